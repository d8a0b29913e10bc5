//! Small fixed matrices of numbers, or of four numbers side by side: products and inverses.

use crate::real::Real;

/// An `N` by `N` matrix, row by row.
pub(crate) type Block<const N: usize, R = f64> = [[R; N]; N];

/// `out -= f m`.
#[inline(always)]
pub(crate) fn subtract_product<const FUSED: bool, const N: usize, R: Real>(
    out: &mut Block<N, R>,
    f: &Block<N, R>,
    m: &Block<N, R>,
) {
    if FUSED {
        subtract_product_inline::<true, N, R>(out, f, m);
    } else {
        subtract_product_called(out, f, m);
    }
}

/// [`subtract_product`] without fused multiply-add, compiled once: what no recent processor runs is not worth the time
/// that copies in every elimination take to compile.
#[inline(never)]
fn subtract_product_called<const N: usize, R: Real>(out: &mut Block<N, R>, f: &Block<N, R>, m: &Block<N, R>) {
    subtract_product_inline::<false, N, R>(out, f, m);
}

/// [`subtract_product`], column by column, so that four blocks side by side stay in registers.
#[inline(always)]
fn subtract_product_inline<const FUSED: bool, const N: usize, R: Real>(
    out: &mut Block<N, R>,
    f: &Block<N, R>,
    m: &Block<N, R>,
) {
    for c in 0..N {
        let mut column = [R::of(0.0); N];
        for b in 0..N {
            column[b] = -m[b][c];
        }
        for a in 0..N {
            let mut sum = out[a][c];
            for b in 0..N {
                sum = sum.plus::<FUSED>(f[a][b], column[b]);
            }
            out[a][c] = sum;
        }
    }
}

/// `out = f out`.
#[inline(always)]
pub(crate) fn multiply<const FUSED: bool, const N: usize, R: Real>(out: &mut Block<N, R>, f: &Block<N, R>) {
    if FUSED {
        multiply_inline::<true, N, R>(out, f);
    } else {
        multiply_called(out, f);
    }
}

/// [`multiply`] as [`subtract_product_called`].
#[inline(never)]
fn multiply_called<const N: usize, R: Real>(out: &mut Block<N, R>, f: &Block<N, R>) {
    multiply_inline::<false, N, R>(out, f);
}

#[inline(always)]
fn multiply_inline<const FUSED: bool, const N: usize, R: Real>(out: &mut Block<N, R>, f: &Block<N, R>) {
    for c in 0..N {
        let mut column = [R::of(0.0); N];
        for b in 0..N {
            column[b] = out[b][c];
        }
        for a in 0..N {
            let mut sum = f[a][0] * column[0];
            for b in 1..N {
                sum = sum.plus::<FUSED>(f[a][b], column[b]);
            }
            out[a][c] = sum;
        }
    }
}

/// `f v`.
#[inline(always)]
pub(crate) fn apply<const N: usize, R: Real>(f: &Block<N, R>, v: &[R; N]) -> [R; N] {
    let mut out = [R::of(0.0); N];
    for a in 0..N {
        for b in 0..N {
            out[a] += f[a][b] * v[b];
        }
    }
    out
}

/// `out += f m` for one number `f`.
#[inline(always)]
pub(crate) fn add_scaled<const FUSED: bool, const N: usize, R: Real>(out: &mut Block<N, R>, f: R, m: &Block<N, R>) {
    for a in 0..N {
        for c in 0..N {
            out[a][c] = out[a][c].plus::<FUSED>(f, m[a][c]);
        }
    }
}

/// `out -= f v`.
#[inline(always)]
pub(crate) fn subtract_applied<const FUSED: bool, const N: usize, R: Real>(
    out: &mut [R; N],
    f: &Block<N, R>,
    v: &[R; N],
) {
    for a in 0..N {
        let mut sum = out[a];
        for b in 0..N {
            sum = sum.plus::<FUSED>(f[a][b], -v[b]);
        }
        out[a] = sum;
    }
}

