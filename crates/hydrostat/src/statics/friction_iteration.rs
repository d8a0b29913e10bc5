//! Solves with friction of the cables: rounds of shape and turns, see [`crate::statics::friction`].
//!
//! A round multiplies what the turns are off by with about the friction times the turn, and by its negative while
//! reeling in: less tension bends less. Above one that leads nowhere by itself, so that the turns for the next round
//! are a mixture of those before and of those that they led to, in which what is off is least (Anderson 1965,
//! "Iterative procedures for nonlinear integral equations").

use std::sync::Arc;

use crate::numerics::elimination::solved;
use crate::statics::configuration::Configuration;
use crate::statics::engine::Trouble;
use crate::statics::friction::{CapstanFactors, WrapAngles, exponents};
use crate::statics::path::{PathSummary, name_limit};
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::solve::Solver;
use crate::statics::verdict::{Phase, SolveError, Verdict, VerdictKind};

/// Most rounds at one level of friction and load.
const ROUNDS: usize = 40;
/// Rounds that are mixed.
const DEPTH: usize = 5;
/// Largest turn of the tip (rad) by which one step of friction or load may change the shape.
const LARGEST_TURN: f64 = 0.3;
/// The least step of friction or load.
const LEAST: f64 = 1e-6;
/// Halvings of elements that confirm the turns.
const CUTS: usize = 4;
/// Intervals at whose ends turns are compared.
const INTERVALS: u32 = 32;

impl Solver {
    /// From the equilibrium without friction; where there is none, along the tensions with it.
    pub(crate) fn solve_with_friction(&mut self) -> Result<Configuration, SolveError> {
        self.engine.set_capstan(None);
        let commanded = self.engine.equations.arm().is_commanded();
        match self.solve_smooth() {
            Ok(smooth) => {
                let mut with_friction = self.raise_friction().map_err(|verdict| self.no_equilibrium(verdict))?;
                with_friction.snaps = smooth.snaps;
                Ok(with_friction)
            }
            Err(SolveError::NoEquilibrium(no)) if no.verdict.phase == Phase::Tension && !commanded => {
                // Friction spares the tip, which may carry more with it.
                let kept = self.engine.state();
                self.raise_tensions(0.9 * no.verdict.load_fraction).map_err(|verdict| {
                    if let Some(verdict) = verdict {
                        return self.no_equilibrium(verdict);
                    }
                    self.engine.restore(&kept);
                    SolveError::NoEquilibrium(no)
                })
            }
            Err(error) => Err(error),
        }
    }

    /// Friction from none to whole at the present loads.
    fn raise_friction(&mut self) -> Result<Configuration, Verdict> {
        let (mut fraction, mut step) = (0.0, 1.0_f64);
        loop {
            let kept = self.engine.state();
            let next = (fraction + step).min(1.0);
            match self.rub(next).map(|estimate| if next == 1.0 { self.confirm(estimate) } else { estimate }) {
                Ok(estimate) if next == 1.0 => {
                    return self
                        .read(estimate, PathSummary::default())
                        .map_err(|trouble| self.limit(Phase::Friction, fraction, &trouble));
                }
                Ok(_) => {
                    fraction = next;
                    step *= 1.5;
                }
                Err(trouble) => {
                    self.engine.restore(&kept);
                    step *= 0.4;
                    if step < LEAST {
                        return Err(self.limit(Phase::Friction, fraction, &trouble));
                    }
                }
            }
        }
    }

    /// Tensions from the fraction `from`, where there is an equilibrium without friction, to the requested ones with
    /// friction. `None` when there is no start.
    fn raise_tensions(&mut self, from: f64) -> Result<Configuration, Option<Verdict>> {
        self.engine.set_phase(Phase::Tension, from);
        if self.engine.settle(self.options.tol, First::Rough).is_err() {
            return Err(None);
        }
        let mut last = self.raise_friction()?;
        let (mut fraction, mut step) = (from, 0.1 * from);
        while fraction < 1.0 {
            let kept = self.engine.state();
            let next = (fraction + step).min(1.0);
            self.engine.set_phase(Phase::Tension, next);
            match self.rub(1.0).map(|estimate| if next == 1.0 { self.confirm(estimate) } else { estimate }) {
                Ok(estimate) => {
                    fraction = next;
                    step *= 1.5;
                    last = self
                        .read(estimate, PathSummary::default())
                        .map_err(|trouble| Some(self.limit(Phase::Tension, fraction, &trouble)))?;
                }
                Err(trouble) => {
                    self.engine.restore(&kept);
                    step *= 0.4;
                    if step < LEAST {
                        return Err(Some(self.limit(Phase::Tension, fraction, &trouble)));
                    }
                }
            }
        }
        Ok(last)
    }

