//! `hydrostat path`: equilibria over a range of one parameter.

use std::fmt::Write as _;

use hydrostat::{
    Arm, Branch, Configuration, Event, Path, PathEnd, PathError, PathOptions, PathPoint, SpatialConfiguration,
    Stability,
};
use hydrostat_figures::{Abscissa, Quantity};
use hydrostat_files::{Landing, Varied, end_message, number};

use super::shape::Shape;
use super::slip;
use super::table::{decimals, stability_words, table};
use super::{NoAnswer, wrong_option};
use crate::args::{Format, PathArgs};
use crate::output;
use crate::progress::Progress;
use crate::request::{self, WrongRequest};
use crate::say;

pub(crate) fn run(args: &PathArgs) -> anyhow::Result<()> {
    let arm = request::arm_in_space(&args.arm)?;
    let varied = &args.vary;
    varied.parameter.of(&arm).map_err(|e| WrongRequest::Unfit("--vary", e))?;
    check_quantity(&arm, args.quantity)?;
    slip::warn_of_range(&arm, varied);
    let pictures = [("--plot", args.plot.as_deref()), ("--plot-shapes", args.plot_shapes.as_deref())];
    let outputs = [("-o", args.output.as_deref()), pictures[0], pictures[1]];
    request::check_outputs(&[request::arm_input(&args.arm.file)], &outputs)?;
    request::check_picture(&args.picture, &pictures)?;
    if arm.space.is_some() { along::<SpatialConfiguration>(&arm, args) } else { along::<Configuration>(&arm, args) }
}

fn along<C: Shape>(arm: &Arm, args: &PathArgs) -> anyhow::Result<()> {
    let path = follow::<C>(arm, args)?;
    draw_shapes(arm, &path, args)?;
    let landings = args.after_snap.then(|| landings(&path, &args.vary));
    report(arm, &path, landings.as_deref(), args)
}

fn draw_shapes<C: Shape>(arm: &Arm, path: &Path<C>, args: &PathArgs) -> anyhow::Result<()> {
    let varied = &args.vary;
    let Some(file) = args.plot_shapes.as_ref().filter(|_| C::document(path, varied).is_some()) else { return Ok(()) };
    let figure = C::shapes(path, &abscissa(varied), &title(arm, varied), &args.picture.page());
    output::draw(&figure, file, &args.picture.page)
}

/// Writes what was asked for.
fn report<C: Shape>(arm: &Arm, path: &Path<C>, landings: Option<&[Landing<C>]>, args: &PathArgs) -> anyhow::Result<()> {
    let varied = &args.vary;
    let Some(document) = C::document(path, varied) else {
        let start = varied.with_unit(varied.range[0]);
        return Err(NoAnswer(format!("no point of the path was established at its start, {start}")).into());
    };
    if let Some(file) = &args.plot {
        let (title, page) = (title(arm, varied), args.picture.page());
        let figure = C::chart(path, &abscissa(varied), args.quantity, &title, &page);
        output::draw(&figure, file, &args.picture.page)?;
    }
    let text = match args.format {
        Format::Text => summary(arm, path, varied) + &rests(path, varied, landings.unwrap_or_default()),
        Format::Json => output::line(C::with_landings(document, landings.unwrap_or_default()).to_json()),
        Format::Csv => C::csv(path, varied, landings),
    };
    output::put(args.output.as_deref(), &text)?;
    say_ends(path, varied)
}

/// The fraction of the range by which the parameter is past a limit point while the arm moves.
const PAST: f64 = 1e-3;

/// Where the arm rests that is let go at limit points which a stable part of the path leads up to.
fn landings<C: Shape>(path: &Path<C>, varied: &Varied) -> Vec<Landing<C>> {
    const TOLERANCE: f64 = 1e-8;
    let mut progress = Progress::new();
    let mut out = Vec::new();
    for (b, branch) in path.branches.iter().enumerate() {
        for (p, pair) in branch.points.windows(2).enumerate() {
            let [before, at] = pair else { continue };
            if at.event != Some(Event::LimitPoint) || before.stability != Some(Stability::Stable) {
                continue;
            }
            progress.say(|| format!("motion from the limit point at {}", varied.with_unit(at.value)));
            let past = at.value + PAST * (path.range[1] - path.range[0]).abs() * (at.value - before.value).signum();
            let mut arm = at.configuration.arm().clone();
            // The arm has the parameter: the path varies it.
            let _ = path.parameter.set(&mut arm, past);
            let outcome = at.configuration.let_go(&arm, TOLERANCE).map_err(|restless| restless.to_string());
            out.push(Landing { at: [b, p + 1], outcome });
        }
    }
    out
}

