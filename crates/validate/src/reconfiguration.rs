//! A flexible blade in ever faster streams: it bends out of the way, and its drag grows with the power 4/3 of the speed, not 2.

use hydrostat::{Arm, Configuration, Options, Solver, cases};
use hydrostat_figures::{Measure, Page, Panel, Scale, lines_figure};
use rayon::prelude::*;

use crate::numbers::{fixed, size};
use crate::report::{Check, Row, Section, Table};
use crate::scope::Scope;

const SOURCE: &str = "F. Gosselin, E. de Langre, B. A. Machado-Almeida, Drag reduction of flexible plates by reconfiguration, Journal of Fluid Mechanics 650 \
    (2010), 319-341: a rectangular plate under drag normal to it, Vogel exponent -2/3; the same exponent for a fibre in a free-streamline flow: S. Alben, \
    M. Shelley, J. Zhang, Drag reduction through self-similar bending of a flexible body, Nature 420 (2002), 479-481. Rigid limit: the square of the speed.";

/// An inextensible blade clamped across a stream, in drag normal to it alone, at a Cauchy number Ca = 1/2 rho C_n D U^2 L^3/EI.
fn blade(ca: f64) -> Option<Arm> {
    // The first of the tables' blades, whose Cauchy number is one, in another stream.
    let mut arm = cases::normal_drag().into_iter().next()?.arm;
    arm.flow.speed *= ca.sqrt();
    Some(arm)
}

/// Its drag over EI/L^2.
fn drag(solved: &Configuration) -> f64 {
    -solved.base_reaction.force[0]
}

/// Cauchy number, drag over EI/L^2, tip angle from the stream in degrees; what could not be solved is not a number.
fn at(ca: f64) -> [f64; 3] {
    let solved = blade(ca).and_then(|arm| Solver::new(&arm, Options::with_tol(1e-9)).and_then(|mut s| s.solve()).ok());
    solved.map_or([ca, f64::NAN, f64::NAN], |solved| [ca, drag(&solved), solved.tip().theta.to_degrees()])
}

pub(crate) fn section(scope: Scope) -> Section {
    let per_decade = if scope == Scope::Quick { 1 } else { 4 };
    let numbers: Vec<f64> =
        (-2 * per_decade..=6 * per_decade).map(|k| 10_f64.powf(f64::from(k) / f64::from(per_decade))).collect();
    let solved: Vec<[f64; 3]> = numbers.par_iter().map(|ca| at(*ca)).collect();
    let mut section = Section::new("reconfiguration", "Drag of a flexible blade");
    section.text(
        "A slender blade clamped across a stream that loads it with drag normal to it alone (the second flow law, C_t = 0; an inextensible arm with volume = \
         none). A rigid one would carry Ca = 1/2 rho C_n D U^2 L^3/EI in units of EI/L^2. A soft one keeps only a length of the order (EI/(1/2 rho C_n D \
         U^2))^(1/3) across the stream, so that its drag grows as U^2 U^(-2/3) = U^(4/3).",
    );
    // The exponent by the speed is twice that by Ca: between neighbours, from solves 1 % to either side.
    let exponent = |ca: f64| {
        let [low, high] = [ca / 1.02, ca * 1.02].map(at);
        2.0 * (high[1] / low[1]).ln() / (high[0] / low[0]).ln()
    };
    let mut table = Table::new(
        "Drag D ~ U^p",
        SOURCE,
        &["Ca", "drag L^2/EI", "drag / rigid drag", "tip from the stream (deg)", "p", "known"],
    );
    let mut shown = Vec::new();
    for digits in -2..=6 {
        let ca = 10_f64.powi(digits);
        let [_, drag, angle] = at(ca);
        let p = exponent(ca);
        shown.push([ca, p]);
        let limit = match digits {
            ..=-2 => Some((2.0, 1e-3)),
            4.. => Some((4.0 / 3.0, 0.01)),
            _ => None,
        };
        let known = limit.map_or_else(String::new, |(known, _)| fixed(known, 4));
        let row = Row::new([format!("{ca}"), fixed(drag, 5), fixed(drag / ca, 5), fixed(angle, 3), fixed(p, 4), known]);
        table.push(match limit {
            Some((known, allowed)) => row.checked(Check::within(p - known, allowed)),
            None => row,
        });
    }
    section.table(table);
    // In the limit drag over Ca^(2/3) is a number: how far it still moves over the last two decades.
    let settled: Vec<f64> = [1e4, 1e6].iter().map(|ca| at(*ca)[1] / ca.powf(2.0 / 3.0)).collect();
    section.text(format!(
        "In the limit drag L^2/EI is {} Ca^(2/3); the factor moves by {} of itself from Ca = 1e4 to 1e6.",
        fixed(settled[1], 4),
        size((settled[1] / settled[0] - 1.0).abs())
    ));
    let logarithmic = |title: &str| Measure { title: title.to_owned(), scale: Scale::Logarithmic };
    let rigid = numbers.iter().map(|ca| [*ca, *ca]).collect();
    let limit = numbers.iter().filter(|ca| **ca >= 1.0).map(|ca| [*ca, settled[1] * ca.powf(2.0 / 3.0)]).collect();
    let panels = [
        Panel {
            up: logarithmic("drag L²/EI"),
            lines: vec![solved.iter().map(|p| [p[0], p[1]]).collect(), rigid, limit],
        },
        Panel { up: Measure { title: "exponent p".to_owned(), scale: Scale::Even }, lines: vec![shown] },
    ];
    section.figure(
        "reconfiguration",
        "Drag of the blade, of a rigid one, and the large-flow limit Ca^(2/3), that is U^(4/3); below the exponent of the speed, from 2 to 4/3.",
        lines_figure("a blade across a stream", &logarithmic("Cauchy number"), &["Hydrostat", "rigid", "limit"], &panels, &Page::default()),
    );
    section
}
