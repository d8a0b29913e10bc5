//! Files that are read, with their defaults, units and overrides.

mod common;

use hydrostat::{
    Arm, Cable, Cavity, Displaced, Flow, FlowLaw, FlowSurface, Gravity, Material, ModelOptions, Profile, Reference,
    Support, Volume,
};
use hydrostat_files::{ArmFile, shipped};

use common::ARM;

fn file(text: &str) -> ArmFile {
    ArmFile::parse(text, "dir/case.toml").unwrap()
}

fn shipped_file(name: &str) -> ArmFile {
    ArmFile::parse(shipped::get(name).unwrap(), name).unwrap()
}

fn arm(text: &str) -> Arm {
    file(text).arm().unwrap()
}

/// The arm of `ARM` with one override, or why not.
fn set(key: &str, value: &str) -> Result<Arm, String> {
    let mut file = file(&format!("{ARM}[[cable]]\noffset = 0.001\n[[cable]]\noffset = -0.001\n"));
    file.set(key, value).and_then(|()| file.arm()).map_err(|e| e.to_string())
}

#[test]
fn defaults_are_those_of_the_core() {
    let mut want = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    want.name = "case".to_owned();
    assert_eq!(arm(ARM), want);
}

#[test]
fn empty_tables_are_their_defaults() {
    let text = format!("{ARM}[arm.base]\n[reference]\n[[cable]]\n[flow]\n[gravity]\n[tip]\n[distributed]\n[model]\n");
    let mut want = arm(ARM);
    want.gravity = Some(Gravity { acceleration: 9.81, direction: -std::f64::consts::FRAC_PI_2 });
    want.cables.push(Cable::new("0", Profile::linear(0.005, 0.001)));
    assert_eq!(arm(&text), want);
}

#[test]
fn every_key_of_the_format() {
    let arm = arm(r#"
        name = "all of it"
        [arm]
        length = "245 mm"
        radius = { base = "10 mm", tip = "2 mm" }
        inner_radius = "1 mm"
        cavity = "sealed"
        density = "1.08 g/cm3"
        base = { x = "1 cm", y = "-1 cm", angle = 90 }
        [material]
        c1 = "110 kPa"
        c2 = { base = "40 kPa", tip = 30e3 }
        c3 = [["0 mm", "150 N"], ["100 mm", 20], [0.245, 0.1]]
        [reference]
        nu = 1.1
        eta = 0.01
        mu = "5 1/m"
        [[cable]]
        name = "left"
        offset = [[0, "4 mm"], ["245 mm", "1 mm"]]
        tension = "500 mN"
        max_tension = 1.5
        end = 0.5
        [flow]
        speed = "0.5 m/s"
        direction = "0.5 rad"
        density = "1022 kg/m3"
        layer_thickness = "4 mm"
        law = "quadratic-drag"
        cn = 2.5
        ct = 0.005
        [gravity]
        acceleration = "2 g"
        direction = "-45 deg"
        [tip]
        force = ["1 mN", 0.002]
        moment = "3 N mm"
        follower = [0, "-1 mN"]
        [distributed]
        force = [{ base = "1 mN/m", tip = 0 }, 0.5]
        couple = "1 mN m/m"
        [model]
        closure = "literal"
        volume = "none"
        displaced = "section"
        support = "unstrained-base"
    "#
    .replace("1 mN m/m", "1 mN")
    .as_str());
    assert_eq!(arm.name, "all of it");
    assert_eq!(arm.radius, Profile::linear(0.010, 0.002));
    assert_eq!((arm.inner_radius.clone(), arm.cavity, arm.density), (0.001.into(), Cavity::Sealed, 1080.0));
    assert_eq!((arm.base.x, arm.base.y, arm.base.angle), (0.01, -0.01, std::f64::consts::FRAC_PI_2));
    let c3 = Profile::table(&[[0.0, 150.0], [0.1, 20.0], [0.245, 0.1]]).unwrap();
    assert_eq!(arm.material, Material::Coefficients { c1: 110e3.into(), c2: Profile::linear(40e3, 30e3), c3 });
    assert_eq!(arm.reference, Reference { nu: 1.1.into(), eta: 0.01.into(), mu: 5.0.into() });
    let mut left = Cable::new("left", Profile::table(&[[0.0, 0.004], [0.245, 0.001]]).unwrap());
    left = left.pulled(0.5).ending_at(0.5);
    left.max_tension = Some(1.5);
    assert_eq!(arm.cables, [left]);
    let law = FlowLaw::QuadraticDrag { cn: 2.5, ct: 0.005 };
    assert_eq!(arm.flow, Flow { speed: 0.5, direction: 0.5, density: 1022.0, layer_thickness: 0.004, law });
    let direction = -std::f64::consts::FRAC_PI_4;
    assert_eq!(arm.gravity, Some(Gravity { acceleration: 19.6133, direction }));
    assert_eq!((arm.tip.force, arm.tip.moment, arm.tip.follower), ([0.001, 0.002], 0.003, [0.0, -0.001]));
    assert_eq!(arm.distributed.force, [Profile::linear(0.001, 0.0), 0.5.into()]);
    assert_eq!(arm.distributed.couple, 0.001.into());
    let want = ModelOptions {
        volume: Volume::None,
        displaced: Displaced::Section,
        support: Support::UnstrainedBase,
        ..ModelOptions::LITERAL
    };
    assert_eq!(arm.model, want);
}

