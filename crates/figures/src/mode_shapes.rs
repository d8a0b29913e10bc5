//! Shapes of small motions: one frame a mode.

use hydrostat::{Arm, Mode, ModeSection, ModeShape, ModeStation, Modes};

use crate::axes::{Axes, TEXT_SIZE};
use crate::font::{CAP_HEIGHT, Label};
use crate::legend::{Legend, Sample};
use crate::numbers::short;
use crate::outline::bounds;
use crate::page::{MARGIN, Page};
use crate::palette::{GREY, INK, PAPER, series};
use crate::scene::{Anchor, Point, Scene, Stroke};
use crate::view::{Vector, View, plus};

/// Modes that one figure shows.
const MOST: usize = 6;
const COLUMNS: usize = 2;
const GAP: f64 = 14.0;
/// Above a frame, for its title.
const ABOVE: f64 = 14.0;
const HEIGHT: f64 = 108.0;
/// How far the arm moves, over its length, and turns, rad: whichever is reached first.
const MOVED: f64 = 0.15;
const TURNED: f64 = 1.5;
/// Phases of one period.
const PHASES: usize = 12;
/// From the middle to the eye, and its distance over the length.
const EYE: Vector = [0.42, 0.50, 1.0];
const DISTANCE: f64 = 3.0;

/// The shapes of the first modes, up to six, each to scale: the equilibrium, grey; the arm at equal phases of one period,
/// pale, and at its largest displacement, in colour. What travels along the arm shows as an envelope without nodes. In
/// space the arm is seen in perspective, and a thin line along its surface, on the side of the director b, shows twist.
///
/// ```
/// use hydrostat_figures::{Page, mode_shapes_figure};
///
/// let mut rod = hydrostat::Arm::cone(1.0, 0.001, 0.001, 1e9, 0.5);
/// rod.flow.density = 0.0;
/// let figure = mode_shapes_figure(&rod, &rod.modes(3, 8)?, "a rod", &Page::default());
/// assert!(figure.texts().any(|text| text.starts_with("3: ")));
/// # Ok::<(), hydrostat::MotionError>(())
/// ```
pub fn mode_shapes_figure<T>(arm: &Arm, modes: &Modes<T>, title: &str, page: &Page) -> Scene {
    let in_space = arm.space.is_some();
    let mut legend = Legend::new(page);
    legend.add(Sample::Line(REST), Label::plain("equilibrium"));
    legend.add(Sample::Line(largest()), Label::plain("largest displacement"));
    legend.add(Sample::Line(pale()), Label::plain("phases of a period"));
    let heading = page.heading(title, None);
    let top = heading.bottom + legend.height() + 12.0;
    let count = modes.modes.len().min(MOST);
    let rows = count.div_ceil(COLUMNS);
    let width = (page.right() - MARGIN - GAP) / COLUMNS as f64;
    let says = format!("{}: shapes of small motions", page.title_or(title));
    let mut scene = Scene::new(page.width(), top + rows as f64 * (ABOVE + HEIGHT + GAP) - GAP + MARGIN, says);
    heading.draw(&mut scene);
    legend.draw(&mut scene, heading.bottom);
    for (k, (mode, shape)) in modes.modes.iter().zip(&modes.shapes).take(MOST).enumerate() {
        let left = MARGIN + (k % COLUMNS) as f64 * (width + GAP);
        let above = top + (k / COLUMNS) as f64 * (ABOVE + HEIGHT + GAP);
        let label = Label::plain(words(k + 1, mode));
        let baseline = above + CAP_HEIGHT * TEXT_SIZE;
        scene.text_in(&label, [left, baseline], Anchor::Start, TEXT_SIZE, INK, false);
        Moved::new(arm, &modes.sections, shape, in_space).draw(&mut scene, [left, above + ABOVE], width);
    }
    scene
}

const REST: Stroke = Stroke::solid(GREY, 0.8);

fn largest() -> Stroke {
    Stroke::solid(series(1), 1.8)
}

fn pale() -> Stroke {
    Stroke::solid(series(1).towards(PAPER, 0.65), 0.6)
}

fn words(number: usize, mode: &Mode) -> String {
    let minus = |text: String| text.replace('-', "\u{2212}");
    if mode.rate[1] == 0.0 {
        format!("{number}: rate {} 1/s", minus(short(mode.rate[0])))
    } else {
        format!("{number}: {} Hz, damping ratio {}", short(mode.frequency()), minus(short(mode.damping_ratio())))
    }
}

