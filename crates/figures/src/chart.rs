//! A quantity of many equilibria over a parameter.

use hydrostat::{
    Equilibria, Equilibrium, Event, Path, PathEnd, PathPoint, SpatialConfiguration, SpatialEquilibria, Stability,
};

use crate::arm_figure::place_label;
use crate::axes::{Axes, BELOW, LEFT};
use crate::font::Label;
use crate::legend::{Legend, Mark, Sample};
use crate::numbers::short;
use crate::page::{MARGIN, Page};
use crate::palette::{Color, GREY, INK, series};
use crate::placement::{Occupied, Rect};
use crate::quantity::Quantity;
use crate::scene::{Point, Scene, Stroke};

const HEIGHT: f64 = 230.0;
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
    pub(crate) fn title(&self) -> Label {
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
        Event::Slack(_) | Event::Taut(_) => (Mark::Hollow(INK), "a cable goes slack or taut"),
    }
}

const END: Mark = Mark::Cross(INK);

/// `quantity` along a path: stable pieces solid, unstable ones dashed, limit points, bifurcations and cables that go slack or taut marked with the
/// value of the parameter, a cross where a limit of the arm ends a branch.
///
/// ```
/// use hydrostat::{Arm, Parameter, PathOptions};
/// use hydrostat_figures::{Abscissa, Page, Quantity, path_figure};
///
/// let arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// let path = arm.path(Parameter::TipForce(1), [0.0, 0.02], &PathOptions::default()).unwrap();
/// let over = Abscissa { name: "force".to_owned(), unit: "mN".to_owned(), per_si: 1e3 };
/// let figure = path_figure(&path, &over, Quantity::TipY, "a cone", &Page::default());
/// assert!(figure.texts().any(|text| text == "force (mN)"));
/// ```
pub fn path_figure(path: &Path, over: &Abscissa, quantity: Quantity, title: &str, page: &Page) -> Scene {
    chart(path, over, |c| quantity.of(c), quantity, title, page)
}

/// [`path_figure`] of an arm in space.
pub fn spatial_path_figure(
    path: &Path<SpatialConfiguration>,
    over: &Abscissa,
    quantity: Quantity,
    title: &str,
    page: &Page,
) -> Scene {
    chart(path, over, |c| quantity.of(c), quantity, title, page)
}

