//! Overrides: `--set KEY=VALUE`, applied to the tree before it is read.

use hydrostat::Join;

use crate::document::{Entry, Field, Node, Origin, parse_setting};
use crate::format::{self, JOINED, Key, Kind};
use crate::quantity::{Dimension, bare_number};
use crate::reading::{Fault, join, quantity_at, unknown, value_fault};

/// One step of a dotted path.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Step {
    Name(String),
    Index(usize),
}

/// Writes `value` at the dotted path `key`, making tables that are not there yet. `index` is the
/// number of the override.
pub(crate) fn apply(fields: &mut Vec<Field>, key: &str, value: &str, index: usize) -> Result<(), Fault> {
    let origin = Origin::Setting(index);
    let steps = path(&format::bracketed(key.trim())).ok_or_else(|| {
        let expected = "a dotted key such as flow.speed or cable[0].tension".to_owned();
        value_fault("KEY", origin, expected, format!("\"{}\"", crate::error::shortened(key)))
    })?;
    into_table(fields, "", format::FILE, &steps, &Target { value, index, origin })
}

struct Target<'a> {
    value: &'a str,
    index: usize,
    origin: Origin,
}

impl Target<'_> {
    fn node(&self, kind: Kind) -> Node {
        match (kind, parse_setting(self.value, self.index)) {
            // What TOML does not take for a number may be one: .1, 0., 5.e-2.
            (Kind::Text | Kind::Choice(_), text @ Node::Text(_)) => text,
            (_, text @ Node::Text(_)) => bare_number(self.value).map_or(text, Node::Number),
            // A name may look like a number.
            (Kind::Text, _) => Node::Text(self.value.to_owned()),
            (_, node) => node,
        }
    }

    fn refuse(&self, path: &str, expected: impl Into<String>, found: impl Into<String>) -> Fault {
        value_fault(path, self.origin, expected.into(), found.into())
    }
}

fn into_table(
    fields: &mut Vec<Field>,
    path: &str,
    keys: &'static [Key],
    steps: &[Step],
    target: &Target<'_>,
) -> Result<(), Fault> {
    let [Step::Name(name), rest @ ..] = steps else {
        return Err(target.refuse(path, format!("one of {}", format::names(keys)), "an index"));
    };
    let here = join(path, name);
    let Some(key) = keys.iter().find(|k| k.name == name) else {
        return Err(unknown(target.origin, here, name, keys));
    };
    let at = fields.iter().position(|f| f.name == *name).unwrap_or(fields.len());
    if at == fields.len() {
        let entry = Entry { node: empty(key), origin: target.origin };
        fields.push(Field { name: name.clone(), origin: target.origin, entry });
    }
    into_value(&mut fields[at].entry, &here, key.kind, rest, target)
}

/// What a value that is not there yet is made of when only a part of it is set.
fn empty(key: &Key) -> Node {
    match key.kind {
        // A direction of a load is that of its angle until a component is set.
        Kind::Heading => Node::Number(key.default.and_then(bare_number).unwrap_or(0.0)),
        Kind::Tables(_) => Node::Array(Vec::new()),
        Kind::Pair(_) | Kind::ProfilePair(_) => {
            let zero = Entry { node: Node::Number(0.0), origin: Origin::Text(0) };
            Node::Array(vec![zero.clone(), zero])
        }
        Kind::Axial(_) => Node::Number(0.0),
        Kind::Direction => {
            let zero = Entry { node: Node::Number(0.0), origin: Origin::Text(0) };
            Node::Array(vec![zero.clone(), zero.clone(), zero])
        }
        _ => Node::Table(Vec::new()),
    }
}

