//! `hydrostat simulate`: its tables, shapes, events, and runs that go on.

use std::path::Path;

use super::{columns, directory, files, hydrostat_in, json};

/// A short motion of a soft arm with cables; rows every 20 ms.
fn motion<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let own = ["simulate", "silicone", "--vary", "cable[0].tension=ramp:0:0.1:0:0.1", "--every", "20ms"];
    own.iter().chain(&["--set", "dynamics.relaxation_time=2.7ms", "--tol", "1e-3"]).chain(more).copied().collect()
}

fn run(place: &Path, more: &[&str]) {
    let run = hydrostat_in(place, &motion(more));
    assert_eq!(run.code, 0, "{more:?} {}", run.err);
}

fn read(place: &Path, name: &str) -> String {
    std::fs::read_to_string(place.join(name)).unwrap()
}

/// The numbers of a table; empty cells are none.
fn numbers(text: &str) -> Vec<Vec<f64>> {
    columns(text).1.iter().map(|row| row.iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()).collect()
}

#[test]
fn rows_are_the_same_in_every_format() {
    let directory = directory();
    let here = directory.path();
    let more = ["--until", "0.1", "--station", "0.5,122.5 mm", "--quasi-static"];
    for name in ["out.csv", "out.json", "out.parquet"] {
        run(here, &[&more[..], &["-o", name]].concat());
    }
    let text = read(here, "out.csv");
    let (names, _) = columns(&text);
    let rows = numbers(&text);
    assert_eq!(rows.len(), 6);
    let of = |name: &str| names.iter().position(|own| *own == name).unwrap_or_else(|| panic!("{name} in {names:?}"));
    let end = &rows[5];
    // Kinetic energy and that of strain are what was worked, less what was dissipated.
    let sum: f64 = ["cable", "water", "gravity", "load", "base", "volume"]
        .iter()
        .map(|of_| end[of(&format!("{of_}_work_J"))])
        .sum();
    let grown = end[of("kinetic_energy_J")] + end[of("strain_energy_J")] - rows[0][of("strain_energy_J")];
    assert!((grown + end[of("dissipated_J")] - sum).abs() < 2e-3 * end[of("cable_work_J")], "{end:?}");
    // Half of the arm by its share and by its length.
    assert_eq!(end[of("place_0_x_m")], end[of("place_1_x_m")]);
    assert!(end[of("equilibrium_distance")] > 1e-3 && rows[0][of("equilibrium_distance")] < 1e-5, "{end:?}");
    let document = json(&read(here, "out.json"));
    assert_eq!(document["columns"].as_array().unwrap().len(), names.len());
    for (row, want) in document["rows"].as_array().unwrap().iter().zip(&rows) {
        // The reader of the test is off by the last digit.
        for (own, want) in row.as_array().unwrap().iter().zip(want) {
            assert!((own.as_f64().unwrap() - want).abs() <= 1e-15 * want.abs(), "{own} {want}");
        }
    }
    let table = hydrostat_sweep::parquet_columns(&here.join("out.parquet")).unwrap();
    assert_eq!(table.len(), names.len());
    for (k, (column, name)) in table.iter().zip(&names).enumerate() {
        let want: Vec<f64> = rows.iter().map(|row| row[k]).collect();
        assert_eq!((column.name.as_str(), &column.data), (*name, &hydrostat_sweep::Data::Number(want)));
    }
    // The text has the distance from the equilibrium too.
    let text = hydrostat_in(here, &motion(&["--until", "0.1", "--quasi-static"]));
    assert!(text.out.contains("\nstatics in equilibrium the tip would be at ("), "{}", text.out);
}

