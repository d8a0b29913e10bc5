//! How the equations follow what is given, at a fixed solution: the right sides of responses.

use hydrostat_bvp::{Condition, Forcing, Lanes, Local, Problem, Real, StageForcing, Station, each};

use super::cable_paths::StationData;
use super::gradients::{by_strain_change, in_directors};
use super::place::Place;
use super::section_state::SectionQuery;
use super::system::Equations;
use super::way::{PLACES, Way};
use crate::numerics::sincos::sin_cos;
use crate::rod::area_law::area_law;
use crate::rod::cable::pull;
use crate::rod::cable_list::CableList;
use crate::rod::loads::{load, uniform};
use crate::rod::parameter::Parameter;
use crate::rod::section::{CableAt, Stiffness, apply3, balance};
use crate::statics::dimensions::{L, N, Q};
use crate::statics::verdict::Phase;

/// The explicit part of the equations at a station: what the section carries, and the loads along the arm.
#[derive(Clone, Copy)]
struct Explicit {
    carried: [Lanes; 3],
    force: [Lanes; 2],
    couple: Lanes,
}

impl Explicit {
    const ZERO: Self = Self { carried: [Lanes([0.0; 4]); 3], force: [Lanes([0.0; 4]); 2], couple: Lanes([0.0; 4]) };

    #[inline(always)]
    fn add(&mut self, other: &Self, factor: f64) {
        let f = Lanes::of(factor);
        for k in 0..3 {
            self.carried[k] += f * other.carried[k];
        }
        for k in 0..2 {
            self.force[k] += f * other.force[k];
        }
        self.couple += f * other.couple;
    }
}

impl Equations {
    /// The change of the equations by `way`, at the stations and ends of the last evaluation.
    pub(crate) fn change_by(
        &self,
        way: Way,
        stations: &[Station<N, L>],
        locals: &[Local<N, Q, L, Lanes>],
        ends: &[Station<N, L>],
        end_states: [&[f64; N]; 2],
    ) -> Forcing<N, Q, L> {
        let mut out = Forcing::default();
        let (mut explicit, mut end_explicit) = (Vec::new(), Vec::new());
        if self.moves_nothing(way) {
            return out;
        }
        if let Some(couple) = self.imposed_by(way) {
            explicit.extend((0..stations.len()).map(|block| Explicit { couple: couple(block), ..Explicit::ZERO }));
        } else if let Some(cables) = self.pulled_by(way) {
            explicit.extend(stations.iter().enumerate().map(|(block, station)| Explicit {
                carried: self.carried_by(&cables, self.cables_in(block), station),
                ..Explicit::ZERO
            }));
            let count = self.tensions.len();
            let at_ends = ends
                .iter()
                .enumerate()
                .map(|(b, station)| self.carried_by(&cables, &self.end_cables[b * count..(b + 1) * count], station));
            end_explicit.extend(at_ends);
        } else if way == Way::Path && self.varied.is_none() {
            // The fraction of the loads.
            let mut whole = self.water;
            whole.tangential_factor = self.water.tangential_factor;
            explicit.extend(stations.iter().zip(&self.places).map(|(station, place)| {
                let (sin, cos) = sin_cos(station.z[0]);
                let section_stretch = area_law(self.volume, station.inner[0]);
                let slope = station.closure_slope;
                let (body, stream) = (&place.body, uniform(&whole));
                let force = load(&whole, body, stream, [cos, sin], station.inner, &section_stretch, slope).force;
                Explicit { force, couple: place.body.couple, ..Explicit::ZERO }
            }));
        } else {
            self.differences(way, stations, ends, &mut explicit, &mut end_explicit);
        }
        self.conditions_by(way, end_states, &mut out);
        out.stages = explicit
            .iter()
            .enumerate()
            .map(|(block, by)| self.stage_forcing(&self.places[block], &stations[block], &locals[block], by))
            .collect();
        out.ends = end_explicit.iter().zip(ends).enumerate().map(|(b, (by, at))| self.end_forcing(b, at, by)).collect();
        out
    }

    /// Whether only commands follow `way`.
    fn moves_nothing(&self, way: Way) -> bool {
        match way {
            Way::Path => {
                self.only_commands_move()
                    || (self.varied.is_none() && self.imposed.is_none() && self.phase == Phase::Friction)
            }
            Way::Of(parameter) => matches!(parameter, Parameter::Stroke(_)),
            Way::Tension(_) => false,
        }
    }

    fn imposed_by(&self, way: Way) -> Option<impl Fn(usize) -> Lanes> {
        let couple = self.imposed.as_ref().filter(|_| way == Way::Path)?;
        Some(|block: usize| Lanes(each(|lane| couple[self.groups.station_in(block, lane)])))
    }

