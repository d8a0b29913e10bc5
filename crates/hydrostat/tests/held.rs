//! Stability and paths of arms whose cables are held at commanded lengths.

use std::f64::consts::PI;

use hydrostat::cases::column;
use hydrostat::{
    Arm, Cable, Configuration, Event, Parameter, PathEnd, PathError, PathOptions, PathPoint, Profile, Stability,
};

/// EA of columns and cables that hardly give way; EI and L are one.
const RIGID: f64 = 1e6;
/// Offset of the cables of a column.
const OFFSET: f64 = 0.04;

/// A column under a thrust, with a cable on either side reeled in by `stroke`.
fn held_column(thrust: f64, stroke: f64, stiffness: Option<f64>) -> Arm {
    // As stiff in shear as in stretch: then the two cancel in the buckling load.
    let mut arm = column(RIGID, RIGID, thrust, 0.0);
    for (name, side) in [("left", 1.0), ("right", -1.0)] {
        let mut cable = Cable::new(name, side * OFFSET).reeled_in(stroke);
        cable.stiffness = stiffness;
        arm.cables.push(cable);
    }
    arm
}

fn solve(arm: &Arm) -> Configuration {
    arm.solve().unwrap_or_else(|e| panic!("{}: {e}", arm.name))
}

/// Two cables of fixed lengths keep the tip from turning: a column that may only sway buckles at pi^2 EI/L^2, four
/// times the load of one whose cables keep their tensions.
#[test]
fn cables_of_fixed_lengths_hold_a_column_up_to_four_times_its_buckling_load() {
    // Enough stroke that the cables stay taut while the thrust shortens the column.
    let stroke = 16.0 / RIGID;
    for (fraction, held, pulled) in [
        (0.2, Stability::Stable, Stability::Stable),
        (0.26, Stability::Stable, Stability::Unstable(1)),
        (0.99, Stability::Stable, Stability::Unstable(1)),
        (1.01, Stability::Unstable(1), Stability::Unstable(1)),
    ] {
        let thrust = fraction * PI * PI;
        let shape = solve(&held_column(thrust, stroke, None));
        assert!(shape.tip().y.abs() < 1e-9);
        let want = 0.5 * (RIGID * stroke - thrust);
        for cable in &shape.cables {
            assert!((cable.tension - want).abs() < 1e-3, "{fraction}: {} N for {want}", cable.tension);
        }
        assert_eq!(shape.stability(), Some(held), "{fraction} of the load");
        let mut given = shape.arm.clone();
        given.set_tensions(&[shape.cables[0].tension, shape.cables[1].tension]).unwrap();
        assert_eq!(solve(&given).stability(), Some(pulled), "{fraction} of the load, at these tensions");
    }
}

fn bifurcations(points: &[PathPoint]) -> Vec<f64> {
    points.iter().filter(|p| p.event == Some(Event::Bifurcation)).map(|p| p.value).collect()
}

/// Elastic cables are a spring k = 2 y^2 EA/L against the tip's turning: P L^2/EI = w^2 with w cot(w) = -k L/EI.
#[test]
fn elastic_cables_hold_a_column_as_the_spring_that_they_are() {
    for stiffness in [50.0, 500.0, 5000.0] {
        let stroke = 16.0 / RIGID + 1e-4;
        let spring = 2.0 * OFFSET * OFFSET * stiffness;
        let (mut low, mut high) = (0.5 * PI + 1e-9, PI - 1e-9);
        for _ in 0..100 {
            let w = 0.5 * (low + high);
            if w / w.tan() > -spring { low = w } else { high = w }
        }
        let critical = low * low;
        let arm = held_column(0.0, stroke, Some(stiffness));
        let path = arm.path(Parameter::TipForce(0), [0.0, -1.2 * critical], &PathOptions::default()).unwrap();
        assert_eq!(path.branches[0].end, PathEnd::ReachedEnd);
        let found = bifurcations(&path.branches[0].points);
        assert_eq!(found.len(), 1, "{found:?}");
        // The cables are shorter than the column by what they are stretched, and it is a little shorter than L.
        assert!((found[0] / critical + 1.0).abs() < 2e-4, "EA {stiffness}: {} for {critical}", found[0]);
        for point in path.branches[0].points.iter().filter(|p| p.event.is_none()) {
            let unstable = point.value < found[0];
            assert_eq!(point.stability, Some(if unstable { Stability::Unstable(1) } else { Stability::Stable }));
        }
    }
}

