//! `-` in place of a file, and readers that go away.

use std::io::Write as _;
use std::process::{Command, Stdio};

use super::{Run, columns, directory, files, hydrostat_in, refused, solved};

/// A run whose standard input is `text`.
fn fed(args: &[&str], text: &str) -> Run {
    let here = directory();
    let mut child = Command::new(env!("CARGO_BIN_EXE_hydrostat"))
        .args(args)
        .current_dir(here.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    let run = child.wait_with_output().unwrap();
    assert!(files(here.path()).is_empty());
    Run {
        code: run.status.code().unwrap(),
        out: String::from_utf8(run.stdout).unwrap(),
        err: String::from_utf8(run.stderr).unwrap(),
    }
}

#[test]
fn loads_come_from_standard_input() {
    let rows = "t_s,cable[0].tension\n0,0\n0.01,0.1\n";
    let history = fed(&["history", "silicone", "--input", "-", "--format", "csv"], rows);
    assert_eq!(history.code, 0, "{}", history.err);
    let (names, rows_read) = columns(&history.out);
    assert_eq!((names[0], rows_read.len()), ("cable_0_tension_N", 2), "an identifier with its unit");
    let motion = ["simulate", "silicone", "--input", "-", "--until", "0.01", "--every", "0.01", "--format", "csv"];
    let simulate = fed(&motion, rows);
    assert_eq!((simulate.code, columns(&simulate.out).1.len()), (0, 2), "{}", simulate.err);
    let wrong = fed(&["history", "silicone", "--input", "-"], "nothing\n1\n");
    assert!(wrong.code == 2 && wrong.err.contains("standard input:1: column 1"), "{}", wrong.err);
    let twice = refused(&["history", "-", "--input", "-"]);
    assert!(twice.contains("ARM and --input are both -"), "{twice}");
}

/// `-o -` wrote a file of that name.
#[test]
fn a_dash_is_standard_output() {
    let here = directory();
    let here = here.path();
    for args in [
        &["solve", "silicone"][..],
        &["solve", "silicone", "--format", "json"],
        &["path", "silicone", "--vary", "flow.speed=0:0.1", "--format", "csv"],
        &["identify", "silicone", "--template"],
    ] {
        let run = hydrostat_in(here, &[args, &["-o", "-"]].concat());
        assert_eq!((run.code, run.out), (0, solved(args).out), "{args:?}: {}", run.err);
    }
    let motion = ["simulate", "silicone", "--vary", "flow.speed=step:0:0.1:0", "--until", "0.01", "--every", "0.01"];
    let run = hydrostat_in(here, &[&motion[..], &["-o", "-"]].concat());
    assert_eq!((run.code, columns(&run.out).1.len()), (0, 2), "{}", run.err);
    let resumed = hydrostat_in(here, &[&motion[..], &["-o", "-", "--resume"]].concat());
    assert!(resumed.code == 2 && resumed.err.contains("--resume: -"), "{}", resumed.err);
    let twice = hydrostat_in(here, &["identify", "silicone", "--template", "-o", "-", "--fitted", "-"]);
    assert_eq!(twice.code, 2, "{}", twice.err);
    let figures = hydrostat_in(here, &["figures", "-o", "-"]);
    assert!(figures.code == 2 && figures.err.contains("a directory"), "{}", figures.err);
    assert!(files(here).is_empty(), "{:?}", files(here));
}

/// A message that nobody reads was a panic.
#[cfg(unix)]
#[test]
fn a_closed_standard_error_is_no_failure() {
    let run = |args: &[&str]| {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut command = Command::new(env!("CARGO_BIN_EXE_hydrostat"));
        command.args(args).stdout(Stdio::null()).stderr(writer).status().unwrap().code()
    };
    assert_eq!(run(&["solve", "silicone", "--set", "gravity.acceleration=981"]), Some(0));
    assert_eq!(run(&["solve", "silicone", "--set", "arm.length=-1"]), Some(2));
}
