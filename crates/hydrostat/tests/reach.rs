//! Inverse kinetics: round trips, targets out of reach, redundancy, and bounds.

mod common;

use hydrostat::{Arm, Bound, Cable, Options, Profile, ReachError, ReachOptions, Solver, Target};
use hydrostat_files::shipped;

use common::{cone, options, shipped_arm, strokes_at, target_of, wound_in_by};

/// Tensions of the first and the last cable to a tip, and from there to tensions that lead to the same tip, as a solve
/// of its own says: how many, and how many of them are met.
fn round_trips(arm: &Arm, most: f64, per_cable: u32) -> (usize, usize) {
    let last = arm.cables.len() - 1;
    let (mut all, mut met) = (0, 0);
    let fraction = |k: u32| most * f64::from(k) / f64::from(per_cable - 1);
    for (left, right) in (0..per_cable).flat_map(|a| (0..per_cable).map(move |b| (fraction(a), fraction(b)))) {
        let mut tensions = vec![0.0; last + 1];
        (tensions[0], tensions[last]) = (left, right);
        let Some(target) = target_of(arm, &tensions) else { continue };
        all += 1;
        let found = arm.reach(&[target], &ReachOptions { all: false, ..options(most) });
        let back = found.ok().and_then(|found| found.solutions.into_iter().next());
        let solved = back.and_then(|back| target_of(arm, &back.tensions).map(|tip| (back.on_the_path, tip)));
        let off = solved.map_or(f64::INFINITY, |(_, tip)| (tip.x - target.x).hypot(tip.y - target.y) / arm.length);
        if off < 2e-8 {
            met += 1;
        } else {
            println!("{}: {left} and {right} N not met: {solved:?}", arm.name);
        }
    }
    (met, all)
}

fn shipped_round_trips(per_cable: u32) {
    let mut sums = (0, 0);
    for name in shipped::names() {
        let mut arm = shipped_arm(name);
        let most = arm.cables[0].max_tension.unwrap();
        for speed in [0.0, 0.1] {
            arm.flow.speed = speed;
            let (met, all) = round_trips(&arm, most, per_cable);
            println!("{name} at {speed} m/s: {met} of {all}");
            sums = (sums.0 + met, sums.1 + all);
        }
    }
    println!("{} of {}", sums.0, sums.1);
    assert!(sums.0 as f64 >= 0.999 * sums.1 as f64, "{} of {}", sums.0, sums.1);
}

#[test]
fn tips_of_shipped_arms_are_reached_on_a_thinned_grid() {
    shipped_round_trips(4);
}

#[test]
#[ignore = "minutes: the whole grid, on request"]
fn slow_tips_of_shipped_arms_are_reached_on_the_grid() {
    shipped_round_trips(11);
}

/// Near folds of the map from tensions to tips Newton's method finds another solution, or none: what was solved with is
/// found all the same.
#[test]
fn all_tensions_near_folds_are_found() {
    let arm = shipped_arm("silicone");
    for tensions in [
        [0.328, 0.0156],
        [0.328, 0.0234],
        [0.0, 0.319_266_538],
        [0.0, 0.6],
        [0.043_234_867, 0.297_319_235],
        [0.348_683_05, 0.072_911_004],
        [0.998_043_55, 0.194_675_974],
    ] {
        let target = target_of(&arm, &tensions).unwrap();
        let found = arm.reach(&[target], &ReachOptions::default()).unwrap();
        let seen: Vec<_> = found.solutions.iter().map(|one| (&one.tensions, one.distance)).collect();
        // At a fold a distance of 1e-8 is a change of tensions of its root.
        let own = |found: &&Vec<f64>| found.iter().zip(&tensions).all(|(a, b)| (a - b).abs() < 1.5e-4);
        assert!(seen.iter().any(|(found, _)| own(found)), "{tensions:?}: {seen:?}");
        assert!(seen.iter().all(|(_, distance)| *distance <= 1e-8), "{tensions:?}: {seen:?}");
    }
}

