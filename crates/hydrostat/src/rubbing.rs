//! Solves with friction of the cables: rounds of shape and turns, see [`crate::friction`].

use crate::configuration::Configuration;
use crate::engine::{First, Trouble};
use crate::friction::Grip;
use crate::path::{Travelled, name_limit};
use crate::solve::Solver;
use crate::verdict::{Phase, SolveError, Verdict, VerdictKind};

/// Most rounds at one level of friction and load.
const ROUNDS: usize = 60;
/// Largest turn of the tip (rad) by which one step of friction or load may change the shape.
const LARGEST_TURN: f64 = 0.3;

impl Solver {
    /// From the equilibrium without friction; where there is none, along the tensions with it.
    pub(crate) fn solve_rubbing(&mut self) -> Result<Configuration, SolveError> {
        self.engine.set_grip(None);
        let commanded = self.engine.equations.arm().is_commanded();
        match self.solve_smooth() {
            Ok(_) => self.raise_friction().map_err(|_| self.no_equilibrium(self.last_verdict(Some(1.0)))),
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
    fn raise_friction(&mut self) -> Result<Configuration, Trouble> {
        let (mut share, mut step) = (0.0, 1.0_f64);
        loop {
            let kept = self.engine.state();
            let next = (share + step).min(1.0);
            match self.rub(next) {
                Ok(configuration) if next == 1.0 => return Ok(configuration),
                Ok(_) => share = next,
                Err(trouble) => {
                    self.engine.restore(&kept);
                    step *= 0.5;
                    if step < 1e-3 {
                        return Err(trouble);
                    }
                }
            }
        }
    }

    /// Tensions from the share `from`, where there is an equilibrium without friction, to whole with friction. `None`
    /// when there is no start either.
    fn raise_tensions(&mut self, from: f64) -> Result<Configuration, Option<Verdict>> {
        self.engine.set_phase(Phase::Tension, from);
        if self.engine.settle(self.options.tol, First::Rough).is_err() {
            return Err(None);
        }
        let mut last = self.raise_friction().map_err(|_| None)?;
        let (mut share, mut step) = (from, 0.1 * from);
        while share < 1.0 {
            let kept = self.engine.state();
            let next = (share + step).min(1.0);
            self.engine.set_phase(Phase::Tension, next);
            match self.rub(1.0) {
                Ok(configuration) => {
                    share = next;
                    step *= 1.5;
                    last = configuration;
                }
                Err(trouble) => {
                    self.engine.restore(&kept);
                    step *= 0.4;
                    if step < 1e-6 {
                        let residual = self.engine.last;
                        let spent = self.engine.spent();
                        let (kind, s) = match spent {
                            Some(_) => (VerdictKind::NotFound, None),
                            None => name_limit(&mut self.engine, Some(&trouble), residual),
                        };
                        let phase = Phase::Tension;
                        return Err(Some(Verdict { kind, phase, load_fraction: share, s, residual, spent }));
                    }
                }
            }
        }
        Ok(last)
    }

    /// Rounds of turns and shape at `share` of the friction until the tip stays.
    fn rub(&mut self, share: f64) -> Result<Configuration, Trouble> {
        let tol = self.options.tol;
        let start = self.engine.tip_angle();
        let sign = self.engine.determinant().sign;
        for _ in 0..ROUNDS {
            self.engine.refresh().map_err(Trouble::Section)?;
            let grip = Grip::of(&self.engine, share).map_err(Trouble::Section)?;
            self.engine.set_grip(Some(&grip));
            let (before, angle) = (self.engine.tip, self.engine.tip_angle());
            let estimate = self.engine.settle(tol, First::Warm)?;
            let same_branch = self.engine.determinant().sign == sign;
            if (self.engine.tip_angle() - start).abs() > LARGEST_TURN || !same_branch {
                return Err(Trouble::Stalled(self.engine.tip_angle() - start));
            }
            let moved = (self.engine.tip[0] - before[0]).hypot(self.engine.tip[1] - before[1]);
            let turned = (self.engine.tip_angle() - angle).abs();
            if moved.max(0.1 * turned) <= 0.2 * tol {
                return self.read(estimate + moved, Travelled::default());
            }
        }
        Err(Trouble::Stalled(f64::INFINITY))
    }
}
