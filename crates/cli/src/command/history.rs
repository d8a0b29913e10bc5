//! `hydrostat history`: equilibria along loads that rise and fall.

use std::fmt::Write as _;
use std::path::Path;

use hydrostat::{Arm, Configuration, LoadingError, LoadingStep, SpatialConfiguration};
use hydrostat_figures::{Abscissa, LoadingPoint, loading_figure};
use hydrostat_files::{LoadRows, LoadingRow, number, parse_load_rows, read_load_rows};

use super::loaded::Loaded;
use super::path::check_quantity;
use super::slip;
use super::table::{counted, decimals, table};
use crate::args::{Format, HistoryArgs};
use crate::input;
use crate::output;
use crate::progress::Progress;
use crate::request::{self, WrongRequest};

pub(crate) fn run(args: &HistoryArgs) -> anyhow::Result<()> {
    input::check_once(&[("ARM", Some(Path::new(&args.arm.file))), ("--input", Some(&args.input))])?;
    let arm = request::arm_in_space(&args.arm)?;
    check_quantity(&arm, args.quantity)?;
    let inputs = [request::arm_input(&args.arm.file), Some(("--input", input::source(&args.input)))];
    let outputs = [("-o", args.output.as_deref()), ("--plot", args.plot.as_deref())];
    request::check_outputs(&inputs, &outputs)?;
    request::check_picture(&args.picture, &[("--plot", args.plot.as_deref())])?;
    let loads = loads(args)?;
    slip::warn(&arm, &loads.spans());
    if arm.space.is_some() {
        return along::<SpatialConfiguration>(args, &arm, &loads);
    }
    along::<Configuration>(args, &arm, &loads)
}

fn along<C: Loaded>(args: &HistoryArgs, arm: &Arm, loads: &LoadRows) -> anyhow::Result<()> {
    let over = column(loads, args.over.as_deref())?;
    let arms = loads.arms(arm)?;
    let (rows, failure) = follow::<C>(&arms, loads, args.tol);
    let verdict = failure.as_ref().map(|(row, error)| at_row(loads, *row, error));
    if let Some(file) = args.plot.as_ref().filter(|_| rows.len() > 1) {
        output::draw(&diagram(args, arm, loads, over, &rows), file, &args.picture.page)?;
    }
    let text = match args.format {
        Format::Text => summary(arm, loads, &rows),
        Format::Json => output::line(C::loading_document(arm, loads, &rows, verdict.clone()).to_json()),
        Format::Csv => C::loading_csv(loads, &rows),
    };
    output::put(args.output.as_deref(), &text)?;
    match failure {
        Some((_, error)) => {
            let message = verdict.unwrap_or_default();
            Err(anyhow::Error::new(error).context(message))
        }
        None => Ok(()),
    }
}

/// A row of loads with its equilibrium.
type Row<C> = LoadingRow<C, <C as hydrostat_figures::Posed>::Tip>;

/// The loads, row by row.
fn loads(args: &HistoryArgs) -> anyhow::Result<LoadRows> {
    if input::is_standard(&args.input) {
        return Ok(parse_load_rows(&input::text()?, input::NAME)?);
    }
    Ok(read_load_rows(&args.input)?)
}

/// The rows that were reached, and the index of the one that was not, with why.
#[allow(clippy::type_complexity, reason = "names of what is there")]
fn follow<C: Loaded>(
    arms: &[Arm],
    loads: &LoadRows,
    tol: f64,
) -> (Vec<Row<C>>, Option<(usize, LoadingError<C::Error>)>) {
    let mut progress = Progress::new();
    let mut rows: Vec<Row<C>> = Vec::new();
    let Some(first) = arms.first() else { return (rows, None) };
    let (mut loading, configuration) = match C::start(first, tol) {
        Ok(started) => started,
        Err(error) => return (rows, Some((0, error))),
    };
    let values = |row: usize| loads.rows[row].1.clone();
    rows.push(LoadingRow::new(None, values(0), LoadingStep { configuration, snaps: Vec::new() }));
    for (k, arm) in arms.iter().enumerate().skip(1) {
        progress.say(|| format!("row {k} of {}", arms.len()));
        match C::go_to(&mut loading, arm) {
            Ok(step) => rows.push(LoadingRow::new(Some(&values(k - 1)), values(k), step)),
            Err(error) => return (rows, Some((k, error))),
        }
    }
    (rows, None)
}

