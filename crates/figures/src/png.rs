//! A scene as PNG.

use tiny_skia::{
    FillRule, FilterQuality, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, PixmapPaint, StrokeDash, Transform,
};

use crate::palette::Color;
use crate::placement::Rect;
use crate::scene::{Picture, Scene, Segment};

/// Resolution of the pictures, dots an inch.
const DPI: f64 = 300.0;

/// A picture that could not be made.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
    /// The page has no size, or more pixels than memory.
    #[error("a page of {width} x {height} points cannot be drawn")]
    Size {
        /// Points.
        width: f64,
        /// Points.
        height: f64,
    },
    /// The encoder failed.
    #[error("the picture could not be encoded: {0}")]
    Encode(#[from] png::EncodingError),
}

impl Scene {
    /// The figure as a PNG file of 300 dots an inch.
    ///
    /// # Errors
    /// [`PngError`].
    pub fn png(&self) -> Result<Vec<u8>, PngError> {
        let scale = DPI / 72.0;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates, as meant")]
        let pixels = |points: f64| (points * scale).round() as u32;
        let mut map = Pixmap::new(pixels(self.width), pixels(self.height))
            .ok_or(PngError::Size { width: self.width, height: self.height })?;
        map.fill(tiny_skia::Color::WHITE);
        #[expect(clippy::cast_possible_truncation, reason = "pictures are single precision")]
        let to_pixels = Transform::from_scale(scale as f32, scale as f32);
        for item in &self.items {
            if let Some((place, picture)) = &item.picture {
                draw_picture(&mut map, *place, picture, scale);
            }
            let Some(path) = path(&item.path) else { continue };
            if let Some(color) = item.fill {
                map.fill_path(&path, &paint(color), FillRule::Winding, to_pixels, None);
            }
            if let Some(stroke) = item.stroke {
                let dash = stroke.dash.and_then(|[dash, gap]| StrokeDash::new(vec![single(dash), single(gap)], 0.0));
                let style = tiny_skia::Stroke {
                    width: single(stroke.width),
                    line_cap: if dash.is_some() { LineCap::Butt } else { LineCap::Round },
                    line_join: LineJoin::Round,
                    dash,
                    ..tiny_skia::Stroke::default()
                };
                map.stroke_path(&path, &paint(stroke.color), &style, to_pixels, None);
            }
        }
        encode(&map)
    }
}

impl Picture {
    /// The cells as a PNG file, a pixel each.
    pub(crate) fn png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let size = |cells: usize| u32::try_from(cells).unwrap_or(0);
        let mut out = Vec::new();
        let mut encoder = png::Encoder::new(&mut out, size(self.width), size(self.height));
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgba)?;
        writer.finish()?;
        Ok(out)
    }
}

/// Cells with sharp edges, at `scale` pixels a point.
fn draw_picture(map: &mut Pixmap, place: Rect, picture: &Picture, scale: f64) {
    let size = |cells: usize| u32::try_from(cells).ok();
    let cells = size(picture.width).zip(size(picture.height)).and_then(|(w, h)| Pixmap::new(w, h));
    let Some(mut cells) = cells else { return };
    // Cells are opaque or not there, so that nothing has to be multiplied by an opacity.
    for (own, given) in cells.data_mut().chunks_exact_mut(4).zip(picture.rgba.chunks_exact(4)) {
        if given[3] > 0 {
            own.copy_from_slice(given);
        }
    }
    let across = scale * place.width() / picture.width as f64;
    let down = scale * place.height() / picture.height as f64;
    let to_pixels = Transform::from_row(
        single(across),
        0.0,
        0.0,
        single(down),
        single(scale * place.left),
        single(scale * place.top),
    );
    let paint = PixmapPaint { quality: FilterQuality::Nearest, ..PixmapPaint::default() };
    map.draw_pixmap(0, 0, cells.as_ref(), &paint, to_pixels, None);
}

/// The page is opaque, so three channels say everything.
fn encode(map: &Pixmap) -> Result<Vec<u8>, PngError> {
    let rgb: Vec<u8> = map.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, map.width(), map.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "11811 dots a metre")]
    let per_metre = (DPI / 0.0254).round() as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit: png::Unit::Meter }));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(out)
}

#[expect(clippy::cast_possible_truncation, reason = "pictures are single precision")]
fn single(value: f64) -> f32 {
    value as f32
}

fn paint(color: Color) -> Paint<'static> {
    let [r, g, b] = color.rgb;
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an opacity in [0, 1] as a byte")]
    let opacity = (color.opacity.clamp(0.0, 1.0) * 255.0).round() as u8;
    paint.set_color_rgba8(r, g, b, opacity);
    paint
}

fn path(segments: &[Segment]) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for segment in segments {
        match *segment {
            Segment::Move([x, y]) => builder.move_to(single(x), single(y)),
            Segment::Line([x, y]) => builder.line_to(single(x), single(y)),
            Segment::Quad([cx, cy], [x, y]) => builder.quad_to(single(cx), single(cy), single(x), single(y)),
            Segment::Close => builder.close(),
        }
    }
    builder.finish()
}
