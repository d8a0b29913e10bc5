//! Arm files of arms in space.

use hydrostat::{Arm, BaseDirections, Cable, Gravity, Material, Profile, Space};
use hydrostat_files::{ArmFile, arm_to_toml, shipped};

const TEXT: &str = r#"
[arm]
space = "spatial"
length = "245 mm"
radius = { base = "10 mm", tip = "6 mm" }
base = { x = "1 mm", z = "2 mm", direction = [1, 1, 0], section = [0, 0, 1] }

[material]
c1 = 1e5
c2 = 4e4
c3 = 2.0
c4 = 1.5

[reference]
zeta = 0.01
tau = 0.5
kappa = { base = 1.0, tip = 2.0 }

[[cable]]
name = "helix"
offset = "5 mm"
angle = { base = 0, tip = 180 }

[[cable]]
name = "straight"
offset = "2 mm"
angle = "1.5 rad"

[flow]
speed = 0.1
direction = [0, 0, 2]

[gravity]
direction = [0, 0, -1]

[tip]
force = [0.1, 0.2, 0.3]
follower = [0.01, 0.02]
moment = [1e-3, 2e-3, 3e-3]

[distributed]
force = [0.0, 0.1, { base = 0.0, tip = 0.2 }]
couple = [0.0, 1e-3, [[0, 0], [0.245, 2e-3]]]
"#;

