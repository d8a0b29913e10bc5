//! A quantity given along the arm, with its slope and curvature.

mod point;
mod table;

use std::fmt;

use hydrostat_bvp::{LANES, Lanes, Real};

use crate::rod::arm::ArmError;

pub use self::point::Point;
use self::table::slopes;
pub use self::table::{Join, Sample, Table, TableError};

/// A quantity along the reference arc length `s` in [0, L], base to tip.
///
/// ```
/// use hydrostat::Profile;
///
/// let radius = Profile::linear(0.010, 0.002);
/// let middle = radius.at(0.1, 0.2); // s = 0.1 m on an arm of 0.2 m
/// assert!((middle.value - 0.006).abs() < 1e-15);
/// assert!((middle.slope + 0.04).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// The same everywhere.
    Constant(f64),
    /// Linear from base (s = 0) to tip (s = L).
    Linear {
        /// Value at s = 0.
        base: f64,
        /// Value at s = L.
        tip: f64,
    },
    /// Through given points, joined by a monotone piecewise cubic or by straight lines.
    Table(Table),
}

impl Profile {
    /// A profile that is `base` at s = 0 and `tip` at s = L, linear between.
    pub fn linear(base: f64, tip: f64) -> Self {
        Self::Linear { base, tip }
    }

    /// A monotone piecewise cubic through `points`, each `[s in m, value]`.
    ///
    /// # Errors
    /// [`TableError`] when there are fewer than two points, one is not finite, or `s` does not increase.
    pub fn table(points: &[[f64; 2]]) -> Result<Self, TableError> {
        Self::joined(points, Join::Cubic)
    }

    /// A profile through `points`, each `[s in m, value]`, joined as `join` says.
    ///
    /// ```
    /// use hydrostat::{Join, Profile};
    ///
    /// let radius = Profile::joined(&[[0.0, 0.010], [0.1, 0.010], [0.2, 0.002]], Join::Linear)?;
    /// assert!((radius.at(0.15, 0.2).value - 0.006).abs() < 1e-15);
    /// # Ok::<(), hydrostat::TableError>(())
    /// ```
    ///
    /// # Errors
    /// As of [`Profile::table`].
    pub fn joined(points: &[[f64; 2]], join: Join) -> Result<Self, TableError> {
        Table::joined(points, join).map(Self::Table)
    }

    /// Value, slope and curvature at `s` (m) on an arm of length `length` (m).
    pub fn at(&self, s: f64, length: f64) -> Sample {
        match self {
            Self::Constant(value) => Sample { value: *value, slope: 0.0, curvature: 0.0 },
            Self::Linear { base, tip } => {
                let slope = (tip - base) / length;
                Sample { value: base + slope * s, slope, curvature: 0.0 }
            }
            Self::Table(table) => table.at(s),
        }
    }

    /// Values, slopes and curvatures at four places, to the bit those of [`Profile::at`].
    #[inline(always)]
    pub(crate) fn at_four(&self, s: Lanes, length: f64) -> [Lanes; 3] {
        let zero = Lanes::of(0.0);
        match self {
            Self::Constant(value) => [Lanes::of(*value), zero, zero],
            Self::Linear { base, tip } => {
                let slope = Lanes::of((tip - base) / length);
                [Lanes::of(*base) + slope * s, slope, zero]
            }
            Self::Table(table) => {
                let mut out = [zero; 3];
                for lane in 0..LANES {
                    let Sample { value, slope, curvature } = table.at(s.0[lane]);
                    for (out, own) in out.iter_mut().zip([value, slope, curvature]) {
                        out.0[lane] = own;
                    }
                }
                out
            }
        }
    }

    /// The places strictly inside (0, length) where the curvature jumps, or the slope: the knots of a table.
    pub fn knots(&self) -> &[f64] {
        match self {
            Self::Table(table) => &table.s[1..table.s.len() - 1],
            _ => &[],
        }
    }

    /// Smallest and largest value on [0, `upto`] (m), exact because every kind of profile is
    /// monotone between its knots.
    pub fn range(&self, upto: f64, length: f64) -> (f64, f64) {
        let inner = self.knots().iter().copied().filter(|s| *s < upto);
        std::iter::once(0.0)
            .chain(inner)
            .chain(std::iter::once(upto))
            .map(|s| self.at(s, length).value)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)))
    }

    /// Whether it is zero everywhere.
    pub fn is_zero(&self) -> bool {
        match self {
            Self::Constant(v) => *v == 0.0,
            Self::Linear { base, tip } => *base == 0.0 && *tip == 0.0,
            Self::Table(t) => t.value.iter().all(|v| *v == 0.0),
        }
    }

    /// This profile with every value multiplied by `factor` and every place by `stretch`.
    pub fn scaled(&self, factor: f64, stretch: f64) -> Self {
        match self {
            Self::Constant(v) => Self::Constant(v * factor),
            Self::Linear { base, tip } => Self::Linear { base: base * factor, tip: tip * factor },
            Self::Table(t) => Self::Table(Table {
                s: t.s.iter().map(|s| s * stretch).collect(),
                value: t.value.iter().map(|v| v * factor).collect(),
                slope: t.slope.iter().map(|d| d * factor / stretch).collect(),
            }),
        }
    }

    /// Refuses values that are not finite and tables that do not cover [0, `length`].
    pub(crate) fn check(&self, key: impl fmt::Display, length: f64) -> Result<(), ArmError> {
        let finite = match self {
            Self::Constant(v) => v.is_finite(),
            Self::Linear { base, tip } => base.is_finite() && tip.is_finite(),
            Self::Table(_) => true,
        };
        if !finite {
            return Err(ArmError::NotFinite { key: key.to_string() });
        }
        if let Self::Table(table) = self {
            let (from, to) = (table.s[0], table.s[table.s.len() - 1]);
            let slack = 1e-9 * length;
            if from.abs() > slack || (to - length).abs() > slack {
                return Err(ArmError::TableDoesNotCover { key: key.to_string(), from, to, length });
            }
        }
        Ok(())
    }
}

