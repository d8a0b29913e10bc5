//! `hydrostat` alone: the source's figure and what its text claims.

use std::fmt::Write as _;
use std::path::Path;

use hydrostat_figures::source::{Claim, Finding, SPEED, TIP_ANGLE};

use super::figures;
use crate::output;

pub(crate) fn run() -> anyhow::Result<()> {
    let directory = Path::new("figures");
    output::make_directory(directory)?;
    let study = figures::study()?;
    let files = figures::write(&study, directory)?;
    let mut out = table(&study.claims);
    let _ = writeln!(
        out,
        "\nOf the figure's parameters only the stream of {SPEED} m/s is published, and of its results {TIP_ANGLE} deg at \
         the highest\ntension. The arm `paper` is a set found by trial; with it that tension is {:.2} N.",
        study.highest_tension()
    );
    let _ = writeln!(out, "\nWritten: {}", files.join(", "));
    Ok(output::print(&out)?)
}

const WIDTH: usize = 100;
const INDENT: usize = 19;

/// The claims, one below the other: finding, statement, numbers.
fn table(claims: &[Claim]) -> String {
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
