//! The direct solve, else the path; verdicts.

use crate::numerics::distance;
use crate::rod::arm::{Arm, ArmError};
use crate::statics::configuration::{Configuration, Statistics, Tip};
use crate::statics::engine::{Engine, Guess, Trouble, WORK};
use crate::statics::kept::{Kept, holds_equilibrium};
use crate::statics::path::loaded::Loaded as _;
use crate::statics::path::{
    BY_MESH, DOUBTFUL, LOOSE, PathSummary, StepControl, Stopped, follow, follow_on, follow_range, no_equilibrium,
    no_equilibrium_in_range,
};
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::row::{Row, Wanted};
use crate::statics::snap::SnapBounds;
use crate::statics::stability::Stability;
use crate::statics::verdict::{Phase, SolveError, Verdict, VerdictKind};
use crate::statics::warm_start::{FARTHEST_ON_RAMP, WarmStart, alike, differ_in_loads, may_be_followed};

/// A tip that turns further (rad) than this in a warm start has left what a small change of the loads does.
const FARTHEST: f64 = 0.2;

/// Tips (over L) that are this near belong to the same shape on two meshes.
pub(crate) const SAME: f64 = 1e-6;

/// How a solve is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Error of the tip position over L that is asked for, in [1e-12, 1e-2].
    pub tol: f64,
    /// How far the arm may snap on its way to the loads.
    pub snaps: SnapBounds,
    /// Which equilibrium [`Solver::update`] may give.
    pub warm_start: WarmStart,
}

impl Default for Options {
    fn default() -> Self {
        Self::with_tol(1e-8)
    }
}

/// Where the tip is, and how well that is known; in space with a [`crate::SpatialTip`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer<T = Tip> {
    /// The tip.
    pub tip: T,
    /// Estimated error of its position, m.
    pub error_estimate: f64,
    /// What the solve took.
    pub statistics: Statistics,
}

impl Options {
    /// The default options at another tolerance.
    ///
    /// ```
    /// use hydrostat::Options;
    ///
    /// assert_eq!(Options::with_tol(1e-8), Options::default());
    /// ```
    pub const fn with_tol(tol: f64) -> Self {
        Self { tol, snaps: SnapBounds::SMALL, warm_start: WarmStart::Branch }
    }

    pub(crate) fn check(self) -> Result<(), SolveError> {
        if !(self.tol >= 1e-12 && self.tol <= 1e-2) {
            return Err(SolveError::Option { option: "tol", value: self.tol, expected: "in [1e-12, 1e-2]" });
        }
        for (option, value) in [("snap_distance", self.snaps.distance), ("snap_angle", self.snaps.angle)] {
            if value.is_nan() || value < 0.0 {
                return Err(SolveError::Option { option, value, expected: "at least 0" });
            }
        }
        Ok(())
    }
}

/// Solves one arm, again and again as its loads change: [`Solver::solve`] from the unloaded arm, [`Solver::update`]
/// from the last shape. [`Solver::configuration`] and [`Solver::row`] read out the solution.
#[derive(Debug, Clone)]
pub struct Solver {
    pub(crate) engine: Engine,
    pub(crate) options: Options,
    kept: Kept<Guess>,
}

impl Solver {
    /// A solver for `arm`.
    ///
    /// # Errors
    /// [`SolveError::Arm`], [`SolveError::Option`].
    pub fn new(arm: &Arm, options: Options) -> Result<Self, SolveError> {
        arm.check()?;
        options.check()?;
        if arm.space.is_some() {
            return Err(ArmError::OnlyInPlane { what: "what was asked for" }.into());
        }
        Ok(Self { engine: Engine::new(arm), options, kept: Kept::new() })
    }

    /// The arm, with the loads that were set last.
    pub fn arm(&self) -> &Arm {
        self.engine.equations.arm()
    }

