//! Rates of small motions in the complex plane, at one load or over several values of one.

use hydrostat::Mode;

use crate::axes::{Axes, BELOW, LEFT};
use crate::chart::{Abscissa, padded_beside};
use crate::font::Label;
use crate::legend::{Legend, Mark, Sample};
use crate::page::{MARGIN, Page};
use crate::palette::{GREY, INK, ordered};
use crate::placement::Rect;
use crate::scene::{Scene, Stroke};

const HEIGHT: f64 = 240.0;
/// Values that the legend names.
const NAMED: usize = 6;

/// Rates of the modes of an arm, given the values (SI) of what varies: the real part, the growth, across, and the imaginary
/// part, the angular frequency, up; from light to dark as the value goes on. A pair is one point. What is right of the line
/// at zero grows.
///
/// ```
/// use hydrostat_figures::{Page, root_locus_figure};
///
/// let mut rod = hydrostat::Arm::cone(1.0, 0.001, 0.001, 1e9, 0.5);
/// rod.flow.density = 0.0;
/// let modes = rod.modes(3, 8)?;
/// let figure = root_locus_figure(&[(0.0, &modes.modes)], None, "a rod", &Page::default());
/// assert!(figure.texts().any(|text| text == "growth rate (1/s)"));
/// # Ok::<(), hydrostat::MotionError>(())
/// ```
pub fn root_locus_figure(found: &[(f64, &[Mode])], over: Option<&Abscissa>, title: &str, page: &Page) -> Scene {
    let count = found.len();
    let mut legend = Legend::new(page);
    if let Some(over) = over {
        let every = count.div_ceil(NAMED).max(1);
        for (k, (value, _)) in found.iter().enumerate().filter(|(k, _)| k % every == 0 || k + 1 == count) {
            legend.add(Sample::Mark(Mark::Filled(ordered(k, count))), Label::plain(over.text(*value)));
        }
    }
    let places: Vec<(usize, [f64; 2])> =
        found.iter().enumerate().flat_map(|(k, (_, modes))| modes.iter().map(move |mode| (k, mode.rate))).collect();
    let reach = |axis: usize| {
        let values = places.iter().map(|(_, rate)| rate[axis]).chain([0.0]);
        values.fold([0.0_f64; 2], |[low, high], v| [low.min(v), high.max(v)])
    };
    let heading = page.heading(title, None);
    let top = heading.bottom + legend.height() + 6.0;
    let frame = Rect { left: LEFT, top, right: page.right(), bottom: top + HEIGHT };
    // A part that is rounding beside the other one is zero.
    let [growth, frequency] = [reach(0), reach(1)];
    let size = [growth, frequency].into_iter().flatten().fold(0.0_f64, |size, v| size.max(v.abs()));
    let axes = Axes::new(frame, padded_beside(growth, 0.05, size), padded_beside(frequency, 0.06, size));
    let says = format!("{}: rates of small motions", page.title_or(title));
    let mut scene = Scene::new(page.width(), frame.bottom + BELOW + MARGIN, says);
    heading.draw(&mut scene);
    legend.draw(&mut scene, heading.bottom);
    axes.draw(
        &mut scene,
        &Label::plain("growth rate (1/s)".to_owned()),
        &Label::plain("angular frequency (rad/s)".to_owned()),
    );
    let zero = axes.at([0.0, 0.0])[0];
    scene.line(&[[zero, frame.top], [zero, frame.bottom]], Stroke::dashed(GREY, 0.6, [3.0, 2.0]));
    for (k, rate) in places {
        let color = if over.is_some() { ordered(k, count) } else { INK };
        Mark::Filled(color).draw(&mut scene, axes.at(rate));
    }
    scene
}
