//! Small numerical tools: vectors of the processor and rounds on them, small dense systems, sines of four angles.

pub(crate) mod dispatch;
pub(crate) mod elimination;
pub(crate) mod rounds;
pub(crate) mod sincos;

/// The distance between two places.
pub(crate) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum: f64, (a, b)| sum.hypot(a - b))
}
