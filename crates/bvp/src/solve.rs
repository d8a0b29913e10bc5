//! The driver: Newton's method on a mesh, an error estimate, a better mesh, until the estimate meets the tolerance.

use crate::adapt::Comparison;
use crate::bvp::{Bvp, NotFinite, OnUnit, Unit};
use crate::collocation::{Collocation, Singular};
use crate::mesh::Mesh;
use crate::newton::{Converged, NewtonError, Workspace, solve_on_mesh};
use crate::options::{Norm, Options};
use crate::pointwise::OnMesh;
use crate::real::LANES;
use crate::sol::{METHODS, STAGES, Sol, SolveStatistics};
use crate::solution::Solution;

/// Norms of corrections that are as good as none, over the tolerance.
const CONVERGED: f64 = 1e-3;
/// The least of these: rounding.
const ROUNDING: f64 = 1e-13;

/// Why there is no solution. Places are in the problem's interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Error {
    /// An option, or what the problem says of itself, cannot be.
    Input {
        /// What.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// Slopes or their derivatives are not numbers at the guess.
    NotFinite {
        /// Where.
        s: f64,
    },
    /// The linearised problem is singular: the conditions do not determine the solution, as at a limit point or a bifurcation.
    Singular {
        /// The element that could not be condensed starts here; `None` where it is the whole.
        s: Option<f64>,
        /// Elements of the mesh.
        elements: usize,
    },
    /// Newton's method does not converge from the guess.
    Stalled {
        /// The last correction, root mean square over the sizes of the unknowns.
        correction: f64,
        /// Where it is largest.
        s: f64,
        /// The last damping factor.
        damping: f64,
        /// Iterations on this mesh.
        iterations: usize,
        /// Its elements.
        elements: usize,
    },
    /// The estimate is above the tolerance on the last mesh that is allowed.
    Mesh {
        /// The estimate.
        error: f64,
        /// Where it is largest.
        s: f64,
        /// Elements of that mesh.
        elements: usize,
        /// Meshes tried.
        meshes: usize,
    },
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match *self {
            Self::Input { what, value, expected } => write!(f, "{what} must be {expected}, found {value}"),
            Self::NotFinite { s } => write!(f, "slopes or their derivatives at s = {s} are not finite for the guess"),
            Self::Singular { s: Some(s), elements } => {
                write!(f, "the equations of the element at s = {s} are singular, on {elements} elements")
            }
            Self::Singular { s: None, elements } => {
                write!(
                    f,
                    "the linearised problem is singular, on {elements} elements: the conditions leave a solution free"
                )
            }
            Self::Stalled { correction, s, damping, iterations, elements } => write!(
                f,
                "Newton's method stalled after {iterations} iterations on {elements} elements: correction {correction:.1e}, \
                 largest at s = {s}, damping factor {damping:.1e}"
            ),
            Self::Mesh { error, s, elements, meshes } => write!(
                f,
                "the estimated error is {error:.1e}, largest at s = {s}, on {elements} elements after {meshes} meshes"
            ),
        }
    }
}

impl std::error::Error for Error {}

/// Where Newton's method starts: states, then parameters, along the interval.
pub struct Guess<'a, const N: usize> {
    from: From<'a, N>,
    elements: usize,
}

enum From<'a, const N: usize> {
    Function(Box<dyn Fn(f64) -> [f64; N] + 'a>),
    Sol(&'a Sol<N>),
}

impl<const N: usize> std::fmt::Debug for Guess<'_, N> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Guess").field("elements", &self.elements).finish_non_exhaustive()
    }
}

impl<'a, const N: usize> Guess<'a, N> {
    /// The same unknowns everywhere.
    pub fn constant(unknowns: [f64; N]) -> Self {
        Self::function(move |_| unknowns)
    }

    /// The unknowns as a function of s.
    pub fn function(unknowns: impl Fn(f64) -> [f64; N] + 'a) -> Self {
        Self { from: From::Function(Box::new(unknowns)), elements: 8 }
    }

    /// The solution of a problem nearby, on its mesh.
    pub fn solution(sol: &'a Sol<N>) -> Self {
        Self { from: From::Sol(sol), elements: 1 }
    }

    /// At least so many elements in the first mesh; 8 unless said. A solution's mesh is cut until it has as many.
    pub fn elements(mut self, elements: usize) -> Self {
        self.elements = elements;
        self
    }

