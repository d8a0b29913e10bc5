//! The direct solve of an arm in space, else the path; verdicts.

use super::configuration::SpatialConfiguration;
use super::engine::{Engine, State};
use super::equations::Guess;
use super::tip::{SpatialSnap, SpatialTip};
use crate::numerics::distance;
use crate::rod::arm::{Arm, ArmError};
use crate::statics::engine::{Trouble, WORK, led_on};
use crate::statics::path::loaded::Loaded as _;
use crate::statics::path::{
    PathSummary, StepControl, Stopped, follow, follow_on, follow_range, no_equilibrium, no_equilibrium_in_range,
};
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::solve::Options;
use crate::statics::verdict::{NoEquilibrium, Phase, SolveError, Verdict, VerdictKind};

/// How far (over L) the tip may move when the end of a path is made accurate.
const MOVED: f64 = 0.05;

/// Why a solve in space gives no configuration at the loads asked for.
pub type SpatialError = SolveError<SpatialConfiguration, SpatialTip>;

/// A verdict with the last configuration before it, in space.
pub type NoSpatialEquilibrium = NoEquilibrium<SpatialConfiguration, SpatialTip>;

impl From<SolveError> for SpatialError {
    fn from(error: SolveError) -> Self {
        match error {
            SolveError::Arm(error) => Self::Arm(error),
            SolveError::Option { option, value, expected } => Self::Option { option, value, expected },
            SolveError::NoEquilibrium(_) => Self::Arm(ArmError::OnlyInPlane { what: "a planar solve" }),
        }
    }
}

/// Solves one arm in space, again and again as its tensions change.
#[derive(Debug, Clone)]
pub struct SpatialSolver {
    pub(super) engine: Engine,
    pub(super) options: Options,
    /// Whether the engine holds a configuration at whole loads.
    settled: bool,
    /// Whether it is that of the present tensions and strokes.
    solved: bool,
    /// Sign of the determinant of the last configuration.
    sign: f64,
}

impl SpatialSolver {
    /// A solver for `arm`; one without [`Arm::space`] may leave its plane.
    ///
    /// # Errors
    /// [`SpatialError::Arm`], [`SpatialError::Option`].
    pub fn new(arm: &Arm, options: Options) -> Result<Self, SpatialError> {
        let mut arm = arm.clone();
        arm.space.get_or_insert_default();
        arm.check()?;
        options.check()?;
        Ok(Self { engine: Engine::new(&arm), options, settled: false, solved: false, sign: 1.0 })
    }

    /// The arm, with the tensions that were set last.
    pub fn arm(&self) -> &Arm {
        self.engine.equations.arm()
    }

    /// What holds the last configuration.
    pub(crate) fn engine_mut(&mut self) -> &mut Engine {
        &mut self.engine
    }

    /// Solves from the unloaded arm.
    ///
    /// # Errors
    /// [`SpatialError::NoEquilibrium`].
    pub fn solve(&mut self) -> Result<SpatialConfiguration, SpatialError> {
        self.solved = false;
        let found = self.solve_anew();
        self.solved = found.is_ok();
        found
    }

    fn solve_anew(&mut self) -> Result<SpatialConfiguration, SpatialError> {
        self.settled = false;
        self.engine.reset_statistics();
        self.engine.allowed = WORK;
        self.engine.release_strokes();
        let solved = self.solve_tensions()?;
        if self.arm().cables.iter().all(|cable| cable.stroke.is_none()) {
            return Ok(solved);
        }
        self.settled = false;
        self.solve_strokes(solved)
    }

    /// At given tensions, the cables with a commanded stroke slack.
    fn solve_tensions(&mut self) -> Result<SpatialConfiguration, SpatialError> {
        self.engine.equations.set_phase(Phase::Tension, 1.0);
        let tol = self.options.tol;
        let engine = &mut self.engine;
        let direct = engine
            .start_from_cables(8)
            .and_then(|()| engine.approach(tol))
            .and_then(|()| engine.settle(tol, First::Fair));
        if let Ok(estimate) = direct
            && !self.engine.needs_continuation()
            && let Ok(configuration) = self.read(estimate, PathSummary::default())
        {
            self.settled = true;
            self.sign = 1.0;
            return Ok(configuration);
        }
        self.solve_along_the_path()
    }

