//! The JSON Schema: the committed file is the generated one, and it agrees with the parser.

use hydrostat_files::{ArmFile, Inputs, schema, shipped};
use serde_json::Value;

const ARM: &str = "arm = { length = 0.2, radius = 0.01 }\n";
const MATERIAL: &str = "material = { young = 1e5 }\n";

fn valid(validator: &jsonschema::Validator, text: &str) -> bool {
    let json: Value = toml::from_str(text).unwrap_or_else(|e| panic!("{e}:\n{text}"));
    validator.is_valid(&json)
}

#[test]
fn the_committed_schema_is_the_generated_one() {
    let committed: Value = serde_json::from_str(include_str!("../../../schema/arm.schema.json")).unwrap();
    // Not `assert_eq`: nobody wants to read both.
    assert!(
        committed == schema::arm_schema(),
        "out of step; write it anew: cargo run -p hydrostat-files --example write_schema > schema/arm.schema.json"
    );
}

#[test]
fn it_is_a_schema() {
    assert!(jsonschema::meta::is_valid(&schema::arm_schema()));
}

#[test]
#[allow(clippy::too_many_lines, reason = "a list of cases")]
fn parser_and_schema_take_the_same() {
    let validator = jsonschema::validator_for(&schema::arm_schema()).unwrap();
    let check = |text: &str, want: bool| {
        assert_eq!(ArmFile::parse(text, "x").unwrap().arm().is_ok(), want, "{text}");
        assert_eq!(valid(&validator, text), want, "{text}");
    };
    let all = ["momentum", "quadratic-drag"].map(|law| format!("[flow]\nlaw = \"{law}\"\ncn = 1\nct = 0.1"));
    let good = [
        "",
        "name = \"x\"",
        "flow = {}\ngravity = {}\ntip = {}\nmodel = {}\nreference = {}\ndistributed = {}\ncable = []",
        &all[0],
        &all[1],
        "[[cable]]\n[[cable]]\nname = \"x\"\noffset = \"-1 mm\"\ntension = 1\nmax_tension = \"20 N\"\nend = 0.5",
        "[[cable]]\noffset = \"50 %\"\nend = \"98 mm\"",
        "[[cable]]\noffset = { base = \"-50 %\", tip = 0.001 }\nend = \"40 %\"",
        "[[cable]]\noffset = [[0, \"50 %\"], [0.2, \"1 mm\"]]\n[[cable]]\noffset = { points = [[0, 0], [0.2, \"5e1%\"]], join = \"linear\" }",
        "[reference]\nnu = { base = 1, tip = 2 }\neta = [[0, 1], [\"200 mm\", 2]]\nmu = \"2 1/m\"",
        "[tip]\nforce = [\"1 mN\", 0]\nmoment = \"1 N m\"\nfollower = [1, 2]",
        "[distributed]\nforce = [0, { base = \"1 N/m\", tip = 0 }]\ncouple = \"1 N\"",
        "[gravity]\nacceleration = \"2 g\"\ndirection = \"-45\u{b0}\"",
        "[flow]\nspeed = \" +.5e0 m/s \"\ndensity = \"1.02 g/cm^3\"\nlayer_thickness = \"5 \u{b5}m\"",
        "[model]\nclosure = \"literal\"\nvolume = \"none\"\ndisplaced = \"section\"\nsupport = \"unstrained-base\"",
    ];
    for text in good {
        check(&format!("{ARM}{MATERIAL}{text}"), true);
    }
    let bad = [
        "nme = \"x\"",
        "name = 1",
        "flow = 1",
        "[flow]\nspede = 1",
        "[flow]\nspeed = true",
        "[flow]\nspeed = [1]",
        "[[cable]]\ntension = 1\nstroke = 0.001",
        "[flow]\nspeed = \"1 m\"",
        "[flow]\nspeed = \"1\"",
        "[flow]\nspeed = \"m/s\"",
        "[flow]\nspeed = \"1 m/s/s\"",
        "[flow]\nlaw = \"drag\"",
        "[flow]\nlaw = \"quadratic-drag\"",
        "[flow]\nlaw = \"quadratic-drag\"\ncn = 1",
        "[flow]\ncn = \"1\"",
        "[cable]\noffset = 0",
        "cable = [1]",
        "[[cable]]\noffset = true",
        "[[cable]]\nend = \"tip\"",
        "[[cable]]\nend = \"1 kg\"",
        "[[cable]]\nend = { base = 1, tip = 1 }",
        "[[cable]]\noffset = \"50 % of R\"",
        "[tip]\nmoment = \"50 %\"",
        "[[cable]]\ntension = { base = 1, tip = 2 }",
        "[reference]\nmu = { base = 1 }",
        "[reference]\nmu = { base = 1, tip = 2, mid = 3 }",
        "[reference]\nmu = []",
        "[reference]\nmu = [[0, 1]]",
        "[reference]\nmu = [0, 1]",
        "[reference]\nmu = [[0, 1, 2], [0.2, 1, 2]]",
        "[reference]\nmu = [[0, 1], [\"200 kg\", 1]]",
        "[reference]\nnu = \"1\"",
        "[tip]\nforce = 1",
        "[tip]\nforce = [1]",
        "[tip]\nforce = [1, \"1 m\"]",
        "[distributed]\nforce = [1, 2, 3]",
        "[model]\nvolume = \"plain\"",
        "[model]\nvolume = 1",
        "[gravity]\nacceleration = \"9.81\"",
    ];
    for text in bad {
        check(&format!("{ARM}{MATERIAL}{text}"), false);
    }
    let whole = [
        ("", false),
        (ARM, false),
        (MATERIAL, false),
        ("arm = { length = 1 }\nmaterial = { young = 1 }", false),
        ("arm = { radius = 1 }\nmaterial = { young = 1 }", false),
        ("arm = { length = 1, radius = 1 }\nmaterial = {}", false),
        ("arm = { length = 1, radius = 1 }\nmaterial = { poisson = 0.5 }", false),
        ("arm = { length = 1, radius = 1 }\nmaterial = { c1 = 1, c2 = 1 }", false),
        ("arm = { length = 1, radius = 1 }\nmaterial = { young = 1, c1 = 1, c2 = 1, c3 = 1 }", false),
        ("arm = { length = 1, radius = 1 }\nmaterial = { poisson = 0.5, c1 = 1, c2 = 1, c3 = 1 }", false),
        ("arm = { length = 1, radius = 1 }\nmaterial = { c1 = 1, c2 = \"1 kPa\", c3 = \"1 N\" }", true),
        (
            "arm = { length = 1, radius = 1, cavity = \"sealed\", base = { x = 1, angle = 3 } }\n[material]\nyoung = 1",
            true,
        ),
        ("arm = { length = 1, radius = 1, base = { z = 1 } }\n[material]\nyoung = 1", false),
    ];
    for (text, want) in whole {
        check(text, want);
    }
    // What leaves the plane, with and without the word for it.
    let leaves = [
        "arm.base.z = 1",
        "arm.base = { direction = [1, 0, 2], section = [0, 1, 0] }",
        "cable = [{ angle = 30 }]",
        "flow.direction = [0, 0, 1]",
        "gravity.direction = [0, 0, 1]",
        "tip.force = [1, 2, \"3 N\"]",
        "tip.moment = [1, 2, 3]",
        "distributed.force = [1, 2, { base = 1, tip = 2 }]",
        "distributed.couple = [1, 2, [[0, 1], [0.2, 2]]]",
        "reference.tau = 1",
    ];
    for text in leaves {
        for (space, want) in [("planar", false), ("spatial", true)] {
            check(
                &format!("arm.length = 0.2\narm.radius = 0.01\narm.space = \"{space}\"\nmaterial.young = 1e5\n{text}"),
                want,
            );
        }
    }
    for text in ["arm.base = { direction = [1, 0, 0], angle = 3 }", "arm.base.section = [1, 0, 0]", "material.c4 = 1"] {
        check(
            &format!("arm.length = 0.2\narm.radius = 0.01\narm.space = \"spatial\"\nmaterial.young = 1e5\n{text}"),
            false,
        );
    }
}

