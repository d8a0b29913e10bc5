//! The error of a solution by comparison with one more stage an element, and the mesh that follows from it.
//!
//! The difference of both solutions estimates the error to leading order. It is large between nodes, where collocation polynomials
//! are of order M + 1 only, and small at the nodes, where the order is 2M. What an element itself contributes is, between nodes,
//! the difference less its linear interpolation between the element's ends, and, at the nodes, the jump of the state over the
//! element that the comparison finds. For a goal functional the adjoint says what each element contributes (dual weighted residuals).

use crate::bvp::{NotFinite, Unit};
use crate::collocation::Collocation;
use crate::correction::Correction;
use crate::mesh::{Limits, Mesh};
use crate::newton::{Converged, NewtonError, correct, evaluate, factorise, weights};
use crate::options::{Norm, Options};
use crate::pointwise::OnMesh;
use crate::sol::{FINER, METHODS, STAGES};
use crate::solution::Solution;

/// Square of a comparison's first correction, over the tolerance, above which a second Newton iteration is worth its work: that square is
/// what one leaves.
const SECOND: f64 = 0.05;

/// Elements of a new mesh over those that it would need were the estimate exact.
const SPARE: f64 = 1.15;

/// Factor by which the estimate must fall on a mesh with half as many elements again, or rounding is all there is.
const PROGRESS: f64 = 0.5;

/// Part of the tolerance that contributions to a goal may add up to: their signs are not known on the next mesh.
const OF_GOAL: f64 = 0.3;

/// What a comparison says.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measured {
    /// In the norm asked for.
    pub(crate) error: f64,
    /// Where it is largest, in [0, 1].
    pub(crate) place: f64,
    pub(crate) goal: f64,
    pub(crate) goal_error: f64,
    /// The largest error at a node.
    nodal: f64,
}

/// The solve with one more stage.
pub(crate) struct Comparison<'a, const N: usize> {
    problem: &'a Unit<'a, N>,
    options: Options,
    system: Collocation<N, FINER, 1>,
    correction: Correction<N, FINER, 1>,
    pub(crate) finer: Solution<N, FINER>,
    /// Newton iterations of the last comparison.
    pub(crate) iterations: usize,
    /// Integrals of the finer cardinal polynomials up to the stages of the solve.
    integrals: [[f64; FINER]; STAGES],
    /// Of each element: the largest local difference between nodes, the largest jump, the contribution to the goal.
    local: Vec<f64>,
    jumps: Vec<f64>,
    to_goal: Vec<f64>,
    /// Elements and error of the mesh before, and how often in a row that was no worse.
    before: Option<(usize, f64)>,
    stagnant: usize,
}

impl<'a, const N: usize> Comparison<'a, N> {
    pub(crate) fn new(problem: &'a Unit<'a, N>, options: Options) -> Self {
        let methods = &*METHODS;
        Self {
            problem,
            options,
            system: Collocation::with(methods.compare.clone()),
            correction: Correction::default(),
            finer: Solution::default(),
            iterations: 0,
            integrals: methods.solve.c.map(|c| methods.compare.integrals(c)),
            local: Vec::new(),
            jumps: Vec::new(),
            to_goal: Vec::new(),
            before: None,
            stagnant: 0,
        }
    }

    /// Places evaluated so far.
    pub(crate) fn evaluations(&self) -> usize {
        self.system.evaluations
    }

    /// Compares a solution that Newton's method converged to.
    pub(crate) fn measure(
        &mut self,
        solution: &Solution<N, STAGES>,
        converged: &Converged,
    ) -> Result<Measured, NewtonError<NotFinite>> {
        let methods = &*METHODS;
        solution.resample(&methods.to_compare, &mut self.finer);
        let problem = OnMesh::new(self.problem, &methods.compare, &solution.mesh);
        let sizes = weights(solution, self.options.floor);
        self.iterations = 0;
        loop {
            evaluate(&mut self.system, &problem, &self.finer).map_err(NewtonError::Slopes)?;
            factorise(&mut self.system, &problem, &self.finer).map_err(NewtonError::Singular)?;
            correct(&mut self.system, &self.finer, &mut self.correction);
            if self.iterations == 0 {
                let size = |jump: &[f64; N]| (0..N).fold(0.0, |m: f64, a| m.max(sizes[a] * jump[a].abs()));
                self.jumps.clear();
                self.jumps.extend(self.system.jumps().iter().map(size));
                if self.options.norm == Norm::Goal {
                    self.system.contributions(&converged.by_element, &mut self.to_goal);
                }
            }
            self.finer.add(&self.correction, 1.0);
            self.iterations += 1;
            let at_nodes = (0..N).fold(0.0, |m: f64, a| m.max(sizes[a] * self.correction.largest(a)));
            let at_stages = self.system.moved_states(&self.correction);
            let largest = at_stages.iter().fold(at_nodes, |m: f64, z| {
                (0..N).fold(m, |m: f64, a| z[a].0.iter().fold(m, |m: f64, v| m.max(sizes[a] * v.abs())))
            });
            if self.iterations == 2 || largest * largest < SECOND * self.options.tolerance {
                break;
            }
        }
        let goal: f64 = converged.by_element.iter().map(|[own]| own).sum();
        let goal_error = self.system.totals()[0] + self.correction.total[0] - goal;
        let mut measured = self.differences(solution);
        (measured.goal, measured.goal_error) = (goal, goal_error);
        if self.options.norm == Norm::Goal {
            measured.error = goal_error.abs() / (self.options.floor + goal.abs());
            let largest = self.to_goal.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
            measured.place = largest.map_or(0.0, |(i, _)| solution.mesh.nodes()[i]);
        }
        // A number that is none is no small error.
        if measured.error.is_nan() {
            measured.error = f64::INFINITY;
        }
        Ok(measured)
    }

