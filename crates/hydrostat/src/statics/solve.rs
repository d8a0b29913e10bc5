//! The direct solve, else the path; verdicts.

use crate::numerics::distance;
use crate::rod::arm::{Arm, ArmError};
use crate::statics::configuration::{Configuration, Statistics, Tip};
use crate::statics::engine::{Engine, Trouble, WORK};
use crate::statics::path::{
    BY_MESH, DOUBTFUL, LOOSE, PathSummary, StepControl, Stopped, follow, follow_on, follow_range, no_equilibrium,
    no_equilibrium_in_range,
};
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::snap::SnapBounds;
use crate::statics::stability::Stability;
use crate::statics::verdict::{Phase, SolveError, Verdict, VerdictKind};

/// Tips (over L) that are this near belong to the same shape on two meshes.
pub(crate) const SAME: f64 = 1e-6;

/// How a solve is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Error of the tip position over L that is asked for, in [1e-12, 1e-2].
    pub tol: f64,
    /// How far the arm may snap on its way to the loads.
    pub snaps: SnapBounds,
}

impl Default for Options {
    fn default() -> Self {
        Self::with_tol(1e-8)
    }
}

/// Where the tip is, and how well that is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// The tip.
    pub tip: Tip,
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
        Self { tol, snaps: SnapBounds::SMALL }
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

