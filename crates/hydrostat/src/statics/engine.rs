//! Newton rounds, meshes and estimates on one arm's equations.

mod budget;
mod carry_over;
mod discrete;
mod kinks;
mod loaded;
mod loads;
#[cfg(test)]
pub(crate) mod manufactured;
mod newton;
mod outputs;
mod settle;
mod start;
mod stroke_control;
mod traced;
mod trouble;
mod watch;
mod wrap_angles;

pub(crate) use self::budget::WORK;
pub(crate) use self::carry_over::led_on;
pub(crate) use self::discrete::{Engine, response_change, shift_by_tangential_load};
pub(crate) use self::kinks::{at_jumps, end_beside, zero_beside};
pub(crate) use self::outputs::{asked_in, sharpened};
pub(crate) use self::start::{turn_sections, wanted_side};
pub(crate) use self::stroke_control::pull_taut;
pub(crate) use self::trouble::{HOP, Trouble, roughly};
pub(crate) use super::dimensions::{Guess, M};
pub(crate) use crate::numerics::rounds::{correct, linearise, respond};
