//! Drawings of Fig. 1a, 1b and 1c.

use hydrostat::{Configuration, Parameter};

use super::shapes::Study;
use super::solves::{SPEED, TIP_ANGLE, speed, tension};
use crate::axes::{Axes, BELOW, LEFT, TEXT_SIZE};
use crate::font::{CAP_HEIGHT, Label};
use crate::legend::{Legend, Sample};
use crate::numbers::{degrees, short};
use crate::outline::{Outline, Style, bounds};
use crate::page::{MARGIN, Page};
use crate::palette::{Color, GREY, INK, ordered, series};
use crate::placement::{Occupied, Rect};
use crate::scene::{Anchor, Scene, Stroke};
use crate::surroundings::Surroundings;
use crate::tip_labels::{TipLabel, draw_tip_labels};

const LINE: f64 = 13.0;
/// Baseline of the heading, and where what is below it begins.
const HEADING: [f64; 2] = [MARGIN + CAP_HEIGHT * 9.5, MARGIN + LINE];
/// In the key of Fig. 1c: room for a tension, and for each speed.
const COLUMNS: [f64; 2] = [68.0, 76.0];

/// Said on every part: the numbers are not the source's.
fn note(study: &Study) -> String {
    let arm = study.raised.first().map_or("", |c| c.arm.name.as_str());
    format!("Arm {arm}, parameters found by trial; published are only the stream of {SPEED} m/s and {TIP_ANGLE}°.")
}

/// Fig. 1a: tension raised in one stream.
pub(super) fn raised(study: &Study, page: &Page) -> Scene {
    let heading = Label::math(&format!("Tension $T_1$ raised in a stream of {SPEED} m/s"));
    let count = study.raised.len();
    let shapes: Vec<_> = study
        .raised
        .iter()
        .enumerate()
        .map(|(i, c)| {
            let value = if tension(c) == 0.0 { "0".to_owned() } else { short(tension(c)) };
            let label = Label::math(&format!("{value} N: $α$($L$) = {}", degrees(c.tip().alpha)));
            Member { configuration: c, color: ordered(i, count), label }
        })
        .collect();
    arms(["Fig. 1a", &note(study)], &heading, &shapes, None, page)
}

/// Fig. 1b: one tension in ever faster streams.
pub(super) fn faster(study: &Study, page: &Page) -> Scene {
    let value = study.faster.first().map_or(0.0, tension);
    let heading = Label::math(&format!("Streams of several speeds, tension $T_1$ = {} N", short(value)));
    let shapes: Vec<_> = study
        .faster
        .iter()
        .enumerate()
        .map(|(i, c)| {
            // Three decimals: with two, the tips would seem to turn alike.
            let angle = c.tip().alpha.to_degrees();
            let label = Label::math(&format!("{} m/s: $α$($L$) = {angle:.3}°", speed(c)));
            Member { configuration: c, color: speed_color(i), label }
        })
        .collect();
    arms(["Fig. 1b", &note(study)], &heading, &shapes, Some(Parameter::FlowSpeed), page)
}

/// The colour of the speed `index`; 0.5 m/s is the blue one, as in the source.
fn speed_color(index: usize) -> Color {
    [INK, series(1), series(0), series(2)][index % 4]
}

/// One arm among several.
struct Member<'a> {
    configuration: &'a Configuration,
    color: Color,
    label: Label,
}