#[test]
fn tips_are_reached_again() {
    let mut flowing = cone();
    flowing.flow.speed = 0.1;
    flowing.flow.direction = 1.0;
    for arm in [cone(), flowing] {
        let (met, all) = round_trips(&arm, 0.5, 5);
        println!("{met} of {all}");
        assert!(all >= 24 && met == all, "{met} of {all}");
    }
}

/// The nearest of a fine scan of the tensions is no nearer than what is found.
#[test]
fn what_is_out_of_reach_is_met_as_nearly_as_a_scan_says() {
    const MOST: f64 = 0.4;
    let arm = cone();
    let scan: Vec<[f64; 2]> = (0..=20)
        .flat_map(|a| (0..=20).map(move |b| [MOST * f64::from(a) / 20.0, MOST * f64::from(b) / 20.0]))
        .filter_map(|tensions| target_of(&arm, &tensions).map(|tip| [tip.x, tip.y]))
        .collect();
    assert!(scan.len() > 400);
    for (x, y) in [(0.30, 0.02), (0.20, 0.20), (0.10, -0.20), (0.05, 0.0), (-0.1, 0.1)] {
        let found = arm.reach(&[Target::tip(x, y)], &options(MOST)).unwrap();
        assert!(found.solutions.is_empty(), "({x}, {y}) m is reached");
        let closest = found.closest.unwrap();
        let nearest = scan.iter().map(|tip| (tip[0] - x).hypot(tip[1] - y)).fold(f64::INFINITY, f64::min);
        let distance = closest.distance * arm.length;
        println!("({x}, {y}): {distance} for {nearest}, {:?}", closest.bounds);
        assert!(distance < nearest + 1e-6, "({x}, {y}): {distance} m for {nearest} m");
        assert!(!closest.bounds.is_empty());
    }
    // Straight ahead, too far: nothing pulls.
    let ahead = arm.reach(&[Target::tip(0.3, 0.0)], &options(MOST)).unwrap().closest.unwrap();
    assert_eq!(ahead.bounds, [Bound::Slack(0), Bound::Slack(1)]);
}

/// Three cables and a place leave one freedom: least effort against a scan of one of the tensions.
#[test]
fn three_cables_take_the_least_effort() {
    let mut arm = cone();
    let mut short = Cable::new("short", Profile::linear(0.006, 0.003));
    short.end = 0.6;
    arm.cables.push(short);
    let target = target_of(&arm, &[0.15, 0.1, 0.25]).unwrap();
    let found = arm.reach(&[target], &options(1.0)).unwrap();
    let best = &found.solutions[0];
    println!("{:?} {}", best.tensions, best.effort);
    let mut least = f64::INFINITY;
    for k in 0..=120 {
        // What is left of the effort with the short cable at a given tension.
        let given = 0.005 * f64::from(k);
        if let Some(effort) = effort_with_third(&arm, target, given) {
            least = least.min(effort);
        }
    }
    println!("scan {least}");
    assert!(least.is_finite() && best.effort <= least * (1.0 + 1e-6), "{} for {least}", best.effort);
    assert!(best.effort > 0.98 * least, "{} for {least}: the scan is too coarse", best.effort);
}

fn effort_with_third(arm: &Arm, target: Target, third: f64) -> Option<f64> {
    with_given(arm, target, [0.15, 0.1, third], 2).map(|tensions| effort(&tensions))
}

fn effort(tensions: &[f64]) -> f64 {
    tensions.iter().map(|t| t * t).sum()
}

