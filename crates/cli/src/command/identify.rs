//! `hydrostat identify`: parameters from measured shapes.

use hydrostat::{Arm, SensitivityError};
use hydrostat_figures::fit_figure;
use hydrostat_files::{
    Deviations, IdentificationDocument, Span, arm_to_toml, fitted, measurements_template, number, parse_measurements,
    read_measurements, residuals_csv, residuals_csv_with_predictions,
};
use hydrostat_identify::{Case, Fit, FitOptions, Fitted, Prediction, Unknown, fit, predict};
use std::fmt::Write as _;
use std::path::Path;

use super::NoAnswer;
use super::misses::{misses_table, predicted_cases};
use super::slip;
use super::table::{counted, table};
use crate::args::{Format, IdentifyArgs};
use crate::input;
use crate::output;
use crate::progress::Progress;
use crate::request::{self, WrongRequest};
use crate::say;

/// Residuals from which a number is named, in standard deviations.
const FAR: f64 = 4.0;
/// So many are named.
const MOST_NAMED: usize = 10;

pub(crate) fn run(args: &IdentifyArgs) -> anyhow::Result<()> {
    let arm_file = Path::new(&args.arm.file);
    let read = [("ARM", Some(arm_file)), ("DATA", args.data.as_deref()), ("--predict", args.predict.as_deref())];
    input::check_once(&read)?;
    let file = request::overridden(&args.arm)?;
    let arm = request::arm_anywhere(&file)?;
    // Told before anything is measured.
    if let Some(cable) = arm.cables.iter().position(|cable| cable.friction > 0.0) {
        return Err(SensitivityError::<hydrostat::SolveError>::Friction(cable).into());
    }
    let outputs =
        [("-o", args.output.as_deref()), ("--fitted", args.fitted.as_deref()), ("--plot", args.plot.as_deref())];
    let inputs = [
        request::arm_input(&args.arm.file),
        args.data.as_deref().map(|data| ("DATA", input::source(data))),
        args.predict.as_deref().map(|data| ("--predict", input::source(data))),
    ];
    request::check_outputs(&inputs, &outputs)?;
    request::check_picture(&args.picture, &[("--plot", args.plot.as_deref())])?;
    let Some(data) = args.data.as_ref().filter(|_| !args.template) else {
        return output::put(args.output.as_deref(), &measurements_template(&arm));
    };
    let mut deviations = Deviations::default();
    for text in &args.sd {
        deviations.add(text).map_err(anyhow::Error::msg)?;
    }
    let wanted = fitted(&arm, &args.fit, &args.prior)?;
    slip::warn(&arm, &starts(&wanted));
    let parameters: Vec<_> = wanted.iter().map(|one| one.parameter).collect();
    let cases_of = |path: &Path| -> anyhow::Result<Vec<Case>> {
        if input::is_standard(path) {
            return Ok(parse_measurements(&input::text()?, input::NAME, &file, &deviations, &parameters)?);
        }
        Ok(read_measurements(path, &file, &deviations, &parameters)?)
    };
    let cases = cases_of(data)?;
    let others = args.predict.as_deref().map(cases_of).transpose()?.unwrap_or_default();
    if cases.iter().all(|case| case.measurements.is_empty()) {
        return Err(WrongRequest::NothingMeasured(data.clone()).into());
    }
    let options = FitOptions {
        loss: args.loss.into(),
        rescale: args.rescale,
        cross_validate: !args.no_cross_validation,
        tol: args.tol,
        ..FitOptions::default()
    };
    let mut progress = Progress::new();
    let found = fit(&cases, &wanted, &options, |step| {
        progress.say(|| step.to_string());
        true
    })?;
    drop(progress);

    let predicted = predict(&found, &others, &options)?;
    let best = found.applied_to(&arm);
    if let Some(path) = &args.fitted {
        output::put(Some(path), &arm_to_toml(&best))?;
    }
    if let Some(path) = &args.plot {
        let figure = fit_figure(&arm.name, &cases, &found, &args.picture.page());
        output::draw(&figure, path, &args.picture.page)?;
    }
    let format = if args.json { Format::Json } else { args.format };
    let text = match format {
        Format::Text => report(&arm, &cases, &found, (&others, &predicted)),
        Format::Json => {
            let document = IdentificationDocument::new(&best, &cases, &found, options.loss);
            output::line(document.with_predictions(&others, &predicted).to_json())
        }
        Format::Csv if args.predict.is_none() => residuals_csv(&cases, &found),
        Format::Csv => residuals_csv_with_predictions(&cases, &found, &others, &predicted),
    };
    output::put(args.output.as_deref(), &text)?;
    if format == Format::Csv {
        for one in &predicted {
            if let Err(trial) = &one.found {
                say::warning(format_args!("load case {} is not predicted: {trial}", others[one.case].name));
            }
        }
    }
    if found.converged {
        return Ok(());
    }
    let mut words = format!("the fit did not converge in {}", counted(found.rounds, "step"));
    if let Some(one) = found.no_answer.first() {
        let _ = write!(
            words,
            "; load case {} had no equilibrium at {} trial values: {}",
            cases[one.case].name, one.trials, one.why
        );
    }
    Err(NoAnswer(words).into())
}

