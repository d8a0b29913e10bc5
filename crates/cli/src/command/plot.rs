//! `hydrostat plot`: pictures of a sweep.

use std::path::{Path, PathBuf};

use hydrostat_figures::{
    Abscissa, Coloured, ColouredColumn, KeyValues, Page, Scene, curve_figure, map_figure, spatial_workspace_figure,
    value_text, workspace_figure,
};
use hydrostat_files::head_now;
use hydrostat_sweep::{Table, VariedKey, names, note_beside, varied_keys};

use crate::args::PlotArgs;
use crate::output;
use crate::request::{self, WrongRequest};

const TIP: [&str; 2] = ["tip_x_m", "tip_y_m"];
/// Of arms in space.
const TIP_Z: &str = "tip_z_m";
const ALPHA: &str = "tip_alpha_rad";
/// How little an error estimate says of an arm.
const ERROR: &str = "error_estimate_m";
const VERDICT: &str = "verdict";
/// What is drawn first where several vary.
const TIP_FIRST: [&str; 2] = ["tip_theta_rad", ALPHA];

pub(crate) fn run(args: &PlotArgs) -> anyhow::Result<()> {
    let keys = varied_keys(&args.sweep)?;
    let all = names(&args.sweep)?;
    let pictures = pictures(args, all.iter().any(|name| name == TIP[0]));
    let outputs: Vec<_> = pictures.iter().map(|(option, file, _)| (*option, Some(file.as_path()))).collect();
    let beside = note_beside(&args.sweep);
    request::check_outputs(&[Some(("SWEEP", &*args.sweep)), Some(("SWEEP", &*beside))], &outputs)?;

    let quantity = match &args.quantity {
        Some(asked) => head_now(asked),
        None => varying(&args.sweep, &all, &keys)?,
    };
    let mut wanted: Vec<&str> = keys.iter().map(|key| key.column.as_str()).collect();
    wanted.extend(TIP);
    wanted.push(TIP_Z);
    wanted.push(&quantity);
    let table = Table::read(&args.sweep, &wanted)?;
    let Some(column) = coloured(&table, &quantity) else {
        return Err(WrongRequest::NoColumn(args.quantity.clone().unwrap_or(quantity), all).into());
    };
    if matches!(&column.values, Coloured::Numbers(values) if !values.iter().any(|value| value.is_finite())) {
        return Err(WrongRequest::NothingToDraw(args.sweep.clone(), Some(quantity)).into());
    }
    // A workspace needs no keys, of which there may be as many as cables.
    let has_map = pictures.iter().any(|(_, _, kind)| matches!(kind, Kind::Map));
    let over = if has_map || !args.over.is_empty() { over(&table, &keys, &args.over)? } else { Vec::new() };
    let name = args.sweep.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let page = args.picture.page();
    let mut written = String::new();
    for (option, file, kind) in pictures {
        let scene = match kind {
            Kind::Map => map(&table, [&keys, &over], &column, &name, &page)?,
            Kind::Workspace => {
                let [x, y] = TIP.map(|name| table.numbers(name));
                let (Some(x), Some(y)) = (x, y) else {
                    return Err(WrongRequest::NotInSweep(option, "the columns tip_x_m and tip_y_m").into());
                };
                let tips = x.into_iter().zip(y);
                if let Some(z) = table.numbers(TIP_Z) {
                    let tips: Vec<[f64; 3]> = tips.zip(z).map(|((x, y), z)| [x, y, z]).collect();
                    spatial_workspace_figure(&tips, &column, &name, &page)
                } else {
                    let tips: Vec<[f64; 2]> = tips.map(|(x, y)| [x, y]).collect();
                    workspace_figure(&tips, &column, &name, &page)
                }
            }
        };
        output::draw(&scene, &file, &args.picture.page)?;
        written.extend([&*file.to_string_lossy(), "\n"]);
    }
    // Names that were asked for are known.
    if args.map.is_none() && args.workspace.is_none() {
        output::print(&written)?;
    }
    Ok(())
}

#[derive(Clone, Copy)]
enum Kind {
    Map,
    Workspace,
}

/// What is drawn and into which files.
fn pictures(args: &PlotArgs, has_tips: bool) -> Vec<(&'static str, PathBuf, Kind)> {
    let mut out = Vec::new();
    if args.map.is_none() && args.workspace.is_none() {
        let beside = |ending: &str| args.sweep.with_extension(ending);
        out.extend(["map.svg", "map.png"].map(|ending| ("--map", beside(ending), Kind::Map)));
        if has_tips {
            let endings = ["workspace.svg", "workspace.png"];
            out.extend(endings.map(|ending| ("--workspace", beside(ending), Kind::Workspace)));
        }
    }
    out.extend(args.map.iter().map(|file| ("--map", file.clone(), Kind::Map)));
    out.extend(args.workspace.iter().map(|file| ("--workspace", file.clone(), Kind::Workspace)));
    out
}

