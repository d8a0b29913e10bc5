//! TOML text as a tree of values that know where they were written.

use toml::de::{DeInteger, DeTable, DeValue};

use crate::error::shortened;

/// Where a value comes from: a place in the text, or an override.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Origin {
    /// Byte offset in the text.
    Text(usize),
    /// Index of the override.
    Setting(usize),
}

/// A value and where it was written.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub(crate) node: Node,
    pub(crate) origin: Origin,
}

/// A key of a table, where it was written, and its value.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    pub(crate) name: String,
    pub(crate) origin: Origin,
    pub(crate) entry: Entry,
}

/// A value. TOML's integers and floats are one: no key of the format is a count.
#[derive(Debug, Clone)]
pub(crate) enum Node {
    Text(String),
    Number(f64),
    Boolean(bool),
    Datetime(String),
    Array(Vec<Entry>),
    /// In the order of the text.
    Table(Vec<Field>),
}

impl Node {
    /// What it is, in words short enough for a message.
    pub(crate) fn describe(&self) -> String {
        match self {
            Self::Text(text) => format!("\"{}\"", shortened(text)),
            Self::Number(value) => written(*value),
            Self::Boolean(value) => format!("{value}"),
            Self::Datetime(text) => format!("the date {text}"),
            Self::Array(entries) if entries.len() == 1 => "an array of 1 value".to_owned(),
            Self::Array(entries) => format!("an array of {} values", entries.len()),
            Self::Table(fields) if fields.is_empty() => "an empty table".to_owned(),
            Self::Table(fields) => {
                let names: Vec<String> = fields.iter().take(4).map(|f| segment(&f.name)).collect();
                let more = if fields.len() > 4 { ", ..." } else { "" };
                format!("a table with {}{more}", names.join(", "))
            }
        }
    }
}

/// A number as a person would write it.
pub(crate) fn written(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A key as it stands in a dotted path: quoted unless it is bare.
pub(crate) fn segment(name: &str) -> String {
    let bare = !name.is_empty() && name.len() <= 60;
    if bare && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-') {
        name.to_owned()
    } else {
        format!("\"{}\"", shortened(name))
    }
}

/// What the TOML parser refuses.
#[derive(Debug)]
pub(crate) struct SyntaxError {
    /// Byte offset.
    pub(crate) at: usize,
    /// The text it points at.
    pub(crate) what: String,
    pub(crate) message: String,
}

/// Deeper nesting than the format has, so that no text can exhaust the stack.
const MAX_DEPTH: usize = 16;

/// Opening brackets up to which a text is parsed on the stack that there is.
const FEW_OPEN: usize = 200;

/// Stack for each opening bracket of other texts: what a level takes, with room to spare.
const STACK_EACH: usize = if cfg!(debug_assertions) { 8192 } else { 2048 };

/// The fields of a TOML document.
pub(crate) fn parse(text: &str) -> Result<Vec<Field>, SyntaxError> {
    with_stack_for(text, || parse_here(text)).unwrap_or_else(|| {
        let message = "more opening brackets than there is memory for".to_owned();
        Err(SyntaxError { at: 0, what: String::new(), message })
    })
}

/// The value after `KEY=` of an override: TOML if it is, else a string.
pub(crate) fn parse_setting(text: &str, index: usize) -> Node {
    let node = with_stack_for(text, || parse_setting_here(text, index)).flatten();
    node.unwrap_or_else(|| Node::Text(text.to_owned()))
}

/// Parses with a stack that no nesting of brackets in `text` exhausts: the parser stops at a depth of its own, but counts a level less for
/// closing brackets that belong to nothing. `None` where there is no memory for it.
fn with_stack_for<T: Send>(text: &str, parse: impl FnOnce() -> T + Send) -> Option<T> {
    let open = text.bytes().filter(|byte| matches!(byte, b'{' | b'[')).count();
    if open <= FEW_OPEN {
        return Some(parse());
    }
    std::thread::scope(|scope| {
        let builder = std::thread::Builder::new().stack_size(open.saturating_mul(STACK_EACH));
        builder.spawn_scoped(scope, parse).ok()?.join().ok()
    })
}

fn parse_here(text: &str) -> Result<Vec<Field>, SyntaxError> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let table = DeValue::Table(table.into_inner());
    let result = match first(text, errors) {
        Some(error) => Err(error),
        None => convert(&table, 0, 0, &Origin::Text).map(|node| match node {
            Node::Table(fields) => fields,
            _ => Vec::new(),
        }),
    };
    dismantle(table);
    result
}

fn parse_setting_here(text: &str, index: usize) -> Option<Node> {
    let (value, errors) = DeValue::parse_recoverable(text);
    let value = value.into_inner();
    let node = if errors.is_empty() { convert(&value, 0, 0, &|_| Origin::Setting(index)).ok() } else { None };
    dismantle(value);
    node
}

fn first(text: &str, errors: Vec<toml::de::Error>) -> Option<SyntaxError> {
    let start = |e: &toml::de::Error| e.span().map_or(text.len(), |s| s.start);
    let error = errors.into_iter().min_by_key(start)?;
    let span = error.span().unwrap_or(text.len()..text.len());
    let what = text.get(span.clone()).unwrap_or_default().to_owned();
    Some(SyntaxError { at: span.start, what, message: error.message().to_owned() })
}

