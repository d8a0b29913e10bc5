//! Draws sets, judges them, looks around the best and writes what they say.

use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use clap::Parser;
use hydrostat_study::{Drawn, refine, report, sample};

/// Which parameters satisfy what the source says of its Fig. 1.
#[derive(Debug, Parser)]
struct Args {
    /// Sets that are drawn
    #[arg(long, default_value_t = 1024)]
    sets: u64,
    /// Seed of the draws
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Draw the readings under which the load of the stream can jump, too
    #[arg(long)]
    all_readings: bool,
    /// Best sets that are looked around
    #[arg(long, default_value_t = 6)]
    starts: usize,
    /// Boxes about each of them
    #[arg(long, default_value_t = 8)]
    rounds: u32,
    /// Where tables and pictures go
    #[arg(short, long, default_value = "validation/study/results")]
    output: PathBuf,
}

fn main() -> anyhow::Result<()> {
    let args = Args::parse();
    let began = Instant::now();
    let done = AtomicU64::new(0);
    let step = (args.sets / 64).max(1);
    let readings = if args.all_readings { Drawn::All } else { Drawn::Smooth };
    let drawn = sample(args.sets, args.seed, readings, || {
        let count = done.fetch_add(1, Ordering::Relaxed) + 1;
        if count.is_multiple_of(step) {
            eprintln!("{count} of {} sets, {:.0} s", args.sets, began.elapsed().as_secs_f64());
        }
    });
    let scopes = [false, true].map(|everywhere| {
        let best = refine(&drawn, args.starts, args.rounds, everywhere, args.seed + 1);
        eprintln!("looked around the best, {:.0} s", began.elapsed().as_secs_f64());
        best
    });
    let text = report::write(&args.output, &drawn, &scopes)?;
    print!("{text}");
    Ok(())
}
