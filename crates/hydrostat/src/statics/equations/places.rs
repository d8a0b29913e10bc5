//! The data of an arm at the stations: sections and cables.

use hydrostat_bvp::{Gauss, LANES, Lanes, Real, Side, Solution, each};

use super::place::{EndSection, Place, blank_cable};
use super::system::Equations;
use crate::rod::arm::{Arm, Cavity, Material};
use crate::rod::cable::Offset;
use crate::rod::loads::Body;
use crate::rod::profile::Profile;
use crate::rod::section::{CableAt, Stiffness};
use crate::statics::dimensions::{L, Units};

impl Equations {
    /// Data at `s` (over L).
    pub(super) fn place(&self, s: f64) -> Place<f64> {
        self.place_of(&self.arm, s)
    }

    /// Data at `s` (over L) of an arm in the units of this one.
    pub(super) fn place_of(&self, arm: &Arm, s: f64) -> Place<f64> {
        let length = self.units.length;
        let at = |profile: &Profile| {
            let own = profile.at(s * length, length);
            [own.value, own.slope]
        };
        let place = self.place_with(arm, s, at(&arm.radius), at);
        #[cfg(test)]
        let place = self.manufactured.as_ref().map_or(place, |shape| {
            let [f1, f2, couple] = shape.missing(self.units, &self.water, &place.body, s);
            let Body { force: [x, y], couple: own, .. } = place.body;
            Place { body: Body { force: [x + f1, y + f2], couple: own + couple, ..place.body }, ..place }
        });
        place
    }

    /// Data at four places side by side, to the bit those of [`Equations::place`].
    #[inline(always)]
    pub(super) fn place_four(&self, s: Lanes) -> Place<Lanes> {
        #[cfg(test)]
        if self.manufactured.is_some() {
            let mut place = in_lanes(&self.place(s.0[0]));
            for lane in 1..LANES {
                set_lane(&mut place, lane, &self.place(s.0[lane]));
            }
            return place;
        }
        let length = self.units.length;
        let along = s * Lanes::of(length);
        let at = |profile: &Profile| {
            let [value, slope, _] = profile.at_four(along, length);
            [value, slope]
        };
        self.place_with(&self.arm, s, at(&self.arm.radius), at)
    }

    /// [`section_data`] in the units of these equations.
    #[inline(always)]
    pub(super) fn place_with<R: Real>(
        &self,
        arm: &Arm,
        s: R,
        radius: [R; 2],
        at: impl Fn(&Profile) -> [R; 2],
    ) -> Place<R> {
        section_data(arm, self.units, s, radius, at)
    }

    pub(crate) fn offset(&self, cable: usize, s: f64) -> Offset<f64> {
        let length = self.units.length;
        let offset = self.arm.cables[cable].offset.at(s * length, length);
        Offset { y: offset.value / length, slope: offset.slope }
    }

    /// [`Equations::offset`] at four places.
    #[inline(always)]
    pub(super) fn offset_four(&self, cable: usize, s: Lanes) -> Offset<Lanes> {
        let length = self.units.length;
        let [y, slope, _] = self.arm.cables[cable].offset.at_four(s * Lanes::of(length), length);
        Offset { y: y / Lanes::of(length), slope }
    }

    /// Takes the stations and ends of a solution's mesh.
    pub(crate) fn place_on<const S: usize, const M: usize>(&mut self, gauss: &Gauss<M>, solution: &Solution<S, M, L>) {
        let mesh = &solution.mesh;
        let groups = solution.groups();
        let blocks = groups.count() * M;
        let cable_count = self.tensions.len();
        let before = std::mem::replace(&mut self.groups, groups).elements;
        let mut stations = std::mem::take(&mut self.stations);
        if self.places.len() < blocks {
            let blank = self.place_four(Lanes::of(0.5));
            self.places.resize(blocks, blank);
        }
        self.places.truncate(blocks);
        self.cables.resize(blocks * cable_count, blank_cable());
        stations.resize(groups.elements * M, f64::NAN);
        for group in 0..groups.count() {
            for j in 0..M {
                let block = group * M + j;
                let mut places = Lanes::of(0.0);
                // Stations that stay where they were keep their data.
                let mut stay = true;
                for lane in 0..LANES {
                    let i = groups.element(group, lane);
                    let k = i * M + j;
                    let s = mesh.nodes()[i] + mesh.step(i) * gauss.c[j];
                    places.0[lane] = s;
                    let own = group * LANES + lane == i;
                    stay &= own && i < before && stations[k] == s;
                    if own {
                        stations[k] = s;
                    }
                }
                if !stay {
                    self.place_section(block, places);
                    for lane in 0..LANES {
                        self.place_pull(block, lane, places.0[lane]);
                    }
                }
            }
        }
        self.stations = stations;
        self.place_ends(solution);
    }

