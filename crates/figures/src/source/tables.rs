//! The numbers of the figures as CSV.

use hydrostat::Configuration;

use super::solves::{speed, tension};

const STATIONS: u32 = 201;

/// Places along an arm, m.
fn places(configuration: &Configuration) -> impl Iterator<Item = f64> + use<> {
    let length = configuration.arm.length;
    (0..STATIONS).map(move |k| length * f64::from(k) / f64::from(STATIONS - 1))
}

/// Heads, and a row of numbers for each entry of `rows`.
fn table(heads: &[&str], rows: impl Iterator<Item = Vec<f64>>) -> String {
    let mut out = csv::Writer::from_writer(Vec::new());
    // Memory takes every row.
    let _ = out.write_record(heads);
    for row in rows {
        let _ = out.write_record(row.iter().map(|value| format!("{value:?}")));
    }
    String::from_utf8(out.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// Shapes: one row a station, one block of rows an arm.
pub(super) fn shapes(configurations: &[Configuration]) -> String {
    let heads = [
        "T1_N",
        "v_inf_m_s",
        "s_m",
        "x_m",
        "y_m",
        "theta_rad",
        "alpha_rad",
        "nu",
        "beta",
        "left_x_m",
        "left_y_m",
        "right_x_m",
        "right_y_m",
    ];
    let row = |c: &Configuration, s: f64| {
        let at = c.at(s);
        let [left, right] = c.surfaces(s);
        let station = [at.x, at.y, at.theta, at.alpha, at.nu, at.beta];
        [&[tension(c), speed(c), s][..], &station, &left, &right].concat()
    };
    table(&heads, configurations.iter().flat_map(|c| places(c).map(move |s| row(c, s))))
}

/// Section rotation along the arm.
pub(super) fn angles(configurations: &[&Configuration]) -> String {
    let row = |c: &Configuration, s: f64| vec![tension(c), speed(c), s, c.at(s).alpha.to_degrees()];
    let rows = configurations.iter().flat_map(|c| places(c).map(move |s| row(c, s)));
    table(&["T1_N", "v_inf_m_s", "s_m", "alpha_deg"], rows)
}
