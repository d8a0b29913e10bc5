//! `hydrostat figures`: the source's Fig. 1 as SVG, PNG and CSV.

use std::path::Path;

use hydrostat_figures::source::Study;
use hydrostat_files::{ArmFile, shipped, write_whole};

use crate::args::FiguresArgs;
use crate::output;

pub(crate) fn run(args: &FiguresArgs) -> anyhow::Result<()> {
    output::make_directory(&args.output)?;
    let files = write(&study()?, &args.output)?;
    let mut out = files.join("\n");
    out.push('\n');
    Ok(output::print(&out)?)
}

/// The shapes of the source's figure, solved.
pub(super) fn study() -> anyhow::Result<Study> {
    const NAME: &str = "paper";
    let text = shipped::get(NAME).unwrap_or_default();
    Ok(Study::of(&ArmFile::parse(text, NAME)?.arm()?)?)
}

/// Writes nine files and says which.
pub(super) fn write(study: &Study, directory: &Path) -> anyhow::Result<Vec<String>> {
    let mut files = Vec::new();
    for figure in study.figures() {
        let outputs =
            [("svg", figure.scene.svg().into_bytes()), ("png", figure.scene.png()?), ("csv", figure.csv.into_bytes())];
        for (ending, bytes) in outputs {
            let path = directory.join(format!("{}.{ending}", figure.name));
            write_whole(&path, &bytes)?;
            files.push(path.display().to_string());
        }
    }
    Ok(files)
}
