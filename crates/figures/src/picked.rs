//! Which shapes of a path are drawn: at even distances, and at round values of the parameter.

use hydrostat::{Arm, Configuration, Event, Path, PathPoint, SpatialConfiguration};

use crate::chart::Look;
use crate::numbers::roundest;
use crate::outline::Outline;
use crate::three_views::centreline;
use crate::view::{Vector, dot, minus, unit};

/// Shapes along the branch that a path starts on, along each of a few that it switches to, and of each of many.
const ALONG: [usize; 3] = [9, 4, 1];
const FEW: usize = 3;
/// Tips that are no further apart, over L, and no more than that (rad) turned against each other are one on the page.
const ALIKE: [f64; 2] = [0.02, 0.05];
/// How far from its place, over the distance of two, a shape may move to a round value, and how near an event there is no need for another.
const FREE: f64 = 0.35;
const BESIDE: f64 = 0.4;

/// A shape in the plane or in space, as it is drawn among others.
pub(crate) trait Drawable: Sized {
    /// What is drawn of it.
    type Drawn;

    /// Of shapes with weights that add up to one.
    fn mean(shapes: &[(&Self, f64)]) -> Self::Drawn;
    /// Its tip, m.
    fn tip_place(&self) -> Vector;
    fn arm(&self) -> &Arm;
    /// How far the tips of two are apart, mm, and how much (rad) they are turned against each other.
    fn between(a: &Self::Drawn, b: &Self::Drawn) -> [f64; 2];
}

/// A shape in the plane.
pub(crate) struct Flat {
    pub(crate) outline: Outline,
    /// The direction of the tip section, rad.
    pub(crate) theta: f64,
}

impl Drawable for Configuration {
    type Drawn = Flat;

    fn mean(shapes: &[(&Self, f64)]) -> Flat {
        let outline = match shapes {
            [(only, _)] => Outline::new(only, 0),
            shapes => Outline::mean(shapes),
        };
        Flat { outline, theta: shapes.iter().map(|(shape, weight)| weight * shape.tip().theta).sum() }
    }

    fn tip_place(&self) -> Vector {
        let tip = self.tip();
        [tip.x, tip.y, 0.0]
    }

    fn arm(&self) -> &Arm {
        &self.arm
    }

    fn between(a: &Flat, b: &Flat) -> [f64; 2] {
        let [[ax, ay], [bx, by]] = [a.outline.tip(), b.outline.tip()];
        [(bx - ax).hypot(by - ay), (b.theta - a.theta).abs()]
    }
}

/// Places of a centreline in space, mm.
const PLACES: usize = 200;

impl Drawable for SpatialConfiguration {
    type Drawn = Vec<Vector>;

    fn mean(shapes: &[(&Self, f64)]) -> Vec<Vector> {
        let mut out = vec![[0.0; 3]; PLACES];
        for (shape, weight) in shapes {
            for (sum, place) in out.iter_mut().zip(centreline(shape, PLACES)) {
                *sum = [0, 1, 2].map(|k| sum[k] + weight * place[k]);
            }
        }
        out
    }

    fn tip_place(&self) -> Vector {
        let tip = self.tip();
        [tip.x, tip.y, tip.z]
    }

    fn arm(&self) -> &Arm {
        &self.arm
    }

    fn between(a: &Vec<Vector>, b: &Vec<Vector>) -> [f64; 2] {
        let [Some([.., p, q]), Some([.., r, s])] = [a.last_chunk::<2>(), b.last_chunk::<2>()] else {
            return [f64::INFINITY; 2];
        };
        let off = minus(s, q);
        let turned = dot(&unit(&minus(q, p)), &unit(&minus(s, r))).clamp(-1.0, 1.0).acos();
        [dot(&off, &off).sqrt(), turned]
    }
}

/// A shape of a path.
pub(crate) struct Picked<'a, C: Drawable = Configuration> {
    pub(crate) drawn: C::Drawn,
    pub(crate) arm: &'a Arm,
    /// Of the parameter, SI.
    pub(crate) value: f64,
    pub(crate) look: Look,
}

