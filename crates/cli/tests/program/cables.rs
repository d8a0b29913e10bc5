//! Cables given by their stroke, and cables that rub.

use super::{hydrostat, json, refused, solved};

const LEFT: &str = "cable[0].stroke=\"12 mm\"";

#[test]
fn a_stroke_takes_the_place_of_a_tension() {
    let run = solved(&["solve", "silicone", "--set", LEFT, "--format", "json"]);
    let left = &json(&run.out)["cables"][0];
    assert!((left["stroke"].as_f64().unwrap() - 0.012).abs() < 1e-8);
    assert_eq!(left["command"]["stroke"], 0.012);
    assert_eq!(left["command"]["slack"], false);
    // The tension found gives the same stroke.
    let tension = format!("{},0", left["tension"].as_f64().unwrap());
    let again = json(&solved(&["solve", "silicone", "--tension", &tension, "--format", "json"]).out);
    assert!((again["cables"][0]["stroke"].as_f64().unwrap() - 0.012).abs() < 1e-8);
    assert!(again["cables"][0].get("command").is_none());
}

#[test]
fn a_slack_cable_is_called_slack() {
    let slack = "cable[1].stroke=\"-30 mm\"";
    let run = solved(&["solve", "silicone", "--set", LEFT, "--set", slack]);
    assert!(run.out.contains("(slack: commanded stroke -30.000 mm, 275.033 mm of cable)"), "{}", run.out);
}

#[test]
fn a_tension_and_a_stroke_together_are_refused() {
    let both = refused(&["solve", "silicone", "--set", LEFT, "--set", "cable[0].tension=0.1"]);
    assert!(both.contains("either tension or stroke"), "{both}");
    refused(&["solve", "silicone", "--set", LEFT, "--tension", "0.1,0"]);
}

#[test]
fn a_stroke_that_no_arm_takes_ends_in_a_verdict() {
    let run = hydrostat(&["solve", "silicone", "--set", "cable[0].stroke=0.2", "--format", "json"]);
    assert_eq!(run.code, 3);
    let verdict = &json(&run.out)["verdict"];
    assert_eq!((&verdict["kind"], &verdict["phase"]), (&"cable_fold".into(), &"stroke".into()));
}

#[test]
fn a_path_over_a_stroke_says_where_a_cable_goes_taut() {
    let held = "cable[1].stroke=\"-0.22 mm\"";
    let path = |format: &str| {
        let vary = "cable[0].stroke=0:6 mm";
        let args = ["path", "silicone", "--set", held, "--set", "flow.speed=0.1", "--vary", vary, "--format", format];
        solved(&args).out
    };
    let found = json(&path("json"));
    let points = found["branches"][0]["points"].as_array().unwrap();
    let event = points.iter().find(|p| p["event"] == "taut").expect("the right cable is taken up");
    assert_eq!(event["cable"], 1);
    assert!(points.iter().all(|p| p["stability"]["state"] == "stable"));
    assert!(path("csv").contains(",taut[1],"));
    let text = path("text");
    assert!(text.contains("right is taken up") && text.contains("cables go slack or taut 2 times"), "{text}");
}

#[test]
fn a_stroke_is_answered_with_its_stability_and_what_it_takes_of_the_cable() {
    let max = "cable[0].max_tension=0.05";
    let run = solved(&["solve", "silicone", "--set", LEFT, "--set", max, "--format", "json"]);
    let found = json(&run.out);
    assert_eq!(found["stable"], true);
    let kinds: Vec<&str> = found["warnings"].as_array().unwrap().iter().map(|w| w["kind"].as_str().unwrap()).collect();
    assert!(kinds.contains(&"tension_above_max"), "{kinds:?}");
}

#[test]
fn friction_takes_from_the_bend() {
    let turned = |friction: &str| {
        let set = format!("cable[0].friction={friction}");
        let run = solved(&["solve", "silicone", "--tension", "0.3,0", "--set", &set, "--format", "json"]);
        json(&run.out)["tip"]["theta"].as_f64().unwrap()
    };
    assert!(turned("0.1") < 0.9 * turned("0"));
    let wrong = refused(&["solve", "silicone", "--set", "cable[0].friction=-0.1"]);
    assert!(wrong.contains("cable[0].friction"), "{wrong}");
}

/// What asks for derivatives says which key keeps it from them, before anything is measured.
#[test]
fn friction_was_refused_without_its_key() {
    let directory = super::directory();
    let [file, out] = ["rubbing.toml", "out"].map(|name| directory.path().join(name));
    let text =
        "[arm]\nlength = 0.2\nradius = 0.01\n[material]\nyoung = 1e5\n[[cable]]\noffset = 0.005\nfriction = 0.1\n";
    std::fs::write(&file, text).unwrap();
    let (file, out) = (file.to_str().unwrap(), out.to_str().unwrap());
    for arguments in [
        &["reach", file, "--target", "0.182,0.078"][..],
        &["identify", file, "--template"],
        &["figures", file, "-o", out],
        &["path", file, "--vary", "flow.speed=0:0.1"],
    ] {
        let wrong = refused(arguments);
        assert!(wrong.contains("friction"), "{arguments:?}: {wrong}");
    }
}
