//! The answer in space: the arm's shape and what it carries.

use hydrostat_bvp::{LANES, each};

use super::cable_paths::StageData;
use super::engine::Engine;
use super::equations::{FORCE, L, M, MOMENT, N, Q, in_directors};
use super::rotation::{Directors, Vector};
use super::section::{CableAt, STRAINS};
use super::section_solve::{FOLDED, solve_section};
use super::tip::{SpatialSnap, SpatialTip};
use crate::numerics::rounds::evaluate;
use crate::rod::area_law::area_law;
use crate::rod::arm::{Arm, Cavity};
use crate::rod::model_options::Support;
use crate::statics::configuration::{CableState, Command, FoldMargin, Statistics, Warning};
use crate::statics::engine::Trouble;
use crate::statics::equations::{Margins, SectionFailure};

/// The static configuration of an arm in space.
#[derive(Debug, Clone)]
pub struct SpatialConfiguration {
    /// The arm with the loads that this configuration balances.
    pub arm: Arm,
    /// The mesh nodes, base to tip; the end of a cable appears twice, with the values on either side.
    pub stations: SpatialStations,
    /// One entry a cable, in the arm's order.
    pub cables: Vec<CableState>,
    /// What support and cable anchors exert on the arm at the base: force (N) and moment about r(0) (N m), in space.
    pub base_reaction: SpatialWrench,
    /// With [`Support::UnstrainedBase`]: n_f(L), m_f(L) less the tip loads.
    pub unmet: Option<SpatialWrench>,
    /// Estimated error of the tip position, m.
    pub error_estimate: f64,
    /// What the solve came to know on its way: `Some(false)` where the determinant says that an odd number of
    /// directions is unstable, else `None`.
    pub stable: Option<bool>,
    /// The snaps that the arm makes as its loads grow from nothing to these, in their order.
    pub snaps: Vec<SpatialSnap>,
    /// What the solve took.
    pub statistics: Statistics,
    fold: FoldMargin,
    /// The stretch that is furthest from one, and where, m.
    stretch: (f64, f64),
    energy: f64,
    /// r (m) at the nodes, and its rates (over L) at the stages, to read the centreline anywhere.
    dense: Box<Dense>,
}

/// What it takes to evaluate a configuration anywhere.
#[derive(Debug, Clone)]
struct Dense {
    engine: Engine,
    nodes: Vec<Vector<f64>>,
    rates: Vec<[f64; Q]>,
}

/// A force (N) and a moment (N m) in space.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpatialWrench {
    /// N.
    pub force: [f64; 3],
    /// N m.
    pub moment: [f64; 3],
}

/// State at one place of an arm in space.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpatialStation {
    /// Reference arc length, m.
    pub s: f64,
    /// Centreline, m.
    pub x: f64,
    /// Centreline, m.
    pub y: f64,
    /// Centreline, m.
    pub z: f64,
    /// Director normal to the section.
    pub a: [f64; 3],
    /// Director in the section.
    pub b: [f64; 3],
    /// Director in the section, a x b.
    pub c: [f64; 3],
    /// Stretch.
    pub nu: f64,
    /// Shear strain along b.
    pub eta: f64,
    /// Shear strain along c.
    pub zeta: f64,
    /// Twist, 1/m.
    pub tau: f64,
    /// Bending about b, 1/m.
    pub kappa: f64,
    /// Bending about c, 1/m.
    pub mu: f64,
    /// Section stretch.
    pub beta: f64,
    /// Angle between section normal and centreline tangent, rad, in [0, pi].
    pub alpha: f64,
    /// Contact force along a, N.
    pub n_a: f64,
    /// Contact force along b, N.
    pub n_b: f64,
    /// Contact force along c, N.
    pub n_c: f64,
    /// Contact moment about a, N m.
    pub m_a: f64,
    /// Contact moment about b, N m.
    pub m_b: f64,
    /// Contact moment about c, N m.
    pub m_c: f64,
}