/// Where the search begins.
fn starts(wanted: &[Fitted]) -> Vec<Span> {
    let of = |one: &Fitted| Some(Span { key: one.parameter.parameter()?.to_string(), ends: [one.start; 2] });
    wanted.iter().filter_map(of).collect()
}

/// A parameter's value as a user reads it: angles in degrees.
fn shown(parameter: Unknown, value: f64) -> String {
    number(if parameter.unit() == "rad" { value.to_degrees() } else { value })
}

fn named(parameter: Unknown) -> String {
    match parameter.unit() {
        "" => parameter.to_string(),
        "rad" => format!("{parameter} (deg)"),
        unit => format!("{parameter} ({unit})"),
    }
}

fn report(arm: &Arm, cases: &[Case], found: &Fit, (others, predicted): (&[Case], &[Prediction])) -> String {
    let count = found.residuals.len();
    let mut out = format!(
        "{}: {}, {}, {}\n\n",
        arm.name,
        counted(found.load_cases, "load case"),
        counted(count, "measured value"),
        counted(found.rounds, "step")
    );
    out.push_str(&estimates(found));
    out.push('\n');
    for sentence in found.verdict() {
        let _ = writeln!(out, "verdict: {sentence}");
    }
    if let Some(misfit) = found.misfit() {
        let _ = writeln!(
            out,
            "misfit: {misfit} (chi-square {} for {} degrees of freedom)",
            number(found.chi_square),
            found.freedom
        );
    }
    if found.spread != 1.0 {
        let _ = writeln!(out, "intervals: with standard deviations {} times those given", number(found.spread));
    }
    out.push_str(&together(found));
    out.push_str(&predictions(cases, found));
    out.push_str(&predicted_cases(others, predicted));
    if arm.space.is_some() || !predicted.is_empty() {
        out.push_str(&misses_table(found, predicted));
    }
    out.push_str(&far_out(cases, found));
    for one in &found.no_answer {
        let at: Vec<String> = found
            .estimates
            .iter()
            .zip(&one.at)
            .map(|(own, value)| format!("{} {}", named(own.fitted.parameter), shown(own.fitted.parameter, *value)))
            .collect();
        let _ = writeln!(
            out,
            "\nload case {} had no equilibrium at {} of {} trials, the last at {}: {}",
            cases[one.case].name,
            one.trials,
            found.evaluations,
            at.join(", "),
            one.why
        );
    }
    out
}

