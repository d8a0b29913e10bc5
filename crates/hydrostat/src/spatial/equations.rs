//! The differential equations and end conditions of an arm in space (`docs/model.md`, the arm in space).
//!
//! Unknown along the arm are z = (q, n_f, m_f): the section's rotation as a quaternion, and the part of the contact
//! force and moment, in space, that balances everything but the cables:
//!
//! ```text
//! q'   = 1/2 q (0, u)
//! n_f' = -f
//! m_f' = -r' x n_f - couple        r' = nu a + eta b + zeta c
//! ```
//!
//! and at every s the section law gives (nu, eta, zeta, tau, kappa, mu), see [`super::section`]. The centreline r is
//! a quadrature. Gauss collocation keeps |q| at the nodes, as it keeps every quadratic invariant. Lengths are in
//! units of L, forces in a unit of [`Units`], as in the plane.

use hydrostat_bvp::{Condition, EndPlace, Groups, Inner, LANES, Lanes, Local, Problem, Real, Solution, Station, each};

use super::loads::{Load, Water, load, uniform, water};
use super::place::{Place, base_of, loads_of};
use super::rotation::{Directors, Vector, cross, spin, turn};
use super::section::{CableAt, STRAINS, Stiffness, apply};
use super::section_solve::{Solved, solve_section};
use crate::numerics::dispatch::each_block;
use crate::rod::area_law::area_law;
use crate::rod::arm::{Arm, Space};
use crate::rod::model_options::{Support, Volume};
use crate::statics::dimensions::Units;
use crate::statics::equations::{SectionFailure, Varied};
use crate::statics::verdict::Phase;

/// States: q, n_f and m_f in space.
pub(crate) const N: usize = 10;
/// Quadratures: x, y, z.
pub(crate) const Q: usize = 3;
/// Inner unknowns: nu, eta, zeta, tau, kappa, mu.
pub(crate) const L: usize = STRAINS;

/// Stages of the solve, and of the check that estimates its error.
pub(crate) const M: usize = 4;
pub(super) const K: usize = M + 1;

/// What a solve works on.
pub(crate) type Guess = Solution<N, M, L>;

/// Where n_f stands in the state.
pub(crate) const FORCE: usize = 4;
/// Where m_f stands in the state.
pub(crate) const MOMENT: usize = 7;

/// Steps of the section law that Newton's rounds on the arm leave to the next one.
const ROUGH: f64 = 1e-3;

/// Equations of one arm in space at given fractions of its loads, on a mesh.
#[derive(Debug, Clone)]
pub(crate) struct Equations {
    pub(crate) units: Units,
    pub(super) arm: Arm,
    pub(crate) space: Space,
    /// The arm with gravity along e1, see [`Equations::place`].
    pub(super) upright: Arm,
    /// Direction of gravity.
    pub(super) gravity: Vector<f64>,
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
    /// The axis in space that the base turns about, once round over the range of what is varied.
    pub(super) turning: Option<Vector<f64>>,
    /// A couple about the directors, at the blocks of stations, that takes the place of the parameter.
    pub(super) imposed: Option<Vec<Vector<Lanes>>>,
    /// Steps of the section law that are left to the next round.
    pub(crate) inner_tolerance: f64,
    pub(crate) groups: Groups,
    pub(super) stations: Vec<f64>,
    pub(crate) places: Vec<Place<Lanes>>,
    pub(super) cables: Vec<CableAt<Lanes>>,
    pub(crate) end_sections: Vec<(Lanes, Stiffness<Lanes>)>,
    pub(super) end_cables: Vec<CableAt<Lanes>>,
    /// The quaternion of the base.
    pub(crate) base: [f64; 4],
}

