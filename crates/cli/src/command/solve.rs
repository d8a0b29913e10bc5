//! `hydrostat solve`: one arm.

use hydrostat::{
    AfterSnapError, Arm, Configuration, NoEquilibrium, Options, SnapMotion, SolveError, Solver, Stability, VerdictKind,
};
use hydrostat_figures::{arm_figure, last_good_note};
use hydrostat_files::{FailureDocument, Note, Others, SolutionDocument, stations_csv};

use super::slip::slip;
use super::summary::{beyond, summary};
use super::{Advised, wrong_option};
use crate::args::{Format, SolveArgs};
use crate::output;
use crate::request;
use crate::say;

pub(crate) fn run(args: &SolveArgs) -> anyhow::Result<()> {
    let arm = request::arm_in_space(&args.arm)?;
    if arm.space.is_some() {
        return super::solve_spatial::run(args, &arm);
    }
    let options = Options { snaps: args.snaps.bounds(), ..Options::with_tol(args.tol) };
    let mut solver = Solver::new(&arm, options).map_err(|error| match error {
        SolveError::Option { option, value, expected } => wrong_option(option, value, expected, error),
        other => other.into(),
    })?;
    let outputs = [("-o", args.output.as_deref()), ("--plot", args.plot.as_deref())];
    request::check_outputs(&[request::arm_input(&args.arm.file)], &outputs)?;
    request::check_picture(&args.picture, &[("--plot", args.plot.as_deref())])?;
    if args.snaps.after_snap {
        return after_snap(args, &arm);
    }
    match solver.solve() {
        Ok(configuration) => {
            let notes = Note::all(&configuration, args.tol);
            report(args, configuration, &[], &notes)
        }
        Err(error) => report_error(args, &arm, error),
    }
}

/// The shape after all snaps on the way.
fn after_snap(args: &SolveArgs, arm: &Arm) -> anyhow::Result<()> {
    match arm.solve_after_snap(args.tol) {
        Ok(found) => {
            let notes = Note::after_snap(&found, args.tol);
            report(args, found.configuration, &found.snaps, &notes)
        }
        Err(AfterSnapError::Solve(error)) => report_error(args, arm, error),
        Err(error) => Err(error.into()),
    }
}

fn report_error(args: &SolveArgs, arm: &Arm, error: SolveError) -> anyhow::Result<()> {
    match error {
        SolveError::NoEquilibrium(failure) => {
            let others = others(arm, args.tol, failure.verdict.kind);
            report_failure(args, *failure.clone(), others)?;
            let place = |shape: &Configuration| {
                let tip = shape.tip();
                format!("x {:.4} mm, y {:.4} mm", 1e3 * tip.x, 1e3 * tip.y)
            };
            if let Some(message) = beyond(&failure, place) {
                say::note(message);
            }
            if let Some(others) = others {
                say::note(others_message(others));
            }
            let advice = slip(arm, &failure.verdict);
            Err(Advised::with(SolveError::NoEquilibrium(failure), advice))
        }
        error => Err(error.into()),
    }
}

/// `motions` are those after its snaps, where they were followed.
fn report(
    args: &SolveArgs,
    mut configuration: Configuration,
    motions: &[SnapMotion],
    notes: &[Note],
) -> anyhow::Result<()> {
    if let Some(plot) = &args.plot {
        output::draw(&arm_figure(&configuration, None, &args.picture.page()), plot, &args.picture.page)?;
    }
    let margin = configuration.fold_margin();
    resample(args, &mut configuration);
    let text = match args.format {
        Format::Text => summary(&configuration),
        Format::Csv => stations_csv(&configuration.stations),
        Format::Json => {
            let document = SolutionDocument::new(&configuration, margin.value, notes);
            let length = configuration.arm.length;
            let document = if motions.is_empty() { document } else { document.with_motions(motions, length) };
            output::line(document.to_json())
        }
    };
    output::put(args.output.as_deref(), &text)?;
    for note in notes {
        // A snap within its bounds is known to be harmless.
        if note.kind == "snap" { say::note(&note.message) } else { say::warning(&note.message) }
    }
    if configuration.stability().map_or(configuration.stable, Stability::is_stable) == Some(false) {
        say::warning("this equilibrium is unstable: the slightest disturbance would move the arm away from it");
    }
    Ok(())
}

/// JSON gets the verdict with the last good shape; text and CSV have nothing to say.
fn report_failure(args: &SolveArgs, mut failure: NoEquilibrium, others: Option<Others>) -> anyhow::Result<()> {
    match (&args.plot, &failure.last_good) {
        (Some(plot), Some(last_good)) => {
            let note = last_good_note(&failure.verdict);
            output::draw(&arm_figure(last_good, Some(&note), &args.picture.page()), plot, &args.picture.page)?;
        }
        (Some(plot), None) => {
            say::warning(format_args!("no shape was found on the way, so {} is not drawn", plot.display()));
        }
        (None, _) => {}
    }
    if args.format == Format::Json {
        // A tolerance was asked of the answer, not of the last good shape.
        let notes = failure.last_good.as_ref().map(|c| Note::all(c, f64::INFINITY)).unwrap_or_default();
        let margin = failure.last_good.as_ref().map_or(f64::NAN, |c| c.fold_margin().value);
        if let Some(last_good) = &mut failure.last_good {
            resample(args, last_good);
        }
        let text = output::line(FailureDocument::new(&failure, margin, &notes).with_others(others).to_json());
        output::put(args.output.as_deref(), &text)?;
    }
    Ok(())
}

/// The equilibria that the path does not lead to, where it turns back: looked for with no finer tolerance than a count needs.
fn others(arm: &Arm, tol: f64, kind: VerdictKind) -> Option<Others> {
    const COARSE: f64 = 1e-6;
    if kind != VerdictKind::LimitPoint {
        return None;
    }
    arm.equilibria(tol.clamp(COARSE, 1e-3)).ok().map(|all| Others::of(&all))
}

fn others_message(others: Others) -> String {
    match (others.count, others.complete) {
        (0, true) => "no other equilibrium exists at these loads".to_owned(),
        (0, false) => "no other equilibrium was found at these loads, but the search is not complete".to_owned(),
        (count, complete) => format!(
            "{count} other equilibri{} at these loads, {} of them stable: see `hydrostat equilibria`",
            match (count, complete) {
                (1, true) => "um exists",
                (1, false) => "um, at least, exists",
                (_, true) => "a exist",
                (_, false) => "a, at least, exist",
            },
            others.stable
        ),
    }
}

fn resample(args: &SolveArgs, configuration: &mut Configuration) {
    if let Some(count) = args.stations {
        configuration.stations = configuration.resampled(count);
    }
}
