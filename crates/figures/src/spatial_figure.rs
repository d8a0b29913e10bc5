//! One arm in space: three views along the axes at one scale, and one in perspective.

use hydrostat::SpatialConfiguration;

use crate::arm_figure::{cable_legend, cable_strokes, place_label};
use crate::axes::{Axes, BELOW, LEFT, TEXT_SIZE, TICK_SIZE, ticks};
use crate::font::{CAP_HEIGHT, Label};
use crate::numbers::{degrees, short};
use crate::outline::bounds;
use crate::page::{MARGIN, Page};
use crate::palette::{Color, GREY, INK, PAPER, series};
use crate::placement::{Occupied, Rect};
use crate::scene::{Anchor, Point, Scene, Stroke};
use crate::solid::{Paint, Solid};
use crate::surroundings::{SHORTEST, Surroundings, draw_along_sight};
use crate::three_views::{Room, ThreeViews};
use crate::view::{Vector, View, plus, unit};

/// From the middle of the arm to the eye: from the right, from above and from e3.
const EYE: Vector = [0.42, 0.50, 1.0];
/// Distance of the eye over the size of the arm.
const DISTANCE: f64 = 2.2;
/// Heights of a perspective that stands above the views, points.
const HEIGHTS: [f64; 2] = [120.0, 250.0];
/// Length of the arrows of e1, e2 and e3.
const TRIAD: f64 = 20.0;
/// The floor and the shadow on it.
const LATTICE: Stroke = Stroke::solid(Color { rgb: [222, 226, 230], opacity: 1.0 }, 0.4);
const SHADOW: Color = Color { rgb: [226, 229, 232], opacity: 1.0 };

/// A configuration in space drawn to scale: seen from e3, against e2 and from e1 at one scale, and in perspective with
/// its shadow on a floor below, the directors and the tangent at the tip with alpha(L), the directions of e1, e2, e3, of
/// the stream and of gravity, and a scale. Cables are as wide as they are tight, pale on the far side of the section,
/// dashed when slack. `note` is written under the title: say there if this is not the answer that was asked for.
///
/// ```
/// use hydrostat::{Arm, Cable, Options, Profile, SpatialSolver};
/// use std::f64::consts::FRAC_PI_2;
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("side", Profile::linear(0.005, 0.001)).at_angle(FRAC_PI_2).pulled(0.2));
/// let shape = SpatialSolver::new(&arm, Options::default())?.solve()?;
/// let figure = hydrostat_figures::spatial_arm_figure(&shape, None, &hydrostat_figures::Page::default());
/// assert!(figure.texts().any(|text| text == "z (mm)"));
/// # Ok::<(), hydrostat::SpatialError>(())
/// ```
pub fn spatial_arm_figure(configuration: &SpatialConfiguration, note: Option<&str>, page: &Page) -> Scene {
    let arm = &configuration.arm;
    let solid = Solid::new(configuration);
    let strokes = cable_strokes(&configuration.cables);
    let heading = page.heading(&arm.name, note);
    let legend = cable_legend(&configuration.cables, &strokes, page);
    let top = heading.bottom + legend.height() + 6.0;

    let nearby = Perspective::of(&solid);
    let views = ThreeViews::new(padded(solid.bounds()), page);
    let (axes, top) = match views.room(top, page) {
        Room::Beside(room) => (nearby.axes([room.left, room.top], room.width(), [room.height(); 2]), top),
        Room::Above => {
            let axes = nearby.axes([LEFT, top], page.across(), HEIGHTS);
            (axes, axes.frame.bottom + 12.0)
        }
    };
    let placed = views.placed(top);

    let title = format!("{}: static shape in space", page.title_or(&arm.name));
    let mut scene = Scene::new(page.width(), placed.bottom.max(axes.frame.bottom) + BELOW + MARGIN, title);
    heading.draw(&mut scene);
    legend.draw(&mut scene, heading.bottom);
    nearby.draw(&mut scene, &axes, configuration, &strokes);
    placed.draw(&mut scene);
    for (axes, view) in &placed.views {
        solid.draw(&mut scene, axes, view, Paint::Flat, &strokes);
    }
    scene
}

/// A little room round the arm, the same on all sides.
fn padded(bounds: [[f64; 2]; 3]) -> [[f64; 2]; 3] {
    let pad = 0.05 * bounds.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
    bounds.map(|[low, high]| [low - pad, high + pad])
}

/// The arm from nearby, over a floor.
struct Perspective<'a> {
    solid: &'a Solid,
    view: View,
    floor: Floor,
    /// Length of the directors at the tip, mm.
    arrow: f64,
}

/// A lattice of lines in a plane normal to e2, mm.
struct Floor {
    y: f64,
    /// Places of the lines over x and over z.
    lines: [Vec<f64>; 2],
}

impl<'a> Perspective<'a> {
    fn of(solid: &'a Solid) -> Self {
        let bounds = solid.bounds();
        let size = bounds.iter().map(|[low, high]| (high - low).powi(2)).sum::<f64>().sqrt();
        let middle = bounds.map(|[low, high]| 0.5 * (low + high));
        let view = View::perspective(EYE, middle, DISTANCE * size);
        Self { solid, view, floor: Floor::below(bounds), arrow: 0.09 * size }
    }