/// A station near its strains, with its loads.
pub(crate) struct AtStation<R> {
    pub(crate) directors: Directors<R>,
    /// n_f and m_f in the directors.
    pub(crate) contact: [R; STRAINS],
    pub(crate) solved: Solved<R>,
    pub(crate) load: Load<R>,
    pub(crate) couple: Vector<R>,
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
            space: arm.space.clone().unwrap_or_default(),
            upright: arm.clone(),
            gravity: [0.0; 3],
            varied: None,
            turning: None,
            imposed: None,
            fraction: [1.0, 1.0],
            phase: Phase::Tension,
            inner_tolerance: ROUGH,
            groups: Groups { elements: 0, stages },
            stations: Vec::new(),
            places: Vec::new(),
            cables: Vec::new(),
            end_sections: Vec::new(),
            end_cables: Vec::new(),
            base: base_of(arm),
        };
        this.take_gravity();
        // At unit force the stiffness is C3 A0 / L^2: make it one at the base.
        this.units.force = this.place(0.0).stiffness.value[5];
        this.set_tensions();
        this
    }

    /// The same equations on no mesh.
    pub(crate) fn without_places(&self) -> Self {
        Self {
            arm: self.arm.clone(),
            space: self.space.clone(),
            upright: self.upright.clone(),
            tensions: self.tensions.clone(),
            ends: self.ends.clone(),
            varied: self.varied.clone(),
            imposed: None,
            groups: Groups { elements: 0, stages: self.groups.stages },
            stations: Vec::new(),
            places: Vec::new(),
            cables: Vec::new(),
            end_sections: Vec::new(),
            end_cables: Vec::new(),
            ..*self
        }
    }

    /// The same equations with steps of the section law left up to `inner_tolerance`.
    pub(crate) fn leaving(self, inner_tolerance: f64) -> Self {
        Self { inner_tolerance, ..self }
    }

    pub(super) fn set_tensions(&mut self) {
        self.tensions = self.arm.cables.iter().map(|c| c.tension / self.units.force).collect();
    }

    pub(crate) fn arm(&self) -> &Arm {
        &self.arm
    }

    /// Changes tensions, the same cables being there.
    pub(crate) fn take_tensions(&mut self, tensions: &[f64]) {
        for (cable, tension) in self.arm.cables.iter_mut().zip(tensions) {
            cable.tension = *tension;
        }
        self.set_tensions();
    }

    /// The arm with the loads that act at the present fractions.
    pub(crate) fn arm_at_fraction(&self) -> Arm {
        let mut arm = self.arm.clone();
        let [loads, tension] = self.fraction;
        for cable in &mut arm.cables {
            cable.tension *= tension;
        }
        if loads != 1.0 {
            // The stream's load is its fraction: with the square of the speed, which both laws have.
            arm.flow.speed *= loads.sqrt();
            if let Some(gravity) = &mut arm.gravity {
                gravity.acceleration *= loads;
            }
            arm.tip.force = arm.tip.force.map(|v| v * loads);
            arm.tip.follower = arm.tip.follower.map(|v| v * loads);
            arm.tip.moment *= loads;
            for p in arm.distributed.force.iter_mut().chain([&mut arm.distributed.couple]) {
                *p = p.scaled(loads, 1.0);
            }
            if let Some(space) = &mut arm.space {
                space.tip_force *= loads;
                space.tip_follower *= loads;
                space.tip_moment = space.tip_moment.map(|v| v * loads);
                for p in space.couple.iter_mut().chain([&mut space.force]) {
                    *p = p.scaled(loads, 1.0);
                }
            }
        }
        arm
    }

    /// Whether anything but cables loads the arm.
    pub(crate) fn has_loads(&self) -> bool {
        let a = &self.arm;
        let water_moves = a.flow.speed != 0.0 && a.flow.density != 0.0;
        let gravity = a.gravity.is_some_and(|g| g.acceleration != 0.0);
        let tip = a.tip.force != [0.0; 2] || a.tip.moment != 0.0 || a.tip.follower != [0.0; 2];
        let along = !(a.distributed.force.iter().all(crate::Profile::is_zero) && a.distributed.couple.is_zero());
        water_moves || gravity || tip || along || loads_of(&self.space)
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
    }

    /// The tension of cable `c` at the present fraction, in the unit of force.
    pub(crate) fn tension(&self, c: usize) -> f64 {
        self.tensions[c] * self.fraction[1]
    }

    /// Whether beta' enters the equations.
    pub(crate) fn is_closed(&self) -> bool {
        self.volume != Volume::None && !self.tensions.is_empty()
    }

    /// The reference strains in a block of stations.
    pub(crate) fn reference_in(&self, block: usize) -> [Lanes; L] {
        self.places[block].stiffness.reference
    }

    /// beta R (over L) in a lane of a block.
    pub(crate) fn half_width(&self, block: usize, station: &Station<N, L>, lane: usize) -> f64 {
        (area_law(self.volume, station.inner[0]).beta * self.places[block].body.radius).0[lane]
    }

    /// The place (over L) of a lane of a block.
    pub(crate) fn place_in(&self, block: usize, lane: usize) -> f64 {
        self.places[block].s.0[lane]
    }

    /// Strain measure 1/2 sum C (strain - reference)^2 A per length in a block of stations.
    #[inline(always)]
    pub(crate) fn strain_energy_of(&self, block: usize, strain: &[Lanes; L]) -> Lanes {
        let stiffness = &self.places[block].stiffness;
        let beta = area_law(self.volume, strain[0]).beta;
        let mut sum = Lanes::of(0.0);
        for a in 0..L {
            let strained = strain[a] - stiffness.reference[a];
            sum += Lanes::of(0.5) * stiffness.value[a] * beta * beta * strained * strained;
        }
        sum
    }

    /// U_t and U_p over the stream's speed in a block of stations.
    #[inline(always)]
    pub(crate) fn speeds(&self, block: usize, station: &Station<N, L>) -> (Lanes, Vector<Lanes>) {
        let directors = Directors::of(&each(|k| station.z[k]));
        let section_stretch = area_law(self.volume, station.inner[0]);
        let body = &self.places[block].body;
        let load = load(&self.water, body, uniform(&self.water), &directors, &station.inner, &section_stretch);
        (load.along, load.across)
    }

    /// Fills `out` with the cables that pull in a block, given all of them there.
    #[inline(always)]
    pub(crate) fn pulled_in(&self, cables: &[CableAt<Lanes>], out: &mut Vec<CableAt<Lanes>>) {
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

    /// The cables of a block of ends.
    #[inline(always)]
    pub(crate) fn cables_at_end(&self, block: usize) -> &[CableAt<Lanes>] {
        let count = self.tensions.len();
        &self.end_cables[block * count..(block + 1) * count]
    }

    #[inline(always)]
    pub(crate) fn solved(
        &self,
        stiffness: &Stiffness<Lanes>,
        station: &Station<N, L>,
        pulled: &[CableAt<Lanes>],
    ) -> (Directors<Lanes>, [Lanes; STRAINS], Solved<Lanes>) {
        let directors = Directors::of(&each(|k| station.z[k]));
        let contact = in_directors(&directors, &station.z);
        let (guess, slope) = (&station.inner, station.closure_slope);
        let solved = solve_section(self.volume, stiffness, pulled, &contact, guess, slope, self.inner_tolerance);
        (directors, contact, solved)
    }

    /// A block of stations near their strains.
    #[inline(always)]
    pub(super) fn solved_in(
        &self,
        block: usize,
        station: &Station<N, L>,
        pulled: &mut Vec<CableAt<Lanes>>,
    ) -> Result<AtStation<Lanes>, SectionFailure> {
        let place = &self.places[block];
        self.pulled_in(self.cables_in(block), pulled);
        let (directors, contact, solved) = self.solved(&place.stiffness, station, pulled);
        if !solved.is_fine(self.inner_tolerance) {
            return Err(failure(place.s, &solved, self.inner_tolerance));
        }
        let stream = uniform(&self.water);
        let section_stretch = &solved.balance.section_stretch;
        let mut load = load(&self.water, &place.body, stream, &directors, &solved.strain, section_stretch);
        let fraction = Lanes::of(self.fraction[0]);
        for k in 0..3 {
            load.force[k] = load.force[k] * fraction;
            for c in 0..3 {
                load.by_turn[c][k] = load.by_turn[c][k] * fraction;
                load.by_stretch[c][k] = load.by_stretch[c][k] * fraction;
            }
        }
        Ok(AtStation { directors, contact, solved, load, couple: each(|k| place.body.couple[k] * fraction) })
    }

    /// The stations of a block.
    #[inline(always)]
    fn block(
        &self,
        block: usize,
        station: &mut Station<N, L>,
        pulled: &mut Vec<CableAt<Lanes>>,
        out: &mut Local<N, Q, L, Lanes>,
    ) -> Result<(), SectionFailure> {
        let at = self.solved_in(block, station, pulled)?;
        let q: [Lanes; 4] = each(|k| station.z[k]);
        let turns = turn(&q);
        let by_state = strain_by_state(&at.solved.inverse, &at.directors, &at.contact, &turns);
        slopes(&at, &q, &turns, &by_state, out);
        let by_change = by_strain_change(&at, &q, &at.solved.change);
        for a in 0..N {
            out.slope[a] += by_change[a];
        }
        let strains = |strain: &[Lanes; L]| at.directors.to_space(&[strain[0], strain[1], strain[2]]);
        let change = strains(&at.solved.change);
        for k in 0..Q {
            out.rate[k] += change[k];
        }
        out.inner = inner(&at.solved, by_state);
        out.by_closure = by_strain_change(&at, &q, &out.inner.by_closure);
        out.rate_by_closure = strains(&out.inner.by_closure);
        station.inner = at.solved.strain;
        Ok(())
    }

    /// All stages, compiled once for all systems that they are evaluated for.
    #[inline(never)]
    fn all_stages(
        &self,
        stations: &mut [Station<N, L>],
        out: &mut [Local<N, Q, L, Lanes>],
    ) -> Result<(), SectionFailure> {
        let mut pulled = Vec::with_capacity(self.tensions.len());
        each_block(
            stations,
            out,
            #[inline(always)]
            |block, station, out| self.block(block, station, &mut pulled, out),
        )
    }

    /// All ends at which elements meet the section law, likewise.
    #[inline(never)]
    fn all_ends(&self, stations: &mut [Station<N, L>], out: &mut [Inner<N, L, Lanes>]) -> Result<(), SectionFailure> {
        let mut pulled = Vec::with_capacity(self.tensions.len());
        each_block(
            stations,
            out,
            #[inline(always)]
            |block, station, out| {
                let (s, stiffness) = &self.end_sections[block];
                self.pulled_in(self.cables_at_end(block), &mut pulled);
                let (directors, contact, solved) = self.solved(stiffness, station, &pulled);
                if !solved.is_fine(self.inner_tolerance) {
                    return Err(failure(*s, &solved, self.inner_tolerance));
                }
                let turns = turn(&each(|k| station.z[k]));
                *out = inner(&solved, strain_by_state(&solved.inverse, &directors, &contact, &turns));
                station.inner = solved.strain;
                Ok(())
            },
        )
    }

    /// n_f(L) and m_f(L) that a fraction of the loads on the tip asks for, and their derivatives by a turn about each
    /// director.
    pub(crate) fn tip_load(&self, fraction: f64, directors: &Directors<f64>) -> ([f64; 6], [Vector<f64>; 3]) {
        let fraction = fraction / self.units.force;
        let (tip, space) = (&self.arm.tip, &self.space);
        let follower = [tip.follower[0], tip.follower[1], space.tip_follower];
        let dead = [tip.force[0], tip.force[1], space.tip_force];
        let following = directors.to_space(&follower);
        let moment = [space.tip_moment[0], space.tip_moment[1], tip.moment];
        let mut out = [0.0; 6];
        for k in 0..3 {
            out[k] = fraction * (dead[k] + following[k]);
            out[3 + k] = fraction * moment[k] / self.units.length;
        }
        let by_turn = each(|k| {
            let mut axis = [0.0; 3];
            axis[k] = 1.0;
            directors.to_space(&cross(&axis, &follower)).map(|v| fraction * v)
        });
        (out, by_turn)
    }

    /// n_f(0) and m_f(0) of a base at which the section is unstrained, at these tensions (in the unit of force).
    pub(super) fn unstrained_base(&self, tensions: &[f64]) -> [f64; 6] {
        let directors = Directors::of(&self.base);
        let stiffness = self.place(0.0).stiffness;
        let mut at_base: [f64; STRAINS] =
            each(|k| stiffness.value[k] * (f64::from(u8::from(k == 0)) - stiffness.reference[k]));
        for (c, tension) in tensions.iter().enumerate() {
            let cable = self.cable(c, 0.0);
            let stretch = (1.0 + cable.y_slope * cable.y_slope + cable.z_slope * cable.z_slope).sqrt();
            let force = [1.0, cable.y_slope, cable.z_slope].map(|v| v * tension / stretch);
            let moment = cross(&[0.0, cable.y, cable.z], &force);
            for k in 0..3 {
                at_base[k] += force[k];
                at_base[3 + k] += moment[k];
            }
        }
        let force = directors.to_space(&[at_base[0], at_base[1], at_base[2]]);
        let moment = directors.to_space(&[at_base[3], at_base[4], at_base[5]]);
        [force[0], force[1], force[2], moment[0], moment[1], moment[2]]
    }

    pub(super) fn is_unstrained_base(&self) -> bool {
        self.arm.model.support == Support::UnstrainedBase
    }
}

