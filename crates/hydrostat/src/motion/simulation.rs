//! A run: the motion at the times asked for, one by one.

use hydrostat_bvp::{Lanes, Real, Station};

use super::error::MotionError;
use super::history::{Snapshot, between};
use super::inputs::Inputs;
use super::stepper::Stepper;
use crate::rod::area_law::area_derivatives;
use crate::rod::arm::Arm;
use crate::statics::dimensions::{M, N};
use crate::statics::equations::StationData;

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
        let refuse = |option, value, expected| Err(MotionError::Option { option, value, expected });
        if !(1e-9..=1e-2).contains(&options.tol) {
            return refuse("tol", options.tol, "in [1e-9, 1e-2]");
        }
        if !options.start.is_finite() {
            return refuse("start", options.start, "finite");
        }
        if let Some(elements) = options.elements.filter(|n| !(1..=1000).contains(n)) {
            return refuse("elements", elements as f64, "in [1, 1000]");
        }
        if let Some(step) = options.step.filter(|h| !(*h >= 1e-9 && h.is_finite())) {
            return refuse("step", step, "at least 1e-9 s");
        }
        let stepper = Stepper::new(arm, inputs, options.start, options.tol, options.elements, options.step)?;
        Ok(Self { asked: stepper.now.clone(), time: options.start, stepper, stations: Vec::new() })
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

    /// Sum of the embedded errors of all steps at the tip, m: of the method of order 3 inside that of order 4, so
    /// that it says too much where the motion is smooth. The mesh's error is not in it.
    pub fn error_estimate(&self) -> f64 {
        self.stepper.error * self.stepper.arm().length
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
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(MotionError::Option { option: "dt", value: dt, expected: "above 0" });
        }
        if self.stepper.time > self.time {
            let (option, value) = ("time", self.stepper.time);
            let expected = "the end of a step: loads can be led on only in a run of which every step does so";
            return Err(MotionError::Option { option, value, expected });
        }
        let end = self.time + dt;
        let mut arm = self.stepper.arm().clone();
        self.stepper.inputs.apply(&mut arm, self.time);
        for (key, value) in loads {
            self.stepper.inputs.lead(key, *value, &arm, [self.time, end])?;
        }
        while self.stepper.time < end {
            self.stepper.advance(end)?;
        }
        self.asked.clone_from(&self.stepper.now);
        self.time = end;
        Ok(self.read())
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
            let x = 1.0 - (stepper.time - time) / stepper.step;
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
        let groups = statics.groups;
        let (mut kinetic, mut strained) = (0.0, 0.0);
        self.stations.clear();
        for block in 0..self.asked.layout.blocks {
            let [_, [omega, vx, vy]] = self.asked.stage(block);
            let [[nu, eta, mu, slope], _] = self.asked.strains(block);
            let station = Station { z: [Lanes::of(0.0); N], inner: [nu, eta, mu], closure_slope: slope };
            let masses = &settling.moving.masses[block];
            let [area, ..] = area_derivatives(statics.volume, nu);
            let moving = masses.wall * (vx * vx + vy * vy) + masses.rotary * area * omega * omega;
            let strain = statics.strain_energy(block, &station);
            let weight = settling.system.gauss.b[block % M];
            for lane in 0..groups.filled(block / M) {
                let h = weight * settling.system.steps()[block / M].0[lane];
                kinetic += 0.5 * h * moving.0[lane];
                strained += h * strain.0[lane];
            }
            self.stations.push(station);
        }
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
        Instant {
            time: self.time,
            tip: [x * length, y * length],
            tip_theta: theta,
            tip_velocity: [u * length, v * length],
            cables,
            kinetic_energy: kinetic * energy,
            strain_energy: strained * energy,
        }
    }
}
