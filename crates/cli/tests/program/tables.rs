//! Tables in and out: what the program writes and what spreadsheets write is read everywhere.

use std::fs;
use std::path::Path;

use super::{columns, directory, hydrostat_in, json};

/// An arm of silicone held level in air, markers along it.
const HANGING: &str = "[arm]\nlength = \"245 mm\"\nradius = { base = \"10 mm\", tip = \"4 mm\" }\ndensity = 1080\n\
    [material]\nyoung = \"200 kPa\"\n[flow]\ndensity = 0\n[gravity]\ndirection = -90\n[model]\nvolume = \"none\"\n";
const PLAIN: &str = "s [mm],x [mm],y [mm]\n50,42.51,-23.16\n100,65.32,-67.89\n200,81.56,-166.36\n245,84.83,-210.90\n";

fn written(here: &Path, name: &str, text: &str) {
    fs::write(here.join(name), text).unwrap();
}

fn read(here: &Path, name: &str) -> String {
    fs::read_to_string(here.join(name)).unwrap()
}

/// Young's modulus that a table gives, Pa.
fn young(here: &Path, data: &str, more: &[&str]) -> f64 {
    let args = ["identify", "arm.toml", data, "--fit", "young", "--sd", "1 mm", "--json"];
    let run = hydrostat_in(here, &[&args[..], more].concat());
    assert_eq!(run.code, 0, "{data}: {}", run.err);
    json(&run.out)["parameters"][0]["estimate"].as_f64().unwrap()
}

/// `NaN` in two cells was refused, markers in columns were unknown columns.
#[test]
fn tables_of_markers_were_refused() {
    let directory = directory();
    let here = directory.path();
    written(here, "arm.toml", HANGING);
    written(here, "plain.csv", PLAIN);
    let want = young(here, "plain.csv", &[]);
    let with = |row: &str| PLAIN.replacen("200,", &format!("{row}\n200,"), 1);
    for (name, text) in [
        ("nan.csv", with("150,NaN,NaN")),
        ("na.csv", with("150,NA,")),
        ("de.csv", format!("\u{feff}{}", PLAIN.replace(',', ";").replace('.', ",").replace('\n', "\r\n"))),
        ("heads.csv", PLAIN.replace(" [mm]", "_mm")),
    ] {
        written(here, name, &text);
        assert_eq!(young(here, name, &[]), want, "{name}");
    }
    written(here, "mocap.csv", "frame,time,m1_x,m1_y,m2_x,m2_y\n0,0.0,0.0653,-0.0679,0.0848,-0.2109\n");
    let run = hydrostat_in(here, &["identify", "arm.toml", "mocap.csv", "--fit", "young", "--sd", "1 mm"]);
    assert!(run.code == 2 && run.err.contains("Turn it round: heads \"case,s_mm,x_mm,y_mm\""), "{}", run.err);
}

#[test]
fn what_solve_writes_is_measured_and_followed() {
    let directory = directory();
    let here = directory.path();
    written(here, "arm.toml", HANGING);
    let run = hydrostat_in(
        here,
        &["solve", "arm.toml", "--set", "material.young=150 kPa", "--format", "csv", "-o", "shape.csv"],
    );
    assert_eq!(run.code, 0, "{}", run.err);
    for more in [&[][..], &["--sd", "1 deg"]] {
        let found = young(here, "shape.csv", more);
        assert!((found - 150e3).abs() < 1.0, "{found}");
    }
    // Places of the arm's middle as targets of its tip, without the base.
    let stations = ["solve", "silicone", "--tension", "0.2,0", "--stations", "40", "--format", "csv", "-o", "all.csv"];
    assert_eq!(hydrostat_in(here, &stations).code, 0);
    let all = read(here, "all.csv");
    let kept: Vec<&str> = all.lines().take(1).chain(all.lines().skip(37)).collect();
    written(here, "targets.csv", &kept.join("\n"));
    let run =
        hydrostat_in(here, &["reach", "silicone", "--path", "targets.csv", "--max-tension", "1", "--format", "csv"]);
    let (names, rows) = columns(&run.out);
    assert_eq!((rows.len(), names[1], run.code != 2), (4, "target_x_m", true), "{}", run.err);
    let german = "\u{feff}x [mm];y [mm]\n182,0;78,0\n";
    written(here, "german.csv", german);
    let run =
        hydrostat_in(here, &["reach", "silicone", "--path", "german.csv", "--max-tension", "0.6", "--format", "csv"]);
    assert!(run.code == 0 && run.out.contains("\n1,0.182,0.078,"), "{}{}", run.out, run.err);
}

