//! Exact derivatives of everything at a station: by the state there, by beta', and by parameters.
//!
//! The same code as that of the slopes runs on numbers that carry derivatives. What the section law leaves implicit, the
//! strains, is one Newton step from the strains found, whose derivatives are exact there. The section law knows the state by
//! the contact force in the directors and the moment alone, so that those and beta' are what numbers are seeded with; what the turn
//! of the section does beside is a rotation.

use hydrostat_bvp::{LANES, Lanes, Real, each};

use super::few::Few;
use super::gradients::slopes;
use super::places::{Place, converted};
use super::strains::Solved;
use super::{Asked, Equations, N, Q};
use crate::arm::Material;
use crate::beta_along::Rule;
use crate::cable::{Offset, tangent};
use crate::dispatch::widest;
use crate::flow::Law;
use crate::loads::{Body, load};
use crate::parameter::Parameter;
use crate::profile::Profile;
use crate::section::{CableAt, Stiffness, apply3, balance, inverse3};
use crate::sensitivity::dual::Dual;
use crate::swelling::{Swelling, swelling};

/// What is differentiated at a station: z', (x, y)', beta, and beta' by the closed form.
pub(crate) const OUT: usize = N + Q + 2;
/// Where in that the rates stand.
pub(crate) const RATE: usize = N;
/// Where beta stands.
pub(crate) const VALUE: usize = N + Q;
/// Where beta' by the closed form stands.
pub(crate) const CLOSED: usize = N + Q + 1;
/// What derivatives at a station are by: the state and beta'.
pub(crate) const BY: usize = N + 1;

/// A place as the equations left it.
#[derive(Clone)]
pub(crate) struct Spot {
    place: Place<f64>,
    /// All cables, with what is left there of a unit of their tensions.
    cables: Vec<CableAt<f64>>,
    z: [f64; N],
    strain: [f64; 3],
    beta: [f64; 2],
}

/// Derivatives at a spot by state and beta'.
#[derive(Clone, Copy)]
pub(crate) struct ByState {
    pub(crate) by: [[f64; BY]; OUT],
    /// (x, y)' themselves.
    pub(crate) rate: [f64; Q],
    /// d beta' (closed form) / d beta''.
    pub(crate) reach: f64,
}

/// How the radius, or the offset of a cable, follows one of its numbers.
struct Geometry {
    /// The number's place among those that are differentiated by.
    way: usize,
    cable: Option<usize>,
    change: Profile,
}

/// Derivatives by what numbers were seeded with, and what it takes to complete them.
struct Raw {
    by: [Lanes; OUT],
    rate: [f64; Q],
    reach: f64,
    direction: [f64; 2],
    contact: [f64; 3],
    force: [f64; 2],
    force_by_theta: [f64; 2],
    /// d beta' by the slopes of the contact force.
    beta_by_force: [f64; 2],
}

impl Equations {
    /// The stations, in order, as the last evaluation left them.
    pub(crate) fn spots(&self) -> Vec<Spot> {
        let count = self.tensions.len();
        let one = |k: usize| {
            let (block, lane) = self.groups.station(k);
            let memory = &self.memory[block];
            let cables = self.cables[block * count..(block + 1) * count].iter();
            Spot {
                place: lane_of(&self.places[block], lane),
                cables: cables.map(|cable| lane_of_cable(cable, lane)).collect(),
                z: memory.z.map(|v| v.0[lane]),
                strain: memory.strain.map(|v| v.0[lane]),
                beta: [self.beta.slope[block].0[lane], self.beta.curvature[block].0[lane]],
            }
        };
        (0..self.stations.len()).map(one).collect()
    }

    /// A place anywhere.
    pub(crate) fn spot_at(&self, asked: &Asked) -> Spot {
        let cables = (0..self.tensions.len()).map(|c| {
            let end = self.cable_end(c);
            let runs = if asked.from_left { asked.s <= end + 1e-12 } else { asked.s < end - 1e-12 };
            CableAt { offset: self.offset(c, asked.s), tension: f64::from(u8::from(runs)), tension_slope: 0.0 }
        });
        Spot {
            place: self.place(asked.s),
            cables: cables.collect(),
            z: asked.z,
            strain: asked.strain,
            beta: asked.beta,
        }
    }

