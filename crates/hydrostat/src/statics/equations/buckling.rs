//! How hard loads push against the arm, and whether it is in line with them.

use hydrostat_bvp::Station;

use super::system::Equations;
use crate::rod::area_law::{area_law, displacement};
use crate::statics::dimensions::{L, N};

/// Where the unloaded arm points at a place, and the load on its tip that would turn with it.
pub(crate) struct Unloaded {
    angle: f64,
    /// cos and sin of the angle.
    direction: [f64; 2],
    tip: [f64; 2],
}

impl Unloaded {
    pub(crate) fn new(equations: &Equations, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        let ([x, y, _], _) = equations.tip_load(angle);
        Self { angle, direction: [cos, sin], tip: [x, y] }
    }

    /// Turned by `by` (rad), which is nothing where the arm is straight.
    pub(crate) fn turn(&mut self, equations: &Equations, by: f64) {
        if by != 0.0 {
            *self = Self::new(equations, self.angle + by);
        }
    }
}

impl Equations {
    /// How hard loads push against the arm at station `k`, over what its bending stiffness there
    /// resists over the rest of its length: compression of the contact force by (1 - s)^2/EI, and
    /// stream and weight by (1 - s)^3/EI where they run against the tangent, now or in the unloaded
    /// arm. Well below one, equilibria are unique: a cantilever buckles at 2.47 under a force on its tip and at
    /// 7.84 under a load along it. The stream counts with S U^2 times [`Law::largest`](crate::rod::flow::Law::largest).
    /// Moments and couples bend the arm and push nothing along it: they are in the compression of the shape that they
    /// lead to.
    pub(crate) fn buckling_indicator(&self, k: usize, stations: &[Station<N, L>], unloaded: &Unloaded) -> f64 {
        let (block, lane) = self.groups.station(k);
        let place = &self.places[block];
        let rest = 1.0 - place.s.0[lane];
        let (z, [nu, eta, _]) = at(&stations[block], lane);
        let beta = area_law(self.volume, nu).beta;
        let stiffness = place.stiffness.value[2].0[lane] * beta * beta;
        // Along the centreline: the section's directions, turned by alpha.
        let stretch = (nu * nu + eta * eta).sqrt();
        let (sin, cos) = z[0].sin_cos();
        let (cos, sin) = ((nu * cos - eta * sin) / stretch, (nu * sin + eta * cos) / stretch);
        let compression = -(cos * z[1] + sin * z[2]) * rest * rest / stiffness;
        let stream = self.water.stream;
        let speed_square = stream[0] * stream[0] + stream[1] * stream[1];
        let drag = self.water.law.largest() * place.body.wetted.0[lane] * beta * speed_square * stretch;
        let net = self.net_weight(k, nu);
        let cube = rest * rest * rest / stiffness;
        let mut worst = compression;
        let slow = 1e-9 * speed_square.sqrt();
        for [cos, sin] in [[cos, sin], unloaded.direction] {
            if cos * stream[0] + sin * stream[1] < -slow {
                worst = worst.max(drag * cube);
            }
            worst = worst.max(-(cos * net[0] + sin * net[1]) * cube);
        }
        let ([cos, sin], [x, y]) = (unloaded.direction, unloaded.tip);
        worst.max(-(cos * x + sin * y) * rest * rest / stiffness)
    }

    /// Weight less buoyancy, and forces along the arm, at station `k`, per length.
    fn net_weight(&self, k: usize, nu: f64) -> [f64; 2] {
        let (block, lane) = self.groups.station(k);
        let place = &self.places[block];
        let [d, _] = displacement(self.water.displaced, self.water.volume, nu, &area_law(self.water.volume, nu));
        [0, 1].map(|c| place.body.weight[c].0[lane] - place.body.displaced[c].0[lane] * d + place.body.force[c].0[lane])
    }

    /// Whether the arm at station `k` is nearly in line with a load: small angles to it decide then to
    /// which side it goes.
    pub(crate) fn is_in_line(&self, k: usize, stations: &[Station<N, L>]) -> bool {
        const NEARLY: f64 = 0.05;
        let (block, lane) = self.groups.station(k);
        let ([theta, ..], [nu, eta, _]) = at(&stations[block], lane);
        let (sin, cos) = (theta + eta.atan2(nu)).sin_cos();
        let (tip, _) = self.tip_load(theta);
        [self.water.stream, self.net_weight(k, nu), [tip[0], tip[1]]].iter().any(|[x, y]| {
            let size = x.hypot(*y);
            size > 0.0 && (cos * y - sin * x).abs() < NEARLY * size
        })
    }
}

/// State and strains in a lane.
fn at(station: &Station<N, L>, lane: usize) -> ([f64; N], [f64; L]) {
    (station.z.map(|v| v.0[lane]), station.inner.map(|v| v.0[lane]))
}

#[cfg(test)]
mod tests {
    use crate::statics::engine::Engine;
    use crate::statics::refinement::{First, Refinable as _};
    use crate::{Arm, FlowLaw};

    /// Ten times the drag pushes ten times as hard, whichever number it comes from.
    #[test]
    fn drag_counted_as_that_of_cn_pi_whatever_its_coefficients() {
        let leaves = |speed: f64, cn: f64, ct: f64| {
            let mut arm = Arm::cone(0.245, 0.010, 0.006, 110e3, 0.5);
            arm.flow.speed = speed;
            arm.flow.direction = 3.0;
            arm.flow.law = FlowLaw::QuadraticDrag { cn, ct };
            let mut engine = Engine::new(&arm);
            engine.start_from_cables(8).unwrap();
            engine.settle(1e-6, First::Rough).unwrap();
            engine.needs_continuation()
        };
        let (slow, fast) = (0.02, 0.02 * 10.0_f64.sqrt());
        assert!(!leaves(slow, 0.01, 0.0) && leaves(fast, 0.01, 0.0), "the speeds are on both sides");
        assert!(leaves(slow, 10.0 * std::f64::consts::PI, 0.0));
        assert!(leaves(slow, 0.0, 10.0));
    }
}
