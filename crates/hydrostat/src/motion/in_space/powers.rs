//! The power of all that acts on an arm that moves in space: as in the plane ([`crate::motion::powers`]), with six
//! strains, omega in the directors and J = J_0 beta^2 diag(2, 1, 1).

use hydrostat_bvp::{Collocation, Lanes, Real, Stage, each};

use super::equations::{COORDINATES, S, SpatialMoving};
use crate::motion::along::{integral, least};
use crate::motion::history::Snapshot;
use crate::motion::works::{Carried, WORKS};
use crate::rod::area_law::{area_derivatives, area_law};
use crate::spatial::equations::{L, M};
use crate::spatial::inertia::{Turn, inertia};
use crate::spatial::loads::{Body, load};
use crate::spatial::rotation::{Directors, Vector, cross, dot, turned_by};
use crate::spatial::section::tangent;

/// A block of stages in motion.
struct Moving {
    directors: Directors<Lanes>,
    /// In the directors.
    omega: Vector<Lanes>,
    velocity: Vector<Lanes>,
    acceleration: Vector<Lanes>,
    stage: Stage<1, L>,
    strain_rate: [Lanes; L],
    beta_slope_rate: Lanes,
}

impl Moving {
    fn of(at: &Snapshot, block: usize) -> Self {
        let [[c1, c2, c3, ..], [v1, v2, v3, velocity @ ..]] = at.stage::<COORDINATES>(block);
        let [_, _, _, acceleration @ ..] = at.second::<COORDINATES>(block);
        let c = [c1, c2, c3];
        let [[inner @ .., closure_slope], [strain_rate @ .., beta_slope_rate]] = at.strains::<{ L + 1 }>(block);
        Self {
            directors: Directors::of(&turned_by(&at.from[block], &c)),
            omega: Turn { c, v: [v1, v2, v3], a: [Lanes::of(0.0); 3] }.rates()[0],
            velocity,
            acceleration,
            stage: Stage { slope: [Lanes::of(0.0)], inner, closure_slope },
            strain_rate,
            beta_slope_rate,
        }
    }

    /// omega . diag(2, 1, 1) omega.
    fn spin(&self) -> Lanes {
        dot(&self.omega, &self.omega) + self.omega[0] * self.omega[0]
    }
}

impl SpatialMoving {
    /// The powers (in the unit of force times L/s) in the motion `at`, which `system` was linearised at and whose base
    /// carries `base`.
    pub(super) fn powers(&self, system: &Collocation<S, M, 0, L>, at: &Snapshot, base: Carried) -> [f64; WORKS] {
        let mut out = integral(system, self.statics.groups, |block| self.density(block, &Moving::of(at, block)));
        let power = |i: usize, carried: &[f64; 6]| {
            let [_, velocity] = at.node_place(i);
            let omega = at.directors(i).to_space(&at.omega(i));
            let both = velocity.into_iter().chain(omega);
            carried.iter().zip(both).map(|(carried, rate)| carried * rate).sum::<f64>()
        };
        let tip = at.layout.nodes - 1;
        let (load, _) = self.statics.tip_load(1.0, &at.directors(tip));
        out[3] += power(tip, &load);
        out[4] -= power(0, &base);
        out
    }

    /// Kinetic energy and that of strain (in the unit of force times L) in the motion `at`.
    pub(super) fn energies(&self, system: &Collocation<S, M, 0, L>, at: &Snapshot) -> [f64; 2] {
        integral(system, self.statics.groups, |block| {
            let own = Moving::of(at, block);
            let masses = &self.masses[block];
            let [area, ..] = area_derivatives(self.statics.volume, own.stage.inner[0]);
            let moving = masses.wall * dot(&own.velocity, &own.velocity) + masses.rotary * area * own.spin();
            [Lanes::of(0.5) * moving, self.statics.strain_energy_of(block, &own.stage.inner)]
        })
    }

