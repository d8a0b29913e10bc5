//! The boundary-value problem of one stage in the plane, as the stepper sees it, and how a motion there starts.

use hydrostat_bvp::{Collocation, Correction, Forcing, Gauss, Lanes, Mesh, Real, Solution, Stage, Station};

use super::dimensions::{S, Shape, X};
use super::equations::Moving;
use super::error::MotionError;
use super::history::{History, Layout, Snapshot};
use super::inputs::Inputs;
use super::settling::{Moves, Settling};
use super::start::{check, fair_elements, mesh, mesh_at, not_found};
use super::state::carried_slopes;
use super::works::{Carried, WORKS};
use crate::rod::arm::Arm;
use crate::statics::dimensions::{Guess, L, M, N, Q, Units};
use crate::statics::engine::turn_sections;
use crate::statics::equations::{StationData, StrokeControl};
use crate::statics::solve::{Options, Solver};
use crate::statics::verdict::{SolveError, VerdictKind};

/// The solver of stages in the plane.
pub(super) type Planar = Settling<Moving, S, L>;

impl Moves<S, L> for Moving {
    type Strained = Station<N, L>;

    const COORDINATES: [usize; 2] = [1, 2];
    const CARRIED: &'static [usize] = &[0, 1, 5];

    fn start(arm: &Arm, elements: Option<usize>, tol: f64, time: f64) -> Result<Planar, MotionError> {
        let mut settling = Planar::new(arm);
        start_at_rest(&mut settling, arm, elements, tol, time)?;
        Ok(settling)
    }

    fn sizes(k: f64) -> [f64; S] {
        [1.0, k * k, k * k, k, 1.0 / k, 1.0 / k]
    }

    fn scales(&self) -> &[f64; S] {
        &self.scales
    }

    fn set_rate(&mut self, cv: f64, scales: [f64; S]) {
        (self.cv, self.scales) = (cv, scales);
    }

    fn arm(&self) -> &Arm {
        self.statics.arm()
    }

    fn units(&self) -> Units {
        self.statics.units
    }

    fn mass(&self) -> f64 {
        self.masses.first().map_or(0.0, |own| (own.wall + own.added).0[0])
    }

    fn place_on(&mut self, gauss: &Gauss<M>, solution: &Shape) {
        Self::place_on(self, gauss, solution);
    }

    fn place_ends(&mut self, solution: &Shape) {
        self.statics.place_ends(solution);
    }

    fn jumps_at(&self, s: f64) -> bool {
        self.statics.jumps_at(s)
    }

    fn set_end_rates(&mut self, gauss: &Gauss<M>) {
        Self::set_end_rates(self, gauss);
    }

    fn layout(&self) -> Layout {
        Self::layout(self)
    }

    fn history_mut(&mut self) -> &mut History {
        &mut self.history
    }

    fn largest(&self, correction: &Correction<S, M, 0, L>) -> [f64; 2] {
        [correction.largest(0), correction.largest(X).max(correction.largest(X + 1)) * self.scales[X]]
    }

    fn drag_change(&self) -> f64 {
        Self::drag_change(self)
    }

    fn take_loads(&mut self, arm: &Arm, inputs: &Inputs, time: f64) {
        let [x, y, _] = inputs.stream_acceleration(arm, time);
        self.set_loads(arm, [x, y]);
    }

    fn read(&self, system: &mut Collocation<S, M, 0, L>, solution: &Shape, out: &mut Snapshot) {
        system.take_stations(solution);
        let size = self.scales[X];
        let per = Lanes::of(size);
        for (block, (station, stage)) in system.stations().iter().zip(&solution.stages).enumerate() {
            let own = [station.z[0], per * station.z[X], per * station.z[X + 1]];
            out.take_stage(block, own, stage.inner, stage.closure_slope);
        }
        for (i, z) in solution.nodes.iter().enumerate() {
            out.take_node(i, [z[0], size * z[X], size * z[X + 1]]);
        }
    }

    fn carried_at(&self, solution: &Shape, node: usize) -> Carried {
        let [n_x, n_y, m] = std::array::from_fn(|k| self.scales[k + 1] * solution.nodes[node][k + 1]);
        [n_x, n_y, 0.0, 0.0, 0.0, m]
    }

