//! Round arms whose loads all act along the axis of the base: nothing prefers a side. A shape that leaves the axis
//! stands for the circle of those that are turned from it about the axis, and a turn about the axis costs nothing.
//!
//! With the unit vector k along the base's a, q the quaternion of a section and i = (0, 1, 0, 0), that neutral turn is
//!
//! ```text
//! dq = 1/2 ((0, k) q - q i),   dn_f = k x n_f,   dm_f = k x m_f,   dr = k x (r - r(0)),
//! ```
//!
//! because the section is round: at the base, where q turns e1 into k, dq is zero. Away from the axis the linearised
//! equations are singular in this direction. What rounding puts into it says nothing, and is taken out of every
//! correction; nor does the sign of the determinant say anything there.

use hydrostat_bvp::{Collocation, Correction, Lanes, Real, Solution};

use super::equations::{Equations, FORCE, L, MOMENT, N, Q};
use super::rotation::{Directors, Vector, cross, dot, spin, turn_of};
use crate::rod::model_options::Support;
use crate::rod::profile::Profile;

/// Directions (sine of the angle) that are along the axis.
const ALONG: f64 = 1e-12;

/// Neutral turns (rad for a radian, root mean square along the arm) below which the arm is on the axis.
const OFF: f64 = 1e-6;

impl Equations {
    /// The axis of the base, where the arm and what acts on it are alike on all sides of it.
    pub(super) fn axis_of_symmetry(&self) -> Option<Vector<f64>> {
        let (arm, space) = (&self.arm, &self.space);
        let Directors { a, .. } = Directors::of(&self.base);
        let along = |v: Vector<f64>| {
            let off = cross(&a, &v);
            dot(&off, &off).sqrt() <= ALONG * dot(&v, &v).sqrt()
        };
        let nothing = |profiles: &[&Profile]| profiles.iter().all(|profile| profile.is_zero());
        let slack = (0..self.ends.len()).all(|c| self.tensions[c] == 0.0 && arm.cables[c].stroke.is_none());
        let (tip, of_arm) = (&arm.tip, &arm.distributed);
        let is_symmetric = self.imposed.is_none()
            && arm.model.support == Support::Clamped
            && slack
            && nothing(&[&arm.reference.eta, &arm.reference.mu, &space.zeta, &space.kappa])
            && nothing(&[&of_arm.force[0], &of_arm.force[1], &of_arm.couple, &space.force])
            && nothing(&[&space.couple[0], &space.couple[1]])
            && (arm.flow.speed == 0.0 || along(arm.stream_in_space()))
            && along(arm.gravity_in_space())
            && along([tip.force[0], tip.force[1], space.tip_force])
            && along([space.tip_moment[0], space.tip_moment[1], tip.moment])
            && [tip.follower[1], space.tip_follower] == [0.0; 2];
        is_symmetric.then_some(a)
    }
}

/// The neutral turn of a state, or of its slope.
fn neutral<R: Real>(axis: &Vector<f64>, z: &[R; N]) -> [R; N] {
    let k = axis.map(R::of);
    let half = R::of(0.5);
    let (w, v) = (z[0], [z[1], z[2], z[3]]);
    let turned = cross(&k, &v);
    let zero = R::of(0.0);
    let own = spin(&[z[0], z[1], z[2], z[3]], &[R::of(1.0), zero, zero]);
    let mut out = [zero; N];
    out[0] = -(half * dot(&k, &v)) - own[0];
    for j in 0..3 {
        out[1 + j] = half * (w * k[j] + turned[j]) - own[1 + j];
    }
    for first in [FORCE, MOMENT] {
        let moved = cross(&k, &[z[first], z[first + 1], z[first + 2]]);
        out[first..first + 3].copy_from_slice(&moved);
    }
    out
}

/// That of the strains, in the directors.
fn neutral_strains(strain: &[Lanes; L]) -> [Lanes; L] {
    let zero = Lanes::of(0.0);
    [zero, -strain[2], strain[1], zero, -strain[5], strain[4]]
}

/// How much of the neutral turn there is in a shape (the square of [`OFF`]'s), and in a change of it.
fn parts<const S: usize>(
    axis: &Vector<f64>,
    solution: &Solution<N, S, L>,
    change: Option<&Correction<N, S, Q, L>>,
) -> [f64; 2] {
    let mut out = [0.0; 2];
    for (i, (z, weight)) in solution.nodes.iter().zip(solution.mesh.node_weights()).enumerate() {
        let own = turn_of(z, &neutral(axis, z));
        out[0] += weight * dot(&own, &own);
        if let Some(change) = change {
            out[1] += weight * dot(&own, &turn_of(z, &change.nodes[i]));
        }
    }
    out
}

/// Takes the neutral turn out of a correction of `solution`, at which `system` was linearised.
pub(super) fn without_neutral<const S: usize>(
    equations: &Equations,
    system: &Collocation<N, S, Q, L>,
    solution: &Solution<N, S, L>,
    correction: &mut Correction<N, S, Q, L>,
) {
    let Some(axis) = equations.axis_of_symmetry() else { return };
    let [own, change] = parts(&axis, solution, Some(correction));
    if own < OFF * OFF {
        return;
    }
    let by = -change / own;
    let lanes = Lanes::of(by);
    for (dz, z) in correction.nodes.iter_mut().zip(&solution.nodes) {
        dz.iter_mut().zip(neutral(&axis, z)).for_each(|(own, turn)| *own += by * turn);
    }
    for (change, stage) in correction.stages.iter_mut().zip(&solution.stages) {
        change.slope.iter_mut().zip(neutral(&axis, &stage.slope)).for_each(|(own, turn)| *own += lanes * turn);
        change.inner.iter_mut().zip(neutral_strains(&stage.inner)).for_each(|(own, turn)| *own += lanes * turn);
    }
    for (change, end) in correction.ends.iter_mut().zip(&solution.ends) {
        change.inner.iter_mut().zip(neutral_strains(&end.inner)).for_each(|(own, turn)| *own += lanes * turn);
    }
    let mut spans = Vec::new();
    system.quadratures(&mut spans);
    for (change, span) in correction.by_element.iter_mut().zip(&spans) {
        let turned = cross(&axis, span);
        for q in 0..Q {
            change[q] += by * turned[q];
            correction.total[q] += by * turned[q];
        }
    }
}

/// Whether a shape is one of a circle of equal ones, turned from each other about the axis of the base.
pub(super) fn is_on_a_circle<const S: usize>(equations: &Equations, solution: &Solution<N, S, L>) -> bool {
    equations.axis_of_symmetry().is_some_and(|axis| parts(&axis, solution, None)[0] >= OFF * OFF)
}
