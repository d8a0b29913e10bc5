//! A quantity along the arm, from the numbers of its profile alone: straight lines, and monotone cubics with the slopes of
//! Fritsch and Butland (1984), at the ends the three-point slope that keeps the cubic monotone (`docs/model.md`, section 8, item 7).

use hydrostat::Profile;

#[derive(Debug, Clone)]
pub(crate) struct Curve {
    s: Vec<f64>,
    value: Vec<f64>,
    slope: Vec<f64>,
}

impl Curve {
    pub(crate) fn new(profile: &Profile, length: f64) -> Self {
        let points: Vec<[f64; 2]> = match profile {
            Profile::Constant(value) => vec![[0.0, *value], [length, *value]],
            Profile::Linear { base, tip } => vec![[0.0, *base], [length, *tip]],
            Profile::Table(table) => table.points().collect(),
        };
        let s: Vec<f64> = points.iter().map(|p| p[0]).collect();
        let value: Vec<f64> = points.iter().map(|p| p[1]).collect();
        let slope = monotone_slopes(&s, &value);
        Self { s, value, slope }
    }

    /// Value and slope at `s`.
    pub(crate) fn at(&self, s: f64) -> [f64; 2] {
        let i = (1..self.s.len() - 1).take_while(|i| self.s[*i] <= s).count();
        let h = self.s[i + 1] - self.s[i];
        let t = (s - self.s[i]) / h;
        // Hermite's cubic.
        let (v0, v1, d0, d1) = (self.value[i], self.value[i + 1], h * self.slope[i], h * self.slope[i + 1]);
        let value = v0 + t * (d0 + t * (3.0 * (v1 - v0) - 2.0 * d0 - d1 + t * (2.0 * (v0 - v1) + d0 + d1)));
        let slope = d0 + t * (2.0 * (3.0 * (v1 - v0) - 2.0 * d0 - d1) + 3.0 * t * (2.0 * (v0 - v1) + d0 + d1));
        [value, slope / h]
    }

    /// Inner points, where the curvature jumps.
    pub(crate) fn knots(&self) -> &[f64] {
        &self.s[1..self.s.len() - 1]
    }
}

fn monotone_slopes(s: &[f64], value: &[f64]) -> Vec<f64> {
    let step = |i: usize| s[i + 1] - s[i];
    let chord = |i: usize| (value[i + 1] - value[i]) / step(i);
    let n = s.len();
    if n == 2 {
        return vec![chord(0); 2];
    }
    let end = |i: usize, next: usize| {
        let slope = ((2.0 * step(i) + step(next)) * chord(i) - step(i) * chord(next)) / (step(i) + step(next));
        if slope * chord(i) <= 0.0 {
            0.0
        } else if chord(i) * chord(next) <= 0.0 && slope.abs() > 3.0 * chord(i).abs() {
            3.0 * chord(i)
        } else {
            slope
        }
    };
    let inner = (1..n - 1).map(|i| {
        if chord(i - 1) * chord(i) <= 0.0 {
            return 0.0;
        }
        let (w, v) = (2.0 * step(i) + step(i - 1), step(i) + 2.0 * step(i - 1));
        (w + v) / (w / chord(i - 1) + v / chord(i))
    });
    std::iter::once(end(0, 1)).chain(inner).chain(std::iter::once(end(n - 2, n - 3))).collect()
}

/// SciPy's `PchipInterpolator([0, 1, 3, 4], [0, 2, 3, 1])`: slopes 2.5, 6/7, 0, -17/6.
#[test]
fn curves_have_the_slopes_of_scipy() {
    let curve = Curve::new(&Profile::table(&[[0.0, 0.0], [1.0, 2.0], [3.0, 3.0], [4.0, 1.0]]).unwrap(), 4.0);
    for (s, slope) in [(0.0, 2.5), (1.0, 6.0 / 7.0), (3.0, 0.0), (4.0, -17.0 / 6.0)] {
        assert!((curve.at(s)[1] - slope).abs() < 1e-14, "{s}");
    }
    assert_eq!(curve.knots(), [1.0, 3.0]);
}
