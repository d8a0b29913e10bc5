//! `hydrostat plot`: pictures of a sweep.

use std::path::PathBuf;

use hydrostat_figures::{
    Abscissa, Coloured, ColouredColumn, KeyValues, Page, Scene, curve_figure, map_figure, value_text, workspace_figure,
};
use hydrostat_sweep::{Table, VariedKey, names, note_beside, varied_keys};

use crate::args::PlotArgs;
use crate::output;
use crate::request::{self, WrongRequest};

const TIP: [&str; 2] = ["tip_x_m", "tip_y_m"];

pub(crate) fn run(args: &PlotArgs) -> anyhow::Result<()> {
    let keys = varied_keys(&args.sweep)?;
    let all = names(&args.sweep)?;
    let over = over(&keys, &args.over)?;
    let pictures = pictures(args, all.iter().any(|name| name == TIP[0]));
    let outputs: Vec<_> = pictures.iter().map(|(option, file, _)| (*option, Some(file.as_path()))).collect();
    let beside = note_beside(&args.sweep);
    request::check_outputs(&[Some(("SWEEP", &*args.sweep)), Some(("SWEEP", &*beside))], &outputs)?;

    let mut wanted: Vec<&str> = keys.iter().map(|key| key.column.as_str()).collect();
    wanted.extend(TIP);
    wanted.push(&args.quantity);
    let table = Table::read(&args.sweep, &wanted)?;
    let column = coloured(&table, &args.quantity).ok_or_else(|| WrongRequest::NoColumn(args.quantity.clone(), all))?;
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
                let tips: Vec<[f64; 2]> = x.into_iter().zip(y).map(|(x, y)| [x, y]).collect();
                workspace_figure(&tips, &column, &name, &page)
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

/// The keys of the map: those asked for, or the only two, or the only one.
fn over(keys: &[VariedKey], asked: &[String]) -> Result<Vec<VariedKey>, WrongRequest> {
    let known = || keys.iter().map(|key| key.name.clone()).collect();
    if asked.is_empty() {
        return if keys.len() <= 2 { Ok(keys.to_vec()) } else { Err(WrongRequest::Over(known())) };
    }
    let named =
        |asked: &String| keys.iter().find(|key| key.name == asked.trim() || key.column == asked.trim()).cloned();
    let found: Option<Vec<VariedKey>> = asked.iter().map(named).collect();
    match found {
        Some(found) if found.len() == 1 || (found.len() == 2 && found[0] != found[1]) => Ok(found),
        _ => Err(WrongRequest::Over(known())),
    }
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
