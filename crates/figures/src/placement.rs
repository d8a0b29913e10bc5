//! Labels that cover nothing: each goes to the nearest free place.

use crate::geometry::Point;

/// A rectangle on the page, points; `y` down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rect {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) right: f64,
    pub(crate) bottom: f64,
}

impl Rect {
    pub(crate) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(crate) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    pub(crate) fn grown(self, by: f64) -> Self {
        Self { left: self.left - by, top: self.top - by, right: self.right + by, bottom: self.bottom + by }
    }

    fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    fn holds(&self, other: &Self) -> bool {
        self.left <= other.left && other.right <= self.right && self.top <= other.top && other.bottom <= self.bottom
    }

    /// The point of this rectangle nearest to `p`.
    pub(crate) fn nearest(&self, p: Point) -> Point {
        [p[0].clamp(self.left, self.right), p[1].clamp(self.top, self.bottom)]
    }

    /// Whether the line from `a` to `b` passes through (Liang and Barsky).
    pub(crate) fn meets(&self, a: Point, b: Point) -> bool {
        self.part_of(a, b).is_some()
    }

    /// The part of the line from `a` to `b` inside, as fractions of the line.
    pub(crate) fn part_of(&self, a: Point, b: Point) -> Option<(f64, f64)> {
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        let edges = [(0, self.left, self.right), (1, self.top, self.bottom)];
        for (axis, low, high) in edges {
            let d = b[axis] - a[axis];
            if d == 0.0 {
                if a[axis] < low || a[axis] > high {
                    return None;
                }
                continue;
            }
            let (t0, t1) = ((low - a[axis]) / d, (high - a[axis]) / d);
            from = from.max(t0.min(t1));
            to = to.min(t0.max(t1));
        }
        (from <= to).then_some((from, to))
    }
}

/// What is on the page already.
#[derive(Debug, Clone)]
pub(crate) struct Occupied {
    bounds: Rect,
    lines: Vec<[Point; 2]>,
    boxes: Vec<Rect>,
}

impl Occupied {
    /// Nothing yet; labels stay inside `bounds`.
    pub(crate) fn new(bounds: Rect) -> Self {
        Self { bounds, lines: Vec::new(), boxes: Vec::new() }
    }

    /// A line that no label may cover.
    pub(crate) fn add_line(&mut self, points: &[Point]) {
        self.lines.extend(points.windows(2).map(|w| [w[0], w[1]]));
    }

    /// A rectangle that no label may cover.
    pub(crate) fn add_box(&mut self, rect: Rect) {
        self.boxes.push(rect);
    }

    /// The free place for a label of `width` by `height` that is nearest to `anchor`, with a
    /// preference for the direction `towards` (rad, y up). It is taken from then on.
    pub(crate) fn place(&mut self, anchor: Point, width: f64, height: f64, towards: f64) -> Rect {
        const DIRECTIONS: usize = 48;
        const MARGIN: f64 = 3.5;
        let mut best: Option<(f64, Rect)> = None;
        for ring in 0..60 {
            let gap = 5.0 + 3.0 * f64::from(ring);
            // Later rings only cost more.
            if best.is_some_and(|(cost, _)| cost < gap) {
                break;
            }
            for k in 0..DIRECTIONS {
                let turn = std::f64::consts::TAU * k as f64 / DIRECTIONS as f64;
                let wish = gap + 8.0 * (1.0 - turn.cos());
                // Conflicts only add to what was wished for, and take time to count.
                if best.is_some_and(|(least, _)| least <= wish) {
                    continue;
                }
                let (sin, cos) = (towards + turn).sin_cos();
                // The label's centre, such that its border is `gap` away from the anchor.
                let reach = (0.5 * width * cos).hypot(0.5 * height * sin) + gap;
                let [cx, cy] = [anchor[0] + reach * cos, anchor[1] - reach * sin];
                let rect = Rect {
                    left: cx - 0.5 * width,
                    right: cx + 0.5 * width,
                    top: cy - 0.5 * height,
                    bottom: cy + 0.5 * height,
                };
                let crossed = self.crossed(anchor, rect.nearest(anchor));
                let cost = wish + crossed + 1e3 * self.conflicts(&rect.grown(MARGIN));
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, rect));
                }
            }
        }
        let rect = best.map_or(self.bounds, |(_, rect)| rect);
        self.boxes.push(rect);
        self.lines.push([anchor, rect.nearest(anchor)]);
        rect
    }

    /// What it costs to join a label to its anchor: a little for every line crossed, much for a label.
    fn crossed(&self, from: Point, to: Point) -> f64 {
        // What meets at the anchor itself is not crossed.
        let start = [from[0] + 0.15 * (to[0] - from[0]), from[1] + 0.15 * (to[1] - from[1])];
        let lines = self.lines.iter().filter(|[a, b]| cross(start, to, *a, *b)).count();
        let boxes = self.boxes.iter().filter(|area| area.grown(1.0).meets(start, to)).count();
        2.0 * lines as f64 + 100.0 * boxes as f64
    }

    /// Whether a label may go there.
    pub(crate) fn is_free(&self, rect: &Rect) -> bool {
        self.conflicts(rect) == 0.0
    }

    /// How much a rectangle would cover; 0 where it may go.
    pub(crate) fn conflicts(&self, rect: &Rect) -> f64 {
        let lines = self.lines.iter().filter(|[a, b]| rect.meets(*a, *b)).count();
        let boxes = self.boxes.iter().filter(|b| b.overlaps(rect)).count();
        lines as f64 + 10.0 * boxes as f64 + if self.bounds.holds(rect) { 0.0 } else { 100.0 }
    }
}

/// Whether two lines cross.
fn cross(a: Point, b: Point, c: Point, d: Point) -> bool {
    let side = |p: Point, q: Point, r: Point| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: Rect = Rect { left: 0.0, top: 0.0, right: 200.0, bottom: 200.0 };

    #[test]
    fn a_label_goes_where_it_is_wanted_if_that_is_free() {
        let mut page = Occupied::new(PAGE);
        let rect = page.place([100.0, 100.0], 20.0, 8.0, 0.0);
        assert!(rect.left > 100.0 && rect.left < 106.0, "{rect:?}");
    }

    #[test]
    fn a_label_avoids_lines_labels_and_the_edge() {
        let mut page = Occupied::new(PAGE);
        page.add_line(&[[102.0, 0.0], [102.0, 200.0]]);
        let first = page.place([100.0, 100.0], 20.0, 8.0, 0.0);
        assert!(!first.meets([102.0, 0.0], [102.0, 200.0]));
        let second = page.place([100.0, 100.0], 20.0, 8.0, 0.0);
        assert!(!second.overlaps(&first));
        let corner = page.place([199.0, 1.0], 20.0, 8.0, 0.0);
        assert!(PAGE.holds(&corner), "{corner:?}");
    }
}