fn estimates(found: &Fit) -> String {
    let head = ["key", "start", "estimate", "sd", "95 % from", "to", ""].map(str::to_owned).to_vec();
    let mut rows = vec![head];
    for one in &found.estimates {
        let parameter = one.fitted.parameter;
        let shown = |value: f64| if value.is_finite() { shown(parameter, value) } else { "unknown".to_owned() };
        let side = |side: usize| if side == 0 { "lower" } else { "upper" };
        let note = match (one.held, one.fitted.prior) {
            (Some(held), _) => format!("at its {} bound", side(held)),
            (None, Some(prior)) => format!("prior {} ± {}", shown(prior.mean), shown(prior.sd)),
            (None, None) => String::new(),
        };
        let [from, to] = match one.interval {
            Some(ends) => ends.map(shown),
            None => [String::from("-"), String::from("-")],
        };
        let sd = one.sd.map_or_else(|| "-".to_owned(), shown);
        rows.push(vec![named(parameter), shown(one.fitted.start), shown(one.value), sd, from, to, note]);
    }
    table(&rows, 1)
}

/// Correlations and singular values.
fn together(found: &Fit) -> String {
    if found.estimates.len() < 2 {
        return String::new();
    }
    let names: Vec<String> = found.estimates.iter().map(|one| one.fitted.parameter.to_string()).collect();
    let mut out = "\ncorrelation\n".to_owned();
    let mut rows = Vec::new();
    for (i, name) in names.iter().enumerate() {
        let row = found.correlation[i].iter().take(i + 1);
        let mut cells = vec![name.clone()];
        // Adding zero makes one zero of both.
        let cell = |value: &f64| format!("{:.3}", (1e3 * value).round() / 1e3 + 0.0);
        cells.extend(row.map(|value| if value.is_finite() { cell(value) } else { "?".to_owned() }));
        rows.push(cells);
    }
    out.push_str(&table(&rows, 0));
    out.push_str(
        "\nsingular value: change of all measured values, in standard deviations, per unit of the combination in its row (parameters \
         relative to their scales)\n",
    );
    let mut head = vec!["value".to_owned()];
    head.extend(names);
    let mut rows = vec![head];
    for direction in found.directions.iter().rev() {
        let mut cells = vec![number(direction.singular_value)];
        cells.extend(direction.weights.iter().map(|w| format!("{w:.3}")));
        rows.push(cells);
    }
    out.push_str(&table(&rows, 0));
    out
}

fn predictions(cases: &[Case], found: &Fit) -> String {
    if found.left_out.is_empty() {
        return String::new();
    }
    let mut out =
        "\nresiduals of each load case, root mean square in standard deviations: in the fit, and when predicted from the other cases\n"
            .to_owned();
    let mut head = ["case", "fit", "predicted"].map(str::to_owned).to_vec();
    head.extend(found.estimates.iter().map(|one| format!("{} shift (sd)", one.fitted.parameter)));
    let mut rows = vec![head];
    for one in &found.left_out {
        let mut row = vec![cases[one.case].name.clone(), format!("{:.2}", one.within)];
        match &one.predicted {
            Ok(predicted) => row.push(format!("{predicted:.2}")),
            Err(why) => row.push(format!("none: {why}")),
        }
        row.extend(one.shifts.iter().map(|shift| format!("{shift:.2}")));
        rows.push(row);
    }
    out.push_str(&table(&rows, 0));
    out
}

/// Numbers that fit badly, with their rows.
fn far_out(cases: &[Case], found: &Fit) -> String {
    let mut far: Vec<_> = found.residuals.iter().filter(|one| one.standardised.abs() > FAR).collect();
    far.sort_by(|a, b| b.standardised.abs().total_cmp(&a.standardised.abs()));
    let mut out = String::new();
    if !far.is_empty() {
        let _ = writeln!(out, "\n{} beyond {FAR} standard deviations", counted(far.len(), "value"));
    }
    for one in far.iter().take(MOST_NAMED) {
        let measurement = one.measurement;
        let _ = writeln!(
            out,
            "  row {}, load case {}, {}: {:.1} sd",
            measurement.row, cases[one.case].name, measurement.quantity, one.standardised
        );
    }
    out
}
