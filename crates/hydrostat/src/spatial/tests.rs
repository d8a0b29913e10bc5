//! The exact tangent of the equations in space, against differences.

use hydrostat_bvp::{Gauss, Groups, Inner, Lanes, Local, Mesh, Problem, Side, Solution, Station};

use super::equations::{Equations, L, M, N, Q};
use crate::rod::arm::{Arm, BaseDirections, Cable, FlowLaw, Gravity, Space};
use crate::rod::model_options::{Displaced, EnteringSpeed, Hydrostatics, ModelOptions, Support, Volume, WettedLength};
use crate::rod::profile::Profile;
use crate::statics::verdict::Phase;

/// An arm with everything on it.
fn arm(model: ModelOptions, law: FlowLaw) -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1300.0;
    arm.cables.push(Cable::new("one", Profile::linear(0.005, 0.001)).pulled(0.2).at_angle(0.3));
    arm.cables.push(Cable::new("two", 0.002).pulled(0.1).at_angle(Profile::linear(2.0, 5.0)));
    arm.cables.push(Cable::new("short", 0.003).pulled(0.1).at_angle(4.0).ending_at(0.55));
    arm.flow.speed = 0.2;
    arm.flow.law = law;
    arm.gravity = Some(Gravity::default());
    arm.tip.force = [0.001, 0.002];
    arm.tip.follower = [0.001, -0.001];
    arm.tip.moment = 1e-5;
    arm.distributed.force = [0.01.into(), 0.02.into()];
    arm.distributed.couple = 1e-4.into();
    arm.reference.mu = 2.0.into();
    arm.model = model;
    arm.space = Some(Space {
        base: Some(BaseDirections { direction: [0.6, 0.5, -0.4], section: Some([0.1, 0.2, 0.9]) }),
        stream: Some([1.0, -2.0, 0.5]),
        gravity: Some([0.2, -1.0, 0.4]),
        tip_force: -0.001,
        tip_follower: 0.002,
        tip_moment: [2e-5, -1e-5],
        force: 0.01.into(),
        couple: [1e-4.into(), 2e-4.into()],
        zeta: 0.02.into(),
        tau: 1.0.into(),
        kappa: (-1.5).into(),
        ..Space::default()
    });
    arm
}

fn arms() -> Vec<Arm> {
    let drag = FlowLaw::QuadraticDrag { cn: 2.0, ct: 0.02 };
    let other = ModelOptions {
        volume: Volume::Circular,
        entering_speed: EnteringSpeed::Resultant,
        wetted_length: WettedLength::Deformed,
        displaced: Displaced::Section,
        hydrostatics: Hydrostatics::NormalOnly,
        support: Support::UnstrainedBase,
        ..ModelOptions::default()
    };
    let rigid = ModelOptions { volume: Volume::None, ..ModelOptions::default() };
    vec![arm(ModelOptions::default(), FlowLaw::Momentum), arm(other, FlowLaw::Momentum), arm(rigid, drag)]
}

/// Equations on one group of elements with closure, and a station in its first block.
fn at_station(arm: &Arm, phase: Phase, fraction: f64) -> (Equations, Station<N, L>) {
    arm.check().unwrap();
    let gauss = Gauss::<M>::new();
    let mut equations = Equations::new(arm, M).leaving(1e-13);
    let z: [f64; N] = [0.4, -0.3, 0.7, 0.5, 0.05, -0.02, 0.03, 0.04, 0.01, -0.06];
    let flat = Solution::<N, M, L>::constant(Mesh::uniform(4, &[]), z, [0.97, 0.01, -0.02, 0.3, -0.2, 0.4]);
    equations.place_on(&gauss, &flat);
    let mut closed = Solution::default();
    flat.with_sides(&gauss, |_| Side::Left, |_| false, &mut closed);
    equations.place_ends(&closed);
    equations.set_phase(phase, fraction);
    let inner = [0.97, 0.01, -0.02, 0.3, -0.2, 0.4].map(|v| Lanes([v; 4]));
    (equations, Station { z: z.map(|v| Lanes([v; 4])), inner, closure_slope: Lanes([0.1; 4]) })
}

fn evaluated(equations: &Equations, station: &Station<N, L>) -> (Local<N, Q, L, Lanes>, Station<N, L>) {
    let groups = Groups { elements: 4, stages: M };
    let mut stations = vec![*station; M];
    let mut out = vec![Local::default(); M];
    equations.stages::<false>(groups, &mut stations, &mut out).unwrap();
    (out[1], stations[1])
}

const STEP: f64 = 1e-6;

