//! Arms without an answer: every kind of verdict that an arm can reach is the same whatever the
//! tolerance, at the same part of the loads, and the last good shape carries that part.

use std::f64::consts::PI;

use hydrostat::VerdictKind::{self, CableFold, LimitPoint, LoadJump, NoSectionSolution, SectionCrushed};
use hydrostat::cases::{column_buckling_load, inextensible_arm};
use hydrostat::{
    Arm, Cable, Configuration, ModelOptions, NoEquilibrium, Options, Parameter, PathOptions, Phase, Profile,
    SolveError, Solver, SpatialSolver, Volume,
};
use hydrostat_files::{ArmFile, shipped};

/// An arm and the verdict that it must get.
struct Case {
    name: String,
    arm: Arm,
    kind: VerdictKind,
    phase: Phase,
}

impl Case {
    fn new(name: impl Into<String>, arm: Arm, kind: VerdictKind, phase: Phase) -> Self {
        Self { name: name.into(), arm, kind, phase }
    }

    fn verdict(&self, tol: f64) -> NoEquilibrium {
        let name = &self.name;
        let no = match Solver::new(&self.arm, Options::with_tol(tol)).unwrap().solve() {
            Err(SolveError::NoEquilibrium(no)) => *no,
            Err(error) => panic!("{name}, tol {tol:e}: {error}"),
            Ok(solved) => panic!("{name}, tol {tol:e}: solved, tip {:?}", solved.tip()),
        };
        assert_eq!(
            (no.verdict.kind, no.verdict.phase),
            (self.kind, self.phase),
            "{name}, tol {tol:e}: {:?}",
            no.verdict
        );
        no
    }

    /// The part of the phase's loads that a shape on the way carries, by those that this arm has.
    fn carried(&self, shape: &Configuration) -> f64 {
        let (whole, part) = (&self.arm, &shape.arm);
        match self.phase {
            Phase::Tension => part.cables[0].tension / whole.cables[0].tension,
            Phase::Loads if whole.flow.speed > 0.0 => (part.flow.speed / whole.flow.speed).powi(2),
            Phase::Loads => part.tip.force[0] / whole.tip.force[0],
            Phase::Stroke | Phase::Friction => panic!("no stroke is commanded here, and no cable has friction"),
        }
    }

    /// Verdict, fraction and the existence of a last good shape do not hang on the tolerance.
    /// Returns the fraction and the part of the loads that the last good shape carries.
    fn check(&self) -> [f64; 2] {
        let name = &self.name;
        let [loose, tight] = [1e-6, 1e-10].map(|tol| self.verdict(tol));
        let [from, to] = [&loose, &tight].map(|no| no.verdict.load_fraction);
        assert!(from > 0.0 && from <= 1.0 && (to / from - 1.0).abs() < 0.01, "{name}: from {from} to {to}");
        let [_, carried] = [&loose, &tight].map(|no| {
            let last = no.last_good.as_ref().unwrap_or_else(|| panic!("{name}: no last good shape"));
            assert!(last.error_estimate < 1e-3 * self.arm.length, "{name}: {:e} m", last.error_estimate);
            assert!([last.tip().x, last.tip().y, last.tip().alpha].iter().all(|v| v.is_finite()), "{name}");
            let carried = self.carried(last);
            assert!(carried > 0.0 && carried < 1.0 + 1e-9, "{name}: {carried}");
            carried
        });
        [to, carried]
    }

    /// And the last good shape carries the loads at that fraction.
    fn check_with_last_good(&self) -> f64 {
        let [fraction, carried] = self.check();
        let off = carried / fraction - 1.0;
        assert!(off.abs() < 0.01, "{}: the verdict at {fraction}, the last good shape at {carried}", self.name);
        fraction
    }

    /// Where the limit is known.
    fn check_exactly(&self, known: f64) {
        let fraction = self.check_with_last_good();
        assert!((fraction / known - 1.0).abs() < 1e-3, "{}: {fraction}, want {known}", self.name);
    }
}

