//! Why there is no fit.

use hydrostat::parameter::Unfit;
use hydrostat::{ArmError, SensitivityError, SolveError, SpatialError};

use crate::quantity::Quantity;
use crate::unknown::Unknown;

/// Why parameters cannot be fitted.
#[derive(Debug, Clone, thiserror::Error)]
pub enum IdentifyError {
    /// Nothing to find.
    #[error("no parameter to fit was given")]
    NoParameter,
    /// Nothing was measured.
    #[error("there is no measured value")]
    NoData,
    /// A parameter twice.
    #[error("`{0}` is given twice")]
    Twice(Unknown),
    /// Bounds, start or prior that make no sense.
    #[error("`{parameter}`: expected {expected}, found {found}")]
    Range {
        /// Which.
        parameter: Unknown,
        /// What it may be, in words.
        expected: &'static str,
        /// What it is, in the parameter's unit.
        found: f64,
    },
    /// A standard deviation that is none.
    #[error(
        "case {case}, {quantity}: expected a finite value and a standard deviation above zero, found {value} and {sd}"
    )]
    Measurement {
        /// The load case.
        case: String,
        /// What was measured.
        quantity: Quantity,
        /// Its value.
        value: f64,
        /// The standard deviation given.
        sd: f64,
    },
    /// A quantity that the case does not have: a cable or a place that is not there, or what is given and does not follow.
    #[error("case {case}: {quantity} {why}")]
    Quantity {
        /// The load case.
        case: String,
        /// What was measured.
        quantity: Quantity,
        /// Why not, in words.
        why: String,
    },
    /// A parameter that the arm of a case does not have.
    #[error("case {case}: {source}")]
    Unfit {
        /// The load case.
        case: String,
        /// Why not.
        source: Unfit,
    },
    /// A case has no answer where the search starts.
    #[error("case {case} has no equilibrium at the start values: {source}")]
    Start {
        /// The load case.
        case: String,
        /// Why.
        source: Box<Trial>,
    },
    /// More to find than was measured, with `rescale`.
    #[error("{measured} measured values do not determine {parameters} parameters and the size of the errors")]
    Freedom {
        /// Numbers measured.
        measured: usize,
        /// Parameters to find.
        parameters: usize,
    },
}

/// Why a load case has no answer at trial values.
#[derive(Debug, Clone, thiserror::Error)]
pub enum Trial {
    /// The values make no arm.
    #[error(transparent)]
    Arm(#[from] ArmError),
    /// No equilibrium, or no derivative.
    #[error(transparent)]
    Sensitivity(#[from] SensitivityError),
    /// The same of an arm in space.
    #[error(transparent)]
    InSpace(#[from] SensitivityError<SpatialError>),
}

impl From<SolveError> for Trial {
    fn from(error: SolveError) -> Self {
        match error {
            SolveError::Arm(error) => Self::Arm(error),
            other => Self::Sensitivity(other.into()),
        }
    }
}