/// The keys of the map: those asked for, or the only two whose values are numbers, or the only one.
fn over(table: &Table, keys: &[VariedKey], asked: &[String]) -> Result<Vec<VariedKey>, WrongRequest> {
    let known = || keys.iter().map(|key| key.name.clone()).collect();
    if asked.is_empty() {
        let has_numbers = |key: &&VariedKey| table.numbers(&key.column).is_some();
        let numbers: Vec<VariedKey> = keys.iter().filter(has_numbers).cloned().collect();
        return match numbers.len() {
            0 => Err(WrongRequest::OnlyWords(known())),
            1 | 2 => Ok(numbers),
            _ => Err(WrongRequest::Over(known())),
        };
    }
    let named = |asked: &String| {
        let asked = asked.trim();
        keys.iter().find(|key| key.name == asked || key.column == head_now(asked)).cloned()
    };
    let found: Option<Vec<VariedKey>> = asked.iter().map(named).collect();
    match found {
        Some(found) if found.len() == 1 || (found.len() == 2 && found[0] != found[1]) => Ok(found),
        _ => Err(WrongRequest::Over(known())),
    }
}

/// The column that gives colours where none is asked for: one that varies.
fn varying(sweep: &Path, all: &[String], keys: &[VariedKey]) -> anyhow::Result<String> {
    const LEAST_ANGLE: f64 = 10.0 * std::f64::consts::PI / 180.0;
    let is_key = |name: &str| keys.iter().any(|key| key.column == name);
    let mut outputs: Vec<&str> = all.iter().skip(1).map(String::as_str).filter(|name| !is_key(name)).collect();
    outputs.sort_by_key(|name| TIP_FIRST.iter().position(|first| first == name).unwrap_or(TIP_FIRST.len()));
    let table = Table::read(sweep, &outputs)?;
    if table.words(VERDICT).is_some_and(|verdicts| verdicts.iter().all(Option::is_some)) {
        return Err(WrongRequest::NothingToDraw(sweep.to_owned(), None).into());
    }
    let span = |name: &str| {
        let values = table.numbers(name)?;
        let ends = |ends: [f64; 2], v: &f64| [ends[0].min(*v), ends[1].max(*v)];
        let [from, to] = values.iter().filter(|v| v.is_finite()).fold([f64::INFINITY, f64::NEG_INFINITY], ends);
        // What differs by rounding does not vary.
        Some(to - from).filter(|span| *span > 1e-9 * from.abs().max(to.abs()))
    };
    if span(ALPHA).is_some_and(|span| span >= LEAST_ANGLE) {
        return Ok(ALPHA.to_owned());
    }
    let widest =
        TIP.into_iter().chain([TIP_Z]).filter_map(|name| Some((name, span(name)?))).max_by(|a, b| a.1.total_cmp(&b.1));
    let other = || outputs.iter().copied().filter(|name| *name != ERROR).find(|name| span(name).is_some());
    // Where nothing varies, one colour is what there is to see.
    let any =
        || outputs.iter().copied().find(|name| table.numbers(name).is_some_and(|v| v.iter().any(|v| v.is_finite())));
    Ok(widest.map(|(name, _)| name).or_else(other).or_else(any).unwrap_or(VERDICT).to_owned())
}

fn coloured(table: &Table, name: &str) -> Option<ColouredColumn> {
    let values = match table.numbers(name) {
        // A CSV's column of words without any reads as one of numbers.
        Some(numbers) => Coloured::Numbers(numbers),
        None => Coloured::Words(table.words(name)?),
    };
    Some(ColouredColumn { name: name.to_owned(), values })
}

/// A column over one key or two; where others vary, at their first value.
fn map(
    table: &Table,
    [keys, over]: [&[VariedKey]; 2],
    column: &ColouredColumn,
    name: &str,
    page: &Page,
) -> anyhow::Result<Scene> {
    let mut title = name.to_owned();
    let mut rows: Vec<usize> = (0..count(column)).collect();
    let others: Vec<&VariedKey> = keys.iter().filter(|key| !over.contains(key)).collect();
    let mut kept = rows.clone();
    for key in &others {
        match (table.numbers(&key.column), table.words(&key.column)) {
            (Some(numbers), _) => kept.retain(|row| numbers[*row] == numbers[0]),
            (None, Some(words)) => kept.retain(|row| words[*row] == words[0]),
            (None, None) => {}
        }
    }
    // Of a sample, no two rows share a value: all are shown.
    if kept.len() >= 2 && kept.len() < rows.len() {
        rows = kept;
        for key in others {
            let value = table.numbers(&key.column).and_then(|values| values.first().copied());
            let word = || table.words(&key.column)?.first()?.clone().map(|word| format!("{} = {word}", key.name));
            let text = value.map(|value| value_text(&axis(key), value)).or_else(word);
            title.push_str(&text.map_or_else(String::new, |text| format!(", {text}")));
        }
    }
    let values = |key: &VariedKey| -> Result<KeyValues, WrongRequest> {
        let values = table.numbers(&key.column).ok_or_else(|| WrongRequest::Words(key.name.clone()))?;
        Ok(KeyValues { axis: axis(key), values: rows.iter().map(|row| values[*row]).collect() })
    };
    let column = column.of(&rows);
    match (over, &column.values) {
        ([x, y], _) => Ok(map_figure(&[values(x)?, values(y)?], &column, &title, page)),
        ([key], Coloured::Numbers(numbers)) => Ok(curve_figure(&values(key)?, &column.name, numbers, &title, page)),
        _ => Err(WrongRequest::NotInSweep("--map", "a column of numbers, or two keys").into()),
    }
}

fn count(column: &ColouredColumn) -> usize {
    match &column.values {
        Coloured::Numbers(values) => values.len(),
        Coloured::Words(values) => values.len(),
    }
}

fn axis(key: &VariedKey) -> Abscissa {
    Abscissa { name: key.name.clone(), unit: key.unit.clone(), per_si: key.per_si }
}
