//! `hydrostat figures`: the source's Fig. 1 as SVG, PDF, PNG and CSV, and what its text says about it.

use std::fmt::Write as _;
use std::path::Path;

use hydrostat_figures::source::{Claim, Finding, Shown, Study};
use hydrostat_files::write_whole;

use crate::args::{FiguresArgs, PageArgs};
use crate::{output, request};

pub(crate) fn run(args: &FiguresArgs) -> anyhow::Result<()> {
    let shown = Shown { at_highest: args.at_highest, faster: args.faster.0.clone() };
    let arm = request::arm_of(&request::arm_file(&args.arm)?, "`hydrostat figures`")?;
    let read = [request::arm_input(&args.arm)];
    for name in ["fig1a", "fig1b", "fig1c"] {
        for ending in ["svg", "png", "csv"] {
            request::check_not_read(&read, "-o", &args.output.join(format!("{name}.{ending}")))?;
        }
    }
    let directory = output::make_directory(&args.output)?;
    let study = Study::of(&arm, &shown)?;
    let files = write(&study, &args.output, &args.page)?;
    directory.keep();
    let out = format!("{}\n{}\n", table(&study.claims), files.join("\n"));
    Ok(output::print(&out)?)
}

/// Writes twelve files and says which.
pub(super) fn write(study: &Study, directory: &Path, page: &PageArgs) -> anyhow::Result<Vec<String>> {
    let mut files = Vec::new();
    for figure in study.figures(&page.page()) {
        let scene = &figure.scene;
        let svg = output::svg(scene, page).into_bytes();
        let outputs = [("svg", svg), ("pdf", scene.pdf()), ("png", scene.png()?), ("csv", figure.csv.into_bytes())];
        for (ending, bytes) in outputs {
            let path = directory.join(format!("{}.{ending}", figure.name));
            write_whole(&path, &bytes)?;
            files.push(path.display().to_string());
        }
    }
    Ok(files)
}

const WIDTH: usize = 100;
const INDENT: usize = 19;

/// The claims, one below the other: finding, statement, numbers.
pub(super) fn table(claims: &[Claim]) -> String {
    let mut out = "What the source says about its Fig. 1, and what the model gives\n\n".to_owned();
    for claim in claims {
        let mut finding = claim.finding.words();
        for line in wrapped(claim.statement, WIDTH - INDENT) {
            let _ = writeln!(out, "{finding:INDENT$}{line}");
            finding = "";
        }
        for line in wrapped(&claim.evidence, WIDTH - INDENT - 2) {
            let _ = writeln!(out, "{:INDENT$}  {line}", "");
        }
    }
    let count = |finding: Finding| claims.iter().filter(|c| c.finding == finding).count();
    let all = [Finding::Holds, Finding::InPart, Finding::DoesNotHold, Finding::Open];
    let counts: Vec<String> = all.iter().map(|f| format!("{}: {}", f.words(), count(*f))).collect();
    let _ = writeln!(out, "\n{}", counts.join(", "));
    out
}

/// `text` in lines of at most `width` characters.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("never empty");
        if line.is_empty() {
            line.push_str(word);
        } else if line.chars().count() + 1 + word.chars().count() <= width {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}
