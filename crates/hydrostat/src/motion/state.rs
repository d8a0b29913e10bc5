//! The state of a motion, from which another run goes on.

use hydrostat_bvp::{LANES, Lanes, Mesh, Real, Stage};

use super::error::MotionError;
use super::history::Snapshot;
use super::in_plane::Planar;
use super::works::WORKS;
use crate::rod::arm::Arm;
use crate::statics::dimensions::{Guess, M};

/// What a motion needs to go on, as plain numbers for a file. Places are over L, times in s, forces in N, moments in
/// N m, energies in J.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MotionState {
    /// s.
    pub time: f64,
    /// Length of the arm, m.
    pub length: f64,
    /// Nodes of the mesh.
    pub nodes: Vec<f64>,
    /// theta, x, y at the stages and nodes, then strains and beta' at the stages, as the solver has them in memory.
    pub values: Vec<f64>,
    /// Their rates.
    pub rates: Vec<f64>,
    /// Second rates of theta, x, y.
    pub second: Vec<f64>,
    /// n_f and m_f at the nodes.
    pub contact: Vec<[f64; 3]>,
    /// Tensions of the cables.
    pub tensions: Vec<f64>,
    /// Works since the start: by cables, water, gravity, loads, base, then dissipated, then of the volume.
    pub works: Vec<f64>,
    /// Their rates.
    pub powers: Vec<f64>,
    /// Sum of the steps' embedded errors at the tip.
    pub error: f64,
    /// The next step; 0 where that is not known.
    pub next: f64,
    /// When a load jumped for the first time, if one did.
    pub jumped: Option<f64>,
    /// Whether accelerations go on as they are: not after a jump, nor under other loads.
    pub smooth: bool,
}

impl MotionState {
    /// The same for a run under other loads, whose accelerations are others.
    pub fn under_other_loads(self) -> Self {
        Self { smooth: false, next: 0.0, ..self }
    }

    /// Refuses what is no state of `arm`.
    pub(super) fn check(&self, arm: &Arm) -> Result<Mesh, MotionError> {
        let refuse = |reason: String| Err(MotionError::State { reason });
        if (self.length / arm.length - 1.0).abs() > 1e-12 {
            return refuse(format!("it is of an arm of {} m, this one has {} m", self.length, arm.length));
        }
        let breaks: Vec<f64> = arm.breaks().iter().map(|s| s / arm.length).collect();
        // A file may have moved a node by its last digit.
        let exact = |node: &f64| breaks.iter().copied().find(|at| (at - node).abs() < 1e-12).unwrap_or(*node);
        let nodes: Vec<f64> = self.nodes.iter().map(exact).collect();
        let Some(mesh) = Mesh::with_nodes(&nodes, &breaks) else {
            return refuse("its mesh is none, or not one of this arm".to_owned());
        };
        let blocks = mesh.elements().div_ceil(LANES) * M;
        let second = LANES * (3 * blocks + mesh.elements() + 1);
        let all = second + LANES * 4 * blocks;
        let lists = [
            ("values", self.values.len(), all),
            ("rates", self.rates.len(), all),
            ("second", self.second.len(), second),
            ("contact", self.contact.len(), mesh.elements() + 1),
            ("tensions", self.tensions.len(), arm.cables.len()),
            ("works", self.works.len(), WORKS),
            ("powers", self.powers.len(), WORKS),
        ];
        if let Some((name, found, expected)) = lists.into_iter().find(|(_, found, expected)| found != expected) {
            return refuse(format!("`{name}` has {found} numbers, {expected} are expected"));
        }
        let numbers = self.values.iter().chain(&self.rates).chain(&self.second).chain(self.contact.iter().flatten());
        let others = self.tensions.iter().chain(&self.works).chain(&self.powers);
        if !numbers.chain(others).chain([&self.time, &self.error, &self.next]).all(|v| v.is_finite()) {
            return refuse("it has numbers that are not finite".to_owned());
        }
        let base = [arm.base.angle, arm.base.x / arm.length, arm.base.y / arm.length];
        let first = LANES * 3 * blocks;
        if (0..3).any(|k| (self.values[first + k] - base[k]).abs() > 1e-9) {
            return refuse("the base is not where it was at its end, and cannot jump".to_owned());
        }
        Ok(mesh)
    }

    /// Puts the state into `settling`, which is new; the motion.
    pub(super) fn restore(&self, settling: &mut Planar, mesh: Mesh) -> Snapshot {
        let blocks = mesh.elements().div_ceil(LANES) * M;
        let lanes = |list: &[f64]| -> Vec<Lanes> {
            list.chunks_exact(LANES).map(|chunk| Lanes(std::array::from_fn(|lane| chunk[lane]))).collect()
        };
        let values = lanes(&self.values);
        let first_strain = 3 * blocks + mesh.elements() + 1;
        // What sections carry is a start for Newton's method alone: straight between the nodes.
        let contact = |i: usize| {
            let [n_x, n_y, m] = self.contact[i.min(mesh.elements())];
            [n_x, n_y, m / self.length]
        };
        let stages = (0..blocks)
            .map(|block| {
                let strain = &values[first_strain + 4 * block..first_strain + 4 * block + 4];
                let mut slope = [strain[2], Lanes::of(0.0), Lanes::of(0.0), Lanes::of(0.0)];
                for lane in 0..LANES {
                    let i = (block / M * LANES + lane).min(mesh.elements() - 1);
                    let (from, to, h) = (contact(i), contact(i + 1), mesh.step(i));
                    for k in 0..3 {
                        slope[k + 1].0[lane] = (to[k] - from[k]) / h;
                    }
                }
                Stage { slope, inner: [strain[0], strain[1], strain[2]], closure_slope: strain[3] }
            })
            .collect();
        let nodes = (0..=mesh.elements())
            .map(|i| {
                let [n_x, n_y, m] = contact(i);
                [values[3 * blocks + i].0[0], n_x, n_y, m]
            })
            .collect();
        let guess = Guess { mesh: mesh.clone(), nodes, stages, ..Guess::default() };
        settling.start_from_statics(&guess, 1.0, mesh);
        settling.system.take_stations(&settling.solution);
        let layout = settling.moving.layout();
        Snapshot { layout, values, rates: lanes(&self.rates), second: lanes(&self.second), from: Vec::new() }
    }
}

/// Blocks of four as a list of numbers.
pub(super) fn flat(list: &[Lanes]) -> Vec<f64> {
    // Lanes that no element fills may hold anything.
    list.iter().flat_map(|lanes| lanes.0).map(|v| if v.is_finite() { v } else { 0.0 }).collect()
}
