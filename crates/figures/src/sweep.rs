//! Many rows of a sweep: a quantity as colours over two keys, or where the tip is.

use crate::axes::{Axes, BELOW, LEFT, Room, TEXT_SIZE, TICK_SIZE, Ticks};
use crate::chart::{Abscissa, padded};
use crate::font::{CAP_HEIGHT, Label};
use crate::legend::{Legend, Mark, Sample};
use crate::numbers::short;
use crate::outline::bounds;
use crate::page::{Heading, MARGIN, Page};
use crate::palette::{Color, INK, series, shade};
use crate::placement::Rect;
use crate::scene::{Anchor, Picture, Scene, Stroke};
use crate::shaded::{Coloured, ColouredColumn, Shades, Shading};
use crate::three_views::ThreeViews;

const HEIGHT: f64 = 250.0;
/// Width of the bar of colours, its gap to the frame, and the room for its labels and title.
const BAR: [f64; 3] = [10.0, 9.0, 46.0];
const FRAME: Stroke = Stroke::solid(INK, 0.6);
/// More dots than this become one picture.
const MOST_DOTS: usize = 3000;
/// Dots of a picture a point of the page.
const FINE: f64 = 300.0 / 72.0;
/// Cells of a picture whose columns or rows are not evenly spaced.
const UNEVEN: usize = 800;

/// A key that was varied, a value (SI) a row.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyValues {
    /// Its name and unit.
    pub axis: Abscissa,
    /// In SI units.
    pub values: Vec<f64>,
}

/// A column as colours over two keys: cells where these are a grid, dots where they are not.
///
/// ```
/// use hydrostat_figures::{Abscissa, Coloured, ColouredColumn, KeyValues, Page, map_figure};
///
/// let key = |name: &str, values: [f64; 4]| KeyValues {
///     axis: Abscissa { name: name.to_owned(), unit: "m/s".to_owned(), per_si: 1.0 },
///     values: values.to_vec(),
/// };
/// let keys = [key("across", [0.0, 0.0, 1.0, 1.0]), key("up", [0.0, 1.0, 0.0, 1.0])];
/// let values = Coloured::Numbers(vec![0.0, 0.1, 0.2, f64::NAN]);
/// let column = ColouredColumn { name: "tip_alpha_rad".to_owned(), values };
/// let figure = map_figure(&keys, &column, "a sweep", &Page::default());
/// assert!(figure.texts().any(|text| text == "no equilibrium"));
/// ```
pub fn map_figure([x, y]: &[KeyValues; 2], column: &ColouredColumn, title: &str, page: &Page) -> Scene {
    let shading = Shading::new(column);
    let shown = |key: &KeyValues| -> Vec<f64> { key.values.iter().map(|v| v * key.axis.per_si).collect() };
    let places: Vec<[f64; 2]> = shown(x).into_iter().zip(shown(y)).map(|(x, y)| [x, y]).collect();
    let says = format!("{}: {} over {} and {}", page.title_or(title), shading.title(), x.axis.name, y.axis.name);
    let cells = Cells::of(&places);
    let [across, up] = match &cells {
        Some(cells) => cells.ranges(),
        None => bounds(&places).map(|range| padded(range, 0.03)),
    };
    let above = Above::new(title, &shading, page);
    let mut scene = above.begin(says, HEIGHT, page);
    let axes = Axes::new(frame(&shading, above.bottom(), HEIGHT, page), across, up);
    match cells {
        Some(cells) => scene.picture(axes.frame, cells.picture(&shading)),
        None => dots(&mut scene, &axes, &places, &shading),
    }
    finish(&mut scene, &axes, &shading, [&x.axis.title(), &y.axis.title()]);
    scene
}

/// The places of the tip, in m, to scale, coloured by a column.
///
/// ```
/// use hydrostat_figures::{Coloured, ColouredColumn, Page, workspace_figure};
///
/// let tips = [[0.1, 0.0], [0.09, 0.03], [f64::NAN; 2]];
/// let values = Coloured::Numbers(vec![0.0, 0.2, f64::NAN]);
/// let column = ColouredColumn { name: "tip_theta_rad".to_owned(), values };
/// let figure = workspace_figure(&tips, &column, "a sweep", &Page::default());
/// assert!(figure.texts().any(|text| text == "x (mm)"));
/// ```
pub fn workspace_figure(tips: &[[f64; 2]], column: &ColouredColumn, title: &str, page: &Page) -> Scene {
    // Without an answer there is no place.
    let rows: Vec<usize> = (0..tips.len()).filter(|row| tips[*row].iter().all(|v| v.is_finite())).collect();
    let shading = Shading::new(&column.of(&rows));
    let places: Vec<[f64; 2]> = rows.iter().map(|row| tips[*row].map(|v| 1e3 * v)).collect();
    let [x, y] = bounds(&places).map(|range| padded(range, 0.05));
    let says = format!("{}: places of the tip, coloured by {}", page.title_or(title), shading.title());
    let above = Above::new(title, &shading, page);
    let width = frame(&shading, above.bottom(), HEIGHT, page).width();
    let axes = Axes::equal(LEFT, above.bottom(), width, [120.0, 1.4 * HEIGHT], x, y);
    let mut scene = above.begin(says, axes.frame.height(), page);
    dots(&mut scene, &axes, &places, &shading);
    finish(&mut scene, &axes, &shading, [&Label::math("$x$ (mm)"), &Label::math("$y$ (mm)")]);
    scene
}

