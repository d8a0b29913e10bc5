//! Several equilibria of one arm in space: their centrelines in three views.

use hydrostat::{Equilibrium, SpatialConfiguration, SpatialEquilibria};

use crate::axes::BELOW;
use crate::chart::Look;
use crate::font::Label;
use crate::legend::{Legend, Sample};
use crate::page::{MARGIN, Page};
use crate::palette::{Color, INK, series};
use crate::placement::Occupied;
use crate::scene::{Scene, Stroke};
use crate::shapes::line_of;
use crate::three_views::ThreeViews;
use crate::tip_labels::{TipLabel, draw_tip_labels};
use crate::view::Vector;

const MM: f64 = 1e3;
/// Points of a centreline.
const POINTS: usize = 200;
/// How much wider a centreline is than a surface.
const WIDER: f64 = 1.5;

/// One centreline, mm.
struct Member {
    points: Vec<Vector>,
    look: Look,
    color: Color,
    label: Label,
}

impl Member {
    fn new(number: usize, one: &Equilibrium<SpatialConfiguration>) -> Self {
        let st = one.configuration.resampled(POINTS);
        let points = (0..st.s.len()).map(|k| [st.x[k], st.y[k], st.z[k]].map(|v| MM * v)).collect();
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
    let mut legend = Legend::new(page);
    for look in [Look::Stable, Look::Unstable, Look::Unknown] {
        if members.iter().any(|m| m.look == look) {
            legend.add(Sample::Line(line_of(look, INK)), Label::plain(look.words()));
        }
    }
    let heading = page.heading(title, None);
    let placed = ThreeViews::new(bounds(&members), page).placed(heading.bottom + legend.height() + 6.0);
    let says = format!("{}: equilibria in space", page.title_or(title));
    let mut scene = Scene::new(page.width(), placed.bottom + BELOW + MARGIN, says);
    heading.draw(&mut scene);
    legend.draw(&mut scene, heading.bottom);
    placed.draw(&mut scene);
    for (axes, view) in &placed.views {
        let mut taken = Occupied::new(axes.frame.grown(-3.0));
        let mut labels = Vec::new();
        for Member { points, look, color, label } in &members {
            let line: Vec<_> = points.iter().map(|p| axes.at(view.place(p))).collect();
            let stroke = line_of(*look, *color);
            scene.line(&line, Stroke { width: WIDER * stroke.width, ..stroke });
            taken.add_line(&line);
            if let [.., before, tip] = line[..] {
                let towards = (before[1] - tip[1]).atan2(tip[0] - before[0]);
                labels.push(TipLabel { tip, towards, color: *color, label: label.clone() });
            }
        }
        draw_tip_labels(&mut scene, &mut taken, axes.frame, &labels);
    }
    scene
}

/// Of all points, with room for labels.
fn bounds(members: &[Member]) -> [[f64; 2]; 3] {
    let all = || members.iter().flat_map(|m| &m.points);
    let ranges = [0, 1, 2].map(|k| {
        let fold = |from: f64, of: fn(f64, f64) -> f64| all().map(|p| p[k]).fold(from, of);
        [fold(f64::INFINITY, f64::min), fold(f64::NEG_INFINITY, f64::max)]
    });
    let pad = 0.07 * ranges.iter().map(|[low, high]| high - low).fold(1.0, f64::max);
    ranges.map(|[low, high]| if low <= high { [low - pad, high + pad] } else { [0.0, 1.0] })
}
