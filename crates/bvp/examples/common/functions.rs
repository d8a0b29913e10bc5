//! Functions that exact solutions are written in.

/// The error function: its series (Abramowitz and Stegun 7.1.6), and far out the continued fraction of its complement (7.1.14).
pub(crate) fn erf(x: f64) -> f64 {
    if x.abs() > 6.0 {
        return x.signum();
    }
    if x.abs() < 2.5 {
        let (mut term, mut sum) = (x, x);
        for n in 1..200 {
            term *= 2.0 * x * x / f64::from(2 * n + 1);
            sum += term;
        }
        return std::f64::consts::FRAC_2_SQRT_PI * (-x * x).exp() * sum;
    }
    let y = x.abs();
    let mut fraction = y;
    for n in (1..=120).rev() {
        fraction = y + 0.5 * f64::from(n) / fraction;
    }
    x.signum() * (1.0 - (-y * y).exp() / (std::f64::consts::PI.sqrt() * fraction))
}

/// Complete elliptic integrals of the first and second kind of a modulus, by the arithmetic-geometric mean (Abramowitz and Stegun 17.6).
pub(crate) fn elliptic(modulus: f64) -> [f64; 2] {
    let (mut a, mut b, mut c) = (1.0, (1.0 - modulus * modulus).sqrt(), modulus);
    let (mut sum, mut power) = (c * c, 1.0);
    while c.abs() > 1e-17 {
        (a, b, c) = (0.5 * (a + b), (a * b).sqrt(), 0.5 * (a - b));
        power *= 2.0;
        sum += power * c * c;
    }
    let first = std::f64::consts::FRAC_PI_2 / a;
    [first, first * (1.0 - 0.5 * sum)]
}
