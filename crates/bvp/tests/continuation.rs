//! Paths against closed forms: a fold, a function's zero, bifurcations and the branches that leave them.

use std::f64::consts::PI;

use hydrostat_bvp::{Continuation, Differentiable, Event, Guess, Options, PathEnd, PathOptions, Scalar};

/// Bratu's problem.
struct Bratu(f64);

impl Differentiable<2> for Bratu {
    const LEFT: usize = 1;

    fn slope<R: Scalar>(&self, _: f64, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[1];
        out[1] = z[0].exp() * -self.0;
    }

    fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0];
    }

    fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0];
    }
}

/// A column, clamped at s = 0 and free at s = 1, under a thrust.
struct Column(f64);

impl Differentiable<2> for Column {
    const LEFT: usize = 1;

    fn slope<R: Scalar>(&self, _: f64, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[1];
        out[1] = z[0].sin() * -self.0;
    }

    fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0];
    }

    fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[1];
    }
}

/// The complete elliptic integral of the first kind of a modulus, by the arithmetic-geometric mean.
fn elliptic(modulus: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - modulus * modulus).sqrt());
    while a - b > 1e-15 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    0.5 * PI / a
}

fn options() -> PathOptions {
    let solve = Options { max_elements: 400, ..Options::with_tolerance(1e-9) };
    PathOptions { solve, ..PathOptions::default() }
}

#[test]
fn a_path_goes_round_bratu_s_fold_and_back() {
    let mut continuation = Continuation::new(Bratu, [0.5, 10.0], options());
    let height = 2.0;
    let path = continuation.follow(&Guess::constant([0.0; 2]), Some(&|_, sol| sol.eval(0.5)[0] - height)).unwrap();
    println!("{} points", path.points.len());
    let folds: Vec<f64> = path.events(Event::LimitPoint).map(|point| point.parameter).collect();
    assert!(folds.len() == 1 && (folds[0] - 3.513_830_719_125_161).abs() < 1e-8, "{folds:?}");
    assert_eq!(path.events(Event::Bifurcation).count(), 0);
    // u(1/2) = 2 ln cosh c, lambda = 8 c^2 / cosh^2 c.
    let cosh = (0.5 * height).exp();
    let exact = 8.0 * (cosh.acosh() / cosh).powi(2);
    let zeros: Vec<f64> = path.events(Event::Zero).map(|point| point.parameter).collect();
    assert!(zeros.len() == 1 && (zeros[0] - exact).abs() < 1e-5, "{zeros:?} for {exact}");
    // Back at the start of the range on the upper branch.
    let last = path.points.last().unwrap();
    assert_eq!((path.end, last.parameter), (PathEnd::Range, 0.5));
    for point in &path.points {
        let cosh = (0.5 * point.sol.eval(0.5)[0]).exp();
        let lambda = 8.0 * (cosh.acosh() / cosh).powi(2);
        assert!((lambda - point.parameter).abs() < 1e-7, "{lambda} {}", point.parameter);
    }
    assert!(last.sol.eval(0.5)[0] > 4.0);
}

#[test]
fn a_straight_column_bifurcates_at_its_buckling_loads_and_the_bent_one_is_an_elastica() {
    let mut continuation = Continuation::new(Column, [1.0, 30.0], options());
    let path = continuation.follow(&Guess::constant([0.0; 2]), None).unwrap();
    assert_eq!(path.end, PathEnd::Range);
    for point in &path.points {
        println!("{} {} {:?} {:?}", point.parameter, point.rate, point.event, point.sol.determinant());
    }
    let loads: Vec<f64> = path.events(Event::Bifurcation).map(|point| point.parameter).collect();
    assert_eq!(loads.len(), 2, "{loads:?}");
    for (mode, load) in loads.iter().enumerate() {
        let exact = ((mode as f64 + 0.5) * PI).powi(2);
        assert!((load / exact - 1.0).abs() < 1e-6, "{load} for {exact}");
    }
    let at = path.events(Event::Bifurcation).next().unwrap();
    let branches = continuation.switched(at);
    assert_eq!(branches.len(), 2);
    let mut tips = Vec::new();
    for branch in &branches {
        for point in &branch.points {
            println!("{} {} {:?} {:?}", point.parameter, point.rate, point.event, point.sol.eval(1.0)[0]);
        }
        assert_eq!(branch.end, PathEnd::Range);
        for point in &branch.points {
            let tip = point.sol.eval(1.0)[0];
            let first = elliptic((0.5 * tip).sin());
            assert!((point.parameter - first * first).abs() < 1e-6 * point.parameter, "{tip}: {}", point.parameter);
        }
        tips.push(branch.points[0].sol.eval(1.0)[0]);
    }
    assert!(tips[0] * tips[1] < 0.0, "{tips:?}");
}
