//! What is written of a row, and under which names.

use std::fmt;
use std::str::FromStr;

use hydrostat::{Arm, Stability, Wanted, Warning};
use hydrostat_files::{Axis, AxisValue, TOLERANCE_MISSED};

use crate::answer::{AnyRow, NoAnswer};

/// Something that can be asked of every row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Output {
    /// Place and angle of the tip.
    Tip,
    /// alpha at the tip.
    Alpha,
    /// How far each cable is reeled in.
    Strokes,
    /// The tension of each cable.
    Tensions,
    /// Base reaction.
    Base,
    /// How far the surface is from folding.
    Fold,
    /// Whether the row is stable, and in how many directions it is not.
    Stability,
    /// Estimated error of the tip position.
    Error,
    /// The snaps on the way to the loads: how many, and of the one that goes furthest load fraction, distance, angle and duration.
    Snaps,
    /// What should be known about the answer.
    Warnings,
    /// Why there is no answer: kind, phase, load fraction and place, or in words why there is no arm.
    Verdict,
}

impl Output {
    /// All, in the order of their columns.
    pub const ALL: [Self; 11] = [
        Self::Tip,
        Self::Alpha,
        Self::Strokes,
        Self::Tensions,
        Self::Base,
        Self::Fold,
        Self::Stability,
        Self::Error,
        Self::Snaps,
        Self::Warnings,
        Self::Verdict,
    ];

    /// What is written unless something else is asked for.
    pub const DEFAULT: [Self; 7] =
        [Self::Tip, Self::Alpha, Self::Strokes, Self::Base, Self::Error, Self::Warnings, Self::Verdict];

    /// The name that it is asked for with.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tip => "tip",
            Self::Alpha => "alpha",
            Self::Strokes => "strokes",
            Self::Tensions => "tensions",
            Self::Base => "base",
            Self::Fold => "fold",
            Self::Stability => "stability",
            Self::Error => "error",
            Self::Snaps => "snaps",
            Self::Warnings => "warnings",
            Self::Verdict => "verdict",
        }
    }
}

impl fmt::Display for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Output {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|output| output.name() == name.trim()).ok_or_else(|| {
            let names: Vec<&str> = Self::ALL.iter().map(|output| output.name()).collect();
            format!("expected some of {} with commas between, found \"{name}\"", names.join(", "))
        })
    }
}

/// The values of a column, in the order of the rows.
#[derive(Debug, Clone, PartialEq)]
pub enum Data {
    /// Whole numbers, or nothing.
    Whole(Vec<Option<i64>>),
    /// Numbers; NaN is nothing.
    Number(Vec<f64>),
    /// Words, or nothing.
    Text(Vec<Option<String>>),
}

impl Data {
    /// How many values there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Whole(values) => values.len(),
            Self::Number(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name, with the SI unit: `tip_x_m`.
    pub name: String,
    /// Its values.
    pub data: Data,
}

/// What became of a row.
pub(crate) type Answer = Result<AnyRow, NoAnswer>;

/// An answer, and the error of the tip (m) that was asked for.
pub(crate) struct Answered {
    pub(crate) answer: Answer,
    pub(crate) asked: f64,
}

/// The column of warnings.
pub(crate) const WARNINGS: &str = "warnings";

/// The kinds of the warnings of a row with blanks between, each once, as the column of warnings has them. Of the errors of the tip (m) one
/// is that of the row, the other was asked for.
///
/// ```
/// let sealed = hydrostat::Warning::SealedCavity;
/// let kinds = hydrostat_sweep::warning_kinds(&[sealed.clone(), sealed], 1e-6, 1e-8);
/// assert_eq!(kinds, "sealed_cavity tolerance_missed");
/// ```
pub fn kinds(warnings: &[Warning], error_estimate: f64, asked: f64) -> String {
    let mut out: Vec<&str> = warnings.iter().map(Warning::kind).collect();
    out.dedup();
    if error_estimate > asked {
        out.push(TOLERANCE_MISSED);
    }
    out.join(" ")
}

/// The columns of a sweep.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    outputs: Vec<Output>,
    cables: usize,
    stations: usize,
    /// Whether rows are of an arm in space.
    space: bool,
}

/// The first column.
pub(crate) const ROW: &str = "row";

