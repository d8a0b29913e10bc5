//! A solution on [a, b] with its error estimate, as a continuous function.

use std::sync::LazyLock;

use crate::determinant::Determinant;
use crate::gauss::Gauss;
use crate::solution::{Resampling, Solution};

/// Stages of the solve: order 8 at the nodes, 5 between them.
pub(crate) const STAGES: usize = 4;
/// Stages of the comparison that estimates its error: one more.
pub(crate) const FINER: usize = STAGES + 1;

/// Points and weights of both.
#[derive(Debug)]
pub(crate) struct Methods {
    pub(crate) solve: Gauss<STAGES>,
    pub(crate) compare: Gauss<FINER>,
    pub(crate) to_compare: Resampling<STAGES, FINER>,
}

pub(crate) static METHODS: LazyLock<Methods> = LazyLock::new(|| {
    let (solve, compare) = (Gauss::new(), Gauss::new());
    let to_compare = Resampling::new(&solve, &compare);
    Methods { solve, compare, to_compare }
});

/// What a solve took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SolveStatistics {
    /// Elements of the last mesh.
    pub elements: usize,
    /// Meshes.
    pub meshes: usize,
    /// Newton iterations on all of them, those of comparisons included.
    pub iterations: usize,
    /// Places at which slopes and derivatives were evaluated, one by one, on all meshes.
    pub evaluations: usize,
}

/// The solution of a boundary-value problem with `N` unknowns: states, then parameters.
///
/// It is a polynomial of degree 4 on each element. Beside it stands the solution with one more stage an element, which is more accurate by
/// at least one order: what the two differ by is the error estimate, place by place and unknown by unknown.
#[derive(Debug, Clone)]
pub struct Sol<const N: usize> {
    pub(crate) interval: [f64; 2],
    pub(crate) states: usize,
    pub(crate) solution: Solution<N, STAGES>,
    pub(crate) finer: Solution<N, FINER>,
    pub(crate) goal: f64,
    pub(crate) goal_error: f64,
    pub(crate) error: f64,
    pub(crate) determinant: Determinant,
    pub(crate) statistics: SolveStatistics,
}

impl<const N: usize> Sol<N> {
    /// The unknowns at `s`, states first; at the nearer end for places outside the interval.
    pub fn eval(&self, s: f64) -> [f64; N] {
        let (i, t) = self.element(s);
        self.solution.state_in(&METHODS.solve, i, t)
    }

    /// The slopes of the unknowns at `s`.
    pub fn derivative(&self, s: f64) -> [f64; N] {
        let (i, t) = self.element(s);
        let x = (t - self.solution.mesh.nodes()[i]) / self.solution.mesh.step(i);
        let length = self.interval[1] - self.interval[0];
        self.solution.slope_in(&METHODS.solve, i, x).map(|v| v / length)
    }

    /// The estimated error of each unknown of [`Sol::eval`] at `s`, with its sign: what to add.
    pub fn error_at(&self, s: f64) -> [f64; N] {
        let (i, t) = self.element(s);
        let own = self.solution.state_in(&METHODS.solve, i, t);
        let finer = self.finer.state_in(&METHODS.compare, i, t);
        std::array::from_fn(|a| finer[a] - own[a])
    }

    /// The unknown parameters.
    pub fn parameters(&self) -> &[f64] {
        &self.solution.nodes[0][self.states..]
    }

    /// The estimated error in the norm that was asked for ([`Options::norm`](crate::Options::norm)): at most the tolerance.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// The goal functional ([`Bvp::goal`](crate::Bvp::goal)).
    pub fn goal(&self) -> f64 {
        self.goal
    }

    /// Its estimated error, with its sign: what to add.
    pub fn goal_error(&self) -> f64 {
        self.goal_error
    }

    /// The interval [a, b].
    pub fn interval(&self) -> [f64; 2] {
        self.interval
    }

    /// The nodes of the mesh, at which the solution is most accurate.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        let [a, b] = self.interval;
        self.solution.mesh.nodes().iter().map(move |t| a + (b - a) * t)
    }

    /// The determinant of the linearised problem. Along a path of solutions its sign changes at limit points and simple bifurcations.
    pub fn determinant(&self) -> Determinant {
        self.determinant
    }

    /// What the solve took.
    pub fn statistics(&self) -> SolveStatistics {
        self.statistics
    }

    /// The element that holds `s`, and the place in [0, 1].
    fn element(&self, s: f64) -> (usize, f64) {
        let [a, b] = self.interval;
        let t = ((s - a) / (b - a)).clamp(0.0, 1.0);
        (self.solution.mesh.element_of(t), t)
    }
}
