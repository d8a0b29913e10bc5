//! How far a configuration gives way to small loads along it: the inverse of its full tangent.
//!
//! A load of the force (f_x, f_y) and the couple c per length moves the arm by (x, y, theta), to first
//! order and in the solver's units, with the jacobian J(s) of the slopes (beta' among what it follows):
//!
//! ```text
//! z' = J z - (0, f_x, f_y, c)      (x, y)' = G z        z = (theta, n_f, m_f)
//! theta(0) = x(0) = y(0) = 0       the right conditions of the equilibrium, differentiated
//! ```
//!
//! The map from loads to motion is compact. It is projected onto shifted Legendre polynomials,
//! orthonormal on [0, 1], the same for each of the three fields: a matrix, whose leading blocks are
//! the projections onto fewer polynomials. The eliminated stages and the rows that carry the right conditions from node to
//! node are those of the last linearisation, [`hydrostat_bvp::Collocation`]; the polynomials are loads on it, all at once.
//!
//! Where the lengths of taut cables are held, loads change their tensions by dt so that the strokes stay: with V the
//! strokes that loads make at fixed tensions, U the motion that tensions make, and B the strokes that they make,
//!
//! ```text
//! B dt + V load = 0        motion = C load + U dt = (C - U B^-1 V) load
//! ```
//!
//! An elastic cable has the length that its own stretch takes in B, and acts as the spring that it is.

use hydrostat_bvp::{CarriedRows, Collocation, Gauss, Mesh};

use crate::elimination::solved;
use crate::engine::M;
use crate::equilibrium::{N, Q};

/// Fields: the motion along e1, along e2, and the turn.
pub(crate) const FIELDS: usize = 3;
/// Conditions at the tip.
const RIGHT: usize = N - 1;
/// Loads at the stages of an element.
const LOADS: usize = FIELDS * M;
/// What an element depends on: the state at its left node, and the loads at its stages.
const GIVEN: usize = N + LOADS;

/// Projection of the compliance onto polynomials: entry `[FIELDS k + f][FIELDS l + g]` is the part of polynomial
/// `k` in the motion of field `f` under a load of the shape of polynomial `l` in field `g`.
#[derive(Debug, Clone)]
pub(crate) struct Compliance {
    /// Polynomials a field.
    pub(crate) functions: usize,
    /// Whether lengths of cables are held.
    pub(crate) held: bool,
    entries: Vec<f64>,
    /// Strokes of the cables asked for under the same loads, one row a cable.
    strokes: Vec<f64>,
}

/// An element after its stages are eliminated.
struct Element {
    /// The state at its right node.
    end: [[f64; GIVEN]; N],
    /// Slopes of x and y, and theta, at each stage.
    motion: [[[f64; GIVEN]; FIELDS]; M],
    /// What it adds to the stroke of each cable asked for.
    strokes: Vec<[f64; GIVEN]>,
}

impl Compliance {
    /// With `functions` polynomials a field, about the state of the last linearisation of `system` on
    /// `mesh`; `cables` are the derivatives of strokes by the state at the stages of every element, times the weights of the
    /// stages. `None` where the linear system is singular.
    #[inline(always)]
    pub(crate) fn new(
        system: &Collocation<N, M, Q>,
        mesh: &Mesh,
        functions: usize,
        cables: &[Vec<[[f64; N]; M]>],
    ) -> Option<Self> {
        let n = mesh.elements();
        let columns = FIELDS * functions;
        let basis = basis(&system.gauss, mesh, functions);
        let basis_of = |i: usize| &basis[i * functions..(i + 1) * functions];
        let elements = (0..n).map(|i| Element::new(system, i, mesh.step(i), cables)).collect::<Option<Vec<_>>>()?;
        let loads = row_loads(system, &elements, &basis, functions);

        // From the base: theta(0) = 0 and the rows there.
        let mut state = vec![0.0; N * columns];
        let mut next = vec![0.0; N * columns];
        for (state, by) in state.chunks_exact_mut(columns).zip(system.start()) {
            add_rows(&by[N - RIGHT..], &loads[..RIGHT * columns], state);
        }
        let mut entries = vec![0.0; columns * columns];
        let mut strokes = vec![0.0; cables.len() * columns];
        let mut moved = vec![0.0; columns];
        for i in 0..n {
            let (element, basis) = (&elements[i], basis_of(i));
            let h = mesh.step(i);
            for j in 0..M {
                let weight = h * system.gauss.b[j];
                for f in 0..FIELDS {
                    moved.fill(0.0);
                    let by = &element.motion[j][f];
                    add_rows(&by[..N], &state, &mut moved);
                    add_loads(by, 1.0, basis, &mut moved);
                    for k in 0..functions {
                        // What x' adds at a place, x has from there to the tip.
                        let test = weight * basis[k][usize::from(f < 2)][j];
                        let row = &mut entries[(FIELDS * k + f) * columns..][..columns];
                        for (entry, motion) in row.iter_mut().zip(&moved) {
                            *entry += test * motion;
                        }
                    }
                }
            }
            for (by, row) in element.strokes.iter().zip(strokes.chunks_exact_mut(columns)) {
                add_rows(&by[..N], &state, row);
                add_loads(by, 1.0, basis, row);
            }
            for a in 0..N {
                let own = &mut next[a * columns..(a + 1) * columns];
                own.fill(0.0);
                add_rows(&element.end[a][..N], &state, own);
                add_loads(&element.end[a], 1.0, basis, own);
            }
            impose(system.rows(i + 1), &loads[(i + 1) * RIGHT * columns..][..RIGHT * columns], &mut next);
            std::mem::swap(&mut state, &mut next);
        }
        Some(Self { functions, held: false, entries, strokes })
    }