/// All that a local evaluation gives out, at the strains that solve the section law.
fn flat(local: &Local<N, Q, L, Lanes>, station: &Station<N, L>, lane: usize) -> Vec<f64> {
    let strains = (0..L).map(|k| station.inner[k].0[lane] + local.inner.change[k].0[lane]);
    let slope = local.slope.iter().chain(&local.rate).map(|v| v.0[lane]);
    slope.chain(strains).chain([local.inner.value.0[lane] + local.inner.value_change.0[lane]]).collect()
}

#[test]
fn gradients_of_everything_match_differences() {
    for arm in arms() {
        let (equations, station) = at_station(&arm, Phase::Tension, 1.0);
        let (here, _) = evaluated(&equations, &station);
        for b in 0..=N {
            let [hi, lo] = [STEP, -STEP].map(|h| {
                let mut moved = station;
                let own = if b < N { &mut moved.z[b] } else { &mut moved.closure_slope };
                *own += Lanes([h; 4]);
                let (local, moved) = evaluated(&equations, &moved);
                flat(&local, &moved, 2)
            });
            let exact: Vec<f64> = if b < N {
                let slope =
                    (0..N).map(|a| here.jacobian[a][b].0[2]).chain((0..Q).map(|q| here.rate_gradient[q][b].0[2]));
                let inner = (0..L).map(|k| here.inner.gradient[k][b].0[2]);
                slope.chain(inner).chain([here.inner.value_gradient[b].0[2]]).collect()
            } else {
                let slope = here.by_closure.iter().chain(&here.rate_by_closure).chain(&here.inner.by_closure);
                slope.map(|v| v.0[2]).chain([here.inner.reach.0[2]]).collect()
            };
            for (k, exact) in exact.iter().enumerate() {
                let by = (hi[k] - lo[k]) / (2.0 * STEP);
                assert!((by - exact).abs() < 2e-7 * exact.abs().max(1.0), "{:?} {b} {k}: {by} {exact}", arm.model);
            }
        }
    }
}

#[test]
fn changes_by_the_fraction_of_a_phase_match_differences() {
    for arm in arms() {
        for phase in [Phase::Loads, Phase::Tension] {
            let at = |fraction: f64| at_station(&arm, phase, fraction);
            let (equations, station) = at(0.6);
            // Where the strains solve the section law.
            let (_, solved) = evaluated(&equations, &station);
            // Only equations with a closure have ends.
            let ends = vec![solved; usize::from(equations.is_closed())];
            let tip: [f64; N] = solved.z.map(|v| v.0[0]);
            let change = equations.change_by_fraction(&vec![solved; M], &ends, &tip).unwrap();
            let [hi, lo] = [STEP, -STEP].map(|h| {
                let equations = at(0.6 + h).0;
                let (local, moved) = evaluated(&equations, &station);
                let mut left = [hydrostat_bvp::Condition::default(); N];
                let mut right = left;
                equations.left(&tip, &mut left);
                equations.right(&tip, &mut right);
                let mut end = vec![Inner::default(); ends.len()];
                let mut stations = ends.clone();
                equations.ends::<false>(&[], &mut stations, &mut end).unwrap();
                let mut all = flat(&local, &moved, 2);
                all.extend(left.iter().chain(&right).map(|condition| condition.residual));
                for (station, end) in stations.iter().zip(&end) {
                    all.extend(station.inner.iter().zip(end.change).map(|(v, change)| v.0[0] + change.0[0]));
                }
                all
            });
            let forcing = &change.stages[1];
            let mut exact: Vec<f64> =
                forcing.slope.iter().chain(&forcing.rate).chain(&forcing.inner).map(|v| v.0[2]).collect();
            exact.push(forcing.value.0[2]);
            exact.extend(change.left.iter().chain(&change.right));
            exact.extend(change.ends.iter().flat_map(|(inner, _)| inner.iter().map(|v| v.0[0])));
            for (k, exact) in exact.iter().enumerate() {
                let by = (hi[k] - lo[k]) / (2.0 * STEP);
                assert!((by - exact).abs() < 2e-7 * exact.abs().max(1.0), "{phase:?} {k}: {by} {exact}");
            }
        }
    }
}

/// The conditions at the tip, by every component of the state.
#[test]
fn conditions_match_differences() {
    for arm in arms() {
        let (equations, station) = at_station(&arm, Phase::Tension, 1.0);
        let z: [f64; N] = station.z.map(|v| v.0[0]);
        let at = |z: &[f64; N]| {
            let mut out = [hydrostat_bvp::Condition::default(); N];
            equations.right(z, &mut out);
            out
        };
        let here = at(&z);
        for b in 0..N {
            let [hi, lo] = [STEP, -STEP].map(|h| {
                let mut z = z;
                z[b] += h;
                at(&z).map(|condition| condition.residual)
            });
            for k in 0..N {
                assert!(((hi[k] - lo[k]) / (2.0 * STEP) - here[k].gradient[b]).abs() < 1e-8);
            }
        }
    }
}