    /// Takes the ends at which elements meet the section law.
    pub(crate) fn place_ends<const S: usize, const M: usize>(&mut self, solution: &Solution<S, M, L>) {
        self.end_places.clear();
        self.end_places.extend_from_slice(solution.directions.ends());
        self.end_sections.clear();
        self.end_cables.clear();
        for b in 0..self.end_places.len() {
            let place = self.end_places[b];
            let node = |lane: usize| place.elements[lane] + place.sides[lane].index();
            let s = Lanes(each(|lane| solution.mesh.nodes()[node(lane)]));
            self.end_sections.push(EndSection { s, stiffness: self.place_four(s).stiffness });
            for c in 0..self.tensions.len() {
                let mut cable = CableAt { offset: self.offset_four(c, s), tension: Lanes::of(0.0) };
                for lane in 0..LANES {
                    let from_left = place.sides[lane] == Side::Right;
                    cable.tension.0[lane] = self.pull_at(c, s.0[lane], from_left);
                }
                self.end_cables.push(cable);
            }
        }
    }

    /// What is left of a unit of the tension of cable `c` at `s` (over L), on the side of it that is said.
    pub(super) fn pull_at(&self, c: usize, s: f64, from_left: bool) -> f64 {
        let runs = if from_left { s <= self.ends[c] + 1e-12 } else { s < self.ends[c] - 1e-12 };
        if runs { self.tension_ratio(c, s, from_left) } else { 0.0 }
    }

    /// Whether strains jump at `s` (over L), where a cable ends.
    pub(crate) fn jumps_at(&self, s: f64) -> bool {
        self.ends.iter().any(|end| *end < 1.0 && (s - end).abs() < 1e-9)
    }

    /// Takes the data at the four stations of a block: all but what is left of the tensions.
    fn place_section(&mut self, block: usize, s: Lanes) {
        self.places[block] = self.place_four(s);
        let cable_count = self.tensions.len();
        for c in 0..cable_count {
            self.cables[block * cable_count + c].offset = self.offset_four(c, s);
        }
    }

    /// Takes what is left of every tension at `s` into a lane of a block, over that at the base.
    pub(crate) fn place_pull(&mut self, block: usize, lane: usize, s: f64) {
        let cable_count = self.tensions.len();
        for c in 0..cable_count {
            let runs = f64::from(u8::from(s <= self.ends[c]));
            let fraction = self.tension_ratio(c, s, true);
            self.cables[block * cable_count + c].tension.0[lane] = runs * fraction;
        }
    }

    /// Takes the arm's sections, and its cables' offsets, at all stations and ends.
    pub(super) fn take_sections(&mut self) {
        for block in 0..self.places.len() {
            let own = each(|lane| self.stations[self.groups.station_in(block, lane)]);
            self.place_section(block, Lanes(own));
        }
        let cable_count = self.tensions.len();
        for b in 0..self.end_places.len() {
            let s = self.end_sections[b].s;
            self.end_sections[b].stiffness = self.place_four(s).stiffness;
            for c in 0..cable_count {
                self.end_cables[b * cable_count + c].offset = self.offset_four(c, s);
            }
        }
    }

    /// Takes what friction leaves of the tensions, at all stations and ends.
    pub(crate) fn take_pulls(&mut self) {
        for block in 0..self.places.len() {
            for lane in 0..LANES {
                let s = self.stations[self.groups.station_in(block, lane)];
                self.place_pull(block, lane, s);
            }
        }
        let cable_count = self.tensions.len();
        for b in 0..self.end_places.len() {
            for c in 0..cable_count {
                for lane in 0..LANES {
                    let (s, side) = (self.end_sections[b].s.0[lane], self.end_places[b].sides[lane]);
                    self.end_cables[b * cable_count + c].tension.0[lane] = self.pull_at(c, s, side == Side::Right);
                }
            }
        }
    }
}

