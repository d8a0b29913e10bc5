//! A report as Markdown, with its figures as files beside it.

use std::fmt::Write as _;

use crate::numbers::size;
use crate::report::{Block, Check, Report, Table};

/// The text, and the files that it shows.
#[derive(Debug, Clone)]
pub struct Markdown {
    /// The text.
    pub text: String,
    /// Paths from the text's place, and what they hold.
    pub figures: Vec<(String, String)>,
}

/// The report as Markdown.
pub fn markdown(report: &Report) -> Markdown {
    let mut out = format!("# {}\n\n{}\n", report.title, verdict(report.checks(), report.failures()));
    for text in &report.about {
        let _ = write!(out, "\n{text}\n");
    }
    for section in &report.sections {
        let _ = write!(out, "\n## {}\n\n{}\n", section.title, verdict(section.checks(), section.failures()));
        for block in &section.blocks {
            out.push('\n');
            match block {
                Block::Text(text) => {
                    let _ = writeln!(out, "{text}");
                }
                Block::Table(table) => write_table(&mut out, table),
                Block::Figure(figure) => {
                    let _ = writeln!(out, "![{}]({})", figure.caption, path(&figure.name));
                }
            }
        }
    }
    let figures = report.figures().map(|figure| (path(&figure.name), figure.scene.svg())).collect();
    Markdown { text: out, figures }
}

fn path(name: &str) -> String {
    format!("figures/{name}.svg")
}

fn verdict(checks: usize, failures: usize) -> String {
    match (checks, failures) {
        (0, _) => "No checks.".to_owned(),
        (1, 0) => "1 check, which holds.".to_owned(),
        (_, 0) => format!("{checks} checks, all hold."),
        _ => format!("**{failures} of {checks} checks FAIL.**"),
    }
}

fn write_table(out: &mut String, table: &Table) {
    let _ = write!(out, "**{}**\n\n", table.caption);
    let checked = table.has_checks();
    let mut heads = table.columns.clone();
    if checked {
        heads.extend(["off", "allowed", ""].map(str::to_owned));
    }
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    out.push_str(&line(&heads));
    out.push_str(&line(&vec!["---".to_owned(); heads.len()]));
    for row in &table.rows {
        let mut cells = row.cells.clone();
        if checked {
            cells.extend(row.check.map_or_else(|| [const { String::new() }; 3], |check| said(&check)));
        }
        out.push_str(&line(&cells));
    }
    let _ = write!(out, "\nReference: {}\n", table.source);
}

/// The deviation, what is allowed, and whether it holds.
fn said(check: &Check) -> [String; 3] {
    let word = if check.holds() { "holds" } else { "**FAILS**" }.to_owned();
    if check.allowed == 0.0 {
        return [String::new(), String::new(), word];
    }
    [size(check.off), size(check.allowed), word]
}
