//! Texts and files with parts of them changed: bytes at random rarely get past the first line.

use std::fmt;

use proptest::collection::vec;
use proptest::prelude::any;
use proptest::prop_oneof;
use proptest::sample::{Index, select};
use proptest::strategy::{Just, Strategy};

/// Bytes that show as text where they are some.
#[derive(Clone)]
pub struct Bytes(pub Vec<u8>);

impl fmt::Debug for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0.escape_ascii())
    }
}

/// What formats give a meaning.
const TOKENS: [&str; 40] = [
    "[",
    "]",
    "{",
    "}",
    "[[",
    "]]",
    "\"",
    "'",
    "\"\"\"",
    "'''",
    "\n",
    "\r\n",
    "\r",
    "\t",
    ",",
    ";",
    ":",
    "=",
    ".",
    "#",
    "\\",
    "\\u0000",
    "\u{feff}",
    "\0",
    "1e999",
    "-0",
    "nan",
    "inf",
    "0x7fffffffffffffff",
    "99999999999999999999",
    "1979-05-27T07:32:00Z",
    "true",
    "null",
    "mm",
    "N m",
    "deg",
    "[[cable]]\n",
    "base",
    "tip",
    "1e-308",
];

/// One change.
#[derive(Debug, Clone)]
enum Change {
    Set(Index, u8),
    Remove(Index, usize),
    Repeat(Index, usize, usize),
    Move(Index, usize, Index),
    Insert(Index, &'static str),
    Number(Index, f64),
    Cut(Index),
}

fn change() -> impl Strategy<Value = Change> {
    prop_oneof![
        2 => (any::<Index>(), any::<u8>()).prop_map(|(at, byte)| Change::Set(at, byte)),
        2 => (any::<Index>(), 1..40_usize).prop_map(|(at, count)| Change::Remove(at, count)),
        2 => (any::<Index>(), 1..40_usize, 1..4_usize).prop_map(|(at, count, times)| Change::Repeat(at, count, times)),
        1 => (any::<Index>(), 1..40_usize, 100..2000_usize).prop_map(|(at, count, times)| Change::Repeat(at, count, times)),
        2 => (any::<Index>(), 1..40_usize, any::<Index>()).prop_map(|(at, count, to)| Change::Move(at, count, to)),
        4 => (any::<Index>(), select(TOKENS.to_vec())).prop_map(|(at, token)| Change::Insert(at, token)),
        4 => (any::<Index>(), number()).prop_map(|(at, number)| Change::Number(at, number)),
        1 => any::<Index>().prop_map(Change::Cut),
    ]
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        (-12.0..12.0_f64, any::<bool>()).prop_map(|(e, minus)| if minus { -(10_f64.powf(e)) } else { 10_f64.powf(e) }),
        select(vec![0.0, -0.0, 1.0, -1.0, f64::MAX, f64::MIN_POSITIVE, 5e-324, 1e300]),
    ]
}

impl Change {
    fn apply(&self, out: &mut Vec<u8>) {
        if out.is_empty() {
            return;
        }
        let part = |out: &[u8], at: &Index, count: usize| {
            let at = at.index(out.len());
            at..(at + count).min(out.len())
        };
        match self {
            Self::Set(at, byte) => {
                let at = at.index(out.len());
                out[at] = *byte;
            }
            Self::Remove(at, count) => {
                let part = part(out, at, *count);
                out.drain(part);
            }
            Self::Repeat(at, count, times) => {
                let part = part(out, at, *count);
                let copies = out[part.clone()].repeat(*times);
                out.splice(part.start..part.start, copies);
            }
            Self::Move(at, count, to) => {
                let part = part(out, at, *count);
                let moved: Vec<u8> = out.drain(part).collect();
                let to = to.index(out.len() + 1);
                out.splice(to..to, moved);
            }
            Self::Insert(at, token) => {
                let at = at.index(out.len());
                out.splice(at..at, token.bytes());
            }
            // The number that stands at the place, or after it.
            Self::Number(at, value) => {
                let from = at.index(out.len());
                let digit = |b: &u8| b.is_ascii_digit() || matches!(b, b'.' | b'-' | b'e');
                let Some(start) = (from..out.len()).find(|k| out[*k].is_ascii_digit()) else { return };
                let end = (start..out.len()).find(|k| !digit(&out[*k])).unwrap_or(out.len());
                out.splice(start..end, format!("{value:?}").into_bytes());
            }
            Self::Cut(at) => out.truncate(at.index(out.len())),
        }
    }
}

/// One of `wholes` with a few changes; now and then bytes at random.
pub fn mutations_of(wholes: Vec<Vec<u8>>) -> impl Strategy<Value = Bytes> {
    let changed = (select(wholes), vec(change(), 0..6)).prop_map(|(mut bytes, changes)| {
        for change in &changes {
            change.apply(&mut bytes);
        }
        bytes
    });
    prop_oneof![20 => changed, 1 => vec(any::<u8>(), 0..200), 1 => Just(Vec::new())].prop_map(Bytes)
}
