//! The data of an arm in space at the stations: sections and cables.

use hydrostat_bvp::{Gauss, LANES, Lanes, Real, Side, Solution, each};

use super::equations::{Equations, L};
use super::loads::Body;
use super::place::Place;
use super::section::{CableAt, Stiffness};
use crate::rod::arm::{Cable, Material};
use crate::rod::profile::Profile;
use crate::statics::equations::section_data;

impl Equations {
    /// Data at `s` (over L).
    pub(super) fn place(&self, s: f64) -> Place<f64> {
        let length = self.units.length;
        self.place_with(s, |profile| {
            let own = profile.at(s * length, length);
            [own.value, own.slope]
        })
    }

    /// Data at four places side by side.
    #[inline(always)]
    pub(super) fn place_four(&self, s: Lanes) -> Place<Lanes> {
        let length = self.units.length;
        let along = s * Lanes::of(length);
        self.place_with(s, |profile| {
            let [value, slope, _] = profile.at_four(along, length);
            [value, slope]
        })
    }

    #[inline(always)]
    fn place_with<R: Real>(&self, s: R, at: impl Fn(&Profile) -> [R; 2]) -> Place<R> {
        let (units, arm, space) = (self.units, &self.arm, &self.space);
        // Of this arm gravity lies along e1, so that weights along e1 are their sizes.
        let plane = section_data(&self.upright, units, s, at(&arm.radius), &at);
        let [c1, c2, c3] = plane.stiffness.value;
        let [nu, eta, mu] = plane.stiffness.reference;
        let length = R::of(units.length);
        let [r, inner] = [at(&arm.radius)[0], at(&arm.inner_radius)[0]];
        let square = r * r + inner * inner;
        let unit = R::of(1.0 / (units.force * units.length * units.length));
        let c4 = match (&space.c4, &arm.material) {
            (Some(c4), _) => at(c4)[0] * R::of(std::f64::consts::PI) * (r * r - inner * inner) * unit,
            // G J of a ring: no shear factor.
            (None, Material::Homogeneous { young, poisson, .. }) => {
                let shear = R::of(young / (2.0 * (1.0 + poisson)) * std::f64::consts::PI);
                shear * (r * r - inner * inner) * square * R::of(0.5) * unit
            }
            (None, Material::Coefficients { .. }) => c2 * square * R::of(0.5 / (units.length * units.length)),
        };

        let zeta = at(&space.zeta)[0];
        let [tau, kappa] = [&space.tau, &space.kappa].map(|profile| at(profile)[0] * length);
        let [weight, displaced] = [plane.body.weight[0], plane.body.displaced[0]];
        let along: [R; 3] = self.gravity.map(R::of);
        let [f1, f2] = plane.body.force;
        let f3 = at(&space.force)[0] * R::of(units.length / units.force);
        let [m1, m2] = [&space.couple[0], &space.couple[1]].map(|profile| at(profile)[0] * R::of(1.0 / units.force));
        Place {
            s,
            stiffness: Stiffness { value: [c1, c2, c2, c4, c3, c3], reference: [nu, eta, zeta, tau, kappa, mu] },
            reference_slope: plane.stiffness.reference_slope,
            body: Body {
                radius: plane.body.radius,
                wetted: plane.body.wetted,
                weight: each(|k| weight * along[k]),
                displaced: each(|k| displaced * along[k]),
                force: [f1, f2, f3],
                couple: [m1, m2, plane.body.couple],
            },
        }
    }

    /// Cable `c` at four places, with no tension.
    #[inline(always)]
    pub(super) fn cable_four(&self, c: usize, s: Lanes) -> CableAt<Lanes> {
        let mut out: CableAt<Lanes> = CableAt::default();
        for lane in 0..LANES {
            let own = self.cable(c, s.0[lane]);
            (out.y.0[lane], out.z.0[lane]) = (own.y, own.z);
            (out.y_slope.0[lane], out.z_slope.0[lane]) = (own.y_slope, own.z_slope);
        }
        out
    }

    /// Cable `c` at `s` (over L), with no tension.
    pub(super) fn cable(&self, c: usize, s: f64) -> CableAt<f64> {
        let length = self.units.length;
        place_of(&self.arm.cables[c], s * length, length)
    }

    /// Takes the stations and ends of a solution's mesh.
    pub(crate) fn place_on<const S: usize, const M: usize>(&mut self, gauss: &Gauss<M>, solution: &Solution<S, M, L>) {
        let mesh = &solution.mesh;
        let groups = solution.groups();
        let count = self.tensions.len();
        self.groups = groups;
        self.stations.clear();
        self.places.clear();
        self.cables.clear();
        self.stations.resize(groups.elements * M, 0.0);
        for group in 0..groups.count() {
            for j in 0..M {
                let mut s = Lanes::of(0.0);
                for lane in 0..LANES {
                    let i = groups.element(group, lane);
                    s.0[lane] = mesh.nodes()[i] + mesh.step(i) * gauss.c[j];
                    self.stations[i * M + j] = s.0[lane];
                }
                self.places.push(self.place_four(s));
                for c in 0..count {
                    let mut cable = self.cable_four(c, s);
                    cable.tension = s.map(|s| f64::from(u8::from(s <= self.ends[c])));
                    self.cables.push(cable);
                }
            }
        }
        self.place_ends(solution);
    }

    /// Takes the ends at which elements meet the section law.
    pub(crate) fn place_ends<const S: usize, const M: usize>(&mut self, solution: &Solution<S, M, L>) {
        self.end_sections.clear();
        self.end_cables.clear();
        for place in solution.directions.ends() {
            let node = |lane: usize| place.elements[lane] + place.sides[lane].index();
            let s = Lanes(each(|lane| solution.mesh.nodes()[node(lane)]));
            self.end_sections.push((s, self.place_four(s).stiffness));
            for c in 0..self.tensions.len() {
                let mut cable = self.cable_four(c, s);
                for lane in 0..LANES {
                    let runs = self.runs_at(c, s.0[lane], place.sides[lane] == Side::Right);
                    cable.tension.0[lane] = f64::from(u8::from(runs));
                }
                self.end_cables.push(cable);
            }
        }
    }

    /// Whether cable `c` still runs at `s` (over L), on the side of it that is said.
    pub(super) fn runs_at(&self, c: usize, s: f64, from_left: bool) -> bool {
        if from_left { s <= self.ends[c] + 1e-12 } else { s < self.ends[c] - 1e-12 }
    }

    /// Whether strains jump at `s` (over L), where a cable ends.
    pub(crate) fn jumps_at(&self, s: f64) -> bool {
        self.ends.iter().any(|end| *end < 1.0 && (s - end).abs() < 1e-9)
    }
}

/// y = o cos phi and z = o sin phi over L with their slopes, at `s` (m).
fn place_of(cable: &Cable, s: f64, length: f64) -> CableAt<f64> {
    let (offset, angle) = (cable.offset.at(s, length), cable.angle.at(s, length));
    let (sin, cos) = angle.value.sin_cos();
    CableAt {
        y: offset.value * cos / length,
        z: offset.value * sin / length,
        y_slope: offset.slope * cos - offset.value * sin * angle.slope,
        z_slope: offset.slope * sin + offset.value * cos * angle.slope,
        tension: 0.0,
    }
}
