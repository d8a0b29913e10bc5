//! Why there are no derivatives.

use crate::rod::parameter::Unfit;
use crate::statics::engine::Trouble;
use crate::statics::verdict::SolveError;

/// Why there are no derivatives: in the plane, or with [`crate::SpatialError`] in space.
#[derive(Debug, Clone, thiserror::Error)]
pub enum SensitivityError<E = SolveError> {
    /// The arm has no equilibrium.
    #[error(transparent)]
    Solve(E),
    /// The arm has no such quantity.
    #[error(transparent)]
    Unfit(#[from] Unfit),
    /// The tension of a cable whose stroke is commanded.
    #[error("`cable[{0}].tension` follows from the commanded stroke of the cable")]
    Commanded(usize),
    /// The stroke of a cable whose tension is given.
    #[error("`cable[{0}].stroke` follows from the tension of the cable; command the stroke to get this derivative")]
    NotCommanded(usize),
    /// A place off the arm.
    #[error("there is no station at {s} m: the arm is {length} m long")]
    Station {
        /// m.
        s: f64,
        /// Of the arm, m.
        length: f64,
    },
    /// A cable with friction, by its index: which way it slides decides what a change does.
    #[error(
        "`cable[{0}].friction` is above 0: the effect of a change depends on the direction in which the cable slides, so that \
         there is no single derivative; set the friction to 0"
    )]
    Friction(usize),
    /// The support option whose arm is no equilibrium at the tip.
    #[error("sensitivities need a clamped base")]
    Support,
    /// A limit point or a bifurcation.
    #[error("the equilibrium is at a limit point or a bifurcation, where it has no derivative")]
    Singular,
    /// The rounds do not settle.
    #[error("the equilibrium is not accurate enough for derivatives: the last correction was {0:e}")]
    Unsettled(f64),
}

impl From<SolveError> for SensitivityError {
    fn from(error: SolveError) -> Self {
        Self::Solve(error)
    }
}

pub(crate) fn unsettled<E>(trouble: &Trouble) -> SensitivityError<E> {
    match *trouble {
        Trouble::Singular => SensitivityError::Singular,
        Trouble::Stalled(size) => SensitivityError::Unsettled(size),
        Trouble::Section(_) | Trouble::Mesh | Trouble::Spent => SensitivityError::Unsettled(f64::NAN),
    }
}