/// A cylinder with C1 A0 = [`EA`].
fn cylinder(volume: Volume) -> Arm {
    let mut arm = Arm::cone(0.2, 0.01, 0.01, 100e3, 0.5);
    arm.model.volume = volume;
    arm
}

/// N.
const EA: f64 = 100e3 * PI * 0.01 * 0.01;

/// The shipped arm `silicone`, its left cable pulled.
fn silicone(tension: f64) -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1080.0;
    arm.flow.density = 1022.0;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(tension));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

fn in_a_stream(mut arm: Arm, speed: f64, degrees: f64) -> Arm {
    arm.flow.speed = speed;
    arm.flow.direction = degrees.to_radians();
    arm
}

#[test]
fn a_cable_folds_its_side_shut() {
    for volume in [Volume::Planar, Volume::Circular, Volume::None] {
        let mut arm = silicone(1.5);
        arm.model.volume = volume;
        Case::new(format!("{volume:?}"), arm, CableFold, Phase::Tension).check_with_last_good();
    }
}

/// The fold is at the tip, which the stream does not reach: its verdict is that of still water.
#[test]
fn a_cable_folds_its_side_shut_in_a_stream() {
    let arm = in_a_stream(silicone(1.5), 0.3, 60.0);
    let still = Case::new("still water", silicone(1.5), CableFold, Phase::Tension).check()[0];
    let stream = Case::new("stream", arm, CableFold, Phase::Tension).check_with_last_good();
    assert!((stream / still - 1.0).abs() < 1e-3, "{stream}, {still}");
}

/// Without swelling nu = 1 - N/(C1 A0), which is zero at N = C1 A0.
#[test]
fn net_compression_crushes_a_section() {
    let mut pulled = cylinder(Volume::None);
    pulled.cables = vec![Cable::new("left", 0.005).pulled(20.0), Cable::new("right", -0.005).pulled(20.0)];
    Case::new("two cables", pulled, SectionCrushed, Phase::Tension).check_exactly(EA / 40.0);
    let mut pushed = cylinder(Volume::None);
    pushed.tip.force = [-40.0, 0.0];
    Case::new("thrust", pushed, SectionCrushed, Phase::Loads).check_exactly(EA / 40.0);
}

/// C1 A0 (nu - 1)/nu^2 has its peak C1 A0/4 at nu = 2; C1 A0 (nu - 1)/nu stays below C1 A0.
#[test]
fn a_section_in_tension_gives_way() {
    for (volume, most) in [(Volume::Planar, 0.25 * EA), (Volume::Circular, EA)] {
        let mut arm = cylinder(volume);
        arm.tip.force = [40.0, 0.0];
        Case::new(format!("{volume:?}"), arm, NoSectionSolution, Phase::Loads).check_exactly(most / 40.0);
    }
    let arm = in_a_stream(silicone(0.0), 3.0, 0.0);
    Case::new("stream", arm, NoSectionSolution, Phase::Loads).check_with_last_good();
}

/// Arms that snap: a stream almost against them, and a column that a thrust above its buckling load
/// has bent to the left, pulled to the right by a cable.
fn snapping() -> Vec<Case> {
    let mut cases: Vec<Case> = [165.0, 170.0, 172.0]
        .map(|degrees| {
            let arm = in_a_stream(silicone(0.0), 0.5, degrees);
            Case::new(format!("stream at {degrees} deg"), arm, LimitPoint, Phase::Loads)
        })
        .into();
    for fraction in [1.2, 1.5] {
        let mut arm = inextensible_arm("column");
        arm.tip.force = [-fraction * column_buckling_load(1e12, 1e12).unwrap(), 0.01];
        arm.cables.push(Cable::new("right", -0.04).pulled(100.0));
        cases.push(Case::new(format!("{fraction} of the buckling load"), arm, LimitPoint, Phase::Tension));
    }
    cases
}

#[test]
fn a_path_turns_back() {
    for case in snapping() {
        let [fraction, carried] = case.check();
        assert!(carried > 0.9 * fraction && carried <= fraction, "{}: {fraction}, {carried}", case.name);
    }
}

