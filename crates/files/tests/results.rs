//! JSON and CSV of results, and files on disk.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use hydrostat::{
    Arm, Cable, CableState, Configuration, NoEquilibrium, Phase, Profile, Stations, Statistics, Verdict, VerdictKind,
    Warning, Wrench,
};
use hydrostat_files::{
    ArmFile, FailureDocument, Note, Others, SolutionDocument, remove_leftovers, stations_csv, write_whole,
    write_whole_with,
};
use serde_json::{Value, json};

fn configuration() -> Configuration {
    let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    arm.base.angle = 30_f64.to_radians();
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.1));
    let column = |at: f64| vec![at, at + 0.1, at + 1.0 / 3.0];
    let stations = Stations {
        s: vec![0.0, 0.1, 0.2],
        x: column(1.0),
        y: column(2.0),
        theta: column(3.0),
        nu: column(4.0),
        eta: column(5.0),
        mu: column(6.0),
        beta: column(7.0),
        alpha: column(8.0),
        n_a: column(9.0),
        n_b: column(10.0),
        m: vec![1e-9, f64::NAN, 1e300],
    };
    // A solved arm, with numbers in its place that are easy to tell apart.
    let mut out = arm.solve().unwrap();
    out.stations = stations;
    out.cables = vec![CableState { name: "left".to_owned(), tension: 0.1, length: 0.19, stroke: 0.01, command: None }];
    out.base_reaction = Wrench { force: [1.0, -2.0], moment: 3.0 };
    out.error_estimate = 1e-9;
    out.stable = None;
    out.statistics = Statistics { elements: 2, stages: 3, newton_rounds: 4, meshes: 1, load_steps: 0, evaluations: 24 };
    out
}

#[test]
fn the_document_of_an_answer() {
    let mut answer = configuration();
    let notes = [Note::from(&Warning::SealedCavity)];
    let text = SolutionDocument::new(&answer, 0.75, &notes).to_json();
    assert!(!text.contains("NaN") && !text.contains('\n'));
    assert!(text.starts_with("{\"schema\":1,\"version\":\""));
    let got: Value = serde_json::from_str(&text).unwrap();
    let keys: Vec<&str> = got.as_object().unwrap().keys().map(String::as_str).collect();
    for key in [
        "schema",
        "version",
        "converged",
        "stable",
        "warnings",
        "snaps",
        "tip",
        "stations",
        "cables",
        "base",
        "error_estimate",
        "fold_margin",
        "inputs",
        "statistics",
    ] {
        assert!(keys.contains(&key), "{key}");
    }
    assert_eq!(keys.len(), 14, "{keys:?}");
    assert_eq!((&got["converged"], &got["stable"], &got["fold_margin"]), (&json!(true), &json!(true), &json!(0.75)));
    assert_eq!(got["warnings"][0]["kind"], "sealed_cavity");
    assert_eq!(got["cables"], json!([{ "name": "left", "tension": 0.1, "length": 0.19, "stroke": 0.01 }]));
    assert_eq!(got["base"], json!({ "force": [1.0, -2.0], "moment": 3.0 }));
    assert_eq!(got["stations"].as_object().unwrap().len(), 12);
    assert_eq!(got["stations"]["m"], json!([1e-9, null, 1e300]));
    assert_eq!(got["stations"]["s"], json!([0.0, 0.1, 0.2]));
    assert_eq!(got["tip"].as_object().unwrap().len(), 4);
    assert_eq!(got["statistics"]["newton_rounds"], 4);
    assert_eq!(got["inputs"]["arm"]["radius"], json!({ "base": 0.01, "tip": 0.002 }));
    assert_eq!(got["inputs"]["arm"]["base"]["angle"], json!(30.0));

    answer.unmet = Some(Wrench { force: [0.0, 0.5], moment: 0.25 });
    let got = serde_json::to_value(SolutionDocument::new(&answer, -0.1, &[])).unwrap();
    assert_eq!((&got["stable"], &got["warnings"]), (&json!(true), &json!([])));
    assert_eq!(got["unmet"], json!({ "force": [0.0, 0.5], "moment": 0.25 }));
}

