//! How a motion in space starts: at rest in the equilibrium of the statics.

use hydrostat_bvp::{Collocation, Lanes, Mesh, Real, Solution, Stage, each};

use super::equations::{COORDINATES, S, Shape, Spatial, SpatialMoving, X};
use crate::motion::error::MotionError;
use crate::motion::history::Snapshot;
use crate::motion::settling::Settling;
use crate::motion::start::{check, fair_elements, force_unit, mesh_at, not_found};
use crate::motion::state::carried_slopes;
use crate::motion::works::Carried;
use crate::rod::arm::Arm;
use crate::spatial::SpatialSolver;
use crate::spatial::equations::{FORCE, Guess, L, M, N, Q};
use crate::spatial::rotation::{Directors, spin, turned_by};
use crate::statics::solve::Options;

/// Refuses what cannot move; else at rest in the equilibrium of `arm`.
pub(super) fn at_rest(arm: &Arm, elements: Option<usize>, tol: f64, time: f64) -> Result<Spatial, MotionError> {
    check(arm)?;
    let elements = elements.unwrap_or_else(|| fair_elements(arm, tol));
    let options = Options::with_tol((0.01 * tol).clamp(1e-10, 1e-6));
    let of_start = |error| MotionError::SpatialStart(Box::new(error));
    let mut solver = SpatialSolver::new(arm, options).map_err(of_start)?;
    solver.solve().map_err(of_start)?;
    let engine = solver.engine_mut();
    let mut settling = Settling::of(SpatialMoving::new(arm, force_unit(arm)));
    let mesh = mesh_at(engine, elements);
    let statics = &mut settling.moving.statics;
    for (c, cable) in engine.equations.arm().cables.iter().enumerate().filter(|(_, cable)| cable.stroke.is_some()) {
        statics.set_tension(c, cable.tension / statics.units.force);
    }
    settling.moving.command_strokes();
    let statics = &settling.moving.statics;
    let force = engine.equations.units.force / statics.units.force;
    let whole = with_places(&engine.solution, force, statics.base_place(), &settling.system);
    settling.start_from(&whole, mesh);
    match settling.solve(time, 1e-10).and_then(|()| settling.solve(time, 1e-12)) {
        Ok(()) => Ok(settling),
        Err(_) => Err(not_found(time, 0.0, None, arm)),
    }
}

/// In the shape of a motion, see [`crate::motion::settling::Moves::in_shape`].
pub(super) fn in_shape(arm: &Arm, at: &Snapshot, carried: &[Carried], mesh: Mesh) -> Spatial {
    let mut settling = Settling::of(SpatialMoving::new(arm, force_unit(arm)));
    settling.moving.command_strokes();
    let stage = |block: usize| {
        let ([coordinates, _], [[inner @ .., closure_slope], _]) =
            (at.stage::<COORDINATES>(block), at.strains::<{ L + 1 }>(block));
        let q = turned_by(&at.from[block], &each(|k| coordinates[k]));
        let turned = spin(&q, &[inner[3], inner[4], inner[5]]);
        let carried = carried_slopes(&mesh, carried, block);
        Stage { slope: each(|a| if a < FORCE { turned[a] } else { carried[a - FORCE] }), inner, closure_slope }
    };
    let node = |(i, carried): (usize, &Carried)| {
        let q = at.rotation(i);
        each(|a| if a < FORCE { q[a] } else { carried[a - FORCE] })
    };
    let stages = (0..at.layout.blocks).map(stage).collect();
    let nodes = carried.iter().enumerate().map(node).collect();
    let guess = Guess { mesh: mesh.clone(), nodes, stages, ..Guess::default() };
    let whole = with_places(&guess, 1.0, settling.moving.statics.base_place(), &settling.system);
    settling.start_from(&whole, mesh);
    settling
}

/// The solution of the statics with x, y, z, from the base, as states, and what it carries times `force`.
pub(super) fn with_places(given: &Guess, force: f64, base: [f64; 3], system: &Collocation<S, M, 0, L>) -> Shape {
    let mut statics = Collocation::<N, M, Q, L>::with(system.gauss.clone());
    statics.take_stations(given);
    let mut out = Solution {
        mesh: given.mesh.clone(),
        directions: given.directions.clone(),
        nodes: Vec::with_capacity(given.nodes.len()),
        stages: Vec::with_capacity(given.stages.len()),
        ends: given.ends.clone(),
    };
    let by = |a: usize| if a < FORCE { 1.0 } else { force };
    for (station, stage) in statics.stations().iter().zip(&given.stages) {
        let directors = Directors::of(&std::array::from_fn(|k| station.z[k]));
        let rate = directors.to_space(&[stage.inner[0], stage.inner[1], stage.inner[2]]);
        out.stages.push(Stage {
            slope: std::array::from_fn(|a| if a < N { Lanes::of(by(a)) * stage.slope[a] } else { rate[a - X] }),
            inner: stage.inner,
            closure_slope: stage.closure_slope,
        });
    }
    let mut r = base;
    for (i, z) in given.nodes.iter().enumerate() {
        out.nodes.push(std::array::from_fn(|a| if a < N { by(a) * z[a] } else { r[a - X] }));
        if i < given.mesh.elements() {
            let h = given.mesh.step(i);
            for (j, b) in system.gauss.b.iter().enumerate() {
                let slope = out.slope(i, j);
                for (k, own) in r.iter_mut().enumerate() {
                    *own += h * b * slope[X + k];
                }
            }
        }
    }
    out
}
