//! The boundary-value problem of one stage in time.
//!
//! ```text
//! theta' = mu                 n_f' = -f(U - r.) + rho_arm A_m r.. + f_a
//! r' = nu a + eta b           m_f' = -(r' x n_f) . k - couple + d/dt (J omega)
//! ```
//!
//! with r. = cv r + hv, r.. = cv r. + ha and so on, see [`super`]. States are (theta, n_f, m_f, x, y), the first four
//! those of the statics; lengths are in L, forces in the static unit, times in s.

use hydrostat_bvp::{
    Collocation, Condition, EndPlace, Forcing, Gauss, Groups, Inner, Lanes, Local, Problem, Real, StageForcing,
    Station, each,
};

use super::dimensions::{S, Shape, X};
use super::history::{History, Layout};
use super::relaxation::stiffened;
use super::start::force_unit;
use crate::numerics::dispatch::each_block;
use crate::numerics::sincos::sin_cos;
use crate::rod::area_law::{SectionStretch, area_law};
use crate::rod::arm::Arm;
use crate::rod::cable::pull;
use crate::rod::cable_list::CableList;
use crate::rod::inertia::{Masses, inertia, turning};
use crate::rod::loads::{Load, centreline, load};
use crate::rod::model_options::{FlowSurface, Volume};
use crate::rod::profile::Profile;
use crate::rod::section::{CableAt, Stiffness};
use crate::statics::dimensions::{L, M, N};
use crate::statics::equations::gradients::{by_strain_change, in_directors, jacobian, rate_gradient, strain_by_state};
use crate::statics::equations::place::Place;
use crate::statics::equations::{Equations, SectionFailure, failure, inner};

/// Equations of a moving arm at one time.
#[derive(Debug, Clone)]
pub(super) struct Moving {
    /// Data along the arm, loads at this time.
    pub(super) statics: Equations,
    /// Acceleration of the stream, m/s2.
    pub(super) stream_acceleration: [f64; 2],
    pub(super) masses: Vec<Masses<Lanes>>,
    /// d rate / d value, 1/s; zero at rest.
    pub(super) cv: f64,
    /// What rates start from.
    pub(super) history: History,
    /// Strain rates at ends of elements, less cv times the strains.
    end_rates: Vec<[Lanes; L]>,
    closed: bool,
    nodes: usize,
    /// Sizes of the states: what a solution holds, times these, is the state.
    pub(super) scales: [f64; S],
}

impl Moving {
    pub(super) fn new(arm: &Arm) -> Self {
        let mut statics = Equations::new(arm, M).leaving(1e-4);
        statics.set_force_unit(force_unit(arm));
        let lateral = arm.model.flow_surface == FlowSurface::Lateral && arm.flow.density != 0.0;
        Self {
            statics,
            stream_acceleration: [0.0; 2],
            masses: Vec::new(),
            cv: 0.0,
            history: History::default(),
            end_rates: Vec::new(),
            nodes: 0,
            scales: [1.0; S],
            closed: arm.model.volume != Volume::None && (!arm.cables.is_empty() || lateral),
        }
    }

    /// Takes stations, ends and masses of a solution's mesh.
    pub(super) fn place_on(&mut self, gauss: &Gauss<M>, solution: &Shape) {
        self.statics.place_on(gauss, solution);
        let (arm, unit) = (self.statics.arm(), self.statics.units);
        self.masses = self
            .statics
            .places
            .iter()
            .map(|place| {
                let at = |profile: &Profile| profile.at_four(place.s * Lanes::of(unit.length), unit.length)[0];
                Masses::new(arm, unit.force, at)
            })
            .collect();
        self.nodes = solution.nodes.len();
        self.history.set_layout(self.layout());
    }

    pub(super) fn layout(&self) -> Layout {
        Layout { blocks: self.masses.len(), nodes: self.nodes, turns: 1, places: 2, strains: L }
    }

