//! The boundary of what a tip reaches, against scans of the tensions.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use hydrostat::{
    Arm, Boundary, BoundaryKind, BoundaryOptions, BoundaryProgress, Cable, Options, Parameter, Profile, ReachError,
    Solver,
};

fn cone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

fn options(most: f64) -> BoundaryOptions {
    BoundaryOptions { max_tension: Some(most), ..BoundaryOptions::default() }
}

fn lines(boundary: &Boundary) -> Vec<Vec<[f64; 2]>> {
    boundary.pieces.iter().map(|piece| piece.points.iter().map(|p| [p.tip.x, p.tip.y]).collect()).collect()
}

/// How often the ray from a place to the right crosses the lines.
fn crossings(lines: &[Vec<[f64; 2]>], [x, y]: [f64; 2]) -> usize {
    let crosses = |pair: &&[[f64; 2]]| {
        let [a, b] = [pair[0], pair[1]];
        (a[1] > y) != (b[1] > y) && a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > x
    };
    lines.iter().flat_map(|line| line.windows(2)).filter(crosses).count()
}

/// How far a place is from the lines.
fn distance(lines: &[Vec<[f64; 2]>], [x, y]: [f64; 2]) -> f64 {
    let to = |pair: &[[f64; 2]]| {
        let [a, b] = [pair[0], pair[1]];
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        let fraction = (((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy).max(1e-300)).clamp(0.0, 1.0);
        (a[0] + fraction * dx - x).hypot(a[1] + fraction * dy - y)
    };
    lines.iter().flat_map(|line| line.windows(2)).map(to).fold(f64::INFINITY, f64::min)
}

/// Without folds the image of the box is what its edges enclose: tips of tensions inside are inside, to what chords cut
/// off.
#[test]
fn the_edges_enclose_all_tips() {
    const MOST: f64 = 0.2;
    let arm = cone();
    let boundary = arm.reachable(&options(MOST)).unwrap();
    assert!(boundary.pieces.iter().all(|piece| matches!(piece.kind, BoundaryKind::Edge(_))));
    let lines = lines(&boundary);
    let mut solver = Solver::new(&arm, Options::default()).unwrap();
    let (mut inside, mut all) = (0, 0);
    for a in 0..=12 {
        for b in 0..=12 {
            solver.set_tensions(&[MOST * f64::from(a) / 12.0, MOST * f64::from(b) / 12.0]).unwrap();
            let tip = solver.update().unwrap().tip;
            let on_edge = a % 12 == 0 || b % 12 == 0;
            let off = distance(&lines, [tip.x, tip.y]) / arm.length;
            all += 1;
            inside += usize::from(crossings(&lines, [tip.x, tip.y]) % 2 == 1);
            if on_edge {
                assert!(off < 2e-4, "{a}, {b}: {off:e} L off the edge that it is on");
            } else {
                assert!(crossings(&lines, [tip.x, tip.y]) % 2 == 1 || off < 2e-4, "{a}, {b}: outside by {off:e} L");
            }
        }
    }
    println!("{inside} of {all} inside");
    // Not level with the straight arm, whose tip is a corner on the ray.
    for [x, y] in [[0.3, 0.001], [0.0, 0.001], [0.1, 0.3]] {
        assert_eq!(crossings(&lines, [x, y]) % 2, 0);
    }
    // Places are as far apart as asked for, and every edge ends at corners of the box.
    for piece in &boundary.pieces {
        for pair in piece.points.windows(2) {
            let apart = (pair[0].tip.x - pair[1].tip.x).hypot(pair[0].tip.y - pair[1].tip.y) / arm.length;
            assert!(apart <= 0.02 + 1e-12, "{apart}");
        }
        for end in [piece.points.first(), piece.points.last()] {
            assert!(end.unwrap().tensions.iter().all(|t| *t == 0.0 || *t == MOST), "{end:?}");
        }
    }
}

/// On a fold the tip's derivatives by the two tensions are parallel.
#[test]
fn folds_are_where_two_cables_move_the_tip_alike() {
    // Curled by more than a turn, the tip goes back and forth.
    let arm = cone();
    let boundary = arm.reachable(&BoundaryOptions { spacing: 0.03, ..options(0.5) }).unwrap();
    let folds: Vec<_> = boundary.pieces.iter().filter(|piece| matches!(piece.kind, BoundaryKind::Fold(_))).collect();
    let count: usize = folds.iter().map(|piece| piece.points.len()).sum();
    println!("{} folds, {count} points", folds.len());
    assert!(count > 10);
    for point in folds.iter().flat_map(|piece| &piece.points) {
        let mut at = arm.clone();
        at.set_tensions(&point.tensions).unwrap();
        let mut solver = Solver::new(&at, Options::default()).unwrap();
        let found = solver.sensitivities(&[Parameter::Tension(0), Parameter::Tension(1)]).unwrap();
        let columns = found.tip_jacobian(&[Parameter::Tension(0), Parameter::Tension(1)]);
        let cross = columns[0][0] * columns[1][1] - columns[0][1] * columns[1][0];
        let sizes = columns.iter().map(|c| c[0].hypot(c[1])).product::<f64>();
        assert!(cross.abs() < 1e-4 * sizes, "{point:?}: {cross:e} of {sizes:e}");
    }
}

/// Tensions that fold the tip end the image: the last shapes on rays are where a solve says that the limit is.
#[test]
fn limits_of_the_tensions_are_part_of_the_boundary() {
    let arm = cone();
    let boundary = arm.reachable(&BoundaryOptions { spacing: 0.05, ..options(1.5) }).unwrap();
    let limits: Vec<_> = boundary.pieces.iter().filter(|piece| matches!(piece.kind, BoundaryKind::Limit(_))).collect();
    let points: usize = limits.iter().map(|piece| piece.points.len()).sum();
    println!("{points} points of limits");
    assert!(points > 4);
    for point in limits.iter().flat_map(|piece| &piece.points) {
        let mut beyond = arm.clone();
        let more: Vec<f64> = point.tensions.iter().map(|t| 1.01 * t).collect();
        beyond.set_tensions(&more).unwrap();
        assert!(beyond.solve().is_err(), "{point:?}");
    }
}

/// Nobody was asked while a boundary was traced: Ctrl-C was heard at its end.
#[test]
fn boundaries_were_traced_to_their_end() {
    let arm = cone();
    let asked = AtomicUsize::new(0);
    let last = Mutex::new(None);
    let count = |progress: BoundaryProgress| {
        asked.fetch_add(1, Ordering::Relaxed);
        *last.lock().unwrap() = Some(progress);
        true
    };
    let whole = arm.reachable_while(&options(0.2), count).unwrap();
    assert_eq!(whole, arm.reachable(&options(0.2)).unwrap());
    let all = asked.load(Ordering::Relaxed);
    let points: usize = whole.pieces.iter().map(|piece| piece.points.len()).sum();
    assert!(all > points, "asked {all} times for {points} points");
    let last = last.lock().unwrap().unwrap();
    // Four edges, a face, a plane.
    assert!(last.of == 6 && last.done < 6 && last.shapes < all, "{last:?} of {all}");

    asked.store(0, Ordering::Relaxed);
    let part = arm.reachable_while(&options(0.2), |_| asked.fetch_add(1, Ordering::Relaxed) < 20).unwrap();
    let found: usize = part.pieces.iter().map(|piece| piece.points.len()).sum();
    // Whoever has said no is not asked again, but by threads that were asking.
    assert!(asked.load(Ordering::Relaxed) < 20 + 64, "{asked:?}");
    assert!(found <= 20 && found < points, "{found} of {points} points");
}

#[test]
fn wrong_requests_are_refused() {
    let arm = cone();
    let unbounded = BoundaryOptions::default();
    assert!(matches!(arm.reachable(&unbounded), Err(ReachError::Option { option: "max_tension", .. })));
    let wide = BoundaryOptions { spacing: 1.0, ..options(0.4) };
    assert!(matches!(arm.reachable(&wide), Err(ReachError::Option { option: "spacing", .. })));
    let mut many = cone();
    for _ in 0..7 {
        many.cables.push(Cable::new("more", 0.001));
    }
    assert!(matches!(many.reachable(&options(0.4)), Err(ReachError::Option { option: "cables", .. })));
}
