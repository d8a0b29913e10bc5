//! Inverse kinetics: tensions and strokes for given places of the arm.

mod boundary;
mod conditions;
mod effort;
mod folds;
mod follow;
mod lines;
mod problem;
pub mod reach;
mod search;
mod solutions;
mod strokes;
