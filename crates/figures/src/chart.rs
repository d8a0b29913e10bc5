//! A quantity of many equilibria over a parameter.

use hydrostat::{Equilibria, Event, Path, PathEnd, PathPoint, Stability};

use crate::arm_figure::{fitting, place_label, short};
use crate::axes::{Axes, BELOW, LEFT};
use crate::font::{CAP_HEIGHT, Label};
use crate::legend::{Legend, MARGIN, Mark, Sample, WIDTH};
use crate::palette::{Color, GREY, INK, series};
use crate::placement::{Occupied, Rect};
use crate::quantity::Quantity;
use crate::scene::{Anchor, Point, Scene, Stroke};

const HEIGHT: f64 = 230.0;
const TITLE_SIZE: f64 = 10.0;
/// More labels than this would hide what they mean.
const MOST_LABELS: usize = 12;

/// The parameter that a chart runs over.
#[derive(Debug, Clone, PartialEq)]
pub struct Abscissa {
    /// For people.
    pub name: String,
    /// The unit in which it is shown; may be empty.
    pub unit: String,
    /// How many of that unit an SI unit is.
    pub per_si: f64,
}

impl Abscissa {
    fn title(&self) -> Label {
        match self.unit.as_str() {
            "" => Label::plain(&self.name),
            "deg" => Label::plain(format!("{} (°)", self.name)),
            unit => Label::plain(format!("{} ({unit})", self.name)),
        }
    }

    /// A value (SI) with its unit.
    pub(crate) fn text(&self, value: f64) -> String {
        let shown = value * self.per_si;
        // What is nothing over the range is rounding.
        let number = short(if shown.abs() < 1e-9 { 0.0 } else { shown }).replace('-', "\u{2212}");
        match self.unit.as_str() {
            "" => number,
            "deg" => format!("{number}°"),
            unit => format!("{number} {unit}"),
        }
    }
}

/// What is known of a piece of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Look {
    Stable,
    Unstable,
    Unknown,
}

impl Look {
    pub(crate) fn of(stability: Option<Stability>) -> Self {
        match stability.and_then(Stability::is_stable) {
            Some(true) => Self::Stable,
            Some(false) => Self::Unstable,
            None => Self::Unknown,
        }
    }

    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Unstable => "unstable",
            Self::Unknown => "stability not established",
        }
    }

    fn color(self) -> Color {
        match self {
            Self::Stable => series(1),
            Self::Unstable => series(0),
            Self::Unknown => GREY,
        }
    }

    fn stroke(self) -> Stroke {
        match self {
            Self::Stable => Stroke::solid(self.color(), 1.4),
            Self::Unstable => Stroke::dashed(self.color(), 1.2, [4.0, 2.2]),
            Self::Unknown => Stroke::dashed(self.color(), 1.2, [1.0, 1.6]),
        }
    }

    fn mark(self) -> Mark {
        match self {
            Self::Stable => Mark::Filled(self.color()),
            Self::Unstable => Mark::Hollow(self.color()),
            Self::Unknown => Mark::Cross(self.color()),
        }
    }
}

const LOOKS: [Look; 3] = [Look::Stable, Look::Unstable, Look::Unknown];

fn event_mark(event: Event) -> (Mark, &'static str) {
    match event {
        Event::LimitPoint => (Mark::Filled(INK), "limit point"),
        Event::Bifurcation => (Mark::Diamond(INK), "bifurcation"),
    }
}

const END: Mark = Mark::Cross(INK);

