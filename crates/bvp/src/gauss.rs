//! Gauss–Legendre collocation with `M` stages on [0, 1]: order 2M at the nodes.

/// Most stages of a method for problems with a closure variable.
pub const MAX_STAGES: usize = 5;

/// The stages and both ends of an element.
pub(crate) const POINTS: usize = MAX_STAGES + 2;

/// Weights by two of the stages and ends.
pub(crate) type Differentiation = [[f64; POINTS]; POINTS];

/// Points and weights of the `M`-stage Gauss method.
///
/// Everything follows from the cardinal polynomials
/// `l_j(x) = b_j sum_n (2n+1) P_n(c_j) P_n(x)` (shifted Legendre `P_n`), which hold because the
/// quadrature is exact to degree 2M-1.
#[derive(Debug, Clone)]
pub struct Gauss<const M: usize> {
    /// Stage points in (0, 1), increasing.
    pub c: [f64; M],
    /// Quadrature weights.
    pub b: [f64; M],
    /// `a[j][l]`: integral of `l_l` from 0 to `c[j]`.
    pub a: [[f64; M]; M],
    /// `d[j][l]`: slope of `l_l` at `c[j]`.
    pub d: [[f64; M]; M],
    /// Differentiation on the stages and both ends, for either side that is an element's own
    /// ([`Side`](crate::directions::Side)): `closure[side][m][l]` is the slope at point `m` of the polynomial that is one at
    /// point `l`. Points 0 to M-1 are the stages, M is the own end, M+1 the other one. Zero for methods
    /// with more than [`MAX_STAGES`] stages.
    pub closure: [Differentiation; 2],
    /// `legendre[n][j]`: weight of P_n in `l_j`, `(2n+1) b_j P_n(c_j)`.
    legendre: [[f64; M]; M],
}

