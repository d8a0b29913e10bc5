//! A run: the motion at the times asked for, one by one.

use hydrostat_bvp::{Lanes, Real, Station};

use super::dimensions::S;
use super::equations::Moving;
use super::error::MotionError;
use super::event::MotionEvent;
use super::inputs::Inputs;
use super::options::{CableMotion, MotionOptions, MotionStatistics};
use super::places::{MotionStation, station};
use super::quasi_static::QuasiStatic;
use super::run::Run;
use super::state::MotionState;
use super::warning::MotionWarning;
use super::works::Works;
use crate::rod::arm::{Arm, ArmError};
use crate::statics::dimensions::{L, N};
use crate::statics::equations::StationData;
use crate::statics::shape::Wrench;

/// The motion at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Instant {
    /// s.
    pub time: f64,
    /// x and y of the tip, m.
    pub tip: [f64; 2],
    /// theta of the tip, rad.
    pub tip_theta: f64,
    /// Velocity of the tip, m/s.
    pub tip_velocity: [f64; 2],
    /// One a cable, in the arm's order.
    pub cables: Vec<CableMotion>,
    /// Kinetic energy of the arm (without that of the water), J.
    pub kinetic_energy: f64,
    /// 1/2 int (C1 (nu - nu_o)^2 + ...) A ds, J: the energy of strain where the volume law is `none`, else a measure.
    pub strain_energy: f64,
    /// What support and cable anchors exert on the arm at the base: force in space (N) and moment about r(0) (N m).
    pub base_reaction: Wrench,
    /// What was done on the arm since the start. Kinetic energy and that of strain less [`Works::sum`] are constant.
    pub works: Works,
}

/// An arm in motion.
///
/// ```
/// use hydrostat::{Arm, Cable, Course, Inputs, MotionOptions, Profile, Simulation};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.dynamics.relaxation_time = 2.7e-3; // s
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
/// let mut inputs = Inputs::default();
/// inputs.set("cable[0].tension", Course::ramp(0.0, 0.1, 0.0, 0.1))?; // N over s
/// let mut simulation = Simulation::new(&arm, inputs, MotionOptions::default())?;
/// let first = simulation.step(0.05)?; // s
/// let later = simulation.step(0.05)?;
/// assert!(later.tip[1] > first.tip[1], "it bends to the side of the pulled cable");
/// assert!((later.cables[0].tension - 0.1).abs() < 1e-12);
/// # Ok::<(), hydrostat::MotionError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Simulation {
    run: Run<Moving, S, L>,
    stations: Vec<Station<N, L>>,
}

impl Simulation {
    /// The arm at rest in the equilibrium of its loads just before the start.
    ///
    /// # Errors
    /// [`MotionError`] where an option, the arm or an input is refused, or where there is no equilibrium.
    pub fn new(arm: &Arm, inputs: Inputs, options: MotionOptions) -> Result<Self, MotionError> {
        if arm.space.is_some() {
            let what = "`Simulation` (in space there is `SpatialSimulation`)";
            return Err(ArmError::OnlyInPlane { what }.into());
        }
        Ok(Self { run: Run::new(arm, inputs, options)?, stations: Vec::new() })
    }

    /// Goes on from the end of another run of `arm`, or of one with the same length and mesh, at the state's time in
    /// place of [`MotionOptions::start`]. Under other loads give [`MotionState::under_other_loads`].
    ///
    /// # Errors
    /// [`MotionError`] where an option, the arm, an input or the state is refused.
    pub fn resume(arm: &Arm, inputs: Inputs, options: MotionOptions, state: &MotionState) -> Result<Self, MotionError> {
        Ok(Self { run: Run::resume(arm, inputs, options, state)?, stations: Vec::new() })
    }

    /// The time of the last answer, s.
    pub fn time(&self) -> f64 {
        self.run.time
    }

    /// What the run took until now.
    pub fn statistics(&self) -> MotionStatistics {
        self.run.statistics()
    }

    /// The error of the tip, m: three times the sum of the embedded errors of all steps, of the method of order 3 in
    /// that of order 4, so that it says too much where the motion is smooth; after a jump that is not resolved (see
    /// [`Simulation::warnings`]) two hundredths of the way of the tip besides. The mesh's error is not in it.
    pub fn error_estimate(&self) -> f64 {
        self.run.error_estimate()
    }

    /// By how much the steps changed the energy of the arm beside all works, J: negative where they damp what they do
    /// not resolve. Zero but for the error of the steps.
    pub fn energy_gap(&self) -> f64 {
        self.run.energy_gap()
    }

    /// What should be known about the motion until now.
    pub fn warnings(&self) -> Vec<MotionWarning> {
        self.run.warnings()
    }

    /// What happened until the end of the last step, in order: the first 10000 events.
    pub fn events(&self) -> &[MotionEvent] {
        &self.run.stepper.events
    }

    /// The arm at the place `s` (m, kept within the arm) at the present time.
    pub fn station(&self, s: f64) -> MotionStation {
        let settling = &self.run.stepper.settling;
        let length = settling.moving.statics.units.length;
        station(&self.run.asked, &settling.solution.mesh, &settling.system, length, s.clamp(0.0, length))
    }

    /// What the equilibria of the same loads are asked with.
    ///
    /// # Errors
    /// [`MotionError::Start`] where the statics refuse the arm.
    pub fn quasi_static(&self) -> Result<QuasiStatic, MotionError> {
        QuasiStatic::new(self.run.stepper.arm(), self.run.stepper.inputs.clone())
    }

    /// What it takes to go on from the present time in another run, see [`Simulation::resume`].
    pub fn state(&self) -> MotionState {
        self.run.state()
    }

