//! Pseudo-arclength continuation: a branch of solutions over a parameter, round limit points and through bifurcations.
//!
//! A step predicts along the tangent and corrects by Newton's method normal to it, with the parameter free (Keller 1977). The bordered
//! system is solved by blocks: one factorisation, and two right sides, the residual and the derivative by the parameter. The metric is the root
//! mean square of all unknowns over their sizes, joined with the change of the parameter over its range. Events are located between two
//! points: a limit point by the zero of the parameter's part of the tangent, a zero of a function likewise, a simple bifurcation
//! by the sign of the determinant times that of the tangent, which is constant along a branch until another branch crosses.

pub mod location;

use crate::adapt::Comparison;
use crate::bvp::{Bvp, OnUnit, Unit};
use crate::collocation::{Collocation, Forcing};
use crate::correction::Correction;
use crate::determinant::Determinant;
use crate::mesh::Mesh;
use crate::newton::{Converged, correct, evaluate, factorise, quadratures, weights};
use crate::options::{Norm, Options};
use crate::pointwise::OnMesh;
use crate::problem::{Condition, Local, Problem, StageForcing};
use crate::real::{LANES, Lanes};
use crate::sol::{METHODS, STAGES, Sol, SolveStatistics};
use crate::solution::Solution;
use crate::solve::{Error, Guess, check, solve};

use self::location::{RegulaFalsi, bordered, inverse_interpolation};

/// How a path is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathOptions {
    /// Of the solve at each point. The norm is of unknowns.
    pub solve: Options,
    /// The first step, and the longest, in the metric of the path.
    pub first: f64,
    /// See `first`.
    pub longest: f64,
    /// Most steps, refused ones included.
    pub most: usize,
}

impl Default for PathOptions {
    fn default() -> Self {
        Self { solve: Options::default(), first: 0.02, longest: 0.2, most: 500 }
    }
}

/// What is special about a point of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Event {
    /// The parameter turns back.
    LimitPoint,
    /// Another branch crosses.
    Bifurcation,
    /// The function that is watched is zero.
    Zero,
}

/// A solution of a path.
#[derive(Debug, Clone)]
pub struct PathPoint<const N: usize> {
    /// The parameter.
    pub parameter: f64,
    /// The solution.
    pub sol: Sol<N>,
    /// The part of the parameter, over the range, in the unit tangent: its sign says which way the parameter goes.
    pub rate: f64,
    /// What is special about it.
    pub event: Option<Event>,
    tangent: Correction<N, STAGES, 1>,
}

/// Why a path ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PathEnd {
    /// The parameter left the range: the last point is at its end.
    Range,
    /// After the most steps allowed.
    Steps,
    /// No step leads on, however short.
    Stuck,
}

/// Solutions in the order in which a branch meets them, events among them.
#[derive(Debug, Clone)]
pub struct Path<const N: usize> {
    /// The points.
    pub points: Vec<PathPoint<N>>,
    /// Why it ends.
    pub end: PathEnd,
}

impl<const N: usize> Path<N> {
    /// The points with an event of a kind.
    pub fn events(&self, event: Event) -> impl Iterator<Item = &PathPoint<N>> {
        self.points.iter().filter(move |point| point.event == Some(event))
    }
}

/// A function of the parameter and the solution that is an event where it is zero.
pub type Watch<'a, const N: usize> = &'a dyn Fn(f64, &Sol<N>) -> f64;

/// The shortest step.
const SHORTEST: f64 = 1e-7;
/// Most corrections of a step.
const CORRECTIONS: usize = 8;
/// The smallest cosine between the tangents of a step's ends.
const STRAIGHT: f64 = 0.95;
/// The part of the parameter in a tangent that is none at a limit point: the parameter is off by its square.
const LEVEL: f64 = 1e-6;
/// Part of the range by which the parameter is varied for the derivative by it: the cube root of the machine's precision.
const VARIED: f64 = 6e-6;