#[test]
fn coefficients_of_drag_may_wait_unused() {
    let text = format!("{ARM}[flow]\ncn = 1.0\nct = 0.02\n");
    assert_eq!(arm(&text).flow.law, FlowLaw::Momentum);
    let mut file = file(&text);
    file.set("flow.law", "quadratic-drag").unwrap();
    assert_eq!(file.arm().unwrap().flow.law, FlowLaw::QuadraticDrag { cn: 1.0, ct: 0.02 });
}

#[test]
fn line_ends_and_byte_order_mark_do_not_matter() {
    assert_eq!(arm(&ARM.replace('\n', "\r\n")), arm(ARM));
    assert_eq!(arm(&format!("\u{feff}{ARM}")), arm(ARM));
    assert_eq!(arm(ARM.trim_end()), arm(ARM));
}

#[test]
fn one_table_can_be_written_in_several_ways() {
    let dotted = "arm.length = 0.2\narm.radius.base = 0.010\narm.radius.tip = 0.002\nmaterial.young = 110e3";
    assert_eq!(arm(dotted), arm(ARM));
    let inline = "arm = { length = 0.2, radius = { base = 0.010, tip = 0.002 } }\nmaterial = { young = 110_000 }";
    assert_eq!(arm(inline), arm(ARM));
    let cables = format!("cable = [{{ offset = 0 }}, {{ offset = 0 }}]\n{ARM}");
    assert_eq!(arm(&cables).cables.len(), 2);
}

#[test]
fn shipped_arms_are_arms() {
    let names: Vec<&str> = shipped::names().collect();
    assert_eq!(names, ["paper", "paper-statements", "silicone", "multi-bending", "octopus"]);
    for name in names {
        let mut file = shipped_file(name);
        let arm = file.arm().unwrap();
        assert_eq!(arm.name, name);
        assert_eq!(arm.flow.law, FlowLaw::Momentum);
        assert!(arm.cables.iter().all(|c| c.max_tension.is_some()));
        assert!(shipped::description(name).is_some());
        // The authors' drag is one word away where they have one.
        file.set("flow.law", "quadratic-drag").unwrap();
        assert_eq!(file.arm().is_ok(), !name.starts_with("paper"));
    }
    assert!(shipped::get("no such arm").is_none());
}

