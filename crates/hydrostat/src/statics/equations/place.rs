//! The data of an arm at one place, or at four.

use hydrostat_bvp::{LANES, Lanes};

use crate::rod::cable::Offset;
use crate::rod::loads::Body;
use crate::rod::section::{CableAt, Stiffness};

/// One place of the arm as data.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place<R> {
    /// Over L.
    pub(crate) s: R,
    pub(crate) stiffness: Stiffness<R>,
    pub(crate) body: Body<R>,
}

/// Sections at the ends of four elements.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EndSection {
    /// Over L.
    pub(crate) s: Lanes,
    pub(crate) stiffness: Stiffness<Lanes>,
}

#[inline(always)]
pub(super) fn blank_cable() -> CableAt<Lanes> {
    let zero = Lanes([0.0; LANES]);
    CableAt { offset: Offset { y: zero, slope: zero }, tension: zero }
}
