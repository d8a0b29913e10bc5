//! Axes: from data to the page, with ticks and titles.

use crate::font::{CAP_HEIGHT, Label};
use crate::numbers::{roundest, short};
use crate::palette::INK;
use crate::placement::Rect;
use crate::scene::{Anchor, Point, Scene, Stroke};

/// Size of tick labels and of all other text, points.
pub(crate) const TICK_SIZE: f64 = 7.5;
pub(crate) const TEXT_SIZE: f64 = 8.5;
const TICK: f64 = 3.0;
const FRAME: Stroke = Stroke::solid(INK, 0.6);

/// How the values of an axis are spaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Equal differences are equal lengths.
    #[default]
    Even,
    /// Equal ratios are equal lengths; values have to be above zero.
    Logarithmic,
}

impl Scale {
    /// A value as a length.
    pub(crate) fn of(self, value: f64) -> f64 {
        match self {
            Self::Even => value,
            Self::Logarithmic => value.log10(),
        }
    }

    /// About `count` ticks in `range` (lengths), whose labels have `room` points.
    fn ticks(self, range: [f64; 2], count: f64, room: Room) -> Ticks {
        match self {
            Self::Even => Ticks::even(range, count, room),
            Self::Logarithmic => Ticks { labelled: decades(range, count), note: String::new() },
        }
    }
}

/// A rectangle of the page that shows an interval of x and one of y.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axes {
    pub(crate) frame: Rect,
    /// As lengths of their scales.
    x: [f64; 2],
    y: [f64; 2],
    scales: [Scale; 2],
}

impl Axes {
    /// Axes that fill `frame`.
    pub(crate) fn new(frame: Rect, x: [f64; 2], y: [f64; 2]) -> Self {
        Self { frame, x, y, scales: [Scale::Even; 2] }
    }

    /// Axes that fill `frame` with ranges that are lengths of their scales.
    pub(crate) fn scaled(frame: Rect, [x, y]: [[f64; 2]; 2], scales: [Scale; 2]) -> Self {
        Self { frame, x, y, scales }
    }

    /// Axes of equal scale at `left`, `top` with the given width. What they show is at least `x`
    /// by `y`; the height follows, between `heights`, by showing more of the shorter side.
    pub(crate) fn equal(left: f64, top: f64, width: f64, heights: [f64; 2], x: [f64; 2], y: [f64; 2]) -> Self {
        let (dx, dy) = (x[1] - x[0], y[1] - y[0]);
        let scale = (width / dx).min(heights[1] / dy);
        let height = (dy * scale).clamp(heights[0], heights[1]);
        let grow = |range: [f64; 2], points: f64| {
            let more = 0.5 * (points / scale - (range[1] - range[0]));
            [range[0] - more, range[1] + more]
        };
        let frame = Rect { left, top, right: left + width, bottom: top + height };
        Self::new(frame, grow(x, width), grow(y, height))
    }