    /// The motion at the present time.
    pub fn now(&mut self) -> Instant {
        self.read()
    }

    /// Moves on by `dt` (s).
    ///
    /// # Errors
    /// [`MotionError::Ended`] where the motion ends before; the last answer stands.
    pub fn step(&mut self, dt: f64) -> Result<Instant, MotionError> {
        self.advance_to(self.run.time + dt)
    }

    /// Moves on by `dt` (s) while the quantities `loads`, named as in [`Inputs::set`], change to these values along
    /// straight lines, and keep them from then on: a step of a control loop. Steps in time end where it ends.
    ///
    /// # Errors
    /// [`MotionError::Course`], [`MotionError::Arm`], [`MotionError::Unfit`] where a load is refused;
    /// [`MotionError::Option`] where the motion is known further than its present time, because
    /// [`Simulation::advance_to`] or [`Simulation::step`] brought it there; [`MotionError::Ended`].
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Inputs, MotionOptions, Profile, Simulation};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.dynamics.relaxation_time = 2.7e-3; // s
    /// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    /// let mut simulation = Simulation::new(&arm, Inputs::default(), MotionOptions::default())?;
    /// let mut tension: f64 = 0.0;
    /// for _ in 0..50 {
    ///     let tip = simulation.now().tip;
    ///     tension = (tension + 2.0 * (0.05 - tip[1]) * 0.02).max(0.0); // N: towards y = 50 mm
    ///     simulation.step_to(0.02, &[("cable[0].tension", tension)])?;
    /// }
    /// assert!(simulation.now().tip[1] > 0.02);
    /// # Ok::<(), hydrostat::MotionError>(())
    /// ```
    pub fn step_to(&mut self, dt: f64, loads: &[(&str, f64)]) -> Result<Instant, MotionError> {
        self.run.step_to(dt, loads, || true)?;
        Ok(self.read())
    }

    /// As [`Simulation::step_to`], but not further than to the end of the first step in time after which `go_on` is
    /// false: [`Instant::time`] says how far it came. Work that is bounded, as a clock on the wall bounds it.
    ///
    /// # Errors
    /// As [`Simulation::step_to`].
    pub fn step_to_while(
        &mut self,
        dt: f64,
        loads: &[(&str, f64)],
        go_on: impl FnMut() -> bool,
    ) -> Result<Instant, MotionError> {
        self.run.step_to(dt, loads, go_on)?;
        Ok(self.read())
    }

    /// Moves on to `time` (s), which is not before the present one.
    ///
    /// # Errors
    /// [`MotionError::Ended`] where the motion ends before.
    pub fn advance_to(&mut self, time: f64) -> Result<Instant, MotionError> {
        self.run.advance_to(time)?;
        Ok(self.read())
    }

    /// The motion at `start`, `start + every` and so on up to `until` (s), one by one to `sink`, which may stop the run
    /// with `false`.
    ///
    /// # Errors
    /// [`MotionError::Ended`] where the motion ends before, after all before it was given.
    pub fn run(
        &mut self,
        until: f64,
        every: f64,
        mut sink: impl FnMut(&Instant, &Self) -> bool,
    ) -> Result<(), MotionError> {
        let times = self.run.times(until, every)?;
        for (k, time) in times.enumerate() {
            let instant = if k == 0 { self.read() } else { self.advance_to(time)? };
            if !sink(&instant, self) {
                break;
            }
        }
        Ok(())
    }

    /// x, y (m) and theta (rad) at the nodes of the mesh at the present time, with their places s (m).
    pub fn shape(&self) -> Vec<[f64; 4]> {
        let length = self.run.stepper.arm().length;
        let nodes = self.run.stepper.settling.solution.mesh.nodes();
        let of = |(i, s): (usize, &f64)| {
            let [theta, x, y] = self.run.asked.node(i);
            [s * length, x * length, y * length, theta]
        };
        nodes.iter().enumerate().map(of).collect()
    }

    fn read(&mut self) -> Instant {
        let arm = self.run.arm();
        let stepper = &self.run.stepper;
        let settling = &stepper.settling;
        let statics = &settling.moving.statics;
        let units = statics.units;
        let last = self.run.asked.layout.nodes - 1;
        let ([theta, x, y], [_, u, v]) = (self.run.asked.node(last), self.run.asked.node_rate(last));
        self.stations.clear();
        for block in 0..self.run.asked.layout.blocks {
            let [[nu, eta, mu, slope], _] = self.run.asked.strains(block);
            self.stations.push(Station { z: [Lanes::of(0.0); N], inner: [nu, eta, mu], closure_slope: slope });
        }
        let [kinetic, strained] = settling.moving.energies(&settling.system, &self.run.asked);
        let at =
            StationData { weights: &settling.system.gauss.b, steps: settling.system.steps(), stations: &self.stations };
        let energy = units.force * units.length;
        let cables = (0..arm.cables.len())
            .map(|c| {
                let [now, reference] = statics.cable_lengths(c, at);
                let tension = match arm.cables[c].stroke {
                    Some(_) => stepper.pulls.tension_at(c, self.run.time),
                    None => arm.cables[c].tension,
                };
                CableMotion { tension, stroke: (reference - now) * units.length }
            })
            .collect();
        let length = units.length;
        let [n_x, n_y, _, _, _, moment] = stepper.ledger.base_at(self.run.time);
        Instant {
            time: self.run.time,
            tip: [x * length, y * length],
            tip_theta: theta,
            tip_velocity: [u * length, v * length],
            cables,
            kinetic_energy: kinetic * energy,
            strain_energy: strained * energy,
            base_reaction: Wrench::of_base([0.0, n_x, n_y, moment], &units),
            works: self.run.works(),
        }
    }
}
