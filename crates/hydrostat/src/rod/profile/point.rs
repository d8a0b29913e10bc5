//! The numbers that a profile is given by, one at a time.

use std::fmt;

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Join, Profile};

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
                assert_eq!(profile.with_point(none, 0.7).is_some(), profile.points().contains(&none));
            }
        }
        for wrong in [".bas", "[1]", "[x][1]", "[1][0]", "base"] {
            assert_eq!(Point::read(wrong), None, "{wrong}");
        }
    }
}
