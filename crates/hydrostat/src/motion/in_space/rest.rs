//! Where an arm in space comes to rest that is let go, see [`crate::motion::landing`].

use hydrostat_bvp::{Lanes, Real, Solution, Stage, each};

use super::equations::{S, Shape, Spatial, SpatialMoving};
use super::start::with_places;
use crate::motion::error::MotionError;
use crate::motion::inputs::Inputs;
use crate::motion::landing::{Lands, Rest};
use crate::motion::resting::{self, Candidate, ELEMENTS, Restless, TOLERANCE, is_damped};
use crate::motion::start::{check, force_unit, mesh_at};
use crate::motion::stepper::Stepper;
use crate::rod::arm::Arm;
use crate::spatial::engine::Engine;
use crate::spatial::equations::{FORCE, Guess, L, N};
use crate::spatial::{SpatialConfiguration, SpatialSnap, SpatialTip};

impl Lands for Engine {
    fn take(&mut self, shape: &SpatialConfiguration) {
        self.take_shape_of(shape);
    }

    fn tip_of(shape: &SpatialConfiguration) -> SpatialTip {
        shape.tip()
    }

    fn snaps_of(shape: &mut SpatialConfiguration) -> &mut Vec<SpatialSnap> {
        &mut shape.snaps
    }

    fn can_rest(&self) -> Result<(), MotionError> {
        let arm = self.equations.arm();
        check(arm)?;
        if let Some(i) = arm.cables.iter().position(|cable| cable.stroke.is_some()) {
            let reason = "no motion leads from a snap in space to a stroke";
            return Err(MotionError::Unsupported { key: format!("cable[{i}].stroke"), reason });
        }
        is_damped(arm)
    }

    fn come_to_rest(&mut self, tol: f64) -> Result<Rest<SpatialConfiguration>, Restless> {
        let arm = self.equations.arm_at_fraction();
        let stepper = let_go(self, &arm);
        let (configuration, time) = resting::come_to_rest(stepper, |stepper| look(self, stepper, tol))?;
        Ok(Rest { configuration, time })
    }
}

impl SpatialConfiguration {
    /// Lets this shape go, at rest, under the loads of `arm`, as
    /// [`Configuration::let_go`](crate::Configuration::let_go) does in the plane. Cables have tensions.
    ///
    /// # Errors
    /// [`Restless`].
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Options, Profile, Space, SpatialSolver};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.density = 1080.0;
    /// arm.dynamics.relaxation_time = 2.7e-3; // s
    /// arm.cables.push(Cable::new("aside", Profile::linear(0.005, 0.001)).at_angle(1.0).pulled(0.2));
    /// arm.space = Some(Space::default());
    /// let bent = SpatialSolver::new(&arm, Options::default())?.solve()?;
    /// arm.cables[0].tension = 0.0;
    /// let rest = bent.let_go(&arm, 1e-8).expect("water and material damp it");
    /// assert!(rest.configuration.tip().z.abs() < 1e-9 && rest.time > 0.1);
    /// # Ok::<(), hydrostat::SpatialError>(())
    /// ```
    pub fn let_go(&self, arm: &Arm, tol: f64) -> Result<Rest<Self>, Restless> {
        let mut arm = arm.clone();
        arm.space.get_or_insert_default();
        arm.check().map_err(MotionError::Arm)?;
        if !self.arm.has_geometry_of(&arm) {
            let reason = "a shape can be let go under other loads only, not as another arm";
            return Err(MotionError::Unsupported { key: "arm".to_owned(), reason }.into());
        }
        let own = self.engine();
        let mut engine = Engine::new(&arm);
        let by = own.equations.units.force / engine.equations.units.force;
        engine.solution.clone_from(&own.solution);
        engine.solution.nodes.iter_mut().for_each(|z| z[FORCE..].iter_mut().for_each(|v| *v *= by));
        engine.solution.stages.iter_mut().for_each(|stage| {
            stage.slope[FORCE..].iter_mut().for_each(|v| *v = *v * Lanes::of(by));
        });
        // Two quaternions have the same directors.
        let base = engine.equations.base;
        if (0..4).map(|k| base[k] * own.solution.nodes[0][k]).sum::<f64>() < 0.0 {
            engine.equations.base = base.map(|v| -v);
        }
        engine.equations.place_on(&engine.system.gauss, &engine.solution);
        engine.can_rest()?;
        engine.come_to_rest(tol)
    }
}

/// The motion of the engine's shape from rest.
fn let_go(engine: &mut Engine, arm: &Arm) -> Stepper<SpatialMoving, S, L> {
    let mut settling = Spatial::of(SpatialMoving::new(arm, force_unit(arm)));
    let mesh = mesh_at(engine, ELEMENTS);
    let statics = &settling.moving.statics;
    let force = engine.equations.units.force / statics.units.force;
    let whole = with_places(&engine.solution, force, statics.base_place(), &settling.system);
    settling.start_from(&whole, mesh);
    Stepper::at_rest(settling, arm.clone(), Inputs::default(), 0.0, TOLERANCE, None).let_go()
}

/// The equilibrium at the shape of the moving arm at which it may end, where there is one, with the engine left there.
fn look(
    engine: &mut Engine,
    stepper: &Stepper<SpatialMoving, S, L>,
    tol: f64,
) -> Option<Candidate<SpatialConfiguration>> {
    let settling = &stepper.settling;
    let force = settling.moving.statics.units.force / engine.equations.units.force;
    let shape = without_places(&settling.solution, &settling.moving.scales, force);
    engine.settle_near(shape, tol, |configuration| {
        let length = configuration.arm.length;
        let place = |s: &f64| {
            let at = configuration.at(s * length);
            [at.x / length, at.y / length, at.z / length]
        };
        let places = settling.solution.mesh.nodes().iter().map(place).collect();
        let stands = configuration.growth().is_none_or(|growth| growth.lets_rest());
        stands.then(|| Candidate::near(configuration, places, &stepper.now)).flatten()
    })
}

/// The states of the statics in a solution of the motion whose states have the sizes `scales`, what it carries times
/// `force`.
fn without_places(given: &Shape, scales: &[f64; S], force: f64) -> Guess {
    let by: [f64; N] = each(|a| scales[a] * if a < FORCE { 1.0 } else { force });
    let stage = |stage: &Stage<S, L>| Stage {
        slope: each(|a| Lanes::of(by[a]) * stage.slope[a]),
        inner: stage.inner,
        closure_slope: stage.closure_slope,
    };
    Solution {
        mesh: given.mesh.clone(),
        directions: given.directions.clone(),
        nodes: given.nodes.iter().map(|z| each(|a| by[a] * z[a])).collect(),
        stages: given.stages.iter().map(stage).collect(),
        ends: given.ends.clone(),
    }
}