    /// Sets all tensions (N), in the order of the cables.
    ///
    /// # Errors
    /// [`SpatialError::Arm`] when their number is wrong or one of them is.
    pub fn set_tensions(&mut self, tensions: &[f64]) -> Result<(), SpatialError> {
        self.engine.equations.arm().check_tensions(tensions)?;
        self.engine.equations.take_tensions(tensions);
        self.engine.check_equations.take_tensions(tensions);
        self.solved = false;
        Ok(())
    }

    /// Takes the loads of an arm with the same sections and cables; tensions of cables whose stroke is commanded stay.
    pub(crate) fn set_loads(&mut self, arm: &Arm) -> Result<(), SpatialError> {
        arm.check()?;
        let mut arm = arm.clone();
        for (new, own) in arm.cables.iter_mut().zip(&self.arm().cables).filter(|(new, _)| new.stroke.is_some()) {
            new.tension = own.tension;
        }
        self.take_loads(&arm);
        Ok(())
    }

    /// [`SpatialSolver::set_loads`] of an arm that was checked and commands no strokes.
    pub(super) fn take_loads(&mut self, arm: &Arm) {
        self.engine.equations.set_loads(arm);
        self.engine.check_equations.set_loads(arm);
        self.solved = false;
    }

    /// Solves again from the last configuration, after a small change of tensions; falls back to
    /// [`SpatialSolver::solve`].
    ///
    /// # Errors
    /// [`SpatialError::NoEquilibrium`].
    pub fn resolve(&mut self) -> Result<SpatialConfiguration, SpatialError> {
        match self.resolve_warm() {
            Some(configuration) => Ok(configuration),
            None => self.solve(),
        }
    }

    /// A few rounds from the last configuration; `None` where that is no way to the answer.
    pub(crate) fn resolve_warm(&mut self) -> Option<SpatialConfiguration> {
        let estimate = self.settle_warm()?;
        self.settled = false;
        let configuration = self.read(estimate, PathSummary::default()).ok()?;
        (self.settled, self.solved) = (true, true);
        Some(configuration)
    }

    /// The rounds of [`SpatialSolver::resolve_warm`]: the estimated error, over L.
    pub(super) fn settle_warm(&mut self) -> Option<f64> {
        if !self.settled {
            return None;
        }
        self.settled = false;
        self.engine.reset_statistics();
        self.engine.allowed = WORK;
        let before = self.engine.tip;
        let estimate = self.engine.settle(self.options.tol, First::Warm).ok()?;
        let stays = self.engine.system.determinant().sign == self.sign && distance(&before, &self.engine.tip) < 0.2;
        self.settled = stays;
        stays.then_some(estimate)
    }

    /// Solves for the present tensions where that was not done yet.
    pub(super) fn be_solved(&mut self) -> Result<(), SpatialError> {
        if self.solved { Ok(()) } else { self.resolve().map(|_| ()) }
    }

    /// Follows the path of `docs/model.md`, section 7, whatever a direct solve would give.
    pub(crate) fn solve_along_the_path(&mut self) -> Result<SpatialConfiguration, SpatialError> {
        let travelled = follow(&mut self.engine, StepControl::BRISK, self.options.snaps);
        self.end_of_path(travelled)
    }

    /// Follows the path on to whole loads from the engine's equilibrium at a fraction of a phase.
    pub(crate) fn solve_on(&mut self, from: (Phase, f64)) -> Result<SpatialConfiguration, SpatialError> {
        self.begin_anew();
        let travelled = follow_on(&mut self.engine, from, StepControl::BRISK, self.options.snaps);
        let solved = self.end_of_path(travelled);
        self.engine.allowed = usize::MAX;
        solved
    }

    /// The engine's equilibrium, read again.
    pub(crate) fn resettle(&mut self) -> Result<SpatialConfiguration, SpatialError> {
        let settled = self.engine.settle(self.options.tol, First::Warm);
        if let Ok(estimate) = settled
            && let Ok(configuration) = self.read(estimate, PathSummary::default())
        {
            return Ok(configuration);
        }
        Err(self.last_verdict(Phase::Tension, Vec::new()))
    }

    /// Follows the engine's range to its end, from the engine's equilibrium at a fraction of it, behind a limit point
    /// down to a lowest one.
    pub(crate) fn solve_along_range(&mut self, from: [f64; 2]) -> Result<SpatialConfiguration, SpatialError> {
        self.begin_anew();
        let travelled = follow_range(&mut self.engine, from, StepControl::BRISK, self.options.snaps);
        let solved = match travelled {
            Ok(travelled) => self.end_of_path(Ok(travelled)),
            Err(stopped) => {
                let no = no_equilibrium_in_range(&mut self.engine, stopped, self.options.tol);
                Err(SpatialError::NoEquilibrium(no.into()))
            }
        };
        self.engine.allowed = usize::MAX;
        solved
    }

