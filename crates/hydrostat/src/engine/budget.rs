//! How much work a solve may be, counted so that every machine ends it at the same place.
//!
//! A piece of work is one evaluation of the section law and the loads at a station, more with many cables ([`crate::Arm::dearness`]). All ways of a solve to its answer are finite in themselves, but meshes of an arm that winds thousands of times
//! through the stream are long, and rounds on them many.

use super::{Engine, Trouble};

/// The work of one solve: some seconds.
pub(crate) const WORK: usize = 4_000_000;

impl Engine {
    /// Work done since [`Engine::allow`].
    pub(crate) fn work(&self) -> usize {
        self.done_beside + self.equations.work + self.check_equations.work
    }

    /// Allows so much work from now on.
    pub(crate) fn allow(&mut self, work: usize) {
        (self.equations.work, self.check_equations.work, self.done_beside) = (0, 0, 0);
        self.allowed = work;
    }

    /// Goes on counting, and allows whatever is done from now on.
    pub(crate) fn lift_limit(&mut self) {
        self.allowed = usize::MAX;
    }

    /// What is left to be done.
    pub(crate) fn left(&self) -> usize {
        self.allowed.saturating_sub(self.work())
    }

    /// Counts work that another engine did for this one's solve.
    pub(crate) fn count_beside(&mut self, work: usize) {
        self.done_beside += work;
    }

    /// The work that was done, where that is all that was allowed.
    pub(crate) fn spent(&self) -> Option<usize> {
        (self.left() == 0).then(|| self.work())
    }

    /// Refuses to go on where nothing is left.
    pub(super) fn may_go_on(&self) -> Result<(), Trouble> {
        if self.left() == 0 { Err(Trouble::Spent) } else { Ok(()) }
    }
}
