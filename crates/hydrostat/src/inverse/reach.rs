//! Inverse kinetics: the tensions that bring tip, or other places, to targets.
//!
//! The distances to the targets, over L, are made small by Newton's method on the tensions, with the exact jacobian
//! (`sensitivity`) on warm solves. A round asks for the least effort |T|^2 among the tensions within their bounds
//! that meet the targets to first order (`inverse/effort`); where there are none, or they lead no nearer, it takes a
//! damped least-squares step within the bounds. Strokes have theirs, too (`inverse/strokes`). Several starts find
//! several answers, and, of as many cables as conditions, lines through the target (`inverse/lines`) the others, across
//! folds of the map from tensions to places.

pub use super::boundary::{Boundary, BoundaryKind, BoundaryOptions, BoundaryPiece, BoundaryPoint, BoundaryProgress};
pub use super::follow::{Followed, Follower, SpatialFollower};
pub use super::in_space::SpatialTarget;
pub use super::problem::{Bound, Reach, ReachError, ReachOptions, Reached, Target};
