//! Small motions about an equilibrium in the plane.

use hydrostat_bvp::{EndPlace, Inner, Lanes, Local, Real, StageForcing, Station, each};

use super::dimensions::{S, X};
use super::equations::Moving;
use super::small_motions::{Linear, Vibrates};
use crate::numerics::sincos::sin_cos;
use crate::rod::area_law::area_law;
use crate::rod::inertia::{inertia, turning};
use crate::rod::loads::{centreline, load};
use crate::statics::dimensions::L;

/// x, y, theta.
const C: usize = 3;

impl Vibrates<S, L, C> for Moving {
    const SPACE: [usize; 2] = [96, 1];

    fn linear(&self, block: usize, station: &Station<S, L>) -> Linear<C, L> {
        let (place, masses, water) = (&self.statics.places[block], &self.masses[block], &self.statics.water);
        let arm = self.statics.arm();
        let (sin, cos) = sin_cos(station.z[0]);
        let [nu, eta, _] = station.inner;
        let swelling = area_law(self.statics.volume, nu);
        let zero = Lanes::of(0.0);
        let stream = (arm.flow.density != 0.0).then(|| each(|k| Lanes::of(water.stream[k])));
        let load = load(water, &place.body, stream, [cos, sin], station.inner, &swelling, station.closure_slope);
        let along = centreline([cos, sin], [nu, eta]);
        let inert = inertia(water, masses, &along, nu, &swelling, [zero; 2], [0.0; 2]);
        let turn = turning(self.statics.volume, masses, [nu, zero], [zero; 2]);
        let length = Lanes::of(self.statics.units.length);
        let area = swelling.beta * swelling.beta;
        let time = Lanes::of(arm.dynamics.relaxation_time);
        let moves = |k: usize, c: usize| k < 2 && c < 2;
        let turned = |k: usize, c: usize| if k == c { turn.by[0] } else { zero };
        Linear {
            damping: each(|k| each(|c| if moves(k, c) { length * load.by_stream[k][c] } else { zero })),
            mass: each(|k| each(|c| if moves(k, c) { inert.by_acceleration[k][c] } else { turned(k, c) })),
            viscous: each(|k| time * place.stiffness.value[k] * area),
        }
    }

    fn load(&self, field: usize, _: &Station<S, L>) -> [Lanes; S] {
        each(|a| Lanes::of(if a == 1 + field { 1.0 } else { 0.0 }))
    }

    fn section(z: &[f64; S]) -> ([f64; 3], [[f64; 3]; 3]) {
        let (sin, cos) = z[0].sin_cos();
        ([z[X], z[X + 1], 0.0], [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    }

    fn in_space(_: &[f64; S], [x, y, theta]: &[f64; C]) -> [[f64; 3]; 2] {
        [[*x, *y, 0.0], [0.0, 0.0, *theta]]
    }

    fn moved(&self, _: &Station<S, L>, change: &[Lanes; S]) -> [Lanes; C] {
        [change[X], change[X + 1], change[0]]
    }

    fn stage_forcing(
        &self,
        block: usize,
        station: &Station<S, L>,
        local: &Local<S, 0, L, Lanes>,
        carried: [Lanes; L],
    ) -> StageForcing<S, 0, L> {
        Self::stage_forcing(self, block, station, local, carried)
    }

    fn end_forcing(
        &self,
        station: &Station<S, L>,
        inner: &Inner<S, L, Lanes>,
        carried: [Lanes; L],
    ) -> ([Lanes; L], Lanes) {
        Self::end_forcing(self, station, inner, carried)
    }

    fn end_places(&self) -> &[EndPlace] {
        &self.statics.end_places
    }
}
