//! The boundary-value problem of one stage in space.
//!
//! ```text
//! q'   = 1/2 q (0, u)                         n_f' = -f(U - r.) + rho_arm A_m r.. + M p - rho_w d A U.
//! r'   = nu a + eta b + zeta c                m_f' = -r' x n_f - couple + d/dt (J omega)
//! ```
//!
//! as in the plane ([`crate::motion::equations`]), with the states (q, n_f, m_f, r), the first ten those of the
//! statics. What turns a station is known to the time method as c, the rotation from where the step started
//! ([`Turn`]): c. = cv c + hv and so on, and omega follows from c and c. .

use hydrostat_bvp::{Condition, EndPlace, Gauss, Groups, Inner, Lanes, Local, Problem, Real, Solution, Station, each};

use crate::motion::history::{History, Layout};
use crate::motion::relaxation::stiffened;
use crate::motion::settling::Settling;
use crate::numerics::dispatch::each_block;
use crate::rod::area_law::SectionStretch;
use crate::rod::arm::Arm;
use crate::rod::inertia::Masses;
use crate::rod::model_options::Volume;
use crate::rod::profile::Profile;
use crate::spatial::equations::{
    AtStation, Equations, FORCE, L, M, MOMENT, N, Q, by_strain_change, failure, inner, slopes, strain_by_state,
};
use crate::spatial::inertia::{Turn, Turning, inertia, turning};
use crate::spatial::loads::{Load, load};
use crate::spatial::rotation::{Directors, Vector, cross, relative, turn};
use crate::spatial::section::{CableAt, Stiffness};
use crate::statics::equations::{SectionFailure, StrokeControl};

/// States: those of the statics, and x, y, z.
pub(super) const S: usize = N + 3;
/// Where x stands among them; y and z follow.
pub(super) const X: usize = N;

/// Coordinates of a station in time: c, and x, y, z.
pub(super) const COORDINATES: usize = 6;

/// A solution on the mesh of the motion.
pub(super) type Shape = Solution<S, M, L>;

/// The solver of stages in space.
pub(super) type Spatial = Settling<SpatialMoving, S, L>;

/// Equations of a moving arm in space at one time.
#[derive(Debug, Clone)]
pub(super) struct SpatialMoving {
    /// Data along the arm, loads at this time.
    pub(super) statics: Equations,
    /// Acceleration of the stream, L/s2.
    pub(super) stream_acceleration: Vector<f64>,
    pub(super) masses: Vec<Masses<Lanes>>,
    /// d rate / d value, 1/s; zero at rest.
    pub(super) cv: f64,
    /// What rates start from.
    pub(super) history: History,
    /// The rotations that stations had at the start of the step: of the stages in blocks, then of the nodes.
    pub(super) from: Vec<[Lanes; 4]>,
    /// Strain rates at ends of elements, less cv times the strains.
    end_rates: Vec<[Lanes; L]>,
    pub(super) end_places: Vec<EndPlace>,
    closed: bool,
    /// The cables whose stroke is commanded.
    pub(super) stroke_control: Option<StrokeControl>,
    pub(super) nodes: usize,
    /// Sizes of the states.
    pub(super) scales: [f64; S],
}

impl SpatialMoving {
    /// With `force` (N) as the unit of force.
    pub(super) fn new(arm: &Arm, force: f64) -> Self {
        let mut statics = Equations::new(arm, M).leaving(1e-4);
        statics.set_force_unit(force);
        Self {
            statics,
            stream_acceleration: [0.0; 3],
            masses: Vec::new(),
            cv: 0.0,
            history: History::default(),
            from: Vec::new(),
            end_rates: Vec::new(),
            end_places: Vec::new(),
            stroke_control: None,
            nodes: 0,
            scales: [1.0; S],
            closed: arm.model.volume != Volume::None && !arm.cables.is_empty(),
        }
    }

