//! A fit beside what was measured: shapes with markers, residuals, and how estimates hang together.

use hydrostat::Configuration;
use hydrostat_identify::{Case, Fit, Marker, Residual, Shape};

use crate::axes::{Axes, BELOW, LEFT, TEXT_SIZE, TICK_SIZE};
use crate::chart::padded;
use crate::fit_in_space::{InSpace, SpatialCase};
use crate::font::{CAP_HEIGHT, Label};
use crate::legend::{Legend, Mark, Sample, clipped};
use crate::outline::{Outline, Style, bounds};
use crate::page::{MARGIN, Page};
use crate::palette::{Color, GREY, INK, PAPER, series};
use crate::placement::{Occupied, Rect};
use crate::scene::{Anchor, Scene, Stroke};
use crate::surroundings::Surroundings;

const MAX_HEIGHT: f64 = 320.0;
const RESIDUALS: f64 = 110.0;
const GAP: f64 = 16.0;
/// The side of a correlation's square, at most.
const CELL: f64 = 34.0;
/// Names in the legend; more would hide the data.
const MOST_NAMES: usize = 12;

/// One load case of a fit.
struct FittedCase<'a> {
    name: &'a str,
    /// The fitted arm under the loads of the case, if it was kept.
    shape: Option<&'a Shape>,
    /// Markers with their measured places, m; in the plane z is 0.
    markers: Vec<(Marker, [f64; 3])>,
    /// Residuals in standard deviations, in the order of the data.
    residuals: Vec<f64>,
}

impl<'a> FittedCase<'a> {
    fn new(name: &'a str, shape: Option<&'a Shape>, residuals: &[Residual]) -> Self {
        let in_space = matches!(shape, Some(Shape::Space(_)));
        let mut found: Vec<(Marker, [Option<f64>; 3])> = Vec::new();
        for one in residuals {
            let Some((marker, axis)) = one.measurement.quantity.marker() else { continue };
            let at = found.iter().position(|(own, _)| *own == marker).unwrap_or_else(|| {
                found.push((marker, [None, None, (!in_space).then_some(0.0)]));
                found.len() - 1
            });
            found[at].1[axis] = Some(one.measurement.value);
        }
        // A marker without one of its coordinates has no place on the page.
        let place = |(marker, at): &(Marker, [Option<f64>; 3])| Some((*marker, [at[0]?, at[1]?, at[2]?]));
        Self {
            name,
            shape,
            markers: found.iter().filter_map(place).collect(),
            residuals: residuals.iter().map(|one| one.standardised).collect(),
        }
    }

    /// The shape in the plane.
    fn plane(&self) -> Option<&'a Configuration> {
        match self.shape? {
            Shape::Plane(shape) => Some(shape),
            Shape::Space(_) => None,
        }
    }

    /// The shape in space with its markers.
    fn space(&self, color: Color) -> Option<SpatialCase<'_>> {
        match self.shape? {
            Shape::Plane(_) => None,
            Shape::Space(shape) => Some(SpatialCase { shape, markers: &self.markers, color }),
        }
    }
}

/// Fitted shapes to scale with the measured places, every residual in standard deviations, and, of two parameters or more, the correlations
/// of the estimates. `cases` are those that were fitted to, `name` the arm's.
///
/// ```
/// use hydrostat::{Arm, Gravity, Parameter};
/// use hydrostat_figures::{Page, fit_figure};
/// use hydrostat_identify::{Case, FitOptions, Fitted, Measurement, Quantity, fit};
///
/// let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// (arm.density, arm.flow.density) = (1500.0, 1000.0); // kg/m3: it sinks
/// arm.gravity = Some(Gravity::default());
/// let measurements = vec![Measurement::new(Quantity::X(0.2), 0.196, 1e-3), Measurement::new(Quantity::Y(0.2), -0.02, 1e-3)];
/// let cases = [Case { name: "at rest".to_owned(), arm: arm.clone(), measurements }];
/// let wanted = [Fitted::new(Parameter::Young, &arm).unwrap()];
/// let found = fit(&cases, &wanted, &FitOptions::default(), |_| true).unwrap();
/// let figure = fit_figure("a cone", &cases, &found, &Page::default());
/// assert!(figure.texts().any(|text| text == "at rest"));
/// ```
pub fn fit_figure(name: &str, cases: &[Case], fit: &Fit, page: &Page) -> Scene {
    let shown: Vec<FittedCase<'_>> = fit
        .residuals
        .chunk_by(|one, next| one.case == next.case)
        .map(|own| {
            let case = own[0].case;
            let shape = fit.shapes.iter().find(|(index, _)| *index == case).map(|(_, shape)| shape);
            FittedCase::new(cases.get(case).map_or("", |case| case.name.as_str()), shape, own)
        })
        .collect();
    let names: Vec<String> = fit.estimates.iter().map(|one| one.fitted.parameter.to_string()).collect();
    let cases = if fit.load_cases == 1 { "load case" } else { "load cases" };
    let title = format!("{name}: fitted to {} {cases}", fit.load_cases);
    drawn(&title, &shown, &names, &fit.correlation, page)
}

