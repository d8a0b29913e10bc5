//! What a search for tensions asks of a solver: that of the plane or that of space.

use crate::rod::arm::{Arm, ArmError};
use crate::statics::configuration::CableState;
use crate::statics::stability::Stability;

/// A solver of one arm, again and again as its tensions change.
pub(super) trait Reaching: Clone + std::fmt::Debug {
    /// What is to be reached.
    type Goal: Clone + std::fmt::Debug;
    /// The arm under its loads.
    type Shape: Clone + std::fmt::Debug;
    /// One place of it.
    type Place: Clone + std::fmt::Debug;
    /// Why there is no shape.
    type Error;

    /// Whether a goal can be meant of `arm`.
    fn fits(goal: &Self::Goal, arm: &Arm) -> bool;
    /// Places that are looked at beside the tip, m.
    fn stations(goal: &Self::Goal) -> Vec<f64>;

    /// The error of an arm that is none.
    fn wrong(error: ArmError) -> Self::Error;
    /// Solves `arm` from the unloaded one.
    fn begin(arm: &Arm, tolerance: f64) -> Result<Self, Self::Error>;
    /// Keeps nodes at these places (over L) from now on; whether the solution settles with them.
    fn watch(&mut self, places: &[f64]) -> bool;
    /// Sets all tensions (N).
    fn pull(&mut self, tensions: &[f64]) -> Option<()>;
    /// Solves at the present tensions.
    fn settle(&mut self) -> Option<()>;
    /// The same from the last solution, or not at all.
    fn settle_warm(&mut self) -> Option<()>;

    /// The tensions, N.
    fn tensions(&self) -> Vec<f64>;
    /// Strokes of the first cables, over L.
    fn strokes(&self, count: usize) -> Vec<f64>;
    /// Weighted distances to the goal, over L.
    fn rest(&self, goal: &Self::Goal, arm: &Arm) -> Vec<f64>;
    /// Derivatives by the tensions, a row each: of the distances, and after them, if asked for, of the strokes over L.
    /// `None` at a limit point.
    fn derivatives(&self, goal: &Self::Goal, arm: &Arm, of_strokes: bool) -> Option<Vec<Vec<f64>>>;
    /// Place of the tip over L, with the direction of its section.
    fn tip_pose(&self) -> Vec<f64>;
    /// The angle (rad) that the section at the tip has turned by.
    fn turned(&self, from: &Self) -> f64;

    /// The shape.
    fn shape(&mut self) -> Result<Self::Shape, Self::Error>;
    /// The shape that the path of `docs/model.md` leads to, if it leads to one.
    fn on_the_path(arm: &Arm) -> Option<Self::Shape>;
    /// Whether two tips are at the same place.
    fn is_near(a: &Self::Shape, b: &Self::Shape) -> bool;
    /// The arm that a shape is of.
    fn arm(shape: &Self::Shape) -> &Arm;
    /// Its cables.
    fn cables(shape: &Self::Shape) -> &[CableState];
    /// Its stability.
    fn stability(shape: &Self::Shape) -> Option<Stability>;
    /// One place of it, at `s` (m).
    fn place(shape: &Self::Shape, s: f64) -> Self::Place;
    /// The force (N) that bends `arm` a good deal at its length.
    fn unit_force(arm: &Arm) -> f64;
}
