//! Several equilibria of one arm to scale.

use hydrostat::{Arm, Equilibria, Event, Parameter, Path};

use crate::axes::{Axes, BELOW, LEFT};
use crate::chart::{Abscissa, Look};
use crate::font::Label;
use crate::legend::{Legend, Sample};
use crate::outline::{Outline, Style, bounds};
use crate::page::{MARGIN, Page};
use crate::palette::{Color, INK, ordered, series};
use crate::picked::{Flat, Picked, picked};
use crate::placement::Occupied;
use crate::scene::{Scene, Stroke};
use crate::surroundings::Surroundings;
use crate::tip_labels::{TipLabel, label_at_tips};

const MAX_HEIGHT: f64 = 400.0;

/// One shape among several.
struct Member<'a> {
    outline: Outline,
    arm: &'a Arm,
    /// The direction of the tip section, rad.
    theta: f64,
    look: Look,
    color: Color,
    label: Label,
}

/// Shapes along a path at even distances and at round values of the parameter, with those at its ends, limit points and
/// bifurcations: stable ones solid, unstable ones dashed, those at events dotted, each with the value of the parameter. A shape
/// between two points of the path is interpolated, to less than a line is wide.
///
/// ```
/// use hydrostat::{Arm, Parameter, PathOptions};
/// use hydrostat_figures::{Abscissa, Page, path_shapes_figure};
///
/// let arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// let path = arm.path(Parameter::TipForce(1), [0.0, 0.02], &PathOptions::default()).unwrap();
/// let over = Abscissa { name: "force".to_owned(), unit: "mN".to_owned(), per_si: 1e3 };
/// assert!(path_shapes_figure(&path, &over, "a cone", &Page::default()).texts().any(|text| text == "20 mN"));
/// ```
pub fn path_shapes_figure(path: &Path, over: &Abscissa, title: &str, page: &Page) -> Scene {
    let picked = picked(path, over.per_si);
    let count = picked.len();
    let members: Vec<Member<'_>> = picked
        .into_iter()
        .enumerate()
        .map(|(index, Picked { drawn: Flat { outline, theta }, arm, value, look })| {
            let (color, label) = (ordered(index, count), Label::plain(over.text(value)));
            Member { outline, arm, theta, look, color, label }
        })
        .collect();
    let says = format!("{}: shapes along the path", page.title_or(title));
    draw(says, title, &members, marginal(path), Some(path.parameter), page)
}

/// What shapes without stability are, along a path.
pub(crate) fn marginal<C>(path: &Path<C>) -> &'static str {
    let has = |event: Event| path.branches.iter().flat_map(|b| &b.points).any(|p| p.event == Some(event));
    match (has(Event::LimitPoint), has(Event::Bifurcation)) {
        (true, true) => "limit point or bifurcation",
        (true, false) => "limit point",
        (false, true) => "bifurcation",
        (false, false) => Look::Unknown.words(),
    }
}

/// All equilibria under the same loads, numbered from 1: stable ones solid and filled, unstable ones dashed.
///
/// ```
/// let mut arm = hydrostat::Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// arm.tip.force = [-0.2, 0.0];
/// let all = arm.equilibria(1e-6).unwrap();
/// let figure = hydrostat_figures::equilibria_figure(&all, "a column", &hydrostat_figures::Page::default());
/// assert!(figure.texts().any(|text| text == "3"));
/// ```
pub fn equilibria_figure(all: &Equilibria, title: &str, page: &Page) -> Scene {
    let members: Vec<Member<'_>> = all
        .found
        .iter()
        .enumerate()
        .map(|(index, one)| Member {
            outline: Outline::new(&one.configuration, 0),
            arm: &one.configuration.arm,
            theta: one.configuration.tip().theta,
            look: Look::of(one.stability),
            color: series(index + 1),
            label: Label::plain((index + 1).to_string()),
        })
        .collect();
    let says = format!("{}: all equilibria", page.title_or(title));
    draw(says, title, &members, Look::Unknown.words(), None, page)
}

