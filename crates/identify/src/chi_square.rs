//! Probabilities of sums of squares.

/// The probability that the sum of the squares of so many normal numbers is below `sum`: the lower incomplete gamma function by its series
/// (Abramowitz and Stegun 26.4.6).
pub(crate) fn below(sum: f64, freedom: usize) -> f64 {
    let (a, x) = (0.5 * freedom as f64, 0.5 * sum);
    if x <= 0.0 || freedom == 0 {
        return if x > 0.0 { 1.0 } else { 0.0 };
    }
    // So far above the mean a that nothing is left, and the series would have many terms.
    if x > a + 15.0 * a.sqrt() + 60.0 {
        return 1.0;
    }
    let (mut term, mut series, mut k) = (1.0, 1.0, a);
    while term > 1e-17 * series {
        k += 1.0;
        term *= x / k;
        series += term;
    }
    (a * x.ln() - x - ln_factorial(freedom) + f64::ln(series)).exp().min(1.0)
}

/// ln of the gamma function at `freedom`/2 + 1: a product of whole or half numbers.
fn ln_factorial(freedom: usize) -> f64 {
    let (mut k, mut out) = if freedom.is_multiple_of(2) { (1.0, 0.0) } else { (0.5, 0.5 * std::f64::consts::PI.ln()) };
    while k <= 0.5 * freedom as f64 {
        out += f64::ln(k);
        k += 1.0;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_are_those_of_the_tables() {
        // Abramowitz and Stegun, table 26.8: the sums that are passed with a probability of 0.05.
        for (freedom, sum) in
            [(1, 3.841_46), (2, 5.991_46), (3, 7.814_73), (10, 18.307_0), (30, 43.772_9), (100, 124.342)]
        {
            assert!((below(sum, freedom) - 0.95).abs() < 1e-5, "{freedom}: {}", below(sum, freedom));
        }
        for sum in [1e-11, 0.3, 2.0, 40.0, 800.0] {
            let exact = -f64::exp_m1(-0.5 * sum);
            assert!((below(sum, 2) - exact).abs() <= 1e-14 + 1e-12 * exact, "{sum}: {} {exact}", below(sum, 2));
        }
        // Of many numbers the sum is normal: within 1 % by Wilson and Hilferty's cube root at its mean.
        assert!((below(1e5, 100_000) - 0.5).abs() < 0.01);
        assert_eq!((below(0.0, 3), below(1e9, 3)), (0.0, 1.0));
    }
}
