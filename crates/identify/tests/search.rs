//! The search by itself: linear problems in closed form, bounds, robust losses, models with holes.

use hydrostat_identify::Loss;
use hydrostat_identify::least_squares::{Model, Rows, Settings, minimise};
use nalgebra::{DMatrix, DVector};

mod common;
use common::Random;

const FREE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// matrix x - right.
struct Linear {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
}

impl Linear {
    fn random(rows: usize, columns: usize, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let matrix = DMatrix::from_fn(rows, columns, |_, j| [1e-3, 1.0, 1e3][j] * random.normal());
        Self { matrix, right: DVector::from_fn(rows, |_, _| random.normal()) }
    }

    fn residuals(&self, x: &[f64]) -> DVector<f64> {
        &self.matrix * DVector::from_column_slice(x) - &self.right
    }
}

impl Model for Linear {
    type Refusal = ();

    fn evaluate(&mut self, x: &[f64]) -> Result<Rows, ()> {
        Ok(Rows { residuals: self.residuals(x), jacobian: self.matrix.clone(), measured: self.right.len() })
    }
}

#[test]
fn a_linear_problem_has_the_answer_of_the_normal_equations() {
    for seed in 0..20 {
        let mut linear = Linear::random(12, 3, seed);
        let normal = linear.matrix.tr_mul(&linear.matrix);
        let want = normal.lu().solve(&linear.matrix.tr_mul(&linear.right)).unwrap();
        let found = minimise(&mut linear, &[5.0, -3.0, 1.0], &[FREE; 3], &Settings::default(), |_, _| true).unwrap();
        assert!(found.converged);
        for (j, (found, want)) in found.x.iter().zip(want.iter()).enumerate() {
            // In standard deviations of the parameter, were it the only one.
            let off = (found - want).abs() * linear.matrix.column(j).norm();
            assert!(off < 1e-4, "{seed}: {found} {want}");
        }
    }
}

/// At a bounded minimum the gradient vanishes inside and points outwards on a bound (Karush, Kuhn and Tucker); the problem is convex, so that
/// this is all.
#[test]
fn bounds_are_kept_and_what_is_pushed_against_them_is_said() {
    let mut on_bounds = 0;
    for seed in 0..200 {
        let mut linear = Linear::random(10, 3, seed);
        let bounds = [[-20.0, 20.0], [-0.02, 0.05], [0.0, 1e-4]];
        let found = minimise(&mut linear, &[100.0, 0.01, 5e-5], &bounds, &Settings::default(), |_, _| true).unwrap();
        assert!(found.converged, "{seed}");
        let gradient = linear.matrix.tr_mul(&linear.residuals(&found.x));
        for j in 0..3 {
            assert!((bounds[j][0]..=bounds[j][1]).contains(&found.x[j]));
            let slope = gradient[j] / linear.matrix.column(j).norm();
            match found.held[j] {
                Some(0) => assert!(found.x[j] == bounds[j][0] && slope > 0.0),
                Some(_) => assert!(found.x[j] == bounds[j][1] && slope < 0.0),
                None => assert!(slope.abs() < 1e-4, "{seed} {j}: {slope}"),
            }
            on_bounds += usize::from(found.held[j].is_some());
        }
    }
    assert!(on_bounds > 50, "{on_bounds}");
}

/// One column twice: the rows know the sum only, which the search finds without running away.
#[test]
fn a_singular_jacobian_does_no_harm() {
    let mut linear = Linear::random(8, 2, 3);
    let first = linear.matrix.column(0).into_owned();
    linear.matrix.set_column(1, &first);
    let found = minimise(&mut linear, &[0.0, 0.0], &[FREE; 2], &Settings::default(), |_, _| true).unwrap();
    let want = first.dot(&linear.right) / first.norm_squared();
    assert!(found.converged);
    assert!((found.x[0] + found.x[1] - want).abs() < 1e-8 * want.abs(), "{:?} {want}", found.x);
    assert!((found.x[0] - found.x[1]).abs() < 1e-6 * want.abs(), "the shortest of all: {:?}", found.x);
}

/// The least sum of losses of x - right.
#[test]
fn robust_means_are_those_found_by_bisection() {
    let right = [0.1, -0.4, 0.3, 0.9, -1.2, 8.0, 40.0];
    for loss in [Loss::Huber, Loss::Cauchy] {
        let mut model =
            Linear { matrix: DMatrix::from_element(right.len(), 1, 1.0), right: DVector::from_column_slice(&right) };
        let settings = Settings { loss, ..Settings::default() };
        let found = minimise(&mut model, &[0.5], &[FREE], &settings, |_, _| true).unwrap();
        let slope = |x: f64| right.iter().map(|r| loss.slope(x - r)).sum::<f64>();
        let (mut low, mut high) = (-2.0, 3.0);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if slope(middle) < 0.0 { low = middle } else { high = middle }
        }
        assert!(found.converged && (found.x[0] - low).abs() < 1e-4, "{loss:?}: {} {low}", found.x[0]);
    }
}

/// atan(k x) for a few k and x up to 2 only.
struct Saturating {
    refusals: usize,
}

impl Model for Saturating {
    type Refusal = f64;

    fn evaluate(&mut self, x: &[f64]) -> Result<Rows, f64> {
        if x[0] > 2.0 {
            self.refusals += 1;
            return Err(x[0]);
        }
        let slopes = [0.5, 0.8, 1.0, 1.5];
        let residuals = DVector::from_iterator(4, slopes.iter().map(|k| (k * x[0]).atan() - (k * 1.99_f64).atan()));
        let jacobian = DMatrix::from_iterator(4, 1, slopes.iter().map(|k| k / (1.0 + (k * x[0]).powi(2))));
        Ok(Rows { residuals, jacobian, measured: 4 })
    }
}

#[test]
fn where_there_is_no_model_steps_are_shorter() {
    let mut model = Saturating { refusals: 0 };
    // The slopes at -3 lead far beyond 2.
    let found = minimise(&mut model, &[-3.0], &[FREE], &Settings::default(), |_, _| true).unwrap();
    assert!(found.converged && (found.x[0] - 1.99).abs() < 1e-4, "{:?}", found.x);
    assert!(model.refusals > 0 && found.refused.len() == model.refusals);
    assert!(found.refused.iter().all(|refused| refused.why == refused.at[0] && refused.why > 2.0));
    assert_eq!(minimise(&mut model, &[3.0], &[FREE], &Settings::default(), |_, _| true).unwrap_err(), 3.0);
}

/// A valley along x y = 1 that falls for ever, with 1/x^2.
struct Valley;

impl Model for Valley {
    type Refusal = ();

    fn evaluate(&mut self, x: &[f64]) -> Result<Rows, ()> {
        let residuals = DVector::from_vec(vec![100.0 * (x[0] * x[1] - 1.0), 0.1 / x[0]]);
        let jacobian = DMatrix::from_row_slice(2, 2, &[100.0 * x[1], 100.0 * x[0], -0.1 / (x[0] * x[0]), 0.0]);
        Ok(Rows { residuals, jacobian, measured: 2 })
    }
}

#[test]
fn what_falls_for_ever_is_left_where_nothing_can_be_seen_any_more() {
    let settings = Settings { rounds: 1000, ..Settings::default() };
    let found = minimise(&mut Valley, &[1.0, 1.0], &[FREE; 2], &settings, |_, _| true).unwrap();
    assert!(found.converged && found.rounds < 200, "{} rounds", found.rounds);
    assert!((found.x[0] * found.x[1] - 1.0).abs() < 1e-3 && found.cost < 0.004, "{:?} {}", found.x, found.cost);
}
