//! What paths to the loads of an arm ask of an engine beside what all paths ask for.

use super::traced::Traced;
use crate::statics::phase::Phase;
use crate::statics::shape::Pose;

/// One arm's equations with the loads that a path leads to.
pub(crate) trait Loaded: Traced {
    /// Where the tip is.
    type Tip: Pose;
    /// A jump from a limit point.
    type Snap: Clone;
    /// The unknowns of a solution.
    type Guess: Clone;

    fn guess(&self) -> Self::Guess;
    fn take_guess(&mut self, guess: &Self::Guess);
    /// The tip at the solution; `None` where the section there is at its limit.
    fn tip(&self) -> Option<Self::Tip>;
    /// The place of the tip from the base at the last round, over L.
    fn tip_place(&self) -> [f64; 3];
    fn snap(phase: Phase, load_fraction: f64, before: Self::Tip, after: Self::Tip) -> Self::Snap;
    /// How far (m) the tip jumps, and by how much (rad) it turns.
    fn jump(snap: &Self::Snap) -> [f64; 2];
    /// The work that was done, where none is left to be done.
    fn spent(&self) -> Option<usize>;
    /// Whether the arm may lie in the stream with angles whose signs decide where it goes.
    fn may_be_in_line(&mut self) -> bool;
    /// The place (over L) that is nearest to a jump of the stream's load, where loads can jump.
    fn place_of_jump(&mut self) -> Option<f64>;
}
