//! A run: the motion at the times asked for, one by one.

use hydrostat_bvp::{Lanes, Real, Station};

use super::error::MotionError;
use super::event::MotionEvent;
use super::history::{Snapshot, between};
use super::inputs::Inputs;
use super::places::{MotionStation, station};
use super::quasi_static::QuasiStatic;
use super::state::{MotionState, flat};
use super::stepper::Stepper;
use super::warning::MotionWarning;
use super::works::Works;
use crate::rod::arm::Arm;
use crate::statics::dimensions::N;
use crate::statics::equations::StationData;
use crate::statics::shape::Wrench;

/// How a run is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionOptions {
    /// Error of the tip's position over L that is asked for, in [1e-9, 1e-2].
    pub tol: f64,
    /// When the run starts, s.
    pub start: f64,
    /// Elements of the mesh along the arm; by the tolerance unless given.
    pub elements: Option<usize>,
    /// Length of all steps, s, in place of steps by the tolerance; corners of the inputs still end a step.
    pub step: Option<f64>,
}

impl Default for MotionOptions {
    fn default() -> Self {
        Self { tol: 1e-4, start: 0.0, elements: None, step: None }
    }
}

impl MotionOptions {
    /// Refuses what is out of range.
    fn check(&self) -> Result<(), MotionError> {
        let refuse = |option, value, expected| Err(MotionError::Option { option, value, expected });
        if !(1e-9..=1e-2).contains(&self.tol) {
            return refuse("tol", self.tol, "in [1e-9, 1e-2]");
        }
        if !self.start.is_finite() {
            return refuse("start", self.start, "finite");
        }
        if let Some(elements) = self.elements.filter(|n| !(1..=1000).contains(n)) {
            return refuse("elements", elements as f64, "in [1, 1000]");
        }
        if let Some(step) = self.step.filter(|h| !(*h >= 1e-9 && h.is_finite())) {
            return refuse("step", step, "at least 1e-9 s");
        }
        Ok(())
    }
}

/// A cable at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CableMotion {
    /// Tension, N.
    pub tension: f64,
    /// Length reeled in since the reference strains, m.
    pub stroke: f64,
}

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

/// What a run took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MotionStatistics {
    /// Steps in time.
    pub steps: usize,
    /// Steps that were tried and taken back.
    pub rejected: usize,
    /// Boundary-value problems solved.
    pub solves: usize,
    /// Linearisations of one.
    pub rounds: usize,
    /// Elements of the mesh.
    pub elements: usize,
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
    stepper: Stepper,
    /// The motion at the time asked for.
    asked: Snapshot,
    time: f64,
    stations: Vec<Station<N, 3>>,
}

impl Simulation {
    /// The arm at rest in the equilibrium of its loads just before the start.
    ///
    /// # Errors
    /// [`MotionError`] where an option, the arm or an input is refused, or where there is no equilibrium.
    pub fn new(arm: &Arm, inputs: Inputs, options: MotionOptions) -> Result<Self, MotionError> {
        options.check()?;
        let stepper = Stepper::new(arm, inputs, options.start, options.tol, options.elements, options.step)?;
        Ok(Self::of(stepper))
    }

    /// Goes on from the end of another run of `arm`, or of one with the same length and mesh, at the state's time in
    /// place of [`MotionOptions::start`]. Under other loads give [`MotionState::under_other_loads`].
    ///
    /// # Errors
    /// [`MotionError`] where an option, the arm, an input or the state is refused.
    pub fn resume(arm: &Arm, inputs: Inputs, options: MotionOptions, state: &MotionState) -> Result<Self, MotionError> {
        options.check()?;
        Ok(Self::of(Stepper::resumed(arm, inputs, state, options.tol, options.step)?))
    }

    fn of(stepper: Stepper) -> Self {
        Self { asked: stepper.now.clone(), time: stepper.time, stepper, stations: Vec::new() }
    }

    /// The time of the last answer, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// What the run took until now.
    pub fn statistics(&self) -> MotionStatistics {
        let settling = &self.stepper.settling;
        MotionStatistics {
            steps: self.stepper.steps,
            rejected: self.stepper.rejected,
            solves: settling.solves,
            rounds: settling.rounds,
            elements: settling.solution.mesh.elements(),
        }
    }

    /// The error of the tip, m: the sum of the embedded errors of all steps, of the method of order 3 inside that of
    /// order 4, so that it says too much where the motion is smooth; after a jump that is not resolved (see
    /// [`Simulation::warnings`]) two hundredths of the way of the tip besides. The mesh's error is not in it.
    pub fn error_estimate(&self) -> f64 {
        self.stepper.estimate() * self.stepper.arm().length
    }

    /// By how much the steps changed the energy of the arm beside all works, J: negative where they damp what they do
    /// not resolve. Zero but for the error of the steps.
    pub fn energy_gap(&self) -> f64 {
        let units = self.stepper.settling.moving.statics.units;
        self.stepper.ledger.gap()[0] * units.force * units.length
    }

    /// What should be known about the motion until now.
    pub fn warnings(&self) -> Vec<MotionWarning> {
        let warning = |time| MotionWarning::UnresolvedJump { time };
        self.stepper.unresolved_jump().map(warning).into_iter().collect()
    }

    /// What happened until the end of the last step, in order: the first 10000 events.
    pub fn events(&self) -> &[MotionEvent] {
        &self.stepper.events
    }

