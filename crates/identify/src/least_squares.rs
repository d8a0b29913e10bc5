//! Levenberg-Marquardt with bounds, for models that cannot be evaluated everywhere.
//!
//! Minimised is
//!
//! ```text
//! F(x) = sum over the measured rows of loss(r_i(x)) + 1/2 sum over the prior rows of r_i(x)^2,    lower <= x <= upper
//! ```
//!
//! A step solves (J^T W J + lambda D^2) d = -g. W has the curvature of each row's loss, held above a tenth of its weight, so that the
//! matrix is never indefinite (the safeguarded Gauss-Newton model of Triggs et al. 1999); D is the largest norm that each column of J
//! has had (Moré 1978), so that parameters of any size are alike; lambda rises until a step is shorter than the region in which the model
//! can be trusted and falls with the agreement that is found (Nielsen 1999). One singular value decomposition a round serves all lambda
//! and makes singular jacobians harmless: directions that the rows do not know are not moved along.
//!
//! Bounds: parameters that stand on a bound and are pushed against it rest for the round; the step of the others is cut off at theirs
//! (the projected method of Kanzow, Yamashita and Fukushima 2004). A trial that the model refuses counts as one that went too far.

use nalgebra::{DMatrix, DVector, SVD};

use crate::loss::Loss;

/// Singular values below this, over the largest, are nothing.
pub(crate) const NOTHING: f64 = 1e-9;

/// So many steps that together make F less by no more than that are an end: of 0.014 standard deviations nothing can be seen. Along a
/// combination that the rows hardly know F can fall for ever.
const CALM: (usize, f64) = (8, 1e-4);

/// Rows of a model at a point, in standard deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    /// Model less measured. Rows that were measured first, those of priors last.
    pub residuals: DVector<f64>,
    /// A row of derivatives for each.
    pub jacobian: DMatrix<f64>,
    /// How many of the rows were measured: those that the loss is for.
    pub measured: usize,
}

/// Something that has residuals.
pub trait Model {
    /// Why it has none at some point.
    type Refusal;

    /// Residuals and their derivatives at `x`.
    ///
    /// # Errors
    /// Where there are none.
    fn evaluate(&mut self, x: &[f64]) -> Result<Rows, Self::Refusal>;
}

/// How a minimum is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Of the measured rows.
    pub loss: Loss,
    /// The most rounds.
    pub rounds: usize,
    /// How much F may still have to fall, over 1 + F.
    pub tolerance: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { loss: Loss::None, rounds: 100, tolerance: 1e-10 }
    }
}

/// A trial that the model refused.
#[derive(Debug, Clone, PartialEq)]
pub struct Refused<R> {
    /// Where.
    pub at: Vec<f64>,
    /// Why.
    pub why: R,
}

/// Where the search ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Minimum<R> {
    /// The point.
    pub x: Vec<f64>,
    /// The rows there.
    pub rows: Rows,
    /// F.
    pub cost: f64,
    /// Which parameters are held by a bound: its index, 0 the lower.
    pub held: Vec<Option<usize>>,
    /// Steps taken.
    pub rounds: usize,
    /// Points evaluated.
    pub evaluations: usize,
    /// Whether F has nothing left to fall by, to first order, or falls by nothing that could be seen.
    pub converged: bool,
    /// Trials that the model refused, in their order.
    pub refused: Vec<Refused<R>>,
}

/// F with what a step needs.
struct Local {
    cost: f64,
    gradient: DVector<f64>,
    /// sqrt(W) J and slope / sqrt(W).
    matrix: DMatrix<f64>,
    right: DVector<f64>,
}

impl Local {
    fn new(rows: &Rows, loss: Loss) -> Self {
        let mut matrix = rows.jacobian.clone();
        let mut right = rows.residuals.clone();
        let mut slopes = rows.residuals.clone();
        let mut cost = 0.0;
        for (i, r) in rows.residuals.iter().enumerate() {
            let own = if i < rows.measured { loss } else { Loss::None };
            cost += own.cost(*r);
            let root = own.curvature(*r).max(0.1 * own.weight(*r)).sqrt();
            slopes[i] = own.slope(*r);
            right[i] = slopes[i] / root;
            matrix.row_mut(i).scale_mut(root);
        }
        Self { cost, gradient: rows.jacobian.tr_mul(&slopes), matrix, right }
    }
}

