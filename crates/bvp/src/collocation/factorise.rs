//! The linearised problem: elements condensed, the rest factorised between nodes.

use super::closing::Closing;
use super::{Collocation, LinearisationError, Singular};
use crate::block::add_scaled;
use crate::condense::{Map, assemble, assemble_closed, eliminate};
use crate::determinant::Product;
use crate::directions::Side;
use crate::gauss::POINTS;
use crate::groups::resize;
use crate::problem::{Condition, Problem};
use crate::real::{LANES, Lanes, Real};
use crate::solution::Solution;

impl<const N: usize, const M: usize, const Q: usize, const L: usize> Collocation<N, M, Q, L> {
    /// Evaluates and factorises.
    ///
    /// # Errors
    /// [`LinearisationError`].
    #[inline(always)]
    pub fn linearise<P: Problem<N, Q, L>, const FUSED: bool>(
        &mut self,
        problem: &P,
        solution: &Solution<N, M, L>,
    ) -> Result<(), LinearisationError<P::Failure>> {
        self.evaluate::<P, FUSED>(problem, solution).map_err(LinearisationError::Slopes)?;
        self.factorise::<P, FUSED>(problem, solution).map_err(LinearisationError::Singular)
    }

    /// Factorises what was evaluated last.
    ///
    /// # Errors
    /// [`Singular`].
    #[inline(always)]
    pub fn factorise<P: Problem<N, Q, L>, const FUSED: bool>(
        &mut self,
        problem: &P,
        solution: &Solution<N, M, L>,
    ) -> Result<(), Singular> {
        let groups = self.groups;
        let mut product = Product::new();
        self.condensed.resize(groups.count(), self.directions.is_closed());
        let blank = Map { by_state: [[0.0; N]; N], by_taken: [0.0; N], own_by_state: [0.0; N], own_by_taken: 0.0 };
        resize(&mut self.maps, groups.elements, blank);
        for g in 0..groups.count() {
            let mut own_product = Lanes::of(1.0);
            self.condense::<FUSED>(g, &mut own_product).map_err(|lane| Singular::Element(groups.element(g, lane)))?;
            for lane in 0..groups.filled(g) {
                if own_product.0[lane] < 0.0 {
                    product.turn();
                }
            }
            self.map_group::<FUSED>(g);
        }
        self.close(&mut product)?;
        let (left, right) = self.take_conditions(problem, solution);
        let left_count = problem.left_count();
        self.determinant = self
            .panels
            .factorise::<FUSED>(&self.maps, &self.directions, &left[..left_count], &right[..N - left_count], product)
            .ok_or(Singular::System)?;
        Ok(())
    }

    /// Evaluates, and keeps the factors of the last linearisation, on the same mesh with the same own ends: [`Collocation::newton`] gives the
    /// simplified correction then, new residual and old factors.
    ///
    /// # Errors
    /// Those of the problem.
    #[inline(always)]
    pub fn simplify<P: Problem<N, Q, L>, const FUSED: bool>(
        &mut self,
        problem: &P,
        solution: &Solution<N, M, L>,
    ) -> Result<(), P::Failure> {
        self.evaluate::<P, FUSED>(problem, solution)?;
        if const { L > 0 } && self.directions.is_closed() {
            for g in 0..self.groups.count() {
                let (values, slopes) = self.closure_at(g);
                let (h, sides) = (self.steps[g], self.directions.ends[g].sides);
                self.condensed.closures[g].retake_defects::<FUSED>(h, &self.gauss, sides, &values, &slopes);
            }
            for closing in &mut self.closings {
                let slope = self.condensed.closures[closing.element / LANES].other_slope;
                let own = self.end_stations[closing.block].closure_slope.0[closing.lane];
                closing.defect = slope.0[closing.element % LANES] - own;
            }
        }
        self.take_conditions(problem, solution);
        Ok(())
    }

