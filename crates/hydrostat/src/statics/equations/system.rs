//! Equations of one arm at given loads on a mesh, as the solver evaluates them.

use hydrostat_bvp::{Condition, EndPlace, Groups, Inner, LANES, Lanes, Local, Problem, Real, Station, each};

use super::gradients::{by_strain_change, in_directors, jacobian, rate_gradient, strain_by_state};
use super::limits::SectionFailure;
use super::place::{EndSection, Place};
use super::range::Varied;
use super::stroke_control::StrokeControl;
use crate::numerics::dispatch::each_block;
use crate::numerics::sincos::sin_cos;
use crate::rod::area_law::{SectionStretch, area_law};
use crate::rod::arm::Arm;
use crate::rod::cable_list::CableList;
use crate::rod::flow::Law;
use crate::rod::loads::{Load, Water, load, uniform};
use crate::rod::model_options::{FlowSurface, Support, Volume};
use crate::rod::profile::Profile;
use crate::rod::section::{CableAt, Stiffness, apply3};
use crate::rod::section_solve::{Solved, solve_section};
use crate::statics::dimensions::{L, N, Q, Units};
use crate::statics::friction::CapstanFactors;
use crate::statics::phase::Phase;

/// Steps of the section law that Newton's rounds on the arm leave to the next one.
const ROUGH: f64 = 1e-3;

/// Equations of one arm at given fractions of its loads, on a mesh.
#[derive(Debug, Clone)]
pub(crate) struct Equations {
    pub(crate) units: Units,
    pub(crate) arm: Arm,
    pub(crate) water: Water,
    pub(crate) volume: Volume,
    pub(crate) tensions: Vec<f64>,
    /// Arc length of each cable's anchor, over L.
    pub(super) ends: Vec<f64>,
    /// Fractions of the loads and of the tensions.
    pub(crate) fraction: [f64; 2],
    /// The phase whose fraction is the parameter, unless another one is varied.
    pub(crate) phase: Phase,
    pub(super) varied: Option<Varied>,
    /// Cables whose stroke is commanded, from where on these are.
    pub(crate) stroke_control: Option<StrokeControl>,
    /// What friction leaves of the tensions, if there is any.
    pub(crate) capstan: Option<CapstanFactors>,
    /// A couple over s/L that takes the place of the parameter, at every station.
    pub(super) imposed: Option<Vec<f64>>,
    /// Steps of the section law that are left to the next round.
    pub(crate) inner_tolerance: f64,
    /// How the stations stand in blocks of four.
    pub(crate) groups: Groups,
    pub(crate) stations: Vec<f64>,
    pub(crate) places: Vec<Place<Lanes>>,
    pub(super) cables: Vec<CableAt<Lanes>>,
    /// The ends at which elements meet the section law, in blocks, and what is there.
    pub(crate) end_places: Vec<EndPlace>,
    pub(crate) end_sections: Vec<EndSection>,
    pub(crate) end_cables: Vec<CableAt<Lanes>>,
    /// A chosen shape, with the loads that make it an equilibrium.
    #[cfg(test)]
    pub(crate) manufactured: Option<crate::statics::engine::manufactured::Manufactured>,
}

impl Equations {
    /// The equations of `arm` (already checked), with all loads whole.
    pub(crate) fn new(arm: &Arm, stages: usize) -> Self {
        let length = arm.length;
        let mut this = Self {
            units: Units { length, force: 1.0 },
            water: water(arm),
            volume: arm.model.volume,
            tensions: Vec::new(),
            ends: arm.cables.iter().map(|c| c.end).collect(),
            arm: arm.clone(),
            fraction: [1.0, 1.0],
            phase: Phase::Tension,
            varied: None,
            stroke_control: None,
            capstan: None,
            imposed: None,
            inner_tolerance: ROUGH,
            groups: Groups { elements: 0, stages },
            stations: Vec::new(),
            places: Vec::new(),
            cables: Vec::new(),
            end_places: Vec::new(),
            end_sections: Vec::new(),
            end_cables: Vec::new(),
            #[cfg(test)]
            manufactured: None,
        };
        let bending = this.place(0.0).stiffness.value[2];
        // At unit force the stiffness is C3 A0 / L^2: make it one at the base.
        this.units.force = bending;
        this.set_tensions();
        this
    }

