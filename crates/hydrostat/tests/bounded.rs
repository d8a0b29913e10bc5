//! What fuzzing found: arms far from any that is built are answered in bounded work and memory. Each test is named
//! after what it was.

use hydrostat::{Arm, Cable, Options, Profile, SolveError, Solver, VerdictKind};
use hydrostat_files::{ArmFile, shipped};

/// The arm `paper` without its loads.
fn uniform() -> Arm {
    let mut arm = Arm::cone(1.0, 0.05, 0.05, 1e6, 0.5);
    arm.cables.push(Cable::new("left", 0.025).pulled(20.0));
    arm.cables.push(Cable::new("right", -0.025));
    arm
}

/// The goal of a second mesh was held between two bounds whose order a tolerance above 3.3e-4 turns round.
#[test]
fn a_second_mesh_at_a_coarse_tolerance_panicked() {
    for (name, curvature) in [("silicone", 342.66), ("octopus", 203.0), ("multi-bending", 687.0)] {
        let mut arm = ArmFile::parse(shipped::get(name).unwrap(), name).unwrap().arm().unwrap();
        arm.reference.mu = curvature.into();
        let found = Solver::new(&arm, Options::with_tol(1e-3)).unwrap().solve().unwrap();
        assert!(found.statistics.meshes > 2, "{name}: one mesh was enough, {:?}", found.statistics);
        assert!(found.error_estimate <= 1e-3 * arm.length, "{name}: {:e} m", found.error_estimate);
    }
}

/// An arm that winds through the stream 10^5 times got a node for every time: 41,750 elements, 890 MB, 17 s.
#[test]
fn an_arm_wound_up_in_a_stream_took_a_gigabyte() {
    let mut arm = uniform();
    arm.reference.mu = 656_211.0.into();
    arm.reference.nu = 0.086.into();
    arm.flow.speed = 0.5;
    match Solver::new(&arm, Options::with_tol(1e-3)).unwrap().solve() {
        Ok(found) => assert!(found.statistics.elements <= 3000, "{:?}", found.statistics),
        Err(SolveError::NoEquilibrium(no)) => {
            assert_eq!(no.verdict.kind, VerdictKind::NotFound);
            let elements = no.last_good.map_or(0, |last| last.statistics.elements);
            assert!(elements <= 3000, "{elements} elements");
        }
        Err(error) => panic!("{error}"),
    }
}

/// Evaluations before a step back were forgotten: what a path took was what its last steps took.
#[test]
fn evaluations_of_refused_steps_were_not_counted() {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.5));
    arm.flow.speed = 0.1;
    arm.flow.direction = 1.2;
    let taken = arm.solve().unwrap().statistics;
    assert!(taken.load_steps > 0, "{taken:?}");
    // A round evaluates all stations of a mesh that has eight elements or more; some of the rounds are of the check,
    // which counts its own.
    assert!(taken.evaluations > 32 * taken.newton_rounds / 2, "{taken:?}");
}
