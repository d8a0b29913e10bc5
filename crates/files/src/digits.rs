//! Numbers for people.

/// A number with five digits that matter.
///
/// ```
/// use hydrostat_files::number;
///
/// assert_eq!(number(0.123456), "0.12346");
/// assert_eq!(number(-40.0), "-40");
/// assert_eq!(number(1.5e-7), "1.5000e-7");
/// ```
pub fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{}", value + 0.0);
    }
    let power = value.abs().log10().floor();
    if !(-4.0..6.0).contains(&power) {
        return format!("{value:.4e}");
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 8")]
    let decimals = (4.0 - power).clamp(0.0, 8.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
