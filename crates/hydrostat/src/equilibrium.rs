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

mod varied;

use hydrostat_bvp::{Condition, Gauss, Local, Problem};

use crate::arm::{Arm, Cavity, Material, TipLoad};
use crate::beta_along::BetaAlong;
use crate::cable::{Offset, tangent};
use crate::flow::Law;
use crate::loads::{Body, Load, Water, load};
use crate::readings::{Support, Volume};
use crate::real::{LANES, Lanes, Real};
use crate::section::{Balance, CableAt, Stiffness, apply3, balance, inverse3};
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

/// Where a section law failed and how near each limit it was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SectionFailure {
    /// Over L.
    pub(crate) s: f64,
    /// Smallest tau.a / nu of the pulled cables.
    pub(crate) openness: f64,
    /// Stretch when it failed.
    pub(crate) nu: f64,
    /// Determinant of the section law over that of the slack one.
    pub(crate) regularity: f64,
}

/// How near the limits of the section law the stations came, each with its place (over L).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Nearness {
    /// Smallest tau.a / nu of a pulled cable.
    pub(crate) openness: (f64, f64),
    /// Smallest stretch.
    pub(crate) nu: (f64, f64),
    /// Smallest determinant of the section law over that of the slack one.
    pub(crate) regularity: (f64, f64),
}

impl Nearness {
    const FAR: Self = Self { openness: (1.0, 0.0), nu: (f64::INFINITY, 0.0), regularity: (f64::INFINITY, 0.0) };

    #[inline(always)]
    pub(crate) fn note(&mut self, s: f64, openness: f64, nu: f64, regularity: f64) {
        for (least, value) in [(&mut self.openness, openness), (&mut self.nu, nu), (&mut self.regularity, regularity)] {
            if value < least.0 {
                *least = (value, s);
            }
        }
    }
}

/// One place of the arm as data.
#[derive(Debug, Clone, Copy)]
struct Place<R> {
    stiffness: Stiffness<R>,
    body: Body<R>,
}

/// What the section law remembers from the last state at a station.
#[derive(Debug, Clone, Copy)]
struct Memory<R> {
    z: [R; N],
    strain: [R; 3],
    /// d strain / d z.
    by_state: [[R; N]; 3],
}

