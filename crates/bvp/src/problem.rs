//! What a boundary-value problem tells the solver.

use crate::groups::Groups;
use crate::real::{LANES, Lanes, Real};

/// Slopes and rates at one station, or at one stage of four elements, with their gradients in the state.
#[derive(Debug, Clone, Copy)]
pub struct Local<const N: usize, const Q: usize, R = f64> {
    /// `z'` there.
    pub slope: [R; N],
    /// `jacobian[a][b]` = d slope_a / d z_b.
    pub jacobian: [[R; N]; N],
    /// Slopes of the quantities that the state does not depend on (a centreline, say): the solver
    /// integrates them and measures its error in them.
    pub rate: [R; Q],
    /// `rate_gradient[q][b]` = d rate_q / d z_b.
    pub rate_gradient: [[R; N]; Q],
}

impl<const N: usize, const Q: usize, R: Real> Default for Local<N, Q, R> {
    fn default() -> Self {
        let zero = R::of(0.0);
        Self { slope: [zero; N], jacobian: [[zero; N]; N], rate: [zero; Q], rate_gradient: [[zero; N]; Q] }
    }
}

impl<const N: usize, const Q: usize> Local<N, Q, Lanes> {
    /// That of one of the four elements.
    pub fn lane(&self, lane: usize) -> Local<N, Q> {
        let row = |row: [Lanes; N]| row.map(|v| v.0[lane]);
        Local {
            slope: row(self.slope),
            jacobian: self.jacobian.map(row),
            rate: self.rate.map(|v| v.0[lane]),
            rate_gradient: self.rate_gradient.map(row),
        }
    }

    /// Takes `of` for one of the four elements.
    pub fn set_lane(&mut self, lane: usize, of: &Local<N, Q>) {
        for a in 0..N {
            self.slope[a].0[lane] = of.slope[a];
            for b in 0..N {
                self.jacobian[a][b].0[lane] = of.jacobian[a][b];
            }
        }
        for q in 0..Q {
            self.rate[q].0[lane] = of.rate[q];
            for b in 0..N {
                self.rate_gradient[q][b].0[lane] = of.rate_gradient[q][b];
            }
        }
    }
}

/// One scalar condition at an end: its residual and its gradient in the state there.
#[derive(Debug, Clone, Copy)]
pub struct Condition<const N: usize> {
    /// Zero when met.
    pub residual: f64,
    /// d residual / d z.
    pub gradient: [f64; N],
    /// d residual / d parameter.
    pub drift: f64,
}

impl<const N: usize> Default for Condition<N> {
    fn default() -> Self {
        Self { residual: 0.0, gradient: [0.0; N], drift: 0.0 }
    }
}

/// A first-order system `z' = F(s, z)` of `N` equations on [0, 1] with separated end conditions and
/// `Q` quadratures `q' = g(s, z)`.
///
/// The solver calls [`Problem::slopes`] for all stations at once, the same stage of four elements side
/// by side as [`Groups`] says, so that an implementation can keep memory a station (a warm start of a
/// local law, say) and work on four stations as on one. One that works on one station at a time is
/// a [`Plain`] problem, which [`OneByOne`] makes a problem of this kind.
pub trait Problem<const N: usize, const Q: usize> {
    /// Why slopes cannot be had at a state.
    type Failure;

    /// Slopes and gradients at every station: `z` and `out` hold the blocks of `groups`. With `FUSED` the caller
    /// is compiled for a processor with fused multiply-add ([`Real::plus`]).
    ///
    /// # Errors
    /// When the state has no slopes: the solver then takes a shorter step.
    fn slopes<const FUSED: bool>(
        &mut self,
        groups: Groups,
        z: &[[Lanes; N]],
        out: &mut [Local<N, Q, Lanes>],
    ) -> Result<(), Self::Failure>;

    /// Slopes differentiated by the continuation parameter, at the state of the last call of
    /// [`Problem::slopes`] and in its order.
    fn drift(&mut self, out: &mut [[Lanes; N]]);

    /// How many conditions hold at s = 0; the other `N` less that number hold at s = 1.
    fn left_count(&self) -> usize;

    /// The conditions at s = 0 (the first [`Problem::left_count`] of `out`).
    fn left(&self, z: &[f64; N], out: &mut [Condition<N>; N]);

    /// The conditions at s = 1 (the first `N` - [`Problem::left_count`] of `out`).
    fn right(&self, z: &[f64; N], out: &mut [Condition<N>; N]);
}

/// A [`Problem`] that is evaluated station by station.
pub trait Plain<const N: usize, const Q: usize> {
    /// Why slopes cannot be had at a state.
    type Failure;

    /// Slopes and gradients at `station`, counted along the mesh, at the state `z`.
    ///
    /// # Errors
    /// When the state has no slopes: the solver then takes a shorter step.
    fn local(&mut self, station: usize, z: &[f64; N]) -> Result<Local<N, Q>, Self::Failure>;

    /// Slopes differentiated by the continuation parameter at `station`, where the last state was `z`.
    fn drift(&mut self, station: usize, z: &[f64; N]) -> [f64; N] {
        let _ = (station, z);
        [0.0; N]
    }

    /// See [`Problem::left_count`].
    fn left_count(&self) -> usize;

    /// See [`Problem::left`].
    fn left(&self, z: &[f64; N], out: &mut [Condition<N>; N]);

    /// See [`Problem::right`].
    fn right(&self, z: &[f64; N], out: &mut [Condition<N>; N]);
}

/// A [`Plain`] problem as a [`Problem`].
#[derive(Debug, Clone)]
pub struct OneByOne<P, const N: usize> {
    /// The problem.
    pub problem: P,
    groups: Groups,
    last: Vec<[Lanes; N]>,
}

impl<P, const N: usize> OneByOne<P, N> {
    /// Of `problem`.
    pub fn new(problem: P) -> Self {
        Self { problem, groups: Groups { elements: 0, stages: 1 }, last: Vec::new() }
    }
}

impl<P: Plain<N, Q>, const N: usize, const Q: usize> Problem<N, Q> for OneByOne<P, N> {
    type Failure = P::Failure;

    fn slopes<const FUSED: bool>(
        &mut self,
        groups: Groups,
        z: &[[Lanes; N]],
        out: &mut [Local<N, Q, Lanes>],
    ) -> Result<(), P::Failure> {
        self.groups = groups;
        self.last.clear();
        self.last.extend_from_slice(z);
        for (block, (z, out)) in z.iter().zip(out).enumerate() {
            for lane in 0..LANES {
                let local = self.problem.local(groups.station_in(block, lane), &z.map(|v| v.0[lane]))?;
                out.set_lane(lane, &local);
            }
        }
        Ok(())
    }

    fn drift(&mut self, out: &mut [[Lanes; N]]) {
        for (block, (z, out)) in self.last.iter().zip(out).enumerate() {
            for lane in 0..LANES {
                let station = self.groups.station_in(block, lane);
                let drift = self.problem.drift(station, &z.map(|v| v.0[lane]));
                for a in 0..N {
                    out[a].0[lane] = drift[a];
                }
            }
        }
    }

    fn left_count(&self) -> usize {
        self.problem.left_count()
    }

    fn left(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        self.problem.left(z, out);
    }

    fn right(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        self.problem.right(z, out);
    }
}
