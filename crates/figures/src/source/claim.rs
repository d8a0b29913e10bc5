//! What the text of the source says, and what numbers say of it.

/// What became of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Finding {
    /// Everywhere that was looked.
    Holds,
    /// Somewhere, and somewhere not.
    InPart,
    /// Nowhere.
    DoesNotHold,
    /// The source gives nothing to measure it by.
    Open,
}

impl Finding {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::InPart => "holds in part",
            Self::DoesNotHold => "does not hold",
            Self::Open => "cannot be decided",
        }
    }

    pub(super) fn of(held: usize, looked: usize) -> Self {
        match held {
            h if h == looked => Self::Holds,
            0 => Self::DoesNotHold,
            _ => Self::InPart,
        }
    }
}

/// A statement of the source and the numbers behind the finding.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// What the source says.
    pub statement: &'static str,
    /// Whether it is so.
    pub finding: Finding,
    /// The numbers.
    pub evidence: String,
}
