//! Estimates of the error on a mesh in the plane, and what its refinement needs to know.

use hydrostat_bvp::Mesh;

use super::discrete::{Engine, METHODS, State};
use super::kinks::kink_resolution;
use super::trouble::Trouble;
use crate::numerics::dispatch::widest;
use crate::numerics::rounds::{correct, linearise};
use crate::rod::arm::Arm;
use crate::statics::refinement::{Refinable, unseen};

/// How close (over L) nodes are kept to kinks of friction.
const OF_FRICTION: f64 = 5e-8;

impl Refinable for Engine {
    type State = State;

    const MESHES: usize = 10;

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

    /// Kinks of friction are given while a shape is looked for, and as beside them chi' is not zero (`friction`), what
    /// a node that is off one costs is of first order.
    fn resolution(&self, tolerance: f64) -> f64 {
        let resolution = kink_resolution(tolerance, self.arm().model.load_can_jump());
        if self.equations.capstan.is_some() { resolution.min(OF_FRICTION) } else { resolution }
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
            // The last Newton rounds on this mesh did not converge: there is nothing to compare with.
            return Err(Trouble::Mesh);
        }
        let methods = &*METHODS;
        let own = &self.equations;
        let (solution, finer) = (&self.solution, &mut self.finer);
        widest(
            #[inline(always)]
            || solution.resample(&methods.to_check, finer),
        );
        self.check_equations.fraction = own.fraction;
        self.check_equations.phase = own.phase;
        self.check_equations.take_arm_of(own);
        self.check_equations.place_on(&methods.check, &self.finer);
        let mut estimate = self.compare()?;
        // What Newton left is in the solution, but not in the tip that its last round foresaw.
        let unseen = unseen(self.left_over);
        if enough.is_some_and(|enough| estimate.max(unseen) <= enough) {
            return Ok(estimate.max(unseen));
        }
        let (check, spans, errors) = (&mut self.check, &self.spans, &mut self.errors);
        widest(
            #[inline(always)]
            || check.contributions(spans, errors),
        );
        let contributed: f64 = self.errors.iter().sum();
        if estimate > tolerance && contributed < tolerance {
            // Between nodes the polynomials are less accurate than at them, and one Newton round
            // from there leaves the square of that in the comparison: a second one removes it.
            self.finer.add(&self.check_correction, 1.0);
            estimate = self.compare()?;
        }
        Ok(estimate.max(unseen))
    }
}

impl Engine {
    /// How far a Newton round with one more stage puts the tip from where the solve has it.
    fn compare(&mut self) -> Result<f64, Trouble> {
        self.may_go_on()?;
        linearise(&mut self.check, &self.check_equations, &self.finer)?;
        self.rounds += 1;
        correct(&mut self.check, &self.finer, &mut self.check_correction);
        let total = self.check.totals();
        let [dx, dy] = self.check_correction.total;
        Ok((total[0] + dx - self.tip[0]).hypot(total[1] + dy - self.tip[1]))
    }
}