#[test]
fn the_shipped_numbers() {
    let get = |name: &str| shipped_file(name).arm().unwrap();
    let paper = get("paper");
    assert_eq!((paper.length, paper.radius, paper.density), (0.2, Profile::linear(0.010, 0.0008), 1080.0));
    assert_eq!(paper.material, Material::Coefficients { c1: 500e3.into(), c2: (500e3 / 3.0).into(), c3: 150.0.into() });
    assert_eq!((paper.cables[0].tension, paper.cables[1].tension, paper.flow.speed), (40.0, 0.0, 0.5));
    assert_eq!(paper.cables[0].offset, Profile::linear(0.008, 0.0001));
    assert_eq!(paper.cables[1].offset, Profile::linear(-0.008, -0.0001));
    assert!(paper.gravity.is_none());
    let multi = get("multi-bending");
    let ends: Vec<f64> = multi.cables.iter().map(|c| c.end * multi.length).collect();
    for (end, want) in ends.iter().zip([0.098, 0.203, 0.311, 0.098, 0.203, 0.311]) {
        assert!((end - want).abs() < 1e-8, "{end} {want}");
    }
    assert_eq!(get("silicone").length, 0.245);
    assert_eq!(get("octopus").flow.density, 1022.0);
}

#[test]
fn overrides_replace_and_make() {
    let ok = |key: &str, value: &str| set(key, value).unwrap_or_else(|e| panic!("{key}={value}: {e}"));
    assert_eq!(ok("cable[0].tension", "20").cables[0].tension, 20.0);
    assert_eq!(ok("cable[1].tension", "20 mN").cables[1].tension, 0.02);
    assert_eq!(ok("arm.length", "0.3 m").length, 0.3);
    assert_eq!(ok("arm.length", "\"30 cm\"").length, 0.3);
    assert_eq!(ok("model.volume", "none").model.volume, Volume::None);
    assert_eq!(ok("model.closure", "\"literal\"").model, ModelOptions::LITERAL);
    assert_eq!(ok("model.flow_surface", "lateral").model.flow_surface, FlowSurface::Lateral);
    assert_eq!(ok("flow.speed", "0.5").flow.speed, 0.5);
    assert_eq!(ok("gravity.acceleration", "1 g").gravity.unwrap().acceleration, 9.80665);
    assert_eq!(ok("gravity", "{}").gravity, Some(Gravity::default()));
    assert_eq!(ok("arm.radius", "0.01").radius, 0.01.into());
    assert_eq!(ok("arm.radius", "{ base = 0.01, tip = \"5 mm\" }").radius, Profile::linear(0.01, 0.005));
    assert_eq!(ok("arm.radius.tip", "0.004").radius, Profile::linear(0.010, 0.004));
    assert_eq!(
        ok("arm.radius", "[[0, 0.01], [0.2, 0.005]]").radius,
        Profile::table(&[[0.0, 0.01], [0.2, 0.005]]).unwrap()
    );
    assert_eq!(ok("arm.base.angle", "90").base.angle, std::f64::consts::FRAC_PI_2);
    assert_eq!(ok("tip.force", "[1, 2]").tip.force, [1.0, 2.0]);
    assert_eq!(ok("tip.force[1]", "-0.02").tip.force, [0.0, -0.02]);
    assert_eq!(ok("name", "2024").name, "2024");
    assert_eq!(ok("name", "").name, "");
    assert_eq!(ok("cable", "[]").cables, []);
    assert_eq!(ok("distributed.force[0]", "0.5").distributed.force, [0.5.into(), 0.0.into()]);
    assert_eq!(ok("material.poisson", "0.3"), {
        let mut arm = ok("name", "case");
        arm.material = Material::Homogeneous { young: 110e3, poisson: 0.3, shear_factor: 1.0 };
        arm
    });
}

