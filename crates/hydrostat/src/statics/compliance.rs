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
//! the projections onto fewer polynomials. Each polynomial is a load on the last linearisation.
//!
//! Where the lengths of taut cables are held, loads change their tensions by dt so that the strokes stay: with V the
//! strokes that loads make at fixed tensions, U the motion that tensions make, and B the strokes that they make,
//!
//! ```text
//! B dt + V load = 0        motion = C load + U dt = (C - U B^-1 V) load
//! ```
//!
//! An elastic cable has the length that its own stretch takes in B, and acts as the spring that it is.

use hydrostat_bvp::{Collocation, Correction, Forcing, LANES, Lanes, Mesh, StageForcing};

use crate::numerics::elimination::solved;
use crate::statics::engine::{M, respond};
use crate::statics::equations::{L, N, Q};

/// Fields: the motion along e1, along e2, and the turn.
pub(crate) const FIELDS: usize = 3;

/// Projection of the compliance onto polynomials: entry `[FIELDS k + f][FIELDS l + g]` is the part of polynomial
/// `k` in the motion of field `f` under a load of the shape of polynomial `l` in field `g`.
#[derive(Debug, Clone)]
pub(crate) struct Compliance {
    /// Polynomials a field.
    pub(crate) functions: usize,
    /// Whether lengths of cables are held.
    pub(crate) at_strokes: bool,
    entries: Vec<f64>,
    /// Strokes of the cables asked for under the same loads, one row a cable.
    strokes: Vec<f64>,
}

impl Compliance {
    /// With `functions` polynomials a field, about the last linearisation of `system` on `mesh`; `strokes` gives what a
    /// change of the solution reels in of each cable asked for.
    pub(crate) fn new(
        system: &Collocation<N, M, Q, L>,
        mesh: &Mesh,
        functions: usize,
        cables: usize,
        strokes: impl Fn(&Collocation<N, M, Q, L>, &Correction<N, M, Q, L>) -> Vec<f64>,
    ) -> Self {
        let columns = FIELDS * functions;
        let mut out = Self {
            functions,
            at_strokes: false,
            entries: vec![0.0; columns * columns],
            strokes: vec![0.0; cables * columns],
        };
        let basis = Basis::new(&system.gauss.c, mesh, functions);
        let mut change = Forcing { stages: vec![StageForcing::default(); basis.blocks], ..Forcing::default() };
        let mut response = Correction::default();
        for column in 0..columns {
            let (l, g) = (column / FIELDS, column % FIELDS);
            for (block, forcing) in change.stages.iter_mut().enumerate() {
                forcing.slope = [Lanes::default(); N];
                // (n_f, m_f)' = -load.
                forcing.slope[1 + g] = -basis.value(l, block);
            }
            respond(system, &change, &mut response);
            let motion = project(system, &basis, &response, &Forcing::default());
            for (k, moved) in motion.iter().enumerate() {
                out.entries[k * columns + column] = *moved;
            }
            for (i, stroke) in strokes(system, &response).into_iter().enumerate() {
                out.strokes[i * columns + column] = stroke;
            }
        }
        out
    }

    /// Holds the lengths of the cables asked for: `motions` are the projections of what unit tensions move, `strokes`
    /// what they reel in of all of them. `None` where the cables have no tensions for their lengths.
    pub(crate) fn hold(&mut self, motions: &[Vec<f64>], strokes: &[Vec<f64>]) -> Option<()> {
        let (count, columns) = (motions.len(), FIELDS * self.functions);
        self.at_strokes = true;
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

/// Polynomials at the stages of a mesh, in blocks.
pub(crate) struct Basis {
    functions: usize,
    blocks: usize,
    /// Value, and integral to the tip, of each polynomial.
    values: Vec<[Lanes; 2]>,
}

impl Basis {
    pub(crate) fn new(c: &[f64; M], mesh: &Mesh, functions: usize) -> Self {
        let groups = hydrostat_bvp::Groups { elements: mesh.elements(), stages: M };
        let blocks = groups.count() * M;
        let mut values = vec![[Lanes::default(); 2]; functions * blocks];
        for block in 0..blocks {
            for lane in 0..LANES {
                let i = groups.element(block / M, lane);
                let s = mesh.nodes()[i] + mesh.step(i) * c[block % M];
                polynomials(
                    s,
                    |k, value, rest| {
                        let own = &mut values[k * blocks + block];
                        own[0].0[lane] = value;
                        own[1].0[lane] = rest;
                    },
                    functions,
                );
            }
        }
        Self { functions, blocks, values }
    }

    fn value(&self, k: usize, block: usize) -> Lanes {
        self.both(k, block)[0]
    }

    /// Polynomial `k` in a block of stations, and its integral from there to the tip.
    pub(crate) fn both(&self, k: usize, block: usize) -> [Lanes; 2] {
        self.values[k * self.blocks + block]
    }
}

/// Projection of the motion in a response, as the rows of a compliance are; `change` is what it responds to, beside
/// loads along the arm.
pub(crate) fn project(
    system: &Collocation<N, M, Q, L>,
    basis: &Basis,
    response: &Correction<N, M, Q, L>,
    change: &Forcing<N, Q, L>,
) -> Vec<f64> {
    let states = system.moved_states(response);
    let elements = response.by_element.len();
    let mut out = vec![0.0; FIELDS * basis.functions];
    for (block, local) in system.locals().iter().enumerate() {
        let (g, j) = (block / M, block % M);
        let mut moved = [Lanes::default(), Lanes::default(), states[block][0]];
        for q in 0..Q {
            moved[q] = local.rate_by_closure[q] * response.stages[block].closure_slope;
            for a in 0..N {
                moved[q] += local.rate_gradient[q][a] * states[block][a];
            }
            if let Some(forcing) = change.stages.get(block) {
                moved[q] += forcing.rate[q];
            }
        }
        let mut weight = Lanes::default();
        for lane in 0..LANES.min(elements - g * LANES) {
            weight.0[lane] = system.steps()[g].0[lane] * system.gauss.b[j];
        }
        for k in 0..basis.functions {
            let [value, rest] = basis.both(k, block);
            for f in 0..FIELDS {
                // What x' adds at a place, x has from there to the tip.
                let by = weight * moved[f] * if f < 2 { rest } else { value };
                out[FIELDS * k + f] += by.0.iter().sum::<f64>();
            }
        }
    }
    out
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
