//! Condensation: the stages of an element are eliminated, alone or four elements side by side.

use crate::block::{Block, apply, inverse, invert_in_order, multiply, subtract_applied, subtract_product};
use crate::gauss::Gauss;
use crate::problem::Local;
use crate::real::{Lanes, Real};

/// The stages of a group of elements after they are eliminated.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stages<const N: usize, const M: usize> {
    /// d (stage slopes) / d z_i.
    pub(crate) response: [Block<N, Lanes>; M],
    /// Stage slopes due to the residual (0) and to the parameter (1).
    pub(crate) load: [[[Lanes; N]; M]; 2],
}

/// Eliminates the stages of one element: on return `response` and `load` hold the stage slopes they
/// lead to. Of `load`, the columns are the right sides given; `response` is written only.
#[inline(always)]
pub(crate) fn eliminate<const N: usize, const M: usize, const Q: usize>(
    h: f64,
    gauss: &Gauss<M>,
    locals: &[Local<N, Q>],
    response: &mut [Block<N>; M],
    load: &mut [[[f64; N]; M]],
) -> bool {
    let mut m = [[[[0.0; N]; N]; M]; M];
    let invert = |block: &mut Block<N>| match inverse(block, 1e-10) {
        Some(inverse) => {
            *block = inverse;
            true
        }
        None => false,
    };
    eliminate_by::<f64, false, N, M, Q>(invert, h, gauss, locals, &mut m, response, load)
}

/// [`eliminate`] for four elements, without exchanges; one, or zero where that is not fine.
#[inline(always)]
pub(crate) fn eliminate_in_order<const FUSED: bool, const N: usize, const M: usize, const Q: usize>(
    h: Lanes,
    gauss: &Gauss<M>,
    locals: &[Local<N, Q, Lanes>],
    m: &mut [[Block<N, Lanes>; M]; M],
    response: &mut [Block<N, Lanes>; M],
    load: &mut [[[Lanes; N]; M]],
) -> Lanes {
    let mut fine = Lanes::of(1.0);
    eliminate_by::<Lanes, FUSED, N, M, Q>(
        #[inline(always)]
        |block: &mut Block<N, Lanes>| {
            fine = fine.min(invert_in_order::<FUSED, N, Lanes>(block));
            true
        },
        h,
        gauss,
        locals,
        m,
        response,
        load,
    );
    fine
}

/// [`eliminate`] for one of four elements, whose loads are `given`.
#[cold]
#[inline(never)]
pub(crate) fn eliminate_lane<const N: usize, const M: usize, const Q: usize, const C: usize>(
    lane: usize,
    h: Lanes,
    gauss: &Gauss<M>,
    locals: &[Local<N, Q, Lanes>],
    given: &[[[Lanes; N]; M]; C],
    out: &mut Stages<N, M>,
) -> bool {
    let own: [Local<N, Q>; M] = std::array::from_fn(|j| locals[j].lane(lane));
    let mut load = given.map(|column| column.map(|stage| stage.map(|v| v.0[lane])));
    let mut response = [[[0.0; N]; N]; M];
    let done = eliminate(h.0[lane], gauss, &own, &mut response, &mut load);
    for j in 0..M {
        for a in 0..N {
            for b in 0..N {
                out.response[j][a][b].0[lane] = response[j][a][b];
            }
            for column in 0..C {
                out.load[column][j][a].0[lane] = load[column][j][a];
            }
        }
    }
    done
}

/// The elimination, given how a block is inverted in place. `m` is memory.
#[inline(always)]
fn eliminate_by<R: Real, const FUSED: bool, const N: usize, const M: usize, const Q: usize>(
    mut invert: impl FnMut(&mut Block<N, R>) -> bool,
    h: R,
    gauss: &Gauss<M>,
    locals: &[Local<N, Q, R>],
    m: &mut [[Block<N, R>; M]; M],
    response: &mut [Block<N, R>; M],
    load: &mut [[[R; N]; M]],
) -> bool {
    // Block row j of the equations is 1 - h J_j a_j., so all of the first row's blocks are multiples
    // of J_0, and one product J_i R_0 a row serves the whole first step.
    let one = R::of(1.0);
    let ha = |j: usize, l: usize| h * R::of(gauss.a[j][l]);
    let locals = &locals[..M];
    let inv = &mut m[0][0];
    set_scaled(inv, -ha(0, 0), &locals[0].jacobian);
    for a in 0..N {
        inv[a][a] += one;
    }
    if !invert(inv) {
        return false;
    }
    let (lead, rest) = response.split_at_mut(1);
    let lead = &mut lead[0];
    *lead = locals[0].jacobian;
    multiply::<FUSED, N, R>(lead, &m[0][0]);
    for column in load.iter_mut() {
        column[0] = apply(&m[0][0], &column[0]);
    }
    for l in 1..M {
        set_scaled(&mut m[0][l], -ha(0, l), lead);
    }
    for i in 1..M {
        let own = &locals[i].jacobian;
        let f = ha(i, 0);
        let mut next = *lead;
        multiply::<FUSED, N, R>(&mut next, own);
        for l in 1..M {
            let block = &mut m[i][l];
            let (by_own, by_next) = (-ha(i, l), -f * ha(0, l));
            for a in 0..N {
                for c in 0..N {
                    block[a][c] = (by_own * own[a][c]).plus::<FUSED>(by_next, next[a][c]);
                }
            }
        }
        for a in 0..N {
            m[i][i][a][a] += one;
        }
        for a in 0..N {
            for c in 0..N {
                rest[i - 1][a][c] = own[a][c].plus::<FUSED>(f, next[a][c]);
            }
        }
        for column in load.iter_mut() {
            let lead = apply(own, &column[0]);
            for a in 0..N {
                column[i][a] = column[i][a].plus::<FUSED>(f, lead[a]);
            }
        }
    }
    for j in 1..M {
        let (upper, lower) = m.split_at_mut(j + 1);
        let (inv, row) = upper[j].split_at_mut(j + 1);
        let inv = &mut inv[j];
        if !invert(inv) {
            return false;
        }
        for block in row.iter_mut() {
            multiply::<FUSED, N, R>(block, inv);
        }
        let (own, others) = response.split_at_mut(j + 1);
        let own = &mut own[j];
        multiply::<FUSED, N, R>(own, inv);
        for column in load.iter_mut() {
            column[j] = apply(inv, &column[j]);
        }
        for i in j + 1..M {
            let (f, blocks) = lower[i - j - 1].split_at_mut(j + 1);
            let f = &f[j];
            for (block, of) in blocks.iter_mut().zip(row.iter()) {
                subtract_product::<FUSED, N, R>(block, f, of);
            }
            subtract_product::<FUSED, N, R>(&mut others[i - j - 1], f, own);
            for column in load.iter_mut() {
                let lead = column[j];
                subtract_applied::<FUSED, N, R>(&mut column[i], f, &lead);
            }
        }
    }
    for j in (0..M).rev() {
        let (own, others) = response.split_at_mut(j + 1);
        for l in j + 1..M {
            subtract_product::<FUSED, N, R>(&mut own[j], &m[j][l], &others[l - j - 1]);
            for column in load.iter_mut() {
                let other = column[l];
                subtract_applied::<FUSED, N, R>(&mut column[j], &m[j][l], &other);
            }
        }
    }
    true
}

/// `out = f m` for one number `f`.
#[inline(always)]
fn set_scaled<const N: usize, R: Real>(out: &mut Block<N, R>, f: R, m: &Block<N, R>) {
    for a in 0..N {
        for c in 0..N {
            out[a][c] = f * m[a][c];
        }
    }
}
