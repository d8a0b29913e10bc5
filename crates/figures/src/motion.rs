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
use crate::scene::{Scene, Stroke};

const MAX_HEIGHT: f64 = 400.0;

/// The arm at one time of a motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MotionFrame {
    /// s.
    pub time: f64,
    /// The centreline from base to tip, m.
    pub centreline: Vec<[f64; 2]>,
    /// Kinetic energy, J.
    pub kinetic_energy: f64,
    /// Energy of strain, J.
    pub strain_energy: f64,
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
    let mm = |line: &[[f64; 2]]| -> Vec<[f64; 2]> { line.iter().map(|p| p.map(|v| 1e3 * v)).collect() };
    let last = frames.len().saturating_sub(1);
    let count = shapes.clamp(2, frames.len().max(2));
    let shown: Vec<&MotionFrame> = (0..count).filter_map(|k| frames.get(k * last / (count - 1))).collect();
    let trace: Vec<[f64; 2]> = frames.iter().filter_map(|frame| frame.centreline.last().copied()).collect();
    let all: Vec<[f64; 2]> = shown.iter().flat_map(|frame| mm(&frame.centreline)).chain(mm(&trace)).collect();

    let mut legend = Legend::new(page);
    for (index, frame) in [(0, shown.first()), (count - 1, shown.last())] {
        if let Some(frame) = frame {
            let words = format!("{} s", short(frame.time).replace('-', "\u{2212}"));
            legend.add(Sample::Line(Stroke::solid(ordered(index, count), 1.6)), Label::plain(words));
        }
    }
    legend.add(Sample::Line(trace_stroke()), Label::plain("tip trace"));
    let heading = page.heading(title, None);
    let top = heading.bottom + legend.height() + 6.0;
    let [x, y] = bounds(&all);
    let pad = 0.05 * (x[1] - x[0]).max(y[1] - y[0]).max(1e-9);
    let grown = |range: [f64; 2]| [range[0] - pad, range[1] + pad];
    let axes = Axes::equal(LEFT, top, page.across(), [150.0, MAX_HEIGHT], grown(x), grown(y));
    let says = format!("{}: shapes at equal times", page.title_or(title));
    let mut scene = Scene::new(page.width(), axes.frame.bottom + BELOW + MARGIN, says);
    heading.draw(&mut scene);
    legend.draw(&mut scene, heading.bottom);
    axes.draw(&mut scene, &Label::math("$x$ (mm)"), &Label::math("$y$ (mm)"));
    for (index, frame) in shown.iter().enumerate() {
        let width = if index + 1 == count { 1.8 } else { 1.1 };
        curve(&mut scene, &axes.all(&mm(&frame.centreline)), Stroke::solid(ordered(index, count), width));
    }
    scene.line(&axes.all(&mm(&trace)), trace_stroke());
    scene
}

fn trace_stroke() -> Stroke {
    Stroke::dashed(GREY.towards(INK, 0.4), 0.8, [1.5, 1.5])
}

/// A smooth line through points of the page.
fn curve(scene: &mut Scene, points: &[crate::scene::Point], stroke: Stroke) {
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
pub fn motion_figure(frames: &[MotionFrame], title: &str, page: &Page) -> Scene {
    let over = |of: &dyn Fn(&MotionFrame) -> f64| -> Vec<[f64; 2]> {
        frames.iter().map(|frame| [frame.time, of(frame)]).collect()
    };
    let tip = |axis: usize| over(&|frame| frame.centreline.last().map_or(f64::NAN, |p| 1e3 * p[axis]));
    let measure = |title: &str| Measure { title: title.to_owned(), scale: Scale::Even };
    let panels = [
        Panel { up: measure("tip (mm)"), lines: vec![tip(0), tip(1)] },
        Panel {
            up: measure("energy (mJ)"),
            lines: vec![
                Vec::new(),
                Vec::new(),
                over(&|frame| 1e3 * frame.kinetic_energy),
                over(&|frame| 1e3 * frame.strain_energy),
            ],
        },
    ];
    let names = ["x of the tip", "y of the tip", "kinetic energy", "energy of strain"];
    lines_figure(title, &measure("time (s)"), &names, &panels, page)
}
