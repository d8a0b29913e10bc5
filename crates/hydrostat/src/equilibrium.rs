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

use hydrostat_bvp::{Condition, Gauss, Groups, LANES, Lanes, Local, Mesh, Problem, Real, each};

use crate::arm::{Arm, Cavity, Material, TipLoad};
use crate::beta_along::{BetaAlong, Coupling};
use crate::cable::{Offset, tangent};
use crate::flow::Law;
use crate::loads::{Body, Load, Water, load};
use crate::readings::{Support, Volume};
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

/// [`Nearness`] lane by lane: openness, stretch, determinant.
struct NearnessLanes {
    least: [Lanes; 3],
    s: [Lanes; 3],
}

impl NearnessLanes {
    #[inline(always)]
    fn far() -> Self {
        let infinity = Lanes::of(f64::INFINITY);
        Self { least: [Lanes::of(1.0), infinity, infinity], s: [Lanes::of(0.0); 3] }
    }

    #[inline(always)]
    fn note(&mut self, s: Lanes, values: [Lanes; 3]) {
        for k in 0..3 {
            self.s[k] = values[k].if_less(self.least[k], s, self.s[k]);
            self.least[k] = values[k].min(self.least[k]);
        }
    }

    /// The nearest of all lanes, of the equally near the first along the arm.
    fn nearest(&self) -> Nearness {
        let [openness, nu, regularity] = [0, 1, 2].map(|k| {
            let each = (0..LANES).map(|lane| (self.least[k].0[lane], self.s[k].0[lane]));
            each.reduce(|a, b| if b < a { b } else { a }).unwrap_or((f64::INFINITY, 0.0))
        });
        Nearness { openness, nu, regularity }
    }
}

/// One place of the arm as data.
#[derive(Debug, Clone, Copy)]
struct Place<R> {
    /// Over L.
    s: R,
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

impl Solved<Lanes> {
    /// Whether all lanes are.
    #[inline(always)]
    fn fine(&self) -> bool {
        let positive = self.regularity.min(self.balance.openness).min(self.strain[0]);
        // A number that is none is below nothing.
        self.step.all_below(STATION) & (-positive).all_below(0.0) & (-self.regularity).all_below(0.0)
    }

