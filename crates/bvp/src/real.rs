//! Numbers that equations are written in: one `f64`, or the same quantity in four elements side by side.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// What equations need of a number. Comparisons choose lane by lane.
pub trait Real:
    Copy
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// `value` in every lane.
    fn of(value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// `self` where it is less than `other`, else `other`.
    fn min(self, other: Self) -> Self;
    /// `other` where `self` is less, else `self`.
    fn max(self, other: Self) -> Self;
    /// -1, 0 or 1.
    fn sign(self) -> Self;
    /// `yes` where `self < other`, else `no`.
    fn if_less(self, other: Self, yes: Self, no: Self) -> Self;
    /// Whether `self < bound` in every lane.
    fn all_below(self, bound: f64) -> bool;
    /// `self + f m`, rounded once with `FUSED`: only for code compiled for a processor that can, because
    /// others take a hundred times as long.
    fn plus<const FUSED: bool>(self, f: Self, m: Self) -> Self;
}

/// Four numbers side by side, which the compiler turns into one vector.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(32))]
pub struct Lanes(
    /// The numbers.
    pub [f64; LANES],
);

/// Elements in one [`Lanes`].
pub const LANES: usize = 4;

/// `f` of every lane. Written out: a loop here is one for every operation of the equations, and the compiler takes as long
/// to unroll them all as for everything else.
#[inline(always)]
fn each_lane(f: impl Fn(usize) -> f64) -> Lanes {
    Lanes([f(0), f(1), f(2), f(3)])
}

macro_rules! lanewise {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                each_lane(|i| self.0[i] $op other.0[i])
            }
        }
    };
}
lanewise!(Add, add, +);
lanewise!(Sub, sub, -);
lanewise!(Mul, mul, *);
lanewise!(Div, div, /);

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|v| -v)
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Lanes {
    /// `f` of every number.
    #[inline(always)]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        each_lane(|i| f(self.0[i]))
    }
}

impl Real for Lanes {
    #[inline(always)]
    fn plus<const FUSED: bool>(self, f: Self, m: Self) -> Self {
        each_lane(|i| self.0[i].plus::<FUSED>(f.0[i], m.0[i]))
    }
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self([value; LANES])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.if_less(other, self, other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.if_less(other, other, self)
    }
    #[inline(always)]
    fn all_below(self, bound: f64) -> bool {
        let mut all = true;
        for v in self.0 {
            all &= v < bound;
        }
        all
    }
    #[inline(always)]
    fn sign(self) -> Self {
        self.map(sign)
    }
    #[inline(always)]
    fn if_less(self, other: Self, yes: Self, no: Self) -> Self {
        each_lane(|i| if self.0[i] < other.0[i] { yes.0[i] } else { no.0[i] })
    }
}

impl Real for f64 {
    #[inline(always)]
    fn plus<const FUSED: bool>(self, f: Self, m: Self) -> Self {
        if FUSED { f.mul_add(m, self) } else { self + f * m }
    }
    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self < other { other } else { self }
    }
    #[inline(always)]
    fn all_below(self, bound: f64) -> bool {
        self < bound
    }
    #[inline(always)]
    fn sign(self) -> Self {
        sign(self)
    }
    #[inline(always)]
    fn if_less(self, other: Self, yes: Self, no: Self) -> Self {
        if self < other { yes } else { no }
    }
}

#[inline(always)]
fn sign(v: f64) -> f64 {
    f64::from(u8::from(v > 0.0)) - f64::from(u8::from(v < 0.0))
}

/// The numbers `f(0)` to `f(K - 1)`: `std::array::from_fn`, but always inlined, as all has to be that
/// is compiled for more than one kind of processor.
#[inline(always)]
pub fn each<T: Copy + Default, const K: usize>(mut f: impl FnMut(usize) -> T) -> [T; K]
where
    [T; K]: Default,
{
    let mut out = <[T; K]>::default();
    for k in 0..K {
        out[k] = f(k);
    }
    out
}