/// n_f and m_f in the directors.
#[inline(always)]
pub(crate) fn in_directors<R: Real>(directors: &Directors<R>, z: &[R; N]) -> [R; STRAINS] {
    let n = directors.to_body(&[z[4], z[5], z[6]]);
    let m = directors.to_body(&[z[7], z[8], z[9]]);
    [n[0], n[1], n[2], m[0], m[1], m[2]]
}

/// d strain / d z: the law depends on z through n_f and m_f in the directors alone.
#[inline(always)]
pub(crate) fn strain_by_state<R: Real>(
    inverse: &[[R; STRAINS]; STRAINS],
    directors: &Directors<R>,
    contact: &[R; STRAINS],
    turns: &[[R; 4]; 3],
) -> [[R; N]; STRAINS] {
    let zero = R::of(0.0);
    let mut out = [[zero; N]; STRAINS];
    let n = [contact[0], contact[1], contact[2]];
    let m = [contact[3], contact[4], contact[5]];
    for k in 0..4 {
        let phi = [turns[0][k], turns[1][k], turns[2][k]];
        let (dn, dm) = (cross(&n, &phi), cross(&m, &phi));
        let column = apply(inverse, &[dn[0], dn[1], dn[2], dm[0], dm[1], dm[2]]);
        for row in 0..STRAINS {
            out[row][k] = column[row];
        }
    }
    for k in 0..3 {
        let d = [directors.a[k], directors.b[k], directors.c[k]];
        for row in 0..STRAINS {
            let i = &inverse[row];
            out[row][FORCE + k] = i[0] * d[0] + i[1] * d[1] + i[2] * d[2];
            out[row][MOMENT + k] = i[3] * d[0] + i[4] * d[1] + i[5] * d[2];
        }
    }
    out
}

