//! Boundary-value problems as a stranger states them: `z' = f(s, z, p)` on [a, b], with conditions at both ends.
//!
//! States z and unknown parameters p together are the `N` unknowns: each parameter is a constant function, and counts as
//! an unknown with the equation `p' = 0`. There are as many scalar conditions as unknowns, [`Bvp::LEFT`] of them at a and the
//! others at b (separated conditions). A condition that couples both ends becomes separated by one more parameter: with
//! `p = z_k(a)` as a condition at a, the value `z_k(a)` is known at b as p (Ascher, Mattheij and Russell 1995, section 1.2).
//!
//! A problem is given by one of two traits. [`Differentiable`] asks for functions that are written for any [`Scalar`]; derivatives are
//! then exact, by dual numbers. [`Bvp`] asks for functions of `f64`; derivatives are by central differences, or analytic where the
//! methods with derivatives are given, too. Every [`Differentiable`] problem is a [`Bvp`].

use crate::pointwise::{Pointwise, Slopes};
use crate::problem::Condition;
use crate::scalar::{Dual, Scalar};

/// A boundary-value problem with `N` unknowns, given by functions of `f64`; see the [module](self).
///
/// In every method `z` has the states, the first `N` - [`Bvp::PARAMETERS`] unknowns, and `p` the parameters, the rest of them. Derivatives
/// are by both, in this order.
pub trait Bvp<const N: usize> {
    /// How many of the unknowns are parameters.
    const PARAMETERS: usize = 0;
    /// How many conditions hold at a; the other `N` less that number hold at b.
    const LEFT: usize;

    /// The interval [a, b].
    fn interval(&self) -> [f64; 2] {
        [0.0, 1.0]
    }

    /// Places inside the interval, increasing, at which f is not smooth in s: they are nodes of every mesh.
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }

    /// The slopes `z'` = f(s, z, p) into `out`, one a state.
    fn slope(&self, s: f64, z: &[f64], p: &[f64], out: &mut [f64]);

    /// Residuals of the conditions at a into `out`: zero when met.
    fn left(&self, z: &[f64], p: &[f64], out: &mut [f64]);

    /// Residuals of the conditions at b into `out`.
    fn right(&self, z: &[f64], p: &[f64], out: &mut [f64]);

    /// The integrand of the goal, the functional `integral of goal(s, z, p) ds`, to which a mesh can be adapted
    /// ([`Norm::Goal`](crate::Norm::Goal)).
    fn goal(&self, _s: f64, _z: &[f64], _p: &[f64]) -> f64 {
        0.0
    }

    /// [`Bvp::slope`] with its derivatives: `jacobian[a][b]` of slope a by unknown b. By central differences unless given.
    fn slope_with_jacobian(&self, s: f64, z: &[f64], p: &[f64], out: &mut [f64], jacobian: &mut [[f64; N]]) {
        self.slope(s, z, p, out);
        differences(z, p, jacobian, |z, p, out| self.slope(s, z, p, out));
    }

    /// [`Bvp::left`] with its derivatives: `gradient[c][b]` of condition c by unknown b. By central differences unless given.
    fn left_with_gradient(&self, z: &[f64], p: &[f64], out: &mut [f64], gradient: &mut [[f64; N]]) {
        self.left(z, p, out);
        differences(z, p, gradient, |z, p, out| self.left(z, p, out));
    }

    /// [`Bvp::right`] with its derivatives: `gradient[c][b]` of condition c by unknown b. By central differences unless given.
    fn right_with_gradient(&self, z: &[f64], p: &[f64], out: &mut [f64], gradient: &mut [[f64; N]]) {
        self.right(z, p, out);
        differences(z, p, gradient, |z, p, out| self.right(z, p, out));
    }

    /// [`Bvp::goal`] with its derivatives by the unknowns. By central differences unless given.
    fn goal_with_gradient(&self, s: f64, z: &[f64], p: &[f64], gradient: &mut [f64; N]) -> f64 {
        let mut row = [*gradient];
        differences(z, p, &mut row, |z, p, out| out[0] = self.goal(s, z, p));
        *gradient = row[0];
        self.goal(s, z, p)
    }
}

