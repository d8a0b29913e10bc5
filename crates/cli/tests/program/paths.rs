//! `hydrostat path`.

use std::f64::consts::{FRAC_PI_2, PI};

use serde_json::Value;

use super::{columns, directory, files, hydrostat, hydrostat_in, json, picture, refused, solved};

/// An arm that lies down the stream and is turned to face it and past it: it snaps twice.
const TURNED: [&str; 7] =
    ["path", "silicone", "--flow-speed", "0.2", "--set", "flow.direction=180", "--vary=arm.base.angle=90 deg:-90 deg"];

fn turned<'a>(more: &[&'a str]) -> Vec<&'a str> {
    TURNED.iter().chain(more).copied().collect()
}

#[test]
fn text_has_ends_events_and_a_summary() {
    let run = solved(&["path", "paper", "--vary", "cable[0].tension=0:100"]);
    assert!(run.out.starts_with("path   paper, cable[0].tension from 0 N to 100 N\n"), "{}", run.out);
    assert_eq!(run.out.lines().filter(|l| l.ends_with("start") || l.ends_with("end")).count(), 2);
    assert!(
        run.out
            .contains("no limit points, no bifurcations; stable throughout; the end of the range was reached, 100 N")
    );
    assert_eq!(run.err, "");

    let run = solved(&turned(&[]));
    assert_eq!(run.out.lines().filter(|l| l.ends_with("limit point")).count(), 4, "{}", run.out);
    assert!(run.out.contains("4 limit points") && run.out.contains("stable in part"), "{}", run.out);
    assert!(run.out.lines().all(|line| line.chars().count() <= 120));
}

#[test]
fn csv_has_a_row_a_point_in_si_units() {
    let run = solved(&turned(&["--format", "csv"]));
    let (names, rows) = columns(&run.out);
    let expected = "branch,arm_base_angle_rad,tip_x_m,tip_y_m,tip_theta_rad,tip_alpha_rad,stroke_0_m,tension_0_N,\
                    stroke_1_m,tension_1_N,stability,unstable_directions,event,error_estimate_m";
    assert_eq!(names.join(","), expected);
    let first = rows.first().unwrap();
    assert_eq!((first[0], first[1].parse()), ("0", Ok(FRAC_PI_2)));
    assert_eq!(rows.last().unwrap()[1].parse(), Ok(-FRAC_PI_2));
    let events: Vec<_> = rows.iter().filter(|row| row[12] == "limit_point").collect();
    assert_eq!(events.len(), 4);
    assert!(events.iter().all(|row| row[10] == "marginal" && row[11].is_empty()));
    let count = |word: &str, directions: &str| rows.iter().filter(|r| r[10] == word && r[11] == directions).count();
    assert!(count("stable", "0") > 20 && count("unstable", "1") > 5);
    assert_eq!(count("stable", "0") + count("unstable", "1") + 4, rows.len());
}

#[test]
fn json_holds_every_point_in_si_units() {
    let run = solved(&turned(&["--format", "json"]));
    let document = json(&run.out);
    assert_eq!((&document["schema"], &document["unit"]), (&Value::from(1), &Value::from("rad")));
    assert_eq!(document["parameter"], "arm.base.angle");
    assert_eq!(document["range"], Value::from(vec![FRAC_PI_2, -FRAC_PI_2]));
    assert_eq!(document["inputs"]["arm"]["base"]["angle"], 90.0);
    let branch = &document["branches"][0];
    assert_eq!((&branch["switched_at"], &branch["end"]["kind"]), (&Value::Null, &Value::from("reached_end")));
    let points = branch["points"].as_array().unwrap();
    assert_eq!(points[0]["value"], FRAC_PI_2);
    for point in points {
        assert!(point["tip"]["alpha"].is_f64() && point["error_estimate"].is_f64());
        assert_eq!(point["cables"][1]["name"], "right");
    }
    let event = points.iter().find(|p| p["event"] == "limit_point").unwrap();
    assert_eq!((&event["stability"]["state"], &event["stability"]["directions"]), (&"marginal".into(), &Value::Null));
    assert_eq!(
        (&points[0]["stability"]["state"], &points[0]["stability"]["directions"]),
        (&"stable".into(), &0.into())
    );
}

