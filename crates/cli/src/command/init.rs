//! `hydrostat init`: an arm file to start from.

use std::path::Path;

use hydrostat::Arm;
use hydrostat_files::{ArmFile, commented_arm, write_whole};

use crate::args::InitArgs;
use crate::output;
use crate::request::{self, WrongRequest};

/// The arm that is written where none is asked for, with what makes it bend: a pull, a stream, and drag as it was measured.
const START: &str = "silicone";
const LOADS: [(&str, &str); 3] = [("cable[0].tension", "0.2"), ("flow.speed", "0.1"), ("flow.law", "quadratic-drag")];

pub(crate) fn run(args: &InitArgs) -> anyhow::Result<()> {
    let mut arm = match &args.from {
        Some(name) => request::shipped_arm(name)?,
        None => start()?,
    };
    if args.file == Path::new("-") {
        return Ok(output::print(&commented_arm(&arm))?);
    }
    if args.file.exists() {
        return Err(WrongRequest::Exists(args.file.clone()).into());
    }
    if let Some(name) = args.file.file_stem() {
        arm.name = name.to_string_lossy().into_owned();
    }
    write_whole(&args.file, commented_arm(&arm).as_bytes())?;
    let file = args.file.display();
    Ok(output::print(&format!("{file}: written; `hydrostat check {file}` shows all its values\n"))?)
}

fn start() -> anyhow::Result<Arm> {
    let mut file: ArmFile = request::shipped_file(START)?;
    for (key, value) in LOADS {
        file.set(key, value)?;
    }
    let mut arm = file.arm()?;
    "arm".clone_into(&mut arm.name);
    Ok(arm)
}
