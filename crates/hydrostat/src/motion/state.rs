//! The state of a motion, from which another run goes on.

use hydrostat_bvp::{LANES, Lanes, Mesh, Real};

use super::error::MotionError;
use super::history::{Layout, Snapshot};
use super::settling::Moves;
use super::works::{Carried, WORKS};
use crate::rod::arm::Arm;
use crate::statics::dimensions::M;

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
    /// theta, x, y at the stages and nodes, then strains and beta' at the stages, as the solver has them in memory. In
    /// space three coordinates of the turn from [`MotionState::rotations`] stand for theta.
    pub values: Vec<f64>,
    /// Their rates.
    pub rates: Vec<f64>,
    /// Second rates of theta, x, y.
    pub second: Vec<f64>,
    /// In space, the quaternions that stages and nodes turn from; empty in the plane.
    pub rotations: Vec<f64>,
    /// n_f and m_f at the nodes: three numbers each in the plane, six in space.
    pub contact: Vec<Vec<f64>>,
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

    /// The mesh and the motion; refuses what is no state of `arm`.
    pub(super) fn check<P: Moves<S, L>, const S: usize, const L: usize>(
        &self,
        arm: &Arm,
    ) -> Result<(Mesh, Snapshot), MotionError> {
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
        let [turns, places] = P::COORDINATES;
        let (blocks, nodes) = (mesh.elements().div_ceil(LANES) * M, mesh.elements() + 1);
        let layout = Layout { blocks, nodes, turns, places, strains: L };
        let rotations = if turns == 3 { 4 * LANES * (blocks + nodes) } else { 0 };
        let lists = [
            ("values", self.values.len(), LANES * layout.all()),
            ("rates", self.rates.len(), LANES * layout.all()),
            ("second", self.second.len(), LANES * layout.second()),
            ("rotations", self.rotations.len(), rotations),
            ("contact", self.contact.iter().map(Vec::len).sum(), nodes * P::CARRIED.len()),
            ("tensions", self.tensions.len(), arm.cables.len()),
            ("works", self.works.len(), WORKS),
            ("powers", self.powers.len(), WORKS),
        ];
        if let Some((name, found, expected)) = lists.into_iter().find(|(_, found, expected)| found != expected) {
            return refuse(format!("`{name}` has {found} numbers, {expected} are expected"));
        }
        if self.contact.iter().any(|own| own.len() != P::CARRIED.len()) {
            return refuse(format!("`contact` has {} numbers at every node", P::CARRIED.len()));
        }
        let numbers = [&self.values, &self.rates, &self.second, &self.rotations].into_iter().flatten();
        let others = self.tensions.iter().chain(&self.works).chain(&self.powers).chain(self.contact.iter().flatten());
        if !numbers.chain(others).chain([&self.time, &self.error, &self.next]).all(|v| v.is_finite()) {
            return refuse("it has numbers that are not finite".to_owned());
        }
        let [values, rates, second, rotations] =
            [&self.values, &self.rates, &self.second, &self.rotations].map(|list| lanes(list));
        let from = rotations.chunks_exact(4).map(|q| [q[0], q[1], q[2], q[3]]).collect();
        let motion = Snapshot { layout, values, rates, second, from };
        if !P::is_based(arm, &motion) {
            return refuse("the base is not where it was at its end, and cannot jump".to_owned());
        }
        Ok((mesh, motion))
    }

    /// What nodes carry, with `force` (N) as the unit of force.
    pub(super) fn carried(&self, components: &[usize], force: f64) -> Vec<Carried> {
        let at = |own: &Vec<f64>| {
            let mut out = [0.0; 6];
            for (k, value) in components.iter().zip(own) {
                out[*k] = value / if *k < 3 { force } else { force * self.length };
            }
            out
        };
        self.contact.iter().map(at).collect()
    }
}

/// Slopes in a block of stages of what nodes carry, straight between them.
pub(super) fn carried_slopes(mesh: &Mesh, carried: &[Carried], block: usize) -> [Lanes; 6] {
    let mut out = [Lanes::of(0.0); 6];
    for lane in 0..LANES {
        let i = (block / M * LANES + lane).min(mesh.elements() - 1);
        for (k, slope) in out.iter_mut().enumerate() {
            slope.0[lane] = (carried[i + 1][k] - carried[i][k]) / mesh.step(i);
        }
    }
    out
}

/// A list of numbers as blocks of four.
fn lanes(list: &[f64]) -> Vec<Lanes> {
    list.chunks_exact(LANES).map(|chunk| Lanes(std::array::from_fn(|lane| chunk[lane]))).collect()
}

/// Blocks of four as a list of numbers.
pub(super) fn flat(list: &[Lanes]) -> Vec<f64> {
    // Lanes that no element fills may hold anything.
    list.iter().flat_map(|lanes| lanes.0).map(|v| if v.is_finite() { v } else { 0.0 }).collect()
}
