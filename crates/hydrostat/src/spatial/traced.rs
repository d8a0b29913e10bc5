//! The engine of space, as paths go along its equilibria.

use hydrostat_bvp::{Correction, Determinant, LANES, Mesh, each};

use super::configuration::SpatialConfiguration;
use super::engine::{Engine, State};
use super::equations::{Guess, L, M, N, Q};
use super::rotation::{dot, turn_of};
use crate::statics::border::NewtonStep;
use crate::statics::engine::Trouble;
use crate::statics::equations::StrokeControl;
use crate::statics::limit::limit_at;
use crate::statics::path::traced::{Along, Traced, Turn};
use crate::statics::phase::Phase;
use crate::statics::stability::Stability;
use crate::statics::verdict::VerdictKind;

impl Traced for Engine {
    type Change = Correction<N, M, Q, L>;
    type Nodes = Vec<[f64; N]>;
    type Shape = SpatialConfiguration;

    fn is_in_a_hurry(&self) -> bool {
        self.in_a_hurry
    }

    fn set(&mut self, along: Along, fraction: f64) {
        match along {
            Along::Phase(phase) => {
                self.equations.set_phase(phase, fraction);
                if let Some(stroke_control) = &mut self.stroke_control {
                    stroke_control.fraction = if phase == Phase::Stroke { fraction } else { 1.0 };
                }
            }
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
        largest_turn_between(before, &self.solution)
    }

    fn turns(&self, change: &Self::Change) -> Vec<Turn> {
        self.solution.nodes.iter().zip(&change.nodes).map(|(z, dz)| turn_of(z, dz)).collect()
    }

    fn turns_between(&self, before: &State, after: &State) -> Vec<Turn> {
        let (from, to) = (&before.solution, &after.solution);
        let turn = |(s, z): (&f64, &[f64; N])| {
            let then = from.state_in(&self.system.gauss, from.mesh.element_of(*s), *s);
            turn_of(&then, &each(|k| z[k] - then[k]))
        };
        to.mesh.nodes().iter().zip(&to.nodes).map(turn).collect()
    }

    fn changed_sides(&self, before: &State) -> f64 {
        let (mesh, gauss, from) = (&self.solution.mesh, &self.system.gauss, &before.solution.mesh);
        if before.speeds.is_empty() || self.speeds.is_empty() {
            return 0.0;
        }
        let mut fraction = 0.0;
        for i in 0..mesh.elements() {
            for j in 0..M {
                let s = mesh.nodes()[i] + mesh.step(i) * gauss.c[j];
                let e = from.element_of(s);
                let w = gauss.cardinals((s - from.nodes()[e]) / from.step(e));
                let mut then = [0.0; 4];
                for (l, w) in w.iter().enumerate() {
                    let (along, across) = &before.speeds[e / LANES * M + l];
                    let own = [along, &across[0], &across[1], &across[2]];
                    for k in 0..4 {
                        then[k] += w * own[k].0[e % LANES];
                    }
                }
                let (along, across) = &self.speeds[i / LANES * M + j];
                let across = across.map(|v| v.0[i % LANES]);
                for turned in [then[0] * along.0[i % LANES], dot(&[then[1], then[2], then[3]], &across)] {
                    if turned < 0.0 {
                        fraction += mesh.step(i) * gauss.b[j];
                    }
                }
            }
        }
        fraction
    }

    fn note_sides(&mut self) {
        let flow = &self.equations.arm().flow;
        if flow.speed == 0.0 || flow.density == 0.0 {
            self.speeds.clear();
            return;
        }
        self.take_speeds();
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
        self.solution.add(&round.rest, 1.0);
        self.solution.add(&round.response, slide);
        self.add_tensions(&round.tension[0], 1.0);
        self.add_tensions(&round.tension[1], slide);
    }

    fn move_along(&mut self, change: &Self::Change, tensions: &[f64], factor: f64) {
        self.solution.add(change, factor);
        self.add_tensions(tensions, factor);
    }

    fn impose_couple(&mut self, couple: Option<&dyn Fn(f64) -> Turn>) {
        self.equations.impose_couple(couple);
    }

    fn newton(&mut self, tolerance: f64, most: usize) -> Result<(), Trouble> {
        self.iterate(tolerance, most, None)
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
        self.ends_fine()
    }

    fn name_limit(&mut self, trouble: Option<&Trouble>) -> (VerdictKind, Option<f64>) {
        let mut near = self.nearest_limits();
        let failed = trouble.and_then(Trouble::failed_section);
        if let Some(failure) = &failed {
            near.note_failure(failure);
        }
        let (kind, s) = match limit_at(near, self.equations.volume) {
            Some((kind, s)) => (kind, Some(s)),
            None => (VerdictKind::NotFound, failed.map(|f| f.s)),
        };
        (kind, s.map(|s| s * self.equations.units.length))
    }

    fn stroke_control(&self) -> Option<&StrokeControl> {
        self.stroke_control.as_ref()
    }

    fn let_cables_switch(&mut self, may: bool) {
        if let Some(stroke_control) = &mut self.stroke_control {
            stroke_control.switching = may;
        }
    }

    fn switch_active(&mut self, index: usize) -> (usize, bool) {
        self.switch_active(index)
    }

    fn tension(&self, cable: usize) -> f64 {
        self.equations.tension(cable)
    }

    fn command_derivative(&self, index: usize) -> f64 {
        self.stroke_control
            .as_ref()
            .map_or(0.0, |stroke_control| self.equations.command_derivative(stroke_control, index))
    }

    fn value_at(&self, fraction: f64) -> f64 {
        self.equations.value_at(fraction)
    }

    fn range_fraction(&self) -> f64 {
        self.equations.range_fraction()
    }

    fn read(&mut self, error: f64) -> Option<SpatialConfiguration> {
        let statistics = self.statistics(0);
        SpatialConfiguration::read(self, error * self.equations.units.length, statistics).ok()
    }

    fn stability(shape: &SpatialConfiguration) -> Option<Stability> {
        shape.stability()
    }
}

/// The largest turn (rad) of a node from where it was; 0 on another mesh.
pub(super) fn largest_turn_between(before: &[[f64; N]], solution: &Guess) -> f64 {
    if before.len() != solution.nodes.len() {
        return 0.0;
    }
    let turns = before.iter().zip(&solution.nodes).map(|(old, new)| {
        let by = turn_of(old, &each(|k| new[k] - old[k]));
        dot(&by, &by).sqrt()
    });
    turns.fold(0.0, f64::max)
}
