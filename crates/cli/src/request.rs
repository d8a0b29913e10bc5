//! What the user asked for, before anything is solved.

use std::path::{MAIN_SEPARATOR, Path, PathBuf};

use hydrostat::parameter::Unfit;
use hydrostat::{Arm, ArmError, SolveError};
use hydrostat_files::{ArmFile, Dimension, FileError, PartialUnit, is_same_file, shared_unit, shipped, unit_slips};

use crate::args::{ArmArgs, PictureArgs};
use crate::{input, output};

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
    /// A sweep without an answer, or without a value in a column.
    NothingToDraw(PathBuf, Option<String>),
    /// What an option needs of a sweep and does not find.
    NotInSweep(&'static str, &'static str),
    /// Keys that give no map, and those of the sweep.
    Over(Vec<String>),
    /// A key whose values are words.
    Words(String),
    /// Numbers of other programs that cannot be read.
    Peers(PathBuf, String),
    /// A cable without a largest tension, where one is needed.
    Unbounded(String),
    /// A cable whose stroke was asked for.
    NoCable { asked: usize, cables: usize },
    /// A table of measurements without any.
    NothingMeasured(PathBuf),
    /// An option of pictures without one, and the options that ask for one.
    NothingDrawn(&'static str, String),
    /// More work than was meant.
    Declined,
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
            Self::UnknownArm(name) => {
                write!(f, "`{name}` is neither a file nor an arm that ships with the program (")?;
                for (i, shipped) in shipped::names().enumerate() {
                    write!(f, "{}{shipped}", if i == 0 { "" } else { ", " })?;
                }
                f.write_str(")")?;
                match nearest(name) {
                    Some(near) => write!(f, "; did you mean `{near}`?"),
                    None => Ok(()),
                }
            }
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
            Self::Peers(path, why) => write!(f, "--peers {}: {why}", path.display()),
            Self::Unbounded(cable) => {
                write!(
                    f,
                    "--boundary: cable {cable} has no largest tension; give --max-tension, or set `max_tension` in the arm file"
                )
            }
            Self::NoCable { asked, cables } => {
                write!(f, "--quantity stroke[{asked}]: the arm has {cables} cables, counted from 0")
            }
            Self::File(errors) => {
                for (k, error) in errors.iter().enumerate() {
                    write!(f, "{}{error}", if k == 0 { "" } else { "\nerror: " })?;
                }
                Ok(())
            }
            Self::Input(why) => write!(f, "{}: {why}", input::NAME),
            Self::InputTwice([a, b]) => {
                write!(f, "{a} and {b} are both -, and {} is read only once; name a file for one of them", input::NAME)
            }
            Self::Exists(path) => write!(f, "{} exists; remove it or choose another name", path.display()),
            Self::NoCommand(name, all) => write!(f, "`{name}` is not a command; the commands are {}", all.join(", ")),
            Self::Declined => f.write_str("nothing was solved"),
            Self::NothingDrawn(option, pictures) => write!(f, "{option}: nothing is drawn; give {pictures}"),
            Self::NothingMeasured(path) => {
                let path = path.display();
                write!(f, "{path}: there is no measured value; fill in x and y, or another measured quantity")
            }
        }
    }
}

impl std::error::Error for WrongRequest {}

fn nearest(name: &str) -> Option<&'static str> {
    let score = |candidate: &str| strsim::jaro_winkler(name, candidate);
    shipped::names().max_by(|a, b| score(a).total_cmp(&score(b))).filter(|best| score(best) > 0.75)
}

/// The arm file that `arm` names: a file if there is one or if it looks like a path, else an arm
/// that ships with the program. A file of the name of a shipped arm wins, as a file's contents are
/// the user's. `-` is standard input.
pub(crate) fn arm_file(arm: &str) -> anyhow::Result<ArmFile> {
    if input::is_standard(arm) {
        return Ok(ArmFile::parse_bytes(&input::bytes()?, input::NAME)?);
    }
    if is_file(arm) { Ok(ArmFile::read(Path::new(arm))?) } else { shipped_file(arm) }
}

/// Whether an arm is meant as a file.
fn is_file(arm: &str) -> bool {
    let path = Path::new(arm);
    let looks_like_path =
        arm.contains('/') || arm.contains(MAIN_SEPARATOR) || path.extension().is_some_and(|e| e == "toml");
    looks_like_path || path.is_file()
}

/// The file of an arm that ships with the program.
pub(crate) fn shipped_file(name: &str) -> anyhow::Result<ArmFile> {
    match shipped::get(name) {
        Some(text) => Ok(ArmFile::parse(text, name)?),
        None => Err(WrongRequest::UnknownArm(name.to_owned()).into()),
    }
}

/// The arm that ships under this name, whatever files there are.
pub(crate) fn shipped_arm(name: &str) -> anyhow::Result<Arm> {
    Ok(shipped_file(name)?.arm()?)
}

/// The arm that is asked for: a file, then what overrides it.
pub(crate) fn arm(args: &ArmArgs) -> anyhow::Result<Arm> {
    arm_of(&overridden(args)?)
}

