//! The source's Fig. 1 and what its text says about it.
//!
//! Of the figure's parameters only the speed of the stream, 0.5 m/s, is published; the arms that
//! ship as `paper` and `paper-statements` are sets found by trial. [`Study::of`] solves every shape
//! that the figure shows, finding the tension at which alpha(L) is the published 72.25 deg, and
//! [`Study::claims`] holds what the text says against the numbers. At which tension streams are
//! compared, and which faster ones, the source leaves open: [`Shown`].

mod charts;
mod claim;
mod claims;
mod shapes;
mod solves;
mod tables;
mod target;

use hydrostat::Arm;

use crate::page::Page;
use crate::scene::Scene;

pub use claim::{Claim, Finding};
pub use shapes::Study;
pub use solves::{SPEED, StudyError, TIP_ANGLE};
use solves::{solved, tension};

/// Tensions of the pulled cable below the highest, over it and before they are rounded: ours.
const SHARES: [f64; 5] = [0.0, 1.0 / 16.0, 0.125, 0.25, HALF];
/// The tension at which speeds are compared, over the highest and before it is rounded: ours.
const HALF: f64 = 0.5;

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
        let lower = SHARES.map(|fraction| one_digit(fraction * highest_tension));
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