    /// Derivatives by state and beta' at whole loads; those of |tau| of every cable, one after the other, go to the end of `stretch`.
    pub(crate) fn by_state(&self, spots: &[Spot], stretch: &mut Vec<[f64; BY]>) -> Vec<ByState> {
        let mut tangents = Vec::new();
        let raw = self.differentiated(spots, &[], &mut tangents);
        let cables = self.tensions.len();
        for (k, by) in tangents.iter().enumerate() {
            let own = &raw[k / cables];
            stretch.push(own.by_state(by, 0.0));
        }
        raw.iter().map(Raw::complete).collect()
    }

    /// Derivatives by up to four parameters of the section law: tensions, a homogeneous material's and the geometry's.
    pub(crate) fn by_section(
        &self,
        spots: &[Spot],
        parameters: &[Parameter],
        stretch: &mut Vec<Lanes>,
    ) -> Vec<[Lanes; OUT]> {
        self.differentiated(spots, parameters, stretch).into_iter().map(|raw| raw.by).collect()
    }

    /// By the contact force, the moment and beta' where there are no parameters.
    fn differentiated(&self, spots: &[Spot], parameters: &[Parameter], stretch: &mut Vec<Lanes>) -> Vec<Raw> {
        let mut tensions: Vec<Dual> = self.tensions.iter().map(|t| Dual::fixed(*t)).collect();
        let mut shares = [Lanes([0.0; LANES]); 3];
        let mut geometry = Vec::new();
        for (way, parameter) in parameters.iter().enumerate() {
            self.seed(*parameter, way, &mut tensions, &mut shares);
            geometry.extend(self.geometry(*parameter, way));
        }
        let unit = f64::from(u8::from(parameters.is_empty()));
        widest(
            #[inline(always)]
            || {
                let mut out = Vec::with_capacity(spots.len());
                stretch.reserve(spots.len() * tensions.len());
                for spot in spots {
                    out.push(self.differentiated_at(spot, &tensions, &shares, &geometry, unit, stretch));
                }
                out
            },
        )
    }

    #[inline(always)]
    fn differentiated_at(
        &self,
        spot: &Spot,
        tensions: &[Dual],
        shares: &[Lanes; 3],
        geometry: &[Geometry],
        unit: f64,
        stretch: &mut Vec<Lanes>,
    ) -> Raw {
        let [slope, curvature] = spot.beta;
        let along = [Dual::seeded(slope, 3, unit), Dual::fixed(curvature)];
        let mut place = self.place_along(spot, geometry);
        for k in 0..3 {
            for of in [&mut place.stiffness.value[k], &mut place.stiffness.slope[k]] {
                of.by += shares[k] * Lanes::of(of.value);
            }
        }
        let (sin, cos) = spot.z[0].sin_cos();
        let [_, x, y, m] = spot.z;
        let values = [cos * x + sin * y, cos * y - sin * x, m];
        let contact: [Dual; 3] = each(|k| Dual::seeded(values[k], k, unit));
        let direction = [Dual::fixed(cos), Dual::fixed(sin)];
        let pulled = self.pulled_along(spot, tensions, geometry);
        let solved = self.strained_along(&place.stiffness, pulled.as_slice(), contact, spot.strain, along);
        let strain = solved.strain;
        let load = self.load(&place, direction, &solved, along[0]);
        let slopes = slopes(place.body.couple, direction, contact, &solved, &load);
        let [nu, eta, _] = strain;
        let rate = [nu * direction[0] - eta * direction[1], nu * direction[1] + eta * direction[0]];
        let swelling = solved.balance.swelling;
        let mut by = [Lanes([0.0; LANES]); OUT];
        for a in 0..N {
            by[a] = slopes.slope[a].by;
        }
        for q in 0..Q {
            by[RATE + q] = rate[q].by;
        }
        by[VALUE] = swelling.beta.by;
        by[CLOSED] = slopes.beta_slope.by;
        for c in 0..spot.cables.len() {
            let offset = self.offset_along(spot, c, geometry);
            stretch.push(tangent(&offset, strain, &swelling, along[0]).stretch.by);
        }
        let mut less = 0.0;
        for c in 0..3 {
            less += solved.inverse[0][c].value * solved.balance.by_curvature[c].value;
        }
        Raw {
            by,
            rate: rate.map(|v| v.value),
            reach: -(swelling.slope.value * less),
            direction: [cos, sin],
            contact: values,
            force: load.force.map(|v| v.value),
            force_by_theta: load.by_theta.map(|v| v.value),
            beta_by_force: [0, 1].map(|k| swelling.slope.value * solved.inverse[0][k].value),
        }
    }

