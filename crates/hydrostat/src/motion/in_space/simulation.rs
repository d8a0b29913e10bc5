//! A run in space: the motion at the times asked for, one by one.

use hydrostat_bvp::{Groups, Lanes, Stage, each};

use super::equations::{COORDINATES, S, SpatialMoving};
use super::quasi_static::SpatialQuasiStatic;
use crate::motion::error::MotionError;
use crate::motion::event::MotionEvent;
use crate::motion::inputs::Inputs;
use crate::motion::options::{CableMotion, MotionOptions, MotionStatistics};
use crate::motion::run::Run;
use crate::motion::state::MotionState;
use crate::motion::warning::MotionWarning;
use crate::motion::works::Works;
use crate::rod::arm::Arm;
use crate::spatial::cable_paths::StageData;
use crate::spatial::configuration::angle_to_tangent;
use crate::spatial::equations::{L, M, N};
use crate::spatial::inertia::Turn;
use crate::spatial::rotation::{Directors, turned_by};
use crate::spatial::{SpatialTip, SpatialWrench};

/// The motion in space at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialInstant {
    /// s.
    pub time: f64,
    /// The tip.
    pub tip: SpatialTip,
    /// Velocity of the tip, m/s.
    pub tip_velocity: [f64; 3],
    /// One a cable, in the arm's order.
    pub cables: Vec<CableMotion>,
    /// Kinetic energy of the arm (without that of the water), J.
    pub kinetic_energy: f64,
    /// 1/2 int sum C (strain - reference)^2 A ds, J: the energy of strain where the volume law is `none`, else a
    /// measure.
    pub strain_energy: f64,
    /// What support and cable anchors exert on the arm at the base: force (N) and moment about r(0) (N m), in space.
    pub base_reaction: SpatialWrench,
    /// What was done on the arm since the start. Kinetic energy and that of strain less [`Works::sum`] are constant.
    pub works: Works,
}

/// The arm at one place and time, in space.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpatialMotionStation {
    /// Arc length of the undeformed arm from the base, m.
    pub s: f64,
    /// Centreline, m.
    pub place: [f64; 3],
    /// Director normal to the section.
    pub a: [f64; 3],
    /// Director in the section.
    pub b: [f64; 3],
    /// Director in the section, a x b.
    pub c: [f64; 3],
    /// nu, eta, zeta, then tau, kappa, mu (1/m).
    pub strains: [f64; 6],
    /// Velocity of the centreline, m/s.
    pub velocity: [f64; 3],
    /// Rate of turn of the section, in space, rad/s.
    pub omega: [f64; 3],
}

/// An arm in motion in space; [`Simulation`](crate::Simulation) is that in the plane. An arm without
/// [`Arm::space`] may leave its plane here.
///
/// ```
/// use hydrostat::{Arm, Cable, Course, Inputs, MotionOptions, Profile, Space, SpatialSimulation};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.dynamics.relaxation_time = 2.7e-3; // s
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
/// arm.cables.push(Cable::new("up", Profile::linear(0.005, 0.001)).at_angle(1.5));
/// arm.space = Some(Space::default());
/// let mut inputs = Inputs::default();
/// inputs.set("cable[1].tension", Course::ramp(0.0, 0.1, 0.0, 0.1))?; // N over s
/// let options = MotionOptions { tol: 1e-3, ..MotionOptions::default() };
/// let mut simulation = SpatialSimulation::new(&arm, inputs, options)?;
/// let later = simulation.step(0.05)?; // s
/// assert!(later.tip.z > later.tip.y.abs(), "it bends to the side of the pulled cable");
/// # Ok::<(), hydrostat::MotionError>(())
/// ```
#[derive(Debug, Clone)]
pub struct SpatialSimulation {
    run: Run<SpatialMoving, S, L>,
    stages: Vec<Stage<N, L>>,
}

impl SpatialSimulation {
    /// The arm at rest in the equilibrium of its loads just before the start.
    ///
    /// # Errors
    /// [`MotionError`] where an option, the arm or an input is refused, or where there is no equilibrium.
    pub fn new(arm: &Arm, inputs: Inputs, options: MotionOptions) -> Result<Self, MotionError> {
        let mut arm = arm.clone();
        arm.space.get_or_insert_default();
        Ok(Self { run: Run::new(&arm, inputs, options)?, stages: Vec::new() })
    }

