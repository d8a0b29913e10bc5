//! The stations of a discrete solution, and the problem evaluated there.

use super::Collocation;
use crate::directions::Side;
use crate::gauss::POINTS;
use crate::groups::{Groups, resize};
use crate::problem::{Inner, Local, Problem, Station};
use crate::real::{LANES, Lanes, Real};
use crate::solution::{End, Solution, Stage};

impl<const N: usize, const M: usize, const Q: usize, const L: usize> Collocation<N, M, Q, L> {
    /// Takes the stations of a solution: states at the stages and ends.
    #[inline(always)]
    pub fn take_stations(&mut self, solution: &Solution<N, M, L>) {
        let groups = solution.groups();
        self.groups = groups;
        let zero = Lanes::of(0.0);
        let blank = Station { z: [zero; N], inner: [zero; L], closure_slope: zero };
        resize(&mut self.steps, groups.count(), zero);
        resize(&mut self.stations, groups.count() * M, blank);
        for g in 0..groups.count() {
            let (h, z) = group_start(groups, g, solution);
            let stages = &solution.stages[g * M..(g + 1) * M];
            for j in 0..M {
                let mut out = z;
                for l in 0..M {
                    let w = h * Lanes::of(self.gauss.a[j][l]);
                    for a in 0..N {
                        out[a] += w * stages[l].slope[a];
                    }
                }
                let Stage { inner, closure_slope, .. } = stages[j];
                self.stations[g * M + j] = Station { z: out, inner, closure_slope };
            }
            self.steps[g] = h;
        }
        self.directions.clone_from(&solution.directions);
        resize(&mut self.end_stations, self.directions.ends.len(), blank);
        for (b, place) in self.directions.ends.iter().enumerate() {
            let station = &mut self.end_stations[b];
            for lane in 0..LANES {
                let i = place.elements[lane];
                let mut z = solution.nodes[i];
                if place.sides[lane] == Side::Right {
                    let (first, own) = (i / LANES * M, i % LANES);
                    let h = solution.mesh.step(i);
                    for (b, stage) in self.gauss.b.iter().zip(&solution.stages[first..first + M]) {
                        for a in 0..N {
                            z[a] += h * b * stage.slope[a].0[own];
                        }
                    }
                }
                for a in 0..N {
                    station.z[a].0[lane] = z[a];
                }
            }
            let End { inner, closure_slope } = solution.ends[b];
            station.inner = inner;
            station.closure_slope = closure_slope;
        }
    }

    /// Evaluates the problem at the stations of a solution.
    ///
    /// # Errors
    /// Those of the problem.
    #[inline(always)]
    pub fn evaluate<P: Problem<N, Q, L>, const FUSED: bool>(
        &mut self,
        problem: &P,
        solution: &Solution<N, M, L>,
    ) -> Result<(), P::Failure> {
        self.take_stations(solution);
        resize(&mut self.locals, self.stations.len(), Local::default());
        self.evaluations += self.groups.elements * M;
        problem.stages::<FUSED>(self.groups, &mut self.stations, &mut self.locals)?;
        if const { L > 0 } && self.directions.is_closed() {
            resize(&mut self.ends, self.end_stations.len(), Inner::default());
            problem.ends::<FUSED>(&self.directions.ends, &mut self.end_stations, &mut self.ends)?;
        }
        Ok(())
    }

    /// Takes the inner unknowns with their Newton step at fixed state and closure slope into a solution, and the closure slopes that
    /// follow from the polynomials through the closure variable.
    pub fn take_inner(&self, solution: &mut Solution<N, M, L>) {
        for ((stage, station), local) in solution.stages.iter_mut().zip(&self.stations).zip(&self.locals) {
            for a in 0..L {
                stage.inner[a] = station.inner[a] + local.inner.change[a];
            }
        }
        if const { L == 0 } || !self.directions.is_closed() {
            return;
        }
        for ((end, station), inner) in solution.ends.iter_mut().zip(&self.end_stations).zip(&self.ends) {
            for a in 0..L {
                end.inner[a] = station.inner[a] + inner.change[a];
            }
        }
        let at_end = |block: usize, lane: usize| self.ends[block].value.0[lane] + self.ends[block].value_change.0[lane];
        for i in 0..self.groups.elements {
            let (g, lane) = (i / LANES, i % LANES);
            let h = solution.mesh.step(i);
            let d = &self.gauss.closure[self.directions.side(i).index()];
            let mut values = [0.0; POINTS];
            for j in 0..M {
                let inner = &self.locals[g * M + j].inner;
                values[j] = inner.value.0[lane] + inner.value_change.0[lane];
            }
            values[M] = at_end(g, lane);
            let (block, end_lane) = self.directions.end_taken(i);
            values[M + 1] = at_end(block, end_lane);
            let slope = |m: usize| (0..M + 2).map(|l| d[m][l] * values[l]).sum::<f64>() / h;
            let last = i + 1 == self.groups.elements;
            let lanes = |first: usize, fill: bool| if fill { first..LANES } else { first..first + 1 };
            for j in 0..M {
                for lane in lanes(lane, last) {
                    solution.stages[g * M + j].closure_slope.0[lane] = slope(j);
                }
            }
            for lane in lanes(lane, last) {
                solution.ends[g].closure_slope.0[lane] = slope(M);
            }
            if let Some(k) = self.directions.closings.iter().position(|c| *c == i) {
                for lane in lanes(k % LANES, k + 1 == self.directions.closings.len()) {
                    solution.ends[self.groups.count() + k / LANES].closure_slope.0[lane] = slope(M + 1);
                }
            }
        }
    }
}

/// Element lengths and left nodes of group `g`.
#[inline(always)]
pub(super) fn group_start<const N: usize, const M: usize, const L: usize>(
    groups: Groups,
    g: usize,
    solution: &Solution<N, M, L>,
) -> (Lanes, [Lanes; N]) {
    let mut h = Lanes::of(0.0);
    let mut z = [Lanes::of(0.0); N];
    for lane in 0..LANES {
        let i = groups.element(g, lane);
        h.0[lane] = solution.mesh.step(i);
        for a in 0..N {
            z[a].0[lane] = solution.nodes[i][a];
        }
    }
    (h, z)
}