/// Solves one arm, again and again as its loads change.
#[derive(Debug, Clone)]
pub struct Solver {
    pub(crate) engine: Engine,
    pub(crate) options: Options,
    /// Whether the engine holds a configuration at whole loads.
    settled: bool,
    /// Sign of the determinant of the last configuration.
    sign: f64,
    /// Estimated error of its tip position over L; none since loads were changed.
    estimate: Option<f64>,
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
        Ok(Self { engine: Engine::new(arm), options, settled: false, sign: 1.0, estimate: None })
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
        self.settled = false;
        self.engine.reset_statistics();
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
            self.settled = true;
            self.sign = 1.0;
            return Ok(configuration);
        }
        self.solve_along_the_path(StepControl::BRISK)
    }

    /// Begins anew.
    pub(crate) fn forget(&mut self) {
        self.settled = false;
        self.engine.reset_statistics();
    }

    /// Keeps the engine's solution, read as `configuration`, to start from, with the sign of its determinant. After a
    /// snap the way back is another one: it is no start.
    pub(crate) fn keep(&mut self, configuration: &Configuration, sign: f64) {
        self.settled = configuration.snaps.is_empty();
        self.sign = sign;
    }

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
        self.settled &= own.stroke.is_some();
        own.stroke = Some(stroke);
        arm.check()?;
        self.estimate = None;
        self.engine.set_loads(&arm);
        Ok(())
    }

    /// Takes another arm. One of the same geometry, with the same cables commanded by their strokes, is solved from the
    /// last configuration by [`Solver::resolve`] and [`Solver::update`], whatever its loads and its material; any other
    /// starts anew.
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
        arm.check()?;
        let own = self.engine.equations.arm();
        if !alike(own, arm) {
            *self = Self::new(arm, self.options)?;
            return Ok(());
        }
        let mut arm = arm.clone();
        for (new, own) in arm.cables.iter_mut().zip(&own.cables).filter(|(new, _)| new.stroke.is_some()) {
            new.tension = own.tension;
        }
        self.estimate = None;
        self.engine.set_loads(&arm);
        Ok(())
    }

    /// Sets all tensions (N), in the order of the cables.
    ///
    /// # Errors
    /// [`SolveError::Arm`] when their number is wrong or one of them is.
    pub fn set_tensions(&mut self, tensions: &[f64]) -> Result<(), SolveError> {
        self.engine.equations.arm().check_tensions(tensions)?;
        // Strokes are not commanded any more: what was solved with them is no start.
        self.settled &= self.engine.equations.held.is_none();
        self.engine.equations.let_go();
        self.estimate = None;
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
        let before = self.engine.equations.arm().flow.speed;
        self.estimate = None;
        self.engine.change_loads(|arm| arm.flow.speed = speed);
        if let Err(error) = self.engine.equations.arm().check_flow() {
            self.engine.change_loads(|arm| arm.flow.speed = before);
            return Err(error.into());
        }
        Ok(())
    }

    /// Solves again from the last configuration, after a small change of tensions or stream: a few
    /// Newton rounds on the mesh there is. Falls back to [`Solver::solve`] when the arm moves further
    /// than a small change moves it, or when nothing was solved before.
    ///
    /// # Errors
    /// [`SolveError::NoEquilibrium`].
    pub fn resolve(&mut self) -> Result<Configuration, SolveError> {
        match self.settle_warm() {
            Some(estimate) => self.read_warm(estimate),
            None => self.solve(),
        }
    }

    /// [`Solver::resolve`] for those who only want to know where the tip is, a control loop say: nothing is read out,
    /// and nothing allocated once meshes have their size. [`Solver::configuration`] reads the rest when it is wanted.
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
        if let Some(answer) = self.update_warm() {
            return Ok(answer);
        }
        let found = self.resolve()?;
        Ok(Answer { tip: found.tip(), error_estimate: found.error_estimate, statistics: found.statistics })
    }

    /// [`Solver::update`], as far as a few rounds lead from the configuration before: on its branch. After `None`
    /// nothing is solved.
    pub(crate) fn update_warm(&mut self) -> Option<Answer> {
        let estimate = self.settle_warm()?;
        let tip = self.engine.read_tip().ok()?;
        self.settled = true;
        self.estimate = Some(estimate);
        let length = self.engine.equations.units.length;
        Some(Answer { tip, error_estimate: estimate * length, statistics: self.engine.statistics(0) })
    }

    /// Everything about the last [`Solver::update`], or, without one, of [`Solver::resolve`].
    ///
    /// # Errors
    /// [`SolveError::NoEquilibrium`].
    pub fn configuration(&mut self) -> Result<Configuration, SolveError> {
        match self.estimate {
            Some(estimate) if self.settled => self.read_warm(estimate),
            _ => self.resolve(),
        }
    }

    /// Solves, unless the engine holds the configuration of the present loads.
    pub(crate) fn be_solved(&mut self) -> Result<(), SolveError> {
        if self.settled && self.estimate.is_some() { Ok(()) } else { self.update().map(|_| ()) }
    }

    /// The tip of the configuration that the engine holds.
    pub(crate) fn tip(&mut self) -> Result<Tip, SolveError> {
        match self.engine.read_tip() {
            Ok(tip) => Ok(tip),
            Err(_) => self.configuration().map(|found| found.tip()),
        }
    }

    /// A few Newton rounds on the mesh there is. `None` where that is no way to the answer: nothing was solved before,
    /// the arm moved further than a small change moves it, or cables rub, and which way they slid is part of the
    /// answer.
    fn settle_warm(&mut self) -> Option<f64> {
        if !self.settled || self.engine.equations.arm().has_friction() {
            return None;
        }
        self.settled = false;
        self.engine.reset_statistics();
        let before = self.engine.tip_angle();
        let estimate = self.engine.settle(self.options.tol, First::Warm).ok()?;
        let turned = self.engine.tip_angle() - before;
        let same = self.engine.determinant().sign == self.sign && turned.abs() <= 0.2;
        same.then_some(estimate)
    }

    /// The configuration that the engine has settled on from another.
    fn read_warm(&mut self, estimate: f64) -> Result<Configuration, SolveError> {
        let Ok(mut configuration) = self.read(estimate, PathSummary::default()) else { return self.solve() };
        if self.sign < 0.0 {
            configuration.stable = Some(false);
        }
        self.settled = true;
        Ok(configuration)
    }

    /// Follows the path of `docs/model.md`, section 7, whatever a direct solve would give.
    pub(crate) fn solve_along_the_path(&mut self, pace: StepControl) -> Result<Configuration, SolveError> {
        let travelled = follow(&mut self.engine, pace, self.options.snaps).map_err(|at| self.no_equilibrium(at))?;
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
        self.settled = false;
        &mut self.engine
    }

    pub(crate) fn last_verdict(&mut self, load_fraction: Option<f64>) -> Verdict {
        let spent = self.engine.spent();
        let jumps = spent.is_none() && self.engine.equations.arm().readings.load_can_jump();
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
        self.estimate = Some(estimate);
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

/// Whether a solution for one arm is a start for the other: the same geometry, equations and unknowns.
fn alike(a: &Arm, b: &Arm) -> bool {
    a.has_geometry_of(b)
        && a.cables.iter().zip(&b.cables).all(|(a, b)| a.stroke.is_some() == b.stroke.is_some())
        && !a.has_friction()
        && !b.has_friction()
        && a.breaks() == b.breaks()
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