    /// The cables that pull at a spot, or would with other tensions.
    #[inline(always)]
    fn pulled_along(&self, spot: &Spot, tensions: &[Dual], geometry: &[Geometry]) -> Few<Dual> {
        let mut out = Few::new();
        for (c, (cable, tension)) in spot.cables.iter().zip(tensions).enumerate() {
            if tension.value != 0.0 || tension.by != Lanes([0.0; LANES]) {
                out.push(CableAt {
                    offset: self.offset_along(spot, c, geometry),
                    tension: *tension * Dual::fixed(cable.tension),
                    tension_slope: *tension * Dual::fixed(cable.tension_slope),
                });
            }
        }
        out
    }

    /// The strains that were found, and how they follow: a Newton step from them, whose matrix need not be differentiated where the
    /// rest is nothing.
    #[inline(always)]
    fn strained_along(
        &self,
        stiffness: &Stiffness<Dual>,
        pulled: &[CableAt<Dual>],
        contact: [Dual; 3],
        found: [f64; 3],
        along: [Dual; 2],
    ) -> Solved<Dual> {
        let mut strain = found.map(Dual::fixed);
        let there = balance(self.volume, stiffness, pulled, strain, along);
        let inverse = inverse3(&there.by_strain).0;
        let rest: [Dual; 3] = each(|k| contact[k] - there.carried[k]);
        for k in 0..3 {
            for c in 0..3 {
                strain[k] += Dual::fixed(inverse[k][c].value) * rest[c];
            }
        }
        let balance = balance(self.volume, stiffness, pulled, strain, along);
        let inverse = inverse3(&balance.by_strain).0;
        Solved { strain, balance, inverse, regularity: along[0], step: along[0] }
    }

    /// Lets tensions, or stretch, shear and bending stiffness (over themselves), follow `parameter`.
    fn seed(&self, parameter: Parameter, way: usize, tensions: &mut [Dual], shares: &mut [Lanes; 3]) {
        if let Parameter::Tension(c) = parameter {
            tensions[c].by.0[way] = 1.0 / self.units.force;
            return;
        }
        let (coefficients, per) = match (parameter, &self.arm.material) {
            (Parameter::Young, Material::Homogeneous { young, .. }) => (0..3, 1.0 / young),
            (Parameter::Poisson, Material::Homogeneous { poisson, .. }) => (1..2, -1.0 / (1.0 + poisson)),
            (Parameter::ShearFactor, Material::Homogeneous { shear_factor, .. }) => (1..2, 1.0 / shear_factor),
            (Parameter::Coefficient(k), Material::Coefficients { .. }) => {
                let k = k.min(2);
                (k..k + 1, 1.0 / parameter.of(&self.arm).unwrap_or(f64::INFINITY))
            }
            _ => return,
        };
        for share in &mut shares[coefficients] {
            share.0[way] = per;
        }
    }

    fn geometry(&self, parameter: Parameter, way: usize) -> Option<Geometry> {
        // That the arm has the parameter was checked.
        let (profile, point) = parameter.profile(&self.arm).ok()??;
        let cable = if let Parameter::Offset(c, _) = parameter { Some(c) } else { None };
        Some(Geometry { way, cable, change: profile.by_point(point)? })
    }

    /// The data at a spot, whose radius follows the geometry.
    #[inline(always)]
    fn place_along(&self, spot: &Spot, geometry: &[Geometry]) -> Place<Dual> {
        let place = fixed(&spot.place);
        if geometry.iter().all(|change| change.cable.is_some()) {
            return place;
        }
        let length = self.units.length;
        let s = place.s.value;
        let own = self.arm.radius.at(s * length, length);
        let mut radius = [Dual::fixed(own.value), Dual::fixed(own.slope)];
        for Geometry { way, change, .. } in geometry.iter().filter(|change| change.cable.is_none()) {
            let change = change.at(s * length, length);
            radius[0].by.0[*way] = change.value;
            radius[1].by.0[*way] = change.slope;
        }
        self.place_with(&self.arm, Dual::fixed(s), radius, |profile| {
            let own = profile.at(s * length, length);
            [Dual::fixed(own.value), Dual::fixed(own.slope)]
        })
    }

