//! What a change of what sections carry moves in space: that of a cable's tension ([`crate::motion::strokes`]) among
//! them.

use hydrostat_bvp::{Collocation, Forcing, Inner, Lanes, Real, StageForcing, Station, each};

use super::equations::{S, SpatialMoving, X};
use crate::rod::area_law::area_law;
use crate::spatial::equations::{FORCE, L, M, MOMENT, in_directors, strained};
use crate::spatial::rotation::{Directors, Vector};
use crate::spatial::section::{CableAt, STRAINS, pull};
use crate::statics::equations::StrokeControl;

impl SpatialMoving {
    /// Commands the strokes of the arm: those cables are taut that have a tension.
    pub(super) fn command_strokes(&mut self) {
        let cables = &self.statics.arm().cables;
        self.stroke_control = StrokeControl::slack((0..cables.len()).filter(|c| cables[*c].stroke.is_some()).collect());
        if let Some(stroke_control) = &mut self.stroke_control {
            stroke_control.taut =
                stroke_control.cables.iter().map(|cable| self.statics.tensions[*cable] > 0.0).collect();
        }
    }

    /// What changes with a unit of the tension of cable `c` (in the unit of force), into `out`.
    pub(super) fn pull_by(&self, c: usize, system: &Collocation<S, M, 0, L>, out: &mut Forcing<S, 0, L>) {
        let statics = &self.statics;
        out.stages.clear();
        for (block, (station, local)) in system.stations().iter().zip(system.locals()).enumerate() {
            let carried = self.carried(&statics.cables_in(block)[c], station);
            out.stages.push(self.stage_forcing(block, station, &local.inner, &carried));
        }
        out.ends.clear();
        for (block, (station, inner)) in system.end_stations().iter().zip(system.ends()).enumerate() {
            let carried = self.carried(&statics.cables_at_end(block)[c], station);
            out.ends.push(self.end_forcing(station, inner, &carried));
        }
    }

    /// What a cable carries a unit of its tension, in the directors.
    fn carried(&self, cable: &CableAt<Lanes>, station: &Station<S, L>) -> [Lanes; STRAINS] {
        let section_stretch = area_law(self.statics.volume, station.inner[0]);
        pull(cable, &station.inner, &section_stretch, station.closure_slope).load
    }

    /// What a change of what sections carry, in a block of stations, changes at fixed states: the strains follow, and
    /// with them the slopes.
    pub(super) fn stage_forcing(
        &self,
        block: usize,
        given: &Station<S, L>,
        inner: &Inner<S, L, Lanes>,
        carried: &[Lanes; STRAINS],
    ) -> StageForcing<S, 0, L> {
        let (station, r) = self.unscaled(given);
        let q: [Lanes; 4] = each(|k| station.z[k]);
        let directors = Directors::of(&q);
        let contact = in_directors(&directors, &station.z);
        let strain = self.follow(inner, &directors, carried);
        let section_stretch = area_law(self.statics.volume, station.inner[0]);
        let (load, _) = self.loads(block, &r, &directors, &station.inner, &section_stretch);
        let still = strained(&directors, &contact, &load.by_stretch, &q, &strain);
        let by_nu = directors.to_space(&self.turning(block, &q, station.inner[0]).by_nu);
        let rate = directors.to_space(&[strain[0], strain[1], strain[2]]);
        let slope: [Lanes; S] = each(|a| match a {
            X.. => rate[a - X],
            MOMENT.. => still[a] + by_nu[a - MOMENT] * strain[0],
            _ => still[a],
        });
        StageForcing {
            slope: each(|a| Lanes::of(1.0 / self.scales[a]) * slope[a]),
            rate: [],
            inner: strain,
            value: section_stretch.slope * strain[0],
        }
    }

    /// The same at a block of ends: strains, and the section stretch.
    pub(super) fn end_forcing(
        &self,
        given: &Station<S, L>,
        inner: &Inner<S, L, Lanes>,
        carried: &[Lanes; STRAINS],
    ) -> ([Lanes; L], Lanes) {
        let (station, _) = self.unscaled(given);
        let strain = self.follow(inner, &Directors::of(&each(|k| station.z[k])), carried);
        (strain, area_law(self.statics.volume, given.inner[0]).slope * strain[0])
    }

    /// The strains that follow so much more of what a section carries, at a fixed state: those of that much less of
    /// contact force and moment, whose derivatives the section law's gradient has.
    fn follow(
        &self,
        inner: &Inner<S, L, Lanes>,
        directors: &Directors<Lanes>,
        carried: &[Lanes; STRAINS],
    ) -> [Lanes; L] {
        let both: [Vector<Lanes>; 2] = each(|half| directors.to_space(&each(|k| carried[3 * half + k])));
        each(|k| {
            let mut sum = Lanes::of(0.0);
            for c in 0..STRAINS {
                let own = Lanes::of(1.0 / self.scales[FORCE + c]) * inner.gradient[k][FORCE + c];
                sum += own * both[c / 3][c % 3];
            }
            -sum
        })
    }
}
