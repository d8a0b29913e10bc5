//! Five problems at several tolerances: evaluations, time and error, as JSON lines. `validation/peers/scipy_problems.py` sets them beside SciPy's.

#[path = "common/functions.rs"]
mod functions;
#[path = "common/problems.rs"]
mod problems;

use std::hint::black_box;
use std::time::Instant;

use hydrostat_bvp::{Options, solve};
use problems::{Bratu, Elastica, Known, Mathieu, Shock, Troesch};

/// Solves of which the fastest counts.
const REPEATS: usize = 20;

fn measure<P: Known<N>, const N: usize>(problem: &P) {
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let options = Options::with_tolerance(tolerance);
        let mut fastest = f64::INFINITY;
        for _ in 0..REPEATS {
            let start = Instant::now();
            let solved = black_box(solve(black_box(problem), &problem.guess(), &options));
            fastest = fastest.min(start.elapsed().as_secs_f64());
            if solved.is_err() {
                break;
            }
        }
        match solve(problem, &problem.guess(), &options) {
            Ok(sol) => println!(
                "{{\"problem\": \"{}\", \"tolerance\": {tolerance:e}, \"elements\": {}, \"evaluations\": {}, \
                 \"microseconds\": {:.1}, \"estimate\": {:e}, \"error\": {:e}}}",
                P::NAME,
                sol.statistics().elements,
                sol.statistics().evaluations,
                1e6 * fastest,
                sol.error(),
                problem.error(|s| sol.eval(s)),
            ),
            Err(error) => eprintln!("{} at {tolerance:e}: {error}", P::NAME),
        }
    }
}

fn main() {
    measure(&Bratu { lambda: 1.0, upper: true });
    measure(&Troesch { mu: 5.0, slope: TROESCH_5 });
    measure(&Shock { epsilon: 1e-4 });
    measure(&Mathieu { q: 5.0, characteristic: MATHIEU_4, order: 4 });
    measure(&Elastica { tip: 120.0_f64.to_radians() });
}

/// The slope v of Troesch's problem for mu = 5: the root of `sc(mu | 1 - v^2/4) v/2 = sinh(mu/2)`, with Jacobi's elliptic function sc (by SciPy).
const TROESCH_5: f64 = 4.575_046_140_631_8e-2;

/// The characteristic value a_4(5) of Mathieu's equation (SciPy's `mathieu_a`).
const MATHIEU_4: f64 = 17.096_581_684_366_047;
