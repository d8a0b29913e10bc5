//! Interpolation of tables: the monotone piecewise cubic of Fritsch and Carlson, and straight lines.

/// How the points of a [`Table`] are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Join {
    /// By a monotone piecewise cubic: the slope is continuous, and between two points is no value beyond theirs.
    #[default]
    Cubic,
    /// By straight lines: the slope jumps at the points.
    Linear,
}

impl Join {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Cubic, Self::Linear];
    /// Their words in arm files, in the same order.
    pub const NAMES: [&'static str; 2] = ["cubic", "linear"];

    /// The word in arm files.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// Value and derivatives of a [`Profile`](crate::Profile) at one place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sample {
    /// The value, in the unit of the profile.
    pub value: f64,
    /// First derivative in s, per metre.
    pub slope: f64,
    /// Second derivative in s, per square metre. At a knot of a table, where it jumps, the value
    /// to the right.
    pub curvature: f64,
}

/// Points joined by a monotone piecewise cubic (Fritsch and Carlson 1980; Fritsch and Butland 1984
/// for the weighted harmonic mean), with the slopes of SciPy's `PchipInterpolator`, end slopes included; or by straight
/// lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    pub(super) s: Vec<f64>,
    pub(super) value: Vec<f64>,
    /// At the points; none where straight lines join them.
    pub(super) slope: Vec<f64>,
}

/// Why points do not make a [`Table`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableError {
    /// Fewer than two points.
    #[error("a table needs at least two points [s, value], found {found}")]
    TooShort {
        /// How many there were.
        found: usize,
    },
    /// A number that is NaN or infinite.
    #[error("point {index} of the table, [{s}, {value}], is not finite")]
    NotFinite {
        /// Which point, from 0.
        index: usize,
        /// Its place.
        s: f64,
        /// Its value.
        value: f64,
    },
    /// Places that do not increase.
    #[error("the places of a table must increase: point {index} at s = {s} follows s = {previous}")]
    NotIncreasing {
        /// Which point, from 0.
        index: usize,
        /// Its place.
        s: f64,
        /// The place before it.
        previous: f64,
    },
}

impl Table {
    /// Builds the monotone piecewise cubic through `points`, each `[s in m, value]`.
    ///
    /// # Errors
    /// See [`TableError`].
    pub fn new(points: &[[f64; 2]]) -> Result<Self, TableError> {
        Self::joined(points, Join::Cubic)
    }

    /// Builds the interpolant through `points`, each `[s in m, value]`.
    ///
    /// # Errors
    /// See [`TableError`].
    pub fn joined(points: &[[f64; 2]], join: Join) -> Result<Self, TableError> {
        if points.len() < 2 {
            return Err(TableError::TooShort { found: points.len() });
        }
        for (index, &[s, value]) in points.iter().enumerate() {
            if !s.is_finite() || !value.is_finite() {
                return Err(TableError::NotFinite { index, s, value });
            }
            if index > 0 && s <= points[index - 1][0] {
                return Err(TableError::NotIncreasing { index, s, previous: points[index - 1][0] });
            }
        }
        let s: Vec<f64> = points.iter().map(|p| p[0]).collect();
        let value: Vec<f64> = points.iter().map(|p| p[1]).collect();
        let slope = slopes(join, &s, &value);
        Ok(Self { s, value, slope })
    }

    /// The points, as `[s, value]`.
    pub fn points(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.s.iter().zip(&self.value).map(|(s, v)| [*s, *v])
    }

    /// The first place and the last one.
    pub(crate) fn ends(&self) -> [f64; 2] {
        [self.s[0], self.s[self.s.len() - 1]]
    }

    /// How they are joined.
    pub fn join(&self) -> Join {
        if self.slope.is_empty() { Join::Linear } else { Join::Cubic }
    }

    pub(crate) fn at(&self, s: f64) -> Sample {
        let last = self.s.len() - 2;
        let i = self.s.partition_point(|knot| *knot <= s).saturating_sub(1).min(last);
        let h = self.s[i + 1] - self.s[i];
        let chord = (self.value[i + 1] - self.value[i]) / h;
        if self.slope.is_empty() {
            return Sample { value: self.value[i] + (s - self.s[i]) * chord, slope: chord, curvature: 0.0 };
        }
        let c2 = (3.0 * chord - 2.0 * self.slope[i] - self.slope[i + 1]) / h;
        let c3 = (self.slope[i] + self.slope[i + 1] - 2.0 * chord) / (h * h);
        let t = s - self.s[i];
        Sample {
            value: self.value[i] + t * (self.slope[i] + t * (c2 + t * c3)),
            slope: self.slope[i] + t * (2.0 * c2 + 3.0 * t * c3),
            curvature: 2.0 * c2 + 6.0 * t * c3,
        }
    }
}

/// At the points; none where straight lines join them.
pub(super) fn slopes(join: Join, s: &[f64], value: &[f64]) -> Vec<f64> {
    match join {
        Join::Cubic => pchip_slopes(s, value),
        Join::Linear => Vec::new(),
    }
}

fn pchip_slopes(s: &[f64], value: &[f64]) -> Vec<f64> {
    let n = s.len();
    let h: Vec<f64> = s.windows(2).map(|w| w[1] - w[0]).collect();
    let chord: Vec<f64> = value.windows(2).zip(&h).map(|(v, h)| (v[1] - v[0]) / h).collect();
    if n == 2 {
        return vec![chord[0]; 2];
    }
    let mut slope = vec![0.0; n];
    for i in 1..n - 1 {
        let (before, after) = (chord[i - 1], chord[i]);
        if before * after > 0.0 {
            let (w1, w2) = (2.0 * h[i] + h[i - 1], h[i] + 2.0 * h[i - 1]);
            slope[i] = (w1 + w2) / (w1 / before + w2 / after);
        }
    }
    slope[0] = end_slope(h[0], h[1], chord[0], chord[1]);
    slope[n - 1] = end_slope(h[n - 2], h[n - 3], chord[n - 2], chord[n - 3]);
    slope
}

/// One-sided three-point slope at an end, limited so that the cubic stays monotone.
fn end_slope(h0: f64, h1: f64, chord0: f64, chord1: f64) -> f64 {
    let slope = ((2.0 * h0 + h1) * chord0 - h0 * chord1) / (h0 + h1);
    if slope * chord0 <= 0.0 {
        0.0
    } else if chord0 * chord1 <= 0.0 && slope.abs() > 3.0 * chord0.abs() {
        3.0 * chord0
    } else {
        slope
    }
}