    /// Takes another unit of force, N, before anything is placed.
    pub(crate) fn set_force_unit(&mut self, force: f64) {
        self.units.force = force;
        self.set_tensions();
    }

    /// The same equations with steps of the section law left up to `inner_tolerance`.
    pub(crate) fn leaving(self, inner_tolerance: f64) -> Self {
        Self { inner_tolerance, ..self }
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

    pub(super) fn set_tensions(&mut self) {
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
        let of_friction = self.capstan.as_ref().map_or(0.0, |capstan| capstan.of_friction);
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
        for (i, c) in self.stroke_control.iter().flat_map(|stroke_control| stroke_control.cables.iter().enumerate()) {
            let stroke =
                self.stroke_control.as_ref().map(|stroke_control| self.command(stroke_control, i) * self.units.length);
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

    /// Pieces of work that an evaluation of a station is.
    pub(crate) fn work(&self) -> usize {
        self.arm.cost_factor()
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
        let along = !(a.distributed.force.iter().all(Profile::is_zero) && a.distributed.couple.is_zero());
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
        self.set_stroke_fraction(phase, fraction);
    }

    /// The tension of cable `c` at the present fraction, in the unit of force.
    pub(crate) fn tension(&self, c: usize) -> f64 {
        self.tensions[c] * self.fraction[1]
    }

    /// Whether beta' enters the equations.
    pub(crate) fn is_closed(&self) -> bool {
        let lateral = self.arm.model.flow_surface == FlowSurface::Lateral && self.water.stream != [0.0; 2];
        self.volume != Volume::None && (!self.tensions.is_empty() || lateral)
    }

    #[inline(always)]
    pub(super) fn load<R: Real>(
        &self,
        place: &Place<R>,
        direction: [R; 2],
        strain: [R; 3],
        section_stretch: &SectionStretch<R>,
        beta_slope: R,
    ) -> Load<R> {
        let stream = uniform(&self.water);
        let mut load = load(&self.water, &place.body, stream, direction, strain, section_stretch, beta_slope);
        let fraction = R::of(self.fraction[0]);
        for k in 0..2 {
            load.force[k] = load.force[k] * fraction;
            load.by_theta[k] = load.by_theta[k] * fraction;
            load.by_strain[k] = each(|c| load.by_strain[k][c] * fraction);
            load.by_beta_slope[k] = load.by_beta_slope[k] * fraction;
        }
        load
    }

    /// Speeds whose change of sign kinks the load in a block of stations, see [`Load::switches`].
    #[inline(always)]
    pub(crate) fn switches(&self, block: usize, station: &Station<N, L>) -> [Lanes; 3] {
        let (sin, cos) = sin_cos(station.z[0]);
        let section_stretch = area_law(self.volume, station.inner[0]);
        let (body, stream) = (&self.places[block].body, uniform(&self.water));
        load(&self.water, body, stream, [cos, sin], station.inner, &section_stretch, station.closure_slope).switches
    }

    /// Strains of the unloaded arm at station `k`, mu times L.
    pub(crate) fn reference_strain(&self, k: usize) -> [f64; 3] {
        let (block, lane) = self.groups.station(k);
        self.places[block].stiffness.reference.map(|v| v.0[lane])
    }

    /// The reference strains in a block of stations.
    pub(crate) fn reference_in(&self, block: usize) -> [Lanes; L] {
        self.places[block].stiffness.reference
    }

    /// Place (over L), nu and mu (times L), and beta R (over L), in a lane of a block.
    pub(crate) fn stretched(&self, block: usize, station: &Station<N, L>, lane: usize) -> (f64, [f64; 2], f64) {
        let (place, [nu, _, mu]) = (&self.places[block], station.inner);
        let half_width = area_law(self.volume, nu).beta * place.body.radius;
        (place.s.0[lane], [nu.0[lane], mu.0[lane]], half_width.0[lane])
    }

    /// Strain measure 1/2 (C1 (nu-nu_o)^2 + C2 (eta-eta_o)^2 + C3 (mu-mu_o)^2) A per length in a block of stations.
    #[inline(always)]
    pub(crate) fn strain_energy(&self, block: usize, station: &Station<N, L>) -> Lanes {
        let stiffness = &self.places[block].stiffness;
        let strain = station.inner;
        let beta = area_law(self.volume, strain[0]).beta;
        let mut sum = Lanes::of(0.0);
        for a in 0..3 {
            let strained = strain[a] - stiffness.reference[a];
            sum += Lanes::of(0.5) * stiffness.value[a] * beta * beta * strained * strained;
        }
        sum
    }

    /// Fills `out` with the cables that pull in a block of stations, given all of them there.
    #[inline(always)]
    pub(crate) fn pulled_in(&self, cables: &[CableAt<Lanes>], out: &mut CableList<Lanes>) {
        out.clear();
        for (cable, tension) in cables.iter().zip(&self.tensions) {
            let tension = tension * self.fraction[1];
            if tension != 0.0 {
                out.push(CableAt { tension: cable.tension * Lanes::of(tension), ..*cable });
            }
        }
    }

    /// The cables of a block of stations.
    #[inline(always)]
    pub(crate) fn cables_in(&self, block: usize) -> &[CableAt<Lanes>] {
        let count = self.tensions.len();
        &self.cables[block * count..(block + 1) * count]
    }

    /// The section in a block, near `strain`.
    #[inline(always)]
    pub(super) fn solved_in(
        &self,
        block: usize,
        station: &Station<N, L>,
        pulled: &mut CableList<Lanes>,
    ) -> ([Lanes; 2], [Lanes; 3], Solved<Lanes>) {
        self.pulled_in(self.cables_in(block), pulled);
        self.solved(&self.places[block].stiffness, station, pulled)
    }

    /// Direction of a section, what it carries in its directors, and its law near the strains of a station, whose first
    /// states are those of the statics.
    #[inline(always)]
    pub(crate) fn solved<const S: usize>(
        &self,
        stiffness: &Stiffness<Lanes>,
        station: &Station<S, L>,
        pulled: &CableList<Lanes>,
    ) -> ([Lanes; 2], [Lanes; 3], Solved<Lanes>) {
        let (sin, cos) = sin_cos(station.z[0]);
        let z: [Lanes; N] = each(|a| station.z[a]);
        let contact = in_directors([cos, sin], &z);
        let solved = solve_section(
            self.volume,
            stiffness,
            pulled.as_slice(),
            contact,
            station.inner,
            station.closure_slope,
            self.inner_tolerance,
        );
        ([cos, sin], contact, solved)
    }

    /// The stations of a block.
    #[inline(always)]
    fn block(
        &self,
        block: usize,
        station: &mut Station<N, L>,
        pulled: &mut CableList<Lanes>,
        out: &mut Local<N, Q, L, Lanes>,
    ) -> Result<(), SectionFailure> {
        let place = &self.places[block];
        let (direction, contact, solved) = self.solved_in(block, station, pulled);
        if !solved.is_solved(self.inner_tolerance) {
            return Err(failure(place.s, &solved, self.inner_tolerance));
        }
        let [cos, sin] = direction;
        let [nu, eta, mu] = solved.strain;
        let beta_slope = station.closure_slope;
        let load = self.load(place, direction, solved.strain, &solved.balance.section_stretch, beta_slope);
        let couple = place.body.couple * Lanes::of(self.fraction[0]);
        let by_state = strain_by_state(&solved.inverse, direction, contact);
        let rate = [nu * cos - eta * sin, nu * sin + eta * cos];
        // With the step of the strains, to first order.
        let by_change = by_strain_change(&load, contact, solved.change);
        out.slope = [mu, -load.force[0], -load.force[1], eta * contact[0] - nu * contact[1] - couple];
        for a in 0..N {
            out.slope[a] += by_change[a];
        }
        out.jacobian = jacobian(direction, contact, &solved, &load, &by_state);
        let rates = |[nu, eta, _]: [Lanes; 3]| [nu * cos - eta * sin, nu * sin + eta * cos];
        let rate_change = rates(solved.change);
        out.rate = each(|q| rate[q] + rate_change[q]);
        out.rate_gradient = rate_gradient(direction, rate, &by_state);
        out.inner = inner(&solved, by_state);
        out.by_closure = by_strain_change(&load, contact, out.inner.by_closure);
        for k in 0..2 {
            out.by_closure[1 + k] -= load.by_beta_slope[k];
        }
        out.rate_by_closure = rates(out.inner.by_closure);
        station.inner = solved.strain;
        Ok(())
    }

    /// All stages. Compiled once, for collocations of every order.
    #[inline(never)]
    fn all_stages(
        &self,
        stations: &mut [Station<N, L>],
        out: &mut [Local<N, Q, L, Lanes>],
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
    fn all_ends(&self, stations: &mut [Station<N, L>], out: &mut [Inner<N, L, Lanes>]) -> Result<(), SectionFailure> {
        let mut pulled = CableList::new();
        let count = self.tensions.len();
        each_block(
            stations,
            out,
            #[inline(always)]
            |block, station, out| {
                let section = &self.end_sections[block];
                self.pulled_in(&self.end_cables[block * count..(block + 1) * count], &mut pulled);
                let (direction, contact, solved) = self.solved(&section.stiffness, station, &pulled);
                if !solved.is_solved(self.inner_tolerance) {
                    return Err(failure(section.s, &solved, self.inner_tolerance));
                }
                *out = inner(&solved, strain_by_state(&solved.inverse, direction, contact));
                station.inner = solved.strain;
                Ok(())
            },
        )
    }
}

/// The section law linearised and solved for the strains, which follow the state by `by_state`.
#[inline(always)]
pub(crate) fn inner<const S: usize>(solved: &Solved<Lanes>, by_state: [[Lanes; S]; 3]) -> Inner<S, L, Lanes> {
    let section_stretch = &solved.balance.section_stretch;
    let less = apply3(&solved.inverse, solved.balance.by_beta_slope);
    let mut value_gradient = [Lanes::of(0.0); S];
    for a in 0..S {
        value_gradient[a] = section_stretch.slope * by_state[0][a];
    }
    Inner {
        change: solved.change,
        gradient: by_state,
        by_closure: each(|k| -less[k]),
        value: section_stretch.beta,
        value_change: section_stretch.slope * solved.change[0],
        value_gradient,
        reach: -(section_stretch.slope * less[0]),
    }
}

/// The first station of a block, along the arm, that could not be solved.
#[cold]
#[inline(never)]
pub(crate) fn failure(s: Lanes, solved: &Solved<Lanes>, tolerance: f64) -> SectionFailure {
    let lane = (0..LANES).find(|lane| !solved.is_solved_in(*lane, tolerance)).unwrap_or(0);
    SectionFailure {
        s: s.0[lane],
        openness: solved.balance.openness.0[lane],
        nu: solved.strain[0].0[lane],
        regularity: solved.regularity.0[lane],
    }
}

impl Problem<N, Q, L> for Equations {
    type Failure = SectionFailure;

    fn is_closed(&self) -> bool {
        self.is_closed()
    }

    fn stages<const FUSED: bool>(
        &self,
        _: Groups,
        stations: &mut [Station<N, L>],
        out: &mut [Local<N, Q, L, Lanes>],
    ) -> Result<(), SectionFailure> {
        self.all_stages(stations, out)
    }

    fn ends<const FUSED: bool>(
        &self,
        _: &[EndPlace],
        stations: &mut [Station<N, L>],
        out: &mut [Inner<N, L, Lanes>],
    ) -> Result<(), SectionFailure> {
        self.all_ends(stations, out)
    }

    fn left_count(&self) -> usize {
        match self.arm.model.support {
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

pub(crate) fn water(arm: &Arm) -> Water {
    let r = &arm.model;
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
