//! Orders of convergence: of the collocation on equal elements, and of whole solves as their meshes grow.

use std::convert::Infallible;

use hydrostat::{Arm, Cable, Configuration, Gravity, Options, Profile, Solver, cases};
use hydrostat_bvp::{Collocation, Condition, Correction, Mesh, OnMesh, Pointwise, Slopes, Solution};
use hydrostat_figures::{Measure, Page, Panel, Scale, lines_figure};
use rayon::prelude::*;

use crate::numbers::{fixed, larger, size};
use crate::report::{Check, Row, Section, Table};

/// Smooth arms of several kinds, easy and hard.
pub fn arms() -> Vec<Arm> {
    let mut arms = Vec::new();
    let mut cone = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    cone.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.5));
    cone.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    "cone".clone_into(&mut cone.name);
    arms.push(cone.clone());
    "cone along a stream".clone_into(&mut cone.name);
    cone.flow.speed = 0.1;
    arms.push(cone.clone());
    "heavy cone across a stream".clone_into(&mut cone.name);
    cone.flow.direction = 1.2;
    cone.density = 1200.0;
    cone.gravity = Some(Gravity::default());
    arms.push(cone);
    for mut cases in [cases::end_loads(), cases::own_weights(), cases::follower_loads(), cases::normal_drag()] {
        arms.extend(cases.pop().map(|c| c.arm));
    }
    arms
}

/// An inextensible rod with EI = 1 under a dead end force across it and a couple along it that makes theta = sin(12 s) + s^2/2
/// exact: m' = -P cos(theta) - c(s).
struct Rod;

const PULL: f64 = 3.0;

impl Rod {
    /// theta, theta' and theta''.
    fn exact(s: f64) -> [f64; 3] {
        let (sin, cos) = (12.0 * s).sin_cos();
        [sin + 0.5 * s * s, 12.0 * cos + s, 1.0 - 144.0 * sin]
    }

    /// Where its tip is, by Simpson's rule on so many intervals that rounding is left.
    fn tip() -> [f64; 2] {
        const HALVES: u32 = 20_000;
        let step = 1.0 / f64::from(2 * HALVES);
        let mut sums = [0.0; 2];
        for k in 0..=2 * HALVES {
            let weight = if k == 0 || k == 2 * HALVES { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
            let (sin, cos) = Self::exact(f64::from(k) * step)[0].sin_cos();
            sums[0] += weight * cos;
            sums[1] += weight * sin;
        }
        sums.map(|sum| sum * step / 3.0)
    }
}

impl Pointwise<2, 2> for Rod {
    type Failure = Infallible;

    fn slopes(&self, s: f64, &[theta, m]: &[f64; 2]) -> Result<Slopes<2, 2>, Infallible> {
        let (sin, cos) = theta.sin_cos();
        let [exact, _, bend] = Self::exact(s);
        let couple = -bend - PULL * exact.cos();
        Ok(Slopes {
            slope: [m, -PULL * cos - couple],
            jacobian: [[0.0, 1.0], [PULL * sin, 0.0]],
            rate: [cos, sin],
            rate_gradient: [[-sin, 0.0], [cos, 0.0]],
        })
    }

    fn left_count(&self) -> usize {
        1
    }

    fn left(&self, z: &[f64; 2], out: &mut [Condition<2>; 2]) {
        out[0] = Condition { residual: z[0], gradient: [1.0, 0.0] };
    }