    /// The closure variable at the points of a group, and its slopes at stages and own end.
    #[inline(always)]
    fn closure_at(&self, g: usize) -> ([Lanes; POINTS], [Lanes; POINTS]) {
        let zero = Lanes::of(0.0);
        let (mut values, mut slopes) = ([zero; POINTS], [zero; POINTS]);
        for j in 0..M {
            values[j] = self.locals[g * M + j].inner.value;
            slopes[j] = self.stations[g * M + j].closure_slope;
        }
        values[M] = self.ends[g].value;
        slopes[M] = self.end_stations[g].closure_slope;
        for lane in 0..LANES {
            let (block, from) = self.directions.end_taken(self.groups.element(g, lane));
            values[M + 1].0[lane] = self.ends[block].value.0[from];
        }
        (values, slopes)
    }

    /// The conditions at both ends of a solution, their residuals put into the right side.
    ///
    /// After it, and an evaluation at the solution, [`Collocation::newton`] gives the simplified correction: new residual, old factors. (Without a
    /// closure variable: [`Collocation::simplify`] has its defects.)
    #[inline(always)]
    pub(crate) fn take_conditions<P: Problem<N, Q, L>>(
        &mut self,
        problem: &P,
        solution: &Solution<N, M, L>,
    ) -> ([Condition<N>; N], [Condition<N>; N]) {
        let (mut left, mut right) = ([Condition::default(); N], [Condition::default(); N]);
        problem.left(&solution.nodes[0], &mut left);
        problem.right(&solution.nodes[self.groups.elements], &mut right);
        for r in 0..N {
            (self.memory.loads.left[r], self.memory.loads.right[r]) = (-left[r].residual, -right[r].residual);
        }
        (left, right)
    }

    /// Condenses a group; else the lane whose stages cannot be eliminated.
    #[inline(always)]
    fn condense<const FUSED: bool>(&mut self, g: usize, product: &mut Lanes) -> Result<(), usize> {
        let is_closed = const { L > 0 } && self.directions.is_closed();
        if is_closed {
            self.assemble_closed::<FUSED>(g, product)?;
        } else {
            let locals = &self.locals[g * M..(g + 1) * M];
            let (mut group, _) = self.condensed.group_mut(g);
            assemble::<N, M, Q, L>(self.steps[g], &self.gauss, locals, &mut group);
        }
        let (mut group, _) = self.condensed.group_mut(g);
        eliminate::<FUSED, N, M>(&mut group, is_closed, product)
    }

    #[inline(always)]
    fn assemble_closed<const FUSED: bool>(&mut self, g: usize, product: &mut Lanes) -> Result<(), usize> {
        let (values, slopes) = self.closure_at(g);
        let locals = &self.locals[g * M..(g + 1) * M];
        let (mut group, Some(closure)) = self.condensed.group_mut(g) else { return Err(0) };
        assemble_closed::<FUSED, N, M, Q, L>(
            self.steps[g],
            &self.gauss,
            self.directions.ends[g].sides,
            locals,
            &self.ends[g],
            &values,
            &slopes,
            &mut group,
            closure,
            product,
        )
    }

    /// The maps of the elements of a group.
    #[inline(always)]
    fn map_group<const FUSED: bool>(&mut self, g: usize) {
        let (groups, h) = (self.groups, self.steps[g]);
        let (by_stages, by_taken_stages) = (self.condensed.by_state(g), self.condensed.by_taken(g));
        let zero = Lanes::of(0.0);
        let mut by_state = [[zero; N]; N];
        for a in 0..N {
            by_state[a][a] = Lanes::of(1.0);
        }
        for j in 0..M {
            let w = h * Lanes::of(self.gauss.b[j]);
            add_scaled::<FUSED, N, Lanes>(&mut by_state, w, &by_stages[j]);
        }
        for lane in 0..groups.filled(g) {
            let out = &mut self.maps[g * LANES + lane];
            for a in 0..N {
                for b in 0..N {
                    out.by_state[a][b] = by_state[a][b].0[lane];
                }
            }
        }
        if const { L == 0 } || !self.directions.is_closed() {
            return;
        }
        let closure = &self.condensed.closures[g];
        let mut by_taken = [zero; N];
        let mut own_by_state = [zero; N];
        let mut own_by_taken = closure.own_by_taken;
        for m in 0..M + 1 {
            let inner = self.inner_at(g, m);
            for a in 0..N {
                own_by_state[a] += closure.own[m] * inner.value_gradient[a];
            }
        }
        for j in 0..M {
            let w = h * Lanes::of(self.gauss.b[j]);
            for a in 0..N {
                let s = h * closure.own_by_slopes[j][a];
                by_taken[a] += w * by_taken_stages[j][a];
                own_by_taken += s * by_taken_stages[j][a];
                for b in 0..N {
                    own_by_state[b] = own_by_state[b].plus::<FUSED>(s, by_stages[j][a][b]);
                }
            }
        }
        for lane in 0..groups.filled(g) {
            let out = &mut self.maps[g * LANES + lane];
            out.by_taken = by_taken.map(|v| v.0[lane]);
            out.own_by_state = own_by_state.map(|v| v.0[lane]);
            out.own_by_taken = own_by_taken.0[lane];
        }
    }

