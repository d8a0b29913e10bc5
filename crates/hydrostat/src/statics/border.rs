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

/// One linearisation.
#[derive(Debug, Clone, Default)]
pub(crate) struct NewtonStep<C> {
    /// What is left to correct at the commanded strokes.
    pub(crate) rest: C,
    /// Change a unit of the parameter.
    pub(crate) response: C,
    /// Of the tensions (in the unit of force), one a commanded cable: by the rest, and by the parameter.
    pub(crate) tension: [Vec<f64>; 2],
    /// Strokes less commands: those after the rest, and by the parameter.
    pub(crate) slack: [Vec<f64>; 2],
    /// By how much the strokes of taut cables are off.
    pub(crate) off: f64,
}

impl<const N: usize, const S: usize, const Q: usize, const L: usize> NewtonStep<Correction<N, S, Q, L>> {
    /// Nothing held.
    pub(crate) fn let_go(&mut self) {
        (self.tension, self.slack, self.off) = Default::default();
    }

    /// Holds the strokes in both corrections, which are at fixed tensions: given what unit tensions do, and of each
    /// commanded cable by how much its stroke is off now, how that follows a change of the solution, and the change of
    /// the command a unit of the parameter. The determinant of B; `None` where no tensions hold the strokes.
    pub(crate) fn hold(
        &mut self,
        stroke_control: &StrokeControl,
        pulled: &[UnitPull<N, S, Q, L>],
        off: impl Fn(usize) -> f64,
        change: impl Fn(usize, &Correction<N, S, Q, L>) -> f64,
        command: impl Fn(usize) -> f64,
    ) -> Option<Determinant> {
        let mut slack: [Vec<f64>; 2] = std::array::from_fn(|_| Vec::with_capacity(stroke_control.cables.len()));
        self.off = 0.0;
        for (index, cable) in stroke_control.cables.iter().enumerate() {
            let off = off(index);
            if stroke_control.taut[index] {
                self.off = self.off.max(off.abs());
            }
            slack[0].push(off + change(*cable, &self.rest));
            slack[1].push(change(*cable, &self.response) - command(index));
        }
        let (tensions, determinant) = meeting(stroke_control, pulled, [&slack[0], &slack[1]])?;
        for (which, shape) in [&mut self.rest, &mut self.response].into_iter().enumerate() {
            let changes = tensions.iter().map(|both| both[which]);
            self.tension[which] = add_pulls(stroke_control, pulled, changes, shape, &mut slack[which]);
        }
        self.slack = slack;
        Some(determinant)
    }
}

/// Changes of the tensions of taut cables that take two lists of slacks away (one a commanded cable, over L), with the
/// determinant of B; `None` where no tensions do.
pub(crate) fn meeting<const N: usize, const S: usize, const Q: usize, const L: usize>(
    stroke_control: &StrokeControl,
    pulled: &[UnitPull<N, S, Q, L>],
    slack: [&[f64]; 2],
) -> Option<(Vec<[f64; 2]>, Determinant)> {
    let row =
        |index: usize| (pulled.iter().map(|by| by.strokes[index]).collect(), [-slack[0][index], -slack[1][index]]);
    solved(stroke_control.taut_cables().into_iter().map(row).collect())
}

/// The determinant of B.
pub(crate) fn border<const N: usize, const S: usize, const Q: usize, const L: usize>(
    stroke_control: &StrokeControl,
    pulled: &[UnitPull<N, S, Q, L>],
) -> Option<Determinant> {
    let none = vec![0.0; stroke_control.cables.len()];
    meeting(stroke_control, pulled, [&none, &none]).map(|(_, determinant)| determinant)
}

/// Adds what `changes` of the taut tensions do to a correction and to the slacks; the changes, one a commanded cable.
pub(crate) fn add_pulls<const N: usize, const S: usize, const Q: usize, const L: usize>(
    stroke_control: &StrokeControl,
    pulled: &[UnitPull<N, S, Q, L>],
    changes: impl Iterator<Item = f64>,
    correction: &mut Correction<N, S, Q, L>,
    slack: &mut [f64],
) -> Vec<f64> {
    let mut out = vec![0.0; stroke_control.cables.len()];
    for ((index, pulled), change) in stroke_control.taut_cables().into_iter().zip(pulled).zip(changes) {
        correction.add(&pulled.response, change);
        out[index] = change;
        for (slack, by) in slack.iter_mut().zip(&pulled.strokes) {
            *slack += change * by;
        }
    }
    out
}