    /// Takes stations, ends and masses of a solution's mesh.
    pub(super) fn place_on(&mut self, gauss: &Gauss<M>, solution: &Shape) {
        self.statics.place_on(gauss, solution);
        self.end_places = solution.directions.ends().to_vec();
        let (arm, unit) = (self.statics.arm(), self.statics.units);
        let masses = self.statics.places.iter().map(|place| {
            let at = |profile: &Profile| profile.at_four(place.s * Lanes::of(unit.length), unit.length)[0];
            Masses::new(arm, unit.force, at)
        });
        self.masses = masses.collect();
        self.nodes = solution.nodes.len();
        self.history.set_layout(self.layout());
    }

    pub(super) fn place_ends(&mut self, solution: &Shape) {
        self.statics.place_ends(solution);
        self.end_places = solution.directions.ends().to_vec();
    }

    pub(super) fn layout(&self) -> Layout {
        Layout { blocks: self.masses.len(), nodes: self.nodes, turns: 3, places: 3, strains: L }
    }

    /// Takes what strain rates at the ends start from.
    pub(super) fn set_end_rates(&mut self, gauss: &Gauss<M>) {
        self.end_rates.clear();
        if self.statics.arm().dynamics.relaxation_time > 0.0 {
            let ends = &self.end_places;
            self.end_rates.extend(self.history.end_rates(self.cv, gauss, self.statics.groups, ends));
        }
    }

    /// The section law of a material with memory of rate, given what strain rates are beside cv times the strains.
    #[inline(always)]
    fn stiffened(&self, stiffness: &Stiffness<Lanes>, rates: &[Lanes; L]) -> Stiffness<Lanes> {
        let time = self.statics.arm().dynamics.relaxation_time;
        let [value, reference] = stiffened([&stiffness.value, &stiffness.reference], rates, time, self.cv);
        Stiffness { value, reference }
    }

    /// What acts along the arm at a station, inertia among it, as a load whose force is -n_f', and its derivative by r.
    #[inline(always)]
    pub(super) fn loads(
        &self,
        block: usize,
        place: &Vector<Lanes>,
        directors: &Directors<Lanes>,
        strain: &[Lanes; L],
        section_stretch: &SectionStretch<Lanes>,
    ) -> (Load<Lanes>, [Vector<Lanes>; 3]) {
        let statics = &self.statics;
        let cv = Lanes::of(self.cv);
        let moving: [[Lanes; 2]; 3] = each(|k| self.history.rates_of(self.cv, block, 3 + k, place[k]));
        let length = Lanes::of(statics.units.length);
        let wet = statics.arm().flow.density != 0.0;
        let stream = wet.then(|| each(|k| Lanes::of(statics.water.stream[k]) - length * moving[k][0]));
        let mut out = load(&statics.water, &statics.places[block].body, stream, directors, strain, section_stretch);
        let acceleration: Vector<Lanes> = each(|k| moving[k][1]);
        let inert = inertia(
            &statics.water,
            &self.masses[block],
            directors,
            strain,
            section_stretch,
            &acceleration,
            &self.stream_acceleration,
        );
        let by_place = each(|k| each(|c| cv * (-(length * out.by_stream[k][c]) - cv * inert.by_acceleration[k][c])));
        for k in 0..3 {
            out.force[k] -= inert.force[k];
            for c in 0..3 {
                out.by_turn[k][c] -= inert.by_turn[k][c];
                out.by_stretch[k][c] -= inert.by_stretch[k][c];
            }
        }
        (out, by_place)
    }

    /// d/dt (J omega) at a station.
    #[inline(always)]
    pub(super) fn turning(&self, block: usize, q: &[Lanes; 4], nu: Lanes) -> Turning<Lanes> {
        let cv = Lanes::of(self.cv);
        let c = relative(&self.from[block], q);
        let rates: [[Lanes; 2]; 3] = each(|k| self.history.rates_of(self.cv, block, k, c[k]));
        let turn = Turn { c, v: each(|k| rates[k][0]), a: each(|k| rates[k][1]) };
        let nu_rate = cv * (nu - self.history.strain(block, 0));
        turning(self.statics.volume, &self.masses[block], [nu, nu_rate], &turn, cv)
    }

