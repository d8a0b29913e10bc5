//! How the equations of an arm in space follow what is given, at a fixed solution: the right sides of responses, as in
//! the plane.

use hydrostat_bvp::{Forcing, Lanes, Real, StageForcing, Station, each};

use super::equations::{AtStation, Equations, FORCE, L, MOMENT, N, Q, by_strain_change};
use super::loads::{load, uniform};
use super::rotation::{Directors, Vector};
use super::section::{CableAt, STRAINS, apply, balance, pull};
use super::section_solve::Solved;
use crate::rod::parameter::Parameter;
use crate::statics::equations::{PLACES, SectionFailure, Way};
use crate::statics::phase::Phase;

/// The explicit part of the equations at a station: what the section carries, and the loads along the arm.
#[derive(Clone, Copy)]
struct Explicit {
    carried: [Lanes; STRAINS],
    force: Vector<Lanes>,
    couple: Vector<Lanes>,
}

impl Explicit {
    const ZERO: Self =
        Self { carried: [Lanes([0.0; 4]); STRAINS], force: [Lanes([0.0; 4]); 3], couple: [Lanes([0.0; 4]); 3] };

    fn add(&mut self, other: &Self, factor: f64) {
        let f = Lanes::of(factor);
        for k in 0..STRAINS {
            self.carried[k] += f * other.carried[k];
        }
        for k in 0..3 {
            self.force[k] += f * other.force[k];
            self.couple[k] += f * other.couple[k];
        }
    }
}

impl Equations {
    /// The change of the equations by `way`, at the last stations and ends and at the states at base and tip.
    pub(super) fn change_by(
        &self,
        way: Way,
        stations: &[Station<N, L>],
        end_stations: &[Station<N, L>],
        ends: [&[f64; N]; 2],
    ) -> Result<Forcing<N, Q, L>, SectionFailure> {
        if let Some(couples) = self.imposed.as_ref().filter(|_| way == Way::Path) {
            return Ok(change_by_couples(couples, stations));
        }
        if let Some(axis) = self.turning.as_ref().filter(|_| way == Way::Path) {
            return Ok(self.change_by_turn(axis));
        }
        match (way, self.varied_over()) {
            (Way::Of(Parameter::Stroke(_)), _) => return Ok(Forcing::default()),
            (Way::Path, Some(ways)) if ways.iter().all(|way| matches!(way.parameter, Parameter::Stroke(_))) => {
                return Ok(Forcing::default());
            }
            (Way::Path, None) if matches!(self.phase, Phase::Stroke | Phase::Friction) => {
                return Ok(Forcing::default());
            }
            (Way::Path, None) => return self.change_by_fraction(stations, end_stations, ends[1]),
            _ => {}
        }
        match way.pulls(&self.tensions, self.units.force, self.varied_over(), self.phase) {
            Some(tensions) => self.change_by_tensions(stations, end_stations, &tensions),
            None => self.differences(way, stations, end_stations, ends),
        }
    }

