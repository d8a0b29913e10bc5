//! How far a fit is from measured places, and from load cases that were not fitted.

use hydrostat_files::number;
use hydrostat_identify::{Case, Fit, Miss, Prediction, misses};

use super::table::table;

/// Root mean squares of the residuals of load cases that were not fitted.
pub(super) fn predicted_cases(cases: &[Case], predicted: &[Prediction]) -> String {
    if predicted.is_empty() {
        return String::new();
    }
    let mut rows = vec![["case", "predicted"].map(str::to_owned).to_vec()];
    for one in predicted {
        let size = match &one.found {
            Ok((residuals, _)) => {
                let squares: f64 = residuals.iter().map(|own| own.standardised.powi(2)).sum();
                format!("{:.2}", (squares / residuals.len() as f64).sqrt())
            }
            Err(why) => format!("none: {why}"),
        };
        rows.push(vec![cases[one.case].name.clone(), size]);
    }
    let head = "\nresiduals of each load case that was not fitted, root mean square in standard deviations\n";
    format!("{head}{}", table(&rows, 0))
}

/// Distances of fitted and of predicted places from the measured ones, by marker.
pub(super) fn misses_table(found: &Fit, predicted: &[Prediction]) -> String {
    let fitted = misses(&found.residuals);
    let others =
        misses(predicted.iter().filter_map(|one| one.found.as_ref().ok()).flat_map(|(residuals, _)| residuals));
    if fitted.is_empty() && others.is_empty() {
        return String::new();
    }
    let mut head = ["s", "offset a, b, c", "fit", "largest"].map(str::to_owned).to_vec();
    if !predicted.is_empty() {
        head.extend(["predicted", "largest"].map(str::to_owned));
    }
    let mm = |length: f64| number((1e6 * length).round() / 1e3);
    let cells = |miss: Option<&Miss>| match miss {
        Some(miss) => [format!("{:.2}", 1e3 * miss.rms), format!("{:.2}", 1e3 * miss.most)],
        None => ["-", "-"].map(str::to_owned),
    };
    let mut rows = vec![head];
    let of = |all: &[Miss], own: &Miss| all.iter().find(|one| one.marker == own.marker).copied();
    for one in fitted.iter().chain(others.iter().filter(|other| of(&fitted, other).is_none())) {
        let offset = one.marker.offset.map(mm).join(", ");
        let mut row = vec![mm(one.marker.s), offset];
        row.extend(cells(of(&fitted, one).as_ref()));
        if !predicted.is_empty() {
            row.extend(cells(of(&others, one).as_ref()));
        }
        rows.push(row);
    }
    let head = "\ndistance from the measured to the fitted place of each marker, mm: root mean square over the load cases, and the largest\n";
    format!("{head}{}", table(&rows, 0))
}