    /// What sections carry is a start for Newton's method alone: straight between the nodes.
    fn in_shape(arm: &Arm, at: &Snapshot, carried: &[Carried], mesh: Mesh) -> Planar {
        let stage = |block: usize| {
            let [[nu, eta, mu, closure_slope], _] = at.strains(block);
            let [n_x, n_y, _, _, _, m] = carried_slopes(&mesh, carried, block);
            Stage { slope: [mu, n_x, n_y, m], inner: [nu, eta, mu], closure_slope }
        };
        let node = |(i, [n_x, n_y, _, _, _, m]): (usize, &Carried)| {
            let [theta, _, _] = at.node(i);
            [theta, *n_x, *n_y, *m]
        };
        let stages = (0..at.layout.blocks).map(stage).collect();
        let nodes = carried.iter().enumerate().map(node).collect();
        let guess = Guess { mesh: mesh.clone(), nodes, stages, ..Guess::default() };
        let mut settling = Planar::new(arm);
        settling.moving.statics.hold_strokes();
        let force = settling.moving.statics.units.force;
        settling.start_from_statics(&guess, force, mesh);
        settling
    }

    fn is_based(arm: &Arm, at: &Snapshot) -> bool {
        let base = [arm.base.angle, arm.base.x / arm.length, arm.base.y / arm.length];
        at.node::<3>(0).iter().zip(base).all(|(at, base)| (at - base).abs() <= 1e-9)
    }

    fn radius(&self, _: usize) -> Option<Lanes> {
        None
    }

    fn powers(&self, system: &Collocation<S, M, 0, L>, at: &Snapshot, base: Carried) -> [f64; WORKS] {
        Self::powers(self, system, at, base)
    }

    fn energies(&self, system: &Collocation<S, M, 0, L>, at: &Snapshot) -> [f64; 2] {
        Self::energies(self, system, at)
    }

    fn fold_margin(&self, at: &Snapshot) -> [f64; 2] {
        Self::fold_margin(self, at)
    }

    fn stroke_control(&self) -> Option<&StrokeControl> {
        self.statics.stroke_control.as_ref()
    }

    fn stroke_control_mut(&mut self) -> Option<&mut StrokeControl> {
        self.statics.stroke_control.as_mut()
    }

    fn set_tension(&mut self, cable: usize, tension: f64) {
        self.statics.set_tension(cable, tension);
    }

    fn command(&self, stroke_control: &StrokeControl, index: usize) -> f64 {
        self.statics.command(stroke_control, index)
    }

    fn strained(&self, system: &Collocation<S, M, 0, L>, out: &mut Vec<Station<N, L>>) {
        out.clear();
        out.extend(system.stations().iter().map(|station| Station {
            z: [Lanes::of(0.0); N],
            inner: station.inner,
            closure_slope: station.closure_slope,
        }));
    }

    fn stroke(&self, cable: usize, system: &Collocation<S, M, 0, L>, strained: &[Station<N, L>]) -> [f64; 2] {
        self.statics.stroke(cable, station_data(system, strained))
    }

    fn stroke_change(
        &self,
        cable: usize,
        system: &Collocation<S, M, 0, L>,
        strained: &[Station<N, L>],
        correction: &Correction<S, M, 0, L>,
    ) -> f64 {
        self.statics.stroke_change(cable, station_data(system, strained), correction)
    }

    fn pull_by(&self, cable: usize, system: &Collocation<S, M, 0, L>, out: &mut Forcing<S, 0, L>) {
        Self::pull_by(self, cable, system, out);
    }
}

fn station_data<'a>(system: &'a Collocation<S, M, 0, L>, stations: &'a [Station<N, L>]) -> StationData<'a> {
    StationData { weights: &system.gauss.b, steps: system.steps(), stations }
}

impl Planar {
    pub(super) fn new(arm: &Arm) -> Self {
        Self::of(Moving::new(arm))
    }

