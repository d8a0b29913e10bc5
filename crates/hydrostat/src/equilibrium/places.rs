//! The data of an arm at the stations: sections and cables.

use hydrostat_bvp::{Groups, LANES, Lanes, Mesh, Real, each};

use super::{Equations, Memory, N};
use crate::arm::{Arm, Cavity, Material};
use crate::cable::Offset;
use crate::loads::Body;
use crate::profile::Profile;
use crate::section::{CableAt, Stiffness};

/// One place of the arm as data.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place<R> {
    /// Over L.
    pub(super) s: R,
    pub(super) stiffness: Stiffness<R>,
    pub(super) body: Body<R>,
}

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
            let mut place = converted(&self.place(s.0[0]), Lanes::of);
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

    /// The data at `s` (over L) from a radius (m) and its slope that may carry derivatives, and from what all other profiles
    /// are there, with their slopes.
    #[inline(always)]
    pub(super) fn place_with<R: Real>(
        &self,
        arm: &Arm,
        s: R,
        [r, r_slope]: [R; 2],
        at: impl Fn(&Profile) -> [R; 2],
    ) -> Place<R> {
        let units = self.units;
        let length = units.length;
        let [r_in, r_in_slope] = at(&arm.inner_radius);
        let (zero, two, four) = (R::of(0.0), R::of(2.0), R::of(4.0));
        let pi = std::f64::consts::PI;
        let area = R::of(pi) * (r * r - r_in * r_in);
        let area_slope = R::of(2.0 * pi) * (r * r_slope - r_in * r_in_slope);
        let (c, c_slope) = match &arm.material {
            Material::Homogeneous { young, poisson, shear_factor } => {
                // C1 = E, C2 = k G, C3 = E I/A of a ring.
                let square = r * r + r_in * r_in;
                let square_slope = two * (r * r_slope + r_in * r_in_slope);
                let shear = shear_factor * young / (2.0 * (1.0 + poisson));
                let young = R::of(*young);
                ([young, R::of(shear), young * square / four], [zero, zero, young * square_slope / four])
            }
            Material::Coefficients { c1, c2, c3 } => {
                let c = [at(c1), at(c2), at(c3)];
                (c.map(|[value, _]| value), c.map(|[_, slope]| slope))
            }
        };
        // Stiffness in the units: C1 A0 / F, C2 A0 / F, C3 A0 / (F L^2).
        let unit = [1.0 / units.force, 1.0 / units.force, 1.0 / (units.force * length * length)];
        let reference = [at(&arm.reference.nu), at(&arm.reference.eta), at(&arm.reference.mu)];
        let per_length = [1.0, 1.0, length];
        let stiffness = Stiffness {
            value: each(|k| c[k] * area * R::of(unit[k])),
            slope: each(|k| (c_slope[k] * area + c[k] * area_slope) * R::of(unit[k]) * R::of(length)),
            reference: each(|k| reference[k][0] * R::of(per_length[k])),
            reference_slope: each(|k| reference[k][1] * R::of(per_length[k]) * R::of(length)),
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

    pub(crate) fn offset(&self, cable: usize, s: f64) -> Offset<f64> {
        let length = self.units.length;
        let offset = self.arm.cables[cable].offset.at(s * length, length);
        Offset { y: offset.value / length, slope: offset.slope, curvature: offset.curvature * length }
    }

    /// [`Equations::offset`] at four places.
    #[inline(always)]
    pub(super) fn offset_four(&self, cable: usize, s: Lanes) -> Offset<Lanes> {
        let length = self.units.length;
        let [y, slope, curvature] = self.arm.cables[cable].offset.at_four(s * Lanes::of(length), length);
        Offset { y: y / Lanes::of(length), slope, curvature: curvature * Lanes::of(length) }
    }

    /// Takes a new set of stations, those of `mesh`, with guesses of the strains and of beta'.
    pub(crate) fn place_stations(
        &mut self,
        stations: &[f64],
        mesh: &Mesh,
        guess: impl Fn(usize) -> ([f64; 3], f64, f64),
    ) {
        let stages = self.groups.stages;
        let groups = Groups { elements: mesh.elements(), stages };
        let blocks = groups.count() * stages;
        let zero = Lanes::of(0.0);
        let cable_count = self.tensions.len();
        let before = std::mem::replace(&mut self.groups, groups).elements;
        let memory = Memory {
            z: [zero; N],
            strain: [zero; 3],
            by_state: [[zero; N]; 3],
            beta_slope: zero,
            by_beta_slope: [zero; 3],
        };
        self.memory.clear();
        self.memory.resize(blocks, memory);
        if self.places.len() < blocks {
            let blank = self.place_four(Lanes::of(stations[0]));
            self.places.resize(blocks, blank);
        }
        self.places.truncate(blocks);
        self.cables.resize(blocks * cable_count, blank_cable());
        self.steps.resize(groups.count(), zero);
        self.beta.resize(blocks);
        self.switches.resize(blocks, [zero; 3]);
        self.strain_slopes.resize(blocks, [zero; 3]);
        self.drifts.resize(blocks, [zero; N]);
        for group in 0..groups.count() {
            for lane in 0..LANES {
                self.steps[group].0[lane] = mesh.step(groups.element(group, lane));
            }
            for j in 0..stages {
                let block = group * stages + j;
                let mut places = zero;
                // Stations that stay where they were keep their data.
                let mut stay = true;
                for lane in 0..LANES {
                    let i = groups.element(group, lane);
                    let k = i * stages + j;
                    let (strain, slope, curvature) = guess(k);
                    for a in 0..3 {
                        self.memory[block].strain[a].0[lane] = strain[a];
                    }
                    self.beta.start(block, lane, slope, curvature);
                    places.0[lane] = stations[k];
                    let own = group * LANES + lane == i && i < before;
                    stay &= own && self.stations[k] == stations[k];
                }
                if !stay {
                    self.place_section(block, places);
                    for lane in 0..LANES {
                        self.place_pull(block, lane, places.0[lane]);
                    }
                }
            }
        }
        self.stations.clear();
        self.stations.extend_from_slice(stations);
        // Where a cable ends strains jump.
        let ends = &self.ends;
        let jumps = |i: &usize| ends.iter().any(|end| *end < 1.0 && (mesh.nodes()[i + 1] - end).abs() < 1e-9);
        self.beta.take_jumps((0..mesh.elements()).filter(jumps));
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
            let share = self.pull_share(c, s, true);
            let at = &mut self.cables[block * cable_count + c];
            at.tension.0[lane] = runs * share.value;
            at.tension_slope.0[lane] = runs * share.slope;
        }
    }

    /// Takes the arm's sections, and its cables' offsets, at all stations.
    pub(super) fn take_sections(&mut self) {
        for block in 0..self.places.len() {
            let own = each(|lane| self.stations[self.groups.station_in(block, lane)]);
            self.place_section(block, Lanes(own));
        }
    }
}

