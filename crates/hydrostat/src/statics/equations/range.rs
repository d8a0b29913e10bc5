//! An arm along a range of one parameter, or of several that change together.

use crate::rod::parameter::Parameter;

/// An arm along a range of one parameter, or of several that change together.
#[derive(Debug, Clone)]
pub(crate) struct Varied {
    pub(crate) ways: Vec<Change>,
    /// Where the equations are.
    pub(crate) fraction: f64,
}

/// A parameter with its values at the fractions 0 and 1 of a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Change {
    pub(crate) parameter: Parameter,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

impl Change {
    /// The value at a fraction of the range.
    pub(crate) fn value(self, fraction: f64) -> f64 {
        self.from + fraction * (self.to - self.from)
    }

    /// The change over the whole range.
    pub(crate) fn whole(self) -> f64 {
        self.to - self.from
    }
}
