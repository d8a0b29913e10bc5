//! Five problems against exact and published numbers, and the estimates against the errors.

#[path = "../examples/common/functions.rs"]
mod functions;
#[path = "../examples/common/problems.rs"]
mod problems;

use hydrostat_bvp::{Differentiable, Guess, Norm, Options, Scalar, Sol, solve};
use problems::{Bratu, Elastica, Known, Mathieu, Shock, Troesch};

/// Bratu's problem at its fold, where lambda is an unknown parameter: beside the state stands the null vector of its linearisation, with
/// the slope one at s = 0 (the extended system of Moore and Spence 1980).
struct BratuFold;

impl Differentiable<5> for BratuFold {
    const PARAMETERS: usize = 1;
    const LEFT: usize = 3;

    fn slope<R: Scalar>(&self, _: f64, z: &[R], p: &[R], out: &mut [R]) {
        let by_u = p[0] * z[0].exp();
        out[0] = z[1];
        out[1] = -by_u;
        out[2] = z[3];
        out[3] = -by_u * z[2];
    }

    fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0];
        out[1] = z[2];
        out[2] = z[3] - 1.0;
    }

    fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0];
        out[1] = z[2];
    }
}

/// lambda at the fold of Bratu's problem: `8 / sinh^2 c` at `c tanh c = 1`.
const BRATU_FOLD: f64 = 3.513_830_719_125_161;

fn solved<P: Known<N>, const N: usize>(problem: &P, options: &Options) -> Sol<N> {
    let sol = solve(problem, &problem.guess(), options).unwrap();
    println!("{}: error {:e} at tolerance {:e}, {:?}", P::NAME, sol.error(), options.tolerance, sol.statistics());
    sol
}

/// The largest error of the first unknown over what it counts over, and the largest estimate of it.
fn error_and_estimate<P: Known<N>, const N: usize>(problem: &P, sol: &Sol<N>) -> [f64; 2] {
    let [a, b] = sol.interval();
    let (mut worst, mut estimated) = (0.0_f64, 0.0_f64);
    for k in 0..=3000 {
        let s = a + (b - a) * f64::from(k) / 3000.0;
        let exact = problem.exact(s).unwrap();
        worst = worst.max((sol.eval(s)[0] - exact).abs() / (1.0 + exact.abs()));
        estimated = estimated.max(sol.error_at(s)[0].abs() / (1.0 + exact.abs()));
    }
    [worst, estimated]
}

#[test]
fn estimates_are_the_errors_they_estimate() {
    for tolerance in [1e-3, 1e-5, 1e-7, 1e-9, 1e-11] {
        let options = Options { norm: Norm::Unknown(0), ..Options::with_tolerance(tolerance) };
        for upper in [false, true] {
            let problem = Bratu { lambda: 1.0, upper };
            check(tolerance, error_and_estimate(&problem, &solved(&problem, &options)));
        }
        for epsilon in [1e-2, 1e-4, 1e-6] {
            let problem = Shock { epsilon };
            check(tolerance, error_and_estimate(&problem, &solved(&problem, &options)));
        }
    }
}

fn check(tolerance: f64, [error, estimate]: [f64; 2]) {
    println!("    {error:e} estimated as {estimate:e}");
    assert!(error <= 1.2 * tolerance, "{error:e} at {tolerance:e}");
    assert!((error / estimate - 1.0).abs() < 0.3 || error < 1e-12, "{error:e} estimated as {estimate:e}");
}

#[test]
fn the_fold_of_bratu_s_problem_is_where_it_is_published() {
    let guess = Guess::function(|s| [4.5 * s * (1.0 - s), 4.5 * (1.0 - 2.0 * s), s * (1.0 - s), 1.0 - 2.0 * s, 3.0]);
    let sol = solve(&BratuFold, &guess, &Options::with_tolerance(1e-11)).unwrap();
    println!("{:?}", sol.statistics());
    assert!((sol.parameters()[0] - BRATU_FOLD).abs() < 1e-11, "{:?}", sol.parameters());
}

#[test]
fn troesch_s_slopes_are_those_published() {
    for (mu, slope) in [(5.0, 4.575_046_14e-2), (10.0, 3.583_377_8e-4)] {
        let problem = Troesch { mu, slope };
        let sol = solved(&problem, &Options::with_tolerance(1e-10));
        assert!(problem.error(|s| sol.eval(s)) < 1e-6 * slope, "{:e}", sol.eval(0.0)[1]);
        // u'^2 / 2 - cosh(mu u) is constant.
        let first = sol.eval(0.0);
        for k in 0..=50 {
            let [u, v] = sol.eval(f64::from(k) / 50.0);
            let (energy, large) = (0.5 * v * v - (mu * u).cosh(), 1.0 + (mu * u).cosh());
            assert!((energy - 0.5 * first[1] * first[1] + 1.0).abs() < 1e-6 * large, "{k}: {energy}");
        }
    }
}

#[test]
fn characteristic_values_of_mathieu_s_equation_are_those_tabulated() {
    // Abramowitz and Stegun, table 20.1; Digital Library of Mathematical Functions, table 28.6.1.
    for (q, order, characteristic) in [(1.0, 0, -0.455_138_60), (5.0, 2, 7.449_109_74), (5.0, 4, 17.096_581_68)] {
        let problem = Mathieu { q, characteristic, order };
        let sol = solved(&problem, &Options::with_tolerance(1e-10));
        let a = sol.parameters()[0];
        assert!((a - characteristic).abs() < 1e-8, "order {order}: {a}");
    }
}

#[test]
fn an_elastica_has_the_load_and_the_tip_of_elliptic_integrals() {
    for degrees in [20.0_f64, 60.0, 120.0, 170.0] {
        let problem = Elastica { tip: degrees.to_radians() };
        let sol = solved(&problem, &Options::with_tolerance(1e-11));
        let error = problem.error(|s| sol.eval(s));
        assert!(error < 2e-11 * (1.0 + problem.known()[0]), "{degrees} degrees: {error:e}");
    }
}
