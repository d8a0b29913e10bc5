//! Sets drawn evenly, and around the best of them.

use hydrostat_sweep::Sobol;
use rayon::prelude::*;

use crate::set::{COORDINATES, READINGS, Set};
use crate::statements::{Judged, Miss, judge};

/// Tolerance (tip over L) with which sets are judged: angles are then told apart to 1e-3 deg.
pub const TOL: f64 = 1e-8;
/// Draws around a set before the box about it shrinks.
const DRAWS: u64 = 24;
/// Width of the first box, of a coordinate's range, and by how much each next one is narrower.
const BOX: [f64; 2] = [0.4, 0.75];

/// A set with what became of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Its number in the sample.
    pub number: u64,
    /// The set.
    pub set: Set,
    /// How it stands to the statements.
    pub outcome: Result<Judged, Miss>,
}

impl Found {
    fn of(number: u64, set: Set) -> Self {
        Self { number, set, outcome: judge(&set.arm(0.0, 0.0), TOL) }
    }

    /// [`Judged::shortfall`]; infinite where the published angle is not reached.
    pub fn shortfall(&self, everywhere: bool) -> f64 {
        self.outcome.map_or(f64::INFINITY, |judged| judged.shortfall(everywhere))
    }
}

/// Which readings are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drawn {
    /// Those under which the load of the stream cannot jump: `centreline` and `tangential`, all else free.
    Smooth,
    /// All.
    All,
}

/// `count` sets of Sobol's sequence, judged in parallel; `done` is told of each.
pub fn sample(count: u64, seed: u64, readings: Drawn, done: impl Fn() + Sync) -> Vec<Found> {
    let sobol = Sobol::new(COORDINATES, seed);
    let one = |number: u64| {
        let mut place = [0.5; COORDINATES];
        for (own, drawn) in place.iter_mut().zip(sobol.point(number)) {
            *own = drawn;
        }
        if readings == Drawn::Smooth {
            for own in &mut place[READINGS + 1..READINGS + 3] {
                *own *= 0.5;
            }
        }
        let found = Found::of(number, Set::at(place));
        done();
        found
    };
    (0..count).into_par_iter().map(one).collect()
}

/// From each of the `starts` sets of least shortfall, `rounds` boxes, each drawn in about the best set so far and narrower than the
/// one before; readings stay. The best that each start led to, best first.
pub fn refine(found: &[Found], starts: usize, rounds: u32, everywhere: bool, seed: u64) -> Vec<Found> {
    let mut best: Vec<Found> = found.to_vec();
    best.sort_by(|a, b| a.shortfall(everywhere).total_cmp(&b.shortfall(everywhere)));
    best.retain(|one| one.outcome.is_ok());
    best.truncate(starts);
    let sobol = Sobol::new(READINGS, seed);
    let polish = |start: &Found| {
        let mut best = *start;
        let mut width = BOX[0];
        for round in 0..u64::from(rounds) {
            let centre = best.set.place;
            for draw in 0..DRAWS {
                let point = sobol.point(round * DRAWS + draw);
                let mut place = centre;
                for (own, drawn) in place.iter_mut().zip(point) {
                    *own = (*own + width * (drawn - 0.5)).clamp(0.0, 1.0);
                }
                let other = Found::of(start.number, Set::at(place));
                if other.shortfall(everywhere) < best.shortfall(everywhere) {
                    best = other;
                }
            }
            width *= BOX[1];
        }
        best
    };
    let mut out: Vec<Found> = best.par_iter().map(polish).collect();
    out.sort_by(|a, b| a.shortfall(everywhere).total_cmp(&b.shortfall(everywhere)));
    out
}
