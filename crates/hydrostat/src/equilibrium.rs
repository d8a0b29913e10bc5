//! The differential equations and end conditions that the solver gets (`docs/model.md`, section 7).
//!
//! Unknown along the arm are z = (theta, n_f, m_f), the section rotation and the part of the contact
//! force and moment that balances everything but the cables:
//!
//! ```text
//! theta' = mu
//! n_f'   = -f
//! m_f'   = -(r' x n_f) . k - couple          r' = nu a + eta b (2)
//! ```
//!
//! and at every s the section law gives (nu, eta, mu), see [`crate::section`]. The centreline r is a
//! quadrature. Lengths are in units of L, forces in a unit of [`Units`].

mod adversity;
mod at_place;
mod cable_paths;
mod ends;
mod few;
mod gradients;
mod held;
mod nearness;
mod partials;
mod places;
mod remembered;
mod strains;
mod varied;

use hydrostat_bvp::{Condition, Gauss, Groups, LANES, Lanes, Local, Problem, Real, each};

pub(crate) use self::adversity::Unloaded;
pub(crate) use self::at_place::{Asked, AtPlace};
use self::few::Few;
use self::gradients::{by_strain_change, jacobian, rate_gradient, slopes, strain_by_state};
pub(crate) use self::held::{Column, Held};
use self::nearness::NearnessLanes;
pub(crate) use self::nearness::{Nearness, SectionFailure};
pub(crate) use self::partials::{BY, ByState, CLOSED, OUT, RATE, Spot, VALUE};
use self::places::Place;
use self::strains::{STATION, Solved, solve_section};
use crate::arm::Arm;
use crate::beta_along::{BetaAlong, Coupling};
use crate::flow::Law;
use crate::loads::{Load, Water, load};
use crate::readings::{Support, Volume};
use crate::section::{CableAt, apply3};
use crate::sincos::sin_cos;
use crate::swelling::swelling;
use crate::verdict::Phase;

/// States: theta, n_f along e1, n_f along e2, m_f.
pub(crate) const N: usize = 4;
/// Quadratures: x, y.
pub(crate) const Q: usize = 2;

/// The units in which the equations are solved: lengths in L, forces in `force`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Units {
    pub(crate) length: f64,
    pub(crate) force: f64,
}

/// What the section law remembers from the last state at a station.
#[derive(Debug, Clone, Copy)]
struct Memory<R> {
    z: [R; N],
    strain: [R; 3],
    /// d strain / d z.
    by_state: [[R; N]; 3],
    /// beta' that the strains are of, and d strain / d beta'.
    beta_slope: R,
    by_beta_slope: [R; 3],
}

/// Equations of one arm at given fractions of its loads.
#[derive(Debug, Clone)]
pub(crate) struct Equations {
    pub(crate) units: Units,
    arm: Arm,
    water: Water,
    volume: Volume,
    tensions: Vec<f64>,
    /// Arc length of each cable's anchor, over L.
    ends: Vec<f64>,
    /// Fractions of the loads and of the tensions.
    pub(crate) fraction: [f64; 2],
    /// The phase whose fraction is the parameter, unless another one is varied.
    pub(crate) phase: Phase,
    varied: Option<varied::Varied>,
    /// Cables whose stroke is commanded, from where on these are.
    pub(crate) held: Option<Held>,
    /// The cable whose tension takes the place of the parameter.
    pub(crate) pulled: Option<usize>,
    /// How strains and beta' followed the parameter when [`Problem::drift`] was asked last.
    pub(crate) column: Column,
    /// What friction leaves of the tensions, if there is any.
    pub(crate) grip: Option<crate::friction::Grip>,
    /// (nu, eta, mu)' at the stations.
    strain_slopes: Vec<[Lanes; 3]>,
    /// A couple over s/L that takes the place of the parameter, at every station.
    imposed: Option<Vec<f64>>,
    /// How the stations stand in blocks of four.
    groups: Groups,
    stations: Vec<f64>,
    /// Element lengths, a group.
    steps: Vec<Lanes>,
    places: Vec<Place<Lanes>>,
    cables: Vec<CableAt<Lanes>>,
    memory: Vec<Memory<Lanes>>,
    pub(crate) beta: BetaAlong,
    drifts: Vec<[Lanes; N]>,
    /// Load switches.
    switches: Vec<[Lanes; 3]>,
    pub(crate) evaluations: usize,
    /// Evaluations with what cables add to them, see `engine/budget`.
    pub(crate) work: usize,
    /// At the last evaluation.
    pub(crate) nearness: Nearness,
    /// A chosen shape, with the loads that make it an equilibrium.
    #[cfg(test)]
    pub(crate) manufactured: Option<crate::engine::manufactured::Manufactured>,
}

