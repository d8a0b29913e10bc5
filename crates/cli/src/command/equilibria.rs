//! `hydrostat equilibria`: all equilibria under the same loads.

use std::fmt::Write as _;
use std::time::Instant;

use anyhow::Context as _;
use hydrostat::{Arm, Equilibria, PathError};
use hydrostat_figures::{equilibria_figure, over_figure};
use hydrostat_files::equilibria::side_message;
use hydrostat_files::{EquilibriaDocument, Others, OverDocument, Varied, equilibria_csv, number, over_csv};

use super::NoAnswer;
use super::path::{abscissa, check_quantity, title};
use super::table::{TIP, stability_words, table, tip_cells};
use crate::args::{EquilibriaArgs, Format, Over};
use crate::output;
use crate::progress::Progress;
use crate::request::{self, WrongRequest};

pub(crate) fn run(args: &EquilibriaArgs) -> anyhow::Result<()> {
    let arm = request::arm(&args.arm, "`hydrostat equilibria`")?;
    check_quantity(&arm, args.quantity)?;
    if let Some(Over { varied, .. }) = &args.over {
        varied.parameter.of(&arm).map_err(|e| WrongRequest::Unfit("--over", e))?;
    }
    let pictures = [("--plot", args.plot.as_deref()), ("--plot-over", args.plot_over.as_deref())];
    let outputs = [("-o", args.output.as_deref()), pictures[0], pictures[1]];
    request::check_outputs(&[request::arm_input(&args.arm.file)], &outputs)?;
    request::check_picture(&args.picture, &pictures)?;
    match &args.over {
        Some(over) => over_range(args, &arm, *over),
        None => at_loads(args, &arm),
    }
}

fn at_loads(args: &EquilibriaArgs, arm: &Arm) -> anyhow::Result<()> {
    let all = search(arm, args)?;
    if let Some(file) = args.plot.as_ref().filter(|_| !all.found.is_empty()) {
        let title = format!("{}: all equilibria", arm.name);
        output::draw(&equilibria_figure(&all, &title, &args.picture.page()), file, &args.picture.page)?;
    }
    let text = match args.format {
        Format::Text => summary(arm, &all),
        Format::Json => output::line(EquilibriaDocument::new(arm, &all).to_json()),
        Format::Csv => equilibria_csv(arm.cables.len(), &all),
    };
    output::put(args.output.as_deref(), &text)?;
    if all.found.is_empty() {
        return Err(NoAnswer(format!("no equilibrium was found; {}", extent(&all).replace('\n', " "))).into());
    }
    Ok(())
}

/// The equilibria of `arm` that are found within the time limit. `place` says where the search is among others.
fn within(arm: &Arm, args: &EquilibriaArgs, progress: &mut Progress, place: &str) -> Result<Equilibria, PathError> {
    let start = Instant::now();
    arm.equilibria_while(args.tol, |points| {
        progress.say(|| format!("{place}{points} points of the curve of equilibria"));
        args.time_limit.is_none_or(|limit| start.elapsed() < limit)
    })
}

/// The equilibria of `arm`; an error says what a solve at its own base angle says.
fn search(arm: &Arm, args: &EquilibriaArgs) -> anyhow::Result<Equilibria> {
    within(arm, args, &mut Progress::new(), "").map_err(|error| match error {
        PathError::Start { source, .. } => {
            let message = format!("no equilibrium was found at any base angle; at the angle of the arm, {source}");
            anyhow::Error::new(source).context(message)
        }
        PathError::Option { option, value, expected } => {
            let message = format!("--{option}: expected a number {expected}, found {value}");
            anyhow::Error::new(error).context(message)
        }
        other => other.into(),
    })
}

fn over_range(args: &EquilibriaArgs, arm: &Arm, Over { varied, count }: Over) -> anyhow::Result<()> {
    let searches = searches(arm, args, &varied, count)?;
    if let Some(file) = &args.plot_over {
        let found: Vec<(f64, &Equilibria)> =
            searches.iter().filter_map(|(value, all)| Some((*value, all.as_ref().ok()?))).collect();
        let (title, page) = (title(arm, &varied), args.picture.page());
        let figure = over_figure(&found, &abscissa(&varied), args.quantity, &title, &page);
        output::draw(&figure, file, &args.picture.page)?;
    }
    let text = match args.format {
        Format::Text => over_summary(arm, &varied, &searches),
        Format::Json => output::line(OverDocument::new(arm, &varied, &searches).to_json()),
        Format::Csv => over_csv(arm.cables.len(), &varied, &searches),
    };
    output::put(args.output.as_deref(), &text)?;
    for (value, all) in &searches {
        if let Err(message) = all {
            eprintln!("warning: at {}: {message}", varied.with_unit(*value));
        }
    }
    if searches.iter().all(|(_, all)| all.as_ref().map_or(0, |all| all.found.len()) == 0) {
        return Err(NoAnswer(format!("no equilibrium was found at any value of {}", varied.parameter)).into());
    }
    Ok(())
}