/// Family, range and metric of a path.
pub struct Continuation<F, const N: usize> {
    family: F,
    range: [f64; 2],
    options: PathOptions,
    sizes: [f64; N],
}

impl<F, const N: usize> std::fmt::Debug for Continuation<F, N> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Continuation")
            .field("range", &self.range)
            .field("options", &self.options)
            .finish_non_exhaustive()
    }
}

impl<const N: usize> PathPoint<N> {
    /// Sign of the determinant times that of the tangent's rate, which is constant along a branch; zero where rounding could turn it.
    fn orientation(&self) -> f64 {
        self.sol.determinant.known_sign().unwrap_or(0.0) * self.rate.signum()
    }
}

/// What a correction leaves: the problem's linearisation at a solution and its derivative by the parameter.
struct Linearised<const N: usize> {
    rest: Correction<N, STAGES, 1>,
    response: Correction<N, STAGES, 1>,
    by_element: Vec<[f64; 1]>,
    determinant: Determinant,
}

impl<P: Bvp<N>, F: Fn(f64) -> P, const N: usize> Continuation<F, N> {
    /// Of the problems `family` gives for values of a parameter, over a range of it.
    pub fn new(family: F, range: [f64; 2], options: PathOptions) -> Self {
        Self { family, range, options, sizes: [1.0; N] }
    }

    /// The branch through the solution at the start of the range that a guess leads to, towards the end of the range, and past limit points, until
    /// the parameter leaves the range. `watch`, a function of the parameter and the solution, is an event where it is zero.
    ///
    /// # Errors
    /// When there is no solution at the start; [`Error::Input`] for a range or options that cannot be.
    pub fn follow(&mut self, guess: &Guess<'_, N>, watch: Option<Watch<'_, N>>) -> Result<Path<N>, Error> {
        let [from, to] = self.range;
        if !(from.is_finite() && to.is_finite() && from != to) {
            return Err(Error::Input { what: "the range's end", value: to, expected: "finite, and not its start" });
        }
        if self.options.solve.norm == Norm::Goal {
            return Err(Error::Input { what: "the norm of a path", value: 0.0, expected: "of unknowns" });
        }
        let PathOptions { first, longest, .. } = self.options;
        if !(first >= SHORTEST && first <= longest && longest.is_finite()) {
            return Err(Error::Input { what: "the first step", value: first, expected: "in [1e-7, longest]" });
        }
        let sol = solve(&(self.family)(from), guess, &self.options.solve)?;
        self.sizes = weights(&sol.solution, self.options.solve.floor);
        let start = self.point(from, sol, None)?;
        Ok(self.walk(start, watch))
    }

    /// The two branches that leave a bifurcation of a path aside of it, each from its first point on.
    pub fn switched(&mut self, at: &PathPoint<N>) -> Vec<Path<N>> {
        let Some(mode) = self.null_vector(at) else { return Vec::new() };
        let mut out = Vec::new();
        for side in [1.0, -1.0] {
            let mut away = mode.clone();
            away.scale(side);
            let started = [0.05, 0.02, 0.1, 0.2].into_iter().find_map(|distance| {
                let from = PathPoint { tangent: away.clone(), rate: 0.0, ..at.clone() };
                self.step(&from, distance)
            });
            if let Some(mut first) = started {
                // Away from the bifurcation.
                let along = self.dot(&first.sol.solution.mesh, &first.tangent, &carried(&away, at, &first));
                if along * first.rate.signum() < 0.0 {
                    first.rate = -first.rate;
                }
                out.push(self.walk(first, None));
            }
        }
        out
    }

