//! Static condensation: the stages of an element, its inner unknowns and its closure eliminated, four elements side by side.
//!
//! With z the state at the left node of an element, w the value that it takes over, and k the slopes at the stages, what is
//! left of the collocation equations between nodes is
//!
//! ```text
//! z_right = G z + G_w w + g        w_own = c . z + d w + e
//! ```
//!
//! With P = (1 - reach D/h)^-1 over stages and own end, D differentiating on these and the other end (`D_t`), the closure gives
//!
//! ```text
//! dw  = P (q + v . dz + reach D_t/h dw_t)                           q = change + reach t
//! dw' = t + W (q + v . dz) + omega dw_t                             W = D P/h
//! ```
//!
//! where t is what the slopes of the polynomial through w differ by from the closure slopes, and the stage equations
//!
//! ```text
//! dk_j = r_j + A_j dz_j + u_j dw'_j        dz_j = dz + h sum_l a_jl dk_l
//! ```

use crate::block::{
    Block, apply, balanced_inverse, determinant, inverse, invert_in_order, multiply, subtract_applied, subtract_product,
};
use crate::directions::Side;
use crate::gauss::{Gauss, POINTS};
use crate::groups::resize;
use crate::problem::{Inner, Local};
use crate::real::{LANES, Lanes, Real};

/// All groups of elements, condensed, in flat memory.
#[derive(Debug, Clone, Default)]
pub(crate) struct Condensed<const N: usize, const M: usize> {
    /// Whether rows and columns are brought to one size before an element is called singular.
    pub(crate) balances: bool,
    lu: Vec<Lanes>,
    by_state: Vec<Lanes>,
    by_taken: Vec<[Lanes; N]>,
    /// W, M + 1 rows a group.
    w: Vec<[Lanes; POINTS]>,
    pub(crate) closures: Vec<Closure<N, M>>,
}

/// The stage equations of a group in block LU: inverses on the diagonal, a unit upper part.
pub(crate) type BlockLu<const N: usize, const M: usize> = [[Block<N, Lanes>; M]];

/// A group of elements, condensed.
#[derive(Debug)]
pub(crate) struct GroupMut<'a, const N: usize, const M: usize> {
    pub(crate) balances: bool,
    pub(crate) lu: &'a mut BlockLu<N, M>,
    /// d (stage slopes) / d z.
    pub(crate) by_state: &'a mut [Block<N, Lanes>],
    /// d (stage slopes) / d w.
    pub(crate) by_taken: &'a mut [[Lanes; N]],
    /// W, without a closure variable nothing.
    pub(crate) w: &'a mut [[Lanes; POINTS]],
}

impl<const N: usize, const M: usize> Condensed<N, M> {
    /// Room for so many groups.
    pub(crate) fn resize(&mut self, groups: usize, closed: bool) {
        // What is new is written before it is read.
        let blank = Lanes::of(f64::NAN);
        resize(&mut self.lu, groups * M * M * N * N, blank);
        resize(&mut self.by_state, groups * M * N * N, blank);
        resize(&mut self.by_taken, groups * M, [blank; N]);
        let closures = if closed { groups } else { 0 };
        resize(&mut self.w, closures * (M + 1), [blank; POINTS]);
        resize(&mut self.closures, closures, Closure::blank());
    }

    /// Group `g`, and its closure where there is one.
    #[inline(always)]
    pub(crate) fn group_mut(&mut self, g: usize) -> (GroupMut<'_, N, M>, Option<&mut Closure<N, M>>) {
        let size = M * M * N * N;
        let lu = self.lu[g * size..(g + 1) * size].as_chunks_mut::<N>().0.as_chunks_mut::<N>().0.as_chunks_mut::<M>().0;
        let size = M * N * N;
        let by_state = self.by_state[g * size..(g + 1) * size].as_chunks_mut::<N>().0.as_chunks_mut::<N>().0;
        let by_taken = &mut self.by_taken[g * M..(g + 1) * M];
        let w = if self.w.is_empty() { &mut [] } else { &mut self.w[g * (M + 1)..(g + 1) * (M + 1)] };
        (GroupMut { balances: self.balances, lu, by_state, by_taken, w }, self.closures.get_mut(g))
    }

    #[inline(always)]
    pub(crate) fn lu(&self, g: usize) -> &BlockLu<N, M> {
        let size = M * M * N * N;
        self.lu[g * size..(g + 1) * size].as_chunks::<N>().0.as_chunks::<N>().0.as_chunks::<M>().0
    }