/// The chart of a path, given the value of the quantity.
fn chart<C>(
    path: &Path<C>,
    over: &Abscissa,
    value: impl Fn(&C) -> f64,
    quantity: Quantity,
    title: &str,
    page: &Page,
) -> Scene {
    let at = |p: &PathPoint<C>| [over.per_si * p.value, value(&p.configuration)];
    let all: Vec<[f64; 2]> = path.branches.iter().flat_map(|b| b.points.iter().map(at)).collect();
    let events: Vec<&PathPoint<C>> =
        path.branches.iter().flat_map(|b| &b.points).filter(|p| p.event.is_some()).collect();
    let stopped: Vec<&PathPoint<C>> = path
        .branches
        .iter()
        .filter(|b| matches!(b.end, PathEnd::Limit { .. }))
        .filter_map(|b| b.points.last())
        .collect();

    let mut legend = Legend::new(page);
    let regular = || path.branches.iter().flat_map(|b| &b.points).filter_map(look);
    for look in LOOKS.into_iter().filter(|wanted| regular().any(|look| look == *wanted)) {
        legend.add(Sample::Line(look.stroke()), Label::plain(look.words()));
    }
    for event in [Event::LimitPoint, Event::Bifurcation, Event::Slack(0)] {
        let (mark, words) = event_mark(event);
        if events.iter().any(|p| p.event.is_some_and(|own| event_mark(own).1 == words)) {
            legend.add(Sample::Mark(mark), Label::plain(words));
        }
    }
    if !stopped.is_empty() {
        legend.add(Sample::Mark(END), Label::plain("no equilibrium found beyond"));
    }

    let (mut scene, axes) = frame(title, &legend, &all, over, quantity, page);
    let pieces: Vec<Vec<(Look, Vec<Point>)>> = path
        .branches
        .iter()
        .map(|branch| {
            // A branch switched to begins at the bifurcation, which is a point of another.
            let left = |p: &&&PathPoint<C>| branch.switched_at == Some(p.value);
            let points: Vec<&PathPoint<C>> =
                events.iter().find(left).copied().into_iter().chain(&branch.points).collect();
            let looks: Vec<Option<Look>> = points.iter().map(|p| look(p)).collect();
            pieces(&looks, &smooth(&axes.all(&points.iter().map(|p| at(p)).collect::<Vec<_>>())))
        })
        .collect();
    let mut occupied = Occupied::new(axes.frame.grown(-3.0));
    for wanted in [Look::Unknown, Look::Unstable, Look::Stable] {
        for (_, line) in pieces.iter().flatten().filter(|(look, _)| *look == wanted) {
            scene.line(line, wanted.stroke());
            occupied.add_line(line);
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
        let place = axes.at(at(point));
        place_label(&mut scene, &mut occupied, &Label::plain(over.text(point.value)), INK, place, 0.0);
    }
    scene
}

/// `quantity` of all equilibria at several values (SI) of a parameter: stable ones filled, unstable ones hollow.
///
/// ```
/// use hydrostat::{Arm, Parameter};
/// use hydrostat_figures::{Abscissa, Page, Quantity, over_figure};
///
/// let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// arm.tip.force = [-0.2, 0.0];
/// let all = arm.equilibria(1e-6).unwrap();
/// let over = Abscissa { name: "force".to_owned(), unit: "N".to_owned(), per_si: 1.0 };
/// let figure = over_figure(&[(-0.2, &all)], &over, Quantity::TipY, "a column", &Page::default());
/// assert!(figure.texts().any(|text| text == "unstable"));
/// ```
pub fn over_figure(
    searches: &[(f64, &Equilibria)],
    over: &Abscissa,
    quantity: Quantity,
    title: &str,
    page: &Page,
) -> Scene {
    let found: Vec<_> = searches.iter().map(|(value, all)| (*value, all.found.as_slice())).collect();
    over_chart(&found, over, |shape| quantity.of(shape), quantity, title, page)
}

/// [`over_figure`] of an arm in space.
pub fn spatial_over_figure(
    searches: &[(f64, &SpatialEquilibria)],
    over: &Abscissa,
    quantity: Quantity,
    title: &str,
    page: &Page,
) -> Scene {
    let found: Vec<_> = searches.iter().map(|(value, all)| (*value, all.found.as_slice())).collect();
    over_chart(&found, over, |shape| quantity.of(shape), quantity, title, page)
}

/// The chart of equilibria at several values, given the value of the quantity.
fn over_chart<C>(
    searches: &[(f64, &[Equilibrium<C>])],
    over: &Abscissa,
    of: impl Fn(&C) -> f64,
    quantity: Quantity,
    title: &str,
    page: &Page,
) -> Scene {
    let mut points: Vec<([f64; 2], Look)> = Vec::new();
    for (value, found) in searches {
        let at = |one: &Equilibrium<C>| [over.per_si * value, of(&one.configuration)];
        points.extend(found.iter().map(|one| (at(one), Look::of(one.stability))));
    }
    let mut legend = Legend::new(page);
    for look in LOOKS.into_iter().filter(|look| points.iter().any(|(_, l)| l == look)) {
        legend.add(Sample::Mark(look.mark()), Label::plain(look.words()));
    }
    let mut all: Vec<[f64; 2]> = points.iter().map(|(p, _)| *p).collect();
    // The whole range is shown, even where there are no equilibria.
    if let (Some(first), Some(any)) = (searches.first().zip(searches.last()), all.first().copied()) {
        all.extend([first.0.0, first.1.0].map(|value| [over.per_si * value, any[1]]));
    }
    let (mut scene, axes) = frame(title, &legend, &all, over, quantity, page);
    for (point, look) in points {
        look.mark().draw(&mut scene, axes.at(point));
    }
    scene
}

/// Title, legend, and axes round all points.
pub(crate) fn frame(
    title: &str,
    legend: &Legend,
    points: &[[f64; 2]],
    over: &Abscissa,
    quantity: Quantity,
    page: &Page,
) -> (Scene, Axes) {
    let heading = page.heading(title, None);
    let top = heading.bottom + legend.height() + 6.0;
    let frame = Rect { left: LEFT, top, right: page.right(), bottom: top + HEIGHT };
    let [x, y] = crate::outline::bounds(points);
    let axes = Axes::new(frame, padded(x, 0.03), padded(y, 0.06));
    let y_title = quantity.title();
    let says = format!("{}: {y_title} over {}", page.title_or(title), over.name);
    let mut scene = Scene::new(page.width(), frame.bottom + BELOW + MARGIN, says);
    heading.draw(&mut scene);
    legend.draw(&mut scene, heading.bottom);
    axes.draw(&mut scene, &over.title(), &y_title);
    (scene, axes)
}

/// A range with some room at its ends. What is one number but for rounding gets a tenth of it to both sides, zero gets 1.
pub(crate) fn padded(range: [f64; 2], fraction: f64) -> [f64; 2] {
    padded_beside(range, fraction, 0.0)
}

/// [`padded`] of a part of numbers whose size is at least `size`: what is nothing beside that is rounding.
pub(crate) fn padded_beside([low, high]: [f64; 2], fraction: f64, size: f64) -> [f64; 2] {
    /// Less than this is zero in any unit that is shown.
    const NOTHING: f64 = 1e-12;
    if !(low.is_finite() && high.is_finite()) {
        return [0.0, 1.0];
    }
    let size = low.abs().max(high.abs()).max(size);
    if size < NOTHING {
        return [-1.0, 1.0];
    }
    let pad = if high - low < 1e-6 * size { 0.1 * size } else { fraction * (high - low) };
    [low - pad, high + pad]
}

/// `None` at events, where one direction is neither stable nor unstable.
fn look<C>(point: &PathPoint<C>) -> Option<Look> {
    point.event.is_none().then(|| Look::of(point.stability))
}

/// The line between points, one part for each two of them, in pieces of one look each, which share their ends. Where the
/// look changes without an event, it does so halfway.
fn pieces(looks: &[Option<Look>], parts: &[Vec<Point>]) -> Vec<(Look, Vec<Point>)> {
    let mut out: Vec<(Look, Vec<Point>)> = Vec::new();
    let mut go = |look: Look, part: &[Point]| match out.last_mut() {
        Some((last, line)) if *last == look => line.extend(part.iter().skip(1)),
        _ => out.push((look, part.to_vec())),
    };
    let mut last = None;
    for (k, (pair, part)) in looks.windows(2).zip(parts).enumerate() {
        let [before, after] = [pair[0], pair[1]];
        last = before.or(last);
        match (before, after) {
            (Some(before), Some(after)) if before != after => {
                let middle = part.len() / 2;
                go(before, &part[..=middle]);
                go(after, &part[middle..]);
            }
            (Some(look), _) | (None, Some(look)) => go(look, part),
            (None, None) => {
                let next = looks[k + 1..].iter().find_map(|look| *look);
                go(next.or(last).unwrap_or(Look::Unknown), part);
            }
        }
    }
    out
}

/// A smooth line through `points` (centripetal Catmull and Rom), one part for each two of them.
pub(crate) fn smooth(points: &[Point]) -> Vec<Vec<Point>> {
    const STEPS: u32 = 10;
    let last = points.len().saturating_sub(1);
    let part = |k: usize| {
        let (b, c) = (points[k], points[k + 1]);
        let (a, d) = (points[k.saturating_sub(1)], points[(k + 2).min(last)]);
        let gap = |p: Point, q: Point| (p[0] - q[0]).hypot(p[1] - q[1]).sqrt().max(1e-6);
        let (ab, bc, cd) = (gap(a, b), gap(b, c), gap(c, d));
        // Slopes at both ends, by a parameter that runs from 0 to 1 between them.
        let slopes = |axis: usize| {
            let chord = c[axis] - b[axis];
            let leave = (b[axis] - a[axis]) / ab - (c[axis] - a[axis]) / (ab + bc) + chord / bc;
            let reach = chord / bc - (d[axis] - b[axis]) / (bc + cd) + (d[axis] - c[axis]) / cd;
            let [leave, reach] = [bc * leave, bc * reach];
            // An end has no neighbour: the curve bends there as evenly as its other end lets it.
            match (k == 0, k + 1 == last) {
                (true, true) => [chord; 2],
                (true, false) => [1.5 * chord - 0.5 * reach, reach],
                (false, true) => [leave, 1.5 * chord - 0.5 * leave],
                (false, false) => [leave, reach],
            }
        };
        let slopes = [slopes(0), slopes(1)];
        let at = |t: f64, axis: usize| {
            let [leave, reach] = slopes[axis];
            let (rise, fall) = (t * t * (3.0 - 2.0 * t), t * (1.0 - t));
            b[axis] + rise * (c[axis] - b[axis]) + fall * ((1.0 - t) * leave - t * reach)
        };
        (0..=STEPS).map(|step| f64::from(step) / f64::from(STEPS)).map(|t| [at(t, 0), at(t, 1)]).collect()
    };
    (0..last).map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_share_their_ends() {
        use Look::{Stable, Unstable};
        let at = |x: f64| [x, 0.0];
        let places = [0.0, 1.0, 2.0, 1.5, 1.0, 1.1, 2.0];
        let parts: Vec<Vec<Point>> = places.windows(2).map(|w| vec![at(w[0]), at(w[1])]).collect();
        let looks = [Some(Stable), Some(Stable), None, Some(Unstable), None, None, Some(Stable)];
        let expected = [
            (Stable, vec![at(0.0), at(1.0), at(2.0)]),
            (Unstable, vec![at(2.0), at(1.5), at(1.0)]),
            (Stable, vec![at(1.0), at(1.1), at(2.0)]),
        ];
        assert_eq!(pieces(&looks, &parts), expected);
        let halves = pieces(&[Some(Stable), Some(Unstable)], &[vec![at(0.0), at(0.5), at(1.0)]]);
        assert_eq!(halves, [(Stable, vec![at(0.0), at(0.5)]), (Unstable, vec![at(0.5), at(1.0)])]);
    }

    #[test]
    fn a_smooth_line_goes_through_its_points_and_keeps_lines_straight() {
        let points = [[0.0, 0.0], [1.0, 2.0], [3.0, 2.5], [3.0, 2.5], [2.0, 4.0]];
        let parts = smooth(&points);
        let near = |p: Point, q: Point| (p[0] - q[0]).hypot(p[1] - q[1]) < 1e-9;
        assert_eq!(parts.len(), 4);
        for (part, ends) in parts.iter().zip(points.windows(2)) {
            assert!(near(part[0], ends[0]) && near(part[part.len() - 1], ends[1]));
        }
        assert!(parts.iter().flatten().flatten().all(|x| x.is_finite()));
        let straight = smooth(&[[0.0, 0.0], [1.0, 1.0], [5.0, 5.0], [6.0, 6.0]]);
        assert!(straight.iter().flatten().all(|p| (p[0] - p[1]).abs() < 1e-12));
        assert!(smooth(&[[1.0, 1.0]]).is_empty() && smooth(&[]).is_empty());
    }

    #[test]
    fn ranges_have_room() {
        assert_eq!(padded([0.0, 10.0], 0.1), [-1.0, 11.0]);
        assert!(padded([5.0, 5.0], 0.1)[0] < 5.0);
        assert_eq!(padded([0.0, 0.0], 0.1), [-1.0, 1.0]);
        assert_eq!(padded([-1e-17, 2e-18], 0.0), [-1.0, 1.0]);
        let [low, high] = padded([245.0, 245.000_000_01], 0.0);
        assert!((low - 220.5).abs() < 1e-6 && (high - 269.5).abs() < 1e-6);
        assert!(padded_beside([-1e-9, 0.0], 0.05, 100.0)[1] > 9.0);
        assert_eq!(padded([f64::INFINITY, f64::NEG_INFINITY], 0.1), [0.0, 1.0]);
    }
}
