//! Requests that are wrong: status 2, a reason, and no output.

use std::path::Path;

use super::{directory, files, hydrostat, hydrostat_in, refused};

#[test]
fn unknown_arms_are_answered_with_the_known_ones() {
    let message = refused(&["solve", "silicon"]);
    for name in ["paper", "paper-statements", "silicone", "multi-bending", "octopus", "did you mean `silicone`?"] {
        assert!(message.contains(name), "{message}");
    }
    assert!(!refused(&["solve", "zzz"]).contains("did you mean"));
    assert!(refused(&["check", "papr"]).contains("did you mean `paper`?"));
    assert!(refused(&["arms", "octopuss"]).contains("did you mean `octopus`?"));
}

#[test]
fn a_path_is_never_taken_for_a_name() {
    assert!(refused(&["solve", "./paper"]).contains("cannot be read"));
    assert!(refused(&["solve", "paper.toml"]).contains("cannot be read"));
}

#[test]
fn a_file_wins_over_a_shipped_arm_of_its_name() {
    let directory = directory();
    std::fs::write(directory.path().join("paper"), "[arm]\nlength = 0.1\nradius = 0.01\n[material]\nyoung = 1e5\n")
        .unwrap();
    let run = hydrostat_in(directory.path(), &["solve", "paper"]);
    assert_eq!(run.code, 0);
    assert!(run.out.contains("100 mm"), "{}", run.out);
}

#[test]
fn tensions_must_fit_the_cables() {
    for (tension, found) in [("1", "1 tension was given"), ("1,2,3", "3 tensions were given")] {
        let message = refused(&["solve", "paper", "--tension", tension]);
        assert_eq!(message, format!("error: --tension: the arm has 2 cables, {found}\n"));
    }
    assert!(refused(&["solve", "paper", "--tension", "-5,0"]).contains("not negative"));
    assert!(refused(&["solve", "paper", "--tension", "nan,0"]).contains("NaN"));
    assert!(refused(&["solve", "paper", "--tension", "inf,0"]).contains("not finite"));
    assert!(refused(&["solve", "paper", "--tension", "101,0"]).contains("max_tension"));
    assert!(refused(&["solve", "paper", "--tension", "2 mm,0"]).contains("a force"));
    refused(&["solve", "paper", "--tension", ""]);
    // It is named as it was typed.
    let message = refused(&["solve", "paper", "--tension", "-1,0"]);
    assert!(message.starts_with("error: --tension -1,0: cable[0].tension="), "{message}");
    let message = refused(&["solve", "paper", "--flow-speed", "-1"]);
    assert!(message.starts_with("error: --flow-speed -1: flow.speed="), "{message}");
}

#[test]
fn overrides_must_be_keys_and_values_of_the_format() {
    assert!(refused(&["solve", "paper", "--set", "flow.sped=1"]).contains("did you mean `speed`?"));
    assert!(refused(&["solve", "paper", "--set", "flow.speed"]).contains("KEY=VALUE"));
    assert!(refused(&["solve", "paper", "--set", "cable[2].tension=1"]).contains("2 cables"));
    assert!(refused(&["solve", "paper", "--set", "arm.length=-1"]).contains("above zero"));
    assert!(refused(&["solve", "paper", "--set", "arm.length=nan"]).contains("not finite"));
    assert!(refused(&["solve", "paper", "--flow-speed", "-1"]).contains("not negative"));
    assert!(refused(&["solve", "paper", "--flow-speed", "2 kg"]).contains("a speed"));
}

#[test]
fn an_arm_file_is_refused_with_its_line() {
    let directory = directory();
    std::fs::write(directory.path().join("arm.toml"), "[arm]\nlength = 0.1\nradus = 0.01\n").unwrap();
    for command in ["solve", "check"] {
        let run = hydrostat_in(directory.path(), &[command, "arm.toml"]);
        assert_eq!((run.code, run.out.as_str()), (2, ""));
        assert!(run.err.starts_with("error: arm.toml:3: arm.radus"), "{}", run.err);
        assert!(run.err.contains("did you mean `radius`?"), "{}", run.err);
    }
}

#[test]
fn options_out_of_range() {
    for tol in ["0", "1", "-1e-8", "nan", "x"] {
        refused(&["solve", "paper", "--tol", tol]);
    }
    for stations in ["0", "1", "-3", "2.5", "99999999999"] {
        refused(&["solve", "paper", "--stations", stations]);
    }
    refused(&["solve", "paper", "--format", "xml"]);
    refused(&["solve"]);
    refused(&["fly"]);
    refused(&["solve", "paper", "--plot", "arm.jpg"]);
}

#[test]
fn outputs_that_cannot_be_written() {
    let directory = directory();
    let here = directory.path();
    std::fs::create_dir(here.join("folder")).unwrap();
    std::fs::write(here.join("file"), "kept").unwrap();
    for path in ["nowhere/arm.csv", "folder", "file/arm.csv"] {
        let run = hydrostat_in(here, &["solve", "paper", "-o", path]);
        assert_eq!((run.code, run.out.as_str()), (2, ""), "{path}: {}", run.err);
        assert!(run.err.contains(&format!("cannot write {path}")), "{}", run.err);
    }
    if Path::new("/proc").is_dir() {
        // The directory is there; files cannot be made in it.
        assert!(!refused(&["solve", "paper", "-o", "/proc/arm.csv"]).contains("make the directory"));
    }
    let run = hydrostat_in(here, &["solve", "paper", "--plot", "nowhere/arm.svg"]);
    assert_eq!((run.code, run.out.as_str()), (2, ""), "{}", run.err);
    let run = hydrostat_in(here, &["solve", "paper", "-o", "arm.svg", "--plot", "arm.svg"]);
    assert_eq!((run.code, run.out.as_str()), (2, ""), "{}", run.err);
    let run = hydrostat_in(here, &["figures", "-o", "file"]);
    assert_eq!((run.code, run.out.as_str()), (2, ""), "{}", run.err);
    // Nothing was left behind, nothing was changed.
    assert_eq!(files(here), ["file", "folder"]);
    assert_eq!(std::fs::read_to_string(here.join("file")).unwrap(), "kept");
}

#[test]
fn a_refused_plot_keeps_the_other_output_from_being_written() {
    let directory = directory();
    let run = hydrostat_in(directory.path(), &["solve", "paper", "-o", "arm.txt", "--plot", "nowhere/arm.svg"]);
    assert_eq!(run.code, 2);
    assert!(files(directory.path()).is_empty());
}

#[test]
fn a_request_is_refused_before_its_outputs_are_looked_at() {
    let run = hydrostat(&["solve", "papr", "-o", "nowhere/arm.csv"]);
    assert!(run.err.contains("did you mean"), "{}", run.err);
}