/// Newton by differences on two of three tensions, from some; that of cable `given` stays.
fn with_given(arm: &Arm, target: Target, start: [f64; 3], given: usize) -> Option<Vec<f64>> {
    let mut solver = Solver::new(arm, Options::with_tol(1e-9)).ok()?;
    let [a, b] = [(given + 1) % 3, (given + 2) % 3];
    let mut tip = |t: [f64; 3]| {
        solver.set_tensions(&t).ok()?;
        let tip = solver.update().ok()?.tip;
        Some([tip.x - target.x, tip.y - target.y])
    };
    let mut t = start;
    for _ in 0..25 {
        let here = tip(t)?;
        if here[0].hypot(here[1]) < 1e-8 {
            return Some(t.to_vec());
        }
        let h = 1e-5;
        let mut by = |c: usize| {
            let mut moved = t;
            moved[c] += h;
            tip(moved).map(|there| [(there[0] - here[0]) / h, (there[1] - here[1]) / h])
        };
        let (by_a, by_b) = (by(a)?, by(b)?);
        let det = by_a[0] * by_b[1] - by_b[0] * by_a[1];
        let step = [(by_b[1] * here[0] - by_b[0] * here[1]) / det, (by_a[0] * here[1] - by_a[1] * here[0]) / det];
        let fraction = (0.05 / step[0].hypot(step[1])).min(1.0);
        (t[a], t[b]) = (t[a] - fraction * step[0], t[b] - fraction * step[1]);
        if t.iter().any(|t| *t < 0.0) {
            return None;
        }
    }
    None
}

#[test]
fn a_station_an_angle_and_several_markers_are_reached() {
    let mut arm = cone();
    arm.cables.push(Cable::new("third", Profile::linear(0.006, -0.001)));
    arm.set_tensions(&[0.2, 0.1, 0.15]).unwrap();
    let shape = arm.solve().unwrap();
    let (tip, middle) = (shape.tip(), shape.at(0.15));
    let at_middle = Target { s: Some(0.15), ..Target::tip(middle.x, middle.y) };
    let turned = Target { angle: Some(tip.theta), ..Target::tip(tip.x, tip.y) };
    for targets in [vec![at_middle], vec![turned], vec![at_middle, Target { weight: 2.0, ..Target::tip(tip.x, tip.y) }]]
    {
        let found = arm.reach(&targets, &options(0.6)).unwrap();
        let back =
            &found.solutions.first().unwrap_or_else(|| panic!("{targets:?}: {:?}", found.closest.map(|c| c.distance)));
        let shape = &back.configuration;
        for target in &targets {
            let place = shape.at(target.s.unwrap_or(arm.length));
            assert!((place.x - target.x).hypot(place.y - target.y) < 2e-8 * arm.length);
            assert!(target.angle.is_none_or(|angle| (place.theta - angle).abs() < 2e-8));
        }
    }
}

#[test]
fn strokes_that_are_found_lead_to_the_target() {
    let mut arm = cone();
    let mut short = Cable::new("short", Profile::linear(0.006, 0.003));
    (short.end, short.stiffness) = (0.6, Some(20.0));
    arm.cables.push(short);
    arm.flow.speed = 0.05;
    // At [0.3, 0, 0.2] N the target is reached, but its strokes, one cable just taut, do not lead there from slack
    // cables.
    for tensions in [[0.2, 0.1, 0.1], [0.0, 0.3, 0.0], [0.3, 0.05, 0.2]] {
        let target = target_of(&arm, &tensions).unwrap();
        let found = arm.reach_by_strokes(&[target], &options(0.6)).unwrap();
        let seen: Vec<_> = found.solutions.iter().map(|s| (&s.tensions, s.on_the_path, s.distance, s.effort)).collect();
        let best = found.solutions.iter().find(|one| one.on_the_path);
        let best = best.unwrap_or_else(|| panic!("{tensions:?}: {seen:?}"));
        assert!(best.configuration.arm.cables.iter().all(|cable| cable.stroke.is_some()));
        // By strokes alone: the tensions that it comes with do not count.
        let mut commanded = best.configuration.arm.clone();
        commanded.cables.iter_mut().for_each(|cable| cable.tension = 0.0);
        let shape = commanded.solve().unwrap();
        let off = (shape.tip().x - target.x).hypot(shape.tip().y - target.y) / arm.length;
        assert!(off < 3e-8, "{tensions:?}: {off:e} L");
        for (state, tension) in shape.cables.iter().zip(&best.tensions) {
            assert!((state.tension - tension).abs() < 1e-5, "{tensions:?}: {state:?} for {tension} N");
        }
    }
}

