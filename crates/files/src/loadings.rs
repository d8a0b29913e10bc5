//! Equilibria along a sequence of loads as JSON and CSV.

use hydrostat::{Arm, Configuration, LoadingSnap, LoadingStep, Pose, SpatialConfiguration, SpatialTip, Tip};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::heads::head_of;
use crate::results::{SCHEMA, cell, json};
use crate::state::{AnyTip, State};
use crate::time_loads::LoadRows;
use crate::written::Inputs;

/// A snap on the way to a row, with the loads at which the arm snaps.
#[derive(Debug, Clone, PartialEq)]
pub struct RowSnap<T = Tip> {
    /// The loads at the limit point, in the order of the keys, SI units, angles in degrees.
    pub loads: Vec<f64>,
    /// The snap.
    pub snap: LoadingSnap<T>,
}

/// A row of a sequence of loads: its loads, its equilibrium, and the snaps since the row before.
#[derive(Debug, Clone)]
pub struct LoadingRow<C = Configuration, T = Tip> {
    /// The loads in the order of the keys, SI units, angles in degrees.
    pub loads: Vec<f64>,
    /// The equilibrium.
    pub step: LoadingStep<C, T>,
    /// The snaps since the row before.
    pub snaps: Vec<RowSnap<T>>,
}

impl<C, T: Pose> LoadingRow<C, T> {
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
    pub fn new(before: Option<&[f64]>, loads: Vec<f64>, step: LoadingStep<C, T>) -> Self {
        let at = |snap: &LoadingSnap<T>| {
            let before = before.unwrap_or(&loads);
            before.iter().zip(&loads).map(|(from, to)| from + snap.fraction * (to - from)).collect()
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
    fraction: f64,
    before: AnyTip,
    after: AnyTip,
    /// m
    distance: f64,
    /// rad
    angle: f64,
    /// s
    duration: f64,
    lands_elsewhere: Option<bool>,
}

impl<'a> SnapOut<'a> {
    fn new<T: Pose + Into<AnyTip>>(row: &'a RowSnap<T>, length: f64) -> Self {
        let LoadingSnap { fraction, before, after, duration, .. } = row.snap;
        Self {
            loads: &row.loads,
            fraction,
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
        Self::of(arm, loads, rows, verdict, in_plane)
    }

    /// The same of an arm in space.
    pub fn in_space(
        arm: &Arm,
        loads: &'a LoadRows,
        rows: &'a [LoadingRow<SpatialConfiguration, SpatialTip>],
        verdict: Option<String>,
    ) -> Self {
        Self::of(arm, loads, rows, verdict, in_space)
    }

    fn of<C, T: Pose + Into<AnyTip>>(
        arm: &Arm,
        loads: &'a LoadRows,
        rows: &'a [LoadingRow<C, T>],
        verdict: Option<String>,
        state: impl Fn(&'a C) -> State<'a>,
    ) -> Self {
        let one = |row: &'a LoadingRow<C, T>| RowOut {
            loads: &row.loads,
            state: state(&row.step.configuration),
            snaps: row.snaps.iter().map(|snap| SnapOut::new(snap, arm.length)).collect(),
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

fn in_plane(configuration: &Configuration) -> State<'_> {
    State::new(configuration, configuration.stability())
}

fn in_space(configuration: &SpatialConfiguration) -> State<'_> {
    State::in_space(configuration, configuration.stability())
}

/// The columns of snaps before the place of the tip.
const SNAPS: [&str; 5] = ["snaps", "snap_fraction", "snap_distance_m", "snap_angle_rad", "snap_duration_s"];

/// The rows as CSV: loads in SI units, angles in degrees, under their keys with the unit (`cable_0_tension_N`), what [`crate::path_csv`] has of an equilibrium, and the snaps since the row
/// before: how many, and of the one that goes furthest fraction, distance, angle, duration and the place of the tip.
pub fn loading_csv(loads: &LoadRows, rows: &[LoadingRow]) -> String {
    let columns =
        |more: &[&str]| State::columns(rows.first().map_or(0, |row| row.step.configuration.cables.len()), more);
    written(loads, rows, columns, in_plane, |tip| [("snap_x_m", tip.x), ("snap_y_m", tip.y)])
}

/// The same of an arm in space.
pub fn spatial_loading_csv(loads: &LoadRows, rows: &[LoadingRow<SpatialConfiguration, SpatialTip>]) -> String {
    let columns = |more: &[&str]| {
        State::columns_in_space(rows.first().map_or(0, |row| row.step.configuration.cables.len()), more)
    };
    let place = |tip: SpatialTip| [("snap_x_m", tip.x), ("snap_y_m", tip.y), ("snap_z_m", tip.z)];
    written(loads, rows, columns, in_space, place)
}

fn written<'a, C, T: Pose + Default, const D: usize>(
    loads: &LoadRows,
    rows: &'a [LoadingRow<C, T>],
    columns: impl Fn(&[&str]) -> Vec<String>,
    state: impl Fn(&'a C) -> State<'a>,
    place: impl Fn(T) -> [(&'static str, f64); D],
) -> String {
    let mut names: Vec<String> = loads.keys.iter().enumerate().map(|(k, key)| head_of(key, loads.unit(k))).collect();
    let places = place(T::default()).map(|(name, _)| name);
    names.extend(columns(&SNAPS.into_iter().chain(places).collect::<Vec<_>>()));
    let mut out = Rows::new(&names);
    for row in rows {
        let mut cells: Vec<String> = row.loads.iter().copied().map(cell).collect();
        let furthest = row.snaps.iter().map(|row| row.snap).max_by(|a, b| a.distance().total_cmp(&b.distance()));
        let mut more = vec![row.snaps.len().to_string()];
        match furthest {
            Some(snap) => {
                more.extend([snap.fraction, snap.distance(), snap.angle(), snap.duration].map(cell));
                more.extend(place(snap.before).map(|(_, value)| cell(value)));
            }
            None => more.extend(vec![String::new(); SNAPS.len() - 1 + D]),
        }
        let more: Vec<&str> = more.iter().map(String::as_str).collect();
        cells.extend(state(&row.step.configuration).cells(&more));
        out.row(&cells);
    }
    out.text()
}
