//! What the user asked for, before anything is solved.

use std::path::{MAIN_SEPARATOR, Path};

use hydrostat::{Arm, ArmError, SolveError};
use hydrostat_files::{ArmFile, Dimension, FileError, is_same_file, shared_unit, shipped, unit_slips};

use crate::args::{ArmArgs, PictureArgs};
pub(crate) use crate::wrong_request::WrongRequest;
use crate::{input, output, say};

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

/// The arm that is asked for, in the plane or in space: a file, then what overrides it.
pub(crate) fn arm_in_space(args: &ArmArgs) -> anyhow::Result<Arm> {
    arm_anywhere(&overridden(args)?)
}

/// The arm that a file means, for `command`, which is for arms in the plane.
pub(crate) fn arm_of(file: &ArmFile, command: &'static str) -> anyhow::Result<Arm> {
    let arm = arm_anywhere(file)?;
    if arm.space.is_some() {
        let planar: SolveError = ArmError::OnlyInPlane { what: command }.into();
        return Err(planar.into());
    }
    Ok(arm)
}

/// The arm of a file, in the plane or in space. Numbers that look like a slip of the unit are named on standard error.
pub(crate) fn arm_anywhere(file: &ArmFile) -> anyhow::Result<Arm> {
    let arm = file.arm().map_err(|first| wrong(file, first))?;
    for slip in unit_slips(&arm) {
        say::warning(slip);
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
    (input::is_standard(arm) || is_file(arm)).then(|| ("ARM", input::source(Path::new(arm))))
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
        if let Some(file) = output::file(file) {
            output::check_writable(file)?;
        }
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
    let is_own = |read: &Path| output::file(file).is_some_and(|file| is_same_file(read, file));
    match inputs.iter().flatten().find(|(_, read)| is_own(read)) {
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