#[inline(always)]
pub(super) fn blank_cable() -> CableAt<Lanes> {
    let zero = Lanes([0.0; LANES]);
    CableAt { offset: Offset { y: zero, slope: zero, curvature: zero }, tension: zero, tension_slope: zero }
}

/// The same data in other numbers.
#[inline(always)]
pub(super) fn converted<A: Copy, B>(place: &Place<A>, number: impl Fn(A) -> B) -> Place<B> {
    let Place { s, stiffness, body } = place;
    Place {
        s: number(*s),
        stiffness: Stiffness {
            value: stiffness.value.map(&number),
            slope: stiffness.slope.map(&number),
            reference: stiffness.reference.map(&number),
            reference_slope: stiffness.reference_slope.map(&number),
        },
        body: Body {
            radius: number(body.radius),
            radius_slope: number(body.radius_slope),
            wetted: number(body.wetted),
            weight: body.weight.map(&number),
            displaced: body.displaced.map(&number),
            force: body.force.map(&number),
            couple: number(body.couple),
        },
    }
}

#[cfg(test)]
fn set_lane(out: &mut Place<Lanes>, lane: usize, place: &Place<f64>) {
    let Place { s, stiffness, body } = place;
    out.s.0[lane] = *s;
    for k in 0..3 {
        out.stiffness.value[k].0[lane] = stiffness.value[k];
        out.stiffness.slope[k].0[lane] = stiffness.slope[k];
        out.stiffness.reference[k].0[lane] = stiffness.reference[k];
        out.stiffness.reference_slope[k].0[lane] = stiffness.reference_slope[k];
    }
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
