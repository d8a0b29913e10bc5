//! Several quantities over one, for several things that are compared: frames one above the other.

use crate::axes::{Axes, BELOW, LEFT, Scale};
use crate::chart::padded;
use crate::font::Label;
use crate::legend::{Legend, Mark, Sample};
use crate::outline::bounds;
use crate::page::{MARGIN, Page};
use crate::palette::series;
use crate::placement::Rect;
use crate::scene::{Scene, Stroke};

const HEIGHT: f64 = 120.0;
/// Between two frames.
const GAP: f64 = 14.0;
const WIDE: f64 = 1.3;
/// Every second line: the one below it shows through where both are the same.
const DASH: [f64; 2] = [4.0, 4.0];
/// More marks than this would hide their line.
const MOST_MARKS: usize = 40;

/// What an axis measures.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// With its unit.
    pub title: String,
    /// How its values are spaced.
    pub scale: Scale,
}

/// One frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// What is shown upwards.
    pub up: Measure,
    /// The points of each thing that is compared, in the order of their names; those that are not finite are left out.
    pub lines: Vec<Vec<[f64; 2]>>,
}

/// Lines over `across`, a line and a colour for each of `names`, in a frame for each panel.
///
/// ```
/// use hydrostat_figures::{Measure, Page, Panel, Scale, lines_figure};
///
/// let measure = |title: &str| Measure { title: title.to_owned(), scale: Scale::Logarithmic };
/// let lines = vec![vec![[1e-8, 120.0], [1e-4, 60.0]], vec![[1e-8, 55.0], [1e-4, 30.0]]];
/// let panel = Panel { up: measure("time (µs)"), lines };
/// let figure = lines_figure("a solve", &measure("tol"), &["cold", "warm"], &[panel], &Page::default());
/// assert!(figure.texts().any(|text| text == "warm") && figure.texts().any(|text| text == "time (µs)"));
/// ```
pub fn lines_figure(title: &str, across: &Measure, names: &[&str], panels: &[Panel], page: &Page) -> Scene {
    let mut legend = Legend::new(page);
    let is_drawn = |index: usize| {
        let of = |panel: &Panel| {
            panel.lines.get(index).is_some_and(|l| l.iter().any(|p| length(*p, across.scale, panel).is_some()))
        };
        panels.iter().any(of)
    };
    for (index, name) in names.iter().enumerate().filter(|(index, _)| is_drawn(*index)) {
        legend.add(Sample::Line(stroke(index)), Label::plain(*name));
    }
    let heading = page.heading(title, None);
    let first = heading.bottom + legend.height() + 6.0;
    let top = |index: usize| first + index as f64 * (HEIGHT + GAP);
    let bottom = top(panels.len()) - GAP;
    let says = format!("{}, over {}", page.title_or(title), across.title);
    let mut scene = Scene::new(page.width(), bottom + BELOW + MARGIN, says);
    heading.draw(&mut scene);
    legend.draw(&mut scene, heading.bottom);

    let all: Vec<[f64; 2]> = panels.iter().flat_map(|panel| lengths(panel, across.scale)).collect();
    let x = padded(bounds(&all)[0], 0.03);
    for (index, panel) in panels.iter().enumerate() {
        let frame = Rect { left: LEFT, top: top(index), right: page.right(), bottom: top(index) + HEIGHT };
        let y = padded(bounds(&lengths(panel, across.scale))[1], 0.08);
        let axes = Axes::scaled(frame, [x, y], [across.scale, panel.up.scale]);
        for (index, line) in panel.lines.iter().enumerate() {
            let shown: Vec<[f64; 2]> =
                line.iter().copied().filter(|p| length(*p, across.scale, panel).is_some()).collect();
            let points = axes.all(&shown);
            scene.line(&points, stroke(index));
            for point in points.into_iter().filter(|_| shown.len() <= MOST_MARKS) {
                Mark::Filled(series(index)).draw(&mut scene, point);
            }
        }
        let up = Label::plain(&panel.up.title);
        if index + 1 == panels.len() {
            axes.draw(&mut scene, &Label::plain(&across.title), &up);
        } else {
            axes.draw_above_another(&mut scene, &up);
        }
    }
    scene
}

fn stroke(index: usize) -> Stroke {
    let (color, dashed) = (series(index), index % 2 == 1);
    if dashed { Stroke::dashed(color, WIDE, DASH) } else { Stroke::solid(color, WIDE) }
}

/// A point as lengths; `None` where it has no place.
fn length(point: [f64; 2], across: Scale, panel: &Panel) -> Option<[f64; 2]> {
    let [x, y] = [across.of(point[0]), panel.up.scale.of(point[1])];
    (x.is_finite() && y.is_finite()).then_some([x, y])
}

fn lengths(panel: &Panel, across: Scale) -> Vec<[f64; 2]> {
    panel.lines.iter().flatten().filter_map(|point| length(*point, across, panel)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measure(title: &str, scale: Scale) -> Measure {
        Measure { title: title.to_owned(), scale }
    }

    #[test]
    fn what_has_no_logarithm_has_no_place() {
        let lines = vec![vec![[0.0, 10.0], [1.0, 0.0], [2.0, 100.0], [3.0, f64::NAN]], Vec::new()];
        let panel = Panel { up: measure("us", Scale::Logarithmic), lines };
        assert_eq!(lengths(&panel, Scale::Even), [[0.0, 1.0], [2.0, 2.0]]);
        let figure =
            lines_figure("t", &measure("v", Scale::Even), &["one", "none"], &[panel.clone(), panel], &Page::default());
        let svg = figure.svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        let texts: Vec<&str> = figure.texts().collect();
        assert!(texts.contains(&"one") && !texts.contains(&"none"), "what has no line has no entry: {texts:?}");
        assert_eq!(texts.iter().filter(|text| **text == "v").count(), 1, "{texts:?}");
        assert_eq!(texts.iter().filter(|text| **text == "us").count(), 2, "{texts:?}");
    }
}
