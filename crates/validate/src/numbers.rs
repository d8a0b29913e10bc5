//! Numbers in cells.

/// A deviation: two digits.
pub(crate) fn size(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") }
}

/// A value with so many decimals.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    // What rounds to nothing has no sign.
    if text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.')) {
        text.trim_start_matches('-').to_owned()
    } else {
        text
    }
}

/// The larger one, or what is not a number.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// The value below which a fraction of `sorted` lies; NaN where there is none.
pub(crate) fn quantile(sorted: &[f64], fraction: f64) -> f64 {
    if sorted.is_empty() {
        return f64::NAN;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the length")]
    let at = ((sorted.len() - 1) as f64 * fraction.clamp(0.0, 1.0)).floor() as usize;
    sorted[at]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_has_no_sign() {
        assert_eq!((fixed(-0.000_01, 2).as_str(), fixed(-0.5, 1).as_str()), ("0.00", "-0.5"));
        assert_eq!((size(0.0).as_str(), size(1.24e-9).as_str()), ("0", "1.2e-9"));
        assert_eq!(quantile(&[1.0, 2.0, 3.0], 0.5), 2.0);
        assert!(quantile(&[], 0.5).is_nan());
        assert!(larger(f64::NAN, 1.0).is_nan() && larger(1.0, f64::NAN).is_nan() && larger(1.0, 2.0) == 2.0);
    }
}