/// Many [`SpatialStation`]s, one array a field (units as there).
#[derive(Debug, Clone, PartialEq, Default)]
#[allow(missing_docs, reason = "the fields are those of `SpatialStation`")]
pub struct SpatialStations {
    pub s: Vec<f64>,
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub z: Vec<f64>,
    pub a: Vec<[f64; 3]>,
    pub b: Vec<[f64; 3]>,
    pub c: Vec<[f64; 3]>,
    pub nu: Vec<f64>,
    pub eta: Vec<f64>,
    pub zeta: Vec<f64>,
    pub tau: Vec<f64>,
    pub kappa: Vec<f64>,
    pub mu: Vec<f64>,
    pub beta: Vec<f64>,
    pub alpha: Vec<f64>,
    pub n_a: Vec<f64>,
    pub n_b: Vec<f64>,
    pub n_c: Vec<f64>,
    pub m_a: Vec<f64>,
    pub m_b: Vec<f64>,
    pub m_c: Vec<f64>,
}

macro_rules! each_field {
    ($name:ident!($($rest:tt)*)) => {
        $name!($($rest)* s x y z a b c nu eta zeta tau kappa mu beta alpha n_a n_b n_c m_a m_b m_c)
    };
}

impl SpatialStations {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.s.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.s.is_empty()
    }

    /// One more, at the end.
    pub fn push(&mut self, station: &SpatialStation) {
        macro_rules! push {
            ($($field:ident)*) => { $(self.$field.push(station.$field);)* };
        }
        each_field!(push!());
    }

    /// Station `i`.
    pub fn get(&self, i: usize) -> Option<SpatialStation> {
        macro_rules! at {
            ($($field:ident)*) => { SpatialStation { $($field: *self.$field.get(i)?,)* } };
        }
        Some(each_field!(at!()))
    }
}

/// A place between stations, solved.
pub(super) struct StationState {
    pub(super) directors: Directors<f64>,
    pub(super) strain: [f64; L],
    beta: f64,
    /// What the body carries, in the directors.
    contact: [f64; STRAINS],
    openness: f64,
    regularity: f64,
    radius: f64,
}

impl Engine {
    /// The section at `x` in [0, 1] of element `i`; at x = 1 what is on the left of the node.
    pub(super) fn section_in(&self, i: usize, x: f64) -> Result<StationState, SectionFailure> {
        /// Steps of the section law that may be left to what is read at a place.
        const SHARP: f64 = 1e-12;
        let (solution, gauss, equations) = (&self.solution, &self.system.gauss, &self.equations);
        let nodes = solution.mesh.nodes();
        let s = if x == 1.0 { nodes[i + 1] } else { nodes[i] + x * solution.mesh.step(i) };
        let z = match x {
            0.0 => solution.nodes[i],
            1.0 => solution.nodes[i + 1],
            _ => solution.state_in(gauss, i, s),
        };
        let known = solution.inner_in(gauss, i, x);
        let place = equations.place(s);
        let mut cables = Vec::new();
        for c in (0..equations.ends.len()).filter(|c| equations.runs_at(*c, s, x > 0.0)) {
            let tension = equations.tension(c);
            if tension != 0.0 {
                cables.push(CableAt { tension, ..equations.cable(c, s) });
            }
        }
        let directors = Directors::of(&each(|k| z[k]));
        let contact = in_directors(&directors, &z);
        let (volume, slope) = (equations.volume, known.closure_slope);
        let mut solved = solve_section(volume, &place.stiffness, &cables, &contact, &known.inner, slope, SHARP);
        if solved.size.is_nan() || solved.size > 1e-9 {
            // Polynomials through the stages may lead far from the strains at an end.
            let nearest = solution.inner(i, if x > 0.5 { M - 1 } else { 0 }).inner;
            solved = solve_section(volume, &place.stiffness, &cables, &contact, &nearest, slope, SHARP);
        }
        let failure = SectionFailure {
            s,
            openness: solved.balance.openness,
            nu: solved.strain[0],
            regularity: solved.regularity,
        };
        if !(solved.size < 1e-9 && solved.regularity > 0.0 && solved.balance.openness > FOLDED) {
            return Err(failure);
        }
        Ok(StationState {
            directors,
            strain: each(|k| solved.strain[k] + solved.change[k]),
            beta: area_law(volume, solved.strain[0] + solved.change[0]).beta,
            contact: each(|k| contact[k] - solved.balance.cables[k]),
            openness: solved.balance.openness,
            regularity: solved.regularity,
            radius: place.body.radius,
        })
    }

