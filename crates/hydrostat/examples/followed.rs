//! Times of a path of targets followed: `cargo run --release -p hydrostat --example followed`.
//!
//! A target a point, each the tip at tensions that run round a loop; of every point the least of several rounds, since others may use
//! the machine.

#[path = "common/arms.rs"]
mod arms;

use std::error::Error;
use std::time::Instant;

use arms::pulled;
use hydrostat::{Follower, Options, ReachOptions, Solver, Target};

const POINTS: u32 = 300;
const ROUNDS: usize = 9;

fn main() -> Result<(), Box<dyn Error>> {
    for (name, cables) in [("silicone", 2), ("multi-bending", 6)] {
        let arm = pulled(name, &vec![0.0; cables], 0.0)?;
        let most = arm.cables[0].max_tension.ok_or("no largest tension")?;
        let last = cables - 1;
        let pulls = |k: u32| {
            let angle = f64::from(k) * std::f64::consts::TAU / f64::from(POINTS);
            let mut tensions = vec![0.0; last + 1];
            (tensions[0], tensions[last]) = (most * (0.25 + 0.1 * angle.cos()), most * (0.2 + 0.1 * angle.sin()));
            tensions
        };
        let mut solver = Solver::new(&arm, Options::with_tol(1e-9))?;
        let mut targets = Vec::new();
        for k in 0..=POINTS {
            solver.set_tensions(&pulls(k))?;
            let tip = solver.update()?.tip;
            targets.push(Target::tip(tip.x, tip.y));
        }
        let mut start = arm.clone();
        start.set_tensions(&pulls(0))?;
        let begin = Follower::new(&start, &targets[..1], &ReachOptions::default())?;
        let mut least = vec![f64::INFINITY; targets.len()];
        let (mut solves, mut missed) = (0, 0);
        for _ in 0..ROUNDS {
            let mut follower = begin.clone();
            (solves, missed) = (0, 0);
            for (target, least) in targets.iter().zip(&mut least) {
                let clock = Instant::now();
                let found = follower.follow(&[*target])?;
                *least = least.min(1e6 * clock.elapsed().as_secs_f64());
                solves += found.solves;
                missed += usize::from(!found.reached);
            }
        }
        least.remove(0);
        least.sort_by(f64::total_cmp);
        let fraction = |part: usize| least[part * (least.len() - 1) / 100];
        let solves = solves as f64 / f64::from(POINTS);
        println!(
            "{name}: {:.0} us median, {:.0} us in 95 %, {solves:.2} solves a point, {missed} missed",
            fraction(50),
            fraction(95)
        );
    }
    Ok(())
}
