//! Two-point boundary-value problems: Gauss collocation on [0, 1].
//!
//! A [`Problem`] is a first-order system `z' = F(s, z)` of `N` equations with separated end
//! conditions and `Q` quadratures `q' = g(s, z)`, integrals that the state does not depend on.
//! [`Collocation`] linearises it about a [`Solution`] with `M` Gauss stages an element (order `2M`
//! at the nodes), eliminates the stages element by element, four elements side by side, and carries the conditions at s = 1
//! towards s = 0 as rows, which stays stable where growing and decaying solutions mix and shooting
//! overflows. `N`, `M` and `Q` are constants of the types; nothing is allocated once the mesh has
//! its size, and the crate has no dependencies.
//!
//! What a program builds from the parts:
//!
//! - **Newton's method**: [`Collocation::linearise`], [`Collocation::solve`] for column 0,
//!   [`Solution::add`], with whatever damping the problem wants;
//! - **a path in a parameter**: linearise with the parameter, and column 1 is the tangent;
//!   [`Collocation::determinant`] changes sign where two solutions meet or cross;
//! - **an error estimate**: carry the solution to one more stage ([`Solution::resample`]), and
//!   one Newton round there says what the totals would move; [`Collocation::contributions`] says
//!   by which elements;
//! - **loads that come after the linearisation**, many at once: what they do to the stages ([`Collocation::eliminate`]), to the
//!   rows of the conditions at s = 1 ([`Collocation::rows`]) and to the state at s = 0 ([`Collocation::start`]);
//! - **a better mesh**: [`Mesh::redistributed`] from those contributions, [`Solution::onto`] to go
//!   there, [`Mesh::pin`] for nodes that must lie on breaks of the data or kinks of the solution;
//! - **values between the nodes**: [`Solution::state_in`], or [`step()`] to the order of the nodes.
//!
//! # Example
//!
//! A boundary layer: `e u'' = u`, `u(0) = 1`, `u(1) = 0`, with `e = 1e-4`, so that the layer at s = 0
//! is 0.01 long and the growing solution reaches e^100 at s = 1. The state is `(u, v)` with
//! `u' = v / d`, `v' = u / d`, `d = 0.01`; the quadrature is the area under `u`. The exact solution is
//! `u = sinh((1 - s) / d) / sinh(1 / d)`, its area `d tanh(1 / (2 d))`.
//!
//! ```
//! use hydrostat_bvp::{Collocation, Condition, Correction, Local, Mesh, OneByOne, Plain, Solution};
//!
//! struct Layer {
//!     thickness: f64,
//! }
//!
//! impl Plain<2, 1> for Layer {
//!     type Failure = std::convert::Infallible; // this one has slopes at every state
//!
//!     fn local(&mut self, _: usize, z: &[f64; 2]) -> Result<Local<2, 1>, Self::Failure> {
//!         let k = 1.0 / self.thickness;
//!         Ok(Local {
//!             slope: [k * z[1], k * z[0]],
//!             jacobian: [[0.0, k], [k, 0.0]],
//!             rate: [z[0]],
//!             rate_gradient: [[1.0, 0.0]],
//!         })
//!     }
//!
//!     fn left_count(&self) -> usize {
//!         1
//!     }
//!
//!     fn left(&self, z: &[f64; 2], out: &mut [Condition<2>; 2]) {
//!         out[0] = Condition { residual: z[0] - 1.0, gradient: [1.0, 0.0], drift: 0.0 };
//!     }
//!
//!     fn right(&self, z: &[f64; 2], out: &mut [Condition<2>; 2]) {
//!         out[0] = Condition { residual: z[0], gradient: [1.0, 0.0], drift: 0.0 };
//!     }
//! }
//!
//! let d = 0.01_f64;
//! let mut problem = OneByOne::new(Layer { thickness: d });
//! let mut system = Collocation::<2, 4, 1>::new(); // 4 stages: order 8 at the nodes
//! let mut solution = Solution::constant(Mesh::uniform(200, &[]), [0.0, 0.0]);
//! let mut correction = Correction::default();
//!
//! for round in 0.. {
//!     system.linearise(&mut problem, &solution, false).unwrap();
//!     system.solve(&solution, 0, &mut correction);
//!     solution.add(&correction, 1.0);
//!     if correction.largest(0) < 1e-12 {
//!         break;
//!     }
//!     assert!(round < 3, "a linear problem needs one round, and one to see that");
//! }
//!
//! for (s, z) in solution.mesh.nodes().iter().zip(&solution.nodes) {
//!     let exact = ((1.0 - s) / d).sinh() / (1.0 / d).sinh();
//!     assert!((z[0] - exact).abs() < 1e-9);
//! }
//! let area = system.totals()[0]; // at the state of the last linearisation
//! assert!((area - d * (0.5 / d).tanh()).abs() < 1e-11);
//! ```
mod block;
mod carry;
pub mod collocation;
mod condense;
pub mod gauss;
pub mod groups;
pub mod mesh;
pub mod problem;
pub mod real;
pub mod solution;
pub mod step;
pub use carry::{CarriedRows, Determinant};
pub use collocation::{Collocation, RoundError, Singular};
pub use gauss::{Gauss, Hermite};
pub use groups::Groups;
pub use mesh::{Limits, Mesh};
pub use problem::{Condition, Local, OneByOne, Plain, Problem};
pub use real::{LANES, Lanes, Real, each};
pub use solution::{Correction, Solution};
pub use step::step;