    fn right(&self, z: &[f64; 2], out: &mut [Condition<2>; 2]) {
        out[0] = Condition { residual: z[1] - Self::exact(1.0)[1], gradient: [0.0, 1.0] };
    }
}

/// The largest error of theta at the nodes, and that of the tip, on equal elements with `M` stages.
fn rod_errors<const M: usize>(elements: usize, tip: [f64; 2]) -> [f64; 2] {
    let mut solution = Solution::<2, M>::constant(Mesh::uniform(elements, &[]), [0.0; 2], []);
    let mut system = Collocation::<2, M, 2>::new();
    let problem = OnMesh::new(Rod, &system.gauss, &solution.mesh);
    let mut correction = Correction::default();
    for _ in 0..20 {
        if system.linearise::<_, false>(&problem, &solution).is_err() {
            return [f64::NAN; 2];
        }
        system.newton::<false>(&solution, &mut correction);
        solution.add(&correction, 1.0);
        if correction.largest(0) < 1e-14 {
            break;
        }
    }
    if system.linearise::<_, false>(&problem, &solution).is_err() {
        return [f64::NAN; 2];
    }
    let nodes = solution.mesh.nodes().iter().zip(&solution.nodes).map(|(s, z)| (z[0] - Rod::exact(*s)[0]).abs());
    let [x, y] = system.totals();
    [nodes.fold(0.0, larger), (x - tip[0]).hypot(y - tip[1])]
}

/// Elements, and both errors on them.
type Errors = Vec<(usize, [f64; 2])>;

fn on<const M: usize>(counts: &[usize], tip: [f64; 2]) -> Errors {
    counts.iter().map(|n| (*n, rod_errors::<M>(*n, tip))).collect()
}

/// What rounding leaves of an error.
const ROUNDING: f64 = 1e-13;

/// The slope of the last two errors that rounding has no part in, on logarithmic axes.
fn order(errors: &Errors, which: usize) -> f64 {
    let seen: Vec<(f64, f64)> = errors
        .iter()
        .filter(|(_, e)| e[which] > 10.0 * ROUNDING)
        .map(|(n, e)| ((*n as f64).ln(), e[which].ln()))
        .collect();
    match seen[..] {
        [.., a, b] => (a.1 - b.1) / (b.0 - a.0),
        _ => f64::NAN,
    }
}

pub(crate) fn section() -> Section {
    let mut section = Section::new("convergence", "Orders of convergence");
    section.text(
        "The solver is Gauss collocation. With M stages an element its order at the nodes is 2 M; Hydrostat uses M = 4, and 5 for the check \
         behind its error estimate. First on equal elements, for a rod whose exact shape was chosen and whose load follows from it; then for \
         whole solves, whose elements are placed by the error estimate. Chosen shapes of the arm's own equations are found under all \
         240 combinations of the readings and flow laws, with orders of 7.48 and more, in crates/hydrostat/src/statics/engine/manufactured.rs.",
    );
    let tip = Rod::tip();
    let counts = [2, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256];
    let all = [
        on::<1>(&counts, tip),
        on::<2>(&counts, tip),
        on::<3>(&counts, tip),
        on::<4>(&counts, tip),
        on::<5>(&counts, tip),
    ];
    let mut table = Table::new(
        "Order on equal elements, from the last two meshes that rounding has no part in",
        "2 M: the superconvergence of Gauss collocation at the nodes. Checked is what an order is short of it, over it. The rod's exact shape is theta = sin(12 s) + s^2/2.",
        &["stages", "order of theta", "order of the tip", "error of theta on 24 elements", "design order"],
    );
    for (stages, errors) in (1..).zip(&all) {
        let orders = [order(errors, 0), order(errors, 1)];
        let design = f64::from(2 * stages);
        let on_24 = errors.iter().find(|(n, _)| *n == 24).map_or(f64::NAN, |(_, e)| e[0]);
        // Where rounding is near, errors may fall faster than the design says; they may not fall slower.
        let short = orders.map(|o| if o > design { 0.0 } else { 1.0 - o / design });
        let off = larger(short[0], short[1]);
        table.push(
            Row::new([stages.to_string(), fixed(orders[0], 2), fixed(orders[1], 2), size(on_24), fixed(design, 0)])
                .checked(Check::within(off, 0.06)),
        );
    }
    section.table(table);
    let lines = |which: usize| -> Vec<Vec<[f64; 2]>> {
        let shown = |errors: &Errors| {
            errors.iter().filter(|(_, e)| e[which] > ROUNDING).map(|(n, e)| [*n as f64, e[which]]).collect()
        };
        all.iter().map(shown).collect()
    };
    let logarithmic = |title: &str| Measure { title: title.to_owned(), scale: Scale::Logarithmic };
    let panels = [
        Panel { up: logarithmic("error of theta (rad)"), lines: lines(0) },
        Panel { up: logarithmic("error of the tip / L"), lines: lines(1) },
    ];
    section.figure(
        "orders",
        "Errors on equal elements, down to rounding; a design order 2 M is a slope of -2 M.",
        lines_figure(
            "a rod of known shape",
            &logarithmic("elements"),
            &["M = 1", "2", "3", "4", "5"],
            &panels,
            &Page::default(),
        ),
    );
    meshes(&mut section);
    section
}

/// What an arm's solves at several tolerances have: elements, and the error of the tip over L.
fn tolerances(arm: &Arm) -> Vec<[f64; 2]> {
    let solve = |tol: f64| -> Option<Configuration> {
        Solver::new(arm, Options::with_tol(tol)).and_then(|mut solver| solver.solve()).ok()
    };
    let Some(best) = solve(1e-12) else { return Vec::new() };
    (3..=11)
        .filter_map(|digits| solve(10_f64.powi(-digits)))
        .map(|solved| {
            let (a, b) = (solved.tip(), best.tip());
            [solved.statistics.elements as f64, (a.x - b.x).hypot(a.y - b.y) / arm.length]
        })
        .collect()
}

fn meshes(section: &mut Section) {
    let arms = arms();
    let solved: Vec<Vec<[f64; 2]>> = arms.par_iter().map(tolerances).collect();
    let mut table = Table::new(
        "Elements at tolerances from 1e-3 to 1e-11",
        "order 8: six digits more take about 10^(6/8) = 5.6 times the elements. Up to 9 times is allowed, as meshes begin at 8 elements and come in fours.",
        &["arm", "at 1e-5", "at 1e-11", "ratio", "error at 1e-5", "error at 1e-11"],
    );
    for (arm, points) in arms.iter().zip(&solved) {
        let at = |digits: usize| points.get(digits - 3).filter(|_| points.len() == 9).copied().unwrap_or([f64::NAN; 2]);
        let (coarse, fine) = (at(5), at(11));
        let ratio = fine[0] / coarse[0];
        table.push(
            Row::new([
                arm.name.clone(),
                fixed(coarse[0], 0),
                fixed(fine[0], 0),
                fixed(ratio, 1),
                size(coarse[1]),
                size(fine[1]),
            ])
            .checked(Check::within(ratio, 9.0)),
        );
    }
    section.table(table);
    let names: Vec<&str> = arms.iter().map(|arm| arm.name.as_str()).collect();
    let logarithmic = |title: &str| Measure { title: title.to_owned(), scale: Scale::Logarithmic };
    let panel = Panel { up: logarithmic("error of the tip / L"), lines: solved };
    section.figure(
        "meshes",
        "Error of the tip against elements of the final mesh, for tolerances from 1e-3 to 1e-11; the solve at 1e-12 stands for the exact one.",
        lines_figure("whole solves", &logarithmic("elements"), &names, &[panel], &Page::default()),
    );
}