#[test]
fn the_last_good_shape_of_a_limit_point_is_at_its_load() {
    for case in snapping() {
        case.check_with_last_good();
    }
}

fn literal(arm: Arm) -> Arm {
    Arm { model: ModelOptions::LITERAL, ..arm }
}

#[test]
fn a_load_jumps_against_the_motion() {
    for degrees in [60.0, 90.0, 150.0] {
        let arm = literal(in_a_stream(silicone(0.0), 0.5, degrees));
        Case::new(format!("{degrees} deg"), arm, LoadJump, Phase::Loads).check_with_last_good();
    }
}

/// In a stream along it the straight arm is on the tie of its sides; any tension takes it off.
#[test]
fn a_load_jumps_on_the_tie_of_both_sides() {
    for speed in [0.1, 0.5] {
        let arm = literal(in_a_stream(silicone(0.3), speed, 0.0));
        Case::new(format!("{speed} m/s"), arm, LoadJump, Phase::Tension).verdict(1e-6);
    }
}

/// Where the stream alone takes the sections of the base near their limit, what carries the stream is not lost by
/// tensions that go on only so far.
#[test]
fn nothing_was_last_good_where_tensions_did_not_start() {
    let mut arm = ArmFile::parse(shipped::get("octopus").unwrap(), "octopus").unwrap().arm().unwrap();
    let tension = 0.003_406_966_685_885_696_3;
    arm.set_tensions(&[tension, 0.0]).unwrap();
    arm.flow.speed = 0.841_468_984_200_415_4;
    let Err(SolveError::NoEquilibrium(no)) = arm.solve() else { panic!("there is none") };
    assert_eq!((no.verdict.kind, no.verdict.phase), (NoSectionSolution, Phase::Tension), "{}", no.verdict.message());
    let last = no.last_good.unwrap();
    let reached = last.arm.cables[0].tension / tension;
    assert_eq!(last.arm.flow.speed, arm.flow.speed);
    assert!(
        reached <= no.verdict.load_fraction && reached > 0.999 * no.verdict.load_fraction,
        "{reached}: {}",
        no.verdict.message()
    );
}

/// Slack, the arm lies in the stream, and the signs of tiny angles decide which way the load goes. Tensions did not get
/// off: the plane had a limit point at 0 % of them, space no equilibrium. A path over the speed at whole tensions does
/// not pass that shape.
#[test]
fn tensions_did_not_start_on_a_slack_arm_that_lies_in_the_stream() {
    let mut arm = ArmFile::parse(shipped::get("octopus").unwrap(), "octopus").unwrap().arm().unwrap();
    arm.set_tensions(&[0.016, 0.0]).unwrap();
    arm.flow.speed = 0.5;
    for (degrees, in_space) in [(58.0_f64, false), (60.0, false), (62.0, false), (90.0, true), (150.0, true)] {
        arm.flow.direction = degrees.to_radians();
        let path = arm.path(Parameter::FlowSpeed, [0.0, 0.5], &PathOptions::default()).unwrap();
        let last = path.branches[0].points.last().unwrap();
        assert_eq!(last.value, 0.5, "{degrees} deg");
        let expected = last.configuration.tip();
        let off = |x: f64, y: f64| (x - expected.x).hypot(y - expected.y) / arm.length;
        let plane = arm.solve().unwrap_or_else(|error| panic!("{degrees} deg: {error}")).tip();
        assert!(off(plane.x, plane.y) < 1e-5, "{degrees} deg: {:e}", off(plane.x, plane.y));
        if in_space {
            let mut solver = SpatialSolver::new(&arm, Options::default()).unwrap();
            let space = solver.solve().unwrap_or_else(|error| panic!("{degrees} deg in space: {error}")).tip();
            assert!(off(space.x, space.y) < 1e-5, "{degrees} deg in space: {:e}", off(space.x, space.y));
        }
    }
}