/// `quantity` along a path: stable pieces solid, unstable ones dashed, limit points and bifurcations marked with the
/// value of the parameter, a cross where a limit of the arm ends a branch.
///
/// ```
/// use hydrostat::{Arm, Parameter, PathOptions};
/// use hydrostat_figures::{Abscissa, Quantity, path_figure};
///
/// let arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// let path = arm.path(Parameter::TipForce(1), [0.0, 0.02], &PathOptions::default()).unwrap();
/// let over = Abscissa { name: "force".to_owned(), unit: "mN".to_owned(), per_si: 1e3 };
/// let figure = path_figure(&path, &over, Quantity::TipY, "a cone");
/// assert!(figure.texts().any(|text| text == "force (mN)"));
/// ```
pub fn path_figure(path: &Path, over: &Abscissa, quantity: Quantity, title: &str) -> Scene {
    let at = |p: &PathPoint| [over.per_si * p.value, quantity.of(&p.configuration)];
    let all: Vec<[f64; 2]> = path.branches.iter().flat_map(|b| b.points.iter().map(at)).collect();
    let events: Vec<&PathPoint> =
        path.branches.iter().flat_map(|b| &b.points).filter(|p| p.event.is_some()).collect();
    let stopped: Vec<&PathPoint> = path
        .branches
        .iter()
        .filter(|b| matches!(b.end, PathEnd::Limit { .. }))
        .filter_map(|b| b.points.last())
        .collect();

    let pieces: Vec<Vec<(Look, Vec<[f64; 2]>)>> =
        path.branches.iter().map(|b| pieces(&b.points.iter().map(|p| (at(p), look(p))).collect::<Vec<_>>())).collect();
    let shown = |look: Look| pieces.iter().flatten().any(|(piece, _)| *piece == look);
    let mut legend = Legend::default();
    for look in LOOKS.into_iter().filter(|look| shown(*look)) {
        legend.add(Sample::Line(look.stroke()), Label::plain(look.words()));
    }
    for event in [Event::LimitPoint, Event::Bifurcation] {
        if events.iter().any(|p| p.event == Some(event)) {
            let (mark, words) = event_mark(event);
            legend.add(Sample::Mark(mark), Label::plain(words));
        }
    }
    if !stopped.is_empty() {
        legend.add(Sample::Mark(END), Label::plain("no equilibrium beyond"));
    }

    let (mut scene, axes) = page(title, &legend, &all, over, quantity);
    let mut occupied = Occupied::new(axes.frame.grown(-3.0));
    for wanted in [Look::Unknown, Look::Unstable, Look::Stable] {
        for (_, points) in pieces.iter().flatten().filter(|(look, _)| *look == wanted) {
            let smooth = smooth(&axes.all(points));
            scene.line(&smooth, wanted.stroke());
            occupied.add_line(&smooth);
        }
    }
    for point in &stopped {
        END.draw(&mut scene, axes.at(at(point)));
    }
    let labelled = events.len() <= MOST_LABELS;
    for point in &events {
        if let Some(event) = point.event {
            event_mark(event).0.draw(&mut scene, axes.at(at(point)));
        }
    }
    for point in events.into_iter().chain(stopped).filter(|_| labelled) {
        let page = axes.at(at(point));
        place_label(&mut scene, &mut occupied, &Label::plain(over.text(point.value)), INK, page, 0.0);
    }
    scene
}

/// `quantity` of all equilibria at several values (SI) of a parameter: stable ones filled, unstable ones hollow.
///
/// ```
/// use hydrostat::{Arm, Parameter};
/// use hydrostat_figures::{Abscissa, Quantity, over_figure};
///
/// let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// arm.tip.force = [-0.2, 0.0];
/// let all = arm.equilibria(1e-6).unwrap();
/// let over = Abscissa { name: "force".to_owned(), unit: "N".to_owned(), per_si: 1.0 };
/// let figure = over_figure(&[(-0.2, &all)], &over, Quantity::TipY, "a column");
/// assert!(figure.texts().any(|text| text == "unstable"));
/// ```
pub fn over_figure(searches: &[(f64, &Equilibria)], over: &Abscissa, quantity: Quantity, title: &str) -> Scene {
    let points: Vec<([f64; 2], Look)> = searches
        .iter()
        .flat_map(|(value, all)| {
            let at = move |one: &hydrostat::Equilibrium| [over.per_si * value, quantity.of(&one.configuration)];
            all.found.iter().map(move |one| (at(one), Look::of(one.stability)))
        })
        .collect();
    let mut legend = Legend::default();
    for look in LOOKS.into_iter().filter(|look| points.iter().any(|(_, l)| l == look)) {
        legend.add(Sample::Mark(look.mark()), Label::plain(look.words()));
    }
    let mut all: Vec<[f64; 2]> = points.iter().map(|(p, _)| *p).collect();
    // The whole range is shown, even where there are no equilibria.
    if let (Some(first), Some(any)) = (searches.first().zip(searches.last()), all.first().copied()) {
        all.extend([first.0.0, first.1.0].map(|value| [over.per_si * value, any[1]]));
    }
    let (mut scene, axes) = page(title, &legend, &all, over, quantity);
    for (point, look) in points {
        look.mark().draw(&mut scene, axes.at(point));
    }
    scene
}

/// Title, legend, and axes round all points.
fn page(title: &str, legend: &Legend, points: &[[f64; 2]], over: &Abscissa, quantity: Quantity) -> (Scene, Axes) {
    let baseline = MARGIN + CAP_HEIGHT * TITLE_SIZE;
    let top = baseline + 8.0 + legend.height() + 6.0;
    let frame = Rect { left: LEFT, top, right: WIDTH - MARGIN, bottom: top + HEIGHT };
    let [x, y] = crate::outline::bounds(points);
    let axes = Axes::new(frame, padded(x, 0.03), padded(y, 0.06));
    let y_title = quantity.title();
    let mut scene = Scene::new(WIDTH, frame.bottom + BELOW + MARGIN, format!("{title}: {y_title} over {}", over.name));
    let label = Label::plain(title);
    scene.text(&label, [LEFT, baseline], Anchor::Start, fitting(&label, TITLE_SIZE));
    legend.draw(&mut scene, baseline + 8.0);
    axes.draw(&mut scene, &over.title(), &y_title);
    (scene, axes)
}

/// A range with some room at its ends, and never an empty one.
fn padded([low, high]: [f64; 2], share: f64) -> [f64; 2] {
    if !(low.is_finite() && high.is_finite()) {
        return [0.0, 1.0];
    }
    let size = low.abs().max(high.abs()).max(1e-9);
    let pad = (share * (high - low)).max(if high - low < 1e-6 * size { 0.1 * size } else { 0.0 });
    [low - pad, high + pad]
}

