//! What a solver keeps of its last solve, to start from and to read.

use crate::rod::arm::Arm;
use crate::statics::configuration::Tip;
use crate::statics::prediction::Recent;
use crate::statics::snap::Snap;
use crate::statics::warm_start::{WarmStart, loads};

/// What is known of the equilibrium that an engine holds, beside the solution itself.
#[derive(Debug, Clone)]
pub(crate) struct Solved<T = Tip> {
    /// Estimated error of the tip position, over L.
    pub(crate) estimate: f64,
    /// Load steps of the path to it.
    pub(crate) steps: usize,
    /// The snaps on that path.
    pub(crate) snaps: Vec<Snap<T>>,
    /// Whether it is stable, where the path knows.
    pub(crate) stable: Option<bool>,
}

/// What is kept beside the solution that an engine holds, whose unknowns are `G` and whose tips are `T`.
#[derive(Debug, Clone)]
pub(crate) struct Kept<G, T = Tip> {
    /// Whether the solution is a start for a warm start.
    pub(crate) is_start: bool,
    /// Sign of the determinant of the last configuration.
    pub(crate) sign: f64,
    /// The solution, if it is that of the present loads.
    pub(crate) solved: Option<Solved<T>>,
    /// The loads that the solution belongs to, and the solutions before it: for [`WarmStart::Ramp`].
    loads: Vec<f64>,
    before: Recent<G>,
}

impl<G, T> Kept<G, T> {
    pub(crate) fn new() -> Self {
        Self { is_start: false, sign: 1.0, solved: None, loads: Vec::new(), before: Recent::new() }
    }

    /// The solution is none any more.
    pub(crate) fn forget(&mut self) {
        (self.is_start, self.solved) = (false, None);
    }

    /// To be called before the loads of `arm` change: the solution is that of the loads before. Loads are kept for rows
    /// of tables, which have them in regular steps; a control loop has not, and copies would cost it allocations.
    pub(crate) fn leave(&mut self, arm: &Arm, policy: WarmStart) {
        if self.solved.take().is_some() && policy == WarmStart::Ramp {
            self.loads = loads(arm);
        }
    }

    /// Whether the engine was left with the solution of other loads than those of the next solve.
    pub(crate) fn is_of_other_loads(&self) -> bool {
        !self.loads.is_empty()
    }

    /// Solutions before with the steps from them that lead to the loads of `arm`, see [`Recent::steps`].
    pub(crate) fn steps(&self, arm: &Arm) -> Vec<(&G, f64)> {
        self.before.steps(&self.loads, &loads(arm))
    }

    /// Keeps `solution`, that of the loads before.
    pub(crate) fn push(&mut self, solution: G) {
        self.before.push(self.loads.clone(), solution);
    }

    /// The solution is that of the present loads, by a warm start: its estimated error, over L.
    pub(crate) fn settle(&mut self, estimate: f64) -> f64 {
        let stable = if self.sign < 0.0 { Some(false) } else { None };
        self.is_start = true;
        self.solved = Some(Solved { estimate, steps: 0, snaps: Vec::new(), stable });
        estimate
    }
}

/// What both solvers do alike with the equilibrium that their engine holds: they have the same names for the same
/// things, and other shapes, tips and errors.
macro_rules! holds_equilibrium {
    ($shape:ty, $tip:ty, $error:ty) => {
        /// The engine's solution is that of the present loads, read as `configuration`.
        fn remember(&mut self, configuration: &$shape) {
            self.kept.solved = Some($crate::statics::kept::Solved {
                estimate: configuration.error_estimate / self.engine.equations.units.length,
                steps: configuration.statistics.load_steps,
                snaps: configuration.snaps.clone(),
                stable: configuration.stable,
            });
        }

        /// To be called before loads change.
        fn leave_loads(&mut self) {
            self.kept.leave(self.engine.equations.arm(), self.options.warm_start);
        }

        /// Moves the engine's solution on to the present loads by the solutions before it.
        fn predict(&mut self) {
            let solution = self.engine.solution.clone();
            let steps = self.kept.steps(self.engine.equations.arm());
            self.engine.lead_on(&steps);
            self.kept.push(solution);
        }

        /// Solves where loads changed since the last solve. The configuration, if it had to be read for that.
        pub(crate) fn refresh(&mut self) -> Result<Option<$shape>, $error> {
            if self.kept.solved.is_some() || self.settle_warm().is_some() {
                return Ok(None);
            }
            if self.kept.is_of_other_loads() {
                // A row must not depend on what a row before it left behind.
                *self = Self::new(&self.arm().clone(), self.options)?;
            }
            self.solve().map(Some)
        }

        /// The tip under the present loads.
        fn updated(&mut self) -> Result<Answer<$tip>, $error> {
            let found = match self.refresh()? {
                Some(found) => found,
                None => match self.answer() {
                    Some(answer) => return Ok(answer),
                    None => self.solve()?,
                },
            };
            let (error_estimate, statistics) = (found.error_estimate, found.statistics);
            Ok(Answer { tip: found.tip(), error_estimate, statistics })
        }

        /// The tip that the engine holds.
        fn answer(&self) -> Option<Answer<$tip>> {
            let solved = self.kept.solved.as_ref()?;
            let error_estimate = solved.estimate * self.engine.equations.units.length;
            let (tip, statistics) = (self.engine.tip()?, self.engine.statistics(solved.steps));
            Some(Answer { tip, error_estimate, statistics })
        }

        /// The configuration under the present loads.
        fn configured(&mut self) -> Result<$shape, $error> {
            if let Some(found) = self.refresh()? {
                return Ok(found);
            }
            match self.read_again() {
                Some(found) => Ok(found),
                None => self.solve(),
            }
        }

        /// The engine's solution of the present loads, read.
        fn read_again(&mut self) -> Option<$shape> {
            let $crate::statics::kept::Solved { estimate, steps, snaps, stable } = self.kept.solved.clone()?;
            let mut found = self.read(estimate, PathSummary { steps, snaps, ..PathSummary::default() }).ok()?;
            found.stable = stable;
            Some(found)
        }
    };
}
pub(crate) use holds_equilibrium;
