//! The differential equations and end conditions that the solver gets (`docs/model.md`, section 7).
//!
//! Unknown along the arm are z = (theta, n_f, m_f), the section rotation and the part of the contact
//! force and moment that balances everything but the cables:
//!
//! ```text
//! theta' = mu
//! n_f'   = -f
//! m_f'   = -(r' x n_f) . k - couple          r' = nu a + eta b (2)
//! ```
//!
//! and at every s the section law gives (nu, eta, mu), see [`crate::rod::section`]. The centreline r is a
//! quadrature. Lengths are in units of L, forces in a unit of [`Units`].

mod buckling;
mod cable_paths;
mod change;
mod commanded;
mod ends;
mod friction;
pub(crate) mod gradients;
mod limits;
mod margins;
pub(crate) mod place;
mod places;
mod range;
mod section_state;
mod stroke_control;
mod system;
mod varied;
mod way;

pub(crate) use self::buckling::Unloaded;
pub(crate) use self::cable_paths::StationData;
pub(crate) use self::limits::{Margins, SectionFailure};
pub(crate) use self::places::section_data;
pub(crate) use self::range::{Change, Varied};
pub(crate) use self::section_state::{SectionQuery, SectionState};
pub(crate) use self::stroke_control::StrokeControl;
pub(crate) use self::system::{Equations, failure, inner};
pub(crate) use self::way::{PLACES, Way};
pub(crate) use super::dimensions::{L, N, Q};
