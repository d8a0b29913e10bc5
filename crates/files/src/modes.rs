//! Eigenmodes as JSON and CSV, at one load and over several values of one.

use hydrostat::{Arm, Mode, Modes, SpatialTip};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::results::{SCHEMA, cell, json};
use crate::spatial_results::TipOut;
use crate::varied::{RangeOut, Varied};
use crate::written::Inputs;

#[derive(Debug, Clone, Serialize)]
struct ModesOut {
    /// Whether no motion grows, of those listed.
    stable: bool,
    modes: Vec<ModeOut>,
    tip: ModesTip,
}

/// The document of eigenmodes.
#[derive(Debug, Clone, Serialize)]
pub struct ModesDocument {
    schema: u32,
    version: &'static str,
    #[serde(flatten)]
    found: ModesOut,
    inputs: Inputs,
}

#[derive(Debug, Clone, Serialize)]
struct ValueOut<'a> {
    value: f64,
    #[serde(flatten)]
    found: Option<ModesOut>,
    message: Option<&'a str>,
}

/// The document of eigenmodes at several values of one quantity.
#[derive(Debug, Clone, Serialize)]
pub struct ModesOverDocument<'a> {
    schema: u32,
    version: &'static str,
    #[serde(flatten)]
    over: RangeOut,
    values: Vec<ValueOut<'a>>,
    inputs: Inputs,
}

#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
enum TipAs {
    InPlane { x: f64, y: f64, theta: f64 },
    InSpace(TipOut),
}

/// The tip in the equilibrium of modes, in the plane or in space, as documents have it.
#[derive(Debug, Clone, Serialize)]
pub struct ModesTip(TipAs);

/// x, y (m) and theta (rad).
impl From<[f64; 3]> for ModesTip {
    fn from([x, y, theta]: [f64; 3]) -> Self {
        Self(TipAs::InPlane { x, y, theta })
    }
}

impl From<SpatialTip> for ModesTip {
    fn from(tip: SpatialTip) -> Self {
        Self(TipAs::InSpace(tip.into()))
    }
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

impl From<&Mode> for ModeOut {
    fn from(mode: &Mode) -> Self {
        Self {
            rate: mode.rate,
            frequency_hz: mode.frequency(),
            damping_ratio: mode.damping_ratio(),
            kind: mode_kind(mode),
        }
    }
}

impl<T: Copy + Into<ModesTip>> From<&Modes<T>> for ModesOut {
    fn from(modes: &Modes<T>) -> Self {
        let modes_out = modes.modes.iter().map(ModeOut::from).collect();
        Self { stable: modes.is_stable(), modes: modes_out, tip: modes.tip.into() }
    }
}

impl ModesDocument {
    /// Of the modes of `arm`.
    pub fn new(arm: &Arm, modes: &Modes<impl Copy + Into<ModesTip>>) -> Self {
        Self { schema: SCHEMA, version: env!("CARGO_PKG_VERSION"), found: modes.into(), inputs: Inputs::new(arm) }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

impl<'a> ModesOverDocument<'a> {
    /// Of the modes of `arm` at each value (SI) of what varies, or why there are none.
    pub fn new<T: Copy + Into<ModesTip>>(
        arm: &Arm,
        varied: &Varied,
        found: &'a [(f64, Result<Modes<T>, String>)],
    ) -> Self {
        let value = |(value, modes): &'a (f64, Result<Modes<T>, String>)| ValueOut {
            value: *value,
            found: modes.as_ref().ok().map(ModesOut::from),
            message: modes.as_ref().err().map(String::as_str),
        };
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            over: RangeOut::new(varied.parameter, varied.range),
            values: found.iter().map(value).collect(),
            inputs: Inputs::new(arm),
        }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

const COLUMNS: [&str; 6] =
    ["number", "growth_rate_1_s", "angular_frequency_rad_s", "frequency_Hz", "damping_ratio", "kind"];

fn cells(number: usize, mode: &Mode) -> Vec<String> {
    let mut out = vec![number.to_string()];
    out.extend([mode.rate[0], mode.rate[1], mode.frequency(), mode.damping_ratio()].map(cell));
    out.push(mode_kind(mode).to_owned());
    out
}

/// Modes, one row each, counted from 1.
pub fn modes_csv<T>(modes: &Modes<T>) -> String {
    let mut out = Rows::new(&COLUMNS.map(str::to_owned));
    for (k, mode) in modes.modes.iter().enumerate() {
        out.row(&cells(k + 1, mode));
    }
    out.text()
}

/// [`modes_csv`] at each value of what varies.
pub fn modes_over_csv<T>(varied: &Varied, found: &[(f64, Result<Modes<T>, String>)]) -> String {
    let mut names = vec![varied.column()];
    names.extend(COLUMNS.map(str::to_owned));
    let mut out = Rows::new(&names);
    for (value, modes) in found {
        let Ok(modes) = modes else { continue };
        for (k, mode) in modes.modes.iter().enumerate() {
            let mut row = vec![cell(*value)];
            row.extend(cells(k + 1, mode));
            out.row(&row);
        }
    }
    out.text()
}
