//! What a solve is asked for.

/// What has to be accurate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Norm {
    /// Every unknown, at every place of the interval.
    Unknowns,
    /// The unknown of this index (states first, then parameters), at every place. What depends on end values alone is a parameter:
    /// with the condition that says what it is.
    Unknown(usize),
    /// The goal functional ([`Bvp::goal`](crate::Bvp::goal)), relative to the options' floor plus its size.
    Goal,
}

/// What a solve is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// The error allowed, in [1e-13, 0.1]: in the norm below, or, for a goal, of the goal.
    pub tolerance: f64,
    /// What is to be as accurate as that.
    pub norm: Norm,
    /// An unknown z may be off by the tolerance times `floor + |z|`: above zero.
    pub floor: f64,
    /// Most elements of a mesh.
    pub max_elements: usize,
    /// Most meshes.
    pub max_meshes: usize,
    /// Most Newton iterations on a mesh.
    pub max_iterations: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            norm: Norm::Unknowns,
            floor: 1.0,
            max_elements: 10_000,
            max_meshes: 20,
            max_iterations: 40,
        }
    }
}

impl Options {
    /// The default at another tolerance.
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self { tolerance, ..Self::default() }
    }
}
