//! How hard loads push against an arm in space: the criterion of the plane, with vectors.

use hydrostat_bvp::each;

use super::engine::Engine;
use super::equations::{Equations, FORCE, L, M, N};
use super::rotation::{Directors, Vector, dot, times, turned};
use crate::rod::area_law::{area_law, displacement};
use crate::rod::model_options::Support;

/// Buckling indicator from which on a direct solve may have landed on a branch that the path does not lead to.
const HARD: f64 = 0.3;

impl Engine {
    /// Whether something pushes against the arm hard enough that a direct solve may have landed on a branch that the
    /// path does not lead to. Cheap and on the safe side.
    pub(super) fn needs_continuation(&mut self) -> bool {
        let equations = &self.equations;
        if equations.arm().model.support == Support::UnstrainedBase {
            // An initial-value problem has one solution.
            return false;
        }
        if self.system.determinant().known_sign() != Some(1.0) {
            return true;
        }
        self.system.take_stations(&self.solution);
        // The unloaded arm, turned along by its reference strains.
        let mut unloaded = equations.base;
        let mesh = &self.solution.mesh;
        for i in 0..mesh.elements() {
            for j in 0..M {
                let (block, lane) = self.solution.groups().at(i, j);
                let station = &self.system.stations()[block];
                let reference = equations.reference_in(block);
                let rate: Vector<f64> = each(|k| reference[3 + k].0[lane]);
                unloaded = turned(&unloaded, &times(mesh.step(i) * self.system.gauss.b[j], &rate));
                let z: [f64; N] = each(|k| station.z[k].0[lane]);
                let strain: [f64; L] = each(|k| station.inner[k].0[lane]);
                if equations.buckling_indicator(block, lane, &z, &strain, &Directors::of(&unloaded)) > HARD {
                    return true;
                }
            }
        }
        false
    }
}

impl Equations {
    /// Compression of the contact force by (1 - s)^2/EI, and stream and weight by (1 - s)^3/EI where they run against
    /// the tangent, now or in the unloaded arm: as in the plane.
    fn buckling_indicator(
        &self,
        block: usize,
        lane: usize,
        z: &[f64; N],
        strain: &[f64; L],
        unloaded: &Directors<f64>,
    ) -> f64 {
        let place = &self.places[block];
        let rest = 1.0 - place.s.0[lane];
        let own = area_law(self.volume, strain[0]);
        let stiffness = place.stiffness.value[5].0[lane] * own.beta * own.beta;
        let v = Directors::of(&[z[0], z[1], z[2], z[3]]).to_space(&[strain[0], strain[1], strain[2]]);
        let stretch = dot(&v, &v).sqrt();
        let tangent = times(1.0 / stretch, &v);
        let (square, cube) = (rest * rest / stiffness, rest * rest * rest / stiffness);
        let mut worst = -dot(&tangent, &[z[FORCE], z[FORCE + 1], z[FORCE + 2]]) * square;
        let stream = self.water.stream;
        let speed_square = dot(&stream, &stream);
        let drag = self.water.law.largest() * place.body.wetted.0[lane] * own.beta * speed_square * stretch;
        let [d, _] = displacement(self.water.displaced, self.volume, strain[0], &own);
        let of = |v: &Vector<hydrostat_bvp::Lanes>| v.map(|v| v.0[lane]);
        let (weight, displaced, force) = (of(&place.body.weight), of(&place.body.displaced), of(&place.body.force));
        let net: Vector<f64> = each(|k| weight[k] - displaced[k] * d + force[k]);
        let slow = 1e-9 * speed_square.sqrt();
        for direction in [tangent, unloaded.a] {
            if dot(&direction, &stream) < -slow {
                worst = worst.max(drag * cube);
            }
            worst = worst.max(-dot(&direction, &net) * cube);
        }
        let (tip, _) = self.tip_load(self.fraction[0], unloaded);
        worst.max(-dot(&unloaded.a, &[tip[0], tip[1], tip[2]]) * square)
    }
}
