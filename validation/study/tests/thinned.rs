//! The study on few sets: its answers are those of its parts.

use hydrostat::{ModelOptions, Options, Solver};
use hydrostat_files::{ArmFile, shipped};
use hydrostat_study::statements::compare;
use hydrostat_study::{Drawn, Set, Statement, judge, refine, report, sample};

/// The shipped arm `paper` as a set: what is known of it is found again.
#[test]
fn the_shipped_arm_is_judged_as_its_claims_are() {
    let mut paper = Set::at([0.0; 13]);
    (paper.slenderness, paper.taper) = (0.05, 0.08);
    (paper.base_offset, paper.tip_offset) = (0.8, 0.125);
    (paper.c1, paper.shear, paper.bending, paper.bending_taper) = (500e3, 1.0 / 3.0, 12.0, 0.0);
    let judged = judge(&paper.arm(0.0, 0.0), 1e-9).unwrap();
    println!("{judged:?}");
    assert!((judged.tension - 86.24).abs() < 0.01, "{}", judged.tension);
    let failing = judged.failing(true);
    assert!(failing.contains(&Statement::LocallySmaller), "{failing:?}");
    for held in [Statement::StraightTip, Statement::TipAngle, Statement::TipRises, Statement::DeformsLess] {
        assert!(!failing.contains(&held), "{held:?}");
    }
    // Word by word, the base bends nothing without a stream: the angle is not reached, or more stream deforms more.
    let literal = judge(&paper.with_unstrained_base().arm(0.0, 0.0), 1e-8);
    println!("{literal:?}");
    assert!(literal.is_err() || !literal.unwrap().failing(true).is_empty());
}

#[test]
fn a_sample_is_drawn_judged_and_written() {
    let drawn = sample(48, 1, Drawn::Smooth, || ());
    assert_eq!(drawn, sample(48, 1, Drawn::Smooth, || ()), "the same seed draws and judges the same");
    let judged: Vec<_> = drawn.iter().filter_map(|one| one.outcome.ok()).collect();
    assert!(judged.len() > 2 && judged.len() < 48, "{}", judged.len());
    for one in &judged {
        // What holds at every tension holds at the highest.
        for (highest, every) in one.margins(false).iter().zip(one.margins(true)) {
            assert!(every <= highest, "{one:?}");
        }
        assert!(one.failing(false).len() <= one.failing(true).len());
    }
    let before = drawn.iter().map(|one| one.shortfall(false)).fold(f64::INFINITY, f64::min);
    let best = refine(&drawn, 2, 1, false, 2);
    assert!(best[0].shortfall(false) <= before, "{} {before}", best[0].shortfall(false));
    let csv = report::best_csv(&best, &[]);
    let columns: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert_eq!(columns, [columns[0]; 3]);
    assert!(report::summary(&drawn, &[best, Vec::new()]).contains("48 sets drawn"));
}

/// What the arm that ships for it says of itself, at every one of the stations, in streams of 0.5 and 1 m/s; and with still water beside them.
#[test]
fn the_shipped_arm_satisfies_all_statements_at_the_highest_tension() {
    let text = shipped::get("paper-statements").unwrap();
    let arm = ArmFile::parse(text, "paper-statements").unwrap().arm().unwrap();
    assert_eq!(arm.model, ModelOptions::default());
    let judged = judge(&arm, 1e-9).unwrap();
    println!("{judged:?}");
    assert!(judged.failing(false).is_empty(), "{:?}", judged.failing(false));
    assert_eq!((judged.growing, judged.smaller), (1.0, 1.0));
    assert!((judged.tension - arm.cables[0].tension).abs() < 0.01, "{}", judged.tension);
    // By how much, as README.md has it: deformation over L or in rad, alpha(L) in deg, its growth a length, alpha(s) in deg.
    let margins = &judged.margins(false)[Statement::DeformsLess as usize..];
    for (margin, known) in margins.iter().zip([0.0114, 0.0200, 0.0268, 0.0200]) {
        assert!((margin - known).abs() < 1e-4, "{margins:?}");
    }
    assert!((judged.least_stretch - 0.190).abs() < 1e-3 && (judged.fold_margin - 0.107).abs() < 1e-3, "{judged:?}");
    let shape = |speed: f64| {
        let mut arm = arm.clone();
        (arm.flow.speed, arm.cables[0].tension) = (speed, judged.tension);
        Solver::new(&arm, Options::with_tol(1e-9)).unwrap().solve().unwrap()
    };
    for (statement, margin) in compare(&shape(0.0), &shape(0.5)) {
        assert!(margin > 0.0, "{statement:?}: {margin}");
    }
    // Pulled less, its base is sheared by the stream as that of other arms.
    assert!(!judged.failing(true).is_empty());
}

/// What `README.md` says of the best set that was found.
#[test]
#[expect(clippy::unreadable_literal, reason = "coordinates as the search found them")]
fn the_best_set_satisfies_all_statements_at_the_highest_tension() {
    let best = Set::at([
        0.8366335437822292,
        0.5828139659889706,
        0.8839424016398517,
        0.3342560816012373,
        0.2822988894703691,
        0.3447374530703535,
        0.868248457627083,
        0.2000758311570571,
        0.015290994779206812,
        0.12810880882898346,
        0.3007860942161642,
        0.17672896676231176,
        0.7003339064540341,
    ]);
    let judged = judge(&best.arm(0.0, 0.0), 1e-9).unwrap();
    println!("{judged:?}");
    assert!(judged.failing(false).is_empty(), "{:?}", judged.failing(false));
    assert!((judged.tension - 53.246).abs() < 0.01 && judged.fold_margin > 0.45);
    assert_eq!((judged.growing, judged.smaller), (1.0, 1.0));
    // Pulled less, its base is sheared by the stream as that of other arms.
    assert!(judged.failing(true).contains(&Statement::LocallySmaller));
}
