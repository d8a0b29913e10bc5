//! The boundary-value problem of one stage in space, as the stepper sees it.

use hydrostat_bvp::{Collocation, Correction, Forcing, Gauss, LANES, Lanes, Mesh, Real, Stage, each};

use super::equations::{COORDINATES, S, Shape, Spatial, SpatialMoving, X};
use super::start::{at_rest, in_shape};
use crate::motion::error::MotionError;
use crate::motion::history::{History, Layout, Snapshot};
use crate::motion::inputs::Inputs;
use crate::motion::settling::Moves;
use crate::motion::start::force_unit;
use crate::motion::works::{Carried, WORKS};
use crate::rod::arm::Arm;
use crate::spatial::cable_paths::StageData;
use crate::spatial::equations::{FORCE, L, M, N};
use crate::spatial::inertia::Turn;
use crate::spatial::rotation::{Directors, Vector, relative, turned_by};
use crate::statics::dimensions::Units;
use crate::statics::equations::StrokeControl;

impl Moves<S, L> for SpatialMoving {
    type Strained = Stage<N, L>;

    const COORDINATES: [usize; 2] = [3, 3];
    const CARRIED: &'static [usize] = &[0, 1, 2, 3, 4, 5];

    fn start(arm: &Arm, elements: Option<usize>, tol: f64, time: f64) -> Result<Spatial, MotionError> {
        at_rest(arm, elements, tol, time)
    }

    fn sizes(k: f64) -> [f64; S] {
        let mut out = [1.0; S];
        for axis in 0..3 {
            (out[FORCE + axis], out[FORCE + 3 + axis], out[X + axis]) = (k * k, k, 1.0 / k);
        }
        out
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
        self.from = rotations(solution, gauss);
    }

    fn place_ends(&mut self, solution: &Shape) {
        Self::place_ends(self, solution);
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

    /// A change of a quaternion is half a turn.
    fn largest(&self, correction: &Correction<S, M, 0, L>) -> [f64; 2] {
        let most = |of: std::ops::Range<usize>| {
            of.map(|a| correction.largest(a)).fold(0.0, |most: f64, v| if v.is_nan() { v } else { most.max(v) })
        };
        [2.0 * most(0..4), most(X..S) * self.scales[X]]
    }

    fn drag_change(&self) -> f64 {
        let (statics, length) = (&self.statics, self.statics.units.length);
        if statics.arm().flow.density == 0.0 {
            return 0.0;
        }
        let [_, _, _, v @ ..] = self.history.last_rate::<COORDINATES>();
        let against: Vector<f64> = each(|k| statics.water.stream[k] - length * v[k]);
        let speed = against.iter().map(|v| v * v).sum::<f64>().sqrt();
        self.cv * length / speed.max(1e-6 * length)
    }

    fn take_loads(&mut self, arm: &Arm, inputs: &Inputs, time: f64) {
        let length = self.statics.units.length;
        let acceleration = inputs.stream_acceleration(arm, time).map(|v| v / length);
        self.stream_acceleration = if arm.dynamics.inertia { acceleration } else { [0.0; 3] };
        // Tensions of held cables follow from their strokes.
        let tensions = self.statics.tensions.clone();
        self.statics.set_loads(arm);
        for cable in self.stroke_control.iter().flat_map(|stroke_control| &stroke_control.cables) {
            self.statics.set_tension(*cable, tensions[*cable]);
        }
    }

    fn start_step(&mut self, now: &Snapshot) {
        self.from.clone_from(&now.from);
    }

    fn restarted(&self, now: &Snapshot, out: &mut Snapshot) {
        out.clone_from(now);
        let layout = now.layout;
        for block in 0..layout.blocks {
            let ([[c1, c2, c3, ..], [v1, v2, v3, ..]], [a1, a2, a3, ..]) =
                (now.stage::<COORDINATES>(block), now.second::<COORDINATES>(block));
            let turn = Turn { c: [c1, c2, c3], v: [v1, v2, v3], a: [a1, a2, a3] };
            let [omega, omega_rate] = turn.rates();
            out.from[block] = turned_by(&now.from[block], &turn.c);
            for k in 0..3 {
                let own = COORDINATES * block + k;
                out.values[own] = Lanes::of(0.0);
                (out.rates[own], out.second[own]) = (omega[k], omega_rate[k]);
            }
        }
        for i in 0..layout.nodes {
            let turn =
                Turn { c: now.turn_in(&now.values, i), v: now.turn_in(&now.rates, i), a: now.turn_in(&now.second, i) };
            let [omega, omega_rate] = turn.rates();
            let own = layout.blocks + i;
            out.from[own] = turned_by(&now.from[own], &turn.c.map(Lanes::of));
            for k in 0..3 {
                let (block, lane) = layout.at_node(i, k);
                out.values[block].0[lane] = 0.0;
                (out.rates[block].0[lane], out.second[block].0[lane]) = (omega[k], omega_rate[k]);
            }
        }
    }

    fn read(&self, system: &mut Collocation<S, M, 0, L>, solution: &Shape, out: &mut Snapshot) {
        system.take_stations(solution);
        let size = self.scales[X];
        let per = Lanes::of(size);
        out.from.clone_from(&self.from);
        for (block, (station, stage)) in system.stations().iter().zip(&solution.stages).enumerate() {
            let c = relative(&self.from[block], &each(|k| station.z[k]));
            let own: [Lanes; COORDINATES] = each(|k| if k < 3 { c[k] } else { per * station.z[X + k - 3] });
            out.take_stage(block, own, stage.inner, stage.closure_slope);
        }
        for (i, z) in solution.nodes.iter().enumerate() {
            let from = self.from[self.masses.len() + i].map(|v| v.0[0]);
            let c = relative(&from, &each(|k| z[k]));
            let own: [f64; COORDINATES] = each(|k| if k < 3 { c[k] } else { size * z[X + k - 3] });
            out.take_node(i, own);
        }
    }

    fn carried_at(&self, solution: &Shape, node: usize) -> Carried {
        each(|k| self.scales[FORCE + k] * solution.nodes[node][FORCE + k])
    }

    fn in_shape(arm: &Arm, at: &Snapshot, carried: &[Carried], mesh: Mesh) -> Spatial {
        in_shape(arm, at, carried, mesh)
    }

    fn is_based(arm: &Arm, at: &Snapshot) -> bool {
        let base = SpatialMoving::new(arm, force_unit(arm)).statics;
        let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-9);
        let [place, _] = at.node_place(0);
        let (own, wanted) = (at.directors(0), Directors::of(&base.base));
        close(&place, &base.base_place()) && close(&own.a, &wanted.a) && close(&own.b, &wanted.b)
    }

