//! Values that are relative to others: an offset as a fraction of the radius, the end of a cable as a length. Both become plain numbers before the
//! tree is read.

use std::borrow::Cow;

use hydrostat::{Join, Profile};

use crate::document::{Entry, Field, Node};
use crate::format::{ENDS, JOINED};
use crate::quantity::{Dimension, percent};
use crate::reading::{Values, quantity_at};

/// The fields with plain numbers in place of what is relative. What cannot be told, for want of a length or radius, stays as it is if it
/// is wrong by itself, and is none where only that is missing, which is said once.
pub(crate) fn resolved(fields: &[Field]) -> Cow<'_, [Field]> {
    let cables = |fields: &[Field]| fields.iter().position(|field| field.name == "cable");
    let is_relative = |cable: &Entry| match &cable.node {
        Node::Table(fields) => fields.iter().any(|field| match field.name.as_str() {
            "offset" => has_fraction(&field.entry),
            "end" => matches!(field.entry.node, Node::Text(_)),
            _ => false,
        }),
        _ => false,
    };
    let Some(at) = cables(fields) else { return Cow::Borrowed(fields) };
    let Node::Array(found) = &fields[at].entry.node else { return Cow::Borrowed(fields) };
    if !found.iter().any(is_relative) {
        return Cow::Borrowed(fields);
    }
    let (length, radius) = size(fields);
    let mut out = fields.to_vec();
    if let Node::Array(cables) = &mut out[at].entry.node {
        for cable in cables {
            let Node::Table(fields) = &mut cable.node else { continue };
            for field in fields {
                match field.name.as_str() {
                    "offset" => offset(&mut field.entry, length, radius.as_ref()),
                    "end" => end(&mut field.entry, length),
                    _ => {}
                }
            }
        }
    }
    Cow::Owned(out)
}

/// Length and radius of the arm, m, where they can be read.
fn size(fields: &[Field]) -> (Option<f64>, Option<Profile>) {
    let arm = fields.iter().find(|field| field.name == "arm");
    let Some(Node::Table(keys)) = arm.map(|arm| &arm.entry.node) else { return (None, None) };
    let of = |name: &str| keys.iter().find(|key| key.name == name).map(|key| &key.entry);
    let mut values = Values::default();
    let length = of("length").and_then(|entry| quantity_at(Dimension::Length, entry));
    (length, of("radius").and_then(|entry| values.profile_of(Dimension::Length, entry)))
}

/// Whether a fraction stands anywhere in a value.
fn has_fraction(entry: &Entry) -> bool {
    match &entry.node {
        Node::Text(text) => percent(text).is_some(),
        Node::Array(entries) => entries.iter().any(has_fraction),
        Node::Table(fields) => fields.iter().any(|field| has_fraction(&field.entry)),
        Node::Number(_) | Node::Boolean(_) | Node::Datetime(_) => false,
    }
}

/// Shares of the radius at each place as lengths.
fn offset(entry: &mut Entry, length: Option<f64>, radius: Option<&Profile>) {
    let (Some(length), Some(radius)) = (length, radius) else {
        if has_fraction(entry) {
            entry.node = Node::Number(0.0);
        }
        return;
    };
    let origin = entry.origin;
    let number = |value: f64| Entry { node: Node::Number(value), origin };
    let field = |name: &str, entry: Entry| Field { name: name.to_owned(), origin, entry };
    match &mut entry.node {
        Node::Text(text) => {
            let Some(fraction) = percent(text) else { return };
            entry.node = match radius {
                Profile::Constant(value) => Node::Number(short_product(fraction, *value)),
                Profile::Linear { base, tip } => Node::Table(vec![
                    field(ENDS[0], number(short_product(fraction, *base))),
                    field(ENDS[1], number(short_product(fraction, *tip))),
                ]),
                Profile::Table(table) => {
                    let point =
                        |[s, value]: [f64; 2]| Node::Array(vec![number(s), number(short_product(fraction, value))]);
                    let points = table.points().map(|at| Entry { node: point(at), origin }).collect();
                    joined(Entry { node: Node::Array(points), origin }, table.join(), &field)
                }
            };
        }
        Node::Array(points) => shares_at(points, length, radius),
        Node::Table(fields) => {
            for field in fields {
                match (field.name.as_str(), &mut field.entry.node) {
                    ("base", node) => fraction_at(node, 0.0, length, radius),
                    ("tip", node) => fraction_at(node, length, length, radius),
                    ("points", Node::Array(points)) => shares_at(points, length, radius),
                    _ => {}
                }
            }
        }
        Node::Number(_) | Node::Boolean(_) | Node::Datetime(_) => {}
    }
}

/// Points with how they are joined.
fn joined(points: Entry, join: Join, field: &dyn Fn(&str, Entry) -> Field) -> Node {
    let word = Entry { node: Node::Text(join.name().to_owned()), origin: points.origin };
    Node::Table(vec![field(JOINED[0], points), field(JOINED[1], word)])
}

fn shares_at(points: &mut [Entry], length: f64, radius: &Profile) {
    for point in points {
        let Node::Array(pair) = &mut point.node else { continue };
        let [place, value] = pair.as_mut_slice() else { continue };
        if let Some(s) = quantity_at(Dimension::Length, place) {
            fraction_at(&mut value.node, s, length, radius);
        }
    }
}

fn fraction_at(node: &mut Node, s: f64, length: f64, radius: &Profile) {
    let fraction = match node {
        Node::Text(text) => percent(text),
        _ => None,
    };
    if let Some(fraction) = fraction {
        // Not `clamp`, which panics where a length is negative: that is refused later, by its key.
        let radius = radius.at(s.max(0.0).min(length), length).value;
        *node = Node::Number(short_product(fraction, radius));
    }
}

/// `fraction` of a length with 15 digits: 70 % of 10 mm is 7 mm, not 6.999999999999999 mm.
fn short_product(fraction: f64, length: f64) -> f64 {
    let product = fraction * length;
    format!("{product:.14e}").parse().unwrap_or(product)
}

/// Where a cable ends, as a fraction of the length.
fn end(entry: &mut Entry, length: Option<f64>) {
    let Node::Text(text) = &entry.node else { return };
    let fraction = match (percent(text), Dimension::Length.parse(text), length) {
        (Some(fraction), ..) => Some(fraction),
        (None, Ok(place), Some(length)) => Some(place / length),
        // The length is missing, not this.
        (None, Ok(_), None) => Some(1.0),
        (None, Err(_), _) => None,
    };
    if let Some(fraction) = fraction {
        entry.node = Node::Number(fraction);
    }
}

#[cfg(test)]
mod tests {
    use super::short_product;

    #[test]
    fn shares_of_round_lengths_are_round() {
        assert_eq!(short_product(0.7, 0.010), 0.007);
        assert_eq!(short_product(-0.35, 0.002), -0.0007);
        assert_eq!(short_product(0.1, 0.3), 0.03);
    }
}