/// Forcing of z' with the strains, at fixed z and beta'.
#[inline(always)]
pub(crate) fn by_strain_change<R: Real>(at: &AtStation<R>, q: &[R; 4], change: &[R; STRAINS]) -> [R; N] {
    strained(&at.directors, &at.contact, &at.load.by_stretch, q, change)
}

/// The same, given the section's directors, n_f and m_f in them, and how the load follows nu, eta, zeta.
#[inline(always)]
pub(crate) fn strained<R: Real>(
    directors: &Directors<R>,
    contact: &[R; STRAINS],
    by: &[Vector<R>; 3],
    q: &[R; 4],
    change: &[R; STRAINS],
) -> [R; N] {
    let v = [change[0], change[1], change[2]];
    let dq = spin(q, &[change[3], change[4], change[5]]);
    let n = [contact[0], contact[1], contact[2]];
    let dm = directors.to_space(&cross(&v, &n));
    let dn: Vector<R> = each(|k| by[0][k] * v[0] + by[1][k] * v[1] + by[2][k] * v[2]);
    [dq[0], dq[1], dq[2], dq[3], -dn[0], -dn[1], -dn[2], -dm[0], -dm[1], -dm[2]]
}

/// Slopes of the state and of the centreline, with their gradients, at the strains without their step.
#[inline(always)]
pub(crate) fn slopes(
    at: &AtStation<Lanes>,
    q: &[Lanes; 4],
    turns: &[[Lanes; 4]; 3],
    by_state: &[[Lanes; N]; STRAINS],
    out: &mut Local<N, Q, L, Lanes>,
) {
    let zero = Lanes::of(0.0);
    let strain = &at.solved.strain;
    let v = [strain[0], strain[1], strain[2]];
    let u = [strain[3], strain[4], strain[5]];
    let n = [at.contact[0], at.contact[1], at.contact[2]];
    let lever = cross(&v, &n);
    let dq = spin(q, &u);
    let moment = at.directors.to_space(&lever);
    let f = &at.load.force;
    out.slope[..4].copy_from_slice(&dq);
    for k in 0..3 {
        out.slope[FORCE + k] = -f[k];
        out.slope[MOMENT + k] = -moment[k] - at.couple[k];
    }
    out.rate = at.directors.to_space(&v);
    for b in 0..N {
        let column: [Lanes; STRAINS] = each(|k| by_state[k][b]);
        let own = by_strain_change(at, q, &column);
        for a in 0..N {
            out.jacobian[a][b] = own[a];
        }
        let rate = at.directors.to_space(&[column[0], column[1], column[2]]);
        for k in 0..Q {
            out.rate_gradient[k][b] = rate[k];
        }
    }
    for b in 0..4 {
        let phi = [turns[0][b], turns[1][b], turns[2][b]];
        // A change of q at fixed strains: q' is linear in q, and all vectors in the directors turn.
        let mut unit = [zero; 4];
        unit[b] = Lanes::of(1.0);
        let dq = spin(&unit, &u);
        for a in 0..4 {
            out.jacobian[a][b] += dq[a];
        }
        let moment = at.directors.to_space(&cross(&cross(&phi, &v), &n));
        let rate = at.directors.to_space(&cross(&phi, &v));
        let by = &at.load.by_turn;
        for k in 0..3 {
            out.jacobian[FORCE + k][b] -= by[0][k] * phi[0] + by[1][k] * phi[1] + by[2][k] * phi[2];
            out.jacobian[MOMENT + k][b] -= moment[k];
            out.rate_gradient[k][b] += rate[k];
        }
    }
    // -r' x e_k for a change of n_f.
    let r = out.rate;
    out.jacobian[MOMENT][FORCE + 1] += r[2];
    out.jacobian[MOMENT][FORCE + 2] -= r[1];
    out.jacobian[MOMENT + 1][FORCE] -= r[2];
    out.jacobian[MOMENT + 1][FORCE + 2] += r[0];
    out.jacobian[MOMENT + 2][FORCE] += r[1];
    out.jacobian[MOMENT + 2][FORCE + 1] -= r[0];
}

