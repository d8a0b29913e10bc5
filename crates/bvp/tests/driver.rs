//! The driver beyond five problems: other state counts, coupled conditions, goals, breaks, ways to derivatives, and what it refuses.

use hydrostat_bvp::{Bvp, Differentiable, Error, Guess, Norm, Options, Scalar, solve};

/// An arm that rests on an elastic foundation (Winkler's): x, y, the angle, horizontal and vertical force, and the moment. The load depends on
/// the position. A force `load` acts across the free end s = 0; the other end is free, too.
struct OnFoundation {
    stiffness: f64,
    foundation: f64,
    length: f64,
    load: f64,
}

impl Differentiable<6> for OnFoundation {
    const LEFT: usize = 3;

    fn interval(&self) -> [f64; 2] {
        [0.0, self.length]
    }

    fn slope<R: Scalar>(&self, _: f64, z: &[R], _: &[R], out: &mut [R]) {
        let &[_, y, angle, horizontal, vertical, moment] = z else { return };
        out[0] = angle.cos();
        out[1] = angle.sin();
        out[2] = moment / self.stiffness;
        out[3] = R::from(0.0);
        out[4] = y * self.foundation;
        out[5] = horizontal * angle.sin() - vertical * angle.cos();
    }

    fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0];
        out[1] = z[4] + self.load;
        out[2] = z[5];
    }

    fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[3];
        out[1] = z[4];
        out[2] = z[5];
    }

    /// What the foundation carries.
    fn goal<R: Scalar>(&self, _: f64, z: &[R], _: &[R]) -> R {
        z[1] * self.foundation
    }
}

impl OnFoundation {
    /// Deflection and slope of the loaded end by Hetenyi ("Beams on Elastic Foundation", 1946, section 21), for small deflections.
    fn hetenyi(&self) -> [f64; 2] {
        let rate = (0.25 * self.foundation / self.stiffness).powf(0.25);
        let l = rate * self.length;
        let (sh, ch, sn, cs) = (l.sinh(), l.cosh(), l.sin(), l.cos());
        let below = sh * sh - sn * sn;
        let unit = 2.0 * self.load * rate / self.foundation;
        [unit * (sh * ch - sn * cs) / below, -unit * rate * (sh * sh + sn * sn) / below]
    }
}

#[test]
fn an_arm_on_an_elastic_foundation_deflects_as_in_hetenyi_s_closed_form() {
    for length in [0.5, 2.0, 8.0] {
        let mut off = Vec::new();
        for load in [1e-2, 1e-3, 1e-4] {
            let problem = OnFoundation { stiffness: 0.7, foundation: 20.0, length, load };
            let options = Options { floor: load, ..Options::with_tolerance(1e-9) };
            let guess = Guess::function(|s| [s, 0.0, 0.0, 0.0, 0.0, 0.0]);
            let sol = solve(&problem, &guess, &options).unwrap();
            let ([deflection, slope], found) = (problem.hetenyi(), sol.eval(0.0));
            off.push((found[1] / deflection - 1.0).abs().max((found[2] / slope - 1.0).abs()));
            // Equilibrium holds for large deflections, too.
            assert!((sol.goal() - load).abs() < 1e-7 * load, "{length} {load}: {:e}", sol.goal() - load);
        }
        println!("length {length}: {off:?}");
        // What the closed form leaves out is of second order in the load.
        assert!(off[0] < 2e-2 && off[1] < 0.02 * off[0] && off[2] < 1e-6, "length {length}: {off:?}");
    }
}

/// `u'' + 2 u = cos s` with a period of 2 pi: coupled conditions, by parameters that are the values at s = 0. The solution is cos s.
struct Periodic;

impl Differentiable<4> for Periodic {
    const PARAMETERS: usize = 2;
    const LEFT: usize = 2;

    fn interval(&self) -> [f64; 2] {
        [0.0, std::f64::consts::TAU]
    }

    fn slope<R: Scalar>(&self, s: f64, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[1];
        out[1] = z[0] * -2.0 + s.cos();
    }

    fn left<R: Scalar>(&self, z: &[R], p: &[R], out: &mut [R]) {
        out[0] = z[0] - p[0];
        out[1] = z[1] - p[1];
    }

    fn right<R: Scalar>(&self, z: &[R], p: &[R], out: &mut [R]) {
        out[0] = z[0] - p[0];
        out[1] = z[1] - p[1];
    }
}

