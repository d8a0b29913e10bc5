//! A quantity of the arm over a load that rises and falls: the way there, the way back, and the snaps.

use hydrostat::{Configuration, LoadingSnap};

use crate::arm_figure::place_label;
use crate::chart::{Abscissa, frame, smooth};
use crate::font::Label;
use crate::legend::{Legend, Mark, Sample};
use crate::page::Page;
use crate::palette::{GREY, INK, series};
use crate::placement::Occupied;
use crate::quantity::{Posed, Quantity};
use crate::scene::{Scene, Stroke};

/// More labels than this would hide what they mean.
const MOST_LABELS: usize = 8;

/// An equilibrium of a sequence of loads: in the plane, or with [`hydrostat::SpatialConfiguration`] in space.
#[derive(Debug, Clone)]
pub struct LoadingPoint<'a, C: Posed = Configuration> {
    /// The load, SI.
    pub value: f64,
    /// The equilibrium.
    pub configuration: &'a C,
    /// The snaps since the point before, with the load at each, SI.
    pub snaps: Vec<(f64, LoadingSnap<C::Tip>)>,
}

/// A part of the way in one direction.
struct Piece {
    rises: bool,
    points: Vec<[f64; 2]>,
}

/// `quantity` over a load: a line where the load rises, a broken one where it falls, and an arrow for each snap, with
/// the load at it.
///
/// ```
/// use hydrostat::{Arm, Loading};
/// use hydrostat_figures::{Abscissa, LoadingPoint, Page, Quantity, loading_figure};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// let (mut loading, first) = Loading::start(&arm, 1e-6)?;
/// arm.tip.force = [0.0, 0.01]; // N
/// let then = loading.go_to(&arm)?;
/// let at = |value, configuration| LoadingPoint { value, configuration, snaps: Vec::new() };
/// let points = [at(0.0, &first.configuration), at(0.01, &then.configuration)];
/// let over = Abscissa { name: "force".to_owned(), unit: "mN".to_owned(), per_si: 1e3 };
/// let figure = loading_figure(&points, &over, Quantity::TipY, "a cone", &Page::default());
/// assert!(figure.texts().any(|text| text == "load rises"));
/// # Ok::<(), hydrostat::LoadingError>(())
/// ```
pub fn loading_figure<C: Posed>(
    points: &[LoadingPoint<'_, C>],
    over: &Abscissa,
    quantity: Quantity,
    title: &str,
    page: &Page,
) -> Scene {
    let at = |value: f64, shown: f64| [over.per_si * value, shown];
    let of_tip = |tip: C::Tip, else_of: &C| C::of_tip(quantity, &tip).unwrap_or_else(|| quantity.of(else_of));
    let mut pieces: Vec<Piece> = Vec::new();
    let mut jumps: Vec<([[f64; 2]; 2], f64)> = Vec::new();
    let mut last: Option<(&LoadingPoint<'_, C>, [f64; 2])> = None;
    for point in points {
        let end = at(point.value, quantity.of(point.configuration));
        if let Some((before, start)) = last {
            let rises = point.value >= before.value;
            let mut from = start;
            for (value, snap) in &point.snaps {
                let ends = [snap.before, snap.after].map(|tip| at(*value, of_tip(tip, before.configuration)));
                go(&mut pieces, rises, from, ends[0]);
                jumps.push((ends, *value));
                from = ends[1];
            }
            go(&mut pieces, rises, from, end);
        }
        last = Some((point, end));
    }
    let all: Vec<[f64; 2]> = pieces.iter().flat_map(|piece| piece.points.iter().copied()).collect();

    let mut legend = Legend::new(page);
    for (rises, words) in [(true, "load rises"), (false, "load falls")] {
        if pieces.iter().any(|piece| piece.rises == rises) {
            legend.add(Sample::Line(stroke(rises)), Label::plain(words));
        }
    }
    if !jumps.is_empty() {
        legend.add(Sample::Line(Stroke::solid(GREY, 1.0)), Label::plain("the arm snaps"));
    }
    let (mut scene, axes) = frame(title, &legend, &all, over, quantity, page);
    let mut occupied = Occupied::new(axes.frame.grown(-3.0));
    for ([from, to], _) in &jumps {
        let [from, to] = [axes.at(*from), axes.at(*to)];
        scene.arrow(from, to, GREY, 1.0);
        occupied.add_line(&[from, to]);
    }
    for wanted in [true, false] {
        for piece in pieces.iter().filter(|piece| piece.rises == wanted) {
            let mut line = Vec::new();
            for part in smooth(&axes.all(&piece.points)) {
                line.extend(part.into_iter().skip(usize::from(!line.is_empty())));
            }
            scene.line(&line, stroke(wanted));
            occupied.add_line(&line);
        }
    }
    for ([from, _], _) in &jumps {
        Mark::Filled(INK).draw(&mut scene, axes.at(*from));
    }
    if jumps.len() <= MOST_LABELS {
        for ([from, _], value) in &jumps {
            place_label(&mut scene, &mut occupied, &Label::plain(over.text(*value)), INK, axes.at(*from), 0.0);
        }
    }
    scene
}

fn stroke(rises: bool) -> Stroke {
    if rises { Stroke::solid(series(1), 1.4) } else { Stroke::dashed(series(0), 1.4, [4.0, 3.0]) }
}

/// Goes on to `to`, in the piece before where that ends at `from` and has the same direction.
fn go(pieces: &mut Vec<Piece>, rises: bool, from: [f64; 2], to: [f64; 2]) {
    match pieces.last_mut() {
        Some(piece) if piece.rises == rises && piece.points.last() == Some(&from) => piece.points.push(to),
        _ => pieces.push(Piece { rises, points: vec![from, to] }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_end_where_the_load_turns_and_where_the_arm_snaps() {
        let mut pieces = Vec::new();
        go(&mut pieces, true, [0.0, 0.0], [1.0, 1.0]);
        go(&mut pieces, true, [1.0, 1.0], [2.0, 2.0]);
        go(&mut pieces, true, [2.0, 5.0], [3.0, 6.0]);
        go(&mut pieces, false, [3.0, 6.0], [2.0, 5.0]);
        let lengths: Vec<(bool, usize)> = pieces.iter().map(|piece| (piece.rises, piece.points.len())).collect();
        assert_eq!(lengths, [(true, 3), (true, 2), (false, 2)]);
    }
}
