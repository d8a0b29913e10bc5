//! Small motions about an equilibrium in space.

use hydrostat_bvp::{EndPlace, Inner, Lanes, Local, Real, StageForcing, Station, each};

use super::equations::{COORDINATES, S, SpatialMoving, X};
use super::start::at_rest;
use crate::motion::error::MotionError;
use crate::motion::modes::{Modes, slowest};
use crate::motion::small_motions::{Linear, Vibrates};
use crate::rod::area_law::area_law;
use crate::rod::arm::Arm;
use crate::spatial::SpatialTip;
use crate::spatial::configuration::angle_to_tangent;
use crate::spatial::equations::{L, MOMENT};
use crate::spatial::inertia::inertia;
use crate::spatial::loads::load;
use crate::spatial::rotation::{Directors, turn};

impl Vibrates<S, L, COORDINATES> for SpatialMoving {
    // A round arm bends to all sides alike: rates come in twos.
    const SPACE: [usize; 2] = [192, 2];

    /// Turns are about the directors.
    fn linear(&self, block: usize, station: &Station<S, L>) -> Linear<COORDINATES, L> {
        let statics = &self.statics;
        let (place, masses, water) = (&statics.places[block], &self.masses[block], &statics.water);
        let directors = Directors::of(&each(|k| station.z[k]));
        let section_stretch = area_law(statics.volume, station.inner[0]);
        let zero = Lanes::of(0.0);
        let stream = (statics.arm().flow.density != 0.0).then(|| each(|k| Lanes::of(water.stream[k])));
        let load = load(water, &place.body, stream, &directors, &station.inner, &section_stretch);
        let inert = inertia(water, masses, &directors, &station.inner, &section_stretch, &[zero; 3], &[0.0; 3]);
        let length = Lanes::of(statics.units.length);
        let area = section_stretch.beta * section_stretch.beta;
        let time = Lanes::of(statics.arm().dynamics.relaxation_time);
        let rotary = masses.rotary * area;
        let turned = |k: usize, c: usize| match (k, c) {
            (3, 3) => rotary + rotary,
            _ if k == c => rotary,
            _ => zero,
        };
        let moves = |k: usize, c: usize| k < 3 && c < 3;
        Linear {
            damping: each(|k| each(|c| if moves(k, c) { length * load.by_stream[k][c] } else { zero })),
            mass: each(|k| each(|c| if moves(k, c) { inert.by_acceleration[k][c] } else { turned(k, c) })),
            viscous: each(|k| time * place.stiffness.value[k] * area),
        }
    }

    fn load(&self, field: usize, station: &Station<S, L>) -> [Lanes; S] {
        let unit = |k: usize| Lanes::of(if k == field % 3 { 1.0 } else { 0.0 });
        let mut out = [Lanes::of(0.0); S];
        let (first, load) = if field < 3 {
            (MOMENT - 3, each(unit))
        } else {
            (MOMENT, Directors::of(&each(|k| station.z[k])).to_space(&each(unit)))
        };
        out[first..first + 3].copy_from_slice(&load);
        out
    }

    fn section(z: &[f64; S]) -> ([f64; 3], [[f64; 3]; 3]) {
        let Directors { a, b, c } = Directors::of(&each(|k| z[k]));
        ([z[X], z[X + 1], z[X + 2]], [a, b, c])
    }

    fn in_space(z: &[f64; S], moved: &[f64; COORDINATES]) -> [[f64; 3]; 2] {
        let [x, y, z_, turns @ ..] = *moved;
        [[x, y, z_], Directors::of(&each(|k| z[k])).to_space(&turns)]
    }

    fn moved(&self, station: &Station<S, L>, change: &[Lanes; S]) -> [Lanes; COORDINATES] {
        let turns = turn(&each(|k| station.z[k]));
        each(|k| match k {
            0..3 => change[X + k],
            _ => (0..4).fold(Lanes::of(0.0), |sum, a| sum + turns[k - 3][a] * change[a]),
        })
    }

    fn stage_forcing(
        &self,
        block: usize,
        station: &Station<S, L>,
        local: &Local<S, 0, L, Lanes>,
        carried: [Lanes; L],
    ) -> StageForcing<S, 0, L> {
        Self::stage_forcing(self, block, station, &local.inner, &carried)
    }

    fn end_forcing(
        &self,
        station: &Station<S, L>,
        inner: &Inner<S, L, Lanes>,
        carried: [Lanes; L],
    ) -> ([Lanes; L], Lanes) {
        Self::end_forcing(self, station, inner, &carried)
    }

    fn end_places(&self) -> &[EndPlace] {
        &self.end_places
    }
}

impl Arm {
    /// The `count` slowest motions in space about the equilibrium of this arm there, as [`Arm::modes`] has those in the
    /// plane: of an arm that lies in a plane those are among them. An arm without [`Arm::space`] may leave its plane
    /// here.
    ///
    /// ```
    /// use hydrostat::{Arm, Space, Volume};
    ///
    /// let mut rod = Arm::cone(1.0, 0.001, 0.001, 1e9, 0.5); // m, Pa
    /// rod.model.volume = Volume::None;
    /// rod.flow.density = 0.0; // a vacuum
    /// let modes = rod.modes_in_space(4, 4)?.modes;
    /// // A round rod bends to either side at the same frequency.
    /// assert!((modes[1].frequency() / modes[0].frequency() - 1.0).abs() < 1e-9);
    /// assert!((modes[2].frequency() / modes[0].frequency() - 6.267).abs() < 1e-3);
    /// # Ok::<(), hydrostat::MotionError>(())
    /// ```
    ///
    /// # Errors
    /// [`MotionError`] where there is no equilibrium, or the arm cannot move.
    pub fn modes_in_space(&self, count: usize, elements: usize) -> Result<Modes<SpatialTip>, MotionError> {
        let mut arm = self.clone();
        arm.space.get_or_insert_default();
        let (slowest, settling) = slowest(&arm, count, elements, |arm| at_rest(arm, Some(elements), 1e-8, 0.0))?;
        let (solution, length) = (&settling.solution, self.length);
        let last = solution.mesh.elements();
        let z = solution.nodes[last];
        let Directors { a, b, c } = Directors::of(&each(|k| z[k]));
        let alpha = angle_to_tangent(&solution.inner_in(&settling.system.gauss, last - 1, 1.0).inner);
        let [x, y, z] = each(|k| length * z[X + k]);
        Ok(slowest.with(SpatialTip { x, y, z, a, b, c, alpha }))
    }
}
