//! How far fitted places are from the measured ones.

use crate::fit::Residual;
use crate::quantity::Marker;

/// Of one marker over several load cases.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Miss {
    /// Which.
    pub marker: Marker,
    /// Load cases in which it was measured.
    pub count: usize,
    /// Root of the mean square of the distances from the measured to the fitted place, of the coordinates that were measured, m.
    pub rms: f64,
    /// The largest distance, m.
    pub most: f64,
}

/// Of every marker, in the order of the residuals.
///
/// ```
/// use hydrostat_identify::{Measurement, Quantity, Residual, misses};
///
/// let of = |case, quantity, fitted| {
///     Residual { case, measurement: Measurement::new(quantity, 0.0, 1e-3), fitted, standardised: 1e3 * fitted, weight: 1.0 }
/// };
/// let all = [of(0, Quantity::X(0.2), 3e-3), of(0, Quantity::Y(0.2), 4e-3), of(1, Quantity::X(0.2), 0.0)];
/// let found = misses(&all);
/// assert_eq!((found.len(), found[0].count, found[0].most), (1, 2, 5e-3));
/// assert!((found[0].rms - 12.5e-6_f64.sqrt()).abs() < 1e-15);
/// ```
pub fn misses<'a>(residuals: impl IntoIterator<Item = &'a Residual>) -> Vec<Miss> {
    // Of each marker: load cases with squares of distances.
    let mut all: Vec<(Marker, Vec<(usize, f64)>)> = Vec::new();
    for one in residuals {
        let Some((marker, _)) = one.measurement.quantity.marker() else { continue };
        let square = (one.fitted - one.measurement.value).powi(2);
        let at = all.iter().position(|(own, _)| *own == marker).unwrap_or_else(|| {
            all.push((marker, Vec::new()));
            all.len() - 1
        });
        match all[at].1.iter_mut().find(|(case, _)| *case == one.case) {
            Some((_, sum)) => *sum += square,
            None => all[at].1.push((one.case, square)),
        }
    }
    let miss = |(marker, squares): (Marker, Vec<(usize, f64)>)| {
        let count = squares.len();
        let sum: f64 = squares.iter().map(|(_, square)| square).sum();
        let most = squares.iter().fold(0.0_f64, |m, (_, square)| m.max(*square)).sqrt();
        Miss { marker, count, rms: (sum / count as f64).sqrt(), most }
    };
    all.into_iter().map(miss).collect()
}