#[test]
fn the_last_override_counts_and_a_refused_one_does_not() {
    let mut file = file(ARM);
    file.set("flow.speed", "1").unwrap();
    file.set("flow.sped", "3").unwrap_err();
    file.set("gravity.foo.bar", "3").unwrap_err();
    file.set("flow.speed", "2").unwrap();
    file.set("tip.moment", "1 kg").unwrap();
    assert!(file.arm().unwrap_err().to_string().starts_with("--set tip.moment=1 kg: tip.moment: expected a moment"));
    file.set("tip.moment", "1").unwrap();
    let arm = file.arm().unwrap();
    assert_eq!((arm.flow.speed, arm.gravity, arm.tip.moment), (2.0, None, 1.0));
}

#[test]
fn overrides_are_refused_by_name() {
    let cases: &[(&str, &str, &str, &[&str])] = &[
        ("flow.sped", "1", "flow.sped", &["did you mean `speed`?"]),
        ("young", "1", "young", &["did you mean `material.young`?"]),
        ("flow", "1", "flow", &["a table with speed", "found 1"]),
        ("flow.speed", "fast", "flow.speed", &["a speed", "found \"fast\""]),
        ("flow.speed", "-1", "flow.speed", &["not negative"]),
        ("flow.speed", "nan", "flow.speed", &["not finite"]),
        ("flow.speed.x", "1", "flow.speed", &["the end of the key"]),
        ("flow.speed[0]", "1", "flow.speed", &["the end of the key"]),
        ("cable[2].tension", "1", "cable", &["from 0 to 1, because the arm has 2 cables", "found 2"]),
        ("cable[99999999999999999999].tension", "1", "cable", &["the arm has 2 cables"]),
        ("cable.tension", "1", "cable", &["an index, as in cable[0].tension"]),
        ("cable[0].tensions", "1", "cable[0].tensions", &["did you mean `tension`?"]),
        ("cable[0]", "1", "cable[0]", &["a table with name", "found 1"]),
        ("arm.length[0]", "1", "arm.length", &["the end of the key"]),
        ("arm.inner_radius.mid", "1", "arm.inner_radius.mid", &["base or tip"]),
        ("arm.inner_radius.base", "0.001", "arm.inner_radius.tip", &["missing"]),
        ("arm.radius[0][1]", "1", "arm.radius", &["[[s, value], ...]; set arm.radius as a whole"]),
        ("tip.force[2]", "1", "tip.force", &["`space = \"spatial\"`", "found an arm in the plane"]),
        ("model.volume", "plain", "model.volume", &["\"planar\"", "found \"plain\""]),
        ("material.c1", "1", "material.c1", &["either young"]),
        ("flow.law", "quadratic-drag", "flow.cn", &["missing"]),
        ("arm.length", "0", "arm.length", &["above zero"]),
        ("cable[0].max_tension", "1 m", "cable[0].max_tension", &["a force"]),
        ("", "1", "KEY", &["a dotted key such as flow.speed"]),
        ("a b", "1", "KEY", &["a dotted key"]),
    ];
    for (key, value, named, parts) in cases {
        let message = set(key, value).unwrap_err();
        let start = format!("--set {key}={value}: {named}: ");
        let said = message.strip_prefix(&start).unwrap_or_else(|| panic!("wanted `{start}`, got `{message}`"));
        let starts = ["expected ", "unknown key; expected ", "missing; expected "];
        assert!(starts.iter().any(|start| said.starts_with(start)), "{message}");
        assert!(parts.iter().all(|p| message.contains(p)), "wanted {parts:?} in `{message}`");
    }
}

#[test]
fn a_message_names_what_has_to_change() {
    // The override is right by itself; it is the table in the file that no longer fits.
    let mut file = file(&ARM.replace("{ base = 0.010, tip = 0.002 }", "[[0, 0.01], [0.2, 0.002]]"));
    file.set("arm.length", "0.3").unwrap();
    let message = file.arm().unwrap_err().to_string();
    assert!(message.starts_with("dir/case.toml:3: arm.radius: expected a table that runs"), "{message}");
}
