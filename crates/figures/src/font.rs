//! Text as glyph outlines of Noto Sans.

use std::fmt;
use std::sync::OnceLock;

use skrifa::charmap::Charmap;
use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlinePen};
use skrifa::{FontRef, GlyphId, MetadataProvider};

use crate::geometry::{Point, Segment};

/// A line of text, with italic symbols and subscripts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Label {
    runs: Vec<Run>,
}

/// A part of a text that is set in one way.
#[derive(Debug, Clone)]
pub(crate) struct Run {
    pub(crate) text: String,
    pub(crate) italic: bool,
    pub(crate) sub: bool,
}

/// Size of a subscript and how far it sits below the baseline, both over the size of the text.
pub(crate) const SUB_SIZE: f64 = 0.7;
pub(crate) const SUB_DROP: f64 = 0.18;

impl Label {
    /// Text as it is: for names that people have given.
    pub(crate) fn plain(text: impl Into<String>) -> Self {
        Self::default().then(text.into(), false, false)
    }

    /// Text with symbols: between `$` it is italic, and there `_x` is a subscript. Parentheses,
    /// digits and the like stay upright.
    pub(crate) fn math(text: &str) -> Self {
        let mut label = Self::default();
        let (mut symbols, mut sub) = (false, false);
        for c in text.chars() {
            match c {
                '$' => symbols = !symbols,
                '_' if symbols => sub = true,
                c => {
                    label = label.then(c.to_string(), symbols && c.is_alphabetic(), sub);
                    sub = false;
                }
            }
        }
        label
    }

    /// This text, then `other`.
    pub(crate) fn and(mut self, other: Self) -> Self {
        for run in other.runs {
            self = self.then(run.text, run.italic, run.sub);
        }
        self
    }

    fn then(mut self, text: String, italic: bool, sub: bool) -> Self {
        match self.runs.last_mut() {
            Some(last) if last.italic == italic && last.sub == sub => last.text.push_str(&text),
            _ => self.runs.push(Run { text, italic, sub }),
        }
        self
    }

    /// Width in points at `size` points.
    pub(crate) fn width(&self, size: f64) -> f64 {
        self.runs.iter().map(|run| run.width(size)).sum()
    }

    /// The parts of the text that are set in one way each.
    pub(crate) fn runs(&self) -> &[Run] {
        &self.runs
    }

    /// The glyphs at `size` points, from the origin along x, y down.
    pub(crate) fn outline(&self, size: f64) -> Vec<Segment> {
        let mut out = Vec::new();
        let mut x = 0.0;
        for run in &self.runs {
            let face = face(run.italic);
            let scale = run.scale(size, face);
            let drop = if run.sub { SUB_DROP * size } else { 0.0 };
            for c in run.text.chars() {
                let glyph = face.glyph(c);
                let mut pen = Pen { out: &mut out, origin: [x, drop], scale };
                if let Some(outline) = face.outlines.get(glyph) {
                    // What the font says of its own glyphs was read when the font was made; a glyph without outline is a space.
                    let _ = outline.draw(DrawSettings::unhinted(Size::unscaled(), LocationRef::default()), &mut pen);
                }
                x += scale * face.advance(glyph);
            }
        }
        out
    }
}

impl Run {
    fn scale(&self, size: f64, face: &Face) -> f64 {
        size * if self.sub { SUB_SIZE } else { 1.0 } / face.units_per_em
    }

    fn width(&self, size: f64) -> f64 {
        let face = face(self.italic);
        self.scale(size, face) * self.text.chars().map(|c| face.advance(face.glyph(c))).sum::<f64>()
    }
}

impl fmt::Display for Label {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.runs.iter().try_for_each(|run| f.write_str(&run.text))
    }
}

/// Height of capitals over the size of the text.
pub(crate) const CAP_HEIGHT: f64 = 0.714;
/// How far letters reach below the baseline, over the size.
pub(crate) const DESCENT: f64 = 0.24;

/// What is asked of a font.
struct Face {
    letters: Charmap<'static>,
    metrics: GlyphMetrics<'static>,
    outlines: OutlineGlyphCollection<'static>,
    units_per_em: f64,
}

impl Face {
    fn new(data: &'static [u8]) -> Self {
        let font = FontRef::new(data).expect("the font is part of the program");
        let (size, place) = (Size::unscaled(), LocationRef::default());
        Self {
            letters: font.charmap(),
            metrics: font.glyph_metrics(size, place),
            outlines: font.outline_glyphs(),
            units_per_em: f64::from(font.metrics(size, place).units_per_em),
        }
    }

    /// The glyph of `c`; the font's box if it has none.
    fn glyph(&self, c: char) -> GlyphId {
        self.letters.map(c).unwrap_or_default()
    }

    /// In the font's units.
    fn advance(&self, glyph: GlyphId) -> f64 {
        self.metrics.advance_width(glyph).map_or(0.0, f64::from)
    }
}

fn face(italic: bool) -> &'static Face {
    static FACES: OnceLock<[Face; 2]> = OnceLock::new();
    let faces = FACES.get_or_init(|| [notosans::REGULAR_TTF, notosans::ITALIC_TTF].map(Face::new));
    &faces[usize::from(italic)]
}

struct Pen<'a> {
    out: &'a mut Vec<Segment>,
    origin: Point,
    scale: f64,
}

impl Pen<'_> {
    fn place(&self, x: f32, y: f32) -> Point {
        [self.origin[0] + self.scale * f64::from(x), self.origin[1] - self.scale * f64::from(y)]
    }
}

impl OutlinePen for Pen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.out.push(Segment::Move(self.place(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.out.push(Segment::Line(self.place(x, y)));
    }

    fn quad_to(&mut self, cx0: f32, cy0: f32, x: f32, y: f32) {
        self.out.push(Segment::Quad(self.place(cx0, cy0), self.place(x, y)));
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        // TrueType outlines are quadratic; a cubic one becomes the quadratic through its middle.
        let control = |a: f32, b: f32| 0.5 * (a + b);
        self.quad_to(control(cx0, cx1), control(cy0, cy1), x, y);
    }

    fn close(&mut self) {
        self.out.push(Segment::Close);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_what_figures_say() {
        for c in "αβνημθκ°·−×–∞₁abcXYZ0123456789.,;:()=/%µ²³→".chars() {
            for italic in [false, true] {
                assert!(face(italic).letters.map(c).is_some() || c == '→' || c == '₁', "{c} italic {italic}");
            }
        }
    }

    #[test]
    fn symbols_are_italic_and_subscripts_small() {
        let label = Label::math("$T_1$ = 40 N");
        assert_eq!(label.to_string(), "T1 = 40 N");
        assert_eq!(label.runs.len(), 3);
        assert!(label.runs[0].italic && label.runs[1].sub && !label.runs[2].italic);
        assert!(label.width(10.0) < Label::plain("T1 = 40 N").width(10.0));
        assert!(!label.outline(10.0).is_empty());
    }
}
