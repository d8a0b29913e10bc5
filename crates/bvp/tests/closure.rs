//! Problems with inner unknowns and a closure variable: Newton is exact, adjoints agree, the determinant's sign does not depend on the mesh.

use std::convert::Infallible;

use hydrostat_bvp::{
    Collocation, Condition, Correction, EndPlace, EndWeights, Forcing, Functional, Gauss, Groups, Inner, LANES, Lanes,
    Local, Mesh, Problem, Side, Solution, StageForcing, StageWeights, Station,
};

/// z1' = z2, z2' = -z1 + y + 0.3 w' + load, w = y, y + 0.2 y^3 = sin z1 + reach(s) w'.
struct Wave {
    mesh: Mesh,
    gauss: Gauss<4>,
    reach: fn(f64) -> f64,
    load: f64,
}

impl Wave {
    fn inner(&self, s: f64, z: [f64; 2], y: f64, slope: f64) -> Inner<2, 1> {
        let r = (self.reach)(s);
        let rest = z[0].sin() + r * slope - y - 0.2 * y.powi(3);
        let by_y = 1.0 + 0.6 * y * y;
        let inner = Inner {
            change: [rest / by_y],
            gradient: [[z[0].cos() / by_y, 0.0]],
            by_closure: [r / by_y],
            value: y,
            ..Inner::default()
        };
        Inner { value_change: inner.change[0], value_gradient: inner.gradient[0], reach: inner.by_closure[0], ..inner }
    }

    fn local(&self, s: f64, z: [f64; 2], y: f64, slope: f64) -> Local<2, 1, 1> {
        let inner = self.inner(s, z, y, slope);
        let ([by_z1, _], by) = (inner.gradient[0], inner.by_closure[0]);
        Local {
            slope: [z[1], -z[0] + y + inner.change[0] + 0.3 * slope + self.load],
            jacobian: [[0.0, 1.0], [-1.0 + by_z1, 0.0]],
            by_closure: [0.0, 0.3 + by],
            rate: [z[0] * (y + inner.change[0])],
            rate_gradient: [[y + z[0] * by_z1, 0.0]],
            rate_by_closure: [z[0] * by],
            inner,
        }
    }
}

fn lane(v: Lanes, l: usize) -> f64 {
    v.0[l]
}

fn set_inner(out: &mut Inner<2, 1, Lanes>, l: usize, of: &Inner<2, 1>) {
    out.change[0].0[l] = of.change[0];
    out.by_closure[0].0[l] = of.by_closure[0];
    out.value.0[l] = of.value;
    out.value_change.0[l] = of.value_change;
    out.reach.0[l] = of.reach;
    for a in 0..2 {
        out.gradient[0][a].0[l] = of.gradient[0][a];
        out.value_gradient[a].0[l] = of.value_gradient[a];
    }
}

impl Problem<2, 1, 1> for Wave {
    type Failure = Infallible;

    fn is_closed(&self) -> bool {
        true
    }

    fn stages<const FUSED: bool>(
        &self,
        groups: Groups,
        stations: &mut [Station<2, 1>],
        out: &mut [Local<2, 1, 1, Lanes>],
    ) -> Result<(), Infallible> {
        for (block, (at, out)) in stations.iter().zip(out).enumerate() {
            for l in 0..LANES {
                let k = groups.station_in(block, l);
                let (i, j) = (k / 4, k % 4);
                let s = self.mesh.nodes()[i] + self.mesh.step(i) * self.gauss.c[j];
                let of = self.local(s, at.z.map(|v| lane(v, l)), lane(at.inner[0], l), lane(at.closure_slope, l));
                for a in 0..2 {
                    out.slope[a].0[l] = of.slope[a];
                    out.by_closure[a].0[l] = of.by_closure[a];
                    out.rate_gradient[0][a].0[l] = of.rate_gradient[0][a];
                    for b in 0..2 {
                        out.jacobian[a][b].0[l] = of.jacobian[a][b];
                    }
                }
                out.rate[0].0[l] = of.rate[0];
                out.rate_by_closure[0].0[l] = of.rate_by_closure[0];
                set_inner(&mut out.inner, l, &of.inner);
            }
        }
        Ok(())
    }

    fn ends<const FUSED: bool>(
        &self,
        places: &[EndPlace],
        stations: &mut [Station<2, 1>],
        out: &mut [Inner<2, 1, Lanes>],
    ) -> Result<(), Infallible> {
        for ((place, at), out) in places.iter().zip(stations).zip(out) {
            for l in 0..LANES {
                let s = self.mesh.nodes()[place.elements[l] + place.sides[l].index()];
                let of = self.inner(s, at.z.map(|v| lane(v, l)), lane(at.inner[0], l), lane(at.closure_slope, l));
                set_inner(out, l, &of);
            }
        }
        Ok(())
    }