    /// The offset of cable `c` at a spot, which follows the geometry.
    #[inline(always)]
    fn offset_along(&self, spot: &Spot, c: usize, geometry: &[Geometry]) -> Offset<Dual> {
        let own = &spot.cables[c].offset;
        let [y, slope, curvature] = [own.y, own.slope, own.curvature].map(Dual::fixed);
        let mut offset = Offset { y, slope, curvature };
        let length = self.units.length;
        for Geometry { way, change, .. } in geometry.iter().filter(|change| change.cable == Some(c)) {
            let change = change.at(spot.place.s * length, length);
            offset.y.by.0[*way] = change.value / length;
            offset.slope.by.0[*way] = change.slope;
            offset.curvature.by.0[*way] = change.curvature * length;
        }
        offset
    }

    /// d (length of cable `c` at the reference strains, over L) / d parameter, with the weights of the stages.
    pub(crate) fn reference_length_by(&self, spots: &[Spot], c: usize, parameter: Parameter, weights: &[f64]) -> f64 {
        let Some(geometry) = self.geometry(parameter, 0).filter(|change| change.cable == Some(c)) else { return 0.0 };
        let stages = self.groups.stages;
        let mut sum = 0.0;
        for (k, spot) in spots.iter().enumerate().filter(|(_, spot)| spot.place.s < self.ends[c]) {
            let (group, lane) = (k / stages / LANES, k / stages % LANES);
            let stiffness = fixed(&spot.place).stiffness;
            let swelling = swelling(self.volume, stiffness.reference[0]);
            let slope = swelling.slope * stiffness.reference_slope[0];
            let offset = self.offset_along(spot, c, std::slice::from_ref(&geometry));
            let stretch = tangent(&offset, stiffness.reference, &swelling, slope).stretch;
            sum += self.steps[group].0[lane] * weights[k % stages] * stretch.by.0[0];
        }
        sum
    }

    /// Derivative of the closed-form quantities by a parameter of the loads along the arm: those of stream, gravity and the
    /// densities. At fixed z and beta' strains do not follow them.
    pub(crate) fn by_load(&self, spot: &Spot, parameter: Parameter) -> [f64; OUT] {
        let (sin, cos) = spot.z[0].sin_cos();
        let mut pulled = Few::new();
        for (cable, tension) in spot.cables.iter().zip(&self.tensions) {
            if *tension != 0.0 {
                let (tension, tension_slope) = (cable.tension * tension, cable.tension_slope * tension);
                pulled.push(CableAt { tension, tension_slope, ..*cable });
            }
        }
        let balance = balance(self.volume, &spot.place.stiffness, pulled.as_slice(), spot.strain, spot.beta);
        let (inverse, _) = inverse3(&balance.by_strain);
        let [x, y] = self.force_change(spot, parameter, [cos, sin], &balance.swelling);
        let strain_slope = apply3(&inverse, [-(cos * x + sin * y), sin * x - cos * y, 0.0]);
        let mut out = [0.0; OUT];
        out[1] = -x;
        out[2] = -y;
        out[CLOSED] = balance.swelling.slope * strain_slope[0];
        out
    }

