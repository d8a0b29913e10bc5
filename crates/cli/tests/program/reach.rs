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
    let target = format!("{} mm,{y} m", 1e3 * x);
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
        run.err.starts_with("error: the target is not reached: the closest shape that was found is "),
        "{}",
        run.err
    );
    assert!(run.err.contains("is slack and cannot push"), "{}", run.err);
    let document = json(&run.out);
    assert_eq!((&document["reached"], &document["solutions"]), (&Value::from(false), &serde_json::json!([])));
    assert_eq!(document["closest"]["bounds"][0]["kind"], "slack");
}

/// Table, JSON and CSV gave the tip alone, which read as a place 20 mm off its target.
#[test]
fn the_place_asked_for_was_not_said() {
    let solve =
        ["solve", "silicone", "--tension", "0.3,0.1", "--flow-speed", "0.05", "--stations", "50", "--format", "json"];
    let middle = json(&solved(&solve).out)["stations"].clone();
    let [s, wanted_x, wanted_y] = ["s", "x", "y"].map(|key| middle[key][30].as_f64().unwrap());
    assert!((s - 0.15).abs() < 1e-12);
    let target = format!("{wanted_x:?},{wanted_y:?}");
    let args = reach(&target, &["--station", "150 mm"]);
    let document = json(&solved(&[&args[..], &["--format", "json"]].concat()).out);
    let best = &document["solutions"][0];
    let place = |key: &str| best["places"][0][key].as_f64().unwrap();
    assert_eq!(place("s"), 0.15);
    assert!((place("x") - wanted_x).hypot(place("y") - wanted_y) < 1e-8 * 0.245, "{best}");
    // The tip is where a solve at these tensions has it, and further than the place.
    let tension = |c: usize| best["cables"][c]["tension"].as_f64().unwrap();
    let [x, y] = tip(&format!("{:?},{:?}", tension(0), tension(1)));
    assert!((best["tip"]["x"].as_f64().unwrap() - x).hypot(best["tip"]["y"].as_f64().unwrap() - y) < 1e-7, "{best}");
    assert!((x - wanted_x).hypot(y - wanted_y) > 0.02, "{x}, {y}");

    let text = solved(&[&args[..], &["--format", "csv"]].concat()).out;
    let (names, rows) = columns(&text);
    assert_eq!(names[4..9], ["s_m", "x_m", "y_m", "theta_rad", "alpha_rad"].map(|name| format!("place_0_{name}")));
    assert_eq!((rows[0].len(), rows[0][4], names[9]), (names.len(), "0.15", "tip_x_m"));
    assert!((rows[0][5].parse::<f64>().unwrap() - wanted_x).abs() < 1e-8, "{text}");

    let run = solved(&args);
    assert!(run.out.starts_with("silicone: 1 solution for the station at s = 150 mm\n"), "{}", run.out);
    let head = run.out.lines().nth(2).unwrap();
    for name in ["place x (mm)", "place alpha (deg)", "tip x (mm)", "tip turned (deg)"] {
        assert!(head.contains(name), "{head}");
    }
    let cells: Vec<&str> = run.out.lines().nth(3).unwrap().split_whitespace().collect();
    assert_eq!(cells[3..5], [1e3 * wanted_x, 1e3 * wanted_y].map(|mm| format!("{mm:.3}")), "{}", run.out);
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

/// A target of 182 m for an arm of 245 mm was "off by 197779 mm", and the angle that the table prints was "not reached".
#[test]
fn what_to_try_was_not_said() {
    let advice = |args: &[&str]| {
        let run = hydrostat(args);
        assert_eq!(run.code, 3, "{}", run.err);
        run.err.lines().find_map(|line| line.strip_prefix("try: ")).unwrap_or_default().to_owned()
    };
    let far = advice(&reach("182,78", &[]));
    assert!(
        far.starts_with("if you mean millimetres, write \"182 mm,78 mm\"") && far.contains("(182, 78) m is 808."),
        "{far}"
    );
    assert_eq!(advice(&reach("0.3,0", &[])), "", "a little too far is no slip of units");
    let rounded = ["reach", "silicone", "--target", "0.182,0.078", "--angle", "161.665", "--max-tension", "0.6"];
    let near = advice(&rounded);
    assert!(near.starts_with("--tol 1e-") && near.contains("one radian counts as one length"), "{near}");
    let tol = near.split(':').next().unwrap().strip_prefix("--tol ").unwrap();
    solved(&[&rounded[..], &["--tol", tol]].concat());
    let base = hydrostat(&reach("0.1,0", &["--station", "0"]));
    assert!(base.err.trim_end().ends_with("; the base cannot move"), "{}", base.err);

    let here = directory();
    std::fs::write(here.path().join("far.csv"), "x_m,y_m\n0.24,0.01\n182,78\n").unwrap();
    let run = hydrostat_in(here.path(), &along("far.csv", &[]));
    assert!(
        run.err.contains("\ntry: if you mean millimetres, write \"182 mm,78 mm\", in a file the heads x_mm,y_mm"),
        "{}",
        run.err
    );
}

/// Four of them ended with status 3, and nothing said so.
#[test]
fn examples_of_the_help_were_not_reached() {
    let here = directory();
    let help = solved(&["reach", "--help"]).out;
    let examples: Vec<&str> =
        help.lines().filter(|line| line.starts_with("  hydrostat reach") && line.contains("--target")).collect();
    assert_eq!(examples.len(), 7, "{help}");
    for line in examples {
        let (line, said) = line.trim().split_once("    not reached").map_or((line.trim(), 0), |(line, _)| (line, 3));
        let words = super::guide::words(line);
        let run = hydrostat_in(here.path(), &words[1..].iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(run.code, said, "{line}: {}", run.err);
    }
}

/// A loop of tips that tensions on a circle lead to, as CSV in mm.
fn path_of_targets(count: u32) -> String {
    let row = |k: u32| {
        let angle = f64::from(k) * std::f64::consts::TAU / f64::from(count);
        let [x, y] = tip(&format!("{},{}", 0.2 + 0.05 * angle.cos(), 0.15 + 0.05 * angle.sin()));
        format!("{:?},{:?}\n", 1e3 * x, 1e3 * y)
    };
    "# tips in mm\nx_mm,y_mm\n".to_owned() + &(0..count).map(row).collect::<String>()
}

fn along<'a>(file: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut args = vec!["reach", "silicone", "--flow-speed", "0.05", "--max-tension", "0.5", "--path", file];
    args.extend(more);
    args
}

#[test]
fn a_path_of_targets_is_followed() {
    let here = directory();
    std::fs::write(here.path().join("loop.csv"), path_of_targets(12)).unwrap();
    let run = hydrostat_in(here.path(), &along("loop.csv", &[]));
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.starts_with("silicone: 12 of 12 targets reached, 0 jumps\n"), "{}", run.out);

    let run = hydrostat_in(here.path(), &along("loop.csv", &["--format", "csv"]));
    let (names, rows) = columns(&run.out);
    let column = |name: &str| names.iter().position(|own| *own == name).unwrap();
    assert_eq!(rows.len(), 12);
    for (k, row) in rows.iter().enumerate() {
        let angle = k as f64 * std::f64::consts::TAU / 12.0;
        let left: f64 = row[column("tension_0_N")].parse().unwrap();
        assert!((left - 0.2 - 0.05 * angle.cos()).abs() < 1e-5, "{k}: {row:?}");
        assert_eq!((row[column("reached")], row[column("jumped")]), ("true", "false"));
    }

    let document = json(&hydrostat_in(here.path(), &along("loop.csv", &["--format", "json"])).out);
    assert_eq!((&document["reached"], &document["jumps"]), (&Value::from(true), &Value::from(0)));
    assert_eq!(document["points"].as_array().unwrap().len(), 12);

    // One that is out of reach: the others are there, and the status says so.
    std::fs::write(here.path().join("far.csv"), path_of_targets(3) + "900,0\n").unwrap();
    let run = hydrostat_in(here.path(), &along("far.csv", &["--format", "csv"]));
    assert_eq!(run.code, 3, "{}", run.err);
    assert!(run.err.contains("1 of 4 targets are not reached, the first is target 4"), "{}", run.err);
    assert_eq!(columns(&run.out).1.len(), 4);
}