    fn begin_anew(&mut self) {
        (self.settled, self.solved) = (false, false);
        self.engine.reset_statistics();
        self.engine.allowed = WORK;
    }

    /// The answer at the end of a path, which the engine is at.
    fn end_of_path(
        &mut self,
        travelled: Result<PathSummary<SpatialTip>, Stopped<Engine>>,
    ) -> Result<SpatialConfiguration, SpatialError> {
        let travelled = match travelled {
            Ok(travelled) => travelled,
            Err(stopped) => return Err(self.no_equilibrium(stopped)),
        };
        let before = self.engine.tip;
        let settled = self.engine.settle(self.options.tol, First::Rough);
        let moved = distance(&before, &self.engine.tip);
        let (bifurcations, snaps) = (travelled.bifurcations, travelled.snaps.clone());
        if let Ok(estimate) = settled
            && moved < MOVED
            && let Ok(mut configuration) = self.read(estimate, travelled)
        {
            let sign = self.engine.system.determinant().sign;
            if sign < 0.0 {
                configuration.stable = Some(false);
            }
            self.settled = bifurcations == 0 && snaps.is_empty();
            self.sign = sign;
            return Ok(configuration);
        }
        Err(self.last_verdict(Phase::Tension, snaps))
    }

    /// Nothing could be made of the end of the path of a phase.
    pub(super) fn last_verdict(&mut self, phase: Phase, snaps: Vec<SpatialSnap>) -> SpatialError {
        let (residual, spent) = (self.engine.last, self.engine.spent());
        let verdict = Verdict { kind: VerdictKind::NotFound, phase, load_fraction: 1.0, s: None, residual, spent };
        self.no_equilibrium(Stopped { snaps, ..verdict.into() })
    }

    /// The verdict with the last good shape, which the engine holds.
    pub(super) fn no_equilibrium(&mut self, stopped: Stopped<Engine>) -> SpatialError {
        self.engine.allowed = usize::MAX;
        SpatialError::NoEquilibrium(no_equilibrium(&mut self.engine, stopped, self.options.tol).into())
    }

    pub(super) fn read(
        &mut self,
        estimate: f64,
        travelled: PathSummary<SpatialTip>,
    ) -> Result<SpatialConfiguration, Trouble> {
        let statistics = self.engine.statistics(travelled.steps);
        let length = self.engine.equations.units.length;
        let mut read = SpatialConfiguration::read(&mut self.engine, estimate * length, statistics)?;
        read.snaps = travelled.snaps;
        Ok(read)
    }
}

impl Engine {
    /// Takes shape and loads of a configuration.
    pub(crate) fn take_shape_of(&mut self, configuration: &SpatialConfiguration) {
        *self = configuration.engine().clone();
        self.allowed = usize::MAX;
    }

    /// Moves the solution on by each factor times its way from that solution before, one after the other, and nodes on
    /// kinks with it. Left as it is where one of them does not correspond node by node.
    pub(super) fn lead_on(&mut self, steps: &[(&Guess, f64)]) {
        let Some(next) = led_on(&self.solution, steps) else { return };
        let moved = next.mesh != self.solution.mesh;
        self.solution = next;
        if moved {
            self.equations.place_on(&self.system.gauss, &self.solution);
        }
    }

    /// The equilibrium under the engine's loads near a shape, if `accepted` makes something of it: else the engine
    /// stays as it is.
    pub(crate) fn settle_near<T>(
        &mut self,
        shape: Guess,
        tol: f64,
        accepted: impl FnOnce(SpatialConfiguration) -> Option<T>,
    ) -> Option<T> {
        let kept: State = self.state();
        self.solution = shape;
        self.equations.place_on(&self.system.gauss, &self.solution);
        let settled = self.settle(tol, First::Rough);
        let statistics = self.statistics(0);
        let length = self.equations.units.length;
        let read = settled.and_then(|estimate| SpatialConfiguration::read(self, estimate * length, statistics));
        let out = read.ok().and_then(accepted);
        if out.is_none() {
            self.restore(&kept);
        }
        out
    }
}
