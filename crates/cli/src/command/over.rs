//! `--over`: the arm at each of several values of one quantity, and what is said of those without an answer.

use hydrostat::Arm;
use hydrostat_files::Varied;

use super::{NoAnswer, slip};
use crate::args::Over;
use crate::request::WrongRequest;
use crate::say;

/// What is found at a value, or why there is nothing.
pub(super) type At<T> = (f64, Result<T, String>);

/// One of the values.
pub(super) struct Value {
    /// From 1.
    pub(super) number: usize,
    /// Of so many.
    pub(super) count: usize,
    /// `at flow.speed = 0.1 m/s`
    pub(super) at: String,
}

/// What `find` finds for the arm at each value; what the arm cannot be is an error.
pub(super) fn at_values<T>(
    arm: &Arm,
    Over { varied, count }: Over,
    mut find: impl FnMut(&Arm, &Value) -> anyhow::Result<Result<T, String>>,
) -> anyhow::Result<Vec<At<T>>> {
    slip::warn_of_range(arm, &varied);
    let mut out = Vec::new();
    for (index, value) in varied.values(count).into_iter().enumerate() {
        let at = format!("at {} = {}", varied.parameter, varied.with_unit(value));
        let mut there = arm.clone();
        varied.parameter.set(&mut there, value).map_err(|e| WrongRequest::Unfit("--over", e))?;
        if let Err(error) = there.check() {
            return Err(WrongRequest::Value(at, error).into());
        }
        out.push((value, find(&there, &Value { number: index + 1, count, at })?));
    }
    Ok(out)
}

/// Warns of the values at which nothing was found; that there is none with an equilibrium is an error.
pub(super) fn say_what_is_missing<T>(
    varied: &Varied,
    found: &[At<T>],
    has_equilibrium: impl Fn(&T) -> bool,
) -> anyhow::Result<()> {
    for (value, one) in found {
        if let Err(message) = one {
            say::warning(format_args!("at {}: {message}", varied.with_unit(*value)));
        }
    }
    if found.iter().any(|(_, one)| one.as_ref().is_ok_and(&has_equilibrium)) {
        return Ok(());
    }
    Err(NoAnswer(format!("no equilibrium was found at any value of {}", varied.parameter)).into())
}
