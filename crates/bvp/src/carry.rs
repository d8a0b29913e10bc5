//! The conditions at s = 1, carried from node to node as rows and reduced with pivoting at every one.

use crate::block::Block;
use crate::real::Real;

/// Transition of an element, `dz_{i+1} = g dz_i + affine[0] + affine[1] dlambda`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Transition<const N: usize> {
    pub(crate) by_state: Block<N>,
    pub(crate) affine: [[f64; N]; 2],
}

/// The right conditions carried to a node, reduced: `z[pivot[r]] + sum_free rows[r][free] z[free] = load[r]`. There are as many as
/// the problem has conditions at s = 1; what stands behind these means nothing.
#[derive(Debug, Clone, Copy)]
#[allow(clippy::struct_field_names, reason = "the rows are what the struct is named for")]
pub struct CarriedRows<const N: usize> {
    /// One in the column of the pivot, zero in those of other pivots.
    pub rows: [[f64; N]; N],
    /// The component of the state that each decides.
    pub pivot: [usize; N],
    /// Reduced = `reduction` times carried: for the adjoint, and for loads that come later.
    pub reduction: [[f64; N]; N],
    pub(crate) load: [[f64; 2]; N],
}

/// The sign and size of the determinant of the shooting matrix: of the conditions at s = 1 by the
/// states that the conditions at s = 0 leave free. It does not depend on the mesh, changes sign
/// where two solutions meet or cross, and is what tells branches apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Determinant {
    /// -1, 0 or 1.
    pub sign: f64,
    /// Natural logarithm of the size.
    pub log: f64,
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

    pub(crate) fn whole(self) -> Determinant {
        Determinant { sign: self.sign, log: self.log + self.rest.ln() }
    }
}

impl<const N: usize> CarriedRows<N> {
    /// Takes the first `count` rows of the `next` node through the transition that leads there.
    #[inline(always)]
    pub(crate) fn carry<const FUSED: bool>(&mut self, next: &Self, transition: &Transition<N>, count: usize) {
        for r in 0..count {
            let row = &next.rows[r];
            let mut own = [0.0; N];
            let mut load = next.load[r];
            for b in 0..N {
                for c in 0..N {
                    own[c] = own[c].plus::<FUSED>(row[b], transition.by_state[b][c]);
                }
                load[0] -= row[b] * transition.affine[0][b];
                load[1] -= row[b] * transition.affine[1][b];
            }
            self.rows[r] = own;
            self.load[r] = load;
        }
    }
}

/// The largest free entry that reduced rows may have on pivots that were not searched for.
const LARGEST_FREE: f64 = 8.0;

/// Reduces carried rows to the identity on their pivots; false, with the rows spoilt, when one is small or a free
/// entry comes out large.
#[inline(always)]
pub(crate) fn reduce_on<const FUSED: bool, const N: usize>(
    c: &mut CarriedRows<N>,
    count: usize,
    determinant: &mut Product,
) -> bool {
    let mut product = *determinant;
    for r in 0..N {
        c.reduction[r] = [0.0; N];
        c.reduction[r][r] = 1.0;
    }
    for r in 0..count {
        let column = c.pivot[r];
        let pivot = c.rows[r][column];
        let mut largest = 0.0_f64;
        for v in c.rows[r] {
            largest = largest.max(v.abs());
        }
        // The negation also catches NaN.
        #[allow(clippy::neg_cmp_op_on_partial_ord)]
        if !(pivot.abs() * LARGEST_FREE > largest) {
            return false;
        }
        product.times(pivot);
        eliminate_column::<FUSED, N>(c, count, r, column, 1.0 / pivot);
    }
    let mut fine = true;
    for r in 0..count {
        for v in c.rows[r] {
            fine &= v.abs() <= LARGEST_FREE;
        }
    }
    if fine {
        *determinant = product;
    }
    fine
}

/// Scales row `r` to one in `column` and clears that column in the other rows.
#[inline(always)]
fn eliminate_column<const FUSED: bool, const N: usize>(
    c: &mut CarriedRows<N>,
    count: usize,
    r: usize,
    column: usize,
    scale: f64,
) {
    let (mut own, mut load, mut reduction) = (c.rows[r], c.load[r], c.reduction[r]);
    for k in 0..N {
        own[k] *= scale;
        reduction[k] *= scale;
    }
    load[0] *= scale;
    load[1] *= scale;
    own[column] = 1.0;
    for i in 0..count {
        if i != r {
            let f = c.rows[i][column];
            for k in 0..N {
                c.rows[i][k] = c.rows[i][k].plus::<FUSED>(-f, own[k]);
                c.reduction[i][k] = c.reduction[i][k].plus::<FUSED>(-f, reduction[k]);
            }
            c.load[i][0] -= f * load[0];
            c.load[i][1] -= f * load[1];
            c.rows[i][column] = 0.0;
        }
    }
    (c.rows[r], c.load[r], c.reduction[r]) = (own, load, reduction);
}

/// Reduces on pivots of its own with a search for the largest entry of the remaining rows at every pivot, so that no
/// column is divided by something small; false where the rows are singular.
#[cold]
#[inline(never)]
pub(crate) fn reduce_on_largest<const N: usize>(
    c: &mut CarriedRows<N>,
    count: usize,
    determinant: &mut Product,
) -> bool {
    for r in 0..N {
        c.reduction[r] = [0.0; N];
        c.reduction[r][r] = 1.0;
    }
    for r in 0..count {
        let (mut row, mut column, mut largest) = (r, 0, 0.0);
        for i in r..count {
            for col in 0..N {
                if c.rows[i][col].abs() > largest {
                    (row, column, largest) = (i, col, c.rows[i][col].abs());
                }
            }
        }
        if largest == 0.0 || !largest.is_finite() {
            return false;
        }
        if row != r {
            c.rows.swap(row, r);
            c.load.swap(row, r);
            c.reduction.swap(row, r);
            determinant.sign = -determinant.sign;
        }
        c.pivot[r] = column;
        let pivot = c.rows[r][column];
        determinant.times(pivot);
        eliminate_column::<false, N>(c, count, r, column, 1.0 / pivot);
    }
    true
}

/// Multiplies by the determinant of a matrix.
#[inline(always)]
pub(crate) fn multiply_by_determinant<const N: usize>(mut m: Block<N>, product: &mut Product) {
    for k in 0..N {
        let mut best = k;
        for i in k + 1..N {
            if m[i][k].abs() > m[best][k].abs() {
                best = i;
            }
        }
        if best != k {
            m.swap(best, k);
            product.sign = -product.sign;
        }
        product.times(m[k][k]);
        if m[k][k] == 0.0 {
            return;
        }
        for i in k + 1..N {
            let f = m[i][k] / m[k][k];
            for c in k..N {
                m[i][c] -= f * m[k][c];
            }
        }
    }
}