    /// The differences at nodes and stages over the sizes of the unknowns, and the local ones of each element.
    fn differences(&mut self, solution: &Solution<N, STAGES>) -> Measured {
        let wanted = |a: usize| match self.options.norm {
            Norm::Unknown(index) => a == index,
            Norm::Unknowns | Norm::Goal => true,
        };
        let floor = self.options.floor;
        let gauss = &METHODS.solve;
        let mut out = Measured { error: 0.0, place: 0.0, goal: 0.0, goal_error: 0.0, nodal: 0.0 };
        let at_node = |i: usize| -> [f64; N] { std::array::from_fn(|a| self.finer.nodes[i][a] - solution.nodes[i][a]) };
        let size = |difference: &[f64; N], value: &[f64; N]| {
            // Not f64::max, which takes what is not a number for nothing.
            (0..N).filter(|a| wanted(*a)).fold(0.0, |m: f64, a| {
                let relative = difference[a].abs() / (floor + value[a].abs());
                if relative <= m { m } else { relative }
            })
        };
        self.local.clear();
        for i in 0..solution.mesh.elements() {
            let (t, h) = (solution.mesh.nodes()[i], solution.mesh.step(i));
            let (left, right) = (at_node(i), at_node(i + 1));
            let nodal = size(&left, &solution.nodes[i]).max(size(&right, &solution.nodes[i + 1]));
            out.nodal = out.nodal.max(nodal);
            if nodal.is_nan() || nodal > out.error {
                (out.error, out.place) = (nodal, t);
            }
            let mut local = 0.0_f64;
            for j in 0..STAGES {
                let (c, mut own, mut finer) = (gauss.c[j], solution.nodes[i], self.finer.nodes[i]);
                for l in 0..STAGES {
                    let slope = solution.slope(i, l);
                    (0..N).for_each(|a| own[a] += h * gauss.a[j][l] * slope[a]);
                }
                for l in 0..FINER {
                    let slope = self.finer.slope(i, l);
                    (0..N).for_each(|a| finer[a] += h * self.integrals[j][l] * slope[a]);
                }
                let difference: [f64; N] = std::array::from_fn(|a| finer[a] - own[a]);
                let own_part: [f64; N] = std::array::from_fn(|a| difference[a] - (1.0 - c) * left[a] - c * right[a]);
                local = local.max(size(&own_part, &own));
                let whole = size(&difference, &own);
                if whole.is_nan() || whole > out.error {
                    (out.error, out.place) = (whole, t + c * h);
                }
            }
            self.local.push(local);
        }
        out
    }

    /// The mesh to go on with; `None` where no mesh that is allowed promises less of an error.
    pub(crate) fn next_mesh(&mut self, mesh: &Mesh, measured: &Measured) -> Option<Mesh> {
        let n = mesh.elements();
        if let Some((elements, error)) = self.before
            && 2 * n >= 3 * elements
        {
            let worse = measured.error.is_nan() || measured.error > PROGRESS * error;
            self.stagnant = if worse { self.stagnant + 1 } else { 0 };
        }
        let full = n >= self.options.max_elements;
        if self.stagnant >= 3 || (full && self.before.is_some_and(|(elements, _)| elements == n)) {
            return None;
        }
        // A mesh that had its turn, and was not refined: halves.
        let again = self.before.is_some_and(|(elements, error)| n <= elements && measured.error > PROGRESS * error);
        self.before = Some((n, measured.error));
        if !measured.error.is_finite() || (again && 2 * n <= self.options.max_elements) {
            return (2 * n <= self.options.max_elements).then(|| mesh.cut(2));
        }
        let tolerance = self.options.tolerance;
        let limits = Limits { fewest: 4, most: self.options.max_elements, growth: 6.0, cut: 8.0, least: 0.1 };
        let shortest = vec![1e-9; n];
        if self.options.norm == Norm::Goal {
            let order = (2 * STAGES + 1) as f64;
            let target = OF_GOAL * tolerance * (self.options.floor + measured.goal.abs());
            return Some(mesh.redistributed(&self.to_goal, &shortest, order, target, limits));
        }
        // Both kinds of contributions as numbers of new elements in each: between nodes the largest counts, at nodes the sum.
        let order = (STAGES + 1) as f64;
        let jumps: f64 = self.jumps.iter().sum();
        let amplification = if jumps > 0.0 { measured.nodal / jumps } else { 0.0 };
        let parts = |i: usize| {
            let between = (self.local[i] / tolerance).powf(1.0 / order);
            let at_nodes = (n as f64 * amplification * self.jumps[i] / tolerance).powf(1.0 / (2 * STAGES + 1) as f64);
            between.max(at_nodes)
        };
        let errors: Vec<f64> = (0..n).map(|i| tolerance * parts(i).powf(order)).collect();
        let needed: f64 = (0..n).map(parts).sum();
        let target = tolerance * needed / SPARE.powf(order - 1.0);
        Some(mesh.redistributed(&errors, &shortest, order, target, limits))
    }
}