/// A station's strains and everything derived.
#[derive(Clone, Copy)]
pub(crate) struct Solved<R> {
    pub(crate) strain: [R; 3],
    pub(crate) balance: Balance<R>,
    inverse: [[R; 3]; 3],
    /// Determinant of the section law over that of the slack one: not above zero past a limit.
    pub(crate) regularity: R,
    /// Last Newton step.
    step: R,
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
    /// A couple at every station that takes the place of the parameter.
    imposed: Option<Vec<f64>>,
    stages: usize,
    stations: Vec<f64>,
    /// Element length of each station.
    steps: Vec<f64>,
    places: Vec<Place<Lanes>>,
    cables: Vec<CableAt<Lanes>>,
    memory: Vec<Memory<Lanes>>,
    pub(crate) beta: BetaAlong,
    drifts: Vec<[f64; N]>,
    /// Load switches a station.
    pub(crate) switches: Vec<[f64; 3]>,
    pub(crate) evaluations: usize,
    /// At the last evaluation.
    pub(crate) nearness: Nearness,
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
            imposed: None,
            stages: M,
            stations: Vec::new(),
            steps: Vec::new(),
            places: Vec::new(),
            cables: Vec::new(),
            memory: Vec::new(),
            beta: BetaAlong::new(gauss),
            drifts: Vec::new(),
            switches: Vec::new(),
            evaluations: 0,
            nearness: Nearness::FAR,
        };
        let bending = this.place(0.0).stiffness.value[2];
        // At unit force the stiffness is C3 A0 / L^2: make it one at the base.
        this.units.force = bending;
        this.set_tensions();
        this
    }

    /// Takes new tensions and stream from an arm of the same geometry and material.
    pub(crate) fn set_loads(&mut self, arm: &Arm) {
        let same_water = self.arm.flow.density == arm.flow.density && self.arm.gravity == arm.gravity;
        self.arm.clone_from(arm);
        self.water = water(arm);
        self.set_tensions();
        if !same_water {
            let stations = std::mem::take(&mut self.stations);
            for (k, s) in stations.iter().enumerate() {
                let place = self.place(*s);
                set_lane(&mut self.places[k / LANES], k % LANES, &place);
            }
            self.stations = stations;
        }
    }

    fn set_tensions(&mut self) {
        self.tensions = self.arm.cables.iter().map(|c| c.tension / self.units.force).collect();
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

    /// |tau| of cable `c` at station `k`, now and at the reference strains.
    pub(crate) fn cable_stretch(&self, c: usize, k: usize) -> [f64; 2] {
        let (block, lane) = (k / LANES, k % LANES);
        let at = &self.cables[block * self.tensions.len() + c].offset;
        let offset = Offset { y: at.y.0[lane], slope: at.slope.0[lane], curvature: at.curvature.0[lane] };
        let stiffness = &self.places[block].stiffness;
        let reference_strain = stiffness.reference.map(|v| v.0[lane]);
        let reference = swelling(self.volume, reference_strain[0]);
        let reference_slope = reference.slope * stiffness.reference_slope[0].0[lane];
        let strain = self.strain(k);
        [
            tangent(&offset, strain, &swelling(self.volume, strain[0]), self.beta.slope[k]).stretch,
            tangent(&offset, reference_strain, &reference, reference_slope).stretch,
        ]
    }

    /// Length of the path of cable `c`, now and at the reference strains, over L, with the weights of the stages.
    pub(crate) fn cable_lengths(&self, c: usize, weights: &[f64]) -> [f64; 2] {
        let mut lengths = [0.0; 2];
        for (k, s) in self.stations.iter().enumerate() {
            if *s < self.ends[c] {
                let weight = self.steps[k] * weights[k % self.stages];
                let stretches = self.cable_stretch(c, k);
                lengths[0] += weight * stretches[0];
                lengths[1] += weight * stretches[1];
            }
        }
        lengths
    }

    /// Stroke (over L) a unit of tension of cable `c` in the straight arm, by compression and bending.
    pub(crate) fn cable_compliance(&self, c: usize) -> f64 {
        (0..64).map(|k| (f64::from(k) + 0.5) / 64.0).filter(|s| *s < self.ends[c]).fold(0.0, |sum, s| {
            let [axial, _, bending] = self.place(s).stiffness.value;
            sum + (1.0 / axial + self.offset(c, s).y.powi(2) / bending) / 64.0
        })
    }

    /// Where cable `c` ends, over L.
    pub(crate) fn cable_end(&self, c: usize) -> f64 {
        self.ends[c]
    }

    /// Strain measure 1/2 (C1 (nu-nu_o)^2 + C2 (eta-eta_o)^2 + C3 (mu-mu_o)^2) A per length at station `k`.
    pub(crate) fn strain_energy(&self, k: usize) -> f64 {
        let stiffness = &self.places[k / LANES].stiffness;
        let strain = self.strain(k);
        let beta = swelling(self.volume, strain[0]).beta;
        let mut sum = 0.0;
        for a in 0..3 {
            let strained = strain[a] - stiffness.reference[a].0[k % LANES];
            sum += 0.5 * stiffness.value[a].0[k % LANES] * beta * beta * strained * strained;
        }
        sum
    }

    /// Data at `s` (over L).
    fn place(&self, s: f64) -> Place<f64> {
        let (arm, units) = (&self.arm, self.units);
        let l = units.length;
        let at = |p: &crate::profile::Profile| p.at(s * l, l);
        let (r, r_in) = (at(&arm.radius), at(&arm.inner_radius));
        let pi = std::f64::consts::PI;
        let area = pi * (r.value * r.value - r_in.value * r_in.value);
        let area_slope = 2.0 * pi * (r.value * r.slope - r_in.value * r_in.slope);
        let (c, c_slope) = match &arm.material {
            Material::Homogeneous { young, poisson, shear_factor } => {
                // C1 = E, C2 = k G, C3 = E I/A of a ring.
                let square = r.value * r.value + r_in.value * r_in.value;
                let square_slope = 2.0 * (r.value * r.slope + r_in.value * r_in.slope);
                let shear = shear_factor * young / (2.0 * (1.0 + poisson));
                ([*young, shear, young * square / 4.0], [0.0, 0.0, young * square_slope / 4.0])
            }
            Material::Coefficients { c1, c2, c3 } => {
                let c = [at(c1), at(c2), at(c3)];
                (c.map(|c| c.value), c.map(|c| c.slope))
            }
        };
        // Stiffness in the units: C1 A0 / F, C2 A0 / F, C3 A0 / (F L^2).
        let unit = [1.0 / units.force, 1.0 / units.force, 1.0 / (units.force * l * l)];
        let reference = [at(&arm.reference.nu), at(&arm.reference.eta), at(&arm.reference.mu)];
        let per_length = [1.0, 1.0, l];
        let stiffness = Stiffness {
            value: [0, 1, 2].map(|k| c[k] * area * unit[k]),
            slope: [0, 1, 2].map(|k| (c_slope[k] * area + c[k] * area_slope) * unit[k] * l),
            reference: [0, 1, 2].map(|k| reference[k].value * per_length[k]),
            reference_slope: [0, 1, 2].map(|k| reference[k].slope * per_length[k] * l),
        };
        let load_unit = l / units.force;
        let gravity = arm.gravity.map_or([0.0; 2], |g| {
            let (sin, cos) = g.direction.sin_cos();
            [g.acceleration * cos * load_unit, g.acceleration * sin * load_unit]
        });
        let outline = match arm.cavity {
            Cavity::Flooded => area,
            Cavity::Sealed => pi * r.value * r.value,
        };
        let body = Body {
            radius: r.value / l,
            radius_slope: r.slope,
            wetted: pi * arm.flow.density * r.value * load_unit,
            weight: gravity.map(|g| arm.density * area * g),
            displaced: gravity.map(|g| arm.flow.density * outline * g),
            force: [0, 1].map(|k| at(&arm.distributed.force[k]).value * load_unit),
            couple: at(&arm.distributed.couple).value / units.force,
        };
        Place { stiffness, body }
    }

    fn offset(&self, cable: usize, s: f64) -> Offset<f64> {
        let l = self.units.length;
        let p = self.arm.cables[cable].offset.at(s * l, l);
        Offset { y: p.value / l, slope: p.slope, curvature: p.curvature * l }
    }

    /// Takes a new set of stations, `stages` an element, with guesses of the strains and of beta'.
    pub(crate) fn place_stations(
        &mut self,
        stations: &[f64],
        mesh: &hydrostat_bvp::Mesh,
        guess: impl Fn(usize) -> ([f64; 3], f64, f64),
    ) {
        let count = stations.len();
        let blocks = count.div_ceil(LANES);
        let zero = Lanes::of(0.0);
        let cable_count = self.tensions.len();
        let memory = Memory { z: [zero; N], strain: [zero; 3], by_state: [[zero; N]; 3] };
        self.memory.clear();
        self.memory.resize(blocks, memory);
        if self.places.len() < blocks {
            let blank = splat(&self.place(stations[0]));
            self.places.resize(blocks, blank);
        }
        self.places.truncate(blocks);
        self.cables.resize(blocks * cable_count, blank_cable());
        self.steps.clear();
        self.steps.extend((0..count).map(|k| mesh.step(k / self.stages)));
        self.beta.resize(count);
        self.switches.resize(count, [0.0; 3]);
        self.drifts.resize(count, [0.0; N]);
        for lane in 0..blocks * LANES {
            let k = lane.min(count - 1);
            let (block, lane_in_block) = (lane / LANES, lane % LANES);
            let (strain, slope, curvature) = guess(k);
            for a in 0..3 {
                self.memory[block].strain[a].0[lane_in_block] = strain[a];
            }
            self.beta.start(k, slope, curvature);
            let s = stations[k];
            if k == lane && self.stations.get(k) == Some(&s) {
                // A station that stays where it was keeps its data.
                continue;
            }
            let place = self.place(s);
            set_lane(&mut self.places[block], lane_in_block, &place);
            for c in 0..cable_count {
                let offset = self.offset(c, s);
                let at = &mut self.cables[block * cable_count + c];
                at.offset.y.0[lane_in_block] = offset.y;
                at.offset.slope.0[lane_in_block] = offset.slope;
                at.offset.curvature.0[lane_in_block] = offset.curvature;
                at.tension.0[lane_in_block] = f64::from(u8::from(s <= self.ends[c]));
            }
        }
        self.stations.clear();
        self.stations.extend_from_slice(stations);
    }

    pub(crate) fn stations(&self) -> &[f64] {
        &self.stations
    }

    /// Strains at station `k`.
    pub(crate) fn strain(&self, k: usize) -> [f64; 3] {
        [0, 1, 2].map(|a| self.memory[k / LANES].strain[a].0[k % LANES])
    }

    /// Strains, and beta' and beta'', between the stages of element `i`, weighed by `weights`.
    pub(crate) fn remembered<const M: usize>(&self, i: usize, weights: &[f64; M]) -> ([f64; 3], [f64; 2]) {
        let mut strain = [0.0; 3];
        let mut beta = [0.0; 2];
        for (j, w) in weights.iter().enumerate() {
            let k = i * M + j;
            let own = self.strain(k);
            for a in 0..3 {
                strain[a] += w * own[a];
            }
            beta[0] += w * self.beta.slope[k];
            beta[1] += w * self.beta.curvature[k];
        }
        (strain, beta)
    }

    /// Strains of the unloaded arm at station `k`, mu times L.
    pub(crate) fn reference_strain(&self, k: usize) -> [f64; 3] {
        self.places[k / LANES].stiffness.reference.map(|v| v.0[k % LANES])
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
        let (block, lane) = (k / LANES, k % LANES);
        let place = &self.places[block];
        let [nu, eta, _] = self.strain(k);
        let stiffness = place.stiffness.value[2].0[lane] * self.beta.value[k] * self.beta.value[k];
        let alpha = eta.atan2(nu);
        let (sin, cos) = (z[0] + alpha).sin_cos();
        let compression = -(cos * z[1] + sin * z[2]) * rest * rest / stiffness;
        let stream = self.water.stream;
        let speed_square = stream[0] * stream[0] + stream[1] * stream[1];
        let drag = place.body.wetted.0[lane] * self.beta.value[k] * speed_square * nu.hypot(eta);
        let net = [0, 1].map(|c| {
            place.body.weight[c].0[lane]
                - place.body.displaced[c].0[lane] * nu * self.beta.value[k] * self.beta.value[k]
                + place.body.force[c].0[lane]
        });
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

    /// The other fraction is whole in the tension phase, zero in the loads phase.
    pub(crate) fn set_phase(&mut self, phase: Phase, fraction: f64) {
        self.phase = phase;
        self.fraction = match phase {
            Phase::Loads => [fraction, 0.0],
            Phase::Tension => [1.0, fraction],
            Phase::Stroke => [1.0, 1.0],
        };
    }

    /// The tension of cable `c` at the present fraction, in the unit of force.
    pub(crate) fn tension(&self, c: usize) -> f64 {
        self.tensions[c] * self.fraction[1]
    }

    /// The shortest part of element `i` that beta' can still be differentiated on.
    pub(crate) fn shortest_element(&self, i: usize) -> f64 {
        let own = i * self.stages..(i + 1) * self.stages;
        (4.0 * self.beta.reach[own].iter().fold(0.0_f64, |m, r| m.max(r.abs()))).max(1e-6)
    }

    /// Solves section law and loads at one place, for output between stations: state `z`, guess of
    /// the strains, beta' and beta''. `from_left` decides whether a cable that ends here still acts.
    pub(crate) fn at_place(
        &self,
        s: f64,
        from_left: bool,
        z: [f64; N],
        guess: [f64; 3],
        [mut beta_slope, beta_curvature]: [f64; 2],
    ) -> Result<AtPlace, SectionFailure> {
        let mut place = self.place(s);
        place.body.couple *= self.fraction[0];
        let cables: Vec<CableAt<f64>> = (0..self.tensions.len())
            .map(|c| {
                let runs = if from_left { s <= self.ends[c] + 1e-12 } else { s < self.ends[c] - 1e-12 };
                CableAt { offset: self.offset(c, s), tension: if runs { self.tension(c) } else { 0.0 } }
            })
            .collect();
        let (sin, cos) = z[0].sin_cos();
        let contact = [cos * z[1] + sin * z[2], cos * z[2] - sin * z[1], z[3]];
        let mut strain = guess;
        for round in 0.. {
            let solved = solve_section(
                self.volume,
                &place.stiffness,
                &cables,
                contact,
                strain,
                [beta_slope, beta_curvature],
                1e-13,
            );
            let fine = solved.step < 1e-9 && solved.regularity > 0.0 && solved.balance.openness > 0.0;
            if !fine {
                return Err(SectionFailure {
                    s,
                    openness: solved.balance.openness,
                    nu: solved.strain[0],
                    regularity: solved.regularity,
                });
            }
            strain = solved.strain;
            let load = self.load(&place, [cos, sin], &solved, beta_slope);
            let slopes = slopes(&place, [cos, sin], contact, &solved, &load);
            let change = (slopes.beta_slope - beta_slope).abs();
            beta_slope = slopes.beta_slope;
            if change < 1e-13 || round == 29 {
                let by_state = strain_by_state(&solved.inverse, [cos, sin], contact);
                let [nu, eta, _] = solved.strain;
                let rate = [nu * cos - eta * sin, nu * sin + eta * cos];
                return Ok(AtPlace {
                    strain,
                    beta: solved.balance.swelling.beta,
                    beta_slope,
                    contact: [0, 1, 2].map(|k| contact[k] - solved.balance.cables[k]),
                    openness: solved.balance.openness,
                    regularity: solved.regularity,
                    local: Local {
                        slope: slopes.slope,
                        jacobian: jacobian([cos, sin], contact, &solved, &load, &by_state),
                        rate,
                        rate_gradient: rate_gradient([cos, sin], rate, &by_state),
                    },
                    radius: place.body.radius,
                });
            }
        }
        unreachable!("the loop returns at its last round")
    }

    #[inline(always)]
    fn load<R: Real>(&self, place: &Place<R>, direction: [R; 2], solved: &Solved<R>, beta_slope: R) -> Load<R> {
        let mut load = load(&self.water, &place.body, direction, solved.strain, &solved.balance.swelling, beta_slope);
        let fraction = R::of(self.fraction[0]);
        for k in 0..2 {
            load.force[k] = load.force[k] * fraction;
            load.by_theta[k] = load.by_theta[k] * fraction;
            load.by_strain[k] = load.by_strain[k].map(|v| v * fraction);
            load.by_beta_slope[k] = load.by_beta_slope[k] * fraction;
        }
        load
    }
}

/// Everything at one place, in the solver's units.
#[derive(Clone)]
pub(crate) struct AtPlace {
    pub(crate) strain: [f64; 3],
    pub(crate) beta: f64,
    pub(crate) beta_slope: f64,
    /// n.a, n.b, m: what the body carries.
    pub(crate) contact: [f64; 3],
    /// Smallest tau.a / nu of the pulled cables.
    pub(crate) openness: f64,
    /// Determinant of the section law over that of the slack one.
    pub(crate) regularity: f64,
    pub(crate) local: Local<N, Q>,
    /// Undeformed radius.
    pub(crate) radius: f64,
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

/// Newton on the section law from a guess, every lane to `tolerance` or to its own limit.
#[inline(always)]
fn solve_section<R: Real + Lanewise>(
    volume: Volume,
    stiffness: &Stiffness<R>,
    cables: &[CableAt<R>],
    contact: [R; 3],
    guess: [R; 3],
    beta_along: [R; 2],
    tolerance: f64,
) -> Solved<R> {
    const SWIFT: usize = 8;
    const MOST: usize = 80;
    let mut strain = guess;
    let one = R::of(1.0);
    for round in 0.. {
        if round == SWIFT {
            strain = guess;
        }
        let balance = balance(volume, stiffness, cables, strain, beta_along);
        let (inverse, det) = inverse3(&balance.by_strain);
        let rest = [0, 1, 2].map(|k| contact[k] - balance.carried[k]);
        let step = apply3(&inverse, rest);
        // Never more than halve nu, close a cable's side by more than two thirds, or leap.
        let mu_scale = one / (R::of(2.0) + strain[2].abs());
        let size = step[0].abs().max(step[1].abs()).max(step[2].abs() * mu_scale);
        let mut share = one.min(R::of(0.5) * strain[0] / step[0].abs().max(R::of(1e-30)));
        share = share.min(R::of(0.7) / size.max(R::of(1e-30)));
        for cable in cables {
            let lever = cable.offset.y * balance.swelling.beta;
            let now = strain[0] - lever * strain[2];
            let lever_nu = cable.offset.y * balance.swelling.slope;
            let closing = (lever * step[2] + (lever_nu * strain[2] - one) * step[0]).max(R::of(1e-30));
            let allowed = R::of(0.67) * now.abs() / closing;
            let pulls = R::of(0.0).if_less(cable.tension, allowed, one);
            share = share.min(pulls);
            if round >= SWIFT {
                // Turn no cable by more than a fraction of a radian a round.
                let across = strain[1] + cable.offset.slope * balance.swelling.beta + cable.offset.y * beta_along[0];
                let stretch = (now * now + across * across).sqrt();
                let turning = (step[1] + cable.offset.slope * balance.swelling.slope * step[0]).abs();
                let allowed = R::of(0.3) * stretch / turning.max(R::of(1e-30));
                share = share.min(R::of(0.0).if_less(cable.tension, allowed, one));
            }
        }
        for k in 0..3 {
            strain[k] += share * step[k];
        }
        let size = size.if_less(R::of(f64::INFINITY), size, R::of(f64::INFINITY));
        if size.all_below(tolerance) || round == MOST {
            let area = balance.swelling.beta * balance.swelling.beta;
            let slack = stiffness.value[0] * stiffness.value[1] * stiffness.value[2] * area * area * area;
            return Solved { strain, balance, inverse, regularity: det / slack, step: size };
        }
    }
    unreachable!("the loop returns at its last round")
}

/// What a loop over lanes needs beyond arithmetic.
trait Lanewise {
    fn all_below(self, bound: f64) -> bool;
    fn max(self, other: Self) -> Self;
}

impl Lanewise for f64 {
    #[inline(always)]
    fn all_below(self, bound: f64) -> bool {
        self < bound
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self < other { other } else { self }
    }
}

impl Lanewise for Lanes {
    #[inline(always)]
    fn all_below(self, bound: f64) -> bool {
        self.0.iter().all(|v| *v < bound)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.if_less(other, other, self)
    }
}

struct Slopes<R> {
    slope: [R; N],
    beta_slope: R,
}

/// z' at a station, and beta' by implicit differentiation of the section law.
#[inline(always)]
fn slopes<R: Real>(
    place: &Place<R>,
    [cos, sin]: [R; 2],
    contact: [R; 3],
    solved: &Solved<R>,
    load: &Load<R>,
) -> Slopes<R> {
    let [nu, eta, mu] = solved.strain;
    let [n_a, n_b, _] = contact;
    let f = load.force;
    let m_slope = eta * n_a - nu * n_b - place.body.couple;
    // n_f . a and n_f . b turn with the directors.
    let f_a = cos * f[0] + sin * f[1];
    let f_b = cos * f[1] - sin * f[0];
    let contact_slope = [mu * n_b - f_a, -(mu * n_a + f_b), m_slope];
    let rest = [0, 1, 2].map(|k| contact_slope[k] - solved.balance.along_s[k]);
    let strain_slope = apply3(&solved.inverse, rest);
    Slopes { slope: [mu, -f[0], -f[1], m_slope], beta_slope: solved.balance.swelling.slope * strain_slope[0] }
}

impl Problem<N, Q> for Equilibrium {
    type Failure = SectionFailure;

    #[allow(clippy::too_many_lines, reason = "one pass over the stations: gather, solve, spread")]
    #[inline(always)]
    fn slopes(&mut self, z: &[[f64; N]], out: &mut [Local<N, Q>]) -> Result<(), SectionFailure> {
        let count = z.len();
        self.evaluations += count;
        self.nearness = Nearness::FAR;
        let cable_count = self.tensions.len();
        let fraction = Lanes::of(self.fraction[0]);
        let mut pulled: [CableAt<Lanes>; MOST_IN_PLACE] = [blank_cable(); MOST_IN_PLACE];
        let mut many: Vec<CableAt<Lanes>> = Vec::new();
        if cable_count > MOST_IN_PLACE {
            many.resize(cable_count, blank_cable());
        }
        for block in 0..self.places.len() {
            let mut place = self.places[block];
            place.body.couple = place.body.couple * fraction;
            let mut state = [Lanes::of(0.0); N];
            let mut beta_along = [Lanes::of(0.0); 2];
            for lane in 0..LANES {
                let k = (block * LANES + lane).min(count - 1);
                for a in 0..N {
                    state[a].0[lane] = z[k][a];
                }
                beta_along[1].0[lane] = self.beta.curvature[k];
            }
            let (sin, cos) = sin_cos(state[0]);
            let direction = [cos, sin];
            let pulled = if cable_count > MOST_IN_PLACE { &mut many[..] } else { &mut pulled[..] };
            let mut used = 0;
            for c in 0..cable_count {
                let tension = self.tensions[c] * self.fraction[1];
                if tension != 0.0 {
                    let mut cable = self.cables[block * cable_count + c];
                    cable.tension = cable.tension * Lanes::of(tension);
                    pulled[used] = cable;
                    used += 1;
                }
            }
            let pulled = &pulled[..used];
            let contact = [cos * state[1] + sin * state[2], cos * state[2] - sin * state[1], state[3]];

            // Start from the last strains moved along their tangent.
            let memory = &self.memory[block];
            let mut guess = memory.strain;
            let mut leap = Lanes::of(0.0);
            for a in 0..3 {
                let mut move_by = Lanes::of(0.0);
                for b in 0..N {
                    move_by += memory.by_state[a][b] * (state[b] - memory.z[b]);
                }
                let size = if a == 2 { move_by.abs() / (Lanes::of(2.0) + guess[2].abs()) } else { move_by.abs() };
                leap = leap.max(size);
                guess[a] += move_by;
            }
            for lane in 0..LANES {
                let k = (block * LANES + lane).min(count - 1);
                let mut moved = z[k];
                if leap.0[lane] > 0.3 || !leap.0[lane].is_finite() {
                    for a in 0..3 {
                        guess[a].0[lane] = memory.strain[a].0[lane];
                    }
                    moved = [0.0; N];
                } else {
                    for a in 0..N {
                        moved[a] -= memory.z[a].0[lane];
                    }
                }
                beta_along[0].0[lane] = self.beta.follow(k, moved);
            }

            let solved = solve_section(self.volume, &place.stiffness, pulled, contact, guess, beta_along, 1e-6);
            for lane in 0..LANES {
                let fine = solved.step.0[lane] < 1e-6
                    && solved.regularity.0[lane] > 0.0
                    && solved.balance.openness.0[lane] > 0.0
                    && solved.strain[0].0[lane] > 0.0;
                if !fine {
                    let k = (block * LANES + lane).min(count - 1);
                    return Err(SectionFailure {
                        s: self.stations[k],
                        openness: solved.balance.openness.0[lane],
                        nu: solved.strain[0].0[lane],
                        regularity: solved.regularity.0[lane],
                    });
                }
            }
            let load = self.load(&place, direction, &solved, beta_along[0]);
            let slopes = slopes(&place, direction, contact, &solved, &load);

            let by_state = strain_by_state(&solved.inverse, direction, contact);
            let jacobian = jacobian(direction, contact, &solved, &load, &by_state);
            let [nu, eta, _] = solved.strain;
            let rate = [nu * cos - eta * sin, nu * sin + eta * cos];
            let rate_gradient = rate_gradient(direction, rate, &by_state);
            // What moves at fixed z with beta': the strains, and all that follows from them.
            let strain_by_slope = apply3(&solved.inverse, solved.balance.by_curvature).map(|v| -v);
            let [nu_p, eta_p, mu_p] = strain_by_slope;
            let force_by_slope = |k: usize| {
                let by = load.by_strain[k];
                -(by[0] * nu_p + by[1] * eta_p + by[2] * mu_p + load.by_beta_slope[k])
            };
            let slope_by = [mu_p, force_by_slope(0), force_by_slope(1), contact[0] * eta_p - contact[1] * nu_p];
            let rate_by = [nu_p * cos - eta_p * sin, nu_p * sin + eta_p * cos];
            let swelling_slope = solved.balance.swelling.slope;
            let reach = swelling_slope * nu_p;
            let value_by = by_state[0].map(|v| swelling_slope * v);
            let (drift, nu_drift) = self.drift_of(block, contact, &solved, &load);
            let value_drift = swelling_slope * nu_drift;

            for lane in 0..LANES {
                let k = block * LANES + lane;
                if k >= count {
                    break;
                }
                let local = &mut out[k];
                for a in 0..N {
                    local.slope[a] = slopes.slope[a].0[lane];
                    for b in 0..N {
                        local.jacobian[a][b] = jacobian[a][b].0[lane];
                    }
                    self.drifts[k][a] = drift[a].0[lane];
                }
                for q in 0..Q {
                    local.rate[q] = rate[q].0[lane];
                    for b in 0..N {
                        local.rate_gradient[q][b] = rate_gradient[q][b].0[lane];
                    }
                }
                self.nearness.note(
                    self.stations[k],
                    solved.balance.openness.0[lane],
                    solved.strain[0].0[lane],
                    solved.regularity.0[lane],
                );
                self.beta.value[k] = solved.balance.swelling.beta.0[lane];
                self.beta.closed[k] = slopes.beta_slope.0[lane];
                self.beta.reach[k] = reach.0[lane];
                let by = &mut self.beta.coupling[k];
                by.slope = slope_by.map(|v| v.0[lane]);
                by.rate = rate_by.map(|v| v.0[lane]);
                by.value = value_by.map(|v| v.0[lane]);
                by.value_drift = value_drift.0[lane];
                self.switches[k] = [0, 1, 2].map(|w| load.switches[w].0[lane]);
            }
            self.memory[block] = Memory { z: state, strain: solved.strain, by_state };
        }
        self.beta.close(&self.steps, out, &mut self.drifts);
        Ok(())
    }

    #[inline(always)]
    fn drift(&mut self, out: &mut [[f64; N]]) {
        if !self.drift_by_share(out) {
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

/// Cables that fit on the stack; more are held in a vector.
const MOST_IN_PLACE: usize = 8;

#[inline(always)]
fn blank_cable() -> CableAt<Lanes> {
    let zero = Lanes([0.0; LANES]);
    CableAt { offset: Offset { y: zero, slope: zero, curvature: zero }, tension: zero }
}

impl Equilibrium {
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
                let strain = apply3(&solved.inverse, solved.balance.cables.map(|v| v * per));
                let by = |k: usize| {
                    -(load.by_strain[k][0] * strain[0]
                        + load.by_strain[k][1] * strain[1]
                        + load.by_strain[k][2] * strain[2])
                };
                ([strain[2], by(0), by(1), contact[0] * strain[1] - contact[1] * strain[0]], strain[0])
            }
        }
    }
}

/// d(nu, eta, mu)/dz: the law depends on z through n_f.a, n_f.b and m_f alone.
#[inline(always)]
fn strain_by_state<R: Real>(inverse: &[[R; 3]; 3], [cos, sin]: [R; 2], [n_a, n_b, _]: [R; 3]) -> [[R; N]; 3] {
    [0, 1, 2].map(|k| {
        let e = inverse[k];
        [e[0] * n_b - e[1] * n_a, e[0] * cos - e[1] * sin, e[0] * sin + e[1] * cos, e[2]]
    })
}

#[inline(always)]
fn jacobian<R: Real>(
    [cos, sin]: [R; 2],
    [n_a, n_b, _]: [R; 3],
    solved: &Solved<R>,
    load: &Load<R>,
    by_state: &[[R; N]; 3],
) -> [[R; N]; N] {
    let zero = R::of(0.0);
    let [nu, eta, _] = solved.strain;
    let mut out = [[zero; N]; N];
    out[0] = by_state[2];
    for b in 0..N {
        for k in 0..2 {
            out[k + 1][b] = -(load.by_strain[k][0] * by_state[0][b]
                + load.by_strain[k][1] * by_state[1][b]
                + load.by_strain[k][2] * by_state[2][b]);
        }
        out[3][b] = n_a * by_state[1][b] - n_b * by_state[0][b];
    }
    for k in 0..2 {
        out[k + 1][0] -= load.by_theta[k];
    }
    // n_a, n_b by theta: n_b, -n_a; by n_f: the directors.
    out[3][0] += eta * n_b + nu * n_a;
    out[3][1] += eta * cos + nu * sin;
    out[3][2] += eta * sin - nu * cos;
    out
}

#[inline(always)]
fn rate_gradient<R: Real>([cos, sin]: [R; 2], rate: [R; 2], by_state: &[[R; N]; 3]) -> [[R; N]; Q] {
    let mut out = [[R::of(0.0); N]; Q];
    for b in 0..N {
        out[0][b] = cos * by_state[0][b] - sin * by_state[1][b];
        out[1][b] = sin * by_state[0][b] + cos * by_state[1][b];
    }
    out[0][0] -= rate[1];
    out[1][0] += rate[0];
    out
}

fn splat(place: &Place<f64>) -> Place<Lanes> {
    let l = Lanes::of;
    let (s, b) = (&place.stiffness, &place.body);
    Place {
        stiffness: Stiffness {
            value: s.value.map(l),
            slope: s.slope.map(l),
            reference: s.reference.map(l),
            reference_slope: s.reference_slope.map(l),
        },
        body: Body {
            radius: l(b.radius),
            radius_slope: l(b.radius_slope),
            wetted: l(b.wetted),
            weight: b.weight.map(l),
            displaced: b.displaced.map(l),
            force: b.force.map(l),
            couple: l(b.couple),
        },
    }
}

fn set_lane(out: &mut Place<Lanes>, lane: usize, place: &Place<f64>) {
    let (s, b) = (&place.stiffness, &place.body);
    for k in 0..3 {
        out.stiffness.value[k].0[lane] = s.value[k];
        out.stiffness.slope[k].0[lane] = s.slope[k];
        out.stiffness.reference[k].0[lane] = s.reference[k];
        out.stiffness.reference_slope[k].0[lane] = s.reference_slope[k];
    }
    for k in 0..2 {
        out.body.weight[k].0[lane] = b.weight[k];
        out.body.displaced[k].0[lane] = b.displaced[k];
        out.body.force[k].0[lane] = b.force[k];
    }
    out.body.radius.0[lane] = b.radius;
    out.body.radius_slope.0[lane] = b.radius_slope;
    out.body.wetted.0[lane] = b.wetted;
    out.body.couple.0[lane] = b.couple;
}