    /// Whether the section law has strains at both ends.
    pub(super) fn ends_fine(&self) -> Result<(), Trouble> {
        let last = self.solution.mesh.elements() - 1;
        self.section_in(0, 0.0).and_then(|_| self.section_in(last, 1.0)).map(|_| ()).map_err(Trouble::Section)
    }

    /// How near the limits of the section law nodes are.
    pub(super) fn nearest_limits(&self) -> Margins {
        let mut near = Margins::FAR;
        for i in 0..self.solution.mesh.elements() {
            for x in [0.0, 0.5, 1.0] {
                if let Ok(at) = self.section_in(i, x) {
                    let s = self.solution.mesh.nodes()[i] + x * self.solution.mesh.step(i);
                    near.note(s, at.openness, at.strain[0], at.regularity);
                }
            }
        }
        near
    }

    /// Where the tip is, after Newton has converged.
    pub(crate) fn read_tip(&self) -> Option<SpatialTip> {
        let at = self.section_in(self.solution.mesh.elements() - 1, 1.0).ok()?;
        let length = self.equations.units.length;
        let base = self.base();
        let [x, y, z] = [0, 1, 2].map(|k| base[k] + length * self.tip[k]);
        let Directors { a, b, c } = at.directors;
        Some(SpatialTip { x, y, z, a, b, c, alpha: angle_to_tangent(&at.strain) })
    }

    /// Where the base is, m.
    fn base(&self) -> Vector<f64> {
        let base = self.equations.arm().base;
        [base.x, base.y, self.equations.space.z]
    }

    /// Begins anew to count what a solve takes.
    pub(super) fn reset_statistics(&mut self) {
        (self.rounds, self.meshes) = (0, 0);
        (self.system.evaluations, self.check.evaluations) = (0, 0);
    }
}

/// The angle between a and r'.
pub(crate) fn angle_to_tangent(strain: &[f64; L]) -> f64 {
    strain[1].hypot(strain[2]).atan2(strain[0])
}