    /// Goes on from the end of another run in space, see [`Simulation::resume`](crate::Simulation::resume).
    ///
    /// # Errors
    /// [`MotionError`] where an option, the arm, an input or the state is refused.
    pub fn resume(arm: &Arm, inputs: Inputs, options: MotionOptions, state: &MotionState) -> Result<Self, MotionError> {
        let mut arm = arm.clone();
        arm.space.get_or_insert_default();
        Ok(Self { run: Run::resume(&arm, inputs, options, state)?, stages: Vec::new() })
    }

    /// What it takes to go on from the present time in another run, see [`SpatialSimulation::resume`].
    pub fn state(&self) -> MotionState {
        self.run.state()
    }

    /// What the equilibria of the same loads are asked with.
    ///
    /// # Errors
    /// [`MotionError::SpatialStart`] where the statics refuse the arm.
    pub fn quasi_static(&self) -> Result<SpatialQuasiStatic, MotionError> {
        SpatialQuasiStatic::new(self.run.stepper.arm(), self.run.stepper.inputs.clone())
    }

    /// The time of the last answer, s.
    pub fn time(&self) -> f64 {
        self.run.time
    }

    /// What the run took until now.
    pub fn statistics(&self) -> MotionStatistics {
        self.run.statistics()
    }

    /// The error of the tip, m, see [`Simulation::error_estimate`](crate::Simulation::error_estimate).
    pub fn error_estimate(&self) -> f64 {
        self.run.error_estimate()
    }

    /// By how much the steps changed the energy of the arm beside all works, J.
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

    /// The motion at the present time.
    pub fn now(&mut self) -> SpatialInstant {
        self.read()
    }

    /// Moves on by `dt` (s).
    ///
    /// # Errors
    /// [`MotionError::Ended`] where the motion ends before; the last answer stands.
    pub fn step(&mut self, dt: f64) -> Result<SpatialInstant, MotionError> {
        self.advance_to(self.run.time + dt)
    }

    /// Moves on by `dt` (s) while loads change, see [`Simulation::step_to`](crate::Simulation::step_to).
    ///
    /// # Errors
    /// As there.
    pub fn step_to(&mut self, dt: f64, loads: &[(&str, f64)]) -> Result<SpatialInstant, MotionError> {
        self.run.step_to(dt, loads, || true)?;
        Ok(self.read())
    }

    /// As [`SpatialSimulation::step_to`] for as long as `go_on` is true, see
    /// [`Simulation::step_to_while`](crate::Simulation::step_to_while).
    ///
    /// # Errors
    /// As there.
    pub fn step_to_while(
        &mut self,
        dt: f64,
        loads: &[(&str, f64)],
        go_on: impl FnMut() -> bool,
    ) -> Result<SpatialInstant, MotionError> {
        self.run.step_to(dt, loads, go_on)?;
        Ok(self.read())
    }