/// Inverse; `None` when a pivot is below `smallest` times the largest entry of the matrix given.
///
/// Rows are first eliminated in the order in which they stand, which keeps every row one vector;
/// where that would divide by a small pivot, with pivoting.
#[inline(always)]
pub(crate) fn inverse<const N: usize>(m: &Block<N>, smallest: f64) -> Option<Block<N>> {
    let mut inverse = *m;
    let (fine, _) = invert_in_order::<false, N, f64>(&mut inverse);
    if fine > 0.0 { Some(inverse) } else { inverse_with_pivoting(*m, smallest) }
}

/// [`inverse`] of a matrix whose unknowns and equations may be of very different sizes: rows and columns are first brought
/// to one size, by powers of two, and `smallest` is over that.
pub(crate) fn balanced_inverse<const N: usize>(m: &Block<N>, smallest: f64) -> Option<Block<N>> {
    let (mut rows, mut columns) = ([1.0; N], [1.0; N]);
    for _ in 0..4 {
        let mut changed = false;
        for a in 0..N {
            let power = levelling((0..N).fold(0.0_f64, |most, c| most.max((rows[a] * m[a][c] * columns[c]).abs())));
            rows[a] *= power;
            changed |= power != 1.0;
        }
        for c in 0..N {
            let power = levelling((0..N).fold(0.0_f64, |most, a| most.max((rows[a] * m[a][c] * columns[c]).abs())));
            columns[c] *= power;
            changed |= power != 1.0;
        }
        if !changed {
            break;
        }
    }
    let mut scaled = *m;
    for a in 0..N {
        for c in 0..N {
            scaled[a][c] *= rows[a] * columns[c];
        }
    }
    let mut out = inverse(&scaled, smallest)?;
    for a in 0..N {
        for c in 0..N {
            out[a][c] *= columns[a] * rows[c];
        }
    }
    Some(out)
}

/// The power of two by whose square a size comes to [1, 4), read from its exponent; 1 for zero and what is no number.
fn levelling(size: f64) -> f64 {
    if !(size > 0.0 && size.is_finite()) {
        return 1.0;
    }
    // Exponents are stored with 1023 more: 1023 - floor((stored - 1023)/2).
    let stored = size.to_bits() >> 52;
    f64::from_bits((1535 - ((stored + 1) >> 1)) << 52)
}

/// A pivot below this fraction of what stands under it would lose digits.
const SMALL_PIVOT: f64 = 0.1;

/// Steps of an elimination that are compiled one by one.
const APART: usize = 4;

/// Inverse in place by Gauss–Jordan elimination without exchanges. Returns one, or zero where a pivot is
/// small against the largest entry of the matrix given or against what stands under it; and the determinant.
#[inline(always)]
pub(crate) fn invert_in_order<const FUSED: bool, const N: usize, R: Real>(m: &mut Block<N, R>) -> (R, R) {
    let (zero, one) = (R::of(0.0), R::of(1.0));
    let mut columns = [zero; N];
    for row in m.iter() {
        for c in 0..N {
            columns[c] = columns[c].max(row[c].abs());
        }
    }
    let mut largest = zero;
    for column in columns {
        largest = largest.max(column);
    }
    let mut fine = largest.if_less(R::of(f64::INFINITY), one, zero);
    let least = R::of(1e-3) * largest;
    let mut product = one;
    // Steps one by one, so that each is compiled for its column.
    if N > 0 {
        invert_step::<FUSED, N, R>(m, 0, least, &mut fine, &mut product);
    }
    if N > 1 {
        invert_step::<FUSED, N, R>(m, 1, least, &mut fine, &mut product);
    }
    if N > 2 {
        invert_step::<FUSED, N, R>(m, 2, least, &mut fine, &mut product);
    }
    if N > 3 {
        invert_step::<FUSED, N, R>(m, 3, least, &mut fine, &mut product);
    }
    for k in APART..N {
        invert_step::<FUSED, N, R>(m, k, least, &mut fine, &mut product);
    }
    (fine, product)
}

