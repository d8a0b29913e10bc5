//! The source's Fig. 1 and what its text says about it.
//!
//! Of the figure's parameters only the speed of the stream, 0.5 m/s, is published; the arms that
//! ship as `paper` and `paper-statements` are sets found by trial. [`Study::of`] solves every shape
//! that the figure shows, finding the tension at which alpha(L) is the published 72.25 deg, and
//! [`Study::claims`] holds what the text says against the numbers. At which tension streams are
//! compared, and which faster ones, the source leaves open: [`Shown`].

mod charts;
mod claims;
mod tables;
mod target;

use hydrostat::{Arm, Configuration, Options, ReachError, SolveError, Solver};

use crate::page::Page;
use crate::scene::Scene;

pub use claims::{Claim, Finding};

/// The published tip angle alpha(L) at the highest tension, degrees.
pub const TIP_ANGLE: f64 = 72.25;
/// The published speed of the stream, m/s.
pub const SPEED: f64 = 0.5;
/// Tensions of the pulled cable below the highest, over it and before they are rounded: ours.
const SHARES: [f64; 5] = [0.0, 1.0 / 16.0, 0.125, 0.25, HALF];
/// The tension at which speeds are compared, over the highest and before it is rounded: ours.
const HALF: f64 = 0.5;
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
        None => "no solve leads to the shapes that have this angle".to_owned(),
    }
}

/// What the source leaves open of its figure besides the arm.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Speeds are compared at the highest tension alone, that of the blue curve of Fig. 1c; else at half of it, too.
    pub at_highest: bool,
    /// The streams faster than [`SPEED`], m/s, rising. Still water and [`SPEED`] are always shown.
    pub faster: Vec<f64>,
}

impl Default for Shown {
    fn default() -> Self {
        Self { at_highest: false, faster: vec![1.0, 2.0] }
    }
}

/// Every shape of the source's Fig. 1, solved.
#[derive(Debug, Clone)]
pub struct Study {
    /// Fig. 1a: tension raised at [`SPEED`], ending at the highest.
    pub raised: Vec<Configuration>,
    /// Fig. 1b: one tension in ever faster streams.
    pub faster: Vec<Configuration>,
    /// Fig. 1c besides those of 1b: the highest tension in the same streams. Empty where 1b is of that tension.
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
    pub fn of(arm: &Arm, shown: &Shown) -> Result<Self, StudyError> {
        let speeds = shown.speeds()?;
        if arm.cables.is_empty() {
            return Err(StudyError::NoCable { name: arm.name.clone() });
        }
        let highest = target::configuration(arm)?;
        let highest_tension = highest.arm.cables[0].tension;
        let lower = SHARES.map(|share| one_digit(share * highest_tension));
        let mut raised = lower.iter().map(|t| solved(arm, *t, SPEED)).collect::<Result<Vec<_>, _>>()?;
        raised.push(highest);
        let at = |tension: f64| speeds.iter().map(|v| solved(arm, tension, *v)).collect::<Result<Vec<_>, _>>();
        let (faster, faster_highest) = if shown.at_highest {
            (at(highest_tension)?, Vec::new())
        } else {
            (at(one_digit(HALF * highest_tension))?, at(highest_tension)?)
        };
        let mut study = Self { raised, faster, faster_highest, claims: Vec::new() };
        study.claims = claims::judge(&study, arm);
        Ok(study)
    }

    /// The tension of the pulled cable at which alpha(L) is [`TIP_ANGLE`], N.
    pub fn highest_tension(&self) -> f64 {
        self.raised.last().map_or(0.0, tension)
    }

    /// Fig. 1a, 1b and 1c.
    pub fn figures(&self, page: &Page) -> [Figure; 3] {
        let angles = tables::angles(&self.angle_configurations());
        [
            Figure { name: "fig1a", scene: charts::raised(self, page), csv: tables::shapes(&self.raised) },
            Figure { name: "fig1b", scene: charts::faster(self, page), csv: tables::shapes(&self.faster) },
            Figure { name: "fig1c", scene: charts::angles(self, page), csv: angles },
        ]
    }

    /// The shapes whose alpha(s) Fig. 1c shows.
    fn angle_configurations(&self) -> Vec<&Configuration> {
        self.faster.iter().chain(&self.faster_highest).collect()
    }

    /// The same, those of each tension by themselves, rising; the highest is the last.
    fn rows(&self) -> Vec<&[Configuration]> {
        [&self.faster, &self.faster_highest].into_iter().map(Vec::as_slice).filter(|row| !row.is_empty()).collect()
    }
}

impl Shown {
    /// The speeds compared, m/s.
    fn speeds(&self) -> Result<Vec<f64>, StudyError> {
        let speeds: Vec<f64> = [0.0, SPEED].into_iter().chain(self.faster.iter().copied()).collect();
        let rising = speeds.windows(2).all(|pair| pair[1] > pair[0] && pair[1].is_finite());
        if !rising || self.faster.is_empty() {
            return Err(StudyError::Faster { found: self.faster.clone() });
        }
        Ok(speeds)
    }
}

/// To one digit, for tensions that are ours to choose.
fn one_digit(value: f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let unit = 10_f64.powf(value.log10().floor());
    (value / unit).round() * unit
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
    Solver::new(&loaded(arm, tension, speed), Options::with_tol(TOL))
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