    /// The smallest (nu - beta R sqrt(kappa^2 + mu^2))/nu at the stages in the motion `at`, and where over L.
    pub(super) fn fold_margin(&self, at: &Snapshot) -> [f64; 2] {
        least(self.statics.groups, |block| {
            let [[nu, _, _, _, kappa, mu, _], _] = at.strains(block);
            let place = &self.statics.places[block];
            let half_width = area_law(self.statics.volume, nu).beta * place.body.radius;
            let bending = (kappa * kappa + mu * mu).sqrt();
            [Lanes::of(1.0) - half_width * bending / nu, place.s]
        })
    }

    /// Powers per length in a block of stations.
    fn density(&self, block: usize, at: &Moving) -> [Lanes; WORKS] {
        let statics = &self.statics;
        let (place, masses, water) = (&statics.places[block], &self.masses[block], &statics.water);
        let arm = statics.arm();
        let (zero, half) = (Lanes::of(0.0), Lanes::of(0.5));
        let (strain, strain_rate, directors) = (&at.stage.inner, &at.strain_rate, &at.directors);
        let (velocity, length) = (&at.velocity, Lanes::of(statics.units.length));
        let section_stretch = area_law(statics.volume, strain[0]);

        let wet = arm.flow.density != 0.0;
        let stream = wet.then(|| each(|k| Lanes::of(water.stream[k]) - length * velocity[k]));
        let of = |body: &Body<Lanes>| load(water, body, stream, directors, strain, &section_stretch).force;
        let weightless = Body { weight: [zero; 3], displaced: [zero; 3], force: [zero; 3], ..place.body };
        let (all, by_stream, dead) = (of(&place.body), of(&weightless), &place.body.force);
        let acceleration = &at.acceleration;
        let inert =
            inertia(water, masses, directors, strain, &section_stretch, acceleration, &self.stream_acceleration).force;
        let by_water: Vector<Lanes> = each(|k| by_stream[k] - (inert[k] - masses.wall * acceleration[k]));
        let hydrostatic: Vector<Lanes> = each(|k| all[k] - by_stream[k] - dead[k]);

        let [area, area_nu, _] = area_derivatives(statics.volume, strain[0]);
        let (mut dissipated, mut swells) = (zero, -(half * masses.rotary * area_nu * strain_rate[0] * at.spin()));
        for k in 0..L {
            let (stiffness, strained) = (place.stiffness.value[k], strain[k] - place.stiffness.reference[k]);
            dissipated += stiffness * area * strain_rate[k] * strain_rate[k];
            swells += half * stiffness * area_nu * strain_rate[0] * strained * strained;
        }
        let mut by_cables = zero;
        for (c, cable) in statics.cables_in(block).iter().enumerate() {
            let tension = cable.tension * Lanes::of(statics.tension(c));
            let path = tangent(cable, strain, &section_stretch, at.stage.closure_slope);
            let inverse = Lanes::of(1.0) / dot(&path.tau, &path.tau).sqrt();
            let spun = cross(&[strain_rate[3], strain_rate[4], strain_rate[5]], &path.place);
            // What tau changes by with the strains at fixed beta, and with beta and beta' besides.
            let by_force: Vector<Lanes> = each(|k| strain_rate[k] + section_stretch.beta * spun[k]);
            let beta_rate = section_stretch.slope * strain_rate[0];
            let whole: Vector<Lanes> =
                each(|k| by_force[k] + beta_rate * path.by_beta[k] + at.beta_slope_rate * path.place[k]);
            let along = |rate: &Vector<Lanes>| inverse * dot(&path.tau, rate);
            by_cables -= tension * along(&whole);
            swells += tension * (along(&whole) - along(&by_force));
        }
        let omega = directors.to_space(&at.omega);
        [
            by_cables,
            dot(&by_water, velocity),
            dot(&hydrostatic, velocity),
            dot(dead, velocity) + dot(&place.body.couple, &omega),
            zero,
            Lanes::of(arm.dynamics.relaxation_time) * dissipated,
            swells,
        ]
    }
}
