//! The motion in the plane under constant loads, from a shape that is let go until it rests in an equilibrium
//! ([`super::resting`]).

use hydrostat_bvp::{Lanes, Real, Solution, Stage};

use super::dimensions::{S, Shape, X};
use super::equations::Moving;
use super::error::MotionError;
use super::in_plane::Planar;
use super::inputs::Inputs;
use super::landing::{Lands, Rest};
use super::resting::{self, Candidate, ELEMENTS, Restless, TOLERANCE, is_damped};
use super::start::{check, mesh_at};
use super::stepper::Stepper;
use crate::rod::arm::Arm;
use crate::statics::configuration::{Configuration, Tip};
use crate::statics::dimensions::{Guess, L};
use crate::statics::engine::Engine;
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::snap::Snap;

impl Configuration {
    /// Lets this shape go, at rest, under the loads of `arm`, which has the same geometry, and follows the motion until
    /// the arm rests in an equilibrium. The tip position of that is good to `tol` L.
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Profile};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.density = 1080.0;
    /// arm.dynamics.relaxation_time = 2.7e-3; // s
    /// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.2));
    /// let bent = arm.solve()?;
    /// arm.cables[0].tension = 0.0;
    /// let rest = bent.let_go(&arm, 1e-8).expect("water and material damp it");
    /// assert!(rest.configuration.tip().theta.abs() < 1e-9 && rest.time > 0.1);
    /// # Ok::<(), hydrostat::SolveError>(())
    /// ```
    ///
    /// # Errors
    /// [`Restless`].
    pub fn let_go(&self, arm: &Arm, tol: f64) -> Result<Rest, Restless> {
        arm.check().map_err(MotionError::Arm)?;
        let mut engine = Engine::new(arm);
        let dense = self.dense();
        if !self.arm.has_geometry_of(arm) {
            let reason = "a shape can be let go under other loads only, not as another arm";
            return Err(MotionError::Unsupported { key: "arm".to_owned(), reason }.into());
        }
        let strokes = |arm: &Arm| arm.cables.iter().map(|cable| cable.stroke.is_some()).collect::<Vec<_>>();
        engine.solution.clone_from(&dense.solution);
        engine.solution.nodes.iter_mut().for_each(|z| {
            let by = dense.equations.units.force / engine.equations.units.force;
            z[1..].iter_mut().for_each(|v| *v *= by);
        });
        engine.solution.stages.iter_mut().for_each(|stage| {
            let by = Lanes::of(dense.equations.units.force / engine.equations.units.force);
            stage.slope[1..].iter_mut().for_each(|v| *v = *v * by);
        });
        if strokes(arm).contains(&true) {
            if strokes(arm) != strokes(&self.arm) || dense.equations.stroke_control.is_none() {
                let reason = "a cable keeps its tension or its stroke while the arm is let go";
                return Err(MotionError::Unsupported { key: "cable.stroke".to_owned(), reason }.into());
            }
            for (c, cable) in self.arm.cables.iter().enumerate().filter(|(_, cable)| cable.stroke.is_some()) {
                engine.equations.set_tension(c, cable.tension);
            }
            engine.equations.hold_strokes();
        }
        engine.equations.place_on(&engine.system.gauss, &engine.solution);
        engine.can_rest()?;
        engine.come_to_rest(tol)
    }
}

impl Lands for Engine {
    fn take(&mut self, shape: &Configuration) {
        self.equations.clone_from(&shape.dense().equations);
        self.solution.clone_from(&shape.dense().solution);
    }

    fn tip_of(shape: &Configuration) -> Tip {
        shape.tip()
    }

    fn snaps_of(shape: &mut Configuration) -> &mut Vec<Snap> {
        &mut shape.snaps
    }

