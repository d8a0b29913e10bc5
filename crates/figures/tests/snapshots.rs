//! Every figure as its SVG, kept in `snapshots/`: an axis that moves, a line that is gone or a word that changes fails here.
//!
//! What is kept is not the file itself but what it shows: each element with its colours and words, and of each line nine places
//! along it. Nodes of a mesh may move along a line and results may change by rounding, the picture may not: numbers are the same
//! within a tenth of a point.

use hydrostat::{
    Arm, BoundaryOptions, Cable, Gravity, Inputs, Loading, Material, Mode, MotionOptions, Options, Parameter,
    PathOptions, Profile, Simulation, Space, SpatialSolver,
};
use hydrostat_figures::source::{Shown, Study};
use hydrostat_figures::{
    Abscissa, Coloured, ColouredColumn, KeyValues, LoadingPoint, Measure, MotionFrame, Page, Panel, Quantity, Scale,
    Scene, arm_figure, boundary_figure, curve_figure, equilibria_figure, fit_figure, last_good_note, lines_figure,
    loading_figure, map_figure, motion_figure, over_figure, path_figure, path_shapes_figure, reach_figure,
    root_locus_figure, spatial_arm_figure, spatial_equilibria_figure, spatial_over_figure, spatial_path_figure,
    spatial_path_shapes_figure, spatial_strobe_figure, spatial_workspace_figure, strobe_figure, workspace_figure,
};
use hydrostat_identify::{Case, FitOptions, Fitted, Measurement, fit};
use insta::comparator::Comparator;
use insta::internals::SnapshotContents;
use insta::{Settings, Snapshot};

/// Numbers further apart are different, points.
const SAME: f64 = 0.1;

/// Words as they are, numbers within [`SAME`].
#[derive(Clone)]
struct Nearly;

impl Comparator for Nearly {
    fn matches(&self, kept: &Snapshot, found: &Snapshot) -> bool {
        let text = |snapshot: &Snapshot| match snapshot.contents() {
            SnapshotContents::Text(text) => text.to_string(),
            SnapshotContents::Binary(_) => String::new(),
        };
        nearly(&text(kept), &text(found))
    }

    fn dyn_clone(&self) -> Box<dyn Comparator> {
        Box::new(self.clone())
    }
}

fn nearly(kept: &str, found: &str) -> bool {
    let words = |text: &str| -> Vec<String> { text.trim().split([' ', '\n', ',']).map(str::to_owned).collect() };
    let (kept, found) = (words(kept), words(found));
    let same = |(a, b): (&String, &String)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= SAME,
        _ => a == b,
    };
    kept.len() == found.len() && kept.iter().zip(&found).all(same)
}

#[test]
fn what_is_the_same_and_what_is_not() {
    let kept = "text \"a 1.0\" 10,20\npath #123456 1.00,2.00 3.00,4.00";
    assert!(nearly(kept, "text \"a 1.0\" 10.05,20\npath #123456 1.01,2.00 3.00,3.95\n"));
    for other in [kept.replace("3.00", "3.20"), kept.replace("#123456", "#123457"), kept.replace("a 1.0", "b 1.0")] {
        assert!(!nearly(kept, &other), "{other}");
    }
    assert!(!nearly(kept, &format!("{kept}\nmore")));
}

fn check(name: &str, figure: &Scene) {
    check_svg(name, &figure.svg_with_text());
}

fn check_svg(name: &str, svg: &str) {
    let mut settings = Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_comparator(Box::new(Nearly));
    settings.bind(|| insta::assert_snapshot!(name, shown(svg)));
}

/// An SVG's elements, one a line.
fn shown(svg: &str) -> String {
    let mut out = String::new();
    for line in svg.lines().filter(|line| line.starts_with('<') && !line.starts_with("</svg")) {
        if let Some((head, path)) = line.split_once(" d=\"") {
            let places = nine_places(path.trim_end_matches("\"/>"));
            let places: Vec<String> = places.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
            out.extend([head.trim_start_matches('<'), " ", &places.join(" "), "\n"]);
        } else if let Some((head, _)) = line.split_once(" href=\"") {
            out.extend([head.trim_start_matches('<'), "\n"]);
        } else {
            out.extend([line, "\n"]);
        }
    }
    out
}

