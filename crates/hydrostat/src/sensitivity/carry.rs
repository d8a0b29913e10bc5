//! beta that elements take over from their neighbours (`beta_along/carried`), in the differentiated equations.
//!
//! The changes v of what is taken over are unknowns beside those of [`Linear`], which answers for given ones. Each is a functional of the
//! answer, and of the next one: v = f + G v with as many rows as there are such elements, few and only in arms squeezed hard.

use nalgebra::{DMatrix, DVector, Dyn, LU};

use super::linear::{Drift, Functional, Linear, Response};
use crate::beta_along::{BetaAlong, Side};

pub(super) struct Carry {
    /// All elements of the arm.
    elements: usize,
    /// Those that take beta over.
    taking: Vec<usize>,
    /// beta where it is taken from, but for what that element takes over itself.
    taken: Vec<Functional>,
    /// The change of the solution with each.
    responses: Vec<Response>,
    /// 1 - G.
    system: LU<f64, Dyn, Dyn>,
}

impl Carry {
    /// `None` where it is singular.
    pub(super) fn new(linear: &Linear, beta: &BetaAlong, elements: usize) -> Option<Self> {
        let all = (0..elements).filter_map(|i| beta.carried(i).map(|from| (i, from)));
        let (taking, from): (Vec<usize>, Vec<(Side, usize)>) = all.unzip();
        let end = |side: Side| usize::from(side == Side::Left);
        let taken: Vec<_> = from.iter().map(|(side, other)| linear.beta_at_end(beta, *other, end(*side))).collect();
        let none = Drift::default();
        let responses: Vec<_> = taking
            .iter()
            .map(|i| {
                let mut known = vec![0.0; elements];
                known[*i] = 1.0;
                linear.response_given(&none, &known)
            })
            .collect();
        let system = DMatrix::from_fn(taking.len(), taking.len(), |row, column| {
            let own = f64::from(u8::from(row == column));
            // What is taken from an element that takes its own over moves along with that.
            let along = f64::from(u8::from(from[row].1 == taking[column]));
            own - along - linear.apply(&taken[row], &responses[column], &none)
        });
        let system = system.lu();
        system.is_invertible().then_some(Self { elements, taking, taken, responses, system })
    }

    /// The change of what every element takes over, given the change of the solution without it.
    pub(super) fn known(&self, linear: &Linear, response: &Response, drift: &Drift) -> Vec<f64> {
        let given = self.taken.iter().map(|taken| linear.apply(taken, response, drift));
        let mut out = vec![0.0; self.elements];
        if let Some(known) = self.system.solve(&DVector::from_iterator(self.taking.len(), given)) {
            for (i, known) in self.taking.iter().zip(known.iter()) {
                out[*i] = *known;
            }
        }
        out
    }

    /// The functional on solutions without changes of what is taken over that comes to `functional` on those with them.
    pub(super) fn with_known(&self, linear: &Linear, functional: &Functional) -> Functional {
        let none = Drift::default();
        let by_known = self.responses.iter().map(|response| linear.apply(functional, response, &none));
        let mut weights = DVector::from_iterator(self.taking.len(), by_known);
        let mut out = functional.padded();
        // By the transposed system: P A = L U, so A^T w = b is U^T L^T P w = b.
        let (l, u) = (self.system.l(), self.system.u());
        u.tr_solve_upper_triangular_mut(&mut weights);
        l.tr_solve_lower_triangular_mut(&mut weights);
        self.system.p().inv_permute_rows(&mut weights);
        for (taken, weight) in self.taken.iter().zip(weights.iter()) {
            out.add(*weight, taken);
        }
        out
    }
}
