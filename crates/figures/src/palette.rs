//! Colours that stay apart for colour-blind readers and in grey.

/// Red, green, blue and opacity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Color {
    pub(crate) rgb: [u8; 3],
    /// 0 (invisible) to 1.
    pub(crate) opacity: f64,
}

const fn rgb(r: u8, g: u8, b: u8) -> Color {
    Color { rgb: [r, g, b], opacity: 1.0 }
}

impl Color {
    pub(crate) const fn with_opacity(self, opacity: f64) -> Self {
        Self { rgb: self.rgb, opacity }
    }

    /// The colour between this one (`fraction` 0) and `other` (`fraction` 1).
    pub(crate) fn towards(self, other: Self, fraction: f64) -> Self {
        let mut mixed = self;
        for (own, other) in mixed.rgb.iter_mut().zip(other.rgb) {
            let value = f64::from(*own) + fraction.clamp(0.0, 1.0) * (f64::from(other) - f64::from(*own));
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two bytes")]
            let byte = value.round() as u8;
            *own = byte;
        }
        mixed
    }
}

/// What everything is drawn on.
pub(crate) const PAPER: Color = rgb(255, 255, 255);
/// Text and axes: softer than black on white.
pub(crate) const INK: Color = rgb(38, 38, 38);
/// What should step back.
pub(crate) const GREY: Color = rgb(120, 120, 120);
/// The body of an arm.
pub(crate) const BODY: Color = rgb(205, 213, 220);
/// The stream.
pub(crate) const WATER: Color = rgb(0, 114, 178);

/// The palette of Okabe and Ito without its yellow, which is too light for lines.
pub(crate) const SERIES: [Color; 7] = [
    rgb(213, 94, 0),
    rgb(0, 114, 178),
    rgb(0, 158, 115),
    rgb(204, 121, 167),
    rgb(230, 159, 0),
    rgb(86, 180, 233),
    rgb(60, 60, 60),
];

/// The colour of member `index` of a series: behind the last colour they come again, darker and then paler.
pub(crate) fn series(index: usize) -> Color {
    let own = SERIES[index % SERIES.len()];
    match index / SERIES.len() % 3 {
        0 => own,
        1 => own.towards(rgb(0, 0, 0), 0.5),
        _ => own.towards(PAPER, 0.5),
    }
}

/// The colour of step `index` of `count` ordered ones: from pale to dark, through blue and purple,
/// falling steadily in lightness.
pub(crate) fn ordered(index: usize, count: usize) -> Color {
    shade(if count < 2 { 1.0 } else { index as f64 / (count - 1) as f64 })
}

/// Colours of fractions from 0 to 1 at equal distances.
const STOPS: [Color; 5] = [rgb(232, 158, 60), rgb(214, 96, 77), rgb(172, 52, 104), rgb(104, 32, 112), rgb(34, 20, 74)];

/// The colours of all figures, red, green and blue, for whoever draws beside them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Palette {
    /// Of cables and of whatever else is told apart.
    pub series: [[u8; 3]; 7],
    /// Of fractions from 0 to 1 at equal distances; what is between is mixed.
    pub shades: [[u8; 3]; 5],
    /// The body of an arm.
    pub body: [u8; 3],
    /// The stream.
    pub water: [u8; 3],
}

/// The colours of all figures.
///
/// ```
/// assert_eq!(hydrostat_figures::palette().series[0], [213, 94, 0]);
/// ```
pub fn palette() -> Palette {
    Palette { series: SERIES.map(|c| c.rgb), shades: STOPS.map(|c| c.rgb), body: BODY.rgb, water: WATER.rgb }
}

/// The colour of a fraction from 0 to 1.
pub(crate) fn shade(fraction: f64) -> Color {
    let place = fraction.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the stops")]
    let at = (place.floor() as usize).min(STOPS.len() - 2);
    STOPS[at].towards(STOPS[at + 1], place - at as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Load cases 1 and 8 of a fit had one colour.
    #[test]
    fn members_of_a_series_of_twenty_one_have_colours_of_their_own() {
        let colours: Vec<[u8; 3]> = (0..21).map(|index| series(index).rgb).collect();
        for (i, one) in colours.iter().enumerate() {
            for other in &colours[..i] {
                let apart: u32 = one.iter().zip(other).map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
                assert!(apart > 40, "{one:?} and {other:?}");
            }
        }
    }
}