/// Places at even distances along straight lines and chords.
fn nine_places(path: &str) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for piece in path.replace('Z', "").split(['M', 'L', 'Q']) {
        let numbers: Vec<f64> = piece.split_whitespace().filter_map(|number| number.parse().ok()).collect();
        points.extend(numbers.last_chunk().copied());
    }
    if path.ends_with('Z') {
        points.extend(points.first().copied());
    }
    let mut along = vec![0.0];
    for pair in points.windows(2) {
        along.push(along[along.len() - 1] + (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]));
    }
    let whole = along[along.len() - 1];
    let at = |fraction: f64| {
        let place = fraction * whole;
        let k = along.iter().rposition(|at| *at <= place).unwrap_or(0).min(points.len().saturating_sub(2));
        let (a, b) = (points[k], points[(k + 1).min(points.len() - 1)]);
        let part = if along[k + 1] > along[k] { (place - along[k]) / (along[k + 1] - along[k]) } else { 0.0 };
        [0, 1].map(|axis| a[axis] + part * (b[axis] - a[axis]))
    };
    if points.len() < 2 { points } else { (0..=8).map(|k| at(f64::from(k) / 8.0)).collect() }
}

fn page() -> Page {
    Page::default()
}

/// Two cables in a stream, sinking.
fn arm() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    "two cables".clone_into(&mut arm.name);
    arm.density = 1080.0;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.3));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm.flow.speed = 0.1;
    arm.gravity = Some(Gravity::default());
    arm
}

fn key(name: &str, unit: &str, per_si: f64, values: &[f64]) -> KeyValues {
    let axis = Abscissa { name: name.to_owned(), unit: unit.to_owned(), per_si };
    KeyValues { axis, values: values.to_vec() }
}

#[test]
fn one_arm() {
    let shape = arm().solve().unwrap();
    check("arm", &arm_figure(&shape, None, &page()));
    check(
        "arm_in_a_column",
        &arm_figure(&shape, None, &Page { title: Some("A".to_owned()), ..Page::of_width(0.085).unwrap() }),
    );
    check("reached", &reach_figure(&shape, &[[0.2, 0.05]], Some("a note"), &page()));
    let mut folded = arm();
    folded.cables[0].tension = 1.5;
    let Err(hydrostat::SolveError::NoEquilibrium(no)) = folded.solve() else { panic!("1.5 N fold the tip") };
    check("last_good", &arm_figure(no.last_good.as_ref().unwrap(), Some(&last_good_note(&no.verdict)), &page()));
}

#[test]
fn one_arm_in_space() {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    "three cables".clone_into(&mut arm.name);
    for (name, angle, tension) in [("top", 0.0, 0.1), ("left", 120.0_f64, 0.05), ("right", 240.0, 0.0)] {
        let cable = Cable::new(name, Profile::linear(0.005, 0.001)).at_angle(angle.to_radians());
        arm.cables.push(cable.pulled(tension));
    }
    arm.flow.speed = 0.1;
    arm.space = Some(Space { stream: Some([0.0, 0.0, 1.0]), ..Space::default() });
    let shape = SpatialSolver::new(&arm, Options::default()).unwrap().solve().unwrap();
    let svg = spatial_arm_figure(&shape, None, &page()).svg_with_text();
    // The surface alone takes half a megabyte; its edges and rings say where it is.
    let lines = svg.lines().filter(|line| !line.contains("stroke-width=\"0.3\""));
    check_svg("spatial_arm", &lines.collect::<Vec<&str>>().join("\n"));
}

#[test]
fn paths() {
    let mut turned = arm();
    turned.cables.clear();
    turned.flow.speed = 0.2;
    turned.flow.direction = std::f64::consts::PI;
    let quarter = std::f64::consts::FRAC_PI_2;
    let path = turned.path(Parameter::BaseAngle, [quarter, -quarter], &PathOptions::default()).unwrap();
    let over = key("arm.base.angle", "deg", 1.0_f64.to_degrees(), &[]).axis;
    check("path", &path_figure(&path, &over, Quantity::TipY, "turned", &page()));
    check("path_shapes", &path_shapes_figure(&path, &over, "turned", &page()));
}

