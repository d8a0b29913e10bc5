//! One step along a branch of equilibria: predict along the tangent, correct normal to it, refine, and
//! refuse what may be another branch or beyond a fold.

use hydrostat_bvp::{Correction, Mesh, Solution};

use super::{CORNER, EVEN, FINEST, LOOSE, MANY, Pace, SYMMETRIC};
use crate::engine::{Engine, HOP, M, State, Trouble, roughly, solve};
use crate::equilibrium::{N, Q};
use crate::verdict::Phase;

#[derive(Clone)]
pub(super) struct Point {
    pub(super) state: State,
    pub(super) fraction: f64,
    /// Change a unit of load.
    pub(super) response: Correction<N, M, Q>,
    /// The fraction's part of the unit tangent, positive where the load rises along the path: `rise`
    /// times `response` is the rest.
    pub(super) rise: f64,
    /// Natural logarithm of the size of the determinant.
    pub(super) size: f64,
    /// Estimated error of the tip over L.
    pub(super) error: f64,
}

impl Point {
    pub(super) fn mesh(&self) -> &Mesh {
        &self.state.solution.mesh
    }

    /// theta of the tangent at the nodes of another mesh: linear interpolation is enough to orient.
    pub(super) fn tangent_on<'a>(&'a self, mesh: &'a Mesh) -> impl Iterator<Item = f64> + 'a {
        let (own, response) = (self.mesh(), &self.response.nodes);
        mesh.nodes().iter().map(move |s| {
            let e = own.element_of(*s);
            let x = (s - own.nodes()[e]) / own.step(e);
            self.rise * (response[e][0] + x * (response[e + 1][0] - response[e][0]))
        })
    }

    pub(super) fn is_symmetric(&self) -> bool {
        (self.rise * self.response.largest(0)).abs() < SYMMETRIC
    }
}

/// Whether corrections may change the load.
#[derive(Debug, Clone, Copy)]
pub(super) enum Load {
    Fixed(f64),
    Free(f64),
}

impl Load {
    fn fraction(self) -> f64 {
        match self {
            Self::Fixed(fraction) | Self::Free(fraction) => fraction,
        }
    }
}

/// What the fraction of a path is a fraction of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Along {
    /// The loads of a phase.
    Phase(Phase),
    /// The range of a parameter, see [`crate::equilibrium::Equilibrium::vary`].
    Range,
}

pub(super) struct Stepper<'e> {
    pub(super) engine: &'e mut Engine,
    along: Along,
    /// Fractions on which a step lands that would pass them.
    bounds: [f64; 2],
    correction: Correction<N, M, Q>,
    response: Correction<N, M, Q>,
    pub(super) last_trouble: Option<Trouble>,
    /// Sign of the climb times that of the determinant.
    pub(super) orientation: f64,
    /// Fraction of the last solution that was refused as the next point because it is on a branch of
    /// the other orientation.
    pub(super) opposite: Option<f64>,
    /// Whether a tangent that points the other way is taken for another branch that crosses, however long the step.
    crossings_welcome: bool,
    /// The last estimate of the tip's error over L.
    error: f64,
}

/// How the path goes on at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Turn {
    /// Smoothly, or round a corner that a kink of the load makes.
    None,
    /// Smoothly, but the determinant's sign says backwards: another branch crosses.
    Crossing,
}

impl<'e> Stepper<'e> {
    pub(super) fn new(engine: &'e mut Engine, along: Along, bounds: [f64; 2]) -> Self {
        engine.on_a_path = true;
        Self {
            engine,
            along,
            bounds,
            correction: Correction::default(),
            response: Correction::default(),
            last_trouble: None,
            orientation: 1.0,
            opposite: None,
            crossings_welcome: false,
            error: LOOSE,
        }
    }

    /// Does `work`, or comes back to where it started from; whether it was done.
    pub(super) fn or_back(&mut self, work: impl FnOnce(&mut Self) -> Result<(), Trouble>) -> bool {
        let before = self.engine.state();
        let done = work(self).is_ok();
        if !done {
            self.engine.restore(&before);
        }
        done
    }

