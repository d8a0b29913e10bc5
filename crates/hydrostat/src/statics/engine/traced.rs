//! The engine of the plane, as paths go along its equilibria.

use hydrostat_bvp::{Correction, Determinant, Mesh};

use super::discrete::{Engine, State};
use super::trouble::Trouble;
use crate::statics::border::NewtonStep;
use crate::statics::configuration::Configuration;
use crate::statics::dimensions::{L, M, N, Q};
use crate::statics::equations::StrokeControl;
use crate::statics::path::name_limit;
use crate::statics::path::traced::{Along, Traced, Turn};
use crate::statics::stability::Stability;
use crate::statics::verdict::VerdictKind;

impl Traced for Engine {
    type Change = Correction<N, M, Q, L>;
    type Nodes = Vec<[f64; N]>;
    type Shape = Configuration;

    fn is_in_a_hurry(&self) -> bool {
        self.in_a_hurry
    }

    fn set(&mut self, along: Along, fraction: f64) {
        match along {
            Along::Phase(phase) => self.set_phase(phase, fraction),
            Along::Range => self.equations.set_range_fraction(fraction),
        }
    }

    fn mesh_of(state: &State) -> &Mesh {
        &state.solution.mesh
    }

    fn nodes(&self) -> Vec<[f64; N]> {
        self.solution.nodes.clone()
    }

    fn largest_turn_since(&self, before: &Vec<[f64; N]>) -> f64 {
        if before.len() != self.solution.nodes.len() {
            return 0.0;
        }
        before.iter().zip(&self.solution.nodes).fold(0.0, |m, (a, b)| f64::max(m, (a[0] - b[0]).abs()))
    }

    fn turns(&self, change: &Self::Change) -> Vec<Turn> {
        change.nodes.iter().map(|z| [0.0, 0.0, z[0]]).collect()
    }

    fn turns_between(&self, before: &State, after: &State) -> Vec<Turn> {
        let (from, to) = (&before.solution, &after.solution);
        let turn = |(s, z): (&f64, &[f64; N])| {
            [0.0, 0.0, z[0] - from.state_in(&self.system.gauss, from.mesh.element_of(*s), *s)[0]]
        };
        to.mesh.nodes().iter().zip(&to.nodes).map(turn).collect()
    }

    fn changed_sides(&self, before: &State) -> f64 {
        let (mesh, gauss, from) = (&self.solution.mesh, &self.system.gauss, &before.solution.mesh);
        let mut fraction = 0.0;
        for (k, s) in self.equations.stations().iter().enumerate() {
            let e = from.element_of(*s);
            let w = gauss.cardinals((s - from.nodes()[e]) / from.step(e));
            let length = mesh.step(k / M) * gauss.b[k % M];
            for side in 0..2 {
                let then: f64 = (0..M).map(|j| w[j] * before.switch(e, j, side)).sum();
                if then * self.switch(k / M, k % M, side) < 0.0 {
                    fraction += length;
                }
            }
        }
        fraction
    }

    fn note_sides(&mut self) {
        self.take_switches();
    }

    fn linearise_at_strokes(&mut self, parameter: bool, round: &mut NewtonStep<Self::Change>) -> Result<(), Trouble> {
        self.linearise_at_strokes(parameter, round)
    }

    fn take_round(&mut self, round: &NewtonStep<Self::Change>, slide: f64) {
        self.system.quadratures(&mut self.spans);
        self.tip = [0.0; Q];
        for (i, span) in self.spans.iter_mut().enumerate() {
            for q in 0..Q {
                span[q] += round.rest.by_element[i][q] + slide * round.response.by_element[i][q];
                self.tip[q] += span[q];
            }
        }
        self.add_round(round, 0, 1.0);
        self.add_round(round, 1, slide);
    }

    fn move_along(&mut self, change: &Self::Change, tensions: &[f64], factor: f64) {
        self.solution.add(change, factor);
        self.add_tensions(tensions, factor);
    }

    fn impose_couple(&mut self, couple: Option<&dyn Fn(f64) -> Turn>) {
        match couple {
            Some(couple) => self.equations.impose_couple(Some(&|s| couple(s)[2])),
            None => self.equations.impose_couple(None),
        }
    }

    fn newton(&mut self, tolerance: f64, most: usize) -> Result<(), Trouble> {
        self.newton(tolerance, most)
    }

    fn last_mut(&mut self) -> &mut f64 {
        &mut self.last
    }

    fn determinant(&self) -> Determinant {
        self.determinant()
    }

    fn pin(&mut self, kinks: &[f64], tolerance: f64) -> bool {
        self.pin(kinks, tolerance)
    }

    fn check_ends(&self) -> Result<(), Trouble> {
        self.check_ends()
    }

    fn name_limit(&mut self, trouble: Option<&Trouble>) -> (VerdictKind, Option<f64>) {
        name_limit(self, trouble)
    }

    fn stroke_control(&self) -> Option<&StrokeControl> {
        self.equations.stroke_control.as_ref()
    }

    fn let_cables_switch(&mut self, may: bool) {
        self.equations.let_cables_switch(may);
    }

    fn switch_active(&mut self, index: usize) -> (usize, bool) {
        self.equations.switch_active(index)
    }

    fn tension(&self, cable: usize) -> f64 {
        self.equations.tension(cable)
    }

    fn command_derivative(&self, index: usize) -> f64 {
        self.equations
            .stroke_control
            .as_ref()
            .map_or(0.0, |stroke_control| self.equations.command_derivative(stroke_control, index))
    }

    fn value_at(&self, fraction: f64) -> f64 {
        self.equations.value_at(fraction)
    }

    fn range_fraction(&self) -> f64 {
        self.equations.range_fraction()
    }

    fn read(&mut self, error: f64) -> Option<Configuration> {
        let statistics = self.statistics(0);
        Configuration::read(self, error * self.equations.units.length, statistics).ok()
    }

    fn stability(shape: &Configuration) -> Option<Stability> {
        shape.stability()
    }
}