impl<'a, C: Drawable> Picked<'a, C> {
    fn at(point: &'a PathPoint<C>) -> Self {
        let shape = &point.configuration;
        Self { drawn: C::mean(&[(shape, 1.0)]), arm: shape.arm(), value: point.value, look: Look::of(point.stability) }
    }

    /// Whether the two could not be told apart.
    fn is_like(&self, other: &Self) -> bool {
        let [apart, turned] = C::between(&self.drawn, &other.drawn);
        self.look == other.look && apart / (1e3 * self.arm.length) < ALIKE[0] && turned < ALIKE[1]
    }
}

/// The shapes of all branches, at values that are round once multiplied by `per_si`.
pub(crate) fn picked<C: Drawable>(path: &Path<C>, per_si: f64) -> Vec<Picked<'_, C>> {
    let mut all: Vec<Picked<'_, C>> = Vec::new();
    for (branch, own) in path.branches.iter().enumerate() {
        let count = match (branch, path.branches.len()) {
            (0, _) => ALONG[0],
            (_, ..=FEW) => ALONG[1],
            _ => ALONG[2],
        };
        for shape in evenly(&own.points, path.range, per_si, count) {
            if !all.iter().any(|earlier| earlier.is_like(&shape)) {
                all.push(shape);
            }
        }
    }
    all
}

/// About `count` shapes at even distances, the first and the last, and all events; of one, the last.
fn evenly<C: Drawable>(points: &[PathPoint<C>], range: [f64; 2], per_si: f64, count: usize) -> Vec<Picked<'_, C>> {
    let along = distances(points, range);
    let (Some(last), Some(whole)) = (points.last(), along.last().copied()) else { return Vec::new() };
    if count == 1 {
        return vec![Picked::at(last)];
    }
    let gap = whole / (count.max(2) - 1) as f64;
    let events: Vec<usize> = (0..points.len()).filter(|k| points[*k].event.is_some()).collect();
    let mut found: Vec<(f64, Picked<'_, C>)> = events.iter().map(|k| (along[*k], Picked::at(&points[*k]))).collect();
    found.push((0.0, Picked::at(&points[0])));
    if points.len() > 1 && points[points.len() - 1].event.is_none() {
        found.push((whole, Picked::at(last)));
    }
    for k in 1..count - 1 {
        let place = gap * k as f64;
        if events.iter().any(|event| (along[*event] - place).abs() < BESIDE * gap) {
            continue;
        }
        let window = [place - FREE * gap, place + FREE * gap];
        found.extend(round_in(points, &along, window, per_si));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, shape)| shape).collect()
}

/// How far each point is along a branch: the tip's way over L, joined with the parameter's over its range.
fn distances<C: Drawable>(points: &[PathPoint<C>], range: [f64; 2]) -> Vec<f64> {
    let mut along = vec![0.0; points.len().min(1)];
    for pair in points.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        let off = minus(&b.configuration.tip_place(), &a.configuration.tip_place());
        let moved = dot(&off, &off).sqrt() / a.configuration.arm().length;
        let varied = (b.value - a.value) / (range[1] - range[0]);
        along.push(along[along.len() - 1] + moved.hypot(varied));
    }
    along
}

/// The shape at the roundest value of a part of a branch that has no event.
fn round_in<'a, C: Drawable>(
    points: &'a [PathPoint<C>],
    along: &[f64],
    [from, to]: [f64; 2],
    per_si: f64,
) -> Option<(f64, Picked<'a, C>)> {
    let segment = |place: f64| along.windows(2).position(|w| w[0] <= place && place <= w[1]);
    let value = |place: f64| Some(Between::new(points, along, segment(place)?).value(place));
    let ends = [value(from)?, value(to)?];
    let shown = [ends[0].min(ends[1]), ends[0].max(ends[1])].map(|value| value * per_si);
    let wanted = roundest(shown[0].min(shown[1]), shown[0].max(shown[1])) / per_si;
    // Without an event between them, values rise or fall all along.
    let (mut low, mut high) = (from, to);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (value(middle)? < wanted) == (ends[0] < ends[1]) {
            low = middle;
        } else {
            high = middle;
        }
    }
    let place = 0.5 * (low + high);
    let between = Between::new(points, along, segment(place)?);
    Some((place, between.shape(place, wanted)))
}