#[test]
fn all_equilibria() {
    let mut facing = arm();
    facing.cables.clear();
    facing.flow.speed = 0.2;
    facing.flow.direction = std::f64::consts::PI;
    let all = facing.equilibria(1e-8).unwrap();
    check("equilibria", &equilibria_figure(&all, "facing", &page()));
    let over = key("flow.speed", "m/s", 1.0, &[]).axis;
    check("over", &over_figure(&[(0.1, &all), (0.2, &all)], &over, Quantity::TipTheta, "facing", &page()));
}

/// A column that buckles to all sides in a stream from aside.
fn column_in_space() -> Arm {
    let mut column = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    column.density = 1080.0;
    column.tip.force = [-0.05, 0.0];
    (column.flow.speed, column.gravity) = (0.02, Some(Gravity::default()));
    column.space = Some(Space { stream: Some([0.0, 0.0, 1.0]), ..Space::default() });
    column
}

#[test]
fn paths_in_space() {
    let path = column_in_space().path_in_space(Parameter::TipForce(0), [0.0, -0.1], &PathOptions::default()).unwrap();
    let over = key("tip.force[0]", "mN", 1e3, &[]).axis;
    check("spatial_path", &spatial_path_figure(&path, &over, Quantity::TipZ, "pressed", &page()));
    check("spatial_path_shapes", &spatial_path_shapes_figure(&path, &over, "pressed", &page()));
}

#[test]
fn all_equilibria_in_space() {
    let mut column = column_in_space();
    column.tip.force = [-0.1, 0.0];
    let all = column.equilibria_in_space(1e-6).unwrap();
    check("spatial_equilibria", &spatial_equilibria_figure(&all, "pressed", &page()));
    let over = key("tip.force[0]", "N", 1.0, &[]).axis;
    check("spatial_over", &spatial_over_figure(&[(-0.1, &all)], &over, Quantity::TipY, "pressed", &page()));
}

#[test]
fn rates() {
    let mut arm = arm();
    arm.cables[0].tension = 0.0;
    arm.dynamics.relaxation_time = 2.7e-3;
    let of = |speed: f64| {
        let mut arm = arm.clone();
        arm.flow.speed = speed;
        arm.modes(4, 8).unwrap().modes
    };
    let all = [0.0, 0.1, 0.2].map(|speed| (speed, of(speed)));
    let found: Vec<(f64, &[Mode])> = all.iter().map(|(speed, modes)| (*speed, &**modes)).collect();
    let over = key("flow.speed", "m/s", 1.0, &[]).axis;
    check("root_locus", &root_locus_figure(&found, Some(&over), "rates", &page()));
}

/// Numbers that are one but for rounding, and numbers whose labels had a dozen digits.
#[test]
fn axes_of_nearly_one_number() {
    let keys = key("arm.density", "kg/m3", 1.0, &[1000.0, 1080.0, 1200.0]);
    let curve = |name: &str, values: [f64; 3]| check(name, &curve_figure(&keys, "tip_y_m", &values, "flat", &page()));
    curve("curve_of_rounding", [0.1, 0.1 + 1e-16, 0.1 - 1e-16]);
    curve("curve_of_zero", [1e-19, -2e-19, 0.0]);
    curve("curve_with_offset", [0.1, 0.100_000_3, 0.100_000_9]);
    let column = ColouredColumn { name: "tip_y_m".to_owned(), values: Coloured::Numbers(vec![1e-11, 3e-11, 2e-11]) };
    let tips = [[0.2, 1e-11], [0.2, 3e-11], [0.2, 2e-11]];
    check("workspace_of_one_place", &workspace_figure(&tips, &column, "flat", &page()));
}

#[test]
fn tips_in_space() {
    let numbers = Coloured::Numbers(vec![0.0, 0.1, 0.2, f64::NAN, 0.3]);
    let column = ColouredColumn { name: "tip_alpha_rad".to_owned(), values: numbers };
    let tips = [[0.2, 0.0, 0.0], [0.19, 0.03, 0.01], [0.15, 0.08, -0.05], [f64::NAN; 3], [0.1, 0.1, 0.1]];
    check("spatial_workspace", &spatial_workspace_figure(&tips, &column, "a sweep", &page()));
}

