//! What a boundary-value problem tells the solver.
//!
//! The general problem is a system of `N` first-order equations for the state z with `L` inner unknowns y, which are
//! determined at every place by as many algebraic equations, and at most one closure variable w, a function of the inner
//! unknowns whose slope enters the equations (a differential-algebraic system of index one):
//!
//! ```text
//! z' = f(s, z, y, w')        0 = g(s, z, y, w')        w = w(y)        q' = r(s, z, y)
//! ```
//!
//! The quadratures q are integrals that no right side depends on. A plain system of differential equations has `L` = 0 and
//! no closure variable.

use crate::directions::EndPlace;
use crate::groups::Groups;
use crate::real::{Lanes, Real};

/// A place of a discrete solution, or the same place in four elements.
#[derive(Debug, Clone, Copy)]
pub struct Station<const N: usize, const L: usize, R = Lanes> {
    /// State.
    pub z: [R; N],
    /// Inner unknowns.
    pub inner: [R; L],
    /// Slope of the closure variable.
    pub closure_slope: R,
}

/// The inner equations at a station, linearised and solved for the inner unknowns:
/// `dy = change + gradient dz + by_closure dw'`, and for the closure variable alike.
#[derive(Debug, Clone, Copy)]
pub struct Inner<const N: usize, const L: usize, R = f64> {
    /// The Newton step of the inner unknowns at fixed state and closure slope.
    pub change: [R; L],
    /// d y / d z.
    pub gradient: [[R; N]; L],
    /// d y / d w'.
    pub by_closure: [R; L],
    /// The closure variable at the inner unknowns.
    pub value: R,
    /// Its change by `change`.
    pub value_change: R,
    /// d w / d z.
    pub value_gradient: [R; N],
    /// d w / d w': the length over which disturbances of w fade or grow.
    pub reach: R,
}

/// Slopes at a station with their derivatives, the inner unknowns eliminated: by state and closure slope.
#[derive(Debug, Clone, Copy)]
pub struct Local<const N: usize, const Q: usize, const L: usize, R = f64> {
    /// `z'`, with what the Newton step of the inner unknowns changes to first order.
    pub slope: [R; N],
    /// `jacobian[a][b]` = d slope_a / d z_b.
    pub jacobian: [[R; N]; N],
    /// d slope / d w'.
    pub by_closure: [R; N],
    /// Slopes of the quadratures, with the change by the inner unknowns.
    pub rate: [R; Q],
    /// `rate_gradient[q][b]` = d rate_q / d z_b.
    pub rate_gradient: [[R; N]; Q],
    /// d rate / d w'.
    pub rate_by_closure: [R; Q],
    /// The inner equations.
    pub inner: Inner<N, L, R>,
}

impl<const N: usize, const L: usize, R: Real> Default for Inner<N, L, R> {
    #[inline(always)]
    fn default() -> Self {
        let zero = R::of(0.0);
        Self {
            change: [zero; L],
            gradient: [[zero; N]; L],
            by_closure: [zero; L],
            value: zero,
            value_change: zero,
            value_gradient: [zero; N],
            reach: zero,
        }
    }
}

impl<const N: usize, const Q: usize, const L: usize, R: Real> Default for Local<N, Q, L, R> {
    #[inline(always)]
    fn default() -> Self {
        let zero = R::of(0.0);
        Self {
            slope: [zero; N],
            jacobian: [[zero; N]; N],
            by_closure: [zero; N],
            rate: [zero; Q],
            rate_gradient: [[zero; N]; Q],
            rate_by_closure: [zero; Q],
            inner: Inner::default(),
        }
    }
}

/// A change of the equations at a station at fixed state and closure slope, the inner unknowns eliminated: the derivative by a
/// parameter, or a load.
#[derive(Debug, Clone, Copy)]
pub struct StageForcing<const N: usize, const Q: usize, const L: usize, R = Lanes> {
    /// Of the slopes.
    pub slope: [R; N],
    /// Of the rates of the quadratures.
    pub rate: [R; Q],
    /// Of the inner unknowns.
    pub inner: [R; L],
    /// Of the closure variable.
    pub value: R,
}

impl<const N: usize, const Q: usize, const L: usize, R: Real> Default for StageForcing<N, Q, L, R> {
    #[inline(always)]
    fn default() -> Self {
        let zero = R::of(0.0);
        Self { slope: [zero; N], rate: [zero; Q], inner: [zero; L], value: zero }
    }
}

/// One scalar condition at an end: its residual and its gradient in the state there.
#[derive(Debug, Clone, Copy)]
pub struct Condition<const N: usize> {
    /// Zero when met.
    pub residual: f64,
    /// d residual / d z.
    pub gradient: [f64; N],
}

impl<const N: usize> Default for Condition<N> {
    fn default() -> Self {
        Self { residual: 0.0, gradient: [0.0; N] }
    }
}

/// A boundary-value problem on [0, 1] with separated end conditions; see the [module](self).
///
/// Evaluation is a function of the stations alone: the same stations give the same bits, whatever was evaluated before.
pub trait Problem<const N: usize, const Q: usize, const L: usize> {
    /// Why a station has no slopes.
    type Failure;

    /// Whether a closure variable enters the equations.
    fn is_closed(&self) -> bool {
        false
    }

    /// Slopes and derivatives at the stages of all elements, the same stage of four elements side by side as [`Groups`] says. Inner
    /// unknowns that are far from their equations may be brought nearer at fixed state and closure slope; all that is
    /// given out is then about those. With `FUSED` the caller is compiled for a processor with fused multiply-add ([`Real::plus`]).
    ///
    /// # Errors
    /// When a station has no slopes.
    fn stages<const FUSED: bool>(
        &self,
        groups: Groups,
        stations: &mut [Station<N, L>],
        out: &mut [Local<N, Q, L, Lanes>],
    ) -> Result<(), Self::Failure>;

    /// The inner equations at ends of elements, for problems with a closure variable: `places[b]` are the ends in the lanes of
    /// block `b`.
    ///
    /// # Errors
    /// When a station has no inner unknowns.
    fn ends<const FUSED: bool>(
        &self,
        places: &[EndPlace],
        stations: &mut [Station<N, L>],
        out: &mut [Inner<N, L, Lanes>],
    ) -> Result<(), Self::Failure> {
        let _ = (places, stations, out);
        Ok(())
    }

    /// How many conditions hold at s = 0; the other `N` less that number hold at s = 1.
    fn left_count(&self) -> usize;

    /// The conditions at s = 0 (the first [`Problem::left_count`] of `out`).
    fn left(&self, z: &[f64; N], out: &mut [Condition<N>; N]);

    /// The conditions at s = 1 (the first `N` - [`Problem::left_count`] of `out`).
    fn right(&self, z: &[f64; N], out: &mut [Condition<N>; N]);
}