    /// Where a data point is on the page.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> Point {
        self.place([self.scales[0].of(x), self.scales[1].of(y)])
    }

    /// Where lengths of the scales are on the page.
    fn place(&self, [x, y]: [f64; 2]) -> Point {
        let f = &self.frame;
        [
            f.left + f.width() * (x - self.x[0]) / (self.x[1] - self.x[0]),
            f.bottom - f.height() * (y - self.y[0]) / (self.y[1] - self.y[0]),
        ]
    }

    pub(crate) fn all(&self, points: &[[f64; 2]]) -> Vec<Point> {
        points.iter().map(|p| self.at(*p)).collect()
    }

    /// The parts of the line through `points` (data) inside the frame, on the page.
    pub(crate) fn clipped(&self, points: &[[f64; 2]]) -> Vec<Vec<Point>> {
        let mut parts: Vec<Vec<Point>> = Vec::new();
        let mut open = false;
        for pair in self.all(points).windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let Some((from, to)) = self.frame.part_of(a, b) else {
                open = false;
                continue;
            };
            let on = |t: f64| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
            if !(open && from == 0.0) {
                parts.push(vec![on(from)]);
            }
            if let Some(part) = parts.last_mut() {
                part.push(on(to));
            }
            open = to == 1.0;
        }
        parts
    }

    /// Frame, ticks, tick labels and titles.
    pub(crate) fn draw(&self, scene: &mut Scene, x_title: &Label, y_title: &Label) {
        self.draw_above_another(scene, y_title);
        let f = self.frame;
        let below = f.bottom + TICK + 2.0 + CAP_HEIGHT * TICK_SIZE;
        let ticks = self.x_ticks();
        for (tick, label) in &ticks.labelled {
            let [x, _] = self.place([*tick, 0.0]);
            scene.text(label, [x, below], Anchor::Middle, TICK_SIZE);
        }
        let at = [0.5 * (f.left + f.right), below + 5.0 + CAP_HEIGHT * TEXT_SIZE];
        scene.text(&ticks.titled(x_title), at, Anchor::Middle, TEXT_SIZE);
    }

    /// The same without what is said of x: that stands below another frame further down.
    pub(crate) fn draw_above_another(&self, scene: &mut Scene, y_title: &Label) {
        let f = self.frame;
        scene.area(&[[f.left, f.top], [f.right, f.top], [f.right, f.bottom], [f.left, f.bottom]], None, Some(FRAME));
        for (tick, _) in self.x_ticks().labelled {
            let [x, _] = self.place([tick, 0.0]);
            scene.line(&[[x, f.bottom], [x, f.bottom + TICK]], FRAME);
        }
        let mut widest = 0.0_f64;
        let ticks = self.scales[1].ticks(self.y, f.height() / 38.0, Room::Beside);
        for (tick, label) in &ticks.labelled {
            let [_, y] = self.place([0.0, *tick]);
            scene.line(&[[f.left, y], [f.left - TICK, y]], FRAME);
            widest = widest.max(label.width(TICK_SIZE));
            scene.text(label, [f.left - TICK - 2.5, y + 0.5 * CAP_HEIGHT * TICK_SIZE], Anchor::End, TICK_SIZE);
        }
        let beside = [f.left - TICK - 2.5 - widest - 6.0, 0.5 * (f.top + f.bottom)];
        scene.text_in(&ticks.titled(y_title), beside, Anchor::Middle, TEXT_SIZE, INK, true);
    }

    fn x_ticks(&self) -> Ticks {
        let width = self.frame.width();
        self.scales[0].ticks(self.x, width / 55.0, Room::Below { width })
    }
}

/// Room that titles and tick labels need left of and below the frame, points.
pub(crate) const LEFT: f64 = 44.0;
pub(crate) const BELOW: f64 = 28.0;

/// The widest tick label beside a frame, points: what [`LEFT`] leaves beside tick and title.
const WIDEST: f64 = LEFT - TICK - 2.5 - 6.0 - CAP_HEIGHT * TEXT_SIZE - 0.5;
/// Between two tick labels below a frame, at the least, points.
const BETWEEN: f64 = 2.0;

/// Where tick labels stand.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Room {
    /// One above the other, beside the frame or a bar of colours.
    Beside,
    /// In a row of this width, points.
    Below { width: f64 },
}

/// Ticks with labels that can be told apart and have room.
#[derive(Debug, Clone)]
pub(crate) struct Ticks {
    /// Their places and labels.
    pub(crate) labelled: Vec<(f64, Label)>,
    /// What the title has to say of the labels: what is taken off the numbers, and in which power of ten they are.
    note: String,
}

impl Ticks {
    /// Round numbers in `range`, about `count`. Where they have too many digits, a number that all have in common is taken off, and
    /// they are in a power of ten.
    pub(crate) fn even(range: [f64; 2], count: f64, room: Room) -> Self {
        let (places, step) = ticks(range, count);
        let common = roundest(range[0] - 1e-6 * step, range[1] + 1e-6 * step);
        let largest = |off: f64| places.iter().map(|place| (place - off).abs()).fold(step, f64::max);
        // From what needs no words to what needs most.
        let ways = [(0.0, 0), (0.0, power(largest(0.0))), (common, 0), (common, power(largest(common)))];
        let labels = |(off, power): (f64, i32)| -> Vec<Label> {
            let decimals = decimals_of(step, power);
            let shown = |place: &f64| if decimals > MOST_DECIMALS { None } else { Some(scaled(place - off, power)) };
            places.iter().filter_map(shown).map(|number| tick_label(number, decimals)).collect()
        };
        let fits = |labels: &[Label]| {
            let widths: Vec<f64> = labels.iter().map(|label| label.width(TICK_SIZE)).collect();
            match room {
                Room::Beside => widths.iter().all(|width| *width <= WIDEST),
                Room::Below { width } => {
                    let apart = width * step / (range[1] - range[0]);
                    widths.windows(2).all(|pair| 0.5 * (pair[0] + pair[1]) + BETWEEN <= apart)
                }
            }
        };
        let all = || ways.into_iter().map(|way| (way, labels(way))).filter(|(_, labels)| labels.len() == places.len());
        let found = all().find(|(_, labels)| fits(labels)).or_else(|| all().next());
        let (way, labels) = found.unwrap_or_default();
        Self { labelled: places.into_iter().zip(labels).collect(), note: note(way) }
    }

