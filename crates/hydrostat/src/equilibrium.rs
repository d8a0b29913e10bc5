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

mod at_place;
mod few;
mod gradients;
mod held;
mod nearness;
mod partials;
mod places;
mod strains;
mod varied;

use hydrostat_bvp::{Condition, Gauss, Groups, Hermite, LANES, Lanes, Local, Problem, Real, each};

pub(crate) use self::at_place::{Asked, AtPlace};
use self::few::Few;
use self::gradients::{by_strain_change, jacobian, rate_gradient, slopes, strain_by_state};
pub(crate) use self::held::{Column, Held};
use self::nearness::NearnessLanes;
pub(crate) use self::nearness::{Nearness, SectionFailure};
pub(crate) use self::partials::{BY, ByState, CLOSED, OUT, RATE, Spot, VALUE};
use self::places::Place;
use self::strains::{STATION, Solved, solve_section};
use crate::arm::{Arm, TipLoad};
use crate::beta_along::{BetaAlong, Coupling};
use crate::cable::tangent;
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
pub(crate) struct Equilibrium {
    pub(crate) units: Units,
    arm: Arm,
    water: Water,
    volume: Volume,
    tensions: Vec<f64>,
    /// The largest offset of each cable past which it does not run, over L.
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

impl Equilibrium {
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

    /// |tau| of cable `c` in a block of stations, now and at the reference strains.
    #[inline(always)]
    fn cable_stretch(&self, c: usize, block: usize) -> [Lanes; 2] {
        let offset = &self.cables[block * self.tensions.len() + c].offset;
        let stiffness = &self.places[block].stiffness;
        let reference = swelling(self.volume, stiffness.reference[0]);
        let reference_slope = reference.slope * stiffness.reference_slope[0];
        let strain = self.memory[block].strain;
        [
            tangent(offset, strain, &swelling(self.volume, strain[0]), self.beta.slope[block]).stretch,
            tangent(offset, stiffness.reference, &reference, reference_slope).stretch,
        ]
    }

    /// psi' of cable `c` in a block of stations, over L: see [`crate::friction`].
    pub(crate) fn cable_turns(&self, c: usize, block: usize) -> Lanes {
        let offset = &self.cables[block * self.tensions.len() + c].offset;
        let [nu, eta, mu] = self.memory[block].strain;
        let [nu_s, eta_s, mu_s] = self.strain_slopes[block];
        let beta = swelling(self.volume, nu).beta;
        let (beta_s, beta_ss) = (self.beta.slope[block], self.beta.curvature[block]);
        let along = nu - offset.y * beta * mu;
        let across = eta + offset.slope * beta + offset.y * beta_s;
        let along_s = nu_s - (offset.slope * beta + offset.y * beta_s) * mu - offset.y * beta * mu_s;
        let twice = Lanes::of(2.0) * offset.slope * beta_s;
        let across_s = eta_s + offset.curvature * beta + twice + offset.y * beta_ss;
        mu + (along * across_s - across * along_s) / (along * along + across * across)
    }

    /// Length of the path of cable `c`, now and at the reference strains, over L, with the weights of the stages.
    pub(crate) fn cable_lengths(&self, c: usize, weights: &[f64]) -> [f64; 2] {
        let mut lengths = [0.0; 2];
        let groups = self.groups();
        for block in 0..groups.count() * groups.stages {
            let (group, stage) = (block / groups.stages, block % groups.stages);
            let stretches = self.cable_stretch(c, block);
            for lane in 0..groups.filled(group) {
                if self.stations[groups.station_in(block, lane)] < self.ends[c] {
                    let weight = self.steps[group].0[lane] * weights[stage];
                    lengths[0] += weight * stretches[0].0[lane];
                    lengths[1] += weight * stretches[1].0[lane];
                }
            }
        }
        lengths
    }

    /// Stroke (over L) of cable `a` a unit of tension of cable `b` in the straight arm, by compression and bending.
    pub(crate) fn straight_compliance(&self, a: usize, b: usize) -> f64 {
        let end = self.ends[a].min(self.ends[b]);
        (0..64).map(|k| (f64::from(k) + 0.5) / 64.0).filter(|s| *s < end).fold(0.0, |sum, s| {
            let [axial, _, bending] = self.place(s).stiffness.value;
            sum + (1.0 / axial + self.offset(a, s).y * self.offset(b, s).y / bending) / 64.0
        })
    }

