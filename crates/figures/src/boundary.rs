//! The places that a tip reaches, and what bounds them, to scale.

use hydrostat::{Boundary, BoundaryKind, Configuration, Options, Solver};

use crate::axes::{Axes, BELOW, LEFT};
use crate::font::Label;
use crate::legend::{Legend, Sample};
use crate::outline::{Outline, Style, bounds};
use crate::page::{MARGIN, Page};
use crate::palette::{BODY, Color, GREY, series};
use crate::placement::Occupied;
use crate::region;
use crate::scene::{Point, Scene, Stroke};
use crate::surroundings::Surroundings;

const SECTIONS: usize = 21;
const MAX_HEIGHT: f64 = 400.0;
/// What is reachable.
const REACHABLE: Color = Color { rgb: [222, 235, 245], opacity: 1.0 };
/// Shapes that tell inside from outside: anywhere in the box of tensions, and beside the lines.
const SAMPLES: [u32; 2] = [300, 300];
/// How far from a line towards the middle of the box a sample beside it is, as a fraction.
const BESIDE: f64 = 0.03;
/// Error of their tips over L: a tenth of a line's width.
const TOL: f64 = 1e-4;

/// The places that the tip reaches, filled, and the pieces of their boundary, coloured by why they are one, with the arm that
/// nothing pulls. Some hundred shapes are solved to tell which side of a piece is reachable; where pieces leave the area open, it
/// is not filled.
///
/// ```
/// use hydrostat::{Arm, BoundaryOptions, Cable, Profile};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
/// arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
/// let options = BoundaryOptions { max_tension: Some(0.2), spacing: 0.05, ..BoundaryOptions::default() };
/// let found = arm.reachable(&options).unwrap();
/// let figure = hydrostat_figures::boundary_figure(&found, &arm.solve().unwrap(), &hydrostat_figures::Page::default());
/// assert!(figure.texts().any(|text| text == "reachable"));
/// ```
pub fn boundary_figure(found: &Boundary, slack: &Configuration, page: &Page) -> Scene {
    let style = |kind: BoundaryKind| match kind {
        BoundaryKind::Edge(_) => (0, Stroke::solid(series(1), 1.2), "a cable at a bound"),
        BoundaryKind::Fold(_) => (1, Stroke::solid(series(0), 1.2), "two cables move the tip along the same line"),
        BoundaryKind::Limit(_) => (2, Stroke::dashed(series(2), 1.2, [4.0, 2.5]), "no equilibrium beyond"),
    };
    let outline = Outline::new(slack, SECTIONS);
    let millimetres = |[x, y]: [f64; 2]| [1e3 * x, 1e3 * y];
    let pieces: Vec<Vec<[f64; 2]>> = found
        .pieces
        .iter()
        .map(|piece| piece.points.iter().map(|p| millimetres([p.tip.x, p.tip.y])).collect())
        .collect();
    let all: Vec<[f64; 2]> = outline.surface.iter().chain(pieces.iter().flatten()).copied().collect();
    let axes_below = |top: f64| axes_around(&all, top, page);

    let words = format!("{}: workspace of the tip", slack.arm.name);
    let heading = page.heading(&words, None);
    // Whether there is an area does not depend on where on the page it is.
    let area_in = |axes: &Axes| {
        let lines: Vec<Vec<Point>> = pieces.iter().map(|piece| axes.all(piece)).collect();
        let places: Vec<Point> = samples(found, slack).into_iter().map(|tip| axes.at(millimetres(tip))).collect();
        region::inside(&lines, &places, axes.frame, REACHABLE)
    };
    let area = area_in(&axes_below(heading.bottom));

    let mut legend = Legend::new(page);
    if area.is_some() {
        legend.add(Sample::Fill(REACHABLE), Label::plain("reachable"));
    }
    let mut kinds: Vec<_> = found.pieces.iter().map(|piece| style(piece.kind)).collect();
    kinds.sort_by_key(|(order, ..)| *order);
    kinds.dedup_by_key(|(order, ..)| *order);
    for (_, stroke, words) in kinds {
        legend.add(Sample::Line(stroke), Label::plain(words));
    }
    let axes = axes_below(heading.bottom + legend.height() + 6.0);
    let says = page.title_or(&words);
    let mut scene = Scene::new(page.width(), axes.frame.bottom + BELOW + MARGIN, says);
    heading.draw(&mut scene);
    legend.draw(&mut scene, heading.bottom);
    if let Some(area) = area {
        scene.picture(axes.frame, area);
    }
    axes.draw(&mut scene, &Label::math("$x$ (mm)"), &Label::math("$y$ (mm)"));
    let thin = Stroke::solid(GREY, 0.5);
    let nothing = Stroke::solid(GREY.with_opacity(0.0), 0.1);
    let body = Style {
        fill: BODY.with_opacity(0.5),
        surface: thin,
        sections: nothing,
        centreline: thin,
        cables: vec![nothing; slack.cables.len()],
    };
    outline.draw(&mut scene, &axes, &body);
    let mut taken = Occupied::new(axes.frame.grown(-3.0));
    outline.occupy(&mut taken, &axes);
    for (piece, points) in found.pieces.iter().zip(&pieces) {
        let line = axes.all(points);
        scene.line(&line, style(piece.kind).1);
        taken.add_line(&line);
    }
    Surroundings::of(&slack.arm, None).draw(&mut scene, &mut taken, axes.frame);
    scene
}