#[test]
fn what_a_tip_reaches() {
    let mut arm = arm();
    arm.cables[0].tension = 0.0;
    let options = BoundaryOptions { max_tension: Some(0.6), spacing: 0.02, ..BoundaryOptions::default() };
    let found = arm.reachable(&options).unwrap();
    check("boundary", &boundary_figure(&found, &arm.solve().unwrap(), &page()));
}

#[test]
fn sweeps() {
    let numbers = Coloured::Numbers(vec![0.0, 0.1, 0.2, f64::NAN, 0.3, 0.1]);
    let column = ColouredColumn { name: "tip_alpha_rad".to_owned(), values: numbers };
    let speeds = key("flow.speed", "m/s", 1.0, &[0.0, 0.0, 0.5, 0.5, 1.0, 1.0]);
    let pulls = key("cable[0].tension", "mN", 1e3, &[0.0, 0.2, 0.0, 0.2, 0.0, 0.2]);
    check("map", &map_figure(&[speeds, pulls], &column, "a sweep", &page()));
    let words = [None, Some("cable_fold"), Some("limit_point")].map(|word| word.map(str::to_owned)).to_vec();
    let verdicts = ColouredColumn { name: "verdict".to_owned(), values: Coloured::Words(words) };
    let places = [key("a", "", 1.0, &[0.0, 1.0, 2.0]), key("b", "mm", 1e3, &[0.0, 0.1, 0.05])];
    check("map_of_words", &map_figure(&places, &verdicts, "a sample", &page()));
    let tips = [[0.2, 0.0], [0.19, 0.03], [0.15, 0.08], [f64::NAN; 2], [0.1, 0.1], [0.08, -0.02]];
    check("workspace", &workspace_figure(&tips, &column, "a sweep", &page()));
    let key = key("flow.speed", "m/s", 1.0, &[0.0, 0.5, 1.0, 1.5]);
    check("curve", &curve_figure(&key, "tip_x_m", &[0.2, 0.19, f64::NAN, 0.17], "a sweep", &page()));
}

#[test]
fn a_fit() {
    let mut arm = arm();
    arm.flow.speed = 0.0;
    let case = |name: &str, tension: f64, off: f64| {
        let mut pulled = arm.clone();
        pulled.cables[0].tension = tension;
        let tip = pulled.solve().unwrap().tip();
        let [x, y] = [hydrostat_identify::Quantity::X(0.245), hydrostat_identify::Quantity::Y(0.245)];
        let measurements = vec![Measurement::new(x, tip.x + off, 1e-3), Measurement::new(y, tip.y - off, 1e-3)];
        Case { name: name.to_owned(), arm: pulled, measurements }
    };
    let cases = [case("at rest", 0.0, 1e-3), case("pulled", 0.3, -5e-4)];
    let wanted = [Fitted::new(Parameter::Young, &arm).unwrap(), Fitted::new(Parameter::Density, &arm).unwrap()];
    let found = fit(&cases, &wanted, &FitOptions::default(), |_| true).unwrap();
    check("fit", &fit_figure("a cone", &cases, &found, &page()));
}

#[test]
fn lines() {
    let measure = |title: &str, scale| Measure { title: title.to_owned(), scale };
    let up = measure("time (µs)", Scale::Logarithmic);
    let lines = vec![vec![[1e-8, 120.0], [1e-6, 80.0], [1e-4, 60.0]], vec![[1e-8, 55.0], [1e-4, 30.0]]];
    let other = vec![vec![[1e-8, 3.0], [1e-4, 2.0]], vec![[1e-8, 1.0], [1e-4, 1.5]]];
    let panels = [Panel { up, lines }, Panel { up: measure("rounds", Scale::Even), lines: other }];
    check("lines", &lines_figure("a solve", &measure("tol", Scale::Logarithmic), &["cold", "warm"], &panels, &page()));
}