    /// Differences of the explicit parts of equations on both sides.
    fn differences(
        &self,
        way: Way,
        stations: &[Station<N, L>],
        end_stations: &[Station<N, L>],
        [base, tip]: [&[f64; N]; 2],
    ) -> Result<Forcing<N, Q, L>, SectionFailure> {
        let mut out = Forcing::default();
        let mut explicit = vec![Explicit::ZERO; stations.len()];
        let mut carried = vec![[Lanes::of(0.0); STRAINS]; end_stations.len()];
        let step = way.step(&self.arm, self.units.force, self.varied_over());
        let mut pulled = Vec::new();
        for (steps, weight) in PLACES {
            let Some(moved) = self.moved(way, steps * step) else { continue };
            let weight = weight / step;
            for (block, (station, out)) in stations.iter().zip(&mut explicit).enumerate() {
                out.add(&moved.explicit(block, station, &mut pulled), weight);
            }
            for (block, (station, out)) in end_stations.iter().zip(&mut carried).enumerate() {
                moved.pulled_in(moved.cables_at_end(block), &mut pulled);
                let own =
                    balance(moved.volume, &moved.end_sections[block].1, &pulled, &station.inner, station.closure_slope);
                for k in 0..STRAINS {
                    out[k] += Lanes::of(weight) * own.carried[k];
                }
            }
            moved.add_conditions(weight, [base, tip], &mut out);
        }
        for (block, (station, by)) in stations.iter().zip(&explicit).enumerate() {
            let at = self.solved_in(block, station, &mut pulled)?;
            let inner = apply(&at.solved.inverse, &by.carried.map(|v| -v));
            let mut forcing = strained(&at, station, inner);
            for k in 0..3 {
                forcing.slope[FORCE + k] -= by.force[k];
                forcing.slope[MOMENT + k] -= by.couple[k];
            }
            out.stages.push(forcing);
        }
        for (block, (station, by)) in end_stations.iter().zip(&carried).enumerate() {
            let solved = self.solved_at_end(block, station, &mut pulled);
            let inner = apply(&solved.inverse, &by.map(|v| -v));
            out.ends.push((inner, solved.balance.section_stretch.slope * inner[0]));
        }
        Ok(out)
    }

    /// The equations with what they are differentiated by moved by `change`.
    pub(super) fn moved(&self, way: Way, change: f64) -> Option<Self> {
        let mut moved = self.clone();
        match way {
            Way::Path => moved.set_range_fraction(self.range_fraction() + change),
            Way::Tension(c) => moved.tensions[c] += change,
            Way::Of(parameter) => {
                let value = parameter.of(&self.arm).ok()?;
                moved.set_parameter(parameter, value + change);
            }
        }
        Some(moved)
    }

    fn explicit(&self, block: usize, station: &Station<N, L>, pulled: &mut Vec<CableAt<Lanes>>) -> Explicit {
        let place = &self.places[block];
        self.pulled_in(self.cables_in(block), pulled);
        let own = balance(self.volume, &place.stiffness, pulled, &station.inner, station.closure_slope);
        let directors = Directors::of(&each(|k| station.z[k]));
        let fraction = Lanes::of(self.fraction[0]);
        let force =
            load(&self.water, &place.body, uniform(&self.water), &directors, &station.inner, &own.section_stretch)
                .force;
        Explicit {
            carried: own.carried,
            force: force.map(|v| v * fraction),
            couple: place.body.couple.map(|v| v * fraction),
        }
    }

    /// Adds `weight` times the residuals of the conditions at base and tip.
    fn add_conditions(&self, weight: f64, [base, tip]: [&[f64; N]; 2], out: &mut Forcing<N, Q, L>) {
        let mut conditions = [hydrostat_bvp::Condition::default(); N];
        hydrostat_bvp::Problem::left(self, base, &mut conditions);
        for r in 0..N {
            out.left[r] += weight * conditions[r].residual;
        }
        let mut conditions = [hydrostat_bvp::Condition::default(); N];
        hydrostat_bvp::Problem::right(self, tip, &mut conditions);
        for r in 0..N {
            out.right[r] += weight * conditions[r].residual;
        }
    }

    /// The section at a block of ends.
    fn solved_at_end(&self, block: usize, station: &Station<N, L>, pulled: &mut Vec<CableAt<Lanes>>) -> Solved<Lanes> {
        self.pulled_in(self.cables_at_end(block), pulled);
        self.solved(&self.end_sections[block].1, station, pulled).2
    }

