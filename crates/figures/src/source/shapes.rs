//! The shapes that the source's figure shows.

use hydrostat::Configuration;

use super::claim::Claim;

/// Every shape of the source's Fig. 1, solved.
#[derive(Debug, Clone)]
pub struct Study {
    /// Fig. 1a: tension raised at [`SPEED`](super::SPEED), ending at the highest.
    pub raised: Vec<Configuration>,
    /// Fig. 1b: one tension in ever faster streams.
    pub faster: Vec<Configuration>,
    /// Fig. 1c besides those of 1b: the highest tension in the same streams. Empty where 1b is of that tension.
    pub faster_highest: Vec<Configuration>,
    /// What the text says, held against these shapes.
    pub claims: Vec<Claim>,
}

impl Study {
    /// The shapes whose alpha(s) Fig. 1c shows.
    pub(super) fn angle_configurations(&self) -> Vec<&Configuration> {
        self.faster.iter().chain(&self.faster_highest).collect()
    }

    /// The same, those of each tension by themselves, rising; the highest is the last.
    pub(super) fn rows(&self) -> Vec<&[Configuration]> {
        [&self.faster, &self.faster_highest].into_iter().map(Vec::as_slice).filter(|row| !row.is_empty()).collect()
    }
}