    /// Where cable `c` ends, over L.
    pub(crate) fn cable_end(&self, c: usize) -> f64 {
        self.ends[c]
    }

    /// Strain measure 1/2 (C1 (nu-nu_o)^2 + C2 (eta-eta_o)^2 + C3 (mu-mu_o)^2) A per length in a block of stations.
    #[inline(always)]
    pub(crate) fn strain_energy(&self, block: usize) -> Lanes {
        let stiffness = &self.places[block].stiffness;
        let strain = self.memory[block].strain;
        let beta = swelling(self.volume, strain[0]).beta;
        let mut sum = Lanes::of(0.0);
        for a in 0..3 {
            let strained = strain[a] - stiffness.reference[a];
            sum += Lanes::of(0.5) * stiffness.value[a] * beta * beta * strained * strained;
        }
        sum
    }

    /// How the stations stand in blocks.
    pub(crate) fn groups(&self) -> Groups {
        self.groups
    }

    pub(crate) fn stations(&self) -> &[f64] {
        &self.stations
    }

    /// Strains at station `k`.
    pub(crate) fn strain(&self, k: usize) -> [f64; 3] {
        let (block, lane) = self.groups.station(k);
        self.memory[block].strain.map(|v| v.0[lane])
    }

    /// Strains, beta' and beta'' at station `k`.
    pub(crate) fn station_guess(&self, k: usize) -> ([f64; 3], f64, f64) {
        let (block, lane) = self.groups.station(k);
        (self.strain(k), self.beta.slope[block].0[lane], self.beta.curvature[block].0[lane])
    }

    /// Switch `which` of the load at stage `j` of element `i`.
    pub(crate) fn switch(&self, i: usize, j: usize, which: usize) -> f64 {
        let (block, lane) = self.groups.at(i, j);
        self.switches[block][which].0[lane]
    }

    /// Strains, and beta' and beta'', between the stages of element `i`, weighed by `weights`.
    pub(crate) fn remembered<const M: usize>(&self, i: usize, weights: &[f64; M]) -> ([f64; 3], [f64; 2]) {
        let mut strain = [0.0; 3];
        let mut beta = [0.0; 2];
        for (j, w) in weights.iter().enumerate() {
            let (block, lane) = self.groups.at(i, j);
            for a in 0..3 {
                strain[a] += w * self.memory[block].strain[a].0[lane];
            }
            beta[0] += w * self.beta.slope[block].0[lane];
            beta[1] += w * self.beta.curvature[block].0[lane];
        }
        (strain, beta)
    }

    /// [`Equilibrium::remembered`] with beta' and beta'' from the polynomial through beta and beta' at the stages where
    /// the element is long enough for it.
    pub(crate) fn remembered_sharply<const M: usize>(
        &self,
        i: usize,
        weights: &[f64; M],
        sharp: &Hermite<M>,
    ) -> ([f64; 3], [f64; 2]) {
        let (mut strain, mut beta) = ([0.0; 3], [0.0; 2]);
        let (group, own) = (i / LANES, i % LANES);
        let inverse = 1.0 / self.steps[group].0[own];
        if self.beta.is_short(group, own, inverse) {
            return self.remembered(i, weights);
        }
        for l in 0..M {
            let block = group * self.groups.stages + l;
            for a in 0..3 {
                strain[a] += weights[l] * self.memory[block].strain[a].0[own];
            }
            let (value, slope) = (self.beta.value[block].0[own] * inverse, self.beta.slope[block].0[own]);
            beta[0] += sharp.slope[0][l] * value + sharp.slope[1][l] * slope;
            beta[1] += (sharp.curvature[0][l] * value + sharp.curvature[1][l] * slope) * inverse;
        }
        (strain, beta)
    }

