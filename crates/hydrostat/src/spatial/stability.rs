//! Whether an equilibrium in space is stable against static divergence, and in how many directions it is not: as in
//! the plane ([`crate::stability`]), with all six motions of a section.
//!
//! Two eigenvalues of the compliance may pass together, as those of a straight column do at Euler's load: the
//! determinant's sign does not change there, and the count does.

use hydrostat_bvp::{Correction, Forcing, LANES, Lanes, Real, StageForcing, each};
use nalgebra::DMatrix;

use super::cable_paths::StageData;
use super::configuration::SpatialConfiguration;
use super::engine::Engine;
use super::equations::{FORCE, L, M, MOMENT, N, Q};
use super::lengths::{pull_taut, unit_change};
use super::rotation::{Directors, Vector, turn};
use crate::numerics::elimination::solved;
use crate::numerics::rounds::respond;
use crate::rod::model_options::Support;
use crate::statics::compliance::Basis;
use crate::statics::stability::{BLURRED, Growth, KEPT, MARGIN, ROUNDING, Stability, growing, rates_of};
use crate::statics::verdict::Phase;

/// Fields: the motion in space, and the turn in space.
const FIELDS: usize = 6;

/// Polynomials a field, and elements no longer than a part of the arm by as many; more where the count of what grows is
/// not settled.
const POLYNOMIALS: [usize; 2] = [12, 20];

impl SpatialConfiguration {
    /// Whether this equilibrium is stable against static divergence, see [`SpatialConfiguration::growth`]. `None`
    /// where that is not established.
    pub fn stability(&self) -> Option<Stability> {
        self.growth().map(|growth| growth.stability())
    }

    /// How fast small overdamped motions about this equilibrium grow or decay: of the velocity of the centreline over
    /// L and of the rate of turn about any axis, each against a resistance of one along the whole arm. `None` with
    /// [`Support::UnstrainedBase`], whose arm is no equilibrium at the tip, and where the number of growing motions
    /// does not settle as they are resolved more finely.
    pub fn growth(&self) -> Option<Growth> {
        if self.arm.model.support == Support::UnstrainedBase {
            return None;
        }
        for functions in POLYNOMIALS {
            let mut engine = self.engine().clone();
            engine.allowed = usize::MAX;
            let mesh = engine.solution.mesh.cut_to(1.0 / functions as f64);
            if mesh != engine.solution.mesh {
                engine.remap_to(mesh);
            }
            engine.iterate(1e-10, 6, None).ok()?;
            engine.linearise().ok()?;
            engine.find_border().ok()?;
            let sign = engine.determinant().known_sign();
            let unit = slowest_decay(&engine, functions)?;
            let compliance = compliance(&engine, functions)?;
            let holds =
                engine.stroke_control.as_ref().is_some_and(|stroke_control| stroke_control.taut.contains(&true));
            let rates = |functions: usize| {
                let size = FIELDS * functions;
                let least = if holds { BLURRED } else { ROUNDING };
                rates_of(DMatrix::from_fn(size, size, |i, j| compliance[(i, j)]), unit, least)
            };
            let mut all = rates(functions)?;
            let fewer = rates(functions - functions / 4)?;
            let count = growing(&all);
            let marginal = all.iter().any(|rate| rate[0].abs() <= MARGIN);
            let parity = sign.is_none_or(|sign| (sign > 0.0) == count.is_multiple_of(2));
            if count == growing(&fewer) && (marginal || parity) {
                all.truncate(count.max(KEPT));
                return Some(Growth { rates: all });
            }
        }
        None
    }
}

/// The slowest decay of the arm on the same mesh with no load at all.
fn slowest_decay(engine: &Engine, functions: usize) -> Option<f64> {
    let mut unloaded = engine.clone();
    unloaded.stroke_control = None;
    unloaded.equations.set_phase(Phase::Loads, 0.0);
    unloaded.start_unloaded_on(engine.solution.mesh.clone());
    unloaded.linearise().ok()?;
    let rates = rates_of(compliance(&unloaded, functions)?, 1.0, ROUNDING)?;
    rates.first().map(|rate| -rate[0]).filter(|decay| *decay > 0.0)
}

