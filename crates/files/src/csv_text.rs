//! CSV as it is written here, and as spreadsheets of any country write it.

use csv::{Reader, ReaderBuilder, Terminator, Trim, Writer, WriterBuilder};

/// What parts the cells of a table, and so whether its numbers can have decimal commas.
///
/// ```
/// use hydrostat_files::Dialect;
///
/// let german = Dialect::of("s [mm];x [mm]\n122,5;110,25\n");
/// assert_eq!((german.delimiter, german.number("122,5")), (b';', Some(122.5)));
/// assert_eq!(Dialect::of("a,b\n1,2\n").number("1.5"), Some(1.5));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dialect {
    /// A comma, a semicolon or a tab.
    pub delimiter: u8,
}

impl Dialect {
    /// Of a text, by its first line that is neither empty nor a comment.
    pub fn of(text: &str) -> Self {
        let text = without_mark(text);
        let first = text.lines().find(|line| !line.starts_with('#') && !line.trim().is_empty()).unwrap_or_default();
        let (mut counts, mut quoted) = ([0_usize; 3], false);
        for byte in first.bytes() {
            match byte {
                b'"' => quoted = !quoted,
                b';' if !quoted => counts[0] += 1,
                b'\t' if !quoted => counts[1] += 1,
                b',' if !quoted => counts[2] += 1,
                _ => {}
            }
        }
        let [semicolons, tabs, commas] = counts;
        let delimiter = match () {
            () if semicolons > commas => b';',
            () if tabs > commas => b'\t',
            () => b',',
        };
        Self { delimiter }
    }

    /// How tables are read: rows of any length, without a row of heads of its own, cells without the blanks around them.
    pub fn reader(self) -> ReaderBuilder {
        let mut builder = ReaderBuilder::new();
        builder.has_headers(false).flexible(true).delimiter(self.delimiter).trim(Trim::All);
        builder
    }

    /// A number as text with a decimal point.
    pub fn plain(self, cell: &str) -> String {
        if self.delimiter == b',' { cell.to_owned() } else { cell.replace(',', ".") }
    }

    /// A finite number.
    pub fn number(self, cell: &str) -> Option<f64> {
        self.plain(cell).parse().ok().filter(|value: &f64| value.is_finite())
    }
}

/// Whether a cell says that nothing was measured: it is empty, `NaN` or `NA`.
pub fn is_missing(cell: &str) -> bool {
    cell.is_empty() || ["nan", "na", "n/a"].iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// A text without the mark that some programs begin UTF-8 with.
pub(crate) fn without_mark(text: &str) -> &str {
    text.trim_start_matches('\u{feff}')
}

/// The rows of a text in which lines that begin with # do not count.
pub(crate) fn records(text: &str, dialect: Dialect) -> Reader<&[u8]> {
    dialect.reader().comment(Some(b'#')).from_reader(text.as_bytes())
}

/// The lines of rows, asked for from the first to the last. A row's position is where the one before ends: ends of lines, empty lines and
/// comments can stand between that and the row itself.
pub(crate) struct Lines<'a> {
    text: &'a str,
    at: usize,
    line: usize,
}

impl<'a> Lines<'a> {
    pub(crate) fn new(text: &'a str) -> Self {
        Self { text, at: 0, line: 1 }
    }

    pub(crate) fn of(&mut self, position: u64) -> usize {
        let bytes = self.text.as_bytes();
        let position = usize::try_from(position).unwrap_or(usize::MAX);
        while self.at < bytes.len() {
            let begins = self.at == 0 || matches!(bytes[self.at - 1], b'\n' | b'\r');
            let between = matches!(bytes[self.at], b'\n' | b'\r') || (begins && bytes[self.at] == b'#');
            if self.at >= position && !between {
                break;
            }
            if self.at >= position && bytes[self.at] == b'#' {
                let rest = &bytes[self.at..];
                self.at += rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
                continue;
            }
            self.line += usize::from(bytes[self.at] == b'\n');
            self.at += 1;
        }
        self.line
    }
}

/// How tables are written: commas, one `\n` a row, quotes where they are needed.
pub fn csv_writer() -> WriterBuilder {
    let mut builder = WriterBuilder::new();
    builder.flexible(true).terminator(Terminator::Any(b'\n'));
    builder
}

/// One row, with its end of line.
///
/// ```
/// assert_eq!(hydrostat_files::csv_row(&["a, b".to_owned(), "c".to_owned()]), "\"a, b\",c\n");
/// ```
pub fn csv_row(cells: &[String]) -> String {
    Rows::new(cells).text()
}

/// Rows on their way to a text.
pub(crate) struct Rows(Writer<Vec<u8>>);

impl Rows {
    /// With a row of heads.
    pub(crate) fn new(heads: &[String]) -> Self {
        let mut out = Self(csv_writer().from_writer(Vec::new()));
        out.row(heads);
        out
    }

    pub(crate) fn row(&mut self, cells: &[String]) {
        let written = self.0.write_record(cells);
        debug_assert!(written.is_ok(), "memory takes every row: {written:?}");
    }

    pub(crate) fn text(self) -> String {
        let bytes = self.0.into_inner().unwrap_or_default();
        // Cells are texts, and so is what stands between them.
        String::from_utf8(bytes).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_parts_cells_is_seen_outside_of_quotes() {
        for (text, delimiter) in [
            ("a,b\n", b','),
            ("\u{feff}a;b\n", b';'),
            ("# a;b;c\n\n\"x, y, z\";b\n", b';'),
            ("a\tb\n", b'\t'),
            ("a\n", b','),
            ("", b','),
        ] {
            assert_eq!(Dialect::of(text).delimiter, delimiter, "{text:?}");
        }
        let german = Dialect { delimiter: b';' };
        assert_eq!(
            (german.number("-1,5e3"), german.number("1.234,5"), german.number("inf")),
            (Some(-1500.0), None, None)
        );
        assert_eq!(Dialect { delimiter: b',' }.number("1,5"), None);
    }

    #[test]
    fn what_was_not_measured() {
        for cell in ["", "NaN", "nan", "NA", "n/a"] {
            assert!(is_missing(cell), "{cell}");
        }
        assert!(!is_missing("0") && !is_missing("-") && !is_missing("nano"));
    }

    #[test]
    fn cells_are_read_as_they_were_written() {
        let cells = ["plain", "a,b", "say \"so\"", "", "two\nlines", "\"", ",,", "\r\n"].map(str::to_owned);
        let mut rows = Rows::new(&cells);
        rows.row(&cells);
        let text = rows.text();
        let mut reader = Dialect::of(&text).reader().trim(Trim::None).from_reader(text.as_bytes());
        let read: Vec<_> = reader.records().map(Result::unwrap).collect();
        assert!(read.len() == 2 && read.iter().all(|row| row.iter().eq(cells.iter().map(String::as_str))));
    }
}
