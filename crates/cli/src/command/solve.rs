//! `hydrostat solve`: one arm.

use std::path::Path;

use hydrostat::{Configuration, NoEquilibrium, Options, SolveError, Solver, Stability, Verdict};
use hydrostat_figures::arm_figure;
use hydrostat_files::{Failure, Note, Solution, stations_csv, write_whole};

use super::summary::summary;
use crate::args::{Format, SolveArgs, is_png};
use crate::output;
use crate::request::{self, Overrides, WrongRequest};

pub(crate) fn run(args: &SolveArgs) -> anyhow::Result<()> {
    let overrides =
        Overrides { settings: &args.set, tensions: args.tension.as_deref(), flow_speed: args.flow_speed.as_deref() };
    let arm = request::arm(&args.arm, &overrides)?;
    let mut solver = Solver::new(&arm, Options { tol: args.tol })?;
    check_outputs(args)?;
    match solver.solve() {
        Ok(configuration) => report(args, configuration),
        Err(SolveError::NoEquilibrium(failure)) => {
            report_failure(args, *failure.clone())?;
            Err(SolveError::NoEquilibrium(failure).into())
        }
        Err(error) => Err(error.into()),
    }
}

/// Refuses outputs that could not be written, before the work.
fn check_outputs(args: &SolveArgs) -> anyhow::Result<()> {
    let files = [args.output.as_deref(), args.plot.as_deref()];
    if let [Some(output), Some(plot)] = files
        && output == plot
    {
        return Err(WrongRequest::SamePath(output.to_owned()).into());
    }
    for file in files.into_iter().flatten() {
        output::check_writable(file)?;
    }
    Ok(())
}

fn report(args: &SolveArgs, mut configuration: Configuration) -> anyhow::Result<()> {
    if let Some(plot) = &args.plot {
        draw(&configuration, None, plot)?;
    }
    let notes = Note::all(&configuration, args.tol);
    let margin = configuration.fold_margin();
    resample(args, &mut configuration);
    let text = match args.format {
        Format::Text => summary(&configuration),
        Format::Csv => stations_csv(&configuration.stations),
        Format::Json => line(Solution::new(&configuration, margin.value, &notes).to_json()?),
    };
    output::put(args.output.as_deref(), &text)?;
    for note in &notes {
        eprintln!("warning: {}", note.message);
    }
    if configuration.stability().map_or(configuration.stable, Stability::is_stable) == Some(false) {
        eprintln!("warning: this equilibrium is unstable: the arm would leave it at the slightest push");
    }
    Ok(())
}

/// JSON gets the verdict with the last good shape; text and CSV have nothing to say.
fn report_failure(args: &SolveArgs, mut failure: NoEquilibrium) -> anyhow::Result<()> {
    match (&args.plot, &failure.last_good) {
        (Some(plot), Some(last_good)) => draw(last_good, Some(&note(&failure.verdict)), plot)?,
        (Some(plot), None) => eprintln!("warning: no good shape on the way, {} is not drawn", plot.display()),
        (None, _) => {}
    }
    if args.format == Format::Json {
        // A tolerance was asked of the answer, not of the last good shape.
        let notes = failure.last_good.as_ref().map(|c| Note::all(c, f64::INFINITY)).unwrap_or_default();
        let margin = failure.last_good.as_ref().map_or(f64::NAN, |c| c.fold_margin().value);
        if let Some(last_good) = &mut failure.last_good {
            resample(args, last_good);
        }
        let text = line(Failure::new(&failure, margin, &notes).to_json()?);
        output::put(args.output.as_deref(), &text)?;
    }
    Ok(())
}

/// What the drawing of a last good shape says of it.
fn note(verdict: &Verdict) -> String {
    format!(
        "Not the loads asked for: last good shape, at load fraction {:.4} of the phase \u{201c}{}\u{201d} ({})",
        verdict.load_fraction,
        verdict.phase.name(),
        verdict.kind.name().replace('_', " ")
    )
}

fn resample(args: &SolveArgs, configuration: &mut Configuration) {
    if let Some(count) = args.stations {
        configuration.stations = configuration.resampled(count);
    }
}

fn draw(configuration: &Configuration, note: Option<&str>, path: &Path) -> anyhow::Result<()> {
    let figure = arm_figure(configuration, note);
    let bytes = if is_png(path) { figure.png()? } else { figure.svg().into_bytes() };
    Ok(write_whole(path, &bytes)?)
}

fn line(mut text: String) -> String {
    text.push('\n');
    text
}
