//! The border that commanded strokes put round a linearised system: what the tensions of taut cables do to a round.
//!
//! With A the linearised equations, t the tensions of the taut cables, and s their strokes,
//!
//! ```text
//! A dz + A_t dt = -residual            s_z dz + s_t dt = command - s
//! ```
//!
//! is solved by blocks: a response of the shape for every taut cable ([`UnitPull`]), then a small system for the
//! tensions. Its determinant is that of A times that of B = s_t - s_z A^-1 A_t, the strokes that unit tensions reel
//! in: positive in the unloaded arm.

use hydrostat_bvp::{Correction, Determinant};

use crate::numerics::elimination::solved;
use crate::statics::equations::StrokeControl;

/// What a unit of tension of a taut cable does at fixed tensions of all others.
#[derive(Debug)]
pub(crate) struct UnitPull<const N: usize, const S: usize, const Q: usize, const L: usize> {
    /// To the solution.
    pub(crate) response: Correction<N, S, Q, L>,
    /// To the strokes of all commanded cables, over L.
    pub(crate) strokes: Vec<f64>,
}

/// Changes of the tensions of taut cables that take two lists of slacks away (one a commanded cable, over L), with the
/// determinant of B; `None` where no tensions do.
pub(crate) fn meeting<const N: usize, const S: usize, const Q: usize, const L: usize>(
    held: &StrokeControl,
    pulled: &[UnitPull<N, S, Q, L>],
    slack: [&[f64]; 2],
) -> Option<(Vec<[f64; 2]>, Determinant)> {
    let row =
        |index: usize| (pulled.iter().map(|by| by.strokes[index]).collect(), [-slack[0][index], -slack[1][index]]);
    solved(held.taut_cables().into_iter().map(row).collect())
}

/// The determinant of B.
pub(crate) fn border<const N: usize, const S: usize, const Q: usize, const L: usize>(
    held: &StrokeControl,
    pulled: &[UnitPull<N, S, Q, L>],
) -> Option<Determinant> {
    let none = vec![0.0; held.cables.len()];
    meeting(held, pulled, [&none, &none]).map(|(_, determinant)| determinant)
}

/// Adds what `changes` of the taut tensions do to a correction and to the slacks; the changes, one a commanded cable.
pub(crate) fn add_pulls<const N: usize, const S: usize, const Q: usize, const L: usize>(
    held: &StrokeControl,
    pulled: &[UnitPull<N, S, Q, L>],
    changes: impl Iterator<Item = f64>,
    correction: &mut Correction<N, S, Q, L>,
    slack: &mut [f64],
) -> Vec<f64> {
    let mut out = vec![0.0; held.cables.len()];
    for ((index, pulled), change) in held.taut_cables().into_iter().zip(pulled).zip(changes) {
        correction.add(&pulled.response, change);
        out[index] = change;
        for (slack, by) in slack.iter_mut().zip(&pulled.strokes) {
            *slack += change * by;
        }
    }
    out
}
