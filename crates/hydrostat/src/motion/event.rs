//! What happens on the way, and when.

/// What happened in a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotionEventKind {
    /// A cable whose stroke is commanded goes slack.
    Slack(usize),
    /// Such a cable becomes taut.
    Taut(usize),
    /// The surface folds over itself: nu - beta R |mu| passes zero at this place (m).
    SurfaceFolds(f64),
    /// It unfolds: nowhere is it folded any more.
    SurfaceUnfolds,
}

impl MotionEventKind {
    /// The name in results: `slack`, `taut`, `surface_folds`, `surface_unfolds`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Slack(_) => "slack",
            Self::Taut(_) => "taut",
            Self::SurfaceFolds(_) => "surface_folds",
            Self::SurfaceUnfolds => "surface_unfolds",
        }
    }

    /// The cable that it happened to.
    pub fn cable(self) -> Option<usize> {
        match self {
            Self::Slack(cable) | Self::Taut(cable) => Some(cable),
            Self::SurfaceFolds(_) | Self::SurfaceUnfolds => None,
        }
    }

    /// Where along the arm, m.
    pub fn place(self) -> Option<f64> {
        match self {
            Self::SurfaceFolds(s) => Some(s),
            Self::Slack(_) | Self::Taut(_) | Self::SurfaceUnfolds => None,
        }
    }
}

/// Something that happened, with its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionEvent {
    /// s.
    pub time: f64,
    /// What.
    pub kind: MotionEventKind,
}
