//! Inverse kinetics: tensions and strokes for given places of the arm.

mod boundary;
mod conditions;
mod effort;
mod folds;
mod follow;
mod in_plane;
mod in_space;
mod lines;
mod problem;
pub mod reach;
mod reaching;
mod search;
mod solutions;
mod strokes;