impl From<f64> for Profile {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

impl Profile {
    /// All numbers that it is given by, from base to tip.
    pub fn points(&self) -> Vec<Point> {
        match self {
            Self::Constant(_) => vec![Point::Whole],
            Self::Linear { .. } => vec![Point::Base, Point::Tip],
            Self::Table(table) => (0..table.s.len()).map(Point::Knot).collect(),
        }
    }

    /// One of them; `None` of another kind of profile.
    pub fn point(&self, point: Point) -> Option<f64> {
        match (self, point) {
            (Self::Constant(value), Point::Whole) => Some(*value),
            (Self::Linear { base, .. }, Point::Base) => Some(*base),
            (Self::Linear { tip, .. }, Point::Tip) => Some(*tip),
            (Self::Table(table), Point::Knot(k)) => table.value.get(k).copied(),
            _ => None,
        }
    }

    /// The profile with another value of one of them.
    pub fn with_point(&self, point: Point, value: f64) -> Option<Self> {
        self.point(point)?;
        let mut out = self.clone();
        match (&mut out, point) {
            (Self::Constant(own), _) => *own = value,
            (Self::Linear { base, .. }, Point::Base) => *base = value,
            (Self::Linear { tip, .. }, _) => *tip = value,
            (Self::Table(table), Point::Knot(k)) => {
                table.value[k] = value;
                table.slope = slopes(table.join(), &table.s, &table.value);
            }
            (Self::Table(_), _) => return None,
        }
        Some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SciPy 1.11 `PchipInterpolator([0, 1, 3, 4], [0, 2, 3, 1])` at the points and its slopes.
    #[test]
    fn slopes_are_those_of_scipy() {
        let Profile::Table(t) = Profile::table(&[[0.0, 0.0], [1.0, 2.0], [3.0, 3.0], [4.0, 1.0]]).unwrap() else {
            unreachable!()
        };
        // End: ((2*1+2)*2 - 1*0.5)/3 = 2.5; inner: (5+4)/(5/2+4/0.5) = 6/7; turn: 0;
        // end: ((2*1+2)*(-2) - 1*0.5)/3 = -17/6.
        for (got, want) in t.slope.iter().zip([2.5, 6.0 / 7.0, 0.0, -17.0 / 6.0]) {
            assert!((got - want).abs() < 1e-14, "{got} {want}");
        }
    }

    #[test]
    fn derivatives_match_differences() {
        let p = Profile::table(&[[0.0, 1.0], [0.3, 1.5], [0.7, 1.6], [1.0, 3.0]]).unwrap();
        for s in [0.05, 0.41, 0.93] {
            let d = 1e-6;
            let (lo, hi) = (p.at(s - d, 1.0), p.at(s + d, 1.0));
            assert!(((hi.value - lo.value) / (2.0 * d) - p.at(s, 1.0).slope).abs() < 1e-8);
            assert!(((hi.slope - lo.slope) / (2.0 * d) - p.at(s, 1.0).curvature).abs() < 1e-7);
        }
    }

    #[test]
    fn straight_lines_go_from_point_to_point() {
        let points = [[0.0, 1.0], [0.3, 1.6], [0.7, 1.2], [1.0, 3.0]];
        let p = Profile::joined(&points, Join::Linear).unwrap();
        for pair in points.windows(2) {
            let [[s, v], [t, w]] = [pair[0], pair[1]];
            for fraction in [0.0, 0.25, 0.9] {
                let at = p.at(s + fraction * (t - s), 1.0);
                assert!((at.value - (v + fraction * (w - v))).abs() < 1e-14 && at.curvature == 0.0);
                assert!((at.slope - (w - v) / (t - s)).abs() < 1e-12);
            }
        }
        assert_eq!((p.at(1.0, 1.0).value, p.knots(), p.range(1.0, 1.0)), (3.0, &[0.3, 0.7][..], (1.0, 3.0)));
        assert_eq!(p.scaled(2.0, 0.5).at(0.25, 0.5).slope, 4.0 * p.at(0.5, 1.0).slope);
    }

    #[test]
    fn bad_tables_are_refused_with_their_numbers() {
        assert_eq!(Table::new(&[[0.0, 1.0]]), Err(TableError::TooShort { found: 1 }));
        assert_eq!(
            Table::new(&[[0.0, 1.0], [0.0, 2.0]]),
            Err(TableError::NotIncreasing { index: 1, s: 0.0, previous: 0.0 })
        );
        assert!(matches!(Table::new(&[[0.0, f64::NAN], [1.0, 2.0]]), Err(TableError::NotFinite { .. })));
    }
}