    pub(super) fn set(&mut self, fraction: f64) {
        match self.along {
            Along::Phase(phase) => self.engine.set_phase(phase, fraction),
            Along::Range => self.engine.equations.set_share(fraction),
        }
    }

    fn linearise(&mut self) -> Result<(), Trouble> {
        let engine = &mut *self.engine;
        engine.linearise(true)?;
        solve(&engine.system, &engine.solution, 1, &mut self.response);
        Ok(())
    }

    /// Length of theta's change in the metric of the path: its root mean square along the arm.
    pub(super) fn weights(&self) -> Vec<f64> {
        let mesh = &self.engine.solution.mesh;
        let n = mesh.elements();
        (0..=n)
            .map(|i| {
                let left = if i > 0 { mesh.step(i - 1) } else { 0.0 };
                let right = if i < n { mesh.step(i) } else { 0.0 };
                0.5 * (left + right)
            })
            .collect()
    }

    /// The point here. Its tangent is oriented by the determinant, whose sign times that of the climb is
    /// the same all along a branch, round folds and corners alike, until another branch crosses.
    pub(super) fn point(&mut self, fraction: f64) -> Result<Point, Trouble> {
        self.linearise()?;
        let weights = self.weights();
        let square: f64 = weights.iter().zip(&self.response.nodes).map(|(w, z)| w * z[0] * z[0]).sum();
        let norm = (1.0 + square).sqrt();
        if !norm.is_finite() {
            return Err(Trouble::Singular);
        }
        let determinant = self.engine.system.determinant();
        let rise = self.orientation * determinant.sign / norm;
        let (state, response) = (self.engine.state(), self.response.clone());
        Ok(Point { state, fraction, response, rise, size: determinant.log, error: self.error })
    }

    /// Moves the solution from `here` along its tangent.
    fn predict(&mut self, here: &Point, step: f64) -> f64 {
        self.engine.restore(&here.state);
        let climb = step * here.rise;
        self.engine.solution.add(&here.response, climb);
        here.fraction + climb
    }

    pub(super) fn advance(&mut self, here: &Point, step: f64, pace: Pace) -> Result<(Point, Turn), Trouble> {
        let mut fraction = self.predict(here, step);
        let [low, high] = self.bounds;
        if fraction >= high || fraction <= low {
            return self.land(here, if fraction >= high { high } else { low }, pace);
        }
        let from = self.engine.solution.clone();
        self.correct(here, &mut fraction)?;
        self.arrive(here, &from, Load::Free(fraction), step, pace)
    }

    /// A step that ends at a given fraction; near a fold that is refused, and steps shrink.
    pub(super) fn land(&mut self, here: &Point, fraction: f64, pace: Pace) -> Result<(Point, Turn), Trouble> {
        let step = (fraction - here.fraction) / here.rise;
        self.predict(here, step);
        self.set(fraction);
        let from = self.engine.solution.clone();
        roughly(self.engine.newton(1e-6, 9))?;
        let (end, turn) = self.arrive(here, &from, Load::Fixed(fraction), step, pace)?;
        if turn == Turn::None && end.rise * here.rise < 0.0 {
            return Err(Trouble::Stalled(step));
        }
        Ok((end, turn))
    }

