//! Arms that two cables press to a fraction of their length: there beta' has a length scale of up to a fortieth of the
//! arm, and beta is carried from element to element.
//!
//! In still water, without weight or tip loads, n_f = m_f = 0 all along. The section law then is a differential
//! equation for beta alone, beta' = P(s, beta), whose solutions all run together towards the base. Integrated that way,
//! it is a second way to the shape that shares nothing with the solver. The smooth solution is the one that goes on
//! past the tip, to where the cables meet and beta' drops out.

use hydrostat::{Arm, Cable, Configuration, Material, Options, Profile, Solver};

// The source's arm: m, Pa, Pa, N; the cables' offsets are +- OFFSET.
const LENGTH: f64 = 0.2;
const RADIUS: [f64; 2] = [0.010, 0.0008];
const OFFSET: [f64; 2] = [0.008, 0.0001];
const C: [f64; 3] = [500e3, 500e3 / 3.0, 150.0];

fn paper(tensions: [f64; 2]) -> Arm {
    let mut arm = Arm::cone(LENGTH, RADIUS[0], RADIUS[1], 500e3, 0.5);
    let [c1, c2, c3] = C.map(Profile::from);
    arm.material = Material::Coefficients { c1, c2, c3 };
    arm.cables.push(Cable::new("left", Profile::linear(OFFSET[0], OFFSET[1])).pulled(tensions[0]));
    arm.cables.push(Cable::new("right", Profile::linear(-OFFSET[0], -OFFSET[1])).pulled(tensions[1]));
    arm
}

fn solve(arm: &Arm, tol: f64) -> Configuration {
    Solver::new(arm, Options::with_tol(tol)).unwrap().solve().unwrap()
}

fn linear([base, tip]: [f64; 2], s: f64) -> f64 {
    base + (tip - base) * s / LENGTH
}

/// n . a, n . b and m of the section law less what the cables leave of them, at nu = 1/beta.
fn unbalanced(tensions: [f64; 2], s: f64, [beta, beta_slope, eta, mu]: [f64; 4]) -> [f64; 3] {
    let nu = 1.0 / beta;
    let area = std::f64::consts::PI * (beta * linear(RADIUS, s)).powi(2);
    let mut out = [C[0] * (nu - 1.0) * area, C[1] * eta * area, C[2] * mu * area];
    for (tension, side) in tensions.into_iter().zip([1.0, -1.0]) {
        let (y, y_slope) = (side * linear(OFFSET, s), side * (OFFSET[1] - OFFSET[0]) / LENGTH);
        let along = nu - y * beta * mu;
        let across = eta + y_slope * beta + y * beta_slope;
        let length = along.hypot(across);
        out[0] += tension * along / length;
        out[1] += tension * across / length;
        out[2] -= tension * y * beta * along / length;
    }
    out
}

/// beta, beta', eta and mu that balance it, by Newton's method from a guess of which one stays: beta, or, where the
/// cables meet, beta'.
fn balanced(tensions: [f64; 2], s: f64, guess: [f64; 4], stays: usize) -> [f64; 4] {
    let free: Vec<usize> = (0..4).filter(|k| *k != stays).collect();
    let mut v = guess;
    for _ in 0..60 {
        let rest = unbalanced(tensions, s, v);
        let columns = [0, 1, 2].map(|c| {
            let step = 1e-6 * v[free[c]].abs().max(1e-3);
            let [mut up, mut down] = [v, v];
            up[free[c]] += step;
            down[free[c]] -= step;
            let (up, down) = (unbalanced(tensions, s, up), unbalanced(tensions, s, down));
            [0, 1, 2].map(|r| (up[r] - down[r]) / (2.0 * step))
        });
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let [a, b, c] = columns;
        let whole = dot(a, cross(b, c));
        let change = [dot(rest, cross(b, c)), dot(a, cross(rest, c)), dot(a, cross(b, rest))].map(|d| d / whole);
        // A step changes beta by a third at most.
        let most = if stays == 0 { 1.0 } else { (0.3 * v[0] / change[0].abs()).min(1.0) };
        let mut size = 0.0_f64;
        for (k, change) in free.iter().zip(change) {
            v[*k] -= most * change;
            size = size.max(change.abs() / v[*k].abs().max(1.0));
        }
        if size < 1e-13 {
            break;
        }
    }
    v
}