#[test]
fn bifurcations_are_switched_at_when_asked() {
    let args = ["path", "silicone", "--vary", "tip.force[0]=0:-15 mN", "--format", "json"];
    let branches = |more: &[&str]| {
        let args: Vec<&str> = args.iter().chain(more).copied().collect();
        json(&solved(&args).out)["branches"].as_array().unwrap().clone()
    };
    assert_eq!(branches(&[]).len(), 1);
    let all = branches(&["--branches"]);
    assert_eq!(all.len(), 3);
    // C3 I of a cone: between the loads of columns as wide as its tip and its base.
    let at = all[1]["switched_at"].as_f64().unwrap();
    assert!((-0.0039..-0.0037).contains(&at), "{at}");
    let tip = |branch: usize| all[branch]["points"].as_array().unwrap().last().unwrap()["tip"]["y"].as_f64().unwrap();
    assert!(tip(1) > 0.1 && (tip(1) + tip(2)).abs() < 1e-6 && tip(0).abs() < 1e-9);
    let text = solved(&["path", "silicone", "--vary", "tip.force[0]=0:-15 mN", "--branches"]).out;
    assert!(text.contains("branch 2, from the bifurcation at -3.7976 mN"), "{text}");
}

#[test]
fn units_are_those_of_the_user() {
    let end = |vary: &str| {
        let run = solved(&["path", "silicone", "--vary", vary]);
        run.out.lines().rev().nth(1).unwrap().split_whitespace().next().unwrap().to_owned()
    };
    assert_eq!(end("cable[0].tension=0 N:0.3 N"), "0.3");
    assert_eq!(end("cable[0].tension=0:300 mN"), "300");
    assert_eq!(end("flow.direction=0:180"), "180");
    assert_eq!(end("flow.direction=0:3 rad"), "3");
    assert_eq!(end("material.poisson=0.3:0.5"), "0.5");
}

#[test]
fn a_limit_inside_the_range_ends_the_path_and_keeps_what_was_found() {
    let directory = directory();
    let here = directory.path();
    let args = ["path", "silicone", "--vary", "cable[0].tension=0:1.4", "--format", "json", "-o", "path.json"];
    let drawn: Vec<&str> = args.into_iter().chain(["--plot", "path.svg", "--plot-shapes", "shapes.svg"]).collect();
    let run = hydrostat_in(here, &drawn);
    assert_eq!((run.code, run.out.as_str()), (3, ""));
    assert!(run.err.starts_with("error: the path ends inside the range: a cable compresses its side"), "{}", run.err);
    assert!(run.err.contains("at cable[0].tension = 0.943"), "{}", run.err);
    assert_eq!(files(here), ["path.json", "path.svg", "shapes.svg"]);
    let document = json(&std::fs::read_to_string(here.join("path.json")).unwrap());
    let end = &document["branches"][0]["end"];
    assert_eq!(end["kind"], "cable_fold");
    assert!(end["s"].as_f64().unwrap() > 0.2 && run.err.contains(end["message"].as_str().unwrap()));
    let last = document["branches"][0]["points"].as_array().unwrap().last().unwrap();
    assert!((last["value"].as_f64().unwrap() - 0.943).abs() < 1e-3);
    assert!(std::fs::read_to_string(here.join("path.svg")).unwrap().contains("no equilibrium found beyond"));
}

#[test]
fn other_ends_are_no_failure_but_said() {
    let run = solved(&turned(&["--max-points", "10"]));
    assert!(run.out.contains("\n10 points"), "{}", run.out);
    assert!(run.err.starts_with("note: the path ends: the largest number of points was reached at arm.base.angle = "));
    assert!(run.err.ends_with("; raise it with --max-points\n"), "{}", run.err);
    // From the limit point the path goes back to where it came from, on another branch.
    let run = solved(&[
        "path",
        "silicone",
        "--flow-speed",
        "0.2",
        "--set",
        "flow.direction=180",
        "--vary",
        "arm.base.angle=0:20",
    ]);
    assert!(run.err.contains("note: the path ends: the path returned to the start of the range, 0 deg"), "{}", run.err);
}

#[test]
fn a_start_without_equilibrium_is_a_verdict() {
    let directory = directory();
    let run = hydrostat_in(
        directory.path(),
        &[
            "path",
            "silicone",
            "--flow-speed",
            "0.5",
            "--tension",
            "0.3,0",
            "--vary",
            "flow.direction=180:170",
            "-o",
            "path.txt",
        ],
    );
    assert_eq!((run.code, run.out.as_str()), (3, ""));
    let message = "error: no equilibrium at the start of the path, flow.direction = 180 deg: the equilibrium ends in a limit point";
    assert!(run.err.starts_with(message), "{}", run.err);
    assert!(run.err.contains("\ntry: "), "{}", run.err);
    assert!(files(directory.path()).is_empty());
}