#[test]
fn whole_shapes_and_events_have_files_of_their_own() {
    let directory = directory();
    let here = directory.path();
    let shapes = ["--shapes", "every:0.05", "--shape-stations", "11"];
    run(here, &[&["--until", "0.1", "-o", "out.csv", "--shapes-output", "shapes.csv"], &shapes[..]].concat());
    let text = read(here, "shapes.csv");
    let (names, rows) = columns(&text);
    assert_eq!(names[..5], ["t_s", "s_m", "x_m", "y_m", "theta_rad"]);
    assert_eq!((rows.len(), rows[32][0], rows[32][1]), (33, "0.1", "0.245"));
    let out = read(here, "out.csv");
    let (_, table) = columns(&out);
    assert_eq!(rows[32][2..5], table[5][1..4], "the tip is the last station");
    run(here, &["--until", "0.1", "-o", "out.json", "--shapes", "0.03,0.1"]);
    let document = json(&read(here, "out.json"));
    assert_eq!(document["shapes"][0]["time"], 0.03);
    assert_eq!(document["shapes"][1]["x"].as_array().unwrap().len(), 51);
    let refused = hydrostat_in(here, &motion(&["--until", "0.1", "-o", "two.csv", "--shapes", "0.1"]));
    assert!(refused.code == 2 && refused.err.contains("--shapes-output"), "{}", refused.err);
    let late = hydrostat_in(here, &motion(&["--until", "0.1", "-o", "two.json", "--shapes", "0.1,0.2"]));
    assert!(late.code == 2 && late.err.starts_with("error: --shapes: expected"), "{}", late.err);
    let past = hydrostat_in(here, &motion(&["--until", "0.1", "-o", "two.csv", "--station", "0.3 m"]));
    assert!(past.code == 2 && past.err.contains("[0, 0.245] m"), "{}", past.err);
    assert!(!here.join("two.csv").exists() && !here.join("two.json").exists());
    // A fold is the last event.
    let pull = ["--vary", "cable[0].tension=ramp:0:1.5:0:0.3", "--until", "1", "--tol", "1e-3"];
    let fold = [&["simulate", "silicone"][..], &pull].concat();
    let ended = hydrostat_in(here, &[&fold[..], &["-o", "fold.csv", "--events", "events.csv"]].concat());
    assert_eq!(ended.code, 3, "{}", ended.err);
    let text = read(here, "events.csv");
    let (names, rows) = columns(&text);
    assert_eq!(names, ["t_s", "event", "cable", "s_m"]);
    assert_eq!(rows.iter().map(|row| row[1]).collect::<Vec<_>>(), ["surface_folds", "cable_fold"]);
}

#[test]
fn a_run_goes_on_from_an_earlier_one_or_from_where_it_was_broken_off() {
    let directory = directory();
    let here = directory.path();
    run(here, &["--until", "0.4", "-o", "whole.csv"]);
    let whole = read(here, "whole.csv");
    // From the end of another run, with its clock.
    run(here, &["--until", "0.2", "-o", "first.csv"]);
    assert_eq!(files(here), ["first.csv", "first.csv.state.json", "whole.csv", "whole.csv.state.json"]);
    run(here, &["--until", "0.4", "-o", "second.csv", "--from", "first.csv"]);
    let (all, later) = (numbers(&whole), numbers(&read(here, "second.csv")));
    assert_eq!((later.len(), later[0][0]), (11, 0.2));
    for (row, want) in later.iter().zip(&all[10..]) {
        assert!((row[0] - want[0]).abs() < 1e-12, "{row:?} {want:?}");
        assert!((row[1] - want[1]).hypot(row[2] - want[2]) < 1e-3 * 0.245, "{row:?} {want:?}");
    }
    // Broken off in the middle of a row after the state was kept.
    std::fs::write(here.join("first.csv"), read(here, "first.csv") + "0.22,0.2").unwrap();
    run(here, &["--until", "0.4", "-o", "first.csv", "--resume"]);
    let text = read(here, "first.csv");
    assert_eq!(text.lines().take(12).collect::<Vec<_>>(), whole.lines().take(12).collect::<Vec<_>>());
    let resumed = numbers(&text);
    assert_eq!(resumed.len(), 21);
    for (row, want) in resumed.iter().zip(&all) {
        assert!((row[1] - want[1]).hypot(row[2] - want[2]) < 1e-4 * 0.245, "{row:?} {want:?}");
    }
    // Whole already: nothing changes.
    run(here, &["--until", "0.4", "-o", "first.csv", "--resume"]);
    assert_eq!(read(here, "first.csv"), text);
    let others =
        hydrostat_in(here, &motion(&["--until", "0.4", "-o", "first.csv", "--resume", "--flow-speed", "0.05"]));
    assert!(others.code == 2 && others.err.contains("of another arm"), "{}", others.err);
    assert_eq!(read(here, "first.csv"), text);
    let json = hydrostat_in(here, &motion(&["--until", "0.4", "-o", "first.json", "--resume"]));
    assert!(json.code == 2 && json.err.contains("--from"), "{}", json.err);
    std::fs::write(here.join("first.csv.state.json"), "{\"motion_state\": 1}").unwrap();
    let broken = hydrostat_in(here, &motion(&["--until", "0.4", "-o", "third.csv", "--from", "first.csv"]));
    assert!(broken.code == 2 && broken.err.contains("first.csv.state.json"), "{}", broken.err);
    assert!(!here.join("third.csv").exists());
}