    /// The arm at the place `s` (m, kept within the arm) at the present time.
    pub fn station(&self, s: f64) -> MotionStation {
        let settling = &self.stepper.settling;
        let length = settling.moving.statics.units.length;
        station(&self.asked, &settling.solution.mesh, &settling.system, length, s.clamp(0.0, length))
    }

    /// What the equilibria of the same loads are asked with.
    ///
    /// # Errors
    /// [`MotionError::Start`] where the statics refuse the arm.
    pub fn quasi_static(&self) -> Result<QuasiStatic, MotionError> {
        QuasiStatic::new(self.stepper.arm(), self.stepper.inputs.clone())
    }

    /// What it takes to go on from the present time in another run, see [`Simulation::resume`].
    pub fn state(&self) -> MotionState {
        let (stepper, settling) = (&self.stepper, &self.stepper.settling);
        let units = settling.moving.statics.units;
        let energy = units.force * units.length;
        let (next, running) = stepper.next_step();
        let at_end = self.time == stepper.time;
        let [works, powers] = stepper.ledger.at(stepper.share_at(self.time), stepper.step);
        let mut tensions = vec![0.0; stepper.arm().cables.len()];
        for cable in settling.moving.held() {
            tensions[cable] = stepper.tension_at(cable, self.time);
        }
        MotionState {
            time: self.time,
            length: units.length,
            nodes: settling.solution.mesh.nodes().to_vec(),
            values: flat(&self.asked.values),
            rates: flat(&self.asked.rates),
            second: flat(&self.asked.second),
            contact: settling.contact().map(|[x, y, m]| [x * units.force, y * units.force, m * energy]).collect(),
            tensions,
            works: works.map(|work| work * energy).to_vec(),
            powers: powers.map(|power| power * energy).to_vec(),
            error: stepper.error,
            next,
            jumped: stepper.jumped,
            smooth: running || !at_end,
        }
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
        self.advance_to(self.time + dt)
    }

    /// Moves on to `time` (s), which is not before the present one.
    ///
    /// # Errors
    /// [`MotionError::Ended`] where the motion ends before.
    pub fn advance_to(&mut self, time: f64) -> Result<Instant, MotionError> {
        if !(time >= self.time && time.is_finite()) {
            return Err(MotionError::Option { option: "time", value: time, expected: "not before the present one" });
        }
        // Steps may pass the time asked for, but not the corners of inputs.
        let far = time + 1e6;
        while self.stepper.time < time {
            self.stepper.advance(far)?;
        }
        let stepper = &self.stepper;
        if stepper.time == time || stepper.step == 0.0 {
            self.asked.clone_from(&stepper.now);
        } else {
            let x = stepper.share_at(time);
            between(&stepper.before, &stepper.now, stepper.step, x, &mut self.asked);
        }
        self.time = time;
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
        if !(every > 0.0 && every.is_finite()) {
            return Err(MotionError::Option { option: "every", value: every, expected: "above 0" });
        }
        let start = self.time;
        let first = self.read();
        if !sink(&first, self) {
            return Ok(());
        }
        for k in 1_u64.. {
            let time = start + k as f64 * every;
            if time > until + 1e-9 * every {
                break;
            }
            let instant = self.advance_to(time)?;
            if !sink(&instant, self) {
                break;
            }
        }
        Ok(())
    }

    /// x, y (m) and theta (rad) at the nodes of the mesh at the present time, with their places s (m).
    pub fn shape(&self) -> Vec<[f64; 4]> {
        let length = self.stepper.arm().length;
        let nodes = self.stepper.settling.solution.mesh.nodes();
        let of = |(i, s): (usize, &f64)| {
            let [theta, x, y] = self.asked.node(i);
            [s * length, x * length, y * length, theta]
        };
        nodes.iter().enumerate().map(of).collect()
    }

    fn read(&mut self) -> Instant {
        let mut arm = self.stepper.arm().clone();
        self.stepper.inputs.apply(&mut arm, self.time);
        let settling = &self.stepper.settling;
        let statics = &settling.moving.statics;
        let units = statics.units;
        let last = self.asked.layout.nodes - 1;
        let ([theta, x, y], [_, u, v]) = (self.asked.node(last), self.asked.node_rate(last));
        self.stations.clear();
        for block in 0..self.asked.layout.blocks {
            let [[nu, eta, mu, slope], _] = self.asked.strains(block);
            self.stations.push(Station { z: [Lanes::of(0.0); N], inner: [nu, eta, mu], closure_slope: slope });
        }
        let [kinetic, strained] = settling.moving.energies(&settling.system, &self.asked);
        let at =
            StationData { weights: &settling.system.gauss.b, steps: settling.system.steps(), stations: &self.stations };
        let energy = units.force * units.length;
        let cables = (0..arm.cables.len())
            .map(|c| {
                let [now, reference] = statics.cable_lengths(c, at);
                let tension = match arm.cables[c].stroke {
                    Some(_) => self.stepper.tension_at(c, self.time),
                    None => arm.cables[c].tension,
                };
                CableMotion { tension, stroke: (reference - now) * units.length }
            })
            .collect();
        let length = units.length;
        let [n_x, n_y, moment] = self.stepper.ledger.base_at(self.time);
        Instant {
            time: self.time,
            tip: [x * length, y * length],
            tip_theta: theta,
            tip_velocity: [u * length, v * length],
            cables,
            kinetic_energy: kinetic * energy,
            strain_energy: strained * energy,
            base_reaction: Wrench::of_base([0.0, n_x, n_y, moment], &units),
            works: self
                .stepper
                .ledger
                .works_at(self.stepper.share_at(self.time), self.stepper.step)
                .in_units_of(energy),
        }
    }
}