impl Equations {
    /// The equations of `arm` (already checked), with all loads whole.
    pub(crate) fn new<const M: usize>(arm: &Arm, gauss: &Gauss<M>) -> Self {
        let length = arm.length;
        let mut this = Self {
            units: Units { length, force: 1.0 },
            water: water(arm),
            volume: arm.readings.volume,
            tensions: Vec::new(),
            ends: arm.cables.iter().map(|c| c.end).collect(),
            arm: arm.clone(),
            fraction: [1.0, 1.0],
            phase: Phase::Tension,
            varied: None,
            held: None,
            pulled: None,
            column: Column::default(),
            grip: None,
            strain_slopes: Vec::new(),
            imposed: None,
            groups: Groups { elements: 0, stages: M },
            stations: Vec::new(),
            steps: Vec::new(),
            places: Vec::new(),
            cables: Vec::new(),
            memory: Vec::new(),
            beta: BetaAlong::new(gauss),
            drifts: Vec::new(),
            switches: Vec::new(),
            evaluations: 0,
            work: 0,
            nearness: Nearness::FAR,
            #[cfg(test)]
            manufactured: None,
        };
        let bending = this.place(0.0).stiffness.value[2];
        // At unit force the stiffness is C3 A0 / L^2: make it one at the base.
        this.units.force = bending;
        this.set_tensions();
        this
    }

    /// Takes loads, stream and material from an arm of the same geometry.
    pub(crate) fn set_loads(&mut self, arm: &Arm) {
        let own = &self.arm;
        let same_sections = own.flow.density == arm.flow.density
            && own.gravity == arm.gravity
            && own.density == arm.density
            && own.material == arm.material
            && own.distributed == arm.distributed;
        self.arm.clone_from(arm);
        self.water = water(arm);
        self.set_tensions();
        if !same_sections {
            self.take_sections();
        }
    }

    /// Changes tensions, or the stream's velocity.
    pub(crate) fn change_loads(&mut self, change: impl Fn(&mut Arm)) {
        change(&mut self.arm);
        self.water = water(&self.arm);
        self.set_tensions();
    }

    fn set_tensions(&mut self) {
        self.tensions.clear();
        self.tensions.extend(self.arm.cables.iter().map(|c| c.tension / self.units.force));
    }

    pub(crate) fn arm(&self) -> &Arm {
        &self.arm
    }

    /// The arm with the loads that act at the present fractions.
    pub(crate) fn arm_at_fraction(&self) -> Arm {
        let mut arm = self.arm.clone();
        let [loads, tension] = self.fraction;
        let of_friction = self.grip.as_ref().map_or(0.0, |grip| grip.of_friction);
        if of_friction != 1.0 {
            for cable in &mut arm.cables {
                cable.friction *= of_friction;
            }
        }
        if tension != 1.0 {
            for cable in &mut arm.cables {
                cable.tension *= tension;
            }
        }
        for (i, c) in self.held.iter().flat_map(|held| held.cables.iter().enumerate()) {
            let stroke = self.held.as_ref().map(|held| self.command(held, i) * self.units.length);
            arm.cables[*c].stroke = stroke.filter(|_| self.phase == Phase::Stroke).or(arm.cables[*c].stroke);
        }
        if loads != 1.0 {
            // The stream's load is its fraction: with the square of the speed, which both laws have.
            arm.flow.speed *= loads.sqrt();
            if let Some(gravity) = &mut arm.gravity {
                gravity.acceleration *= loads;
            }
            for v in arm.tip.force.iter_mut().chain(&mut arm.tip.follower) {
                *v *= loads;
            }
            arm.tip.moment *= loads;
            for p in arm.distributed.force.iter_mut().chain([&mut arm.distributed.couple]) {
                *p = p.scaled(loads, 1.0);
            }
        }
        arm
    }

