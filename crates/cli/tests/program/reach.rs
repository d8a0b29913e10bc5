//! `hydrostat reach`.

use serde_json::Value;

use super::{columns, directory, files, hydrostat, hydrostat_in, json, refused, solved};

/// The tip of `silicone` at these tensions, mm.
fn tip(tensions: &str) -> [f64; 2] {
    let run = solved(&["solve", "silicone", "--tension", tensions, "--flow-speed", "0.05", "--format", "json"]);
    let document = json(&run.out);
    ["x", "y"].map(|axis| document["tip"][axis].as_f64().unwrap())
}

fn reach<'a>(target: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut args = vec!["reach", "silicone", "--flow-speed", "0.05", "--max-tension", "500 mN", "--target", target];
    args.extend(more);
    args
}

#[test]
fn tensions_that_were_solved_with_are_found_again() {
    let [x, y] = tip("0.3,0.1");
    let target = format!("{} mm,{y}", 1e3 * x);
    let run = solved(&reach(&target, &[]));
    assert!(run.out.starts_with("silicone: 1 solution\n"), "{}", run.out);
    assert!(run.out.lines().any(|line| line.trim_start().starts_with("0.3  ") && line.ends_with("yes")), "{}", run.out);
    assert_eq!(run.err, "");

    let document = json(&solved(&reach(&target, &["--format", "json"])).out);
    assert_eq!((&document["schema"], &document["reached"]), (&Value::from(1), &Value::from(true)));
    let best = &document["solutions"][0];
    for (cable, want) in best["cables"].as_array().unwrap().iter().zip([0.3, 0.1]) {
        assert!((cable["tension"].as_f64().unwrap() - want).abs() < 1e-6, "{cable}");
    }
    assert!((best["effort"].as_f64().unwrap() - 0.1).abs() < 1e-6 && best["distance"].as_f64().unwrap() < 1e-8);
    assert_eq!((&best["on_the_path"], &document["closest"]), (&Value::from(true), &Value::Null));

    let run = solved(&reach(&target, &["--format", "csv"]));
    let (names, rows) = columns(&run.out);
    assert_eq!(&names[..4], ["number", "reached", "effort_N2", "distance"]);
    assert_eq!((rows.len(), rows[0][1]), (1, "true"));
}

#[test]
fn what_is_out_of_reach_ends_with_status_3_and_the_closest() {
    let run = hydrostat(&reach("0.3,0", &["--format", "json"]));
    assert_eq!(run.code, 3, "{}", run.err);
    assert!(
        run.err.starts_with("error: the target is not reached: the closest that was found is off by "),
        "{}",
        run.err
    );
    assert!(run.err.contains("is slack and cannot push"), "{}", run.err);
    let document = json(&run.out);
    assert_eq!((&document["reached"], &document["solutions"]), (&Value::from(false), &serde_json::json!([])));
    assert_eq!(document["closest"]["bounds"][0]["kind"], "slack");
}

#[test]
fn the_arm_is_drawn_with_the_target() {
    let here = directory();
    let [x, y] = tip("0.2,0");
    let target = format!("{x},{y}");
    let run = hydrostat_in(here.path(), &reach(&target, &["--plot", "reached.svg", "-o", "reached.txt"]));
    assert_eq!((run.code, run.out.as_str()), (0, ""), "{}", run.err);
    assert_eq!(files(here.path()), ["reached.svg", "reached.txt"]);
    assert!(std::fs::read_to_string(here.path().join("reached.svg")).unwrap().starts_with("<svg"));
}

#[test]
fn wrong_requests_say_what_is_wrong() {
    assert!(refused(&reach("0.3", &[])).contains("expected X,Y"));
    assert!(refused(&reach("0.3 kg,0", &[])).contains("0.3 kg,0"));
    assert!(refused(&reach("0.2,0", &["--station", "0.3"])).contains("there is no station at 0.3 m"));
    assert!(refused(&reach("0.2,0", &["--tol", "1"])).contains("tol: expected a number in [1e-10, 1e-2], found 1"));
    assert!(refused(&reach("0.2,0", &["--angle", "3 mm"])).contains("3 mm"));
    assert!(refused(&["reach", "silicone"]).contains("--target"));
}
