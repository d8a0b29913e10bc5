//! A solution carried over to another mesh.

use hydrostat_bvp::{Collocation, Mesh, Side, Solution};

use super::discrete::Engine;
use crate::statics::dimensions::{Guess, L, M, N, Q};

impl Engine {
    /// Moves the solution to another mesh.
    pub(crate) fn remap_to(&mut self, mesh: Mesh) {
        std::mem::swap(&mut self.solution, &mut self.before);
        self.solution.mesh = mesh;
        self.remap();
    }

    /// Carries the solution before over to the mesh of the present one.
    pub(super) fn remap(&mut self) {
        self.meshes += 1;
        let (gauss, equations) = (&self.system.gauss, &self.equations);
        self.before.remap(gauss, |s| equations.jumps_at(s), &mut self.solution);
        self.equations.place_on(gauss, &self.solution);
    }

    /// Gives the solution a closure where the equations have one, and none where they have none.
    pub(super) fn match_closure(&mut self) {
        let closed = self.equations.is_closed();
        if closed == self.solution.directions.is_closed() {
            return;
        }
        if closed {
            self.turn(|_, _, _| Side::Left);
            return;
        }
        self.solution.directions.clear();
        self.solution.ends.clear();
        self.equations.place_ends(&self.solution);
    }

    /// Gives every element an own end, given the last linearisation and the solution until now.
    pub(super) fn turn(&mut self, side: impl Fn(&Collocation<N, M, Q, L>, &Guess, usize) -> Side) {
        std::mem::swap(&mut self.solution, &mut self.before);
        let (system, before, equations) = (&self.system, &self.before, &self.equations);
        let jumps = |s| equations.jumps_at(s);
        before.with_sides(&system.gauss, |i| side(system, before, i), jumps, &mut self.solution);
        self.equations.place_ends(&self.solution);
    }

    /// Moves the solution on by each factor times its way from that solution before, one after the other, and nodes on
    /// kinks with it. Left as it is where one of them does not correspond node by node.
    pub(crate) fn lead_on(&mut self, steps: &[(&Guess, f64)]) {
        let Some(next) = led_on(&self.solution, steps) else { return };
        let moved = next.mesh != self.solution.mesh;
        self.solution = next;
        if moved {
            self.equations.place_on(&self.system.gauss, &self.solution);
        }
    }
}

/// A solution moved on as [`Engine::lead_on`] does.
pub(crate) fn led_on<const N: usize, const M: usize, const L: usize>(
    solution: &Solution<N, M, L>,
    steps: &[(&Solution<N, M, L>, f64)],
) -> Option<Solution<N, M, L>> {
    let mut next = solution.clone();
    for (before, fraction) in steps {
        let mesh = next.mesh.extrapolated(&before.mesh, *fraction)?;
        if !next.extrapolate(before, *fraction) {
            return None;
        }
        next.mesh = mesh;
    }
    Some(next)
}
