//! Motions and eigenmodes as JSON and CSV.

use hydrostat::{Arm, Instant, Mode, Modes, MotionStatistics};
use serde::Serialize;

use crate::results::{SCHEMA, cell, json};
use crate::written::Inputs;

/// The heads of [`motion_row`] for an arm with so many cables.
pub fn motion_columns(cables: usize) -> Vec<String> {
    let mut out: Vec<String> = ["t_s", "tip_x_m", "tip_y_m", "tip_theta_rad"].map(str::to_owned).into();
    out.extend((0..cables).flat_map(|c| [format!("stroke_{c}_m"), format!("tension_{c}_N")]));
    out.extend(["kinetic_energy_J", "strain_energy_J", "tip_vx_m_s", "tip_vy_m_s"].map(str::to_owned));
    out
}

/// One time of a motion as the numbers of a row, in the order of [`motion_columns`].
pub fn motion_numbers(at: &Instant) -> Vec<f64> {
    let mut out = vec![at.time, at.tip[0], at.tip[1], at.tip_theta];
    out.extend(at.cables.iter().flat_map(|cable| [cable.stroke, cable.tension]));
    out.extend([at.kinetic_energy, at.strain_energy, at.tip_velocity[0], at.tip_velocity[1]]);
    out
}

/// One time of a motion as a line of CSV, with its end of line. Of all numbers there are as many digits as it takes.
pub fn motion_row(at: &Instant) -> String {
    let cells: Vec<String> = motion_numbers(at).into_iter().map(cell).collect();
    cells.join(",") + "\n"
}

/// The document of a motion.
#[derive(Debug, Clone, Serialize)]
pub struct MotionDocument {
    schema: u32,
    version: &'static str,
    /// Whether the motion was known up to the time asked for.
    complete: bool,
    /// Why not.
    verdict: Option<String>,
    error_estimate: f64,
    statistics: StatisticsOut,
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
    inputs: Inputs,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct StatisticsOut {
    steps: usize,
    rejected: usize,
    solves: usize,
    rounds: usize,
    elements: usize,
}

impl MotionDocument {
    /// Of a run of `arm`, whose estimated error of the tip is `error_estimate` (m); `verdict` says why it ended early.
    pub fn new(
        arm: &Arm,
        instants: &[Instant],
        statistics: MotionStatistics,
        error_estimate: f64,
        verdict: Option<String>,
    ) -> Self {
        let MotionStatistics { steps, rejected, solves, rounds, elements } = statistics;
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            complete: verdict.is_none(),
            verdict,
            error_estimate,
            statistics: StatisticsOut { steps, rejected, solves, rounds, elements },
            columns: motion_columns(arm.cables.len()),
            rows: instants.iter().map(motion_numbers).collect(),
            inputs: Inputs::new(arm),
        }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

/// The document of eigenmodes.
#[derive(Debug, Clone, Serialize)]
pub struct ModesDocument {
    schema: u32,
    version: &'static str,
    /// Whether no motion grows, of those listed.
    stable: bool,
    modes: Vec<ModeOut>,
    tip: ModesTip,
    inputs: Inputs,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct ModesTip {
    x: f64,
    y: f64,
    theta: f64,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct ModeOut {
    rate: [f64; 2],
    frequency_hz: f64,
    damping_ratio: f64,
    kind: &'static str,
}

/// What a mode does, in a word: `swings`, `decays`, `flutter` or `divergence`.
pub fn mode_kind(mode: &Mode) -> &'static str {
    match (mode.grows(), mode.rate[1] == 0.0) {
        (false, false) => "swings",
        (false, true) => "decays",
        (true, false) => "flutter",
        (true, true) => "divergence",
    }
}

impl ModesDocument {
    /// Of the modes of `arm`.
    pub fn new(arm: &Arm, modes: &Modes) -> Self {
        let one = |mode: &Mode| ModeOut {
            rate: mode.rate,
            frequency_hz: mode.frequency(),
            damping_ratio: mode.damping_ratio(),
            kind: mode_kind(mode),
        };
        let [x, y, theta] = modes.tip;
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            stable: modes.is_stable(),
            modes: modes.modes.iter().map(one).collect(),
            tip: ModesTip { x, y, theta },
            inputs: Inputs::new(arm),
        }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}