    /// Holds the lengths of the cables asked for: `motions` are the projections of what unit tensions move, `strokes` what
    /// they reel in of all of them. `None` where the cables have no tensions for their lengths.
    pub(crate) fn hold(&mut self, motions: &[Vec<f64>], strokes: &[Vec<f64>]) -> Option<()> {
        let (count, columns) = (motions.len(), FIELDS * self.functions);
        self.held = true;
        for column in 0..columns {
            let row = |i: usize| {
                let under_load = self.strokes[i * columns + column];
                (strokes.iter().map(|by| by[i]).collect(), [-under_load, 0.0])
            };
            let (tensions, _) = solved((0..count).map(row).collect())?;
            for ([tension, _], motion) in tensions.iter().zip(motions) {
                for (k, moved) in motion.iter().enumerate() {
                    self.entries[k * columns + column] += tension * moved;
                }
            }
        }
        Some(())
    }

    /// The entry of row `i` and column `j`.
    pub(crate) fn entry(&self, i: usize, j: usize) -> f64 {
        self.entries[i * FIELDS * self.functions + j]
    }
}

/// Projection of a motion (x', y' and theta at a stage of an element) onto polynomials, as the rows of a compliance are.
pub(crate) fn project(
    gauss: &Gauss<M>,
    mesh: &Mesh,
    functions: usize,
    motion: impl Fn(usize, usize) -> [f64; FIELDS],
) -> Vec<f64> {
    let mut out = vec![0.0; FIELDS * functions];
    for i in 0..mesh.elements() {
        for j in 0..M {
            let (weight, moved) = (mesh.step(i) * gauss.b[j], motion(i, j));
            polynomials(
                mesh.nodes()[i] + mesh.step(i) * gauss.c[j],
                |k, value, rest| {
                    for f in 0..FIELDS {
                        out[FIELDS * k + f] += weight * moved[f] * if f < 2 { rest } else { value };
                    }
                },
                functions,
            );
        }
    }
    out
}

/// The polynomials and their integrals to the tip at the stages of every element, element by element.
#[inline(always)]
fn basis(gauss: &Gauss<M>, mesh: &Mesh, functions: usize) -> Vec<[[f64; M]; 2]> {
    let mut out = vec![[[0.0; M]; 2]; mesh.elements() * functions];
    for (i, own) in out.chunks_exact_mut(functions).enumerate() {
        for j in 0..M {
            polynomials(
                mesh.nodes()[i] + mesh.step(i) * gauss.c[j],
                |k, value, rest| {
                    own[k][0][j] = value;
                    own[k][1][j] = rest;
                },
                functions,
            );
        }
    }
    out
}

/// What the rows at every node, which every state meets, ask for under each polynomial: carried from the tip, which has no
/// loads of its own.
#[inline(always)]
fn row_loads(
    system: &Collocation<N, M, Q>,
    elements: &[Element],
    basis: &[[[f64; M]; 2]],
    functions: usize,
) -> Vec<f64> {
    let (n, columns) = (elements.len(), FIELDS * functions);
    let size = RIGHT * columns;
    let mut loads = vec![0.0; (n + 1) * size];
    let mut carried = vec![0.0; size];
    for i in (0..n).rev() {
        let (own, next) = loads[i * size..(i + 2) * size].split_at_mut(size);
        carried.copy_from_slice(next);
        for (row, carried) in system.rows(i + 1).rows[..RIGHT].iter().zip(carried.chunks_exact_mut(columns)) {
            let mut by = [0.0; GIVEN];
            for (factor, end) in row.iter().zip(&elements[i].end) {
                for (by, end) in by.iter_mut().zip(end) {
                    *by += factor * end;
                }
            }
            add_loads(&by, -1.0, &basis[i * functions..(i + 1) * functions], carried);
        }
        for (own, by) in own.chunks_exact_mut(columns).zip(&system.rows(i).reduction) {
            add_rows(&by[..RIGHT], &carried, own);
        }
    }
    loads
}

