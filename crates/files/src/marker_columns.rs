//! Tables with a column for each coordinate of each marker, as cameras write them: what to do about them.

use csv::StringRecord;

use crate::error::shortened;
use crate::heads::identifier;
use crate::measured_columns::head;

/// So many columns are named.
const MOST_NAMED: usize = 4;

/// The markers of a row of heads, such as m1 of `m1_x` and `m1_y`, with the columns of x and y.
fn markers(heads: &StringRecord) -> Vec<(String, [usize; 2])> {
    let names: Vec<String> = heads.iter().map(|head| identifier(&head.to_lowercase())).collect();
    let own = |name: &str| ["sd", "base_force"].contains(&name);
    let pair = |(at, name): (usize, &String)| {
        if heads.get(at).is_some_and(|text| head(text).is_ok()) {
            return None;
        }
        let marker = name.strip_suffix("_x").or_else(|| name.strip_prefix("x_")).filter(|marker| !own(marker))?;
        let partner = [format!("{marker}_y"), format!("y_{marker}")];
        let y = names.iter().position(|name| partner.contains(name))?;
        Some((marker.to_owned(), [at, y]))
    };
    names.iter().enumerate().filter_map(pair).collect()
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
    let case = (0..heads.len()).find(|at| !columns.contains(at)).map_or_else(|| "1".to_owned(), cell);
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
        assert!(of(&["x [mm]", "y [mm]", "x [cm]"]).is_empty());
        assert!(of(&["base force x", "base force y", "sd x", "sd y", "x", "y"]).is_empty());
    }
}
