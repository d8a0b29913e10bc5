//! A scene as PDF: one page, vectors throughout, text as outlines with its words beside them.

use pdf_writer::types::{ColorSpaceOperand, LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect as Box, Ref, TextStr};

use crate::palette::Color;
use crate::placement::Rect;
use crate::scene::{Item, Picture, Point, Scene, Segment, Stroke};

/// Of the compressor: 6 of 10, as most programs have it.
const LEVEL: u8 = 6;

impl Scene {
    /// The figure as a PDF file of one page. Text is drawn as outlines, as in SVG; its words are there for readers that read aloud or search.
    ///
    /// ```
    /// let configuration = hydrostat::Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5).solve().unwrap();
    /// let figure = hydrostat_figures::arm_figure(&configuration, None, &hydrostat_figures::Page::default());
    /// assert!(figure.pdf().starts_with(b"%PDF-"));
    /// ```
    pub fn pdf(&self) -> Vec<u8> {
        let mut file = Pdf::new();
        let mut next = Ref::new(1);
        let [catalog, pages, page, contents, about] = [(); 5].map(|()| next.bump());
        let opacities = self.opacities();
        let states: Vec<(String, Ref, f64)> =
            opacities.iter().enumerate().map(|(k, opacity)| (format!("O{k}"), next.bump(), *opacity)).collect();
        let mut cells: Vec<(String, Ref, Ref, &Picture)> = Vec::new();
        for (_, picture) in self.items.iter().filter_map(|item| item.picture.as_ref()) {
            cells.push((format!("P{}", cells.len()), next.bump(), next.bump(), picture));
        }

        let mut top = file.catalog(catalog);
        top.pages(pages).lang(TextStr("en"));
        top.viewer_preferences().display_doc_title(true);
        top.finish();
        file.document_info(about).title(TextStr(&self.title)).producer(TextStr("Hydrostat"));
        file.pages(pages).kids([page]).count(1);
        let mut sheet = file.page(page);
        sheet.parent(pages).contents(contents).media_box(Box::new(0.0, 0.0, single(self.width), single(self.height)));
        let mut resources = sheet.resources();
        let mut known = resources.ext_g_states();
        for (name, id, _) in &states {
            known.pair(Name(name.as_bytes()), *id);
        }
        known.finish();
        let mut objects = resources.x_objects();
        for (name, id, ..) in &cells {
            objects.pair(Name(name.as_bytes()), *id);
        }
        objects.finish();
        resources.finish();
        sheet.finish();
        for (_, id, opacity) in &states {
            let opacity = single(*opacity);
            file.ext_graphics(*id).stroking_alpha(opacity).non_stroking_alpha(opacity);
        }
        for (_, id, mask, picture) in &cells {
            write_cells(&mut file, *id, *mask, picture);
        }

        let drawn = self.drawn(&states, &cells.iter().map(|(name, ..)| name.as_str()).collect::<Vec<_>>());
        let packed = miniz_oxide::deflate::compress_to_vec_zlib(&drawn, LEVEL);
        file.stream(contents, &packed).filter(Filter::FlateDecode);
        file.finish()
    }

    /// All opacities but 1, each once.
    fn opacities(&self) -> Vec<f64> {
        let colors = self.items.iter().flat_map(|item| [item.fill, item.stroke.map(|stroke| stroke.color)]);
        let mut all: Vec<f64> = colors.flatten().map(|color| color.opacity).collect();
        all.push(1.0);
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    fn drawn(&self, states: &[(String, Ref, f64)], pictures: &[&str]) -> Vec<u8> {
        let mut page = Sheet { out: Content::new(), states, opacity: 1.0 };
        // The scene counts from the upper edge.
        page.out.transform([1.0, 0.0, 0.0, -1.0, 0.0, single(self.height)]);
        page.out.set_line_join(LineJoinStyle::RoundJoin);
        page.out.set_fill_color_space(ColorSpaceOperand::DeviceRgb);
        page.out.set_stroke_color_space(ColorSpaceOperand::DeviceRgb);
        let mut pictures = pictures.iter();
        for item in &self.items {
            match &item.picture {
                Some((place, _)) => page.picture(*place, pictures.next().copied().unwrap_or_default()),
                None => page.item(item),
            }
        }
        page.out.finish().to_vec()
    }
}

/// A page that is being filled.
struct Sheet<'a> {
    out: Content,
    states: &'a [(String, Ref, f64)],
    /// As it is set.
    opacity: f64,
}

