//! Newton's method with affine-invariant damping.
//!
//! The strategy is the error-oriented one of Deuflhard ("Newton Methods for Nonlinear Problems: Affine Invariance and Adaptive
//! Algorithms", 2004, section 2.1.4, algorithm NLEQ-ERR). Corrections `dz = -F'(z)^-1 F(z)` are damped by a factor lambda in
//! (0, 1]. A trial `z + lambda dz` is accepted when the simplified correction there, `-F'(z)^-1 F(z + lambda dz)` (new
//! residual, old factors), is shorter than `dz`: the natural monotonicity test. Neither corrections nor the test change when the
//! equations are multiplied by a regular matrix, so that the scale of the equations does not matter. Factors are predicted
//! from estimates of the affine-invariant Lipschitz constant of F'. Near a solution lambda is one, and convergence quadratic.

use crate::bvp::{NotFinite, Unit};
use crate::collocation::{Collocation, Singular};
use crate::correction::Correction;
use crate::pointwise::OnMesh;
use crate::real::LANES;
use crate::solution::Solution;

/// The smallest damping factor.
pub const SMALLEST: f64 = 1e-8;

/// What a trial step says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trial {
    /// It is taken.
    Accepted,
    /// It is refused; the factor is now smaller.
    Refused,
    /// It is the solution, but for the simplified correction there.
    Converged,
}

/// The damping factor of Newton's method, from one correction to the next.
#[derive(Debug, Clone, Copy)]
pub struct Damping {
    /// lambda.
    pub factor: f64,
    /// Norms of the last correction, and of the simplified one after it.
    last: Option<[f64; 2]>,
    /// Whether a trial of the present correction has been refused.
    refused: bool,
}

impl Default for Damping {
    /// Whole corrections at first.
    fn default() -> Self {
        Self { factor: 1.0, last: None, refused: false }
    }
}

impl Damping {
    /// Takes a new correction of the norm `norm`, which is `apart` (in the same norm) from the simplified correction that came before it.
    pub fn predict(&mut self, norm: f64, apart: f64) {
        if let Some([before, simplified]) = self.last
            && apart > 0.0
        {
            self.factor = (self.factor * before * simplified / (apart * norm)).clamp(SMALLEST, 1.0);
        }
        self.refused = false;
    }

    /// Judges the trial by the norms of the correction and of the simplified correction at the trial, and by how far the latter is from
    /// `1 - lambda` times the former; `enough` is the norm of a correction that is as good as none. A trial without a residual has an
    /// infinite `simplified`.
    pub fn judge(&mut self, norm: f64, simplified: f64, apart: f64, enough: f64) -> Trial {
        let lambda = self.factor;
        let contraction = simplified / norm;
        if !contraction.is_finite() {
            self.factor *= 0.25;
            self.refused = true;
            return Trial::Refused;
        }
        let wanted = if apart > 0.0 { 0.5 * norm * lambda * lambda / apart } else { 1.0 };
        if contraction >= 1.0 {
            self.factor = wanted.min(0.5 * lambda);
            self.refused = true;
            return Trial::Refused;
        }
        let next = wanted.min(1.0);
        if lambda == 1.0 && simplified <= enough {
            return Trial::Converged;
        }
        if next >= 4.0 * lambda && !self.refused {
            // Too careful: the same correction with more of it.
            self.factor = next;
            return Trial::Refused;
        }
        self.last = Some([norm, simplified]);
        Trial::Accepted
    }
}

/// Why Newton's method has no solution on a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NewtonError<F> {
    /// The problem has no slopes at the first guess.
    Slopes(F),
    /// The linear system is singular.
    Singular(Singular),
    /// Damping factors became too small, or iterations too many: the norm of the last correction, the place in [0, 1] where it is largest,
    /// the last factor, and iterations done.
    Stalled {
        /// Norm of the last correction.
        correction: f64,
        /// Where it is largest, in [0, 1].
        place: f64,
        /// The last damping factor.
        damping: f64,
        /// Linearisations done.
        iterations: usize,
    },
}