/// An arm that moves in a mode.
struct Moved<'a> {
    sections: &'a [ModeSection],
    shape: &'a ModeShape,
    /// What amplitudes are multiplied by.
    factor: f64,
    view: View,
    /// Radii, m, where a line along the surface is drawn.
    stripe: Option<Vec<f64>>,
}

impl<'a> Moved<'a> {
    fn new(arm: &Arm, sections: &'a [ModeSection], shape: &'a ModeShape, in_space: bool) -> Self {
        let size = |v: &[[f64; 2]; 3]| v.as_flattened().iter().map(|v| v * v).sum::<f64>().sqrt();
        let most = |of: &dyn Fn(&ModeStation) -> f64| shape.iter().map(of).fold(f64::MIN_POSITIVE, f64::max);
        let moves = MOVED * arm.length / most(&|at| size(&at.displacement));
        let factor =
            moves.min(TURNED / most(&|at| size(&at.turn)).max(f64::MIN_POSITIVE) * if in_space { 1.0 } else { 1e3 });
        let middle = [0, 1, 2].map(|k| {
            let range = sections
                .iter()
                .map(|at| at.place[k])
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
            0.5 * (range[0] + range[1])
        });
        let view = if in_space { View::perspective(EYE, middle, DISTANCE * arm.length) } else { View::E1_E2 };
        let radii = || sections.iter().map(|at| arm.radius.at(at.s, arm.length).value).collect();
        Self { sections, shape, factor, view, stripe: in_space.then(radii) }
    }

    /// The centreline at a phase of the period, and the line along the surface; nothing of `share` is the equilibrium.
    fn lines(&self, phase: f64, share: f64) -> Vec<Vec<[f64; 2]>> {
        let (sin, cos) = phase.sin_cos();
        let now = |v: &[[f64; 2]; 3]| v.map(|[re, im]| share * self.factor * (re * cos - im * sin));
        let places: Vec<Vector> = self
            .sections
            .iter()
            .zip(self.shape)
            .map(|(own, at)| plus(&own.place, 1.0, &now(&at.displacement)))
            .collect();
        let seen = |places: &[Vector]| places.iter().map(|p| self.view.place(p)).collect::<Vec<_>>();
        let mut out = vec![seen(&places)];
        if let Some(radii) = &self.stripe {
            let side = |((own, at), (place, radius)): ((&ModeSection, &ModeStation), (&Vector, &f64))| {
                plus(place, *radius, &turned(&own.directors[1], &now(&at.turn)))
            };
            let sides: Vec<Vector> =
                self.sections.iter().zip(self.shape).zip(places.iter().zip(radii)).map(side).collect();
            out.push(seen(&sides));
        }
        out
    }

    fn draw(&self, scene: &mut Scene, corner: Point, width: f64) {
        let phases: Vec<Vec<Vec<[f64; 2]>>> =
            (0..PHASES).map(|k| self.lines(std::f64::consts::TAU * k as f64 / PHASES as f64, 1.0)).collect();
        let rest = self.lines(0.0, 0.0);
        let all: Vec<[f64; 2]> = phases.iter().chain([&rest]).flatten().flatten().copied().collect();
        let [x, y] = bounds(&all);
        let pad = 0.04 * (x[1] - x[0]).max(y[1] - y[0]).max(1e-9);
        let grown = |[low, high]: [f64; 2]| [low - pad, high + pad];
        let axes = Axes::equal(corner[0], corner[1], width, [HEIGHT; 2], grown(x), grown(y));
        let mut line = |lines: &[Vec<[f64; 2]>], stroke: Stroke| {
            for (k, points) in lines.iter().enumerate() {
                let width = if k == 0 { stroke.width } else { 0.5 * stroke.width };
                scene.line(&axes.all(points), Stroke { width, ..stroke });
            }
        };
        for lines in &phases[1..] {
            line(lines, pale());
        }
        line(&rest, REST);
        line(&phases[0], largest());
    }
}

/// A director after a turn.
fn turned(d: &Vector, turn: &Vector) -> Vector {
    let angle = crate::view::dot(turn, turn).sqrt();
    if angle < 1e-12 {
        return *d;
    }
    let axis = turn.map(|v| v / angle);
    let (sin, cos) = angle.sin_cos();
    let along = crate::view::dot(&axis, d);
    let across = crate::view::cross(&axis, d);
    [0, 1, 2].map(|k| cos * d[k] + sin * across[k] + (1.0 - cos) * along * axis[k])
}
