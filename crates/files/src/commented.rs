//! An arm as a file to start from: each key with its meaning, what is left at its default as a comment.

use std::fmt::Write as _;

use hydrostat::{Arm, ModelOptions};

use crate::document::{Node, parse_setting};
use crate::format::{self, Key, Kind};
use crate::quantity::Dimension;
use crate::written::{Tree, model, plain_tree};

const HEAD: &str = "\
# An arm for `hydrostat solve`. `hydrostat check` shows all values; docs/interface.md describes all keys.
#
# Numbers are in SI units, angles in degrees. Strings may have other units: \"245 mm\", \"110 kPa\", \"30 deg\".
# A quantity along the arm is one value, { base = _, tip = _ }, or points [[s, value], ...] from s = 0 to the length.
# A key behind a # is not set. It shows its default, or an example where it has none. Remove the # to set it.
";

/// Keys that may be left out and have no default, with a value to show.
const EXAMPLES: [(&str, &str); 6] = [
    ("stroke", "\"10 mm\""),
    ("stiffness", "\"2 kN\""),
    ("max_tension", "\"1.5 N\""),
    ("cn", "2.5"),
    ("ct", "0.005"),
    ("viscosity", "\"300 Pa s\""),
];

/// Column at which comments begin, where the value leaves room.
const COMMENTS: usize = 44;

/// The text of an arm file with a comment at each key. Reading it gives the same arm.
///
/// ```
/// use hydrostat_files::{ArmFile, commented_arm, shipped};
///
/// let arm = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap().arm().unwrap();
/// let text = commented_arm(&arm);
/// assert!(text.contains("length = \"245 mm\"") && text.contains("# Undeformed length"));
/// assert_eq!(ArmFile::parse(&text, "my.toml").unwrap().arm().unwrap(), arm);
/// ```
pub fn commented_arm(arm: &Arm) -> String {
    let mut out = HEAD.to_owned();
    let Tree::Table(tables) = plain_tree(arm) else { return out };
    for key in format::FILE {
        let value = tables.iter().find(|(name, _)| *name == key.name).map(|(_, value)| value);
        match (key.kind, value) {
            (Kind::Table(keys), Some(Tree::Table(values))) => table(&mut out, key, keys, values, "[", "]"),
            (Kind::Table(keys), _) => table(&mut out, key, keys, &[], "[", "]"),
            (Kind::Tables(keys), Some(Tree::Array(all))) => {
                for one in all {
                    if let Tree::Table(values) = one {
                        table(&mut out, key, keys, values, "[[", "]]");
                    }
                }
            }
            (Kind::Tables(keys), _) => table(&mut out, key, keys, &[], "[[", "]]"),
            (kind, Some(value)) => line(&mut out, &format!("\n{} = {}", key.name, text(value, kind)), key.doc),
            (_, None) => {}
        }
    }
    out
}

fn table(out: &mut String, of: &Key, keys: &'static [Key], values: &[(&'static str, Tree)], open: &str, close: &str) {
    let mut lines = String::new();
    let mut any = false;
    for key in keys {
        let value = values.iter().find(|(name, _)| *name == key.name).map(|(_, value)| value);
        let active = value.filter(|value| key.required || !is_default(of.name, key, value));
        any |= active.is_some();
        let example = || EXAMPLES.iter().find(|(name, _)| *name == key.name).map(|(_, example)| (*example).to_owned());
        let shown = || value.map(|value| text(value, key.kind)).or_else(|| key.default.map(str::to_owned));
        if let Some(value) = active {
            line(&mut lines, &format!("{} = {}", key.name, text(value, key.kind)), key.doc);
        } else if let Some(shown) = shown().or_else(example) {
            line(&mut lines, &format!("# {} = {shown}", key.name), &described(key));
        }
    }
    let mark = if any { "" } else { "# " };
    let _ = write!(out, "\n# {}\n{mark}{open}{}{close}\n{lines}", of.doc, of.name);
}

/// What a key means, with the words that it may have.
fn described(key: &Key) -> String {
    match key.kind {
        Kind::Choice(_) => format!("{} {}.", key.doc, key.kind.expected()),
        _ => key.doc.to_owned(),
    }
}

fn line(out: &mut String, assignment: &str, comment: &str) {
    let width = assignment.trim_start_matches('\n').chars().count();
    let _ = writeln!(out, "{assignment}{:1$} # {comment}", "", COMMENTS.saturating_sub(width));
}

