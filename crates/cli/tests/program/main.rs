//! The program from outside: what it prints, writes and ends with.

mod cables;
mod commands;
mod equilibria;
mod formats;
mod guide;
mod histories;
mod hostile;
mod identify;
mod motions;
mod overwriting;
mod paths;
mod reach;
mod refusals;
mod serve;
mod shell;
mod slips;
mod space;
mod streams;
mod sweeps;
mod tables;
#[cfg(unix)]
mod terminal;
mod units;
mod validate;
mod verdicts;

use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

/// What a run of the program left behind.
struct Run {
    code: i32,
    out: String,
    err: String,
}

/// Runs `hydrostat` with these arguments in `directory`.
fn hydrostat_in(directory: &Path, args: &[&str]) -> Run {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_hydrostat")).args(args).current_dir(directory).output().unwrap();
    Run {
        code: status.code().unwrap(),
        out: String::from_utf8(stdout).unwrap(),
        err: String::from_utf8(stderr).unwrap(),
    }
}

/// Runs `hydrostat` in a directory of its own.
fn hydrostat(args: &[&str]) -> Run {
    hydrostat_in(directory().path(), args)
}

fn directory() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// A run that solved.
fn solved(args: &[&str]) -> Run {
    let run = hydrostat(args);
    assert_eq!(run.code, 0, "{args:?}: {}", run.err);
    run
}

/// A run that was refused: status 2, nothing on standard output, a reason on standard error.
fn refused(args: &[&str]) -> String {
    let run = hydrostat(args);
    assert_eq!(run.code, 2, "{args:?}: {}{}", run.out, run.err);
    assert_eq!(run.out, "", "{args:?}");
    assert!(run.err.starts_with("error: "), "{args:?}: {}", run.err);
    run.err
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap()
}

/// Names and rows of a CSV, as text; every row has a cell a name.
fn columns(text: &str) -> (Vec<&str>, Vec<Vec<&str>>) {
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let names = lines.next().unwrap();
    let rows: Vec<_> = lines.collect();
    assert!(rows.iter().all(|row| row.len() == names.len()));
    (names, rows)
}

/// The names of the files in a directory, sorted.
fn files(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Width and height of a PNG that decodes to the end and is not of one colour.
fn picture(bytes: &[u8]) -> (u32, u32) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert!(pixels.iter().any(|p| *p != pixels[0]));
    (info.width, info.height)
}
