//! `hydrostat equilibria`, and what `solve` says of other equilibria.

use serde_json::Value;

use super::{columns, directory, files, hydrostat, hydrostat_in, json, picture, refused, solved};

/// A soft arm that the stream meets from the tip: straight, bent to either side, and an unstable one between.
const FIVE: [&str; 6] = ["equilibria", "silicone", "--flow-speed", "0.2", "--set", "flow.direction=180 deg"];
/// Loads to which no path leads.
const NINE: [&str; 7] = ["silicone", "--set", "flow.direction=180 deg", "--flow-speed", "0.5", "--tension", "0.3,0"];

fn five<'a>(more: &[&'a str]) -> Vec<&'a str> {
    FIVE.iter().chain(more).copied().collect()
}

fn nine<'a>(command: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    std::iter::once(command).chain(NINE).chain(more.iter().copied()).collect()
}

#[test]
fn text_says_how_many_and_whether_these_are_all() {
    let run = solved(&FIVE);
    assert!(run.out.starts_with("silicone: 5 equilibria, 3 of them stable\ncomplete: the curve of equilibria was followed all the way around\n(tip at "), "{}", run.out);
    let words = |word: &str| run.out.lines().skip(1).filter(|line| line.ends_with(word)).count();
    assert_eq!((words(" stable"), words("unstable (1)")), (3, 2));
    assert_eq!(run.err, "");
    let run = solved(&["equilibria", "octopus"]);
    assert!(run.out.starts_with("octopus: 1 equilibrium, 1 of them stable\n"), "{}", run.out);
}

#[test]
fn csv_and_json_are_sorted_by_the_angle_of_the_tip() {
    let run = solved(&five(&["--format", "csv"]));
    let (names, rows) = columns(&run.out);
    let expected = "number,tip_x_m,tip_y_m,tip_theta_rad,tip_alpha_rad,stroke_0_m,tension_0_N,stroke_1_m,tension_1_N,\
                    stability,unstable_directions,error_estimate_m";
    assert_eq!(names.join(","), expected);
    let angles: Vec<f64> = rows.iter().map(|row| row[3].parse().unwrap()).collect();
    assert!(angles.len() == 5 && angles.is_sorted(), "{angles:?}");
    let states: Vec<&str> = rows.iter().map(|row| row[9]).collect();
    assert_eq!(states, ["stable", "unstable", "stable", "unstable", "stable"]);

    let document = json(&solved(&five(&["--format", "json"])).out);
    assert_eq!((&document["schema"], &document["complete"]), (&Value::from(1), &Value::from(true)));
    assert_eq!(document["equilibria"].as_array().unwrap().len(), 5);
    assert_eq!(document["equilibria"][1]["stability"], serde_json::json!({ "state": "unstable", "directions": 1 }));
    assert_eq!(document["inputs"]["flow"]["direction"], 180.0);
    let covered = document["tip_angles"].as_array().unwrap();
    assert!(covered[1].as_f64().unwrap() - covered[0].as_f64().unwrap() > std::f64::consts::TAU - 1e-9);
}

#[test]
fn a_search_that_is_given_up_says_what_it_covered() {
    let run = solved(&five(&["--time-limit", "1e-6", "--format", "json"]));
    let part = json(&run.out);
    assert_eq!((&part["complete"], &part["ends"][1]["kind"]), (&Value::from(false), &Value::from("stopped")));
    let covered = part["tip_angles"].as_array().unwrap();
    assert!(covered[1].as_f64().unwrap() > covered[0].as_f64().unwrap());
    assert!(!part["equilibria"].as_array().unwrap().is_empty());
    let text = solved(&five(&["--time-limit", "1e-6"])).out;
    assert!(text.contains("not complete") && text.contains("the search was stopped"), "{text}");
    let refused = refused(&five(&["--time-limit", "0"]));
    assert!(refused.contains("--time-limit") && refused.contains("seconds above 0"), "{refused}");
}

#[test]
fn shapes_are_drawn_and_numbered() {
    let directory = directory();
    let here = directory.path();
    assert_eq!(hydrostat_in(here, &five(&["--plot", "all.svg"])).code, 0);
    assert_eq!(hydrostat_in(here, &five(&["--plot", "all.png"])).code, 0);
    let svg = std::fs::read_to_string(here.join("all.svg")).unwrap();
    for words in ["1", "5", "stable", "unstable", "stream 0.2 m/s", "y (mm)"] {
        assert!(svg.contains(&format!("aria-label=\"{words}\"")), "{words}");
    }
    assert!(!svg.contains("NaN"));
    let (width, height) = picture(&std::fs::read(here.join("all.png")).unwrap());
    assert!(width > 1500 && height > 1000, "{width} x {height}");
}