impl Layout {
    /// With these outputs (the verdict always is one) of rows of `arm`.
    pub(crate) fn new(outputs: &[Output], arm: &Arm, stations: usize) -> Self {
        let given = |output: &Output| *output == Output::Verdict || outputs.contains(output);
        let outputs = Output::ALL.into_iter().filter(given).collect();
        Self { outputs, cables: arm.cables.len(), stations, space: arm.space.is_some() }
    }

    pub(crate) fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    /// Whether rows are of an arm in space.
    pub(crate) fn is_spatial(&self) -> bool {
        self.space
    }

    pub(crate) fn wanted(&self) -> Wanted {
        let has = |output| self.outputs.contains(&output);
        Wanted {
            strokes: has(Output::Strokes),
            fold_margin: has(Output::Fold),
            stability: has(Output::Stability),
            warnings: has(Output::Warnings),
            stations: self.stations,
        }
    }

    /// Empty columns.
    pub(crate) fn columns(&self, axes: &[Axis]) -> Vec<Column> {
        let number = |name: String| Column { name, data: Data::Number(Vec::new()) };
        let text = |name: &str| Column { name: name.to_owned(), data: Data::Text(Vec::new()) };
        let mut out = vec![Column { name: ROW.to_owned(), data: Data::Whole(Vec::new()) }];
        out.extend(axes.iter().map(|axis| match axis.dimension {
            Some(_) => number(axis.column()),
            None => text(&axis.column()),
        }));
        for output in &self.outputs {
            let numbers: Vec<String> = match output {
                Output::Tip => self.tip_columns(),
                Output::Alpha => vec!["tip_alpha_rad".to_owned()],
                Output::Strokes => (0..self.cables).map(|c| format!("stroke_{c}_m")).collect(),
                Output::Tensions => (0..self.cables).map(|c| format!("tension_{c}_N")).collect(),
                Output::Base if self.space => {
                    let force = AXES.map(|axis| format!("base_force_{axis}_N"));
                    force.into_iter().chain(AXES.map(|axis| format!("base_moment_{axis}_Nm"))).collect()
                }
                Output::Base => ["base_force_x_N", "base_force_y_N", "base_moment_Nm"].map(str::to_owned).into(),
                Output::Fold => ["fold_margin", "fold_s_m"].map(str::to_owned).into(),
                Output::Error => vec!["error_estimate_m".to_owned()],
                Output::Stability => {
                    out.push(text("stability"));
                    out.push(Column { name: "unstable_directions".to_owned(), data: Data::Whole(Vec::new()) });
                    continue;
                }
                Output::Snaps => {
                    out.push(Column { name: "snaps".to_owned(), data: Data::Whole(Vec::new()) });
                    let of = ["snap_load_fraction", "snap_distance_m", "snap_angle_rad", "snap_duration_s"];
                    out.extend(of.map(|name| number(name.to_owned())));
                    continue;
                }
                Output::Warnings => {
                    out.push(text(WARNINGS));
                    continue;
                }
                Output::Verdict => {
                    out.extend([text("verdict"), text("phase")]);
                    out.extend(["load_fraction", "verdict_s_m"].map(|name| number(name.to_owned())));
                    out.push(text(REASON));
                    continue;
                }
            };
            out.extend(numbers.into_iter().map(number));
        }
        for (name, unit) in self.shape() {
            out.extend((0..self.stations).map(|k| number(format!("shape_{name}_{k}{unit}"))));
        }
        out
    }

    fn tip_columns(&self) -> Vec<String> {
        if !self.space {
            return ["tip_x_m", "tip_y_m", "tip_theta_rad"].map(str::to_owned).into();
        }
        let place = AXES.map(|axis| format!("tip_{axis}_m"));
        let directors = ["a", "b", "c"].into_iter().flat_map(|name| AXES.map(|axis| format!("tip_{name}_{axis}")));
        place.into_iter().chain(directors).collect()
    }

