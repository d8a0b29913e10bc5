//! The arm in motion: shapes at equal times from pale to dark with the tip trace, and what changes over time.

use crate::axes::{Axes, BELOW, LEFT, Scale};
use crate::chart::smooth;
use crate::font::Label;
use crate::legend::{Legend, Sample};
use crate::lines::{Measure, Panel, lines_figure};
use crate::numbers::short;
use crate::outline::bounds;
use crate::page::{MARGIN, Page};
use crate::palette::{GREY, INK, ordered};
use crate::perspective::{Perspective, SHADOW, draw_scale};
use crate::placement::Occupied;
use crate::scene::{Point, Scene, Stroke};
use crate::three_views::ThreeViews;

const MAX_HEIGHT: f64 = 400.0;

/// Shapes of a strobe figure.
const LEAST: usize = 2;
/// Room over the widest extent.
const PAD: f64 = 0.05;

/// The arm at one time of a motion, in the plane or in space.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionFrame<const D: usize = 2> {
    /// s.
    pub time: f64,
    /// The centreline from base to tip, m.
    pub centreline: Vec<[f64; D]>,
    /// Kinetic energy, J.
    pub kinetic_energy: f64,
    /// Energy of strain, J.
    pub strain_energy: f64,
}

impl<const D: usize> Default for MotionFrame<D> {
    fn default() -> Self {
        Self { time: 0.0, centreline: Vec::new(), kinetic_energy: 0.0, strain_energy: 0.0 }
    }
}

/// Shapes at equal times and the tip trace, mm.
struct Strobe<const D: usize> {
    shapes: Vec<Vec<[f64; D]>>,
    trace: Vec<[f64; D]>,
    legend: Legend,
}

impl<const D: usize> Strobe<D> {
    fn new(frames: &[MotionFrame<D>], shapes: usize, page: &Page) -> Self {
        let mm = |p: &[f64; D]| p.map(|v| 1e3 * v);
        let last = frames.len().saturating_sub(1);
        let count = shapes.clamp(LEAST, frames.len().max(LEAST));
        let shown: Vec<&MotionFrame<D>> = (0..count).filter_map(|k| frames.get(k * last / (count - 1))).collect();
        let mut legend = Legend::new(page);
        for (index, frame) in [(0, shown.first()), (count - 1, shown.last())] {
            if let Some(frame) = frame {
                let words = format!("{} s", short(frame.time).replace('-', "\u{2212}"));
                legend.add(Sample::Line(Stroke::solid(ordered(index, count), 1.6)), Label::plain(words));
            }
        }
        legend.add(Sample::Line(trace_stroke()), Label::plain("tip trace"));
        Self {
            shapes: shown.iter().map(|frame| frame.centreline.iter().map(mm).collect()).collect(),
            trace: frames.iter().filter_map(|frame| frame.centreline.last().map(mm)).collect(),
            legend,
        }
    }

    fn places(&self) -> impl Iterator<Item = [f64; D]> {
        self.shapes.iter().flatten().chain(&self.trace).copied()
    }

    /// Where `at` has places on the page.
    fn draw(&self, scene: &mut Scene, at: impl Fn([f64; D]) -> Point) {
        let line = |places: &[[f64; D]]| -> Vec<Point> { places.iter().map(|p| at(*p)).collect() };
        let count = self.shapes.len().max(LEAST);
        for (index, shape) in self.shapes.iter().enumerate() {
            let width = if index + 1 == count { 1.8 } else { 1.1 };
            curve(scene, &line(shape), Stroke::solid(ordered(index, count), width));
        }
        scene.line(&line(&self.trace), trace_stroke());
    }
}

/// About `shapes` centrelines at equal times, the first one pale and the last one dark, and the tip trace through all
/// frames.
///
/// ```
/// use hydrostat_figures::{MotionFrame, Page, strobe_figure};
///
/// let frame = |k: u32| {
///     let time = 0.1 * f64::from(k);
///     let (sin, cos) = time.sin_cos();
///     let centreline = (0..=4).map(|i| 0.05 * f64::from(i)).map(|s| [s * cos, s * sin]).collect();
///     MotionFrame { time, centreline, ..MotionFrame::default() }
/// };
/// let frames: Vec<MotionFrame> = (0..11).map(frame).collect();
/// let figure = strobe_figure(&frames, 6, "a rod that turns", &Page::default());
/// assert!(figure.texts().any(|text| text == "1 s"));
/// ```
pub fn strobe_figure(frames: &[MotionFrame], shapes: usize, title: &str, page: &Page) -> Scene {
    let strobe = Strobe::new(frames, shapes, page);
    let heading = page.heading(title, None);
    let top = heading.bottom + strobe.legend.height() + 6.0;
    let [x, y] = bounds(&strobe.places().collect::<Vec<_>>());
    let pad = PAD * (x[1] - x[0]).max(y[1] - y[0]).max(1e-9);
    let grown = |range: [f64; 2]| [range[0] - pad, range[1] + pad];
    let axes = Axes::equal(LEFT, top, page.across(), [150.0, MAX_HEIGHT], grown(x), grown(y));
    let says = format!("{}: shapes at equal times", page.title_or(title));
    let mut scene = Scene::new(page.width(), axes.frame.bottom + BELOW + MARGIN, says);
    heading.draw(&mut scene);
    strobe.legend.draw(&mut scene, heading.bottom);
    axes.draw(&mut scene, &Label::math("$x$ (mm)"), &Label::math("$y$ (mm)"));
    strobe.draw(&mut scene, |p| axes.at(p));
    scene
}

