//! Numbers as people read them.

/// A number with at most four digits that matter.
pub(crate) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 12")]
    let decimals = (3.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// An angle (rad) in degrees.
pub(crate) fn degrees(angle: f64) -> String {
    let value = format!("{:.2}°", angle.to_degrees());
    if value == "-0.00°" { "0.00°".to_owned() } else { value.replace('-', "\u{2212}") }
}

/// The number from `low` to `high` that is shortest to say: 0, else the multiple nearest to the middle of the largest step among
/// powers of ten and their halves and fifths.
pub(crate) fn roundest(low: f64, high: f64) -> f64 {
    const MOST_DIGITS: i32 = 12;
    let middle = 0.5 * (low + high);
    if low <= 0.0 && high >= 0.0 {
        return 0.0;
    }
    let largest = low.abs().max(high.abs());
    if !largest.is_finite() || low >= high {
        return middle;
    }
    #[expect(clippy::cast_possible_truncation, reason = "an exponent of a finite number")]
    let first = largest.log10().floor() as i32;
    let powers = (0..MOST_DIGITS).flat_map(|digit| [1.0, 0.5, 0.2].map(|factor| factor * 10.0_f64.powi(first - digit)));
    powers.map(|step| (middle / step).round() * step).find(|value| (low..=high).contains(value)).unwrap_or(middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_matter() {
        for (value, text) in [(0.0, "0"), (0.123_456, "0.1235"), (40.0, "40"), (12_345.6, "12346"), (2.5e-3, "0.0025")]
        {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn the_roundest_number_is_the_shortest_to_say() {
        for (low, high, expected) in [
            (8.7, 11.2, 10.0),
            (13.1, 15.9, 15.0),
            (23.4, 26.0, 25.0),
            (-0.3, 0.2, 0.0),
            (-47.0, -38.0, -40.0),
            (0.0123, 0.0131, 0.013),
            (99.6, 100.0, 100.0),
            (3.0, 3.0, 3.0),
        ] {
            let found = roundest(low, high);
            assert!((found - expected).abs() < 1e-12 * expected.abs().max(1.0), "{low} to {high}: {found}");
        }
        assert!(roundest(f64::NAN, 1.0).is_nan());
    }
}