    /// The tensions (in the unit of force) that grow with `way`, where that is all that does.
    fn pulled_by(&self, way: Way) -> Option<Vec<f64>> {
        if way == Way::Path && self.imposed.is_some() {
            return None;
        }
        way.pulls(&self.tensions, self.units.force, self.varied_over(), self.phase)
    }

    /// What sections carry of these tensions.
    fn carried_by(&self, tensions: &[f64], cables: &[CableAt<Lanes>], station: &Station<N, L>) -> [Lanes; 3] {
        let section_stretch = area_law(self.volume, station.inner[0]);
        let mut out = [Lanes::of(0.0); 3];
        for (cable, tension) in cables.iter().zip(tensions).filter(|(_, tension)| **tension != 0.0) {
            let tension = cable.tension * Lanes::of(*tension);
            let (by, _) = pull(tension, &cable.offset, station.inner, &section_stretch, station.closure_slope);
            for k in 0..3 {
                out[k] += by.load[k];
            }
        }
        out
    }

    /// Differences of the explicit parts of equations on both sides.
    fn differences(
        &self,
        way: Way,
        stations: &[Station<N, L>],
        ends: &[Station<N, L>],
        explicit: &mut Vec<Explicit>,
        end_explicit: &mut Vec<[Lanes; 3]>,
    ) {
        explicit.resize(stations.len(), Explicit::ZERO);
        end_explicit.resize(ends.len(), [Lanes::of(0.0); 3]);
        let step = self.difference_step(way);
        let mut pulled = CableList::new();
        let count = self.tensions.len();
        for (steps, weight) in PLACES {
            let Some(moved) = self.moved(way, steps * step) else { continue };
            let weight = weight / step;
            for (block, (station, out)) in stations.iter().zip(explicit.iter_mut()).enumerate() {
                moved.pulled_in(moved.cables_in(block), &mut pulled);
                let place = &moved.places[block];
                out.add(&moved.explicit(&place.stiffness, Some(place), pulled.as_slice(), station), weight);
            }
            for (b, (station, out)) in ends.iter().zip(end_explicit.iter_mut()).enumerate() {
                moved.pulled_in(&moved.end_cables[b * count..(b + 1) * count], &mut pulled);
                let by = moved.explicit(&moved.end_sections[b].stiffness, None, pulled.as_slice(), station);
                for k in 0..3 {
                    out[k] += Lanes::of(weight) * by.carried[k];
                }
            }
        }
    }

    #[inline(always)]
    fn explicit(
        &self,
        stiffness: &Stiffness<Lanes>,
        place: Option<&Place<Lanes>>,
        cables: &[CableAt<Lanes>],
        station: &Station<N, L>,
    ) -> Explicit {
        let slope = station.closure_slope;
        let balance = balance(self.volume, stiffness, cables, station.inner, slope);
        let mut out = Explicit { carried: balance.carried, ..Explicit::ZERO };
        if let Some(place) = place {
            let (sin, cos) = sin_cos(station.z[0]);
            out.force = self.load(place, [cos, sin], station.inner, &balance.section_stretch, slope).force;
            out.couple = place.body.couple * Lanes::of(self.fraction[0]);
        }
        out
    }

    /// The change of the end conditions' residuals.
    fn conditions_by(&self, way: Way, [base, tip]: [&[f64; N]; 2], out: &mut Forcing<N, Q, L>) {
        if way == Way::Path && self.imposed.is_some() {
            return;
        }
        let step = self.difference_step(way);
        for (steps, weight) in PLACES {
            let Some(moved) = self.moved_conditions(way, steps * step) else { continue };
            let mut conditions = [Condition::default(); N];
            moved.left(base, &mut conditions);
            for r in 0..N {
                out.left[r] += weight / step * conditions[r].residual;
            }
            let mut conditions = [Condition::default(); N];
            moved.right(tip, &mut conditions);
            for r in 0..N {
                out.right[r] += weight / step * conditions[r].residual;
            }
        }
    }

    /// The forcing at a station, the strains eliminated.
    #[inline(always)]
    fn stage_forcing(
        &self,
        place: &Place<Lanes>,
        station: &Station<N, L>,
        local: &Local<N, Q, L, Lanes>,
        by: &Explicit,
    ) -> StageForcing<N, Q, L> {
        let (sin, cos) = sin_cos(station.z[0]);
        let section_stretch = area_law(self.volume, station.inner[0]);
        let load = self.load(place, [cos, sin], station.inner, &section_stretch, station.closure_slope);
        let contact = in_directors([cos, sin], &station.z);
        let strain = following(&local.inner.gradient, [cos, sin], by.carried);
        let mut slope = by_strain_change(&load, contact, strain);
        slope[1] -= by.force[0];
        slope[2] -= by.force[1];
        slope[3] -= by.couple;
        let [nu, eta, _] = strain;
        StageForcing {
            slope,
            rate: [nu * cos - eta * sin, nu * sin + eta * cos],
            inner: strain,
            value: section_stretch.slope * strain[0],
        }
    }