    /// d (force along the arm) / d parameter at fixed strains.
    fn force_change(
        &self,
        spot: &Spot,
        parameter: Parameter,
        direction: [f64; 2],
        swelling: &Swelling<f64>,
    ) -> [f64; 2] {
        let own = &spot.place.body;
        let mut body = Body {
            wetted: 0.0,
            weight: [0.0; 2],
            displaced: [0.0; 2],
            force: [0.0; 2],
            couple: 0.0,
            radius: own.radius,
            radius_slope: own.radius_slope,
        };
        let mut water = self.water;
        let turned = |v: [f64; 2]| [-v[1], v[0]];
        match parameter {
            Parameter::FlowSpeed | Parameter::FlowDirection => body.wetted = own.wetted,
            // Quadratic drag is the sum of what its coefficients do.
            Parameter::DragNormal => (body.wetted, water.law) = (own.wetted, Law::drag(1.0, 0.0)),
            Parameter::DragTangential => (body.wetted, water.law) = (own.wetted, Law::drag(0.0, 1.0)),
            Parameter::GravityDirection => {
                body.weight = turned(own.weight);
                body.displaced = turned(own.displaced);
            }
            Parameter::Density => body.weight = self.per_unit(spot, parameter).weight,
            Parameter::GravityAcceleration => {
                let per_unit = self.per_unit(spot, parameter);
                (body.weight, body.displaced) = (per_unit.weight, per_unit.displaced);
            }
            Parameter::FlowDensity => {
                let per_unit = self.per_unit(spot, parameter);
                (body.wetted, body.displaced) = (per_unit.wetted, per_unit.displaced);
                // The stream of a medium without density is left out; what a little of it would do is not.
                water.stream = self.arm.stream();
            }
            _ => {}
        }
        let load = load(&water, &body, direction, spot.strain, swelling, spot.beta[0]);
        match parameter {
            Parameter::FlowSpeed => {
                // Both laws go with the square of the speed.
                let speed = self.arm.flow.speed;
                let per = if speed == 0.0 { 0.0 } else { 2.0 / speed };
                load.force.map(|f| f * per)
            }
            // Turned together, stream and section turn the load.
            Parameter::FlowDirection => {
                let [x, y] = turned(load.force);
                [x - load.by_theta[0], y - load.by_theta[1]]
            }
            _ => load.force,
        }
    }

    /// The body under a load that is in proportion to `parameter`, where that is one.
    fn per_unit(&self, spot: &Spot, parameter: Parameter) -> Body<f64> {
        let mut body = spot.place.body;
        let value = parameter.of(&self.arm).unwrap_or(0.0);
        if value != 0.0 {
            let per = 1.0 / value;
            body.wetted *= per;
            body.weight = body.weight.map(|v| v * per);
            body.displaced = body.displaced.map(|v| v * per);
            return body;
        }
        let mut arm = self.arm.clone();
        // That the arm has the parameter was checked.
        let _ = parameter.set(&mut arm, 1.0);
        self.place_of(&arm, spot.place.s).body
    }

    /// How beta', beta'' and beta hang together in element `i`.
    pub(crate) fn rule(&self, i: usize) -> Rule<'_> {
        let (group, lane) = (i / LANES, i % LANES);
        self.beta.rule(group, lane, 1.0 / self.steps[group].0[lane])
    }
}

impl Raw {
    /// What is by contact force, moment and beta', and by the turn of the section beside that, as by state and beta'.
    fn by_state(&self, by: &Lanes, turn: f64) -> [f64; BY] {
        let ([cos, sin], [a, b, _], [by_a, by_b, by_m, by_beta]) = (self.direction, self.contact, by.0);
        [turn + b * by_a - a * by_b, cos * by_a - sin * by_b, sin * by_a + cos * by_b, by_m, by_beta]
    }

    fn complete(&self) -> ByState {
        let ([cos, sin], [x, y], [x_turn, y_turn]) = (self.direction, self.force, self.force_by_theta);
        let force_a = cos * x_turn + sin * y_turn - sin * x + cos * y;
        let force_b = cos * y_turn - sin * x_turn - cos * x - sin * y;
        let mut turn = [0.0; OUT];
        turn[1] = -x_turn;
        turn[2] = -y_turn;
        turn[RATE] = -self.rate[1];
        turn[RATE + 1] = self.rate[0];
        turn[CLOSED] = -(self.beta_by_force[0] * force_a + self.beta_by_force[1] * force_b);
        let by = each(|k| self.by_state(&self.by[k], turn[k]));
        ByState { by, rate: self.rate, reach: self.reach }
    }
}

#[inline(always)]
fn fixed(place: &Place<f64>) -> Place<Dual> {
    converted(place, Dual::fixed)
}

fn lane_of_cable(cable: &CableAt<Lanes>, lane: usize) -> CableAt<f64> {
    let of = |v: Lanes| v.0[lane];
    let offset = &cable.offset;
    CableAt {
        offset: Offset { y: of(offset.y), slope: of(offset.slope), curvature: of(offset.curvature) },
        tension: of(cable.tension),
        tension_slope: of(cable.tension_slope),
    }
}

fn lane_of(place: &Place<Lanes>, lane: usize) -> Place<f64> {
    converted(place, |v| v.0[lane])
}