#[test]
fn a_path_that_cannot_be_read_says_where() {
    let here = directory();
    for (text, words) in [
        ("x_m,y_m\n0.2,0.05\n0.2\n", "targets.csv:3: expected 2 cells as in the header, found 1"),
        ("x_m,y_ft\n0.2,0.05\n", "found the column \"y_ft\""),
        ("x_m,y_m\n0.2,NaN\n", "targets.csv:2: y_m: expected a finite number, found \"NaN\""),
    ] {
        std::fs::write(here.path().join("targets.csv"), text).unwrap();
        let run = hydrostat_in(here.path(), &along("targets.csv", &[]));
        assert_eq!(run.code, 2, "{}", run.err);
        assert!(run.err.contains(words), "{}", run.err);
    }
    assert!(refused(&along("nowhere.csv", &[])).contains("nowhere.csv: cannot be read"));
    assert!(refused(&reach("0.2,0", &["--path", "targets.csv"])).contains("cannot be used with"));
}

#[test]
fn strokes_are_found_in_place_of_tensions() {
    let [x, y] = tip("0.3,0.1");
    let target = format!("{x},{y}");
    let document = json(&solved(&reach(&target, &["--by", "strokes", "--format", "json"])).out);
    let best = &document["solutions"][0];
    assert_eq!(best["on_the_path"], Value::from(true));
    let strokes: Vec<String> =
        best["cables"].as_array().unwrap().iter().map(|cable| cable["stroke"].to_string()).collect();
    let mut args = vec!["solve".to_owned(), "silicone".to_owned(), "--format=json".to_owned()];
    args.extend(strokes.iter().enumerate().map(|(c, stroke)| format!("--set=cable[{c}].stroke={stroke}")));
    args.push("--flow-speed=0.05".to_owned());
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let again = json(&solved(&args).out);
    let off = |axis: &str, value: f64| (again["tip"][axis].as_f64().unwrap() - value).abs();
    assert!(off("x", x) < 1e-8 && off("y", y) < 1e-8, "{}", again["tip"]);
    assert!(solved(&reach(&target, &["--by", "strokes"])).out.contains("left (mm)"));
}

