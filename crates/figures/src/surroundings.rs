//! Stream and gravity, as arrows in a free corner of the frame.

use hydrostat::{Arm, Parameter};

use crate::axes::TEXT_SIZE;
use crate::font::{CAP_HEIGHT, Label};
use crate::numbers::short;
use crate::palette::{Color, GREY, WATER};
use crate::placement::{Occupied, Rect};
use crate::scene::{Anchor, Point, Scene, Stroke};
use crate::view::{View, dot};

/// Length of an arrow and side of the square that it turns in, points.
const ARROW: f64 = 22.0;
const SQUARE: f64 = 24.0;
/// Below this fraction of its length an arrow is drawn as seen from its end.
pub(crate) const SHORTEST: f64 = 0.25;
/// From the square to the label, and from that to the next square.
const GAPS: [f64; 2] = [3.0, 10.0];
/// From the frame.
const INSET: f64 = 6.0;

/// A direction that holds all over the figure.
#[derive(Debug, Clone)]
struct Direction {
    /// To the right and up on the page: of length one, shorter where it leaves the page.
    along: [f64; 2],
    /// Whether it comes out of the page.
    out: bool,
    color: Color,
    label: Label,
}

/// What acts on an arm from everywhere.
#[derive(Debug, Clone, Default)]
pub(crate) struct Surroundings {
    directions: Vec<Direction>,
}

impl Surroundings {
    /// Of the stream and of gravity of `arm`; `varied` is what differs from shape to shape.
    pub(crate) fn of(arm: &Arm, varied: Option<Parameter>) -> Self {
        let mut directions = Vec::new();
        let flows = arm.flow.speed > 0.0 || varied == Some(Parameter::FlowSpeed);
        if flows && arm.flow.density > 0.0 && varied != Some(Parameter::FlowDirection) {
            let speed = format!("stream {} m/s", short(arm.flow.speed));
            let text = if varied == Some(Parameter::FlowSpeed) { "stream".to_owned() } else { speed };
            directions.push(Direction::in_plane(arm.flow.direction, WATER, Label::plain(text)));
        }
        let pulls = |acceleration: f64| acceleration > 0.0 || varied == Some(Parameter::GravityAcceleration);
        if let Some(gravity) = &arm.gravity
            && pulls(gravity.acceleration)
            && varied != Some(Parameter::GravityDirection)
        {
            directions.push(Direction::in_plane(gravity.direction, GREY, Label::plain("gravity")));
        }
        Self { directions }
    }

    /// Of an arm in space, as `view` shows directions; `varied` is what differs from shape to shape.
    pub(crate) fn seen(arm: &Arm, view: &View, varied: Option<Parameter>) -> Self {
        let mut directions = Vec::new();
        let mut add = |vector: [f64; 3], color: Color, label: String| {
            let length = dot(&vector, &vector).sqrt();
            if length > 0.0 {
                let [right, up, back] = view.turned(&vector.map(|v| v / length));
                directions.push(Direction { along: [right, up], out: back > 0.0, color, label: Label::plain(label) });
            }
        };
        let turns = |direction: Parameter, part: fn(usize) -> Parameter| {
            varied == Some(direction) || (0..3).any(|axis| varied == Some(part(axis)))
        };
        if arm.flow.density > 0.0 && !turns(Parameter::FlowDirection, Parameter::StreamAlong) {
            let speed = format!("stream {} m/s", short(arm.flow.speed));
            let text = if varied == Some(Parameter::FlowSpeed) { "stream".to_owned() } else { speed };
            add(arm.stream_in_space(), WATER, text);
        }
        if !turns(Parameter::GravityDirection, Parameter::GravityAlong) {
            add(arm.gravity_in_space(), GREY, "gravity".to_owned());
        }
        Self { directions }
    }

    /// What all of `arms` share.
    pub(crate) fn shared<'a>(mut arms: impl Iterator<Item = &'a Arm>) -> Self {
        let Some(first) = arms.next() else { return Self::default() };
        let mut own = Self::of(first, None);
        for arm in arms {
            let other = Self::of(arm, None);
            let same = |a: &Direction, b: &Direction| a.along == b.along && a.label.to_string() == b.label.to_string();
            own.directions.retain(|a| other.directions.iter().any(|b| same(a, b)));
        }
        own
    }

    /// Draws the arrows where `page` is free inside `frame`, and keeps labels off them.
    pub(crate) fn draw(&self, scene: &mut Scene, page: &mut Occupied, frame: Rect) {
        if self.directions.is_empty() {
            return;
        }
        let widths: Vec<f64> = self.directions.iter().map(|d| SQUARE + GAPS[0] + d.label.width(TEXT_SIZE)).collect();
        let widest = widths.iter().copied().fold(0.0, f64::max);
        let count = widths.len() as f64;
        let row: f64 = widths.iter().sum::<f64>() + GAPS[1] * (count - 1.0);
        let inside = frame.grown(-INSET);
        let sizes = [[row, SQUARE], [widest, count * SQUARE]];
        let Some((rect, in_row)) = free(page, inside, sizes) else { return };
        let (mut x, mut y) = (rect.left, rect.top);
        for (direction, width) in self.directions.iter().zip(widths) {
            direction.draw(scene, [x + 0.5 * SQUARE, y + 0.5 * SQUARE]);
            if in_row { x += width + GAPS[1] } else { y += SQUARE }
        }
        page.add_box(rect);
    }
}

