//! A set looked at again, more closely: at other tensions, in other streams, at a tighter tolerance.

use std::fmt::Write as _;

use hydrostat::{Configuration, Options, Solver};

use crate::set::Set;
use crate::statements::{Statement, compare, tip_angle};

/// Tip error over L that is asked for.
const TOL: f64 = 1e-10;
/// Streams, m/s.
pub const SPEEDS: [f64; 6] = [0.0, 0.25, 0.5, 0.75, 1.0, 2.0];
/// Tensions over the highest.
pub const SHARES: [f64; 5] = [0.25, 0.5, 0.75, 0.9, 1.0];

/// A row for each tension and each pair of neighbouring streams: by how much the statements about streams hold. Where a stream
/// has no shape there is no row.
pub fn verification(set: &Set, highest: f64) -> String {
    let mut out = "tension_N,share,slow_m_per_s,fast_m_per_s,alpha_tip_slow_deg,alpha_tip_fast_deg,turned_slow_deg,\
                   deforms_less,tip_turns_less_deg,grows_along,locally_smaller_deg\n"
        .to_owned();
    for share in SHARES {
        let tension = share * highest;
        let shape = |speed: &f64| -> Option<Configuration> {
            Solver::new(&set.arm(tension, *speed), Options::with_tol(TOL)).and_then(|mut solver| solver.solve()).ok()
        };
        let shapes: Vec<Option<Configuration>> = SPEEDS.iter().map(shape).collect();
        for (pair, speeds) in shapes.windows(2).zip(SPEEDS.windows(2)) {
            let (Some(slow_shape), Some(fast_shape)) = (&pair[0], &pair[1]) else { continue };
            let margins = compare(slow_shape, fast_shape);
            let margin = |statement: Statement| {
                margins.iter().find(|(own, _)| *own == statement).map_or(f64::NAN, |(_, margin)| *margin)
            };
            let [slow, fast] = [slow_shape, fast_shape].map(tip_angle);
            let _ = writeln!(
                out,
                "{tension:.6},{share},{},{},{slow:.5},{fast:.5},{:.4},{:.6},{:.6},{:.6},{:.6}",
                speeds[0],
                speeds[1],
                slow_shape.tip().theta.to_degrees(),
                margin(Statement::DeformsLess),
                margin(Statement::TipTurnsLess),
                margin(Statement::GrowsAlong),
                margin(Statement::LocallySmaller),
            );
        }
    }
    out
}
