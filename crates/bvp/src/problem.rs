//! What a boundary-value problem tells the solver.

/// Slopes and rates at one station, with their gradients in the state.
#[derive(Debug, Clone, Copy)]
pub struct Local<const N: usize, const Q: usize> {
    /// `z'` there.
    pub slope: [f64; N],
    /// `jacobian[a][b]` = d slope_a / d z_b.
    pub jacobian: [[f64; N]; N],
    /// Slopes of the quantities that the state does not depend on (a centreline, say): the solver
    /// integrates them and measures its error in them.
    pub rate: [f64; Q],
    /// `rate_gradient[q][b]` = d rate_q / d z_b.
    pub rate_gradient: [[f64; N]; Q],
}

impl<const N: usize, const Q: usize> Default for Local<N, Q> {
    fn default() -> Self {
        Self { slope: [0.0; N], jacobian: [[0.0; N]; N], rate: [0.0; Q], rate_gradient: [[0.0; N]; Q] }
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
/// The solver calls [`Problem::slopes`] for all stations at once, in order of `s`, `M` an element,
/// so that an implementation can keep memory a station (a warm start of a local law, say) and work
/// on several stations in one vector.
pub trait Problem<const N: usize, const Q: usize> {
    /// Why slopes cannot be had at a state.
    type Failure;

    /// Slopes and gradients at every station, `z` and `out` in the stations' order.
    ///
    /// # Errors
    /// When the state has no slopes: the solver then takes a shorter step.
    fn slopes(&mut self, z: &[[f64; N]], out: &mut [Local<N, Q>]) -> Result<(), Self::Failure>;

    /// Slopes differentiated by the continuation parameter, at the state of the last call of
    /// [`Problem::slopes`].
    fn drift(&mut self, out: &mut [[f64; N]]);

    /// How many conditions hold at s = 0; the other `N` less that number hold at s = 1.
    fn left_count(&self) -> usize;

    /// The conditions at s = 0 (the first [`Problem::left_count`] of `out`).
    fn left(&self, z: &[f64; N], out: &mut [Condition<N>; N]);

    /// The conditions at s = 1 (the first `N` - [`Problem::left_count`] of `out`).
    fn right(&self, z: &[f64; N], out: &mut [Condition<N>; N]);
}