    fn walk(&mut self, start: PathPoint<N>, watch: Option<Watch<'_, N>>) -> Path<N> {
        // The last that is known: a determinant next to nothing has no sign.
        let mut orientation = start.orientation();
        let mut points = vec![start];
        let mut step = self.options.first;
        let inside = |t: f64| (0.0..=1.0).contains(&t);
        for _ in 0..self.options.most {
            let here = &points[points.len() - 1];
            let Some(next) = self.step(here, step) else {
                step *= 0.4;
                if step < SHORTEST {
                    return Path { points, end: PathEnd::Stuck };
                }
                continue;
            };
            let fraction = self.fraction(next.parameter);
            let mut found = Vec::new();
            if next.rate * here.rate < 0.0 {
                found.extend(self.limit_point(here, &next, step));
            } else if orientation * next.orientation() < 0.0 {
                found.extend(self.bifurcation(here, &next, step));
            }
            if let Some(watch) = watch {
                let value = |point: &PathPoint<N>| watch(point.parameter, &point.sol);
                if value(here) * value(&next) < 0.0 {
                    found.extend(self.zero(here, &next, step, value, Event::Zero));
                }
            }
            if next.orientation() != 0.0 {
                orientation = next.orientation();
            }
            points.extend(found.into_iter().filter(|point| inside(self.fraction(point.parameter))));
            if !inside(fraction) {
                let bound = self.range[usize::from(fraction > 1.0)];
                let landed = solve(&(self.family)(bound), &Guess::solution(&next.sol), &self.options.solve);
                if let Some(end) = landed.ok().and_then(|sol| self.point(bound, sol, Some(&next)).ok()) {
                    points.push(end);
                }
                return Path { points, end: PathEnd::Range };
            }
            points.push(next);
            step = (1.6 * step).min(self.options.longest);
        }
        Path { points, end: PathEnd::Steps }
    }

    /// Where the parameter is in its range.
    fn fraction(&self, parameter: f64) -> f64 {
        (parameter - self.range[0]) / (self.range[1] - self.range[0])
    }

    /// Scalar product of two changes at the nodes of a mesh.
    fn dot(&self, mesh: &Mesh, a: &Correction<N, STAGES, 1>, b: &[[f64; N]]) -> f64 {
        let terms = mesh.node_weights().zip(a.nodes.iter().zip(b));
        terms.map(|(w, (a, b))| w * (0..N).map(|k| self.sizes[k].powi(2) * a[k] * b[k]).sum::<f64>()).sum()
    }

    /// The point at a solution with its tangent, in the direction of the one at `before`, or, without one, into the range.
    fn point(&self, parameter: f64, sol: Sol<N>, before: Option<&PathPoint<N>>) -> Result<PathPoint<N>, Error> {
        let singular = Error::Singular { s: None, elements: sol.solution.mesh.elements() };
        let mut sol = sol;
        let Linearised { response, determinant, .. } = self.linearised(parameter, &sol.solution).ok_or(singular)?;
        sol.determinant = determinant;
        let square = self.dot(&sol.solution.mesh, &response, &response.nodes);
        let mut point = PathPoint { parameter, sol, rate: 1.0 / (1.0 + square).sqrt(), event: None, tangent: response };
        if !point.rate.is_finite() {
            return Err(singular);
        }
        if let Some(before) = before
            && self.cosine(before, &point) < 0.0
        {
            point.rate = -point.rate;
        }
        Ok(point)
    }

    /// Cosine of the angle between two tangents. That of a branch to be switched to has no part of the parameter.
    fn cosine(&self, a: &PathPoint<N>, b: &PathPoint<N>) -> f64 {
        let first = if a.rate == 0.0 { 1.0 } else { a.rate };
        let along = self.dot(&b.sol.solution.mesh, &b.tangent, &carried(&a.tangent, a, b));
        a.rate * b.rate + first * b.rate * along
    }

    /// The problem linearised at a solution, with the derivative by the parameter over its range.
    fn linearised(&self, parameter: f64, solution: &Solution<N, STAGES>) -> Option<Linearised<N>> {
        let width = self.range[1] - self.range[0];
        let [problem, below, above] = [0.0, -VARIED, VARIED].map(|by| (self.family)(parameter + by * width));
        let interval = check(&problem, &self.options.solve).ok()?;
        let [problem, below, above] = [&problem, &below, &above].map(|problem| OnUnit { problem, interval });
        linearised([&problem, &below, &above], solution)
    }