    /// A station with the states themselves: those of the statics, and r.
    #[inline(always)]
    pub(super) fn unscaled(&self, station: &Station<S, L>) -> (Station<N, L>, Vector<Lanes>) {
        let at = |a: usize| Lanes::of(self.scales[a]) * station.z[a];
        let own = Station { z: each(at), inner: station.inner, closure_slope: station.closure_slope };
        (own, each(|k| at(X + k)))
    }

    /// The stations of a block.
    #[inline(always)]
    fn block(
        &self,
        block: usize,
        given: &mut Station<S, L>,
        pulled: &mut Vec<CableAt<Lanes>>,
        out: &mut Local<S, 0, L, Lanes>,
    ) -> Result<(), SectionFailure> {
        let statics = &self.statics;
        let place = &statics.places[block];
        let (station, r) = self.unscaled(given);
        statics.pulled_in(statics.cables_in(block), pulled);
        let stiffness = self.stiffened(&place.stiffness, &self.history.strain_rates(self.cv, block));
        let (directors, contact, solved) = statics.solved(&stiffness, &station, pulled);
        if !solved.is_fine(statics.inner_tolerance) {
            return Err(failure(place.s, &solved, statics.inner_tolerance));
        }
        let (load, by_place) = self.loads(block, &r, &directors, &solved.strain, &solved.balance.section_stretch);
        let at = AtStation { directors, contact, solved, load, couple: place.body.couple };
        let q: [Lanes; 4] = each(|k| station.z[k]);
        let turns = turn(&q);
        let by_state = strain_by_state(&at.solved.inverse, &at.directors, &at.contact, &turns);
        let mut still = Local::<N, Q, L, Lanes>::default();
        slopes(&at, &q, &turns, &by_state, &mut still);
        let own = inner(&at.solved, by_state);
        let spinning = self.turning(block, &q, at.solved.strain[0]);
        widen(&at, &still, &own, &q, out);
        add_turning(&spinning, &at, &turns, &own, out);
        for k in 0..3 {
            for c in 0..3 {
                out.jacobian[FORCE + k][X + c] = -by_place[k][c];
            }
        }
        self.scale(out);
        given.inner = at.solved.strain;
        Ok(())
    }

    /// Brings slopes and gradients to the states' sizes.
    #[inline(always)]
    fn scale(&self, out: &mut Local<S, 0, L, Lanes>) {
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
    }

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

    /// All stages, compiled once.
    #[inline(never)]
    fn all_stages(
        &self,
        stations: &mut [Station<S, L>],
        out: &mut [Local<S, 0, L, Lanes>],
    ) -> Result<(), SectionFailure> {
        let mut pulled = Vec::with_capacity(self.statics.tensions.len());
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
        let mut pulled = Vec::with_capacity(statics.tensions.len());
        each_block(
            stations,
            out,
            #[inline(always)]
            |block, given, out| {
                let (station, _) = self.unscaled(given);
                let (s, stiffness) = &statics.end_sections[block];
                statics.pulled_in(statics.cables_at_end(block), &mut pulled);
                let rates = self.end_rates.get(block).copied().unwrap_or_default();
                let stiffness = self.stiffened(stiffness, &rates);
                let (directors, contact, solved) = statics.solved(&stiffness, &station, &pulled);
                if !solved.is_fine(statics.inner_tolerance) {
                    return Err(failure(*s, &solved, statics.inner_tolerance));
                }
                let turns = turn(&each(|k| station.z[k]));
                let by_state = strain_by_state(&solved.inverse, &directors, &contact, &turns);
                *out = wide(&inner(&solved, by_state));
                self.scale_inner(out);
                given.inner = solved.strain;
                Ok(())
            },
        )
    }
}