#[test]
fn what_is_said_of_stability() {
    let stable = |load: f64| {
        let solved = hydrostat::cases::column(1e6, 3e5, load, 0.0).solve().unwrap();
        serde_json::to_value(SolutionDocument::new(&solved, 1.0, &[])).unwrap()["stable"].clone()
    };
    let critical = hydrostat::cases::column_buckling_load(1e6, 3e5).unwrap();
    assert_eq!([0.9, 1.0, 1.1].map(|fraction| stable(fraction * critical)), [json!(true), Value::Null, json!(false)]);
}

#[test]
fn a_tolerance_that_was_missed_is_noted() {
    let mut answer = configuration();
    answer.error_estimate = 1e-9;
    let kinds = |answer: &Configuration, tol: f64| -> Vec<&str> {
        Note::all(answer, tol).into_iter().map(|note| note.kind).collect()
    };
    // The arm is 0.2 m long.
    let known = kinds(&answer, 6e-9);
    assert!(!known.contains(&"tolerance_missed"), "{known:?}");
    assert_eq!(kinds(&answer, 4e-9), [known, vec!["tolerance_missed"]].concat());
    let last = Note::all(&answer, 4e-9).pop().unwrap();
    assert_eq!(last.message, "the tip error, about 1.0e-6 mm, is above the tolerance of 8.0e-7 mm");
}

#[test]
fn inputs_read_back_as_an_arm() {
    let answer = configuration();
    let document = serde_json::to_value(SolutionDocument::new(&answer, 1.0, &[])).unwrap();
    // The keys of the arm file are set one by one: JSON's numbers and strings are TOML's.
    let mut file = ArmFile::parse("", "x").unwrap();
    for (table, keys) in document["inputs"].as_object().unwrap() {
        let text = keys.to_string().replace("\":", "\"=");
        file.set(table, &text).unwrap();
    }
    assert_eq!(file.arm().unwrap(), answer.arm);
}

#[test]
fn the_document_of_a_verdict() {
    let verdict = Verdict {
        kind: VerdictKind::CableFold,
        phase: Phase::Tension,
        load_fraction: 0.5,
        s: Some(0.2),
        residual: f64::INFINITY,
        spent: None,
    };
    let failure = NoEquilibrium {
        verdict: verdict.clone(),
        last_good: Some(configuration()),
        snaps: Vec::new(),
        after_snap: None,
        at_full_loads: None,
    };
    let text = FailureDocument::new(&failure, 0.5, &[]).to_json();
    let got: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&got["schema"], &got["converged"]), (&json!(1), &json!(false)));
    assert_eq!(got["verdict"]["kind"], "cable_fold");
    assert_eq!(got["verdict"]["phase"], "tension");
    assert_eq!(got["verdict"]["load_fraction"], 0.5);
    assert_eq!(got["verdict"]["s"], 0.2);
    assert_eq!(got["verdict"]["residual"], Value::Null);
    assert_eq!(got["verdict"]["message"], verdict.message());
    assert_eq!(got["verdict"]["advice"], verdict.advice());
    assert_eq!(got["last_good"]["fold_margin"], 0.5);
    assert_eq!(got["last_good"]["stations"]["s"][2], 0.2);

    assert_eq!(got["verdict"]["other_equilibria"], Value::Null);
    let others = Others { count: 9, stable: 2, complete: true };
    let with = serde_json::to_value(FailureDocument::new(&failure, 0.5, &[]).with_others(Some(others))).unwrap();
    assert_eq!(with["verdict"]["other_equilibria"], json!({ "count": 9, "stable": 2, "complete": true }));

    let nothing = NoEquilibrium { verdict, last_good: None, snaps: Vec::new(), after_snap: None, at_full_loads: None };
    assert_eq!(serde_json::to_value(FailureDocument::new(&nothing, 0.0, &[])).unwrap()["last_good"], Value::Null);
}