/// Corrections of one solve, kept for their memory.
#[derive(Debug, Default)]
pub(crate) struct Workspace<const N: usize, const M: usize> {
    pub(crate) correction: Correction<N, M, 1>,
    simplified: Correction<N, M, 1>,
    trial: Solution<N, M>,
    scaled: [Vec<f64>; 2],
}

/// What Newton's method left: the linearisation's quadratures with the last correction, element by element.
#[derive(Debug, Clone, Default)]
pub(crate) struct Converged {
    pub(crate) iterations: usize,
    pub(crate) by_element: Vec<[f64; 1]>,
}

/// Solves on the mesh of `solution`, whose unknowns count over `floor` plus their largest value; until corrections are at most `enough`.
pub(crate) fn solve_on_mesh<const N: usize, const M: usize>(
    system: &mut Collocation<N, M, 1>,
    problem: &OnMesh<&Unit<'_, N>>,
    solution: &mut Solution<N, M>,
    workspace: &mut Workspace<N, M>,
    floor: f64,
    enough: f64,
    most: usize,
) -> Result<Converged, NewtonError<NotFinite>> {
    let Workspace { correction, simplified, trial, scaled: [whole, after] } = workspace;
    let mut damping = Damping::default();
    let mut iterations = 0;
    evaluate(system, problem, solution).map_err(NewtonError::Slopes)?;
    after.clear();
    loop {
        factorise(system, problem, solution).map_err(NewtonError::Singular)?;
        iterations += 1;
        correct(system, solution, correction);
        let weights = weights(solution, floor);
        scale(system, correction, &weights, whole);
        let norm = norm(whole);
        let stalled = |damping: Damping| NewtonError::Stalled {
            correction: norm,
            place: place_of_largest(solution, correction, &weights),
            damping: damping.factor,
            iterations,
        };
        if !norm.is_finite() {
            return Err(NewtonError::Singular(Singular::System));
        }
        if norm <= enough {
            let by_element = quadratures(system, correction);
            solution.add(correction, 1.0);
            return Ok(Converged { iterations, by_element });
        }
        if !after.is_empty() {
            damping.predict(norm, distance(after, whole, 1.0));
        }
        loop {
            if damping.factor < SMALLEST || iterations >= most {
                return Err(stalled(damping));
            }
            trial.clone_from(solution);
            trial.add(correction, damping.factor);
            let (mut size, mut apart) = (f64::INFINITY, f64::INFINITY);
            // A trial without slopes is refused.
            if evaluate(system, problem, trial).is_ok() {
                system.take_conditions(problem, trial);
                correct(system, trial, simplified);
                scale(system, simplified, &weights, after);
                size = self::norm(after);
                apart = distance(after, whole, 1.0 - damping.factor);
            }
            match damping.judge(norm, size, apart, enough) {
                Trial::Refused => {}
                Trial::Accepted => {
                    std::mem::swap(solution, trial);
                    break;
                }
                Trial::Converged => {
                    std::mem::swap(solution, trial);
                    let by_element = quadratures(system, simplified);
                    solution.add(simplified, 1.0);
                    return Ok(Converged { iterations, by_element });
                }
            }
        }
    }
}

// Compiled once for all places that use them, because all of them are inlined otherwise.

/// [`Collocation::evaluate`].
#[inline(never)]
pub(crate) fn evaluate<const N: usize, const M: usize>(
    system: &mut Collocation<N, M, 1>,
    problem: &OnMesh<&Unit<'_, N>>,
    solution: &Solution<N, M>,
) -> Result<(), NotFinite> {
    system.evaluate::<_, false>(problem, solution)
}

/// [`Collocation::factorise`].
#[inline(never)]
pub(crate) fn factorise<const N: usize, const M: usize>(
    system: &mut Collocation<N, M, 1>,
    problem: &OnMesh<&Unit<'_, N>>,
    solution: &Solution<N, M>,
) -> Result<(), Singular> {
    system.factorise::<_, false>(problem, solution)
}