    /// Why it does not go on from where the engine is. A limit of the sections is one that this shape is at: rounds
    /// that lead nowhere can pass any.
    fn limit(&mut self, phase: Phase, load_fraction: f64, trouble: &Trouble) -> Verdict {
        let (residual, spent) = (self.engine.last, self.engine.spent());
        let (mut kind, mut s) = (VerdictKind::NotFound, None);
        if spent.is_none() {
            let named = name_limit(&mut self.engine, Some(trouble));
            let of_rounds = matches!(trouble, Trouble::Section(_));
            if !of_rounds || name_limit(&mut self.engine, None).0 == named.0 {
                (kind, s) = named;
            }
        }
        Verdict { kind, phase, load_fraction, s, residual, spent }
    }

    /// What the tip is off by (over L) beside the estimate of the shape with its turns given: the turns are those of a
    /// mesh, too. They are found again on elements of half the length, until the tip moves by less than the tolerance;
    /// the shape on those stays.
    fn confirm(&mut self, estimate: f64) -> f64 {
        let (tol, mut estimate) = (self.options.tol, estimate);
        for _ in 0..CUTS {
            let before = (self.engine.tip, self.engine.state());
            let cut = self.engine.solution.mesh.cut(2);
            self.engine.remap_to(cut);
            let Ok(again) = self.rub(1.0) else {
                self.engine.restore(&before.1);
                break;
            };
            let moved = (self.engine.tip[0] - before.0[0]).hypot(self.engine.tip[1] - before.0[1]);
            // What halves of elements leave is less than what they moved.
            estimate = again.max(moved);
            if moved <= tol {
                break;
            }
        }
        estimate
    }

    /// Rounds of turns and shape at `fraction` of the friction until the tip stays; its estimated error over L.
    fn rub(&mut self, fraction: f64) -> Result<f64, Trouble> {
        let tol = self.options.tol;
        let start = self.engine.tip_angle();
        let sign = self.engine.determinant().sign;
        let mut rounds = Rounds::new(fraction, exponents(self.engine.equations.arm(), fraction));
        for _ in 0..ROUNDS {
            let ease = rounds.go_on(self.engine.wrap_angles().map_err(Trouble::Section)?);
            self.engine.set_capstan(Some(&rounds.capstan()));
            let (before, angle) = (self.engine.tip, self.engine.tip_angle());
            let estimate = self.engine.settle(tol, First::Warm)?;
            let same_branch = self.engine.determinant().sign == sign;
            if (self.engine.tip_angle() - start).abs() > LARGEST_TURN || !same_branch {
                return Err(Trouble::Stalled(self.engine.tip_angle() - start));
            }
            let moved = (self.engine.tip[0] - before[0]).hypot(self.engine.tip[1] - before[1]);
            let turned = (self.engine.tip_angle() - angle).abs();
            if moved.max(0.1 * turned) <= 0.2 * ease * tol {
                // A slack cable has no tension that kinks could change.
                let pulls = |c: usize| self.engine.equations.tension(c) != 0.0;
                let own = rounds.exponents.iter().enumerate();
                let pulling: Vec<f64> = own.map(|(c, exponent)| if pulls(c) { *exponent } else { 0.0 }).collect();
                let inside = rounds.shapes.last().map_or(0.0, |shape| shape.off_nodes(&pulling));
                return Ok(estimate + moved + inside);
            }
        }
        Err(Trouble::Stalled(f64::INFINITY))
    }
}

/// Shapes and the turns that they were solved with.
struct Rounds {
    fraction: f64,
    exponents: Vec<f64>,
    /// Of all shapes, in order; the first is that before the first round.
    shapes: Vec<Arc<WrapAngles>>,
    /// What each round's shape was solved with, as weights of the shapes before it.
    used: Vec<Vec<f64>>,
    /// What the turns of each round's shape differ by from those, as exponents.
    off: Vec<Vec<f64>>,
}

