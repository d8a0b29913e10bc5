//! Quantiles that intervals take.

/// Two-sided 95 % of a normal distribution.
pub(crate) const NORMAL_95: f64 = 1.959_963_984_540_054;

/// Two-sided 95 % of Student's t with `freedom` (at least 1) degrees of freedom: by the probability that lies within, which is elementary
/// for whole degrees (Abramowitz and Stegun 26.7.3, 26.7.4), and bisection.
pub(crate) fn student_95(freedom: usize) -> f64 {
    if freedom > 10_000 {
        return NORMAL_95;
    }
    let (mut low, mut high) = (NORMAL_95, 13.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if within(middle, freedom.max(1)) < 0.95 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The probability of being nearer to zero than `t`.
fn within(t: f64, freedom: usize) -> f64 {
    let nu = freedom as f64;
    let theta = (t / nu.sqrt()).atan();
    let (sin, cos) = theta.sin_cos();
    // cos^k with the ratios of odd to even numbers, or the other way.
    let odd = freedom % 2 == 1;
    let mut term = if odd { cos } else { 1.0 };
    let mut sum = if freedom == 1 { 0.0 } else { term };
    let mut k = if odd { 3 } else { 2 };
    while k + 2 <= freedom {
        term *= cos * cos * (k - 1) as f64 / k as f64;
        sum += term;
        k += 2;
    }
    if odd { 2.0 / std::f64::consts::PI * (theta + sin * sum) } else { sin * sum }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (freedom, want) in [
            (1, 12.7062),
            (2, 4.3027),
            (3, 3.1824),
            (4, 2.7764),
            (5, 2.5706),
            (10, 2.2281),
            (30, 2.0423),
            (120, 1.9799),
        ] {
            assert!((student_95(freedom) - want).abs() < 1e-4, "{freedom}: {}", student_95(freedom));
        }
        assert!((student_95(100_000) - NORMAL_95).abs() < 1e-12);
    }
}