fn drawn(title: &str, cases: &[FittedCase<'_>], names: &[String], correlation: &[Vec<f64>], page: &Page) -> Scene {
    let mut legend = Legend::new(page);
    for (index, case) in cases.iter().enumerate().take(MOST_NAMES) {
        legend.add(Sample::Mark(Mark::Filled(series(index))), Label::plain(clipped(case.name)));
    }
    if cases.iter().any(|case| !case.markers.is_empty()) {
        legend.add(Sample::Mark(Mark::Cross(INK)), Label::plain("measured"));
    }
    let heading = page.heading(title, None);
    let top = heading.bottom + legend.height() + 6.0;
    let spatial: Vec<SpatialCase<'_>> =
        cases.iter().enumerate().filter_map(|(index, case)| case.space(series(index))).collect();
    let picture = if spatial.is_empty() {
        Picture::Plane(InPlane::new(cases, top, page))
    } else {
        Picture::Space(Box::new(InSpace::new(&spatial, top, page)))
    };
    let second = picture.bottom() + BELOW + GAP;
    let third = second + RESIDUALS + BELOW + GAP;
    let cell = correlation_cell(names.len(), page);
    let height = if names.len() < 2 { third - GAP } else { third + cell * names.len() as f64 + TEXT_SIZE + 8.0 };

    let says = format!("{}: fitted shapes, residuals and correlations", page.title_or(title));
    let mut scene = Scene::new(page.width(), height + MARGIN, says);
    heading.draw(&mut scene);
    legend.draw(&mut scene, heading.bottom);
    match &picture {
        Picture::Plane(own) => own.draw(&mut scene, cases),
        Picture::Space(own) => own.draw(&mut scene, &spatial),
    }
    draw_residuals(&mut scene, second, cases, page);
    if names.len() > 1 {
        draw_correlation(&mut scene, third, cell, names, correlation);
    }
    scene
}

/// The shapes with what was measured.
enum Picture {
    Plane(InPlane),
    Space(Box<InSpace>),
}

impl Picture {
    fn bottom(&self) -> f64 {
        match self {
            Self::Plane(own) => own.axes.frame.bottom,
            Self::Space(own) => own.bottom(),
        }
    }
}

/// Shapes in the plane.
struct InPlane {
    axes: Axes,
    outlines: Vec<Outline>,
}

impl InPlane {
    fn new(cases: &[FittedCase<'_>], top: f64, page: &Page) -> Self {
        let outlines: Vec<Outline> = cases.iter().filter_map(|case| Some(Outline::new(case.plane()?, 0))).collect();
        let markers = cases.iter().flat_map(|case| &case.markers).map(|(_, [x, y, _])| [1e3 * x, 1e3 * y]);
        let all: Vec<[f64; 2]> = outlines.iter().flat_map(|o| o.surface.iter().copied()).chain(markers).collect();
        let [x, y] = bounds(&all);
        let pad = 0.05 * (x[1] - x[0]).max(y[1] - y[0]);
        let grown = |range: [f64; 2]| [range[0] - pad, range[1] + pad];
        let axes = Axes::equal(LEFT, top, page.across(), [120.0, MAX_HEIGHT], grown(x), grown(y));
        Self { axes, outlines }
    }

    fn draw(&self, scene: &mut Scene, cases: &[FittedCase<'_>]) {
        let Self { axes, outlines } = self;
        axes.draw(scene, &Label::math("$x$ (mm)"), &Label::math("$y$ (mm)"));
        for (index, outline) in outlines.iter().enumerate() {
            let color = series(index);
            let style = Style {
                fill: color.with_opacity(0.12),
                surface: Stroke::solid(color.with_opacity(0.5), 0.6),
                sections: Stroke::solid(color.with_opacity(0.0), 0.1),
                centreline: Stroke::solid(color, 1.0),
                cables: Vec::new(),
            };
            outline.draw(scene, axes, &style);
        }
        for (index, case) in cases.iter().enumerate() {
            for (_, [x, y, _]) in &case.markers {
                Mark::Cross(series(index).towards(INK, 0.4)).draw(scene, axes.at([1e3 * x, 1e3 * y]));
            }
        }
        let mut taken = Occupied::new(axes.frame.grown(-3.0));
        for outline in outlines {
            outline.occupy(&mut taken, axes);
        }
        let arms = cases.iter().filter_map(|case| Some(&case.plane()?.arm));
        Surroundings::shared(arms).draw(scene, &mut taken, axes.frame);
    }
}

/// Every residual in a row, case by case, with lines at two standard deviations.
fn draw_residuals(scene: &mut Scene, top: f64, cases: &[FittedCase<'_>], page: &Page) {
    const TWO: f64 = 2.0;
    let frame = Rect { left: LEFT, top, right: page.right(), bottom: top + RESIDUALS };
    let count: usize = cases.iter().map(|case| case.residuals.len()).sum();
    let most = cases.iter().flat_map(|case| &case.residuals).fold(TWO, |m, r| m.max(r.abs()));
    let across = [0.0, count as f64 + 1.0];
    let axes = Axes::new(frame, across, padded([-most, most], 0.08));
    for level in [-TWO, 0.0, TWO] {
        let stroke = if level == 0.0 { Stroke::solid(GREY, 0.5) } else { Stroke::dashed(GREY, 0.5, [3.0, 2.0]) };
        scene.line(&axes.all(&[[across[0], level], [across[1], level]]), stroke);
    }
    let mut number = 0.0;
    for (index, case) in cases.iter().enumerate() {
        for residual in &case.residuals {
            number += 1.0;
            Mark::Filled(series(index)).draw(scene, axes.at([number, *residual]));
        }
    }
    axes.draw(scene, &Label::plain("measured number"), &Label::plain("fitted minus measured (sd)"));
}

/// What room there is for each square beside the names.
fn correlation_cell(count: usize, page: &Page) -> f64 {
    (0.5 * page.across() / count.max(1) as f64).min(CELL)
}

fn draw_correlation(scene: &mut Scene, top: f64, cell: f64, names: &[String], correlation: &[Vec<f64>]) {
    const POSITIVE: Color = series_of(0);
    const NEGATIVE: Color = series_of(1);
    scene.text(&Label::plain("correlation of the estimates"), [LEFT, top], Anchor::Start, TEXT_SIZE);
    let top = top + 6.0;
    for (i, (name, row)) in names.iter().zip(correlation).enumerate() {
        let y = top + cell * i as f64;
        let middle = y + 0.5 * cell + 0.5 * CAP_HEIGHT * TICK_SIZE;
        for (j, value) in row.iter().enumerate().take(names.len()) {
            let x = LEFT + cell * j as f64;
            let corners = [[x, y], [x + cell, y], [x + cell, y + cell], [x, y + cell]];
            let full = if *value < 0.0 { NEGATIVE } else { POSITIVE };
            let shade = if value.is_finite() { PAPER.towards(full, value.abs()) } else { GREY };
            scene.area(&corners, Some(shade), Some(Stroke::solid(PAPER, 0.8)));
            let text = if value.is_finite() { format!("{value:.2}").replace('-', "\u{2212}") } else { "?".to_owned() };
            if cell >= 20.0 {
                scene.text(&Label::plain(text), [x + 0.5 * cell, middle], Anchor::Middle, TICK_SIZE);
            }
        }
        let label = Label::plain(clipped(name));
        scene.text(&label, [LEFT + cell * names.len() as f64 + 6.0, middle], Anchor::Start, TICK_SIZE);
    }
}

const fn series_of(index: usize) -> Color {
    crate::palette::SERIES[index]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_correlations_and_many_cases_can_be_drawn() {
        let shape = hydrostat::Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5).solve().unwrap();
        let shape = Shape::Plane(Box::new(shape));
        let named: Vec<String> = (0..30).map(|k| format!("case {k}")).collect();
        let case = |name| FittedCase { name, shape: Some(&shape), markers: Vec::new(), residuals: vec![9.0] };
        let cases: Vec<_> = named.iter().map(|name| case(name)).collect();
        let names = ["a", "b"].map(str::to_owned);
        let figure = drawn("t", &cases, &names, &[vec![1.0, f64::NAN], vec![f64::NAN, 1.0]], &Page::default());
        assert!(figure.texts().any(|text| text == "?"));
        assert!(!figure.texts().any(|text| text == "case 20"));
        let svg = figure.svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        let one = drawn("t", &cases[..1], &names[..1], &[vec![1.0]], &Page::default());
        assert!(one.size()[1] < figure.size()[1]);
    }
}