    /// Takes the loads of `arm`, which has the same sections, and the acceleration of its stream.
    pub(super) fn set_loads(&mut self, arm: &Arm, stream_acceleration: [f64; 2]) {
        self.stream_acceleration = if arm.dynamics.inertia { stream_acceleration } else { [0.0; 2] };
        // Tensions of held cables follow from their strokes.
        let stroke_control = self.statics.stroke_control.iter().flat_map(|stroke_control| stroke_control.cables.iter());
        let stroke_control: Vec<(usize, f64)> =
            stroke_control.map(|c| (*c, self.statics.arm().cables[*c].tension)).collect();
        self.statics.set_loads(arm);
        for (cable, tension) in stroke_control {
            self.statics.set_tension(cable, tension);
        }
    }

    /// Takes what strain rates at the ends start from.
    pub(super) fn set_end_rates(&mut self, gauss: &Gauss<M>) {
        self.end_rates.clear();
        if self.statics.arm().dynamics.relaxation_time > 0.0 {
            let ends = &self.statics.end_places;
            self.end_rates.extend(self.history.end_rates(self.cv, gauss, self.statics.groups, ends));
        }
    }

    /// The section law of a material with memory of rate, given what strain rates are beside cv times the strains.
    #[inline(always)]
    fn stiffened(&self, stiffness: &Stiffness<Lanes>, rates: &[Lanes; L]) -> Stiffness<Lanes> {
        let time = self.statics.arm().dynamics.relaxation_time;
        let [value, reference] = stiffened([&stiffness.value, &stiffness.reference], rates, time, self.cv);
        Stiffness { value, reference, reference_slope: stiffness.reference_slope }
    }

    /// What acts along the arm at a station, inertia among it, as a load whose force is -n_f'; its derivative by (x,
    /// y); and the couple of inertia with its derivatives by theta and nu.
    #[inline(always)]
    fn loads(
        &self,
        block: usize,
        station: &Station<S, L>,
        direction: [Lanes; 2],
        strain: [Lanes; 3],
        section_stretch: &SectionStretch<Lanes>,
    ) -> (Load<Lanes>, [[Lanes; 2]; 2], [Lanes; 3]) {
        let (place, masses) = (&self.places()[block], &self.masses[block]);
        let (arm, water) = (self.statics.arm(), &self.statics.water);
        let cv = Lanes::of(self.cv);
        let of = |k: usize, z: Lanes| self.history.rates_of(self.cv, block, k, z);
        let [omega, omega_rate] = of(0, station.z[0]);
        let [x, y] = [of(1, station.z[X]), of(2, station.z[X + 1])];
        let length = Lanes::of(self.statics.units.length);
        let wet = arm.flow.density != 0.0;
        let against = [x[0], y[0]];
        let stream = wet.then(|| each(|k| Lanes::of(water.stream[k]) - length * against[k]));
        let [nu, eta, _] = strain;
        let mut out = load(water, &place.body, stream, direction, strain, section_stretch, station.closure_slope);
        let along = centreline(direction, [nu, eta]);
        let unit = 1.0 / self.statics.units.length;
        let still = self.stream_acceleration.map(|v| v * unit);
        let inert = inertia(water, masses, &along, nu, section_stretch, [x[1], y[1]], still);
        let nu_rate = cv * (nu - self.history.strain(block, 0));
        let turn = turning(self.statics.volume, masses, [nu, nu_rate], [omega, omega_rate]);
        let by_place = each(|k| each(|c| cv * (-(length * out.by_stream[k][c]) - cv * inert.by_acceleration[k][c])));
        for k in 0..2 {
            out.force[k] -= inert.force[k];
            out.by_theta[k] -= inert.by_theta[k];
            for c in 0..3 {
                out.by_strain[k][c] -= inert.by_strain[k][c];
            }
        }
        let [by_omega_rate, by_omega, by_nu, by_nu_rate] = turn.by;
        (out, by_place, [turn.couple, cv * (cv * by_omega_rate + by_omega), by_nu + cv * by_nu_rate])
    }