    fn radius(&self, block: usize) -> Option<Lanes> {
        Some(self.statics.places[block].body.radius)
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
        self.stroke_control.as_ref()
    }

    fn stroke_control_mut(&mut self) -> Option<&mut StrokeControl> {
        self.stroke_control.as_mut()
    }

    fn set_tension(&mut self, cable: usize, tension: f64) {
        self.statics.set_tension(cable, tension / self.statics.units.force);
    }

    fn command(&self, stroke_control: &StrokeControl, index: usize) -> f64 {
        self.statics.command(stroke_control, index)
    }

    fn strained(&self, system: &Collocation<S, M, 0, L>, out: &mut Vec<Stage<N, L>>) {
        out.clear();
        out.extend(system.stations().iter().map(|station| Stage {
            inner: station.inner,
            closure_slope: station.closure_slope,
            ..Stage::default()
        }));
    }

    fn stroke(&self, cable: usize, system: &Collocation<S, M, 0, L>, strained: &[Stage<N, L>]) -> [f64; 2] {
        self.statics.stroke(cable, stage_data(system, strained))
    }

    fn stroke_change(
        &self,
        cable: usize,
        system: &Collocation<S, M, 0, L>,
        strained: &[Stage<N, L>],
        correction: &Correction<S, M, 0, L>,
    ) -> f64 {
        self.statics.stroke_change(cable, stage_data(system, strained), correction)
    }

    fn pull_by(&self, cable: usize, system: &Collocation<S, M, 0, L>, out: &mut Forcing<S, 0, L>) {
        Self::pull_by(self, cable, system, out);
    }
}

fn stage_data<'a>(system: &'a Collocation<S, M, 0, L>, stages: &'a [Stage<N, L>]) -> StageData<'a> {
    StageData { weights: &system.gauss.b, steps: system.steps(), stages }
}

/// The rotations of a solution's stages in blocks, then of its nodes, as quaternions of length one.
fn rotations(solution: &Shape, gauss: &Gauss<M>) -> Vec<[Lanes; 4]> {
    let mut system = Collocation::<S, M, 0, L>::with(gauss.clone());
    system.take_stations(solution);
    let unit = |q: [Lanes; 4]| {
        let square = q.iter().fold(Lanes::of(0.0), |sum, v| sum + *v * *v);
        let inverse = Lanes::of(1.0) / square.sqrt();
        q.map(|v| inverse * v)
    };
    let stages = system.stations().iter().map(|station| unit(each(|k| station.z[k])));
    let nodes = solution.nodes.iter().map(|z| unit(each(|k| Lanes::of(z[k]))));
    stages.chain(nodes).collect()
}

impl Snapshot {
    /// c (or its rates) of node `i`, in a list like [`Snapshot::values`].
    pub(super) fn turn_in(&self, list: &[Lanes], i: usize) -> Vector<f64> {
        each(|k| {
            let (block, lane) = self.layout.at_node(i, k);
            list[block].0[lane]
        })
    }

    /// The rotation of node `i` as a quaternion.
    pub(super) fn rotation(&self, i: usize) -> [f64; 4] {
        let from = self.from[self.layout.blocks + i].map(|v| v.0[0]);
        turned_by(&from, &self.turn_in(&self.values, i))
    }

    /// Directors of node `i`.
    pub(super) fn directors(&self, i: usize) -> Directors<f64> {
        Directors::of(&self.rotation(i))
    }

    /// omega of node `i` in its directors.
    pub(super) fn omega(&self, i: usize) -> Vector<f64> {
        let (c, v) = (self.turn_in(&self.values, i), self.turn_in(&self.rates, i));
        Turn { c, v, a: [0.0; 3] }.rates()[0]
    }
}

const _: () = assert!(LANES == 4, "a quaternion's four numbers stand in one block");