#[test]
fn a_jump_without_relaxation_time_is_warned_of() {
    let directory = directory();
    let release =
        ["simulate", "silicone", "--vary", "cable[0].tension=step:0.1:0:0", "--until", "20ms", "--tol", "1e-2"];
    let run = hydrostat_in(directory.path(), &release);
    assert!(run.code == 0 && run.err.starts_with("warning: a load jumps at 0 s"), "{}", run.err);
    let damped = hydrostat_in(directory.path(), &[&release[..], &["--set", "dynamics.relaxation_time=2.7ms"]].concat());
    assert_eq!((damped.code, damped.err.as_str()), (0, ""));
}

/// Ctrl-C keeps what there is, and the run goes on.
#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_its_rows() {
    use std::process::{Command, Stdio};
    use std::time::Duration;

    let directory = directory();
    let here = directory.path();
    let args = motion(&["--until", "1000", "-o", "out.csv"]);
    let mut child = Command::new(env!("CARGO_BIN_EXE_hydrostat"))
        .args(&args)
        .current_dir(here)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while std::fs::metadata(here.join("out.csv")).map_or(0, |file| file.len()) < 4000 {
        assert!(child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(20));
    }
    rustix::process::kill_process(rustix::process::Pid::from_child(&child), rustix::process::Signal::INT).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let before = read(here, "out.csv");
    let rows = numbers(&before).len();
    assert!(before.ends_with('\n') && rows > 5);
    let until = (rows as f64 + 4.0) * 0.02;
    run(here, &["--until", &until.to_string(), "-o", "out.csv", "--resume"]);
    let after = read(here, "out.csv");
    assert!(after.starts_with(&before) && numbers(&after).len() == rows + 5, "{rows}");
}

/// A follower load makes a rod flutter at 20.05 E I/L^2: the rates over the load show it.
#[test]
fn modes_over_a_load_say_where_an_arm_flutters() {
    let directory = tempfile::tempdir().unwrap();
    let rod =
        "[arm]\nlength = 1\nradius = 0.001\n[material]\nyoung = 1e9\n[model]\nvolume = \"none\"\n[flow]\ndensity = 0\n";
    std::fs::write(directory.path().join("rod.toml"), rod).unwrap();
    // E I = pi/4 1e-3 N m2.
    let stiffness = std::f64::consts::PI / 4.0 * 1e-3;
    let range = format!("tip.follower[0]={}:{}:2", -19.9 * stiffness, -20.2 * stiffness);
    let args = ["modes", "rod.toml", "--over", &range, "--plot", "locus.svg", "--svg-text"];
    let document = json(&hydrostat_in(directory.path(), &[&args[..], &["--format", "json"]].concat()).out);
    let values = document["values"].as_array().unwrap();
    assert_eq!((values[0]["stable"].as_bool(), values[1]["stable"].as_bool()), (Some(true), Some(false)));
    assert!(values[1]["modes"].as_array().unwrap().iter().any(|mode| mode["kind"] == "flutter"));
    let svg = std::fs::read_to_string(directory.path().join("locus.svg")).unwrap();
    assert!(svg.contains("angular frequency (rad/s)"));
    let text = hydrostat_in(directory.path(), &args).out;
    assert!(text.contains("flutter") && text.contains("2 values of tip.follower[0]"), "{text}");
    let table = hydrostat_in(directory.path(), &[&args[..], &["--format", "csv", "--count", "3"]].concat()).out;
    assert!(table.starts_with("tip_follower_0_N,number,growth_rate_1_s,"), "{table}");
    assert_eq!(table.lines().count(), 7);
}