    fn left_count(&self) -> usize {
        1
    }

    fn left(&self, z: &[f64; 2], out: &mut [Condition<2>; 2]) {
        out[0] = Condition { residual: z[0] - 0.5, gradient: [1.0, 0.0] };
    }

    fn right(&self, z: &[f64; 2], out: &mut [Condition<2>; 2]) {
        out[0] = Condition { residual: z[1] - 0.2 * z[0] * z[0], gradient: [-0.4 * z[0], 1.0] };
    }
}

type System = Collocation<2, 4, 1, 1>;

fn start(elements: usize, reach: fn(f64) -> f64, load: f64) -> (Wave, Solution<2, 4, 1>, System) {
    let mesh = Mesh::uniform(elements, &[]);
    let system = System::new();
    let wave = Wave { mesh: mesh.clone(), gauss: system.gauss.clone(), reach, load };
    let mut solution = Solution::constant(mesh, [0.5, 0.0], [0.3]);
    let nodes = wave.mesh.nodes().to_vec();
    let side = |i: usize| if reach(0.5 * (nodes[i] + nodes[i + 1])) >= 0.0 { Side::Left } else { Side::Right };
    solution.clone().with_sides(&system.gauss, side, |_| false, &mut solution);
    (wave, solution, system)
}

/// The total, and the sizes of the rounds that led to it.
fn solve(wave: &Wave, solution: &mut Solution<2, 4, 1>, system: &mut System) -> (f64, Vec<f64>) {
    let mut correction = Correction::default();
    let mut sizes = Vec::new();
    for _ in 0..9 {
        system.linearise::<_, false>(wave, solution).unwrap();
        system.newton::<false>(solution, &mut correction);
        solution.add(&correction, 1.0);
        let inner = correction.stages.iter().flat_map(|s| s.inner[0].0).fold(0.0, |m: f64, v| m.max(v.abs()));
        sizes.push(correction.largest(0).max(inner));
    }
    system.linearise::<_, false>(wave, solution).unwrap();
    let total: f64 = {
        let mut sum = 0.0;
        for i in 0..solution.mesh.elements() {
            for j in 0..4 {
                let (b, l) = solution.groups().at(i, j);
                sum += solution.mesh.step(i) * system.gauss.b[j] * system.locals()[b].rate[0].0[l];
            }
        }
        sum
    };
    (total, sizes)
}

const REACHES: [fn(f64) -> f64; 5] = [
    |_| 0.01,
    |_| -0.01,
    |s| 0.005 + 0.3 * (1.0 - s).powi(2),
    |s| 0.1 * (s - 0.5) * (1.03 - s),
    |s| 0.1 * (0.4 - s) * (s + 0.03),
];

#[test]
fn newton_is_quadratic_whichever_way_the_closure_flows() {
    for (k, reach) in REACHES.into_iter().enumerate() {
        let (wave, mut solution, mut system) = start(7, reach, 0.1);
        let (_, sizes) = solve(&wave, &mut solution, &mut system);
        println!("{k}: {sizes:?}");
        let round = sizes.iter().position(|s| *s < 1e-3).unwrap();
        assert!(sizes[round + 2] < 1e-11, "{k}: {sizes:?}");
    }
}

#[test]
fn meshes_agree_and_so_do_their_determinants() {
    for (k, reach) in REACHES.into_iter().enumerate() {
        let found = |n: usize| {
            let (wave, mut solution, mut system) = start(n, reach, 0.1);
            let (total, _) = solve(&wave, &mut solution, &mut system);
            (total, system.determinant())
        };
        let (fine, det) = found(96);
        for (n, bound) in [(5, 1e-4), (8, 2e-5), (12, 2e-5), (31, 8e-7)] {
            let (total, own) = found(n);
            assert!((total - fine).abs() < bound, "{k}: {n} {total} {fine}");
            assert!(own.sign == det.sign && own.clearance > 1e-3, "{k}: {n} {own:?} {det:?}");
        }
    }
}