    pub(crate) fn set_tangential_factor(&mut self, factor: f64) {
        self.water.tangential_factor = factor;
    }

    /// How the stations stand in blocks.
    pub(crate) fn groups(&self) -> Groups {
        self.groups
    }

    pub(crate) fn stations(&self) -> &[f64] {
        &self.stations
    }

    pub(crate) fn volume(&self) -> Volume {
        self.volume
    }

    /// Whether anything but cables loads the arm.
    pub(crate) fn has_loads(&self) -> bool {
        let a = &self.arm;
        let water_moves = a.flow.speed != 0.0 && a.flow.density != 0.0;
        let gravity = a.gravity.is_some_and(|g| g.acceleration != 0.0);
        let tip = a.tip.force != [0.0; 2] || a.tip.moment != 0.0 || a.tip.follower != [0.0; 2];
        let along = !(a.distributed.force.iter().all(crate::Profile::is_zero) && a.distributed.couple.is_zero());
        water_moves || gravity || tip || along
    }

    /// Whether a cable is pulled.
    pub(crate) fn has_tension(&self) -> bool {
        self.tensions.iter().any(|t| *t != 0.0)
    }

    /// The other fraction is whole in the tension phase, zero in the loads phase.
    pub(crate) fn set_phase(&mut self, phase: Phase, fraction: f64) {
        self.phase = phase;
        self.fraction = match phase {
            Phase::Loads => [fraction, 0.0],
            Phase::Tension => [1.0, fraction],
            Phase::Stroke | Phase::Friction => [1.0, 1.0],
        };
        self.set_stroke_share(phase, fraction);
    }

    /// The tension of cable `c` at the present fraction, in the unit of force.
    pub(crate) fn tension(&self, c: usize) -> f64 {
        self.tensions[c] * self.fraction[1]
    }

    /// The shortest part of element `i` that beta' can still be found on.
    pub(crate) fn shortest_element(&self, i: usize) -> f64 {
        self.beta.shortest(i, self.groups.elements).max(1e-6)
    }

    #[inline(always)]
    fn load<R: Real>(&self, place: &Place<R>, direction: [R; 2], solved: &Solved<R>, beta_slope: R) -> Load<R> {
        let mut load = load(&self.water, &place.body, direction, solved.strain, &solved.balance.swelling, beta_slope);
        let fraction = R::of(self.fraction[0]);
        for k in 0..2 {
            load.force[k] = load.force[k] * fraction;
            load.by_theta[k] = load.by_theta[k] * fraction;
            load.by_strain[k] = each(|c| load.by_strain[k][c] * fraction);
            load.by_beta_slope[k] = load.by_beta_slope[k] * fraction;
        }
        load
    }
}

fn water(arm: &Arm) -> Water {
    let r = &arm.readings;
    Water {
        stream: if arm.flow.density == 0.0 { [0.0; 2] } else { arm.stream() },
        law: Law::new(arm.flow.law, r.entering_speed, r.layer_mean.factor()),
        surface: r.flow_surface,
        wetted: r.wetted_length,
        volume: r.volume,
        displaced: r.displaced,
        hydrostatics: r.hydrostatics,
        tangential_factor: 1.0,
    }
}

impl Problem<N, Q> for Equations {
    type Failure = SectionFailure;

    #[inline(always)]
    fn slopes<const FUSED: bool>(
        &mut self,
        groups: Groups,
        z: &[[Lanes; N]],
        out: &mut [Local<N, Q, Lanes>],
    ) -> Result<(), SectionFailure> {
        let evaluations = groups.elements * groups.stages;
        self.evaluations += evaluations;
        self.work += evaluations * self.arm.dearness();
        let mut near = NearnessLanes::far();
        self.follow(z);
        let mut pulled = Few::new();
        for (block, (z, out)) in z.iter().zip(out.iter_mut()).enumerate() {
            self.pulled_in(block, &mut pulled);
            let solved = self.block(block, z, pulled.as_slice(), &mut near, out);
            if solved.is_err() {
                self.nearness = near.nearest();
                return solved;
            }
        }
        self.nearness = near.nearest();
        self.beta.close::<FUSED>(&self.steps, out, &mut self.drifts);
        if self.beta.some_short {
            let memory = &self.memory;
            self.beta.carry(groups.elements, &self.steps, |block, lane| memory[block].beta_slope.0[lane], out);
        }
        Ok(())
    }