    /// Newton on the plane through the present state that the tangent at `here` is normal to.
    fn correct(&mut self, here: &Point, fraction: &mut f64) -> Result<(), Trouble> {
        let normal: Vec<f64> =
            here.tangent_on(&self.engine.solution.mesh).zip(self.weights()).map(|(t, w)| t * w).collect();
        let mut before = f64::INFINITY;
        for round in 0..12 {
            self.set(*fraction);
            self.linearise()?;
            solve(&self.engine.system, &self.engine.solution, 0, &mut self.correction);
            let dot = |c: &Correction<N, M, Q>| -> f64 { normal.iter().zip(&c.nodes).map(|(n, z)| n * z[0]).sum() };
            let slide = -dot(&self.correction) / (dot(&self.response) + here.rise);
            self.engine.system.quadratures(&mut self.engine.spans);
            self.engine.tip = [0.0; Q];
            for (i, span) in self.engine.spans.iter_mut().enumerate() {
                for q in 0..Q {
                    span[q] += self.correction.by_element[i][q] + slide * self.response.by_element[i][q];
                    self.engine.tip[q] += span[q];
                }
            }
            self.engine.solution.add(&self.correction, 1.0);
            self.engine.solution.add(&self.response, slide);
            *fraction += slide;
            let size = (0..self.correction.nodes.len())
                .map(|i| (self.correction.nodes[i][0] + slide * self.response.nodes[i][0]).abs())
                .fold(slide.abs(), f64::max);
            self.engine.last = size;
            if !size.is_finite() || size > 1.0 || (round > 3 && size > 10.0 * before) {
                return Err(Trouble::Stalled(size));
            }
            before = size;
            if size < 1e-6 {
                break;
            }
        }
        self.set(*fraction);
        // Across a kink corrections can hop between two points that are nearer than a path needs.
        if before > HOP { Err(Trouble::Stalled(before)) } else { Ok(()) }
    }

    /// The point that corrections have led to from the prediction `from`, if it may be trusted to be on
    /// the same branch and no fold was stepped over.
    fn arrive(
        &mut self,
        here: &Point,
        from: &Solution<N, M>,
        mut load: Load,
        step: f64,
        pace: Pace,
    ) -> Result<(Point, Turn), Trouble> {
        let moved = largest_turn(from, &self.engine.solution);
        if moved > 0.15 {
            return Err(Trouble::Stalled(moved));
        }
        // What the mesh is off by must not be mistaken for a turn of the path.
        let accuracy = (0.02 * step.abs()).max(FINEST).min(pace.accuracy);
        self.keep_accuracy(Some(here), &mut load, [accuracy, pace.accuracy])?;
        self.engine.ends_fine()?;
        let next = self.point(load.fraction())?;
        let cosine = self.cosine(here, &next);
        let crossing = cosine < 0.0 && -cosine >= pace.straightness;
        // Nothing turns on a symmetric branch but the load: bifurcations are passed at once, because
        // near them rounding would lead off the branch.
        if crossing && (self.crossings_welcome || step.abs() < CORNER || (here.is_symmetric() && next.is_symmetric())) {
            return Ok((next, Turn::Crossing));
        }
        let strict = if self.changed_sides(here) > 0.05 { 0.1 } else { 1.0 };
        let straight = 1.0 - cosine <= strict * (1.0 - pace.straightness);
        if crossing {
            self.opposite = Some(next.fraction);
        }
        if step.abs() > CORNER && !(straight && self.unevenness(here, &next, step) <= strict * EVEN) {
            return Err(Trouble::Stalled(cosine - 2.0));
        }
        Ok((next, Turn::None))
    }

    /// The share of the arm that the stream meets from the other side than at `here`. Where much of a
    /// slender arm in line with the stream changes sides within a step, it may do so in a snap.
    fn changed_sides(&self, here: &Point) -> f64 {
        let mesh = &self.engine.solution.mesh;
        let gauss = &self.engine.system.gauss;
        let (before, now) = (&here.state.equations, &self.engine.equations);
        let mut share = 0.0;
        for (k, s) in self.engine.equations.stations().iter().enumerate() {
            let e = here.mesh().element_of(*s);
            let w = gauss.cardinals((s - here.mesh().nodes()[e]) / here.mesh().step(e));
            let length = mesh.step(k / M) * gauss.b[k % M];
            for side in 0..2 {
                let then: f64 = (0..M).map(|j| w[j] * before.switch(e, j, side)).sum();
                if then * now.switch(k / M, k % M, side) < 0.0 {
                    share += length;
                }
            }
        }
        share
    }