    /// One step along the tangent of a point, on a mesh that carries the tolerance.
    fn step(&self, here: &PathPoint<N>, step: f64) -> Option<PathPoint<N>> {
        let width = self.range[1] - self.range[0];
        // A tangent without a part of the parameter is a unit change of the solution.
        let by_tangent = if here.rate == 0.0 { step } else { step * here.rate };
        let mut solution = here.sol.solution.clone();
        solution.add(&here.tangent, by_tangent);
        let mut parameter = here.parameter + step * here.rate * width;
        let mut statistics = SolveStatistics::default();
        let mut last: Option<Mesh> = None;
        for _ in 0..self.options.solve.max_meshes.min(6) {
            if let Some(mesh) = last.take() {
                let kept = solution.clone();
                solution.mesh = mesh;
                kept.remap(&METHODS.solve, |_| false, &mut solution);
            }
            let by_element = self.correct(here, &mut solution, &mut parameter)?;
            let problem = (self.family)(parameter);
            let interval = check(&problem, &self.options.solve).ok()?;
            let unit = OnUnit { problem: &problem, interval };
            let mut comparison = Comparison::new(&unit, self.options.solve);
            let measured = comparison.measure(&solution, &Converged { iterations: 0, by_element }).ok()?;
            statistics.meshes += 1;
            statistics.elements = solution.mesh.elements();
            if measured.error > self.options.solve.tolerance {
                last = Some(comparison.next_mesh(&solution.mesh, &measured)?);
                continue;
            }
            let sol = Sol {
                interval,
                states: N - P::PARAMETERS,
                finer: comparison.finer,
                solution,
                goal: measured.goal,
                goal_error: measured.goal_error,
                error: measured.error,
                determinant: Determinant::ONE,
                statistics,
            };
            let next = self.point(parameter, sol, Some(here)).ok()?;
            let straight = here.rate == 0.0 || step < 1e-4 || self.cosine(here, &next) > STRAIGHT;
            return straight.then_some(next);
        }
        None
    }