    /// What a change of what sections carry, in a block of stations, changes at fixed states: the strains follow, and
    /// with them the slopes.
    pub(super) fn stage_forcing(
        &self,
        block: usize,
        given: &Station<S, L>,
        local: &Local<S, 0, L, Lanes>,
        carried: [Lanes; 3],
    ) -> StageForcing<S, 0, L> {
        let station = self.unscaled(given);
        let (sin, cos) = sin_cos(station.z[0]);
        let direction = [cos, sin];
        let contact = in_directors(direction, &each(|a| station.z[a]));
        let strain = self.follow(&local.inner, direction, carried);
        let section_stretch = area_law(self.statics.volume, station.inner[0]);
        let (load, _, [_, _, inert_by_nu]) = self.loads(block, &station, direction, station.inner, &section_stretch);
        let [a, b, c, d] = by_strain_change(&load, contact, strain);
        let [nu, eta, _] = strain;
        let slope = [a, b, c, d + inert_by_nu * nu, nu * cos - eta * sin, nu * sin + eta * cos];
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
        carried: [Lanes; 3],
    ) -> ([Lanes; L], Lanes) {
        let (sin, cos) = sin_cos(given.z[0]);
        let strain = self.follow(inner, [cos, sin], carried);
        (strain, area_law(self.statics.volume, given.inner[0]).slope * strain[0])
    }

    /// The strains that follow so much more of what a section carries, at a fixed state: those of that much less of
    /// contact force and moment, whose derivatives the section law's gradient has.
    fn follow(&self, inner: &Inner<S, L, Lanes>, [cos, sin]: [Lanes; 2], carried: [Lanes; 3]) -> [Lanes; L] {
        each(|k| {
            let by: [Lanes; 3] = each(|c| Lanes::of(1.0 / self.scales[c + 1]) * inner.gradient[k][c + 1]);
            let [x, y, m] = by;
            -((cos * x + sin * y) * carried[0] + (cos * y - sin * x) * carried[1] + m * carried[2])
        })
    }

    /// What changes with a unit of the tension of cable `c` (in the unit of force), into `out`.
    pub(super) fn pull_by(&self, c: usize, system: &Collocation<S, M, 0, L>, out: &mut Forcing<S, 0, L>) {
        let statics = &self.statics;
        let count = statics.tensions.len();
        let carried = |cable: &CableAt<Lanes>, station: &Station<S, L>| {
            let section_stretch = area_law(statics.volume, station.inner[0]);
            pull(cable.tension, &cable.offset, station.inner, &section_stretch, station.closure_slope).0.load
        };
        out.stages.clear();
        for (block, (station, local)) in system.stations().iter().zip(system.locals()).enumerate() {
            let own = carried(&statics.cables_in(block)[c], station);
            out.stages.push(self.stage_forcing(block, station, local, own));
        }
        out.ends.clear();
        for (b, (station, inner)) in system.end_stations().iter().zip(system.ends()).enumerate() {
            let own = carried(&statics.end_cables[b * count + c], station);
            out.ends.push(self.end_forcing(station, inner, own));
        }
    }

    /// See [`super::settling::Moves::drag_change`].
    pub(super) fn drag_change(&self) -> f64 {
        let water = &self.statics.water;
        if self.statics.arm().flow.density == 0.0 {
            return 0.0;
        }
        let length = self.statics.units.length;
        let [_, vx, vy] = self.history.last_rate();
        let speed = (water.stream[0] - length * vx).hypot(water.stream[1] - length * vy);
        self.cv * length / speed.max(1e-6 * length)
    }

    /// A station with the states themselves.
    #[inline(always)]
    fn unscaled(&self, station: &Station<S, L>) -> Station<S, L> {
        Station { z: each(|a| Lanes::of(self.scales[a]) * station.z[a]), ..*station }
    }

