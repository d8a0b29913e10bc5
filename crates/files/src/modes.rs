//! Eigenmodes as JSON and CSV, at one load and over several values of one.

use hydrostat::{Arm, Mode, ModeSection, ModeShape, Modes, SpatialTip};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::motions::motion_line;
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
    /// The equilibrium at the places of the shapes.
    #[serde(skip_serializing_if = "Option::is_none")]
    sections: Option<SectionsOut>,
}

/// The equilibrium along the arm: m; `theta` (rad) in the plane, `z` and directors in space.
#[derive(Debug, Clone, Serialize)]
struct SectionsOut {
    s: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
    #[serde(flatten)]
    turned: TurnedOut,
}

#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
enum TurnedOut {
    Plane { theta: Vec<f64> },
    Space { z: Vec<f64>, a: Vec<[f64; 3]>, b: Vec<[f64; 3]>, c: Vec<[f64; 3]> },
}

impl SectionsOut {
    fn new(sections: &[ModeSection], in_space: bool) -> Self {
        let place = |k: usize| sections.iter().map(|at| at.place[k]).collect();
        let director = |k: usize| sections.iter().map(|at| at.directors[k]).collect();
        let turned = if in_space {
            TurnedOut::Space { z: place(2), a: director(0), b: director(1), c: director(2) }
        } else {
            let mut theta: Vec<f64> = sections.iter().map(|at| at.directors[0][1].atan2(at.directors[0][0])).collect();
            unwrap(&mut theta);
            TurnedOut::Plane { theta }
        };
        Self { s: sections.iter().map(|at| at.s).collect(), x: place(0), y: place(1), turned }
    }
}

/// Takes whole turns out of the steps between angles.
fn unwrap(angles: &mut [f64]) {
    use std::f64::consts::TAU;
    for k in 1..angles.len() {
        let step = angles[k] - angles[k - 1];
        angles[k] -= TAU * (step / TAU).round();
    }
}

/// Complex amplitudes along the arm, real and imaginary part: m, and rad.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
enum ShapeOut {
    Plane { x: Vec<[f64; 2]>, y: Vec<[f64; 2]>, theta: Vec<[f64; 2]> },
    Space { x: Vec<[f64; 2]>, y: Vec<[f64; 2]>, z: Vec<[f64; 2]>, turn: Vec<[[f64; 2]; 3]> },
}

impl ShapeOut {
    fn new(shape: &ModeShape, in_space: bool) -> Self {
        let part = |k: usize| shape.iter().map(|at| at.displacement[k]).collect();
        if in_space {
            Self::Space { x: part(0), y: part(1), z: part(2), turn: shape.iter().map(|at| at.turn).collect() }
        } else {
            Self::Plane { x: part(0), y: part(1), theta: shape.iter().map(|at| at.turn[2]).collect() }
        }
    }
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

#[derive(Debug, Clone, Serialize)]
struct ModeOut {
    rate: [f64; 2],
    frequency_hz: f64,
    damping_ratio: f64,
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    shape: Option<ShapeOut>,
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
            shape: None,
        }
    }
}

impl<T: Copy + Into<ModesTip>> From<&Modes<T>> for ModesOut {
    fn from(modes: &Modes<T>) -> Self {
        let modes_out = modes.modes.iter().map(ModeOut::from).collect();
        Self { stable: modes.is_stable(), modes: modes_out, tip: modes.tip.into(), sections: None }
    }
}

impl ModesTip {
    fn is_in_space(&self) -> bool {
        matches!(self.0, TipAs::InSpace(_))
    }
}

impl ModesOut {
    /// With shapes.
    fn whole<T: Copy + Into<ModesTip>>(modes: &Modes<T>) -> Self {
        let mut out = Self::from(modes);
        let in_space = out.tip.is_in_space();
        for (own, shape) in out.modes.iter_mut().zip(&modes.shapes) {
            own.shape = Some(ShapeOut::new(shape, in_space));
        }
        Self { sections: Some(SectionsOut::new(&modes.sections, in_space)), ..out }
    }
}

impl ModesDocument {
    /// Of the modes of `arm`.
    pub fn new(arm: &Arm, modes: &Modes<impl Copy + Into<ModesTip>>) -> Self {
        let found = ModesOut::whole(modes);
        Self { schema: SCHEMA, version: env!("CARGO_PKG_VERSION"), found, inputs: Inputs::new(arm) }
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

/// The shapes of modes as CSV, one row a mode and station: its number, the equilibrium there, and real and imaginary
/// parts of displacement (m) and turn (rad).
pub fn mode_shapes_csv<T: Copy + Into<ModesTip>>(modes: &Modes<T>) -> String {
    let in_space = modes.tip.into().is_in_space();
    let axes: &[&str] = if in_space { &["x", "y", "z"] } else { &["x", "y"] };
    let turns: &[(&str, usize)] =
        if in_space { &[("turn_x", 0), ("turn_y", 1), ("turn_z", 2)] } else { &[("theta", 2)] };
    let mut names = vec!["number".to_owned(), "s_m".to_owned()];
    names.extend(axes.iter().map(|axis| format!("{axis}_m")));
    let parts = |name: &str, unit: &str| ["re", "im"].map(|part| format!("{name}_{part}_{unit}"));
    names.extend(axes.iter().flat_map(|axis| parts(&format!("d{axis}"), "m")));
    names.extend(turns.iter().flat_map(|(name, _)| parts(name, "rad")));
    let mut out = names.join(",") + "\n";
    for (k, shape) in modes.shapes.iter().enumerate() {
        for (section, at) in modes.sections.iter().zip(shape) {
            let mut row = vec![(k + 1) as f64, section.s];
            row.extend(&section.place[..axes.len()]);
            row.extend(at.displacement[..axes.len()].as_flattened());
            row.extend(turns.iter().flat_map(|(_, axis)| at.turn[*axis]));
            out.push_str(&motion_line(&row));
        }
    }
    out
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
