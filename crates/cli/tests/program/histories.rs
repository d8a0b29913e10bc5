//! Shapes after snaps, loads that rise and fall, and pictures of motion.

use super::{columns, directory, files, hydrostat_in, json, picture, refused, solved};

const AGAINST: [&str; 6] =
    ["silicone", "--flow-speed", "0.4", "--set", "flow.direction=172", "--set=dynamics.relaxation_time=2.7 ms"];

fn against<'a>(command: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&[command], &AGAINST[..], more].concat()
}

#[test]
fn a_solve_after_its_snap_says_where_how_far_and_how_long() {
    let run = solved(&against("solve", &["--after-snap", "--format", "json"]));
    let document = json(&run.out);
    assert!(run.err.contains("it rests after 5.478 s, on the curve of equilibria"), "{}", run.err);
    assert_eq!(document["stable"], true);
    let snap = &document["snaps"][0];
    assert_eq!(snap["phase"], "loads");
    assert_eq!(snap["lands_elsewhere"], false);
    assert!((snap["duration"].as_f64().unwrap() - 5.478).abs() < 0.02, "{snap}");
    assert!((snap["load_fraction"].as_f64().unwrap() - 0.6402).abs() < 1e-3, "{snap}");
    // Without it the fields are not there.
    let follows = json(&solved(&against("solve", &["--follow-snaps", "--format", "json"])).out);
    assert!(follows["snaps"][0].get("duration").is_none());
    let off = follows["tip"]["theta"].as_f64().unwrap() - document["tip"]["theta"].as_f64().unwrap();
    assert!(off.abs() < 1e-6, "{off}");
}

#[test]
fn snaps_that_cannot_be_followed_are_refused_by_name() {
    let err = refused(&against("solve", &["--after-snap", "--set", "cable[0].friction=0.1"]));
    assert!(err.contains("the arm snaps at") && err.contains("`cable[0].friction`"), "{err}");
    let err = refused(&against("solve", &["--after-snap", "--follow-snaps"]));
    assert!(err.contains("--follow-snaps"), "{err}");
}

#[test]
fn a_snap_in_space_says_how_far_and_how_long() {
    let run = solved(&against("solve", &["--set", "arm.space=spatial", "--after-snap", "--format", "json"]));
    assert!(run.err.contains("the arm snaps at") && run.err.contains("it rests after"), "{}", run.err);
    let document = json(&run.out);
    let snap = &document["snaps"][0];
    assert!((snap["load_fraction"].as_f64().unwrap() - 0.6402).abs() < 2e-3, "{snap}");
    assert!((snap["distance"].as_f64().unwrap() - 0.372).abs() < 2e-3, "{snap}");
    assert!((snap["duration"].as_f64().unwrap() - 5.478).abs() < 0.05, "{snap}");
    assert_eq!(document["stable"], true);
}

/// A row in space kept its verdict, whatever was asked for.
#[test]
fn rows_of_a_sweep_have_the_shape_after_a_snap_in_the_plane_and_in_space() {
    let directory = directory();
    let mut tips = Vec::new();
    for space in ["planar", "spatial"] {
        let (key, file) = (format!("arm.space={space}"), format!("{space}.csv"));
        let more = [
            "--after-snap",
            "--tol",
            "1e-8",
            "--columns",
            "tip,snaps",
            "--vary",
            "flow.speed=0.4",
            "--set",
            &key,
            "-o",
            &file,
        ];
        let swept = hydrostat_in(directory.path(), &against("sweep", &more));
        assert_eq!(swept.code, 0, "{}", swept.err);
        let table = std::fs::read_to_string(directory.path().join(&file)).unwrap();
        let (names, rows) = columns(&table);
        let at = |name: &str| {
            let column = names.iter().position(|n| *n == name).unwrap_or_else(|| panic!("{name}: {names:?}"));
            rows[0][column].parse::<f64>().unwrap_or_else(|_| panic!("{name}: {table}"))
        };
        assert!((at("snap_duration_s") - 5.478).abs() < 0.05, "{table}");
        tips.push([at("tip_x_m"), at("tip_y_m")]);
    }
    assert!((0..2).all(|k| (tips[0][k] - tips[1][k]).abs() < 1e-7), "{tips:?}");
}

#[test]
fn a_path_says_where_the_arm_rests_past_its_limit_points() {
    let stream = ["path", "silicone", "--flow-speed", "0.2", "--set", "flow.direction=180"];
    let range = ["--vary", "arm.base.angle=60:-60", "--after-snap"];
    let text = solved(&[&stream[..], &range].concat()).out;
    assert!(text.contains("\npast the limit point at -29.643 deg: the arm rests after "), "{text}");
    let csv = solved(&[&stream[..], &range, &["--format", "csv"]].concat()).out;
    let (names, rows) = columns(&csv);
    let at = |name: &str| names.iter().position(|own| *own == name).unwrap();
    let rests: Vec<_> = rows.iter().filter(|row| !row[at("after_snap_s")].is_empty()).collect();
    assert!(!rests.is_empty() && rests.iter().all(|row| row[at("event")] == "limit_point"));
    let document = json(&solved(&[&stream[..], &range, &["--format", "json"]].concat()).out);
    let points = document["branches"][0]["points"].as_array().unwrap();
    let known: Vec<_> = points.iter().filter_map(|point| point.get("after_snap")).collect();
    assert_eq!(known.len(), rests.len());
    assert!(known.iter().all(|after| after["duration"].as_f64().unwrap() > 1.0), "{known:?}");
}