impl<const M: usize> Gauss<M> {
    /// The method with `M` stages.
    pub fn new() -> Self {
        let mut c = [0.0; M];
        let mut b = [0.0; M];
        for j in 0..M {
            // Tricomi's start, then Newton on P_M.
            let mut x = -(std::f64::consts::PI * (j as f64 + 0.75) / (M as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..20 {
                let (value, derivative) = legendre(M, x);
                slope = derivative;
                let step = value / derivative;
                x -= step;
                if step.abs() < 1e-16 {
                    break;
                }
            }
            c[j] = 0.5 * (1.0 + x);
            b[j] = 1.0 / ((1.0 - x * x) * slope * slope);
        }
        let zero = [[0.0; M]; M];
        let mut gauss = Self { c, b, a: zero, d: zero, closure: [[[0.0; POINTS]; POINTS]; 2], legendre: zero };
        for n in 0..M {
            for j in 0..M {
                gauss.legendre[n][j] = (2 * n + 1) as f64 * gauss.b[j] * legendre(n, 2.0 * c[j] - 1.0).0;
            }
        }
        for j in 0..M {
            gauss.a[j] = gauss.integrals(c[j]);
            gauss.d[j] = gauss.slopes(c[j]);
        }
        if M <= MAX_STAGES {
            gauss.closure = [[0.0, 1.0], [1.0, 0.0]].map(|ends| differentiation(&gauss.c, ends));
        }
        gauss
    }

    /// Values of the cardinal polynomials at `x`: interpolation weights.
    #[inline]
    pub fn cardinals(&self, x: f64) -> [f64; M] {
        let mut p = [0.0; M];
        legendre_up_to(2.0 * x - 1.0, &mut p);
        self.combine(&p)
    }

    /// Slopes of the cardinal polynomials at `x`.
    pub fn slopes(&self, x: f64) -> [f64; M] {
        self.combine(&std::array::from_fn(|n| 2.0 * legendre(n, 2.0 * x - 1.0).1))
    }

    /// Integrals of the cardinal polynomials from 0 to `x`.
    pub fn integrals(&self, x: f64) -> [f64; M] {
        let t = 2.0 * x - 1.0;
        self.combine(&std::array::from_fn(|n| {
            if n == 0 { x } else { (legendre(n + 1, t).0 - legendre(n - 1, t).0) / (2.0 * (2 * n + 1) as f64) }
        }))
    }

    /// Weights at `x` of the values at the stages, and at both ends.
    pub fn cardinals_with_ends(&self, x: f64) -> ([f64; M], [f64; 2]) {
        let mut at_stages = self.cardinals(x);
        for (weight, c) in at_stages.iter_mut().zip(self.c) {
            *weight *= x * (x - 1.0) / (c * (c - 1.0));
        }
        let end = |own: f64, other: f64| {
            let distance: f64 = self.c.iter().map(|c| (x - c) / (own - c)).product();
            distance * (x - other) / (own - other)
        };
        (at_stages, [end(0.0, 1.0), end(1.0, 0.0)])
    }

    /// Weights at `x` of the values at the stages and, last, at the end of an element that is its own (0 or 1).
    pub fn cardinals_with_end(&self, x: f64, own: f64) -> ([f64; M], f64) {
        let distance: f64 = self.c.iter().map(|c| (x - c) / (own - c)).product();
        let mut at_stages = self.cardinals(x);
        for (weight, c) in at_stages.iter_mut().zip(self.c) {
            *weight *= (x - own) / (c - own);
        }
        (at_stages, distance)
    }

    #[inline]
    fn combine(&self, of: &[f64; M]) -> [f64; M] {
        let mut out = [0.0; M];
        for n in 0..M {
            for j in 0..M {
                out[j] += self.legendre[n][j] * of[n];
            }
        }
        out
    }
}

impl<const M: usize> Default for Gauss<M> {
    fn default() -> Self {
        Self::new()
    }
}

/// P_0 to P_{M-1} at `x`.
#[inline]
fn legendre_up_to<const M: usize>(x: f64, out: &mut [f64; M]) {
    for n in 0..M {
        out[n] = match n {
            0 => 1.0,
            1 => x,
            _ => {
                let k = (n - 1) as f64;
                ((2.0 * k + 1.0) * x * out[n - 1] - k * out[n - 2]) / (k + 1.0)
            }
        };
    }
}

/// Legendre polynomial of degree `n` at `x` in [-1, 1], and its slope.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut p0, mut p1, mut d0, mut d1) = (1.0, x, 0.0, 1.0);
    if n == 0 {
        return (p0, d0);
    }
    for k in 1..n {
        let k = k as f64;
        let p2 = ((2.0 * k + 1.0) * x * p1 - k * p0) / (k + 1.0);
        let d2 = d0 + (2.0 * k + 1.0) * p1;
        (p0, p1, d0, d1) = (p1, p2, d1, d2);
    }
    (p1, d1)
}

/// Derivatives of the polynomials through stages and ends, by barycentric weights (Berrut and Trefethen 2004).
fn differentiation<const M: usize>(c: &[f64; M], ends: [f64; 2]) -> Differentiation {
    let points: Vec<f64> = c.iter().chain(&ends).copied().collect();
    let weight = |k: usize| -> f64 {
        points.iter().enumerate().filter(|(l, _)| *l != k).map(|(_, x)| 1.0 / (points[k] - x)).product()
    };
    let mut out = [[0.0; POINTS]; POINTS];
    for m in 0..points.len() {
        for l in (0..points.len()).filter(|l| *l != m) {
            out[m][l] = weight(l) / weight(m) / (points[m] - points[l]);
            out[m][m] -= out[m][l];
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrates_degree_seven_exactly_with_four_stages() {
        let g = Gauss::<4>::new();
        let sum: f64 = (0..4).map(|j| g.b[j] * g.c[j].powi(7)).sum();
        assert!((sum - 0.125).abs() < 1e-15);
    }

    #[test]
    fn slopes_through_stages_and_ends_are_exact_to_degree_five() {
        let g = Gauss::<4>::new();
        for (side, ends) in [[0.0, 1.0], [1.0, 0.0]].into_iter().enumerate() {
            let points: Vec<f64> = g.c.iter().chain(&ends).copied().collect();
            for m in 0..6 {
                let slope: f64 = (0..6).map(|l| g.closure[side][m][l] * points[l].powi(5)).sum();
                assert!((slope - 5.0 * points[m].powi(4)).abs() < 1e-12, "{slope}");
            }
            let (at_stages, at_end) = g.cardinals_with_end(0.37, ends[0]);
            let value: f64 = (0..4).map(|l| at_stages[l] * g.c[l].powi(4)).sum::<f64>() + at_end * ends[0].powi(4);
            assert!((value - 0.37_f64.powi(4)).abs() < 1e-13);
        }
    }

    #[test]
    fn cardinals_reproduce_cubics_with_slope_and_integral() {
        let g = Gauss::<4>::new();
        let f = |x: f64| 1.0 + x - 2.0 * x * x + 0.5 * x.powi(3);
        for x in [0.0, 0.3, 1.0] {
            let (l, d, i) = (g.cardinals(x), g.slopes(x), g.integrals(x));
            let dot = |w: [f64; 4]| -> f64 { (0..4).map(|j| w[j] * f(g.c[j])).sum() };
            assert!((dot(l) - f(x)).abs() < 1e-13);
            assert!((dot(d) - (1.0 - 4.0 * x + 1.5 * x * x)).abs() < 1e-12);
            assert!((dot(i) - (x + x * x / 2.0 - 2.0 * x.powi(3) / 3.0 + x.powi(4) / 8.0)).abs() < 1e-13);
        }
    }
}
