//! Problems whose answers are known: closed forms and published tables.

use hydrostat::cases::{Case, HEAVY_COLUMN, Measure, column, column_buckling_load, heavy_column, uniform_arm};
use hydrostat::{Arm, Configuration, Options, Solver};

use crate::numbers::{fixed, larger, size};
use crate::report::{Check, Row, Section, Table};

/// What is asked of each solve, and what the answer may add to the error of the known value, over its size.
const TOL: f64 = 1e-11;

fn solve(arm: &Arm) -> Option<Configuration> {
    Solver::new(arm, Options::with_tol(TOL)).and_then(|mut solver| solver.solve()).ok()
}

fn name(measure: Measure) -> &'static str {
    match measure {
        Measure::TipX => "x(L)/L",
        Measure::TipY => "y(L)/L",
        Measure::TipTheta => "theta(L)",
        Measure::MiddleNu => "nu(L/2)",
        Measure::MiddleEta => "eta(L/2)",
        Measure::MiddleMu => "mu(L/2) L",
        Measure::MiddleBeta => "beta(L/2)",
    }
}

/// What makes a measure a number without a unit.
fn per_unit(measure: Measure, length: f64) -> f64 {
    match measure {
        Measure::TipX | Measure::TipY => 1.0 / length,
        Measure::MiddleMu => length,
        _ => 1.0,
    }
}

/// Digits that both numbers fraction, over the larger of the known one and one.
fn digits(off: f64, known: f64) -> String {
    let relative = off / known.abs().max(1.0);
    if relative == 0.0 { "all".to_owned() } else { fixed(-relative.log10(), 1) }
}

/// The section on `cases` and on columns. Public, so that a test can pass wrong numbers and see them found.
pub fn section(cases: &[Case]) -> Section {
    let mut section = Section::new("exact", "Exact answers");
    section.text(
        "Problems with closed forms, and tables computed independently (docs/model.md, section 11; crates/hydrostat/src/cases.rs), each solved to a \
         tolerance of 1e-11. A deviation may be that, over the value's size, and half of the last digit that the reference prints.",
    );
    let mut sources: Vec<&str> = cases.iter().map(|case| case.source).collect();
    sources.dedup();
    sources.sort_unstable();
    sources.dedup();
    for source in sources {
        let origin = if source == "classical closed form" {
            "closed forms, evaluated here to rounding: circular arcs of one cable for each volume law, straight compression, the end moment's circle."
        } else {
            "tables of the elastica under dead, shearing, distributed and following loads and under normal drag, to the digits with which \
             docs/model.md, section 11, gives them; computed independently of this program."
        };
        let mut table = Table::new(
            if source == "classical closed form" { "Closed forms" } else { "Tables" },
            origin,
            &["problem", "quantity", "here", "known", "digits"],
        );
        for case in cases.iter().filter(|case| case.source == source) {
            add(case, &mut table);
        }
        section.table(table);
    }
    section.table(columns());
    section.table(invariant());
    section
}

fn add(case: &Case, table: &mut Table) {
    let solved = solve(&case.arm);
    for quantity in &case.exact {
        let unit = per_unit(quantity.what, case.arm.length);
        let known = unit * quantity.value;
        let got = unit * solved.as_ref().map_or(f64::NAN, |solved| quantity.what.of(solved));
        let off = (got - known).abs();
        let allowed = unit * quantity.tolerance + TOL * known.abs().max(1.0);
        table.push(
            Row::new([
                case.name.clone(),
                name(quantity.what).to_owned(),
                fixed(got, 12),
                fixed(known, 12),
                digits(off, known),
            ])
            .checked(Check::within(off, allowed)),
        );
    }
}

/// Loads at which a straight column stops being stable, between a fraction below and a fraction above the known one.
fn columns() -> Table {
    const NEAR: f64 = 1e-3;
    let mut table = Table::new(
        "Buckling: the sign of the determinant changes within 0.1 % of the known load",
        "P (1 + P (1/GA - 1/EA)) = pi^2 EI/(4 L^2) for a clamped-free rod; q L^3/EI = 7.83734744 for a column under its own weight (the first zero \
         of a Bessel function of order -1/3).",
        &["column", "known load", "at 0.999 of it", "at 1.001 of it"],
    );
    let mut add = |name: String, known: f64, arm: &dyn Fn(f64) -> Arm| {
        let at = |fraction: f64| solve(&arm(fraction * known)).map(|solved| solved.stable != Some(false));
        let [below, above] = [1.0 - NEAR, 1.0 + NEAR].map(at);
        let words = |stands: Option<bool>| match stands {
            Some(true) => "stands",
            Some(false) => "unstable",
            None => "not solved",
        };
        table.push(
            Row::new([name, fixed(known, 8), words(below).to_owned(), words(above).to_owned()])
                .checked(Check::so(below == Some(true) && above == Some(false))),
        );
    };
    for (ea, ga) in [(1e6, 3e5), (2500.0, 800.0), (400.0, 130.0), (100.0, 33.0)] {
        if let Some(known) = column_buckling_load(ea, ga) {
            add(format!("EA = {ea}, GA = {ga}, end thrust"), known, &|load| column(ea, ga, load, 0.0));
        }
    }
    add("inextensible, own weight".to_owned(), HEAVY_COLUMN, &|load| heavy_column(load, 0.0));
    table
}

/// m^2/(2 EI) + n.a + (n.a)^2/(2 EA) + (n.b)^2/(2 GA) along arms whose contact force is constant.
fn invariant() -> Table {
    let mut table = Table::new(
        "The invariant along a uniform arm under dead tip loads",
        "m^2/(2 EI) + n.a + (n.a)^2/(2 EA) + (n.b)^2/(2 GA) is the same at every s: a first integral of the equations with volume = none.",
        &["EA, GA (N)", "force (N)", "moment (N m)", "value at the tip", "largest change along 97 places"],
    );
    for (ea, ga, force, moment) in [
        (50.0, 20.0, [0.0, 3.0], 0.0),
        (50.0, 20.0, [2.0, 3.0], -2.0),
        (200.0, 8.0, [-1.0, 0.7], 1.0),
        (1e4, 1e4, [0.5, -9.0], 4.0),
    ] {
        let mut arm = uniform_arm("invariant", ea, ga);
        arm.tip.force = force;
        arm.tip.moment = moment;
        let solved = solve(&arm);
        let value = |s: f64| {
            solved.as_ref().map_or(f64::NAN, |solved| {
                let st = solved.at(s);
                0.5 * st.m * st.m + st.n_a + 0.5 * st.n_a * st.n_a / ea + 0.5 * st.n_b * st.n_b / ga
            })
        };
        let at_tip = value(1.0);
        let off = (0..97).map(|k| (value(f64::from(k) / 97.0) - at_tip).abs()).fold(0.0, larger);
        table.push(
            Row::new([
                format!("{ea}, {ga}"),
                format!("{}, {}", force[0], force[1]),
                moment.to_string(),
                fixed(at_tip, 9),
                size(off),
            ])
            .checked(Check::within(off / at_tip.abs().max(1.0), 1e-10)),
        );
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use hydrostat::cases;

    /// A reference that is wrong in its seventh digit is found, and nothing else.
    #[test]
    fn a_wrong_reference_is_found() {
        let mut cases = cases::end_loads();
        assert_eq!(section(&cases).failures(), 0);
        cases[1].exact[0].value += 1e-7;
        assert_eq!(section(&cases).failures(), 1);
    }
}