    #[inline(always)]
    fn drift(&mut self, out: &mut [[Lanes; N]]) {
        let followed = match self.pulled {
            Some(cable) => self.drift_by_tension(cable, out),
            None => self.drift_by_share(out),
        };
        if followed {
            return;
        }
        if self.held.is_some() {
            self.column.clear(out.len());
        }
        if self.pulled.is_some() {
            // Without strains to follow it the tension moves nothing, which no round can work with.
            out.fill([Lanes::of(0.0); N]);
        } else {
            out.copy_from_slice(&self.drifts);
        }
    }

    fn left_count(&self) -> usize {
        match self.arm.readings.support {
            Support::Clamped => 1,
            Support::UnstrainedBase => N,
        }
    }

    fn left(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        self.base_conditions(z, out);
    }

    fn right(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        self.tip_conditions(z, out);
    }
}

impl Equations {
    /// Fills `out` with the cables that pull in a block of stations.
    #[inline(always)]
    fn pulled_in(&self, block: usize, out: &mut Few<Lanes>) {
        let cable_count = self.tensions.len();
        out.clear();
        for c in 0..cable_count {
            let tension = self.tensions[c] * self.fraction[1];
            if tension != 0.0 {
                let mut cable = self.cables[block * cable_count + c];
                cable.tension = cable.tension * Lanes::of(tension);
                cable.tension_slope = cable.tension_slope * Lanes::of(tension);
                out.push(cable);
            }
        }
    }

    /// The stations of a block at the states `z`: all but what beta' adds.
    #[inline(always)]
    fn block(
        &mut self,
        block: usize,
        z: &[Lanes; N],
        pulled: &[CableAt<Lanes>],
        near: &mut NearnessLanes,
        out: &mut Local<N, Q, Lanes>,
    ) -> Result<(), SectionFailure> {
        let state = *z;
        let place = &self.places[block];
        let couple = place.body.couple * Lanes::of(self.fraction[0]);
        let (sin, cos) = sin_cos(state[0]);
        let direction = [cos, sin];
        let contact = [cos * state[1] + sin * state[2], cos * state[2] - sin * state[1], state[3]];

        let guess = self.memory[block].strain;
        let beta_along = [self.beta.slope[block], self.beta.curvature[block]];

        let solved = solve_section(self.volume, &place.stiffness, pulled, contact, guess, beta_along, STATION);
        if !solved.fine() {
            return Err(self.failure(block, &solved));
        }
        let load = self.load(place, direction, &solved, beta_along[0]);
        let slopes = slopes(couple, direction, contact, &solved, &load);

        self.strain_slopes[block] = slopes.strain_slope;
        let by_state = strain_by_state(&solved.inverse, direction, contact);
        let [nu, eta, _] = solved.strain;
        let rate = [nu * cos - eta * sin, nu * sin + eta * cos];
        out.slope = slopes.slope;
        out.jacobian = jacobian(direction, contact, &solved, &load, &by_state);
        out.rate = rate;
        out.rate_gradient = rate_gradient(direction, rate, &by_state);
        // What moves at fixed z with beta': the strains, and all that follows from them.
        let less = apply3(&solved.inverse, solved.balance.by_curvature);
        let [nu_p, eta_p, mu_p] = each(|k| -less[k]);
        let force_by_slope = |k: usize| {
            let by = load.by_strain[k];
            -(by[0] * nu_p + by[1] * eta_p + by[2] * mu_p + load.by_beta_slope[k])
        };
        let swelling_slope = solved.balance.swelling.slope;
        let (drift, nu_drift) = self.drift_of(block, contact, &solved, &load);
        self.drifts[block] = drift;
        self.beta.coupling[block] = Coupling {
            slope: [mu_p, force_by_slope(0), force_by_slope(1), contact[0] * eta_p - contact[1] * nu_p],
            rate: [nu_p * cos - eta_p * sin, nu_p * sin + eta_p * cos],
            value: each(|a| swelling_slope * by_state[0][a]),
            value_drift: swelling_slope * nu_drift,
        };
        self.beta.value[block] = solved.balance.swelling.beta;
        self.beta.slope[block] = beta_along[0];
        self.beta.closed[block] = slopes.beta_slope;
        self.beta.reach[block] = swelling_slope * nu_p;
        self.switches[block] = load.switches;
        near.note(self.places[block].s, [solved.balance.openness, nu, solved.regularity]);
        let by_beta_slope = [nu_p, eta_p, mu_p];
        self.memory[block] =
            Memory { z: state, strain: solved.strain, by_state, beta_slope: beta_along[0], by_beta_slope };
        Ok(())
    }

