//! What a figure shows, before it is SVG, PDF or PNG.

use crate::font::Label;
pub(crate) use crate::geometry::{Point, Segment};
use crate::palette::{Color, INK};
use crate::placement::Rect;

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) color: Color,
    /// Points.
    pub(crate) width: f64,
    /// Lengths of dash and gap, points.
    pub(crate) dash: Option<[f64; 2]>,
}

impl Stroke {
    pub(crate) const fn solid(color: Color, width: f64) -> Self {
        Self { color, width, dash: None }
    }

    pub(crate) const fn dashed(color: Color, width: f64, dash: [f64; 2]) -> Self {
        Self { color, width, dash: Some(dash) }
    }
}

/// Coloured cells, from the upper left line by line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Picture {
    /// Cells across.
    pub(crate) width: usize,
    /// Cells from top to bottom.
    pub(crate) height: usize,
    /// Red, green, blue and opacity (0 or 255) of each.
    pub(crate) rgba: Vec<u8>,
}

/// One thing drawn. Later ones cover earlier ones.
#[derive(Debug, Clone)]
pub(crate) struct Item {
    pub(crate) path: Vec<Segment>,
    pub(crate) fill: Option<Color>,
    pub(crate) stroke: Option<Stroke>,
    /// `None` for everything but text, whose glyphs are the path.
    pub(crate) text: Option<Text>,
    /// Cells that fill a rectangle of the page.
    pub(crate) picture: Option<(Rect, Picture)>,
}

/// Where a text's reference point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// A text, for readers and for those who write it as text.
#[derive(Debug, Clone)]
pub(crate) struct Text {
    /// Without its marks.
    pub(crate) says: String,
    pub(crate) label: Label,
    /// On the baseline.
    pub(crate) at: Point,
    pub(crate) anchor: Anchor,
    /// Points.
    pub(crate) size: f64,
    /// Whether it runs from bottom to top.
    pub(crate) upright: bool,
}

/// A figure: lines, areas and text on a white page.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Points.
    pub(crate) width: f64,
    /// Points.
    pub(crate) height: f64,
    /// For readers that cannot see it.
    pub(crate) title: String,
    pub(crate) items: Vec<Item>,
}

impl Scene {
    pub(crate) fn new(width: f64, height: f64, title: impl Into<String>) -> Self {
        Self { width, height, title: title.into(), items: Vec::new() }
    }

    /// Width and height of the page in points (1/72 inch).
    pub fn size(&self) -> [f64; 2] {
        [self.width, self.height]
    }

    /// The texts on the page, in the order in which they were drawn.
    pub fn texts(&self) -> impl Iterator<Item = &str> {
        self.items.iter().filter_map(|item| Some(item.text.as_ref()?.says.as_str()))
    }

    fn push(&mut self, path: Vec<Segment>, fill: Option<Color>, stroke: Option<Stroke>) {
        if path.len() > 1 {
            self.items.push(Item { path, fill, stroke, text: None, picture: None });
        }
    }

    /// An open line through `points`.
    pub(crate) fn line(&mut self, points: &[Point], stroke: Stroke) {
        self.push(path(points), None, Some(stroke));
    }

    /// A closed area.
    pub(crate) fn area(&mut self, points: &[Point], fill: Option<Color>, stroke: Option<Stroke>) {
        let mut path = path(points);
        path.push(Segment::Close);
        self.push(path, fill, stroke);
    }

    /// A line from `from` to `to` with a head at `to`.
    pub(crate) fn arrow(&mut self, from: Point, to: Point, color: Color, width: f64) {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy);
        if length <= 0.0 {
            return;
        }
        let (ux, uy) = (dx / length, dy / length);
        let head = (3.0 + 2.0 * width).min(length);
        let half = 0.42 * head;
        let neck = [to[0] - head * ux, to[1] - head * uy];
        self.line(&[from, [neck[0] + 0.3 * head * ux, neck[1] + 0.3 * head * uy]], Stroke::solid(color, width));
        let wings = [[neck[0] - half * uy, neck[1] + half * ux], to, [neck[0] + half * uy, neck[1] - half * ux]];
        self.area(&wings, Some(color), None);
    }

    /// A dot of `radius` points.
    pub(crate) fn dot(&mut self, at: Point, radius: f64, fill: Color) {
        self.area(&circle(at, radius), Some(fill), None);
    }

    /// A circle of `radius` points.
    pub(crate) fn ring(&mut self, at: Point, radius: f64, stroke: Stroke) {
        self.area(&circle(at, radius), None, Some(stroke));
    }

    /// Cells that fill `place`.
    pub(crate) fn picture(&mut self, place: Rect, picture: Picture) {
        let picture = Some((place, picture));
        self.items.push(Item { path: Vec::new(), fill: None, stroke: None, text: None, picture });
    }

    /// Text whose baseline starts, is centred or ends at `at`.
    pub(crate) fn text(&mut self, label: &Label, at: Point, anchor: Anchor, size: f64) {
        self.text_in(label, at, anchor, size, INK, false);
    }

    /// [`Scene::text`] in a colour; `upright` text runs from bottom to top.
    pub(crate) fn text_in(&mut self, label: &Label, at: Point, anchor: Anchor, size: f64, color: Color, upright: bool) {
        let back = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5 * label.width(size),
            Anchor::End => label.width(size),
        };
        let place = |[x, y]: Point| {
            let x = x - back;
            if upright { [at[0] + y, at[1] - x] } else { [at[0] + x, at[1] + y] }
        };
        let path = label.outline(size).into_iter().map(|segment| match segment {
            Segment::Move(p) => Segment::Move(place(p)),
            Segment::Line(p) => Segment::Line(place(p)),
            Segment::Quad(c, p) => Segment::Quad(place(c), place(p)),
            Segment::Close => Segment::Close,
        });
        let path = path.collect();
        let text = Some(Text { says: label.to_string(), label: label.clone(), at, anchor, size, upright });
        self.items.push(Item { path, fill: Some(color), stroke: None, text, picture: None });
    }
}

fn circle(at: Point, radius: f64) -> Vec<Point> {
    let corner = |k: u32| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 24.0).sin_cos();
        [at[0] + radius * cos, at[1] + radius * sin]
    };
    (0..24).map(corner).collect()
}

fn path(points: &[Point]) -> Vec<Segment> {
    points.iter().enumerate().map(|(i, p)| if i == 0 { Segment::Move(*p) } else { Segment::Line(*p) }).collect()
}
