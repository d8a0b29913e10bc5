//! The page of a figure: its width, and the title above the picture.

use crate::axes::{LEFT, TEXT_SIZE};
use crate::font::{CAP_HEIGHT, Label};
use crate::palette::series;
use crate::scene::{Anchor, Scene};

/// What stays free at the edges of every page, points.
pub(crate) const MARGIN: f64 = 10.0;
/// Between two lines of text.
pub(crate) const LINE: f64 = 14.0;
const TITLE_SIZE: f64 = 10.0;
/// Points of a metre.
const PER_METRE: f64 = 72.0 / 0.0254;

/// How a figure is laid out. Text has the same size on pages of every width.
///
/// ```
/// use hydrostat_figures::{Page, arm_figure};
///
/// let configuration = hydrostat::Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5).solve().unwrap();
/// let column = Page { title: Some("One column".to_owned()), ..Page::of_width(0.085).unwrap() };
/// let figure = arm_figure(&configuration, None, &column);
/// assert!((figure.size()[0] - 240.9).abs() < 0.1 && figure.texts().any(|text| text == "One column"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    /// Points (1/72 inch), within [`Page::WIDTHS`]; what is outside is drawn at the nearer end.
    pub width: f64,
    /// The title in place of the figure's own; an empty one leaves it out.
    pub title: Option<String>,
}

impl Default for Page {
    fn default() -> Self {
        Self { width: 450.0, title: None }
    }
}

impl Page {
    /// The narrowest and the widest page, points: 70 mm and 1 m.
    pub const WIDTHS: [f64; 2] = [0.07 * PER_METRE, PER_METRE];

    /// A page of `width` metres; `None` outside of [`Page::WIDTHS`].
    pub fn of_width(width: f64) -> Option<Self> {
        let [least, most] = Self::WIDTHS;
        let width = width * PER_METRE;
        (least - 1e-6..=most + 1e-6).contains(&width).then(|| Self { width, ..Self::default() })
    }

    /// Points.
    pub(crate) fn width(&self) -> f64 {
        let [least, most] = Self::WIDTHS;
        if self.width.is_finite() { self.width.clamp(least, most) } else { Self::default().width }
    }

    /// The right edge of what is drawn.
    pub(crate) fn right(&self) -> f64 {
        self.width() - MARGIN
    }

    /// The width of a frame with its axis on the left.
    pub(crate) fn across(&self) -> f64 {
        self.right() - LEFT
    }

    /// `size`, or what makes the text fit the page.
    pub(crate) fn fitting(&self, label: &Label, size: f64) -> f64 {
        size.min(size * self.across() / label.width(size).max(1.0))
    }

    /// The title asked for, or `own`.
    pub(crate) fn title_or(&self, own: &str) -> String {
        self.title.clone().unwrap_or_else(|| own.to_owned())
    }

    /// What stands above a figure whose own title is `own`.
    pub(crate) fn heading(&self, own: &str, note: Option<&str>) -> Heading {
        let title = Label::plain(self.title_or(own));
        let mut heading = Heading { lines: Vec::new(), bottom: MARGIN };
        if !title.to_string().trim().is_empty() {
            let baseline = MARGIN + CAP_HEIGHT * TITLE_SIZE;
            heading.lines.push((self.fitting(&title, TITLE_SIZE), baseline, title, false));
            heading.bottom = baseline + 8.0;
        }
        if let Some(note) = note {
            let note = Label::plain(note);
            let above = heading.lines.last().map(|(_, baseline, ..)| baseline + LINE);
            let baseline = above.unwrap_or(MARGIN + CAP_HEIGHT * TEXT_SIZE);
            heading.lines.push((self.fitting(&note, TEXT_SIZE), baseline, note, true));
            heading.bottom = baseline + 8.0;
        }
        heading
    }
}

/// Title and note.
pub(crate) struct Heading {
    /// Size, baseline, text, and whether it is a note.
    lines: Vec<(f64, f64, Label, bool)>,
    /// Where the legend begins.
    pub(crate) bottom: f64,
}

impl Heading {
    pub(crate) fn draw(&self, scene: &mut Scene) {
        for (size, baseline, label, note) in &self.lines {
            let at = [LEFT, *baseline];
            if *note {
                scene.text_in(label, at, Anchor::Start, *size, series(0), false);
            } else {
                scene.text(label, at, Anchor::Start, *size);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_are_bounded() {
        assert!(Page::of_width(0.069).is_none() && Page::of_width(1.1).is_none() && Page::of_width(f64::NAN).is_none());
        assert_eq!(Page::of_width(0.07).unwrap().width(), Page::WIDTHS[0]);
        assert_eq!(Page { width: f64::NAN, title: None }.width(), 450.0);
        assert_eq!(Page { width: -3.0, title: None }.width(), Page::WIDTHS[0]);
    }

    #[test]
    fn an_empty_title_takes_no_room() {
        let without = Page { title: Some(String::new()), ..Page::default() };
        assert_eq!(without.heading("own", None).bottom, MARGIN);
        assert!(without.heading("own", Some("note")).bottom < Page::default().heading("own", Some("note")).bottom);
    }
}