    /// Moves what is remembered along its tangents to the states `z`: strains, beta and its derivatives. Left where it
    /// was where those lead too far to mean anything.
    #[inline(always)]
    fn follow(&mut self, z: &[[Lanes; N]]) {
        let zero = Lanes::of(0.0);
        for (block, state) in z.iter().enumerate() {
            let memory = &self.memory[block];
            let mut moved = [zero; N];
            for a in 0..N {
                moved[a] = state[a] - memory.z[a];
            }
            let slope = self.beta.followed(block, &moved);
            let turned = slope - memory.beta_slope;
            let mut strain = memory.strain;
            let mut leap = zero;
            for a in 0..3 {
                let mut move_by = memory.by_beta_slope[a] * turned;
                for b in 0..N {
                    move_by += memory.by_state[a][b] * moved[b];
                }
                let size = if a == 2 { move_by.abs() / (Lanes::of(2.0) + strain[2].abs()) } else { move_by.abs() };
                leap = leap.max(size);
                strain[a] += move_by;
            }
            let near_enough = Lanes::of(0.3);
            for a in 0..3 {
                strain[a] = leap.if_less(near_enough, strain[a], memory.strain[a]);
            }
            let slope = leap.if_less(near_enough, slope, self.beta.slope[block]);
            self.beta.value[block] = swelling(self.volume, strain[0]).beta;
            self.beta.slope[block] = slope;
            let memory = &mut self.memory[block];
            memory.z = *state;
            memory.strain = strain;
            memory.beta_slope = slope;
        }
        self.beta.follow_curvature(&self.steps);
    }

    /// What the next evaluation, at the states `z`, would find but for what is of second order: strains, beta and its
    /// derivatives, the load's switches.
    #[inline(always)]
    pub(crate) fn foresee(&mut self, z: &[[Lanes; N]]) {
        self.follow(z);
        for (block, state) in z.iter().enumerate() {
            let (sin, cos) = sin_cos(state[0]);
            let strain = self.memory[block].strain;
            let swelling = swelling(self.volume, strain[0]);
            let slope = self.beta.slope[block];
            let load = load(&self.water, &self.places[block].body, [cos, sin], strain, &swelling, slope);
            self.switches[block] = load.switches;
        }
    }

    /// The first station of a block, along the arm, that could not be solved.
    #[cold]
    #[inline(never)]
    fn failure(&self, block: usize, solved: &Solved<Lanes>) -> SectionFailure {
        let lane = (0..LANES).find(|lane| !solved.fine_in(*lane)).unwrap_or(0);
        SectionFailure {
            s: self.places[block].s.0[lane],
            openness: solved.balance.openness.0[lane],
            nu: solved.strain[0].0[lane],
            regularity: solved.regularity.0[lane],
        }
    }

    /// d z' / d fraction of the phase, and that of nu, at fixed z and beta'.
    #[inline(always)]
    fn drift_of(
        &self,
        block: usize,
        contact: [Lanes; 3],
        solved: &Solved<Lanes>,
        load: &Load<Lanes>,
    ) -> ([Lanes; N], Lanes) {
        let zero = Lanes::of(0.0);
        match self.phase {
            Phase::Loads => {
                let f = self.fraction[0];
                let per = Lanes::of(if f == 0.0 { 0.0 } else { 1.0 / f });
                let couple = self.places[block].body.couple;
                ([zero, -(load.force[0] * per), -(load.force[1] * per), -couple], zero)
            }
            Phase::Tension | Phase::Stroke | Phase::Friction => {
                let f = self.fraction[1];
                let per = Lanes::of(if f == 0.0 { 0.0 } else { -1.0 / f });
                let strain = apply3(&solved.inverse, each(|k| solved.balance.cables[k] * per));
                (by_strain_change(load, contact, strain), strain[0])
            }
        }
    }
}
