//! Several equilibria of one arm to scale.

use hydrostat::{Arm, Configuration, Equilibria, Event, Parameter, Path, PathPoint};

use crate::arm_figure::fitting;
use crate::axes::{Axes, BELOW, LEFT};
use crate::chart::{Abscissa, Look};
use crate::font::{CAP_HEIGHT, Label};
use crate::legend::{Legend, MARGIN, Sample, WIDTH};
use crate::outline::{Outline, Style, bounds};
use crate::palette::{Color, INK, ordered, series};
use crate::placement::Occupied;
use crate::scene::{Anchor, Scene, Stroke};
use crate::tip_labels::{TipLabel, label_at_tips};

const TITLE_SIZE: f64 = 10.0;
const MAX_HEIGHT: f64 = 400.0;
/// Shapes along the branch that a path starts on, along each of a few that it switches to, and of each of many.
const ALONG: [usize; 3] = [9, 4, 1];
const FEW: usize = 3;
/// Tips that are no further apart, over L, and no more than that (rad) turned against each other are one on the page.
const ALIKE: [f64; 2] = [0.02, 0.05];

/// One shape among several.
struct Member<'a> {
    configuration: &'a Configuration,
    look: Look,
    color: Color,
    label: Label,
}

/// Shapes along a path, picked evenly, with those at limit points and bifurcations: stable ones solid, unstable ones
/// dashed, those at events dotted, each with the value of the parameter.
///
/// ```
/// use hydrostat::{Arm, Parameter, PathOptions};
/// use hydrostat_figures::{Abscissa, path_shapes_figure};
///
/// let arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// let path = arm.path(Parameter::TipForce(1), [0.0, 0.02], &PathOptions::default()).unwrap();
/// let over = Abscissa { name: "force".to_owned(), unit: "mN".to_owned(), per_si: 1e3 };
/// assert!(path_shapes_figure(&path, &over, "a cone").texts().any(|text| text == "20 mN"));
/// ```
pub fn path_shapes_figure(path: &Path, over: &Abscissa, title: &str) -> Scene {
    let mut picked: Vec<&PathPoint> = Vec::new();
    for (branch, all) in path.branches.iter().enumerate() {
        let count = match (branch, path.branches.len()) {
            (0, _) => ALONG[0],
            (_, ..=FEW) => ALONG[1],
            _ => ALONG[2],
        };
        for point in evenly(&all.points, path.range, count) {
            if !picked.iter().any(|earlier| alike(earlier, point)) {
                picked.push(point);
            }
        }
    }
    let count = picked.len();
    let members: Vec<Member<'_>> = picked
        .into_iter()
        .enumerate()
        .map(|(index, point)| Member {
            configuration: &point.configuration,
            look: Look::of(point.stability),
            color: ordered(index, count),
            label: Label::plain(over.text(point.value)),
        })
        .collect();
    let has = |event: Event| path.branches.iter().flat_map(|b| &b.points).any(|p| p.event == Some(event));
    let marginal = match (has(Event::LimitPoint), has(Event::Bifurcation)) {
        (true, true) => "limit point or bifurcation",
        (true, false) => "limit point",
        (false, true) => "bifurcation",
        (false, false) => Look::Unknown.words(),
    };
    draw(&format!("{title}: shapes along the path"), title, &members, marginal, Some(path.parameter))
}

/// All equilibria under the same loads, numbered from 1: stable ones solid and filled, unstable ones dashed.
///
/// ```
/// let mut arm = hydrostat::Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// arm.tip.force = [-0.2, 0.0];
/// let all = arm.equilibria(1e-6).unwrap();
/// let figure = hydrostat_figures::equilibria_figure(&all, "a column");
/// assert!(figure.texts().any(|text| text == "3"));
/// ```
pub fn equilibria_figure(all: &Equilibria, title: &str) -> Scene {
    let members: Vec<Member<'_>> = all
        .found
        .iter()
        .enumerate()
        .map(|(index, one)| Member {
            configuration: &one.configuration,
            look: Look::of(one.stability),
            color: series(index + 1),
            label: Label::plain((index + 1).to_string()),
        })
        .collect();
    draw(&format!("{title}: all equilibria"), title, &members, Look::Unknown.words(), None)
}

/// Whether two shapes could not be told apart.
fn alike(a: &PathPoint, b: &PathPoint) -> bool {
    let [p, q] = [a, b].map(|point| point.configuration.tip());
    let apart = (q.x - p.x).hypot(q.y - p.y) / a.configuration.arm.length;
    let same = Look::of(a.stability) == Look::of(b.stability);
    same && apart < ALIKE[0] && (q.theta - p.theta).abs() < ALIKE[1]
}

