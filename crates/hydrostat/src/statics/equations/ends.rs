//! The conditions at base and tip (`docs/model.md`, section 7).

use hydrostat_bvp::Condition;

use super::system::Equations;
use crate::rod::arm::TipLoad;
use crate::rod::model_options::Support;
use crate::statics::dimensions::N;

impl Equations {
    /// theta(0) = theta_0; with the unstrained base also nu = beta = 1, eta = mu = beta' = 0 there, by the section law
    /// n_f(0) = C1 (1 - nu_o) A0 a - C2 eta_o A0 b + sum T t_c(0) and m_f(0) = -C3 mu_o A0 - sum T y (t_c . a)(0).
    pub(super) fn base_conditions(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        out[0].residual = z[0] - self.arm.base.angle;
        out[0].gradient[0] = 1.0;
        if self.arm.model.support == Support::UnstrainedBase {
            let (sin, cos) = self.arm.base.angle.sin_cos();
            let stiffness = self.place(0.0).stiffness;
            let unstrained = [1.0, 0.0, 0.0];
            let [n_a, n_b, m] = [0, 1, 2].map(|k| stiffness.value[k] * (unstrained[k] - stiffness.reference[k]));
            let mut at_base = [n_a * cos - n_b * sin, n_a * sin + n_b * cos, m];
            for c in 0..self.tensions.len() {
                let offset = self.offset(c, 0.0);
                let stretch = 1.0_f64.hypot(offset.slope);
                let (t_a, t_b) = (1.0 / stretch, offset.slope / stretch);
                at_base[0] += self.tension(c) * (t_a * cos - t_b * sin);
                at_base[1] += self.tension(c) * (t_a * sin + t_b * cos);
                at_base[2] -= self.tension(c) * offset.y * t_a;
            }
            for k in 0..3 {
                out[k + 1].residual = z[k + 1] - at_base[k];
                out[k + 1].gradient[k + 1] = 1.0;
            }
        }
    }

    /// n_f(L) = tip force (dead, and following a(L), b(L)), m_f(L) = tip moment.
    pub(super) fn tip_conditions(&self, z: &[f64; N], out: &mut [Condition<N>; N]) {
        if self.arm.model.support == Support::UnstrainedBase {
            return;
        }
        let (load, turn) = self.tip_load(z[0]);
        for k in 0..3 {
            out[k].residual = z[k + 1] - load[k];
            out[k].gradient[k + 1] = 1.0;
            out[k].gradient[0] = -turn[k];
        }
    }

    /// Force and moment on the tip at the present fraction, and their derivative by theta(L).
    pub(crate) fn tip_load(&self, theta: f64) -> ([f64; 3], [f64; 3]) {
        self.load_of(&self.arm.tip, theta)
    }

    fn load_of(&self, tip: &TipLoad, theta: f64) -> ([f64; 3], [f64; 3]) {
        let (sin, cos) = theta.sin_cos();
        let fraction = self.fraction[0] / self.units.force;
        let [f_a, f_b] = tip.follower;
        let load = [
            fraction * (tip.force[0] + f_a * cos - f_b * sin),
            fraction * (tip.force[1] + f_a * sin + f_b * cos),
            fraction * tip.moment / self.units.length,
        ];
        let turn = [fraction * (-f_a * sin - f_b * cos), fraction * (f_a * cos - f_b * sin), 0.0];
        (load, turn)
    }
}