/// A line a limit point.
fn rests<C: Shape>(path: &Path<C>, varied: &Varied, landings: &[Landing<C>]) -> String {
    let mut out = String::new();
    for (k, Landing { at: [branch, point], outcome }) in landings.iter().enumerate() {
        let value = varied.with_unit(path.branches[*branch].points[*point].value);
        let words = match outcome {
            Ok(rest) => {
                let seconds = decimals(rest.time, 2);
                format!("the arm rests after {seconds} s, with the tip at {}", rest.configuration.tip_words())
            }
            Err(message) => message.clone(),
        };
        let _ = writeln!(out, "{}past the limit point at {value}: {words}", if k == 0 { "\n" } else { "" });
    }
    out
}

/// A cable that is not there has no stroke.
pub(super) fn check_quantity(arm: &Arm, quantity: Quantity) -> Result<(), WrongRequest> {
    let cables = arm.cables.len();
    let in_space = arm.space.is_some();
    match quantity {
        quantity if !quantity.is_of(in_space) => Err(WrongRequest::NotOfArm { quantity, in_space }),
        Quantity::Stroke(asked) if asked >= cables => Err(WrongRequest::NoCable { asked, cables }),
        _ => Ok(()),
    }
}

fn follow<C: Shape>(arm: &Arm, args: &PathArgs) -> anyhow::Result<Path<C>> {
    let options = PathOptions { tol: args.tol, longest: args.max_step, most: args.max_points, branches: args.branches };
    let mut progress = Progress::new();
    let mut count = 0;
    let varied = &args.vary;
    let path = C::path(arm, varied.parameter, varied.range, &options, |point| {
        count += 1;
        progress.say(|| format!("{count} points, {} = {}", varied.parameter, varied.with_unit(point.value)));
        true
    });
    path.map_err(|error| match error {
        PathError::Start { value, source, .. } => {
            let start = format!("{} = {}", varied.parameter, varied.with_unit(value));
            let message = format!("no equilibrium at the start of the path, {start}: {source}");
            anyhow::Error::new(source).context(message)
        }
        PathError::Value { value, ref source, .. } => {
            let message = format!("--vary {} = {}: {source}", varied.parameter, varied.with_unit(value));
            anyhow::Error::new(error).context(message)
        }
        PathError::Option { option, value, expected } => {
            wrong_option(if option == "longest" { "max-step" } else { option }, value, expected, error)
        }
        PathError::Support | PathError::Stroke { .. } | PathError::Friction { .. } => error.into(),
    })
}

/// The axis of what varies.
pub(super) fn abscissa(varied: &Varied) -> Abscissa {
    Abscissa { name: varied.parameter.to_string(), unit: varied.unit.to_owned(), per_si: varied.per_si }
}

/// What a drawing shows.
pub(super) fn title(arm: &Arm, varied: &Varied) -> String {
    format!("{}: equilibria over {}", arm.name, varied.parameter)
}

/// Ends, events and a line on the whole.
fn summary<C: Shape>(arm: &Arm, path: &Path<C>, varied: &Varied) -> String {
    let [from, to] = varied.range.map(|value| varied.with_unit(value));
    let mut out = format!("path   {}, {} from {from} to {to}\n", arm.name, varied.parameter);
    for (index, branch) in path.branches.iter().enumerate() {
        let _ = match branch.switched_at {
            Some(value) => writeln!(out, "\nbranch {index}, from the bifurcation at {}", varied.with_unit(value)),
            None => writeln!(out),
        };
        out.push_str(&events_table(branch, varied));
        let count = |event: Event| branch.points.iter().filter(|p| p.event == Some(event)).count();
        let _ = writeln!(
            out,
            "{}, {}, {}{}; {}; {}",
            counted(branch.points.len(), "point", "points"),
            counted(count(Event::LimitPoint), "limit point", "limit points"),
            counted(count(Event::Bifurcation), "bifurcation", "bifurcations"),
            contacts(branch),
            stability_along(branch),
            end_message(branch.end, varied, branch.points.last().map_or(f64::NAN, |p| p.value))
        );
    }
    out
}