fn convert(
    value: &DeValue<'_>,
    at: usize,
    depth: usize,
    origin: &dyn Fn(usize) -> Origin,
) -> Result<Node, SyntaxError> {
    if depth > MAX_DEPTH {
        let message = format!("nested more than {MAX_DEPTH} deep");
        return Err(SyntaxError { at, what: String::new(), message });
    }
    Ok(match value {
        DeValue::String(text) => Node::Text(text.clone().into_owned()),
        DeValue::Integer(integer) => Node::Number(integer_value(integer)),
        // Beyond the largest number the text is read as infinite, and refused as such.
        DeValue::Float(float) => Node::Number(float.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(value) => Node::Boolean(*value),
        DeValue::Datetime(date) => Node::Datetime(date.to_string()),
        DeValue::Array(array) => {
            let mut entries = Vec::with_capacity(array.len());
            for value in array {
                let at = value.span().start;
                let node = convert(value.get_ref(), at, depth + 1, origin)?;
                entries.push(Entry { node, origin: origin(at) });
            }
            Node::Array(entries)
        }
        DeValue::Table(table) => {
            let mut fields = Vec::with_capacity(table.len());
            for (key, value) in table {
                let at = value.span().start;
                let node = convert(value.get_ref(), at, depth + 1, origin)?;
                let entry = Entry { node, origin: origin(at) };
                let key_at = key.span().start;
                fields
                    .push((key_at, Field { name: key.get_ref().clone().into_owned(), origin: origin(key_at), entry }));
            }
            fields.sort_by_key(|(at, _)| *at);
            Node::Table(fields.into_iter().map(|(_, field)| field).collect())
        }
    })
}

fn integer_value(integer: &DeInteger<'_>) -> f64 {
    let text = integer.as_str();
    if integer.radix() == 10 {
        return text.parse().unwrap_or(f64::NAN);
    }
    #[allow(clippy::cast_precision_loss, reason = "rounding to the nearest number is meant")]
    i128::from_str_radix(text, integer.radix()).map_or(f64::INFINITY, |v| v as f64)
}

/// Drops a tree level by level: nested drops of a deep one could exhaust the stack.
fn dismantle(value: DeValue<'_>) {
    let mut rest = vec![value];
    while let Some(value) = rest.pop() {
        match value {
            DeValue::Array(array) => rest.extend(array.into_iter().map(toml::Spanned::into_inner)),
            DeValue::Table(table) => rest.extend(table.into_iter().map(|(_, v)| v.into_inner())),
            _ => {}
        }
    }
}

/// The dotted key that the text at byte `at` belongs to, as far as lines can tell. For messages
/// about text that has no tree.
pub(crate) fn key_at(text: &str, at: usize) -> Option<String> {
    let mut section = String::new();
    let mut key = String::new();
    let mut index: Option<(String, usize)> = None;
    let mut offset = 0;
    for line in text.split_inclusive('\n') {
        if offset > at {
            break;
        }
        offset += line.len();
        let line = line.trim_start_matches('\u{feff}').trim();
        if let Some((name, array)) = header(line) {
            key = String::new();
            section.clone_from(&name);
            if array {
                let n = match &index {
                    Some((last, n)) if *last == name => n + 1,
                    _ => 0,
                };
                section = format!("{name}[{n}]");
                index = Some((name, n));
            }
        } else if let Some((name, _)) = line.split_once('=') {
            let name = name.trim();
            let plain = |c: char| c.is_alphanumeric() || "_-.\"' ".contains(c);
            if !name.is_empty() && name.len() <= 60 && name.chars().all(plain) {
                name.clone_into(&mut key);
            }
        } else if !line.is_empty() && !line.starts_with(['#', '[', ']', '{', '}', '"', '\'']) && key.is_empty() {
            // A line that is no assignment at all: its first word is the best name there is.
            key = line.split_whitespace().next().map(segment).unwrap_or_default();
        }
    }
    match (section.is_empty(), key.is_empty()) {
        (true, true) => None,
        (true, false) => Some(key),
        (false, true) => Some(section),
        (false, false) => Some(format!("{section}.{key}")),
    }
}

/// The name in `[name]` or `[[name]]`, and whether it is the latter.
fn header(line: &str) -> Option<(String, bool)> {
    let inner = line.strip_prefix('[')?;
    let (inner, array) = inner.strip_prefix('[').map_or((inner, false), |i| (i, true));
    let name = inner.split([']', '#']).next()?.trim();
    let after = &inner[inner.find(']').map_or(inner.len(), |i| i + 1)..];
    let after = after.trim_start_matches(']').trim();
    let bare = |b: u8| b.is_ascii_alphanumeric() || b"_-. \"'".contains(&b);
    let starts = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '"' || c == '\'');
    (starts && name.bytes().all(bare) && (after.is_empty() || after.starts_with('#'))).then(|| (name.to_owned(), array))
}