/// A boundary-value problem with `N` unknowns whose functions are written for any [`Scalar`]; see the [module](self) and, for
/// what the methods say, [`Bvp`].
pub trait Differentiable<const N: usize> {
    /// See [`Bvp::PARAMETERS`].
    const PARAMETERS: usize = 0;
    /// See [`Bvp::LEFT`].
    const LEFT: usize;

    /// See [`Bvp::interval`].
    fn interval(&self) -> [f64; 2] {
        [0.0, 1.0]
    }

    /// See [`Bvp::breaks`].
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }

    /// See [`Bvp::slope`].
    fn slope<R: Scalar>(&self, s: f64, z: &[R], p: &[R], out: &mut [R]);

    /// See [`Bvp::left`].
    fn left<R: Scalar>(&self, z: &[R], p: &[R], out: &mut [R]);

    /// See [`Bvp::right`].
    fn right<R: Scalar>(&self, z: &[R], p: &[R], out: &mut [R]);

    /// See [`Bvp::goal`].
    fn goal<R: Scalar>(&self, _s: f64, _z: &[R], _p: &[R]) -> R {
        R::from(0.0)
    }
}

impl<E: Differentiable<N>, const N: usize> Bvp<N> for E {
    const PARAMETERS: usize = E::PARAMETERS;
    const LEFT: usize = E::LEFT;

    fn interval(&self) -> [f64; 2] {
        Differentiable::interval(self)
    }

    fn breaks(&self) -> Vec<f64> {
        Differentiable::breaks(self)
    }

    fn slope(&self, s: f64, z: &[f64], p: &[f64], out: &mut [f64]) {
        Differentiable::slope(self, s, z, p, out);
    }

    fn left(&self, z: &[f64], p: &[f64], out: &mut [f64]) {
        Differentiable::left(self, z, p, out);
    }

    fn right(&self, z: &[f64], p: &[f64], out: &mut [f64]) {
        Differentiable::right(self, z, p, out);
    }

    fn goal(&self, s: f64, z: &[f64], p: &[f64]) -> f64 {
        Differentiable::goal(self, s, z, p)
    }

    fn slope_with_jacobian(&self, s: f64, z: &[f64], p: &[f64], out: &mut [f64], jacobian: &mut [[f64; N]]) {
        by_duals(z, p, out, jacobian, |z, p, out| Differentiable::slope(self, s, z, p, out));
    }

    fn left_with_gradient(&self, z: &[f64], p: &[f64], out: &mut [f64], gradient: &mut [[f64; N]]) {
        by_duals(z, p, out, gradient, |z, p, out| Differentiable::left(self, z, p, out));
    }

    fn right_with_gradient(&self, z: &[f64], p: &[f64], out: &mut [f64], gradient: &mut [[f64; N]]) {
        by_duals(z, p, out, gradient, |z, p, out| Differentiable::right(self, z, p, out));
    }

    fn goal_with_gradient(&self, s: f64, z: &[f64], p: &[f64], gradient: &mut [f64; N]) -> f64 {
        let (mut value, mut row) = ([0.0], [*gradient]);
        by_duals(z, p, &mut value, &mut row, |z, p, out| out[0] = Differentiable::goal(self, s, z, p));
        *gradient = row[0];
        value[0]
    }
}

/// Values and derivatives of `function` by dual numbers.
#[inline(always)]
fn by_duals<const N: usize>(
    z: &[f64],
    p: &[f64],
    out: &mut [f64],
    derivatives: &mut [[f64; N]],
    function: impl FnOnce(&[Dual<N>], &[Dual<N>], &mut [Dual<N>]),
) {
    let mut unknowns = [Dual::<N>::from(0.0); N];
    for (k, v) in z.iter().chain(p).enumerate() {
        unknowns[k] = Dual::unknown(k, *v);
    }
    let mut values = [Dual::<N>::from(0.0); N];
    let (states, parameters) = unknowns.split_at(z.len());
    function(states, parameters, &mut values[..out.len()]);
    for ((out, row), value) in out.iter_mut().zip(derivatives).zip(&values) {
        *out = value.value;
        *row = value.derivative;
    }
}