/// The line of a shape.
pub(crate) fn line_of(look: Look, color: Color) -> Stroke {
    match look {
        Look::Stable => Stroke::solid(color, 1.0),
        Look::Unstable => Stroke::dashed(color, 0.9, [4.0, 2.2]),
        Look::Unknown => Stroke::dashed(color, 0.9, [1.0, 1.6]),
    }
}

fn draw(
    says: String,
    title: &str,
    members: &[Member<'_>],
    unknown: &str,
    varied: Option<Parameter>,
    page: &Page,
) -> Scene {
    let all: Vec<[f64; 2]> = members.iter().flat_map(|m| m.outline.surface.iter().copied()).collect();
    let legend = legend(members.iter().map(|m| m.look), unknown, page);
    let heading = page.heading(title, None);
    let axes = axes(&all, heading.bottom + legend.height() + 6.0, page);
    let mut scene = Scene::new(page.width(), axes.frame.bottom + BELOW + MARGIN, says);
    heading.draw(&mut scene);
    legend.draw(&mut scene, heading.bottom);
    axes.draw(&mut scene, &Label::math("$x$ (mm)"), &Label::math("$y$ (mm)"));
    let mut taken = Occupied::new(axes.frame.grown(-3.0));
    // What an arm can be met in lies on top.
    let (stable, others): (Vec<_>, Vec<_>) = members.iter().partition(|m| m.look == Look::Stable);
    for Member { outline, look, color, .. } in others.into_iter().chain(stable) {
        let nothing = Stroke::solid(color.with_opacity(0.0), 0.1);
        let style = Style {
            fill: color.with_opacity(if *look == Look::Stable { 0.16 } else { 0.0 }),
            surface: line_of(*look, *color),
            sections: nothing,
            centreline: nothing,
            cables: Vec::new(),
        };
        outline.draw(&mut scene, &axes, &style);
        outline.occupy(&mut taken, &axes);
    }
    if let Some(arm) = members.first().map(|m| m.arm) {
        Surroundings::of(streamed(arm, members), varied).draw(&mut scene, &mut taken, axes.frame);
    }
    let labels: Vec<TipLabel> = members
        .iter()
        .map(|Member { outline, theta, color, label, .. }| TipLabel {
            tip: axes.at(outline.tip()),
            towards: *theta,
            color: *color,
            label: label.clone(),
        })
        .collect();
    label_at_tips(&mut scene, &mut taken, &labels);
    scene
}

/// The lines that shapes of these looks have.
pub(crate) fn legend(looks: impl Iterator<Item = Look>, unknown: &str, page: &Page) -> Legend {
    let mut legend = Legend::new(page);
    let looks: Vec<Look> = looks.collect();
    for look in [Look::Stable, Look::Unstable, Look::Unknown] {
        let words = if look == Look::Unknown { unknown } else { look.words() };
        if looks.contains(&look) {
            legend.add(Sample::Line(line_of(look, INK)), Label::plain(words));
        }
    }
    legend
}

/// The first arm, or one that is in a stream if any of them is.
fn streamed<'a>(first: &'a Arm, members: &[Member<'a>]) -> &'a Arm {
    members.iter().map(|m| m.arm).find(|arm| arm.flow.speed > 0.0).unwrap_or(first)
}

/// Axes of one scale round all points, with room for labels.
fn axes(points: &[[f64; 2]], top: f64, page: &Page) -> Axes {
    let [x, y] = bounds(points);
    let pad = 0.07 * (x[1] - x[0]).max(y[1] - y[0]);
    let grown = |range: [f64; 2]| [range[0] - pad, range[1] + pad];
    Axes::equal(LEFT, top, page.across(), [150.0, MAX_HEIGHT], grown(x), grown(y))
}
