//! `hydrostat modes`: small motions about the equilibrium, at one load or over several values of one.

use std::fmt::Write as _;

use hydrostat::{Arm, Mode, Modes, MotionError};
use hydrostat_figures::{mode_shapes_figure, root_locus_figure};
use hydrostat_files::{
    ModesDocument, ModesOverDocument, ModesTip, Varied, mode_kind, mode_shapes_csv, modes_csv, modes_over_csv, number,
};

use super::over::{Value, at_values, say_what_is_missing};
use super::path::abscissa;
use super::simulate::refused;
use super::table::table;
use crate::args::{Format, ModesArgs, Over};
use crate::output;
use crate::progress::Progress;
use crate::request::{self, WrongRequest};

pub(crate) fn run(args: &ModesArgs) -> anyhow::Result<()> {
    let arm = request::arm_in_space(&args.arm)?;
    if let Some(Over { varied, .. }) = &args.over {
        varied.parameter.of(&arm).map_err(|e| WrongRequest::Unfit("--over", e))?;
    }
    let pictures = [("--plot", args.plot.as_deref()), ("--plot-shapes", args.plot_shapes.as_deref())];
    let shapes = ("--shapes-output", args.shapes_output.as_deref());
    let outputs = [("-o", args.output.as_deref()), shapes, pictures[0], pictures[1]];
    request::check_outputs(&[request::arm_input(&args.arm.file)], &outputs)?;
    request::check_picture(&args.picture, &pictures)?;
    let (count, elements) = (args.count, args.elements);
    match (args.over, arm.space.is_some()) {
        (Some(over), false) => over_range(args, &arm, over, |arm| arm.modes(count, elements)),
        (Some(over), true) => over_range(args, &arm, over, |arm| arm.modes_in_space(count, elements)),
        (None, false) => at_loads(args, &arm, &arm.modes(count, elements).map_err(refused)?),
        (None, true) => at_loads(args, &arm, &arm.modes_in_space(count, elements).map_err(refused)?),
    }
}

fn at_loads(args: &ModesArgs, arm: &Arm, modes: &Modes<impl Copy + Into<ModesTip>>) -> anyhow::Result<()> {
    if let Some(file) = &args.plot {
        let title = format!("{}: rates of small motions", arm.name);
        let figure = root_locus_figure(&[(0.0, &modes.modes)], None, &title, &args.picture.page());
        output::draw(&figure, file, &args.picture.page)?;
    }
    if let Some(file) = &args.plot_shapes {
        let title = format!("{}: shapes of small motions", arm.name);
        output::draw(&mode_shapes_figure(arm, modes, &title, &args.picture.page()), file, &args.picture.page)?;
    }
    if let Some(file) = &args.shapes_output {
        output::put(Some(file), &mode_shapes_csv(modes))?;
    }
    let text = match args.format {
        Format::Text => summary(arm, modes),
        Format::Json => output::line(ModesDocument::new(arm, modes).to_json()),
        Format::Csv => modes_csv(modes),
    };
    output::put(args.output.as_deref(), &text)
}

fn over_range<T: Copy + Into<ModesTip>>(
    args: &ModesArgs,
    arm: &Arm,
    over: Over,
    modes_of: impl Fn(&Arm) -> Result<Modes<T>, MotionError>,
) -> anyhow::Result<()> {
    let varied = over.varied;
    let mut progress = Progress::new();
    let found = at_values(arm, over, |there, Value { at, .. }| {
        progress.say(|| format!("modes {at}"));
        match modes_of(there) {
            Ok(modes) => Ok(Ok(modes)),
            Err(error @ (MotionError::Option { .. } | MotionError::Unsupported { .. })) => Err(refused(error)),
            Err(error) => Ok(Err(error.to_string())),
        }
    })?;
    if let Some(file) = &args.plot {
        let all: Vec<(f64, &[Mode])> =
            found.iter().filter_map(|(value, modes)| Some((*value, &*modes.as_ref().ok()?.modes))).collect();
        let title = format!("{}: rates of small motions over {}", arm.name, varied.parameter);
        let figure = root_locus_figure(&all, Some(&abscissa(&varied)), &title, &args.picture.page());
        output::draw(&figure, file, &args.picture.page)?;
    }
    let text = match args.format {
        Format::Text => over_summary(arm, &varied, &found),
        Format::Json => output::line(ModesOverDocument::new(arm, &varied, &found).to_json()),
        Format::Csv => modes_over_csv(&varied, &found),
    };
    output::put(args.output.as_deref(), &text)?;
    say_what_is_missing(&varied, &found, |_| true)
}

fn summary<T>(arm: &Arm, modes: &Modes<T>) -> String {
    let mut out = format!("modes  {}\n\n", arm.name);
    let heads = ["mode", "growth rate (1/s)", "angular frequency (rad/s)", "frequency (Hz)", "damping ratio", "kind"];
    let mut rows = vec![heads.map(str::to_owned).to_vec()];
    for (k, mode) in modes.modes.iter().enumerate() {
        let numbers = [mode.rate[0], mode.rate[1], mode.frequency(), mode.damping_ratio()].map(number);
        let mut row = vec![(k + 1).to_string()];
        row.extend(numbers);
        row.push(mode_kind(mode).to_owned());
        rows.push(row);
    }
    out.push_str(&table(&rows, 1));
    let words =
        if modes.is_stable() { "stable: none of these motions grows" } else { "UNSTABLE: a small motion grows" };
    let _ = writeln!(out, "\n{words}");
    out
}

/// A line a value: the motion that grows fastest, or decays slowest.
fn over_summary<T>(arm: &Arm, varied: &Varied, found: &[(f64, Result<Modes<T>, String>)]) -> String {
    let [from, to] = varied.range.map(|value| varied.with_unit(value));
    let mut out = format!("modes  {}, {} values of {}, {from} to {to}\n\n", arm.name, found.len(), varied.parameter);
    let unit = if varied.unit.is_empty() { "value" } else { varied.unit };
    let heads = [unit, "largest growth rate (1/s)", "frequency (Hz)", "damping ratio", "kind"];
    let mut rows = vec![heads.map(str::to_owned).to_vec()];
    for (value, modes) in found {
        let fastest = modes.as_ref().ok().and_then(|modes| {
            let growth = |mode: &&Mode| mode.rate[0];
            modes.modes.iter().max_by(|a, b| growth(a).total_cmp(&growth(b)))
        });
        let mut row = vec![number(varied.shown(*value))];
        match fastest {
            Some(mode) => {
                row.extend([mode.rate[0], mode.frequency(), mode.damping_ratio()].map(number));
                row.push(mode_kind(mode).to_owned());
            }
            None => row.extend(["", "", "", "no equilibrium"].map(str::to_owned)),
        }
        rows.push(row);
    }
    out.push_str(&table(&rows, 1));
    out
}
