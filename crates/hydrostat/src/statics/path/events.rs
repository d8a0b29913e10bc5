//! Limit points and bifurcations between two points of a path, and the branches that cross there.

use hydrostat_bvp::continuation::location::{RegulaFalsi, inverse_interpolation};

use super::step_control::StepControl;
use super::stepper::{Fraction, Point, StepOutcome, Stepper, weighed};
use super::traced::{Change, Traced, Turn};
use crate::statics::border::NewtonStep;
use crate::statics::stability::Stability;

/// The dlambda/ds that stands for zero in the tangent of a branch that crosses.
const MODE: f64 = 1e-9;

/// About a, b and c: the couple that the search for a mode begins with. In the plane that about c alone acts.
const FIRST_COUPLE: Turn = [0.3, 0.6, 1.0];

/// Where two eigenvalues pass zero together, the root of the determinant next to it, over that at the ends of the step:
/// six halvings leave a sixty-fourth of the way.
const SMALL: f64 = 0.25;

/// The dlambda/ds that counts as zero at a limit point: the error of the fraction is its square, the error of the
/// shape is linear in it.
const LEVEL: f64 = 1e-6;

impl<E: Traced> Stepper<'_, E> {
    /// The point where the fraction is extreme between two whose tangents rise and fall, or fall and rise, and its
    /// fraction. The engine is left at it.
    pub(super) fn limit_point(
        &mut self,
        here: &Point<E>,
        next: &Point<E>,
        step: f64,
        control: StepControl,
    ) -> (Point<E>, f64) {
        let control = StepControl { straightness: -1.0, accuracy: 1e-6_f64.min(control.accuracy), ..control };
        let up = here.dlambda_ds.signum();
        let mut search = RegulaFalsi::between((0.0, here.dlambda_ds.abs()), (step, up * next.dlambda_ds));
        let mut best: Option<Point<E>> = None;
        for _ in 0..25 {
            let middle = search.place(0.1);
            match self.advance(here, middle, control) {
                Ok((point, StepOutcome::Regular)) => {
                    let dlambda_ds = up * point.dlambda_ds;
                    search.put(middle, dlambda_ds);
                    if best.as_ref().is_none_or(|b| up * point.fraction > up * b.fraction) {
                        best = Some(point);
                    }
                    if dlambda_ds.abs() < LEVEL {
                        break;
                    }
                }
                _ => search.shorten(middle),
            }
            if search.width() < 1e-7 {
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
    pub(super) fn bifurcation(
        &mut self,
        here: &Point<E>,
        next: &Point<E>,
        step: f64,
        control: StepControl,
    ) -> Point<E> {
        let mut found = self.bifurcation_between(here, next.clone(), step, control);
        let mut from = here.clone();
        self.bifurcations_welcome = true;
        for _ in 0..4 {
            let before = found.fraction;
            let Some((cut, again)) = self.bifurcation_on_half_the_mesh(&from, step, control) else { break };
            found = again;
            from = cut;
            if (found.fraction - before).abs() < 1e-7 {
                break;
            }
        }
        self.bifurcations_welcome = false;
        found.dlambda_ds = found.dlambda_ds.abs() * here.dlambda_ds.signum();
        found
    }

    /// `from` with its elements halved, and the bifurcation nearby.
    fn bifurcation_on_half_the_mesh(
        &mut self,
        from: &Point<E>,
        step: f64,
        control: StepControl,
    ) -> Option<(Point<E>, Point<E>)> {
        self.engine.restore(&from.state);
        let finer = self.engine.mesh().cut(2);
        self.engine.remap_to(finer);
        self.set(from.fraction);
        self.engine.newton(1e-9, 12).ok()?;
        let mut cut = self.point(from.fraction).ok()?;
        let orientation = self.orientation;
        // On this mesh the point may be beyond the bifurcation.
        let side = cut.dlambda_ds.signum() * from.dlambda_ds.signum();
        self.orientation *= side;
        cut.dlambda_ds *= side;
        let mut reach = step;
        let mut found = None;
        while found.is_none() && reach < 2.0 {
            if let Ok((end, StepOutcome::Bifurcation)) = self.advance(&cut, side * reach, control) {
                found = Some(self.bifurcation_between(&cut, end, side * reach, control));
            }
            reach *= 3.0;
        }
        self.orientation = orientation;
        found.map(|found| (cut, found))
    }

    /// The bifurcation between two points, on their mesh. Corrections are of little worth right at it, so that it is
    /// found from the determinants around it, which vary smoothly: by inverse interpolation.
    fn bifurcation_between(&mut self, here: &Point<E>, next: Point<E>, step: f64, control: StepControl) -> Point<E> {
        // Determinants over that of the first point.
        let unit = here.size;
        let signed = |point: &Point<E>, sign: f64| sign * (point.size - unit).exp();
        let mut samples = vec![(here.clone(), signed(here, 1.0)), (next.clone(), signed(&next, -1.0))];
        let (mut low, mut high) = (0.0, step);
        for _ in 0..6 {
            if (high - low).abs() < 1e-4 {
                break;
            }
            let middle = 0.5 * (low + high);
            match self.advance(here, middle, control) {
                Ok((point, StepOutcome::Bifurcation)) => {
                    high = middle;
                    samples.push((point.clone(), signed(&point, -1.0)));
                }
                Ok((point, StepOutcome::Regular)) => {
                    low = middle;
                    samples.push((point.clone(), signed(&point, 1.0)));
                }
                Err(_) => break,
            }
        }
        self.between(samples, next)
    }

    /// The point between two where two eigenvalues pass zero together. The sign of the determinant does not see that,
    /// but the root of its size, with a sign by the count of unstable directions, passes zero smoothly. `None` where it
    /// keeps its size: there a pair of complex eigenvalues has passed, and nothing crosses.
    pub(super) fn double_bifurcation(
        &mut self,
        here: &Point<E>,
        next: &Point<E>,
        step: f64,
        counts: [usize; 2],
        control: StepControl,
    ) -> Option<Point<E>> {
        let unit = here.size;
        let root = |point: &Point<E>, sign: f64| sign * (0.5 * (point.size - unit)).exp();
        let mut samples = vec![(here.clone(), root(here, 1.0)), (next.clone(), root(next, -1.0))];
        let ends = samples[0].1.abs().min(samples[1].1.abs());
        let (mut low, mut high) = (0.0, step);
        for _ in 0..6 {
            let middle = 0.5 * (low + high);
            let Ok((point, StepOutcome::Regular)) = self.advance(here, middle, control) else { break };
            let sign = match self.count_at(&point) {
                Some(count) if count == counts[0] => 1.0,
                Some(count) if count == counts[1] => -1.0,
                _ => break,
            };
            if sign > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
            let value = root(&point, sign);
            samples.push((point, value));
        }
        let least = samples.iter().fold(f64::INFINITY, |m, (_, value)| m.min(value.abs()));
        (least < SMALL * ends).then(|| self.between(samples, next.clone()))
    }

    /// The number of unstable directions at a point, where it is established and none is marginal.
    fn count_at(&mut self, point: &Point<E>) -> Option<usize> {
        self.engine.restore(&point.state);
        let shape = self.engine.read(point.error)?;
        E::stability(&shape).and_then(Stability::directions)
    }

    /// The point at which what is given of samples is zero, by inverse interpolation from the nearest.
    fn between(&mut self, mut samples: Vec<(Point<E>, f64)>, next: Point<E>) -> Point<E> {
        samples.sort_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        samples.truncate(6);
        let places: Vec<(f64, f64)> = samples.iter().map(|(point, value)| (point.fraction, *value)).collect();
        let place = inverse_interpolation(&places);
        let Some((nearest, _)) = samples.into_iter().next() else { return next };
        let fraction = if place.is_finite() { place } else { nearest.fraction };
        self.predict(&nearest, (fraction - nearest.fraction) / nearest.dlambda_ds);
        self.set(fraction);
        Point { state: self.engine.state(), fraction, ..nearest }
    }

    /// The first point of the branch that crosses at `at`, to one side.
    pub(super) fn switch(&mut self, at: &Point<E>, side: f64, control: StepControl) -> Option<Point<E>> {
        self.engine.restore(&at.state);
        let (mode, tensions) = self.null_mode(at)?;
        for distance in [0.05, 0.02, 0.1, 0.2] {
            // Off the bifurcation along the mode, with the load free.
            let from = Point {
                state: at.state.clone(),
                fraction: at.fraction,
                response: mode.clone(),
                turns: self.engine.turns(&mode),
                tensions: tensions.clone(),
                margins: at.margins.clone(),
                dlambda_ds: side * MODE,
                oriented: true,
                size: 0.0,
                clearance: 0.0,
                error: at.error,
            };
            let mut fraction = self.predict(&from, distance);
            if self.correct(&from, &mut fraction).is_err() {
                continue;
            }
            let accurate =
                self.keep_accuracy(Some(&from), &mut Fraction::Free(fraction), [control.accuracy, control.accuracy]);
            if accurate.is_err() {
                continue;
            }
            let fraction = self.engine.range_fraction();
            let Ok(mut point) = self.point(fraction) else { continue };
            // Away from the bifurcation.
            let along: f64 = {
                let mesh = point.mesh();
                let both = point.tangent_on(mesh).zip(from.tangent_on(mesh));
                both.zip(self.weights()).map(|((a, b), w)| weighed(w, &a, &b)).sum()
            };
            if along < 0.0 {
                self.orientation = -self.orientation;
                point.dlambda_ds = -point.dlambda_ds;
            }
            return Some(point);
        }
        None
    }

    /// What moves at a bifurcation while the load does not, in the length of the path's metric over [`MODE`]:
    /// inverse iteration with loads that turn the arm.
    fn null_mode(&mut self, at: &Point<E>) -> Option<(E::Change, Vec<f64>)> {
        let mesh = self.engine.mesh().clone();
        let mut round = NewtonStep::default();
        let mut couple: Box<dyn Fn(f64) -> Turn> = Box::new(|s| FIRST_COUPLE.map(|couple| couple * (1.0 + s)));
        for _ in 0..4 {
            self.engine.impose_couple(Some(&couple));
            let solved = self.engine.linearise_at_strokes(true, &mut round);
            self.engine.impose_couple(None);
            solved.ok()?;
            let turns = self.engine.turns(&round.response);
            let largest = turns.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
            let mesh = mesh.clone();
            couple = Box::new(move |s| {
                let e = mesh.element_of(s);
                let x = (s - mesh.nodes()[e]) / mesh.step(e);
                std::array::from_fn(|k| (turns[e][k] + x * (turns[e + 1][k] - turns[e][k])) / largest)
            });
        }
        let (mut mode, [_, mut tensions]) = (round.response, round.tension);
        // Less its part along the branch that is known.
        let weights = self.weights();
        let along: Vec<Turn> = at.tangent_on(&mesh).collect();
        let product = |a: &[Turn], b: &[Turn]| -> f64 {
            a.iter().zip(b).zip(&weights).map(|((a, b), w)| weighed(*w, a, b)).sum()
        };
        let known = product(&along, &along);
        if known > 1e-6 {
            let factor = -product(&self.engine.turns(&mode), &along) * at.dlambda_ds / known;
            mode.add(&at.response, factor);
            tensions.iter_mut().zip(&at.tensions).for_each(|(own, along)| *own += factor * along);
        }
        let turns = self.engine.turns(&mode);
        let square = product(&turns, &turns);
        let scale = 1.0 / (MODE * square.sqrt());
        mode.scale(scale);
        for tension in &mut tensions {
            *tension *= scale;
        }
        (square > 0.0 && square.is_finite()).then_some((mode, tensions))
    }
}