    fn end_forcing(&self, block: usize, station: &Station<N, L>, carried: &[Lanes; 3]) -> ([Lanes; L], Lanes) {
        let section = &self.end_sections[block];
        let mut pulled = CableList::new();
        let count = self.tensions.len();
        self.pulled_in(&self.end_cables[block * count..(block + 1) * count], &mut pulled);
        let there = balance(self.volume, &section.stiffness, pulled.as_slice(), station.inner, station.closure_slope);
        let (inverse, _) = crate::rod::section::inverse3(&there.by_strain);
        let less = apply3(&inverse, *carried);
        let strain: [Lanes; 3] = each(|k| -less[k]);
        (strain, there.section_stretch.slope * strain[0])
    }
}

/// The strains that follow a change of what the section carries at fixed strains, from how they follow the state: the
/// section law's inverse is turned into space there.
#[inline(always)]
fn following(gradient: &[[Lanes; N]; 3], [cos, sin]: [Lanes; 2], carried: [Lanes; 3]) -> [Lanes; 3] {
    each(|k| {
        let [_, x, y, m] = gradient[k];
        let (by_n_a, by_n_b) = (cos * x + sin * y, cos * y - sin * x);
        -(by_n_a * carried[0] + by_n_b * carried[1] + m * carried[2])
    })
}

impl Equations {
    fn difference_step(&self, way: Way) -> f64 {
        way.step(&self.arm, self.units.force, self.varied_over())
    }

    /// The equations with what they are differentiated by moved by `change`.
    fn moved(&self, way: Way, change: f64) -> Option<Self> {
        let mut moved = self.clone();
        moved.move_by(way, change, true)?;
        Some(moved)
    }

    /// The same without what is along the arm.
    fn moved_conditions(&self, way: Way, change: f64) -> Option<Self> {
        let mut moved = self.without_stations();
        moved.move_by(way, change, false)?;
        Some(moved)
    }

    fn move_by(&mut self, way: Way, change: f64, sections: bool) -> Option<()> {
        match way {
            Way::Path => match self.varied_over() {
                Some(_) => {
                    let fraction = self.range_fraction() + change;
                    self.set_range_fraction_with(fraction, sections);
                }
                None => match self.phase {
                    Phase::Loads => self.fraction[0] += change,
                    Phase::Tension => self.fraction[1] += change,
                    Phase::Stroke | Phase::Friction => return None,
                },
            },
            Way::Tension(c) => self.tensions[c] += change,
            Way::Of(parameter) => {
                let value = parameter.of(&self.arm).ok()?;
                parameter.set(&mut self.arm, value + change).ok()?;
                self.take_arm(sections && parameter.is_of_sections());
            }
        }
        Some(())
    }

    /// How the stroke of cable `c` (of its path, or as it is commanded) follows `way` at a fixed solution, over L.
    pub(crate) fn stroke_by(&self, c: usize, commanded: bool, way: Way, at: StationData<'_>) -> f64 {
        let geometric = matches!(way, Way::Of(Parameter::Offset(..) | Parameter::Length | Parameter::Reference(..)));
        let stretched = commanded && self.arm.cables[c].stiffness.is_some();
        let pulled = stretched && matches!(way, Way::Of(Parameter::Tension(k)) if k == c);
        if !geometric && !pulled {
            return 0.0;
        }
        let stroke = |equations: &Self| {
            if commanded {
                return equations.stroke(c, at)[0];
            }
            let [now, reference] = equations.cable_lengths(c, at);
            reference - now
        };
        self.difference(way, stroke)
    }

    /// How strains at a place follow `way` at a fixed state and beta'.
    pub(crate) fn strain_by(&self, asked: &SectionQuery, way: Way) -> [f64; L] {
        let strain = |k: usize| move |equations: &Self| equations.at_place(asked).map_or(f64::NAN, |at| at.strain[k]);
        each(|k| self.difference(way, strain(k)))
    }

    /// The derivative of a number by `way`.
    fn difference(&self, way: Way, of: impl Fn(&Self) -> f64) -> f64 {
        let step = self.difference_step(way);
        let one =
            |(steps, weight): (f64, f64)| self.moved(way, steps * step).map_or(0.0, |moved| weight / step * of(&moved));
        PLACES.into_iter().map(one).sum()
    }
}
