//! From an arm to its configuration.

use crate::arm::Arm;
use crate::configuration::{Configuration, Statistics};
use crate::engine::{Engine, M, Trouble};
use crate::verdict::{NoEquilibrium, Phase, SolveError, Verdict, VerdictKind};

/// How a solve is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Error of the tip position over L that is asked for, in [1e-12, 1e-2].
    pub tol: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { tol: 1e-8 }
    }
}

/// Solves one arm, again and again as its loads change.
#[derive(Debug, Clone)]
pub struct Solver {
    engine: Engine,
    options: Options,
}

impl Solver {
    /// A solver for `arm`.
    ///
    /// # Errors
    /// [`SolveError::Arm`], [`SolveError::Option`].
    pub fn new(arm: &Arm, options: Options) -> Result<Self, SolveError> {
        arm.check()?;
        if !(options.tol >= 1e-12 && options.tol <= 1e-2) {
            return Err(SolveError::Option { option: "tol", value: options.tol, expected: "in [1e-12, 1e-2]" });
        }
        Ok(Self { engine: Engine::new(arm), options })
    }

    /// Solves from the unloaded arm.
    ///
    /// # Errors
    /// [`SolveError::NoEquilibrium`].
    pub fn solve(&mut self) -> Result<Configuration, SolveError> {
        let result = self.engine.start_from_cables(8).and_then(|()| self.engine.settle(self.options.tol));
        match result {
            Ok(estimate) => self.read(estimate),
            Err(trouble) => Err(Self::give_up(&trouble)),
        }
    }

    fn read(&mut self, estimate: f64) -> Result<Configuration, SolveError> {
        let statistics = Statistics {
            elements: self.engine.solution.mesh.elements(),
            stages: M,
            newton_rounds: self.engine.rounds,
            meshes: self.engine.meshes,
            load_steps: 0,
            evaluations: self.engine.equations.evaluations,
        };
        let length = self.engine.equations.units.length;
        Configuration::read(&mut self.engine, estimate * length, statistics)
            .map_err(|failure| Self::give_up(&Trouble::Section(failure)))
    }

    fn give_up(trouble: &Trouble) -> SolveError {
        let (s, residual) = match trouble {
            Trouble::Section(f) => (Some(f.s), f64::NAN),
            Trouble::Stalled(r) | Trouble::Mesh(r) => (None, *r),
            Trouble::Singular => (None, f64::NAN),
        };
        let verdict = Verdict { kind: VerdictKind::NotFound, phase: Phase::Tension, load_fraction: 0.0, s, residual };
        SolveError::NoEquilibrium(Box::new(NoEquilibrium { verdict, last_good: None }))
    }
}

impl Arm {
    /// The configuration of this arm under its loads, to a tip error of 1e-8 L.
    ///
    /// # Errors
    /// See [`SolveError`].
    pub fn solve(&self) -> Result<Configuration, SolveError> {
        Solver::new(self, Options::default())?.solve()
    }
}
