//! A scene as SVG.

use std::fmt::Write as _;

use crate::font::{SUB_DROP, SUB_SIZE};
use crate::palette::Color;
use crate::placement::Rect;
use crate::scene::{Anchor, Item, Picture, Scene, Segment, Text};

/// How text is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Letters {
    Outlines,
    Text,
}

impl Scene {
    /// The figure as an SVG document. Text is drawn as outlines and named in `aria-label`, so that
    /// it looks the same everywhere and can still be read and searched.
    pub fn svg(&self) -> String {
        self.written(Letters::Outlines)
    }

    /// [`Scene::svg`] with text as text, for whoever wants to change words or fonts. It is shown in Noto Sans where that is
    /// installed and in another font without serifs elsewhere, whose letters may be wider than the place that was kept for them.
    ///
    /// ```
    /// let configuration = hydrostat::Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5).solve().unwrap();
    /// let figure = hydrostat_figures::arm_figure(&configuration, None, &hydrostat_figures::Page::default());
    /// assert!(figure.svg_with_text().contains(" (mm)</text>") && !figure.svg().contains("<text"));
    /// ```
    pub fn svg_with_text(&self) -> String {
        self.written(Letters::Text)
    }

    fn written(&self, letters: Letters) -> String {
        let [w, h] = [number(self.width), number(self.height)];
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}pt\" height=\"{h}pt\" viewBox=\"0 0 {w} {h}\" \
             role=\"img\">\n<title>{}</title>\n<rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n",
            escaped(&self.title)
        );
        for item in &self.items {
            match &item.text {
                Some(text) if letters == Letters::Text => write_text(&mut out, text, item.fill),
                _ => write_item(&mut out, item),
            }
        }
        out.push_str("</svg>\n");
        out
    }
}

fn write_item(out: &mut String, item: &Item) {
    if let Some((place, picture)) = &item.picture {
        write_picture(out, *place, picture);
        return;
    }
    out.push_str("<path");
    if let Some(text) = &item.text {
        let _ = write!(out, " role=\"text\" aria-label=\"{}\"", escaped(&text.says));
    }
    match item.fill {
        Some(color) => paint(out, "fill", color),
        None => out.push_str(" fill=\"none\""),
    }
    if let Some(stroke) = item.stroke {
        paint(out, "stroke", stroke.color);
        let _ = write!(out, " stroke-width=\"{}\" stroke-linejoin=\"round\"", number(stroke.width));
        match stroke.dash {
            Some([dash, gap]) => {
                let _ = write!(out, " stroke-dasharray=\"{} {}\"", number(dash), number(gap));
            }
            None => out.push_str(" stroke-linecap=\"round\""),
        }
    }
    out.push_str(" d=\"");
    for segment in &item.path {
        match segment {
            Segment::Move([x, y]) => {
                let _ = write!(out, "M{} {}", number(*x), number(*y));
            }
            Segment::Line([x, y]) => {
                let _ = write!(out, "L{} {}", number(*x), number(*y));
            }
            Segment::Quad([cx, cy], [x, y]) => {
                let _ = write!(out, "Q{} {} {} {}", number(*cx), number(*cy), number(*x), number(*y));
            }
            Segment::Close => out.push('Z'),
        }
    }
    out.push_str("\"/>\n");
}

/// Text as text, with italics and subscripts.
fn write_text(out: &mut String, text: &Text, fill: Option<Color>) {
    let [x, y] = text.at.map(number);
    let _ = write!(
        out,
        "<text x=\"{x}\" y=\"{y}\" font-family=\"'Noto Sans', sans-serif\" font-size=\"{}\"",
        number(text.size)
    );
    match text.anchor {
        Anchor::Start => {}
        Anchor::Middle => out.push_str(" text-anchor=\"middle\""),
        Anchor::End => out.push_str(" text-anchor=\"end\""),
    }
    if let Some(color) = fill {
        paint(out, "fill", color);
    }
    if text.upright {
        let _ = write!(out, " transform=\"rotate(-90 {x} {y})\"");
    }
    out.push_str(" xml:space=\"preserve\">");
    // What `dy` moves down stays down.
    let mut down = 0.0;
    for run in text.label.runs() {
        let wanted = if run.sub { SUB_DROP * text.size } else { 0.0 };
        let mut how = String::new();
        if run.italic {
            how.push_str(" font-style=\"italic\"");
        }
        if run.sub {
            let _ = write!(how, " font-size=\"{}\"", number(SUB_SIZE * text.size));
        }
        if wanted != down {
            let _ = write!(how, " dy=\"{}\"", number(wanted - down));
            down = wanted;
        }
        let letters = escaped(&run.text);
        let _ = if how.is_empty() { write!(out, "{letters}") } else { write!(out, "<tspan{how}>{letters}</tspan>") };
    }
    out.push_str("</text>\n");
}

/// Cells as a PNG inside the document.
fn write_picture(out: &mut String, place: Rect, picture: &Picture) {
    // What cannot be encoded has no size, and nothing to show.
    let Ok(bytes) = picture.png() else { return };
    let [x, y, w, h] = [place.left, place.top, place.width(), place.height()].map(number);
    let _ = writeln!(
        out,
        "<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" preserveAspectRatio=\"none\" \
         style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>",
        base64(&bytes)
    );
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |k: usize| u32::from(three.get(k).copied().unwrap_or_default());
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * k) & 63) as usize];
            out.push(if k <= three.len() { char::from(letter) } else { '=' });
        }
    }
    out
}

fn paint(out: &mut String, what: &str, color: Color) {
    let [r, g, b] = color.rgb;
    let _ = write!(out, " {what}=\"#{r:02x}{g:02x}{b:02x}\"");
    if color.opacity < 1.0 {
        let _ = write!(out, " {what}-opacity=\"{}\"", number(color.opacity));
    }
}

/// A hundredth of a point is finer than any print.
fn number(value: f64) -> String {
    let mut text = format!("{value:.2}");
    if text.contains('.') {
        text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
    }
    if text == "-0" { "0".to_owned() } else { text }
}

fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // XML has no way to write most control characters.
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(number(12.0), "12");
        assert_eq!(number(0.125_4), "0.13");
        assert_eq!(number(-0.001), "0");
        assert_eq!(number(100.5), "100.5");
    }

    #[test]
    fn bytes_become_letters() {
        for (bytes, letters) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(base64(bytes.as_bytes()), letters);
        }
    }

    #[test]
    fn text_is_escaped() {
        assert_eq!(escaped("a<b & \"c\"\u{7}"), "a&lt;b &amp; &quot;c&quot; ");
    }
}
