//! Polynomials through the Gauss points of [0, 1]: what they are elsewhere, their slopes and their integrals.

/// Gauss points on [0, 1] with what polynomials through them need.
pub(crate) struct Points {
    pub(crate) at: Vec<f64>,
    /// Integral over [0, 1], by value at a point.
    pub(crate) weight: Vec<f64>,
    /// Integral from 0 to point i, by value at point j.
    pub(crate) upto: Vec<Vec<f64>>,
    /// Slope at point i, by value at point j.
    pub(crate) slope: Vec<Vec<f64>>,
    barycentric: Vec<f64>,
}

impl Points {
    /// `count` of them.
    pub(crate) fn new(count: usize) -> Self {
        let (at, weight) = gauss(count);
        let barycentric: Vec<f64> =
            (0..count).map(|j| 1.0 / (0..count).filter(|i| *i != j).map(|i| at[j] - at[i]).product::<f64>()).collect();
        let mut out = Self { at, weight, upto: Vec::new(), slope: Vec::new(), barycentric };
        for i in 0..count {
            let end = out.at[i];
            let mut row = vec![0.0; count];
            for (x, w) in out.at.iter().zip(&out.weight) {
                for (row, own) in row.iter_mut().zip(out.basis(end * x)) {
                    *row += end * w * own;
                }
            }
            out.upto.push(row);
            let mut row: Vec<f64> = (0..count)
                .map(|j| if i == j { 0.0 } else { out.barycentric[j] / out.barycentric[i] / (out.at[i] - out.at[j]) })
                .collect();
            row[i] = -row.iter().sum::<f64>();
            out.slope.push(row);
        }
        out
    }

    pub(crate) fn count(&self) -> usize {
        self.at.len()
    }

    /// What each value counts for at `x`, which may lie outside [0, 1].
    pub(crate) fn basis(&self, x: f64) -> Vec<f64> {
        if let Some(k) = self.at.iter().position(|own| *own == x) {
            return (0..self.count()).map(|j| if j == k { 1.0 } else { 0.0 }).collect();
        }
        let terms: Vec<f64> = self.at.iter().zip(&self.barycentric).map(|(own, w)| w / (x - own)).collect();
        let sum: f64 = terms.iter().sum();
        terms.iter().map(|term| term / sum).collect()
    }

    /// The polynomial through `values` at `x`.
    pub(crate) fn value(&self, values: &[f64], x: f64) -> f64 {
        self.basis(x).iter().zip(values).map(|(own, value)| own * value).sum()
    }

    /// Slopes of the polynomial through `values` at the points, by x in [0, 1].
    pub(crate) fn slopes(&self, values: &[f64]) -> Vec<f64> {
        self.slope.iter().map(|row| row.iter().zip(values).map(|(own, value)| own * value).sum()).collect()
    }
}

/// Places and weights on [0, 1]: roots of the Legendre polynomial by Newton's method.
fn gauss(count: usize) -> (Vec<f64>, Vec<f64>) {
    let n = count as f64;
    let mut out: Vec<(f64, f64)> = (0..count)
        .map(|i| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let (mut before, mut here) = (1.0, x);
                for k in 2..=count {
                    let k = k as f64;
                    (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
                }
                slope = n * (x * here - before) / (x * x - 1.0);
                let step = here / slope;
                x -= step;
                if step.abs() < 1e-16 {
                    break;
                }
            }
            (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect();
    out.sort_by(|a, b| a.0.total_cmp(&b.0));
    out.into_iter().unzip()
}

#[test]
fn polynomials_through_gauss_points_are_exact() {
    let points = Points::new(8);
    let p = |x: f64| 1.0 - 2.0 * x + 3.0 * x.powi(7);
    let values: Vec<f64> = points.at.iter().map(|x| p(*x)).collect();
    assert!((points.value(&values, -0.3) - p(-0.3)).abs() < 1e-12);
    for (i, slope) in points.slopes(&values).iter().enumerate() {
        let x = points.at[i];
        assert!((slope + 2.0 - 21.0 * x.powi(6)).abs() < 1e-11);
        let integral: f64 = points.upto[i].iter().zip(&values).map(|(own, value)| own * value).sum();
        assert!((integral - (x - x * x + 0.375 * x.powi(8))).abs() < 1e-14);
    }
    // A rule of 8 points is exact up to degree 15.
    let fifteenth: f64 = points.at.iter().zip(&points.weight).map(|(x, w)| w * x.powi(15)).sum();
    assert!((fifteenth - 1.0 / 16.0).abs() < 1e-15);
}
