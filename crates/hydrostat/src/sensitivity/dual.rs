//! Numbers that carry their derivatives by several quantities: forward differentiation.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use hydrostat_bvp::{LANES, Lanes, Real};

/// Quantities that one evaluation is differentiated by.
pub(crate) const WAYS: usize = LANES;

/// A value with its derivatives side by side.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Dual {
    pub(crate) value: f64,
    pub(crate) by: Lanes,
}

impl Dual {
    /// A value that depends on nothing.
    #[inline(always)]
    pub(crate) fn fixed(value: f64) -> Self {
        Self { value, by: Lanes([0.0; LANES]) }
    }

    /// A value that follows the quantity `way`, by `factor`.
    #[inline(always)]
    pub(crate) fn seeded(value: f64, way: usize, factor: f64) -> Self {
        let mut out = Self::fixed(value);
        out.by.0[way] = factor;
        out
    }

    /// `value` with the derivatives times `factor`.
    #[inline(always)]
    fn chain(self, value: f64, factor: f64) -> Self {
        Self { value, by: self.by * Lanes::of(factor) }
    }
}

impl Add for Dual {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl Sub for Dual {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        self -= other;
        self
    }
}

impl Mul for Dual {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let by = self.by * Lanes::of(other.value) + other.by * Lanes::of(self.value);
        Self { value: self.value * other.value, by }
    }
}

impl Div for Dual {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        let value = self.value * inverse;
        Self { value, by: (self.by - other.by * Lanes::of(value)) * Lanes::of(inverse) }
    }
}

impl Neg for Dual {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, by: -self.by }
    }
}

impl AddAssign for Dual {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        self.by += other.by;
    }
}

impl SubAssign for Dual {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        self.value -= other.value;
        self.by -= other.by;
    }
}

impl Real for Dual {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self::fixed(value)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.chain(self.value.abs(), self.value.sign())
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.if_less(other, self, other)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.if_less(other, other, self)
    }

    /// A step: its derivative is zero.
    #[inline(always)]
    fn sign(self) -> Self {
        Self::fixed(self.value.sign())
    }

    #[inline(always)]
    fn if_less(self, other: Self, yes: Self, no: Self) -> Self {
        if self.value < other.value { yes } else { no }
    }

    #[inline(always)]
    fn all_below(self, bound: f64) -> bool {
        self.value < bound
    }

    #[inline(always)]
    fn plus<const FUSED: bool>(self, f: Self, m: Self) -> Self {
        self + f * m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation against differences of itself.
    #[test]
    fn derivatives_match_differences() {
        fn all<R: Real>(x: R, y: R) -> [R; 9] {
            let two = R::of(2.0);
            [
                x + y * two,
                x - y,
                x * y * x,
                x / (y + x * y),
                -(x * x),
                (x * x + y * y).sqrt(),
                (x - two).abs() * y,
                x.min(y) * x + x.max(y),
                x.if_less(y, x * x, y * y * y).plus::<false>(x, y) + x.sign(),
            ]
        }
        for (x, y) in [(0.7, 1.3), (1.9, 0.4), (-0.8, 0.6)] {
            let dual = all(Dual::seeded(x, 0, 1.0), Dual::seeded(y, 1, 3.0));
            let plain = all(x, y);
            let step = 1e-6;
            let by_x = (all(x + step, y), all(x - step, y));
            let by_y = (all(x, y + step), all(x, y - step));
            for k in 0..plain.len() {
                assert!((dual[k].value - plain[k]).abs() < 1e-15 * plain[k].abs().max(1.0), "value {k}");
                for (way, (after, before), factor) in [(0, by_x, 1.0), (1, by_y, 3.0)] {
                    let want = factor * (after[k] - before[k]) / (2.0 * step);
                    assert!((dual[k].by.0[way] - want).abs() < 1e-8, "{k} by {way} at {x}, {y}");
                }
            }
        }
    }
}