    /// How far the climb from `a` to `b` over the way there is from the mean of the climbs at both,
    /// over the steeper. Unlike an angle it sees a fold that takes little load.
    fn unevenness(&self, a: &Point, b: &Point, step: f64) -> f64 {
        // A step that ended past a bound is landed backwards.
        let climb = (b.fraction - a.fraction) * step.signum();
        let mut square = climb * climb;
        let gauss = &self.engine.system.gauss;
        for ((s, z), w) in b.mesh().nodes().iter().zip(&b.state.solution.nodes).zip(self.weights()) {
            let before = a.state.solution.state_in(gauss, a.mesh().element_of(*s), *s);
            square += w * (z[0] - before[0]).powi(2);
        }
        let mean = climb / square.sqrt();
        (mean - 0.5 * (a.rise + b.rise)).abs() / a.rise.abs().max(b.rise.abs())
    }

    /// Refines when the mesh no longer carries `accuracy`, or, where that would take very many elements,
    /// what is `enough`.
    pub(super) fn keep_accuracy(
        &mut self,
        here: Option<&Point>,
        load: &mut Load,
        [accuracy, enough]: [f64; 2],
    ) -> Result<(), Trouble> {
        // Nodes follow the kinks, so that corrections do not hop across them, and as closely as this
        // accuracy needs, or it could not be had on any mesh.
        let resolution = 0.1 * accuracy.sqrt();
        for _ in 0..3 {
            let kinks = self.engine.kinks(resolution.max(10.0 * accuracy));
            if !self.engine.pin(&kinks, resolution) {
                break;
            }
            self.correct_again(here, load)?;
        }
        for _ in 0..4 {
            let estimate = self.engine.estimate(accuracy)?;
            self.error = estimate;
            let many = self.engine.solution.mesh.elements() > MANY;
            if estimate <= accuracy || (many && estimate <= enough) {
                return Ok(());
            }
            self.engine.refine(0.05 * accuracy, 2 * MANY);
            self.correct_again(here, load)?;
        }
        Ok(())
    }

    /// Corrections on another mesh: near a fold there may be no solution at the load that the last mesh
    /// had one at, so the load stays free unless the path ends there.
    fn correct_again(&mut self, here: Option<&Point>, load: &mut Load) -> Result<(), Trouble> {
        match (load, here) {
            (Load::Free(fraction), Some(here)) => self.correct(here, fraction),
            _ => roughly(self.engine.newton(1e-6, 12)),
        }
    }

    fn cosine(&self, a: &Point, b: &Point) -> f64 {
        // Both on the mesh of `b`, lengths included: a coarse mesh measures them coarsely.
        let (mut both, mut first, mut second) = (a.rise * b.rise, a.rise * a.rise, b.rise * b.rise);
        for ((carried, own), w) in a.tangent_on(b.mesh()).zip(b.tangent_on(b.mesh())).zip(self.weights()) {
            both += w * own * carried;
            first += w * carried * carried;
            second += w * own * own;
        }
        both / (first * second).sqrt()
    }

    /// The point where the fraction is extreme between two whose tangents rise and fall, or fall and rise, and its
    /// fraction. The engine is left at it.
    pub(super) fn limit_point(&mut self, here: &Point, next: &Point, step: f64, pace: Pace) -> (Point, f64) {
        let pace = Pace { straightness: -1.0, accuracy: 1e-6_f64.min(pace.accuracy), ..pace };
        let up = here.rise.signum();
        let (mut low, mut low_rise) = (0.0, here.rise.abs());
        let (mut high, mut high_rise) = (step, up * next.rise);
        let mut best: Option<Point> = None;
        for _ in 0..25 {
            let share = (low_rise / (low_rise - high_rise)).clamp(0.1, 0.9);
            let middle = low + share * (high - low);
            match self.advance(here, middle, pace) {
                Ok((point, Turn::None)) => {
                    let rise = up * point.rise;
                    if rise < 0.0 {
                        (high, high_rise) = (middle, rise);
                    } else {
                        (low, low_rise) = (middle, rise);
                    }
                    if best.as_ref().is_none_or(|b| up * point.fraction > up * b.fraction) {
                        best = Some(point);
                    }
                    if rise.abs() < 1e-6 {
                        break;
                    }
                }
                _ => high = middle,
            }
            if high - low < 1e-7 {
                break;
            }
        }
        let limit = best.filter(|b| up * b.fraction > up * here.fraction).unwrap_or_else(|| here.clone());
        self.engine.restore(&limit.state);
        self.set(limit.fraction.min(self.bounds[1]));
        let extreme = up * (up * limit.fraction).max(up * next.fraction);
        (limit, extreme)
    }

