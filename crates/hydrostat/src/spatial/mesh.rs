//! Estimates of the error on a mesh in space, and what its refinement needs to know.

use hydrostat_bvp::Mesh;

use super::engine::{Engine, METHODS, State};
use super::kinks::kink_resolution;
use super::lengths::hold_lengths;
use super::neutral::without_neutral;
use super::rotation::dot;
use crate::numerics::rounds::{correct, linearise};
use crate::rod::arm::Arm;
use crate::statics::engine::Trouble;
use crate::statics::refinement::{Refinable, unseen};

/// What the comparison with one more stage is multiplied by to be the estimate: where the load has kinks nearby, one
/// stage more takes away as little as two thirds of the error.
const SAFE: f64 = 2.0;

impl Refinable for Engine {
    type State = State;

    const MESHES: usize = 12;

    fn arm(&self) -> &Arm {
        self.equations.arm()
    }

    fn mesh(&self) -> &Mesh {
        &self.solution.mesh
    }

    fn remap_to(&mut self, mesh: Mesh) {
        Self::remap_to(self, mesh);
    }

    fn state(&self) -> State {
        Self::state(self)
    }

    fn restore(&mut self, state: &State) {
        Self::restore(self, state);
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn errors(&self) -> &[f64] {
        &self.errors
    }

    fn closing_reaches(&self) -> Vec<(usize, f64)> {
        self.system.closing_reaches().collect()
    }

    fn resolution(&self, tolerance: f64) -> f64 {
        kink_resolution(tolerance, self.equations.arm().model.load_can_jump())
    }

    fn kinks(&mut self, apart: f64) -> Vec<f64> {
        Self::kinks(self, apart)
    }

    fn pin_kinks(&mut self, resolution: f64) -> bool {
        Self::pin_kinks(self, resolution)
    }

    fn iterate(&mut self, goal: f64, most: usize, resolution: Option<f64>) -> Result<(), Trouble> {
        Self::iterate(self, goal, most, resolution)
    }

    fn last(&self) -> f64 {
        self.last
    }

    fn linearise(&mut self) -> Result<(), Trouble> {
        Self::linearise(self)
    }

    fn estimate(&mut self, tolerance: f64, enough: Option<f64>) -> Result<f64, Trouble> {
        if self.spans.len() != self.solution.mesh.elements() {
            return Err(Trouble::Mesh);
        }
        let methods = &*METHODS;
        let (solution, finer) = (&self.solution, &mut self.finer);
        solution.resample(&methods.to_check, finer);
        self.check_equations.fraction = self.equations.fraction;
        self.check_equations.phase = self.equations.phase;
        self.check_equations.take_arm_of(&self.equations);
        self.check_equations.place_on(&methods.check, &self.finer);
        let mut estimate = self.compare()?;
        let unseen = unseen(self.left_over);
        if enough.is_some_and(|enough| estimate.max(unseen) <= enough) {
            return Ok(estimate.max(unseen));
        }
        self.check.contributions(&self.spans, &mut self.errors);
        let contributed: f64 = self.errors.iter().sum();
        if estimate > tolerance && contributed < tolerance {
            // Between nodes the polynomials are less accurate than at them: a second round takes that away.
            self.finer.add(&self.check_correction, 1.0);
            estimate = self.compare()?;
        }
        Ok(estimate.max(unseen))
    }
}

impl Engine {
    /// Moves the solution to another mesh.
    pub(super) fn remap_to(&mut self, mesh: Mesh) {
        std::mem::swap(&mut self.solution, &mut self.before);
        self.solution.mesh = mesh;
        self.meshes += 1;
        let (gauss, equations) = (&self.system.gauss, &self.equations);
        self.before.remap(gauss, |s| equations.jumps_at(s), &mut self.solution);
        self.equations.place_on(gauss, &self.solution);
    }

    /// How far a Newton round with one more stage puts the tip from where the solve has it.
    fn compare(&mut self) -> Result<f64, Trouble> {
        self.may_go_on()?;
        linearise(&mut self.check, &self.check_equations, &self.finer)?;
        self.rounds += 1;
        correct(&mut self.check, &self.finer, &mut self.check_correction);
        without_neutral(&self.check_equations, &self.check, &self.finer, &mut self.check_correction);
        if let Some(stroke_control) = &self.stroke_control {
            hold_lengths(&self.check_equations, &self.check, &self.finer, stroke_control, &mut self.check_correction)?;
        }
        let (total, d) = (self.check.totals(), self.check_correction.total);
        let off = [0, 1, 2].map(|k| total[k] + d[k] - self.tip[k]);
        Ok(SAFE * dot(&off, &off).sqrt())
    }
}