    /// Gradients by the states as gradients by what a solution holds.
    #[inline(always)]
    fn scale_inner(&self, inner: &mut Inner<S, L, Lanes>) {
        for a in 0..S {
            let own = Lanes::of(self.scales[a]);
            inner.value_gradient[a] = own * inner.value_gradient[a];
            for k in 0..L {
                inner.gradient[k][a] = own * inner.gradient[k][a];
            }
        }
    }

    #[inline(always)]
    fn places(&self) -> &[Place<Lanes>] {
        &self.statics.places
    }

    /// The stations of a block.
    #[inline(always)]
    fn block(
        &self,
        block: usize,
        given: &mut Station<S, L>,
        pulled: &mut CableList<Lanes>,
        out: &mut Local<S, 0, L, Lanes>,
    ) -> Result<(), SectionFailure> {
        let statics = &self.statics;
        let place = &statics.places[block];
        let station = &self.unscaled(given);
        statics.pulled_in(statics.cables_in(block), pulled);
        let tolerance = statics.inner_tolerance;
        let stiffness = self.stiffened(&place.stiffness, &self.history.strain_rates(self.cv, block));
        let (direction, contact, solved) = statics.solved(&stiffness, station, pulled);
        if !solved.is_solved(tolerance) {
            return Err(failure(place.s, &solved, tolerance));
        }
        let [cos, sin] = direction;
        let [nu, eta, mu] = solved.strain;
        let (load, by_place, [inert, inert_by_theta, inert_by_nu]) =
            self.loads(block, station, direction, solved.strain, &solved.balance.section_stretch);
        let by_state = strain_by_state(&solved.inverse, direction, contact);
        let rates = |[nu, eta, _]: [Lanes; 3]| [nu * cos - eta * sin, nu * sin + eta * cos];
        let rate = rates(solved.strain);
        let zero = Lanes::of(0.0);

        // With the step of the strains, to first order.
        let by_change = by_strain_change(&load, contact, solved.change);
        let rate_change = rates(solved.change);
        let couple = eta * contact[0] - nu * contact[1] - place.body.couple + inert;
        out.slope = [
            mu + by_change[0],
            by_change[1] - load.force[0],
            by_change[2] - load.force[1],
            couple + by_change[3] + inert_by_nu * solved.change[0],
            rate[0] + rate_change[0],
            rate[1] + rate_change[1],
        ];
        let by_own = jacobian(direction, contact, &solved, &load, &by_state);
        let by_rate = rate_gradient(direction, rate, &by_state);
        out.jacobian = [[zero; S]; S];
        for a in 0..N {
            for b in 0..N {
                out.jacobian[a][b] = by_own[a][b];
            }
            out.jacobian[3][a] += inert_by_nu * by_state[0][a];
        }
        out.jacobian[3][0] += inert_by_theta;
        for q in 0..2 {
            for b in 0..N {
                out.jacobian[X + q][b] = by_rate[q][b];
            }
            for c in 0..2 {
                out.jacobian[1 + q][X + c] = -by_place[q][c];
            }
        }
        out.inner = inner(&solved, each(|k| wide(by_state[k])));
        let by_closure = out.inner.by_closure;
        let own = by_strain_change(&load, contact, by_closure);
        let moved = rates(by_closure);
        out.by_closure = [
            own[0],
            own[1] - load.by_beta_slope[0],
            own[2] - load.by_beta_slope[1],
            own[3] + inert_by_nu * by_closure[0],
            moved[0],
            moved[1],
        ];
        for a in 0..S {
            let [own, inverse] = [self.scales[a], 1.0 / self.scales[a]].map(Lanes::of);
            out.slope[a] = inverse * out.slope[a];
            out.by_closure[a] = inverse * out.by_closure[a];
            for b in 0..S {
                out.jacobian[a][b] = inverse * out.jacobian[a][b];
                out.jacobian[b][a] = own * out.jacobian[b][a];
            }
        }
        self.scale_inner(&mut out.inner);
        given.inner = solved.strain;
        Ok(())
    }