/// The places of the tip in space, in m, to scale, coloured by a column: y over x, z over x and z over y.
///
/// ```
/// use hydrostat_figures::{Coloured, ColouredColumn, Page, spatial_workspace_figure};
///
/// let tips = [[0.1, 0.0, 0.02], [0.09, 0.03, -0.01], [f64::NAN; 3]];
/// let values = Coloured::Numbers(vec![0.0, 0.2, f64::NAN]);
/// let column = ColouredColumn { name: "tip_alpha_rad".to_owned(), values };
/// let figure = spatial_workspace_figure(&tips, &column, "a sweep", &Page::default());
/// assert!(figure.texts().any(|text| text == "z (mm)"));
/// ```
pub fn spatial_workspace_figure(tips: &[[f64; 3]], column: &ColouredColumn, title: &str, page: &Page) -> Scene {
    let rows: Vec<usize> = (0..tips.len()).filter(|row| tips[*row].iter().all(|v| v.is_finite())).collect();
    let shading = Shading::new(&column.of(&rows));
    let places: Vec<[f64; 3]> = rows.iter().map(|row| tips[*row].map(|v| 1e3 * v)).collect();
    let range = |k: usize| {
        let ends = |[low, high]: [f64; 2], place: &[f64; 3]| [low.min(place[k]), high.max(place[k])];
        places.iter().fold([f64::INFINITY, f64::NEG_INFINITY], ends)
    };
    let says = format!("{}: places of the tip in space, coloured by {}", page.title_or(title), shading.title());
    let above = Above::new(title, &shading, page);
    let top = above.bottom();
    let room = Page { width: page.width() - beside(&shading), title: None };
    let views = ThreeViews::new([0, 1, 2].map(|k| padded(range(k), 0.05)), &room).placed(top);
    let mut scene = above.begin(says, views.bottom - top, page);
    for (axes, view) in &views.views {
        let seen: Vec<[f64; 2]> = places.iter().map(|p| view.place(p)).collect();
        dots(&mut scene, axes, &seen, &shading);
    }
    views.draw(&mut scene);
    let right = views.views.iter().map(|(axes, _)| axes.frame.right).fold(0.0, f64::max);
    draw_bar(&mut scene, Rect { left: right, top, right, bottom: views.bottom }, &shading);
    scene
}

/// A column over one key.
///
/// ```
/// use hydrostat_figures::{Abscissa, KeyValues, Page, curve_figure};
///
/// let axis = Abscissa { name: "flow.speed".to_owned(), unit: "m/s".to_owned(), per_si: 1.0 };
/// let key = KeyValues { axis, values: vec![0.0, 1.0] };
/// let figure = curve_figure(&key, "tip_x_m", &[0.2, 0.19], "a sweep", &Page::default());
/// assert!(figure.texts().any(|text| text == "x(L) (mm)"));
/// ```
pub fn curve_figure(key: &KeyValues, column: &str, values: &[f64], title: &str, page: &Page) -> Scene {
    let numbers = ColouredColumn { name: column.to_owned(), values: Coloured::Numbers(values.to_vec()) };
    let shading = Shading::new(&numbers);
    let shown = key.values.iter().map(|v| v * key.axis.per_si).zip(values.iter().map(|v| v * shading.per_si()));
    let mut points: Vec<[f64; 2]> = shown.map(|(x, y)| [x, y]).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let found: Vec<[f64; 2]> = points.iter().copied().filter(|p| p[1].is_finite()).collect();
    let [x, y] = [bounds(&points)[0], bounds(&found)[1]];
    let says = format!("{}: {} over {}", page.title_or(title), shading.title(), key.axis.name);
    let heading = page.heading(title, None);
    let top = heading.bottom + 4.0;
    let frame = Rect { left: LEFT, top, right: page.right(), bottom: top + HEIGHT };
    let mut scene = Scene::new(page.width(), frame.bottom + BELOW + MARGIN, says);
    heading.draw(&mut scene);
    let axes = Axes::new(frame, padded(x, 0.0), padded(y, 0.06));
    for piece in points.split(|p| !p[1].is_finite()) {
        let line = axes.all(piece);
        match line[..] {
            [alone] => scene.dot(alone, 1.2, series(1)),
            _ => scene.line(&line, Stroke::solid(series(1), 1.4)),
        }
    }
    axes.draw(&mut scene, &key.axis.title(), shading.title());
    scene
}

