//! The power of all that acts on a moving arm.
//!
//! With e the strains, W = 1/2 sum C_k A (e_k - e_ok)^2 and J = J_0 beta^2, the equations of motion say
//!
//! ```text
//! d/dt (kinetic + int W) = int ((f - f_a) . r. + couple omega) + tip load on r., omega
//!                          - n_f(0) . r.(0) - m_f(0) omega(0)
//!                          - int sum T |tau|.  - t_v int sum C_k A e_k.^2  + volume
//! volume = int (1/2 sum C_k A' nu. (e_k - e_ok)^2 - 1/2 J. omega^2 + sum T (|tau|. - its part by e.))
//! ```
//!
//! where the last line is what sections that swell take part in without a force of the model.

use hydrostat_bvp::{Collocation, Lanes, Real, Station, each};

use super::along::{integral, least};
use super::dimensions::S;
use super::equations::Moving;
use super::history::Snapshot;
use super::works::{Carried, WORKS};
use crate::numerics::sincos::sin_cos;
use crate::rod::area_law::{area_derivatives, area_law};
use crate::rod::inertia::inertia;
use crate::rod::loads::{Body, centreline, dot, load};
use crate::statics::dimensions::{L, M, N};

impl Moving {
    /// The powers (in the unit of force times L/s) in the motion `at`, which `system` was linearised at and whose base
    /// carries `base`.
    pub(super) fn powers(&self, system: &Collocation<S, M, 0, L>, at: &Snapshot, base: Carried) -> [f64; WORKS] {
        let mut out = integral(system, self.statics.groups, |block| self.density(block, at));
        let tip = at.layout.nodes - 1;
        let ([theta, _, _], [omega, vx, vy]) = (at.node(tip), at.node_rate(tip));
        let ([x, y, moment], _) = self.statics.tip_load(theta);
        out[3] += x * vx + y * vy + moment * omega;
        let [omega, vx, vy] = at.node_rate(0);
        out[4] -= base[0] * vx + base[1] * vy + base[5] * omega;
        out
    }

    /// Kinetic energy and that of strain (in the unit of force times L) in the motion `at`.
    pub(super) fn energies(&self, system: &Collocation<S, M, 0, L>, at: &Snapshot) -> [f64; 2] {
        integral(system, self.statics.groups, |block| {
            let ([_, [omega, vx, vy]], [[nu, eta, mu, slope], _]) = (at.stage(block), at.strains(block));
            let station = Station { z: [Lanes::of(0.0); N], inner: [nu, eta, mu], closure_slope: slope };
            let masses = &self.masses[block];
            let [area, ..] = area_derivatives(self.statics.volume, nu);
            let moving = masses.wall * (vx * vx + vy * vy) + masses.rotary * area * omega * omega;
            [Lanes::of(0.5) * moving, self.statics.strain_energy(block, &station)]
        })
    }

    /// The smallest (nu - beta R |mu|)/nu at the stages in the motion `at`, and where over L: at or below zero the
    /// surface folds.
    pub(super) fn fold_margin(&self, at: &Snapshot) -> [f64; 2] {
        least(self.statics.groups, |block| {
            let [[nu, _, mu, _], _] = at.strains(block);
            let place = &self.statics.places[block];
            let half_width = area_law(self.statics.volume, nu).beta * place.body.radius;
            [Lanes::of(1.0) - half_width * mu.abs() / nu, place.s]
        })
    }

    /// Powers per length in a block of stations.
    fn density(&self, block: usize, at: &Snapshot) -> [Lanes; WORKS] {
        let (place, masses, water) = (&self.statics.places[block], &self.masses[block], &self.statics.water);
        let arm = self.statics.arm();
        let (zero, half) = (Lanes::of(0.0), Lanes::of(0.5));
        let [[theta, _, _], [omega, vx, vy]] = at.stage(block);
        let [_, x_rate, y_rate] = at.second(block);
        let acceleration = [x_rate, y_rate];
        let [[nu, eta, mu, beta_slope], [nu_rate, eta_rate, mu_rate, beta_slope_rate]] = at.strains(block);
        let (strain, strain_rate) = ([nu, eta, mu], [nu_rate, eta_rate, mu_rate]);
        let (velocity, length) = ([vx, vy], Lanes::of(self.statics.units.length));
        let (sin, cos) = sin_cos(theta);
        let section_stretch = area_law(self.statics.volume, nu);

        let wet = arm.flow.density != 0.0;
        let stream = wet.then(|| each(|k| Lanes::of(water.stream[k]) - length * velocity[k]));
        let of = |body: &Body<Lanes>| load(water, body, stream, [cos, sin], strain, &section_stretch, beta_slope).force;
        let weightless = Body { weight: [zero; 2], displaced: [zero; 2], force: [zero; 2], ..place.body };
        let (all, by_stream) = (of(&place.body), of(&weightless));
        let dead = place.body.force;
        let along = centreline([cos, sin], [nu, eta]);
        let still = self.stream_acceleration.map(|v| v / self.statics.units.length);
        let inert = inertia(water, masses, &along, nu, &section_stretch, acceleration, still).force;
        let by_water: [Lanes; 2] = each(|k| by_stream[k] - (inert[k] - masses.wall * acceleration[k]));
        let hydrostatic: [Lanes; 2] = each(|k| all[k] - by_stream[k] - dead[k]);

        let [area, area_nu, _] = area_derivatives(self.statics.volume, nu);
        let (mut dissipated, mut swelling) = (zero, -(half * masses.rotary * area_nu * nu_rate * omega * omega));
        for k in 0..3 {
            let (stiffness, strained) = (place.stiffness.value[k], strain[k] - place.stiffness.reference[k]);
            dissipated += stiffness * area * strain_rate[k] * strain_rate[k];
            swelling += half * stiffness * area_nu * nu_rate * strained * strained;
        }
        let station = Station { z: [zero; N], inner: strain, closure_slope: beta_slope };
        let mut by_cables = zero;
        for (c, cable) in self.statics.cables_in(block).iter().enumerate() {
            let tension = cable.tension * Lanes::of(self.statics.tension(c));
            let (by_strain, by_beta_slope) = self.statics.stretch_gradient(c, block, &station);
            let mut stretching = by_beta_slope * beta_slope_rate;
            for k in 0..3 {
                stretching += by_strain[k] * strain_rate[k];
            }
            let tangent = self.statics.cable_tangent(c, block, &station);
            let arm = cable.offset.y * section_stretch.beta;
            let by_force = tangent.a * (nu_rate - arm * mu_rate) + tangent.b * eta_rate;
            by_cables -= tension * stretching;
            swelling += tension * (stretching - by_force);
        }
        [
            by_cables,
            dot(by_water, velocity),
            dot(hydrostatic, velocity),
            dot(dead, velocity) + place.body.couple * omega,
            zero,
            Lanes::of(arm.dynamics.relaxation_time) * dissipated,
            swelling,
        ]
    }
}