    /// Strains of the unloaded arm at station `k`, mu times L.
    pub(crate) fn reference_strain(&self, k: usize) -> [f64; 3] {
        let (block, lane) = self.groups.station(k);
        self.places[block].stiffness.reference.map(|v| v.0[lane])
    }

    /// Takes the reference strains at every station.
    pub(crate) fn forget_strains(&mut self) {
        for (memory, place) in self.memory.iter_mut().zip(&self.places) {
            memory.strain = place.stiffness.reference;
        }
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

    /// How hard loads push against the arm at station `k`, over what its bending stiffness there
    /// resists over the rest of its length: compression of the contact force by (1 - s)^2/EI, and
    /// stream and weight by (1 - s)^3/EI where they run against the tangent, now or in the unloaded
    /// arm (at the angle `unloaded`). Well below one, equilibria are unique.
    pub(crate) fn adversity(&self, k: usize, s: f64, z: [f64; N], unloaded: f64) -> f64 {
        let rest = 1.0 - s;
        let (block, lane) = self.groups.station(k);
        let place = &self.places[block];
        let beta = self.beta.value[block].0[lane];
        let [nu, eta, _] = self.strain(k);
        let stiffness = place.stiffness.value[2].0[lane] * beta * beta;
        let alpha = eta.atan2(nu);
        let (sin, cos) = (z[0] + alpha).sin_cos();
        let compression = -(cos * z[1] + sin * z[2]) * rest * rest / stiffness;
        let stream = self.water.stream;
        let speed_square = stream[0] * stream[0] + stream[1] * stream[1];
        let drag = place.body.wetted.0[lane] * beta * speed_square * nu.hypot(eta);
        let net = self.net_weight(k);
        let cube = rest * rest * rest / stiffness;
        let mut worst = compression;
        let (unloaded_sin, unloaded_cos) = unloaded.sin_cos();
        for (cos, sin) in [(cos, sin), (unloaded_cos, unloaded_sin)] {
            if cos * stream[0] + sin * stream[1] < -1e-9 * speed_square.sqrt() {
                worst = worst.max(drag * cube);
            }
            worst = worst.max(-(cos * net[0] + sin * net[1]) * cube);
        }
        let (tip, _) = self.tip_load(unloaded);
        worst.max(-(unloaded_cos * tip[0] + unloaded_sin * tip[1]) * rest * rest / stiffness)
    }

    /// Weight less buoyancy, and forces along the arm, at station `k`, per length.
    fn net_weight(&self, k: usize) -> [f64; 2] {
        let (block, lane) = self.groups.station(k);
        let (place, beta) = (&self.places[block], self.beta.value[block].0[lane]);
        let nu = self.strain(k)[0];
        [0, 1].map(|c| {
            place.body.weight[c].0[lane] - place.body.displaced[c].0[lane] * nu * beta * beta
                + place.body.force[c].0[lane]
        })
    }

    /// Whether the arm at station `k`, turned to `theta`, is nearly in line with a load: small angles to it decide then to
    /// which side it goes.
    pub(crate) fn is_in_line(&self, k: usize, theta: f64) -> bool {
        const NEARLY: f64 = 0.05;
        let [nu, eta, _] = self.strain(k);
        let (sin, cos) = (theta + eta.atan2(nu)).sin_cos();
        let (tip, _) = self.tip_load(theta);
        [self.water.stream, self.net_weight(k), [tip[0], tip[1]]].iter().any(|[x, y]| {
            let size = x.hypot(*y);
            size > 0.0 && (cos * y - sin * x).abs() < NEARLY * size
        })
    }

    /// The other fraction is whole in the tension phase, zero in the loads phase.
    pub(crate) fn set_phase(&mut self, phase: Phase, fraction: f64) {
        self.phase = phase;
        self.fraction = match phase {
            Phase::Loads => [fraction, 0.0],
            Phase::Tension => [1.0, fraction],
            Phase::Stroke => [1.0, 1.0],
        };
        self.set_stroke_share(phase, fraction);
    }

    /// The tension of cable `c` at the present fraction, in the unit of force.
    pub(crate) fn tension(&self, c: usize) -> f64 {
        self.tensions[c] * self.fraction[1]
    }

    /// The shortest part of element `i` that beta' can still be differentiated on.
    pub(crate) fn shortest_element(&self, i: usize) -> f64 {
        let reach = (0..self.groups.stages).map(|j| {
            let (block, lane) = self.groups.at(i, j);
            self.beta.reach[block].0[lane].abs()
        });
        (4.0 * reach.fold(0.0, f64::max)).max(1e-6)
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
        hydrostatics: r.hydrostatics,
        tangential_factor: 1.0,
    }
}

impl Problem<N, Q> for Equilibrium {
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