/// What stands above a frame.
struct Above {
    heading: Heading,
    legend: Legend,
}

impl Above {
    fn new(title: &str, shading: &Shading, page: &Page) -> Self {
        let mut legend = Legend::new(page);
        for (color, words) in shading.legend() {
            legend.add(Sample::Mark(Mark::Square(color)), Label::plain(words));
        }
        Self { heading: page.heading(title, None), legend }
    }

    /// Where the frame begins.
    fn bottom(&self) -> f64 {
        self.heading.bottom + self.legend.height() + 6.0
    }

    /// A page for a frame of this height, with what stands above it.
    fn begin(&self, says: String, height: f64, page: &Page) -> Scene {
        let mut scene = Scene::new(page.width(), self.bottom() + height + BELOW + MARGIN, says);
        self.heading.draw(&mut scene);
        self.legend.draw(&mut scene, self.heading.bottom);
        scene
    }
}

fn frame(shading: &Shading, top: f64, height: f64, page: &Page) -> Rect {
    Rect { left: LEFT, top, right: page.right() - beside(shading), bottom: top + height }
}

/// The width that a bar of colours needs.
fn beside(shading: &Shading) -> f64 {
    if matches!(shading.shades(), Shades::Range(_)) { BAR.iter().sum() } else { 0.0 }
}

/// Axes and the bar of colours, over what they measure.
fn finish(scene: &mut Scene, axes: &Axes, shading: &Shading, titles: [&Label; 2]) {
    axes.draw(scene, titles[0], titles[1]);
    draw_bar(scene, axes.frame, shading);
}

/// The bar of colours to the right of a frame.
fn draw_bar(scene: &mut Scene, frame: Rect, shading: &Shading) {
    let Shades::Range(range) = *shading.shades() else { return };
    let Rect { right, top, bottom, .. } = frame;
    let bar = Rect { left: right + BAR[1], top, right: right + BAR[1] + BAR[0], bottom };
    let steps = 256;
    let colors = (0..steps).rev().flat_map(|k| rgba(shade(k as f64 / (steps - 1) as f64)));
    scene.picture(bar, Picture { width: 1, height: steps, rgba: colors.collect() });
    scene.area(&corners(bar), None, Some(FRAME));
    let scale = Axes::new(bar, [0.0, 1.0], range);
    let ticks = Ticks::even(range, bar.height() / 38.0, Room::Beside);
    let mut widest = 0.0_f64;
    for (place, label) in &ticks.labelled {
        let [_, y] = scale.at([1.0, *place]);
        scene.line(&[[bar.right, y], [bar.right + 3.0, y]], FRAME);
        widest = widest.max(label.width(TICK_SIZE));
        scene.text(label, [bar.right + 5.5, y + 0.5 * CAP_HEIGHT * TICK_SIZE], Anchor::Start, TICK_SIZE);
    }
    let beside = [bar.right + 5.5 + widest + 6.0 + CAP_HEIGHT * TEXT_SIZE, 0.5 * (top + bottom)];
    scene.text_in(&ticks.titled(shading.title()), beside, Anchor::Middle, TEXT_SIZE, INK, true);
}

fn corners(r: Rect) -> [[f64; 2]; 4] {
    [[r.left, r.top], [r.right, r.top], [r.right, r.bottom], [r.left, r.bottom]]
}

fn rgba(color: Color) -> [u8; 4] {
    let [r, g, b] = color.rgb;
    [r, g, b, 255]
}

/// A dot a row, those without an answer first. Many are one picture.
fn dots(scene: &mut Scene, axes: &Axes, places: &[[f64; 2]], shading: &Shading) {
    let mut order: Vec<usize> = (0..places.len()).filter(|k| places[*k].iter().all(|v| v.is_finite())).collect();
    order.sort_by_key(|k| shading.is_answered(*k));
    let radius = (60.0 / (order.len().max(1) as f64).sqrt()).clamp(0.8, 2.2);
    if order.len() <= MOST_DOTS {
        for k in order {
            scene.dot(axes.at(places[k]), radius, shading.color(k));
        }
        return;
    }
    let Rect { left, top, .. } = axes.frame;
    let size = |points: f64| whole(points * FINE).max(1);
    let (width, height) = (size(axes.frame.width()), size(axes.frame.height()));
    let mut colors = vec![0; 4 * width * height];
    let reach = (radius * FINE).max(1.0);
    for k in order {
        let [x, y] = axes.at(places[k]);
        let (x, y) = ((x - left) * FINE, (y - top) * FINE);
        let color = rgba(shading.color(k));
        for row in whole(y - reach)..=whole(y + reach).min(height - 1) {
            for column in whole(x - reach)..=whole(x + reach).min(width - 1) {
                if (column as f64 + 0.5 - x).hypot(row as f64 + 0.5 - y) <= reach {
                    let at = 4 * (row * width + column);
                    colors[at..at + 4].copy_from_slice(&color);
                }
            }
        }
    }
    scene.picture(axes.frame, Picture { width, height, rgba: colors });
}

