//! Problems that are evaluated place by place.

use crate::gauss::Gauss;
use crate::groups::Groups;
use crate::mesh::Mesh;
use crate::problem::{Condition, Local, Problem, Station};
use crate::real::{LANES, Lanes};

/// Slopes and rates at one place, with their gradients in the state.
#[derive(Debug, Clone, Copy)]
pub struct Slopes<const N: usize, const Q: usize> {
    /// `z'` there.
    pub slope: [f64; N],
    /// `jacobian[a][b]` = d slope_a / d z_b.
    pub jacobian: [[f64; N]; N],
    /// Slopes of the quadratures.
    pub rate: [f64; Q],
    /// `rate_gradient[q][b]` = d rate_q / d z_b.
    pub rate_gradient: [[f64; N]; Q],
}

/// A first-order system `z' = f(s, z)` on [0, 1] with separated end conditions and `Q` quadratures `q' = r(s, z)`.
pub trait Pointwise<const N: usize, const Q: usize> {
    /// Why a state has no slopes.
    type Failure;

    /// Slopes and gradients at the place `s` in the state `z`.
    ///
    /// # Errors
    /// When the state has no slopes: the round ends with [`LinearisationError::Slopes`](crate::LinearisationError::Slopes), and whoever drives it may correct by less.
    fn slopes(&self, s: f64, z: &[f64; N]) -> Result<Slopes<N, Q>, Self::Failure>;

    /// See [`Problem::left_count`].
    fn left_count(&self) -> usize;

    /// See [`Problem::left`].
    fn left(&self, z: &[f64; N], out: &mut [Condition<N>; N]);

    /// See [`Problem::right`].
    fn right(&self, z: &[f64; N], out: &mut [Condition<N>; N]);
}

impl<P: Pointwise<N, Q> + ?Sized, const N: usize, const Q: usize> Pointwise<N, Q> for &P {
    type Failure = P::Failure;

    fn slopes(&self, s: f64, z: &[f64; N]) -> Result<Slopes<N, Q>, P::Failure> {
        (**self).slopes(s, z)
    }

    fn left_count(&self) -> usize {
        (**self).left_count()
    }

    fn left(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        (**self).left(z, out);
    }

    fn right(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        (**self).right(z, out);
    }
}

/// A [`Pointwise`] problem at the stages of a mesh, as a [`Problem`].
#[derive(Debug, Clone)]
pub struct OnMesh<P> {
    /// The problem.
    pub problem: P,
    places: Vec<f64>,
}

impl<P> OnMesh<P> {
    /// Of `problem`, on `mesh`.
    pub fn new<const M: usize>(problem: P, gauss: &Gauss<M>, mesh: &Mesh) -> Self {
        let mut this = Self { problem, places: Vec::new() };
        this.take(gauss, mesh);
        this
    }

    /// Takes another mesh.
    pub fn take<const M: usize>(&mut self, gauss: &Gauss<M>, mesh: &Mesh) {
        self.places.clear();
        for i in 0..mesh.elements() {
            self.places.extend(gauss.c.iter().map(|c| mesh.nodes()[i] + mesh.step(i) * c));
        }
    }
}

impl<P: Pointwise<N, Q>, const N: usize, const Q: usize> Problem<N, Q, 0> for OnMesh<P> {
    type Failure = P::Failure;

    fn stages<const FUSED: bool>(
        &self,
        groups: Groups,
        stations: &mut [Station<N, 0>],
        out: &mut [Local<N, Q, 0, Lanes>],
    ) -> Result<(), P::Failure> {
        for (block, (station, out)) in stations.iter().zip(out).enumerate() {
            for lane in 0..LANES {
                let s = self.places[groups.station_in(block, lane)];
                let own = self.problem.slopes(s, &station.z.map(|v| v.0[lane]))?;
                for a in 0..N {
                    out.slope[a].0[lane] = own.slope[a];
                    for b in 0..N {
                        out.jacobian[a][b].0[lane] = own.jacobian[a][b];
                    }
                }
                for q in 0..Q {
                    out.rate[q].0[lane] = own.rate[q];
                    for b in 0..N {
                        out.rate_gradient[q][b].0[lane] = own.rate_gradient[q][b];
                    }
                }
            }
        }
        Ok(())
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