/// A search at each value; what the arm cannot be is an error, what has no equilibrium a result.
fn searches(
    arm: &Arm,
    args: &EquilibriaArgs,
    varied: &Varied,
    count: usize,
) -> anyhow::Result<Vec<(f64, Result<Equilibria, String>)>> {
    let mut progress = Progress::new();
    let mut out = Vec::new();
    for (index, value) in varied.values(count).into_iter().enumerate() {
        let at = || format!("at {} = {}", varied.parameter, varied.with_unit(value));
        let place = format!("value {} of {count}, {}, ", index + 1, at());
        let mut there = arm.clone();
        varied.parameter.set(&mut there, value).map_err(|e| WrongRequest::Unfit("--over", e))?;
        there.check().map_err(|e| WrongRequest::Value(at(), e))?;
        let found = match within(&there, args, &mut progress, &place) {
            Ok(all) => Ok(all),
            Err(PathError::Start { source, .. }) => Err(source.to_string()),
            Err(other) => return Err(other).with_context(at),
        };
        out.push((value, found));
    }
    Ok(out)
}

fn summary(arm: &Arm, all: &Equilibria) -> String {
    let mut out = format!("{}: {}\n", arm.name, counted(all));
    let _ = writeln!(out, "{}\n", extent(all));
    let mut head = vec!["number".to_owned()];
    head.extend(TIP.map(str::to_owned));
    head.push("stability".to_owned());
    let mut rows = vec![head];
    for (index, one) in all.found.iter().enumerate() {
        let mut row = vec![(index + 1).to_string()];
        row.extend(tip_cells(&one.configuration));
        row.push(stability_words(one.stability));
        rows.push(row);
    }
    out.push_str(&table(&rows, 1));
    out
}

/// How many, and how many of them stable.
fn counted(all: &Equilibria) -> String {
    let Others { count, stable, .. } = Others::from(all);
    format!("{count} equilibri{}, {stable} of them stable", if count == 1 { "um" } else { "a" })
}

/// Whether the search is complete, and what it covered.
fn extent(all: &Equilibria) -> String {
    // Hundredths, without those that rounding leaves of nothing.
    let angle = |rad: f64| number((100.0 * rad.to_degrees()).round() / 100.0 + 0.0);
    let range = |[from, to]: [f64; 2]| format!("{} to {} deg", angle(from), angle(to));
    let angles = format!("tip at {}, base at {}", range(all.tip_angles), range(all.base_angles));
    if all.complete {
        return format!("complete: the curve of equilibria was followed all the way around\n({angles})");
    }
    let ends: Vec<String> =
        (0..2).filter_map(|side| all.ends[side].map(|end| side_message(end, all.base_angles[side]))).collect();
    format!("not complete: the curve of equilibria was followed in part\n({angles}),\nthen {}", ends.join("; and "))
}

fn over_summary(arm: &Arm, varied: &Varied, searches: &[(f64, Result<Equilibria, String>)]) -> String {
    let [from, to] = varied.range.map(|value| varied.with_unit(value));
    let mut out =
        format!("{}: equilibria at {} values of {}, {from} to {to}\n\n", arm.name, searches.len(), varied.parameter);
    let unit = if varied.unit.is_empty() { "value" } else { varied.unit };
    let mut rows = vec![[unit, "equilibria", "stable", "search"].map(str::to_owned).to_vec()];
    for (value, found) in searches {
        let value = number(varied.shown(*value));
        rows.push(match found {
            Ok(all) => {
                let Others { count, stable, complete } = Others::from(all);
                let search = if complete { "complete" } else { "not complete" };
                vec![value, count.to_string(), stable.to_string(), search.to_owned()]
            }
            Err(_) => vec![value, "0".to_owned(), "0".to_owned(), "none found".to_owned()],
        });
    }
    out.push_str(&table(&rows, 1));
    out
}