/// A place on a picture as the number of its cell.
fn whole(value: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates, as meant")]
    let whole = value.max(0.0).floor() as usize;
    whole
}

/// Rows that are every combination of some columns and some lines.
struct Cells {
    /// Sorted values across and up.
    values: [Vec<f64>; 2],
    /// The row at each, across first.
    rows: Vec<usize>,
}

impl Cells {
    /// `None` where rows are no grid of at least two by two.
    fn of(places: &[[f64; 2]]) -> Option<Self> {
        let values = [0, 1].map(|k| {
            let mut values: Vec<f64> = places.iter().map(|p| p[k]).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        });
        let [columns, lines] = [values[0].len(), values[1].len()];
        if columns < 2 || lines < 2 || columns.checked_mul(lines)? != places.len() {
            return None;
        }
        let mut rows = vec![usize::MAX; places.len()];
        for (row, place) in places.iter().enumerate() {
            let at = |k: usize| values[k].binary_search_by(|v| v.total_cmp(&place[k])).ok();
            rows[at(1)? * columns + at(0)?] = row;
        }
        rows.iter().all(|row| *row != usize::MAX).then_some(Self { values, rows })
    }

    /// The values at the outer edges of the outermost cells.
    fn ranges(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|k| {
            let v = &self.values[k];
            let last = v.len() - 1;
            [v[0] - 0.5 * (v[1] - v[0]), v[last] + 0.5 * (v[last] - v[last - 1])]
        })
    }

    /// Whether values are at even distances, to what a picture shows.
    fn is_even(&self, k: usize) -> bool {
        let v = &self.values[k];
        let step = (v[v.len() - 1] - v[0]) / (v.len() - 1) as f64;
        v.windows(2).all(|pair| (pair[1] - pair[0] - step).abs() < 0.02 * step)
    }

    /// For each cell of a picture across or up, which value is nearest.
    fn nearest(&self, k: usize) -> Vec<usize> {
        let v = &self.values[k];
        if self.is_even(k) {
            return (0..v.len()).collect();
        }
        let [from, to] = self.ranges()[k];
        let at = |cell: usize| from + (cell as f64 + 0.5) / UNEVEN as f64 * (to - from);
        let near = |place: f64| v.windows(2).take_while(|pair| 0.5 * (pair[0] + pair[1]) < place).count();
        (0..UNEVEN).map(|cell| near(at(cell))).collect()
    }

    fn picture(&self, shading: &Shading) -> Picture {
        let [columns, lines] = [0, 1].map(|k| self.nearest(k));
        let row = |line: usize, column: usize| self.rows[line * self.values[0].len() + column];
        let colors = lines
            .iter()
            .rev()
            .flat_map(|line| columns.iter().flat_map(|column| rgba(shading.color(row(*line, *column)))));
        Picture { width: columns.len(), height: lines.len(), rgba: colors.collect() }
    }
}

/// A number with its unit, for a title.
///
/// ```
/// let axis = hydrostat_figures::Abscissa { name: "flow.speed".to_owned(), unit: "cm/s".to_owned(), per_si: 100.0 };
/// assert_eq!(hydrostat_figures::value_text(&axis, 0.5), "flow.speed = 50 cm/s");
/// ```
pub fn value_text(axis: &Abscissa, value: f64) -> String {
    let number = short(value * axis.per_si);
    format!("{} = {number} {}", axis.name, axis.unit).trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_are_found_in_any_order() {
        let places = [[1.0, 5.0], [0.0, 5.0], [1.0, 7.0], [0.0, 7.0]];
        let cells = Cells::of(&places).unwrap();
        assert_eq!(cells.rows, [1, 0, 3, 2]);
        assert_eq!(cells.ranges(), [[-0.5, 1.5], [4.0, 8.0]]);
        assert!(Cells::of(&places[..3]).is_none());
        assert!(Cells::of(&[[0.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 0.0]]).is_none());
        let uneven = Cells::of(&[[0.0, 0.0], [1.0, 0.0], [10.0, 0.0], [0.0, 1.0], [1.0, 1.0], [10.0, 1.0]]).unwrap();
        let nearest = uneven.nearest(0);
        assert_eq!((nearest.len(), nearest[0], nearest[UNEVEN - 1]), (UNEVEN, 0, 2));
        assert!(!uneven.is_even(0) && uneven.is_even(1));
    }
}
