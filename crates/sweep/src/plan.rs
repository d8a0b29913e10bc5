//! The rows of a sweep: which values each has, and how they fall into tiles.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use hydrostat_files::{Axis, AxisValue, AxisValues};

use crate::draw::{hash, permuted, unit};
use crate::sobol::{self, Sobol};

/// Rows of a tile, about: long enough that its first one, solved from nothing, costs little of it.
const TILE: u64 = 128;
/// The most rows of a sweep.
const MOST: u64 = 1 << 40;

/// How rows are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sample {
    /// Every combination of the values, the last key running fastest.
    Grid,
    /// A Latin hypercube of so many rows: each key's range is cut into as many parts, and each part is met once.
    Lhs(u64),
    /// So many rows of Sobol's sequence, its digits shifted at random.
    Sobol(u64),
}

impl fmt::Display for Sample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Grid => f.write_str("grid"),
            Self::Lhs(count) => write!(f, "lhs:{count}"),
            Self::Sobol(count) => write!(f, "sobol:{count}"),
        }
    }
}

impl FromStr for Sample {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("expected lhs:N or sobol:N with N rows, at least 1, found \"{text}\"");
        let (kind, count) = text.split_once(':').ok_or_else(wrong)?;
        let count = count.trim().parse().ok().filter(|count| (1..=MOST).contains(count)).ok_or_else(wrong)?;
        match kind.trim() {
            "lhs" => Ok(Self::Lhs(count)),
            "sobol" => Ok(Self::Sobol(count)),
            _ => Err(wrong()),
        }
    }
}

/// Why keys and values make no plan.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PlanError {
    /// Nothing varies.
    #[error("a sweep needs at least one key that varies")]
    NoAxes,
    /// One key twice.
    #[error("{key}: the key is given twice")]
    Twice {
        /// The key.
        key: String,
    },
    /// A range to draw from in a grid.
    #[error("{key}: expected FROM:TO:COUNT or a list, because no sample is drawn, found a range without a count")]
    NoCount {
        /// The key.
        key: String,
    },
    /// A grid where a range to draw from belongs.
    #[error("{key}: expected FROM:TO or a list, because a sample is drawn, found a range of {count} values")]
    Counted {
        /// The key.
        key: String,
        /// Its values.
        count: u64,
    },
    /// More keys or rows than there are points of Sobol's sequence.
    #[error(
        "expected at most {} keys and {} rows of a Sobol sample, found {keys} and {rows}; lhs has no such limit",
        sobol::DIMENSIONS,
        sobol::MOST
    )]
    Sobol {
        /// Keys asked for.
        keys: usize,
        /// Rows asked for.
        rows: u64,
    },
    /// More rows than make sense.
    #[error("expected at most {MOST} rows, found more")]
    TooMany,
}

/// The rows of a sweep.
///
/// ```
/// use hydrostat_files::AxisValue;
/// use hydrostat_sweep::{Plan, Sample};
///
/// let axes = ["flow.speed=0:1:3", "cable[0].tension=5,7"].map(|text| text.parse().unwrap());
/// let plan = Plan::new(axes.to_vec(), Sample::Grid, 0).unwrap();
/// assert_eq!(plan.rows(), 6);
/// assert_eq!(plan.values(3), [AxisValue::Number(0.5), AxisValue::Number(7.0)]);
/// ```
#[derive(Debug, Clone)]
pub struct Plan {
    axes: Vec<Axis>,
    sample: Sample,
    seed: u64,
    rows: u64,
    sobol: Sobol,
}

impl Plan {
    /// Every combination of values, or a sample of them.
    ///
    /// # Errors
    /// [`PlanError`].
    pub fn new(axes: Vec<Axis>, sample: Sample, seed: u64) -> Result<Self, PlanError> {
        if axes.is_empty() {
            return Err(PlanError::NoAxes);
        }
        for (k, axis) in axes.iter().enumerate() {
            if axes[..k].iter().any(|other| other.key == axis.key) {
                return Err(PlanError::Twice { key: axis.key.clone() });
            }
        }
        let rows = match sample {
            Sample::Grid => combinations(&axes)?,
            Sample::Lhs(count) | Sample::Sobol(count) => {
                if let Some((axis, count)) = axes.iter().find_map(|axis| match axis.values {
                    AxisValues::Even { count, .. } => Some((axis, count)),
                    _ => None,
                }) {
                    return Err(PlanError::Counted { key: axis.key.clone(), count });
                }
                count
            }
        };
        if matches!(sample, Sample::Sobol(_)) && (axes.len() > sobol::DIMENSIONS || rows > sobol::MOST) {
            return Err(PlanError::Sobol { keys: axes.len(), rows });
        }
        let sobol = Sobol::new(if matches!(sample, Sample::Sobol(_)) { axes.len() } else { 0 }, seed);
        Ok(Self { axes, sample, seed, rows, sobol })
    }