    /// theta(0) = theta_0; with the unstrained base also n_f(0) = sum T t_c(0) and
    /// m_f(0) = -sum T y (t_c . a)(0) at nu = beta = 1, eta = mu = beta' = 0.
    fn left(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        out[0].residual = z[0] - self.arm.base.angle;
        out[0].gradient[0] = 1.0;
        out[0].drift = -self.base_turn();
        if self.arm.readings.support == Support::UnstrainedBase {
            let (sin, cos) = self.arm.base.angle.sin_cos();
            let mut at_base = [0.0; 3];
            for c in 0..self.tensions.len() {
                let offset = self.offset(c, 0.0);
                let stretch = 1.0_f64.hypot(offset.slope);
                let (t_a, t_b) = (1.0 / stretch, offset.slope / stretch);
                at_base[0] += self.tension(c) * (t_a * cos - t_b * sin);
                at_base[1] += self.tension(c) * (t_a * sin + t_b * cos);
                at_base[2] -= self.tension(c) * offset.y * t_a;
            }
            for k in 0..3 {
                out[k + 1].residual = z[k + 1] - at_base[k];
                out[k + 1].gradient[k + 1] = 1.0;
            }
            if let Some(c) = self.pulled {
                let offset = self.offset(c, 0.0);
                let stretch = 1.0_f64.hypot(offset.slope);
                let (t_a, t_b) = (1.0 / stretch, offset.slope / stretch);
                out[1].drift = -(t_a * cos - t_b * sin);
                out[2].drift = -(t_a * sin + t_b * cos);
                out[3].drift = offset.y * t_a;
            }
        }
    }

    /// n_f(L) = tip force (dead, and following a(L), b(L)), m_f(L) = tip moment.
    fn right(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        if self.arm.readings.support == Support::UnstrainedBase {
            return;
        }
        let (load, turn) = self.tip_load(z[0]);
        let drift = self.tip_drift(z[0]);
        let per_fraction =
            if self.phase == Phase::Loads && self.fraction[0] != 0.0 { 1.0 / self.fraction[0] } else { 0.0 };
        for k in 0..3 {
            out[k].residual = z[k + 1] - load[k];
            out[k].gradient[k + 1] = 1.0;
            out[k].gradient[0] = -turn[k];
            out[k].drift = -load[k] * per_fraction - drift[k];
        }
    }
}

impl Equilibrium {
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

    /// Force and moment on the tip at the present fraction, and their derivative by theta(L).
    pub(crate) fn tip_load(&self, theta: f64) -> ([f64; 3], [f64; 3]) {
        self.load_of(&self.arm.tip, theta)
    }

    fn load_of(&self, tip: &TipLoad, theta: f64) -> ([f64; 3], [f64; 3]) {
        let (sin, cos) = theta.sin_cos();
        let f = self.fraction[0] / self.units.force;
        let [fa, fb] = tip.follower;
        let load = [
            f * (tip.force[0] + fa * cos - fb * sin),
            f * (tip.force[1] + fa * sin + fb * cos),
            f * tip.moment / self.units.length,
        ];
        let turn = [f * (-fa * sin - fb * cos), f * (fa * cos - fb * sin), 0.0];
        (load, turn)
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
            Phase::Tension | Phase::Stroke => {
                let f = self.fraction[1];
                let per = Lanes::of(if f == 0.0 { 0.0 } else { -1.0 / f });
                let strain = apply3(&solved.inverse, each(|k| solved.balance.cables[k] * per));
                (by_strain_change(load, contact, strain), strain[0])
            }
        }
    }
}