    /// A title that says what the labels are.
    pub(crate) fn titled(&self, title: &Label) -> Label {
        title.clone().and(Label::plain(&self.note))
    }
}

/// The most decimals of a tick label.
const MOST_DECIMALS: usize = 12;

fn power(largest: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "an exponent of a finite number")]
    let power = (1.000_001 * largest).log10().floor() as i32;
    power
}

/// A number in units of a power of ten.
fn scaled(value: f64, power: i32) -> f64 {
    if power < 0 { value * 10.0_f64.powi(-power) } else { value / 10.0_f64.powi(power) }
}

/// The decimals of multiples of `step` in units of a power of ten.
fn decimals_of(step: f64, power: i32) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not below 0")]
    let decimals = (f64::from(power) - (step * 1.000_001).log10().floor()).max(0.0) as usize;
    decimals
}

fn note((off, power): (f64, i32)) -> String {
    let common = match off {
        0.0 => String::new(),
        off => {
            // As many digits as differ from those of the numbers beside it, and no rounding.
            let digits = format!("{:.11e}", off.abs()).parse::<f64>().unwrap_or(off.abs());
            format!(" {} {digits}", if off > 0.0 { '\u{2212}' } else { '+' })
        }
    };
    let unit = if power == 0 { String::new() } else { format!(", in 1e{power}").replace('-', "\u{2212}") };
    common + &unit
}

pub(crate) fn tick_label(value: f64, decimals: usize) -> Label {
    let text = format!("{value:.decimals$}");
    let is_zero = text.bytes().all(|c| b"-0.".contains(&c));
    Label::plain(if is_zero { text.trim_start_matches('-') } else { &text }.replace('-', "\u{2212}"))
}

/// Round places in `range`, as near to `count` of them as round steps allow, and their distance.
pub(crate) fn ticks(range: [f64; 2], count: f64) -> (Vec<f64>, f64) {
    let count = count.max(3.0);
    let size = 10.0_f64.powf(((range[1] - range[0]) / count).log10().floor());
    let off = |f: &f64| ((range[1] - range[0]) / (f * size) - count).abs();
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(1.0);
    let step = factor * size;
    let mut out = Vec::new();
    // Far from zero, rounding moves the ends by more steps.
    let beside = |end: f64| 1e-9 + 4.0 * f64::EPSILON * (end / step).abs();
    let mut k = (range[0] / step - beside(range[0])).ceil();
    while k * step <= range[1] + beside(range[1]) * step && out.len() < 100 {
        out.push(k * step);
        k += 1.0;
    }
    (out, step)
}

