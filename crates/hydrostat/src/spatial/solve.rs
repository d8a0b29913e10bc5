//! The direct solve of an arm in space, else the path; verdicts.

use super::configuration::SpatialConfiguration;
use super::engine::{Engine, State};
use super::equations::Guess;
use super::row::SpatialRow;
use super::tip::{SpatialSnap, SpatialTip};
use crate::numerics::distance;
use crate::rod::arm::{Arm, ArmError};
use crate::statics::engine::{Trouble, WORK, led_on};
use crate::statics::kept::{Kept, holds_equilibrium};
use crate::statics::path::loaded::Loaded as _;
use crate::statics::path::{
    PathSummary, StepControl, Stopped, follow, follow_on, follow_range, no_equilibrium, no_equilibrium_in_range,
};
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::row::Wanted;
use crate::statics::shape::Pose as _;
use crate::statics::solve::{Answer, Options};
use crate::statics::verdict::{NoEquilibrium, Phase, SolveError, Verdict, VerdictKind};
use crate::statics::warm_start::{FARTHEST_ON_RAMP, WarmStart, alike, differ_in_loads, may_be_followed};

/// A tip that moves further (over L) than this in a warm start has left what a small change of the loads does.
const FARTHEST: f64 = 0.2;

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

/// Solves one arm in space, again and again as its loads change, as [`crate::Solver`] does in the plane.
#[derive(Debug, Clone)]
pub struct SpatialSolver {
    pub(super) engine: Engine,
    pub(super) options: Options,
    kept: Kept<Guess, SpatialTip>,
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
        Ok(Self { engine: Engine::new(&arm), options, kept: Kept::new() })
    }

    /// The arm, with the loads that were set last.
    pub fn arm(&self) -> &Arm {
        self.engine.equations.arm()
    }

    /// What holds the last configuration.
    pub(crate) fn engine_mut(&mut self) -> &mut Engine {
        self.kept.forget();
        &mut self.engine
    }

    /// Solves from the unloaded arm.
    ///
    /// # Errors
    /// [`SpatialError::NoEquilibrium`].
    pub fn solve(&mut self) -> Result<SpatialConfiguration, SpatialError> {
        self.begin_anew();
        self.engine.release_strokes();
        let mut solved = self.solve_tensions()?;
        if self.arm().is_commanded() {
            self.kept.forget();
            solved = self.solve_strokes(solved)?;
            self.remember(&solved);
        }
        Ok(solved)
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
            (self.kept.is_start, self.kept.sign) = (true, 1.0);
            self.remember(&configuration);
            return Ok(configuration);
        }
        self.solve_along_the_path()
    }

    holds_equilibrium!(SpatialConfiguration, SpatialTip, SpatialError);

    /// Sets all tensions (N), in the order of the cables. Strokes are not commanded any more.
    ///
    /// # Errors
    /// [`SpatialError::Arm`] when their number is wrong or one of them is.
    pub fn set_tensions(&mut self, tensions: &[f64]) -> Result<(), SpatialError> {
        if self.arm().is_commanded() {
            // What was solved with strokes is no start.
            let mut arm = self.arm().clone();
            arm.set_tensions(tensions)?;
            return self.set_arm(&arm);
        }
        self.arm().check_tensions(tensions)?;
        self.leave_loads();
        self.engine.equations.take_tensions(tensions);
        self.engine.check_equations.take_tensions(tensions);
        Ok(())
    }

    /// Takes another arm. One of the same geometry and material, with the same cables commanded by their strokes, is
    /// solved from the last shape by [`SpatialSolver::update`]; any other starts anew. One without [`Arm::space`] may
    /// leave its plane.
    ///
    /// # Errors
    /// [`SpatialError::Arm`] when it is none; the arm before stays then.
    pub fn set_arm(&mut self, arm: &Arm) -> Result<(), SpatialError> {
        let mut arm = arm.clone();
        arm.space.get_or_insert_default();
        arm.check()?;
        let own = self.arm();
        let is_start = if self.options.warm_start == WarmStart::Ramp {
            may_be_followed(own) && differ_in_loads(own, &arm)
        } else {
            alike(own, &arm) && own.material == arm.material && own.density == arm.density
        };
        if !is_start {
            *self = Self::new(&arm, self.options)?;
            return Ok(());
        }
        for (new, own) in arm.cables.iter_mut().zip(&own.cables).filter(|(new, _)| new.stroke.is_some()) {
            new.tension = own.tension;
        }
        self.leave_loads();
        self.engine.equations.set_loads(&arm);
        self.engine.check_equations.set_loads(&arm);
        Ok(())
    }

    /// Solves from the last shape, after a small change of the loads: a few Newton rounds on the mesh there is. Solves
    /// from the unloaded arm as [`SpatialSolver::solve`] does where nothing was solved before and where the arm moves
    /// further than a small change of the loads moves it. [`Options::warm_start`] says which equilibrium it may give.
    ///
    /// # Errors
    /// [`SpatialError::NoEquilibrium`].
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Options, Profile, SpatialSolver};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// let offset = Profile::linear(0.005, 0.001);
    /// arm.cables.push(Cable { angle: 2.0.into(), ..Cable::new("left", offset) }.pulled(0.1)); // rad, N
    /// let mut solver = SpatialSolver::new(&arm, Options::default())?;
    /// let before = solver.update()?.tip;
    /// solver.set_tensions(&[0.101])?;
    /// assert!(solver.update()?.tip.z > before.z);
    /// # Ok::<(), hydrostat::SpatialError>(())
    /// ```
    pub fn update(&mut self) -> Result<Answer<SpatialTip>, SpatialError> {
        self.updated()
    }

    /// The configuration under the present loads: solved by [`SpatialSolver::update`] where they changed since the last
    /// solve.
    ///
    /// # Errors
    /// [`SpatialError::NoEquilibrium`].
    pub fn configuration(&mut self) -> Result<SpatialConfiguration, SpatialError> {
        self.configured()
    }

    /// What is wanted of the configuration under the present loads, solved as by [`SpatialSolver::update`].
    ///
    /// # Errors
    /// [`SpatialError::NoEquilibrium`].
    pub fn row(&mut self, wanted: Wanted) -> Result<SpatialRow, SpatialError> {
        Ok(SpatialRow::in_space(&self.configuration()?, wanted))
    }

    /// A few Newton rounds on the mesh there is: the estimated error, over L. `None` where that is no way to the
    /// answer: nothing was solved before, or the arm moved further than a small change moves it.
    pub(crate) fn settle_warm(&mut self) -> Option<f64> {
        if !self.kept.is_start {
            return None;
        }
        self.begin_anew();
        let on_ramp = self.options.warm_start == WarmStart::Ramp;
        let last = if on_ramp { self.engine.read_tip() } else { None };
        if on_ramp {
            self.predict();
        }
        let before = self.engine.tip;
        let estimate = self.engine.settle(self.options.tol, First::Warm).ok()?;
        let stays =
            self.engine.system.determinant().sign == self.kept.sign && distance(&before, &self.engine.tip) < FARTHEST;
        if !stays {
            return None;
        }
        if on_ramp {
            // What a direct solve has to pass, too: one equilibrium, and that on the unloaded arm's branch.
            let turned = last?.turn_to(&self.engine.read_tip()?);
            if self.engine.needs_continuation() || turned > FARTHEST_ON_RAMP {
                return None;
            }
        }
        Some(self.kept.settle(estimate))
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
        self.kept.forget();
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
            self.kept.is_start = bifurcations == 0 && snaps.is_empty();
            self.kept.sign = sign;
            self.remember(&configuration);
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
