//! Answers held against the equations of `docs/model.md` written out by other code.
//!
//! Nothing here calls the solver but to get its answers: of `hydrostat` the fields of `Arm` and of `Configuration` are read,
//! and `Configuration::at`. What is computed anew:
//!
//! - profiles (`curve`), the section law with cables and beta', the loads in every reading (`mechanics`);
//! - beta' as the slope of the polynomial through an answer's beta, the turns of cables and with them the capstan law's tensions, lengths,
//!   strokes and stretch of cables (`shape`);
//! - what an answer misses each equation by (`residuals`);
//! - how far its tip is from that of the equilibrium beside it: Newton's method on these equations from the answer, by
//!   collocation of order 16 on elements that end at every kink (`correction`). This is the error that `error_estimate` is held against;
//! - the same tip by shooting from the tip (`shooting`), and hanging cords by shooting in the logarithm of the tip's angle (`cords`).
//!
//! `HYDROSTAT_ARMS=100000 cargo test --profile ci -p hydrostat-validate --test independent -- --nocapture random_arms` takes more arms at
//! random, `HYDROSTAT_ARMS_FROM` the first seed, `HYDROSTAT_FINDINGS` a directory for the arms whose answers are wrong.

mod arms;
mod banded;
mod cords;
mod correction;
mod curve;
mod dice;
mod friction;
mod hanging_cords;
mod in_space;
mod judge;
mod march;
mod mechanics;
mod polynomials;
mod random_arms;
mod residuals;
mod sections;
mod sees;
mod shape;
mod shooting;
mod snaps;
mod streams;