/// `None` at events, where one direction is neither stable nor unstable.
fn look(point: &PathPoint) -> Option<Look> {
    point.event.is_none().then(|| Look::of(point.stability))
}

/// The points in pieces of one look each, which share their ends. Where it changes without an event, halfway.
fn pieces(points: &[([f64; 2], Option<Look>)]) -> Vec<(Look, Vec<[f64; 2]>)> {
    let mut out: Vec<(Look, Vec<[f64; 2]>)> = Vec::new();
    let mut go = |look: Look, from: [f64; 2], to: [f64; 2]| match out.last_mut() {
        Some((last, line)) if *last == look => line.push(to),
        _ => out.push((look, vec![from, to])),
    };
    let mut last = None;
    for (k, pair) in points.windows(2).enumerate() {
        let [(a, before), (b, after)] = [pair[0], pair[1]];
        last = before.or(last);
        match (before, after) {
            (Some(before), Some(after)) if before != after => {
                let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
                go(before, a, middle);
                go(after, middle, b);
            }
            (Some(look), _) | (None, Some(look)) => go(look, a, b),
            (None, None) => {
                let next = points[k + 1..].iter().find_map(|(_, look)| *look);
                go(next.or(last).unwrap_or(Look::Unknown), a, b);
            }
        }
    }
    out
}

/// A smooth line through `points` (centripetal Catmull and Rom).
fn smooth(points: &[Point]) -> Vec<Point> {
    const PARTS: u32 = 8;
    let Some(first) = points.first() else { return Vec::new() };
    let mut out = vec![*first];
    let count = points.len();
    for k in 0..count - 1 {
        let (b, c) = (points[k], points[k + 1]);
        let (a, d) = (points[k.saturating_sub(1)], points[(k + 2).min(count - 1)]);
        let gap = |p: Point, q: Point| (p[0] - q[0]).hypot(p[1] - q[1]).sqrt().max(1e-6);
        let (ab, bc, cd) = (gap(a, b), gap(b, c), gap(c, d));
        // Slopes by the parameter of the middle piece, which runs from 0 to 1.
        let slope = |axis: usize| {
            let leave = (b[axis] - a[axis]) / ab - (c[axis] - a[axis]) / (ab + bc) + (c[axis] - b[axis]) / bc;
            let reach = (c[axis] - b[axis]) / bc - (d[axis] - b[axis]) / (bc + cd) + (d[axis] - c[axis]) / cd;
            [if k == 0 { c[axis] - b[axis] } else { bc * leave }, if k + 2 == count { c[axis] - b[axis] } else { bc * reach }]
        };
        let slopes = [slope(0), slope(1)];
        for part in 1..=PARTS {
            let t = f64::from(part) / f64::from(PARTS);
            let at = |axis: usize| {
                let [leave, reach] = slopes[axis];
                let (rise, fall) = (t * t * (3.0 - 2.0 * t), t * (1.0 - t));
                b[axis] + rise * (c[axis] - b[axis]) + fall * ((1.0 - t) * leave - t * reach)
            };
            out.push([at(0), at(1)]);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_share_their_ends() {
        use Look::{Stable, Unstable};
        let at = |x: f64| [x, 0.0];
        let path = [
            (at(0.0), Some(Stable)),
            (at(1.0), Some(Stable)),
            (at(2.0), None),
            (at(1.5), Some(Unstable)),
            (at(1.0), None),
            (at(1.1), None),
            (at(2.0), Some(Stable)),
        ];
        let pieces = pieces(&path);
        let expected = [
            (Stable, vec![at(0.0), at(1.0), at(2.0)]),
            (Unstable, vec![at(2.0), at(1.5), at(1.0)]),
            (Stable, vec![at(1.0), at(1.1), at(2.0)]),
        ];
        assert_eq!(pieces, expected);
        assert_eq!(super::pieces(&[(at(0.0), Some(Stable)), (at(1.0), Some(Unstable))])[1].1, [at(0.5), at(1.0)]);
    }

    #[test]
    fn a_smooth_line_goes_through_its_points_and_keeps_lines_straight() {
        let points = [[0.0, 0.0], [1.0, 2.0], [3.0, 2.5], [3.0, 2.5], [2.0, 4.0]];
        let line = smooth(&points);
        assert!(points.iter().all(|p| line.iter().any(|q| (p[0] - q[0]).hypot(p[1] - q[1]) < 1e-9)));
        assert!(line.iter().all(|p| p.iter().all(|x| x.is_finite())));
        let straight = smooth(&[[0.0, 0.0], [1.0, 1.0], [5.0, 5.0], [6.0, 6.0]]);
        assert!(straight.iter().all(|p| (p[0] - p[1]).abs() < 1e-12));
    }

    #[test]
    fn ranges_have_room() {
        assert_eq!(padded([0.0, 10.0], 0.1), [-1.0, 11.0]);
        assert!(padded([5.0, 5.0], 0.1)[0] < 5.0 && padded([0.0, 0.0], 0.1)[1] > 0.0);
        assert_eq!(padded([f64::INFINITY, f64::NEG_INFINITY], 0.1), [0.0, 1.0]);
    }
}
