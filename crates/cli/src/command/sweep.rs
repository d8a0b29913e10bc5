//! `hydrostat sweep`: an arm over grids and samples of its file's keys.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use anyhow::Context as _;
use hydrostat::SolveError;
use hydrostat_sweep::{Plan, Sample, Summary, Sweep, SweepError, SweepOptions, note_beside};
use indicatif::{ProgressBar, ProgressStyle};

use super::NoAnswer;
use crate::args::SweepArgs;
use crate::{exit, output, request};

pub(crate) fn run(args: &SweepArgs) -> anyhow::Result<()> {
    let file = request::overridden(&args.arm)?;
    let plan =
        Plan::new(args.vary.clone(), args.sample.unwrap_or(Sample::Grid), args.seed).map_err(SweepError::from)?;
    let options = SweepOptions {
        tol: args.tol,
        snaps: args.snaps.bounds(),
        outputs: args.columns.clone(),
        stations: args.shapes.unwrap_or(0),
        shard: args.shard,
    };
    let sweep = Sweep::new(&file, plan, &options).map_err(|error| match error {
        SweepError::Option(SolveError::Option { option, value, expected }) => {
            let message = format!("--{option}: expected a number {expected}, found {value}");
            anyhow::Error::new(error).context(message)
        }
        other => other.into(),
    })?;
    let beside = note_beside(&args.output);
    for file in [&args.output, &beside] {
        request::check_not_read(&[request::arm_input(&args.arm.file)], "-o", file)?;
    }
    output::check_writable(&args.output)?;
    let rows = sweep.rows();
    exit::at_ctrl_c("stopped: the same command with --resume goes on");
    let progress = Rate::new(rows.end - rows.start);
    let summary = sweep
        .run(&args.output, args.resume, args.threads.unwrap_or(0), &|done| progress.say(done))
        .map_err(anyhow::Error::new)?;
    progress.end();
    let Summary { rows, answered, .. } = summary;
    let warnings = warnings(&summary);
    if summary.damaged > 0 {
        let parts = if summary.damaged == 1 { "part" } else { "parts" };
        eprintln!("note: {} {parts} of an earlier run had changed since; solved again", summary.damaged);
    }
    let words = format!("{}: {rows} rows of {}, {answered} with an answer", args.output.display(), sweep.name());
    if answered == 0 {
        return Err(NoAnswer(format!("{words}: the column `verdict` says why"))).context(words);
    }
    eprintln!("{words}{}", progress.rate(&summary));
    if let Some(warnings) = warnings {
        eprintln!("note: {warnings}");
    }
    Ok(())
}

/// How many rows have which warning, the most frequent first; `None` where there is none.
fn warnings(summary: &Summary) -> Option<String> {
    let mut all: Vec<(&String, &u64)> = summary.warnings.iter().collect();
    all.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
    let of = |(kind, count): &(&String, &u64)| format!("{kind} in {count}");
    let all: Vec<String> = all.iter().map(of).collect();
    (!all.is_empty()).then(|| format!("warnings, of {} rows: {} (column `warnings`)", summary.rows, all.join(", ")))
}

/// How many rows are done, how fast, and how long the rest takes: a bar on a terminal, a line now and then elsewhere.
struct Rate {
    bar: ProgressBar,
    rows: u64,
    start: Instant,
    /// Rows that were there at the start, and when a line was last written.
    said: Mutex<(Option<u64>, Instant)>,
}

impl Rate {
    fn new(rows: u64) -> Self {
        let bar = ProgressBar::new(rows);
        let style =
            ProgressStyle::with_template("{bar:30} {percent}% {human_pos} of {human_len} rows, {per_sec}, {eta} left");
        if let Ok(style) = style {
            bar.set_style(style);
        }
        let start = Instant::now();
        Self { bar, rows, start, said: Mutex::new((None, start)) }
    }

    fn say(&self, done: u64) {
        const PAUSE: Duration = Duration::from_secs(30);
        let Ok(mut said) = self.said.lock() else { return };
        let resumed = *said.0.get_or_insert(done);
        if !self.bar.is_hidden() {
            if resumed > 0 && done == resumed {
                // What was there does not count as speed.
                self.bar.reset_eta();
            }
            self.bar.set_position(done);
        } else if said.1.elapsed() >= PAUSE {
            said.1 = Instant::now();
            let rate = (done - resumed.min(done)) as f64 / self.start.elapsed().as_secs_f64();
            let left = (self.rows - done.min(self.rows)) as f64 / rate;
            let percent = 100.0 * done as f64 / self.rows as f64;
            eprintln!("{percent:.1} %, {done} of {} rows, {rate:.0} rows/s, {left:.0} s left", self.rows);
        }
    }

    fn end(&self) {
        self.bar.finish_and_clear();
    }

    fn rate(&self, summary: &Summary) -> String {
        let seconds = self.start.elapsed().as_secs_f64();
        let solved = summary.rows - summary.resumed;
        if solved == 0 {
            return ", all there before".to_owned();
        }
        let before = if summary.resumed == 0 { String::new() } else { format!(", {} there before", summary.resumed) };
        format!("{before}, {:.1} s, {:.0} rows/s", seconds, solved as f64 / seconds)
    }
}