/// Adds d/dt (J omega) to m_f'.
#[inline(always)]
fn add_turning(
    own: &Turning<Lanes>,
    at: &AtStation<Lanes>,
    turns: &[[Lanes; 4]; 3],
    inner: &Inner<N, L, Lanes>,
    out: &mut Local<S, 0, L, Lanes>,
) {
    let couple = at.directors.to_space(&own.couple);
    let by_nu = at.directors.to_space(&own.by_nu);
    let by_turn: [Vector<Lanes>; 3] = each(|i| {
        let psi = each(|k| Lanes::of(if k == i { 1.0 } else { 0.0 }));
        let turned = cross(&psi, &own.couple);
        at.directors.to_space(&each(|k| turned[k] + own.by_turn[i][k]))
    });
    for k in 0..3 {
        out.slope[MOMENT + k] += couple[k] + by_nu[k] * at.solved.change[0];
        out.by_closure[MOMENT + k] += by_nu[k] * inner.by_closure[0];
        for b in 0..N {
            out.jacobian[MOMENT + k][b] += by_nu[k] * inner.gradient[0][b];
        }
        for b in 0..4 {
            for i in 0..3 {
                out.jacobian[MOMENT + k][b] += by_turn[i][k] * turns[i][b];
            }
        }
    }
}

/// A section law's gradients by the statics' states as those by all.
#[inline(always)]
fn wide(own: &Inner<N, L, Lanes>) -> Inner<S, L, Lanes> {
    let zero = Lanes::of(0.0);
    let mut out = Inner {
        change: own.change,
        gradient: [[zero; S]; L],
        by_closure: own.by_closure,
        value: own.value,
        value_change: own.value_change,
        value_gradient: [zero; S],
        reach: own.reach,
    };
    out.value_gradient[..N].copy_from_slice(&own.value_gradient);
    for k in 0..L {
        out.gradient[k][..N].copy_from_slice(&own.gradient[k]);
    }
    out
}

impl Problem<S, 0, L> for SpatialMoving {
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
        7
    }

    /// Rotation and place of the base.
    fn left(&self, z: &[f64; S], out: &mut [Condition<S>; S]) {
        for k in 0..4 {
            out[k].residual = z[k] - self.statics.base[k];
            out[k].gradient[k] = 1.0;
        }
        for (k, place) in self.statics.base_place().into_iter().enumerate() {
            out[4 + k].residual = z[X + k] - place / self.scales[X];
            out[4 + k].gradient[X + k] = 1.0;
        }
    }

    /// n_f(L) and m_f(L) are the loads on the tip, as in the statics.
    fn right(&self, z: &[f64; S], out: &mut [Condition<S>; S]) {
        let q: [f64; 4] = each(|k| z[k]);
        let (load, by_turn) = self.statics.tip_load(1.0, &Directors::of(&q));
        let turns = turn(&q);
        for k in 0..6 {
            let inverse = 1.0 / self.scales[FORCE + k];
            out[k].residual = z[FORCE + k] - inverse * load[k];
            out[k].gradient[FORCE + k] = 1.0;
            if k < 3 {
                for b in 0..4 {
                    out[k].gradient[b] = -inverse * (0..3).map(|j| by_turn[j][k] * turns[j][b]).sum::<f64>();
                }
            }
        }
    }
}

/// The slopes of the statics with those of r, r' among them, as slopes of all states.
#[inline(always)]
fn widen(
    at: &AtStation<Lanes>,
    still: &Local<N, Q, L, Lanes>,
    own: &Inner<N, L, Lanes>,
    q: &[Lanes; 4],
    out: &mut Local<S, 0, L, Lanes>,
) {
    let strains = |strain: &[Lanes; L]| at.directors.to_space(&[strain[0], strain[1], strain[2]]);
    let (by_change, by_closure) =
        (by_strain_change(at, q, &at.solved.change), by_strain_change(at, q, &own.by_closure));
    let (change, rate_by_closure) = (strains(&at.solved.change), strains(&own.by_closure));
    out.jacobian = [[Lanes::of(0.0); S]; S];
    for a in 0..N {
        out.slope[a] = still.slope[a] + by_change[a];
        out.by_closure[a] = by_closure[a];
        out.jacobian[a][..N].copy_from_slice(&still.jacobian[a]);
    }
    for k in 0..3 {
        out.slope[X + k] = still.rate[k] + change[k];
        out.by_closure[X + k] = rate_by_closure[k];
        out.jacobian[X + k][..N].copy_from_slice(&still.rate_gradient[k]);
    }
    out.inner = wide(own);
}