/// About `count` points at even distances, the first and the last, and all events; of one, the last.
fn evenly(points: &[PathPoint], range: [f64; 2], count: usize) -> Vec<&PathPoint> {
    let mut along = vec![0.0];
    for pair in points.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        let [p, q] = [a, b].map(|p| p.configuration.tip());
        let moved = (q.x - p.x).hypot(q.y - p.y) / a.configuration.arm.length;
        let varied = (b.value - a.value) / (range[1] - range[0]);
        along.push(along[along.len() - 1] + moved.hypot(varied));
    }
    let whole = along.last().copied().unwrap_or(0.0);
    let gap = whole / (count.max(2) - 1) as f64;
    let events: Vec<f64> = points.iter().zip(&along).filter(|(p, _)| p.event.is_some()).map(|(_, at)| *at).collect();
    let mut wanted: Vec<usize> = (0..points.len()).filter(|k| points[*k].event.is_some()).collect();
    if count == 1 {
        return points.last().into_iter().collect();
    }
    for k in 0..count {
        let place = gap * k as f64;
        let nearest = (0..points.len()).min_by(|a, b| (along[*a] - place).abs().total_cmp(&(along[*b] - place).abs()));
        let ends = k == 0 || k + 1 == count;
        // Beside an event there is no need for another shape.
        let beside = |index: usize| events.iter().any(|at| (at - along[index]).abs() < 0.4 * gap);
        wanted.extend(nearest.filter(|index| ends || !beside(*index)));
    }
    wanted.sort_unstable();
    wanted.dedup();
    wanted.into_iter().map(|k| &points[k]).collect()
}

fn surface(look: Look, color: Color) -> Stroke {
    match look {
        Look::Stable => Stroke::solid(color, 1.0),
        Look::Unstable => Stroke::dashed(color, 0.9, [4.0, 2.2]),
        Look::Unknown => Stroke::dashed(color, 0.9, [1.0, 1.6]),
    }
}

fn draw(says: &str, title: &str, members: &[Member<'_>], unknown: &str, varied: Option<Parameter>) -> Scene {
    let outlines: Vec<Outline> = members.iter().map(|m| Outline::new(m.configuration, 0)).collect();
    let all: Vec<[f64; 2]> = outlines.iter().flat_map(|o| o.surface.iter().copied()).collect();
    let legend = legend(members, unknown, varied);
    let baseline = MARGIN + CAP_HEIGHT * TITLE_SIZE;
    let top = baseline + 8.0 + legend.height() + 6.0;
    let axes = axes(&all, top);
    let mut scene = Scene::new(WIDTH, axes.frame.bottom + BELOW + MARGIN, says);
    let label = Label::plain(title);
    scene.text(&label, [LEFT, baseline], Anchor::Start, fitting(&label, TITLE_SIZE));
    legend.draw(&mut scene, baseline + 8.0);
    axes.draw(&mut scene, &Label::math("$x$ (mm)"), &Label::math("$y$ (mm)"));
    let mut page = Occupied::new(axes.frame.grown(-3.0));
    // What an arm can be met in lies on top.
    let both = || outlines.iter().zip(members);
    let (stable, others): (Vec<_>, Vec<_>) = both().partition(|(_, m)| m.look == Look::Stable);
    for (outline, Member { look, color, .. }) in others.into_iter().chain(stable) {
        let nothing = Stroke::solid(color.with_opacity(0.0), 0.1);
        let style = Style {
            fill: color.with_opacity(if *look == Look::Stable { 0.16 } else { 0.0 }),
            surface: surface(*look, *color),
            sections: nothing,
            centreline: nothing,
            cables: Vec::new(),
        };
        outline.draw(&mut scene, &axes, &style);
        outline.occupy(&mut page, &axes);
    }
    let labels: Vec<TipLabel> = both()
        .map(|(outline, Member { configuration, color, label, .. })| TipLabel {
            tip: axes.at(outline.tip()),
            towards: configuration.tip().theta,
            color: *color,
            label: label.clone(),
        })
        .collect();
    label_at_tips(&mut scene, &mut page, &labels);
    scene
}

fn legend(members: &[Member<'_>], unknown: &str, varied: Option<Parameter>) -> Legend {
    let mut legend = Legend::default();
    for look in [Look::Stable, Look::Unstable, Look::Unknown] {
        let words = if look == Look::Unknown { unknown } else { look.words() };
        if members.iter().any(|m| m.look == look) {
            legend.add(Sample::Line(surface(look, INK)), Label::plain(words));
        }
    }
    if let Some(arm) = members.first().map(|m| &m.configuration.arm) {
        legend.add_surroundings(&surroundings(arm, members), varied);
    }
    legend
}

/// The first arm, or one that shows a stream if any of them is in one.
fn surroundings(first: &Arm, members: &[Member<'_>]) -> Arm {
    members.iter().map(|m| &m.configuration.arm).find(|arm| arm.flow.speed > 0.0).unwrap_or(first).clone()
}

/// Axes of one scale round all points, with room for labels.
fn axes(points: &[[f64; 2]], top: f64) -> Axes {
    let [x, y] = bounds(points);
    let pad = 0.07 * (x[1] - x[0]).max(y[1] - y[0]);
    let grown = |range: [f64; 2]| [range[0] - pad, range[1] + pad];
    Axes::equal(LEFT, top, WIDTH - LEFT - MARGIN, [150.0, MAX_HEIGHT], grown(x), grown(y))
}