/// One step of Runge and Kutta's method of order four for beta, angle and place.
fn step(tensions: [f64; 2], s: f64, h: f64, state: [f64; 4], guess: &mut [f64; 4]) -> [f64; 4] {
    let mut slopes = |s: f64, [beta, theta, _, _]: [f64; 4]| {
        guess[0] = beta;
        *guess = balanced(tensions, s, *guess, 0);
        let [_, beta_slope, eta, mu] = *guess;
        let (sin, cos) = theta.sin_cos();
        [beta_slope, mu, cos / beta - eta * sin, sin / beta + eta * cos]
    };
    let moved = |by: f64, k: [f64; 4]| [0, 1, 2, 3].map(|a| state[a] + by * k[a]);
    let k1 = slopes(s, state);
    let k2 = slopes(s + 0.5 * h, moved(0.5 * h, k1));
    let k3 = slopes(s + 0.5 * h, moved(0.5 * h, k2));
    let k4 = slopes(s + h, moved(h, k3));
    [0, 1, 2, 3].map(|a| state[a] + h / 6.0 * (k1[a] + 2.0 * (k2[a] + k3[a]) + k4[a]))
}

/// The tip's place and angle, by steps that resolve what runs together, `fine` times as many as needed.
fn tip_by_integration(tensions: [f64; 2], fine: f64) -> [f64; 3] {
    let meeting = LENGTH * OFFSET[0] / (OFFSET[0] - OFFSET[1]);
    let mut guess = balanced(tensions, meeting, [2.0, 0.0, 0.0, 0.0], 1);
    // What is off where the integration starts, a fiftieth of the way from there to the tip, fades on the rest of it.
    let mut s = meeting - 0.02 * (meeting - LENGTH);
    // beta, then angle and place as seen from the tip.
    let mut state = [guess[0], 0.0, 0.0, 0.0];
    while s > LENGTH {
        let h = (-0.2 * linear(OFFSET, s) / fine).max(LENGTH - s);
        state = step(tensions, s, h, state, &mut guess);
        s += h;
    }
    s = LENGTH;
    state = [state[0], 0.0, 0.0, 0.0];
    while s > 0.0 {
        let h = (-0.2 * linear(OFFSET, s).min(1e-4) / fine).max(-s);
        state = step(tensions, s, h, state, &mut guess);
        s += h;
    }
    let [_, theta, x, y] = state;
    let (sin, cos) = theta.sin_cos();
    [-(cos * x + sin * y), -(cos * y - sin * x), -theta]
}

#[test]
fn squeezed_arms_are_where_integration_from_the_tip_puts_them() {
    for tensions in [[40.0, 20.0], [50.0, 50.0], [100.0, 30.0], [100.0, 90.0]] {
        let arm = paper(tensions);
        let found = solve(&arm, 1e-8);
        let [x, y, theta] = tip_by_integration(tensions, 1.0);
        let [finer_x, finer_y, _] = tip_by_integration(tensions, 2.0);
        let moved = (finer_x - x).hypot(finer_y - y) / LENGTH;
        assert!(moved < 1e-9, "{tensions:?}: {moved:e}");
        let tip = found.tip();
        let off = (tip.x - x).hypot(tip.y - y) / LENGTH;
        let estimate = found.error_estimate / LENGTH;
        println!("{tensions:?}: off by {off:.1e}, said to be by {estimate:.1e}, angle by {:.1e}", tip.theta - theta);
        assert!(estimate <= 1e-8, "{tensions:?}: {estimate:e}");
        assert!(off <= 1.5e-8, "{tensions:?}: {off:e}");
        assert!((tip.theta - theta).abs() < 1e-7, "{tensions:?}: {theta} {}", tip.theta);
    }
}

/// With the stream, too, a tighter tolerance changes an answer by no more than its estimate says.
#[test]
fn squeezed_arms_in_a_stream_converge() {
    for tensions in [[30.0, 10.0], [60.0, 40.0], [100.0, 60.0]] {
        let mut arm = paper(tensions);
        arm.flow.speed = 0.5;
        let [coarse, fine] = [1e-8, 1e-9].map(|tol| solve(&arm, tol));
        let (a, b) = (coarse.tip(), fine.tip());
        let off = (a.x - b.x).hypot(a.y - b.y);
        println!("{tensions:?}: {off:.1e} of {:.1e}", coarse.error_estimate);
        assert!(coarse.error_estimate <= 1e-8 * arm.length, "{tensions:?}: {:e}", coarse.error_estimate);
        assert!(off <= 2.0 * (coarse.error_estimate + fine.error_estimate), "{tensions:?}: {off:e}");
    }
}