    fn start(&self, interval: [f64; 2], breaks: &[f64], most: usize) -> Solution<N, STAGES> {
        let elements = self.elements.clamp(1, most);
        match &self.from {
            From::Function(function) => sample(Mesh::uniform(elements, breaks), interval, function),
            From::Sol(sol) => {
                let mut out = sol.solution.clone();
                out.mesh.pin(breaks, &missing(&out.mesh, breaks));
                let parts = elements.div_ceil(out.mesh.elements());
                if parts > 1 {
                    out.mesh = out.mesh.cut(parts);
                }
                if out.mesh != sol.solution.mesh {
                    sol.solution.remap(&METHODS.solve, |_| false, &mut out);
                }
                out
            }
        }
    }
}

/// Breaks at which a mesh has no node.
fn missing(mesh: &Mesh, breaks: &[f64]) -> Vec<f64> {
    breaks.iter().copied().filter(|s| !mesh.nodes().iter().any(|node| (node - s).abs() < 1e-12)).collect()
}

/// A function sampled at nodes and stages: its polynomial through them has these slopes at the stages.
fn sample<const N: usize>(mesh: Mesh, [a, b]: [f64; 2], function: &dyn Fn(f64) -> [f64; N]) -> Solution<N, STAGES> {
    let gauss = &METHODS.solve;
    let at = |t: f64| function(a + (b - a) * t);
    let mut out = Solution::constant(mesh, [0.0; N], []);
    for (z, t) in out.nodes.iter_mut().zip(out.mesh.nodes()) {
        *z = at(*t);
    }
    let groups = out.groups();
    let n = out.mesh.elements();
    for i in 0..n {
        let (t, h) = (out.mesh.nodes()[i], out.mesh.step(i));
        let mut values = [[0.0; N]; STAGES + 2];
        for (j, c) in gauss.c.iter().enumerate() {
            values[j] = at(t + h * c);
        }
        (values[STAGES], values[STAGES + 1]) = (out.nodes[i], out.nodes[i + 1]);
        for j in 0..STAGES {
            let (block, lane) = groups.at(i, j);
            // The last group is filled up with the last element.
            let last = if i + 1 == n { LANES } else { lane + 1 };
            for k in 0..N {
                let slope: f64 = (0..STAGES + 2).map(|l| gauss.closure[0][j][l] * values[l][k]).sum::<f64>() / h;
                out.stages[block].slope[k].0[lane..last].fill(slope);
            }
        }
    }
    out
}

/// Solves a boundary-value problem, from a guess, to a tolerance.
///
/// Newton's method with affine-invariant damping ([`newton`](crate::newton)) solves the collocation equations on a mesh. The solution is
/// compared with that of one more stage an element: what they differ by estimates the error. Where that is above the tolerance, the mesh is
/// redistributed, or refined, by what each element contributes, and Newton's method goes on from there. Where Newton's method fails, it is
/// tried again on halves of the elements.
///
/// # Errors
/// [`Error`]. Work is bounded by the options, whatever the problem.
pub fn solve<P: Bvp<N>, const N: usize>(problem: &P, guess: &Guess<'_, N>, options: &Options) -> Result<Sol<N>, Error> {
    let interval = check(problem, options)?;
    let [a, b] = interval;
    let breaks: Vec<f64> = problem.breaks().iter().map(|s| (s - a) / (b - a)).collect();
    let problem = OnUnit { problem, interval };
    solve_on_unit(&problem, guess, options, interval, &breaks, N - P::PARAMETERS)
}

