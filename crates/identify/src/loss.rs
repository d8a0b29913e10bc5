//! What a residual costs, in standard deviations: the square, or less for those that are far out.

/// How far-out residuals count.
///
/// The constants are those with which the estimate of a mean is 95 % as efficient as the arithmetic one when all errors are normal
/// (Huber 1981; Holland and Welsch 1977).
///
/// For outliers take `Cauchy`. Under `Huber` each of them pulls with the strength of 1.345 standard deviations however far out it is; a fraction e of n
/// numbers, all off to one side, so moves an estimate by up to some 1.345 e sqrt(n) of its own standard deviations, which no number of data mends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Loss {
    /// By their square: least squares.
    #[default]
    None,
    /// Linearly from 1.345 standard deviations on.
    Huber,
    /// Logarithmically: what is many standard deviations out hardly pulls.
    Cauchy,
}

const HUBER: f64 = 1.345;
const CAUCHY: f64 = 2.3849;

impl Loss {
    /// All of them, under the names that [`Loss::name`] gives.
    pub const ALL: [Self; 3] = [Self::None, Self::Huber, Self::Cauchy];

    /// `none`, `huber` or `cauchy`.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Huber => "huber",
            Self::Cauchy => "cauchy",
        }
    }

    /// What the residual `r` adds to what is minimised: half its square near zero.
    pub fn cost(self, r: f64) -> f64 {
        match self {
            Self::None => 0.5 * r * r,
            Self::Huber if r.abs() <= HUBER => 0.5 * r * r,
            Self::Huber => HUBER * (r.abs() - 0.5 * HUBER),
            Self::Cauchy => 0.5 * CAUCHY * CAUCHY * (r / CAUCHY).powi(2).ln_1p(),
        }
    }

    /// Its slope.
    pub fn slope(self, r: f64) -> f64 {
        match self {
            Self::None => r,
            Self::Huber => r.clamp(-HUBER, HUBER),
            Self::Cauchy => r / (1.0 + (r / CAUCHY).powi(2)),
        }
    }

    /// Its curvature, which is below zero where `Cauchy` bends back.
    pub fn curvature(self, r: f64) -> f64 {
        match self {
            Self::None => 1.0,
            Self::Huber => f64::from(u8::from(r.abs() <= HUBER)),
            Self::Cauchy => {
                let square = (r / CAUCHY).powi(2);
                (1.0 - square) / (1.0 + square).powi(2)
            }
        }
    }

    /// The fraction of its pull under least squares that the residual keeps, in (0, 1].
    pub fn weight(self, r: f64) -> f64 {
        if r == 0.0 { 1.0 } else { self.slope(r) / r }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_those_of_costs_and_curvatures_those_of_slopes() {
        for loss in Loss::ALL {
            for k in -40..=40 {
                let (r, h) = (0.13 * f64::from(k) + 0.01, 1e-5);
                let difference = |f: &dyn Fn(f64) -> f64| (f(r + h) - f(r - h)) / (2.0 * h);
                assert!((difference(&|r| loss.cost(r)) - loss.slope(r)).abs() < 1e-8, "{loss:?} {r}");
                assert!((difference(&|r| loss.slope(r)) - loss.curvature(r)).abs() < 1e-8, "{loss:?} {r}");
                assert!(loss.weight(r) > 0.0 && loss.weight(r) <= 1.0);
                assert!(loss.cost(r) <= Loss::None.cost(r) + 1e-15);
            }
        }
    }
}
