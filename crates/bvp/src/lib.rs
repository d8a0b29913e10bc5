//! Two-point boundary-value problems.
mod block;
pub mod collocation;
pub mod gauss;
pub mod mesh;
pub mod problem;
pub mod step;
pub use collocation::{Collocation, Correction, Determinant, RoundError, Singular, Solution};
pub use gauss::Gauss;
pub use mesh::{Limits, Mesh};
pub use problem::{Condition, Local, Problem};
pub use step::step;
