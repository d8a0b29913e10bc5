//! One arm drawn to scale.

use hydrostat::{CableState, Configuration, Verdict, VerdictKind};

use crate::axes::{Axes, BELOW, LEFT, TEXT_SIZE};
use crate::font::{CAP_HEIGHT, DESCENT, Label};
use crate::legend::{Legend, Sample, clipped};
use crate::numbers::{degrees, short};
use crate::outline::{Outline, Style};
use crate::page::{MARGIN, Page};
use crate::palette::{BODY, Color, GREY, INK, series};
use crate::placement::Occupied;
use crate::scene::{Anchor, Point, Scene, Stroke};
use crate::surroundings::Surroundings;

const SECTIONS: usize = 41;
const MAX_HEIGHT: f64 = 400.0;
/// Length of the arrows at the tip, points.
const ARROW: f64 = 26.0;
/// Half the width of the cross at a target, points.
const CROSS: f64 = 4.0;

/// A configuration drawn to scale: surface, section lines, centreline, cables as wide as they are
/// tight (slack ones thin and dashed), directors and tangent at the tip with alpha(L), the stream
/// and gravity. `note` is written under the title: say there if this is not the answer that was
/// asked for.
///
/// ```
/// let configuration = hydrostat::Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5).solve().unwrap();
/// let figure = hydrostat_figures::arm_figure(&configuration, None, &hydrostat_figures::Page::default());
/// assert!(figure.svg().starts_with("<svg"));
/// assert_eq!(&figure.png().unwrap()[1..4], b"PNG");
/// ```
pub fn arm_figure(configuration: &Configuration, note: Option<&str>, page: &Page) -> Scene {
    reach_figure(configuration, &[], note, page)
}

/// [`arm_figure`] with a cross at every target (m).
///
/// ```
/// let configuration = hydrostat::Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5).solve().unwrap();
/// let page = hydrostat_figures::Page::default();
/// let plain = hydrostat_figures::arm_figure(&configuration, None, &page).svg();
/// assert!(hydrostat_figures::reach_figure(&configuration, &[[0.1, 0.05]], None, &page).svg().len() > plain.len());
/// ```
pub fn reach_figure(configuration: &Configuration, targets: &[[f64; 2]], note: Option<&str>, page: &Page) -> Scene {
    let arm = &configuration.arm;
    let outline = Outline::new(configuration, SECTIONS);
    let strokes = cable_strokes(&configuration.cables);
    let heading = page.heading(&arm.name, note);
    let legend = cable_legend(&configuration.cables, &strokes, page);
    let frame_top = heading.bottom + legend.height() + 6.0;
    let axes = axes_around(&outline, targets, configuration.tip().theta, frame_top, page);

    let title = format!("{}: static shape", page.title_or(&arm.name));
    let mut scene = Scene::new(page.width(), axes.frame.bottom + BELOW + MARGIN, title);
    heading.draw(&mut scene);
    legend.draw(&mut scene, heading.bottom);
    axes.draw(&mut scene, &Label::math("$x$ (mm)"), &Label::math("$y$ (mm)"));
    let style = Style {
        fill: BODY.with_opacity(0.6),
        surface: Stroke::solid(INK, 0.8),
        sections: Stroke::solid(GREY, 0.4),
        centreline: Stroke::dashed(GREY, 0.6, [6.0, 1.5]),
        cables: strokes,
    };
    outline.draw(&mut scene, &axes, &style);

    let mut taken = Occupied::new(axes.frame.grown(-3.0));
    outline.occupy(&mut taken, &axes);
    for target in targets {
        let [x, y] = axes.at(target.map(|v| 1e3 * v));
        for [dx, dy] in [[CROSS, CROSS], [CROSS, -CROSS]] {
            let stroke = [[x - dx, y - dy], [x + dx, y + dy]];
            scene.line(&stroke, Stroke::solid(series(0), 1.2));
            taken.add_line(&stroke);
        }
    }
    let tip = axes.at(outline.tip());
    keep_free(&mut taken, tip, configuration.tip().theta);
    Surroundings::of(arm, None).draw(&mut scene, &mut taken, axes.frame);
    draw_tip(&mut scene, configuration, tip, &mut taken);
    scene
}

/// What a drawing of the last good shape before `verdict` says of it.
///
/// ```
/// use hydrostat::{Arm, Cable, Profile, SolveError};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(1.5));
/// let Err(SolveError::NoEquilibrium(no)) = arm.solve() else { panic!("1.5 N fold the tip") };
/// assert!(hydrostat_figures::last_good_note(&no.verdict).ends_with("(side compressed to zero length)"));
/// ```
pub fn last_good_note(verdict: &Verdict) -> String {
    format!(
        "Last good shape, at {} ({})",
        verdict.phase.load_at(verdict.load_fraction),
        kind_words(verdict.kind.name())
    )
}

/// The name of a kind in results, for people. What folds is the surface; `cable_fold` is something else.
pub(crate) fn kind_words(kind: &str) -> String {
    if kind == VerdictKind::CableFold.name() {
        "side compressed to zero length".to_owned()
    } else {
        kind.replace('_', " ")
    }
}