/// What ended the way to a row.
fn at_row(loads: &LoadRows, row: usize, error: &impl std::fmt::Display) -> String {
    let line = loads.rows.get(row).map_or(0, |(line, _)| *line);
    format!("row {} (line {line}): {error}", row + 1)
}

/// The column that the diagram runs over.
fn column(loads: &LoadRows, asked: Option<&str>) -> Result<usize, WrongRequest> {
    if let Some(key) = asked {
        return loads.column(key).ok_or_else(|| WrongRequest::NoLoad(key.to_owned(), loads.keys.clone()));
    }
    let changes = |k: &usize| loads.rows.windows(2).any(|pair| pair[0].1[*k] != pair[1].1[*k]);
    Ok((0..loads.keys.len()).find(changes).unwrap_or(0))
}

fn diagram<C: Loaded>(
    args: &HistoryArgs,
    arm: &Arm,
    loads: &LoadRows,
    over: usize,
    rows: &[Row<C>],
) -> hydrostat_figures::Scene {
    let points: Vec<LoadingPoint<'_, C>> = rows
        .iter()
        .map(|row| LoadingPoint {
            value: row.loads[over],
            configuration: &row.step.configuration,
            snaps: row.snaps.iter().map(|snap| (snap.loads[over], snap.snap)).collect(),
        })
        .collect();
    let key = &loads.keys[over];
    let abscissa = Abscissa { name: key.clone(), unit: loads.unit(over).to_owned(), per_si: 1.0 };
    loading_figure(&points, &abscissa, args.quantity, &format!("{}: {key} up and down", arm.name), &args.picture.page())
}

/// The snaps, and where the arm is at the end.
fn summary<C: Loaded>(arm: &Arm, loads: &LoadRows, rows: &[Row<C>]) -> String {
    let with_unit = |k: usize, value: f64| format!("{} {}", number(value), loads.unit(k)).trim_end().to_owned();
    let mut out = format!("history {}, {} of {}\n", arm.name, counted(rows.len(), "row"), loads.keys.join(", "));
    let snaps: Vec<_> =
        rows.iter().enumerate().flat_map(|(k, row)| row.snaps.iter().map(move |s| (k + 1, s))).collect();
    if !snaps.is_empty() {
        let mut head = vec!["row".to_owned()];
        head.extend(loads.keys.iter().cloned());
        head.extend(["jumps (mm)", "turns (deg)", "rests after (s)", "lands"].map(str::to_owned));
        let mut lines = vec![head];
        for (row, snap) in &snaps {
            let mut line = vec![row.to_string()];
            line.extend(snap.loads.iter().enumerate().map(|(k, value)| with_unit(k, *value)));
            line.extend([
                decimals(1e3 * snap.snap.distance(), 3),
                decimals(snap.snap.angle().to_degrees(), 3),
                decimals(snap.snap.duration, 2),
            ]);
            let lands = match snap.snap.on_curve {
                None => "the curve does not lead on",
                Some(_) if snap.snap.lands_elsewhere(arm.length) => "elsewhere than the curve",
                Some(_) => "as the curve",
            };
            line.push(lands.to_owned());
            lines.push(line);
        }
        let _ = write!(out, "\n{}", table(&lines, 1));
    }
    let mut lines = vec![[vec!["row".to_owned()], C::TIP.map(str::to_owned).into()].concat()];
    for k in [0, rows.len().saturating_sub(1)] {
        if let Some(row) = rows.get(k) {
            lines.push([vec![(k + 1).to_string()], row.step.configuration.tip_cells().into()].concat());
        }
    }
    let _ = write!(out, "\n{}", table(&lines, 0));
    let _ = writeln!(out, "\n{}", if snaps.is_empty() { "no snap".to_owned() } else { counted(snaps.len(), "snap") });
    out
}
