//! The search for the parameters of some cases.

use crate::least_squares::{Minimum, Settings, minimise};
use crate::model::{Cases, Refusal};

/// Minimises the sum of squares of `model` from its starts; `say` hears of every round, and ends the search.
pub(crate) fn search(
    model: &mut Cases,
    settings: &Settings,
    say: impl FnMut(usize, f64) -> bool,
) -> Result<Minimum<Refusal>, Refusal> {
    let start: Vec<f64> = model.fitted.iter().map(|one| one.start).collect();
    let bounds: Vec<[f64; 2]> = model.fitted.iter().map(|one| one.bounds).collect();
    minimise(model, &start, &bounds, settings, say)
}