#[test]
fn arms_in_space_move_too() {
    let directory = directory();
    let here = directory.path();
    let own = ["simulate", "silicone-spatial", "--vary", "cable[1].tension=ramp:0:0.1:0:0.1", "--every", "50ms"];
    let motion = |more: &[&str]| {
        let rest = ["--set", "dynamics.relaxation_time=2.7ms", "--tol", "1e-3", "--until", "0.1"];
        hydrostat_in(here, &[&own[..], &rest, more].concat())
    };
    let more = ["--station", "0.5", "--shapes", "0.1", "--shape-stations", "5"];
    let done = motion(&[&more[..], &["--shapes-output", "shapes.csv", "-o", "out.csv"]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let text = read(here, "out.csv");
    let (names, _) = columns(&text);
    let rows = numbers(&text);
    let of = |name: &str| names.iter().position(|own| *own == name).unwrap_or_else(|| panic!("{name} in {names:?}"));
    assert_eq!(rows.len(), 3);
    assert!(rows.iter().all(|row| row.len() == names.len()));
    let end = &rows[2];
    assert!(end[of("tip_z_m")].abs() > 1e-3 && end[of("place_0_z_m")].abs() > 1e-6, "{end:?}");
    let a: f64 = ["tip_a_x", "tip_a_y", "tip_a_z"].iter().map(|name| end[of(name)].powi(2)).sum();
    assert!((a - 1.0).abs() < 1e-12);
    let shapes = read(here, "shapes.csv");
    assert_eq!(numbers(&shapes).len(), 5);
    assert!((numbers(&shapes)[4][4] - end[of("tip_z_m")]).abs() < 1e-12);
    assert_eq!(motion(&[&more[..], &["-o", "out.json"]].concat()).code, 0);
    let document = json(&read(here, "out.json"));
    assert_eq!(document["shapes"][0]["z"].as_array().unwrap().len(), 5);
    assert_eq!(document["columns"].as_array().unwrap().len(), names.len());
    assert!(motion(&[]).out.contains("its normal along"));
    assert_eq!(motion(&["--plot", "strobe.svg", "--plot-time", "time.svg", "--svg-text"]).code, 0);
    let (strobe, time) = (read(here, "strobe.svg"), read(here, "time.svg"));
    assert!(strobe.contains("tip trace") && strobe.contains("mm at mid-depth"), "{strobe}");
    assert!(time.contains("z of the tip") && time.contains("energy of strain"), "{time}");
}

#[test]
fn runs_in_space_go_on_with_equilibria_beside_them() {
    let directory = directory();
    let here = directory.path();
    let own = ["simulate", "silicone-spatial", "--vary", "cable[1].tension=ramp:0:0.1:0:0.1", "--every", "50ms"];
    let rest = ["--set", "dynamics.relaxation_time=2.7ms", "--tol", "1e-3", "--quasi-static"];
    let motion = |more: &[&str]| hydrostat_in(here, &[&own[..], &rest, more].concat());
    assert_eq!(motion(&["--until", "0.2", "-o", "whole.csv"]).code, 0);
    let whole = read(here, "whole.csv");
    let (names, _) = columns(&whole);
    assert_eq!(&names[names.len() - 2..], ["equilibrium_a_z", "equilibrium_distance"]);
    let rows = numbers(&whole);
    let z = names.iter().position(|name| *name == "tip_z_m").unwrap();
    let distance = names.len() - 1;
    assert!(rows[0][distance] < 1e-5 && rows.iter().skip(1).all(|row| row[distance] > 1e-4), "{rows:?}");
    assert_eq!(motion(&["--until", "0.1", "-o", "first.csv"]).code, 0);
    assert_eq!(motion(&["--until", "0.2", "--from", "first.csv", "-o", "second.csv"]).code, 0);
    let second = numbers(&read(here, "second.csv"));
    let (end, again) = (rows.last().unwrap(), second.last().unwrap());
    assert!((end[0] - again[0]).abs() < 1e-12 && (end[z] - again[z]).abs() < 2e-4, "{} {}", end[z], again[z]);
    // A planar state is none of an arm in space.
    let flat = hydrostat_in(here, &["simulate", "silicone", "--until", "0.01", "-o", "flat.csv"]);
    assert_eq!(flat.code, 0, "{}", flat.err);
    let refused = motion(&["--until", "0.2", "--from", "flat.csv"]);
    assert!(refused.code == 2 && refused.err.contains("does not fit"), "{}", refused.err);
    assert!(motion(&["--until", "0.1"]).out.contains("in equilibrium the tip would be at ("));
}

#[test]
fn modes_in_space_come_in_twos() {
    let directory = directory();
    let own = ["modes", "silicone-spatial", "--tension", "0,0,0", "--count", "4", "--elements", "6"];
    let document = json(&hydrostat_in(directory.path(), &[&own[..], &["--format", "json"]].concat()).out);
    let frequency = |k: usize| document["modes"][k]["frequency_hz"].as_f64().unwrap();
    assert!(frequency(0) > 0.1 && (frequency(1) / frequency(0) - 1.0).abs() < 1e-6, "{document}");
    assert!(document["tip"]["z"].as_f64().is_some() && document["tip"]["a"].as_array().is_some(), "{document}");
    let over = ["--over", "flow.speed=0:0.1:2", "--plot", "locus.svg", "--format", "csv"];
    let table = hydrostat_in(directory.path(), &[&own[..], &over].concat()).out;
    assert_eq!(table.lines().count(), 9, "{table}");
    assert!(directory.path().join("locus.svg").exists());
}
