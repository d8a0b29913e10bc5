//! Small fixed matrices: products and a pivoted inverse.

/// An `N` by `N` matrix, row by row.
pub(crate) type Block<const N: usize> = [[f64; N]; N];

/// `out += f m`, row by row so that a row is one vector.
#[inline(always)]
pub(crate) fn add_product<const N: usize>(out: &mut Block<N>, f: &Block<N>, m: &Block<N>) {
    for a in 0..N {
        for b in 0..N {
            for c in 0..N {
                out[a][c] += f[a][b] * m[b][c];
            }
        }
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

/// Inverse by Gauss–Jordan elimination with partial pivoting; `None` when a pivot is below
/// `smallest` times the largest entry of its column in the matrix given.
#[inline(always)]
pub(crate) fn inverse<const N: usize>(mut m: Block<N>, smallest: f64) -> Option<Block<N>> {
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
