//! Two-point boundary-value problems: Gauss collocation on [0, 1].
//!
//! A [`Problem`] is a first-order system `z' = f(s, z, y, w')` of `N` equations with separated end conditions. `L` inner unknowns y are
//! settled by algebraic equations at every place, and at most one closure variable w(y) enters with its slope
//! (a differential-algebraic system of index one). Plain systems have neither: see [`Pointwise`]. `Q` quadratures are
//! integrals that no right side depends on. [`Collocation`] linearises a problem about a [`Solution`] with `M` Gauss stages per element
//! (order `2M` at the nodes), eliminates stages, inner unknowns and the closure element by element (static condensation), four elements side by
//! side, and factorises what is left between nodes by Gaussian elimination with row pivoting, which stays stable where
//! growing and decaying solutions mix and shooting overflows. `N`, `M`, `Q` and `L` are constants of the types; nothing is
//! allocated once the mesh has its size, and the crate has no dependencies.
//!
//! What a program builds from the parts:
//!
//! - **Newton's method**: [`Collocation::linearise`], [`Collocation::newton`], [`Solution::add`], with whatever damping the problem wants;
//! - **a path in a parameter**: [`Collocation::response`] to the derivative of the equations by the parameter is the tangent;
//!   [`Collocation::determinant`] changes sign where two solutions meet or cross, and says how well its sign is known;
//! - **derivatives**: responses to many changes of the equations, or the [`Collocation::adjoint`] of few functionals;
//! - **an error estimate**: the solution sampled with one more stage ([`Solution::resample`]), and one Newton round there;
//!   [`Collocation::contributions`] says what each element adds;
//! - **a better mesh**: [`Mesh::redistributed`] from those contributions, [`Solution::remap`] to go there, [`Mesh::pin`] for nodes that
//!   must lie on breaks of the data or kinks of the solution;
//! - **values between the nodes**: [`Solution::state_in`].
//!
//! # Example
//!
//! A boundary layer: `e u'' = u`, `u(0) = 1`, `u(1) = 0`, with `e = 1e-4`, so that the layer at s = 0
//! is 0.01 long and the growing solution reaches e^100 at s = 1. The state is `(u, v)` with
//! `u' = v / d`, `v' = u / d`, `d = 0.01`; the quadrature is the area under `u`. The exact solution is
//! `u = sinh((1 - s) / d) / sinh(1 / d)`, its area `d tanh(1 / (2 d))`.
//!
//! ```
//! use hydrostat_bvp::{Collocation, Condition, Correction, Mesh, OnMesh, Pointwise, Slopes, Solution};
//!
//! struct Layer {
//!     thickness: f64,
//! }
//!
//! impl Pointwise<2, 1> for Layer {
//!     type Failure = std::convert::Infallible; // this one has slopes at every state
//!
//!     fn slopes(&self, _: f64, z: &[f64; 2]) -> Result<Slopes<2, 1>, Self::Failure> {
//!         let k = 1.0 / self.thickness;
//!         Ok(Slopes {
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
//!         out[0] = Condition { residual: z[0] - 1.0, gradient: [1.0, 0.0] };
//!     }
//!
//!     fn right(&self, z: &[f64; 2], out: &mut [Condition<2>; 2]) {
//!         out[0] = Condition { residual: z[0], gradient: [1.0, 0.0] };
//!     }
//! }
//!
//! let d = 0.01_f64;
//! let mut system = Collocation::<2, 4, 1>::new(); // 4 stages: order 8 at the nodes
//! let mut solution = Solution::constant(Mesh::uniform(200, &[]), [0.0, 0.0], []);
//! let problem = OnMesh::new(Layer { thickness: d }, &system.gauss, &solution.mesh);
//! let mut correction = Correction::default();
//!
//! for round in 0.. {
//!     system.linearise::<_, false>(&problem, &solution).unwrap();
//!     system.newton::<false>(&solution, &mut correction);
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
#![allow(clippy::range_plus_one, reason = "loops over inclusive ranges are not unrolled")]
mod block;
pub mod collocation;
mod condense;
pub mod correction;
mod determinant;
pub mod directions;
pub mod gauss;
pub mod groups;
pub mod mesh;
mod panels;
pub mod pointwise;
pub mod problem;
pub mod real;
pub mod solution;
pub use collocation::adjoint::{Cotangent, EndWeights, Functional, StageWeights};
pub use collocation::{Collocation, Forcing, LinearisationError, Singular};
pub use correction::Correction;
pub use determinant::Determinant;
pub use directions::{Directions, EndPlace, Side};
pub use gauss::Gauss;
pub use groups::Groups;
pub use mesh::{Limits, Mesh};
pub use pointwise::{OnMesh, Pointwise, Slopes};
pub use problem::{Condition, Inner, Local, Problem, StageForcing, Station};
pub use real::{LANES, Lanes, Real, each};
pub use solution::{End, InnerState, Resampling, Solution, Stage};