/// `out += by rows`, the rows being as long as `out`.
#[inline(always)]
fn add_rows(by: &[f64], rows: &[f64], out: &mut [f64]) {
    for (factor, row) in by.iter().zip(rows.chunks_exact(out.len())) {
        for (o, v) in out.iter_mut().zip(row) {
            *o += factor * v;
        }
    }
}

/// `out += factor by[N..] loads`, the loads being the polynomials at the stages of the element.
#[inline(always)]
fn add_loads(by: &[f64; GIVEN], factor: f64, basis: &[[[f64; M]; 2]], out: &mut [f64]) {
    for (out, polynomial) in out.chunks_exact_mut(FIELDS).zip(basis) {
        for f in 0..FIELDS {
            let mut sum = 0.0;
            for j in 0..M {
                sum += by[N + FIELDS * j + f] * polynomial[0][j];
            }
            out[f] += factor * sum;
        }
    }
}

/// Gives `out` the first `count` orthonormal polynomials on [0, 1] at `s`: index, value, and integral from `s` to 1.
#[inline(always)]
fn polynomials(s: f64, mut out: impl FnMut(usize, f64, f64), count: usize) {
    let x = 2.0 * s - 1.0;
    let (mut before, mut now) = (1.0, 1.0);
    for k in 0..count {
        let degree = k as f64;
        let next = if k == 0 { x } else { ((2.0 * degree + 1.0) * x * now - degree * before) / (degree + 1.0) };
        let norm = (2.0 * degree + 1.0).sqrt();
        let rest = if k == 0 { 1.0 - s } else { norm * (before - next) / (2.0 * (2.0 * degree + 1.0)) };
        out(k, norm * now, rest);
        (before, now) = (now, next);
    }
}

impl Element {
    /// From k_j = J_j (z + h sum a_jl k_l) - (0, f_x, f_y, c)_j for the stage slopes k.
    #[inline(always)]
    fn new(system: &Collocation<N, M, Q>, i: usize, h: f64, cables: &[Vec<[[f64; N]; M]>]) -> Option<Self> {
        let gauss = &system.gauss;
        let mut by_load = [[[0.0; N]; M]; LOADS];
        for j in 0..M {
            for f in 0..FIELDS {
                by_load[FIELDS * j + f][j][1 + f] = -1.0;
            }
        }
        let by_state = system.eliminate(i, &mut by_load)?;
        // The state after the weights of a quadrature.
        let state = |weights: &[f64; M]| {
            let mut z = [[0.0; GIVEN]; N];
            for a in 0..N {
                z[a][a] = 1.0;
                for l in 0..M {
                    let w = h * weights[l];
                    for c in 0..N {
                        z[a][c] += w * by_state[l][a][c];
                    }
                    for c in 0..LOADS {
                        z[a][N + c] += w * by_load[c][l][a];
                    }
                }
            }
            z
        };
        let motion = std::array::from_fn(|j| {
            let z = state(&gauss.a[j]);
            let rate_gradient = system.local(i, j).rate_gradient;
            let mut out = [[0.0; GIVEN], [0.0; GIVEN], z[0]];
            for q in 0..Q {
                for b in 0..N {
                    for c in 0..GIVEN {
                        out[q][c] += rate_gradient[q][b] * z[b][c];
                    }
                }
            }
            out
        });
        let stroke = |gradients: &Vec<[[f64; N]; M]>| {
            let mut out = [0.0; GIVEN];
            for (weights, gradient) in gauss.a.iter().zip(&gradients[i]) {
                let z = state(weights);
                for (by, z) in gradient.iter().zip(&z) {
                    for (out, z) in out.iter_mut().zip(z) {
                        *out += by * z;
                    }
                }
            }
            out
        };
        let strokes = cables.iter().map(stroke).collect();
        Some(Self { end: state(&gauss.b), motion, strokes })
    }
}

/// The components of the states, column by column, that the rows decide, from the one that they leave free.
#[inline(always)]
fn impose(rows: &CarriedRows<N>, loads: &[f64], states: &mut [f64]) {
    let columns = states.len() / N;
    let pivots = &rows.pivot[..RIGHT];
    let free = (0..N).find(|c| !pivots.contains(c)).unwrap_or(0);
    for r in 0..RIGHT {
        let f = rows.rows[r][free];
        for c in 0..columns {
            states[pivots[r] * columns + c] = loads[r * columns + c] - f * states[free * columns + c];
        }
    }
}
