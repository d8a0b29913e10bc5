//! A report as one HTML file, readable without a network.

use std::fmt::Write as _;

use crate::numbers::size;
use crate::report::{Block, Check, Report, Row, Section, Table};

const STYLE: &str = "\
:root { color-scheme: light; }
body { font: 16px/1.5 Georgia, 'Times New Roman', serif; color: #262626; background: #fff; max-width: 62rem; margin: 2rem auto 6rem; padding: 0 1.2rem; }
h1 { font-size: 1.7rem; margin-bottom: .4rem; } h2 { font-size: 1.25rem; margin-top: 3rem; border-bottom: 1px solid #ccc; padding-bottom: .2rem; }
p { max-width: 46rem; } nav ol { columns: 2; padding-left: 1.3rem; } a { color: #0072b2; }
table { border-collapse: collapse; font: 13px/1.4 system-ui, sans-serif; font-variant-numeric: tabular-nums; margin: 1.4rem 0 .2rem; }
caption { text-align: left; font-weight: 600; padding-bottom: .3rem; }
th { text-align: left; border-bottom: 1px solid #262626; font-weight: 600; padding: .15rem .8rem .15rem 0; vertical-align: bottom; }
td { border-bottom: 1px solid #e4e4e4; padding: .15rem .8rem .15rem 0; vertical-align: top; }
td.n, th.n { text-align: right; white-space: nowrap; }
.from { font: 13px/1.4 system-ui, sans-serif; color: #5a5a5a; margin: .1rem 0 1.2rem; max-width: 52rem; }
.holds { color: #007a5a; } .fails { color: #fff; background: #b33c00; padding: 0 .3rem; font-weight: 600; }
figure { margin: 1.4rem 0; } figure svg { max-width: 100%; height: auto; } figcaption { font: 13px/1.4 system-ui, sans-serif; color: #5a5a5a; max-width: 46rem; }
.wide { overflow-x: auto; }";

/// The report as HTML, with its figures inside.
pub fn html(report: &Report) -> String {
    let title = escaped(&report.title);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>{title}</title>\n<style>\n{STYLE}\n</style>\n</head>\n<body>\n<h1>{title}</h1>\n"
    );
    let _ = writeln!(out, "<p>{}</p>", verdict(report.checks(), report.failures()));
    for text in &report.about {
        let _ = writeln!(out, "<p>{}</p>", escaped(text));
    }
    out.push_str("<nav><ol>\n");
    for section in &report.sections {
        let _ = writeln!(
            out,
            "<li><a href=\"#{}\">{}</a>: {}</li>",
            section.id,
            escaped(section.title),
            verdict(section.checks(), section.failures())
        );
    }
    out.push_str("</ol></nav>\n");
    for section in &report.sections {
        write_section(&mut out, section);
    }
    out.push_str("</body>\n</html>\n");
    out
}

/// How many checks there are and how many of them do not hold.
fn verdict(checks: usize, failures: usize) -> String {
    match (checks, failures) {
        (0, _) => "no checks".to_owned(),
        (1, 0) => "<span class=\"holds\">1 check, which holds</span>".to_owned(),
        (_, 0) => format!("<span class=\"holds\">{checks} checks, all hold</span>"),
        _ => format!("<span class=\"fails\">{failures} of {checks} checks FAIL</span>"),
    }
}

fn write_section(out: &mut String, section: &Section) {
    let _ = writeln!(out, "<h2 id=\"{}\">{}</h2>", section.id, escaped(section.title));
    for block in &section.blocks {
        match block {
            Block::Text(text) => {
                let _ = writeln!(out, "<p>{}</p>", escaped(text));
            }
            Block::Table(table) => write_table(out, table),
            Block::Figure(figure) => {
                let caption = escaped(&figure.caption);
                let _ = writeln!(out, "<figure>\n{}<figcaption>{caption}</figcaption>\n</figure>", figure.scene.svg());
            }
        }
    }
}

fn write_table(out: &mut String, table: &Table) {
    let _ = write!(out, "<div class=\"wide\"><table>\n<caption>{}</caption>\n<tr>", escaped(&table.caption));
    let numeric: Vec<bool> = (0..table.columns.len()).map(|k| is_numeric(&table.rows, k)).collect();
    let class = |k: usize| if numeric[k] { " class=\"n\"" } else { "" };
    for (k, column) in table.columns.iter().enumerate() {
        let _ = write!(out, "<th{}>{}</th>", class(k), escaped(column));
    }
    if table.has_checks() {
        out.push_str("<th class=\"n\">off</th><th class=\"n\">allowed</th><th></th>");
    }
    out.push_str("</tr>\n");
    for row in &table.rows {
        out.push_str("<tr>");
        for (k, cell) in row.cells.iter().enumerate() {
            let _ = write!(out, "<td{}>{}</td>", class(k.min(numeric.len() - 1)), escaped(cell));
        }
        match &row.check {
            Some(check) => write_check(out, check),
            None if table.has_checks() => out.push_str("<td></td><td></td><td></td>"),
            None => {}
        }
        out.push_str("</tr>\n");
    }
    let _ = writeln!(out, "</table></div>\n<p class=\"from\">Reference: {}</p>", escaped(&table.source));
}

fn write_check(out: &mut String, check: &Check) {
    let said = if check.holds() { "<span class=\"holds\">holds</span>" } else { "<span class=\"fails\">FAILS</span>" };
    let _ = if check.allowed == 0.0 {
        write!(out, "<td></td><td></td><td>{said}</td>")
    } else {
        let (off, allowed) = (size(check.off), size(check.allowed));
        write!(out, "<td class=\"n\">{off}</td><td class=\"n\">{allowed}</td><td>{said}</td>")
    };
}

/// Whether a column is of numbers, which stand to the right.
fn is_numeric(rows: &[Row], column: usize) -> bool {
    let cells = rows.iter().filter_map(|row| row.cells.get(column)).filter(|cell| !cell.is_empty());
    let (numbers, all) = cells.fold((0, 0), |(n, all), cell| (n + usize::from(cell.parse::<f64>().is_ok()), all + 1));
    all > 0 && 2 * numbers > all
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_check_that_fails_is_seen() {
        let mut table = Table::new("a < b", "here & there", &["what", "here"]);
        table.push(Row::new(["x", "1"]).checked(Check::within(2.0, 1.0)));
        table.push(Row::new(["y", "2"]).checked(Check::so(true)));
        let mut section = Section::new("one", "One");
        section.table(table);
        let page = html(&Report { title: "t".to_owned(), about: vec!["<p>".to_owned()], sections: vec![section] });
        assert!(page.contains("1 of 2 checks FAIL") && page.contains("FAILS") && page.contains("a &lt; b"));
        assert!(page.contains("here &amp; there") && page.contains("&lt;p&gt;"));
        assert!(!page.contains("http://") && !page.contains("https://"));
    }
}