    /// All stages.
    #[inline(never)]
    fn all_stages(
        &self,
        stations: &mut [Station<S, L>],
        out: &mut [Local<S, 0, L, Lanes>],
    ) -> Result<(), SectionFailure> {
        let mut pulled = CableList::new();
        each_block(
            stations,
            out,
            #[inline(always)]
            |block, station, out| self.block(block, station, &mut pulled, out),
        )
    }

    /// All ends at which elements meet the section law.
    #[inline(never)]
    fn all_ends(&self, stations: &mut [Station<S, L>], out: &mut [Inner<S, L, Lanes>]) -> Result<(), SectionFailure> {
        let statics = &self.statics;
        let mut pulled = CableList::new();
        let count = statics.tensions.len();
        each_block(
            stations,
            out,
            #[inline(always)]
            |block, given, out| {
                let station = &self.unscaled(given);
                let section = &statics.end_sections[block];
                statics.pulled_in(&statics.end_cables[block * count..(block + 1) * count], &mut pulled);
                let rates = self.end_rates.get(block).copied().unwrap_or_default();
                let stiffness = self.stiffened(&section.stiffness, &rates);
                let (direction, contact, solved) = statics.solved(&stiffness, station, &pulled);
                if !solved.is_solved(statics.inner_tolerance) {
                    return Err(failure(section.s, &solved, statics.inner_tolerance));
                }
                let by_state = strain_by_state(&solved.inverse, direction, contact);
                *out = inner(&solved, each(|k| wide(by_state[k])));
                self.scale_inner(out);
                given.inner = solved.strain;
                Ok(())
            },
        )
    }
}

/// A gradient by the statics' states as one by all.
#[inline(always)]
fn wide([theta, n_x, n_y, m]: [Lanes; N]) -> [Lanes; S] {
    let zero = Lanes::of(0.0);
    [theta, n_x, n_y, m, zero, zero]
}

impl Problem<S, 0, L> for Moving {
    type Failure = SectionFailure;

    fn is_closed(&self) -> bool {
        self.closed
    }

    fn stages<const FUSED: bool>(
        &self,
        _: Groups,
        stations: &mut [Station<S, L>],
        out: &mut [Local<S, 0, L, Lanes>],
    ) -> Result<(), SectionFailure> {
        self.all_stages(stations, out)
    }

    fn ends<const FUSED: bool>(
        &self,
        _: &[EndPlace],
        stations: &mut [Station<S, L>],
        out: &mut [Inner<S, L, Lanes>],
    ) -> Result<(), SectionFailure> {
        self.all_ends(stations, out)
    }

    fn left_count(&self) -> usize {
        3
    }

    /// Place and angle of the base.
    fn left(&self, z: &[f64; S], out: &mut [Condition<S>; S]) {
        let base = self.statics.arm().base;
        let length = self.statics.units.length;
        let given = [(0, base.angle), (X, base.x / length), (X + 1, base.y / length)];
        for (out, (a, value)) in out.iter_mut().zip(given) {
            out.residual = z[a] - value / self.scales[a];
            out.gradient[a] = 1.0;
        }
    }

    /// n_f(L) and m_f(L) are the loads on the tip, as in the statics.
    fn right(&self, z: &[f64; S], out: &mut [Condition<S>; S]) {
        let (load, turn) = self.statics.tip_load(z[0]);
        for k in 0..3 {
            let inverse = 1.0 / self.scales[k + 1];
            out[k].residual = z[k + 1] - inverse * load[k];
            out[k].gradient[k + 1] = 1.0;
            out[k].gradient[0] = -inverse * turn[k];
        }
    }
}