/// The template is a table in the heads of all tables.
#[test]
fn heads_are_identifiers_everywhere() {
    let directory = directory();
    let here = directory.path();
    let of = |args: &[&str]| -> Vec<String> {
        let run = hydrostat_in(here, args);
        assert!(matches!(run.code, 0 | 3), "{args:?}: {}", run.err);
        let heads = run.out.lines().find(|line| !line.starts_with('#')).unwrap();
        heads.split(',').map(str::to_owned).collect()
    };
    for args in [
        &["solve", "silicone", "--format", "csv"][..],
        &["path", "silicone", "--vary", "cable[0].tension=0:0.1", "--format", "csv"],
        &["equilibria", "silicone", "--over", "flow.speed=0:1 cm/s:2", "--format", "csv"],
        &["reach", "silicone", "--target", "0.182,0.078", "--station", "0.2", "--max-tension", "2", "--format", "csv"],
        &["identify", "silicone", "--template"],
    ] {
        let plain = |head: &String| head.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
        let heads = of(args);
        assert!(heads.len() > 3 && heads.iter().all(plain), "{heads:?}");
    }
    assert_eq!(of(&["path", "silicone", "--vary", "flow.speed=0:1 cm/s", "--format", "csv"])[1], "flow_speed_m_s");
}

/// A sweep of names with an end of a line wrote two lines a row, which `plot` did not read.
#[test]
fn names_with_ends_of_lines_were_rows() {
    let directory = directory();
    let here = directory.path();
    let args =
        ["sweep", "silicone", "--vary", "name=two\nlines,one", "--vary", "cable[0].tension=0:0.4:3", "-o", "out.csv"];
    let run = hydrostat_in(here, &args);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(read(here, "out.csv").contains("\n0,\"two\nlines\",0.0,"));
    let run = hydrostat_in(here, &["plot", "out.csv", "--over", "cable[0].tension", "--workspace", "tips.svg"]);
    assert_eq!(run.code, 0, "{}", run.err);
}

/// Old heads, semicolons with decimal commas, and a mark of UTF-8.
#[test]
fn old_sweeps_and_those_that_a_spreadsheet_saved_are_plotted() {
    let directory = directory();
    let here = directory.path();
    let args = [
        "sweep",
        "silicone",
        "--vary",
        "flow.speed=0:5 cm/s:3",
        "--vary",
        "cable[0].tension=0.1:0.4:4",
        "-o",
        "out.csv",
    ];
    assert_eq!(hydrostat_in(here, &args).code, 0);
    let now = read(here, "out.csv");
    let (heads, rows) = now.split_once('\n').unwrap();
    let old = heads.replace("flow_speed_m_s", "flow.speed_m_per_s").replace("cable_0_tension_N", "cable[0].tension_N");
    let old = old.replace("stroke_0_m", "stroke[0]_m").replace("stroke_1_m", "stroke[1]_m");
    assert_ne!(old, heads);
    let old = format!("{old}\n{rows}");
    let german = format!("\u{feff}{}", now.replace(',', ";").replace('.', ","));
    // Without its note beside it a CSV is known by its heads alone.
    fs::remove_file(here.join("out.csv.json")).unwrap();
    let map = |text: &str, column: &str| {
        written(here, "out.csv", text);
        let run = hydrostat_in(here, &["plot", "out.csv", "--quantity", column, "--map", "map.svg"]);
        assert_eq!(run.code, 0, "{text}: {}", run.err);
        read(here, "map.svg")
    };
    let want = map(&now, "stroke_0_m");
    for label in ["flow.speed (m/s)", "cable[0].tension (N)", "stroke[0] (mm)"] {
        assert!(want.contains(label), "{label}");
    }
    for (text, column) in [(&old, "stroke_0_m"), (&old, "stroke[0]_m"), (&german, "stroke_0_m")] {
        assert!(map(text, column) == want, "{text}");
    }
}

