//! A view in perspective of what is in space, over a floor.

use crate::axes::{Axes, LEFT, TEXT_SIZE, TICK_SIZE, ticks};
use crate::font::{CAP_HEIGHT, Label};
use crate::numbers::short;
use crate::outline::bounds;
use crate::page::Page;
use crate::palette::{Color, GREY, INK};
use crate::placement::{Occupied, Rect};
use crate::scene::{Anchor, Point, Scene, Stroke};
use crate::surroundings::SHORTEST;
use crate::three_views::{Room, ThreeViews};
use crate::view::{Vector, View};

/// From the middle to the eye: from the right, from above and from e3.
const EYE: Vector = [0.42, 0.50, 1.0];
/// Distance of the eye over the size of what is seen.
const DISTANCE: f64 = 2.2;
/// Heights of a perspective that stands above the views, points.
const HEIGHTS: [f64; 2] = [120.0, 250.0];
/// Length of the arrows of e1, e2 and e3.
const TRIAD: f64 = 20.0;
/// The floor and the shadow on it.
const LATTICE: Stroke = Stroke::solid(Color { rgb: [222, 226, 230], opacity: 1.0 }, 0.4);
pub(crate) const SHADOW: Color = Color { rgb: [226, 229, 232], opacity: 1.0 };

/// What lies within a box, seen from nearby, with a floor below it; lengths are in mm.
pub(crate) struct Perspective {
    pub(crate) view: View,
    /// The diagonal of the box.
    pub(crate) size: f64,
    floor: Floor,
}

/// A lattice of lines in a plane normal to e2, mm.
struct Floor {
    y: f64,
    /// Places of the lines over x and over z.
    lines: [Vec<f64>; 2],
}

impl Perspective {
    /// Of what is within `bounds` (x, y and z).
    pub(crate) fn of(bounds: [[f64; 2]; 3]) -> Self {
        let size = bounds.iter().map(|[low, high]| (high - low).powi(2)).sum::<f64>().sqrt();
        let middle = bounds.map(|[low, high]| 0.5 * (low + high));
        let view = View::perspective(EYE, middle, DISTANCE * size);
        Self { view, size, floor: Floor::below(bounds) }
    }

    /// Axes at one scale that show all `places` and the floor, beside the three views where there is room, else above
    /// them, and the upper edge of the views.
    pub(crate) fn beside(
        &self,
        views: &ThreeViews,
        top: f64,
        places: impl Iterator<Item = Vector>,
        page: &Page,
    ) -> (Axes, f64) {
        match views.room(top, page) {
            Room::Beside(room) => (self.axes(places, [room.left, room.top], room.width(), [room.height(); 2]), top),
            Room::Above => {
                let axes = self.axes(places, [LEFT, top], page.across(), HEIGHTS);
                (axes, axes.frame.bottom + 12.0)
            }
        }
    }

    /// With room below for what is said of the picture.
    fn axes(&self, places: impl Iterator<Item = Vector>, [left, top]: Point, width: f64, heights: [f64; 2]) -> Axes {
        let places: Vec<[f64; 2]> = places.chain(self.floor.corners()).map(|p| self.view.place(&p)).collect();
        let [x, y] = bounds(&places);
        let pad = 0.04 * (x[1] - x[0]).max(y[1] - y[0]);
        let grown = |[low, high]: [f64; 2], below: f64| [low - pad - below, high + pad];
        // Labels of arrows to the right, and the scale in the corner, have sizes on the page.
        let per_point = (x[1] - x[0]) / width;
        Axes::equal(left, top, width, heights, grown(x, 0.0), grown(y, 8.0 * per_point))
    }

    pub(crate) fn at(&self, axes: &Axes, p: &Vector) -> Point {
        axes.at(self.view.place(p))
    }

    /// The place on the floor below one.
    pub(crate) fn fallen(&self, [x, _, z]: Vector) -> Vector {
        [x, self.floor.y, z]
    }

    pub(crate) fn draw_floor(&self, scene: &mut Scene, axes: &Axes) {
        for line in self.floor.each_line() {
            scene.line(&line.map(|p| self.at(axes, &p)), LATTICE);
        }
    }