#[test]
fn over_a_range_each_value_has_its_own() {
    let directory = directory();
    let here = directory.path();
    let over = ["equilibria", "silicone", "--set", "flow.direction=180", "--over", "flow.speed=10 cm/s:20 cm/s:3"];
    let with = |more: &[&str]| {
        let args: Vec<&str> = over.iter().chain(more).copied().collect();
        let run = hydrostat_in(here, &args);
        assert_eq!(run.code, 0, "{}", run.err);
        run.out
    };
    let text = with(&["--plot-over", "over.svg"]);
    let counts: Vec<Vec<&str>> = text.lines().skip(3).map(|l| l.split_whitespace().collect()).collect();
    assert_eq!(counts, [["10", "1", "1", "complete"], ["15", "5", "3", "complete"], ["20", "5", "3", "complete"]]);
    let csv = with(&["--format", "csv", "--plot-over", "over.png", "--quantity", "stroke[0]"]);
    let (names, rows) = columns(&csv);
    assert_eq!(names[..4], ["flow_speed_m_s", "complete", "number", "tip_x_m"]);
    let keys: Vec<[&str; 3]> = rows.iter().map(|row| [row[0], row[1], row[2]]).collect();
    assert_eq!((keys[0], keys[5], keys.len()), (["0.1", "true", "1"], ["0.15", "true", "5"], 11));
    let document = json(&with(&["--format", "json"]));
    assert_eq!((&document["parameter"], &document["unit"]), (&Value::from("flow.speed"), &Value::from("m/s")));
    let values = document["values"].as_array().unwrap();
    assert_eq!(values[2]["equilibria"].as_array().unwrap().len(), 5);
    assert_eq!((&values[2]["complete"], &values[2]["message"]), (&Value::from(true), &Value::Null));
    let svg = std::fs::read_to_string(here.join("over.svg")).unwrap();
    for words in ["stable", "unstable", "flow.speed (cm/s)", "y(L) (mm)"] {
        assert!(svg.contains(&format!("aria-label=\"{words}\"")), "{words}");
    }
    picture(&std::fs::read(here.join("over.png")).unwrap());
}

#[test]
fn wrong_requests_are_refused() {
    let over = |text: &str| refused(&["equilibria", "paper", "--over", text]);
    assert!(over("flow.sped=0:1:5").contains("did you mean `flow.speed`?"));
    assert!(over("flow.speed=0:1").contains("KEY=FROM:TO:COUNT"));
    assert!(over("flow.speed=0:1:1").contains("a whole number from 2"));
    assert!(over("flow.speed=0:1 N:5").contains("expected a speed"));
    assert!(over("cable[2].tension=0:1:5").contains("the arm has 2 cables"));
    assert!(over("cable[0].tension=0:200:3").contains("max_tension of 100 N"));
    assert!(refused(&["equilibria", "paper", "--tol", "1"]).contains("--tol: expected a number in [1e-12, 1e-3]"));
    refused(&["equilibria", "paper", "--plot-over", "over.svg"]);
    refused(&["equilibria", "paper", "--plot", "a.svg", "--over", "flow.speed=0:1:2"]);
    assert!(refused(&["equilibria", "paper", "-o", "a.svg", "--plot", "a.svg"]).contains("-o and --plot both name"));
    assert!(refused(&["equilibria", "paper", "--set", "model.support=unstrained-base"]).contains("initial-value"));
}

#[test]
fn no_equilibrium_is_a_verdict() {
    let directory = directory();
    // Classical rods have no volume to keep: 40 N crush the tip however the base is held.
    let args = ["equilibria", "paper", "--set", "model.volume=none", "-o", "all.txt", "--plot", "all.svg"];
    let run = hydrostat_in(directory.path(), &args);
    assert_eq!((run.code, run.out.as_str()), (3, ""));
    assert!(run.err.starts_with("error: no equilibrium was found at any base angle; "), "{}", run.err);
    assert!(run.err.contains("\ntry: "), "{}", run.err);
    assert!(files(directory.path()).is_empty());
    let over = ["equilibria", "paper", "--set", "model.volume=none", "--over", "cable[0].tension=30:40:2"];
    let run = hydrostat(&over);
    assert_eq!(run.code, 3);
    assert!(run.err.contains("warning: at 30 N: ") && run.err.contains("error: no equilibrium was found at any value"));
}

#[test]
fn a_solve_that_ends_in_a_limit_point_says_what_else_there_is() {
    let run = hydrostat(&nine("solve", &["--format", "json"]));
    assert_eq!(run.code, 3);
    let line = "note: 9 other equilibria exist at these loads, 2 of them stable: see `hydrostat equilibria`\n";
    assert!(run.err.contains(line), "{}", run.err);
    let others = &json(&run.out)["verdict"]["other_equilibria"];
    assert_eq!(*others, serde_json::json!({ "count": 9, "stable": 2, "complete": true }));
    let listed = solved(&nine("equilibria", &[])).out;
    assert!(listed.starts_with("silicone: 9 equilibria, 2 of them stable\n"), "{listed}");
    // Another limit is none that the arm can snap over.
    let run = hydrostat(&["solve", "silicone", "--tension", "1.4,0", "--format", "json"]);
    assert_eq!((run.code, run.err.contains("note:")), (3, false));
    assert_eq!(json(&run.out)["verdict"]["other_equilibria"], Value::Null);
}
