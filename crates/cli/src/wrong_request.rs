//! Requests that cannot be meant, and how they are told.

use std::path::PathBuf;

use hydrostat::ArmError;
use hydrostat::parameter::Unfit;
use hydrostat_figures::Quantity;
use hydrostat_files::{FileError, PartialUnit, shipped};

use crate::say::MORE;

/// What messages call standard input.
pub(crate) const STANDARD_INPUT: &str = "standard input";

/// A request that cannot be meant.
#[derive(Debug)]
pub(crate) enum WrongRequest {
    /// Neither a file nor the name of a shipped arm.
    UnknownArm(String),
    /// `--set` without `=`.
    Setting(String),
    /// Tensions that do not fit the cables.
    Tensions(ArmError),
    /// A unit behind some of the tensions.
    Unit(PartialUnit),
    /// Two outputs in one file.
    SamePath([&'static str; 2], PathBuf),
    /// An output in a file that is read.
    Overwrites { option: &'static str, path: PathBuf, input: &'static str },
    /// Tensions for a search that finds them.
    TensionsAreFound,
    /// A quantity that the arm at hand does not have.
    Unfit(&'static str, Unfit),
    /// A value, said where, that makes no arm.
    Value(String, ArmError),
    /// A column that a sweep does not have, and those that it has.
    NoColumn(String, Vec<String>),
    /// A load that a table does not have, and those that it has.
    NoLoad(String, Vec<String>),
    /// A sweep without an answer, or without a value in a column.
    NothingToDraw(PathBuf, Option<String>),
    /// What an option needs of a sweep and does not find.
    NotInSweep(&'static str, &'static str),
    /// Keys that give no map, and those of the sweep.
    Over(Vec<String>),
    /// A key whose values are words.
    Words(String),
    /// Keys of a sweep, all of whose values are words.
    OnlyWords(Vec<String>),
    /// Numbers of other programs that cannot be read.
    Peers(PathBuf, String),
    /// A cable without a largest tension, where one is needed.
    Unbounded(String),
    /// An option that is for arms in the plane, and what there is in space.
    NotInSpace(&'static str, &'static str),
    /// An option that is for arms in space, and what there is in the plane.
    OnlyInSpace(&'static str, &'static str),
    /// A target with two coordinates in space, or with three in the plane.
    Coordinates { in_space: bool },
    /// A quantity that an arm in the plane, or in space, does not have.
    NotOfArm { quantity: Quantity, in_space: bool },
    /// A cable whose stroke was asked for.
    NoCable { asked: usize, cables: usize },
    /// A table of measurements without any.
    NothingMeasured(PathBuf),
    /// An option of pictures without one, and the options that ask for one.
    NothingDrawn(&'static str, String),
    /// More work than was meant.
    Declined,
    /// A motion that was interrupted at this time (s), and whether another run can go on from there.
    Interrupted(f64, bool),
    /// An interrupted run of another command.
    OtherRun(PathBuf),
    /// A run that cannot be resumed, because its output does not grow.
    NotResumable(PathBuf),
    /// Whole shapes without a place for them.
    ShapesNowhere,
    /// A station past the tip (m), of an arm of such a length.
    PastTheTip(f64, f64),
    /// An end (s) that is not after the start.
    EndsBefore { until: f64, start: f64 },
    /// Everything that is wrong with an arm file, where that is more than one thing.
    File(Vec<FileError>),
    /// What standard input brought is not what was asked for.
    Input(String),
    /// Standard input for two files.
    InputTwice([&'static str; 2]),
    /// A file that is written only where there is none yet.
    Exists(PathBuf),
    /// No command of the program, and those that there are.
    NoCommand(String, Vec<String>),
}

impl std::fmt::Display for WrongRequest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::UnknownArm(name) => f.write_str(&unknown_arm(name)),
            Self::Setting(text) => {
                write!(f, "--set {text}: expected KEY=VALUE, such as flow.speed=0.5 or cable[0].tension=\"20 N\"")
            }
            Self::Tensions(error) => write!(f, "--tension: {error}"),
            Self::Unit(error) => write!(f, "{error}"),
            Self::SamePath([a, b], path) => {
                write!(f, "{a} and {b} both name {}; give them different files", path.display())
            }
            Self::Overwrites { option, path, input } => write!(
                f,
                "{option} {}: this file is also read, as {input}, and inputs are never overwritten; choose another output",
                path.display()
            ),
            Self::TensionsAreFound => f.write_str(
                "--tension: reach finds the tensions itself; use --max-tension to bound them, or --path, which starts from those of --tension",
            ),
            Self::Unfit(option, error) => write!(f, "{option} {error}"),
            Self::Value(at, error) => write!(f, "{at}: {error}"),
            Self::NoColumn(name, columns) => {
                write!(f, "--quantity {name}: expected one of {}", columns.join(", "))
            }
            Self::NoLoad(name, keys) => write!(f, "--over {name}: expected one of {}", keys.join(", ")),
            Self::NothingToDraw(path, None) => write!(
                f,
                "{}: no row has an equilibrium, so there is nothing to draw; see the column `verdict`",
                path.display()
            ),
            Self::NothingToDraw(path, Some(column)) => {
                write!(f, "{}: no row has a value of {column}, so there is nothing to draw", path.display())
            }
            Self::NotInSweep(option, needed) => write!(f, "{option}: expected {needed} in the sweep, found none"),
            Self::Over(keys) => {
                write!(f, "--over: expected one or two different keys of those that were varied, {}", keys.join(", "))
            }
            Self::Words(key) => write!(f, "--over: the values of {key} are words, and an axis needs numbers"),
            Self::OnlyWords(keys) => f.write_str(&only_words(keys)),
            Self::Peers(path, why) => write!(f, "--peers {}: {why}", path.display()),
            Self::Unbounded(cable) => {
                write!(
                    f,
                    "--boundary: cable {cable} has no largest tension; give --max-tension, or set `max_tension` in the arm file"
                )
            }
            Self::NotInSpace(option, instead) => {
                write!(f, "{option}: it is for arms in the plane, and this arm has `space = \"spatial\"`; {instead}")
            }
            Self::OnlyInSpace(option, instead) => {
                write!(f, "{option}: it is for arms with `space = \"spatial\"`, and this arm is in the plane; {instead}")
            }
            Self::Coordinates { in_space } => f.write_str(coordinates(*in_space)),
            Self::NotOfArm { quantity, in_space: true } => write!(
                f,
                "--quantity {quantity}: an arm with `space = \"spatial\"` has tip.x, tip.y, tip.z, tip.alpha and the strokes of its cables"
            ),
            Self::NotOfArm { quantity, in_space: false } => {
                write!(f, "--quantity {quantity}: an arm in the plane has no such quantity; it has tip.x, tip.y, tip.theta, tip.alpha and the strokes of its cables")
            }
            Self::NoCable { asked, cables } => {
                write!(f, "--quantity stroke[{asked}]: the arm has {cables} cables, counted from 0")
            }
            Self::File(errors) => {
                for (k, error) in errors.iter().enumerate() {
                    write!(f, "{}{error}", if k == 0 { "" } else { MORE })?;
                }
                Ok(())
            }
            Self::Input(why) => write!(f, "{STANDARD_INPUT}: {why}"),
            Self::InputTwice([a, b]) => {
                write!(f, "{a} and {b} are both -, and {STANDARD_INPUT} is read only once; name a file for one of them")
            }
            Self::Exists(path) => write!(f, "{} exists; remove it or choose another name", path.display()),
            Self::NoCommand(name, all) => write!(f, "`{name}` is not a command; the commands are {}", all.join(", ")),
            Self::Declined => f.write_str("nothing was solved"),
            Self::Interrupted(time, resumable) => f.write_str(&interrupted(*time, *resumable)),
            Self::OtherRun(path) => write!(
                f,
                "--resume: {} is of another arm, other loads or other options; remove it, or choose another output",
                path.display()
            ),
            Self::NotResumable(path) => write!(
                f,
                "--resume: {}: only CSV grows as the motion goes on and can be resumed; go on from another output with --from",
                path.display()
            ),
            Self::ShapesNowhere => f.write_str("--shapes: nowhere to write them; give --shapes-output, or -o FILE.json"),
            Self::PastTheTip(s, length) => {
                write!(f, "--station {s} m: expected a place in [0, {length}] m along the arm")
            }
            Self::EndsBefore { until, start } => {
                write!(f, "--until {until} s: expected a time after the start at {start} s")
            }
            Self::NothingDrawn(option, pictures) => write!(f, "{option}: nothing is drawn; give {pictures}"),
            Self::NothingMeasured(path) => {
                let path = path.display();
                write!(f, "{path}: there is no measured value; fill in x and y, or another measured quantity")
            }
        }
    }
}

impl std::error::Error for WrongRequest {}

fn unknown_arm(name: &str) -> String {
    let shipped: Vec<&str> = shipped_names().collect();
    let hint = nearest(name).map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    format!("`{name}` is neither a file nor an arm that ships with the program ({}){hint}", shipped.join(", "))
}

fn only_words(keys: &[String]) -> String {
    let keys = keys.join(", ");
    format!("the values of {keys} are words, and the axes of a map need numbers; --workspace FILE draws the tips alone")
}

fn coordinates(in_space: bool) -> &'static str {
    if in_space {
        "--target: expected X,Y,Z of an arm with `space = \"spatial\"`, found two coordinates"
    } else {
        "--target: expected X,Y of an arm in the plane, found three coordinates"
    }
}

fn interrupted(time: f64, resumable: bool) -> String {
    let hint = if resumable { "; resume with the same command and --resume" } else { "" };
    format!("interrupted after {time} s; the rows before are written{hint}")
}

fn nearest(name: &str) -> Option<&'static str> {
    let score = |candidate: &str| strsim::jaro_winkler(name, candidate);
    shipped_names().max_by(|a, b| score(a).total_cmp(&score(b))).filter(|best| score(best) > 0.75)
}

fn shipped_names() -> impl Iterator<Item = &'static str> {
    shipped::names().chain(shipped::spatial_names())
}