#[test]
fn a_held_column_bifurcates_where_it_buckles_and_its_branches_bend() {
    let arm = held_column(0.0, 30.0 / RIGID, None);
    let options = PathOptions { branches: true, ..PathOptions::default() };
    let path = arm.path(Parameter::TipForce(0), [0.0, -1.3 * PI * PI], &options).unwrap();
    let found = bifurcations(&path.branches[0].points);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!((found[0] / (PI * PI) + 1.0).abs() < 5e-5, "{}", found[0]);
    let bent = &path.branches[1];
    let end = bent.points.iter().map(|p| p.configuration.tip().y.abs()).fold(0.0, f64::max);
    assert!(end > 0.05, "{end}");
    for point in &bent.points {
        let turned = point.configuration.tip().theta;
        // To the rigidity of the column: the tip sways and does not turn while both cables are taut.
        if point.configuration.cables.iter().all(|c| c.tension > 0.0) {
            assert!(turned.abs() < 1e-3, "{turned}");
        }
    }
}

fn silicone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm.flow.speed = 0.1;
    arm
}

#[test]
fn a_path_over_a_stroke_meets_every_stroke_and_ends_where_a_solve_does() {
    let arm = silicone();
    let path = arm.path(Parameter::Stroke(0), [0.0, 0.012], &PathOptions::default()).unwrap();
    let branch = &path.branches[0];
    assert_eq!(branch.end, PathEnd::ReachedEnd);
    for point in &branch.points {
        let cable = &point.configuration.cables[0];
        assert!((cable.stroke - point.value).abs() < 1e-9 * arm.length, "{} for {}", cable.stroke, point.value);
        assert_eq!(point.stability, Some(Stability::Stable));
    }
    let tensions: Vec<f64> = branch.points.iter().map(|p| p.configuration.cables[0].tension).collect();
    // At a stroke of zero it holds the arm against the stream that draws it out.
    assert!(tensions[0] > 0.0 && tensions.is_sorted(), "{tensions:?}");
    let mut there = arm.clone();
    there.cables[0].stroke = Some(0.012);
    let (solved, last) = (solve(&there), &branch.points.last().unwrap().configuration);
    assert!((solved.tip().y - last.tip().y).abs() < 1e-6 * arm.length);
    assert!((solved.cables[0].tension / last.cables[0].tension - 1.0).abs() < 1e-5);
    // The path over the tension leads through the same shapes.
    let pulled = arm.path(Parameter::Tension(0), [0.0, solved.cables[0].tension], &PathOptions::default()).unwrap();
    let end = &pulled.branches[0].points.last().unwrap().configuration;
    assert!((end.cables[0].stroke - 0.012).abs() < 1e-6 * arm.length, "{}", end.cables[0].stroke);
}

