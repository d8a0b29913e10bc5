//! Why there is no answer, with numbers.

use crate::statics::configuration::{Configuration, Tip};
use crate::statics::snap::Snap;

pub use crate::statics::phase::Phase;

/// The physical limit that was met on the way from the unloaded arm to the requested loads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VerdictKind {
    /// nu - y_i beta mu reaches zero: a cable compresses its side of the arm to zero length.
    CableFold,
    /// Net compression crushes the section: nu reaches zero (volume law `none`).
    SectionCrushed,
    /// The section law has no strains that carry the contact force: in tension a `planar` section
    /// softens past nu = 2, a `circular` one saturates.
    NoSectionSolution,
    /// The equilibrium path turns back: past this load the equilibrium does not exist.
    LimitPoint,
    /// The load of the stream jumps against the motion, so that no shape balances it.
    LoadJump,
    /// None of these was established: the solver gave up.
    NotFound,
}

impl VerdictKind {
    /// The name in results: `cable_fold`, `limit_point` and so on.
    pub fn name(self) -> &'static str {
        match self {
            Self::CableFold => "cable_fold",
            Self::SectionCrushed => "section_crushed",
            Self::NoSectionSolution => "no_section_solution",
            Self::LimitPoint => "limit_point",
            Self::LoadJump => "load_jump",
            Self::NotFound => "not_found",
        }
    }

    /// What happens, in a phrase.
    pub fn phrase(self) -> &'static str {
        match self {
            Self::CableFold => "a cable compresses its side of the arm to zero length",
            Self::SectionCrushed => "net compression crushes the section",
            Self::NoSectionSolution => "no section strains carry the contact force",
            Self::LimitPoint => "the equilibrium ends in a limit point",
            Self::LoadJump => "the load of the stream jumps against the motion",
            Self::NotFound => "no further equilibrium was found, and no physical limit was identified",
        }
    }
}

/// Why there is no equilibrium, or why none was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Which limit.
    pub kind: VerdictKind,
    /// In which phase of loading.
    pub phase: Phase,
    /// The part of the phase's loads at which it was met, 0 to 1.
    pub load_fraction: f64,
    /// Where along the arm (m), if the limit is local.
    pub s: Option<f64>,
    /// The last Newton correction when the solver stopped: the largest change of an angle, in rad. It is not a residual
    /// of the equations; the name in results is kept for compatibility.
    pub residual: f64,
    /// The evaluations of the section law (those of arms with many cables count more), if the solver
    /// stopped at the limit for one solve.
    pub spent: Option<usize>,
}

impl Verdict {
    /// What happened, in a sentence with its numbers.
    pub fn message(&self) -> String {
        let place = self.s.map_or_else(String::new, |s| format!(" at s = {s:.4} m"));
        let load = self.phase.load_at(self.load_fraction);
        if let Some(spent) = self.spent {
            return format!(
                "no equilibrium was found beyond {load}, within {spent} evaluations of the section law, the limit for one solve \
                 (last correction {:.1e} rad)",
                self.residual
            );
        }
        let phrase = self.kind.phrase();
        match self.kind {
            VerdictKind::CableFold | VerdictKind::SectionCrushed | VerdictKind::NoSectionSolution => {
                format!("{phrase}{place}, at {load}")
            }
            VerdictKind::LimitPoint => format!("{phrase} at {load}: the arm would snap to another shape"),
            VerdictKind::LoadJump => format!("{phrase}{place}, at {load}: no shape balances it in this reading"),
            VerdictKind::NotFound => format!(
                "no equilibrium was found beyond {load}, and no physical limit was identified (last correction {:.1e} rad)",
                self.residual
            ),
        }
    }

    /// What to try.
    pub fn advice(&self) -> &'static str {
        if self.spent.is_some() {
            return "look for a wrong unit, or for loads far above the tension limits of the arm: `hydrostat check` prints both";
        }
        match self.kind {
            VerdictKind::CableFold if self.phase == Phase::Stroke => {
                "reel in less, move the cable towards the centreline near that place, or stiffen the section there"
            }
            VerdictKind::SectionCrushed if self.phase == Phase::Stroke => {
                "reel in less or stiffen the section; the volume law `none` does not conserve volume"
            }
            VerdictKind::CableFold => {
                "lower the tension, move the cable towards the centreline near that place, or stiffen the section there"
            }
            VerdictKind::SectionCrushed => {
                "lower the tensions or stiffen the section; the volume law `none` does not conserve volume"
            }
            VerdictKind::NoSectionSolution => {
                "lower the flow speed or the axial load, or stiffen the section: the section law softens in tension (the axial force of `planar` has its maximum at a stretch of 2)"
            }
            VerdictKind::LimitPoint => {
                "stay below that load, or ask for the shape after the snap (`--after-snap` by its motion, `--follow-snaps` along the curve); `hydrostat path` and `hydrostat equilibria` show the shapes beyond it"
            }
            VerdictKind::LoadJump => {
                "set `flow_surface = \"centreline\"` and `entering_speed = \"tangential\"`, with which the load is continuous"
            }
            VerdictKind::NotFound => {
                "check the units (`hydrostat check`), use a looser tolerance, or approach the loads with `hydrostat path`"
            }
        }
    }
}

/// Why a solve gives no configuration at the requested loads, in the plane or in space.
#[derive(Debug, Clone, thiserror::Error)]
pub enum SolveError<C = Configuration, T = Tip> {
    /// The numbers do not make an arm.
    #[error(transparent)]
    Arm(#[from] crate::rod::arm::ArmError),
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
    /// There is no such equilibrium, or it was not found.
    #[error("{}", .0.verdict.message())]
    NoEquilibrium(Box<NoEquilibrium<C, T>>),
}

/// A verdict with the last configuration before it.
#[derive(Debug, Clone)]
pub struct NoEquilibrium<C = Configuration, T = Tip> {
    /// Why.
    pub verdict: Verdict,
    /// The last good solution on the way, its `arm` carrying the loads that it balances.
    /// `None` only when not even the first step off the unloaded arm could be solved, or where a section at its limit,
    /// at an end of the arm, lets no shape be read out.
    pub last_good: Option<C>,
    /// The snaps that the arm makes on the way, the last of them the one that goes too far where the verdict is
    /// [`VerdictKind::LimitPoint`] and the path leads on beyond it.
    pub snaps: Vec<Snap<T>>,
    /// With such a verdict: the shape that the arm snaps to, at the loads of the limit point.
    pub after_snap: Option<C>,
    /// With such a verdict: the shape at the full loads, if the path continues to them. [`crate::Options::snaps`]
    /// without bounds gives it as an answer.
    pub at_full_loads: Option<C>,
}