fn arm_of(text: &str) -> Arm {
    ArmFile::parse(text, "arm.toml").unwrap().arm().unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_file_says_all_that_leaves_the_plane() {
    let arm = arm_of(TEXT);
    let space = Space {
        z: 0.002,
        base: Some(BaseDirections { direction: [1.0, 1.0, 0.0], section: Some([0.0, 0.0, 1.0]) }),
        stream: Some([0.0, 0.0, 2.0]),
        gravity: Some([0.0, 0.0, -1.0]),
        tip_force: 0.3,
        tip_follower: 0.0,
        tip_moment: [1e-3, 2e-3],
        force: Profile::linear(0.0, 0.2),
        couple: [0.0.into(), 1e-3.into()],
        zeta: 0.01.into(),
        tau: 0.5.into(),
        kappa: Profile::linear(1.0, 2.0),
        c4: Some(1.5.into()),
    };
    assert_eq!(arm.space, Some(space));
    assert_eq!((arm.tip.force, arm.tip.moment, arm.tip.follower), ([0.1, 0.2], 3e-3, [0.01, 0.02]));
    assert_eq!(arm.cables[0].angle, Profile::linear(0.0, std::f64::consts::PI));
    assert_eq!(arm.cables[1].angle, Profile::Constant(1.5));
    assert!(matches!(arm.material, Material::Coefficients { .. }));
}

#[test]
fn what_is_written_reads_back_as_the_same_arm() {
    let mut other = Arm::cone(0.2, 0.01, 0.002, 1e5, 0.5);
    other.cables.push(Cable::new("one", 0.001).at_angle(0.1));
    other.gravity = Some(Gravity::default());
    other.space = Some(Space::default());
    for arm in
        [arm_of(TEXT), other].into_iter().chain(shipped::spatial_names().map(|n| arm_of(shipped::get(n).unwrap())))
    {
        let text = arm_to_toml(&arm);
        assert_eq!(arm_of(&text), arm, "{text}");
    }
}

#[test]
fn overrides_reach_the_third_component() {
    let mut file = ArmFile::parse(TEXT, "arm.toml").unwrap();
    for (key, value) in [
        ("tip.force[2]", "0.5"),
        ("tip.follower[2]", "0.7"),
        ("tip.moment[0]", "0.25"),
        ("flow.direction[1]", "1"),
        ("arm.base.direction[2]", "3"),
        ("cable[1].angle", "90"),
        ("distributed.force[2].tip", "0.4"),
    ] {
        file.set(key, value).unwrap_or_else(|error| panic!("{error}"));
    }
    let arm = file.arm().unwrap();
    let space = arm.space.unwrap();
    assert_eq!((space.tip_force, space.tip_follower, space.tip_moment[0]), (0.5, 0.7, 0.25));
    assert_eq!(space.stream, Some([0.0, 1.0, 2.0]));
    assert_eq!(space.base.unwrap().direction, [1.0, 1.0, 3.0]);
    assert_eq!(space.force, Profile::linear(0.0, 0.4));
    assert!((arm.cables[1].angle.at(0.0, 1.0).value - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
}

/// A component needed three numbers in the file before.
#[test]
fn a_component_of_a_direction_replaces_that_of_the_angle() {
    const PLAIN: &str = "[arm]\nlength = 0.2\nradius = 0.01\nspace = \"spatial\"\n[material]\nyoung = 1e5\n";
    let space = |text: &str, settings: &[(&str, &str)]| {
        let mut file = ArmFile::parse(text, "arm.toml").unwrap();
        for (key, value) in settings {
            file.set(key, value).unwrap_or_else(|error| panic!("{error}"));
        }
        file.arm().unwrap().space.unwrap()
    };
    let stream = |text: &str, settings: &[(&str, &str)]| space(text, settings).stream.unwrap();
    assert_eq!(stream(PLAIN, &[("flow.direction[2]", "0.1")]), [1.0, 0.0, 0.1]);
    assert_eq!(stream(PLAIN, &[("flow.direction[1]", "2"), ("flow.direction[2]", "3")]), [1.0, 2.0, 3.0]);
    assert_eq!(space(PLAIN, &[("gravity.direction[2]", "1")]).gravity, Some([0.0, -1.0, 1.0]));
    for (angle, x) in [("30", 0.75_f64.sqrt()), ("\"30 deg\"", 0.75_f64.sqrt()), ("180", -1.0)] {
        let text = format!("{PLAIN}[flow]\ndirection = {angle}\n");
        let found = stream(&text, &[("flow.direction[2]", "1")]);
        assert!((found[0] - x).abs() < 1e-15 && found[2] == 1.0, "{angle}: {found:?}");
    }
    let mut file = ArmFile::parse(&format!("{PLAIN}[flow]\ndirection = \"30 mm\"\n"), "arm.toml").unwrap();
    let error = file.set("flow.direction[2]", "1").unwrap_err().to_string();
    assert!(error.contains("expected an angle") && error.contains("\"30 mm\""), "{error}");
}

/// Whatever leaves the plane without the word for it is named, with what to write.
#[test]
fn what_leaves_the_plane_of_a_planar_file_is_named() {
    const PLAIN: &str = "[arm]\nlength = 0.2\nradius = 0.01\n[material]\nyoung = 1e5\n[[cable]]\noffset = 0.001\n";
    for (key, value) in [
        ("arm.base.z", "1"),
        ("arm.base.direction", "[1, 0, 0]"),
        ("cable[0].angle", "30"),
        ("flow.direction", "[1, 0, 0]"),
        ("gravity.direction", "[1, 0, 0]"),
        ("tip.force", "[0, 0, 1]"),
        ("tip.moment", "[0, 0, 1]"),
        ("tip.follower", "[0, 0, 1]"),
        ("distributed.force", "[0, 0, 1]"),
        ("distributed.couple", "[0, 0, 1]"),
        ("reference.tau", "1"),
        ("reference.zeta", "0.1"),
        ("reference.kappa", "1"),
    ] {
        let mut file = ArmFile::parse(PLAIN, "arm.toml").unwrap();
        file.set(key, value).unwrap();
        let error = file.arm().unwrap_err();
        assert_eq!(error.key(), Some(key));
        assert!(error.to_string().contains("space = \"spatial\""), "{error}");
        file.set("arm.space", "spatial").unwrap();
        file.arm().unwrap_or_else(|error| panic!("{key}: {error}"));
    }
}

#[test]
fn what_excludes_each_other_and_what_space_does_not_have_is_refused_with_its_key() {
    for (key, value, wrong) in [
        ("arm.base.angle", "30", "arm.base.direction"),
        ("arm.base.section", "[2, 2, 0]", "arm.base.section"),
        ("arm.base.direction", "[0, 0, 0]", "arm.base.direction"),
        ("flow.direction", "[0, 0, 0]", "flow.direction"),
        ("cable[0].friction", "0.1", "cable[0].friction"),
        ("model.closure", "literal", "model.flow_surface"),
        ("tip.force", "[0, 0, 1, 2]", "tip.force"),
        ("arm.base.direction", "[1, 0]", "arm.base.direction"),
    ] {
        let mut file = ArmFile::parse(TEXT, "arm.toml").unwrap();
        file.set(key, value).unwrap();
        let error = file.arm().unwrap_err();
        assert_eq!(error.key(), Some(wrong), "{error}");
    }
    let without = TEXT.replace("c1 = 1e5\nc2 = 4e4\nc3 = 2.0\n", "young = 1e5\n");
    let error = ArmFile::parse(&without, "arm.toml").unwrap().arm().unwrap_err();
    assert_eq!(error.key(), Some("material.c4"), "{error}");
}