#[test]
fn the_tip_section_is_turned_by_one_cable() {
    let arm = cone();
    let mut pulled = arm.clone();
    pulled.cables[1].tension = 0.4;
    let alpha = pulled.solve().unwrap().tip().alpha;
    let found = arm.reach_tip_angle(1, alpha, &options(0.8)).unwrap();
    assert_eq!(found.solutions[0].tensions[0], 0.0);
    assert!((found.solutions[0].tensions[1] - 0.4).abs() < 1e-6, "{:?}", found.solutions[0].tensions);
    let missed = arm.reach_tip_angle(0, alpha, &options(0.4)).unwrap();
    assert!(missed.solutions.is_empty(), "the other cable turns it the other way");
    assert!(matches!(arm.reach_tip_angle(2, alpha, &options(0.4)), Err(ReachError::Sensitivity(_))));
}

#[test]
fn wrong_requests_are_refused() {
    let arm = cone();
    let target = [Target::tip(0.2, 0.05)];
    assert!(matches!(arm.reach(&[], &options(1.0)), Err(ReachError::Target)));
    // Of the last the square of the distance is no number, and the closest was infinitely far.
    for (x, y) in [(f64::NAN, 0.0), (0.0, f64::INFINITY), (0.0, -2e171)] {
        assert!(matches!(arm.reach(&[Target::tip(x, y)], &options(1.0)), Err(ReachError::Target)), "{x}, {y}");
    }
    assert!(matches!(arm.reach(&target, &options(-1.0)), Err(ReachError::Option { option: "max_tension", .. })));
    let loose = ReachOptions { tol: 1.0, ..options(1.0) };
    assert!(matches!(arm.reach(&target, &loose), Err(ReachError::Option { option: "tol", .. })));
    let off = [Target { s: Some(0.3), ..target[0] }];
    assert!(matches!(arm.reach(&off, &options(1.0)), Err(ReachError::Sensitivity(_))));
    let bare = Arm::cone(0.2, 0.01, 0.002, 1e5, 0.5);
    assert!(matches!(bare.reach(&target, &options(1.0)), Err(ReachError::NoCables)));
}

/// Tensions on a lattice with their tips, as solves of their own give them, of which every cable that pulls is wound in
/// by `most` at most.
fn scan_within_strokes(arm: &Arm, largest: f64, count: u32, most: f64) -> Vec<(Vec<f64>, [f64; 2])> {
    let fraction = |k: u32| largest * f64::from(k) / f64::from(count);
    let pairs = (0..=count).flat_map(|a| (0..=count).map(move |b| [fraction(a), fraction(b)]));
    let solved = pairs.filter_map(|tensions| {
        let mut arm = arm.clone();
        arm.set_tensions(&tensions).unwrap();
        let shape = arm.solve().ok()?;
        let fine = shape.cables.iter().all(|cable| cable.tension == 0.0 || cable.stroke <= most);
        fine.then(|| (tensions.to_vec(), [shape.tip().x, shape.tip().y]))
    });
    solved.collect()
}

