//! Parameters of soft arms from measured shapes, forces and strokes.
//!
//! Load cases are arms under known loads with what was measured of them ([`Case`]); [`fit`] finds the parameters ([`Fitted`]) that make
//! all of them agree best, by least squares or a robust loss ([`Loss`]), within bounds and with what was known before ([`Prior`]). The
//! [`Fit`] has estimates with 95 % intervals, the combinations of parameters that the data know least ([`Fit::verdict`] says so in
//! words), every residual, and what each load case is predicted to be by the others.
//!
//! Derivatives are the exact ones of `hydrostat::Solver::sensitivities` and, of arms in space, of `hydrostat::SpatialSolver::sensitivities`; in
//! the plane every solve starts from the last. [`least_squares`] is the search
//! by itself, for any model.

mod certainty;
mod chi_square;
mod cross_validation;
mod data;
mod error;
mod fit;
pub mod least_squares;
mod loss;
mod misses;
mod model;
mod predict;
mod quantity;
mod search;
mod shape;
mod student;
mod unknown;
mod verdict;

pub use certainty::Direction;
pub use cross_validation::LeftOut;
pub use data::{Case, Fitted, Measurement, Prior, natural_bounds};
pub use error::{IdentifyError, Trial};
pub use fit::{Estimate, Fit, FitOptions, NoAnswer, Progress, Residual, fit};
pub use loss::Loss;
pub use misses::{Miss, misses};
pub use predict::{Prediction, predict};
pub use quantity::{Marker, Quantity};
pub use shape::{Shape, value_in_space, value_of};
pub use unknown::Unknown;
pub use verdict::{Finding, Scale};