    /// d (stage slopes) / d z of group `g`.
    #[inline(always)]
    pub(crate) fn by_state(&self, g: usize) -> &[Block<N, Lanes>] {
        let size = M * N * N;
        self.by_state[g * size..(g + 1) * size].as_chunks::<N>().0.as_chunks::<N>().0
    }

    /// W of group `g`, of a problem with a closure variable.
    #[inline(always)]
    pub(crate) fn w(&self, g: usize) -> &[[Lanes; POINTS]] {
        &self.w[g * (M + 1)..(g + 1) * (M + 1)]
    }

    /// d (stage slopes) / d w of group `g`.
    #[inline(always)]
    pub(crate) fn by_taken(&self, g: usize) -> &[[Lanes; N]] {
        &self.by_taken[g * M..(g + 1) * M]
    }
}

/// The closure of a group of elements; point M is the own end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Closure<const N: usize, const M: usize> {
    pub(crate) omega: [Lanes; POINTS],
    /// The row of P of the own end.
    pub(crate) own: [Lanes; POINTS],
    /// d w_own / d w directly.
    pub(crate) own_by_taken: Lanes,
    /// d w_own / d (stage slopes), over the step.
    pub(crate) own_by_slopes: [[Lanes; N]; M],
    /// What the slopes of the polynomial through w differ by from the closure slopes.
    pub(crate) defect: [Lanes; POINTS],
    /// The slope at the other end, by what P leaves at the points, and by w.
    pub(crate) other: [Lanes; POINTS],
    pub(crate) other_by_taken: Lanes,
    /// The slope of the polynomial through w there.
    pub(crate) other_slope: Lanes,
    /// Whether a lane's own end is its right one: 0 or 1.
    pub(crate) right: Lanes,
}

impl<const N: usize, const M: usize> Closure<N, M> {
    fn blank() -> Self {
        let blank = Lanes::of(f64::NAN);
        Self {
            omega: [blank; POINTS],
            own: [blank; POINTS],
            own_by_taken: blank,
            own_by_slopes: [[blank; N]; M],
            defect: [blank; POINTS],
            other: [blank; POINTS],
            other_by_taken: blank,
            other_slope: blank,
            right: blank,
        }
    }

    /// What the closure slopes differ by from those of the polynomial through the values.
    #[inline(always)]
    fn take_defects<const FUSED: bool>(
        &mut self,
        inverse_h: Lanes,
        d: &[[Lanes; POINTS]; POINTS],
        values: &[Lanes; POINTS],
        slopes: &[Lanes; POINTS],
    ) {
        let slope = |m: usize| {
            let start = d[m][M + 1] * values[M + 1];
            inverse_h * (0..M + 1).fold(start, |sum, l| sum.plus::<FUSED>(d[m][l], values[l]))
        };
        for m in 0..M + 1 {
            self.defect[m] = slope(m) - slopes[m];
        }
        self.other_slope = slope(M + 1);
    }

    /// The same for the sides of a group's own ends.
    #[inline(always)]
    pub(crate) fn retake_defects<const FUSED: bool>(
        &mut self,
        h: Lanes,
        gauss: &Gauss<M>,
        sides: [Side; LANES],
        values: &[Lanes; POINTS],
        slopes: &[Lanes; POINTS],
    ) {
        let inverse_h = Lanes::of(1.0) / h;
        self.take_defects::<FUSED>(inverse_h, &differentiation(gauss, sides), values, slopes);
    }
}

/// The maps of an element, see the module.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Map<const N: usize> {
    pub(crate) by_state: Block<N>,
    pub(crate) by_taken: [f64; N],
    pub(crate) own_by_state: [f64; N],
    pub(crate) own_by_taken: f64,
}

/// A right side of a group and what it does to the stages, given z and w.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Column<const N: usize, const M: usize> {
    pub(crate) slopes: [[Lanes; N]; M],
    /// dw' at stages and own end.
    pub(crate) closure: [Lanes; POINTS],
    /// q, and the change of w in it.
    pub(crate) value: [Lanes; POINTS],
    pub(crate) change: [Lanes; POINTS],
}

/// The stage equations of a group without a closure variable.
#[inline(always)]
pub(crate) fn assemble<const N: usize, const M: usize, const Q: usize, const L: usize>(
    h: Lanes,
    gauss: &Gauss<M>,
    locals: &[Local<N, Q, L, Lanes>],
    out: &mut GroupMut<'_, N, M>,
) {
    let locals = &locals[..M];
    for j in 0..M {
        let jacobian = &locals[j].jacobian;
        for l in 0..M {
            let f = -(h * Lanes::of(gauss.a[j][l]));
            let block = &mut out.lu[j][l];
            for a in 0..N {
                for c in 0..N {
                    block[a][c] = f * jacobian[a][c];
                }
            }
        }
        for a in 0..N {
            out.lu[j][j][a][a] += Lanes::of(1.0);
        }
        out.by_state[j] = *jacobian;
    }
}