#[allow(clippy::too_many_lines, reason = "one arm a kind of value")]
fn into_value(entry: &mut Entry, path: &str, kind: Kind, steps: &[Step], target: &Target<'_>) -> Result<(), Fault> {
    let [step, rest @ ..] = steps else {
        *entry = Entry { node: target.node(kind), origin: target.origin };
        return Ok(());
    };
    let kind = match kind {
        Kind::Offset(dimension) => Kind::Profile(dimension),
        Kind::Part => Kind::Quantity(Dimension::Number),
        other => other,
    };
    let whole = |entry: &Entry, what: &str| {
        target.refuse(path, format!("{what}; set {path} as a whole"), entry.node.describe())
    };
    match (kind, step, &mut entry.node) {
        (Kind::Table(keys), Step::Name(_), Node::Table(fields)) => into_table(fields, path, keys, steps, target),
        (Kind::Tables(keys), Step::Index(i), Node::Array(entries)) => {
            let count = entries.len();
            let Some(element) = entries.get_mut(*i) else {
                let expected = match count {
                    0 => "no index, because the arm has 0 cables".to_owned(),
                    1 => "the index 0, because the arm has 1 cable".to_owned(),
                    n => format!("an index from 0 to {}, because the arm has {n} cables", n - 1),
                };
                return Err(target.refuse(path, expected, format!("{i}")));
            };
            into_value(element, &format!("{path}[{i}]"), Kind::Table(keys), rest, target)
        }
        (Kind::Tables(_), Step::Name(_), _) => {
            Err(target.refuse(path, format!("an index, as in {path}[0].tension"), "none"))
        }
        (Kind::Profile(_), Step::Index(_), Node::Table(fields)) if fields.iter().any(is_points) => {
            match fields.iter_mut().find(|field| is_points(field)) {
                Some(points) => into_value(&mut points.entry, path, kind, steps, target),
                None => Ok(()),
            }
        }
        // Points that have no word yet for how they are joined get one.
        (Kind::Profile(_), Step::Name(name), Node::Array(points)) if name == JOINED[1] && rest.is_empty() => {
            let points = Entry { node: Node::Array(std::mem::take(points)), origin: entry.origin };
            let field = |name: &str, entry: Entry| Field { name: name.to_owned(), origin: entry.origin, entry };
            let word = Entry { node: target.node(Kind::Choice(&Join::NAMES)), origin: target.origin };
            entry.node = Node::Table(vec![field(JOINED[0], points), field(JOINED[1], word)]);
            Ok(())
        }
        (Kind::Profile(_), Step::Name(name), Node::Table(fields)) => {
            let here = join(path, name);
            let known = if fields.iter().any(is_points) { JOINED } else { format::ENDS };
            if !known.contains(&name.as_str()) {
                let expected = format!("{} or {}", known[0], known[1]);
                return Err(target.refuse(&here, expected, format!("\"{name}\"")));
            }
            if !rest.is_empty() {
                return Err(target.refuse(&here, "the end of the key", "more of it"));
            }
            let entry = Entry { node: target.node(kind), origin: target.origin };
            match fields.iter_mut().find(|f| f.name == *name) {
                Some(field) => field.entry = entry,
                None => fields.push(Field { name: name.clone(), origin: target.origin, entry }),
            }
            Ok(())
        }
        (Kind::Profile(_), Step::Name(_), _) => Err(whole(entry, "{ base = _, tip = _ }")),
        (Kind::Profile(d), Step::Index(i), Node::Array(entries)) => {
            let count = entries.len();
            match entries.get_mut(*i) {
                Some(point) => into_value(point, &format!("{path}[{i}]"), Kind::Pair(d), rest, target),
                None => Err(target.refuse(path, format!("an index below {count}"), format!("{i}"))),
            }
        }
        (Kind::Profile(_), Step::Index(_), _) => Err(whole(entry, "[[s, value], ...]")),
        // The third component, in space.
        (Kind::Pair(_) | Kind::ProfilePair(_), Step::Index(2), Node::Array(entries)) if entries.len() == 2 => {
            entries.push(Entry { node: Node::Number(0.0), origin: entry.origin });
            into_value(entry, path, kind, steps, target)
        }
        (Kind::Pair(d) | Kind::Axial(d), Step::Index(i), Node::Array(entries)) => match entries.get_mut(*i) {
            Some(part) => into_value(part, &format!("{path}[{i}]"), Kind::Quantity(d), rest, target),
            None => Err(target.refuse(path, "the index 0, 1 or 2", format!("{i}"))),
        },
        (Kind::Heading | Kind::Direction, Step::Index(i), Node::Array(entries)) => match entries.get_mut(*i) {
            Some(part) => into_value(part, &format!("{path}[{i}]"), Kind::Quantity(Dimension::Number), rest, target),
            None => Err(target.refuse(path, "the index 0, 1 or 2", format!("{i}"))),
        },
        // An angle is a direction in the plane e1-e2.
        (Kind::Heading, Step::Index(_), Node::Number(_) | Node::Text(_)) => {
            let Some(angle) = quantity_at(Dimension::Angle, entry) else {
                return Err(target.refuse(path, kind.expected(), entry.node.describe()));
            };
            let origin = entry.origin;
            // Along an axis the other component is zero, not what rounding leaves of it.
            let parts = [angle.cos(), angle.sin(), 0.0].map(|x| if x.abs() < f64::EPSILON { 0.0 } else { x });
            entry.node = Node::Array(parts.map(|part| Entry { node: Node::Number(part), origin }).to_vec());
            into_value(entry, path, kind, steps, target)
        }
        // A number is the component along e3.
        (Kind::Axial(_), Step::Index(_), Node::Number(own)) => {
            let (own, origin) = (*own, entry.origin);
            let part = |value: f64| Entry { node: Node::Number(value), origin };
            entry.node = Node::Array(vec![part(0.0), part(0.0), part(own)]);
            into_value(entry, path, kind, steps, target)
        }
        (Kind::AxialProfile(d), Step::Index(i), Node::Array(entries)) if entries.len() == 3 => {
            match entries.get_mut(*i) {
                Some(part) => into_value(part, &format!("{path}[{i}]"), Kind::Profile(d), rest, target),
                None => Err(target.refuse(path, "the index 0, 1 or 2", format!("{i}"))),
            }
        }
        (Kind::AxialProfile(d), ..) => into_value(entry, path, Kind::Profile(d), steps, target),
        (Kind::ProfilePair(d), Step::Index(i), Node::Array(entries)) => match entries.get_mut(*i) {
            Some(part) => into_value(part, &format!("{path}[{i}]"), Kind::Profile(d), rest, target),
            None => Err(target.refuse(path, "the index 0, 1 or 2", format!("{i}"))),
        },
        (
            Kind::Table(_)
            | Kind::Tables(_)
            | Kind::Pair(_)
            | Kind::ProfilePair(_)
            | Kind::Axial(_)
            | Kind::Heading
            | Kind::Direction,
            _,
            _,
        ) => Err(target.refuse(path, kind.expected(), entry.node.describe())),
        (Kind::Text | Kind::Choice(_) | Kind::Flag | Kind::Quantity(_) | Kind::Offset(_) | Kind::Part, ..) => {
            Err(target.refuse(path, "the end of the key", "more of it"))
        }
    }
}

