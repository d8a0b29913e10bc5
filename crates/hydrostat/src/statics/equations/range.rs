//! An arm along the range of a parameter.

use crate::rod::parameter::Parameter;

/// An arm along the range of a parameter.
#[derive(Debug, Clone)]
pub(crate) struct Varied {
    pub(super) parameter: Parameter,
    /// Values at the shares 0 and 1 of the range.
    pub(super) from: f64,
    pub(super) to: f64,
    /// Where the equations are.
    pub(super) share: f64,
}

impl Varied {
    pub(super) fn value(&self, share: f64) -> f64 {
        self.from + share * (self.to - self.from)
    }
}