/// The section law linearised and solved for the strains.
#[inline(always)]
pub(crate) fn inner(solved: &Solved<Lanes>, by_state: [[Lanes; N]; STRAINS]) -> Inner<N, L, Lanes> {
    let section_stretch = &solved.balance.section_stretch;
    let less = apply(&solved.inverse, &solved.balance.by_beta_slope);
    Inner {
        change: solved.change,
        gradient: by_state,
        by_closure: each(|k| -less[k]),
        value: section_stretch.beta,
        value_change: section_stretch.slope * solved.change[0],
        value_gradient: each(|a| section_stretch.slope * by_state[0][a]),
        reach: -(section_stretch.slope * less[0]),
    }
}

/// The first station of a block, along the arm, that could not be solved.
#[cold]
#[inline(never)]
pub(crate) fn failure(s: Lanes, solved: &Solved<Lanes>, tolerance: f64) -> SectionFailure {
    let lane = (0..LANES).find(|lane| !solved.is_fine_in(*lane, tolerance)).unwrap_or(0);
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
        if self.is_unstrained_base() { N } else { 4 }
    }

    fn left(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        for k in 0..4 {
            out[k].residual = z[k] - self.base[k];
            out[k].gradient[k] = 1.0;
        }
        if self.is_unstrained_base() {
            let pulling: Vec<f64> = (0..self.tensions.len()).map(|c| self.tension(c)).collect();
            for (k, carried) in self.unstrained_base(&pulling).into_iter().enumerate() {
                out[FORCE + k].residual = z[FORCE + k] - carried;
                out[FORCE + k].gradient[FORCE + k] = 1.0;
            }
        }
    }

    fn right(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        if self.is_unstrained_base() {
            return;
        }
        let q: [f64; 4] = each(|k| z[k]);
        let (load, by_turn) = self.tip_load(self.fraction[0], &Directors::of(&q));
        let turns = turn(&q);
        for k in 0..6 {
            out[k].residual = z[FORCE + k] - load[k];
            out[k].gradient[FORCE + k] = 1.0;
        }
        for k in 0..3 {
            for b in 0..4 {
                out[k].gradient[b] = -(0..3).map(|j| by_turn[j][k] * turns[j][b]).sum::<f64>();
            }
        }
    }
}