impl Rounds {
    fn new(fraction: f64, exponents: Vec<f64>) -> Self {
        Self { fraction, exponents, shapes: Vec::new(), used: Vec::new(), off: Vec::new() }
    }

    /// What the next shape is to be solved with.
    fn capstan(&self) -> CapstanFactors {
        let weights = self.used.last().into_iter().flatten();
        let shapes = weights.zip(&self.shapes).filter(|(weight, _)| **weight != 0.0);
        let shapes = shapes.map(|(weight, shape)| (*weight, Arc::clone(shape))).collect();
        CapstanFactors::new(self.fraction, self.exponents.clone(), shapes)
    }

    /// Takes the turns of the last round's shape, and chooses those for the next; the fraction of the residual that
    /// these make up for.
    fn go_on(&mut self, turns: WrapAngles) -> f64 {
        self.shapes.push(Arc::new(turns));
        let count = self.shapes.len();
        let Some(last) = self.used.last() else {
            self.used.push(vec![1.0]);
            return 1.0;
        };
        let own = self.exponents_of(&unit(count - 1));
        self.off.push(own.iter().zip(self.exponents_of(last)).map(|(own, used)| own - used).collect());
        let ease = self.ease();
        let mut next = vec![0.0; count];
        let first = self.off.len().saturating_sub(DEPTH);
        for (j, alpha) in (first..).zip(least_off(&self.off[first..])) {
            for (weight, used) in next.iter_mut().zip(&self.used[j]) {
                *weight += alpha * (1.0 - ease) * used;
            }
            next[j + 1] += alpha * ease;
        }
        self.used.push(next);
        ease
    }

    /// Friction times turn of a mixture of shapes, along all cables that rub.
    fn exponents_of(&self, weights: &[f64]) -> Vec<f64> {
        let mut out = Vec::new();
        for (c, exponent) in self.exponents.iter().enumerate().filter(|(_, exponent)| **exponent != 0.0) {
            for k in 0..=INTERVALS {
                let s = f64::from(k) / f64::from(INTERVALS);
                let turned = weights.iter().zip(&self.shapes).filter(|(weight, _)| **weight != 0.0);
                out.push(exponent * turned.map(|(weight, shape)| weight * shape.at(c, s, true)).sum::<f64>());
            }
        }
        out
    }

    /// The fraction of the residual that a round is to make up for: where less tension bends clearly less, about as
    /// much as would be right if all of the arm did the same.
    fn ease(&self) -> f64 {
        let Some(shape) = self.shapes.last() else { return 1.0 };
        let steep = |(c, exponent): (usize, &f64)| -exponent * shape.at(c, 1.0, true);
        let steepest = self.exponents.iter().enumerate().map(steep).fold(0.0, f64::max);
        if steepest > 0.5 { 1.0 / (1.0 + steepest) } else { 1.0 }
    }
}

/// The weight of one alone.
fn unit(k: usize) -> Vec<f64> {
    (0..=k).map(|j| if j == k { 1.0 } else { 0.0 }).collect()
}

/// Weights with the sum one for which what is off is least.
fn least_off(off: &[Vec<f64>]) -> Vec<f64> {
    let alone = unit(off.len() - 1);
    let Some((last, before)) = off.split_last() else { return alone };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let from: Vec<Vec<f64>> = before.iter().map(|own| last.iter().zip(own).map(|(a, b)| a - b).collect()).collect();
    let row = |(j, own): (usize, &Vec<f64>)| {
        // So little that it only counts where two rounds did the same.
        let slack = 1e-12 * dot(own, own);
        let by = from.iter().enumerate().map(|(k, other)| dot(own, other) + if j == k { slack } else { 0.0 });
        (by.collect(), [dot(own, last), 0.0])
    };
    let Some((found, _)) = solved(from.iter().enumerate().map(row).collect()) else { return alone };
    let mut weights: Vec<f64> = found.iter().map(|[weight, _]| *weight).collect();
    weights.push(1.0 - weights.iter().sum::<f64>());
    if weights.iter().all(|weight| weight.is_finite()) { weights } else { alone }
}
