//! Five boundary-value problems with exact or published answers.

use hydrostat_bvp::{Differentiable, Guess, Scalar};

use super::functions::{elliptic, erf};

/// A problem, where Newton's method starts, and what is known of the answer.
pub(crate) trait Known<const N: usize>: Differentiable<N> {
    /// The name.
    const NAME: &'static str;

    /// The guess.
    fn guess(&self) -> Guess<'_, N>;

    /// The exact unknown of index 0 at `s`, where a formula gives it.
    fn exact(&self, s: f64) -> Option<f64>;

    /// The largest error of a solution: at places all along the interval, or, where there is no formula, of a number that is known.
    fn error(&self, eval: impl Fn(f64) -> [f64; N]) -> f64 {
        let [a, b] = self.interval();
        let places = (0..=1000).map(|k| a + (b - a) * f64::from(k) / 1000.0);
        places.fold(0.0, |worst: f64, s| worst.max((eval(s)[0] - self.exact(s).unwrap_or(f64::NAN)).abs()))
    }
}

/// Bratu's problem `u'' + lambda e^u = 0`, `u(0) = u(1) = 0`: two solutions below `lambda* = 3.513830719...`, none above.
pub(crate) struct Bratu {
    pub(crate) lambda: f64,
    /// Whether the upper solution is asked for.
    pub(crate) upper: bool,
}

impl Differentiable<2> for Bratu {
    const LEFT: usize = 1;

    fn slope<R: Scalar>(&self, _: f64, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[1];
        out[1] = -z[0].exp() * self.lambda;
    }

    fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0];
    }

    fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0];
    }
}

impl Known<2> for Bratu {
    const NAME: &'static str = "Bratu";

    fn guess(&self) -> Guess<'_, 2> {
        let height = if self.upper { 16.0 } else { 0.4 };
        Guess::function(move |s| [height * s * (1.0 - s), height * (1.0 - 2.0 * s)])
    }

    /// `u = 2 ln(cosh c / cosh(c (1 - 2 s)))` with `cosh c = 4 c / sqrt(2 lambda)`.
    fn exact(&self, s: f64) -> Option<f64> {
        // The two solutions stand on either side of the fold's c = 1.19967864...
        let (mut low, mut high) = if self.upper { (1.199_678_640_257_734, 20.0) } else { (0.0, 1.199_678_640_257_734) };
        let rest = |c: f64| 4.0 * c / (2.0 * self.lambda).sqrt() - c.cosh();
        for _ in 0..200 {
            let c = 0.5 * (low + high);
            if (rest(c) < 0.0) == self.upper {
                high = c;
            } else {
                low = c;
            }
        }
        let c = 0.5 * (low + high);
        Some(2.0 * (c.cosh() / (c * (1.0 - 2.0 * s)).cosh()).ln())
    }
}

/// Troesch's problem `u'' = mu sinh(mu u)`, `u(0) = 0`, `u(1) = 1`: a boundary layer at s = 1 that shooting does not survive.
pub(crate) struct Troesch {
    pub(crate) mu: f64,
    /// The published slope at s = 0 (Roberts and Shipman 1976; Chang 2010).
    pub(crate) slope: f64,
}

impl Differentiable<2> for Troesch {
    const LEFT: usize = 1;

    fn slope<R: Scalar>(&self, _: f64, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[1];
        out[1] = (z[0] * self.mu).sinh() * self.mu;
    }

    fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0];
    }

    fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0] - 1.0;
    }
}

impl Known<2> for Troesch {
    const NAME: &'static str = "Troesch";

    fn guess(&self) -> Guess<'_, 2> {
        Guess::function(|s| [s, 1.0])
    }

    fn exact(&self, _: f64) -> Option<f64> {
        None
    }

    /// Of the slope at s = 0.
    fn error(&self, eval: impl Fn(f64) -> [f64; 2]) -> f64 {
        (eval(0.0)[1] - self.slope).abs()
    }
}

/// A shock layer at s = 0 (Ascher, Mattheij and Russell 1995, example 9.2):
/// `e u'' + s u' = -e pi^2 cos(pi s) - pi s sin(pi s)`, `u(-1) = -2`, `u(1) = 0`.
pub(crate) struct Shock {
    pub(crate) epsilon: f64,
}

impl Differentiable<2> for Shock {
    const LEFT: usize = 1;

    fn interval(&self) -> [f64; 2] {
        [-1.0, 1.0]
    }