/// The same, in the plane or in space.
pub(crate) fn arm_in_space(args: &ArmArgs) -> anyhow::Result<Arm> {
    arm_anywhere(&overridden(args)?)
}

/// The arm that a file means. Numbers that look like a slip of the unit are named on standard error.
pub(crate) fn arm_of(file: &ArmFile) -> anyhow::Result<Arm> {
    let arm = arm_anywhere(file)?;
    if arm.space.is_some() {
        return Err(SolveError::Arm(ArmError::OnlyInPlane { what: "this command" }).into());
    }
    Ok(arm)
}

/// The arm of a file, in the plane or in space.
pub(crate) fn arm_anywhere(file: &ArmFile) -> anyhow::Result<Arm> {
    let arm = file.arm().map_err(|first| wrong(file, first))?;
    for slip in unit_slips(&arm) {
        eprintln!("warning: {slip}");
    }
    Ok(arm)
}

/// Everything that is wrong with a file, whose `first` error is known.
fn wrong(file: &ArmFile, first: FileError) -> anyhow::Error {
    let all = file.errors();
    if all.len() > 1 { WrongRequest::File(all).into() } else { first.into() }
}

/// The file that is asked for with what overrides it.
pub(crate) fn overridden(args: &ArmArgs) -> anyhow::Result<ArmFile> {
    let mut file = arm_file(&args.file)?;
    for setting in &args.set {
        let Some((key, value)) = setting.split_once('=') else {
            return Err(WrongRequest::Setting(setting.clone()).into());
        };
        file.set(key.trim(), value.trim())?;
    }
    if let Some(speed) = &args.flow_speed {
        file.set_by(&format!("--flow-speed {speed}:"), "flow.speed", speed)?;
    }
    if let Some(tensions) = &args.tension {
        let cables = cables(&file);
        if tensions.len() != cables {
            // An arm that is wrong without them is the first thing to mend.
            file.arm().map_err(|first| wrong(&file, first))?;
            let error = ArmError::TensionCount { cables, given: tensions.len() };
            return Err(WrongRequest::Tensions(error).into());
        }
        let typed = format!("--tension {}:", tensions.join(","));
        let texts: Vec<&str> = tensions.iter().map(String::as_str).collect();
        let texts = shared_unit(Dimension::Force, "--tension", &texts, ",").map_err(WrongRequest::Unit)?;
        for (i, tension) in texts.iter().enumerate() {
            file.set_by(&typed, &format!("cable[{i}].tension"), tension)?;
        }
    }
    Ok(file)
}

/// A file that is read, and as what.
pub(crate) type Input<'a> = (&'static str, &'a Path);

/// The file of an arm, if it is read from one.
pub(crate) fn arm_input(arm: &str) -> Option<Input<'_>> {
    (!input::is_standard(arm) && is_file(arm)).then_some(("ARM", Path::new(arm)))
}

/// Refuses outputs that could not be written, and those that are files that are read, before the work: each option that names one, with
/// its file.
pub(crate) fn check_outputs(
    inputs: &[Option<Input<'_>>],
    outputs: &[(&'static str, Option<&Path>)],
) -> anyhow::Result<()> {
    let given: Vec<(&'static str, &Path)> =
        outputs.iter().filter_map(|(option, file)| Some((*option, (*file)?))).collect();
    for (i, (option, file)) in given.iter().enumerate() {
        if let Some((earlier, _)) = given[..i].iter().find(|(_, other)| is_same_file(other, file)) {
            return Err(WrongRequest::SamePath([earlier, option], (*file).to_owned()).into());
        }
        check_not_read(inputs, option, file)?;
    }
    for (_, file) in given {
        output::check_writable(file)?;
    }
    Ok(())
}

/// Refuses options of pictures where none is drawn: `pictures` are the options that ask for one, with their files.
pub(crate) fn check_picture(
    args: &PictureArgs,
    pictures: &[(&'static str, Option<&Path>)],
) -> Result<(), WrongRequest> {
    match args.given() {
        Some(option) if pictures.iter().all(|(_, file)| file.is_none()) => {
            let names: Vec<&str> = pictures.iter().map(|(name, _)| *name).collect();
            Err(WrongRequest::NothingDrawn(option, names.join(" or ")))
        }
        _ => Ok(()),
    }
}

/// Refuses an output that is a file that is read.
pub(crate) fn check_not_read(
    inputs: &[Option<Input<'_>>],
    option: &'static str,
    file: &Path,
) -> Result<(), WrongRequest> {
    match inputs.iter().flatten().find(|(_, read)| is_same_file(read, file)) {
        Some((input, _)) => Err(WrongRequest::Overwrites { option, path: file.to_owned(), input }),
        None => Ok(()),
    }
}

/// How many cables the file has, even while their present tensions are refused.
fn cables(file: &ArmFile) -> usize {
    // Far more than an arm has; counting is for a message.
    const MOST: usize = 1000;
    if let Ok(arm) = file.arm() {
        return arm.cables.len();
    }
    let mut probe = file.clone();
    (0..MOST).take_while(|i| probe.set(&format!("cable[{i}].tension"), "0").is_ok()).count()
}
