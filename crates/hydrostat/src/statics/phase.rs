//! The phases in which loads are raised from the unloaded arm.

/// The phases in which loads are raised from the unloaded arm: first everything but the cables, then
/// the tensions, then the strokes of cables whose length is commanded, then the friction of cables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Phase {
    /// Stream, weight, tip and distributed loads are multiplied by the load fraction; cables are slack.
    Loads,
    /// All other loads are whole; tensions are multiplied by the load fraction.
    Tension,
    /// Loads and given tensions are whole; cables with a commanded stroke are reeled from the strokes that they have
    /// when slack to those commanded, the load fraction being the fraction of that way.
    Stroke,
    /// Loads, tensions and strokes are as without friction; the coefficients of friction are multiplied by the load
    /// fraction.
    Friction,
}

impl Phase {
    /// The name in results: `loads`, `tension`, `stroke` or `friction`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Loads => "loads",
            Self::Tension => "tension",
            Self::Stroke => "stroke",
            Self::Friction => "friction",
        }
    }

    /// The loads that are applied at a load fraction, in a phrase: `62.9 % of the requested tensions, other loads fully
    /// applied`.
    pub fn load_at(self, fraction: f64) -> String {
        let fraction = percent(fraction);
        match self {
            Self::Loads => format!("{fraction} of the stream, weight, tip and distributed loads, cables slack"),
            Self::Tension => format!("{fraction} of the requested tensions, other loads fully applied"),
            Self::Stroke => format!("{fraction} of the way from the strokes of slack cables to the requested strokes"),
            Self::Friction => format!("{fraction} of the friction coefficients of the cables"),
        }
    }
}

/// A fraction as a percentage with three digits. What is below the whole is not rounded to it.
pub(crate) fn percent(fraction: f64) -> String {
    let percent = 100.0 * fraction;
    if percent == 0.0 || !percent.is_finite() {
        return format!("{percent} %");
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 12")]
    let decimals = (2.0 - percent.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let text = (decimals..12)
        .map(|digits| format!("{percent:.digits$}"))
        .find(|text| fraction == 1.0 || text.parse() != Ok(100.0));
    format!("{} %", text.unwrap_or_else(|| percent.to_string()))
}

#[cfg(test)]
mod tests {
    use super::percent;

    #[test]
    fn percentages_have_three_digits() {
        for (fraction, text) in [
            (0.628_841, "62.9 %"),
            (0.0, "0 %"),
            (1.0, "100 %"),
            (0.05, "5.00 %"),
            (1.234e-6, "0.000123 %"),
            (0.999_7, "99.97 %"),
            (0.999_999_99, "99.999999 %"),
        ] {
            assert_eq!(percent(fraction), text);
        }
    }
}