#[test]
fn a_cable_is_wound_in_no_further_than_it_may_be() {
    let [x, y] = tip("0.3,0.1");
    let target = &format!("{x},{y}");
    let stroke = |document: &Value| document["cables"][0]["stroke"].as_f64().unwrap();
    let free = json(&solved(&reach(target, &["--format", "json"])).out);
    assert!(stroke(&free["solutions"][0]) > 0.015, "{free}");
    let run = hydrostat(&reach(target, &["--max-stroke", "10 mm", "--format", "json"]));
    assert_eq!(run.code, 3, "{}", run.err);
    assert!(run.err.contains("cable left is at its largest stroke"), "{}", run.err);
    let closest = &json(&run.out)["closest"];
    assert!((stroke(closest) - 0.010).abs() < 1e-8, "{closest}");
    assert_eq!(closest["bounds"][0]["kind"], "stroke");
    assert!(refused(&reach(target, &["--max-stroke", "10 N"])).contains("expected a length"));
}

/// The message was "expected a number finite, for every cable, found inf".
#[test]
fn a_boundary_without_largest_tensions_named_no_option() {
    let here = directory();
    let arm = "[arm]\nlength = 0.2\nradius = 0.01\n[material]\nyoung = 1e5\n[[cable]]\noffset = 0.004\n";
    std::fs::write(here.path().join("my.toml"), arm).unwrap();
    let run = hydrostat_in(here.path(), &["reach", "my.toml", "--boundary"]);
    assert!(run.err.contains("has no largest tension; give --max-tension"), "{}", run.err);
    assert_eq!(run.code, 2);
}

#[test]
fn the_boundary_is_written_and_drawn() {
    let here = directory();
    let args = ["reach", "silicone", "--boundary", "--max-tension", "0.2", "--spacing", "0.05", "--format", "csv"];
    let more = ["-o", "boundary.csv", "--plot", "boundary.svg"];
    let run = hydrostat_in(here.path(), &[&args[..], &more[..]].concat());
    assert_eq!((run.code, run.out.as_str()), (0, ""), "{}", run.err);
    let text = std::fs::read_to_string(here.path().join("boundary.csv")).unwrap();
    let (names, rows) = columns(&text);
    assert_eq!(&names[..5], ["piece", "kind", "cables", "tip_x_m", "tip_y_m"]);
    assert!(rows.len() > 20 && rows.iter().all(|row| row[1] == "edge"), "{text}");
    // Nothing pulls at the start of the first piece.
    let [x, y] = [3, 4].map(|k: usize| rows[0][k].parse::<f64>().unwrap());
    assert!((x - 0.245).hypot(y) < 1e-12, "{x}, {y}");
    assert!(std::fs::read_to_string(here.path().join("boundary.svg")).unwrap().starts_with("<svg"));
    let document = json(&hydrostat_in(here.path(), &[&args[..7], &["--format", "json"]].concat()).out);
    assert_eq!(document["pieces"].as_array().unwrap().len(), 4);
    assert!(solved(&args[..7]).out.starts_with("silicone: the tip reaches x "));
}