/// Targets within and beyond what strokes allow: what is found is within, named where it lies on its bound, and no
/// farther than the nearest of a scan.
#[test]
fn strokes_are_bounded() {
    const MOST: f64 = 0.012;
    let mut flowing = cone();
    (flowing.flow.speed, flowing.flow.direction) = (0.1, 1.0);
    for arm in [cone(), flowing] {
        let scan = scan_within_strokes(&arm, 0.4, 24, MOST);
        println!("{} tensions within", scan.len());
        let mut on_bound = 0;
        for (x, y) in [(0.20, 0.20), (0.10, -0.20), (0.182, 0.078), (0.1, 0.1), (0.05, 0.0), (0.23, 0.05), (0.0, 0.15)]
        {
            let found = arm.reach(&[Target::tip(x, y)], &wound_in_by(MOST, 0.4)).unwrap();
            let nearest = scan.iter().map(|(_, tip)| (tip[0] - x).hypot(tip[1] - y)).fold(f64::INFINITY, f64::min);
            for one in found.solutions.iter().chain(&found.closest) {
                let strokes = strokes_at(&arm, &one.tensions);
                println!(
                    "({x}, {y}): {:?} N, {strokes:?} m, {:e} for {nearest:e} m, {:?}",
                    one.tensions,
                    one.distance * arm.length,
                    one.bounds
                );
                for (c, (stroke, tension)) in strokes.iter().zip(&one.tensions).enumerate() {
                    assert!(*tension == 0.0 || *stroke < MOST + 1e-8, "({x}, {y}): {stroke} m");
                    let on = *tension > 0.0 && *stroke > MOST - 2e-8;
                    assert_eq!(one.bounds.contains(&Bound::Stroke(c)), on, "({x}, {y}): {stroke} m");
                    on_bound += usize::from(on);
                }
            }
            if let Some(closest) = &found.closest {
                assert!(
                    closest.distance * arm.length < nearest + 1e-6,
                    "({x}, {y}): {} for {nearest} m",
                    closest.distance * arm.length
                );
            }
            // What needs no more than is allowed is found, as without a bound.
            let free = arm.reach(&[Target::tip(x, y)], &options(0.4)).unwrap();
            let allowed = |one: &&hydrostat::Reached| {
                strokes_at(&arm, &one.tensions).iter().zip(&one.tensions).all(|(s, t)| *t == 0.0 || *s < MOST)
            };
            let count = free.solutions.iter().filter(allowed).count();
            assert_eq!(found.solutions.len(), count, "({x}, {y})");
        }
        assert!(on_bound >= 3, "{on_bound}");
    }
}

/// What the bound on its stroke forbids a cable takes another one that is nearer to the centreline, at more effort,
/// which a scan cannot better.
#[test]
fn bounded_strokes_take_another_cable() {
    let mut arm = cone();
    let mut inner = Cable::new("inner", Profile::linear(0.0025, 0.0005));
    (inner.end, inner.stiffness) = (0.8, Some(200.0));
    arm.cables.push(inner);
    let within = |tensions: &[f64], most: f64| {
        strokes_at(&arm, tensions).iter().zip(tensions).all(|(stroke, t)| *t == 0.0 || *stroke <= most)
    };
    let mut bounded = 0;
    for tensions in [[0.0, 0.1, 0.35], [0.0, 0.05, 0.2]] {
        let target = target_of(&arm, &tensions).unwrap();
        let free = arm.reach(&[target], &options(2.0)).unwrap().solutions.remove(0);
        let own = strokes_at(&arm, &free.tensions)[0];
        for fraction in [1.02, 0.999, 0.97, 0.9, 0.4] {
            let most = fraction * own;
            let mut least = f64::INFINITY;
            for (given, value) in [0, 2].into_iter().flat_map(|c| (0..=16).map(move |k| (c, 0.025 * f64::from(k)))) {
                let mut start = tensions;
                start[given] = value;
                let found = with_given(&arm, target, start, given).filter(|tensions| within(tensions, most));
                least = found.map_or(least, |tensions| least.min(effort(&tensions)));
            }
            let found = arm.reach(&[target], &wound_in_by(most, 2.0)).unwrap();
            let seen: Vec<_> = found.solutions.iter().map(|one| (&one.tensions, one.effort, &one.bounds)).collect();
            println!("{fraction} of {own} m: {seen:?}, scan {least} (free {:?} {})", free.tensions, free.effort);
            assert!(seen.iter().all(|(tensions, ..)| within(tensions, most + 1e-8)), "{fraction}");
            let best = found.solutions.first().map_or(f64::INFINITY, |one| one.effort);
            assert!(best <= least * (1.0 + 1e-5), "{fraction}: {best} for {least}");
            for one in &found.solutions {
                bounded += usize::from(one.bounds.contains(&Bound::Stroke(0)));
            }
        }
    }
    assert!(bounded >= 5, "{bounded}");
}

