//! Why a motion has no answer, or no more of them.

use crate::rod::arm::ArmError;
use crate::rod::parameter::Unfit;
use crate::spatial::SpatialError;
use crate::statics::verdict::SolveError;

/// What ended a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MotionVerdictKind {
    /// nu - y_i beta mu reaches zero: a cable compresses its side of the arm to zero length.
    CableFold,
    /// Net compression crushes the section: nu reaches zero (volume law `none`).
    SectionCrushed,
    /// The section law has no strains that carry the contact force.
    NoSectionSolution,
    /// The same where cables pull on sections that swell and the material has no relaxation time. Waves as short as the
    /// elements grow there, the faster the shorter they are, once steps are short enough to follow them. So it says of
    /// the mesh and the tolerance, not of a limit of the arm.
    ShortWaves,
    /// Steps became too short, and no physical limit was identified.
    NotFound,
    /// The run took as many steps as one may.
    TooManySteps,
}

impl MotionVerdictKind {
    /// The name in results: `cable_fold` and so on.
    pub fn name(self) -> &'static str {
        match self {
            Self::CableFold => "cable_fold",
            Self::SectionCrushed => "section_crushed",
            Self::NoSectionSolution => "no_section_solution",
            Self::ShortWaves => "short_waves",
            Self::NotFound => "not_found",
            Self::TooManySteps => "too_many_steps",
        }
    }

    /// What happens, in a phrase.
    pub fn phrase(self) -> &'static str {
        match self {
            Self::CableFold => "a cable compresses its side of the arm to zero length",
            Self::SectionCrushed => "net compression crushes the section",
            Self::NoSectionSolution => "no section strains carry the contact force",
            Self::ShortWaves => {
                "waves as short as the elements grow, as they may where cables pull and the material has no relaxation \
                 time (set `dynamics.relaxation_time`, or a larger tolerance),"
            }
            Self::NotFound => "no step could be solved, and no physical limit was identified",
            Self::TooManySteps => "the run took as many steps as one may",
        }
    }
}

/// Why a motion ends before its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionVerdict {
    /// Which limit.
    pub kind: MotionVerdictKind,
    /// Up to when the motion is known, s.
    pub time: f64,
    /// Where along the arm (m), if the limit is local.
    pub s: Option<f64>,
    /// The last step that was tried, s.
    pub step: f64,
}

impl MotionVerdict {
    /// What happened, in a sentence with its numbers.
    ///
    /// ```
    /// use hydrostat::{MotionVerdict, MotionVerdictKind};
    ///
    /// let verdict = MotionVerdict { kind: MotionVerdictKind::CableFold, time: 0.5, s: Some(0.2), step: 1e-9 };
    /// let words = "a cable compresses its side of the arm to zero length at s = 0.2000 m, after 0.5";
    /// assert!(verdict.message().starts_with(words));
    /// ```
    pub fn message(&self) -> String {
        let place = self.s.map_or_else(String::new, |s| format!(" at s = {s:.4} m"));
        format!("{}{place}, after {:.6} s (last step {:.1e} s)", self.kind.phrase(), self.time, self.step)
    }
}

/// Why there is no motion, or no more of it.
#[derive(Debug, Clone, thiserror::Error)]
pub enum MotionError {
    /// The numbers do not make an arm, at the start or at some time.
    #[error(transparent)]
    Arm(#[from] ArmError),
    /// An input that the arm does not have.
    #[error(transparent)]
    Unfit(#[from] Unfit),
    /// Something about the arm that cannot move yet.
    #[error("`{key}`: {reason}")]
    Unsupported {
        /// Which key of the arm.
        key: String,
        /// Why.
        reason: &'static str,
    },
    /// An option out of range.
    #[error("`{option}` must be {expected}, found {value}")]
    Option {
        /// Which option.
        option: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// A course of an input that is none.
    #[error("`{key}`: {reason}")]
    Course {
        /// Which input.
        key: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A state that this arm cannot go on from.
    #[error("the earlier motion does not fit: {reason}")]
    State {
        /// What does not fit.
        reason: String,
    },
    /// There is no equilibrium to start from.
    #[error("no equilibrium to start from: {0}")]
    Start(#[from] Box<SolveError>),
    /// The same in space.
    #[error("no equilibrium to start from: {0}")]
    SpatialStart(Box<SpatialError>),
    /// The motion ended before its time.
    #[error("{}", .0.message())]
    Ended(MotionVerdict),
}