/// Eliminates the stages of a group from its stage equations; else the lane where that cannot be done. `product` is multiplied
/// by the determinants. For both kinds of equations, so that it is compiled once.
#[inline(always)]
pub(crate) fn eliminate<const FUSED: bool, const N: usize, const M: usize>(
    group: &mut GroupMut<'_, N, M>,
    is_closed: bool,
    product: &mut Lanes,
) -> Result<(), usize> {
    factorise::<FUSED, N, M>(group.lu, group.balances, product)?;
    solve_blocks::<FUSED, N, M>(group.lu, group.by_state);
    if is_closed {
        solve_column::<FUSED, N, M>(group.lu, group.by_taken);
    }
    Ok(())
}

/// Differentiation at the points of a closure on elements of length one.
#[inline(always)]
fn differentiation<const M: usize>(gauss: &Gauss<M>, sides: [Side; LANES]) -> [[Lanes; POINTS]; POINTS] {
    let mut d = [[Lanes::of(0.0); POINTS]; POINTS];
    if sides == [sides[0]; LANES] {
        let table = &gauss.closure[sides[0].index()];
        for m in 0..M + 2 {
            for l in 0..M + 2 {
                d[m][l] = Lanes::of(table[m][l]);
            }
        }
    } else {
        let right = Lanes(sides.map(Side::place));
        for m in 0..M + 2 {
            for l in 0..M + 2 {
                let [on_left, on_right] = [gauss.closure[0][m][l], gauss.closure[1][m][l]];
                d[m][l] = Lanes::of(on_left) + right * Lanes::of(on_right - on_left);
            }
        }
    }
    d
}

