//! Why rounds lead nowhere.

use hydrostat_bvp::LinearisationError;

use crate::statics::equations::SectionFailure;

#[derive(Debug, Clone)]
pub(crate) enum Trouble {
    Section(SectionFailure),
    Singular,
    Stalled(f64),
    Mesh,
    /// The work that was allowed is done.
    Spent,
}

impl Trouble {
    /// The section that has no strains, if that is the trouble.
    pub(crate) fn failed_section(&self) -> Option<SectionFailure> {
        match self {
            Self::Section(failure) => Some(*failure),
            _ => None,
        }
    }
}

impl From<LinearisationError<SectionFailure>> for Trouble {
    fn from(error: LinearisationError<SectionFailure>) -> Self {
        match error {
            LinearisationError::Slopes(failure) => Self::Section(failure),
            LinearisationError::Singular(_) => Self::Singular,
        }
    }
}

/// Corrections (rad) that may go on hopping across a kink of the load.
pub(crate) const HOP: f64 = 1e-4;

/// Newton along a path, where hopping across a kink is good enough.
pub(crate) fn roughly(result: Result<(), Trouble>) -> Result<(), Trouble> {
    match result {
        Err(Trouble::Stalled(size)) if size <= HOP => Ok(()),
        other => other,
    }
}