#[test]
fn the_source() {
    let mut arm = Arm::cone(0.2, 0.010, 0.0008, 500e3, 0.5);
    arm.material = Material::Coefficients { c1: 500e3.into(), c2: (500e3 / 3.0).into(), c3: 150.0.into() };
    arm.cables.push(Cable::new("left", Profile::linear(0.008, 0.0001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.008, -0.0001)));
    let study = Study::of(&arm, &Shown::default()).unwrap();
    for figure in study.figures(&page()) {
        check(figure.name, &figure.scene);
    }
    let [.., angles] = study.figures(&Page::of_width(0.085).unwrap());
    check("fig1c_in_a_column", &angles.scene);
}

/// A base that is turned against the stream, and back.
#[test]
fn loading() {
    let mut arm = arm();
    (arm.gravity, arm.density) = (None, 1000.0);
    arm.cables[0].tension = 0.0;
    (arm.flow.speed, arm.flow.direction) = (0.2, std::f64::consts::PI);
    arm.dynamics.relaxation_time = 2.7e-3;
    let angles = [60.0_f64, 40.0, 20.0, 0.0, -20.0, -40.0, -60.0, -40.0, -20.0, 0.0, 20.0, 40.0, 60.0];
    arm.base.angle = angles[0].to_radians();
    let (mut loading, first) = Loading::start(&arm, 1e-6).unwrap();
    let mut steps = Vec::new();
    for pair in angles.windows(2) {
        arm.base.angle = pair[1].to_radians();
        let step = loading.go_to(&arm).unwrap();
        let snaps = step.snaps.iter().map(|snap| (pair[0] + snap.fraction * (pair[1] - pair[0]), *snap)).collect();
        steps.push((pair[1], step.configuration, snaps));
    }
    let mut points = vec![LoadingPoint { value: angles[0], configuration: &first.configuration, snaps: Vec::new() }];
    for (value, configuration, snaps) in &steps {
        let snaps: Vec<_> = Vec::clone(snaps);
        points.push(LoadingPoint { value: *value, configuration, snaps });
    }
    let over = Abscissa { name: "arm.base.angle".to_owned(), unit: "deg".to_owned(), per_si: 1.0 };
    check("loading", &loading_figure(&points, &over, Quantity::TipY, "to and fro", &page()));
}

/// An arm that sinks when it is let go.
#[test]
fn motion() {
    let mut arm = arm();
    arm.cables[0].tension = 0.0;
    arm.flow.speed = 0.0;
    arm.dynamics.relaxation_time = 2.7e-3;
    let mut inputs = Inputs::default();
    inputs.set("gravity.acceleration", hydrostat::Course::step(0.0, 9.81, 0.0)).unwrap();
    let options = MotionOptions { tol: 1e-3, ..MotionOptions::default() };
    let mut simulation = Simulation::new(&arm, inputs, options).unwrap();
    let mut frames = Vec::new();
    let every = |at: &hydrostat::Instant, simulation: &Simulation| {
        frames.push(MotionFrame {
            time: at.time,
            centreline: simulation.shape().iter().map(|[_, x, y, _]| [*x, *y]).collect(),
            kinetic_energy: at.kinetic_energy,
            strain_energy: at.strain_energy,
        });
        true
    };
    simulation.run(1.0, 0.02, every).unwrap();
    check("strobe", &strobe_figure(&frames, 11, "let go", &page()));
    check("motion", &motion_figure(&frames, "let go", &page()));
}

/// A rod that turns about an axis aslant, as it is bent aside.
#[test]
fn motion_in_space() {
    let frame = |k: u32| {
        let time = 0.1 * f64::from(k);
        let place = |s: f64| {
            let (sin, cos) = (time * s / 0.2).sin_cos();
            [s * cos, s * sin * (0.5 * time).cos(), s * sin * (0.5 * time).sin()]
        };
        let centreline = (0..=8).map(|i| place(0.025 * f64::from(i))).collect();
        MotionFrame { time, centreline, kinetic_energy: 1e-3 * time, strain_energy: 2e-3 * time * time }
    };
    let frames: Vec<MotionFrame<3>> = (0..16).map(frame).collect();
    check("spatial_strobe", &spatial_strobe_figure(&frames, 6, "turned aside", &page()));
    check("spatial_motion", &motion_figure(&frames, "turned aside", &page()));
}