    /// Takes the unloaded arm, on a mesh for the motion.
    fn start_unloaded(&mut self, mesh: Mesh) {
        let statics = &mut self.moving.statics;
        let base = statics.arm().base;
        let mut shape = Guess::constant(mesh, [base.angle, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        statics.place_on(&self.system.gauss, &shape);
        for (block, stage) in shape.stages.iter_mut().enumerate() {
            stage.inner = statics.reference_in(block);
        }
        turn_sections(&self.system.gauss, &mut shape);
        let force = statics.units.force;
        let mesh = shape.mesh.clone();
        self.start_from_statics(&shape, force, mesh);
    }

    /// Takes the solution of the statics, whose unit of force is `force` (N), on a mesh for the motion.
    pub(super) fn start_from_statics(&mut self, given: &Guess, force: f64, mesh: Mesh) {
        let statics = &self.moving.statics;
        let whole = with_places(given, force / statics.units.force, statics.arm(), &self.system);
        self.start_from(&whole, mesh);
    }
}

/// Settles on the equilibrium of `arm`: that of the statics, or, where these find none and name no limit, the one that
/// Newton's method finds from the unloaded arm (a hinge is too soft for the statics' evidence).
pub(super) fn start_at_rest(
    settling: &mut Planar,
    arm: &Arm,
    elements: Option<usize>,
    tol: f64,
    time: f64,
) -> Result<(), MotionError> {
    check(arm)?;
    let elements = elements.unwrap_or_else(|| fair_elements(arm, tol));
    let of_start = |error: SolveError| MotionError::Start(Box::new(error));
    let mut solver = Solver::new(arm, Options::with_tol((0.01 * tol).clamp(1e-10, 1e-6))).map_err(of_start)?;
    let missing = match solver.solve() {
        Ok(_) => {
            let engine = solver.engine_mut();
            let statics = &mut settling.moving.statics;
            for (c, cable) in
                engine.equations.arm().cables.iter().enumerate().filter(|(_, cable)| cable.stroke.is_some())
            {
                statics.set_tension(c, cable.tension);
            }
            statics.hold_strokes();
            let mesh = mesh_at(engine, elements);
            settling.start_from_statics(&engine.solution, engine.equations.units.force, mesh);
            None
        }
        Err(SolveError::NoEquilibrium(no)) if no.verdict.kind == VerdictKind::NotFound => {
            settling.start_unloaded(mesh(arm, elements));
            Some(SolveError::NoEquilibrium(no))
        }
        Err(error) => return Err(of_start(error)),
    };
    match settling.solve(time, 1e-10).and_then(|()| settling.solve(time, 1e-12)) {
        Ok(()) => Ok(()),
        Err(_) => Err(missing.map_or_else(|| not_found(time, 0.0, None, arm), of_start)),
    }
}

/// The solution of the statics with x and y, from the base, as states, and what it carries times `force`.
fn with_places(given: &Guess, force: f64, arm: &Arm, system: &Collocation<S, M, 0, L>) -> Shape {
    let mut statics = Collocation::<N, M, Q, L>::with(system.gauss.clone());
    statics.take_stations(given);
    let mut out = Solution {
        mesh: given.mesh.clone(),
        directions: given.directions.clone(),
        nodes: Vec::with_capacity(given.nodes.len()),
        stages: Vec::with_capacity(given.stages.len()),
        ends: given.ends.clone(),
    };
    for (station, stage) in statics.stations().iter().zip(&given.stages) {
        let by = Lanes::of(force);
        let (sin, cos) = (station.z[0].map(f64::sin), station.z[0].map(f64::cos));
        let [nu, eta, _] = stage.inner;
        let [theta, n_x, n_y, m] = stage.slope;
        out.stages.push(hydrostat_bvp::Stage {
            slope: [theta, by * n_x, by * n_y, by * m, nu * cos - eta * sin, nu * sin + eta * cos],
            inner: stage.inner,
            closure_slope: stage.closure_slope,
        });
    }
    let (mut x, mut y) = (arm.base.x / arm.length, arm.base.y / arm.length);
    for (i, [theta, n_x, n_y, m]) in given.nodes.iter().copied().enumerate() {
        out.nodes.push([theta, force * n_x, force * n_y, force * m, x, y]);
        if i < given.mesh.elements() {
            let h = given.mesh.step(i);
            for (j, b) in system.gauss.b.iter().enumerate() {
                let slope = out.slope(i, j);
                x += h * b * slope[X];
                y += h * b * slope[X + 1];
            }
        }
    }
    out
}
