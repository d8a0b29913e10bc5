//! `silicone` leaning in a stream that runs against its weight: near-neutral, so that little tension turns its path back and forth.

use hydrostat::{Arm, Event, Options, Parameter, PathEnd, PathOptions, Solver};
use hydrostat_files::ArmFile;

fn leaning(tension: f64) -> Arm {
    let mut file = ArmFile::parse(include_str!("cases/lean-0.7.toml"), "lean-0.7.toml").unwrap();
    file.set("cable[0].tension", &format!("{tension:e}")).unwrap();
    file.arm().unwrap()
}

/// Tip x, y of each of 40 tensions up to 3e-4 N, each solved by itself: there is a snap of 0.5 mm and 0.17 deg on the way, and no more.
#[test]
fn forty_tensions_in_order_give_forty_tips_in_order() {
    let tips: Vec<_> = (1..=40)
        .map(|k| {
            let tension = 3e-4 * f64::from(k) / 40.0;
            let solved = leaning(tension).solve().unwrap_or_else(|error| panic!("{tension} N: {error}"));
            (tension, solved.tip())
        })
        .collect();
    for pair in tips.windows(2) {
        let ((tension, one), (_, two)) = (pair[0], pair[1]);
        assert!(two.theta > one.theta, "past {tension} N the tip turns back: {one:?} {two:?}");
        assert!((two.x - one.x).hypot(two.y - one.y) < 0.0015, "past {tension} N the tip jumps: {one:?} {two:?}");
    }
}

/// What is answered does not depend on the way: raised in steps, the tensions give the same tips.
#[test]
fn tensions_raised_in_steps_give_the_tips_of_tensions_solved_by_themselves() {
    let mut solver = Solver::new(&leaning(0.0), Options::default()).unwrap();
    solver.solve().unwrap();
    for k in 1..=40 {
        let tension = 3e-4 * f64::from(k) / 40.0;
        solver.set_tensions(&[tension, 0.0]).unwrap();
        let warm = solver.update().unwrap_or_else(|error| panic!("{tension} N: {error}")).tip;
        let cold = leaning(tension).solve().unwrap_or_else(|error| panic!("{tension} N: {error}")).tip();
        assert!((warm.x - cold.x).hypot(warm.y - cold.y) < 1e-7, "{tension} N: {warm:?} {cold:?}");
    }
}

#[test]
fn three_equilibria_are_found_between_the_limit_points() {
    let all = leaning(2.3e-5).equilibria(1e-8).unwrap();
    let mut tips: Vec<f64> = all.found.iter().map(|own| own.configuration.tip().theta.to_degrees()).collect();
    tips.sort_by(f64::total_cmp);
    assert!(all.complete, "{tips:?}");
    assert_eq!(tips.len(), 3, "{tips:?}");
    for (tip, known) in tips.iter().zip([89.841, 90.045, 90.176]) {
        assert!((tip - known).abs() < 6e-4, "{tips:?}");
    }
}

#[test]
fn the_path_meets_both_limit_points() {
    for longest in [PathOptions::default().longest, 0.02] {
        let options = PathOptions { longest, ..PathOptions::default() };
        let path = leaning(0.0).path(Parameter::Tension(0), [0.0, 3e-4], &options).unwrap();
        let branch = &path.branches[0];
        assert_eq!(branch.end, PathEnd::ReachedEnd);
        let limits: Vec<f64> = branch
            .points
            .iter()
            .filter(|point| point.event == Some(Event::LimitPoint))
            .map(|point| point.value)
            .collect();
        assert_eq!(limits.len(), 2, "{limits:?}");
        assert!((limits[0] / 2.4790e-5 - 1.0).abs() < 1e-4 && (limits[1] / 2.2256e-5 - 1.0).abs() < 1e-4, "{limits:?}");
    }
}