    /// What varies.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// How rows are chosen.
    pub fn sample(&self) -> Sample {
        self.sample
    }

    /// The seed of a sample.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// How many rows there are.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// The values of a row, in the order of the keys.
    pub fn values(&self, row: u64) -> Vec<AxisValue<'_>> {
        let mut rest = row;
        let mut values: Vec<AxisValue<'_>> = Vec::with_capacity(self.axes.len());
        for (k, axis) in self.axes.iter().enumerate().rev() {
            let value = match self.sample {
                Sample::Grid => {
                    let count = axis.values.count().unwrap_or(1);
                    let value = axis.value(rest % count);
                    rest /= count;
                    value
                }
                _ => axis.drawn(self.fraction(k, row)),
            };
            values.push(value.unwrap_or(AxisValue::Number(f64::NAN)));
        }
        values.reverse();
        values
    }

    /// Where in the range of key `axis` a row of a sample is, in [0, 1).
    fn fraction(&self, axis: usize, row: u64) -> f64 {
        let stream = axis as u64;
        match self.sample {
            Sample::Sobol(_) => self.sobol.at(axis, row),
            Sample::Lhs(count) => {
                let part = permuted(self.seed, 2 * stream, count, row) as f64;
                let inside = unit(hash(self.seed, !stream, row));
                ((part + inside) / count as f64).min(1.0 - f64::EPSILON)
            }
            Sample::Grid => 0.0,
        }
    }

    /// Rows along which only the last key varies.
    fn line(&self) -> u64 {
        match self.sample {
            Sample::Grid => self.axes.last().and_then(|axis| axis.values.count()).unwrap_or(1),
            _ => TILE,
        }
    }

    /// How many tiles there are. They hold consecutive rows and follow from the plan alone.
    pub fn tiles(&self) -> u64 {
        let line = self.line();
        if line >= TILE {
            self.rows.div_ceil(line) * line.div_ceil(2 * TILE)
        } else {
            self.rows.div_ceil(TILE / line * line)
        }
    }

    /// The rows of a tile: a part of a line, or several whole lines.
    pub fn tile(&self, tile: u64) -> Range<u64> {
        let line = self.line();
        let clipped = |range: Range<u64>| range.start.min(self.rows)..range.end.min(self.rows);
        if line < TILE {
            let size = TILE / line * line;
            return clipped(tile * size..(tile + 1) * size);
        }
        let parts = line.div_ceil(2 * TILE);
        let (start, part) = (tile / parts * line, tile % parts);
        clipped(start + part * line / parts..start + (part + 1) * line / parts)
    }

    /// The rows of a tile in the order in which they are solved, so that neighbours follow each other: lines of a grid there
    /// and back, rows of a sample by the nearest that is left.
    pub fn order(&self, tile: u64) -> Vec<u64> {
        let rows = self.tile(tile);
        if self.sample != Sample::Grid {
            return self.by_nearest(rows);
        }
        let line = self.line();
        let turned = |row: u64| {
            let (start, at) = (row / line * line, row % line);
            if line < TILE && (row / line) % 2 == 1 { start + line - 1 - at } else { row }
        };
        rows.map(turned).collect()
    }

    fn by_nearest(&self, rows: Range<u64>) -> Vec<u64> {
        let place = |row: u64| -> Vec<f64> { (0..self.axes.len()).map(|k| self.fraction(k, row)).collect() };
        let mut left: Vec<(u64, Vec<f64>)> = rows.map(|row| (row, place(row))).collect();
        let mut order = Vec::with_capacity(left.len());
        let mut here = vec![0.0; self.axes.len()];
        while !left.is_empty() {
            let far = |at: &[f64]| at.iter().zip(&here).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            let nearest = (0..left.len()).min_by(|a, b| far(&left[*a].1).total_cmp(&far(&left[*b].1))).unwrap_or(0);
            let (row, at) = left.swap_remove(nearest);
            order.push(row);
            here = at;
        }
        order
    }
}

fn combinations(axes: &[Axis]) -> Result<u64, PlanError> {
    let mut rows: u64 = 1;
    for axis in axes {
        let count = axis.values.count().ok_or_else(|| PlanError::NoCount { key: axis.key.clone() })?;
        rows = rows.checked_mul(count).filter(|rows| *rows <= MOST).ok_or(PlanError::TooMany)?;
    }
    Ok(rows)
}