#[test]
fn coupled_conditions_hold_by_parameters() {
    let sol = solve(&Periodic, &Guess::constant([0.0; 4]), &Options::with_tolerance(1e-9)).unwrap();
    for k in 0..=100 {
        let s = std::f64::consts::TAU * f64::from(k) / 100.0;
        assert!((sol.eval(s)[0] - s.cos()).abs() < 2e-9);
        assert!((sol.derivative(s)[0] + s.sin()).abs() < 1e-6);
    }
    assert!((sol.parameters()[0] - 1.0).abs() < 1e-9 && sol.parameters()[1].abs() < 1e-9);
}

/// Bratu's problem with the integral of e^u as its goal; derivatives by differences.
struct Bratu(f64);

impl Bvp<2> for Bratu {
    const LEFT: usize = 1;

    fn slope(&self, _: f64, z: &[f64], _: &[f64], out: &mut [f64]) {
        (out[0], out[1]) = (z[1], -self.0 * z[0].exp());
    }

    fn left(&self, z: &[f64], _: &[f64], out: &mut [f64]) {
        out[0] = z[0];
    }

    fn right(&self, z: &[f64], _: &[f64], out: &mut [f64]) {
        out[0] = z[0];
    }

    fn goal(&self, _: f64, z: &[f64], _: &[f64]) -> f64 {
        z[0].exp()
    }
}

/// The same with analytic derivatives.
struct Analytic(Bratu);

impl Bvp<2> for Analytic {
    const LEFT: usize = 1;

    fn slope(&self, s: f64, z: &[f64], p: &[f64], out: &mut [f64]) {
        self.0.slope(s, z, p, out);
    }

    fn slope_with_jacobian(&self, s: f64, z: &[f64], p: &[f64], out: &mut [f64], jacobian: &mut [[f64; 2]]) {
        self.slope(s, z, p, out);
        (jacobian[0], jacobian[1]) = ([0.0, 1.0], [out[1], 0.0]);
    }

    fn left(&self, z: &[f64], p: &[f64], out: &mut [f64]) {
        self.0.left(z, p, out);
    }

    fn right(&self, z: &[f64], p: &[f64], out: &mut [f64]) {
        self.0.right(z, p, out);
    }
}

/// The upper solution, which is steep.
fn upper(s: f64) -> [f64; 2] {
    [16.0 * s * (1.0 - s), 16.0 * (1.0 - 2.0 * s)]
}

#[test]
fn differences_lead_where_analytic_derivatives_lead() {
    let options = Options::with_tolerance(1e-10);
    let by_differences = solve(&Bratu(1.0), &Guess::function(upper), &options).unwrap();
    let analytic = solve(&Analytic(Bratu(1.0)), &Guess::function(upper), &options).unwrap();
    assert!((by_differences.eval(0.5)[0] - analytic.eval(0.5)[0]).abs() < 1e-10);
    let (a, b) = (by_differences.statistics(), analytic.statistics());
    assert!(a.iterations <= b.iterations + 2, "{a:?} {b:?}");
}

#[test]
fn a_goal_is_met_on_fewer_elements_than_the_whole_solution() {
    // u' = 4 c tanh(c (1 - 2 s)) with cosh c = 4 c / sqrt 2, so that the integral is 8 c tanh c.
    let c = 2.734_675_693_030_527_f64;
    assert!((c.cosh() - 4.0 * c / 2.0_f64.sqrt()).abs() < 1e-11);
    let exact = 8.0 * c * c.tanh();
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let options = Options { norm: Norm::Goal, ..Options::with_tolerance(tolerance) };
        let sol = solve(&Bratu(1.0), &Guess::function(upper), &options).unwrap();
        let all = solve(&Bratu(1.0), &Guess::function(upper), &Options::with_tolerance(tolerance)).unwrap();
        let error = sol.goal() - exact;
        println!("{tolerance:e}: {error:e}, estimated {:e}, {:?}", -sol.goal_error(), sol.statistics());
        assert!(error.abs() <= 1.5 * tolerance * (1.0 + exact), "{error:e}");
        // What is far below the tolerance is not asymptotic yet.
        let small = 1e-3 * tolerance * (1.0 + exact) + 1e-11;
        assert!((error + sol.goal_error()).abs() < 0.6 * error.abs() + small, "{error:e} {:e}", sol.goal_error());
        assert!(sol.statistics().elements <= all.statistics().elements);
    }
}

/// `u' = sign(s)` on [-1, 1] with u(-1) = 1: |s|.
struct Kink;