/// The data at `s` (over L), from a radius (m) and its slope, which may carry derivatives, and from the values and
/// slopes of all other profiles there.
#[inline(always)]
pub(crate) fn section_data<R: Real>(
    arm: &Arm,
    units: Units,
    s: R,
    [r, r_slope]: [R; 2],
    at: impl Fn(&Profile) -> [R; 2],
) -> Place<R> {
    let length = units.length;
    let [r_in, _] = at(&arm.inner_radius);
    let four = R::of(4.0);
    let pi = std::f64::consts::PI;
    let area = R::of(pi) * (r * r - r_in * r_in);
    let c = match &arm.material {
        Material::Homogeneous { young, poisson, shear_factor } => {
            // C1 = E, C2 = k G, C3 = E I/A of a ring.
            let square = r * r + r_in * r_in;
            let shear = shear_factor * young / (2.0 * (1.0 + poisson));
            let young = R::of(*young);
            [young, R::of(shear), young * square / four]
        }
        Material::Coefficients { c1, c2, c3 } => [at(c1), at(c2), at(c3)].map(|[value, _]| value),
    };
    // Stiffness in the units: C1 A0 / F, C2 A0 / F, C3 A0 / (F L^2).
    let unit = [1.0 / units.force, 1.0 / units.force, 1.0 / (units.force * length * length)];
    let reference = [at(&arm.reference.nu), at(&arm.reference.eta), at(&arm.reference.mu)];
    let per_length = [1.0, 1.0, length];
    let stiffness = Stiffness {
        value: each(|k| c[k] * area * R::of(unit[k])),
        reference: each(|k| reference[k][0] * R::of(per_length[k])),
        reference_slope: reference[0][1] * R::of(length),
    };
    let load_unit = length / units.force;
    let gravity = arm.gravity.map_or([0.0; 2], |g| {
        let (sin, cos) = g.direction.sin_cos();
        [g.acceleration * cos * load_unit, g.acceleration * sin * load_unit]
    });
    let outline = match arm.cavity {
        Cavity::Flooded => area,
        Cavity::Sealed => R::of(pi) * r * r,
    };
    let body = Body {
        radius: r / R::of(length),
        radius_slope: r_slope,
        wetted: R::of(pi * arm.flow.density) * r * R::of(load_unit),
        weight: gravity.map(|g| R::of(arm.density) * area * R::of(g)),
        displaced: gravity.map(|g| R::of(arm.flow.density) * outline * R::of(g)),
        force: each(|k| at(&arm.distributed.force[k])[0] * R::of(load_unit)),
        couple: at(&arm.distributed.couple)[0] / R::of(units.force),
    };
    Place { s, stiffness, body }
}

/// The same data in four lanes.
#[cfg(test)]
fn in_lanes(place: &Place<f64>) -> Place<Lanes> {
    let Place { s, stiffness, body } = place;
    let of = |v: f64| Lanes::of(v);
    Place {
        s: of(*s),
        stiffness: Stiffness {
            value: stiffness.value.map(of),
            reference: stiffness.reference.map(of),
            reference_slope: of(stiffness.reference_slope),
        },
        body: Body {
            radius: of(body.radius),
            radius_slope: of(body.radius_slope),
            wetted: of(body.wetted),
            weight: body.weight.map(of),
            displaced: body.displaced.map(of),
            force: body.force.map(of),
            couple: of(body.couple),
        },
    }
}

#[cfg(test)]
fn set_lane(out: &mut Place<Lanes>, lane: usize, place: &Place<f64>) {
    let Place { s, stiffness, body } = place;
    out.s.0[lane] = *s;
    for k in 0..3 {
        out.stiffness.value[k].0[lane] = stiffness.value[k];
        out.stiffness.reference[k].0[lane] = stiffness.reference[k];
    }
    out.stiffness.reference_slope.0[lane] = stiffness.reference_slope;
    for k in 0..2 {
        out.body.weight[k].0[lane] = body.weight[k];
        out.body.displaced[k].0[lane] = body.displaced[k];
        out.body.force[k].0[lane] = body.force[k];
    }
    out.body.radius.0[lane] = body.radius;
    out.body.radius_slope.0[lane] = body.radius_slope;
    out.body.wetted.0[lane] = body.wetted;
    out.body.couple.0[lane] = body.couple;
}
