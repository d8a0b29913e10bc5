//! Axes: from data to the page, with ticks and titles.

use crate::font::{CAP_HEIGHT, Label};
use crate::palette::INK;
use crate::placement::Rect;
use crate::scene::{Anchor, Point, Scene, Stroke};

/// Size of tick labels and of all other text, points.
pub(crate) const TICK_SIZE: f64 = 7.5;
pub(crate) const TEXT_SIZE: f64 = 8.5;
const TICK: f64 = 3.0;
const FRAME: Stroke = Stroke::solid(INK, 0.6);

/// A rectangle of the page that shows an interval of x and one of y.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axes {
    pub(crate) frame: Rect,
    x: [f64; 2],
    y: [f64; 2],
}

impl Axes {
    /// Axes that fill `frame`.
    pub(crate) fn new(frame: Rect, x: [f64; 2], y: [f64; 2]) -> Self {
        Self { frame, x, y }
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
        Self { frame, x: grow(x, width), y: grow(y, height) }
    }

    /// Where a data point is on the page.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> Point {
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
        let f = self.frame;
        scene.area(&[[f.left, f.top], [f.right, f.top], [f.right, f.bottom], [f.left, f.bottom]], None, Some(FRAME));
        let (x_ticks, decimals) = ticks(self.x, f.width() / 55.0);
        let below = f.bottom + TICK + 2.0 + CAP_HEIGHT * TICK_SIZE;
        for tick in x_ticks {
            let [x, _] = self.at([tick, 0.0]);
            scene.line(&[[x, f.bottom], [x, f.bottom + TICK]], FRAME);
            scene.text(&tick_label(tick, decimals), [x, below], Anchor::Middle, TICK_SIZE);
        }
        scene.text(
            x_title,
            [0.5 * (f.left + f.right), below + 5.0 + CAP_HEIGHT * TEXT_SIZE],
            Anchor::Middle,
            TEXT_SIZE,
        );
        let (y_ticks, decimals) = ticks(self.y, f.height() / 38.0);
        let mut widest = 0.0_f64;
        for tick in y_ticks {
            let [_, y] = self.at([0.0, tick]);
            scene.line(&[[f.left, y], [f.left - TICK, y]], FRAME);
            let label = tick_label(tick, decimals);
            widest = widest.max(label.width(TICK_SIZE));
            scene.text(&label, [f.left - TICK - 2.5, y + 0.5 * CAP_HEIGHT * TICK_SIZE], Anchor::End, TICK_SIZE);
        }
        let beside = [f.left - TICK - 2.5 - widest - 6.0, 0.5 * (f.top + f.bottom)];
        scene.text_in(y_title, beside, Anchor::Middle, TEXT_SIZE, INK, true);
    }
}

/// Room that titles and tick labels need left of and below the frame, points.
pub(crate) const LEFT: f64 = 44.0;
pub(crate) const BELOW: f64 = 28.0;

pub(crate) fn tick_label(value: f64, decimals: usize) -> Label {
    let text = format!("{:.decimals$}", if value == 0.0 { 0.0 } else { value });
    Label::plain(text.replace('-', "\u{2212}"))
}

/// Round places in `range`, as near to `count` of them as round steps allow, and the decimals that
/// they need.
pub(crate) fn ticks(range: [f64; 2], count: f64) -> (Vec<f64>, usize) {
    let count = count.max(3.0);
    let size = 10.0_f64.powf(((range[1] - range[0]) / count).log10().floor());
    let off = |f: &f64| ((range[1] - range[0]) / (f * size) - count).abs();
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(1.0);
    let step = factor * size;
    let mut out = Vec::new();
    let mut k = (range[0] / step - 1e-9).ceil();
    while k * step <= range[1] + 1e-9 * step && out.len() < 100 {
        out.push(k * step);
        k += 1.0;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 12")]
    let decimals = (-(step * 1.000_001).log10().floor()).clamp(0.0, 12.0) as usize;
    (out, decimals)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        assert_eq!(ticks([0.0, 200.0], 5.0), (vec![0.0, 50.0, 100.0, 150.0, 200.0], 0));
        assert_eq!(ticks([-0.12, 0.31], 4.0).1, 1);
        assert_eq!(ticks([0.0, 1.0], 5.0).0.len(), 6);
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