/// [`assemble`] with a closure variable: `own` is the own end, `values` w at the points including the one taken over, `slopes` w'
/// at stages and own end. `product` is multiplied by the determinant of the points; else the lane where these have no closure.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "the parts of an element")]
#[allow(clippy::too_many_lines, reason = "one elimination, whose steps share what they have at hand")]
pub(crate) fn assemble_closed<const FUSED: bool, const N: usize, const M: usize, const Q: usize, const L: usize>(
    h: Lanes,
    gauss: &Gauss<M>,
    sides: [Side; LANES],
    locals: &[Local<N, Q, L, Lanes>],
    own: &Inner<N, L, Lanes>,
    values: &[Lanes; POINTS],
    slopes: &[Lanes; POINTS],
    out: &mut GroupMut<'_, N, M>,
    closure: &mut Closure<N, M>,
    product: &mut Lanes,
) -> Result<(), usize> {
    let (locals, w) = (&locals[..M], &mut out.w[..M + 1]);
    let zero = Lanes::of(0.0);
    let inverse_h = Lanes::of(1.0) / h;
    // What the points have, side by side, so that loops over them choose nothing.
    let mut gradients = [[zero; N]; POINTS];
    let mut reaches = [zero; POINTS];
    for m in 0..M {
        (gradients[m], reaches[m]) = (locals[m].inner.value_gradient, inverse_h * locals[m].inner.reach);
    }
    (gradients[M], reaches[M]) = (own.value_gradient, inverse_h * own.reach);
    let right = Lanes(sides.map(Side::place));
    closure.right = right;
    let d = differentiation::<M>(gauss, sides);
    // P by elimination in order; the matrix is near one, or its largest entries stand on the diagonal.
    let mut p = [[zero; POINTS]; POINTS];
    for m in 0..M + 1 {
        for l in 0..M + 1 {
            p[m][l] = -(reaches[m] * d[m][l]);
        }
        p[m][m] += Lanes::of(1.0);
    }
    invert_points::<FUSED, M>(&mut p, product)?;
    closure.own = p[M];
    closure.take_defects::<FUSED>(inverse_h, &d, values, slopes);
    for m in 0..M + 1 {
        for l in 0..M + 1 {
            let mut sum = d[m][0] * p[0][l];
            for k in 1..M + 1 {
                sum = sum.plus::<FUSED>(d[m][k], p[k][l]);
            }
            w[m][l] = inverse_h * sum;
        }
    }
    let mut taken = [zero; POINTS];
    for m in 0..M + 1 {
        taken[m] = reaches[m] * d[m][M + 1];
    }
    for m in 0..M + 1 {
        let mut omega = inverse_h * d[m][M + 1];
        for l in 0..M + 1 {
            omega = omega.plus::<FUSED>(w[m][l], taken[l]);
        }
        closure.omega[m] = omega;
    }
    let (mut own_by_taken, mut other_by_taken) = (zero, inverse_h * d[M + 1][M + 1]);
    for m in 0..M + 1 {
        let mut other = zero;
        for k in 0..M + 1 {
            other = other.plus::<FUSED>(d[M + 1][k], p[k][m]);
        }
        let other = inverse_h * other;
        closure.other[m] = other;
        own_by_taken = own_by_taken.plus::<FUSED>(p[M][m], taken[m]);
        other_by_taken = other_by_taken.plus::<FUSED>(other, taken[m]);
    }
    (closure.own_by_taken, closure.other_by_taken) = (own_by_taken, other_by_taken);

    // Integrals up to stages and own end.
    let end = right;
    for l in 0..M {
        let mut own_by_slopes = [zero; N];
        for m in 0..M + 1 {
            let f = p[M][m] * if m < M { Lanes::of(gauss.a[m][l]) } else { end * Lanes::of(gauss.b[l]) };
            for a in 0..N {
                own_by_slopes[a] = own_by_slopes[a].plus::<FUSED>(f, gradients[m][a]);
            }
        }
        closure.own_by_slopes[l] = own_by_slopes;
    }
    // Minus h times these.
    let mut weights = [[zero; M]; POINTS];
    let minus = -h;
    for l in 0..M {
        for m in 0..M {
            weights[m][l] = minus * Lanes::of(gauss.a[m][l]);
        }
        weights[M][l] = minus * end * Lanes::of(gauss.b[l]);
    }
    for j in 0..M {
        let (jacobian, u) = (&locals[j].jacobian, &locals[j].by_closure);
        let mut by_state = [zero; N];
        for m in 0..M + 1 {
            for a in 0..N {
                by_state[a] = by_state[a].plus::<FUSED>(w[j][m], gradients[m][a]);
            }
        }
        for a in 0..N {
            for c in 0..N {
                out.by_state[j][a][c] = jacobian[a][c].plus::<FUSED>(u[a], by_state[c]);
            }
            out.by_taken[j][a] = u[a] * closure.omega[j];
        }
        for l in 0..M {
            let mut x = [zero; N];
            for m in 0..M + 1 {
                let f = w[j][m] * weights[m][l];
                for a in 0..N {
                    x[a] = x[a].plus::<FUSED>(f, gradients[m][a]);
                }
            }
            let f = weights[j][l];
            let block = &mut out.lu[j][l];
            for a in 0..N {
                for c in 0..N {
                    block[a][c] = (f * jacobian[a][c]).plus::<FUSED>(u[a], x[c]);
                }
            }
        }
        for a in 0..N {
            out.lu[j][j][a][a] += Lanes::of(1.0);
        }
    }
    Ok(())
}

/// Block LU without exchanges of blocks; the lane where that fails.
#[inline(always)]
fn factorise<const FUSED: bool, const N: usize, const M: usize>(
    m: &mut BlockLu<N, M>,
    balances: bool,
    product: &mut Lanes,
) -> Result<(), usize> {
    let m = &mut m[..M];
    for j in 0..M {
        let (upper, lower) = m.split_at_mut(j + 1);
        let (inv, row) = upper[j].split_at_mut(j + 1);
        let inv = &mut inv[j];
        let mut kept = *inv;
        let (fine, by) = invert_in_order::<FUSED, N, Lanes>(inv);
        *product = *product * by;
        if !(-fine).all_below(0.0) {
            invert_lanes(inv, &mut kept, fine, by, balances, product)?;
        }
        for block in row.iter_mut() {
            multiply::<FUSED, N, Lanes>(block, inv);
        }
        for i in j + 1..M {
            let (f, blocks) = lower[i - j - 1].split_at_mut(j + 1);
            for (block, of) in blocks.iter_mut().zip(row.iter()) {
                subtract_product::<FUSED, N, Lanes>(block, &f[j], of);
            }
        }
    }
    Ok(())
}

/// The lanes that are not fine, with pivoting.
#[cold]
#[inline(never)]
fn invert_lanes<const N: usize>(
    out: &mut Block<N, Lanes>,
    given: &mut Block<N, Lanes>,
    fine: Lanes,
    by: Lanes,
    balances: bool,
    product: &mut Lanes,
) -> Result<(), usize> {
    for lane in 0..LANES {
        if fine.0[lane] > 0.0 {
            continue;
        }
        let own: Block<N> = given.map(|row| row.map(|v| v.0[lane]));
        let inverse = if balances { balanced_inverse(&own, 1e-10) } else { inverse(&own, 1e-10) };
        let inverse = inverse.ok_or(lane)?;
        product.0[lane] = product.0[lane] / by.0[lane] * determinant(own);
        for a in 0..N {
            for c in 0..N {
                out[a][c].0[lane] = inverse[a][c];
            }
        }
    }
    Ok(())
}

