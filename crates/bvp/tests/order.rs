//! Order of the method, stiffness in both directions at once, and the determinant's sign.

use std::convert::Infallible;
use std::f64::consts::PI;

use hydrostat_bvp::{Collocation, Condition, Correction, LANES, Lanes, Mesh, OnMesh, Pointwise, Slopes, Solution};

/// u'' = f(s, u), with u or u' given at each end.
trait Equation {
    /// f and its derivative by u.
    fn bend(&self, s: f64, u: f64) -> [f64; 2];

    /// What the quadrature adds up, and its derivative by u.
    fn rate(&self, u: f64) -> [f64; 2] {
        [u, 1.0]
    }

    /// At s = 0 and s = 1: which of u, u' is given, and its value.
    fn ends(&self) -> [(usize, f64); 2];
}

/// An equation as the solver takes it.
struct Scalar<'e, E> {
    equation: &'e E,
}

fn given((a, value): (usize, f64), z: &[f64; 2]) -> Condition<2> {
    let mut gradient = [0.0; 2];
    gradient[a] = 1.0;
    Condition { residual: z[a] - value, gradient }
}

impl<E: Equation> Pointwise<2, 1> for Scalar<'_, E> {
    type Failure = Infallible;

    fn slopes(&self, s: f64, &[u, v]: &[f64; 2]) -> Result<Slopes<2, 1>, Infallible> {
        let ([bend, by_u], [rate, rate_by_u]) = (self.equation.bend(s, u), self.equation.rate(u));
        Ok(Slopes {
            slope: [v, bend],
            jacobian: [[0.0, 1.0], [by_u, 0.0]],
            rate: [rate],
            rate_gradient: [[rate_by_u, 0.0]],
        })
    }

    fn left_count(&self) -> usize {
        1
    }

    fn left(&self, z: &[f64; 2], out: &mut [Condition<2>; 2]) {
        out[0] = given(self.equation.ends()[0], z);
    }

    fn right(&self, z: &[f64; 2], out: &mut [Condition<2>; 2]) {
        out[0] = given(self.equation.ends()[1], z);
    }
}

/// Newton from `solution`, undamped, until corrections stop falling. Returns the workspace at the end.
fn newton<const M: usize>(equation: &impl Equation, solution: &mut Solution<2, M>) -> Collocation<2, M, 1> {
    let mut system = Collocation::new();
    let problem = OnMesh::new(Scalar { equation }, &system.gauss, &solution.mesh);
    let mut correction = Correction::default();
    for _ in 0..12 {
        system.linearise::<_, false>(&problem, solution).unwrap();
        system.newton::<false>(solution, &mut correction);
        solution.add(&correction, 1.0);
        if (0..2).all(|a| correction.largest(a) < 1e-14) {
            break;
        }
    }
    system.linearise::<_, false>(&problem, solution).unwrap();
    system
}

/// u'' = 3/2 u^2, u(0) = 4, u(1) = 1 of Stoer and Bulirsch, whose solution is 4/(1+s)^2.
/// The quadrature is the integral of u: 2.
struct Parabola;

impl Equation for Parabola {
    fn bend(&self, _: f64, u: f64) -> [f64; 2] {
        [1.5 * u * u, 3.0 * u]
    }

    fn ends(&self) -> [(usize, f64); 2] {
        [(0, 4.0), (0, 1.0)]
    }
}

/// Largest error at the nodes, and that of the quadrature, on `elements` equal elements.
fn parabola_errors<const M: usize>(elements: usize) -> [f64; 2] {
    let mesh = Mesh::uniform(elements, &[]);
    let mut solution = Solution::<2, M>::constant(mesh, [4.0, -8.0], []);
    // Started on the solution's side of the other solution that this problem has.
    for (z, s) in solution.nodes.iter_mut().zip(solution.mesh.nodes()) {
        *z = [4.0 - 3.0 * s, -3.0];
    }
    for stage in &mut solution.stages {
        stage.slope = [Lanes([-3.0; LANES]), Lanes::default()];
    }
    let system = newton(&Parabola, &mut solution);
    let nodes = solution.nodes.iter().zip(solution.mesh.nodes()).fold(0.0_f64, |worst, (z, s)| {
        worst.max((z[0] - 4.0 / ((1.0 + s) * (1.0 + s))).abs()).max((z[1] + 8.0 / (1.0 + s).powi(3)).abs())
    });
    [nodes, (system.totals()[0] - 2.0).abs()]
}

/// Halving the elements divides the errors by 2^(2M), until rounding.
fn check_order<const M: usize>(coarsest: usize) {
    let errors = [coarsest, 2 * coarsest, 4 * coarsest].map(parabola_errors::<M>);
    for k in 0..2 {
        for q in 0..2 {
            let order = (errors[k][q] / errors[k + 1][q]).log2();
            let name = ["nodes", "quadrature"][q];
            eprintln!("{M} stages, {name}: order {order:.3}");
            // Orders set in from below: 0.04 M off on the coarse meshes that high orders allow.
            assert!((order / (2.0 * M as f64) - 1.0).abs() < 0.04, "{M} stages, {name}: {order}, {errors:?}");
        }
    }
}

#[test]
fn the_order_is_twice_the_number_of_stages() {
    check_order::<1>(32);
    check_order::<2>(16);
    check_order::<3>(8);
    check_order::<4>(6);
}

/// u'' = k^2 u - (k^2 + pi^2) cos(pi s): one solution of it grows by e^k, another decays as much.
struct Layers {
    k: f64,
}

