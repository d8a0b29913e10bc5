//! Elements that meet the closure's equation at both ends.

use crate::gauss::POINTS;

/// An element that meets the closure's equation at its other end too: `w = row . z + what columns add`.
#[derive(Debug, Clone)]
pub(super) struct Closing<const N: usize, const M: usize> {
    pub(super) element: usize,
    /// Block and lane of its other end.
    pub(super) block: usize,
    pub(super) lane: usize,
    pub(super) row: [f64; N],
    /// What a change of the inner equation at the other end adds, and a defect of its closure slope.
    pub(super) by_change: f64,
    pub(super) by_defect: f64,
    pub(super) defect: f64,
    /// What the values of a column at stages and own end add, and its stage slopes.
    pub(super) by_value: [f64; POINTS],
    pub(super) by_slopes: [[f64; N]; M],
    /// The closure slope there by the values of a column, and by w, at fixed states.
    pub(super) slope_by_point: [f64; POINTS],
    pub(super) slope_by_taken: f64,
    /// What the element's maps were before w was put in.
    pub(super) by_taken: [f64; N],
    pub(super) own_by_taken: f64,
}