#[test]
fn responses_and_adjoints_match_differences() {
    for (k, reach) in REACHES.into_iter().enumerate() {
        let total = |load: f64| {
            let (wave, mut solution, mut system) = start(6, reach, load);
            let found = solve(&wave, &mut solution, &mut system).0;
            (found, solution.nodes[6][0])
        };
        let step = 1e-5;
        let (hi, lo) = (total(0.1 + step), total(0.1 - step));
        let difference = ((hi.0 - lo.0) / (2.0 * step), (hi.1 - lo.1) / (2.0 * step));
        let (wave, mut solution, mut system) = start(6, reach, 0.1);
        solve(&wave, &mut solution, &mut system);
        let one = Lanes([1.0; LANES]);
        let forcing = StageForcing { slope: [Lanes::default(), one], ..StageForcing::default() };
        let change = Forcing { stages: vec![forcing; solution.stages.len()], ..Forcing::default() };
        let mut out = Correction::default();
        system.response::<false>(&change, &mut out);
        assert!((out.total[0] - difference.0).abs() < 1e-8, "{k}: {} {}", out.total[0], difference.0);
        assert!((out.nodes[6][0] - difference.1).abs() < 1e-8, "{k}");
        // The adjoint of both at once, against forcings of everything.
        let mut functional = Functional { nodes: vec![(6, [1.0, 0.0]), (2, [0.3, -0.7])], ..Functional::default() };
        functional.stages.extend(system.locals().iter().enumerate().map(|(b, local)| {
            let weight = system.steps()[b / 4] * Lanes([system.gauss.b[b % 4]; LANES]);
            StageWeights {
                state: local.rate_gradient[0].map(|v| v * weight),
                closure_slope: local.rate_by_closure[0] * weight,
            }
        }));
        // Weights on the closure slopes and states of all ends.
        for (b, place) in solution.directions.ends().iter().enumerate() {
            for l in 0..LANES {
                if (0..l).any(|k| place.elements[k] == place.elements[l]) {
                    continue;
                }
                let weight = 0.3 + 0.1 * (b * 4 + l) as f64;
                functional.ends.push(EndWeights {
                    block: b,
                    lane: l,
                    state: [weight, 0.5],
                    closure_slope: 0.02 * weight,
                });
            }
        }
        let adjoint = system.adjoint(&functional);
        let wild = |b: usize, f: f64| Lanes(std::array::from_fn(|l| (f * (b * 4 + l) as f64).sin()));
        let groups = solution.groups();
        let filled = |b: usize, v: Lanes| {
            let count = groups.filled(b / 4);
            Lanes(std::array::from_fn(|l| if l < count { v.0[l] } else { v.0[count - 1] }))
        };
        let stages: Vec<StageForcing<2, 1, 1>> = (0..solution.stages.len())
            .map(|b| {
                let value = filled(b, wild(b, 2.3));
                StageForcing {
                    slope: [filled(b, wild(b, 1.1)), filled(b, wild(b, 0.7))],
                    value,
                    inner: [value],
                    ..StageForcing::default()
                }
            })
            .collect();
        let ends: Vec<([Lanes; 1], Lanes)> = solution
            .directions
            .ends()
            .iter()
            .map(|place| {
                let value = Lanes(place.elements.map(|i| (0.9 * i as f64).cos()));
                ([value], value)
            })
            .collect();
        let change = Forcing { stages, ends, left: [0.4, 0.0], right: [-0.3, 0.0] };
        system.response::<false>(&change, &mut out);
        let mut forward = out.total[0] + out.nodes[6][0] + 0.3 * out.nodes[2][0] - 0.7 * out.nodes[2][1];
        for end in &functional.ends {
            let place = &solution.directions.ends()[end.block];
            let (i, side) = (place.elements[end.lane], place.sides[end.lane]);
            let mut z = out.nodes[i];
            if side == Side::Right {
                for j in 0..4 {
                    let (b, l) = groups.at(i, j);
                    for a in 0..2 {
                        z[a] += solution.mesh.step(i) * system.gauss.b[j] * out.stages[b].slope[a].0[l];
                    }
                }
            }
            forward += end.state[0] * z[0] + end.state[1] * z[1];
            forward += end.closure_slope * out.ends[end.block].closure_slope.0[end.lane];
        }
        let mut backward = adjoint.left[0] * 0.4 + adjoint.right[0] * -0.3;
        let dot = |a: Lanes, b: Lanes| (0..LANES).map(|l| a.0[l] * b.0[l]).sum::<f64>();
        for (b, forcing) in change.stages.iter().enumerate() {
            backward += dot(adjoint.slopes[b][0], forcing.slope[0]) + dot(adjoint.slopes[b][1], forcing.slope[1]);
            backward += dot(adjoint.values[b], forcing.value);
        }
        for (b, end) in change.ends.iter().enumerate() {
            backward += dot(adjoint.ends[b], end.1);
        }
        assert!((forward - backward).abs() < 1e-11, "{k}: {forward} {backward}");
    }
}