/// [`Collocation::newton`].
#[inline(never)]
pub(crate) fn correct<const N: usize, const M: usize>(
    system: &mut Collocation<N, M, 1>,
    solution: &Solution<N, M>,
    out: &mut Correction<N, M, 1>,
) {
    system.newton::<false>(solution, out);
}

/// What each element adds to the quadratures, a correction included.
pub(crate) fn quadratures<const N: usize, const M: usize>(
    system: &Collocation<N, M, 1>,
    correction: &Correction<N, M, 1>,
) -> Vec<[f64; 1]> {
    let mut out = Vec::new();
    system.quadratures(&mut out);
    for ([own], [change]) in out.iter_mut().zip(&correction.by_element) {
        *own += change;
    }
    out
}

/// One over the sizes of the unknowns.
pub(crate) fn weights<const N: usize, const M: usize>(solution: &Solution<N, M>, floor: f64) -> [f64; N] {
    let mut largest = [0.0_f64; N];
    for z in &solution.nodes {
        for a in 0..N {
            largest[a] = largest[a].max(z[a].abs());
        }
    }
    largest.map(|size| 1.0 / (floor + size))
}

/// The changes at nodes and stages, over the sizes of the unknowns.
fn scale<const N: usize, const M: usize>(
    system: &Collocation<N, M, 1>,
    correction: &Correction<N, M, 1>,
    weights: &[f64; N],
    out: &mut Vec<f64>,
) {
    out.clear();
    for z in &correction.nodes {
        out.extend((0..N).map(|a| weights[a] * z[a]));
    }
    let elements = correction.nodes.len() - 1;
    for (block, z) in system.moved_states(correction).iter().enumerate() {
        for lane in (0..LANES).take_while(|lane| block / M * LANES + lane < elements) {
            out.extend((0..N).map(|a| weights[a] * z[a].0[lane]));
        }
    }
}

/// Root mean square.
fn norm(of: &[f64]) -> f64 {
    (of.iter().map(|v| v * v).sum::<f64>() / of.len() as f64).sqrt()
}

/// Norm of `a - factor b`.
fn distance(a: &[f64], b: &[f64], factor: f64) -> f64 {
    (a.iter().zip(b).map(|(a, b)| (a - factor * b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

fn place_of_largest<const N: usize, const M: usize>(
    solution: &Solution<N, M>,
    correction: &Correction<N, M, 1>,
    weights: &[f64; N],
) -> f64 {
    let size = |z: &[f64; N]| (0..N).fold(0.0, |m: f64, a| m.max(weights[a] * z[a].abs()));
    let sizes = correction.nodes.iter().map(size).enumerate();
    let (node, _) = sizes.fold((0, 0.0), |best, (i, size)| if size > best.1 { (i, size) } else { best });
    solution.mesh.nodes()[node]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// arctan from where undamped Newton diverges.
    #[test]
    fn damping_finds_the_zero_of_arctan_and_ends_undamped() {
        let mut x = 20.0_f64;
        let mut damping = Damping::default();
        let mut before: Option<f64> = None;
        let mut factors = Vec::new();
        for _ in 0..40 {
            let slope = 1.0 / (1.0 + x * x);
            let correction = -x.atan() / slope;
            if let Some(before) = before {
                damping.predict(correction.abs(), (before - correction).abs());
            }
            loop {
                let trial = x + damping.factor * correction;
                let simplified = -trial.atan() / slope;
                let apart = (simplified - (1.0 - damping.factor) * correction).abs();
                match damping.judge(correction.abs(), simplified.abs(), apart, 1e-14) {
                    Trial::Refused => continue,
                    Trial::Accepted => (x, before) = (trial, Some(simplified)),
                    Trial::Converged => {
                        factors.push(damping.factor);
                        assert!((trial + simplified).abs() < 1e-14);
                        assert!(factors[0] < 0.2 && factors.len() < 15, "{factors:?}");
                        return;
                    }
                }
                factors.push(damping.factor);
                break;
            }
        }
        panic!("{factors:?}");
    }
}