    /// Puts what closing elements take over into their maps.
    fn close(&mut self, product: &mut Product) -> Result<(), Singular> {
        self.closings.clear();
        self.closings.reserve(self.directions.closings.len());
        for (k, &i) in self.directions.closings.iter().enumerate() {
            let (block, lane) = (self.groups.count() + k / LANES, k % LANES);
            let closing = self.closing(i, block, lane, product).ok_or(Singular::Element(i))?;
            let map = &mut self.maps[i];
            for a in 0..N {
                for b in 0..N {
                    map.by_state[a][b] += map.by_taken[a] * closing.row[b];
                }
                map.own_by_state[a] += map.own_by_taken * closing.row[a];
            }
            map.by_taken = [0.0; N];
            map.own_by_taken = 0.0;
            self.closings.push(closing);
        }
        Ok(())
    }

    fn closing(&self, i: usize, block: usize, lane: usize, product: &mut Product) -> Option<Closing<N, M>> {
        let (g, own) = (i / LANES, i % LANES);
        let (map, closure) = (&self.maps[i], &self.condensed.closures[g]);
        let h = self.steps[g].0[own];
        let at = |v: Lanes| v.0[own];
        let other = &self.ends[block];
        let reach = other.reach.0[lane];
        let at_right = self.directions.side(i) == Side::Left;
        // Slopes at the other end by the values at the points, and by those that P leaves.
        let defect = at(closure.other_slope) - self.end_stations[block].closure_slope.0[lane];
        let by_point = closure.other.map(|v| v.0[own]);
        let slope_by_taken = at(closure.other_by_taken);
        let mut by_slopes = [[0.0; N]; M];
        let mut row = [0.0; N];
        for m in 0..M + 1 {
            let gradient = self.inner_at(g, m).value_gradient.map(|v| v.0[own]);
            for a in 0..N {
                row[a] += by_point[m] * gradient[a];
            }
            for l in 0..M {
                let weight = if m < M { self.gauss.a[m][l] } else { at(closure.right) * self.gauss.b[l] };
                for a in 0..N {
                    by_slopes[l][a] += h * weight * by_point[m] * gradient[a];
                }
            }
        }
        let end_gradient = other.value_gradient.map(|v| v.0[lane]);
        for a in 0..N {
            row[a] = reach * row[a] + end_gradient[a];
            for l in 0..M {
                by_slopes[l][a] *= reach;
                if at_right {
                    by_slopes[l][a] += h * self.gauss.b[l] * end_gradient[a];
                }
            }
        }
        let mut by_taken = reach * slope_by_taken;
        for l in 0..M {
            for a in 0..N {
                by_taken += by_slopes[l][a] * at(self.condensed.by_taken(g)[l][a]);
                for b in 0..N {
                    row[b] += by_slopes[l][a] * at(self.condensed.by_state(g)[l][a][b]);
                }
            }
        }
        let left = 1.0 - by_taken;
        if left == 0.0 || !left.is_finite() {
            return None;
        }
        if left < 0.0 {
            product.turn();
        }
        let scale = 1.0 / left;
        Some(Closing {
            element: i,
            block,
            lane,
            row: row.map(|v| scale * v),
            by_change: scale,
            by_defect: scale * reach,
            defect,
            by_value: by_point.map(|v| scale * reach * v),
            by_slopes: by_slopes.map(|v| v.map(|v| scale * v)),
            slope_by_point: by_point,
            slope_by_taken,
            by_taken: map.by_taken,
            own_by_taken: map.own_by_taken,
        })
    }
}
