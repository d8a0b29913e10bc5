//! Small fixed matrices: products and inverses.

/// An `N` by `N` matrix, row by row.
pub(crate) type Block<const N: usize> = [[f64; N]; N];

/// `out += f m`, row by row so that a row is one vector.
#[inline(always)]
pub(crate) fn add_product<const N: usize>(out: &mut Block<N>, f: &Block<N>, m: &Block<N>) {
    for a in 0..N {
        let mut row = out[a];
        for b in 0..N {
            for c in 0..N {
                row[c] += f[a][b] * m[b][c];
            }
        }
        out[a] = row;
    }
}

/// `out -= f m`.
#[inline(always)]
pub(crate) fn subtract_product<const N: usize>(out: &mut Block<N>, f: &Block<N>, m: &Block<N>) {
    for a in 0..N {
        let mut row = out[a];
        for b in 0..N {
            for c in 0..N {
                row[c] -= f[a][b] * m[b][c];
            }
        }
        out[a] = row;
    }
}

/// `f m`.
#[inline(always)]
pub(crate) fn product<const N: usize>(f: &Block<N>, m: &Block<N>) -> Block<N> {
    let mut out = [[0.0; N]; N];
    add_product(&mut out, f, m);
    out
}

/// `f v`.
#[inline(always)]
pub(crate) fn apply<const N: usize>(f: &Block<N>, v: &[f64; N]) -> [f64; N] {
    let mut out = [0.0; N];
    for a in 0..N {
        for b in 0..N {
            out[a] += f[a][b] * v[b];
        }
    }
    out
}

/// `out += f m` for one number `f`.
#[inline(always)]
pub(crate) fn add_scaled<const N: usize>(out: &mut Block<N>, f: f64, m: &Block<N>) {
    for a in 0..N {
        for c in 0..N {
            out[a][c] += f * m[a][c];
        }
    }
}

/// `f m` for one number `f`.
#[inline(always)]
pub(crate) fn scaled<const N: usize>(f: f64, m: &Block<N>) -> Block<N> {
    let mut out = [[0.0; N]; N];
    add_scaled(&mut out, f, m);
    out
}

/// `out -= f v`.
#[inline(always)]
pub(crate) fn subtract_applied<const N: usize>(out: &mut [f64; N], f: &Block<N>, v: &[f64; N]) {
    for a in 0..N {
        let mut sum = 0.0;
        for b in 0..N {
            sum += f[a][b] * v[b];
        }
        out[a] -= sum;
    }
}

/// Inverse; `None` when a pivot is below `smallest` times the largest entry of the matrix given.
///
/// Rows are first eliminated in the order in which they stand, which keeps every row one vector;
/// where that would divide by a small pivot, with pivoting.
#[inline(always)]
pub(crate) fn inverse<const N: usize>(m: &Block<N>, smallest: f64) -> Option<Block<N>> {
    match inverse_in_order(m) {
        Some(inverse) => Some(inverse),
        None => inverse_with_pivoting(*m, smallest),
    }
}

/// A pivot below this share of what stands under it would lose digits.
const SMALL_PIVOT: f64 = 0.1;

/// Inverse in place by Gauss–Jordan elimination without exchanges; `None` when a pivot is small
/// against the largest entry of the matrix given or against what stands under it.
#[inline(always)]
fn inverse_in_order<const N: usize>(given: &Block<N>) -> Option<Block<N>> {
    let mut m = *given;
    let mut columns = [0.0_f64; N];
    for row in &m {
        for c in 0..N {
            columns[c] = columns[c].max(row[c].abs());
        }
    }
    let largest = columns.iter().fold(0.0_f64, |a, b| a.max(*b));
    let mut fine = largest < f64::INFINITY;
    for k in 0..N {
        let pivot = m[k][k].abs();
        fine &= pivot > 1e-3 * largest;
        for i in k + 1..N {
            fine &= pivot >= SMALL_PIVOT * m[i][k].abs();
        }
        let scale = 1.0 / m[k][k];
        // Column k is replaced by choice, not by storing into a row: a row that was stored in
        // parts cannot be loaded as one vector until all of it has reached the cache.
        let mut own = [0.0; N];
        for c in 0..N {
            own[c] = scale * if c == k { 1.0 } else { m[k][c] };
        }
        for i in 0..N {
            if i != k {
                let f = m[i][k];
                let mut row = [0.0; N];
                for c in 0..N {
                    row[c] = if c == k { 0.0 } else { m[i][c] } - f * own[c];
                }
                m[i] = row;
            }
        }
        m[k] = own;
    }
    fine.then_some(m)
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