/// Whether a value is what the key has where it is left out.
fn is_default(table: &str, key: &Key, value: &Tree) -> bool {
    let node = |text: &str| parse_setting(text, 0);
    let written = |value: &Tree| {
        let mut text = String::new();
        value.write_toml(&mut text);
        node(&text)
    };
    if table == "model" {
        let Tree::Table(words) = model(ModelOptions::default()) else { return false };
        return words.iter().any(|(name, word)| *name == key.name && word == value);
    }
    // Left out, an offset is a number that few arms can have.
    key.name != "offset" && key.default.is_some_and(|default| same(&node(default), &written(value)))
}

fn same(a: &Node, b: &Node) -> bool {
    match (a, b) {
        (Node::Number(a), Node::Number(b)) => a == b,
        (Node::Text(a), Node::Text(b)) => a == b,
        (Node::Array(a), Node::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(&a.node, &b.node)),
        (Node::Table(a), Node::Table(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.name == b.name && same(&a.entry.node, &b.entry.node))
        }
        _ => false,
    }
}

/// A value as people write it.
fn text(value: &Tree, kind: Kind) -> String {
    let each = |parts: &[Tree], kinds: [Kind; 3]| -> String {
        let parts: Vec<String> = parts.iter().zip(kinds).map(|(part, kind)| text(part, kind)).collect();
        format!("[{}]", parts.join(", "))
    };
    match (value, kind) {
        (
            Tree::Number(number),
            Kind::Quantity(dimension)
            | Kind::Axial(dimension)
            | Kind::Profile(dimension)
            | Kind::AxialProfile(dimension)
            | Kind::Offset(dimension),
        ) => in_unit(*number, dimension),
        (Tree::Number(number), Kind::Heading) => in_unit(*number, Dimension::Angle),
        (Tree::Array(parts), Kind::Pair(dimension) | Kind::Axial(dimension)) => {
            each(parts, [Kind::Quantity(dimension); 3])
        }
        (Tree::Array(parts), Kind::Heading | Kind::Direction) => each(parts, [Kind::Quantity(Dimension::Number); 3]),
        (Tree::Array(parts), Kind::AxialProfile(dimension)) if parts.len() == 3 && !is_points(parts) => {
            each(parts, [Kind::Profile(dimension); 3])
        }
        (Tree::Array(pair), Kind::ProfilePair(dimension)) => each(pair, [Kind::Profile(dimension); 3]),
        (Tree::Array(points), Kind::Profile(dimension) | Kind::AxialProfile(dimension) | Kind::Offset(dimension)) => {
            let kinds = [Kind::Quantity(Dimension::Length), Kind::Quantity(dimension), Kind::Quantity(dimension)];
            let point = |point: &Tree| match point {
                Tree::Array(pair) => each(pair, kinds),
                other => text(other, kind),
            };
            format!("[{}]", points.iter().map(point).collect::<Vec<_>>().join(", "))
        }
        (Tree::Table(keys), _) => {
            let keys: Vec<String> =
                keys.iter().map(|(name, value)| format!("{name} = {}", text(value, kind))).collect();
            format!("{{ {} }}", keys.join(", "))
        }
        (other, _) => {
            let mut text = String::new();
            other.write_toml(&mut text);
            text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
        }
    }
}

/// Whether all of an array are points [s, value], not profiles.
fn is_points(parts: &[Tree]) -> bool {
    parts.iter().all(|part| match part {
        Tree::Array(pair) => pair.len() == 2 && pair.iter().all(|v| matches!(v, Tree::Number(_))),
        _ => false,
    })
}

/// A number in the unit in which such sizes are usually told, where that reads as the same number; else in the SI unit.
fn in_unit(value: f64, dimension: Dimension) -> String {
    let size = value.abs();
    let unit = match dimension {
        Dimension::Length if (1e-5..1.0).contains(&size) => Some("mm"),
        Dimension::Pressure if (1e3..1e6).contains(&size) => Some("kPa"),
        Dimension::Pressure if (1e6..1e9).contains(&size) => Some("MPa"),
        Dimension::Speed if size >= 0.01 => Some("m/s"),
        Dimension::Force if size >= 0.01 => Some("N"),
        _ => None,
    };
    let readable = unit.and_then(|unit| {
        let count = format!("{:.10}", value * dimension.per_si(unit)?);
        let text = format!("{} {unit}", count.trim_end_matches('0').trim_end_matches('.'));
        (dimension.parse(&text) == Ok(value)).then(|| format!("\"{text}\""))
    });
    readable.unwrap_or_else(|| {
        let text = format!("{value:?}");
        text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
    })
}
