//! Determinants of large systems: signs, sizes, and how well the sign is known.

/// The determinant of a linearised problem. Its sign is that of all equations together, those of the stages and of the closure included:
/// the condensed equations alone change sign, too, where the stages of a long element do, which means nothing. Its size is that of
/// the condensed equations: the determinant of the conditions at s = 1 by the states that those at s = 0 leave free. It changes
/// sign where two solutions meet or cross.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Determinant {
    /// -1, 0 or 1.
    pub sign: f64,
    /// Natural logarithm of the size.
    pub log: f64,
    /// The least of the last pivots over the largest number that it came from or stands beside: the digits that are left of it.
    /// Rounding alone can turn the sign where this is near the machine's precision.
    pub clearance: f64,
}

/// The clearance below which a sign decides nothing.
const UNCLEAR: f64 = 1e-11;

impl Determinant {
    /// One.
    pub const ONE: Self = Self { sign: 1.0, log: 0.0, clearance: 1.0 };

    /// The sign, where rounding could not turn it.
    pub fn known_sign(self) -> Option<f64> {
        (self.sign != 0.0 && self.clearance > UNCLEAR).then_some(self.sign)
    }

    /// Of the product of two.
    pub fn times(self, other: Self) -> Self {
        Self { sign: self.sign * other.sign, log: self.log + other.log, clearance: self.clearance.min(other.clearance) }
    }
}

/// A product of many factors that neither overflows nor takes a logarithm a factor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Product {
    sign: f64,
    log: f64,
    rest: f64,
}

impl Product {
    pub(crate) fn new() -> Self {
        Self { sign: 1.0, log: 0.0, rest: 1.0 }
    }

    #[inline(always)]
    pub(crate) fn times(&mut self, factor: f64) {
        if factor < 0.0 {
            self.sign = -self.sign;
        }
        let next = self.rest * factor.abs();
        if (1e-100..1e100).contains(&next) {
            self.rest = next;
        } else {
            self.spill(factor.abs());
        }
    }

    pub(crate) fn turn(&mut self) {
        self.sign = -self.sign;
    }

    /// Takes logarithms before the product leaves the range of numbers.
    #[cold]
    #[inline(never)]
    fn spill(&mut self, factor: f64) {
        if factor == 0.0 {
            self.sign = 0.0;
        }
        self.log += self.rest.ln() + factor.ln();
        self.rest = 1.0;
    }

    pub(crate) fn whole(self, clearance: f64) -> Determinant {
        Determinant { sign: self.sign, log: self.log + self.rest.ln(), clearance }
    }
}
