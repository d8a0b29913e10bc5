//! Which parameters satisfy every statement that the source makes about its Fig. 1, and which statement fails where none do.
//!
//! A [`Set`] is what the source leaves open: geometry, cable offsets, C1 to C3 and the readings. [`judge`] holds the
//! [`Statement`]s against it. [`sample`] draws sets evenly, [`refine`] looks around the best of them, and `report` writes
//! what they say. `README.md` beside this crate has the answer.

pub mod report;
pub mod search;
pub mod set;
pub mod statements;
pub mod verification;

pub use search::{Drawn, Found, refine, sample};
pub use set::{COORDINATES, Set};
pub use statements::{Judged, Miss, Statement, judge};
