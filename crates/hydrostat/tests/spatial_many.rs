//! Many solves in space: every row is the row's own solve, whatever it is solved after and on how many threads.

use hydrostat::{
    Arm, ManyOptions, NoRow, Options, SpatialConfiguration, SpatialError, SpatialSolver, Wanted, solve_many_in_space,
};
use hydrostat_files::{ArmFile, shipped};

fn arm() -> Arm {
    ArmFile::parse(shipped::get("silicone-spatial").unwrap(), "silicone-spatial").unwrap().arm().unwrap()
}

/// Tensions of two cables and directions of the stream, `count` by `count`, the tension running faster.
fn grid(tension: f64, speed: f64, count: u32) -> Vec<Arm> {
    let fraction = |k: u32| f64::from(k) / f64::from(count - 1);
    let row = |i: u32, k: u32| {
        let mut arm = arm();
        arm.flow.speed = speed;
        let (sin, cos) = (2.0 * fraction(i)).sin_cos();
        arm.space.get_or_insert_default().stream = Some([0.5, sin, cos]);
        arm.cables[0].tension = tension * fraction(k);
        arm.cables[1].tension = 0.5 * tension * fraction(k);
        arm
    };
    (0..count).flat_map(|i| (0..count).map(move |k| (i, k))).map(|(i, k)| row(i, k)).collect()
}

fn own(arm: &Arm, tol: f64) -> Result<SpatialConfiguration, SpatialError> {
    SpatialSolver::new(arm, Options::with_tol(tol))?.solve()
}

fn largest(apart: impl IntoIterator<Item = f64>) -> f64 {
    apart.into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// Rows against solves of their own; how many of them have an answer.
fn compare(arms: &[Arm], every: usize, tol: f64) -> usize {
    let wanted = Wanted { strokes: true, ..Wanted::default() };
    let rows = solve_many_in_space(arms, &ManyOptions { tol, tile: 64, wanted, ..ManyOptions::default() }).unwrap();
    let mut answered = 0;
    for (arm, row) in arms.iter().zip(&rows).step_by(every) {
        match (own(arm, tol), row) {
            (Ok(own), Ok(row)) => {
                answered += 1;
                let (at, tip) = (row.tip, own.tip());
                let apart = largest([at.x - tip.x, at.y - tip.y, at.z - tip.z]);
                // Either may be off by its tolerance; turns and forces by what moves the tip so far.
                assert!(apart <= 2.0 * tol * arm.length, "{apart:e}: {arm:?}");
                for (mine, others) in [(at.a, tip.a), (at.b, tip.b), (at.c, tip.c)] {
                    assert!(largest((0..3).map(|k| mine[k] - others[k])) < 200.0 * tol, "{mine:?} {others:?}");
                }
                assert_eq!(row.tensions, own.cables.iter().map(|c| c.tension).collect::<Vec<_>>());
                for (stroke, cable) in row.strokes.iter().zip(&own.cables) {
                    assert!((stroke - cable.stroke).abs() < 20.0 * tol * arm.length, "{stroke} {}", cable.stroke);
                }
                let [a, b] = [row.base_reaction, own.base_reaction];
                let scale = largest(b.force).max(1e-6);
                let off = largest((0..3).map(|k| a.force[k] - b.force[k]));
                assert!(off < 200.0 * tol * scale, "{a:?} {b:?}");
                let off = largest((0..3).map(|k| a.moment[k] - b.moment[k]));
                assert!(off < 200.0 * tol * scale * arm.length, "{a:?} {b:?}");
            }
            (Err(SpatialError::NoEquilibrium(own)), Err(NoRow::Verdict(row))) => assert_eq!(own.verdict, *row),
            (own, row) => panic!("{own:?} {row:?}"),
        }
    }
    answered
}

#[test]
fn rows_in_space_are_their_own_solves() {
    assert_eq!(compare(&grid(0.3, 0.05, 7), 2, 1e-6), 25);
    assert_eq!(compare(&grid(0.2, 0.03, 5), 3, 1e-9), 9);
}

/// Against a faster stream and beyond the tension that folds the tip.
#[test]
fn rows_in_space_end_with_their_own_verdict() {
    let mut arms = grid(1.2, 0.1, 6);
    for arm in &mut arms[18..] {
        arm.space.get_or_insert_default().stream = Some([-1.0, 0.1, 0.05]);
    }
    let answered = compare(&arms, 3, 1e-6);
    assert!((4..=18).contains(&answered), "{answered}");
}

#[test]
fn neither_order_nor_threads_matter_to_rows_in_space() {
    let arms = grid(0.3, 0.05, 5);
    let wanted = Wanted { strokes: true, fold_margin: true, stations: 5, ..Wanted::default() };
    let solve = |arms: &[Arm], threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solve_many_in_space(arms, &ManyOptions { tile: 10, wanted, ..ManyOptions::default() }).unwrap())
    };
    let one = solve(&arms, 1);
    assert_eq!(one, solve(&arms, 3));
    let backwards: Vec<Arm> = arms.iter().rev().cloned().collect();
    for (row, again) in one.iter().zip(solve(&backwards, 2).iter().rev()) {
        let (row, again) = (row.as_ref().unwrap(), again.as_ref().unwrap());
        let apart = [row.tip.x - again.tip.x, row.tip.y - again.tip.y, row.tip.z - again.tip.z];
        assert!(largest(apart) < 2e-6 * arms[0].length, "{apart:?}");
        assert_eq!((row.stations.len(), row.strokes.len()), (5, 3));
    }
}

/// Every load that a row may start from the row before with is taken, and none of an arm that is another.
#[test]
fn other_loads_and_arms_between_rows_in_space() {
    let mut arms = vec![arm(); 12];
    let changes: [fn(&mut Arm); 11] = [
        |arm| arm.tip.force[0] = 0.01,
        |arm| arm.space.get_or_insert_default().tip_force = 0.005,
        |arm| arm.space.get_or_insert_default().tip_moment = [1e-4, -2e-4],
        |arm| arm.space.get_or_insert_default().tip_follower = 0.004,
        |arm| arm.space.get_or_insert_default().gravity = Some([0.0, 1.0, -1.0]),
        |arm| arm.space.get_or_insert_default().force = 0.02.into(),
        |arm| arm.space.get_or_insert_default().z = 0.1,
        |arm| arm.space.get_or_insert_default().tau = 2.0.into(),
        |arm| arm.space.get_or_insert_default().c4 = Some(9.0.into()),
        |arm| arm.length = -1.0,
        |arm| arm.cables[0].friction = 0.2,
    ];
    for (arm, change) in arms.iter_mut().skip(1).zip(changes) {
        arm.cables[0].tension = 0.1;
        change(arm);
    }
    let rows = solve_many_in_space(&arms, &ManyOptions::default()).unwrap();
    for (k, (arm, row)) in arms.iter().zip(rows).enumerate() {
        match (own(arm, 1e-8), row) {
            (Ok(own), Ok(row)) => {
                let (tip, own) = (row.tip, own.tip());
                let apart = largest([tip.x - own.x, tip.y - own.y, tip.z - own.z]);
                assert!(apart < 2e-6 * arm.length, "{k}: {apart:e}");
            }
            (Err(SpatialError::Arm(_)), Err(NoRow::Arm(_))) => assert!(k >= 10, "{k}"),
            (own, row) => panic!("{k}: {own:?} {row:?}"),
        }
    }
}
