//! The solves of a study, and what is read off them.

use hydrostat::{Arm, Configuration, Options, ReachError, SolveError, Solver};

/// The published tip angle alpha(L) at the highest tension, degrees.
pub const TIP_ANGLE: f64 = 72.25;
/// The published speed of the stream, m/s.
pub const SPEED: f64 = 0.5;
/// Tip error over L that is asked for. alpha(L), a strain, is then good to about [`RESOLUTION`].
pub(super) const TOL: f64 = 1e-9;
/// Differences of alpha(L) below this are not told apart, deg.
pub(super) const RESOLUTION: f64 = 1e-4;

/// Why the study could not be made.
#[derive(Debug, Clone, thiserror::Error)]
pub enum StudyError {
    /// An arm without cables.
    #[error("the arm `{name}` has no cable to pull")]
    NoCable {
        /// The arm.
        name: String,
    },
    /// Speeds that are no faster streams.
    #[error("faster streams: expected rising speeds above {SPEED} m/s, found {found:?}")]
    Faster {
        /// m/s.
        found: Vec<f64>,
    },
    /// A shape of the figure has no equilibrium.
    #[error("at T1 = {tension} N and {speed} m/s: {source}")]
    Solve {
        /// N.
        tension: f64,
        /// m/s.
        speed: f64,
        /// Why.
        source: Box<SolveError>,
    },
    /// The tension cannot be looked for.
    #[error(transparent)]
    Reach(Box<ReachError>),
    /// No tension gives the published tip angle.
    #[error("no tension up to {largest} N turns the tip section by {TIP_ANGLE} deg; {}", nearest_words(*.nearest))]
    NoTension {
        /// The largest that was looked at, N.
        largest: f64,
        /// The tension (N) that comes nearest and alpha(L) there (deg); none where shapes with that angle exist but no solve leads to them.
        nearest: Option<[f64; 2]>,
    },
}

fn nearest_words(nearest: Option<[f64; 2]>) -> String {
    match nearest {
        // A reader wants a few digits, and 0.02 N not as 0.020.
        Some([tension, angle]) => {
            let tension = format!("{tension:.2e}").parse().unwrap_or(tension);
            format!("the nearest that was found is {angle:.2} deg, at {tension} N")
        }
        None => "no solve gives a shape with this angle".to_owned(),
    }
}

/// `arm` with its first cable pulled by `tension` (N) and the others slack, in a stream of `speed` (m/s).
pub(super) fn loaded(arm: &Arm, tension: f64, speed: f64) -> Arm {
    let mut arm = arm.clone();
    arm.flow.speed = speed;
    for (i, cable) in arm.cables.iter_mut().enumerate() {
        cable.tension = if i == 0 { tension } else { 0.0 };
    }
    arm
}

pub(super) fn solved(arm: &Arm, tension: f64, speed: f64) -> Result<Configuration, StudyError> {
    Solver::new(&loaded(arm, tension, speed), Options::with_tol(TOL))
        .and_then(|mut solver| solver.solve())
        .map_err(|source| StudyError::Solve { tension, speed, source: Box::new(source) })
}

/// Tension of the pulled cable, N.
pub(super) fn tension(configuration: &Configuration) -> f64 {
    configuration.cables.first().map_or(0.0, |c| c.tension)
}

/// Speed of the stream, m/s.
pub(super) fn speed(configuration: &Configuration) -> f64 {
    configuration.arm.flow.speed
}

/// alpha(L), deg.
pub(super) fn tip_angle(configuration: &Configuration) -> f64 {
    configuration.tip().alpha.to_degrees()
}