impl Bvp<1> for Kink {
    const LEFT: usize = 1;

    fn interval(&self) -> [f64; 2] {
        [-1.0, 1.0]
    }

    fn breaks(&self) -> Vec<f64> {
        vec![0.0]
    }

    fn slope(&self, s: f64, _: &[f64], _: &[f64], out: &mut [f64]) {
        out[0] = s.signum();
    }

    fn left(&self, z: &[f64], _: &[f64], out: &mut [f64]) {
        out[0] = z[0] - 1.0;
    }

    fn right(&self, _: &[f64], _: &[f64], _: &mut [f64]) {}
}

#[test]
fn breaks_of_the_data_are_nodes_and_cost_nothing() {
    let sol = solve(&Kink, &Guess::constant([0.0]).elements(3), &Options::with_tolerance(1e-12)).unwrap();
    assert!((sol.eval(0.3)[0] - 0.3).abs() < 1e-14 && sol.eval(0.0)[0].abs() < 1e-14);
    assert_eq!(sol.statistics().meshes, 1);
    assert!(sol.nodes().any(|s| s == 0.0));
}

#[test]
fn a_solution_is_the_guess_for_the_problem_nearby() {
    let options = Options::with_tolerance(1e-8);
    let first = solve(&Bratu(1.0), &Guess::constant([0.1, 0.0]), &options).unwrap();
    let next = solve(&Bratu(1.05), &Guess::solution(&first), &options).unwrap();
    assert_eq!(next.statistics().meshes, 1);
    assert!(next.statistics().iterations <= 4, "{:?}", next.statistics());
}

#[test]
fn beyond_the_fold_the_error_says_how_far_newton_came() {
    match solve(&Bratu(3.7), &Guess::constant([0.5, 0.0]), &Options { max_elements: 64, ..Options::default() }) {
        Err(Error::Stalled { correction, s, damping, iterations, elements }) => {
            assert!(correction > 1e-6 && (0.0..=1.0).contains(&s) && damping < 1.0 && iterations > 3 && elements <= 64);
        }
        Err(Error::Singular { s: None, elements }) => assert!(elements <= 64),
        other => panic!("{other:?}"),
    }
}

/// A problem whose logarithm has no value at the guess.
struct Logarithm;

impl Differentiable<1> for Logarithm {
    const LEFT: usize = 1;

    fn slope<R: Scalar>(&self, _: f64, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0].ln();
    }

    fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[0] - 2.0;
    }

    fn right<R: Scalar>(&self, _: &[R], _: &[R], _: &mut [R]) {}
}

#[test]
fn refusals_carry_numbers() {
    let refused = solve(&Logarithm, &Guess::constant([-1.0]), &Options::default()).unwrap_err();
    assert!(matches!(refused, Error::NotFinite { s } if (0.0..0.2).contains(&s)), "{refused:?}");
    let refused = solve(&Bratu(1.0), &Guess::constant([0.0; 2]), &Options::with_tolerance(1e-15)).unwrap_err();
    assert_eq!(refused.to_string(), "tolerance must be in [1e-13, 0.1], found 0.000000000000001");
    let options = Options { max_elements: 8, ..Options::with_tolerance(1e-10) };
    match solve(&Bratu(1.0), &Guess::function(upper), &options).unwrap_err() {
        Error::Mesh { error, elements, meshes, .. } => assert!(error > 1e-10 && elements <= 8 && meshes <= 20),
        other => panic!("{other:?}"),
    }
    let options = Options { norm: Norm::Unknown(2), ..Options::default() };
    assert!(matches!(solve(&Bratu(1.0), &Guess::constant([0.0; 2]), &options), Err(Error::Input { value: 2.0, .. })));
}

/// A problem that is singular: nothing says what u is.
struct Free;

impl Differentiable<2> for Free {
    const LEFT: usize = 1;

    fn slope<R: Scalar>(&self, _: f64, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[1];
        out[1] = R::from(0.0);
    }

    fn left<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[1];
    }

    fn right<R: Scalar>(&self, z: &[R], _: &[R], out: &mut [R]) {
        out[0] = z[1];
    }
}

#[test]
fn a_problem_whose_conditions_leave_a_solution_free_is_singular() {
    let options = Options { max_elements: 16, ..Options::default() };
    let refused = solve(&Free, &Guess::constant([0.0; 2]), &options).unwrap_err();
    assert!(matches!(refused, Error::Singular { s: None, .. }), "{refused:?}");
}
