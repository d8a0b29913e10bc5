//! A hand that moves the tip of an arm in motion: a spring, with a damper, between the tip and where the hand is.
//!
//! ```text
//! F = k (p - r(L)) - c r.(L)            k = 3 EI(0)/L^3, c = k t
//! ```
//!
//! k is the stiffness of a uniform rod against a force on its tip, so that the arm bends by about as much as the hand
//! is ahead. The force is led along straight lines over short steps to its value where tip and velocity foretell the end
//! of each. A force that is not that of where the tip then is would feed the motion, most where nothing damps it: such a
//! step is done again with the force of where it led to.

use hydrostat::Arm;

use crate::moving::Now;

/// The longest step, s.
const LONGEST: f64 = 20e-3;

/// The step over the time in which the arm swings.
const STEP: f64 = 0.01;

/// The longest time of the damper, s, and that over the time in which the arm swings.
const DAMPED: f64 = 0.02;
const DAMPED_SHARE: f64 = 0.05;

/// A step is done again where the force at its end is off by more than this share of it, or of that over this share of
/// the length.
const OFF: f64 = 0.02;

/// The spring between hand and tip.
#[derive(Debug, Clone)]
pub(crate) struct Hand {
    /// N/m.
    stiffness: f64,
    /// N s/m.
    damping: f64,
    /// The longest that the spring counts as, m.
    reach: f64,
    /// Time over which the force is led, s.
    pub(crate) step: f64,
    /// Where the hand is, m.
    pub(crate) at: Option<[f64; 3]>,
    /// What it exerts on the tip, N.
    pub(crate) force: [f64; 3],
}

impl Hand {
    pub(crate) fn of(arm: &Arm) -> Self {
        let [_, _, bending] = arm.stiffness_at(0.0);
        let (length, radius) = (arm.length, arm.radius.at(0.0, arm.length).value);
        let mass = std::f64::consts::PI * radius * radius * (arm.density + arm.flow.density);
        let swing = (mass * length.powi(4) / bending).sqrt();
        let stiffness = 3.0 * bending / length.powi(3);
        let damped = DAMPED.min(DAMPED_SHARE * swing);
        Self {
            stiffness,
            damping: stiffness * damped,
            reach: length,
            step: LONGEST.min(STEP * swing),
            at: None,
            force: [0.0; 3],
        }
    }

    /// N/m.
    #[cfg(test)]
    pub(crate) fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Whether it exerts a force, or is about to.
    pub(crate) fn is_felt(&self) -> bool {
        self.at.is_some() || self.force != [0.0; 3]
    }

    /// Whether a step that ended at `now` with `force` (N) is to be done again.
    pub(crate) fn is_off(&self, now: &Now, force: &[f64; 3]) -> bool {
        let own = self.ahead(now, 0.0);
        let size = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
        let off = size(std::array::from_fn(|k| own[k] - force[k]));
        off > OFF * size(own).max(OFF * self.stiffness * self.reach)
    }

    /// The force (N) at the end of a step of `dt` (s) from `now`.
    pub(crate) fn ahead(&self, now: &Now, dt: f64) -> [f64; 3] {
        let Some(at) = self.at else { return [0.0; 3] };
        let way: [f64; 3] = std::array::from_fn(|k| at[k] - now.tip[k] - dt * now.velocity[k]);
        let far = way.iter().map(|v| v * v).sum::<f64>().sqrt();
        let held = if far > self.reach { self.reach / far } else { 1.0 };
        std::array::from_fn(|k| self.stiffness * held * way[k] - self.damping * now.velocity[k])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hydrostat::Works;

    #[test]
    fn it_pulls_towards_itself_and_not_harder_than_over_one_length() {
        let arm = Arm::cone(0.2, 0.01, 0.002, 1e5, 0.5);
        let mut hand = Hand::of(&arm);
        let now = Now {
            time: 0.0,
            tip: [0.2, 0.0, 0.0],
            velocity: [0.0; 3],
            cables: Vec::new(),
            kinetic: 0.0,
            strained: 0.0,
            works: Works::default(),
        };
        assert_eq!(hand.ahead(&now, 1e-3), [0.0; 3]);
        assert!(!hand.is_felt() && !hand.is_off(&now, &[0.0; 3]));
        hand.at = Some([0.2, 0.01, 0.0]);
        let [x, y, z] = hand.ahead(&now, 1e-3);
        // 3 EI/L^3 with EI = E pi R^4/4.
        let stiffness = 3.0 * 1e5 * std::f64::consts::PI * 1e-8 / 4.0 / 0.008;
        assert!(x == 0.0 && z == 0.0 && (y / (0.01 * stiffness) - 1.0).abs() < 1e-12, "{y}");
        assert!(hand.is_off(&now, &[0.0, 0.97 * y, 0.0]) && !hand.is_off(&now, &[0.0, 0.99 * y, 0.0]));
        hand.at = Some([1e6, 0.0, 0.0]);
        assert!((hand.ahead(&now, 1e-3)[0] / (0.2 * stiffness) - 1.0).abs() < 1e-12);
        let away = Now { velocity: [0.0, 1.0, 0.0], ..now };
        assert!(hand.ahead(&away, 1e-3)[1] < 0.0, "the damper holds back");
    }
}
