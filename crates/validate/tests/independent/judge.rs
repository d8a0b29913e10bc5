//! One arm solved and held against the equations.

use hydrostat::{Arm, Options, Phase, SolveError, Solver, Verdict};

use crate::correction::equilibrium_beside;
use crate::mechanics::Model;
use crate::residuals::{Residuals, residuals};

/// What became of an arm.
#[derive(Debug, Clone)]
pub(crate) enum Outcome {
    /// There is an answer.
    Answered(Judged),
    /// The program says why there is none.
    Refused(Box<Verdict>),
    /// The arm is none.
    NoArm(String),
}

/// How an answer stands.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Judged {
    pub(crate) residuals: Residuals,
    /// Estimated error of the tip, over L.
    pub(crate) estimate: f64,
    /// How far the tip is from that of the equilibrium beside, over L; `None` where that was not found.
    pub(crate) off: Option<f64>,
    /// How far that equilibrium is known, over L.
    pub(crate) doubt: f64,
}

/// An error of rounding, over L, that no estimate needs to foresee.
const ROUNDING: f64 = 1e-13;

impl Judged {
    /// Error over `times` the estimate, beyond what is in doubt.
    pub(crate) fn is_within(&self, times: f64) -> bool {
        self.off.is_none_or(|off| off - self.doubt <= times * self.estimate + ROUNDING)
    }

    /// Whether the equilibrium beside it is known well enough to say so.
    pub(crate) fn is_known(&self, times: f64) -> bool {
        self.off.is_some_and(|off| off <= times * self.estimate + ROUNDING || off > 2.0 * self.doubt)
    }
}

pub(crate) fn judge(arm: &Arm, tol: f64) -> Outcome {
    match Solver::new(arm, Options::with_tol(tol)).and_then(|mut solver| solver.solve()) {
        Ok(solved) => {
            let (model, length, tip) = (Model::new(&solved.arm), arm.length, solved.tip());
            let beside = equilibrium_beside(&model, &solved).ok();
            Outcome::Answered(Judged {
                residuals: residuals(&model, &solved),
                estimate: solved.error_estimate / length,
                off: beside.map(|own| (own.tip[0] - tip.x).hypot(own.tip[1] - tip.y) / length),
                doubt: beside.map_or(f64::INFINITY, |own| own.doubt / length),
            })
        }
        Err(SolveError::NoEquilibrium(no)) => Outcome::Refused(Box::new(no.verdict)),
        Err(error) => Outcome::NoArm(error.to_string()),
    }
}

/// Whether a verdict's phase has something in it: loads, tensions, strokes, friction.
pub(crate) fn phase_is_there(arm: &Arm, phase: Phase) -> bool {
    let commanded = arm.cables.iter().any(|cable| cable.stroke.is_some());
    match phase {
        Phase::Loads => {
            let tip = arm.tip.force.iter().chain(&arm.tip.follower).any(|v| *v != 0.0) || arm.tip.moment != 0.0;
            let along = arm.distributed.force.iter().chain([&arm.distributed.couple]).any(|p| !p.is_zero());
            let stream = arm.flow.speed > 0.0 && arm.flow.density > 0.0;
            let weight = arm.gravity.is_some_and(|g| g.acceleration > 0.0);
            tip || along || stream || weight
        }
        Phase::Tension => arm.cables.iter().any(|cable| cable.stroke.is_none() && cable.tension > 0.0),
        Phase::Stroke => commanded,
        Phase::Friction => arm.cables.iter().any(|cable| cable.friction > 0.0),
    }
}
