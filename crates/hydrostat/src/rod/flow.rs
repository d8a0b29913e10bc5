//! Loads of the stream on the arm, (7)-(10), and quadratic drag.
//!
//! A flow law here gives the load on a surface of direction u (unit tangent) and w = k x u from the
//! speeds U_t = U.u and U_n = U.w of the free stream. What surface that is, is a reading.

use crate::rod::arm::FlowLaw;
use crate::rod::model_options::EnteringSpeed;
use hydrostat_bvp::Real;

/// Load over S = pi rho_w beta R (N/m per m2/s2) along u and w, with derivatives by the angle of u.
#[derive(Clone, Copy)]
pub(crate) struct Traction<R> {
    pub(crate) tangential: R,
    pub(crate) normal: R,
    pub(crate) tangential_turn: R,
    pub(crate) normal_turn: R,
    /// Derivatives by U_t and U_n.
    pub(crate) tangential_by: [R; 2],
    pub(crate) normal_by: [R; 2],
}

/// The flow law of an arm, resolved to numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Law {
    /// (8), (9) with V_in = V_tin.
    MomentumTangential { layer: f64 },
    /// (8), (9) with V_in^2 = V_tin^2 + V_nin^2.
    MomentumResultant { layer: f64 },
    /// C_n/pi, which is C_n on the half perimeter in place of the diameter, and C_t.
    Quadratic { normal: f64, tangential: f64 },
}

impl Law {
    pub(crate) fn new(law: FlowLaw, entering_speed: EnteringSpeed, layer: f64) -> Self {
        match (law, entering_speed) {
            (FlowLaw::Momentum, EnteringSpeed::Tangential) => Self::MomentumTangential { layer },
            (FlowLaw::Momentum, EnteringSpeed::Resultant) => Self::MomentumResultant { layer },
            (FlowLaw::QuadraticDrag { cn, ct }, _) => Self::drag(cn, ct),
        }
    }

    /// The largest load over S U^2, along or across the surface, or one if that is less. The momentum laws exceed one
    /// at an angle to the stream: with V_t = c U_t, (8) has c^2/2 + sqrt(c^4/4 + c^2) along the surface with V_in =
    /// V_tin, 1.05 at most, and 1 + c^2, 1.54 at most, with the resultant. That is left to those who compare with it.
    pub(crate) fn largest(self) -> f64 {
        match self {
            Self::MomentumTangential { .. } | Self::MomentumResultant { .. } => 1.0,
            Self::Quadratic { normal, tangential } => normal.max(tangential).max(1.0),
        }
    }

    /// Quadratic drag with C_n and C_t.
    pub(crate) fn drag(cn: f64, ct: f64) -> Self {
        Self::Quadratic { normal: cn / std::f64::consts::PI, tangential: ct }
    }
}

/// Load on a surface in a stream, per unit S.
///
/// With V_t = (2/3) U_t, the mean of the layer (7) (or sqrt(8/15) U_t, its root mean square):
///
/// - (8), V_in = V_tin:                  f_t = (|V_t| + 2 |U_n|) V_t
/// - (8), V_in^2 = V_tin^2 + V_nin^2:    f_t = (|V_t| + |U_n|)^2 sign(V_t)
/// - (9):                                f_n = |U_n| U_n
/// - quadratic drag:  f_t = C_t |U_t| U_t,  f_n = (C_n/pi) |U_n| U_n
///
/// so that drag acts downstream and the windward side carries the dynamic load. `normal_share` is 1
/// where the surface is hit (or for the centreline, which always is), 0 where it lies in the lee.
/// Turning u by a small angle changes U_t by U_n and U_n by -U_t.
#[inline(always)]
pub(crate) fn traction<R: Real>(law: Law, u_t: R, u_n: R, normal_share: R) -> Traction<R> {
    let two = R::of(2.0);
    let n = u_n * normal_share;
    let n_turn = -(u_t * normal_share);
    let n_abs = n.abs();
    let zero = R::of(0.0);
    match law {
        Law::MomentumTangential { layer } => {
            let layer = R::of(layer);
            let (v, v_turn) = (layer * u_t, layer * u_n);
            let v_abs = v.abs();
            Traction {
                tangential: (v_abs + two * n_abs) * v,
                normal: n_abs * n,
                tangential_turn: two * ((v_abs + n_abs) * v_turn + n.sign() * v * n_turn),
                normal_turn: two * n_abs * n_turn,
                tangential_by: [two * (v_abs + n_abs) * layer, two * n.sign() * v * normal_share],
                normal_by: [zero, two * n_abs * normal_share],
            }
        }
        Law::MomentumResultant { layer } => {
            let layer = R::of(layer);
            let (v, v_turn) = (layer * u_t, layer * u_n);
            let sum = v.abs() + n_abs;
            let sign = v.sign();
            Traction {
                tangential: sum * sum * sign,
                normal: n_abs * n,
                tangential_turn: two * sum * (v_turn + sign * n.sign() * n_turn),
                normal_turn: two * n_abs * n_turn,
                tangential_by: [two * sum * layer, two * sum * sign * n.sign() * normal_share],
                normal_by: [zero, two * n_abs * normal_share],
            }
        }
        Law::Quadratic { normal, tangential } => {
            let (cn, ct) = (R::of(normal), R::of(tangential));
            Traction {
                tangential: ct * u_t.abs() * u_t,
                normal: cn * n_abs * n,
                tangential_turn: two * ct * u_t.abs() * u_n,
                normal_turn: two * cn * n_abs * n_turn,
                tangential_by: [two * ct * u_t.abs(), zero],
                normal_by: [zero, two * cn * n_abs * normal_share],
            }
        }
    }
}

/// Speed in the layer over the windward surface, (7): `v_t_inf (2 y/h - (y/h)^2)` for a normal
/// distance y in [0, h] (m) from the surface, v_t_inf beyond.
pub(crate) fn layer_profile(v_t_inf: f64, y: f64, h: f64) -> f64 {
    let depth = (y / h).clamp(0.0, 1.0);
    v_t_inf * (2.0 * depth - depth * depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_match_differences_for_every_law() {
        let laws = [
            Law::MomentumTangential { layer: 2.0 / 3.0 },
            Law::MomentumResultant { layer: (8.0_f64 / 15.0).sqrt() },
            Law::Quadratic { normal: 0.4, tangential: 0.02 },
        ];
        for law in laws {
            for angle in [0.3_f64, 1.9, 3.3, 5.0] {
                let at = |psi: f64| traction(law, 0.5 * (angle - psi).cos(), 0.5 * (angle - psi).sin(), 1.0);
                let (lo, hi, t) = (at(-1e-6), at(1e-6), at(0.0));
                assert!(((hi.tangential - lo.tangential) / 2e-6 - t.tangential_turn).abs() < 1e-8);
                assert!(((hi.normal - lo.normal) / 2e-6 - t.normal_turn).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn momentum_law_is_quadratic_drag_with_cn_pi_and_ct_four_ninths_at_zero_incidence() {
        let momentum = Law::new(FlowLaw::Momentum, EnteringSpeed::Tangential, 2.0 / 3.0);
        let quadratic = Law::Quadratic { normal: 1.0, tangential: 4.0 / 9.0 };
        let (m, q) = (traction(momentum, 0.7, 0.0, 1.0), traction(quadratic, 0.7, 0.0, 1.0));
        assert!((m.tangential - q.tangential).abs() < 1e-15);
        let (m, q) = (traction(momentum, 0.0, -0.7, 1.0), traction(quadratic, 0.0, -0.7, 1.0));
        assert!((m.normal - q.normal).abs() < 1e-15);
    }
}