    /// Newton's method on the plane through the prediction that the tangent is normal to; what each element adds to the goal.
    fn correct(
        &self,
        here: &PathPoint<N>,
        solution: &mut Solution<N, STAGES>,
        parameter: &mut f64,
    ) -> Option<Vec<[f64; 1]>> {
        let width = self.range[1] - self.range[0];
        let normal = carried_to(&here.tangent, &here.sol.solution.mesh, &solution.mesh);
        let enough = (1e-3 * self.options.solve.tolerance).max(1e-13);
        let mut before = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            let Linearised { rest, response, mut by_element, .. } = self.linearised(*parameter, solution)?;
            let scale = if here.rate == 0.0 { 1.0 } else { here.rate };
            let slide = bordered(
                scale * self.dot(&solution.mesh, &rest, &normal),
                scale * self.dot(&solution.mesh, &response, &normal),
                here.rate,
            );
            solution.add(&rest, 1.0);
            solution.add(&response, slide);
            *parameter += slide * width;
            for (own, by) in by_element.iter_mut().zip(&response.by_element) {
                own[0] += slide * by[0];
            }
            let mut whole = rest;
            whole.add(&response, slide);
            let size = self.dot(&solution.mesh, &whole, &whole.nodes).sqrt().hypot(slide);
            if !size.is_finite() || size > 1.0 || size > 2.0 * before {
                return None;
            }
            // The last correction leaves about its square over the one before.
            if size <= enough || size * size <= enough * before.min(1.0) * 0.1 {
                return Some(by_element);
            }
            before = size;
        }
        None
    }

    fn limit_point(&self, here: &PathPoint<N>, next: &PathPoint<N>, step: f64) -> Option<PathPoint<N>> {
        let up = here.rate.signum();
        self.zero(here, next, step, |point| up * point.rate, Event::LimitPoint)
    }

    /// The point between two, `step` apart, at which a function that changes sign is zero.
    fn zero(
        &self,
        here: &PathPoint<N>,
        next: &PathPoint<N>,
        step: f64,
        value: impl Fn(&PathPoint<N>) -> f64,
        event: Event,
    ) -> Option<PathPoint<N>> {
        let sign = value(here).signum();
        let size = value(here).abs().max(value(next).abs());
        let mut search = RegulaFalsi::between((0.0, value(here).abs()), (step, sign * value(next)));
        let mut best: Option<(f64, PathPoint<N>)> = None;
        for _ in 0..40 {
            let place = search.place(0.02);
            let Some(point) = self.step(here, place) else {
                search.shorten(place);
                continue;
            };
            let found = sign * value(&point);
            search.put(place, found);
            if best.as_ref().is_none_or(|(size, _)| found.abs() < *size) {
                best = Some((found.abs(), PathPoint { event: Some(event), ..point }));
            }
            if found.abs() < LEVEL * size.min(1.0) || search.width() < 1e-9 {
                break;
            }
        }
        best.map(|(_, point)| point)
    }

    /// The bifurcation between two points, from determinants on both sides of it: corrections are of little worth right at it.
    fn bifurcation(&self, here: &PathPoint<N>, next: &PathPoint<N>, step: f64) -> Option<PathPoint<N>> {
        let [unit, side] = [here.sol.determinant.log, here.orientation()];
        let signed = |point: &PathPoint<N>| side * point.orientation() * (point.sol.determinant.log - unit).exp();
        let mut samples = vec![(0.0, signed(here)), (step, signed(next))];
        let (mut low, mut high) = (0.0, step);
        let mut nearest: Option<(f64, PathPoint<N>)> = None;
        for _ in 0..8 {
            let middle = 0.5 * (low + high);
            let Some(point) = self.step(here, middle) else { break };
            let value = signed(&point);
            if value > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
            samples.push((middle, value));
            nearest = Some((middle, point));
        }
        // Meshes differ, and determinants with them by a little: nearest last ones count.
        samples.sort_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        samples.truncate(4);
        let place = inverse_interpolation(&samples);
        let place = if place.is_finite() { place.clamp(low, high) } else { 0.5 * (low + high) };
        // By the tangent of the nearest point.
        let (middle, mut point) = nearest?;
        let by = (place - middle) * point.rate;
        point.sol.solution.add(&point.tangent, by);
        point.parameter += by * (self.range[1] - self.range[0]);
        Some(PathPoint { event: Some(Event::Bifurcation), ..point })
    }

    /// What moves at a bifurcation while the parameter does not, of length one: inverse iteration.
    fn null_vector(&self, at: &PathPoint<N>) -> Option<Correction<N, STAGES, 1>> {
        let problem = (self.family)(at.parameter);
        let interval = check(&problem, &self.options.solve).ok()?;
        let unit = OnUnit { problem: &problem, interval };
        let (system, _) = factorised(&unit, &at.sol.solution)?;
        let mesh = &at.sol.solution.mesh;
        let mut mode = Correction::default();
        let mut forcing = Forcing {
            stages: vec![
                StageForcing { slope: [Lanes([1.0; LANES]); N], ..StageForcing::default() };
                at.sol.solution.stages.len()
            ],
            ..Forcing::default()
        };
        for _ in 0..4 {
            system.response::<false>(&forcing, &mut mode);
            let length = self.dot(mesh, &mode, &mode.nodes).sqrt();
            if !(length > 0.0 && length.is_finite()) {
                return None;
            }
            mode.scale(1.0 / length);
            let states = system.moved_states(&mode);
            for (stage, state) in forcing.stages.iter_mut().zip(states) {
                stage.slope = state;
            }
        }
        // Less its part along the branch that is known.
        let along = self.dot(mesh, &mode, &at.tangent.nodes);
        let known = self.dot(mesh, &at.tangent, &at.tangent.nodes);
        if known * at.rate * at.rate > 1e-6 {
            mode.add(&at.tangent, -along / known);
        }
        let length = self.dot(mesh, &mode, &mode.nodes).sqrt();
        mode.scale(1.0 / length);
        (length > 1e-6 && length.is_finite()).then_some(mode)
    }
}

