//! What paths to the loads of an arm ask of an engine beside what all paths ask for.

use super::traced::Traced;
use crate::statics::engine::Trouble;
use crate::statics::shape::Pose;

/// One arm's equations with the loads that a path leads to.
pub(crate) trait Loaded: Traced {
    /// Where the tip is.
    type Tip: Pose;
    /// The unknowns of a solution.
    type Guess: Clone;

    /// Whether anything but cables acts.
    fn has_loads(&self) -> bool;
    /// Whether a cable is pulled.
    fn has_tension(&self) -> bool;
    /// Takes the shape of the unloaded arm.
    fn start_unloaded(&mut self);
    /// Says whether a path only has to lead to its end.
    fn hurry(&mut self, hurry: bool);
    fn guess(&self) -> Self::Guess;
    fn take_guess(&mut self, guess: &Self::Guess);
    /// The tip at the solution; `None` where the section there is at its limit.
    fn tip(&self) -> Option<Self::Tip>;
    /// The place of the tip from the base at the last round, over L.
    fn tip_place(&self) -> [f64; 3];
    /// Finds the place of the tip, and what leads to it, of a solution that Newton left on another mesh.
    fn measure(&mut self) -> Result<(), Trouble>;
    /// The work that was done, where none is left to be done.
    fn spent(&self) -> Option<usize>;
    /// Whether the arm may lie in the stream with angles whose signs decide where it goes.
    fn may_be_in_line(&mut self) -> bool;
    /// The place (over L) that is nearest to a jump of the stream's load, where loads can jump.
    fn place_of_jump(&mut self) -> Option<f64>;
}
