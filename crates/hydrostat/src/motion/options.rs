//! How a run is done, what it took, and what is told of its cables.

use super::error::MotionError;

/// How a run is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionOptions {
    /// Error of the tip's position over L that is asked for, in [1e-9, 1e-2].
    pub tol: f64,
    /// When the run starts, s.
    pub start: f64,
    /// Elements of the mesh along the arm; by the tolerance unless given.
    pub elements: Option<usize>,
    /// Length of all steps, s, in place of steps by the tolerance; corners of the inputs still end a step.
    pub step: Option<f64>,
}

impl Default for MotionOptions {
    fn default() -> Self {
        Self { tol: 1e-4, start: 0.0, elements: None, step: None }
    }
}

impl MotionOptions {
    /// Refuses what is out of range.
    pub(super) fn check(&self) -> Result<(), MotionError> {
        let refuse = |option, value, expected| Err(MotionError::Option { option, value, expected });
        if !(1e-9..=1e-2).contains(&self.tol) {
            return refuse("tol", self.tol, "in [1e-9, 1e-2]");
        }
        if !self.start.is_finite() {
            return refuse("start", self.start, "finite");
        }
        if let Some(elements) = self.elements.filter(|n| !(1..=1000).contains(n)) {
            return refuse("elements", elements as f64, "in [1, 1000]");
        }
        if let Some(step) = self.step.filter(|h| !(*h >= 1e-9 && h.is_finite())) {
            return refuse("step", step, "at least 1e-9 s");
        }
        Ok(())
    }
}

/// A cable at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CableMotion {
    /// Tension, N.
    pub tension: f64,
    /// Length reeled in since the reference strains, m.
    pub stroke: f64,
}

/// What a run took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MotionStatistics {
    /// Steps in time.
    pub steps: usize,
    /// Steps that were tried and taken back.
    pub rejected: usize,
    /// Boundary-value problems solved.
    pub solves: usize,
    /// Linearisations of one.
    pub rounds: usize,
    /// Elements of the mesh.
    pub elements: usize,
}