impl Layers {
    /// cos(pi s) + exp(-k s) + exp(-k (1-s)).
    fn exact(&self, s: f64) -> [f64; 2] {
        let (left, right) = ((-self.k * s).exp(), (-self.k * (1.0 - s)).exp());
        [(PI * s).cos() + left + right, -PI * (PI * s).sin() + self.k * (right - left)]
    }
}

impl Equation for Layers {
    fn bend(&self, s: f64, u: f64) -> [f64; 2] {
        let square = self.k * self.k;
        [square * u - (square + PI * PI) * (PI * s).cos(), square]
    }

    fn ends(&self) -> [(usize, f64); 2] {
        [(0, self.exact(0.0)[0]), (0, self.exact(1.0)[0])]
    }
}

/// Shooting from either end would multiply rounding by e^k: 1e434 at k = 1000, beyond any float.
#[test]
fn growing_and_decaying_solutions_are_solved_together() {
    for (k, inner) in [(50.0, 20), (300.0, 40), (1000.0, 60)] {
        let problem = Layers { k };
        // Nodes spaced by a tenth of the layer in both layers, wide between.
        let mut breaks: Vec<f64> = (1..=inner).map(|i| f64::from(i) * 0.5 / k).collect();
        let mirrored: Vec<f64> = breaks.iter().rev().map(|s| 1.0 - s).collect();
        breaks.extend(mirrored);
        let mut solution = Solution::<2, 4>::constant(Mesh::uniform(64, &breaks), [0.0; 2], []);
        let system = newton(&problem, &mut solution);
        let worst = solution.nodes.iter().zip(solution.mesh.nodes()).fold(0.0_f64, |worst, (z, s)| {
            let exact = problem.exact(*s);
            worst.max((z[0] - exact[0]).abs()).max((z[1] - exact[1]).abs() / k)
        });
        let total = 2.0 * (1.0 - (-k).exp()) / k;
        let off = (system.totals()[0] - total).abs();
        assert!(worst < 1e-8 && off < 1e-8, "k {k}: nodes {worst:e}, quadrature {off:e}");
    }
}

/// The determinant of these conditions is sinh(k)/k, whose logarithm stays where it overflows.
#[test]
fn the_determinant_does_not_overflow() {
    for k in [1.0_f64, 50.0, 1000.0] {
        let problem = Layers { k };
        let mut solution = Solution::<2, 4>::constant(Mesh::uniform(2000, &[]), [0.0; 2], []);
        let found = newton(&problem, &mut solution).determinant();
        let log = k + (-(-2.0 * k).exp()).ln_1p() - (2.0 * k).ln();
        assert_eq!(found.sign, 1.0);
        assert!((found.log - log).abs() < 1e-8 * (1.0 + log.abs()), "k {k}: {} for {log}", found.log);
    }
}

/// theta'' + lambda sin theta = 0, clamped-free: theta(0) = 0, theta'(1) = 0.
struct Column {
    lambda: f64,
}

impl Equation for Column {
    fn bend(&self, _: f64, theta: f64) -> [f64; 2] {
        [-self.lambda * theta.sin(), -self.lambda * theta.cos()]
    }

    fn rate(&self, theta: f64) -> [f64; 2] {
        [theta.cos(), -theta.sin()]
    }

    fn ends(&self) -> [(usize, f64); 2] {
        [(0, 0.0), (1, 0.0)]
    }
}

/// The straight column's determinant is cos(sqrt(lambda)): it changes sign at each buckling load.
#[test]
fn the_determinant_changes_sign_at_each_eigenvalue() {
    for mode in 0..4 {
        let eigenvalue = ((f64::from(mode) + 0.5) * PI).powi(2);
        for fraction in [0.9999, 1.0001] {
            let lambda = fraction * eigenvalue;
            for elements in [20, 37] {
                let mut solution = Solution::<2, 4>::constant(Mesh::uniform(elements, &[]), [0.0; 2], []);
                let found = newton(&Column { lambda }, &mut solution).determinant();
                let want = lambda.sqrt().cos();
                assert_eq!(found.sign, want.signum(), "mode {mode}, {fraction}, {elements} elements");
                let off = (found.log.exp() - want.abs()).abs();
                assert!(off < 1e-6, "mode {mode}, {fraction}, {elements} elements: off by {off:e}");
            }
        }
    }
}

/// Past its load, the bent column is the stable one: its determinant has the sign that the straight
/// one had below the load.
#[test]
fn the_bent_column_has_the_sign_of_the_straight_one_below_its_load() {
    let lambda = 1.1 * PI * PI / 4.0;
    let mut solution = Solution::<2, 4>::constant(Mesh::uniform(10, &[]), [0.0; 2], []);
    for (z, s) in solution.nodes.iter_mut().zip(solution.mesh.nodes()) {
        *z = [0.9 * (0.5 * PI * s).sin(), 0.9 * 0.5 * PI * (0.5 * PI * s).cos()];
    }
    for i in 0..10 {
        let slope = |a: usize| (solution.nodes[i + 1][a] - solution.nodes[i][a]) / solution.mesh.step(i);
        let slopes = [slope(0), slope(1)];
        for j in 0..4 {
            let (block, lane) = solution.groups().at(i, j);
            for a in 0..2 {
                solution.stages[block].slope[a].0[lane] = slopes[a];
            }
        }
    }
    let system = newton(&Column { lambda }, &mut solution);
    assert!(solution.nodes[10][0] > 0.5);
    assert_eq!(system.determinant().sign, 1.0);
    // m^2/2 - lambda cos(theta) is constant along it.
    let invariant = |z: &[f64; 2]| 0.5 * z[1] * z[1] - lambda * z[0].cos();
    for z in &solution.nodes {
        assert!((invariant(z) - invariant(&solution.nodes[0])).abs() < 1e-9);
    }
}
