//! Tensions for places in space: the search of the plane, on the solver of space.

use super::effort::dot;
use super::in_plane::SAME;
use super::problem::{Reach, ReachError, ReachOptions};
use super::reaching::Reaching;
use super::search::Search;
use crate::rod::arm::{Arm, ArmError};
use crate::rod::parameter::Parameter;
use crate::spatial::{Quantity, SpatialConfiguration, SpatialError, SpatialSolver, SpatialStation, turn_between};
use crate::statics::configuration::CableState;
use crate::statics::sensitivity::SensitivityMethod;
use crate::statics::solve::Options;
use crate::statics::stability::Stability;

/// Where a place of an arm in space is to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpatialTarget {
    /// The place, m along the arm; none for the tip.
    pub s: Option<f64>,
    /// x, y, z, m.
    pub place: [f64; 3],
    /// Direction of a there, of any length but zero, if it matters: in a distance, a radian counts as one arm's
    /// length.
    pub direction: Option<[f64; 3]>,
    /// Weight of its distance among those of several targets, from 1e-9 to 1e9.
    pub weight: f64,
}

impl SpatialTarget {
    /// The tip at a place, m.
    pub fn tip(place: [f64; 3]) -> Self {
        Self { s: None, place, direction: None, weight: 1.0 }
    }

    /// Whether squares of its distances are numbers.
    pub(super) fn is_for(&self, arm: &Arm) -> bool {
        /// Lengths of the arm.
        const FURTHEST: f64 = 1e6;
        let far = dot(&self.place, &self.place).sqrt();
        let direction = self.direction.is_none_or(|d| {
            let size = dot(&d, &d);
            size > 0.0 && size.is_finite()
        });
        far <= FURTHEST * arm.length && direction && (1e-9..=1e9).contains(&self.weight)
    }
}

impl Arm {
    /// [`Arm::reach`] of an arm in space.
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Options, Profile, ReachOptions, Space, SpatialSolver, SpatialTarget};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// for (k, tension) in [0.1, 0.05, 0.0].into_iter().enumerate() {
    ///     let angle = k as f64 * std::f64::consts::TAU / 3.0;
    ///     let cable = Cable::new(format!("cable {k}"), Profile::linear(0.005, 0.001)).at_angle(angle);
    ///     arm.cables.push(cable.pulled(tension));
    /// }
    /// arm.space = Some(Space::default());
    /// let tip = SpatialSolver::new(&arm, Options::default())?.solve()?.tip();
    ///
    /// let options = ReachOptions { all: false, ..ReachOptions::default() };
    /// let found = arm.reach_in_space(&[SpatialTarget::tip([tip.x, tip.y, tip.z])], &options)?;
    /// assert!((found.solutions[0].tensions[0] - 0.1).abs() < 1e-5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ReachError`].
    pub fn reach_in_space(
        &self,
        targets: &[SpatialTarget],
        options: &ReachOptions,
    ) -> Result<Reach<SpatialConfiguration, SpatialStation>, ReachError<SpatialError>> {
        self.reach_in_space_while(targets, options, || true)
    }

    /// [`Arm::reach_in_space`] while `go_on`, see [`Arm::reach_while`].
    ///
    /// # Errors
    /// [`ReachError`].
    pub fn reach_in_space_while(
        &self,
        targets: &[SpatialTarget],
        options: &ReachOptions,
        go_on: impl Fn() -> bool,
    ) -> Result<Reach<SpatialConfiguration, SpatialStation>, ReachError<SpatialError>> {
        let mut arm = self.clone();
        arm.space.get_or_insert_default();
        Search::<SpatialSolver>::new(&arm, targets.to_vec(), options)?.run(options, &go_on)
    }

    /// [`Arm::reach_by_strokes`] of an arm in space.
    ///
    /// # Errors
    /// [`ReachError`].
    pub fn reach_in_space_by_strokes_while(
        &self,
        targets: &[SpatialTarget],
        options: &ReachOptions,
        go_on: impl Fn() -> bool,
    ) -> Result<Reach<SpatialConfiguration, SpatialStation>, ReachError<SpatialError>> {
        let mut arm = self.clone();
        arm.space.get_or_insert_default();
        let mut search = Search::<SpatialSolver>::new(&arm, targets.to_vec(), options)?;
        search.hold_lengths();
        search.run(options, &go_on)
    }
}

impl Reaching for SpatialSolver {
    type Goal = Vec<SpatialTarget>;
    type Shape = SpatialConfiguration;
    type Place = SpatialStation;
    type Error = SpatialError;

    fn fits(goal: &Vec<SpatialTarget>, arm: &Arm) -> bool {
        !goal.is_empty() && goal.iter().all(|target| target.is_for(arm))
    }

    fn stations(goal: &Vec<SpatialTarget>) -> Vec<f64> {
        goal.iter().filter_map(|target| target.s).collect()
    }

    fn wrong(error: ArmError) -> SpatialError {
        error.into()
    }

    fn begin(arm: &Arm, tolerance: f64) -> Result<Self, SpatialError> {
        let mut solver = Self::new(arm, Options::with_tol(tolerance))?;
        solver.solve()?;
        Ok(solver)
    }

    fn watch(&mut self, places: &[f64]) -> bool {
        self.watch_places(places)
    }

    fn pull(&mut self, tensions: &[f64]) -> Option<()> {
        self.set_tensions(tensions).ok()
    }