/// Inverts the leading M + 1 rows and columns in place. With the own end first no entry grows, however long the reach is against
/// the element; with the stages first all digits are lost where it is longer than ten elements.
#[inline(always)]
fn invert_points<const FUSED: bool, const M: usize>(
    p: &mut [[Lanes; POINTS]; POINTS],
    product: &mut Lanes,
) -> Result<(), usize> {
    for step in 0..M + 1 {
        let k = if step == 0 { M } else { step - 1 };
        let pivot = p[k][k];
        // The comparison also catches NaN.
        if !(-pivot.abs()).all_below(-1e-9) {
            let lost = |lane: &usize| pivot.0[*lane].is_nan() || pivot.0[*lane].abs() <= 1e-9;
            return Err((0..LANES).find(lost).unwrap_or(0));
        }
        *product = *product * pivot;
        let scale = Lanes::of(1.0) / pivot;
        // Column k starts as that of one.
        p[k][k] = Lanes::of(1.0);
        let mut own = [Lanes::of(0.0); POINTS];
        for c in 0..M + 1 {
            own[c] = scale * p[k][c];
        }
        p[k] = own;
        for i in 0..M + 1 {
            if i != k {
                let f = p[i][k];
                p[i][k] = Lanes::of(0.0);
                for c in 0..M + 1 {
                    p[i][c] = p[i][c].plus::<FUSED>(f, -own[c]);
                }
            }
        }
    }
    Ok(())
}

/// Solves for one right side a stage in place.
#[inline(always)]
pub(crate) fn solve_column<const FUSED: bool, const N: usize, const M: usize>(
    lu: &BlockLu<N, M>,
    column: &mut [[Lanes; N]],
) {
    let (lu, column) = (&lu[..M], &mut column[..M]);
    for j in 0..M {
        column[j] = apply(&lu[j][j], &column[j]);
        let own = column[j];
        for i in j + 1..M {
            subtract_applied::<FUSED, N, Lanes>(&mut column[i], &lu[i][j], &own);
        }
    }
    for j in (0..M).rev() {
        for l in j + 1..M {
            let other = column[l];
            subtract_applied::<FUSED, N, Lanes>(&mut column[j], &lu[j][l], &other);
        }
    }
}

/// Solves for a block a stage in place.
#[inline(always)]
fn solve_blocks<const FUSED: bool, const N: usize, const M: usize>(lu: &BlockLu<N, M>, blocks: &mut [Block<N, Lanes>]) {
    let (lu, blocks) = (&lu[..M], &mut blocks[..M]);
    for j in 0..M {
        let (own, others) = blocks.split_at_mut(j + 1);
        let own = &mut own[j];
        multiply::<FUSED, N, Lanes>(own, &lu[j][j]);
        for i in j + 1..M {
            subtract_product::<FUSED, N, Lanes>(&mut others[i - j - 1], &lu[i][j], own);
        }
    }
    for j in (0..M).rev() {
        let (own, others) = blocks.split_at_mut(j + 1);
        for l in j + 1..M {
            subtract_product::<FUSED, N, Lanes>(&mut own[j], &lu[j][l], &others[l - j - 1]);
        }
    }
}

/// Solves the transposed equations for one right side a stage in place.
#[inline(always)]
pub(crate) fn solve_column_transposed<const N: usize, const M: usize>(
    lu: &BlockLu<N, M>,
    column: &mut [[Lanes; N]; M],
) {
    for j in 0..M {
        for l in 0..j {
            let other = column[l];
            subtract_transposed(&mut column[j], &lu[l][j], &other);
        }
    }
    for j in (0..M).rev() {
        for i in j + 1..M {
            let other = column[i];
            subtract_transposed(&mut column[j], &lu[i][j], &other);
        }
        let own = column[j];
        let mut out = [Lanes::of(0.0); N];
        subtract_transposed(&mut out, &lu[j][j], &own);
        column[j] = out.map(|v| -v);
    }
}

/// `out -= m^T v`.
#[inline(always)]
fn subtract_transposed<const N: usize>(out: &mut [Lanes; N], m: &Block<N, Lanes>, v: &[Lanes; N]) {
    for a in 0..N {
        for b in 0..N {
            out[b] -= m[a][b] * v[a];
        }
    }
}
