//! One arm in space: three views along the axes at one scale, and one in perspective.

use hydrostat::SpatialConfiguration;

use crate::arm_figure::{cable_legend, cable_strokes, place_label};
use crate::axes::{Axes, BELOW, TEXT_SIZE};
use crate::font::Label;
use crate::numbers::degrees;
use crate::page::{MARGIN, Page};
use crate::palette::{Color, GREY, INK, PAPER, series};
use crate::perspective::{Perspective, SHADOW, draw_scale};
use crate::placement::Occupied;
use crate::scene::{Anchor, Point, Scene, Stroke};
use crate::solid::{Paint, Solid};
use crate::surroundings::{SHORTEST, Surroundings, draw_along_sight};
use crate::three_views::ThreeViews;
use crate::view::{Vector, plus, unit};

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

    let nearby = Nearby::of(&solid);
    let views = ThreeViews::new(padded(solid.bounds()), page);
    let (axes, top) = nearby.perspective.beside(&views, top, nearby.places(), page);
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
struct Nearby<'a> {
    solid: &'a Solid,
    perspective: Perspective,
    /// Length of the directors at the tip, mm.
    arrow: f64,
}

impl<'a> Nearby<'a> {
    fn of(solid: &'a Solid) -> Self {
        let perspective = Perspective::of(solid.bounds());
        let arrow = 0.09 * perspective.size;
        Self { solid, perspective, arrow }
    }

    /// Ends of the arrows at the tip.
    fn arrow_end(&self, direction: &Vector) -> Vector {
        plus(&self.solid.tip().0, self.arrow, direction)
    }

    /// All that is seen beside the floor.
    fn places(&self) -> impl Iterator<Item = Vector> {
        self.solid.surface().chain(self.solid.tip().1.map(|d| self.arrow_end(&d)))
    }

    fn at(&self, axes: &Axes, p: &Vector) -> Point {
        self.perspective.at(axes, p)
    }

    fn draw(&self, scene: &mut Scene, axes: &Axes, configuration: &SpatialConfiguration, strokes: &[Stroke]) {
        let (solid, view) = (self.solid, &self.perspective.view);
        self.perspective.draw_floor(scene, axes);
        let fallen = |p: Vector| self.perspective.fallen(p);
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
        self.perspective.draw_triad(scene, axes, &mut taken);
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
        let nearness = |direction: &Vector| self.perspective.view.turned(direction)[2];
        order.sort_by(|x, y| nearness(&x.1).total_cmp(&nearness(&y.1)));
        for (name, direction, color) in order {
            let end = self.at(axes, &self.arrow_end(direction));
            let [right, up, out] = self.perspective.view.turned(direction);
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
        let [right, up, _] = self.perspective.view.turned(&self.solid.tip().1[0]);
        place_label(scene, page, &label, INK, from, up.atan2(right));
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