    /// The point between two where the determinant changes sign while the branch goes on.
    ///
    /// The shape may be exact on a mesh, as that of a straight arm is, on which its determinant is not: the mesh is
    /// cut until the place stays.
    pub(super) fn bifurcation(&mut self, here: &Point, next: &Point, step: f64, pace: Pace) -> Point {
        let mut found = self.crossing_between(here, next.clone(), step, pace);
        let mut from = here.clone();
        self.crossings_welcome = true;
        for _ in 0..4 {
            let before = found.fraction;
            let Some((cut, again)) = self.crossing_on_half_the_mesh(&from, step, pace) else { break };
            found = again;
            from = cut;
            if (found.fraction - before).abs() < 1e-7 {
                break;
            }
        }
        self.crossings_welcome = false;
        found.rise = found.rise.abs() * here.rise.signum();
        found
    }

    /// `from` with its elements halved, and the crossing nearby.
    fn crossing_on_half_the_mesh(&mut self, from: &Point, step: f64, pace: Pace) -> Option<(Point, Point)> {
        self.engine.restore(&from.state);
        let finer = self.engine.solution.mesh.cut(2);
        self.engine.move_to(finer);
        self.set(from.fraction);
        self.engine.newton(1e-9, 12).ok()?;
        let mut cut = self.point(from.fraction).ok()?;
        let orientation = self.orientation;
        // On this mesh the point may be beyond the crossing.
        let side = cut.rise.signum() * from.rise.signum();
        self.orientation *= side;
        cut.rise *= side;
        let mut reach = step;
        let mut found = None;
        while found.is_none() && reach < 2.0 {
            if let Ok((end, Turn::Crossing)) = self.advance(&cut, side * reach, pace) {
                found = Some(self.crossing_between(&cut, end, side * reach, pace));
            }
            reach *= 3.0;
        }
        self.orientation = orientation;
        found.map(|found| (cut, found))
    }

    /// The crossing between two points, on their mesh. Corrections are of little worth right at it, so that it is found
    /// from the determinants around it, which vary smoothly: by inverse interpolation.
    fn crossing_between(&mut self, here: &Point, next: Point, step: f64, pace: Pace) -> Point {
        // Determinants over that of the first point.
        let unit = here.size;
        let signed = |point: &Point, sign: f64| sign * (point.size - unit).exp();
        let mut samples = vec![(here.clone(), signed(here, 1.0)), (next.clone(), signed(&next, -1.0))];
        let (mut low, mut high) = (0.0, step);
        for _ in 0..6 {
            if (high - low).abs() < 1e-4 {
                break;
            }
            let middle = 0.5 * (low + high);
            match self.advance(here, middle, pace) {
                Ok((point, Turn::Crossing)) => {
                    high = middle;
                    samples.push((point.clone(), signed(&point, -1.0)));
                }
                Ok((point, Turn::None)) => {
                    low = middle;
                    samples.push((point.clone(), signed(&point, 1.0)));
                }
                Err(_) => break,
            }
        }
        samples.sort_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        samples.truncate(6);
        let mut column: Vec<f64> = samples.iter().map(|(point, _)| point.fraction).collect();
        for order in 1..samples.len() {
            for k in 0..samples.len() - order {
                let (a, b) = (samples[k].1, samples[k + order].1);
                column[k] = (b * column[k] - a * column[k + 1]) / (b - a);
            }
        }
        let Some((nearest, _)) = samples.into_iter().next() else { return next };
        let fraction = if column[0].is_finite() { column[0] } else { nearest.fraction };
        self.predict(&nearest, (fraction - nearest.fraction) / nearest.rise);
        self.set(fraction);
        Point { state: self.engine.state(), fraction, ..nearest }
    }

