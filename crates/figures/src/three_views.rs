//! Three views along the axes at one scale: y over x, below it z over x, and beside that z over y.

use hydrostat::SpatialConfiguration;

use crate::axes::{Axes, LEFT};
use crate::font::Label;
use crate::page::Page;
use crate::placement::Rect;
use crate::scene::Scene;
use crate::view::{Vector, View};

/// The shortest side of a view, points.
const LEAST: f64 = 58.0;
/// Between the views that are one above the other.
const GAP: f64 = 14.0;
/// The most that both rows of views may take.
const MAX_HEIGHT: f64 = 400.0;
/// The least room that is worth a picture.
const ROOM: f64 = 140.0;

/// Sizes of the views, before it is known where on the page they stand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ThreeViews {
    bounds: [[f64; 2]; 3],
    /// Points of a unit.
    scale: f64,
    /// Along x and along y, points.
    widths: [f64; 2],
    /// Of the upper and of the lower row.
    heights: [f64; 2],
}

/// Where another picture has room beside three views.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Room {
    /// From the upper edge of the views.
    Beside(Rect),
    /// Only above them.
    Above,
}

/// Three views on the page.
#[derive(Debug, Clone)]
pub(crate) struct Placed {
    /// With how each sees.
    pub(crate) views: [(Axes, View); 3],
    /// The lower edge of the frames.
    pub(crate) bottom: f64,
}

impl ThreeViews {
    /// Of what lies within `bounds` (x, y and z).
    pub(crate) fn new(bounds: [[f64; 2]; 3], page: &Page) -> Self {
        let extents = bounds.map(|[low, high]| (high - low).max(f64::MIN_POSITIVE));
        let [x, y, z] = extents;
        let scale = fitting(page.across() - LEFT, x, y).min(fitting(MAX_HEIGHT - GAP, y, z));
        let long = |extent: f64| (scale * extent).max(LEAST);
        Self { bounds, scale, widths: [long(x), long(y)], heights: [long(y), long(z)] }
    }

    /// Of all these places, mm, with room around them: `pad` of the widest extent.
    pub(crate) fn around(places: impl Iterator<Item = Vector>, pad: f64, page: &Page) -> Self {
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for place in places {
            for (range, v) in ranges.iter_mut().zip(place) {
                *range = [range[0].min(v), range[1].max(v)];
            }
        }
        let room = pad * ranges.iter().map(|[low, high]| high - low).fold(1.0, f64::max);
        let grown = ranges.map(|[low, high]| if low <= high { [low - room, high + room] } else { [0.0, 1.0] });
        Self::new(grown, page)
    }

    /// What they show (x, y and z).
    pub(crate) fn bounds(&self) -> [[f64; 2]; 3] {
        self.bounds
    }

    /// The room beside the views when their upper edge is at `top`.
    pub(crate) fn room(&self, top: f64, page: &Page) -> Room {
        let [x, y] = self.widths;
        let corner = Rect { left: LEFT + x + GAP, top, right: page.right(), bottom: top + self.heights[0] };
        let beside = Rect { left: LEFT + x + LEFT + y + GAP, bottom: self.bottom(top), ..corner };
        [corner, beside]
            .into_iter()
            .find(|room| room.width() >= ROOM && room.height() >= ROOM)
            .map_or(Room::Above, Room::Beside)
    }

    fn bottom(&self, top: f64) -> f64 {
        top + self.heights[0] + GAP + self.heights[1]
    }

    /// The views with their upper edge at `top`.
    pub(crate) fn placed(&self, top: f64) -> Placed {
        let [first, second] = self.widths;
        let below = top + self.heights[0] + GAP;
        let range = |axis: usize, points: f64| {
            let [low, high] = self.bounds[axis];
            let more = 0.5 * (points / self.scale - (high - low));
            [low - more, high + more]
        };
        let frame = |left: f64, top: f64, width: f64, height: f64, [x, y]: [usize; 2]| {
            let frame = Rect { left, top, right: left + width, bottom: top + height };
            Axes::new(frame, range(x, width), range(y, height))
        };
        let beside = LEFT + first + LEFT;
        let views = [
            (frame(LEFT, top, first, self.heights[0], [0, 1]), View::E1_E2),
            (frame(LEFT, below, first, self.heights[1], [0, 2]), View::E1_E3),
            (frame(beside, below, second, self.heights[1], [1, 2]), View::E2_E3),
        ];
        Placed { views, bottom: self.bottom(top) }
    }
}

impl Placed {
    /// Frames, ticks and titles, mm.
    pub(crate) fn draw(&self, scene: &mut Scene) {
        let [x, y, z] = ["$x$ (mm)", "$y$ (mm)", "$z$ (mm)"].map(Label::math);
        let [(upper, _), (lower, _), (beside, _)] = &self.views;
        upper.draw_above_another(scene, &y);
        lower.draw(scene, &x, &z);
        beside.draw(scene, &y, &z);
    }
}

/// So many places of a centreline, mm.
pub(crate) fn centreline(shape: &SpatialConfiguration, count: usize) -> Vec<Vector> {
    let st = shape.resampled(count);
    (0..st.len()).map(|k| [st.x[k], st.y[k], st.z[k]].map(|v| 1e3 * v)).collect()
}

/// The largest scale at which `a` and `b`, none shorter than it may be, fit into `points`.
fn fitting(points: f64, a: f64, b: f64) -> f64 {
    let both = points / (a + b);
    if both * a.min(b) >= LEAST { both } else { (points - LEAST).max(LEAST) / a.max(b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_have_one_scale_and_fit_the_page() {
        let page = Page::default();
        for bounds in [
            [[0.0, 245.0], [-10.0, 10.0], [-10.0, 10.0]],
            [[-10.0, 10.0], [-10.0, 10.0], [0.0, 245.0]],
            [[-100.0, 100.0], [-90.0, 100.0], [0.0, 150.0]],
            [[-10.0, 10.0], [-200.0, 10.0], [-8.0, 8.0]],
        ] {
            let views = ThreeViews::new(bounds, &page);
            let placed = views.placed(50.0);
            for (axes, _) in &placed.views {
                let (a, b) = (axes.at([0.0, 0.0]), axes.at([10.0, 10.0]));
                assert!(((b[0] - a[0]) - (a[1] - b[1])).abs() < 1e-9);
                assert!((b[0] - a[0] - 10.0 * views.scale).abs() < 1e-9);
                assert!(axes.frame.right <= page.right() + 1e-9 && axes.frame.bottom <= placed.bottom + 1e-9);
            }
        }
    }

    #[test]
    fn a_picture_goes_where_there_is_room() {
        let page = Page::default();
        let room = |bounds| ThreeViews::new(bounds, &page).room(0.0, &page);
        assert_eq!(room([[0.0, 245.0], [-10.0, 10.0], [-10.0, 10.0]]), Room::Above);
        assert!(matches!(room([[0.0, 100.0]; 3]), Room::Beside(_)));
        assert!(matches!(room([[-10.0, 10.0], [-10.0, 10.0], [0.0, 245.0]]), Room::Beside(_)));
    }
}