/// Axes that show all of `points`, mm.
fn axes_around(points: &[[f64; 2]], top: f64, page: &Page) -> Axes {
    let [x, y] = bounds(points);
    let pad = 0.04 * (x[1] - x[0]).max(y[1] - y[0]);
    let grown = |range: [f64; 2]| [range[0] - pad, range[1] + pad];
    Axes::equal(LEFT, top, page.across(), [110.0, MAX_HEIGHT], grown(x), grown(y))
}

/// Tips (m) that are reached: anywhere, and beside the lines.
fn samples(found: &Boundary, slack: &Configuration) -> Vec<[f64; 2]> {
    let points = || found.pieces.iter().flat_map(|piece| &piece.points);
    let count = points().map(|point| point.tensions.len()).min().unwrap_or(0);
    let most: Vec<f64> = (0..count).map(|c| points().map(|point| point.tensions[c]).fold(0.0, f64::max)).collect();
    let Ok(mut solver) = Solver::new(&slack.arm, Options::with_tol(TOL)) else { return Vec::new() };
    // With one cable the tip moves on a line.
    if count < 2 || count != slack.cables.len() {
        return Vec::new();
    }
    let anywhere = (1..=SAMPLES[0]).map(|k| spread(k, &most));
    let every = (points().count() / SAMPLES[1] as usize).max(1);
    let beside = points().step_by(every).map(|point| {
        let inwards = |(tension, most): (&f64, &f64)| tension + BESIDE * (0.5 * most - tension);
        point.tensions.iter().zip(&most).map(inwards).collect()
    });
    let tip = |tensions: Vec<f64>| {
        solver.set_tensions(&tensions).ok()?;
        let tip = solver.solve().ok()?.tip();
        Some([tip.x, tip.y])
    };
    anywhere.chain(beside).filter_map(tip).collect()
}

/// Point `number` of a sequence that fills a box evenly: multiples of the powers of the root of g^(d+1) = g + 1, modulo 1.
fn spread(number: u32, most: &[f64]) -> Vec<f64> {
    let dimensions = most.len() as f64;
    let root = (0..40).fold(2.0_f64, |g, _| (1.0 + g).powf(1.0 / (dimensions + 1.0)));
    let mut step = 1.0;
    most.iter()
        .map(|most| {
            step /= root;
            most * (0.5 + f64::from(number) * step).fract()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hydrostat::{Arm, BoundaryOptions, Cable, Profile};

    #[test]
    fn points_of_the_box_are_spread_evenly() {
        let points: Vec<Vec<f64>> = (1..=300).map(|k| spread(k, &[2.0, 3.0])).collect();
        for quarter in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.5], [1.0, 1.5]] {
            let own = points.iter().filter(|p| {
                (quarter[0]..quarter[0] + 1.0).contains(&p[0]) && (quarter[1]..quarter[1] + 1.5).contains(&p[1])
            });
            let count = own.count();
            assert!((70..=80).contains(&count), "{count} of 300 in a quarter");
        }
    }

    /// The area is that of the tips, counted by shapes that the picture was not made of.
    #[test]
    fn what_is_filled_is_where_tips_are() {
        let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
        arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
        arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
        let options = BoundaryOptions { max_tension: Some(0.3), spacing: 0.02, ..BoundaryOptions::default() };
        let found = arm.reachable(&options).unwrap();
        let slack = arm.solve().unwrap();
        let figure = boundary_figure(&found, &slack, &Page::default());
        let (place, picture) = figure.items.iter().find_map(|item| item.picture.clone()).unwrap();
        let outline = Outline::new(&slack, SECTIONS);
        let pieces = found.pieces.iter().flat_map(|p| &p.points).map(|p| [1e3 * p.tip.x, 1e3 * p.tip.y]);
        let all: Vec<[f64; 2]> = outline.surface.iter().copied().chain(pieces).collect();
        let axes = axes_around(&all, place.top, &Page::default());
        assert!((axes.frame.bottom - place.bottom).abs() < 1e-9);
        let cell = |fraction: f64, count: usize| {
            (0..count).position(|k| fraction * (count as f64) < k as f64 + 1.0).unwrap_or(count - 1)
        };
        let filled = |[x, y]: Point| {
            let column = cell((x - place.left) / place.width(), picture.width);
            let line = cell((y - place.top) / place.height(), picture.height);
            picture.rgba[4 * (line * picture.width + column) + 3] > 0
        };
        // Where the area is as thin as a line, the line is all that is seen of it.
        let lines: Vec<Vec<Point>> = found
            .pieces
            .iter()
            .map(|piece| piece.points.iter().map(|p| axes.at([1e3 * p.tip.x, 1e3 * p.tip.y])).collect())
            .collect();
        let on_a_line = |[x, y]: Point| {
            let around = crate::placement::Rect { left: x, top: y, right: x, bottom: y }.grown(0.6);
            lines.iter().flat_map(|line| line.windows(2)).any(|w| around.meets(w[0], w[1]))
        };
        let mut inside = 0;
        for left in [0.01, 0.1, 0.2, 0.29] {
            for right in [0.013, 0.11, 0.21, 0.28] {
                let mut pulled = arm.clone();
                (pulled.cables[0].tension, pulled.cables[1].tension) = (left, right);
                let tip = pulled.solve().unwrap().tip();
                let tip = axes.at([1e3 * tip.x, 1e3 * tip.y]);
                assert!(filled(tip) || on_a_line(tip), "{left} N, {right} N");
                inside += usize::from(filled(tip));
            }
        }
        assert!(inside >= 12, "{inside} of 16");
        let [x, y] = bounds(&all);
        assert!(!filled(axes.at([10.0, 0.0])) && !filled(axes.at([x[1] + 3.0, y[1] + 3.0])));
    }
}