    /// The first point of the branch that crosses at `at`, to one side.
    pub(super) fn switch(&mut self, at: &Point, side: f64, pace: Pace) -> Option<Point> {
        self.engine.restore(&at.state);
        let mode = self.null_mode(at)?;
        for distance in [0.05, 0.02, 0.1, 0.2] {
            // Off the bifurcation along the mode, with the load free.
            let from = Point {
                state: at.state.clone(),
                fraction: at.fraction,
                response: mode.clone(),
                rise: side * MODE,
                size: 0.0,
                error: at.error,
            };
            let mut fraction = self.predict(&from, distance);
            if self.correct(&from, &mut fraction).is_err() {
                continue;
            }
            let accurate = self.keep_accuracy(Some(&from), &mut Load::Free(fraction), [pace.accuracy, pace.accuracy]);
            if accurate.is_err() {
                continue;
            }
            let fraction = self.engine.equations.share();
            let Ok(mut point) = self.point(fraction) else { continue };
            // Away from the bifurcation.
            let along: f64 = {
                let mesh = point.mesh().clone();
                let away: Vec<f64> = from.tangent_on(&mesh).collect();
                point.tangent_on(&mesh).zip(away).zip(self.weights()).map(|((a, b), w)| a * b * w).sum()
            };
            if along < 0.0 {
                self.orientation = -self.orientation;
                point.rise = -point.rise;
            }
            return Some(point);
        }
        None
    }

    /// What moves at a bifurcation while the load does not, in the length of the path's metric over [`MODE`]:
    /// inverse iteration with loads that turn the arm.
    fn null_mode(&mut self, at: &Point) -> Option<Correction<N, M, Q>> {
        let mesh = self.engine.solution.mesh.clone();
        let mut mode = Correction::default();
        let mut couple: Box<dyn Fn(f64) -> f64> = Box::new(|s| 1.0 + s);
        for _ in 0..4 {
            self.engine.equations.impose_couple(Some(&couple));
            let solved = self.engine.linearise(true);
            self.engine.equations.impose_couple(None);
            solved.ok()?;
            solve(&self.engine.system, &self.engine.solution, 1, &mut mode);
            let nodes: Vec<f64> = mode.nodes.iter().map(|z| z[0]).collect();
            let largest = nodes.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            let mesh = mesh.clone();
            couple = Box::new(move |s| {
                let e = mesh.element_of(s);
                let x = (s - mesh.nodes()[e]) / mesh.step(e);
                (nodes[e] + x * (nodes[e + 1] - nodes[e])) / largest
            });
        }
        // Less its part along the branch that is known.
        let weights = self.weights();
        let along: Vec<f64> = at.tangent_on(&mesh).collect();
        let dot: f64 = mode.nodes.iter().zip(&along).zip(&weights).map(|((z, t), w)| z[0] * t * w).sum();
        let known: f64 = along.iter().zip(&weights).map(|(t, w)| t * t * w).sum();
        if known > 1e-6 {
            mode.add(&at.response, -dot * at.rise / known);
        }
        let square: f64 = mode.nodes.iter().zip(&weights).map(|(z, w)| z[0] * z[0] * w).sum();
        mode.scale(1.0 / (MODE * square.sqrt()));
        (square > 0.0 && square.is_finite()).then_some(mode)
    }
}

/// The climb that stands for none in the tangent of a branch that crosses.
const MODE: f64 = 1e-9;

fn largest_turn(a: &Solution<N, M>, b: &Solution<N, M>) -> f64 {
    if a.nodes.len() != b.nodes.len() {
        return 0.0;
    }
    a.nodes.iter().zip(&b.nodes).fold(0.0, |m, (a, b)| f64::max(m, (a[0] - b[0]).abs()))
}