    /// The change of the equations a unit of the phase's fraction, at fixed state, at the last stations.
    pub(super) fn change_by_fraction(
        &self,
        stations: &[Station<N, L>],
        end_stations: &[Station<N, L>],
        tip: &[f64; N],
    ) -> Result<Forcing<N, Q, L>, SectionFailure> {
        if self.phase != Phase::Loads {
            return self.change_by_tensions(stations, end_stations, &self.tensions);
        }
        let mut out = Forcing::default();
        let mut pulled = Vec::new();
        for (block, station) in stations.iter().enumerate() {
            let at = self.solved_in(block, station, &mut pulled)?;
            let place = &self.places[block];
            let (stream, section_stretch) = (uniform(&self.water), &at.solved.balance.section_stretch);
            let own = load(&self.water, &place.body, stream, &at.directors, &at.solved.strain, section_stretch);
            let mut forcing = StageForcing::default();
            for k in 0..3 {
                forcing.slope[FORCE + k] = -own.force[k];
                forcing.slope[MOMENT + k] = -place.body.couple[k];
            }
            out.stages.push(forcing);
        }
        if !self.is_unstrained_base() {
            let (load, _) = self.tip_load(1.0, &Directors::of(&each(|k| tip[k])));
            for k in 0..6 {
                out.right[k] = -load[k];
            }
        }
        Ok(out)
    }

    /// The change of the equations with `tensions` (in the unit of force) more, at fixed state, at the last stations.
    pub(crate) fn change_by_tensions(
        &self,
        stations: &[Station<N, L>],
        end_stations: &[Station<N, L>],
        tensions: &[f64],
    ) -> Result<Forcing<N, Q, L>, SectionFailure> {
        let mut out = Forcing::default();
        let mut pulled = Vec::new();
        for (block, station) in stations.iter().enumerate() {
            let at = self.solved_in(block, station, &mut pulled)?;
            let inner = pulled_more(self.cables_in(block), tensions, &at.solved, station.closure_slope);
            out.stages.push(strained(&at, station, inner));
        }
        for (block, station) in end_stations.iter().enumerate() {
            let solved = self.solved_at_end(block, station, &mut pulled);
            let inner = pulled_more(self.cables_at_end(block), tensions, &solved, station.closure_slope);
            out.ends.push((inner, solved.balance.section_stretch.slope * inner[0]));
        }
        if self.is_unstrained_base() {
            let none = vec![0.0; tensions.len()];
            let [more, without] = [tensions, &none].map(|tensions| self.unstrained_base(tensions));
            for k in 0..6 {
                out.left[FORCE + k] = without[k] - more[k];
            }
        }
        Ok(out)
    }
}

/// The change by a couple along the arm, about the directors.
fn change_by_couples(couples: &[Vector<Lanes>], stations: &[Station<N, L>]) -> Forcing<N, Q, L> {
    let mut out = Forcing::default();
    for (couple, station) in couples.iter().zip(stations) {
        let mut forcing = StageForcing::default();
        let couple = Directors::of(&each(|k| station.z[k])).to_space(couple);
        for k in 0..3 {
            forcing.slope[MOMENT + k] = -couple[k];
        }
        out.stages.push(forcing);
    }
    out
}

/// The forcing at a station whose strains change.
fn strained(at: &AtStation<Lanes>, station: &Station<N, L>, inner: [Lanes; L]) -> StageForcing<N, Q, L> {
    StageForcing {
        slope: by_strain_change(at, &each(|k| station.z[k]), &inner),
        rate: at.directors.to_space(&[inner[0], inner[1], inner[2]]),
        value: at.solved.balance.section_stretch.slope * inner[0],
        inner,
    }
}

/// The change of the strains with `tensions` more.
fn pulled_more(cables: &[CableAt<Lanes>], tensions: &[f64], solved: &Solved<Lanes>, slope: Lanes) -> [Lanes; L] {
    let mut added = [Lanes::of(0.0); L];
    for (cable, tension) in cables.iter().zip(tensions).filter(|(_, tension)| **tension != 0.0) {
        let cable = CableAt { tension: cable.tension * Lanes::of(*tension), ..*cable };
        let load = pull(&cable, &solved.strain, &solved.balance.section_stretch, slope).load;
        for k in 0..L {
            added[k] -= load[k];
        }
    }
    apply(&solved.inverse, &added)
}
