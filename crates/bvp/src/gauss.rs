//! Gauss–Legendre collocation with `M` stages on [0, 1]: order 2M at the nodes.

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
    /// Second derivative at `c[j]` of the polynomial of degree 2M-1 that has given values and
    /// slopes at all stages: `hermite[0][j][l]` weighs values, `hermite[1][j][l]` slopes.
    pub hermite: [[[f64; M]; M]; 2],
    /// [`Gauss::hermite_at`] both ends of an element.
    pub ends: [Hermite<M>; 2],
    /// `legendre[n][j]`: weight of P_n in `l_j`, `(2n+1) b_j P_n(c_j)`.
    legendre: [[f64; M]; M],
}

/// Weights of the values and of the slopes at the stages of an element of length one.
#[derive(Debug, Clone, Copy)]
pub struct Hermite<const M: usize> {
    /// For the value: of values, of slopes.
    pub value: [[f64; M]; 2],
    /// For the first derivative: of values, of slopes.
    pub slope: [[f64; M]; 2],
    /// For the second derivative: of values, of slopes.
    pub curvature: [[f64; M]; 2],
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
        let blank = Hermite { value: [[0.0; M]; 2], slope: [[0.0; M]; 2], curvature: [[0.0; M]; 2] };
        let zero = [[0.0; M]; M];
        let mut gauss = Self { c, b, a: zero, d: zero, hermite: [zero; 2], ends: [blank; 2], legendre: zero };
        for n in 0..M {
            for j in 0..M {
                gauss.legendre[n][j] = (2 * n + 1) as f64 * gauss.b[j] * legendre(n, 2.0 * c[j] - 1.0).0;
            }
        }
        for j in 0..M {
            gauss.a[j] = gauss.integrals(c[j]);
            gauss.d[j] = gauss.slopes(c[j]);
        }
        gauss.hermite = gauss.second_derivatives();
        gauss.ends = [0.0, 1.0].map(|x| gauss.hermite_at(x));
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

    /// From H_l = (1 - 2 (x - c_l) l_l'(c_l)) l_l^2 for values and (x - c_l) l_l^2 for slopes.
    fn second_derivatives(&self) -> [[[f64; M]; M]; 2] {
        let mut out = [[[0.0; M]; M]; 2];
        for j in 0..M {
            for l in 0..M {
                let own = self.d[l][l];
                if j == l {
                    let curvature: f64 = (0..M).map(|k| self.d[l][k] * self.d[k][l]).sum();
                    out[0][j][l] = 2.0 * curvature - 6.0 * own * own;
                    out[1][j][l] = 4.0 * own;
                } else {
                    let square = 2.0 * self.d[j][l] * self.d[j][l];
                    let distance = self.c[j] - self.c[l];
                    out[0][j][l] = square * (1.0 - 2.0 * distance * own);
                    out[1][j][l] = square * distance;
                }
            }
        }
        out
    }

    /// Value, first and second derivative at `x` of the polynomial that [`Gauss::hermite`] is of.
    pub fn hermite_at(&self, x: f64) -> Hermite<M> {
        let values = self.cardinals(x);
        let slopes = self.slopes(x);
        let t = 2.0 * x - 1.0;
        let curvatures = self.combine(&std::array::from_fn(|n| 4.0 * legendre_curvature(n, t)));
        let mut out = Hermite { value: [[0.0; M]; 2], slope: [[0.0; M]; 2], curvature: [[0.0; M]; 2] };
        for l in 0..M {
            let (v, v1, v2) = (values[l], slopes[l], curvatures[l]);
            let own = self.d[l][l];
            let distance = x - self.c[l];
            let lean = 1.0 - 2.0 * distance * own;
            out.value[0][l] = lean * v * v;
            out.value[1][l] = distance * v * v;
            out.slope[0][l] = -2.0 * own * v * v + 2.0 * lean * v * v1;
            out.slope[1][l] = v * v + 2.0 * distance * v * v1;
            out.curvature[0][l] = -8.0 * own * v * v1 + 2.0 * lean * (v1 * v1 + v * v2);
            out.curvature[1][l] = 4.0 * v * v1 + 2.0 * distance * (v1 * v1 + v * v2);
        }
        out
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

/// Second derivative of the Legendre polynomial of degree `n` at `x` in [-1, 1].
fn legendre_curvature(n: usize, x: f64) -> f64 {
    // P_{k+1}' - P_{k-1}' = (2k + 1) P_k, differentiated once.
    let (mut d0, mut d1) = (0.0, 0.0);
    for k in 1..n {
        (d0, d1) = (d1, d0 + (2 * k + 1) as f64 * legendre(k, x).1);
    }
    d1
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
    fn hermite_second_derivatives_are_exact_to_degree_seven() {
        let g = Gauss::<4>::new();
        for j in 0..4 {
            let sum: f64 =
                (0..4).map(|l| g.hermite[0][j][l] * g.c[l].powi(7) + g.hermite[1][j][l] * 7.0 * g.c[l].powi(6)).sum();
            assert!((sum - 42.0 * g.c[j].powi(5)).abs() < 1e-11, "{sum}");
        }
    }

    #[test]
    fn hermite_derivatives_between_stages_are_exact_to_degree_seven() {
        let g = Gauss::<4>::new();
        for x in [0.03, 0.4, 0.77, 1.0] {
            let h = g.hermite_at(x);
            let sum = |w: [[f64; 4]; 2]| -> f64 {
                (0..4).map(|l| w[0][l] * g.c[l].powi(7) + w[1][l] * 7.0 * g.c[l].powi(6)).sum()
            };
            assert!((sum(h.slope) - 7.0 * x.powi(6)).abs() < 1e-11);
            assert!((sum(h.curvature) - 42.0 * x.powi(5)).abs() < 1e-10, "{}", sum(h.curvature));
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