impl SpatialConfiguration {
    /// Reads the engine's solution out; the engine must be settled.
    pub(super) fn read(engine: &mut Engine, error_estimate: f64, statistics: Statistics) -> Result<Self, Trouble> {
        let evaluations = engine.system.evaluations;
        evaluate(&mut engine.system, &engine.equations, &engine.solution).map_err(Trouble::Section)?;
        engine.system.evaluations = evaluations;
        if engine.spans.len() != engine.solution.mesh.elements() {
            // The mesh was changed and no round followed.
            engine.system.quadratures(&mut engine.spans);
        }
        let arm = engine.equations.arm_at_fraction();
        let mesh = &engine.solution.mesh;
        let n = mesh.elements();
        let (length, force) = (arm.length, engine.equations.units.force);
        let mut nodes = vec![engine.base()];
        for span in &engine.spans {
            let last = nodes[nodes.len() - 1];
            nodes.push(each(|k| last[k] + length * span[k]));
        }
        let mut rates = Vec::with_capacity(n * M);
        for i in 0..n {
            for j in 0..M {
                let (block, lane) = (i / LANES * M + j, i % LANES);
                rates.push(engine.system.locals()[block].rate.map(|v| v.0[lane]));
            }
        }
        let dense = Dense { engine: engine.without_workspace(), nodes, rates };
        let mut fold = FoldMargin { value: 1.0, s: 0.0 };
        let mut stretch = (1.0, 0.0);
        let mut note = |s: f64, nu: f64, bending: f64, half_width: f64| {
            let value = (nu - half_width * bending) / nu;
            if value < fold.value {
                fold = FoldMargin { value, s };
            }
            if (nu - 1.0_f64).abs() > (stretch.0 - 1.0_f64).abs() {
                stretch = (nu, s);
            }
        };
        let mut stations = SpatialStations::default();
        let ends = |s: f64| engine.equations.ends.iter().any(|end| (end - s).abs() < 1e-9);
        for i in 0..n {
            let s = mesh.nodes()[i];
            let sides = if i > 0 && ends(s) { vec![(i - 1, 1.0), (i, 0.0)] } else { vec![(i, 0.0)] };
            let last = (i + 1 == n).then_some((i, 1.0));
            for (element, x) in sides.into_iter().chain(last) {
                let (station, radius) = dense.at(element, x).map_err(Trouble::Section)?;
                note(station.s, station.nu, station.kappa.hypot(station.mu), station.beta * radius);
                stations.push(&station);
            }
        }
        let mut energy = 0.0;
        for block in 0..engine.system.stations().len() {
            let station = &engine.system.stations()[block];
            let strained = engine.equations.strain_energy_of(block, &station.inner);
            let groups = engine.solution.groups();
            for lane in 0..groups.filled(block / M) {
                let i = groups.element(block / M, lane);
                energy += length * mesh.step(i) * engine.system.gauss.b[block % M] * strained.0[lane];
                let [nu, kappa, mu] = [0, 4, 5].map(|k| station.inner[k].0[lane]);
                let half_width = engine.equations.half_width(block, station, lane);
                note(engine.equations.place_in(block, lane) * length, nu, kappa.hypot(mu), half_width);
            }
        }
        let cables = arm.cables.iter().enumerate().map(|(c, cable)| {
            let [now, unloaded] = engine.equations.cable_lengths(c, StageData::of(&engine.system, &engine.solution));
            let (now, stroke) = (length * now, length * (unloaded - now));
            let command = cable.stroke.map(|given| Command {
                stroke: given,
                length: now + stroke - given,
                slack: !engine.is_taut(c),
            });
            CableState { name: cable.name.clone(), tension: cable.tension, length: now, stroke, command }
        });
        let cables = cables.collect();
        // Taken from zero, what is nothing is 0 and not -0.
        let wrench = |carried: &[f64; 6], sign: f64| SpatialWrench {
            force: each(|k| 0.0 + sign * force * carried[k]),
            moment: each(|k| 0.0 + sign * force * length * carried[3 + k]),
        };
        let carried = |z: &[f64; N]| -> [f64; 6] { each(|k| z[if k < 3 { FORCE + k } else { MOMENT + k - 3 }]) };
        let base_reaction = wrench(&carried(&engine.solution.nodes[0]), -1.0);
        let unmet = (arm.model.support == Support::UnstrainedBase).then(|| {
            let end = engine.solution.nodes[n];
            let directors = Directors::of(&[end[0], end[1], end[2], end[3]]);
            let (load, _) = engine.equations.tip_load(engine.equations.fraction[0], &directors);
            let own = carried(&end);
            wrench(&each(|k| own[k] - load[k]), 1.0)
        });
        Ok(Self {
            arm,
            stations,
            cables,
            base_reaction,
            unmet,
            error_estimate,
            stable: None,
            snaps: Vec::new(),
            statistics,
            fold,
            stretch,
            energy: energy * force,
            dense: Box::new(dense),
        })
    }

    /// The engine that holds this configuration.
    pub(crate) fn engine(&self) -> &Engine {
        &self.dense.engine
    }

    /// Where the tip is.
    pub fn tip(&self) -> SpatialTip {
        let st = self.stations.get(self.stations.len().saturating_sub(1)).unwrap_or_default();
        SpatialTip { x: st.x, y: st.y, z: st.z, a: st.a, b: st.b, c: st.c, alpha: st.alpha }
    }

    /// Everything at `s` (m); `s` outside [0, L] is moved to the nearer end. At the end of a cable, the values on the
    /// tip's side. Between nodes by the polynomials of the solve.
    pub fn at(&self, s: f64) -> SpatialStation {
        let fraction = (s / self.arm.length).clamp(0.0, 1.0);
        let fraction = if fraction.is_nan() { 0.0 } else { fraction };
        let mesh = &self.dense.engine.solution.mesh;
        let element = mesh.element_of(fraction);
        let x = ((fraction - mesh.nodes()[element]) / mesh.step(element)).clamp(0.0, 1.0);
        if let Ok((station, _)) = self.dense.at(element, x) {
            return station;
        }
        let near = |i: &usize| (self.stations.s[*i] - s).abs();
        let nearest = (0..self.stations.len()).min_by(|i, j| near(i).total_cmp(&near(j)));
        nearest.and_then(|i| self.stations.get(i)).unwrap_or_default()
    }

    /// `count` (at least two) equally spaced stations from base to tip.
    pub fn resampled(&self, count: usize) -> SpatialStations {
        let count = count.max(2);
        let mut out = SpatialStations::default();
        for k in 0..count {
            out.push(&self.at(self.arm.length * k as f64 / (count - 1) as f64));
        }
        out
    }