/// Step of a central difference over the size of the unknown: the cube root of the machine's precision, at which what it leaves out is
/// as large as rounding.
const STEP: f64 = 6e-6;

/// Derivatives of `function` by central differences.
fn differences<const N: usize>(
    z: &[f64],
    p: &[f64],
    derivatives: &mut [[f64; N]],
    function: impl Fn(&[f64], &[f64], &mut [f64]),
) {
    let mut unknowns = [0.0; N];
    for (own, v) in unknowns.iter_mut().zip(z.iter().chain(p)) {
        *own = *v;
    }
    let rows = derivatives.len();
    let (mut low, mut high) = ([0.0; N], [0.0; N]);
    for b in 0..N {
        let kept = unknowns[b];
        let step = STEP * kept.abs().max(1.0);
        for (at, out) in [(kept - step, &mut low), (kept + step, &mut high)] {
            unknowns[b] = at;
            let (states, parameters) = unknowns.split_at(z.len());
            function(states, parameters, &mut out[..rows]);
        }
        unknowns[b] = kept;
        // What is represented, not what was meant.
        let width = (kept + step) - (kept - step);
        for (row, (low, high)) in derivatives.iter_mut().zip(low.iter().zip(&high)) {
            row[b] = (high - low) / width;
        }
    }
}

/// A place at which f, or one of its derivatives, is not a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NotFinite {
    /// The place.
    pub s: f64,
}

/// A problem of this kind on [0, 1], whatever it is: what works on it is compiled once for all.
pub(crate) type Unit<'a, const N: usize> = dyn Pointwise<N, 1, Failure = NotFinite> + 'a;

/// A [`Bvp`] on [0, 1], the goal as its quadrature.
#[derive(Debug)]
pub(crate) struct OnUnit<'a, P> {
    pub(crate) problem: &'a P,
    pub(crate) interval: [f64; 2],
}

impl<P: Bvp<N>, const N: usize> Pointwise<N, 1> for OnUnit<'_, P> {
    type Failure = NotFinite;

    fn slopes(&self, t: f64, unknowns: &[f64; N]) -> Result<Slopes<N, 1>, NotFinite> {
        let states = N - P::PARAMETERS;
        let [a, b] = self.interval;
        let (s, length) = (a + (b - a) * t, b - a);
        let (z, p) = unknowns.split_at(states);
        let mut out = Slopes { slope: [0.0; N], jacobian: [[0.0; N]; N], rate: [0.0; 1], rate_gradient: [[0.0; N]; 1] };
        self.problem.slope_with_jacobian(s, z, p, &mut out.slope[..states], &mut out.jacobian[..states]);
        out.rate[0] = self.problem.goal_with_gradient(s, z, p, &mut out.rate_gradient[0]);
        let mut sum = out.rate[0];
        let numbers = out.slope.iter_mut().chain(out.jacobian.as_flattened_mut()).chain(&mut out.rate_gradient[0]);
        for v in numbers {
            *v *= length;
            sum += *v;
        }
        out.rate[0] *= length;
        if sum.is_finite() { Ok(out) } else { Err(NotFinite { s }) }
    }

    fn left_count(&self) -> usize {
        P::LEFT
    }

    fn left(&self, unknowns: &[f64; N], out: &mut [Condition<N>; N]) {
        let (z, p) = unknowns.split_at(N - P::PARAMETERS);
        put(out, P::LEFT, |values, gradients| self.problem.left_with_gradient(z, p, values, gradients));
    }

    fn right(&self, unknowns: &[f64; N], out: &mut [Condition<N>; N]) {
        let (z, p) = unknowns.split_at(N - P::PARAMETERS);
        put(out, N - P::LEFT, |values, gradients| self.problem.right_with_gradient(z, p, values, gradients));
    }
}

fn put<const N: usize>(
    out: &mut [Condition<N>; N],
    count: usize,
    conditions: impl FnOnce(&mut [f64], &mut [[f64; N]]),
) {
    let (mut values, mut gradients) = ([0.0; N], [[0.0; N]; N]);
    conditions(&mut values[..count], &mut gradients[..count]);
    for ((out, residual), gradient) in out.iter_mut().zip(values).zip(gradients) {
        *out = Condition { residual, gradient };
    }
}
