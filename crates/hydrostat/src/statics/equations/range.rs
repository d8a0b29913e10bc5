//! An arm along the range of a parameter.

use crate::rod::parameter::Parameter;

/// An arm along the range of a parameter.
#[derive(Debug, Clone)]
pub(crate) struct Varied {
    pub(crate) parameter: Parameter,
    /// Values at the shares 0 and 1 of the range.
    pub(crate) from: f64,
    pub(crate) to: f64,
    /// Where the equations are.
    pub(crate) share: f64,
}

impl Varied {
    pub(crate) fn value(&self, share: f64) -> f64 {
        self.from + share * (self.to - self.from)
    }
}
