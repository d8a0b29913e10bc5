//! `hydrostat solve` of an arm in space.

use std::fmt::Write as _;
use std::path::Path;

use hydrostat::{
    AfterSnapError, Arm, NoSpatialEquilibrium, Options, SpatialConfiguration, SpatialError, SpatialSnapMotion,
    SpatialSolver, SpatialWrench, Stability,
};
use hydrostat_figures::{last_good_note, spatial_arm_figure};
use hydrostat_files::{Note, SpatialFailureDocument, SpatialSolutionDocument, number, spatial_stations_csv};

use super::slip::slip;
use super::summary::{beyond, cable_rows, signed, stability_in_words, work};
use super::{Advised, wrong_option};
use crate::args::{Format, SolveArgs};
use crate::output;
use crate::request;
use crate::say;

pub(super) fn run(args: &SolveArgs, arm: &Arm) -> anyhow::Result<()> {
    let options = Options { snaps: args.snaps.bounds(), ..Options::with_tol(args.tol) };
    let mut solver = SpatialSolver::new(arm, options).map_err(|error| match error {
        SpatialError::Option { option, value, expected } => wrong_option(option, value, expected, error),
        other => other.into(),
    })?;
    let outputs = [("-o", args.output.as_deref()), ("--plot", args.plot.as_deref())];
    request::check_outputs(&[request::arm_input(&args.arm.file)], &outputs)?;
    request::check_picture(&args.picture, &[("--plot", args.plot.as_deref())])?;
    if args.snaps.after_snap {
        return after_snap(args, arm);
    }
    match solver.solve() {
        Ok(configuration) => {
            let notes = Note::all_in_space(&configuration, args.tol);
            report(args, configuration, &[], &notes)
        }
        Err(error) => report_error(args, arm, error),
    }
}

/// The shape after all snaps on the way.
fn after_snap(args: &SolveArgs, arm: &Arm) -> anyhow::Result<()> {
    match arm.solve_after_snap_in_space(args.tol) {
        Ok(found) => {
            let notes = Note::after_snap_in_space(&found, args.tol);
            report(args, found.configuration, &found.snaps, &notes)
        }
        Err(AfterSnapError::Solve(error)) => report_error(args, arm, error),
        Err(error) => Err(error.into()),
    }
}

fn report_error(args: &SolveArgs, arm: &Arm, error: SpatialError) -> anyhow::Result<()> {
    match error {
        SpatialError::NoEquilibrium(failure) => {
            report_failure(args, *failure.clone())?;
            let place = |shape: &SpatialConfiguration| {
                let tip = shape.tip();
                format!("x {:.4} mm, y {:.4} mm, z {:.4} mm", 1e3 * tip.x, 1e3 * tip.y, 1e3 * tip.z)
            };
            if let Some(message) = beyond(&failure, place) {
                say::note(message);
            }
            let advice = slip(arm, &failure.verdict);
            Err(Advised::with(SpatialError::NoEquilibrium(failure), advice))
        }
        error => Err(error.into()),
    }
}

/// `motions` are those after its snaps, where they were followed.
fn report(
    args: &SolveArgs,
    mut configuration: SpatialConfiguration,
    motions: &[SpatialSnapMotion],
    notes: &[Note],
) -> anyhow::Result<()> {
    if let Some(plot) = &args.plot {
        draw(args, plot, &configuration, None)?;
    }
    resample(args, &mut configuration);
    let text = match args.format {
        Format::Text => summary(&configuration),
        Format::Csv => spatial_stations_csv(&configuration.stations),
        Format::Json => {
            let document = SpatialSolutionDocument::new(&configuration, notes);
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
fn report_failure(args: &SolveArgs, mut failure: NoSpatialEquilibrium) -> anyhow::Result<()> {
    match (&args.plot, &failure.last_good) {
        (Some(plot), Some(last_good)) => draw(args, plot, last_good, Some(&last_good_note(&failure.verdict)))?,
        (Some(plot), None) => {
            say::warning(format_args!("no shape was found on the way, so {} is not drawn", plot.display()));
        }
        (None, _) => {}
    }
    if args.format != Format::Json {
        return Ok(());
    }
    // A tolerance was asked of the answer, not of the last good shape.
    let notes = failure.last_good.as_ref().map(|c| Note::all_in_space(c, f64::INFINITY)).unwrap_or_default();
    if let Some(last_good) = &mut failure.last_good {
        resample(args, last_good);
    }
    let text = output::line(SpatialFailureDocument::new(&failure, &notes).to_json());
    output::put(args.output.as_deref(), &text)
}

fn draw(args: &SolveArgs, plot: &Path, configuration: &SpatialConfiguration, note: Option<&str>) -> anyhow::Result<()> {
    output::draw(&spatial_arm_figure(configuration, note, &args.picture.page()), plot, &args.picture.page)
}

fn resample(args: &SolveArgs, configuration: &mut SpatialConfiguration) {
    if let Some(count) = args.stations {
        configuration.stations = configuration.resampled(count);
    }
}

fn summary(c: &SpatialConfiguration) -> String {
    let arm = &c.arm;
    let tip = c.tip();
    let mut out = String::new();
    let mut row = |name: &str, text: &str| {
        let _ = writeln!(out, "{name:<15}{text}");
    };
    let stability = stability_in_words(c.stability(), c.stable).map_or_else(String::new, |words| format!(", {words}"));
    let stream = match arm.flow.speed {
        0.0 => "still water".to_owned(),
        speed => format!("stream {speed} m/s"),
    };
    row("arm", &format!("{}, {} mm, in space, {stream}{stability}", arm.name, number(1e3 * arm.length)));
    row("tip", &format!("x {:.4} mm, y {:.4} mm, z {:.4} mm", 1e3 * tip.x, 1e3 * tip.y, 1e3 * tip.z));
    let vector = |v: [f64; 3]| format!("({:.6}, {:.6}, {:.6})", v[0], v[1], v[2]);
    row(
        "tip section",
        &format!("a {}, b {}, alpha(L) {:.4} deg", vector(tip.a), vector(tip.b), tip.alpha.to_degrees()),
    );
    for (i, text) in cable_rows(&c.cables).into_iter().enumerate() {
        row(if i == 0 { "cables" } else { "" }, &text);
    }
    row("base reaction", &wrench(&c.base_reaction));
    if let Some(unmet) = &c.unmet {
        row("unmet at tip", &wrench(unmet));
    }
    let fold = c.fold_margin();
    row(
        "fold margin",
        &format!("{:.3}, least at s = {} mm (the surface folds at 0)", fold.value, number(1e3 * fold.s)),
    );
    row("tip error", &format!("about {:.1e} mm", 1e3 * c.error_estimate));
    row("work", &work(&c.statistics));
    out
}

fn wrench(w: &SpatialWrench) -> String {
    let vector = |v: [f64; 3]| format!("({}, {}, {})", signed(v[0]), signed(v[1]), signed(v[2]));
    format!("force {} N, moment {} N m", vector(w.force), vector(w.moment))
}
