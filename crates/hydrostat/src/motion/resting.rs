//! The motion of an arm that was let go, in the plane or in space, until it rests in an equilibrium.
//!
//! An arm that creeps away from a limit point is as slow as one that comes to rest. So rest is no matter of speed:
//! where the arm is slow the statics look for an equilibrium at its shape, and the arm rests once it stays within
//! [`NEAR`] of one at which it may end (`Growth::lets_rest`).

use super::error::MotionError;
use super::history::{Snapshot, cubic};
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

/// An equilibrium near the moving arm, at which it may end.
pub(super) struct Candidate<C> {
    configuration: Box<C>,
    /// x, y, z over L at the nodes of the motion's mesh; z is 0 in the plane.
    places: Vec<[f64; 3]>,
}

impl<C> Candidate<C> {
    /// One at these places, where the arm `at` may come to rest.
    pub(super) fn near(configuration: C, places: Vec<[f64; 3]>, at: &Snapshot) -> Option<Self> {
        let own: Vec<[f64; 3]> = (0..places.len()).map(|i| at.node_place(i)[0]).collect();
        (apart(&own, &places) < FAR).then(|| Self { configuration: Box::new(configuration), places })
    }
}

/// Where the nodes of an arm were after each step.
#[derive(Default)]
struct Track {
    /// s.
    times: Vec<f64>,
    /// x, y, z over L.
    places: Vec<Vec<[f64; 3]>>,
    /// Their rates, 1/s.
    rates: Vec<Vec<[f64; 3]>>,
}

impl Track {
    fn note(&mut self, time: f64, at: &Snapshot) {
        let (places, rates) = (0..at.layout.nodes).map(|i| at.node_place(i)).map(|[place, rate]| (place, rate)).unzip();
        self.times.push(time);
        self.places.push(places);
        self.rates.push(rates);
    }

    /// How far the arm is now from `places`, over L.
    fn distance(&self, places: &[[f64; 3]]) -> f64 {
        self.places.last().map_or(f64::INFINITY, |own| apart(own, places))
    }

    /// The time (s) at which the arm came within [`NEAR`] of `places` to stay until now, and its step; `None` where it
    /// is not there now.
    fn entry(&self, places: &[[f64; 3]]) -> Option<(usize, f64)> {
        let outside = self.places.iter().rposition(|own| apart(own, places) > NEAR);
        let Some(before) = outside else { return self.times.first().map(|time| (0, *time)) };
        let step = self.times.get(before + 1)? - self.times[before];
        let (mut outside, mut inside) = (0.0, 1.0);
        for _ in 0..30 {
            let middle = 0.5 * (outside + inside);
            if apart(&self.between(before, step, middle), places) <= NEAR { inside = middle } else { outside = middle }
        }
        Some((before + 1, self.times[before] + inside * step))
    }

    /// Places at the fraction `x` of the step (s) after step `k`, by cubic interpolation.
    fn between(&self, k: usize, step: f64, x: f64) -> Vec<[f64; 3]> {
        let [p, u, q, v] = cubic(x);
        let node = |i: usize| {
            let [from, to] = [k, k + 1].map(|at| (self.places[at][i], self.rates[at][i]));
            [0, 1, 2].map(|a| p * from.0[a] + q * to.0[a] + step * (u * from.1[a] + v * to.1[a]))
        };
        (0..self.places[k].len()).map(node).collect()
    }
}

/// Where and when (s) the arm of `stepper`, which was let go, comes to rest: `look` is asked for the equilibrium at
/// the shape of the moving arm at which it may end, where there is one.
pub(super) fn come_to_rest<P: Moves<S, L>, C, const S: usize, const L: usize>(
    mut stepper: Stepper<P, S, L>,
    mut look: impl FnMut(&Stepper<P, S, L>) -> Option<Candidate<C>>,
) -> Result<(C, f64), Restless> {
    let (mut next_look, mut fastest) = (FIRST_LOOK, 0.0_f64);
    let mut found: Option<Candidate<C>> = None;
    let mut track = Track::default();
    track.note(stepper.time, &stepper.now);
    while stepper.steps + stepper.rejected < MOST_STEPS {
        stepper.advance(stepper.time + 1e6).map_err(Restless::Motion)?;
        track.note(stepper.time, &stepper.now);
        let speed = speed(&stepper.now);
        fastest = fastest.max(speed);
        found = found.filter(|at| track.distance(&at.places) <= FAR);
        if let Some((step, time)) = found.as_ref().and_then(|at| track.entry(&at.places))
            && stepper.steps >= step + STEADY
            && let Some(at) = found.take()
        {
            return Ok((*at.configuration, time));
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

/// The largest distance of places of the same nodes, over L.
fn apart(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    a.iter().zip(b).map(|(a, b)| length([0, 1, 2].map(|k| a[k] - b[k]))).fold(0.0, f64::max)
}

/// The largest speed of the centreline, over L.
fn speed(at: &Snapshot) -> f64 {
    (0..at.layout.nodes).map(|i| length(at.node_place(i)[1])).fold(0.0, f64::max)
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    x.hypot(y).hypot(z)
}