/// How the arm gives way to loads of the shapes of polynomials along it, about the last linearisation: entry `[FIELDS
/// k + f, FIELDS l + g]` is the part of polynomial `k` in the motion of field `f` under a load of the shape of
/// polynomial `l` in field `g`.
///
/// Where the lengths of taut cables are held, loads change their tensions so that the strokes stay: with V the strokes
/// that loads make at fixed tensions, U the motions that tensions make, and B the strokes that they make, U B^-1 V is
/// taken off.
fn compliance(engine: &Engine, functions: usize) -> Option<DMatrix<f64>> {
    let system = &engine.system;
    let basis = Basis::new(&system.gauss.c, &engine.solution.mesh, functions);
    let size = FIELDS * functions;
    let mut out = DMatrix::zeros(size, size);
    let blocks = system.stations().len();
    let mut change = Forcing { stages: vec![StageForcing::default(); blocks], ..Forcing::default() };
    let mut response = Correction::default();
    let at = StageData::of(system, &engine.solution);
    let pulled = match &engine.stroke_control {
        Some(stroke_control) => pull_taut(&engine.equations, system, &engine.solution, stroke_control).ok()?,
        None => Vec::new(),
    };
    let taut: Vec<(usize, usize)> = engine
        .stroke_control
        .iter()
        .flat_map(|stroke_control| stroke_control.taut_cables().into_iter().map(|i| (i, stroke_control.cables[i])))
        .collect();
    let mut motions = Vec::with_capacity(taut.len());
    for (by, (_, cable)) in pulled.iter().zip(&taut) {
        let change = unit_change(&engine.equations, system, *cable).ok()?;
        motions.push(project(engine, &basis, functions, &by.response, &change));
    }
    for column in 0..size {
        let (l, g) = (column / FIELDS, column % FIELDS);
        for (block, forcing) in change.stages.iter_mut().enumerate() {
            forcing.slope = [Lanes::default(); N];
            // (n_f, m_f)' = -load.
            forcing.slope[if g < 3 { FORCE + g } else { MOMENT + g - 3 }] = -basis.both(l, block)[0];
        }
        respond(system, &change, &mut response);
        for (row, moved) in project(engine, &basis, functions, &response, &change).into_iter().enumerate() {
            out[(row, column)] = moved;
        }
        let row = |(index, cable): &(usize, usize)| {
            let stroke = engine.equations.stroke_change(*cable, at, &response);
            (pulled.iter().map(|by| by.strokes[*index]).collect(), [-stroke, 0.0])
        };
        let (tensions, _) = solved(taut.iter().map(row).collect())?;
        for ([tension, _], motion) in tensions.iter().zip(&motions) {
            for (row, moved) in motion.iter().enumerate() {
                out[(row, column)] += tension * moved;
            }
        }
    }
    Some(out)
}

/// Projection of the motion in a response to a change of the equations, which moves places by itself, too.
fn project(
    engine: &Engine,
    basis: &Basis,
    functions: usize,
    response: &Correction<N, M, Q, L>,
    change: &Forcing<N, Q, L>,
) -> Vec<f64> {
    let system = &engine.system;
    let states = system.moved_states(response);
    let elements = engine.solution.mesh.elements();
    let mut out = vec![0.0; FIELDS * functions];
    for (block, local) in system.locals().iter().enumerate() {
        let (g, j) = (block / M, block % M);
        let q: [Lanes; 4] = each(|k| system.stations()[block].z[k]);
        let turns = turn(&q);
        let mut moved = [Lanes::of(0.0); FIELDS];
        for k in 0..Q {
            moved[k] = change.stages[block].rate[k] + local.rate_by_closure[k] * response.stages[block].closure_slope;
            for a in 0..N {
                moved[k] += local.rate_gradient[k][a] * states[block][a];
            }
        }
        let mut phi: Vector<Lanes> = [Lanes::of(0.0); 3];
        for k in 0..3 {
            for a in 0..4 {
                phi[k] += turns[k][a] * states[block][a];
            }
        }
        let turned = Directors::of(&q).to_space(&phi);
        moved[3..].copy_from_slice(&turned);
        let mut weight = Lanes::default();
        for lane in 0..LANES.min(elements - g * LANES) {
            weight.0[lane] = system.steps()[g].0[lane] * system.gauss.b[j];
        }
        for k in 0..functions {
            let [value, rest] = basis.both(k, block);
            for f in 0..FIELDS {
                // What x' adds at a place, x has from there to the tip.
                let by = weight * moved[f] * if f < 3 { rest } else { value };
                out[FIELDS * k + f] += by.0.iter().sum::<f64>();
            }
        }
    }
    out
}
