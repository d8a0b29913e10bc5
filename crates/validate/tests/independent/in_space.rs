//! Arms at random, turned into random planes: the solver of arms in space has the answers of the plane.

use std::collections::BTreeMap;

use hydrostat::{
    Arm, BaseDirections, Configuration, FlowSurface, Options, SolveError, Solver, Space, SpatialConfiguration,
    SpatialError, SpatialSolver, VerdictKind,
};
use rayon::prelude::*;

use crate::arms::{Draw, arm};
use crate::dice::Dice;

type Matrix = [[f64; 3]; 3];

/// A turn at random, from a quaternion at random.
fn turn(dice: &mut Dice) -> Matrix {
    let q: [f64; 4] = std::array::from_fn(|_| dice.between(-1.0, 1.0));
    let norm = q.iter().map(|v| v * v).sum::<f64>().sqrt();
    let [w, x, y, z] = q.map(|v| v / norm);
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

fn turned(m: &Matrix, v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|k| m[i][k] * v[k]).sum())
}

/// An arm of the plane that arms in space have everything of: friction and a windward side are left out, and the
/// distributed force has one direction.
fn planar(seed: u64) -> Arm {
    let draw = Draw { extreme: 2.0, friction: false, ..Draw::ALL };
    let mut arm = arm(seed, &draw);
    if arm.model.flow_surface == FlowSurface::Lateral {
        arm.model.flow_surface = FlowSurface::Centreline;
    }
    arm.distributed.force[1] = 0.0.into();
    arm
}

/// The same arm with everything turned.
fn in_space(arm: &Arm, m: &Matrix) -> Arm {
    let mut out = arm.clone();
    let (sin, cos) = arm.base.angle.sin_cos();
    let in_plane = |angle: f64| [angle.cos(), angle.sin(), 0.0];
    let force = turned(m, [arm.tip.force[0], arm.tip.force[1], 0.0]);
    let moment = turned(m, [0.0, 0.0, arm.tip.moment]);
    let base = turned(m, [arm.base.x, arm.base.y, 0.0]);
    let [along, about] = [turned(m, [1.0, 0.0, 0.0]), turned(m, [0.0, 0.0, 1.0])];
    out.tip.force = [force[0], force[1]];
    out.tip.moment = moment[2];
    (out.base.x, out.base.y) = (base[0], base[1]);
    out.distributed.force = [0, 1].map(|k| arm.distributed.force[0].scaled(along[k], 1.0));
    out.distributed.couple = arm.distributed.couple.scaled(about[2], 1.0);
    out.space = Some(Space {
        z: base[2],
        base: Some(BaseDirections {
            direction: turned(m, [cos, sin, 0.0]),
            section: Some(turned(m, [-sin, cos, 0.0])),
        }),
        stream: Some(turned(m, in_plane(arm.flow.direction))),
        gravity: arm.gravity.map(|g| turned(m, in_plane(g.direction))),
        tip_force: force[2],
        tip_moment: [moment[0], moment[1]],
        force: arm.distributed.force[0].scaled(along[2], 1.0),
        couple: [0, 1].map(|k| arm.distributed.couple.scaled(about[k], 1.0)),
        ..Space::default()
    });
    out
}

/// How both answers stand to each other.
fn compared(
    arm: &Arm,
    m: &Matrix,
    flat: Result<Configuration, SolveError>,
    space: Result<SpatialConfiguration, SpatialError>,
) -> (&'static str, String) {
    match (flat, space) {
        (Ok(flat), Ok(space)) => {
            let there = turned(m, [flat.tip().x, flat.tip().y, 0.0]);
            let tip = space.tip();
            let off = [tip.x - there[0], tip.y - there[1], tip.z - there[2]].iter().map(|v| v * v).sum::<f64>().sqrt();
            let allowed = 3.0 * (flat.error_estimate + space.error_estimate) + 1e-9 * arm.length;
            let words = format!(
                "{:.1e} L apart, estimates {:.1e} and {:.1e}, stable {:?} {:?}",
                off / arm.length,
                flat.error_estimate / arm.length,
                space.error_estimate / arm.length,
                flat.stable,
                space.stable
            );
            (if off <= allowed { "same" } else { "apart" }, words)
        }
        (Err(SolveError::NoEquilibrium(flat)), Err(SpatialError::NoEquilibrium(space))) => {
            let (a, b) = (&flat.verdict, &space.verdict);
            let near = (a.load_fraction - b.load_fraction).abs() < 0.02 && a.phase == b.phase;
            let words = format!("plane: {}; space: {}", a.message(), b.message());
            let lost = a.kind == VerdictKind::NotFound || b.kind == VerdictKind::NotFound;
            (
                if lost {
                    "lost in both"
                } else if near {
                    "same verdict"
                } else {
                    "other verdict"
                },
                words,
            )
        }
        (Ok(flat), Err(error)) => ("lost in space", format!("{error}; stable in the plane: {:?}", flat.stable)),
        (Err(error), Ok(_)) => ("lost in the plane", error.to_string()),
        (Err(a), Err(b)) => ("no arm", format!("{a}; {b}")),
    }
}

#[test]
fn arms_turned_into_any_plane_have_the_answers_of_the_plane() {
    let count = std::env::var("HYDROSTAT_ARMS").ok().and_then(|text| text.parse().ok()).unwrap_or(200_u64);
    let found: Vec<(u64, &str, String)> = (0..count)
        .into_par_iter()
        .map(|seed| {
            let arm = planar(seed);
            let m = turn(&mut Dice::new(seed));
            let options = Options::with_tol(1e-8);
            let flat = Solver::new(&arm, options).and_then(|mut solver| solver.solve());
            let space = SpatialSolver::new(&in_space(&arm, &m), options).and_then(|mut solver| solver.solve());
            let (what, words) = compared(&arm, &m, flat, space);
            (seed, what, words)
        })
        .collect();
    let mut counts = BTreeMap::new();
    for (seed, what, words) in &found {
        *counts.entry(*what).or_insert(0) += 1;
        if !what.starts_with("same") {
            println!("seed {seed}, {what}: {words}");
            if let Ok(directory) = std::env::var("HYDROSTAT_FINDINGS") {
                let arm = in_space(&planar(*seed), &turn(&mut Dice::new(*seed)));
                let texts = [("plane", planar(*seed)), ("space", arm)];
                for (name, text) in texts.map(|(name, arm)| (name, hydrostat_files::arm_to_toml(&arm))) {
                    std::fs::write(format!("{directory}/{seed}-{name}.toml"), text).expect("a directory to write to");
                }
            }
        }
    }
    println!("{counts:?}");
    assert!(counts["same"] * 100 >= count * 88, "{counts:?}");
}