/// Axes that show the arm and the arrows at its tip.
fn axes_around(outline: &Outline, targets: &[[f64; 2]], theta: f64, top: f64, page: &Page) -> Axes {
    let width = page.across();
    let [x, y] = outline.bounds();
    let extent = (x[1] - x[0]).max(y[1] - y[0]);
    // The arrows are sized on the page; on a scale that is a little too coarse they need no less.
    let arrow = 1.5 * ARROW * extent / width.min(MAX_HEIGHT);
    let [tip_x, tip_y] = outline.tip();
    let ends = [0.0, 0.5].map(|turn| theta + turn * std::f64::consts::PI);
    let arrows = ends.map(|angle| [tip_x + arrow * angle.cos(), tip_y + arrow * angle.sin()]);
    let pad = 0.05 * extent;
    let grown = |range: [f64; 2], axis: usize| {
        let marks = || targets.iter().map(|p| 1e3 * p[axis]);
        let low = arrows.iter().map(|p| p[axis]).chain(marks().map(|v| v - pad)).fold(range[0] - pad, f64::min);
        let high = arrows.iter().map(|p| p[axis]).chain(marks().map(|v| v + pad)).fold(range[1] + pad, f64::max);
        [low, high]
    };
    Axes::equal(LEFT, top, width, [110.0, MAX_HEIGHT], grown(x, 0), grown(y, 1))
}

/// Line styles: as wide as the tension is large among the cables, dashed when slack.
pub(crate) fn cable_strokes(cables: &[CableState]) -> Vec<Stroke> {
    let largest = cables.iter().map(|c| c.tension).fold(0.0, f64::max);
    let stroke = |(i, tension): (usize, f64)| {
        if tension > 0.0 {
            Stroke::solid(series(i), 0.7 + 1.1 * tension / largest)
        } else {
            Stroke::dashed(series(i), 0.6, [3.0, 2.0])
        }
    };
    cables.iter().map(|c| c.tension).enumerate().map(stroke).collect()
}

/// Keeps what has no place of its own off the arrows at the tip.
fn keep_free(taken: &mut Occupied, tip: Point, theta: f64) {
    for angle in [theta, theta + std::f64::consts::FRAC_PI_2] {
        taken.add_line(&[tip, [tip[0] + ARROW * angle.cos(), tip[1] - ARROW * angle.sin()]]);
    }
}

/// Directors a and b and the tangent t at the tip, with the angle from a to t.
fn draw_tip(scene: &mut Scene, configuration: &Configuration, tip: Point, page: &mut Occupied) {
    let at = configuration.tip();
    let end = |angle: f64, length: f64| [tip[0] + length * angle.cos(), tip[1] - length * angle.sin()];
    let quarter = std::f64::consts::FRAC_PI_2;
    // Without an angle that can be seen, t would cover a.
    let turned = at.alpha.abs() > 0.02;
    let mut arrows = vec![(at.theta, "$a$", INK), (at.theta + quarter, "$b$", INK)];
    if turned {
        arrows.push((at.theta + at.alpha, "$t$", series(2)));
    }
    for (angle, _, color) in &arrows {
        scene.arrow(tip, end(*angle, ARROW), *color, 0.9);
        page.add_line(&[tip, end(*angle, ARROW)]);
    }
    if turned {
        let arc: Vec<Point> = (0..=24).map(|k| end(at.theta + at.alpha * f64::from(k) / 24.0, 0.55 * ARROW)).collect();
        scene.line(&arc, Stroke::solid(series(2), 0.7));
        page.add_line(&arc);
    }
    for (angle, name, color) in arrows {
        let label = Label::math(name);
        let rect = page.place(end(angle, ARROW), label.width(TEXT_SIZE), 0.55 * TEXT_SIZE, angle);
        scene.text_in(&label, [rect.left, rect.bottom], Anchor::Start, TEXT_SIZE, color, false);
    }
    let label = Label::math(&format!("$α$($L$) = {}", degrees(at.alpha)));
    place_label(scene, page, &label, INK, tip, at.theta);
}

/// Puts a label near `anchor`, joined to it by a thin line if it had to go far.
pub(crate) fn place_label(
    scene: &mut Scene,
    page: &mut Occupied,
    label: &Label,
    color: Color,
    anchor: Point,
    towards: f64,
) {
    let height = (CAP_HEIGHT + DESCENT) * TEXT_SIZE;
    let rect = page.place(anchor, label.width(TEXT_SIZE), height, towards);
    let near = rect.nearest(anchor);
    if (near[0] - anchor[0]).hypot(near[1] - anchor[1]) > 9.0 {
        scene.line(&[anchor, near], Stroke::solid(color, 0.4));
    }
    scene.text_in(label, [rect.left, rect.bottom - DESCENT * TEXT_SIZE], Anchor::Start, TEXT_SIZE, color, false);
}

/// The cables, above the frame where no data are.
pub(crate) fn cable_legend(cables: &[CableState], strokes: &[Stroke], page: &Page) -> Legend {
    let mut legend = Legend::new(page);
    for (cable, stroke) in cables.iter().zip(strokes) {
        let state = if cable.tension > 0.0 { format!("{} N", short(cable.tension)) } else { "slack".to_owned() };
        legend.add(Sample::Line(*stroke), Label::plain(format!("{}: {state}", clipped(&cable.name))));
    }
    legend
}