    #[inline(always)]
    fn fine_in(&self, lane: usize) -> bool {
        let positive = [self.regularity, self.balance.openness, self.strain[0]];
        (self.step.0[lane] < STATION) & positive.iter().all(|v| v.0[lane] > 0.0)
    }
}

/// The last Newton step of the section law that stations are content with.
const STATION: f64 = 1e-6;

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
            self.take_sections();
        }
    }

    /// Takes the arm's sections at all stations.
    fn take_sections(&mut self) {
        for block in 0..self.places.len() {
            for lane in 0..LANES {
                let place = self.place(self.stations[self.groups.station_in(block, lane)]);
                set_lane(&mut self.places[block], lane, &place);
            }
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

    /// |tau| of cable `c` in a block of stations, now and at the reference strains.
    #[inline(always)]
    pub(crate) fn cable_stretch(&self, c: usize, block: usize) -> [Lanes; 2] {
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
        Place { s, stiffness, body }
    }

    fn offset(&self, cable: usize, s: f64) -> Offset<f64> {
        let l = self.units.length;
        let p = self.arm.cables[cable].offset.at(s * l, l);
        Offset { y: p.value / l, slope: p.slope, curvature: p.curvature * l }
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
        let memory = Memory { z: [zero; N], strain: [zero; 3], by_state: [[zero; N]; 3] };
        self.memory.clear();
        self.memory.resize(blocks, memory);
        if self.places.len() < blocks {
            let blank = splat(&self.place(stations[0]));
            self.places.resize(blocks, blank);
        }
        self.places.truncate(blocks);
        self.cables.resize(blocks * cable_count, blank_cable());
        self.steps.resize(groups.count(), zero);
        self.beta.resize(blocks);
        self.switches.resize(blocks, [zero; 3]);
        self.drifts.resize(blocks, [zero; N]);
        for group in 0..groups.count() {
            for lane in 0..LANES {
                let i = groups.element(group, lane);
                self.steps[group].0[lane] = mesh.step(i);
                for j in 0..stages {
                    let (block, k) = (group * stages + j, i * stages + j);
                    let (strain, slope, curvature) = guess(k);
                    for a in 0..3 {
                        self.memory[block].strain[a].0[lane] = strain[a];
                    }
                    self.beta.start(block, lane, slope, curvature);
                    // A station that stays where it was keeps its data.
                    let own = group * LANES + lane == i && i < before;
                    if !(own && self.stations[k] == stations[k]) {
                        self.place_station(block, lane, stations[k]);
                    }
                }
            }
        }
        self.stations.clear();
        self.stations.extend_from_slice(stations);
    }

    /// Takes the data at `s` into a lane of a block.
    fn place_station(&mut self, block: usize, lane: usize, s: f64) {
        let place = self.place(s);
        set_lane(&mut self.places[block], lane, &place);
        let cable_count = self.tensions.len();
        for c in 0..cable_count {
            let offset = self.offset(c, s);
            let at = &mut self.cables[block * cable_count + c];
            at.set_offset(lane, &offset);
            at.tension.0[lane] = f64::from(u8::from(s <= self.ends[c]));
        }
    }

    pub(crate) fn stations(&self) -> &[f64] {
        &self.stations
    }

    /// Strains at station `k`.
    pub(crate) fn strain(&self, k: usize) -> [f64; 3] {
        let (block, lane) = self.groups.station(k);
        self.memory[block].strain.map(|v| v.0[lane])
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
        let net = [0, 1].map(|c| {
            place.body.weight[c].0[lane] - place.body.displaced[c].0[lane] * nu * beta * beta
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
        };
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

    /// Solves section law and loads at one place, for output between stations.
    pub(crate) fn at_place(&self, asked: &Asked) -> Result<AtPlace, SectionFailure> {
        let mut place = self.place(asked.s);
        place.body.couple *= self.fraction[0];
        let pulled = (0..self.tensions.len()).filter(|c| self.acts_at(*c, asked));
        let cables: Vec<CableAt<f64>> =
            pulled.map(|c| CableAt { offset: self.offset(c, asked.s), tension: self.tension(c) }).collect();
        let (sin, cos) = asked.z[0].sin_cos();
        let (at, fine) = self.solve_place(&place, &cables, [cos, sin], asked.z, asked.strain, asked.beta);
        if fine {
            Ok(at)
        } else {
            Err(SectionFailure { s: asked.s, openness: at.openness, nu: at.strain[0], regularity: at.regularity })
        }
    }

    /// [`Equilibrium::at_place`] at four places; `None` when one of them has no solution.
    #[inline(always)]
    pub(crate) fn at_places(&self, asked: &[Asked; LANES]) -> Option<AtPlace<Lanes>> {
        let zero = Lanes::of(0.0);
        let mut place = splat(&self.place(asked[0].s));
        let mut cables = Vec::with_capacity(self.tensions.len());
        let (mut z, mut strain, mut beta) = ([zero; N], [zero; 3], [zero; 2]);
        for lane in 0..LANES {
            let asked = &asked[lane];
            if lane > 0 {
                set_lane(&mut place, lane, &self.place(asked.s));
            }
            for a in 0..N {
                z[a].0[lane] = asked.z[a];
            }
            for a in 0..3 {
                strain[a].0[lane] = asked.strain[a];
            }
            for a in 0..2 {
                beta[a].0[lane] = asked.beta[a];
            }
        }
        place.body.couple = place.body.couple * Lanes::of(self.fraction[0]);
        for c in 0..self.tensions.len() {
            let mut cable = blank_cable();
            for lane in 0..LANES {
                if self.acts_at(c, &asked[lane]) {
                    cable.tension.0[lane] = self.tension(c);
                }
                cable.set_offset(lane, &self.offset(c, asked[lane].s));
            }
            if cable.tension != zero {
                cables.push(cable);
            }
        }
        let (sin, cos) = sin_cos(z[0]);
        let (at, fine) = self.solve_place(&place, &cables, [cos, sin], z, strain, beta);
        fine.then_some(at)
    }

    /// Whether cable `c` pulls at a place.
    fn acts_at(&self, c: usize, asked: &Asked) -> bool {
        let runs = if asked.from_left { asked.s <= self.ends[c] + 1e-12 } else { asked.s < self.ends[c] - 1e-12 };
        runs && self.tension(c) != 0.0
    }

    /// Everything at places, and whether it could be solved at all of them.
    #[inline(always)]
    fn solve_place<R: Real>(
        &self,
        place: &Place<R>,
        cables: &[CableAt<R>],
        [cos, sin]: [R; 2],
        z: [R; N],
        mut strain: [R; 3],
        [mut beta_slope, beta_curvature]: [R; 2],
    ) -> (AtPlace<R>, bool) {
        let contact = [cos * z[1] + sin * z[2], cos * z[2] - sin * z[1], z[3]];
        for round in 0.. {
            let beta = [beta_slope, beta_curvature];
            let solved = solve_section(self.volume, &place.stiffness, cables, contact, strain, beta, 1e-13);
            let fine = solved.step.all_below(1e-9)
                && (-solved.regularity).all_below(0.0)
                && (-solved.balance.openness).all_below(0.0);
            strain = solved.strain;
            let load = self.load(place, [cos, sin], &solved, beta_slope);
            let slopes = slopes(place.body.couple, [cos, sin], contact, &solved, &load);
            let change = (slopes.beta_slope - beta_slope).abs();
            beta_slope = slopes.beta_slope;
            if change.all_below(1e-13) || round == 29 || !fine {
                let by_state = strain_by_state(&solved.inverse, [cos, sin], contact);
                let [nu, eta, _] = solved.strain;
                let rate = [nu * cos - eta * sin, nu * sin + eta * cos];
                let at = AtPlace {
                    strain,
                    beta: solved.balance.swelling.beta,
                    beta_slope,
                    contact: each(|k| contact[k] - solved.balance.cables[k]),
                    openness: solved.balance.openness,
                    regularity: solved.regularity,
                    local: Local {
                        slope: slopes.slope,
                        jacobian: jacobian([cos, sin], contact, &solved, &load, &by_state),
                        rate,
                        rate_gradient: rate_gradient([cos, sin], rate, &by_state),
                    },
                    radius: place.body.radius,
                };
                return (at, fine);
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
            load.by_strain[k] = each(|c| load.by_strain[k][c] * fraction);
            load.by_beta_slope[k] = load.by_beta_slope[k] * fraction;
        }
        load
    }
}

/// A place between stations, and what is known there.
#[derive(Clone, Copy)]
pub(crate) struct Asked {
    /// Over L.
    pub(crate) s: f64,
    /// Decides whether a cable that ends here still acts.
    pub(crate) from_left: bool,
    pub(crate) z: [f64; N],
    /// A guess of the strains.
    pub(crate) strain: [f64; 3],
    /// beta' and beta''.
    pub(crate) beta: [f64; 2],
}

/// Everything at one place, or at four, in the solver's units.
#[derive(Clone)]
pub(crate) struct AtPlace<R = f64> {
    pub(crate) strain: [R; 3],
    pub(crate) beta: R,
    pub(crate) beta_slope: R,
    /// n.a, n.b, m: what the body carries.
    pub(crate) contact: [R; 3],
    /// Smallest tau.a / nu of the pulled cables.
    pub(crate) openness: R,
    /// Determinant of the section law over that of the slack one.
    pub(crate) regularity: R,
    pub(crate) local: Local<N, Q, R>,
    /// Undeformed radius.
    pub(crate) radius: R,
}

impl AtPlace<Lanes> {
    /// That of one of the four places.
    pub(crate) fn lane(&self, lane: usize) -> AtPlace {
        AtPlace {
            strain: self.strain.map(|v| v.0[lane]),
            beta: self.beta.0[lane],
            beta_slope: self.beta_slope.0[lane],
            contact: self.contact.map(|v| v.0[lane]),
            openness: self.openness.0[lane],
            regularity: self.regularity.0[lane],
            local: self.local.lane(lane),
            radius: self.radius.0[lane],
        }
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

/// Newton on the section law from a guess, every lane to `tolerance` or to its own limit.
#[inline(always)]
fn solve_section<R: Real>(
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
        let rest = each(|k| contact[k] - balance.carried[k]);
        let step = apply3(&inverse, rest);
        let mu_scale = one / (R::of(2.0) + strain[2].abs());
        let size = step[0].abs().max(step[1].abs()).max(step[2].abs() * mu_scale);
        let share = if round < SWIFT && is_short(&balance, cables, strain, step, size) {
            one
        } else {
            share_of(&balance, cables, strain, step, size, (round >= SWIFT).then_some(beta_along[0]))
        };
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

/// Whether [`share_of`] is one, in every lane and for little more than the section law's first rounds need.
#[inline(always)]
fn is_short<R: Real>(balance: &Balance<R>, cables: &[CableAt<R>], strain: [R; 3], step: [R; 3], size: R) -> bool {
    let mut excess = (size - R::of(0.7)).max(step[0].abs() - R::of(0.5) * strain[0]);
    for cable in cables {
        let (now, closing) = side(balance, cable, strain, step);
        excess = excess.max(closing - R::of(0.67) * now.abs());
    }
    excess.all_below(0.0)
}

/// tau . a of a cable, and how much of it a step takes away.
#[inline(always)]
fn side<R: Real>(balance: &Balance<R>, cable: &CableAt<R>, strain: [R; 3], step: [R; 3]) -> (R, R) {
    let lever = cable.offset.y * balance.swelling.beta;
    let lever_nu = cable.offset.y * balance.swelling.slope;
    (strain[0] - lever * strain[2], lever * step[2] + (lever_nu * strain[2] - R::of(1.0)) * step[0])
}

/// The share of a step of the section law that neither more than halves nu, nor closes a cable's side by more than
/// two thirds, nor leaps; with beta' also turns no cable by more than a fraction of a radian.
#[inline(always)]
fn share_of<R: Real>(
    balance: &Balance<R>,
    cables: &[CableAt<R>],
    strain: [R; 3],
    step: [R; 3],
    size: R,
    turning_at: Option<R>,
) -> R {
    let one = R::of(1.0);
    let mut share = one.min(R::of(0.5) * strain[0] / step[0].abs().max(R::of(1e-30)));
    share = share.min(R::of(0.7) / size.max(R::of(1e-30)));
    for cable in cables {
        let (now, closing) = side(balance, cable, strain, step);
        let allowed = R::of(0.67) * now.abs() / closing.max(R::of(1e-30));
        share = share.min(R::of(0.0).if_less(cable.tension, allowed, one));
        if let Some(beta_slope) = turning_at {
            let swelling = &balance.swelling;
            let across = strain[1] + cable.offset.slope * swelling.beta + cable.offset.y * beta_slope;
            let stretch = (now * now + across * across).sqrt();
            let turning = (step[1] + cable.offset.slope * swelling.slope * step[0]).abs();
            let allowed = R::of(0.3) * stretch / turning.max(R::of(1e-30));
            share = share.min(R::of(0.0).if_less(cable.tension, allowed, one));
        }
    }
    share
}

struct Slopes<R> {
    slope: [R; N],
    beta_slope: R,
}

/// z' at a station, and beta' by implicit differentiation of the section law.
#[inline(always)]
fn slopes<R: Real>(couple: R, [cos, sin]: [R; 2], contact: [R; 3], solved: &Solved<R>, load: &Load<R>) -> Slopes<R> {
    let [nu, eta, mu] = solved.strain;
    let [n_a, n_b, _] = contact;
    let f = load.force;
    let m_slope = eta * n_a - nu * n_b - couple;
    // n_f . a and n_f . b turn with the directors.
    let f_a = cos * f[0] + sin * f[1];
    let f_b = cos * f[1] - sin * f[0];
    let contact_slope = [mu * n_b - f_a, -(mu * n_a + f_b), m_slope];
    let rest = each(|k| contact_slope[k] - solved.balance.along_s[k]);
    let strain_slope = apply3(&solved.inverse, rest);
    Slopes { slope: [mu, -f[0], -f[1], m_slope], beta_slope: solved.balance.swelling.slope * strain_slope[0] }
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
        self.evaluations += groups.elements * groups.stages;
        let mut near = NearnessLanes::far();
        let cable_count = self.tensions.len();
        let mut few: [CableAt<Lanes>; MOST_IN_PLACE] = [blank_cable(); MOST_IN_PLACE];
        let mut many: Vec<CableAt<Lanes>> = Vec::new();
        if cable_count > MOST_IN_PLACE {
            many.resize(cable_count, blank_cable());
        }
        let pulled = if cable_count > MOST_IN_PLACE { &mut many[..] } else { &mut few[..] };
        for (block, (z, out)) in z.iter().zip(out.iter_mut()).enumerate() {
            let mut used = 0;
            for c in 0..cable_count {
                let tension = self.tensions[c] * self.fraction[1];
                if tension != 0.0 {
                    pulled[used] = self.cables[block * cable_count + c];
                    pulled[used].tension = pulled[used].tension * Lanes::of(tension);
                    used += 1;
                }
            }
            let solved = self.block(block, z, &pulled[..used], &mut near, out);
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
        let zero = Lanes::of(0.0);
        let state = *z;
        let place = &self.places[block];
        let couple = place.body.couple * Lanes::of(self.fraction[0]);
        let (sin, cos) = sin_cos(state[0]);
        let direction = [cos, sin];
        let contact = [cos * state[1] + sin * state[2], cos * state[2] - sin * state[1], state[3]];

        // Start from the last strains moved along their tangent.
        let memory = &self.memory[block];
        let mut moved = [zero; N];
        for a in 0..N {
            moved[a] = state[a] - memory.z[a];
        }
        let mut guess = memory.strain;
        let mut leap = zero;
        for a in 0..3 {
            let mut move_by = zero;
            for b in 0..N {
                move_by += memory.by_state[a][b] * moved[b];
            }
            let size = if a == 2 { move_by.abs() / (Lanes::of(2.0) + guess[2].abs()) } else { move_by.abs() };
            leap = leap.max(size);
            guess[a] += move_by;
        }
        let near_enough = Lanes::of(0.3);
        for a in 0..3 {
            guess[a] = leap.if_less(near_enough, guess[a], memory.strain[a]);
        }
        for a in 0..N {
            moved[a] = leap.if_less(near_enough, moved[a], zero);
        }
        let beta_along = [self.beta.followed(block, &moved), self.beta.curvature[block]];

        let solved = solve_section(self.volume, &place.stiffness, pulled, contact, guess, beta_along, STATION);
        if !solved.fine() {
            return Err(self.failure(block, &solved));
        }
        let load = self.load(place, direction, &solved, beta_along[0]);
        let slopes = slopes(couple, direction, contact, &solved, &load);

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
        self.memory[block] = Memory { z: state, strain: solved.strain, by_state };
        Ok(())
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
            Phase::Tension => {
                let f = self.fraction[1];
                let per = Lanes::of(if f == 0.0 { 0.0 } else { -1.0 / f });
                let strain = apply3(&solved.inverse, each(|k| solved.balance.cables[k] * per));
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
    each(|k| {
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
        s: l(place.s),
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
    out.s.0[lane] = place.s;
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
