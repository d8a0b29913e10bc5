//! Cross-validation by load case: what the others say of each.

use crate::error::Trial;
use crate::least_squares::Settings;
use crate::model::{Cases, residuals};
use crate::search::search;

/// A load case as the others predict it.
#[derive(Debug, Clone)]
pub struct LeftOut {
    /// Index of the load case.
    pub case: usize,
    /// Root of the mean square of its residuals in the fit of all cases, in standard deviations.
    pub within: f64,
    /// The same where the fit did not know it; the case that had no answer else, and why.
    pub predicted: Result<f64, Trial>,
    /// By how much each parameter differs without it, in its standard deviations in the fit of all cases; zero where it has none.
    pub shifts: Vec<f64>,
}

/// Fits without each load case, from the estimates `x` with the standard deviations `sds`; with those alone that were left out before `say`
/// ended it.
pub(crate) fn leave_out(
    model: &Cases,
    index: &[usize],
    (x, sds): (&[f64], &[f64]),
    settings: &Settings,
    mut say: impl FnMut(usize, usize) -> bool,
) -> Vec<LeftOut> {
    let mut from = model.clone();
    for (one, x) in from.fitted.iter_mut().zip(x) {
        one.start = *x;
    }
    let unknowns = model.unknowns();
    let count = model.observed.len();
    let mut out = Vec::with_capacity(count);
    for left in 0..count {
        let one = &model.observed[left];
        let size = |values: &[f64]| {
            let all: Vec<f64> = residuals(&one.case, values).map(|r| r * r).collect();
            (all.iter().sum::<f64>() / all.len() as f64).sqrt()
        };
        let within = size(&model.answers[left].values);
        let mut go_on = true;
        let found = search(&mut from.without(left), settings, |_, _| {
            go_on = say(left, count);
            go_on
        });
        if !go_on {
            break;
        }
        let mut shifts = vec![0.0; x.len()];
        let predicted = found.map_err(|refusal| refusal.why).and_then(|found| {
            for ((shift, (new, old)), sd) in shifts.iter_mut().zip(found.x.iter().zip(x)).zip(sds) {
                *shift = (new - old) / sd;
            }
            one.clone().answer(&unknowns, &found.x).map(|answer| size(&answer.values))
        });
        out.push(LeftOut { case: index[left], within, predicted, shifts });
    }
    out
}