/// All dots had one colour, of an alpha that is next to nothing.
#[test]
fn colours_were_those_of_what_does_not_vary() {
    let directory = directory();
    let here = directory.path();
    let sweep = [
        "sweep",
        "silicone",
        "--vary",
        "cable[0].tension=0:0.4:4",
        "--vary",
        "cable[1].tension=0:0.1:3",
        "-o",
        "out.csv",
    ];
    assert_eq!(hydrostat_in(here, &sweep).code, 0);
    let run = hydrostat_in(here, &["plot", "out.csv"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let map = read(here, "out.map.svg");
    assert!(map.contains("(L) (mm)") && !map.contains("α(L)"), "{map}");
    for label in ["cable[0].tension (N)", "cable[1].tension (N)"] {
        assert!(map.contains(label), "{label}");
    }
    let tips = read(here, "out.workspace.svg");
    assert!(tips.contains("x (mm)") && tips.contains("y (mm)"));
    // Nothing varies, and nothing is wrong.
    let still = ["sweep", "silicone", "--vary", "material.young=80:150 kPa:3", "-o", "still.csv"];
    assert_eq!(hydrostat_in(here, &still).code, 0);
    let run = hydrostat_in(here, &["plot", "still.csv"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let none = ["sweep", "silicone", "--vary", "cable[0].tension=1.2,1.4", "-o", "none.csv"];
    assert_eq!(hydrostat_in(here, &none).code, 3);
    let run = hydrostat_in(here, &["plot", "none.csv"]);
    assert_eq!((run.code, run.out.as_str()), (2, ""));
    assert!(run.err.starts_with("error: none.csv: no row has an equilibrium"), "{}", run.err);
    let run = hydrostat_in(here, &["plot", "none.csv", "--quantity", "tip_x_m", "--map", "none.svg"]);
    assert!(run.code == 2 && run.err.contains("no row has a value of tip_x_m"), "{}", run.err);
    assert!(!here.join("none.svg").exists() && !here.join("none.map.svg").exists());
}

/// Rows kept quiet about what `solve` warns of.
#[test]
fn sweeps_dropped_warnings() {
    let directory = directory();
    let here = directory.path();
    let args = ["sweep", "paper", "--vary", "cable[0].tension=0,40", "-o", "out.csv"];
    let run = hydrostat_in(here, &args);
    assert_eq!(run.code, 0, "{}", run.err);
    let said = run.err.lines().last().unwrap();
    assert!(said.starts_with("note: warnings, of 2 rows: ") && said.contains("strain_range in 1"), "{said}");
    let text = read(here, "out.csv");
    let (names, rows) = columns(&text);
    let column = names.iter().position(|name| *name == "warnings").unwrap();
    let kinds = |tension: &str| -> Vec<String> {
        let run = hydrostat_in(here, &["solve", "paper", "--tension", tension, "--tol", "1e-6", "--format", "json"]);
        let document = json(&run.out);
        let all = document["warnings"].as_array().unwrap();
        all.iter().map(|one| one["kind"].as_str().unwrap().to_owned()).collect()
    };
    for (row, tension) in rows.iter().zip(["0,0", "40,0"]) {
        assert_eq!(row[column], kinds(tension).join(" "));
    }
    // One that is there already says the same.
    let again = hydrostat_in(here, &[&args[..], &["--resume"]].concat());
    assert_eq!(again.err.lines().last(), Some(said));
}

#[test]
fn points_are_joined_by_straight_lines_on_request() {
    let directory = directory();
    let here = directory.path();
    let points = "[[0, 0.010], [0.1, 0.010], [0.245, 0.004]]";
    let arm = |radius: &str| HANGING.replace("{ base = \"10 mm\", tip = \"4 mm\" }", radius);
    written(here, "cubic.toml", &arm(points));
    written(here, "linear.toml", &arm(&format!("{{ points = {points}, join = \"linear\" }}")));
    // The same lines with twenty points more, between which the cubic has next to no room.
    let value = |s: f64| if s < 0.1 { 0.010 } else { 0.010 - (s - 0.1) / 0.145 * 0.006 };
    let fine: Vec<String> =
        (0..=490).map(|k| 0.0005 * f64::from(k)).map(|s| format!("[{s:?}, {:?}]", value(s))).collect();
    written(here, "fine.toml", &arm(&format!("[{}]", fine.join(", "))));
    let tip = |args: &[&str]| -> Vec<f64> {
        let run = hydrostat_in(here, &[&["solve"], args, &["--format", "json"]].concat());
        assert_eq!(run.code, 0, "{args:?}: {}", run.err);
        let document = json(&run.out);
        ["x", "y"].map(|name| document["tip"][name].as_f64().unwrap()).to_vec()
    };
    let off = |a: &[f64], b: &[f64]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let [cubic, linear, fine] = ["cubic.toml", "linear.toml", "fine.toml"].map(|name| tip(&[name]));
    assert!(off(&linear, &fine) < 1e-6 && off(&cubic, &linear) > 1e-4, "{cubic:?} {linear:?} {fine:?}");
    assert_eq!(tip(&["cubic.toml", "--set", "arm.radius.join=linear"]), linear);
    assert_eq!(tip(&["linear.toml", "--set", "arm.radius.join=cubic"]), cubic);
    assert_eq!(
        tip(&["linear.toml", "--set", "arm.radius[1][1]=0.009"]),
        tip(&["cubic.toml", "--set", "arm.radius[1][1]=0.009", "--set", "arm.radius.join=linear"])
    );
    let run = hydrostat_in(here, &["solve", "linear.toml", "--set", "arm.radius.join=smooth"]);
    assert!(run.code == 2 && run.err.contains("\"cubic\" or \"linear\""), "{}", run.err);
}
