//! The source's Fig. 1 and what its text says about it.
//!
//! Of the figure's parameters only the speed of the stream, 0.5 m/s, is published; the arm that
//! ships as `paper` is a set found by trial. [`Study::of`] solves every shape that the figure
//! shows, finding the tension at which alpha(L) is the published 72.25 deg, and
//! [`Study::claims`] holds what the text says against the numbers.

mod charts;
mod claims;
mod tables;
mod target;

use hydrostat::{Arm, Configuration, Options, ReachError, SolveError, Solver};

use crate::scene::Scene;

pub use claims::{Claim, Finding};

/// The published tip angle alpha(L) at the highest tension, degrees.
pub const TIP_ANGLE: f64 = 72.25;
/// The published speed of the stream, m/s.
pub const SPEED: f64 = 0.5;
/// Tensions of the pulled cable below the highest, N: ours.
const TENSIONS: [f64; 5] = [0.0, 5.0, 10.0, 20.0, 40.0];
/// The tension of the comparison of speeds, N: ours.
const FIXED_TENSION: f64 = 40.0;
/// The speeds compared, m/s: [`SPEED`] is published, the others are ours.
const SPEEDS: [f64; 4] = [0.0, SPEED, 1.0, 2.0];
/// Tip error over L that is asked for. alpha(L), a strain, is then good to about [`RESOLUTION`].
const TOL: f64 = 1e-9;
/// Differences of alpha(L) below this are not told apart, deg.
const RESOLUTION: f64 = 1e-4;

/// Why the study could not be made.
#[derive(Debug, Clone, thiserror::Error)]
pub enum StudyError {
    /// An arm without cables.
    #[error("the arm `{name}` has no cable to pull")]
    NoCable {
        /// The arm.
        name: String,
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
    #[error("no tension up to {largest} N turns the tip section by {TIP_ANGLE} deg; {angle} deg is reached")]
    NoTension {
        /// N.
        largest: f64,
        /// alpha(L) there, deg.
        angle: f64,
    },
}

/// Every shape of the source's Fig. 1, solved.
#[derive(Debug, Clone)]
pub struct Study {
    /// Fig. 1a: tension raised at [`SPEED`], ending at the highest.
    pub raised: Vec<Configuration>,
    /// Fig. 1b: one tension in ever faster streams.
    pub faster: Vec<Configuration>,
    /// Fig. 1c besides those of 1b: the highest tension in the same streams.
    pub faster_highest: Vec<Configuration>,
    /// What the text says, held against these shapes.
    pub claims: Vec<Claim>,
}

/// One part of the figure.
#[derive(Debug, Clone)]
pub struct Figure {
    /// `fig1a` and so on: the stem of its files.
    pub name: &'static str,
    /// The drawing.
    pub scene: Scene,
    /// The numbers that it shows, as CSV.
    pub csv: String,
}

impl Study {
    /// Solves the shapes for `arm`, whose first cable is the one pulled and whose others are slack.
    ///
    /// # Errors
    /// [`StudyError`].
    pub fn of(arm: &Arm) -> Result<Self, StudyError> {
        if arm.cables.is_empty() {
            return Err(StudyError::NoCable { name: arm.name.clone() });
        }
        let highest = target::configuration(arm)?;
        let mut raised = TENSIONS.iter().map(|t| solved(arm, *t, SPEED)).collect::<Result<Vec<_>, _>>()?;
        let highest_tension = highest.arm.cables[0].tension;
        raised.push(highest);
        let at = |tension: f64| SPEEDS.iter().map(|v| solved(arm, tension, *v)).collect::<Result<Vec<_>, _>>();
        let faster = at(FIXED_TENSION)?;
        let faster_highest = at(highest_tension)?;
        let mut study = Self { raised, faster, faster_highest, claims: Vec::new() };
        study.claims = claims::judge(&study, arm)?;
        Ok(study)
    }

    /// The tension of the pulled cable at which alpha(L) is [`TIP_ANGLE`], N.
    pub fn highest_tension(&self) -> f64 {
        self.raised.last().map_or(0.0, tension)
    }

    /// Fig. 1a, 1b and 1c.
    pub fn figures(&self) -> [Figure; 3] {
        [
            Figure { name: "fig1a", scene: charts::raised(self), csv: tables::shapes(&self.raised) },
            Figure { name: "fig1b", scene: charts::faster(self), csv: tables::shapes(&self.faster) },
            Figure { name: "fig1c", scene: charts::angles(self), csv: tables::angles(&self.angle_configurations()) },
        ]
    }

    /// The shapes whose alpha(s) Fig. 1c shows.
    fn angle_configurations(&self) -> Vec<&Configuration> {
        self.faster.iter().chain(&self.faster_highest).collect()
    }
}

/// `arm` with its first cable pulled by `tension` (N) and the others slack, in a stream of `speed` (m/s).
fn loaded(arm: &Arm, tension: f64, speed: f64) -> Arm {
    let mut arm = arm.clone();
    arm.flow.speed = speed;
    for (i, cable) in arm.cables.iter_mut().enumerate() {
        cable.tension = if i == 0 { tension } else { 0.0 };
    }
    arm
}

fn solved(arm: &Arm, tension: f64, speed: f64) -> Result<Configuration, StudyError> {
    Solver::new(&loaded(arm, tension, speed), Options { tol: TOL })
        .and_then(|mut solver| solver.solve())
        .map_err(|source| StudyError::Solve { tension, speed, source: Box::new(source) })
}

/// Tension of the pulled cable, N.
fn tension(configuration: &Configuration) -> f64 {
    configuration.cables.first().map_or(0.0, |c| c.tension)
}

/// Speed of the stream, m/s.
fn speed(configuration: &Configuration) -> f64 {
    configuration.arm.flow.speed
}

/// alpha(L), deg.
fn tip_angle(configuration: &Configuration) -> f64 {
    configuration.tip().alpha.to_degrees()
}