    /// Cable `cable` at `s` (m), m; `None` past its anchor or for a cable that is not there.
    pub fn cable_point(&self, cable: usize, s: f64) -> Option<[f64; 3]> {
        let own = self.arm.cables.get(cable)?;
        if s > own.end * self.arm.length * (1.0 + 1e-12) {
            return None;
        }
        let st = self.at(s);
        let offset = st.beta * own.offset.at(st.s, self.arm.length).value;
        let (sin, cos) = own.angle.at(st.s, self.arm.length).value.sin_cos();
        Some(each(|k| [st.x, st.y, st.z][k] + offset * (cos * st.b[k] + sin * st.c[k])))
    }

    /// The strain measure 1/2 int sum C (strain - reference)^2 A ds, J: a measure, no potential, as in the plane.
    pub fn strain_energy(&self) -> f64 {
        self.energy
    }

    /// How far the surface is from folding over itself: min over s of (nu - beta R sqrt(kappa^2 + mu^2))/nu, on the
    /// side of the section that is worst.
    pub fn fold_margin(&self) -> FoldMargin {
        self.fold
    }

    /// What should be known about this answer, beside [`SpatialConfiguration::snaps`]. The tangential load of the
    /// momentum law, which warnings in the plane weigh, is not weighed in space.
    pub fn warnings(&self) -> Vec<Warning> {
        let mut out = Vec::new();
        if self.fold.value <= 0.0 {
            out.push(Warning::SurfaceFold { margin: self.fold.value, s: self.fold.s });
        }
        let (nu, s) = self.stretch;
        if !(0.5..=1.5).contains(&nu) {
            out.push(Warning::StrainRange { nu, s });
        }
        for cable in self.arm.cables.iter().filter(|cable| cable.stroke.is_some()) {
            if let Some(max) = cable.max_tension.filter(|max| cable.tension > *max) {
                out.push(Warning::TensionAboveMax { cable: cable.name.clone(), tension: cable.tension, max });
            }
        }
        if self.arm.cavity == Cavity::Sealed && !self.arm.inner_radius.is_zero() {
            out.push(Warning::SealedCavity);
        }
        out
    }
}

impl Dense {
    /// Everything at `x` in [0, 1] of element `i`, and the undeformed radius, m.
    fn at(&self, i: usize, x: f64) -> Result<(SpatialStation, f64), SectionFailure> {
        let engine = &self.engine;
        let length = engine.equations.units.length;
        let force = engine.equations.units.force;
        let at = engine.section_in(i, x)?;
        let mesh = &engine.solution.mesh;
        let r: Vector<f64> = match x {
            0.0 => self.nodes[i],
            1.0 => self.nodes[i + 1],
            _ => {
                // The polynomial through the stages, moved so that it meets both nodes.
                let h = length * mesh.step(i);
                let integral = |weights: &[f64; M]| -> Vector<f64> {
                    each(|k| (0..M).map(|j| h * weights[j] * self.rates[i * M + j][k]).sum())
                };
                let (to_here, whole) = (integral(&engine.system.gauss.integrals(x)), integral(&engine.system.gauss.b));
                each(|k| {
                    let missing = self.nodes[i + 1][k] - self.nodes[i][k] - whole[k];
                    self.nodes[i][k] + to_here[k] + x * missing
                })
            }
        };
        let s = if x == 1.0 { mesh.nodes()[i + 1] } else { mesh.nodes()[i] + x * mesh.step(i) };
        let [nu, eta, zeta, tau, kappa, mu] = at.strain;
        let [n_a, n_b, n_c, m_a, m_b, m_c] = at.contact;
        let Directors { a, b, c } = at.directors;
        let station = SpatialStation {
            s: s * length,
            x: r[0],
            y: r[1],
            z: r[2],
            a,
            b,
            c,
            nu,
            eta,
            zeta,
            tau: tau / length,
            kappa: kappa / length,
            mu: mu / length,
            beta: at.beta,
            alpha: angle_to_tangent(&at.strain),
            n_a: n_a * force,
            n_b: n_b * force,
            n_c: n_c * force,
            m_a: m_a * force * length,
            m_b: m_b * force * length,
            m_c: m_c * force * length,
        };
        Ok((station, at.radius * length))
    }
}
