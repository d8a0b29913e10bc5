//! What should be known about a motion.

/// What should be known about a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotionWarning {
    /// A load jumped at this time (s), in a material without memory of rate: no step resolves the waves that this sends
    /// through the arm, and the error estimate says too little.
    UnresolvedJump {
        /// Of the first such jump, s.
        time: f64,
    },
}

impl MotionWarning {
    /// The name in results: `unresolved_jump`.
    pub fn kind(self) -> &'static str {
        match self {
            Self::UnresolvedJump { .. } => "unresolved_jump",
        }
    }

    /// The warning in a sentence.
    pub fn message(self) -> String {
        match self {
            Self::UnresolvedJump { time } => format!(
                "a load jumps at {time} s and the material has no relaxation time: its waves are not resolved, and the \
                 tip is off by more than the tolerance, about two hundredths of its way"
            ),
        }
    }
}