    fn can_rest(&self) -> Result<(), MotionError> {
        let arm = self.equations.arm();
        check(arm)?;
        if self.equations.stroke_control.is_none()
            && let Some(i) = arm.cables.iter().position(|cable| cable.stroke.is_some())
        {
            let reason = "the arm snaps before its cables are reeled in, and no motion leads from there to a stroke";
            return Err(MotionError::Unsupported { key: format!("cable[{i}].stroke"), reason });
        }
        is_damped(arm)
    }

    fn come_to_rest(&mut self, tol: f64) -> Result<Rest, Restless> {
        let arm = self.equations.arm_at_fraction();
        let stepper = let_go(self, &arm);
        let (configuration, time) = resting::come_to_rest(stepper, |stepper| look(self, stepper, tol))?;
        Ok(Rest { configuration, time })
    }
}

/// The motion of the engine's shape from rest.
fn let_go(engine: &mut Engine, arm: &Arm) -> Stepper<Moving, S, L> {
    let mut settling = Planar::new(arm);
    let mesh = mesh_at(engine, ELEMENTS);
    if engine.equations.stroke_control.is_some() {
        settling.moving.statics.hold_strokes();
    }
    settling.start_from_statics(&engine.solution, engine.equations.units.force, mesh);
    Stepper::at_rest(settling, arm.clone(), Inputs::default(), 0.0, TOLERANCE, None).let_go()
}

/// The equilibrium at the shape of the moving arm at which it may end, where there is one, with the engine left there.
fn look(engine: &mut Engine, stepper: &Stepper<Moving, S, L>, tol: f64) -> Option<Candidate<Configuration>> {
    let kept = engine.state();
    let found = look_from(engine, stepper, tol);
    if found.is_none() {
        engine.restore(&kept);
    }
    found
}

fn look_from(engine: &mut Engine, stepper: &Stepper<Moving, S, L>, tol: f64) -> Option<Candidate<Configuration>> {
    let settling = &stepper.settling;
    let force = settling.moving.statics.units.force / engine.equations.units.force;
    engine.solution = without_places(&settling.solution, &settling.moving.scales, force);
    engine.equations.place_on(&engine.system.gauss, &engine.solution);
    if let (Some(stroke_control), Some(moving)) =
        (&mut engine.equations.stroke_control, &settling.moving.statics.stroke_control)
    {
        stroke_control.taut.clone_from(&moving.taut);
        stroke_control.switching = true;
        let tensions: Vec<(usize, f64)> =
            stroke_control.cables.iter().map(|c| (*c, settling.moving.statics.arm().cables[*c].tension)).collect();
        for (cable, tension) in tensions {
            engine.equations.set_tension(cable, tension);
        }
    }
    let estimate = engine.settle(tol, First::Rough).ok()?;
    let statistics = engine.statistics(0);
    let length = engine.equations.units.length;
    let configuration = Configuration::read(engine, estimate * length, statistics).ok()?;
    let nodes = settling.solution.mesh.nodes().iter();
    let place = |s: &f64| {
        let at = configuration.at(s * length);
        [at.x / length, at.y / length, 0.0]
    };
    let places = nodes.map(place).collect();
    let stands = configuration.growth().is_none_or(|growth| growth.lets_rest());
    stands.then(|| Candidate::near(configuration, places, &stepper.now)).flatten()
}

/// The states of the statics in a solution of the motion whose states have the sizes `scales`, what it carries times
/// `force`.
fn without_places(given: &Shape, scales: &[f64; X + 2], force: f64) -> Guess {
    let by: [f64; X] = std::array::from_fn(|a| scales[a] * if a == 0 { 1.0 } else { force });
    Solution {
        mesh: given.mesh.clone(),
        directions: given.directions.clone(),
        nodes: given.nodes.iter().map(|z| std::array::from_fn(|a| by[a] * z[a])).collect(),
        stages: given
            .stages
            .iter()
            .map(|stage| Stage {
                slope: std::array::from_fn(|a| Lanes::of(by[a]) * stage.slope[a]),
                inner: stage.inner,
                closure_slope: stage.closure_slope,
            })
            .collect(),
        ends: given.ends.clone(),
    }
}