    /// The directions of e1, e2 and e3, above the scale.
    pub(crate) fn draw_triad(&self, scene: &mut Scene, axes: &Axes, page: &mut Occupied) {
        const SIDE: f64 = 2.0 * TRIAD + 14.0;
        let frame = axes.frame;
        let from = [frame.left + 0.45 * SIDE, frame.bottom - 14.0 - 0.42 * SIDE];
        let axis = |k: usize| [0, 1, 2].map(|i| f64::from(u8::from(i == k)));
        for (name, k) in [("$e_1$", 0), ("$e_2$", 1), ("$e_3$", 2)] {
            let [right, up, _] = self.view.turned(&axis(k));
            let end = [from[0] + TRIAD * right, from[1] - TRIAD * up];
            scene.arrow(from, end, GREY, 0.8);
            let label = Label::math(name);
            let beyond = 7.0 / right.hypot(up).max(SHORTEST);
            let at = [end[0] + beyond * right, end[1] - beyond * up + 0.3 * TEXT_SIZE];
            scene.text_in(&label, at, Anchor::Middle, TICK_SIZE, GREY, false);
        }
        let left = frame.left;
        page.add_box(Rect { left, top: from[1] - 0.6 * SIDE, right: left + SIDE, bottom: frame.bottom - 10.0 });
    }
}

/// A length of the arm at the depth of its middle, in the lower left corner.
pub(crate) fn draw_scale(scene: &mut Scene, axes: &Axes, page: &mut Occupied) {
    let frame = axes.frame;
    let per_mm = axes.at([1.0, 0.0])[0] - axes.at([0.0, 0.0])[0];
    let wish = 0.18 * frame.width().min(300.0) / per_mm;
    let size = 10.0_f64.powf(wish.log10().floor());
    let length = [1.0, 2.0, 5.0, 10.0].map(|f| f * size).into_iter().filter(|l| *l <= 1.3 * wish).fold(size, f64::max);
    let y = frame.bottom - 5.0;
    let (left, right) = (frame.left + 2.0, frame.left + 2.0 + length * per_mm);
    scene.line(&[[left, y], [right, y]], Stroke::solid(INK, 1.2));
    for x in [left, right] {
        scene.line(&[[x, y - 2.5], [x, y + 2.5]], Stroke::solid(INK, 0.8));
    }
    let label = Label::plain(format!("{} mm at mid-depth", short(length)));
    let at = [right + 5.0, y + 0.5 * CAP_HEIGHT * TICK_SIZE];
    scene.text(&label, at, Anchor::Start, TICK_SIZE);
    page.add_box(Rect { left, top: y - 5.0, right: at[0] + label.width(TICK_SIZE), bottom: frame.bottom });
}

impl Floor {
    /// Under everything within `bounds` (x, y, z), as far as round numbers go.
    fn below([x, y, z]: [[f64; 2]; 3]) -> Self {
        let size = [x, y, z].iter().map(|[low, high]| high - low).fold(0.0, f64::max);
        let step = match ticks([0.0, size], 6.0).0.as_slice() {
            [first, second, ..] => second - first,
            _ => size.max(1.0),
        };
        let lines = |[low, high]: [f64; 2]| {
            let (from, to) = ((low / step).floor(), (high / step).ceil());
            let to = to.max(from + 1.0);
            let mut places = Vec::new();
            let mut k = from;
            while k <= to && places.len() < 100 {
                places.push(k * step);
                k += 1.0;
            }
            places
        };
        Self { y: y[0] - 0.06 * size, lines: [lines(x), lines(z)] }
    }

    fn ends(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|k| [self.lines[k].first(), self.lines[k].last()].map(|v| v.copied().unwrap_or_default()))
    }

    fn corners(&self) -> impl Iterator<Item = Vector> {
        let [x, z] = self.ends();
        let y = self.y;
        x.into_iter().flat_map(move |x| z.map(|z| [x, y, z]))
    }

    fn each_line(&self) -> impl Iterator<Item = [Vector; 2]> {
        let [x, z] = self.ends();
        let y = self.y;
        let along_z = self.lines[0].iter().map(move |x| z.map(|z| [*x, y, z]));
        along_z.chain(self.lines[1].iter().map(move |z| x.map(|x| [x, y, *z])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_floor_is_below_and_ends_at_round_numbers() {
        let floor = Floor::below([[-3.0, 198.0], [-20.0, 60.0], [-8.0, 8.0]]);
        assert!(floor.y < -20.0);
        assert_eq!(floor.ends(), [[-50.0, 200.0], [-50.0, 50.0]]);
        assert_eq!(floor.corners().count(), 4);
        assert!(floor.each_line().all(|[p, q]| p != q));
    }
}