/// Round values in a range of logarithms, at their logarithms: powers of ten, as many as have room; where they are few, twice and
/// five times them; where these are few, values at equal distances.
fn decades([low, high]: [f64; 2], count: f64) -> Vec<(f64, Label)> {
    if high - low < 0.9 {
        let (values, step) = ticks([low, high].map(|power| 10.0_f64.powf(power)), count);
        let largest = values.iter().copied().fold(step, f64::max);
        let decimals = decimals_of(step, power(largest));
        let label = |value: f64| match value {
            1e-3..1e5 => tick_label(value, decimals_of(step, 0)),
            value => Label::plain(format!("{value:.decimals$e}").replace('-', "\u{2212}")),
        };
        return values.into_iter().map(|value| (value.log10(), label(value))).collect();
    }
    let step = ((high - low) / (1.6 * count.max(3.0))).ceil().max(1.0);
    let factors: &[f64] = if high - low > 2.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let mut values: Vec<f64> = Vec::new();
    let mut power = (low / step).floor() * step;
    while power <= high && values.len() < 100 {
        values.extend(factors.iter().map(|factor| factor * 10.0_f64.powf(power)));
        power += step;
    }
    values.retain(|value| (low - 1e-9..=high + 1e-9).contains(&value.log10()));
    let plain = values.iter().all(|value| (0.999e-2..1.001e7).contains(value));
    let label = |value: &f64| {
        let text = if plain { short(*value) } else { format!("{value:.0e}") };
        (value.log10(), Label::plain(text.replace('-', "\u{2212}")))
    };
    values.iter().map(label).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        assert_eq!(ticks([0.0, 200.0], 5.0), (vec![0.0, 50.0, 100.0, 150.0, 200.0], 50.0));
        assert!((ticks([-0.12, 0.31], 4.0).1 - 0.1).abs() < 1e-12);
        assert_eq!(ticks([0.0, 1.0], 5.0).0.len(), 6);
    }

    /// Labels had up to 12 decimals, which ran over each other and off the page.
    #[test]
    fn labels_have_room_and_can_be_told_apart() {
        let row = Room::Below { width: 396.0 };
        for (range, room, first, note) in [
            ([0.0, 200.0], Room::Beside, "0", ""),
            ([-0.12, 0.31], Room::Beside, "\u{2212}0.1", ""),
            ([0.0, 4e-9], Room::Beside, "0", ", in 1e\u{2212}9"),
            ([-3e-13, 1e-13], row, "\u{2212}3", ", in 1e\u{2212}13"),
            ([0.0, 5e8], Room::Beside, "0", ", in 1e8"),
            ([245.001, 245.001_04], Room::Beside, "0", " \u{2212} 245.001, in 1e\u{2212}5"),
            ([-1000.01, -1000.0], Room::Beside, "\u{2212}0.010", " + 1000"),
            ([1e6, 1e6 + 4.0], Room::Beside, "0", " \u{2212} 1000000"),
        ] {
            let ticks = Ticks::even(range, 5.0, room);
            let texts: Vec<String> = ticks.labelled.iter().map(|(_, label)| label.to_string()).collect();
            assert_eq!((texts[0].as_str(), ticks.note.as_str()), (first, note), "{range:?}: {texts:?}");
            assert!(texts.windows(2).all(|pair| pair[0] != pair[1]), "{texts:?}");
            assert!(ticks.labelled.iter().all(|(_, label)| label.width(TICK_SIZE) <= WIDEST), "{texts:?}");
        }
    }

    #[test]
    fn ticks_of_logarithms_are_powers_of_ten_or_simple_shares() {
        let texts = |range, count| -> Vec<String> {
            decades(range, count).into_iter().map(|(_, label)| label.to_string()).collect()
        };
        assert_eq!(texts([1.0, 2.0], 3.0), ["10", "20", "50", "100"]);
        assert_eq!(texts([0.9, 4.1], 3.0), ["10", "100", "1000", "10000"]);
        assert_eq!(texts([-11.2, -2.8], 7.0)[0], "1e\u{2212}11");
        assert_eq!(texts([-12.0, 12.0], 3.0).len(), 5);
        let places: Vec<f64> = decades([0.0, 1.0], 3.0).into_iter().map(|(place, _)| place).collect();
        assert!((places[1] - 2.0_f64.log10()).abs() < 1e-12);
        assert_eq!(texts([150_f64.log10(), 430_f64.log10()], 3.0), ["200", "300", "400"]);
        assert_eq!(texts([1.5e-9_f64.log10(), 4.3e-9_f64.log10()], 3.0)[0], "2e\u{2212}9");
    }

    #[test]
    fn equal_axes_have_one_scale() {
        let axes = Axes::equal(0.0, 0.0, 300.0, [80.0, 200.0], [0.0, 200.0], [0.0, 10.0]);
        let (a, b) = (axes.at([0.0, 0.0]), axes.at([10.0, 10.0]));
        assert!(((b[0] - a[0]) - (a[1] - b[1])).abs() < 1e-9);
        assert_eq!(axes.frame.height(), 80.0);
    }

    #[test]
    fn lines_are_cut_at_the_frame() {
        let frame = Rect { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };
        let axes = Axes::new(frame, [0.0, 1.0], [0.0, 1.0]);
        let parts = axes.clipped(&[[0.0, 0.5], [0.5, 1.5], [1.0, 0.5]]);
        assert_eq!(parts.len(), 2);
        assert_eq!(parts[0].len(), 2);
        assert!((parts[0][1][1]).abs() < 1e-12);
    }
}
