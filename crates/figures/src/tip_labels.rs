//! Labels of several arms, each at its tip.

use crate::arm_figure::place_label;
use crate::axes::TEXT_SIZE;
use crate::font::{CAP_HEIGHT, Label};
use crate::palette::{Color, INK};
use crate::placement::{Occupied, Rect};
use crate::scene::{Anchor, Point, Scene, Stroke};

const LINE: f64 = 13.0;

/// What is written at a tip.
pub(crate) struct TipLabel {
    pub(crate) tip: Point,
    /// The direction in which it had best stand, rad.
    pub(crate) towards: f64,
    pub(crate) color: Color,
    pub(crate) label: Label,
}

/// A dot on every tip, and the labels beside them; one below the other in a free corner where tips are crowded.
pub(crate) fn draw_tip_labels(scene: &mut Scene, page: &mut Occupied, frame: Rect, labels: &[TipLabel]) {
    if !(crowded(labels) && in_column(scene, page, frame, labels)) {
        label_at_tips(scene, page, labels);
    }
}

/// A dot on every tip, and each label at the free place next to it.
pub(crate) fn label_at_tips(scene: &mut Scene, page: &mut Occupied, labels: &[TipLabel]) {
    dots(scene, labels);
    for TipLabel { tip, towards, color, label } in labels {
        place_label(scene, page, label, color.towards(INK, 0.25), *tip, *towards);
    }
}

fn dots(scene: &mut Scene, labels: &[TipLabel]) {
    for TipLabel { tip, color, .. } in labels {
        scene.dot(*tip, 1.6, *color);
    }
}

/// Whether labels beside the tips would be in each other's way.
fn crowded(labels: &[TipLabel]) -> bool {
    let apart = |a: Point, b: Point| (a[0] - b[0]).hypot(a[1] - b[1]);
    labels.windows(2).any(|w| apart(w[0].tip, w[1].tip) < 2.0 * TEXT_SIZE)
}

/// Labels one below the other in the upper right corner, joined to their tips by lines that do not
/// cross. Draws nothing and says so if that corner is not free.
fn in_column(scene: &mut Scene, page: &mut Occupied, frame: Rect, labels: &[TipLabel]) -> bool {
    const INSET: f64 = 6.0;
    let widest = labels.iter().map(|l| l.label.width(TEXT_SIZE)).fold(0.0, f64::max);
    let height = LINE * labels.len() as f64;
    let (top, right) = (frame.top + INSET, frame.right - INSET);
    let column = Rect { left: right - widest, top, right, bottom: top + height };
    if !page.is_free(&column) {
        return false;
    }
    dots(scene, labels);
    let mut order: Vec<&TipLabel> = labels.iter().collect();
    order.sort_by(|a, b| a.tip[1].total_cmp(&b.tip[1]));
    for (row, TipLabel { tip, color, label, .. }) in order.into_iter().enumerate() {
        let middle = column.top + LINE * (row as f64 + 0.5);
        let leader = [*tip, [column.left - 3.0, middle]];
        scene.line(&leader, Stroke::solid(*color, 0.4));
        page.add_line(&leader);
        let baseline = middle + 0.5 * CAP_HEIGHT * TEXT_SIZE;
        scene.text_in(label, [column.left, baseline], Anchor::Start, TEXT_SIZE, color.towards(INK, 0.25), false);
    }
    page.add_box(column);
    true
}