#[inline(always)]
fn invert_step<const FUSED: bool, const N: usize, R: Real>(
    m: &mut Block<N, R>,
    k: usize,
    least: R,
    fine: &mut R,
    product: &mut R,
) {
    let (zero, one) = (R::of(0.0), R::of(1.0));
    let pivot = m[k][k].abs();
    *fine = least.if_less(pivot, *fine, zero);
    let mut below = zero;
    for i in k + 1..N {
        below = below.max(m[i][k].abs());
    }
    if k + 1 < N {
        *fine = pivot.if_less(R::of(SMALL_PIVOT) * below, zero, *fine);
    }
    *product = *product * m[k][k];
    let scale = one / m[k][k];
    // Column k is replaced by choice, not by storing into a row: a row that was stored in
    // parts cannot be loaded as one vector until all of it has reached the cache.
    let mut own = [zero; N];
    for c in 0..N {
        own[c] = if c == k { scale } else { scale * m[k][c] };
    }
    for i in 0..N {
        if i != k {
            let f = m[i][k];
            let mut row = [zero; N];
            for c in 0..N {
                row[c] = if c == k { -(f * own[c]) } else { m[i][c].plus::<FUSED>(f, -own[c]) };
            }
            m[i] = row;
        }
    }
    m[k] = own;
}

/// Determinant, with pivoting.
pub(crate) fn determinant<const N: usize>(mut m: Block<N>) -> f64 {
    let mut product = 1.0;
    for k in 0..N {
        let best = (k..N).fold(k, |best, i| if m[i][k].abs() > m[best][k].abs() { i } else { best });
        if best != k {
            m.swap(best, k);
            product = -product;
        }
        product *= m[k][k];
        if m[k][k] == 0.0 {
            return 0.0;
        }
        for i in k + 1..N {
            let f = m[i][k] / m[k][k];
            for c in k..N {
                m[i][c] -= f * m[k][c];
            }
        }
    }
    product
}

/// Inverse by Gauss–Jordan elimination with partial pivoting.
#[cold]
#[inline(never)]
fn inverse_with_pivoting<const N: usize>(mut m: Block<N>, smallest: f64) -> Option<Block<N>> {
    let mut inv = [[0.0; N]; N];
    for a in 0..N {
        inv[a][a] = 1.0;
    }
    let mut largest = 0.0_f64;
    for row in &m {
        for v in row {
            largest = largest.max(v.abs());
        }
    }
    for k in 0..N {
        let mut best = k;
        for i in k + 1..N {
            if m[i][k].abs() > m[best][k].abs() {
                best = i;
            }
        }
        // The negation also catches NaN.
        #[allow(clippy::neg_cmp_op_on_partial_ord)]
        if !(m[best][k].abs() > smallest * largest) {
            return None;
        }
        if best != k {
            m.swap(k, best);
            inv.swap(k, best);
        }
        let scale = 1.0 / m[k][k];
        for c in 0..N {
            m[k][c] *= scale;
            inv[k][c] *= scale;
        }
        let (row, inv_row) = (m[k], inv[k]);
        for i in 0..N {
            if i != k {
                let f = m[i][k];
                for c in 0..N {
                    m[i][c] -= f * row[c];
                    inv[i][c] -= f * inv_row[c];
                }
            }
        }
    }
    Some(inv)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levelling_brings_sizes_to_one_and_four_and_no_further() {
        for size in [1e-300, 3e-7, 0.25, 0.99, 1.0, 3.99, 4.0, 7.0, 1e12, 1e300] {
            let level = levelling(size);
            let levelled = level * size * level;
            assert!((1.0..4.0).contains(&levelled), "{size}: {levelled}");
            assert_eq!(level.log2().fract(), 0.0, "{size}: {level} is no power of two");
        }
        assert_eq!([0.0, f64::NAN, f64::INFINITY].map(levelling), [1.0; 3]);
    }

    #[test]
    fn a_matrix_of_very_different_sizes_is_inverted_to_rounding() {
        let (rows, columns) = ([1e-9, 1.0, 1e7], [1e5, 1e-8, 1.0]);
        let plain = [[2.0, 1.0, 0.5], [1.0, -3.0, 1.0], [0.5, 1.0, 4.0]];
        let m: Block<3> = std::array::from_fn(|a| std::array::from_fn(|c| rows[a] * plain[a][c] * columns[c]));
        let inverse = balanced_inverse(&m, 1e-10).unwrap();
        for a in 0..3 {
            for c in 0..3 {
                let product: f64 = (0..3).map(|k| m[a][k] * inverse[k][c]).sum();
                let wanted = if a == c { 1.0 } else { 0.0 };
                assert!((product - wanted).abs() * rows[c] / rows[a] < 1e-13, "{a}, {c}: {product}");
            }
        }
    }
}
