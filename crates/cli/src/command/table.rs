//! Tables for people.

use std::fmt::Write as _;

use hydrostat::{Configuration, SpatialTip, Stability, Tip};

/// Rows of cells in columns as wide as they need to be, numbers to the right and `words` last columns to the left.
pub(super) fn table(rows: &[Vec<String>], words: usize) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |c: usize| rows.iter().filter_map(|row| row.get(c)).map(|cell| cell.chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut out = String::new();
    for row in rows {
        let mut line = String::new();
        for (c, cell) in row.iter().enumerate() {
            let width = widths[c];
            line.push_str(if c == 0 { "" } else { "  " });
            let _ = if c + words < columns { write!(line, "{cell:>width$}") } else { write!(line, "{cell:<width$}") };
        }
        out.push_str(line.trim_end());
        out.push('\n');
    }
    out
}

/// The heads of [`tip_cells`].
pub(super) const TIP: [&str; 4] = ["x (mm)", "y (mm)", "turned (deg)", "alpha (deg)"];

/// Where the tip is, by how much it is turned, and alpha there.
pub(super) fn tip_cells(c: &Configuration) -> [String; 4] {
    place_cells(c.tip())
}

/// The heads of [`spatial_tip_cells`].
pub(super) const SPATIAL_TIP: [&str; 4] = ["x (mm)", "y (mm)", "z (mm)", "alpha (deg)"];

/// Where the tip is in space, and alpha there.
pub(super) fn spatial_tip_cells(tip: &SpatialTip) -> [String; 4] {
    let [x, y, z] = [tip.x, tip.y, tip.z].map(|v| decimals(1e3 * v, 3));
    [x, y, z, decimals(tip.alpha.to_degrees(), 3)]
}

/// The same of any place.
pub(super) fn place_cells(place: Tip) -> [String; 4] {
    [
        decimals(1e3 * place.x, 3),
        decimals(1e3 * place.y, 3),
        decimals(place.theta.to_degrees(), 3),
        decimals(place.alpha.to_degrees(), 3),
    ]
}

/// A number with so many decimals; zero has no sign.
pub(super) fn decimals(value: f64, count: usize) -> String {
    let text = format!("{value:.count$}");
    match text.strip_prefix('-') {
        Some(zero) if zero.bytes().all(|b| matches!(b, b'0' | b'.')) => zero.to_owned(),
        _ => text,
    }
}

/// A distance (m) in mm, of any size.
pub(super) fn distance_cell(distance: f64) -> String {
    let mm = 1e3 * distance;
    if mm < 1e-3 { format!("{mm:.1e}") } else { format!("{mm:.3}") }
}

/// A number of things: "1 target", "2 targets".
pub(super) fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// Stability in a word or two.
pub(super) fn stability_words(stability: Option<Stability>) -> String {
    match stability {
        Some(stability @ Stability::Unstable(count)) => format!("{} ({count})", stability.name()),
        Some(stability) => stability.name().to_owned(),
        None => "not established".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distance_beyond_a_millimetre_is_no_power_of_ten() {
        assert_eq!(distance_cell(0.116_65), "116.650");
        assert_eq!(distance_cell(6.94e-15), "6.9e-12");
        assert_eq!(counted(1, "target") + ", " + &counted(0, "jump"), "1 target, 0 jumps");
    }

    #[test]
    fn numbers_stand_right_and_words_left() {
        let row = |cells: [&str; 3]| cells.map(str::to_owned).to_vec();
        let text = table(&[row(["a", "long", "word"]), row(["10", "2", "w"])], 1);
        assert_eq!(text, " a  long  word\n10     2  w\n");
    }
}