/// Two points of a path one after the other, with their neighbours.
struct Between<'a, C> {
    /// The two and, where nothing has a kink, one before and one after.
    points: Vec<(&'a PathPoint<C>, f64)>,
    nearer: [(&'a PathPoint<C>, f64); 2],
}

impl<'a, C: Drawable> Between<'a, C> {
    fn new(points: &'a [PathPoint<C>], along: &[f64], first: usize) -> Self {
        let smooth = |k: usize| !matches!(points[k].event, Some(Event::Slack(_) | Event::Taut(_)));
        let apart = |a: usize, b: usize| along[b] - along[a] > 1e-9 * along[along.len() - 1];
        let before = first.checked_sub(1).filter(|k| smooth(first) && apart(*k, first));
        let after = Some(first + 2).filter(|k| *k < points.len() && smooth(first + 1) && apart(first + 1, *k));
        let own = |k: usize| (&points[k], along[k]);
        let nearer = [own(first), own(first + 1)];
        let inner = if apart(first, first + 1) { vec![first, first + 1] } else { vec![first] };
        let points = before.into_iter().chain(inner).chain(after).map(own).collect();
        Self { points, nearer }
    }

    /// What each point counts at a place: the polynomial through all of them.
    fn weights(&self, place: f64) -> Vec<f64> {
        let others = |k: usize| self.points.iter().enumerate().filter(move |(j, _)| *j != k);
        let weight = |k: usize| -> f64 {
            let own = self.points[k].1;
            others(k).map(|(_, (_, other))| (place - other) / (own - other)).product()
        };
        (0..self.points.len()).map(weight).collect()
    }

    fn value(&self, place: f64) -> f64 {
        self.points.iter().zip(self.weights(place)).map(|((point, _), weight)| weight * point.value).sum()
    }

    fn shape(&self, place: f64, value: f64) -> Picked<'a, C> {
        let weights = self.weights(place);
        let shapes: Vec<(&C, f64)> =
            self.points.iter().zip(&weights).map(|((point, _), weight)| (&point.configuration, *weight)).collect();
        let [a, b] = self.nearer;
        let (near, _) = if place - a.1 < b.1 - place { a } else { b };
        let known = if near.event.is_none() {
            near
        } else if near.value == a.0.value {
            b.0
        } else {
            a.0
        };
        let look = Look::of(known.stability);
        Picked { drawn: C::mean(&shapes), arm: near.configuration.arm(), value, look }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hydrostat::{Cable, Parameter, PathOptions, Profile};

    fn arm() -> Arm {
        let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
        arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
        arm.flow.speed = 0.1;
        arm
    }

    #[test]
    fn shapes_have_round_values_and_are_those_of_solves() {
        let path = arm().path(Parameter::Tension(0), [0.0, 0.71], &PathOptions::default()).unwrap();
        let shapes = picked(&path, 1e3);
        assert!(shapes.len() >= 7, "{}", shapes.len());
        for shape in &shapes[1..shapes.len() - 1] {
            let shown = 1e3 * shape.value;
            assert!((shown / 10.0 - (shown / 10.0).round()).abs() < 1e-9, "{shown} mN");
            let mut pulled = arm();
            pulled.cables[0].tension = shape.value;
            let solved = Outline::new(&pulled.solve().unwrap(), 0);
            let [[ax, ay], [bx, by]] = [shape.drawn.outline.tip(), solved.tip()];
            let off = (bx - ax).hypot(by - ay) / 245.0;
            // A line of 1 pt on a page on which an arm is 400 pt long.
            assert!(off < 2.5e-3, "{off} of the length at {shown} mN");
        }
        let values: Vec<f64> = shapes.iter().map(|shape| shape.value).collect();
        assert_eq!(values[0], 0.0);
        assert!((values[values.len() - 1] - 0.71).abs() < 1e-12, "the ends are those that were asked for");
        assert!(values.windows(2).all(|w| w[0] < w[1]), "{values:?}");
    }

    #[test]
    fn a_path_of_few_points_has_shapes() {
        let options = PathOptions { most: 1, ..PathOptions::default() };
        let path = arm().path(Parameter::Tension(0), [0.0, 0.7], &options).unwrap();
        assert_eq!(picked(&path, 1.0).len(), 1);
    }
}
