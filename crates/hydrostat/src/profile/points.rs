//! The numbers that a profile is given by, one at a time, and how it follows each of them.

use std::fmt;

use super::{Join, Profile, Table, end_slope, slopes};

/// One of the numbers that a profile is given by. Shown, it is what follows the profile's key in the arm file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Point {
    /// The value of a constant.
    Whole,
    /// The value of a linear profile at the base.
    Base,
    /// The value of a linear profile at the tip.
    Tip,
    /// The value of a table at its point of this index.
    Knot(usize),
}

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::Base => f.write_str(".base"),
            Self::Tip => f.write_str(".tip"),
            Self::Knot(k) => write!(f, "[{k}][1]"),
        }
    }
}

impl Point {
    /// What [`fmt::Display`] writes, read back.
    pub(crate) fn read(text: &str) -> Option<Self> {
        match text {
            "" => Some(Self::Whole),
            ".base" => Some(Self::Base),
            ".tip" => Some(Self::Tip),
            _ => text.strip_prefix('[')?.strip_suffix("][1]")?.parse().ok().map(Self::Knot),
        }
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

    /// How the profile changes a unit of one of them. The slopes of a table have a kink where neighbouring chords change
    /// their signs; there it is the change to one side.
    pub(crate) fn by_point(&self, point: Point) -> Option<Self> {
        self.point(point)?;
        Some(match (self, point) {
            (Self::Table(table), Point::Knot(k)) => {
                let mut value = vec![0.0; table.s.len()];
                value[k] = 1.0;
                Self::Table(Table { s: table.s.clone(), slope: slope_changes(table, &value), value })
            }
            (Self::Linear { .. }, Point::Base) => Self::linear(1.0, 0.0),
            (Self::Linear { .. }, _) => Self::linear(0.0, 1.0),
            _ => Self::Constant(1.0),
        })
    }
}

/// How the slopes of a table change with its values.
fn slope_changes(table: &Table, change: &[f64]) -> Vec<f64> {
    if table.join() == Join::Linear {
        return Vec::new();
    }
    let n = table.s.len();
    let h: Vec<f64> = table.s.windows(2).map(|w| w[1] - w[0]).collect();
    let chords = |values: &[f64]| -> Vec<f64> { values.windows(2).zip(&h).map(|(v, h)| (v[1] - v[0]) / h).collect() };
    let (chord, by) = (chords(&table.value), chords(change));
    if n == 2 {
        return vec![by[0]; 2];
    }
    let mut out = vec![0.0; n];
    for i in 1..n - 1 {
        let (before, after) = (chord[i - 1], chord[i]);
        if before * after > 0.0 {
            // Of (w1 + w2) / (w1 / before + w2 / after).
            let (w1, w2) = (2.0 * h[i] + h[i - 1], h[i] + 2.0 * h[i - 1]);
            let slope = table.slope[i];
            out[i] = slope * slope / (w1 + w2) * (w1 * by[i - 1] / (before * before) + w2 * by[i] / (after * after));
        }
    }
    let end = |h0: f64, h1: f64, (chord0, by0): (f64, f64), (chord1, by1): (f64, f64)| {
        let limited = end_slope(h0, h1, chord0, chord1);
        let free = ((2.0 * h0 + h1) * chord0 - h0 * chord1) / (h0 + h1);
        if limited == free {
            ((2.0 * h0 + h1) * by0 - h0 * by1) / (h0 + h1)
        } else if limited == 0.0 {
            0.0
        } else {
            3.0 * by0
        }
    };
    out[0] = end(h[0], h[1], (chord[0], by[0]), (chord[1], by[1]));
    let last = n - 2;
    out[n - 1] = end(h[last], h[last - 1], (chord[last], by[last]), (chord[last - 1], by[last - 1]));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_set_and_read_back() {
        for profile in [
            Profile::Constant(0.01),
            Profile::linear(0.01, 0.002),
            Profile::table(&[[0.0, 1.0], [0.4, 1.5], [1.0, 3.0]]).unwrap(),
            Profile::joined(&[[0.0, 1.0], [0.4, 1.5], [1.0, 3.0]], Join::Linear).unwrap(),
        ] {
            for point in profile.points() {
                assert_eq!(Point::read(&point.to_string()), Some(point));
                let moved = profile.with_point(point, 0.7).unwrap();
                assert_eq!(moved.point(point), Some(0.7));
                let others = profile.points().into_iter().filter(|other| *other != point);
                assert!(others.into_iter().all(|other| moved.point(other) == profile.point(other)));
            }
            for none in [Point::Whole, Point::Base, Point::Tip, Point::Knot(3)] {
                assert_eq!(profile.by_point(none).is_some(), profile.points().contains(&none));
            }
        }
        for wrong in [".bas", "[1]", "[x][1]", "[1][0]", "base"] {
            assert_eq!(Point::read(wrong), None, "{wrong}");
        }
    }

    /// A moved table is what its points make, and its change by a point that of small differences, slopes and curvatures included.
    #[test]
    fn changes_match_differences() {
        let tables: [&[[f64; 2]]; 4] = [
            &[[0.0, 1.0], [0.3, 1.5], [0.7, 1.6], [1.0, 3.0]],
            // Slopes that are held at zero: at a turn, and at an end.
            &[[0.0, 1.0], [0.3, 2.0], [0.5, 1.2], [1.0, 1.1]],
            &[[0.0, 1.0], [0.5, 1.05], [1.0, 9.0]],
            &[[0.0, 1.0], [1.0, 3.0]],
        ];
        for (points, join) in tables.into_iter().flat_map(|points| Join::ALL.map(|join| (points, join))) {
            let profile = Profile::joined(points, join).unwrap();
            for (k, point) in profile.points().into_iter().enumerate() {
                let change = profile.by_point(point).unwrap();
                let step = 1e-6;
                let moved = |by: f64| {
                    let moved = profile.with_point(point, points[k][1] + by).unwrap();
                    let mut own = points.to_vec();
                    own[k][1] += by;
                    assert_eq!(moved, Profile::joined(&own, join).unwrap());
                    moved
                };
                let (after, before) = (moved(step), moved(-step));
                for s in [0.05, 0.41, 0.62, 0.93] {
                    let (after, before, change) = (after.at(s, 1.0), before.at(s, 1.0), change.at(s, 1.0));
                    let off = |after: f64, before: f64, change: f64| ((after - before) / (2.0 * step) - change).abs();
                    assert!(off(after.value, before.value, change.value) < 1e-8, "{points:?} {k} {s}");
                    assert!(off(after.slope, before.slope, change.slope) < 1e-7, "{points:?} {k} {s}");
                    assert!(off(after.curvature, before.curvature, change.curvature) < 1e-6, "{points:?} {k} {s}");
                }
            }
        }
    }
}
