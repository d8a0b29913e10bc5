//! Many solves: every row is the row's own solve, whatever it is solved after and on how many threads.

use hydrostat::{Arm, ManyOptions, NoRow, Options, Row, SolveError, Solver, Wanted, solve_many};
use hydrostat_files::{ArmFile, shipped};

fn arm(name: &str) -> Arm {
    ArmFile::parse(shipped::get(name).unwrap(), name).unwrap().arm().unwrap()
}

/// Tensions of the first cable and speeds of the stream, `count` by `count`, the tension running faster.
fn grid(arm: &Arm, tension: f64, speed: f64, count: u32) -> Vec<Arm> {
    let fraction = |k: u32| f64::from(k) / f64::from(count - 1);
    let row = |i: u32, k: u32| {
        let mut arm = arm.clone();
        arm.flow.speed = speed * fraction(i);
        arm.cables[0].tension = tension * fraction(k);
        arm
    };
    (0..count).flat_map(|i| (0..count).map(move |k| (i, k))).map(|(i, k)| row(i, k)).collect()
}

fn own(arm: &Arm, tol: f64) -> Result<hydrostat::Configuration, SolveError> {
    Solver::new(arm, Options::with_tol(tol)).unwrap().solve()
}

/// Rows against solves of their own; how many of them have an answer.
fn compare(arms: &[Arm], every: usize, tol: f64) -> usize {
    let wanted = Wanted { strokes: true, ..Wanted::default() };
    let rows = solve_many(arms, &ManyOptions { tol, tile: 64, wanted, ..ManyOptions::default() }).unwrap();
    let mut answered = 0;
    for (arm, row) in arms.iter().zip(&rows).step_by(every) {
        match (own(arm, tol), row) {
            (Ok(own), Ok(row)) => {
                answered += 1;
                let (at, tip) = (row.tip, own.tip());
                let apart = (at.x - tip.x).hypot(at.y - tip.y);
                // Either may be off by its tolerance; angles and forces by what moves the tip so far.
                assert!(apart <= 2.0 * tol * arm.length, "{apart:e}: {arm:?}");
                assert!((at.theta - tip.theta).abs() < 200.0 * tol, "{arm:?}");
                // alpha(L) hangs on the slope of beta at the tip, which is good to some 500 times the tip, warm or not.
                assert!((at.alpha - tip.alpha).abs() < 2000.0 * tol, "{arm:?}");
                assert_eq!(row.tensions, own.cables.iter().map(|c| c.tension).collect::<Vec<_>>());
                for (stroke, cable) in row.strokes.iter().zip(&own.cables) {
                    assert!((stroke - cable.stroke).abs() < 20.0 * tol * arm.length, "{stroke} {}", cable.stroke);
                }
                let [a, b] = [row.base_reaction, own.base_reaction];
                let scale = b.force[0].hypot(b.force[1]).max(1e-6);
                for k in 0..2 {
                    assert!((a.force[k] - b.force[k]).abs() < 200.0 * tol * scale, "{a:?} {b:?}");
                }
                assert!((a.moment - b.moment).abs() < 200.0 * tol * scale * arm.length, "{a:?} {b:?}");
            }
            (Err(SolveError::NoEquilibrium(own)), Err(NoRow::Verdict(row))) => assert_eq!(own.verdict, *row),
            (own, row) => panic!("{own:?} {row:?}"),
        }
    }
    answered
}

#[test]
fn rows_are_their_own_solves() {
    let paper = arm("paper");
    assert_eq!(compare(&grid(&paper, 100.0, 1.0, 24), 5, 1e-6), 116);
    assert_eq!(compare(&grid(&paper, 80.0, 0.6, 12), 5, 1e-9), 29);
}

/// Against the stream, where there are other equilibria, and beyond the tension that folds the tip.
#[test]
fn rows_stay_on_their_own_branch_and_end_with_their_own_verdict() {
    let mut silicone = arm("silicone");
    silicone.flow.direction = 170.0_f64.to_radians();
    let arms = grid(&silicone, 1.2, 0.15, 16);
    let answered = compare(&arms, 3, 1e-6);
    assert!((20..80).contains(&answered), "{answered}");
}

#[test]
fn threads_do_not_matter() {
    let arms = grid(&arm("paper"), 120.0, 0.9, 14);
    let wanted = Wanted { strokes: true, fold_margin: true, stations: 5, ..Wanted::default() };
    for wanted in [Wanted::default(), wanted] {
        let solve = |threads: usize, tile: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| solve_many(&arms, &ManyOptions { tile, wanted, ..ManyOptions::default() }).unwrap())
        };
        let (one, three) = (solve(1, 20), solve(3, 20));
        assert_eq!(one, three);
        // A tile depends on its own rows alone.
        let part = solve_many(&arms[40..80], &ManyOptions { tile: 20, wanted, ..ManyOptions::default() }).unwrap();
        assert_eq!(one[40..80], part[..]);
    }
}

#[test]
fn a_row_has_what_was_asked_for() {
    let arms = grid(&arm("silicone"), 0.4, 0.1, 3);
    let row = |wanted| -> Row {
        let rows = solve_many(&arms, &ManyOptions { wanted, ..ManyOptions::default() }).unwrap();
        rows[5].clone().unwrap()
    };
    let plain = row(Wanted::default());
    assert!(plain.strokes.is_empty() && plain.fold_margin.is_none() && plain.stability.is_none());
    assert!(plain.stations.is_empty());
    let all = row(Wanted { strokes: true, fold_margin: true, stability: true, warnings: true, stations: 7 });
    let own = own(&arms[5], 1e-9).unwrap();
    assert_eq!((all.strokes.len(), all.stations.len()), (2, 7));
    assert_eq!(all.stability, own.stability());
    assert!((all.fold_margin.unwrap().value - own.fold_margin().value).abs() < 0.02);
    assert!((all.stations.x[6] - all.tip.x).abs() < 1e-12);
}

#[test]
fn other_arms_between_rows() {
    let mut arms = grid(&arm("paper"), 60.0, 0.5, 3);
    arms.extend(grid(&arm("silicone"), 0.3, 0.2, 3));
    arms[4].length = -1.0;
    arms[7].cables[1].stroke = Some(0.001);
    let rows = solve_many(&arms, &ManyOptions::default()).unwrap();
    for (k, (arm, row)) in arms.iter().zip(rows).enumerate() {
        if k == 4 {
            assert!(matches!(row, Err(NoRow::Arm(_))));
            continue;
        }
        let (tip, own) = (row.unwrap().tip, own(arm, 1e-8).unwrap().tip());
        assert!((tip.x - own.x).hypot(tip.y - own.y) < 2e-6 * arm.length);
    }
}

#[test]
fn options_are_checked() {
    for (tol, tile) in [(0.0, 1), (1e-13, 1), (f64::NAN, 1), (1e-6, 0)] {
        let options = ManyOptions { tol, tile, ..ManyOptions::default() };
        assert!(matches!(solve_many(&[], &options), Err(SolveError::Option { .. })), "{options:?}");
    }
}
