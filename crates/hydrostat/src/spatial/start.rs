//! Where Newton starts from in space, and the own ends of elements.

use hydrostat_bvp::{Collocation, Gauss, LANES, Mesh, Side, Solution, each};

use super::engine::Engine;
use super::equations::{Guess, L, M, N, Q};
use super::rotation::{spin, times, turned};
use crate::numerics::rounds::evaluate;
use crate::statics::engine::Trouble;

/// Reach over the length of an element up to which either end may be its own.
const HARMLESS: f64 = 0.02;

impl Engine {
    /// Strains from the cables alone (no stream, weight or tip load).
    pub(super) fn start_from_cables(&mut self, elements: usize) -> Result<(), Trouble> {
        self.place_unloaded(Mesh::uniform(elements, &self.breaks));
        self.strains_from_cables()?;
        turn_sections(&self.system.gauss, &mut self.solution);
        Ok(())
    }

    /// The unloaded arm: reference strains, nothing carried.
    pub(super) fn start_unloaded(&mut self, elements: usize) {
        self.start_unloaded_on(Mesh::uniform(elements, &self.breaks));
    }

    /// [`Engine::start_unloaded`] on a mesh.
    pub(super) fn start_unloaded_on(&mut self, mesh: Mesh) {
        self.place_unloaded(mesh);
        turn_sections(&self.system.gauss, &mut self.solution);
    }

    fn place_unloaded(&mut self, mesh: Mesh) {
        self.meshes += 1;
        let mut z = [0.0; N];
        z[..4].copy_from_slice(&self.equations.base);
        let mut inner = [0.0; L];
        inner[0] = 1.0;
        self.solution = Solution::constant(mesh, z, inner);
        self.equations.place_on(&self.system.gauss, &self.solution);
        for (block, stage) in self.solution.stages.iter_mut().enumerate() {
            stage.inner = self.equations.reference_in(block);
        }
        self.match_closure();
    }

    fn strains_from_cables(&mut self) -> Result<(), Trouble> {
        let whole = self.equations.fraction;
        if self.take_strains().is_err() {
            // Raise the tensions in steps, each from the strains of the last.
            for k in 1..=16 {
                self.equations.fraction[1] = whole[1] * f64::from(k) / 16.0;
                if self.take_strains().is_err() {
                    break;
                }
            }
            self.equations.fraction = whole;
        }
        for _ in 0..2 {
            self.take_strains()?;
        }
        Ok(())
    }

    /// The strains that the section law has at the present state, and the slopes of beta that follow.
    fn take_strains(&mut self) -> Result<(), Trouble> {
        evaluate(&mut self.system, &self.equations, &self.solution).map_err(Trouble::Section)?;
        self.system.take_inner(&mut self.solution);
        if self.choose_sides() {
            evaluate(&mut self.system, &self.equations, &self.solution).map_err(Trouble::Section)?;
            self.system.take_inner(&mut self.solution);
        }
        Ok(())
    }

    /// Gives elements the own ends that the reach of beta' at the last evaluation asks for; whether any changed.
    pub(super) fn choose_sides(&mut self) -> bool {
        if !self.solution.directions.is_closed() {
            return false;
        }
        let (solution, system) = (&self.solution, &self.system);
        if (0..solution.mesh.elements()).all(|i| wanted_side(system, solution, i) == solution.directions.side(i)) {
            return false;
        }
        self.turn(wanted_side);
        true
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
    fn turn(&mut self, side: impl Fn(&Collocation<N, M, Q, L>, &Guess, usize) -> Side) {
        std::mem::swap(&mut self.solution, &mut self.before);
        let (system, before, equations) = (&self.system, &self.before, &self.equations);
        let jumps = |s| equations.jumps_at(s);
        before.with_sides(&system.gauss, |i| side(system, before, i), jumps, &mut self.solution);
        self.equations.place_ends(&self.solution);
    }
}

/// Turns the sections by the strains of each station, from the base, with nothing carried: between stages each at the
/// mean rate of both.
fn turn_sections(gauss: &Gauss<M>, solution: &mut Guess) {
    let groups = solution.groups();
    for i in 0..solution.mesh.elements() {
        let h = solution.mesh.step(i);
        let rate = |solution: &Guess, j: usize| {
            let inner = solution.inner(i, j).inner;
            [inner[3], inner[4], inner[5]]
        };
        let node = solution.nodes[i];
        let mut q: [f64; 4] = each(|k| node[k]);
        let mut from = 0.0;
        for j in 0..M {
            let u = rate(solution, j);
            let last = if j > 0 { rate(solution, j - 1) } else { u };
            let mean: [f64; 3] = each(|k| 0.5 * (u[k] + last[k]));
            q = turned(&q, &times(h * (gauss.c[j] - from), &mean));
            from = gauss.c[j];
            let dq = spin(&q, &u);
            let (block, lane) = groups.at(i, j);
            let last_element = i + 1 == solution.mesh.elements();
            for lane in lane..if last_element { LANES } else { lane + 1 } {
                let slope = &mut solution.stages[block].slope;
                for a in 0..N {
                    slope[a].0[lane] = if a < 4 { dq[a] } else { 0.0 };
                }
            }
        }
        q = turned(&q, &times(h * (1.0 - from), &rate(solution, M - 1)));
        let mut next = [0.0; N];
        next[..4].copy_from_slice(&q);
        solution.nodes[i + 1] = next;
    }
}

/// The end of element `i` towards which disturbances of beta fade, by its largest reach.
fn wanted_side(system: &Collocation<N, M, Q, L>, solution: &Guess, i: usize) -> Side {
    let mut largest = 0.0_f64;
    for j in 0..M {
        let reach = system.reach(i, j);
        if reach.abs() > largest.abs() {
            largest = reach;
        }
    }
    if largest.abs() < HARMLESS * solution.mesh.step(i) {
        return solution.directions.side(i);
    }
    if largest >= 0.0 { Side::Left } else { Side::Right }
}
