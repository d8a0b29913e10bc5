//! `hydrostat sweep`: an arm over grids and samples of its file's keys.

use anyhow::Context as _;
use hydrostat::{Arm, SolveError};
use hydrostat_files::{ArmFile, Axis, AxisValue, AxisValues, Span};
use hydrostat_sweep::{Plan, Sample, Summary, Sweep, SweepError, SweepOptions, note_beside};

use super::{NoAnswer, slip, wrong_option};
use crate::args::SweepArgs;
use crate::rate::{Rate, duration};
use crate::request::WrongRequest;
use crate::{exit, output, question, request, say};

/// Rows from which a sweep is asked about.
const MANY: u64 = 1_000_000_000;

pub(crate) fn run(args: &SweepArgs) -> anyhow::Result<()> {
    let file = request::overridden(&args.arm)?;
    // Wrong files and likely slips are told as everywhere.
    let arm = request::arm_anywhere(&file)?;
    slip::warn_beside(&arm, args.vary.iter().flat_map(|axis| at_ends(&file, axis)));
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
        say::note(format_args!("{} {parts} of an earlier run had changed since; solved again", summary.damaged));
    }
    let words = format!("{}: {rows} rows of {}, {answered} with an equilibrium", args.output.display(), sweep.name());
    if answered == 0 {
        return Err(NoAnswer(format!("{words}: the column `verdict` says why"))).context(words);
    }
    say::line(format_args!("{words}{}", progress.summary(rows, summary.resumed)));
    if let Some(warnings) = warnings {
        say::note(warnings);
    }
    Ok(())
}

/// The arm with the least and with the largest value of a key, where it can have them.
fn at_ends(file: &ArmFile, axis: &Axis) -> Vec<Arm> {
    let ends: Vec<f64> = match &axis.values {
        AxisValues::Even { from, to, .. } | AxisValues::Span { from, to } => vec![*from, *to],
        AxisValues::List(values) => Span::of(&axis.key, values.iter().copied()).map_or(Vec::new(), |s| s.ends.into()),
        AxisValues::Words(_) => Vec::new(),
    };
    let with = |value: f64| {
        let mut file = file.clone();
        file.set(&axis.key, &axis.text(AxisValue::Number(value))).ok()?;
        file.arm().ok()
    };
    ends.into_iter().filter_map(with).collect()
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