/// A cable that hangs slack takes no stroke: another one nearer to the centreline, on the same side, bends the arm
/// further than its bound lets it.
#[test]
fn a_slack_cable_may_be_shorter_than_it_can_be_wound_in() {
    const MOST: f64 = 0.005;
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("outer", Profile::linear(0.009, 0.0018)));
    arm.cables.push(Cable::new("inner", Profile::linear(0.006, 0.0012)));
    let scan = scan_within_strokes(&arm, 0.12, 40, MOST);
    for (x, y) in [(0.15, 0.12), (0.2, 0.1), (0.1, 0.05)] {
        let closest = arm.reach(&[Target::tip(x, y)], &wound_in_by(MOST, 0.6)).unwrap().closest.unwrap();
        let nearest = scan.iter().map(|(_, tip)| (tip[0] - x).hypot(tip[1] - y)).fold(f64::INFINITY, f64::min);
        let strokes = strokes_at(&arm, &closest.tensions);
        println!(
            "({x}, {y}): {:?} N, {strokes:?} m, {} for {nearest} m",
            closest.tensions,
            closest.distance * arm.length
        );
        assert_eq!(closest.bounds, [Bound::Slack(0), Bound::Stroke(1)]);
        assert!(strokes[0] > 1.2 * MOST && strokes[1] < MOST + 1e-8, "{strokes:?}");
        assert!(closest.distance * arm.length < nearest + 1e-6);
    }
}

#[test]
fn strokes_that_are_no_bounds_are_refused() {
    for value in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let refused = cone().reach(&[Target::tip(0.2, 0.05)], &wound_in_by(value, 1.0));
        assert!(matches!(refused, Err(ReachError::Option { option: "max_stroke", .. })));
    }
}

/// What is found by strokes with slack cables is what a solve with these strokes gives, along with the tensions.
#[test]
fn strokes_with_slack_cables_lead_to_the_target() {
    let mut arm = cone();
    let mut short = Cable::new("short", Profile::linear(0.006, 0.003));
    (short.end, short.stiffness) = (0.6, Some(20.0));
    arm.cables.push(short);
    let (mut all, mut met) = (0, 0);
    for (speed, direction) in [(0.0, 0.0), (0.05, 0.0), (0.1, 1.0)] {
        (arm.flow.speed, arm.flow.direction) = (speed, direction);
        for tensions in [
            [0.3, 0.0, 0.2],
            [0.2, 0.0, 0.1],
            [0.1, 0.0, 0.3],
            [0.0, 0.3, 0.0],
            [0.0, 0.15, 0.0],
            [0.2, 0.0, 0.0],
            [0.3, 1e-6, 0.2],
        ] {
            let target = target_of(&arm, &tensions).unwrap();
            let found = arm.reach_by_strokes(&[target], &options(0.6)).unwrap();
            for one in &found.solutions {
                all += 1;
                met += usize::from(one.on_the_path);
                // What a tension of less than a nanonewton is, rounding decides.
                let agrees = |slack: bool, t: f64| if t > 1e-9 { !slack } else { slack || t > 0.0 };
                let commands = one.configuration.cables.iter().map(|cable| cable.command);
                assert!(
                    !one.on_the_path
                        || commands.zip(&one.tensions).all(|(command, t)| agrees(command.unwrap().slack, *t))
                );
            }
        }
    }
    println!("{met} of {all}");
    assert_eq!(met, all);
}

/// At the edge of what is reached tensions within some root of the tolerance do as well: one solution, not one for each
/// start.
#[test]
fn an_edge_was_a_list_of_neighbours() {
    let mut arm = cone();
    let mut short = Cable::new("short", Profile::linear(0.006, 0.003));
    short.end = 0.6;
    arm.cables.push(short);
    for tensions in [[0.0, 0.3, 0.0], [0.3, 0.0, 0.0]] {
        let target = target_of(&arm, &tensions).unwrap();
        let found = arm.reach(&[target], &options(0.5)).unwrap();
        let seen: Vec<_> = found.solutions.iter().map(|one| &one.tensions).collect();
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 2e-3);
        assert!(!seen.is_empty());
        for (k, a) in seen.iter().enumerate() {
            assert!(seen[k + 1..].iter().all(|b| apart(a, b)), "{tensions:?}: {seen:?}");
        }
    }
}
