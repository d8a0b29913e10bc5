//! Several shapes of one arm in space: their centrelines in three views.

use hydrostat::{Arm, Equilibrium, Parameter, Path, SpatialConfiguration, SpatialEquilibria};

use crate::axes::{Axes, BELOW};
use crate::chart::{Abscissa, Look};
use crate::font::Label;
use crate::page::{MARGIN, Page};
use crate::palette::{Color, ordered, series};
use crate::picked::{Picked, picked};
use crate::placement::Occupied;
use crate::scene::{Scene, Stroke};
use crate::shapes::{legend, line_of, marginal};
use crate::surroundings::Surroundings;
use crate::three_views::{ThreeViews, centreline};
use crate::tip_labels::{TipLabel, draw_tip_labels};
use crate::view::Vector;

/// Points of a centreline.
const POINTS: usize = 200;
/// How much wider a centreline is than a surface.
const WIDER: f64 = 1.5;
/// Room for labels over the widest extent.
const PAD: f64 = 0.07;
/// More labels than this stand in the largest view alone: the smaller ones have no room for them.
const LABELS_IN_SMALL_VIEWS: usize = 5;

/// One centreline, mm.
struct Member {
    points: Vec<Vector>,
    look: Look,
    color: Color,
    label: Label,
}

impl Member {
    fn new(number: usize, one: &Equilibrium<SpatialConfiguration>) -> Self {
        let points = centreline(&one.configuration, POINTS);
        let label = Label::plain(number.to_string());
        Self { points, look: Look::of(one.stability), color: series(number), label }
    }
}

/// Centrelines of the equilibria of an arm in space, numbered from 1, seen from e3, against e2 and from e1: stable ones
/// solid, unstable ones dashed.
///
/// ```
/// use hydrostat::{Arm, Space};
///
/// let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// arm.tip.force = [-0.2, 0.001];
/// arm.space = Some(Space::default());
/// let all = arm.equilibria_in_space(1e-6).unwrap();
/// let figure = hydrostat_figures::spatial_equilibria_figure(&all, "a column", &hydrostat_figures::Page::default());
/// assert!(figure.texts().any(|text| text == "z (mm)"));
/// ```
pub fn spatial_equilibria_figure(all: &SpatialEquilibria, title: &str, page: &Page) -> Scene {
    let members: Vec<Member> = all.found.iter().enumerate().map(|(k, one)| Member::new(k + 1, one)).collect();
    let says = format!("{}: equilibria in space", page.title_or(title));
    let around = all.found.first().map(|one| (&one.configuration.arm, None));
    draw(says, title, &members, Look::Unknown.words(), around, page)
}

/// [`path_shapes_figure`](crate::path_shapes_figure) of an arm in space: centrelines in three views.
///
/// ```
/// use hydrostat::{Arm, Cable, Parameter, PathOptions, Profile, Space};
/// use hydrostat_figures::{Abscissa, Page, spatial_path_shapes_figure};
///
/// let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("aside", Profile::linear(0.005, 0.001)).at_angle(1.0));
/// arm.space = Some(Space::default());
/// let path = arm.path_in_space(Parameter::Tension(0), [0.0, 0.2], &PathOptions::default()).unwrap();
/// let over = Abscissa { name: "tension".to_owned(), unit: "mN".to_owned(), per_si: 1e3 };
/// assert!(spatial_path_shapes_figure(&path, &over, "a cone", &Page::default()).texts().any(|text| text == "200 mN"));
/// ```
pub fn spatial_path_shapes_figure(
    path: &Path<SpatialConfiguration>,
    over: &Abscissa,
    title: &str,
    page: &Page,
) -> Scene {
    let picked = picked(path, over.per_si);
    let count = picked.len();
    // At one end of the range there may be no stream or no gravity.
    let acts = |arm: &Arm| arm.stream_in_space() != [0.0; 3] || arm.gravity_in_space() != [0.0; 3];
    let arms = || picked.iter().map(|one| one.arm);
    let around = arms().find(|arm| acts(arm)).map(|arm| (arm, Some(path.parameter)));
    let member = |(index, Picked { drawn, value, look, .. }): (usize, Picked<'_, SpatialConfiguration>)| Member {
        points: drawn,
        look,
        color: ordered(index, count),
        label: Label::plain(over.text(value)),
    };
    let members: Vec<Member> = picked.into_iter().enumerate().map(member).collect();
    let says = format!("{}: shapes along the path", page.title_or(title));
    draw(says, title, &members, marginal(path), around, page)
}

/// `around` is an arm whose stream and gravity are those of all, and what differs from shape to shape.
fn draw(
    says: String,
    title: &str,
    members: &[Member],
    unknown: &str,
    around: Option<(&Arm, Option<Parameter>)>,
    page: &Page,
) -> Scene {
    let legend = legend(members.iter().map(|m| m.look), unknown, page);
    let heading = page.heading(title, None);
    let placed = ThreeViews::around(members.iter().flat_map(|m| m.points.iter().copied()), PAD, page)
        .placed(heading.bottom + legend.height() + 6.0);
    let mut scene = Scene::new(page.width(), placed.bottom + BELOW + MARGIN, says);
    heading.draw(&mut scene);
    legend.draw(&mut scene, heading.bottom);
    placed.draw(&mut scene);
    let area = |axes: &Axes| axes.frame.width() * (axes.frame.bottom - axes.frame.top);
    let largest = placed.views.iter().fold(0.0, |most, (axes, _)| f64::max(most, area(axes)));
    for (axes, view) in &placed.views {
        let mut taken = Occupied::new(axes.frame.grown(-3.0));
        let mut labels = Vec::new();
        for Member { points, look, color, label } in members {
            let line: Vec<_> = points.iter().map(|p| axes.at(view.place(p))).collect();
            let stroke = line_of(*look, *color);
            scene.line(&line, Stroke { width: WIDER * stroke.width, ..stroke });
            taken.add_line(&line);
            if let [.., before, tip] = line[..] {
                let towards = (before[1] - tip[1]).atan2(tip[0] - before[0]);
                labels.push(TipLabel { tip, towards, color: *color, label: label.clone() });
            }
        }
        if let Some((arm, varied)) = around {
            Surroundings::seen(arm, view, varied).draw(&mut scene, &mut taken, axes.frame);
        }
        if area(axes) >= largest || members.len() <= LABELS_IN_SMALL_VIEWS {
            draw_tip_labels(&mut scene, &mut taken, axes.frame, &labels);
        }
    }
    scene
}
