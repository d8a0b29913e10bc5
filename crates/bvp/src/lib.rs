//! Two-point boundary-value problems with error estimates: Gauss collocation with adaptive meshes.
//!
//! [`solve()`] takes a problem `z' = f(s, z, p)` on [a, b] with conditions at both ends, where parameters p may be unknown, a guess, and
//! options. It returns a [`Sol`]: a continuous function ([`Sol::eval`]) with an estimate of its error at every place
//! ([`Sol::error_at`]).
//!
//! # The method
//!
//! - **Gauss collocation** with four stages on each element: order 8 at the nodes (superconvergence), 5 between them.
//! - **Newton's method** with affine-invariant damping (Deuflhard 2004, NLEQ-ERR): see [`newton`].
//! - **Static condensation**: the stages of each element are eliminated from its equations, which leaves the states at the nodes.
//! - **Almost block diagonal elimination with row pivoting**, node by node from a. The rows carried on are the
//!   combinations of states that the conditions at a still determine: a transfer of boundary conditions. It is stable if the problem has a
//!   dichotomy: if conditions at a fix the solutions that grow away from b, and conditions at b those that grow away from a. Row pivoting then
//!   keeps the carried rows independent, however fast solutions grow (Ascher, Mattheij and Russell, "Numerical Solution of Boundary Value
//!   Problems for Ordinary Differential Equations", 1995, chapters 6 and 7). Shooting overflows there. Where the problem has no such
//!   dichotomy, the problem itself is ill conditioned: small changes of the data change the solution strongly, and no elimination helps. The symptoms
//!   are a small [`Determinant::clearance`], a Newton method that stalls, or [`Error::Singular`].
//! - **An error estimate** from one more stage: the solution is sampled with five stages, and one Newton iteration there (two where the
//!   first was large) gives a solution that is more accurate by an order between nodes and by two at them. The difference is the estimate. It is
//!   exact to leading order, but not a bound.
//! - **Mesh adaptation** by the norm of all unknowns, of one of them, or by a goal functional ([`Norm`]); by the goal with adjoints (dual
//!   weighted residuals).
//!
//! Conditions are separated: each holds at one end. A condition that couples both ends becomes separated by one more parameter, see
//! [`bvp`]. Derivatives are exact by dual numbers ([`Differentiable`]), or by central differences or analytic ([`Bvp`]). The crate has no
//! dependencies.
//!
//! # Bratu's problem and its fold
//!
//! `u'' + lambda e^u = 0`, `u(0) = u(1) = 0` has two solutions below `lambda* = 3.513830719...`, and none above. At the fold the
//! linearised problem has a null vector w. Both together, with `w'(0) = 1`, determine lambda as an unknown parameter (Moore and Spence 1980).
//!
//! ```
//! use hydrostat_bvp::{Differentiable, Guess, Options, Scalar, solve};
//!
//! struct Fold;
//!
//! impl Differentiable<5> for Fold {
//!     const PARAMETERS: usize = 1; // the last of the five unknowns u, u', w, w', lambda
//!     const LEFT: usize = 3; // conditions at s = 0; the other two hold at s = 1
//!
//!     fn slope<R: Scalar>(&self, _: f64, z: &[R], p: &[R], out: &mut [R]) {
//!         let by_u = p[0] * z[0].exp();
//!         (out[0], out[1]) = (z[1], -by_u);
//!         (out[2], out[3]) = (z[3], -by_u * z[2]);
//!     }
//!     fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
//!         (out[0], out[1], out[2]) = (z[0], z[2], z[3] - 1.0);
//!     }
//!     fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
//!         (out[0], out[1]) = (z[0], z[2]);
//!     }
//! }
//!
//! let bump = |s: f64| [4.5 * s * (1.0 - s), 4.5 * (1.0 - 2.0 * s), s * (1.0 - s), 1.0 - 2.0 * s, 3.0];
//! let fold = solve(&Fold, &Guess::function(bump), &Options::with_tolerance(1e-10)).unwrap();
//! assert!((fold.parameters()[0] - 3.513_830_719_125_2).abs() < 1e-10);
//! ```
//!
//! # Troesch's problem
//!
//! `u'' = mu sinh(mu u)`, `u(0) = 0`, `u(1) = 1`: the solution rises in a boundary layer, and shooting from s = 0 meets a pole.
//! For `mu = 5` the published slope is `u'(0) = 4.5750461e-2`.
//!
//! ```
//! use hydrostat_bvp::{Differentiable, Guess, Options, Scalar, solve};
//!
//! struct Troesch(f64);
//!
//! impl Differentiable<2> for Troesch {
//!     const LEFT: usize = 1;
//!
//!     fn slope<R: Scalar>(&self, _: f64, z: &[R], _: &[R], out: &mut [R]) {
//!         (out[0], out[1]) = (z[1], (z[0] * self.0).sinh() * self.0);
//!     }
//!     fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
//!         out[0] = z[0];
//!     }
//!     fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
//!         out[0] = z[0] - 1.0;
//!     }
//! }
//!
//! let sol = solve(&Troesch(5.0), &Guess::function(|s| [s, 1.0]), &Options::with_tolerance(1e-9)).unwrap();
//! assert!((sol.eval(0.0)[1] - 4.575_046_1e-2).abs() < 1e-8);
//! ```
//!
//! # A shock layer
//!
//! `e u'' + s u' = -e pi^2 cos(pi s) - pi s sin(pi s)`, `u(-1) = -2`, `u(1) = 0` (Ascher, Mattheij and Russell, example 9.2), with
//! `e = 1e-6`: a layer at s = 0 that is 0.001 wide. This example gives analytic derivatives.
//! The exact solution is `cos(pi s) + erf(s / sqrt(2 e)) / erf(1 / sqrt(2 e))`.
//!
//! ```
//! use hydrostat_bvp::{Bvp, Guess, Options, solve};
//! use std::f64::consts::PI;
//!
//! struct Shock(f64);
//!
//! impl Bvp<2> for Shock {
//!     const LEFT: usize = 1;
//!
//!     fn interval(&self) -> [f64; 2] {
//!         [-1.0, 1.0]
//!     }
//!     fn slope(&self, s: f64, z: &[f64], _: &[f64], out: &mut [f64]) {
//!         let source = -self.0 * PI * PI * (PI * s).cos() - PI * s * (PI * s).sin();
//!         (out[0], out[1]) = (z[1], (source - s * z[1]) / self.0);
//!     }
//!     fn slope_with_jacobian(&self, s: f64, z: &[f64], p: &[f64], out: &mut [f64], jacobian: &mut [[f64; 2]]) {
//!         self.slope(s, z, p, out);
//!         (jacobian[0], jacobian[1]) = ([0.0, 1.0], [0.0, -s / self.0]);
//!     }
//!     fn left(&self, z: &[f64], _: &[f64], out: &mut [f64]) {
//!         out[0] = z[0] + 2.0;
//!     }
//!     fn right(&self, z: &[f64], _: &[f64], out: &mut [f64]) {
//!         out[0] = z[0];
//!     }
//! }
//!
//! let sol = solve(&Shock(1e-6), &Guess::constant([-1.0, 0.0]), &Options::with_tolerance(1e-8)).unwrap();
//! assert!((sol.eval(0.0)[0] - 1.0).abs() < 1e-7);
//! assert!((sol.eval(0.001)[0] - (0.001 * PI).cos() - 0.682_689_492_137_086).abs() < 1e-7); // erf(1 / sqrt 2)
//! ```
//!
//! # A characteristic value of Mathieu's equation
//!
//! `u'' + (a - 2 q cos 2 s) u = 0` with `u'(0) = u'(pi) = 0`: an eigenvalue problem, normalised by `u(0) = 1`. For `q = 5` the
//! tabulated even characteristic values are -5.80004602, 7.44910974, 17.09658168 (Digital Library of Mathematical Functions, table 28.6.1).
//!
//! ```
//! use hydrostat_bvp::{Differentiable, Guess, Options, Scalar, solve};
//! use std::f64::consts::PI;
//!
//! struct Mathieu(f64);
//!
//! impl Differentiable<3> for Mathieu {
//!     const PARAMETERS: usize = 1;
//!     const LEFT: usize = 2;
//!
//!     fn interval(&self) -> [f64; 2] {
//!         [0.0, PI]
//!     }
//!     fn slope<R: Scalar>(&self, s: f64, z: &[R], p: &[R], out: &mut [R]) {
//!         (out[0], out[1]) = (z[1], -(p[0] - 2.0 * self.0 * (2.0 * s).cos()) * z[0]);
//!     }
//!     fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
//!         (out[0], out[1]) = (z[0] - 1.0, z[1]);
//!     }
//!     fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
//!         out[0] = z[1];
//!     }
//! }
//!
//! let guess = Guess::function(|s: f64| [(4.0 * s).cos(), -4.0 * (4.0 * s).sin(), 16.0]);
//! let sol = solve(&Mathieu(5.0), &guess, &Options::with_tolerance(1e-9)).unwrap();
//! assert!((sol.parameters()[0] - 17.096_581_68).abs() < 2e-8);
//! ```
//!
//! # An elastica
//!
//! A column, clamped at s = 0, whose tip a thrust turns by a given angle: the thrust is unknown. With `k = sin(angle / 2)` it is `K(k)^2`
//! times the bending stiffness over the square of the length, and the tip is at `x = 2 E(k) / K(k) - 1`, `y = 2 k / K(k)`.
//!
//! ```
//! use hydrostat_bvp::{Differentiable, Guess, Options, Scalar, solve};
//! use std::f64::consts::{FRAC_PI_2, PI};
//!
//! struct Elastica(f64);
//!
//! impl Differentiable<5> for Elastica {
//!     const PARAMETERS: usize = 1; // angle, curvature, x, y, thrust
//!     const LEFT: usize = 3;
//!
//!     fn slope<R: Scalar>(&self, _: f64, z: &[R], p: &[R], out: &mut [R]) {
//!         (out[0], out[1]) = (z[1], -p[0] * z[0].sin());
//!         (out[2], out[3]) = (z[0].cos(), z[0].sin());
//!     }
//!     fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
//!         (out[0], out[1], out[2]) = (z[0], z[2], z[3]);
//!     }
//!     fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
//!         (out[0], out[1]) = (z[0] - self.0, z[1]);
//!     }
//! }
//!
//! let angle = PI / 2.0;
//! let guess = Guess::function(|s| {
//!     let x = FRAC_PI_2 * s;
//!     [angle * x.sin(), angle * FRAC_PI_2 * x.cos(), s, 0.0, FRAC_PI_2 * FRAC_PI_2]
//! });
//! let sol = solve(&Elastica(angle), &guess, &Options::with_tolerance(1e-10)).unwrap();
//! let (first, second) = (1.854_074_677_301_372_f64, 1.350_643_881_047_675_5); // K and E of the modulus 1 / sqrt 2
//! let [_, _, x, y, thrust] = sol.eval(1.0);
//! assert!((thrust - first * first).abs() < 1e-9);
//! assert!((x - (2.0 * second / first - 1.0)).abs() < 1e-9 && (y - 2.0_f64.sqrt() / first).abs() < 1e-9);
//! ```
//!
//! # Beneath the driver
//!
//! The driver is made of parts that a program may use by itself, for problems with more structure: inner unknowns y that
//! algebraic equations determine at every place, and one closure variable w(y) that enters with its slope (a differential-algebraic system
//! of index one); equations that are evaluated for four elements side by side ([`Lanes`]), and with fused multiply-add
//! (`FUSED`, [`Real::plus`]), in code that is compiled for more than one kind of processor. On [0, 1], a [`Problem`] is all of these, a
//! [`Pointwise`] one none. `N` states, `M` stages an element, `Q` quadratures and `L` inner unknowns are constants of the types; nothing is
//! allocated once the mesh has its size.
//!
//! - **Newton's method**: [`Collocation::linearise`], [`Collocation::newton`], [`Solution::add`], with [`newton::Damping`] or another;
//! - **derivatives**: responses to many changes of the equations ([`Collocation::response`]), or the [`Collocation::adjoint`] of a few functionals;
//! - **a path in a parameter**: the response to the derivative of the equations by the parameter is the tangent; [`Collocation::determinant`]
//!   changes sign where two solutions meet or cross, and says how well its sign is known;
//! - **an error estimate**: the solution sampled with one more stage ([`Solution::resample`]), and one Newton iteration there;
//!   [`Collocation::contributions`] says what each element adds;
//! - **a better mesh**: [`Mesh::redistributed`] from those contributions, [`Solution::remap`] to go there, [`Mesh::pin`] for nodes that
//!   must lie on breaks of the data or kinks of the solution;
//! - **values between the nodes**: [`Solution::state_in`].
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
mod adapt;
mod block;
pub mod bvp;
pub mod collocation;
mod condense;
pub mod continuation;
pub mod correction;
pub mod derivatives;
mod determinant;
pub mod directions;
pub mod gauss;
pub mod groups;
pub mod mesh;
pub mod newton;
mod options;
mod panels;
pub mod pointwise;
pub mod problem;
pub mod real;
pub mod scalar;
mod sol;
pub mod solution;
pub mod solve;
pub use bvp::{Bvp, Differentiable};
pub use collocation::adjoint::{Cotangent, EndWeights, Functional, StageWeights};
pub use collocation::{Collocation, Forcing, LinearisationError, Singular};
pub use continuation::{Continuation, Event, Path, PathEnd, PathOptions, PathPoint, Watch};
pub use correction::Correction;
pub use derivatives::{Along, Derivatives};
pub use determinant::Determinant;
pub use directions::{Directions, EndPlace, Side};
pub use gauss::Gauss;
pub use groups::Groups;
pub use mesh::{Limits, Mesh};
pub use options::{Norm, Options};
pub use pointwise::{OnMesh, Pointwise, Slopes};
pub use problem::{Condition, Inner, Local, Problem, StageForcing, Station};
pub use real::{LANES, Lanes, Real, each};
pub use scalar::{Dual, Scalar};
pub use sol::{Sol, SolveStatistics};
pub use solution::{End, InnerState, Resampling, Solution, Stage};
pub use solve::{Error, Guess, solve};
