//! Tables with a column for each coordinate of each marker, as cameras write them: what to do about them.

use csv::StringRecord;

use crate::error::shortened;
use crate::heads::{identifier, readings, unit_of};
use crate::measured_columns::head;
use crate::quantity::Dimension;

/// So many columns are named.
const MOST_NAMED: usize = 4;

/// The marker and the coordinate of a head, such as m1 and x of `m1_x`, `x_m1`, `m1x`, `x1` (marker 1) or `M1_x_mm`.
fn coordinate(head: &str) -> Option<(String, char)> {
    let name = head.to_lowercase();
    let is_length = |unit: &str| unit_of(Dimension::Length, unit).is_some();
    // With its unit first: `x1_mm` is no marker `1_mm`.
    let (with_unit, bare): (Vec<_>, Vec<_>) = readings(&name)
        .into_iter()
        .filter(|(_, unit)| unit.is_empty() || is_length(unit))
        .partition(|(_, u)| !u.is_empty());
    with_unit.into_iter().chain(bare).find_map(|(name, _)| parts(&identifier(name)))
}

/// A name without its unit, in its two parts.
fn parts(name: &str) -> Option<(String, char)> {
    let is_axis = |c: &char| ['x', 'y', 'z'].contains(c);
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let first = || {
        let axis = name.chars().next().filter(is_axis)?;
        let rest = &name[1..];
        rest.strip_prefix('_').or_else(|| is_number(rest).then_some(rest)).map(|marker| (marker, axis))
    };
    let last = || {
        let axis = name.chars().last().filter(is_axis)?;
        let rest = &name[..name.len() - 1];
        let has_number = rest.ends_with(|c: char| c.is_ascii_digit());
        rest.strip_suffix('_').or_else(|| has_number.then_some(rest)).map(|marker| (marker, axis))
    };
    let (marker, axis) = first().or_else(last)?;
    let own = ["", "sd", "base_force", "base_moment"].contains(&marker);
    (!own).then(|| (marker.to_owned(), axis))
}

/// The markers of a row of heads, such as m1 of `m1_x` and `m1_y`, with the columns of x and y.
fn markers(heads: &StringRecord) -> Vec<(String, [usize; 2])> {
    let all: Vec<Option<(String, char)>> =
        heads.iter().map(|text| if head(text).is_ok() { None } else { coordinate(text) }).collect();
    let pair = |(at, one): (usize, &Option<(String, char)>)| {
        let (marker, axis) = one.as_ref()?;
        let y = all.iter().position(|other| other.as_ref().is_some_and(|(own, axis)| own == marker && *axis == 'y'))?;
        (*axis == 'x').then(|| (marker.clone(), [at, y]))
    };
    all.iter().enumerate().filter_map(pair).collect()
}

/// How a table with a column for each coordinate of each marker is turned round; `None` of any other table. `first` is its first row of numbers.
pub(crate) fn hint(heads: &StringRecord, first: Option<&StringRecord>) -> Option<String> {
    let found = markers(heads);
    let (marker, [x, y]) = found.first()?;
    let mut names: Vec<String> = heads.iter().map(shortened).collect();
    let columns: Vec<usize> = found.iter().flat_map(|(_, places)| *places).collect();
    names = columns.iter().take(MOST_NAMED).map(|at| names[*at].clone()).collect();
    if columns.len() > MOST_NAMED {
        names.push("...".to_owned());
    }
    let cell = |at: usize| first.and_then(|row| row.get(at)).map_or_else(|| "...".to_owned(), shortened);
    let case = (0..heads.len()).find(|at| coordinate(&heads[*at]).is_none()).map_or_else(|| "1".to_owned(), cell);
    Some(format!(
        "has columns for each marker ({}): expected a row for each marker. Turn it round: heads \"case,s_mm,x_mm,y_mm\" with the units of the \
         file, and for each of its rows a row a marker, with the marker's place s along the arm; of {marker} in the first one \
         \"{case},s,{},{}\"",
        names.join(", "),
        cell(*x),
        cell(*y)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_are_pairs_of_columns() {
        let of =
            |heads: &[&str]| markers(&StringRecord::from(heads)).into_iter().map(|(name, _)| name).collect::<Vec<_>>();
        assert_eq!(of(&["frame", "time", "m1_x", "m1_y", "m2_x", "m2_y"]), ["m1", "m2"]);
        assert_eq!(of(&["Tip.X", "Tip.Y", "x_2", "y_2", "z_x"]), ["tip", "2"]);
        for heads in [
            ["x1", "y1", "x2", "y2"],
            ["x1_mm", "y1_mm", "x2_mm", "y2_mm"],
            ["1x", "1y", "2x", "2y"],
            ["x_1 [mm]", "y_1 [mm]", "x_2 [mm]", "y_2 [mm]"],
        ] {
            assert_eq!(of(&heads), ["1", "2"], "{heads:?}");
        }
        assert_eq!(of(&["marker1_x_mm", "marker1_y_mm", "marker1_z_mm"]), ["marker1"]);
        assert_eq!(of(&["frame", "P1_x_mm", "P1_y_mm", "P2_x_mm", "P2_y_mm"]), ["p1", "p2"]);
        assert_eq!(of(&["m1x", "m1y"]), ["m1"]);
        assert!(of(&["x [mm]", "y [mm]", "x [cm]"]).is_empty());
        assert!(of(&["base force x", "base force y", "sd x", "sd y", "x", "y"]).is_empty());
    }
}