impl Sheet<'_> {
    fn item(&mut self, item: &Item) {
        if let Some(text) = &item.text {
            let mut mark = self.out.begin_marked_content_with_properties(Name(b"Span"));
            mark.properties().actual_text(TextStr(&text.says));
        }
        if let Some(color) = item.fill {
            self.look_through(color);
            let [r, g, b] = rgb(color);
            self.out.set_fill_rgb(r, g, b);
            self.path(&item.path);
            self.out.fill_nonzero();
        }
        if let Some(stroke) = item.stroke {
            self.stroke(stroke);
            self.path(&item.path);
            self.out.stroke();
        }
        if item.text.is_some() {
            self.out.end_marked_content();
        }
    }

    fn stroke(&mut self, Stroke { color, width, dash }: Stroke) {
        self.look_through(color);
        let [r, g, b] = rgb(color);
        self.out.set_stroke_rgb(r, g, b).set_line_width(single(width));
        match dash {
            Some(dash) => self.out.set_dash_pattern(dash.map(single), 0.0).set_line_cap(LineCapStyle::ButtCap),
            None => self.out.set_dash_pattern([], 0.0).set_line_cap(LineCapStyle::RoundCap),
        };
    }

    fn look_through(&mut self, color: Color) {
        if color.opacity == self.opacity {
            return;
        }
        if let Some((name, ..)) = self.states.iter().find(|(.., opacity)| *opacity == color.opacity) {
            self.out.set_parameters(Name(name.as_bytes()));
            self.opacity = color.opacity;
        }
    }

    fn path(&mut self, path: &[Segment]) {
        let mut at: Point = [0.0; 2];
        for segment in path {
            match *segment {
                Segment::Move(p) => {
                    self.out.move_to(single(p[0]), single(p[1]));
                    at = p;
                }
                Segment::Line(p) => {
                    self.out.line_to(single(p[0]), single(p[1]));
                    at = p;
                }
                Segment::Quad(c, p) => {
                    // PDF knows cubics alone: the same curve.
                    let control = |end: Point| [0, 1].map(|k| single(end[k] + 2.0 / 3.0 * (c[k] - end[k])));
                    let [[ax, ay], [bx, by]] = [control(at), control(p)];
                    self.out.cubic_to(ax, ay, bx, by, single(p[0]), single(p[1]));
                    at = p;
                }
                Segment::Close => {
                    self.out.close_path();
                }
            }
        }
    }

    fn picture(&mut self, place: Rect, name: &str) {
        self.look_through(Color { rgb: [0; 3], opacity: 1.0 });
        // The unit square of a picture stands on its lower edge.
        let (across, up) = (single(place.width()), single(-place.height()));
        self.out.save_state();
        self.out.transform([across, 0.0, 0.0, up, single(place.left), single(place.bottom)]);
        self.out.x_object(Name(name.as_bytes()));
        self.out.restore_state();
    }
}

/// Cells with sharp edges; those that are not there are masked.
fn write_cells(file: &mut Pdf, id: Ref, mask: Ref, picture: &Picture) {
    let size = |cells: usize| i32::try_from(cells).unwrap_or(0);
    let (width, height) = (size(picture.width), size(picture.height));
    let pack = |bytes: Vec<u8>| miniz_oxide::deflate::compress_to_vec_zlib(&bytes, LEVEL);
    let colors = pack(picture.rgba.chunks_exact(4).flat_map(|cell| [cell[0], cell[1], cell[2]]).collect());
    let mut image = file.image_xobject(id, &colors);
    image.filter(Filter::FlateDecode);
    image.width(width).height(height).bits_per_component(8).s_mask(mask);
    image.color_space().device_rgb();
    image.finish();
    let there = pack(picture.rgba.chunks_exact(4).map(|cell| cell[3]).collect());
    let mut image = file.image_xobject(mask, &there);
    image.filter(Filter::FlateDecode);
    image.width(width).height(height).bits_per_component(8);
    image.color_space().device_gray();
    image.finish();
}

fn rgb(color: Color) -> [f32; 3] {
    color.rgb.map(|value| f32::from(value) / 255.0)
}

/// A hundredth of a point is finer than any print, and keeps files short.
#[expect(clippy::cast_possible_truncation, reason = "pictures are single precision")]
fn single(value: f64) -> f32 {
    ((value * 100.0).round() / 100.0) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::font::Label;
    use crate::palette::series;
    use crate::scene::Anchor;

    /// What is drawn on the page of a file.
    fn contents(file: &[u8]) -> String {
        let text = String::from_utf8_lossy(file).into_owned();
        assert!(text.starts_with("%PDF-1.7") && text.trim_end().ends_with("%%EOF"));
        let streams = file.windows(8).enumerate().filter(|(_, w)| *w == b"\nstream\n").map(|(at, _)| at + 8);
        // The page's own is the last.
        let start = streams.max().unwrap();
        String::from_utf8(miniz_oxide::inflate::decompress_to_vec_zlib(&file[start..]).unwrap()).unwrap()
    }

    #[test]
    fn a_page_has_its_lines_words_and_cells() {
        let mut scene = Scene::new(200.0, 100.0, "a title");
        scene.line(&[[10.0, 20.0], [30.0, 40.5]], Stroke::dashed(series(0), 1.5, [3.0, 2.0]));
        scene.area(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], Some(series(1).with_opacity(0.25)), None);
        scene.text(&Label::plain("words"), [50.0, 50.0], Anchor::Start, 8.0);
        let place = Rect { left: 5.0, top: 6.0, right: 15.0, bottom: 26.0 };
        scene.picture(place, Picture { width: 1, height: 1, rgba: vec![1, 2, 3, 255] });
        let file = scene.pdf();
        let drawn = contents(&file);
        assert!(drawn.contains("10 20 m\n30 40.5 l\nS"), "{drawn}");
        assert!(drawn.contains("[3 2] 0 d") && drawn.contains("/O0 gs"), "{drawn}");
        assert!(drawn.contains("/ActualText (words)") && drawn.contains("EMC"), "{drawn}");
        assert!(drawn.contains("10 0 0 -20 5 26 cm\n/P0 Do"), "{drawn}");
        assert_eq!(scene.pdf(), file, "the same again, byte by byte");
        let text = String::from_utf8_lossy(&file).into_owned();
        assert!(text.contains("/MediaBox [0 0 200 100]") && text.contains("(a title)"), "{text}");
    }
}
