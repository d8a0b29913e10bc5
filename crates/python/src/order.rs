//! The order in which rows are solved: each from one that is near, and those that are alike once.

use std::cmp::Ordering::Equal;
use std::ops::Range;

use hydrostat::Parameter;

/// How much longer than along a Hilbert curve the way through the rows may be for their own order to stay: rows of a grid lie on lines,
/// along which a solve foresees the next shape.
const LONGER: f64 = 3.0;
/// Binary digits of a place on the curve.
const DIGITS: usize = 120;

/// The rows that are solved, in their order, and for each row the place there of the one that it is equal to; none of those with NaN.
pub(crate) struct Order {
    pub(crate) solved: Vec<usize>,
    pub(crate) places: Vec<Option<usize>>,
}

/// A row among the others.
struct Key {
    row: usize,
    /// Its place on the curve.
    curve: u128,
    /// Its loads, over their ranges.
    at: Range<usize>,
}

/// The order of some rows of the varied columns.
pub(crate) fn order(varied: &[(Parameter, Vec<f64>)], rows: Range<usize>) -> Order {
    let (loads, others): (Vec<_>, Vec<_>) = varied.iter().partition(|(parameter, _)| is_load(*parameter));
    let is_number = |row: &usize| varied.iter().all(|(_, values)| !values[*row].is_nan());
    let numbers: Vec<usize> = rows.clone().filter(is_number).collect();
    let units: Vec<Unit<'_>> = loads.iter().map(|(_, values)| Unit::new(values, &numbers)).collect();
    let digits = (DIGITS / units.len().max(1)).clamp(1, 20);
    let mut unit = Vec::with_capacity(numbers.len() * units.len());
    let mut point = vec![0; units.len().min(DIGITS)];
    let mut keys: Vec<Key> = Vec::with_capacity(numbers.len());
    for row in numbers {
        let start = unit.len();
        unit.extend(units.iter().map(|unit| unit.of(row)));
        keys.push(Key { row, curve: hilbert(&unit[start..], &mut point, digits), at: start..unit.len() });
    }
    let same_start = |a: &Key, b: &Key| others.iter().all(|(_, values)| values[a.row] == values[b.row]);
    let same = |a: &Key, b: &Key| varied.iter().all(|(_, values)| values[a.row] == values[b.row]);
    let compare = |columns: &[&(Parameter, Vec<f64>)], a: &Key, b: &Key| {
        let each = columns.iter().map(|(_, values)| values[a.row].total_cmp(&values[b.row]));
        each.fold(Equal, std::cmp::Ordering::then)
    };
    // From one row to the next; one that starts anew is as far as the range is wide.
    let way = |a: &Key, b: &Key| {
        let apart = || unit[a.at.clone()].iter().zip(&unit[b.at.clone()]).map(|(a, b)| (a - b).abs());
        if same_start(a, b) { apart().fold(0.0, f64::max) } else { 1.0 }
    };
    let length = |keys: &[Key]| -> f64 { keys.windows(2).map(|two| way(&two[0], &two[1])).sum() };
    let given = length(&keys);
    // Places on a line are in the order of their values, whatever the digits of the curve.
    keys.sort_by(|a, b| {
        compare(&others, a, b).then(a.curve.cmp(&b.curve)).then_with(|| compare(&loads, a, b)).then(a.row.cmp(&b.row))
    });
    let sorted = length(&keys);

    let mut first = vec![None; rows.len()];
    let mut solved: Vec<usize> = Vec::with_capacity(keys.len());
    let mut before: Option<&Key> = None;
    for key in &keys {
        let of = before.filter(|before| same(before, key)).unwrap_or(key);
        first[key.row - rows.start] = Some(of.row);
        if of.row == key.row {
            solved.push(key.row);
        }
        before = Some(of);
    }
    if given <= LONGER * sorted {
        solved.sort_unstable();
    }
    let mut at_place = vec![0; rows.len()];
    for (place, row) in solved.iter().enumerate() {
        at_place[row - rows.start] = place;
    }
    let places = first.into_iter().map(|row| row.map(|row: usize| at_place[row - rows.start])).collect();
    Order { solved, places }
}

/// A column over its range.
struct Unit<'a> {
    values: &'a [f64],
    least: f64,
    range: f64,
}

impl<'a> Unit<'a> {
    fn new(values: &'a [f64], rows: &[usize]) -> Self {
        let least = rows.iter().map(|row| values[*row]).fold(f64::INFINITY, f64::min);
        let most = rows.iter().map(|row| values[*row]).fold(f64::NEG_INFINITY, f64::max);
        Self { values, least, range: if most > least { most - least } else { 1.0 } }
    }

    fn of(&self, row: usize) -> f64 {
        (self.values[row] - self.least) / self.range
    }
}

/// What a solve takes over from the row before: all else starts a row anew.
fn is_load(parameter: Parameter) -> bool {
    matches!(
        parameter,
        Parameter::Tension(_)
            | Parameter::FlowSpeed
            | Parameter::FlowDirection
            | Parameter::FlowDensity
            | Parameter::GravityAcceleration
            | Parameter::GravityDirection
            | Parameter::TipForce(_)
            | Parameter::TipFollower(_)
            | Parameter::TipMoment
    )
}

/// The place along a Hilbert curve of a point of the unit cube, with so many binary digits a dimension (Skilling, "Programming the Hilbert
/// curve", AIP Conference Proceedings 707, 2004).
fn hilbert(point: &[f64], x: &mut [u32], digits: usize) -> u128 {
    let count = x.len();
    let top = 1_u32 << (digits - 1);
    for (whole, fraction) in x.iter_mut().zip(point) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 2^20")]
        let digits = (fraction.clamp(0.0, 1.0) * f64::from(2 * top - 1)) as u32;
        *whole = digits;
    }
    let mut q = top;
    while q > 1 {
        let below = q - 1;
        for i in 0..count {
            if x[i] & q == 0 {
                let turned = (x[0] ^ x[i]) & below;
                x[0] ^= turned;
                x[i] ^= turned;
            } else {
                x[0] ^= below;
            }
        }
        q >>= 1;
    }
    for i in 1..count {
        x[i] ^= x[i - 1];
    }
    let mut turned = 0;
    q = top;
    while q > 1 {
        if count > 0 && x[count - 1] & q != 0 {
            turned ^= q - 1;
        }
        q >>= 1;
    }
    let mut out = 0_u128;
    for digit in (0..digits).rev() {
        for own in x.iter() {
            out = out << 1 | u128::from((own ^ turned) >> digit & 1);
        }
    }
    out
}