impl Direction {
    /// `angle` from e1, rad.
    fn in_plane(angle: f64, color: Color, label: Label) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { along: [cos, sin], out: false, color, label }
    }

    fn draw(&self, scene: &mut Scene, [x, y]: [f64; 2]) {
        let [right, up] = self.along;
        if right.hypot(up) < SHORTEST {
            draw_along_sight(scene, [x, y], self.out, self.color);
        } else {
            let (dx, dy) = (0.5 * ARROW * right, -0.5 * ARROW * up);
            scene.arrow([x - dx, y - dy], [x + dx, y + dy], self.color, 1.3);
        }
        let at = [x + 0.5 * SQUARE + GAPS[0], y + 0.5 * CAP_HEIGHT * TEXT_SIZE];
        scene.text(&self.label, at, Anchor::Start, TEXT_SIZE);
    }
}

/// An arrow that comes out of the page (a dot in a circle) or goes into it (a cross in a circle).
pub(crate) fn draw_along_sight(scene: &mut Scene, [x, y]: Point, out: bool, color: Color) {
    const RADIUS: f64 = 4.0;
    let stroke = Stroke::solid(color, 0.9);
    scene.ring([x, y], RADIUS, stroke);
    if out {
        scene.dot([x, y], 1.3, color);
        return;
    }
    let a = RADIUS * std::f64::consts::FRAC_1_SQRT_2;
    scene.line(&[[x - a, y - a], [x + a, y + a]], stroke);
    scene.line(&[[x - a, y + a], [x + a, y - a]], stroke);
}

/// The first free place for a row or a column, corners before the edges between them; where nothing is free, the place that covers least.
fn free(page: &Occupied, inside: Rect, [row, column]: [[f64; 2]; 2]) -> Option<(Rect, bool)> {
    const PLACES: u32 = 6;
    let at = |[width, height]: [f64; 2], across: f64, down: f64| {
        let left = inside.left + across * (inside.width() - width);
        let top = inside.top + down * (inside.height() - height);
        Rect { left, top, right: left + width, bottom: top + height }
    };
    let corners = [[1.0, 0.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let along = (1..PLACES).map(|k| f64::from(k) / f64::from(PLACES));
    let edges = along.flat_map(|fraction| [[fraction, 0.0], [fraction, 1.0], [0.0, fraction], [1.0, fraction]]);
    let places = corners.into_iter().chain(edges);
    let fits = |size: [f64; 2]| size[0] <= inside.width() && size[1] <= inside.height();
    let all = places.flat_map(|[across, down]| {
        [(row, true), (column, false)]
            .into_iter()
            .filter(|(size, _)| fits(*size))
            .map(move |(size, in_row)| (at(size, across, down), in_row))
    });
    all.map(|(rect, in_row)| (page.conflicts(&rect.grown(3.0)), rect, in_row))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, rect, in_row)| (rect, in_row))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hydrostat::Gravity;

    #[test]
    fn what_does_not_act_has_no_arrow() {
        let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
        assert!(Surroundings::of(&arm, None).directions.is_empty(), "still water, no gravity");
        arm.flow.speed = 0.2;
        arm.gravity = Some(Gravity::default());
        assert_eq!(Surroundings::of(&arm, None).directions.len(), 2);
        assert_eq!(Surroundings::of(&arm, Some(Parameter::FlowDirection)).directions.len(), 1);
        let mut faster = arm.clone();
        faster.flow.speed = 0.3;
        let shared = Surroundings::shared([&arm, &faster].into_iter());
        assert_eq!(shared.directions.len(), 1, "gravity alone is the same");
    }

    #[test]
    fn arrows_keep_off_what_is_drawn() {
        let frame = Rect { left: 0.0, top: 0.0, right: 200.0, bottom: 100.0 };
        let mut page = Occupied::new(frame);
        page.add_line(&[[100.0, 10.0], [195.0, 10.0]]);
        let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
        arm.gravity = Some(Gravity::default());
        let mut scene = Scene::new(200.0, 100.0, "t");
        Surroundings::of(&arm, None).draw(&mut scene, &mut page, frame);
        assert_eq!(scene.texts().collect::<Vec<_>>(), ["gravity"]);
        assert!(
            !page.is_free(&Rect { left: 6.0, top: 6.0, right: 20.0, bottom: 20.0 }),
            "the upper left corner is taken"
        );
    }
}
