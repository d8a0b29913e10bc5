//! What a report holds, before it is HTML or Markdown.

use hydrostat_figures::Scene;

/// Sections of tables and figures.
#[derive(Debug, Clone)]
pub struct Report {
    /// Its title.
    pub title: String,
    /// Paragraphs before the first section.
    pub about: Vec<String>,
    /// In the order in which they are read.
    pub sections: Vec<Section>,
}

/// One subject.
#[derive(Debug, Clone)]
pub struct Section {
    /// Its anchor: lower-case letters and hyphens.
    pub id: &'static str,
    /// Its title.
    pub title: &'static str,
    /// What it says and shows.
    pub blocks: Vec<Block>,
}

/// A part of a section.
#[derive(Debug, Clone)]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// A table.
    Table(Table),
    /// A figure.
    Figure(Figure),
}

/// A drawing with what it shows.
#[derive(Debug, Clone)]
pub struct Figure {
    /// The stem of its file.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// The drawing.
    pub scene: Scene,
}

/// Rows of numbers, some of which are checks.
#[derive(Debug, Clone)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Where its reference numbers come from.
    pub source: String,
    /// Heads of the columns.
    pub columns: Vec<String>,
    /// Its rows.
    pub rows: Vec<Row>,
}

/// A row: a cell a column, and whether it holds.
#[derive(Debug, Clone)]
pub struct Row {
    /// As many as the table has columns.
    pub cells: Vec<String>,
    /// What it checks, if anything.
    pub check: Option<Check>,
}

/// A deviation beside what is allowed of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Check {
    /// Never negative where it is known; NaN where there is none, because something could not be solved.
    pub off: f64,
    /// The largest that holds.
    pub allowed: f64,
}

impl Check {
    /// Of a deviation, whose sign does not matter.
    pub fn within(off: f64, allowed: f64) -> Self {
        Self { off: off.abs(), allowed }
    }

    /// Of something that is so or is not.
    pub fn so(holds: bool) -> Self {
        Self { off: if holds { 0.0 } else { 1.0 }, allowed: 0.0 }
    }

    /// Whether it holds.
    pub fn holds(&self) -> bool {
        self.off <= self.allowed
    }
}

impl Row {
    /// A row that checks nothing.
    pub fn new<C: Into<String>>(cells: impl IntoIterator<Item = C>) -> Self {
        Self { cells: cells.into_iter().map(Into::into).collect(), check: None }
    }

    /// The same row as a check.
    pub fn checked(mut self, check: Check) -> Self {
        self.check = Some(check);
        self
    }
}

impl Table {
    /// An empty one.
    pub fn new(caption: impl Into<String>, source: impl Into<String>, columns: &[&str]) -> Self {
        let columns = columns.iter().map(|c| (*c).to_owned()).collect();
        Self { caption: caption.into(), source: source.into(), columns, rows: Vec::new() }
    }

    /// Adds a row.
    pub fn push(&mut self, row: Row) {
        self.rows.push(row);
    }

    /// Whether any of its rows is a check.
    pub fn has_checks(&self) -> bool {
        self.rows.iter().any(|row| row.check.is_some())
    }
}

impl Section {
    /// An empty one.
    pub fn new(id: &'static str, title: &'static str) -> Self {
        Self { id, title, blocks: Vec::new() }
    }

    /// Adds a paragraph.
    pub fn text(&mut self, text: impl Into<String>) {
        self.blocks.push(Block::Text(text.into()));
    }

    /// Adds a table.
    pub fn table(&mut self, table: Table) {
        self.blocks.push(Block::Table(table));
    }

    /// Adds a figure.
    pub fn figure(&mut self, name: impl Into<String>, caption: impl Into<String>, scene: Scene) {
        self.blocks.push(Block::Figure(Figure { name: name.into(), caption: caption.into(), scene }));
    }

    /// Its tables.
    pub fn tables(&self) -> impl Iterator<Item = &Table> {
        self.blocks.iter().filter_map(|block| if let Block::Table(table) = block { Some(table) } else { None })
    }

    fn all_checks(&self) -> impl Iterator<Item = &Check> {
        self.tables().flat_map(|table| &table.rows).filter_map(|row| row.check.as_ref())
    }

    /// How many checks it has.
    pub fn checks(&self) -> usize {
        self.all_checks().count()
    }

    /// How many of them do not hold.
    pub fn failures(&self) -> usize {
        self.all_checks().filter(|check| !check.holds()).count()
    }
}

impl Report {
    /// How many checks it has.
    pub fn checks(&self) -> usize {
        self.sections.iter().map(Section::checks).sum()
    }

    /// How many of them do not hold.
    pub fn failures(&self) -> usize {
        self.sections.iter().map(Section::failures).sum()
    }

    /// Whether all of them hold.
    pub fn holds(&self) -> bool {
        self.failures() == 0
    }

    /// Its figures.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        let blocks = self.sections.iter().flat_map(|section| &section.blocks);
        blocks.filter_map(|block| if let Block::Figure(figure) = block { Some(figure) } else { None })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_number_does_not_hold() {
        assert!(Check::within(-1e-9, 1e-9).holds());
        assert!(!Check::within(f64::NAN, 1e300).holds());
        assert!(!Check::within(2.0, 1.0).holds());
        assert!(Check::so(true).holds() && !Check::so(false).holds());
    }
}
