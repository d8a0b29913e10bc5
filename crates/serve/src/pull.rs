//! The tip of an arm that is pulled, in the plane or in space.

use hydrostat::{
    Arm, Configuration, Followed, Follower, ReachError, ReachOptions, SpatialConfiguration, SpatialFollower,
    SpatialTarget, Target,
};
use serde::Serialize;

use crate::problem::Problem;
use crate::shape::Shape;

/// Distance to a target over L at which the tip has reached it.
const REACHED: f64 = 1e-6;

/// How far (over L) a target is moved at once: further targets are gone to in parts.
const PART: f64 = 0.05;

/// Most parts.
const PARTS: f64 = 12.0;

/// Where the tip was pulled to.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Pulled {
    /// N; these are the tensions of the answer.
    tensions: Vec<f64>,
    reached: bool,
    /// From the target, m.
    distance: f64,
    /// Cables whose tension is at a bound.
    bounds: Vec<BoundOut>,
    /// Whether the arm went to another branch of its equilibria on the way.
    jumped: bool,
    /// Whether a solve from the unloaded arm at these tensions leads to another shape than following did.
    pub(crate) elsewhere: bool,
}

#[derive(Debug, Clone, Serialize)]
struct BoundOut {
    cable: usize,
    kind: &'static str,
}

/// What follows the targets.
#[derive(Debug)]
enum Hand {
    Plane(Box<Follower>),
    Space(Box<SpatialFollower>),
}

impl Hand {
    fn follow(&mut self, to: [f64; 3]) -> Result<Followed<[f64; 3]>, Problem> {
        match self {
            Self::Plane(follower) => {
                let Followed { tensions, tip, distance, reached, jumped, solves } =
                    follower.follow(&[Target::tip(to[0], to[1])]).map_err(lost)?;
                Ok(Followed { tensions, tip: [tip.x, tip.y, 0.0], distance, reached, jumped, solves })
            }
            Self::Space(follower) => follower.follow(&[SpatialTarget::tip(to)]).map_err(lost),
        }
    }
}

/// A tip that is being pulled.
#[derive(Debug)]
pub(crate) struct Pull {
    /// The arm with slack cables, and the bound: what must not change under the hand.
    of: (Arm, Option<f64>),
    hand: Hand,
    pub(crate) at: [f64; 3],
}

impl Pull {
    /// Takes hold of the tip of `arm` where it is; no cable's tension is to be above `most`, N.
    pub(crate) fn begin(arm: &Arm, most: Option<f64>) -> Result<Self, Problem> {
        let of = (arm.slackened(), most);
        let mut held = of.0.clone();
        // The tensions that commanded strokes have led to are where the pull begins.
        let mut hold = |found: &[hydrostat::CableState]| {
            for (cable, state) in held.cables.iter_mut().zip(found) {
                cable.tension = cable.max_tension.map_or(state.tension, |max| state.tension.min(max));
            }
        };
        let options = ReachOptions { max_tension: most, tol: REACHED, all: false, ..ReachOptions::default() };
        let tol = hydrostat::Options::default().tol;
        if arm.space.is_some() {
            let found = <SpatialConfiguration as Shape>::solve(arm, tol)?;
            hold(&found.cables);
            let at = Shape::tip(&found);
            let follower = SpatialFollower::new(&held, &[SpatialTarget::tip(at)], &options)?;
            return Ok(Self { of, hand: Hand::Space(Box::new(follower)), at });
        }
        let found = <Configuration as Shape>::solve(arm, tol)?;
        hold(&found.cables);
        let at = Shape::tip(&found);
        let follower = Follower::new(&held, &[Target::tip(at[0], at[1])], &options)?;
        Ok(Self { of, hand: Hand::Plane(Box::new(follower)), at })
    }

    /// Whether it is of this arm.
    pub(crate) fn is_of(&self, arm: &Arm, most: Option<f64>) -> bool {
        self.of.1 == most && self.of.0 == arm.slackened()
    }

    /// Brings the tip to the target, or as near as it gets, and gives the tensions to `arm`.
    pub(crate) fn to(&mut self, target: [f64; 3], arm: &mut Arm) -> Result<Pulled, Problem> {
        let (from, most) = (self.at, self.of.1);
        let way = [0, 1, 2].map(|k| target[k] - from[k]);
        let far = way.iter().map(|v| v * v).sum::<f64>().sqrt();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 1 and PARTS")]
        let parts = (far / (PART * arm.length)).ceil().clamp(1.0, PARTS) as u32;
        let mut jumped = false;
        let mut last = None;
        for part in 1..=parts {
            let share = f64::from(part) / f64::from(parts);
            let found = self.hand.follow([0, 1, 2].map(|k| from[k] + share * way[k]))?;
            jumped |= found.jumped;
            self.at = found.tip;
            last = Some(found);
        }
        let Some(found) = last else { return Err(Problem::defect()) };
        for (cable, tension) in arm.cables.iter_mut().zip(&found.tensions) {
            (cable.tension, cable.stroke) = (*tension, None);
        }
        let bound = |(cable, tension): (usize, &f64)| {
            let largest = arm.cables[cable].max_tension.into_iter().chain(most).reduce(f64::min);
            let kind = match largest {
                Some(largest) if *tension >= largest * (1.0 - 1e-9) => "most",
                _ if *tension <= 0.0 => "slack",
                _ => return None,
            };
            Some(BoundOut { cable, kind })
        };
        Ok(Pulled {
            reached: found.reached,
            distance: found.distance * arm.length,
            bounds: found.tensions.iter().enumerate().filter_map(bound).collect(),
            tensions: found.tensions,
            jumped,
            elsewhere: false,
        })
    }
}

fn lost<E>(error: ReachError<E>) -> Problem
where
    Problem: From<ReachError<E>>,
{
    let mut problem = Problem::from(error);
    problem.body.error.message = format!("the arm cannot follow there: {}", problem.body.error.message);
    problem
}