/// How often cables go slack or taut, where any does.
fn contacts<C>(branch: &Branch<C>) -> String {
    match branch.points.iter().filter(|p| p.event.is_some_and(|event| event.cable().is_some())).count() {
        0 => String::new(),
        1 => ", a cable goes slack or taut once".to_owned(),
        count => format!(", cables go slack or taut {count} times"),
    }
}

fn counted(count: usize, one: &str, many: &str) -> String {
    match count {
        0 => format!("no {many}"),
        1 => format!("1 {one}"),
        n => format!("{n} {many}"),
    }
}

fn stability_along<C>(branch: &Branch<C>) -> &'static str {
    let regular = || branch.points.iter().filter(|p| p.event.is_none());
    if regular().all(|p| p.stability == Some(Stability::Stable)) {
        "stable throughout"
    } else if regular().any(|p| p.stability == Some(Stability::Stable)) {
        "stable in part"
    } else {
        "no point established as stable"
    }
}

/// The first point, the last one and the events between.
fn events_table<C: Shape>(branch: &Branch<C>, varied: &Varied) -> String {
    let unit = if varied.unit.is_empty() { "value".to_owned() } else { varied.unit.to_owned() };
    let mut head = vec![unit];
    head.extend(C::TIP.map(str::to_owned));
    head.extend(["stability", "event"].map(str::to_owned));
    let mut rows = vec![head];
    let last = branch.points.len().saturating_sub(1);
    for (index, point) in branch.points.iter().enumerate() {
        let event = match point.event {
            Some(Event::LimitPoint) => "limit point".to_owned(),
            Some(Event::Bifurcation) => "bifurcation".to_owned(),
            Some(Event::Slack(cable)) => format!("{} goes slack", point.configuration.cables()[cable].name),
            Some(Event::Taut(cable)) => format!("{} is taken up", point.configuration.cables()[cable].name),
            None if index == 0 => "start".to_owned(),
            None if index == last => "end".to_owned(),
            None => continue,
        };
        rows.push(row(point, varied, &event));
    }
    table(&rows, 2)
}

fn row<C: Shape>(point: &PathPoint<C>, varied: &Varied, event: &str) -> Vec<String> {
    let mut row = vec![number(varied.shown(point.value))];
    row.extend(point.configuration.tip_cells());
    row.extend([stability_words(point.stability), event.to_owned()]);
    row
}

/// Says why branches ended elsewhere than at the end of the range. A limit that ends the first one is no success.
fn say_ends<C>(path: &Path<C>, varied: &Varied) -> anyhow::Result<()> {
    for (index, branch) in path.branches.iter().enumerate() {
        let value = branch.points.last().map_or(f64::NAN, |p| p.value);
        let message = end_message(branch.end, varied, value);
        let what = if index == 0 { "the path ends".to_owned() } else { format!("branch {index} ends") };
        match branch.end {
            PathEnd::ReachedEnd => {}
            PathEnd::Limit { .. } if index == 0 => {}
            PathEnd::MostPoints => say::note(format_args!("{what}: {message}; raise it with --max-points")),
            PathEnd::ReachedStart | PathEnd::Stopped | PathEnd::Limit { .. } => {
                say::note(format_args!("{what}: {message}"));
            }
        }
    }
    match path.branches.first() {
        Some(Branch { end: end @ PathEnd::Limit { .. }, points, .. }) => {
            let value = points.last().map_or(f64::NAN, |p| p.value);
            Err(NoAnswer(format!("the path ends inside the range: {}", end_message(*end, varied, value))).into())
        }
        _ => Ok(()),
    }
}