#[test]
fn what_cannot_vary_is_refused() {
    let vary = |text: &str| refused(&["path", "paper", "--vary", text]);
    assert!(vary("cabel[0].tension=0:1").contains("did you mean `cable[0].tension`?"));
    assert!(
        vary("arm.inner_radius=0.001:0.002").contains("keys that can: cable[0].tension, cable[0].stroke, flow.speed")
    );
    assert!(vary("cable[9].tension=0:1").contains("`cable[9].tension`: the arm has 2 cables, counted from 0"));
    assert!(vary("material.young=1e5:1e6").contains("the arm gives c1, c2 and c3"));
    assert!(vary("cable[0].tension=0").contains("expected KEY=FROM:TO"));
    assert!(vary("cable[0].tension=0:1 m").contains("expected a force"));
    assert!(vary("cable[0].tension=1:1").contains("two different ends"));
    assert!(vary("cable[0].tension=0:101").contains("max_tension of 100 N"));
    assert!(vary("cable[0].tension=-1:10").contains("--vary cable[0].tension = -1 N: "));
    assert!(vary("flow.speed=-1:1").contains("negative"));
    refused(&["path", "paper"]);
    refused(&["path", "papr", "--vary", "flow.speed=0:1"]);
}

#[test]
fn options_out_of_range_are_refused() {
    let with = |more: &[&str]| {
        let args: Vec<&str> = ["path", "paper", "--vary", "flow.speed=0:1"].iter().chain(more).copied().collect();
        refused(&args)
    };
    assert!(with(&["--tol", "1"]).contains("--tol: expected a number in [1e-7, 1e-3], found 1"));
    assert!(with(&["--max-step", "9"]).contains("--max-step: expected a number in [0.001, 0.4]"));
    assert!(with(&["--max-points", "1"]).contains("a whole number from 2"));
    assert!(with(&["--quantity", "tip.z"]).contains("tip.x, tip.y, tip.theta, tip.alpha"));
    assert!(with(&["--quantity", "stroke[2]"]).contains("the arm has 2 cables"));
    assert!(with(&["--plot", "a.jpg"]).contains(".svg, .pdf or .png"));
    assert!(with(&["--plot", "a.svg", "--plot-shapes", "a.svg"]).contains("--plot and --plot-shapes both name a.svg"));
    assert!(with(&["-o", "nowhere/a.csv"]).contains("cannot write nowhere/a.csv"));
    let literal = ["--set", "model.support=unstrained-base"];
    assert!(with(&literal).contains("initial-value problem"));
}

#[test]
fn pictures_show_the_path() {
    let directory = directory();
    let here = directory.path();
    let plots = ["--plot", "path.svg", "--plot-shapes", "shapes.svg", "--quantity", "tip.theta"];
    assert_eq!(hydrostat_in(here, &turned(&plots)).code, 0);
    let read = |name: &str| std::fs::read_to_string(here.join(name)).unwrap();
    let path = read("path.svg");
    for words in ["stable", "unstable", "limit point", "arm.base.angle (°)", "θ(L) (°)", "8.236°"] {
        assert!(path.contains(&format!("aria-label=\"{words}\"")), "{words}");
    }
    assert!(path.contains("stroke-dasharray") && !path.contains("NaN"));
    let shapes = read("shapes.svg");
    for words in ["stable", "unstable", "limit point", "stream 0.2 m/s", "90°", "\u{2212}90°", "8.236°", "x (mm)"] {
        assert!(shapes.contains(&format!("aria-label=\"{words}\"")), "{words}");
    }
    assert!(shapes.contains("stroke-dasharray") && !shapes.contains("NaN"));
    assert_eq!(hydrostat_in(here, &turned(&["--plot", "path.png", "--plot-shapes", "shapes.png"])).code, 0);
    for name in ["path.png", "shapes.png"] {
        let (width, height) = picture(&std::fs::read(here.join(name)).unwrap());
        assert!(width > 1500 && height > 1000, "{width} x {height}");
    }
}

#[test]
fn a_cable_gives_way_as_it_is_pulled() {
    let run = hydrostat(&[
        "path",
        "silicone",
        "--vary",
        "flow.direction=0:180 deg",
        "--flow-speed",
        "0.1",
        "--format",
        "csv",
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    let (names, rows) = columns(&run.out);
    assert_eq!(names[1], "flow_direction_rad");
    assert_eq!(rows.last().unwrap()[1].parse(), Ok(PI));
}
