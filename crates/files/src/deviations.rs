//! Standard deviations of measured numbers that have none of their own.

use crate::error::shortened;
use crate::quantity::Dimension;

/// Standard deviations for what has none of its own.
///
/// ```
/// use hydrostat_files::Deviations;
///
/// let mut all = Deviations::default();
/// all.add("1 mm").unwrap();
/// all.add("0.5 deg").unwrap();
/// assert_eq!((all.length, all.force), (Some(1e-3), None));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deviations {
    /// Of positions and strokes, m.
    pub length: Option<f64>,
    /// Of angles, rad.
    pub angle: Option<f64>,
    /// Of tensions and base forces, N.
    pub force: Option<f64>,
    /// Of base moments, N m.
    pub moment: Option<f64>,
}

impl Deviations {
    /// Adds one, whose unit says what it is of.
    ///
    /// # Errors
    /// A sentence, where it has no unit of a length, an angle, a force or a moment, or is not above zero.
    pub fn add(&mut self, text: &str) -> Result<(), String> {
        let own = [
            (Dimension::Length, &mut self.length),
            (Dimension::Angle, &mut self.angle),
            (Dimension::Force, &mut self.force),
            (Dimension::Moment, &mut self.moment),
        ];
        let found = own.into_iter().find_map(|(dimension, place)| Some((dimension.parse(text).ok()?, place)));
        match found {
            Some((value, place)) if value > 0.0 => {
                *place = Some(value);
                Ok(())
            }
            _ => Err(format!(
                "expected a standard deviation with its unit, as in \"1 mm\", \"0.5 deg\", \"2 mN\" or \"0.1 N mm\", found \"{}\"",
                shortened(text)
            )),
        }
    }

    pub(crate) fn of(&self, dimension: Dimension) -> Option<f64> {
        match dimension {
            Dimension::Length => self.length,
            Dimension::Angle => self.angle,
            Dimension::Force => self.force,
            _ => self.moment,
        }
    }
}