#[test]
fn rows_of_numbers_that_read_back() {
    let stations = configuration().stations;
    let text = stations_csv(&stations);
    let mut lines = text.lines();
    let header = "s_m,x_m,y_m,theta_rad,nu,eta,mu_per_m,beta,alpha_rad,n_a_N,n_b_N,m_Nm";
    assert_eq!(lines.next(), Some(header));
    let rows: Vec<Vec<Option<f64>>> = lines.map(|l| l.split(',').map(|c| c.parse().ok()).collect()).collect();
    assert_eq!(rows.len(), 3);
    for (i, row) in rows.iter().enumerate() {
        assert_eq!(row.len(), 12);
        assert_eq!(row[1], Some(stations.x[i]));
        assert_eq!(row[10], Some(stations.n_b[i]));
    }
    assert_eq!((rows[0][11], rows[1][11], rows[2][11]), (Some(1e-9), None, Some(1e300)));
    // Columns of unequal length are no reason to panic.
    let ragged = Stations { s: vec![0.0, 1.0], ..Stations::default() };
    assert_eq!(stations_csv(&ragged).lines().count(), 3);
}

/// A directory of a test, which goes with it.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn files_appear_whole_or_not_at_all() {
    let scratch = Scratch::new("write");
    let dir = &scratch.0;
    let target = dir.join("out.json");
    write_whole(&target, b"one").unwrap();
    write_whole(&target, b"two").unwrap();
    assert_eq!(std::fs::read(&target).unwrap(), b"two");
    assert_eq!(std::fs::read_dir(dir).unwrap().count(), 1, "nothing else is left");

    let missing = write_whole(dir.join("no/out.json"), b"x").unwrap_err().to_string();
    assert!(missing.contains("no/out.json") && missing.contains("make the directory"), "{missing}");
    // A directory that was there was to be made.
    if cfg!(target_os = "linux") {
        let there = write_whole("/proc/out.json", b"{}").unwrap_err().to_string();
        assert!(there.ends_with("; choose another path"), "{there}");
    }
    let directory = write_whole(dir, b"x").unwrap_err().to_string();
    assert!(directory.contains("name a file in that directory"), "{directory}");
    assert!(write_whole("", b"x").is_err());
    assert!(write_whole("/", b"x").is_err());

    let below_a_file = write_whole(target.join("x"), b"x").unwrap_err().to_string();
    assert!(below_a_file.starts_with("cannot write "), "{below_a_file}");

    let mut permissions = std::fs::metadata(&target).unwrap().permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&target, permissions).unwrap();
    let locked = write_whole(&target, b"three").unwrap_err().to_string();
    assert!(locked.contains("that you may write to"), "{locked}");
    assert_eq!(std::fs::read(&target).unwrap(), b"two");
    assert_eq!(std::fs::read_dir(dir).unwrap().count(), 1, "nothing half-written is left");
}

#[test]
fn what_fails_or_is_killed_half_way_does_not_stay() {
    let scratch = Scratch::new("half");
    let dir = &scratch.0;
    let target = dir.join("out.csv");
    write_whole(&target, b"one").unwrap();
    // A writer's own error is what its caller gets.
    let failed: Result<(), Box<dyn std::error::Error>> = write_whole_with(&target, |file| {
        file.write_all(b"ha")?;
        Err("given up".into())
    });
    assert_eq!(failed.unwrap_err().to_string(), "given up");
    assert_eq!(std::fs::read(&target).unwrap(), b"one");

    let others = [".out.csv.json.1-0.tmp", ".out.csv.tmp", "out.csv.1-0.tmp", ".out.csv.1-x.tmp"];
    for name in [".out.csv.1-0.tmp", ".out.csv.77-12.tmp"].iter().chain(&others) {
        std::fs::write(dir.join(name), "ha").unwrap();
    }
    remove_leftovers(&target);
    let left = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let (mut left, mut want) = (left.collect::<Vec<_>>(), [&["out.csv"], &others[..]].concat());
    left.sort_unstable();
    want.sort_unstable();
    assert_eq!(left, want);
}

#[cfg(unix)]
#[test]
fn links_keep_pointing_and_devices_stay() {
    let scratch = Scratch::new("link");
    let dir = &scratch.0;
    let (target, link) = (dir.join("target"), dir.join("link"));
    std::fs::write(&target, "old").unwrap();
    std::os::unix::fs::symlink(&target, &link).unwrap();
    write_whole(&link, b"new").unwrap();
    assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(std::fs::read(&target).unwrap(), b"new");
    write_whole("/dev/null", b"x").unwrap();
    assert!(!std::fs::metadata("/dev/null").unwrap().is_file());
}
