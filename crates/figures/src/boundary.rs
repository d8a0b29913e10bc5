//! What bounds the places that a tip reaches, to scale.

use hydrostat::{Boundary, BoundaryKind, Configuration};

use crate::arm_figure::fitting;
use crate::axes::{Axes, BELOW, LEFT};
use crate::font::{CAP_HEIGHT, Label};
use crate::legend::{Legend, MARGIN, Sample, WIDTH};
use crate::outline::{Outline, Style, bounds};
use crate::palette::{BODY, GREY, series};
use crate::scene::{Anchor, Scene, Stroke};

const TITLE_SIZE: f64 = 10.0;
const SECTIONS: usize = 21;
const MAX_HEIGHT: f64 = 400.0;

/// The pieces of a boundary, coloured by why they are one, with the arm that nothing pulls.
///
/// ```
/// use hydrostat::{Arm, BoundaryOptions, Cable, Profile};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
/// arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
/// let options = BoundaryOptions { max_tension: Some(0.2), spacing: 0.05, ..BoundaryOptions::default() };
/// let found = arm.reachable(&options).unwrap();
/// let figure = hydrostat_figures::boundary_figure(&found, &arm.solve().unwrap());
/// assert!(figure.texts().any(|text| text == "a cable at a bound"));
/// ```
pub fn boundary_figure(found: &Boundary, slack: &Configuration) -> Scene {
    let style = |kind: BoundaryKind| match kind {
        BoundaryKind::Edge(_) => (0, Stroke::solid(series(1), 1.2), "a cable at a bound"),
        BoundaryKind::Fold(_) => (1, Stroke::solid(series(0), 1.2), "a fold"),
        BoundaryKind::Limit(_) => (2, Stroke::dashed(series(2), 1.2, [4.0, 2.5]), "no equilibrium beyond"),
    };
    let mut legend = Legend::default();
    let mut kinds: Vec<_> = found.pieces.iter().map(|piece| style(piece.kind)).collect();
    kinds.sort_by_key(|(order, ..)| *order);
    kinds.dedup_by_key(|(order, ..)| *order);
    for (_, stroke, words) in kinds {
        legend.add(Sample::Line(stroke), Label::plain(words));
    }
    let below = MARGIN + CAP_HEIGHT * TITLE_SIZE + 8.0;
    let top = below + legend.height() + 6.0;

    let outline = Outline::new(slack, SECTIONS);
    let places = found.pieces.iter().flat_map(|piece| &piece.points).map(|p| [1e3 * p.tip.x, 1e3 * p.tip.y]);
    let all: Vec<[f64; 2]> = outline.surface.iter().copied().chain(places).collect();
    let [x, y] = bounds(&all);
    let pad = 0.04 * (x[1] - x[0]).max(y[1] - y[0]);
    let grown = |range: [f64; 2]| [range[0] - pad, range[1] + pad];
    let axes = Axes::equal(LEFT, top, WIDTH - LEFT - MARGIN, [110.0, MAX_HEIGHT], grown(x), grown(y));

    let words = format!("{}: what the tip can reach", slack.arm.name);
    let mut scene = Scene::new(WIDTH, axes.frame.bottom + BELOW + MARGIN, words.clone());
    let title = Label::plain(words);
    scene.text(&title, [LEFT, MARGIN + CAP_HEIGHT * TITLE_SIZE], Anchor::Start, fitting(&title, TITLE_SIZE));
    legend.draw(&mut scene, below);
    axes.draw(&mut scene, &Label::math("$x$ (mm)"), &Label::math("$y$ (mm)"));
    let thin = Stroke::solid(GREY, 0.5);
    let body = Style {
        fill: BODY.with_opacity(0.5),
        surface: thin,
        sections: Stroke::solid(GREY.with_opacity(0.0), 0.1),
        centreline: thin,
        cables: vec![Stroke::solid(GREY.with_opacity(0.0), 0.1); slack.cables.len()],
    };
    outline.draw(&mut scene, &axes, &body);
    for piece in &found.pieces {
        let line: Vec<[f64; 2]> = piece.points.iter().map(|p| axes.at([1e3 * p.tip.x, 1e3 * p.tip.y])).collect();
        scene.line(&line, style(piece.kind).1);
    }
    scene
}
