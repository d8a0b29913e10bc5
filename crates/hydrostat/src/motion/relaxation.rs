//! Material with memory of rate (Kelvin-Voigt), with one relaxation time for all strains.

use hydrostat_bvp::{Lanes, Real, each};

/// Stiffness and reference strains of a section whose strains e change at the rates cv e + `rates`:
/// C (e - e_o + t_v e.) = C (1 + t_v cv) (e - (e_o - t_v rates)/(1 + t_v cv)), with t_v = `time` (s) and cv in 1/s.
#[inline(always)]
pub(super) fn stiffened<const K: usize>(
    [value, reference]: [&[Lanes; K]; 2],
    rates: &[Lanes; K],
    time: f64,
    cv: f64,
) -> [[Lanes; K]; 2]
where
    [Lanes; K]: Default,
{
    let factor = 1.0 + time * cv;
    [
        each(|k| value[k] * Lanes::of(factor)),
        each(|k| (reference[k] - Lanes::of(time) * rates[k]) * Lanes::of(1.0 / factor)),
    ]
}
