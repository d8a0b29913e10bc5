//! `hydrostat sweep`: an arm over grids and samples of its file's keys.

use anyhow::Context as _;
use hydrostat::SolveError;
use hydrostat_sweep::{Plan, Sample, Summary, Sweep, SweepError, SweepOptions, note_beside};

use super::{NoAnswer, wrong_option};
use crate::args::SweepArgs;
use crate::rate::{Rate, duration};
use crate::request::WrongRequest;
use crate::{exit, output, question, request};

/// Rows from which a sweep is asked about.
const MANY: u64 = 1_000_000_000;

pub(crate) fn run(args: &SweepArgs) -> anyhow::Result<()> {
    let file = request::overridden(&args.arm)?;
    // Wrong files and likely slips are told as everywhere.
    request::arm_anywhere(&file)?;
    let plan =
        Plan::new(args.vary.clone(), args.sample.unwrap_or(Sample::Grid), args.seed).map_err(SweepError::from)?;
    let options = SweepOptions {
        tol: args.tol,
        snaps: args.snaps.bounds(),
        after_snap: args.snaps.after_snap,
        outputs: args.columns.clone(),
        stations: args.shapes.unwrap_or(0),
        shard: args.shard,
    };
    let sweep = Sweep::new(&file, plan, &options).map_err(|error| match error {
        SweepError::Option(SolveError::Option { option, value, expected }) => {
            wrong_option(option, value, expected, error)
        }
        other => other.into(),
    })?;
    let beside = note_beside(&args.output);
    for file in [&args.output, &beside] {
        request::check_not_read(&[request::arm_input(&args.arm.file)], "-o", file)?;
    }
    output::check_writable(&args.output)?;
    let rows = sweep.rows();
    let count = rows.end - rows.start;
    if count >= MANY && !question::goes_on(&many(count)) {
        return Err(WrongRequest::Declined.into());
    }
    exit::at_ctrl_c("stopped: resume with the same command and --resume");
    let progress = Rate::new(count);
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
    let words = format!("{}: {rows} rows of {}, {answered} with an equilibrium", args.output.display(), sweep.name());
    if answered == 0 {
        return Err(NoAnswer(format!("{words}: the column `verdict` says why"))).context(words);
    }
    eprintln!("{words}{}", progress.summary(rows, summary.resumed));
    if let Some(warnings) = warnings {
        eprintln!("note: {warnings}");
    }
    Ok(())
}

/// What so many rows mean, in words.
fn many(rows: u64) -> String {
    // What a processor does on arms that are easily solved.
    const SPEED: f64 = 30_000.0;
    format!("{rows} rows: even at {SPEED} rows/s they take {}.", duration(rows as f64 / SPEED))
}

/// How many rows have which warning, the most frequent first; `None` where there is none.
fn warnings(summary: &Summary) -> Option<String> {
    let mut all: Vec<(&String, &u64)> = summary.warnings.iter().collect();
    all.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
    let of = |(kind, count): &(&String, &u64)| format!("{kind} in {count}");
    let all: Vec<String> = all.iter().map(of).collect();
    (!all.is_empty()).then(|| format!("warnings, of {} rows: {} (column `warnings`)", summary.rows, all.join(", ")))
}