/// A change at the nodes of `from`, at those of `to`.
fn carried<const N: usize>(change: &Correction<N, STAGES, 1>, from: &PathPoint<N>, to: &PathPoint<N>) -> Vec<[f64; N]> {
    carried_to(change, &from.sol.solution.mesh, &to.sol.solution.mesh)
}

/// A change at the nodes of one mesh, at those of another: linear interpolation is enough for a direction.
fn carried_to<const N: usize>(change: &Correction<N, STAGES, 1>, own: &Mesh, mesh: &Mesh) -> Vec<[f64; N]> {
    let at = |s: &f64| {
        let e = own.element_of(*s);
        let x = (s - own.nodes()[e]) / own.step(e);
        std::array::from_fn(|a| change.nodes[e][a] + x * (change.nodes[e + 1][a] - change.nodes[e][a]))
    };
    mesh.nodes().iter().map(at).collect()
}

type System<const N: usize> = Collocation<N, STAGES, 1>;

fn factorised<'a, const N: usize>(
    problem: &'a Unit<'a, N>,
    solution: &Solution<N, STAGES>,
) -> Option<(System<N>, OnMesh<&'a Unit<'a, N>>)> {
    let methods = &*METHODS;
    let mut system = System::<N>::with(methods.solve.clone());
    let on_mesh = OnMesh::new(problem, &methods.solve, &solution.mesh);
    evaluate(&mut system, &on_mesh, solution).ok()?;
    factorise(&mut system, &on_mesh, solution).ok()?;
    Some((system, on_mesh))
}

/// A problem linearised, and its derivative by what `below` and `above` are varied in, by central differences.
fn linearised<const N: usize>(
    [problem, below, above]: [&Unit<'_, N>; 3],
    solution: &Solution<N, STAGES>,
) -> Option<Linearised<N>> {
    let (mut system, on_mesh) = factorised(problem, solution)?;
    let mut rest = Correction::default();
    correct(&mut system, solution, &mut rest);
    let mut forcing = Forcing { stages: vec![StageForcing::default(); solution.stages.len()], ..Forcing::default() };
    let ends = [&solution.nodes[0], &solution.nodes[solution.mesh.elements()]];
    let count = on_mesh.left_count();
    for (varied, factor) in [(below, -0.5 / VARIED), (above, 0.5 / VARIED)] {
        let varied = OnMesh::new(varied, &METHODS.solve, &solution.mesh);
        let mut stations = system.stations().to_vec();
        let mut locals = vec![Local::default(); stations.len()];
        varied.stages::<false>(solution.groups(), &mut stations, &mut locals).ok()?;
        let by = Lanes([factor; LANES]);
        for (out, local) in forcing.stages.iter_mut().zip(&locals) {
            for a in 0..N {
                out.slope[a] += by * local.slope[a];
            }
            out.rate[0] += by * local.rate[0];
        }
        let (mut left, mut right) = ([Condition::default(); N], [Condition::default(); N]);
        varied.left(ends[0], &mut left);
        varied.right(ends[1], &mut right);
        for c in 0..count {
            forcing.left[c] += factor * left[c].residual;
        }
        for c in 0..N - count {
            forcing.right[c] += factor * right[c].residual;
        }
    }
    let mut response = Correction::default();
    system.response::<false>(&forcing, &mut response);
    Some(Linearised { by_element: quadratures(&system, &rest), rest, response, determinant: system.determinant() })
}