    fn slope<R: Scalar>(&self, s: f64, z: &[R], _: &[R], out: &mut [R]) {
        let (pi, e) = (std::f64::consts::PI, self.epsilon);
        let source = -e * pi * pi * (pi * s).cos() - pi * s * (pi * s).sin();
        out[0] = z[1];
        out[1] = (z[1] * -s + source) / e;
    }

    fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0] + 2.0;
    }

    fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0];
    }
}

impl Known<2> for Shock {
    const NAME: &'static str = "shock layer";

    fn guess(&self) -> Guess<'_, 2> {
        Guess::constant([-1.0, 0.0])
    }

    /// `u = cos(pi s) + erf(s / sqrt(2 e)) / erf(1 / sqrt(2 e))`.
    fn exact(&self, s: f64) -> Option<f64> {
        let width = (2.0 * self.epsilon).sqrt();
        Some((std::f64::consts::PI * s).cos() + erf(s / width) / erf(1.0 / width))
    }
}

/// Mathieu's equation `u'' + (a - 2 q cos 2 s) u = 0`, `u'(0) = u'(pi) = 0`, `u(0) = 1`: the characteristic value a is an unknown parameter.
pub(crate) struct Mathieu {
    pub(crate) q: f64,
    /// What is known of a, and the number of the even function of period pi.
    pub(crate) characteristic: f64,
    pub(crate) order: u32,
}

impl Differentiable<3> for Mathieu {
    const PARAMETERS: usize = 1;
    const LEFT: usize = 2;

    fn interval(&self) -> [f64; 2] {
        [0.0, std::f64::consts::PI]
    }

    fn slope<R: Scalar>(&self, s: f64, z: &[R], p: &[R], out: &mut [R]) {
        out[0] = z[1];
        out[1] = -(p[0] - 2.0 * self.q * (2.0 * s).cos()) * z[0];
    }

    fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0] - 1.0;
        out[1] = z[1];
    }

    fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[1];
    }
}

impl Known<3> for Mathieu {
    const NAME: &'static str = "Mathieu";

    fn guess(&self) -> Guess<'_, 3> {
        let n = f64::from(self.order);
        Guess::function(move |s| [(n * s).cos(), -n * (n * s).sin(), n * n])
    }

    fn exact(&self, _: f64) -> Option<f64> {
        None
    }

    /// Of the characteristic value.
    fn error(&self, eval: impl Fn(f64) -> [f64; 3]) -> f64 {
        (eval(0.0)[2] - self.characteristic).abs()
    }
}

/// Euler's elastica: a column of length one, clamped at s = 0, under a thrust that turns its tip by `tip` (rad). The thrust, over the bending
/// stiffness, is an unknown parameter; unknowns are the angle, the curvature, x, y, and the thrust.
pub(crate) struct Elastica {
    pub(crate) tip: f64,
}

impl Elastica {
    /// Thrust, and the tip's x and y, by complete elliptic integrals of the modulus sin(tip / 2).
    pub(crate) fn known(&self) -> [f64; 3] {
        let modulus = (0.5 * self.tip).sin();
        let [first, second] = elliptic(modulus);
        [first * first, 2.0 * second / first - 1.0, 2.0 * modulus / first]
    }
}

impl Differentiable<5> for Elastica {
    const PARAMETERS: usize = 1;
    const LEFT: usize = 3;

    fn slope<R: Scalar>(&self, _: f64, z: &[R], p: &[R], out: &mut [R]) {
        out[0] = z[1];
        out[1] = -p[0] * z[0].sin();
        out[2] = z[0].cos();
        out[3] = z[0].sin();
    }

    fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0];
        out[1] = z[2];
        out[2] = z[3];
    }

    fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0] - self.tip;
        out[1] = z[1];
    }
}

impl Known<5> for Elastica {
    const NAME: &'static str = "elastica";

    fn guess(&self) -> Guess<'_, 5> {
        let (tip, rate) = (self.tip, std::f64::consts::FRAC_PI_2);
        Guess::function(move |s| [tip * (rate * s).sin(), tip * rate * (rate * s).cos(), s, 0.0, rate * rate])
    }

    fn exact(&self, _: f64) -> Option<f64> {
        None
    }

    /// The largest of the thrust's and the tip's.
    fn error(&self, eval: impl Fn(f64) -> [f64; 5]) -> f64 {
        let ([thrust, x, y], found) = (self.known(), eval(1.0));
        [found[4] - thrust, found[2] - x, found[3] - y].iter().fold(0.0, |m: f64, v| m.max(v.abs()))
    }
}