#[test]
fn a_path_in_space_says_where_the_arm_rests_too() {
    let stream =
        ["path", "silicone", "--flow-speed", "0.2", "--set", "flow.direction=180", "--set", "arm.space=spatial"];
    let range = ["--set", "dynamics.relaxation_time=2.7ms", "--vary", "arm.base.angle=60:-60", "--after-snap"];
    let text = solved(&[&stream[..], &range].concat()).out;
    assert!(text.contains("the arm rests after ") || text.contains("does not come to rest"), "{text}");
    let csv = solved(&[&stream[..], &range, &["--format", "csv"]].concat()).out;
    let (names, _) = columns(&csv);
    assert!(names.contains(&"after_snap_z_m") && names.contains(&"after_snap_s"), "{names:?}");
}

#[test]
fn a_history_in_space_is_that_in_the_plane() {
    let place = directory();
    std::fs::write(place.path().join("turns.csv"), TURNS).unwrap();
    let stream = ["history", "silicone", "--flow-speed", "0.2", "--set", "flow.direction=180", "--input", "turns.csv"];
    let more = ["--set", "arm.space=spatial", "--set", "dynamics.relaxation_time=2.7ms", "--plot", "loading.svg"];
    let run = hydrostat_in(place.path(), &[&stream[..], &more, &["--format", "csv", "--quantity", "tip.y"]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let (names, rows) = columns(&run.out);
    let at = |name: &str| names.iter().position(|own| *own == name).unwrap();
    assert_eq!(rows.iter().map(|row| row[at("snaps")]).collect::<Vec<_>>(), ["0", "0", "1", "0", "1"]);
    assert!(names.contains(&"snap_z_m") && names.contains(&"tip_z_m"), "{names:?}");
    let run = hydrostat_in(place.path(), &[&stream[..], &more, &["--format", "json"]].concat());
    let document = json(&run.out);
    let snap = &document["rows"][2]["snaps"][0];
    assert!((snap["loads"][0].as_f64().unwrap() + 29.643).abs() < 1e-2, "{snap}");
    assert!(snap["after"]["z"].as_f64().unwrap().abs() < 1e-6, "{snap}");
    assert!(hydrostat_in(place.path(), &[&stream[..], &more].concat()).out.contains("z (mm)"));
}

const TURNS: &str = "arm.base.angle\n40\n0\n-40\n0\n40\n";

#[test]
fn a_history_has_its_rows_snaps_and_diagram() {
    let place = directory();
    std::fs::write(place.path().join("turns.csv"), TURNS).unwrap();
    let stream = ["history", "silicone", "--flow-speed", "0.2", "--set", "flow.direction=180", "--input", "turns.csv"];
    let run = hydrostat_in(place.path(), &[&stream[..], &["--format", "csv", "--plot", "loading.svg"]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let drawn = std::fs::read_to_string(place.path().join("loading.svg")).unwrap();
    assert!(drawn.contains("<svg") && drawn.contains("up and down"), "{drawn:.300}");
    let (names, rows) = columns(&run.out);
    let at = |name: &str| names.iter().position(|own| *own == name).unwrap();
    let snaps: Vec<&str> = rows.iter().map(|row| row[at("snaps")]).collect();
    assert_eq!(snaps, ["0", "0", "1", "0", "1"]);
    let run = hydrostat_in(place.path(), &[&stream[..], &["--format", "json"]].concat());
    let document = json(&run.out);
    let load = document["rows"][2]["snaps"][0]["loads"][0].as_f64().unwrap();
    assert!((load + 29.643).abs() < 1e-2, "{load}");
    assert_eq!(document["complete"], true);
}

#[test]
fn a_history_that_ends_early_keeps_the_rows_before_and_names_the_line() {
    let place = directory();
    let write = |text: &str| std::fs::write(place.path().join("loads.csv"), text).unwrap();
    let history = |more: &[&str]| {
        let command = ["history", "silicone", "--input", "loads.csv", "--format", "csv"];
        hydrostat_in(place.path(), &[&command[..], more].concat())
    };
    write("t_s,cable[0].tension\n0,0\n1,0.2\n2,1.4\n");
    let run = history(&[]);
    assert_eq!(run.code, 3, "{}", run.err);
    assert!(run.err.contains("row 3 (line 4)") && run.err.contains("to zero length"), "{}", run.err);
    assert_eq!(run.out.lines().count(), 3);
    for (text, words) in [
        ("cable[0].tenson\n0\n", "did you mean `cable[0].tension`"),
        ("cable[0].tension\nmuch\n", "loads.csv:2: column 1"),
        ("cable[0].tension,flow.speed\n1\n", "loads.csv:2: expected 2 cells"),
        ("cable[0].tension\n-1\n", "loads.csv:2"),
        ("t_s\n1\n", "expected a header"),
    ] {
        write(text);
        let run = history(&[]);
        assert_eq!((run.code, run.out.as_str()), (2, ""), "{text}: {}", run.err);
        assert!(run.err.contains(words), "{text}: {}", run.err);
    }
    write(TURNS);
    let run = history(&["--over", "flow.speed", "--plot", "a.svg"]);
    assert_eq!(run.code, 2);
    assert!(run.err.contains("--over flow.speed: expected one of arm.base.angle"), "{}", run.err);
    assert_eq!(files(place.path()), ["loads.csv"], "nothing half written");
}

#[test]
fn a_motion_is_drawn() {
    let place = directory();
    let command = ["simulate", "silicone", "--vary", "cable[0].tension=ramp:0:0.1:0:0.1", "--until", "0.2"];
    let pictures = ["--plot", "strobe.svg", "--plot-time", "motion.png", "--tol", "1e-3"];
    let run = hydrostat_in(place.path(), &[&command[..], &pictures].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    picture(&std::fs::read(place.path().join("motion.png")).unwrap());
    assert!(std::fs::read_to_string(place.path().join("strobe.svg")).unwrap().contains("<svg"));
}