/// [`solve`], compiled once for all problems with as many unknowns.
fn solve_on_unit<const N: usize>(
    problem: &Unit<'_, N>,
    guess: &Guess<'_, N>,
    options: &Options,
    [a, b]: [f64; 2],
    breaks: &[f64],
    states: usize,
) -> Result<Sol<N>, Error> {
    let unit = |unit: f64| a + (b - a) * unit;
    let methods = &*METHODS;
    let mut system = Collocation::<N, STAGES, 1>::with(methods.solve.clone());
    let mut comparison = Comparison::new(problem, *options);
    let mut workspace = Workspace::default();
    let mut solution = guess.start([a, b], breaks, options.max_elements);
    let mut kept = solution.clone();
    let mut statistics = SolveStatistics::default();
    let enough = (CONVERGED * options.tolerance).max(ROUNDING);
    let mut last: Option<Error> = None;
    while statistics.meshes < options.max_meshes {
        statistics.meshes += 1;
        let elements = solution.mesh.elements();
        let on_mesh = OnMesh::new(problem, &methods.solve, &solution.mesh);
        kept.clone_from(&solution);
        let solved = solve_on_mesh(
            &mut system,
            &on_mesh,
            &mut solution,
            &mut workspace,
            options.floor,
            enough,
            options.max_iterations,
        );
        let converged: Converged = match solved {
            Ok(converged) => converged,
            Err(error) => {
                let error = in_interval(error, &solution.mesh, unit);
                if matches!(error, Error::NotFinite { .. }) || 2 * elements > options.max_elements {
                    return Err(error);
                }
                last = Some(error);
                // The guess on halves of the elements.
                solution.mesh = kept.mesh.cut(2);
                match &guess.from {
                    From::Function(function) if statistics.meshes < 4 => {
                        solution = sample(solution.mesh, [a, b], function);
                    }
                    _ => kept.remap(&methods.solve, |_| false, &mut solution),
                }
                continue;
            }
        };
        statistics.iterations += converged.iterations;
        let measured = comparison.measure(&solution, &converged);
        statistics.iterations += comparison.iterations;
        statistics.evaluations = system.evaluations + comparison.evaluations();
        statistics.elements = elements;
        let measured = match measured {
            Ok(measured) => measured,
            Err(error) => {
                // What one more stage cannot even be linearised at is not resolved.
                last = Some(in_interval(error, &solution.mesh, unit));
                if 2 * elements > options.max_elements {
                    break;
                }
                kept.clone_from(&solution);
                solution.mesh = kept.mesh.cut(2);
                kept.remap(&methods.solve, |_| false, &mut solution);
                continue;
            }
        };
        if measured.error <= options.tolerance {
            return Ok(Sol {
                interval: [a, b],
                states,
                solution,
                finer: comparison.finer,
                goal: measured.goal,
                goal_error: measured.goal_error,
                error: measured.error,
                determinant: system.determinant(),
                statistics,
            });
        }
        last =
            Some(Error::Mesh { error: measured.error, s: unit(measured.place), elements, meshes: statistics.meshes });
        let Some(mesh) = comparison.next_mesh(&solution.mesh, &measured) else { break };
        kept.clone_from(&solution);
        solution.mesh = mesh;
        kept.remap(&methods.solve, |_| false, &mut solution);
    }
    Err(last.unwrap_or(Error::Input { what: "max_meshes", value: 0.0, expected: "at least 1" }))
}

fn in_interval(error: NewtonError<NotFinite>, mesh: &Mesh, unit: impl Fn(f64) -> f64) -> Error {
    let elements = mesh.elements();
    match error {
        NewtonError::Slopes(NotFinite { s }) => Error::NotFinite { s },
        NewtonError::Singular(Singular::Element(i)) => Error::Singular { s: Some(unit(mesh.nodes()[i])), elements },
        NewtonError::Singular(Singular::System) => Error::Singular { s: None, elements },
        NewtonError::Stalled { correction, place, damping, iterations } => {
            Error::Stalled { correction, s: unit(place), damping, iterations, elements }
        }
    }
}

/// The interval of a problem that can be solved with these options.
pub(crate) fn check<P: Bvp<N>, const N: usize>(problem: &P, options: &Options) -> Result<[f64; 2], Error> {
    let refuse = |what, value, expected| Err(Error::Input { what, value, expected });
    let [a, b] = problem.interval();
    if !(a.is_finite() && b.is_finite() && a < b) {
        return refuse("the interval's end", b, "finite, and larger than its finite start");
    }
    if P::PARAMETERS >= N {
        return refuse("the number of parameters", P::PARAMETERS as f64, "less than the number of unknowns");
    }
    if P::LEFT > N {
        return refuse("the number of conditions at a", P::LEFT as f64, "at most the number of unknowns");
    }
    let mut before = a;
    for s in problem.breaks() {
        if !(s > before && s < b) {
            return refuse("a break", s, "inside the interval, and above the one before");
        }
        before = s;
    }
    if !(1e-13..=0.1).contains(&options.tolerance) {
        return refuse("tolerance", options.tolerance, "in [1e-13, 0.1]");
    }
    if !(options.floor > 0.0 && options.floor.is_finite()) {
        return refuse("floor", options.floor, "above zero");
    }
    if !(4..=1_000_000).contains(&options.max_elements) {
        return refuse("max_elements", options.max_elements as f64, "in [4, 1000000]");
    }
    if let Norm::Unknown(index) = options.norm
        && index >= N
    {
        return refuse("the unknown of the norm", index as f64, "less than the number of unknowns");
    }
    Ok([a, b])
}
