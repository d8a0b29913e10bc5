//! How a path of targets was followed, as JSON and CSV.

use hydrostat::{Arm, Followed, Target};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::results::{SCHEMA, TipOut, cell, json};
use crate::written::Inputs;

/// The place and the angle (rad) that a row asks for.
#[derive(Debug, Clone, Copy, Serialize)]
struct TargetOut {
    x: f64,
    y: f64,
    angle: Option<f64>,
}

#[derive(Debug, Clone, Serialize)]
struct FollowedOut<'a> {
    target: TargetOut,
    reached: bool,
    jumped: bool,
    distance: f64,
    solves: usize,
    tip: TipOut,
    tensions: &'a [f64],
}

impl<'a> FollowedOut<'a> {
    fn new((target, found): &'a (Target, Followed)) -> Self {
        Self {
            target: TargetOut { x: target.x, y: target.y, angle: target.angle },
            reached: found.reached,
            jumped: found.jumped,
            distance: found.distance,
            solves: found.solves,
            tip: found.tip.into(),
            tensions: &found.tensions,
        }
    }
}

/// The document of a path of targets.
#[derive(Debug, Clone, Serialize)]
pub struct FollowedDocument<'a> {
    schema: u32,
    version: &'static str,
    reached: bool,
    jumps: usize,
    points: Vec<FollowedOut<'a>>,
    inputs: Inputs,
}

impl<'a> FollowedDocument<'a> {
    /// Of what `arm` did at each target.
    pub fn new(arm: &Arm, rows: &'a [(Target, Followed)]) -> Self {
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            reached: rows.iter().all(|(_, found)| found.reached),
            jumps: rows.iter().filter(|(_, found)| found.jumped).count(),
            points: rows.iter().map(FollowedOut::new).collect(),
            inputs: Inputs::new(arm),
        }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

/// One row a target, for an arm with `cables` cables.
pub fn followed_csv(cables: usize, rows: &[(Target, Followed)]) -> String {
    let mut names: Vec<String> =
        ["number", "target_x_m", "target_y_m", "target_angle_rad", "reached", "jumped", "distance", "solves"]
            .map(str::to_owned)
            .into();
    names.extend(["tip_x_m", "tip_y_m", "tip_theta_rad", "tip_alpha_rad"].map(str::to_owned));
    names.extend((0..cables).map(|c| format!("tension_{c}_N")));
    let mut out = Rows::new(&names);
    for (index, (target, found)) in rows.iter().enumerate() {
        let mut cells = vec![(index + 1).to_string(), cell(target.x), cell(target.y)];
        cells.push(target.angle.map_or_else(String::new, cell));
        cells.extend([found.reached, found.jumped].map(|flag| flag.to_string()));
        cells.extend([cell(found.distance), found.solves.to_string()]);
        cells.extend([found.tip.x, found.tip.y, found.tip.theta, found.tip.alpha].map(cell));
        cells.extend(found.tensions.iter().copied().map(cell));
        out.row(&cells);
    }
    out.text()
}