fn is_points(field: &Field) -> bool {
    field.name == JOINED[0]
}

/// `cable[0].tension` as steps.
fn path(key: &str) -> Option<Vec<Step>> {
    // The format is four steps deep; more can only be a mistake.
    const LONGEST: usize = 200;
    if key.len() > LONGEST {
        return None;
    }
    let mut steps = Vec::new();
    for part in key.trim().split('.') {
        let (name, mut indices) = part.find('[').map_or((part, ""), |i| part.split_at(i));
        let word = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || !name.chars().all(word) {
            return None;
        }
        steps.push(Step::Name(name.to_owned()));
        while !indices.is_empty() {
            let (digits, rest) = indices.strip_prefix('[')?.split_once(']')?;
            if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
                return None;
            }
            steps.push(Step::Index(digits.parse().unwrap_or(usize::MAX)));
            indices = rest;
        }
    }
    Some(steps)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_names_and_indices() {
        let name = |n: &str| Step::Name(n.to_owned());
        assert_eq!(path("flow.speed"), Some(vec![name("flow"), name("speed")]));
        assert_eq!(path("cable[12].tension"), Some(vec![name("cable"), Step::Index(12), name("tension")]));
        assert_eq!(path("arm.radius[1][0]").map(|s| s.len()), Some(4));
        for bad in ["", ".", "a..b", "cable[]", "cable[-1]", "cable[0", "cable]0[", "a b", "cable[0]x"] {
            assert_eq!(path(bad), None, "{bad}");
        }
    }
}
