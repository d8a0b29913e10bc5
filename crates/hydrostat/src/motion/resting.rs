//! The motion of an arm that was let go, in the plane or in space, until it rests in an equilibrium.
//!
//! An arm that creeps away from a limit point is as slow as one that comes to rest. So rest is no matter of speed:
//! where the arm is slow the statics look for an equilibrium at its shape, and the arm rests once it stays within
//! [`NEAR`] of a stable one.

use super::error::MotionError;
use super::history::{Snapshot, between};
use super::settling::Moves;
use super::stepper::Stepper;
use crate::rod::arm::Arm;

/// An arm rests that stays within this of an equilibrium, over L.
const NEAR: f64 = 2e-3;

/// Equilibria further away (over L) than this are not where an arm comes to rest.
const FAR: f64 = 0.05;

/// Steps that it has to stay there.
const STEADY: usize = 20;

/// Steps before the statics look for the first time.
const FIRST_LOOK: usize = 20;

/// The part of the largest speed until then below which an arm may be coming to rest.
const SLOW: f64 = 0.5;

/// The most steps of one motion.
const MOST_STEPS: usize = 5000;

/// Elements along the arm, and the tolerance of the tip.
pub(super) const ELEMENTS: usize = 20;
pub(super) const TOLERANCE: f64 = 1e-4;

/// Why an arm did not come to rest.
#[derive(Debug, Clone, thiserror::Error)]
pub enum Restless {
    /// The motion could not be followed.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// It goes on.
    #[error("the arm does not come to rest: after {time:.3} s its tip still moves at {speed:.2e} m/s")]
    Moving {
        /// For how long it was followed, s.
        time: f64,
        /// The speed of the tip then, m/s.
        speed: f64,
    },
}

/// A stable equilibrium near the moving arm.
pub(super) struct Candidate<C> {
    configuration: Box<C>,
    /// x, y, z over L at the nodes of the motion's mesh; z is 0 in the plane.
    places: Vec<[f64; 3]>,
    /// Step and time (s) since when the arm is within [`NEAR`].
    since: Option<(usize, f64)>,
}

impl<C> Candidate<C> {
    /// One at these places, where the arm `at` may come to rest.
    pub(super) fn near(configuration: C, places: Vec<[f64; 3]>, at: &Snapshot) -> Option<Self> {
        let found = Self { configuration: Box::new(configuration), places, since: None };
        (found.distance(at) < FAR).then_some(found)
    }

    /// How far the arm is from it, over L.
    fn distance(&self, at: &Snapshot) -> f64 {
        let off = |(i, place): (usize, &[f64; 3])| {
            let [own, _] = at.node_place(i);
            length([0, 1, 2].map(|k| own[k] - place[k]))
        };
        self.places.iter().enumerate().map(off).fold(0.0, f64::max)
    }

    /// When in the last step the arm came within [`NEAR`].
    fn entry<P: Moves<S, L>, const S: usize, const L: usize>(&self, stepper: &Stepper<P, S, L>) -> f64 {
        let mut at = stepper.before.clone();
        if self.distance(&at) <= NEAR {
            return stepper.time - stepper.step;
        }
        let (mut outside, mut inside) = (0.0, 1.0);
        for _ in 0..30 {
            let middle = 0.5 * (outside + inside);
            between(&stepper.before, &stepper.now, stepper.step, middle, &mut at);
            if self.distance(&at) <= NEAR { inside = middle } else { outside = middle }
        }
        stepper.time - (1.0 - inside) * stepper.step
    }
}

/// Where and when (s) the arm of `stepper`, which was let go, comes to rest: `look` is asked for the stable equilibrium
/// at the shape of the moving arm, where there is one.
pub(super) fn come_to_rest<P: Moves<S, L>, C, const S: usize, const L: usize>(
    mut stepper: Stepper<P, S, L>,
    mut look: impl FnMut(&Stepper<P, S, L>) -> Option<Candidate<C>>,
) -> Result<(C, f64), Restless> {
    let (mut next_look, mut fastest) = (FIRST_LOOK, 0.0_f64);
    let mut found: Option<Candidate<C>> = None;
    while stepper.steps + stepper.rejected < MOST_STEPS {
        stepper.advance(stepper.time + 1e6).map_err(Restless::Motion)?;
        let speed = speed(&stepper.now);
        fastest = fastest.max(speed);
        if let Some(at) = &mut found {
            let off = at.distance(&stepper.now);
            if off > FAR {
                found = None;
            } else if off > NEAR {
                at.since = None;
            } else if at.since.is_none() {
                at.since = Some((stepper.steps, at.entry(&stepper)));
            }
        }
        match found {
            Some(Candidate { since: Some((step, time)), configuration, .. }) if stepper.steps >= step + STEADY => {
                return Ok((*configuration, time));
            }
            other => found = other,
        }
        if found.is_none() && stepper.steps >= next_look && speed <= SLOW * fastest {
            next_look = stepper.steps + FIRST_LOOK.max(stepper.steps / 8);
            found = look(&stepper);
        }
    }
    let [_, rate] = stepper.now.node_place(stepper.now.layout.nodes - 1);
    Err(Restless::Moving { time: stepper.time, speed: stepper.arm().length * length(rate) })
}

/// Refuses arms whose motion never ends.
pub(super) fn is_damped(arm: &Arm) -> Result<(), MotionError> {
    if arm.flow.density == 0.0 && arm.dynamics.relaxation_time == 0.0 {
        let reason =
            "in a vacuum nothing but a relaxation time brings an arm to rest; give one, or the density of the water";
        return Err(MotionError::Unsupported { key: "dynamics.relaxation_time".to_owned(), reason });
    }
    Ok(())
}

/// The largest speed of the centreline, over L.
fn speed(at: &Snapshot) -> f64 {
    (0..at.layout.nodes).map(|i| length(at.node_place(i)[1])).fold(0.0, f64::max)
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    x.hypot(y).hypot(z)
}
