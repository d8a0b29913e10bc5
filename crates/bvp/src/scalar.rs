//! Numbers that a stranger's equations are written in: `f64`, or numbers that carry derivatives along.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number with the elementary functions: `f64`, or a dual number with exact first derivatives ([`Dual`]).
///
/// `f64` constants stand on the right: `x * 2.0`, `x + 1.0`; or become numbers by `R::from(2.0)`.
pub trait Scalar:
    Copy
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// The number without its derivatives.
    fn value(self) -> f64;
    /// `f(self)`, given the value and the slope of `f` there: for functions that are not among these.
    fn chain(self, value: f64, slope: f64) -> Self;

    /// Sine.
    #[inline]
    fn sin(self) -> Self {
        let (sin, cos) = self.value().sin_cos();
        self.chain(sin, cos)
    }
    /// Cosine.
    #[inline]
    fn cos(self) -> Self {
        let (sin, cos) = self.value().sin_cos();
        self.chain(cos, -sin)
    }
    /// Exponential.
    #[inline]
    fn exp(self) -> Self {
        let exp = self.value().exp();
        self.chain(exp, exp)
    }
    /// Natural logarithm.
    #[inline]
    fn ln(self) -> Self {
        self.chain(self.value().ln(), 1.0 / self.value())
    }
    /// Square root.
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.value().sqrt();
        self.chain(root, 0.5 / root)
    }
    /// Hyperbolic sine.
    #[inline]
    fn sinh(self) -> Self {
        self.chain(self.value().sinh(), self.value().cosh())
    }
    /// Hyperbolic cosine.
    #[inline]
    fn cosh(self) -> Self {
        self.chain(self.value().cosh(), self.value().sinh())
    }
    /// Hyperbolic tangent.
    #[inline]
    fn tanh(self) -> Self {
        let tanh = self.value().tanh();
        self.chain(tanh, 1.0 - tanh * tanh)
    }
    /// Integer power.
    #[inline]
    fn powi(self, n: i32) -> Self {
        let v = self.value();
        self.chain(v.powi(n), if n == 0 { 0.0 } else { f64::from(n) * v.powi(n - 1) })
    }
    /// Power with a constant exponent.
    #[inline]
    fn powf(self, exponent: f64) -> Self {
        let v = self.value();
        self.chain(v.powf(exponent), exponent * v.powf(exponent - 1.0))
    }
    /// Absolute value; its slope at zero is taken to be zero.
    #[inline]
    fn abs(self) -> Self {
        let v = self.value();
        self.chain(v.abs(), f64::from(u8::from(v > 0.0)) - f64::from(u8::from(v < 0.0)))
    }
}

impl Scalar for f64 {
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
    #[inline(always)]
    fn chain(self, value: f64, _: f64) -> f64 {
        value
    }
}

/// A dual number: a value with its derivatives by `N` unknowns (forward-mode differentiation).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<const N: usize> {
    /// The value.
    pub value: f64,
    /// Its derivatives by the unknowns.
    pub derivative: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// The unknown of this index, at a value.
    #[inline]
    pub fn unknown(index: usize, value: f64) -> Self {
        let mut derivative = [0.0; N];
        derivative[index] = 1.0;
        Self { value, derivative }
    }

    /// `value`, with the derivatives `a x' + b y'`.
    #[inline(always)]
    fn of(value: f64, a: f64, x: &Self, b: f64, y: &Self) -> Self {
        let mut derivative = [0.0; N];
        for k in 0..N {
            derivative[k] = a * x.derivative[k] + b * y.derivative[k];
        }
        Self { value, derivative }
    }
}

impl<const N: usize> From<f64> for Dual<N> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self { value, derivative: [0.0; N] }
    }
}

impl<const N: usize> Scalar for Dual<N> {
    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { value, derivative: self.derivative.map(|d| slope * d) }
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::of(self.value + other.value, 1.0, &self, 1.0, &other)
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::of(self.value - other.value, 1.0, &self, -1.0, &other)
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::of(self.value * other.value, other.value, &self, self.value, &other)
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let (inverse, value) = (1.0 / other.value, self.value / other.value);
        Self::of(value, inverse, &self, -value * inverse, &other)
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl<const N: usize> Add<f64> for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl<const N: usize> Sub<f64> for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: f64) -> Self {
        Self { value: self.value - other, ..self }
    }
}

impl<const N: usize> Mul<f64> for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self.chain(self.value * other, other)
    }
}

impl<const N: usize> Div<f64> for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: f64) -> Self {
        self.chain(self.value / other, 1.0 / other)
    }
}

impl<const N: usize> AddAssign for Dual<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for Dual<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation once, at a place where none of them is special.
    fn all<R: Scalar>(x: R, y: R) -> R {
        let a = (x * y + x / y - y) * 2.0 - 1.0;
        let b = (x.sin() + y.cos()) * x.exp() + (y + 2.0).ln() + y.sqrt() / 3.0;
        let c = x.sinh() - y.cosh() * x.tanh() + x.powi(3) + y.powf(1.5) + (-x).abs();
        let mut sum = a + b;
        sum += c;
        sum -= x.powi(0);
        sum
    }

    #[test]
    fn derivatives_of_dual_numbers_match_differences() {
        let (x, y, step) = (0.7, 1.3, 1e-5);
        let exact = all(Dual::<2>::unknown(0, x), Dual::unknown(1, y));
        assert_eq!(exact.value, all(x, y));
        let by_x = (all(x + step, y) - all(x - step, y)) / (2.0 * step);
        let by_y = (all(x, y + step) - all(x, y - step)) / (2.0 * step);
        assert!((exact.derivative[0] - by_x).abs() < 1e-8, "{exact:?} {by_x}");
        assert!((exact.derivative[1] - by_y).abs() < 1e-8, "{exact:?} {by_y}");
    }
}
