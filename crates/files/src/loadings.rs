//! Equilibria along a sequence of loads as JSON and CSV.

use hydrostat::{Arm, LoadingSnap, LoadingStep, Tip};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::heads::head_of;
use crate::results::{SCHEMA, TipOut, cell, json};
use crate::state::State;
use crate::time_loads::LoadRows;
use crate::written::Inputs;

/// A snap on the way to a row, with the loads at which the arm snaps.
#[derive(Debug, Clone, PartialEq)]
pub struct RowSnap {
    /// The loads at the limit point, in the order of the keys, SI units, angles in degrees.
    pub loads: Vec<f64>,
    /// The snap.
    pub snap: LoadingSnap,
}

/// A row of a sequence of loads: its loads, its equilibrium, and the snaps since the row before.
#[derive(Debug, Clone)]
pub struct LoadingRow {
    /// The loads in the order of the keys, SI units, angles in degrees.
    pub loads: Vec<f64>,
    /// The equilibrium.
    pub step: LoadingStep,
    /// The snaps since the row before.
    pub snaps: Vec<RowSnap>,
}

impl LoadingRow {
    /// Of a step to these loads from those `before`, which the first row has not.
    ///
    /// ```
    /// use hydrostat::{Arm, Loading};
    /// use hydrostat_files::LoadingRow;
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// let (mut loading, _) = Loading::start(&arm, 1e-8)?;
    /// arm.tip.force = [0.0, 0.01]; // N
    /// let row = LoadingRow::new(Some(&[0.0]), vec![0.01], loading.go_to(&arm)?);
    /// assert!(row.snaps.is_empty() && row.step.configuration.tip().y > 0.0);
    /// # Ok::<(), hydrostat::LoadingError>(())
    /// ```
    pub fn new(before: Option<&[f64]>, loads: Vec<f64>, step: LoadingStep) -> Self {
        let at = |snap: &LoadingSnap| {
            let before = before.unwrap_or(&loads);
            before.iter().zip(&loads).map(|(from, to)| from + snap.share * (to - from)).collect()
        };
        let snaps = step.snaps.iter().map(|snap| RowSnap { loads: at(snap), snap: *snap }).collect();
        Self { loads, step, snaps }
    }
}

/// The document of a sequence of loads.
#[derive(Debug, Clone, Serialize)]
pub struct LoadingDocument<'a> {
    schema: u32,
    version: &'static str,
    /// Whether all rows were reached.
    complete: bool,
    /// Why not.
    verdict: Option<String>,
    /// The keys of the loads; values are in SI units, angles in degrees.
    keys: &'a [String],
    rows: Vec<RowOut<'a>>,
    inputs: Inputs,
}

#[derive(Debug, Clone, Serialize)]
struct RowOut<'a> {
    loads: &'a [f64],
    #[serde(flatten)]
    state: State<'a>,
    snaps: Vec<SnapOut<'a>>,
}

#[derive(Debug, Clone, Serialize)]
struct SnapOut<'a> {
    loads: &'a [f64],
    share: f64,
    before: TipOut,
    after: TipOut,
    /// m
    distance: f64,
    /// rad
    angle: f64,
    /// s
    duration: f64,
    lands_elsewhere: Option<bool>,
}

impl<'a> SnapOut<'a> {
    fn new(row: &'a RowSnap, length: f64) -> Self {
        let LoadingSnap { share, before, after, duration, .. } = row.snap;
        Self {
            loads: &row.loads,
            share,
            before: before.into(),
            after: after.into(),
            distance: row.snap.distance(),
            angle: row.snap.angle(),
            duration,
            lands_elsewhere: row.snap.on_curve.map(|_| row.snap.lands_elsewhere(length)),
        }
    }
}

impl<'a> LoadingDocument<'a> {
    /// Of rows of `arm` over these keys; `verdict` says why they end early.
    pub fn new(arm: &Arm, loads: &'a LoadRows, rows: &'a [LoadingRow], verdict: Option<String>) -> Self {
        let one = |row: &'a LoadingRow| {
            let configuration = &row.step.configuration;
            RowOut {
                loads: &row.loads,
                state: State::new(configuration, configuration.stability()),
                snaps: row.snaps.iter().map(|snap| SnapOut::new(snap, arm.length)).collect(),
            }
        };
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            complete: verdict.is_none(),
            verdict,
            keys: &loads.keys,
            rows: rows.iter().map(one).collect(),
            inputs: Inputs::new(arm),
        }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

/// The rows as CSV: loads in SI units, angles in degrees, under their keys with the unit (`cable_0_tension_N`), what [`crate::path_csv`] has of an equilibrium, and the snaps since the row
/// before: how many, and of the one that goes furthest share, distance, angle and duration.
pub fn loading_csv(loads: &LoadRows, rows: &[LoadingRow]) -> String {
    let cables = rows.first().map_or(0, |row| row.step.configuration.cables.len());
    let mut names: Vec<String> = loads.keys.iter().enumerate().map(|(k, key)| head_of(key, loads.unit(k))).collect();
    names.extend(State::columns(
        cables,
        &["snaps", "snap_share", "snap_distance_m", "snap_angle_rad", "snap_duration_s", "snap_x_m", "snap_y_m"],
    ));
    let mut out = Rows::new(&names);
    for row in rows {
        let mut cells: Vec<String> = row.loads.iter().copied().map(cell).collect();
        let furthest = row.snaps.iter().map(|row| row.snap).max_by(|a, b| a.distance().total_cmp(&b.distance()));
        let number =
            |of: &dyn Fn(&LoadingSnap) -> f64| furthest.as_ref().map_or_else(String::new, |snap| cell(of(snap)));
        let more = [
            row.snaps.len().to_string(),
            number(&|snap| snap.share),
            number(&LoadingSnap::distance),
            number(&LoadingSnap::angle),
            number(&|snap| snap.duration),
            number(&|LoadingSnap { before: Tip { x, .. }, .. }| *x),
            number(&|LoadingSnap { before: Tip { y, .. }, .. }| *y),
        ];
        let configuration = &row.step.configuration;
        let more: Vec<&str> = more.iter().map(String::as_str).collect();
        cells.extend(State::new(configuration, configuration.stability()).cells(&more));
        out.row(&cells);
    }
    out.text()
}
