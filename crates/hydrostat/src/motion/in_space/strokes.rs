//! Cables whose stroke is commanded in motion in space: shape and tensions in one bordered system, as in the plane
//! ([`crate::motion::strokes`]).

use hydrostat_bvp::{Collocation, Correction, Forcing, Inner, Lanes, Real, Stage, StageForcing, Station, each};

use super::equations::{S, Spatial, SpatialMoving, X};
use crate::motion::settling::Unsolved;
use crate::rod::area_law::area_law;
use crate::spatial::cable_paths::StageData;
use crate::spatial::equations::{FORCE, L, M, MOMENT, N, in_directors, strained};
use crate::spatial::rotation::{Directors, Vector};
use crate::spatial::section::{CableAt, STRAINS, pull};
use crate::statics::border::{UnitPull, add_pulls, meeting};
use crate::statics::equations::StrokeControl;

/// Corrections above which tensions do not yet say which cables are taut.
const SETTLED: f64 = 0.3;

/// The tensions' part of a round, and memory for it.
#[derive(Debug, Clone, Default)]
pub(super) struct SpatialBorder {
    /// Changes of the tensions (in the unit of force), one a held cable.
    tensions: Vec<f64>,
    /// Strokes less commands after the round, over L.
    slack: Vec<f64>,
    stages: Vec<Stage<N, L>>,
    forcing: Forcing<S, 0, L>,
}

impl SpatialMoving {
    /// Commands the strokes of the arm: those cables are taut that have a tension.
    pub(super) fn command_strokes(&mut self) {
        let cables = &self.statics.arm().cables;
        self.held = StrokeControl::slack((0..cables.len()).filter(|c| cables[*c].stroke.is_some()).collect());
        if let Some(held) = &mut self.held {
            held.taut = held.cables.iter().map(|cable| self.statics.tensions[*cable] > 0.0).collect();
        }
    }

    /// What changes with a unit of the tension of cable `c` (in the unit of force), into `out`.
    fn pull_by(&self, c: usize, system: &Collocation<S, M, 0, L>, out: &mut Forcing<S, 0, L>) {
        let statics = &self.statics;
        out.stages.clear();
        for (block, (station, local)) in system.stations().iter().zip(system.locals()).enumerate() {
            let carried = self.carried(&statics.cables_in(block)[c], station);
            out.stages.push(self.drift(block, station, &local.inner, &carried));
        }
        out.ends.clear();
        for (block, (station, inner)) in system.end_stations().iter().zip(system.ends()).enumerate() {
            let carried = self.carried(&statics.cables_at_end(block)[c], station);
            let (own, _) = self.unscaled(station);
            let directors = Directors::of(&each(|k| own.z[k]));
            let strain = self.follow(inner, &directors, &carried);
            out.ends.push((strain, area_law(statics.volume, station.inner[0]).slope * strain[0]));
        }
    }

    /// What a cable carries a unit of its tension, in the directors.
    fn carried(&self, cable: &CableAt<Lanes>, station: &Station<S, L>) -> [Lanes; STRAINS] {
        let swelling = area_law(self.statics.volume, station.inner[0]);
        pull(cable, &station.inner, &swelling, station.closure_slope).load
    }

    /// What a change of what sections carry, in a block of stations, changes at fixed states: the strains follow, and
    /// with them the slopes.
    fn drift(
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
        let swelling = area_law(self.statics.volume, station.inner[0]);
        let (load, _) = self.loads(block, &r, &directors, &station.inner, &swelling);
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
            value: swelling.slope * strain[0],
        }
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

impl Spatial {
    /// Adds to the correction of the last linearisation what the tensions of held cables do, so that their strokes
    /// are met; by how much those of taut ones were off.
    pub(super) fn meet_strokes(&mut self) -> Result<f64, Unsolved> {
        let Some(held) = self.moving.held.clone() else { return Ok(0.0) };
        let mut border = std::mem::take(&mut self.border);
        border.stages.clear();
        border.stages.extend(self.system.stations().iter().map(|station| Stage {
            inner: station.inner,
            closure_slope: station.closure_slope,
            ..Stage::default()
        }));
        let statics = &self.moving.statics;
        let at = StageData { weights: &self.system.gauss.b, steps: self.system.steps(), stages: &border.stages };
        let taut = held.taut_cables();
        let mut pulled = Vec::with_capacity(taut.len());
        for index in taut {
            self.moving.pull_by(held.cables[index], &self.system, &mut border.forcing);
            let mut response = Correction::default();
            self.respond(&border.forcing, &mut response);
            let mut strokes: Vec<f64> =
                held.cables.iter().map(|cable| statics.stroke_change(*cable, at, &response)).collect();
            strokes[index] += statics.stroke(held.cables[index], at)[1];
            pulled.push(UnitPull { response, strokes });
        }
        let mut most = 0.0_f64;
        border.slack.clear();
        for (index, cable) in held.cables.iter().enumerate() {
            let off = statics.stroke(*cable, at)[0] - statics.command(&held, index);
            if held.taut[index] {
                most = most.max(off.abs());
            }
            border.slack.push(off + statics.stroke_change(*cable, at, &self.correction));
        }
        let found = meeting(&held, &pulled, [&border.slack, &border.slack]);
        let changes = found.iter().flat_map(|(tensions, _)| tensions.iter().map(|both| both[0]));
        border.tensions = add_pulls(&held, &pulled, changes, &mut self.correction, &mut border.slack);
        self.border = border;
        found.map(|_| most).ok_or(Unsolved::Singular)
    }

    /// Adds `factor` times the last round to the tensions.
    pub(super) fn change_tensions(&mut self, factor: f64) {
        let Some(held) = &self.moving.held else { return };
        for ((cable, taut), change) in held.cables.iter().zip(&held.taut).zip(&self.border.tensions) {
            if *taut {
                let tension = self.moving.statics.tensions[*cable] + factor * change;
                self.moving.statics.set_tension(*cable, tension);
            }
        }
    }

    /// Lets cables go slack that push, and takes slack ones up that are too short, given the size of the last
    /// correction; whether any changed.
    pub(super) fn switch_cables(&mut self, size: f64) -> bool {
        if size > SETTLED {
            return false;
        }
        let Some(held) = &mut self.moving.held else { return false };
        let statics = &mut self.moving.statics;
        let changed = held.switch(|cable| statics.tensions[cable], &self.border.slack);
        if changed {
            held.slack_cables().for_each(|cable| statics.set_tension(cable, 0.0));
        }
        changed
    }
}