    /// Solves from the unloaded arm.
    ///
    /// # Errors
    /// [`SolveError::NoEquilibrium`].
    pub fn solve(&mut self) -> Result<Configuration, SolveError> {
        self.solve_within(WORK)
    }

    /// [`Solver::solve`] in so much work.
    pub(crate) fn solve_within(&mut self, work: usize) -> Result<Configuration, SolveError> {
        self.engine.allow(work);
        let has_friction = self.engine.equations.arm().has_friction();
        let solved = if has_friction { self.solve_with_friction() } else { self.solve_smooth() };
        // What is done with the answer, a path say, has bounds of its own.
        self.engine.lift_limit();
        if has_friction {
            // The engine holds the last of its iterations, not the answer.
            self.kept.solved = None;
        }
        solved
    }

    /// Without friction of the cables.
    pub(crate) fn solve_smooth(&mut self) -> Result<Configuration, SolveError> {
        if self.engine.equations.arm().is_commanded() {
            return self.solve_strokes();
        }
        self.solve_tensions()
    }

    /// With all tensions given.
    pub(crate) fn solve_tensions(&mut self) -> Result<Configuration, SolveError> {
        self.forget();
        self.engine.set_phase(Phase::Tension, 1.0);
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
            self.keep(&configuration, 1.0);
            return Ok(configuration);
        }
        self.solve_along_the_path(StepControl::BRISK)
    }

    /// Begins anew.
    pub(crate) fn forget(&mut self) {
        self.kept.forget();
        self.engine.reset_statistics();
    }

    /// Keeps the engine's solution, read as `configuration`, to start from, with the sign of its determinant. After a
    /// snap the way back is another one: no branch to stay on begins there.
    pub(crate) fn keep(&mut self, configuration: &Configuration, sign: f64) {
        self.kept.is_start = configuration.snaps.is_empty() || self.options.warm_start == WarmStart::Ramp;
        self.kept.sign = sign;
        self.remember(configuration);
    }

    holds_equilibrium!(Configuration, Tip, SolveError);

    /// Commands the stroke (m, positive when reeled in) of cable `cable` in place of its tension.
    ///
    /// # Errors
    /// [`SolveError::Option`] when there is no such cable, [`SolveError::Arm`] when the stroke is none.
    pub fn set_stroke(&mut self, cable: usize, stroke: f64) -> Result<(), SolveError> {
        let mut arm = self.engine.equations.arm().clone();
        let Some(own) = arm.cables.get_mut(cable) else {
            let expected = "the index of one of the arm's cables";
            return Err(SolveError::Option { option: "cable", value: cable as f64, expected });
        };
        // A cable that had a tension before starts anew.
        let starts_anew = own.stroke.is_none();
        own.stroke = Some(stroke);
        arm.check()?;
        self.leave_loads();
        self.kept.is_start &= !starts_anew && self.options.warm_start == WarmStart::Branch;
        self.engine.set_loads(&arm);
        Ok(())
    }

    /// Takes another arm. One of the same geometry, with the same cables commanded by their strokes, is solved from the
    /// last shape by [`Solver::update`], whatever its loads and its material (with [`WarmStart::Ramp`]: where the loads
    /// alone differ); any other starts anew.
    ///
    /// # Errors
    /// [`SolveError::Arm`] when it is none; the arm before stays then.
    ///
    /// ```
    /// use hydrostat::{Arm, Options, Parameter, Solver};
    ///
    /// let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    /// arm.tip.force = [0.0, 1e-3]; // N
    /// let mut solver = Solver::new(&arm, Options::default())?;
    /// let soft = solver.update()?.tip;
    /// Parameter::Young.set(&mut arm, 120e3).expect("a cone is homogeneous");
    /// solver.set_arm(&arm)?;
    /// assert!(solver.update()?.tip.y < soft.y, "a stiffer arm gives way less");
    /// # Ok::<(), hydrostat::SolveError>(())
    /// ```
    pub fn set_arm(&mut self, arm: &Arm) -> Result<(), SolveError> {
        let own = self.engine.equations.arm();
        if self.options.warm_start == WarmStart::Ramp && may_be_followed(own) && differ_in_loads(own, arm) {
            arm.check_loads()?;
            self.leave_loads();
            self.engine.take_loads(arm);
            return Ok(());
        }
        arm.check()?;
        if self.options.warm_start == WarmStart::Ramp || !alike(own, arm) {
            *self = Self::new(arm, self.options)?;
            return Ok(());
        }
        let mut arm = arm.clone();
        for (new, own) in arm.cables.iter_mut().zip(&own.cables).filter(|(new, _)| new.stroke.is_some()) {
            new.tension = own.tension;
        }
        self.leave_loads();
        self.engine.set_loads(&arm);
        Ok(())
    }

    /// Sets all tensions (N), in the order of the cables.
    ///
    /// # Errors
    /// [`SolveError::Arm`] when their number is wrong or one of them is.
    pub fn set_tensions(&mut self, tensions: &[f64]) -> Result<(), SolveError> {
        self.engine.equations.arm().check_tensions(tensions)?;
        self.leave_loads();
        // Strokes are not commanded any more: what was solved with them is no start.
        self.kept.is_start &= self.engine.equations.stroke_control.is_none();
        self.engine.equations.let_go();
        self.engine.change_loads(|arm| {
            for (cable, tension) in arm.cables.iter_mut().zip(tensions) {
                cable.tension = *tension;
                cable.stroke = None;
            }
        });
        Ok(())
    }

    /// Sets the speed of the stream (m/s).
    ///
    /// # Errors
    /// [`SolveError::Arm`] when it is negative or not finite.
    pub fn set_flow_speed(&mut self, speed: f64) -> Result<(), SolveError> {
        self.leave_loads();
        let before = self.engine.equations.arm().flow.speed;
        self.engine.change_loads(|arm| arm.flow.speed = speed);
        if let Err(error) = self.engine.equations.arm().check_flow() {
            self.engine.change_loads(|arm| arm.flow.speed = before);
            return Err(error.into());
        }
        Ok(())
    }

    /// Solves from the last shape, after a small change of the loads: a few Newton rounds on the mesh there is. Solves
    /// from the unloaded arm as [`Solver::solve`] does where nothing was solved before, where the arm moves further
    /// than a small change of the loads moves it, and with friction, where the answer depends on the way to the loads.
    /// [`Options::warm_start`] says which equilibrium it may give.
    ///
    /// A warm start reads nothing out but the tip, and allocates nothing once meshes have their size.
    ///
    /// # Errors
    /// [`SolveError::NoEquilibrium`].
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Options, Profile, Solver};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.2));
    /// let mut solver = Solver::new(&arm, Options::default())?;
    /// let mut before = solver.update()?;
    /// for step in 1..=10 {
    ///     solver.set_tensions(&[0.2 + 0.002 * f64::from(step)])?;
    ///     let answer = solver.update()?;
    ///     assert!(answer.tip.theta > before.tip.theta && answer.error_estimate < 1e-8 * 0.245);
    ///     before = answer;
    /// }
    /// # Ok::<(), hydrostat::SolveError>(())
    /// ```
    pub fn update(&mut self) -> Result<Answer, SolveError> {
        self.updated()
    }

    /// The configuration under the present loads: solved by [`Solver::update`] where they changed since the last
    /// solve.
    ///
    /// # Errors
    /// [`SolveError::NoEquilibrium`].
    pub fn configuration(&mut self) -> Result<Configuration, SolveError> {
        self.configured()
    }

    /// What is wanted of the configuration under the present loads, solved as by [`Solver::update`]; without reading
    /// the whole configuration where only tip, base reaction, tensions and strokes are wanted.
    ///
    /// # Errors
    /// [`SolveError::NoEquilibrium`].
    pub fn row(&mut self, wanted: Wanted) -> Result<Row, SolveError> {
        if let Some(found) = self.refresh()? {
            return Ok(Row::new(&found, wanted));
        }
        if let Some(solved) = &self.kept.solved
            && !wanted.reads_stations()
            && let Some(row) = Row::at_hand(&mut self.engine, solved, wanted)
        {
            return Ok(row);
        }
        Ok(Row::new(&self.configured()?, wanted))
    }

    /// The tip of the configuration that the engine holds.
    pub(crate) fn tip(&mut self) -> Result<Tip, SolveError> {
        match self.engine.read_tip() {
            Ok(tip) => Ok(tip),
            Err(_) => self.configuration().map(|found| found.tip()),
        }
    }

    /// A few Newton rounds on the mesh there is: the estimated error, over L. `None` where that is no way to the
    /// answer: nothing was solved before, the arm moved further than a small change moves it, or cables rub, and which
    /// way they slid is part of the answer.
    pub(crate) fn settle_warm(&mut self) -> Option<f64> {
        if !self.kept.is_start || self.engine.equations.arm().has_friction() {
            return None;
        }
        self.forget();
        let on_ramp = self.options.warm_start == WarmStart::Ramp;
        if on_ramp {
            self.predict();
            self.engine.set_phase(Phase::Tension, 1.0);
        }
        let before = self.engine.tip_angle();
        let estimate = self.engine.settle(self.options.tol, First::Warm).ok()?;
        let turned = (self.engine.tip_angle() - before).abs();
        let is_it = if on_ramp {
            // What a direct solve has to pass, too: one equilibrium, and that on the unloaded arm's branch.
            self.kept.sign = 1.0;
            !self.engine.needs_continuation() && turned <= FARTHEST_ON_RAMP
        } else {
            self.engine.determinant().sign == self.kept.sign && turned <= FARTHEST
        };
        is_it.then(|| self.kept.settle(estimate))
    }

    /// Follows the path of `docs/model.md`, section 7, whatever a direct solve would give.
    pub(crate) fn solve_along_the_path(&mut self, control: StepControl) -> Result<Configuration, SolveError> {
        let travelled = follow(&mut self.engine, control, self.options.snaps).map_err(|at| self.no_equilibrium(at))?;
        self.end_of_path(travelled)
    }

    /// Follows the path on to whole loads from the engine's equilibrium at a fraction of a phase.
    pub(crate) fn solve_on(&mut self, from: (Phase, f64)) -> Result<Configuration, SolveError> {
        self.forget();
        self.engine.allow(WORK);
        let travelled = follow_on(&mut self.engine, from, StepControl::BRISK, self.options.snaps);
        let solved = travelled.map_err(|at| self.no_equilibrium(at)).and_then(|travelled| self.end_of_path(travelled));
        self.engine.lift_limit();
        solved
    }

    /// The engine's equilibrium, read again.
    pub(crate) fn resettle(&mut self) -> Result<Configuration, SolveError> {
        let settled = self.engine.settle(self.options.tol, First::Warm);
        if let Ok(estimate) = settled
            && let Ok(configuration) = self.read(estimate, PathSummary::default())
        {
            return Ok(configuration);
        }
        let verdict = self.last_verdict(None);
        Err(self.no_equilibrium(verdict))
    }

    /// Follows the engine's range to its end, from the engine's equilibrium at a fraction of it, behind a limit point
    /// down to a lowest one.
    pub(crate) fn solve_along_range(&mut self, from: [f64; 2]) -> Result<Configuration, SolveError> {
        self.forget();
        self.engine.allow(WORK);
        let travelled = follow_range(&mut self.engine, from, StepControl::BRISK, self.options.snaps);
        let solved = match travelled {
            Ok(travelled) => self.end_of_path(travelled),
            Err(at) => {
                let no = no_equilibrium_in_range(&mut self.engine, at, self.options.tol);
                Err(SolveError::NoEquilibrium(no.into()))
            }
        };
        self.engine.lift_limit();
        solved
    }

    /// The answer at the end of a path, which the engine is at.
    fn end_of_path(&mut self, travelled: PathSummary) -> Result<Configuration, SolveError> {
        let before = self.engine.tip;
        let on_path = self.engine.system.determinant();
        let is_doubtful =
            on_path.clearance <= BY_MESH || (on_path.clearance < DOUBTFUL && self.engine.sure_sign().is_none());
        let settled = self.engine.settle(self.options.tol, First::Rough);
        let moved = distance(&self.engine.tip, &before);
        let near = moved < 10.0 * LOOSE;
        let sign = self.engine.system.determinant().sign;
        // A coarse mesh can be exact for the shape, of a straight arm above all, and not for the determinant.
        let mut same = sign == on_path.sign || travelled.symmetric || moved < SAME;
        // What a mesh decides decides nothing: that of the path, or that of the answer.
        same |= near && is_doubtful;
        let unsure = (sign < 0.0 || !same) && settled.is_ok() && self.engine.sure_sign().is_none();
        same |= near && unsure;
        let odd = sign < 0.0 && !unsure;
        match settled {
            Ok(estimate) if moved < 0.05 && same => {
                let bifurcations = travelled.bifurcations;
                let Ok(mut configuration) = self.read(estimate, travelled) else {
                    let verdict = self.last_verdict(Some(1.0));
                    return Err(self.no_equilibrium(verdict));
                };
                configuration.stable = known_on_the_way(&configuration, bifurcations, odd);
                self.keep(&configuration, sign);
                Ok(configuration)
            }
            _ => {
                let verdict = self.last_verdict(None);
                Err(self.no_equilibrium(verdict))
            }
        }
    }

    /// The engine, which holds the last configuration.
    pub(crate) fn engine_mut(&mut self) -> &mut Engine {
        self.kept.forget();
        &mut self.engine
    }

    pub(crate) fn last_verdict(&mut self, load_fraction: Option<f64>) -> Verdict {
        let spent = self.engine.spent();
        let jumps = spent.is_none() && self.engine.equations.arm().model.load_can_jump();
        Verdict {
            kind: if jumps { VerdictKind::LoadJump } else { VerdictKind::NotFound },
            phase: Phase::Tension,
            load_fraction: load_fraction.unwrap_or(1.0),
            s: if jumps { self.engine.nearest_switch().map(|s| s * self.engine.equations.units.length) } else { None },
            residual: self.engine.last,
            spent,
        }
    }

    /// The verdict with the last good point, which the engine holds, settled and read.
    pub(crate) fn no_equilibrium(&mut self, stopped: impl Into<Stopped>) -> SolveError {
        SolveError::NoEquilibrium(no_equilibrium(&mut self.engine, stopped.into(), self.options.tol).into())
    }

    pub(crate) fn read(&mut self, estimate: f64, travelled: PathSummary) -> Result<Configuration, Trouble> {
        let statistics = self.engine.statistics(travelled.steps);
        let length = self.engine.equations.units.length;
        let mut read =
            Configuration::read(&mut self.engine, estimate * length, statistics).map_err(Trouble::Section)?;
        read.snaps = travelled.snaps;
        Ok(read)
    }
}

/// What a path knows of the stability of its end, from the bifurcations that it passed and the determinant's sign,
/// which is negative where an `odd` number of directions is unstable. An even one, after two bifurcations, is counted.
pub(crate) fn known_on_the_way(configuration: &Configuration, bifurcations: usize, odd: bool) -> Option<bool> {
    let counted = || configuration.stability().and_then(Stability::is_stable).filter(|stable| !stable);
    match (bifurcations, odd) {
        (_, true) => Some(false),
        (0, false) => None,
        (_, false) => counted(),
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
