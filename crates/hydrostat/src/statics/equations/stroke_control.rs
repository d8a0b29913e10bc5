//! The cables whose stroke is commanded.

/// The cables whose stroke is commanded.
#[derive(Debug, Clone)]
pub(crate) struct StrokeControl {
    /// Their indices among the arm's.
    pub(crate) cables: Vec<usize>,
    /// Whether each is taut: then its tension is unknown and its stroke given, else its tension is zero.
    pub(crate) taut: Vec<bool>,
    /// Strokes that the phase of strokes starts from, over L.
    pub(crate) from: Vec<f64>,
    /// The fraction of the way from these to those commanded.
    pub(crate) fraction: f64,
    /// Whether rounds may change which cables are taut. Along a path that is an event of its own.
    pub(crate) switching: bool,
}

/// Slacks (over L) below which a cable is too short to hang slack.
const SLACK: f64 = 1e-12;

impl StrokeControl {
    /// Of these cables, all slack; `None` of none.
    pub(crate) fn slack(cables: Vec<usize>) -> Option<Self> {
        let count = cables.len();
        let (taut, from) = (vec![false; count], vec![0.0; count]);
        (count > 0).then_some(Self { cables, taut, from, fraction: 1.0, switching: true })
    }

    /// Stroke that is commanded of cable `index` now, `whole` (over L) being the one asked for.
    pub(crate) fn command(&self, index: usize, whole: f64) -> f64 {
        let from = self.from[index];
        if self.fraction == 1.0 { whole } else { from + self.fraction * (whole - from) }
    }

    /// Which of the commanded cables are taut.
    pub(crate) fn taut_cables(&self) -> Vec<usize> {
        (0..self.cables.len()).filter(|index| self.taut[*index]).collect()
    }

    /// The cables that hang slack.
    pub(crate) fn slack_cables(&self) -> impl Iterator<Item = usize> + '_ {
        self.cables.iter().zip(&self.taut).filter(|(_, taut)| !**taut).map(|(cable, _)| *cable)
    }

    /// Lets cables go slack that push, and takes slack ones up that are too short, given what tensions and slacks are;
    /// whether any changed. Those that went slack have no tension from then on.
    pub(crate) fn switch(&mut self, tension: impl Fn(usize) -> f64, slack: &[f64]) -> bool {
        let mut changed = false;
        for ((cable, taut), slack) in self.cables.iter().zip(&mut self.taut).zip(slack) {
            let switches = if *taut { tension(*cable) < 0.0 } else { *slack < -SLACK };
            *taut ^= switches;
            changed |= switches;
        }
        changed
    }
}