/// The left cable is reeled in: at first the bend draws the right one to the 0.22 mm that it is paid out by, then the
/// arm gets so short that it hangs slack again; and the other way round on the way back.
#[test]
fn a_cable_that_is_taken_up_or_let_go_on_the_way_is_an_event() {
    const PAID_OUT: f64 = 0.00022;
    let mut arm = silicone();
    arm.cables[1].stroke = Some(-PAID_OUT);
    let follow = |range| arm.path(Parameter::Stroke(0), range, &PathOptions::default()).unwrap().branches.remove(0);
    let (there, back) = (follow([0.0, 0.006]), follow([0.006, 0.0]));
    let at = |points: &[PathPoint], wanted: Event| {
        let found: Vec<f64> = points.iter().filter(|p| p.event == Some(wanted)).map(|p| p.value).collect();
        assert_eq!(found.len(), 1, "{wanted:?}: {found:?}");
        found[0]
    };
    let [first, last] = [at(&there.points, Event::Taut(1)), at(&there.points, Event::Slack(1))];
    let [back_first, back_last] = [at(&back.points, Event::Slack(1)), at(&back.points, Event::Taut(1))];
    assert!(first < last && (first - back_first).abs() < 1e-6 * arm.length, "{first} and {back_first}");
    assert!((last - back_last).abs() < 1e-6 * arm.length, "{last} and {back_last}");
    // Where the right cable's stroke is that although it hangs free.
    for left in [first, last] {
        let mut free = silicone();
        free.cables[0].stroke = Some(left);
        let stroke = solve(&free).cables[1].stroke;
        assert!((stroke + PAID_OUT).abs() < 1e-6 * arm.length, "{stroke} at {left}");
    }
    for point in there.points.iter().chain(&back.points) {
        let right = &point.configuration.cables[1];
        assert!(right.stroke > -PAID_OUT - 1e-9 * arm.length && right.tension >= 0.0, "{right:?}");
        if point.event.is_none() {
            let between = point.value > first && point.value < last;
            assert_eq!((right.command.unwrap().slack, right.tension > 0.0), (!between, between), "{}", point.value);
        }
        assert_eq!(point.stability, Some(Stability::Stable));
    }
}

#[test]
fn a_path_over_a_load_keeps_the_strokes_that_are_commanded() {
    let mut arm = silicone();
    arm.cables[0].stroke = Some(0.008);
    arm.cables[1].stroke = Some(-0.006);
    for (parameter, range) in [
        (Parameter::FlowSpeed, [0.0, 0.5]),
        (Parameter::BaseAngle, [0.0, 1.5]),
        (Parameter::TipForce(1), [0.0, -0.02]),
        (Parameter::Young, [1.1e5, 0.8e5]),
    ] {
        let path = arm.path(parameter, range, &PathOptions::default()).unwrap();
        let branch = &path.branches[0];
        assert_eq!(branch.end, PathEnd::ReachedEnd, "{parameter}");
        for point in &branch.points {
            for (cable, command) in point.configuration.cables.iter().zip([0.008, -0.006]) {
                let over = cable.stroke - command;
                assert!(over > -1e-9 * arm.length, "{parameter}: {cable:?}");
                assert!(cable.tension == 0.0 || over.abs() < 1e-9 * arm.length, "{parameter}: {cable:?}");
            }
        }
        let mut there = arm.clone();
        parameter.set(&mut there, range[1]).unwrap();
        let (solved, last) = (solve(&there), &branch.points.last().unwrap().configuration);
        let off = (solved.tip().x - last.tip().x).hypot(solved.tip().y - last.tip().y);
        assert!(off < 1e-5 * arm.length, "{parameter}: {off:e}");
    }
}

#[test]
fn what_cannot_be_followed_is_refused() {
    let mut arm = silicone();
    arm.cables[0].stroke = Some(0.008);
    assert!(matches!(arm.equilibria(1e-6), Err(PathError::Stroke { .. })));
    arm.cables[1].friction = 0.1;
    let refused = arm.path(Parameter::Stroke(0), [0.0, 0.01], &PathOptions::default());
    assert!(matches!(refused, Err(PathError::Friction { .. })));
}

#[test]
fn a_stroke_that_takes_more_than_the_most_tension_is_a_warning() {
    let mut arm = silicone();
    arm.cables[0].stroke = Some(0.010);
    let tension = solve(&arm).cables[0].tension;
    arm.cables[0].max_tension = Some(1.01 * tension);
    assert!(solve(&arm).warnings().iter().all(|w| w.kind() != "tension_above_max"));
    arm.cables[0].max_tension = Some(0.99 * tension);
    let warnings = solve(&arm).warnings();
    let warning = warnings.iter().find(|w| w.kind() == "tension_above_max").expect("a warning");
    assert!(warning.message().contains("`left`") && warning.message().contains("max_tension"), "{}", warning.message());
}