/// Seeks a minimum from `start`, which is moved into the bounds. `say` is told the steps taken and F there, and says whether to go on.
///
/// ```
/// use hydrostat_identify::least_squares::{Model, Rows, Settings, minimise};
/// use nalgebra::{DMatrix, DVector};
///
/// /// Rosenbrock's valley as a sum of squares.
/// struct Valley;
/// impl Model for Valley {
///     type Refusal = ();
///     fn evaluate(&mut self, x: &[f64]) -> Result<Rows, ()> {
///         let residuals = DVector::from_vec(vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]);
///         let jacobian = DMatrix::from_row_slice(2, 2, &[-20.0 * x[0], 10.0, -1.0, 0.0]);
///         Ok(Rows { residuals, jacobian, measured: 2 })
///     }
/// }
/// let free = [[f64::NEG_INFINITY, f64::INFINITY]; 2];
/// let found = minimise(&mut Valley, &[-1.2, 1.0], &free, &Settings::default(), |_, _| true).unwrap();
/// assert!(found.converged && (found.x[0] - 1.0).abs() < 1e-5 && (found.x[1] - 1.0).abs() < 1e-5);
/// ```
///
/// # Errors
/// The model's own, where it has no rows at the start.
pub fn minimise<M: Model>(
    model: &mut M,
    start: &[f64],
    bounds: &[[f64; 2]],
    settings: &Settings,
    mut say: impl FnMut(usize, f64) -> bool,
) -> Result<Minimum<M::Refusal>, M::Refusal> {
    const LEAST_LAMBDA: f64 = 1e-12;
    const MOST_LAMBDA: f64 = 1e16;
    /// What a model that is known to some digits leaves, over the tolerance.
    const ROUNDING: f64 = 1e4;
    let count = start.len();
    let clamped = |x: &[f64]| -> Vec<f64> { x.iter().zip(bounds).map(|(x, b)| x.max(b[0]).min(b[1])).collect() };
    let mut x = clamped(start);
    let mut rows = model.evaluate(&x)?;
    let mut local = Local::new(&rows, settings.loss);
    let mut scale = vec![0.0_f64; count];
    let (mut lambda, mut growth) = (1e-4_f64, 2.0_f64);
    let (mut rounds, mut evaluations, mut converged, mut refused) = (0, 1, false, Vec::new());
    let mut costs = Vec::new();
    loop {
        let go_on = say(rounds, local.cost);
        costs.push(local.cost);
        converged |= costs.iter().rev().nth(CALM.0).is_some_and(|before| before - local.cost <= CALM.1);
        for (j, scale) in scale.iter_mut().enumerate() {
            *scale = scale.max(local.matrix.column(j).norm());
        }
        let held = held(&x, bounds, &local.gradient);
        let free: Vec<usize> = (0..count).filter(|j| held[*j].is_none() && scale[*j] > 0.0).collect();
        let small = settings.tolerance * (1.0 + local.cost);
        let step = Step::new(&local, &free, &scale);
        if step.as_ref().is_none_or(|step| step.most() <= small) {
            converged = true;
        }
        if converged || rounds >= settings.rounds || !go_on {
            return Ok(Minimum { x, cost: local.cost, rows, held, rounds, evaluations, converged, refused });
        }
        let Some(step) = step else { continue };
        loop {
            let mut to = x.clone();
            for (j, d) in free.iter().zip(step.at(lambda).iter()) {
                to[*j] += d / scale[*j];
            }
            let to = clamped(&to);
            let moved = DVector::from_iterator(count, to.iter().zip(&x).map(|(to, from)| to - from));
            let falls = -local.gradient.dot(&moved) - 0.5 * (&local.matrix * &moved).norm_squared();
            if falls > 0.0 {
                evaluations += 1;
                match model.evaluate(&to) {
                    Ok(found) => {
                        let next = Local::new(&found, settings.loss);
                        let agreement = (local.cost - next.cost) / falls;
                        if agreement > 1e-4 {
                            lambda *= (1.0 - (2.0 * agreement - 1.0).powi(3)).clamp(0.1, 2.0);
                            (lambda, growth) = (lambda.max(LEAST_LAMBDA), 2.0);
                            (x, rows, local) = (to, found, next);
                            rounds += 1;
                            break;
                        }
                    }
                    Err(why) => {
                        refused.push(Refused { at: to, why });
                        growth = growth.max(8.0);
                    }
                }
            }
            lambda *= growth;
            growth *= 2.0;
            if lambda > MOST_LAMBDA {
                // However short, no step makes it less: rounding has what is left, or the model ends here.
                converged = step.most() <= ROUNDING * small;
                return Ok(Minimum { x, cost: local.cost, rows, held, rounds, evaluations, converged, refused });
            }
        }
    }
}

/// Which parameters stand on a bound and are pushed against it.
fn held(x: &[f64], bounds: &[[f64; 2]], gradient: &DVector<f64>) -> Vec<Option<usize>> {
    let one = |(j, x): (usize, &f64)| {
        if *x <= bounds[j][0] && gradient[j] > 0.0 {
            Some(0)
        } else if *x >= bounds[j][1] && gradient[j] < 0.0 {
            Some(1)
        } else {
            None
        }
    };
    x.iter().enumerate().map(one).collect()
}

/// Steps of the free parameters, over their scales, for any lambda.
struct Step {
    singular: DVector<f64>,
    /// U^T right.
    along: DVector<f64>,
    /// V^T.
    directions: DMatrix<f64>,
    least: f64,
}

impl Step {
    /// `None` where nothing is free.
    fn new(local: &Local, free: &[usize], scale: &[f64]) -> Option<Self> {
        if free.is_empty() {
            return None;
        }
        let mut matrix = local.matrix.select_columns(free);
        for (mut column, j) in matrix.column_iter_mut().zip(free) {
            column /= scale[*j];
        }
        let SVD { u, v_t, singular_values: singular } = SVD::new(matrix, true, true);
        let (u, directions) = (u?, v_t?);
        let along = u.tr_mul(&local.right);
        let least = NOTHING * singular.max();
        Some(Self { singular, along, directions, least })
    }

    /// The most that F could fall by, to first order, were there no bounds.
    fn most(&self) -> f64 {
        let known = self.singular.iter().zip(self.along.iter()).filter(|(s, _)| **s > self.least);
        0.5 * known.map(|(_, a)| a * a).sum::<f64>()
    }

    fn at(&self, lambda: f64) -> DVector<f64> {
        let along =
            self.along.zip_map(&self.singular, |a, s| if s > self.least { -a * s / (s * s + lambda) } else { 0.0 });
        self.directions.tr_mul(&along)
    }
}