/// Several arms on equal axes, each with a label at its tip; `varied` is what differs from one to the other of what acts on all of the arm.
fn arms(
    [part, note]: [&str; 2],
    heading: &Label,
    shapes: &[Member<'_>],
    varied: Option<Parameter>,
    page: &Page,
) -> Scene {
    let outlines: Vec<Outline> = shapes.iter().map(|m| Outline::new(m.configuration, 26)).collect();
    let all: Vec<[f64; 2]> = outlines.iter().flat_map(|o| o.surface.iter().copied()).collect();
    let [x, y] = bounds(&all);
    let pad = 0.05 * (x[1] - x[0]).max(y[1] - y[0]);
    let key = cable_key(shapes, page);
    let top = HEADING[1] + key.height() + 6.0;
    let room = [[x[0] - pad, x[1] + 3.0 * pad], [y[0] - pad, y[1] + 3.5 * pad]];
    let axes = Axes::equal(LEFT, top, page.across(), [150.0, 400.0], room[0], room[1]);
    let height = axes.frame.bottom + BELOW + LINE + MARGIN;
    let mut scene = Scene::new(page.width(), height, format!("{part}: {heading}"));
    header(&mut scene, part, heading, page);
    key.draw(&mut scene, HEADING[1]);
    footer(&mut scene, note, page);
    axes.draw(&mut scene, &Label::math("$x$ (mm)"), &Label::math("$y$ (mm)"));
    let mut taken = Occupied::new(axes.frame.grown(-3.0));
    for (outline, Member { configuration, color, .. }) in outlines.iter().zip(shapes) {
        let style = Style {
            fill: color.with_opacity(0.07),
            surface: Stroke::solid(*color, 0.9),
            sections: Stroke::solid(color.with_opacity(0.45), 0.35),
            centreline: Stroke::solid(color.with_opacity(0.0), 0.1),
            cables: configuration
                .cables
                .iter()
                .enumerate()
                .map(|(i, _)| if i == 0 { Stroke::solid(*color, 0.6) } else { Stroke::dashed(*color, 0.5, CABLE_DASH) })
                .collect(),
        };
        outline.draw(&mut scene, &axes, &style);
        outline.occupy(&mut taken, &axes);
    }
    let labels: Vec<TipLabel> = outlines
        .iter()
        .zip(shapes)
        .map(|(outline, Member { configuration, color, label })| TipLabel {
            tip: axes.at(outline.tip()),
            towards: configuration.tip().theta,
            color: *color,
            label: label.clone(),
        })
        .collect();
    // Labels want the upper right corner; what holds for all shapes takes what is left.
    draw_tip_labels(&mut scene, &mut taken, axes.frame, &labels);
    if let Some(first) = shapes.first() {
        Surroundings::of(&first.configuration.arm, varied).draw(&mut scene, &mut taken, axes.frame);
    }
    scene
}

const CABLE_DASH: [f64; 2] = [2.5, 1.8];

fn header(scene: &mut Scene, part: &str, heading: &Label, page: &Page) {
    let label = Label::plain(format!("{part}   ")).and(heading.clone());
    scene.text(&label, [LEFT, HEADING[0]], Anchor::Start, page.fitting(&label, 9.5));
}

fn footer(scene: &mut Scene, note: &str, page: &Page) {
    let at = [LEFT, scene.height - MARGIN];
    let note = Label::plain(note);
    scene.text_in(&note, at, Anchor::Start, page.fitting(&note, 7.0), GREY, false);
}

/// What lines mean that are drawn of some shape.
fn cable_key(shapes: &[Member<'_>], page: &Page) -> Legend {
    let mut key = Legend::new(page);
    let cables = shapes.iter().map(|shape| shape.configuration.cables.len()).max().unwrap_or(0);
    if cables > 0 {
        key.add(Sample::Line(Stroke::solid(INK, 0.6)), Label::plain("pulled cable"));
    }
    if cables > 1 {
        key.add(Sample::Line(Stroke::dashed(INK, 0.5, CABLE_DASH)), Label::plain("slack cable"));
    }
    key.add(Sample::Line(Stroke::solid(INK.with_opacity(0.45), 0.35)), Label::plain("section"));
    key
}

/// Fig. 1c: alpha(s), whole on the left, enlarged where the speeds part on the right.
pub(super) fn angles(study: &Study, page: &Page) -> Scene {
    let rows = study.rows();
    let (per_line, lines) = key_lines(&rows, page);
    let top = MARGIN + (1.0 + (lines * rows.len()) as f64) * LINE + 8.0;
    let height = 190.0;
    let gap = 46.0;
    let width = 0.5 * (page.across() - gap);
    let frame = |left: f64| Rect { left, top, right: left + width, bottom: top + height };
    let length = 1e3 * study.faster.first().map_or(1.0, |c| c.arm.length);
    let curves: Vec<(usize, usize, Vec<[f64; 2]>)> = rows
        .iter()
        .enumerate()
        .flat_map(|(row, shapes)| shapes.iter().enumerate().map(move |(i, c)| (row, i, curve(c))))
        .collect();
    let largest = |upto: f64| {
        let shown = curves.iter().flat_map(|(.., c)| c).filter(|p| p[0] <= upto * length);
        shown.map(|p| p[1]).fold(0.0, f64::max)
    };
    let lowest = curves.iter().flat_map(|(.., c)| c).map(|p| p[1]).fold(0.0, f64::min);
    let whole = Axes::new(frame(LEFT), [0.0, length], [0.0_f64.min(1.05 * lowest), 1.08 * largest(1.0)]);
    let low = [1.15 * lowest - 0.1, 1.08 * largest(0.6)];
    let enlarged = Axes::new(frame(LEFT + width + gap), [0.0, length], low);

    let heading = Label::math("Section rotation $α$($s$) along the arm");
    let mut scene = Scene::new(page.width(), top + height + BELOW + LINE + MARGIN, format!("Fig. 1c: {heading}"));
    header(&mut scene, "Fig. 1c", &heading, page);
    footer(&mut scene, &note(study), page);
    angle_key(&mut scene, &rows, per_line, lines);
    for (axes, title) in [(&whole, "$α$ (°)"), (&enlarged, "$α$ (°), enlarged")] {
        axes.draw(&mut scene, &Label::math("$s$ (mm)"), &Label::math(title));
        for (row, i, points) in &curves {
            for part in axes.clipped(points) {
                scene.line(&part, angle_stroke(*row + 1 == rows.len(), *i));
            }
        }
    }
    // Zero is where the section stands across the centreline.
    let zero = [[0.0, 0.0], [length, 0.0]];
    scene.line(&enlarged.all(&zero), Stroke::solid(GREY.with_opacity(0.6), 0.4));
    scene
}

fn angle_stroke(highest: bool, index: usize) -> Stroke {
    let color = speed_color(index);
    if highest { Stroke::solid(color, 1.0) } else { Stroke::dashed(color, 1.0, [4.0, 2.0]) }
}

/// alpha (deg) over s (mm).
fn curve(c: &Configuration) -> Vec<[f64; 2]> {
    let mut places: Vec<f64> = (0..=400).map(|k| c.arm.length * f64::from(k) / 400.0).collect();
    places.extend(&c.stations.s);
    places.sort_by(f64::total_cmp);
    places.iter().map(|s| [1e3 * s, c.at(*s).alpha.to_degrees()]).collect()
}

/// How many speeds go on a line of the key, and how many lines each tension takes.
fn key_lines(rows: &[&[Configuration]], page: &Page) -> (usize, usize) {
    let most = rows.iter().map(|row| row.len()).max().unwrap_or(0);
    let fits = |count: &usize| COLUMNS[0] + COLUMNS[1] * *count as f64 <= page.across() + 20.0;
    let per_line = (1..=most).rev().find(fits).unwrap_or(1);
    (per_line, most.div_ceil(per_line).max(1))
}

fn angle_key(scene: &mut Scene, rows: &[&[Configuration]], per_line: usize, lines: usize) {
    for (number, row) in rows.iter().rev().enumerate() {
        let baseline =
            |line: usize| MARGIN + 2.0 + ((number * lines + line) as f64 + 1.0) * LINE + CAP_HEIGHT * TEXT_SIZE;
        let value = row.first().map_or(0.0, tension);
        let name = Label::math(&format!("$T_1$ = {} N:", short(value)));
        scene.text(&name, [LEFT, baseline(0)], Anchor::Start, TEXT_SIZE);
        for (i, c) in row.iter().enumerate() {
            let baseline = baseline(i / per_line);
            let middle = baseline - 0.5 * CAP_HEIGHT * TEXT_SIZE;
            let x = LEFT + COLUMNS[0] + COLUMNS[1] * (i % per_line) as f64;
            scene.line(&[[x, middle], [x + 18.0, middle]], angle_stroke(number == 0, i));
            let label = Label::plain(format!("{} m/s", speed(c)));
            scene.text(&label, [x + 22.0, baseline], Anchor::Start, TEXT_SIZE);
        }
    }
}
