//! Where Newton starts from.

use hydrostat_bvp::{Collocation, Gauss, Lanes, Mesh, Side, Solution};

use super::discrete::Engine;
use super::trouble::Trouble;
use crate::numerics::rounds::evaluate;
use crate::statics::dimensions::{Guess, M};

impl Engine {
    /// Strains from the cables alone (no stream, weight or tip load): a start that is exact when
    /// nothing else acts.
    pub(crate) fn start_from_cables(&mut self, elements: usize) -> Result<(), Trouble> {
        self.place_unloaded(Mesh::uniform(elements, &self.breaks));
        self.strains_from_cables()?;
        turn_sections(&self.system.gauss, &mut self.solution);
        Ok(())
    }

    /// The unloaded arm: reference strains, nothing carried.
    pub(crate) fn start_unloaded(&mut self, elements: usize) {
        self.place_unloaded(Mesh::uniform(elements, &self.breaks));
        turn_sections(&self.system.gauss, &mut self.solution);
    }

    /// Stations on a mesh, each with the reference strains, and nothing carried.
    fn place_unloaded(&mut self, mesh: Mesh) {
        self.meshes += 1;
        let angle = self.equations.arm().base.angle;
        self.solution = Solution::constant(mesh, [angle, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        self.equations.place_on(&self.system.gauss, &self.solution);
        for (block, stage) in self.solution.stages.iter_mut().enumerate() {
            stage.inner = self.equations.reference_in(block);
        }
        self.match_closure();
    }

    fn strains_from_cables(&mut self) -> Result<(), Trouble> {
        let whole = self.equations.fraction;
        let mut fine = self.take_strains().is_ok();
        if !fine {
            // Raise the tensions in steps, each from the strains of the last.
            for k in 1..=16 {
                self.equations.fraction[1] = whole[1] * f64::from(k) / 16.0;
                fine = self.take_strains().is_ok();
                if !fine {
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
    pub(crate) fn choose_sides(&mut self) -> bool {
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
}

/// Turns the sections by the bending strain of each station, from the base, with nothing carried.
pub(crate) fn turn_sections(gauss: &Gauss<M>, solution: &mut Guess) {
    let zero = Lanes::default();
    for stage in &mut solution.stages {
        stage.slope = [stage.inner[2], zero, zero, zero];
    }
    for i in 0..solution.mesh.elements() {
        let h = solution.mesh.step(i);
        let mut next = solution.nodes[i];
        for (j, b) in gauss.b.iter().enumerate() {
            next[0] += h * b * solution.slope(i, j)[0];
        }
        solution.nodes[i + 1] = next;
    }
}

/// The end of element `i` towards which disturbances of beta fade, by its largest reach.
pub(crate) fn wanted_side<const S: usize, const P: usize, const I: usize>(
    system: &Collocation<S, M, P, I>,
    solution: &Solution<S, M, I>,
    i: usize,
) -> Side {
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

/// Reach over the length of an element up to which either end may be its own.
const HARMLESS: f64 = 0.02;
