//! One small motion about an equilibrium.

/// Real parts below this fraction of a rate are what rounding leaves of none.
pub(super) const NOTHING: f64 = 1e-7;

/// One motion about an equilibrium: a real rate, or a conjugate pair of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Real and imaginary part of lambda, 1/s: the motion goes as exp(lambda t); of a pair the one with the positive
    /// imaginary part.
    pub rate: [f64; 2],
}

impl Mode {
    /// |Im lambda|/(2 pi), Hz; zero where the motion does not swing.
    pub fn frequency(&self) -> f64 {
        self.rate[1].abs() / (2.0 * std::f64::consts::PI)
    }

    /// -Re lambda/|lambda|: 0 of a free swing, 1 of one that only decays, negative where it grows.
    pub fn damping_ratio(&self) -> f64 {
        let size = self.rate[0].hypot(self.rate[1]);
        // Taken from zero, what is nothing is 0 and not -0.
        if size > 0.0 { 0.0 - self.rate[0] / size } else { 0.0 }
    }

    /// Whether it grows.
    pub fn grows(&self) -> bool {
        self.rate[0] > NOTHING * self.rate[0].hypot(self.rate[1])
    }

    /// Whether it grows as it swings.
    pub fn is_flutter(&self) -> bool {
        self.grows() && self.rate[1] != 0.0
    }
}
