//! The same solve so many times, for `.ci/instructions` to count what one takes: `again KIND REPEATS` with a kind of `cold`,
//! `warm`, `update`, `flag`, `ramped` (eleven arms that need the path) and `limit` (three that it ends for). Without arguments it says which path the solves run on, `wide-vectors` or `any-processor`.

#[path = "common/arms.rs"]
mod arms;
#[path = "common/sets.rs"]
mod sets;

use std::error::Error;
use std::hint::black_box;

use arms::pulled;
use hydrostat::{Arm, Options, Solver};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [kind, repeats] = arguments.as_slice() else {
        println!("{}", if hydrostat::has_wide_vectors() { "wide-vectors" } else { "any-processor" });
        return Ok(());
    };
    let repeats: usize = repeats.parse()?;
    let paper = pulled("paper", &[40.0, 0.0], 0.5)?;
    let cold = |arm: &Arm| Solver::new(arm, Options::default())?.solve();
    let mut solver = Solver::new(&paper, Options::default())?;
    let tensions = |round: usize| [if round.is_multiple_of(2) { 40.4 } else { 40.0 }, 0.0];
    match kind.as_str() {
        "cold" => (0..repeats).try_for_each(|_| cold(&paper).map(|found| drop(black_box(found))))?,
        "flag" => {
            let silicone = pulled("silicone", &[0.3, 0.0], 0.5)?;
            (0..repeats).try_for_each(|_| cold(&silicone).map(|found| drop(black_box(found))))?;
        }
        "warm" => {
            solver.solve()?;
            for round in 0..repeats {
                solver.set_tensions(&tensions(round))?;
                black_box(solver.configuration()?);
            }
        }
        "update" => {
            solver.solve()?;
            for round in 0..repeats {
                solver.set_tensions(&tensions(round))?;
                black_box(solver.update()?);
            }
        }
        "ramped" => {
            let arms = sets::ramped()?;
            let mut all = (0..repeats).flat_map(|_| &arms);
            all.try_for_each(|(_, arm)| cold(arm).map(|found| drop(black_box(found))))?;
        }
        "limit" => {
            let arms = sets::limit_points()?;
            (0..repeats).flat_map(|_| &arms).for_each(|(_, arm)| drop(black_box(cold(arm))));
        }
        other => return Err(format!("{other}: expected cold, warm, update, flag, ramped or limit").into()),
    }
    Ok(())
}