#[test]
fn shipped_arms_and_inputs_of_results_follow_it() {
    let validator = jsonschema::validator_for(&schema::arm_schema()).unwrap();
    for name in shipped::names().chain(shipped::spatial_names()) {
        let text = shipped::get(name).unwrap();
        assert!(valid(&validator, text), "{name}");
        let arm = ArmFile::parse(text, name).unwrap().arm().unwrap();
        assert!(validator.is_valid(&serde_json::to_value(Inputs::new(&arm)).unwrap()), "{name}");
    }
}

/// Every default in the schema is what the parser does without the key.
#[test]
fn defaults_in_the_schema_are_those_of_the_parser() {
    let schema = schema::arm_schema();
    let base = format!("{ARM}{MATERIAL}gravity = {{}}\ncable = [{{}}]\n");
    let without = ArmFile::parse(&base, "x").unwrap().arm().unwrap();
    let mut seen = 0;
    for (table, properties) in schema["properties"].as_object().unwrap() {
        let (prefix, inner) = match properties["items"]["properties"].as_object() {
            Some(inner) => (format!("{table}[0]"), Some(inner)),
            None => (table.clone(), properties["properties"].as_object()),
        };
        for (key, property) in inner.into_iter().flatten() {
            let Some(default) = property.get("default") else { continue };
            let text = default.to_string().replace("\":", "\"=");
            let mut file = ArmFile::parse(&base, "x").unwrap();
            file.set(&format!("{prefix}.{key}"), &text).unwrap();
            assert_eq!(file.arm().unwrap(), without, "{prefix}.{key} = {text}");
            seen += 1;
        }
    }
    assert_eq!(seen, 31);
}