/// [`strobe_figure`] of an arm in space: from e3, against e2 and from e1 at one scale, and in perspective over a floor
/// with the shadow of the last shape.
///
/// ```
/// use hydrostat_figures::{MotionFrame, Page, spatial_strobe_figure};
///
/// let frame = |k: u32| {
///     let time = 0.1 * f64::from(k);
///     let (sin, cos) = time.sin_cos();
///     let centreline = (0..=4).map(|i| 0.05 * f64::from(i)).map(|s| [s * cos, s * sin, 0.2 * s * time]).collect();
///     MotionFrame { time, centreline, ..MotionFrame::default() }
/// };
/// let frames: Vec<MotionFrame<3>> = (0..11).map(frame).collect();
/// let figure = spatial_strobe_figure(&frames, 6, "a rod that turns", &Page::default());
/// assert!(figure.texts().any(|text| text == "z (mm)"));
/// ```
pub fn spatial_strobe_figure(frames: &[MotionFrame<3>], shapes: usize, title: &str, page: &Page) -> Scene {
    let strobe = Strobe::new(frames, shapes, page);
    let heading = page.heading(title, None);
    let views = ThreeViews::around(strobe.places(), PAD, page);
    let nearby = Perspective::of(views.bounds());
    let top = heading.bottom + strobe.legend.height() + 6.0;
    let (axes, top) = nearby.beside(&views, top, strobe.places(), page);
    let placed = views.placed(top);
    let says = format!("{}: shapes in space at equal times", page.title_or(title));
    let bottom = placed.bottom.max(axes.frame.bottom);
    let mut scene = Scene::new(page.width(), bottom + BELOW + MARGIN, says);
    heading.draw(&mut scene);
    strobe.legend.draw(&mut scene, heading.bottom);
    nearby.draw_floor(&mut scene, &axes);
    if let Some(last) = strobe.shapes.last() {
        let shadow: Vec<Point> = last.iter().map(|p| nearby.at(&axes, &nearby.fallen(*p))).collect();
        curve(&mut scene, &shadow, Stroke::solid(SHADOW, 3.0));
    }
    strobe.draw(&mut scene, |p| nearby.at(&axes, &p));
    let mut taken = Occupied::new(axes.frame);
    draw_scale(&mut scene, &axes, &mut taken);
    nearby.draw_triad(&mut scene, &axes, &mut taken);
    placed.draw(&mut scene);
    for (axes, view) in &placed.views {
        strobe.draw(&mut scene, |p| axes.at(view.place(&p)));
    }
    scene
}

fn trace_stroke() -> Stroke {
    Stroke::dashed(GREY.towards(INK, 0.4), 0.8, [1.5, 1.5])
}

/// A smooth line through points of the page.
fn curve(scene: &mut Scene, points: &[Point], stroke: Stroke) {
    let mut line = Vec::new();
    for part in smooth(points) {
        line.extend(part.into_iter().skip(usize::from(!line.is_empty())));
    }
    scene.line(&line, stroke);
}

/// Place of the tip and energies over time.
///
/// ```
/// use hydrostat_figures::{MotionFrame, Page, motion_figure};
///
/// let frame = |k: u32| MotionFrame {
///     time: 0.1 * f64::from(k),
///     centreline: vec![[0.0, 0.0], [0.2, 0.01 * f64::from(k)]],
///     ..MotionFrame::default()
/// };
/// let figure = motion_figure(&(0..11).map(frame).collect::<Vec<_>>(), "a rod", &Page::default());
/// assert!(figure.texts().any(|text| text == "time (s)"));
/// ```
pub fn motion_figure<const D: usize>(frames: &[MotionFrame<D>], title: &str, page: &Page) -> Scene {
    let over = |of: &dyn Fn(&MotionFrame<D>) -> f64| -> Vec<[f64; 2]> {
        frames.iter().map(|frame| [frame.time, of(frame)]).collect()
    };
    let tip = |axis: usize| over(&|frame| frame.centreline.last().map_or(f64::NAN, |p| 1e3 * p[axis]));
    let measure = |title: &str| Measure { title: title.to_owned(), scale: Scale::Even };
    let mut energies = vec![Vec::new(); D];
    energies.push(over(&|frame| 1e3 * frame.kinetic_energy));
    energies.push(over(&|frame| 1e3 * frame.strain_energy));
    let panels = [
        Panel { up: measure("tip (mm)"), lines: (0..D).map(tip).collect() },
        Panel { up: measure("energy (mJ)"), lines: energies },
    ];
    let tips = ["x of the tip", "y of the tip", "z of the tip"].into_iter().take(D);
    let names: Vec<&str> = tips.chain(["kinetic energy", "energy of strain"]).collect();
    lines_figure(title, &measure("time (s)"), &names, &panels, page)
}
