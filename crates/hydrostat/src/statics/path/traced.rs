//! What paths ask of an engine whose equilibria they go along: that of the plane or that of space.

use hydrostat_bvp::{Determinant, Mesh};

use crate::statics::border::NewtonStep;
use crate::statics::engine::Trouble;
use crate::statics::equations::StrokeControl;
use crate::statics::phase::Phase;
use crate::statics::refinement::Refinable;
use crate::statics::stability::Stability;
use crate::statics::verdict::VerdictKind;

/// A turn of a section, or a couple on it, about its directors: in the plane about c alone.
pub(crate) type Turn = [f64; 3];

/// What the fraction of a path is a fraction of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Along {
    /// The loads of a phase.
    Phase(Phase),
    /// The range of a parameter.
    Range,
}

/// A change of a solution on its mesh.
pub(crate) trait Change: Clone + Default {
    /// Adds `factor` times another change.
    fn add(&mut self, other: &Self, factor: f64);
    /// Multiplies it by `factor`.
    fn scale(&mut self, factor: f64);
}

impl<const N: usize, const S: usize, const Q: usize, const L: usize> Change for hydrostat_bvp::Correction<N, S, Q, L> {
    fn add(&mut self, other: &Self, factor: f64) {
        Self::add(self, other, factor);
    }

    fn scale(&mut self, factor: f64) {
        Self::scale(self, factor);
    }
}

/// One arm's equations and their solution on a mesh.
pub(crate) trait Traced: Clone + Refinable {
    /// A change of a solution.
    type Change: Change;
    /// The state at the nodes.
    type Nodes;
    /// What is read off a solution.
    type Shape;

    /// Whether a path only has to lead to its end.
    fn is_in_a_hurry(&self) -> bool;
    /// Takes the equations at a fraction.
    fn set(&mut self, along: Along, fraction: f64);
    /// The mesh of a solution.
    fn mesh_of(state: &Self::State) -> &Mesh;
    /// The state at the nodes.
    fn nodes(&self) -> Self::Nodes;
    /// The largest turn (rad) of a node since then, on the same mesh; nothing on another.
    fn largest_turn_since(&self, before: &Self::Nodes) -> f64;
    /// The turns of the nodes by a change of the solution.
    fn turns(&self, change: &Self::Change) -> Vec<Turn>;
    /// The turns of the nodes of a state from where sections there are at another.
    fn turns_between(&self, before: &Self::State, after: &Self::State) -> Vec<Turn>;
    /// The fraction of the arm that the stream meets from the other side than it did.
    fn changed_sides(&self, before: &Self::State) -> f64;
    /// Brings what [`Traced::changed_sides`] goes by up to date.
    fn note_sides(&mut self);

    /// Factorises at the solution, and finds correction and response, at held strokes where there are any.
    fn linearise_at_strokes(&mut self, parameter: bool, round: &mut NewtonStep<Self::Change>) -> Result<(), Trouble>;
    /// Adds the correction of a round, and `slide` times its response, to the solution.
    fn take_round(&mut self, round: &NewtonStep<Self::Change>, slide: f64);
    /// Adds `factor` times a change, and changes of the commanded cables' tensions, to the solution.
    fn move_along(&mut self, change: &Self::Change, tensions: &[f64], factor: f64);
    /// Makes the response that to a couple along the arm, over s/L.
    fn impose_couple(&mut self, couple: Option<&dyn Fn(f64) -> Turn>);
    /// Newton on the present mesh until the tip (over L) moves by less than `tolerance`.
    fn newton(&mut self, tolerance: f64, most: usize) -> Result<(), Trouble>;
    /// The size (rad) of the last correction, to be read and set.
    fn last_mut(&mut self) -> &mut f64;
    /// Sign and size of the determinant at the last linearisation.
    fn determinant(&self) -> Determinant;

    /// Moves nodes onto kinks that no pinned node is within `tolerance` of; whether any moved.
    fn pin(&mut self, kinks: &[f64], tolerance: f64) -> bool;
    /// Whether the section law has strains at both ends.
    fn check_ends(&self) -> Result<(), Trouble>;
    /// The limit that the solution is at, with its place, m; `trouble` is what kept it from going on.
    fn name_limit(&mut self, trouble: Option<&Trouble>) -> (VerdictKind, Option<f64>);

    /// The cables whose strokes are commanded.
    fn stroke_control(&self) -> Option<&StrokeControl>;
    /// Whether rounds may change which of them are taut.
    fn let_cables_switch(&mut self, may: bool);
    /// Makes held cable `index` slack that was taut, or the other way round: which it is of the arm's, and whether it
    /// is slack now.
    fn switch_active(&mut self, index: usize) -> (usize, bool);
    /// The tension of a cable, in the unit of force.
    fn tension(&self, cable: usize) -> f64;
    /// The change of the stroke that is commanded of held cable `index`, over L, a unit of the fraction.
    fn command_derivative(&self, index: usize) -> f64;

    /// The parameter's value at a fraction of its range.
    fn value_at(&self, fraction: f64) -> f64;
    /// Where in the range the equations are.
    fn range_fraction(&self) -> f64;
    /// The shape, given the error of its tip over L.
    fn read(&mut self, error: f64) -> Option<Self::Shape>;
    /// Whether a shape is stable.
    fn stability(shape: &Self::Shape) -> Option<Stability>;
}