    fn settle(&mut self) -> Option<()> {
        self.update().ok().map(drop)
    }

    fn settle_warm(&mut self) -> Option<()> {
        Self::settle_warm(self).map(drop)
    }

    fn tensions(&self) -> Vec<f64> {
        self.arm().cables.iter().map(|cable| cable.tension).collect()
    }

    fn strokes(&self, count: usize) -> Vec<f64> {
        self.strokes_now(count)
    }

    fn rest(&self, goal: &Vec<SpatialTarget>, arm: &Arm) -> Vec<f64> {
        let base = [0, 1, 2].map(|axis| arm.base_place(axis).unwrap_or_default());
        let mut out = Vec::with_capacity(5 * goal.len());
        for target in goal {
            let (place, a) = self.pose_of(target.s.map_or(1.0, |s| s / arm.length));
            for k in 0..3 {
                out.push(target.weight * (place[k] - (target.place[k] - base[k]) / arm.length));
            }
            if let Some(direction) = target.direction {
                let aim = Aim::of(direction);
                let [off, _] = aim.angle(a);
                out.extend(aim.across.map(|axis| target.weight * off * dot(&a, &axis)));
            }
        }
        out
    }

    fn derivatives(&self, goal: &Vec<SpatialTarget>, arm: &Arm, of_strokes: bool) -> Option<Vec<Vec<f64>>> {
        let cables: Vec<Parameter> = (0..arm.cables.len()).map(Parameter::Tension).collect();
        let mut sums = Vec::new();
        for target in goal {
            let s = target.s.map_or(1.0, |s| s / arm.length);
            let pose = self.pose_at(s);
            sums.extend((0..3).map(|k| vec![(pose[k], target.weight / arm.length)]));
            if let Some(direction) = target.direction {
                let ((_, a), aim) = (self.pose_of(s), Aim::of(direction));
                let [off, by_cosine] = aim.angle(a);
                for axis in aim.across {
                    // a' = phi x a, so that (a . v)' = phi . (a x v).
                    let (by_axis, by_aim) = (cross(&a, &axis), cross(&a, &aim.direction));
                    let own = dot(&a, &axis);
                    let weight = |k: usize| target.weight * (off * by_axis[k] + by_cosine * own * by_aim[k]);
                    sums.push((0..3).map(|k| (pose[3 + k], weight(k))).collect());
                }
            }
        }
        if of_strokes {
            sums.extend((0..cables.len()).map(|c| vec![(Quantity::Command(c), 1.0 / arm.length)]));
        }
        Some(self.derivatives_of(sums, &cables, SensitivityMethod::Best)?.rows)
    }

    fn tip_pose(&self) -> Vec<f64> {
        let (place, a) = self.pose_of(1.0);
        place.into_iter().chain(a).collect()
    }

    fn turned(&self, from: &Self) -> f64 {
        turn_between(from, self)
    }

    fn shape(&mut self) -> Result<SpatialConfiguration, SpatialError> {
        self.configuration()
    }

    fn on_the_path(arm: &Arm) -> Option<SpatialConfiguration> {
        Self::new(arm, Options::default()).ok()?.solve().ok()
    }

    fn is_near(a: &SpatialConfiguration, b: &SpatialConfiguration) -> bool {
        let (p, q) = (a.tip(), b.tip());
        let apart = [p.x - q.x, p.y - q.y, p.z - q.z];
        dot(&apart, &apart).sqrt() < SAME * a.arm.length
    }

    fn arm(shape: &SpatialConfiguration) -> &Arm {
        &shape.arm
    }

    fn cables(shape: &SpatialConfiguration) -> &[CableState] {
        &shape.cables
    }

    fn stability(shape: &SpatialConfiguration) -> Option<Stability> {
        shape.stability()
    }

    fn place(shape: &SpatialConfiguration, s: f64) -> SpatialStation {
        shape.at(s)
    }

    fn unit_force(arm: &Arm) -> f64 {
        Self::unit_force(arm)
    }
}

/// A direction of length one, with two across it.
struct Aim {
    direction: [f64; 3],
    across: [[f64; 3]; 2],
}

impl Aim {
    fn of(direction: [f64; 3]) -> Self {
        let size = dot(&direction, &direction).sqrt();
        let d = direction.map(|v| v / size);
        // The axis that is furthest from it.
        let least = (0..3).min_by(|a, b| d[*a].abs().total_cmp(&d[*b].abs())).unwrap_or(0);
        let mut axis = [0.0; 3];
        axis[least] = 1.0;
        let p = cross(&d, &axis);
        let p = p.map(|v| v / dot(&p, &p).sqrt());
        Self { direction: d, across: [p, cross(&d, &p)] }
    }

    /// The angle to it over its sine, and the derivative of that by the cosine: times the part of `a` across, the angle
    /// is a distance.
    fn angle(&self, a: [f64; 3]) -> [f64; 2] {
        let cosine = dot(&a, &self.direction).clamp(-1.0, 1.0);
        let across = self.across.map(|axis| dot(&a, &axis));
        let sine = across[0].hypot(across[1]);
        if sine < 1e-4 {
            // Straight away from it, where there is no shortest way back, any one counts.
            return if cosine > 0.0 { [1.0, -1.0 / 3.0] } else { [std::f64::consts::PI / sine.max(1e-9), 0.0] };
        }
        let angle = sine.atan2(cosine);
        [angle / sine, (cosine * angle / sine - 1.0) / (sine * sine)]
    }
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}
