//! `hydrostat` alone: the source's figure and what its text claims.

use std::fmt::Write as _;
use std::path::Path;

use hydrostat_figures::source::{SPEED, Shown, Study, TIP_ANGLE};

use super::figures;
use crate::args::PageArgs;
use crate::{output, request};

pub(crate) fn run() -> anyhow::Result<()> {
    let directory = Path::new("figures");
    let made = output::make_directory(directory)?;
    let study = Study::of(&request::shipped_arm("paper")?, &Shown::default())?;
    let files = figures::write(&study, directory, &PageArgs::default())?;
    made.keep();
    let mut out = figures::table(&study.claims);
    let _ = writeln!(
        out,
        "\nOf the figure's parameters only the stream of {SPEED} m/s is published, and of its results {TIP_ANGLE} deg at \
         the highest\ntension. The arm `paper` is a set found by trial; with it that tension is {:.2} N. That of \
         `paper-statements` meets\nevery statement at the highest tension, at a price (`hydrostat arms paper-statements`).",
        study.highest_tension()
    );
    let _ = writeln!(out, "\nWritten: {}", files.join(", "));
    Ok(output::print(&out)?)
}
