//! Loads that come after the linearisation: what stages, rows and start make of them is what the solve makes of a drift.

use std::convert::Infallible;

use hydrostat_bvp::{Collocation, Condition, Correction, Groups, LANES, Lanes, Local, Mesh, Problem, Solution};

const N: usize = 3;
const M: usize = 3;

/// z' = J(s) z + lambda f(s), with one condition at s = 0 and two at s = 1. Solutions grow and decay by e^30.
struct Loaded {
    stations: Vec<f64>,
}

fn jacobian(s: f64) -> [[f64; N]; N] {
    [[0.0, 30.0, s], [30.0, 0.0, -1.0], [(3.0 * s).sin(), 0.5, 0.2]]
}

fn load(s: f64) -> [f64; N] {
    [(5.0 * s).cos(), 1.0 - s, s * s]
}

impl Problem<N, 1> for Loaded {
    type Failure = Infallible;

    fn slopes<const FUSED: bool>(
        &mut self,
        groups: Groups,
        z: &[[Lanes; N]],
        out: &mut [Local<N, 1, Lanes>],
    ) -> Result<(), Infallible> {
        for (block, (z, out)) in z.iter().zip(out).enumerate() {
            for lane in 0..LANES {
                let jacobian = jacobian(self.stations[groups.station_in(block, lane)]);
                let slope = jacobian.map(|row| (0..N).map(|b| row[b] * z[b].0[lane]).sum());
                out.set_lane(lane, &Local { slope, jacobian, rate: [0.0], rate_gradient: [[0.0; N]] });
            }
        }
        Ok(())
    }

    fn drift(&mut self, out: &mut [[Lanes; N]]) {
        let groups = Groups { elements: self.stations.len() / M, stages: M };
        for (block, out) in out.iter_mut().enumerate() {
            for lane in 0..LANES {
                let load = load(self.stations[groups.station_in(block, lane)]);
                (0..N).for_each(|a| out[a].0[lane] = load[a]);
            }
        }
    }

    fn left_count(&self) -> usize {
        1
    }

    fn left(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        out[0] = Condition { residual: z[0] + 0.5 * z[2], gradient: [1.0, 0.0, 0.5], drift: 0.0 };
    }

    fn right(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        out[0] = Condition { residual: z[0] - z[1], gradient: [1.0, -1.0, 0.0], drift: 0.0 };
        out[1] = Condition { residual: 2.0 * z[2], gradient: [0.0, 0.0, 2.0], drift: 0.0 };
    }
}

#[test]
fn loads_that_come_later_move_what_a_drift_moves() {
    let mut system = Collocation::<N, M, 1>::new();
    let solution = Solution::constant(Mesh::uniform(21, &[]), [0.0; N]);
    let mut stations = Vec::new();
    system.stations(&solution.mesh, &mut stations);
    let mut problem = Loaded { stations: stations.clone() };
    system.linearise(&mut problem, &solution, true).unwrap();
    let mut want = Correction::default();
    system.solve(&solution, 1, &mut want);

    // Each element's own part, and the loads of the rows from the tip on.
    let n = solution.mesh.elements();
    let elements: Vec<_> = (0..n)
        .map(|i| {
            let mut loads = [std::array::from_fn(|j| load(stations[i * M + j]))];
            let by_state = system.eliminate(i, &mut loads).unwrap();
            (by_state, loads[0])
        })
        .collect();
    let end = |i: usize, z: &[f64; N]| -> [f64; N] {
        let (by_state, own) = &elements[i];
        std::array::from_fn(|a| {
            let slope = |j: usize| own[j][a] + (0..N).map(|b| by_state[j][a][b] * z[b]).sum::<f64>();
            z[a] + solution.mesh.step(i) * (0..M).map(|j| system.gauss.b[j] * slope(j)).sum::<f64>()
        })
    };
    let dot = |row: &[f64; N], z: &[f64; N]| (0..N).map(|c| row[c] * z[c]).sum::<f64>();
    let mut loads = vec![[0.0; 2]; n + 1];
    for i in (0..n).rev() {
        let own = end(i, &[0.0; N]);
        let next = system.rows(i + 1);
        let carried = [0, 1].map(|r| loads[i + 1][r] - dot(&next.rows[r], &own));
        let reduction = system.rows(i).reduction;
        loads[i] = [0, 1].map(|r| reduction[r][0] * carried[0] + reduction[r][1] * carried[1]);
    }

    let start = system.start();
    let mut z: [f64; N] = std::array::from_fn(|a| start[a][1] * loads[0][0] + start[a][2] * loads[0][1]);
    let scale = want.largest(0).max(want.largest(1)).max(want.largest(2));
    for i in 0..=n {
        for a in 0..N {
            assert!((z[a] - want.nodes[i][a]).abs() < 1e-11 * scale, "{i}: {z:?} for {:?}", want.nodes[i]);
        }
        if i < n {
            z = end(i, &z);
            let rows = system.rows(i + 1);
            for r in 0..2 {
                z[rows.pivot[r]] = 0.0;
            }
            let decided = [0, 1].map(|r| loads[i + 1][r] - dot(&rows.rows[r], &z));
            for r in 0..2 {
                z[rows.pivot[r]] = decided[r];
            }
        }
    }
    assert!(scale > 1e-3);
}