    /// Ends of the arrows at the tip.
    fn arrow_end(&self, direction: &Vector) -> Vector {
        plus(&self.solid.tip().0, self.arrow, direction)
    }

    /// Axes at one scale that show everything, with room below for what is said of the picture.
    fn axes(&self, [left, top]: Point, width: f64, heights: [f64; 2]) -> Axes {
        let ends = self.solid.tip().1.map(|d| self.arrow_end(&d));
        let all = self.solid.surface().chain(self.floor.corners()).chain(ends);
        let places: Vec<[f64; 2]> = all.map(|p| self.view.place(&p)).collect();
        let [x, y] = bounds(&places);
        let pad = 0.04 * (x[1] - x[0]).max(y[1] - y[0]);
        let grown = |[low, high]: [f64; 2], below: f64| [low - pad - below, high + pad];
        // Labels of arrows to the right, and the scale in the corner, have sizes on the page.
        let per_point = (x[1] - x[0]) / width;
        Axes::equal(left, top, width, heights, grown(x, 0.0), grown(y, 8.0 * per_point))
    }

    fn at(&self, axes: &Axes, p: &Vector) -> Point {
        axes.at(self.view.place(p))
    }

    fn draw(&self, scene: &mut Scene, axes: &Axes, configuration: &SpatialConfiguration, strokes: &[Stroke]) {
        let (solid, view) = (self.solid, &self.view);
        for line in self.floor.each_line() {
            scene.line(&line.map(|p| self.at(axes, &p)), LATTICE);
        }
        let fallen = |[x, _, z]: Vector| [x, self.floor.y, z];
        for part in solid.parts(|p| self.at(axes, &fallen(p))) {
            scene.area(&part, Some(SHADOW), Some(Stroke::solid(SHADOW, 0.3)));
        }
        let tip = solid.tip().0;
        let drop = [tip, fallen(tip)].map(|p| self.at(axes, &p));
        scene.line(&drop, Stroke::dashed(GREY.towards(PAPER, 0.3), 0.5, [2.0, 2.0]));
        solid.draw(scene, axes, view, Paint::Lit, strokes);

        let mut taken = Occupied::new(axes.frame);
        solid.occupy(&mut taken, axes, view);
        taken.add_line(&drop);
        draw_scale(scene, axes, &mut taken);
        self.draw_triad(scene, axes, &mut taken);
        let arrows = tip_arrows(configuration);
        let from = self.at(axes, &tip);
        for (_, direction, _) in &arrows {
            taken.add_line(&[from, self.at(axes, &self.arrow_end(direction))]);
        }
        Surroundings::seen(&configuration.arm, view, None).draw(scene, &mut taken, axes.frame);
        self.draw_tip(scene, axes, &mut taken, &arrows, configuration.tip().alpha);
    }

    fn draw_tip(
        &self,
        scene: &mut Scene,
        axes: &Axes,
        page: &mut Occupied,
        arrows: &[(&'static str, Vector, Color)],
        alpha: f64,
    ) {
        let from = self.at(axes, &self.solid.tip().0);
        // What points away is behind what comes nearer.
        let mut order: Vec<_> = arrows.iter().collect();
        let nearness = |direction: &Vector| self.view.turned(direction)[2];
        order.sort_by(|x, y| nearness(&x.1).total_cmp(&nearness(&y.1)));
        for (name, direction, color) in order {
            let end = self.at(axes, &self.arrow_end(direction));
            let [right, up, out] = self.view.turned(direction);
            if right.hypot(up) < SHORTEST {
                draw_along_sight(scene, from, out > 0.0, *color);
            } else {
                scene.arrow(from, end, *color, 0.9);
            }
            let label = Label::math(name);
            let towards = (from[1] - end[1]).atan2(end[0] - from[0]);
            let rect = page.place(end, label.width(TEXT_SIZE), 0.55 * TEXT_SIZE, towards);
            scene.text_in(&label, [rect.left, rect.bottom], Anchor::Start, TEXT_SIZE, *color, false);
        }
        let label = Label::math(&format!("$α$($L$) = {}", degrees(alpha)));
        let [right, up, _] = self.view.turned(&self.solid.tip().1[0]);
        place_label(scene, page, &label, INK, from, up.atan2(right));
    }

    /// The directions of e1, e2 and e3, above the scale.
    fn draw_triad(&self, scene: &mut Scene, axes: &Axes, page: &mut Occupied) {
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

/// Names, directions and colours of the directors at the tip, and of the tangent where it is not a.
fn tip_arrows(configuration: &SpatialConfiguration) -> Vec<(&'static str, Vector, Color)> {
    let tip = configuration.tip();
    let mut arrows = vec![("$a$", tip.a, INK), ("$b$", tip.b, INK), ("$c$", tip.c, INK)];
    if tip.alpha > 0.02 {
        let st = configuration.at(configuration.arm.length);
        let along = plus(&plus(&st.a.map(|v| st.nu * v), st.eta, &st.b), st.zeta, &st.c);
        arrows.push(("$t$", unit(&along), series(2)));
    }
    arrows
}

/// A length of the arm at the depth of its middle, in the lower left corner.
fn draw_scale(scene: &mut Scene, axes: &Axes, page: &mut Occupied) {
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