    /// Moves on to `time` (s), which is not before the present one.
    ///
    /// # Errors
    /// [`MotionError::Ended`] where the motion ends before.
    pub fn advance_to(&mut self, time: f64) -> Result<SpatialInstant, MotionError> {
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
        mut sink: impl FnMut(&SpatialInstant, &Self) -> bool,
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

    /// s, x, y, z (m) at the nodes of the mesh at the present time.
    pub fn shape(&self) -> Vec<[f64; 4]> {
        let length = self.run.stepper.arm().length;
        let nodes = self.run.stepper.settling.solution.mesh.nodes();
        let of = |(i, s): (usize, &f64)| {
            let [[x, y, z], _] = self.run.asked.node_place(i);
            [s * length, x * length, y * length, z * length]
        };
        nodes.iter().enumerate().map(of).collect()
    }

    /// The arm at the place `s` (m, kept within the arm) at the present time, by the polynomials through nodes and
    /// stages.
    pub fn station(&self, s: f64) -> SpatialMotionStation {
        let (at, settling) = (&self.run.asked, &self.run.stepper.settling);
        let (mesh, gauss) = (&settling.solution.mesh, &settling.system.gauss);
        let length = settling.moving.statics.units.length;
        let fraction = (s / length).clamp(0.0, 1.0);
        let element = mesh.element_of(fraction).min(mesh.elements() - 1);
        let x = (fraction - mesh.nodes()[element]) / mesh.step(element);
        let (stages, ends) = gauss.cardinals_with_ends(x);
        let strain_weights = gauss.cardinals(x);
        let groups = Groups { elements: mesh.elements(), stages: M };
        let mut out = SpatialMotionStation { s: fraction * length, ..SpatialMotionStation::default() };
        let mut q = [0.0; 4];
        let mut add = |weight: f64, own: [f64; 4], place: [f64; 3], velocity: [f64; 3], omega: [f64; 3]| {
            q = each(|k| q[k] + weight * own[k]);
            out.place = each(|k| out.place[k] + weight * length * place[k]);
            out.velocity = each(|k| out.velocity[k] + weight * length * velocity[k]);
            out.omega = each(|k| out.omega[k] + weight * omega[k]);
        };
        for (i, weight) in [(element, ends[0]), (element + 1, ends[1])] {
            let [place, velocity] = at.node_place(i);
            let own = at.rotation(i);
            add(weight, own, place, velocity, Directors::of(&own).to_space(&at.omega(i)));
        }
        for (j, weight) in stages.iter().enumerate() {
            let (block, lane) = groups.at(element, j);
            let lanes = |v: &[Lanes]| -> [f64; 3] { each(|k| v[k].0[lane]) };
            let [coordinates, rates] = at.stage::<COORDINATES>(block);
            let turn = Turn { c: lanes(&coordinates), v: lanes(&rates), a: [0.0; 3] };
            let own = turned_by(&at.from[block].map(|v| v.0[lane]), &turn.c);
            let omega = Directors::of(&own).to_space(&turn.rates()[0]);
            add(*weight, own, lanes(&coordinates[3..]), lanes(&rates[3..]), omega);
            let [strains, _] = at.strains::<{ L + 1 }>(block);
            let size = |k: usize| if k < 3 { 1.0 } else { 1.0 / length };
            out.strains = each(|k| out.strains[k] + strain_weights[j] * size(k) * strains[k].0[lane]);
        }
        let Directors { a, b, c } = Directors::of(&q);
        SpatialMotionStation { a, b, c, ..out }
    }

    fn read(&mut self) -> SpatialInstant {
        let arm = self.run.arm();
        let (run, stepper) = (&self.run, &self.run.stepper);
        let settling = &stepper.settling;
        let statics = &settling.moving.statics;
        let units = statics.units;
        self.stages.clear();
        for block in 0..run.asked.layout.blocks {
            let [[inner @ .., closure_slope], _] = run.asked.strains::<{ L + 1 }>(block);
            self.stages.push(Stage { inner, closure_slope, ..Stage::default() });
        }
        let [kinetic, strained] = settling.moving.energies(&settling.system, &run.asked);
        let at = StageData { weights: &settling.system.gauss.b, steps: settling.system.steps(), stages: &self.stages };
        let energy = units.force * units.length;
        let cables = arm.cables.iter().enumerate().map(|(c, cable)| {
            let [now, reference] = statics.cable_lengths(c, at);
            let tension = if cable.stroke.is_some() { stepper.pulls.tension_at(c, run.time) } else { cable.tension };
            CableMotion { tension, stroke: (reference - now) * units.length }
        });
        let cables = cables.collect();
        let carried = stepper.ledger.base_at(run.time);
        // Taken from zero, what is nothing is 0 and not -0.
        let base_reaction = SpatialWrench {
            force: each(|k| 0.0 - units.force * carried[k]),
            moment: each(|k| 0.0 - energy * carried[3 + k]),
        };
        let tip = self.station(units.length);
        let [x, y, z] = tip.place;
        SpatialInstant {
            time: run.time,
            tip: SpatialTip { x, y, z, a: tip.a, b: tip.b, c: tip.c, alpha: angle_to_tangent(&tip.strains) },
            tip_velocity: tip.velocity,
            cables,
            kinetic_energy: kinetic * energy,
            strain_energy: strained * energy,
            base_reaction,
            works: run.works(),
        }
    }
}