    /// What shapes have at every station: names, and the ends of columns' names.
    fn shape(&self) -> &'static [(&'static str, &'static str)] {
        if self.space { &SHAPE_IN_SPACE } else { &SHAPE }
    }

    /// Adds a row to what [`Layout::columns`] has made; see there.
    pub(crate) fn add(&self, columns: &mut [Column], index: u64, values: &[AxisValue<'_>], answer: &Answered) {
        let Answered { answer: row, asked } = answer;
        let mut cells = Cells { columns: columns.iter_mut() };
        cells.whole(i64::try_from(index).ok());
        for value in values {
            match value {
                AxisValue::Number(number) => cells.number(*number),
                AxisValue::Word(word) => cells.text(Some(word)),
            }
        }
        let found = row.as_ref().ok();
        let nothing = f64::NAN;
        for output in &self.outputs {
            match output {
                Output::Tip => {
                    let tip = found.map(AnyRow::tip);
                    cells.numbers((0..self.tip_columns().len()).map(|k| tip.as_ref()?.get(k).copied()));
                }
                Output::Alpha => cells.number(found.map_or(nothing, AnyRow::alpha)),
                Output::Strokes => cells.numbers((0..self.cables).map(|c| found?.strokes().get(c).copied())),
                Output::Tensions => cells.numbers((0..self.cables).map(|c| found?.tensions().get(c).copied())),
                Output::Base => {
                    let base = found.map(AnyRow::base);
                    let count = if self.space { 2 * AXES.len() } else { 3 };
                    cells.numbers((0..count).map(|k| base.as_ref()?.get(k).copied()));
                }
                Output::Fold => {
                    let fold = found.and_then(AnyRow::fold_margin);
                    cells.numbers([fold.map(|fold| fold.value), fold.map(|fold| fold.s)]);
                }
                Output::Error => cells.number(found.map_or(nothing, AnyRow::error_estimate)),
                Output::Stability => {
                    let stability = found.and_then(AnyRow::stability);
                    cells.text(stability.map(Stability::name));
                    cells.whole(stability.and_then(Stability::directions).and_then(|count| i64::try_from(count).ok()));
                }
                Output::Snaps => {
                    let snaps = found.map(AnyRow::snaps);
                    cells.whole(snaps.and_then(|(count, _)| i64::try_from(count).ok()));
                    cells.numbers(snaps.map_or([None; 4], |(_, of)| of));
                }
                Output::Warnings => {
                    let kinds = found.map(|row| kinds(row.warnings(), row.error_estimate(), *asked));
                    cells.text(kinds.filter(|kinds| !kinds.is_empty()).as_deref());
                }
                Output::Verdict => {
                    let (verdict, reason) = match row {
                        Ok(_) => (None, None),
                        Err(NoAnswer::Verdict(verdict)) => (Some(verdict), None),
                        Err(NoAnswer::Arm(reason)) => (None, Some(reason.as_str())),
                    };
                    cells.text(verdict.map(|v| v.kind.name()).or(reason.map(|_| NO_ARM)));
                    cells.text(verdict.map(|v| v.phase.name()));
                    cells.numbers([verdict.map(|v| v.load_fraction), verdict.and_then(|v| v.s)]);
                    cells.text(reason);
                }
            }
        }
        for field in 0..self.shape().len() {
            cells.numbers((0..self.stations).map(|station| found?.shape(field, station)));
        }
    }
}

const SHAPE: [(&str, &str); 3] = [("x", "_m"), ("y", "_m"), ("theta", "_rad")];
const SHAPE_IN_SPACE: [(&str, &str); 9] = [
    ("x", "_m"),
    ("y", "_m"),
    ("z", "_m"),
    ("a_x", ""),
    ("a_y", ""),
    ("a_z", ""),
    ("b_x", ""),
    ("b_y", ""),
    ("b_z", ""),
];

/// Along e1, e2, e3.
const AXES: [&str; 3] = ["x", "y", "z"];

/// The verdict of a row whose values together make no arm.
pub const NO_ARM: &str = "no_arm";

/// The column that says why they make none.
pub(crate) const REASON: &str = "reason";

/// Columns that get a cell each, one after the other.
struct Cells<'a> {
    columns: std::slice::IterMut<'a, Column>,
}

impl Cells<'_> {
    fn number(&mut self, value: f64) {
        if let Some(Column { data: Data::Number(values), .. }) = self.columns.next() {
            values.push(if value.is_finite() { value } else { f64::NAN });
        }
    }

    fn numbers(&mut self, values: impl IntoIterator<Item = Option<f64>>) {
        for value in values {
            self.number(value.unwrap_or(f64::NAN));
        }
    }

    fn text(&mut self, value: Option<&str>) {
        if let Some(Column { data: Data::Text(values), .. }) = self.columns.next() {
            values.push(value.map(str::to_owned));
        }
    }

    fn whole(&mut self, value: Option<i64>) {
        if let Some(Column { data: Data::Whole(values), .. }) = self.columns.next() {
            values.push(value);
        }
    }
}
