//! A motion in the plane or in space, as a session runs it.

use hydrostat::{
    Arm, CableMotion, Inputs, MotionError, MotionEvent, MotionOptions, MotionState, MotionStation, MotionStatistics,
    MotionWarning, Simulation, SpatialMotionStation, SpatialSimulation, Works,
};
use hydrostat_files::MotionShape;

/// Error of the tip over L that is asked for: less than a pixel of most screens.
const TOLERANCE: f64 = 1e-3;

/// The motion at one time; in the plane what is along e3 is zero.
#[derive(Debug, Clone)]
pub(crate) struct Now {
    /// s.
    pub(crate) time: f64,
    /// m.
    pub(crate) tip: [f64; 3],
    /// m/s.
    pub(crate) velocity: [f64; 3],
    pub(crate) cables: Vec<CableMotion>,
    /// J.
    pub(crate) kinetic: f64,
    /// J.
    pub(crate) strained: f64,
    pub(crate) works: Works,
}

/// An arm in motion.
pub(crate) trait Moving: Send {
    /// Moves on by `dt` (s) while loads change to these values, or to the end of the step in time after which `go_on`
    /// is false.
    fn move_on(&mut self, dt: f64, loads: &[(&str, f64)], go_on: &mut dyn FnMut() -> bool) -> Result<(), MotionError>;
    fn now(&mut self) -> Now;
    /// A motion of its own that goes on from here.
    fn copy(&self) -> Box<dyn Moving>;
    fn state(&self) -> MotionState;
    /// The shape at places along the arm (m), and the stretch nu there.
    fn shape(&self, places: &[f64]) -> (MotionShape, Vec<f64>);
    fn events(&self) -> &[MotionEvent];
    fn warnings(&self) -> Vec<MotionWarning>;
    /// Of the tip, m.
    fn error_estimate(&self) -> f64;
    fn statistics(&self) -> MotionStatistics;
}

/// The arm at rest in its equilibrium at the time 0, or as another motion left it.
pub(crate) fn moving(arm: &Arm, from: Option<&MotionState>) -> Result<Box<dyn Moving>, MotionError> {
    let (inputs, options) = (Inputs::default(), MotionOptions { tol: TOLERANCE, ..MotionOptions::default() });
    Ok(match (arm.space.is_some(), from) {
        (false, None) => Box::new(Simulation::new(arm, inputs, options)?),
        (false, Some(state)) => Box::new(Simulation::resume(arm, inputs, options, state)?),
        (true, None) => Box::new(SpatialSimulation::new(arm, inputs, options)?),
        (true, Some(state)) => Box::new(SpatialSimulation::resume(arm, inputs, options, state)?),
    })
}

/// What both kinds of motion are asked for alike.
macro_rules! alike {
    () => {
        fn move_on(
            &mut self,
            dt: f64,
            loads: &[(&str, f64)],
            go_on: &mut dyn FnMut() -> bool,
        ) -> Result<(), MotionError> {
            self.step_to_while(dt, loads, go_on).map(drop)
        }

        fn copy(&self) -> Box<dyn Moving> {
            Box::new(self.clone())
        }

        fn state(&self) -> MotionState {
            self.state()
        }

        fn events(&self) -> &[MotionEvent] {
            self.events()
        }

        fn warnings(&self) -> Vec<MotionWarning> {
            self.warnings()
        }

        fn error_estimate(&self) -> f64 {
            self.error_estimate()
        }

        fn statistics(&self) -> MotionStatistics {
            self.statistics()
        }
    };
}

impl Moving for Simulation {
    alike!();

    fn now(&mut self) -> Now {
        let at = self.now();
        let ([x, y], [u, v]) = (at.tip, at.tip_velocity);
        Now {
            time: at.time,
            tip: [x, y, 0.0],
            velocity: [u, v, 0.0],
            cables: at.cables,
            kinetic: at.kinetic_energy,
            strained: at.strain_energy,
            works: at.works,
        }
    }

    fn shape(&self, places: &[f64]) -> (MotionShape, Vec<f64>) {
        let stations: Vec<MotionStation> = places.iter().map(|s| self.station(*s)).collect();
        (MotionShape::in_plane(self.time(), &stations), stations.iter().map(|at| at.nu).collect())
    }
}

impl Moving for SpatialSimulation {
    alike!();

    fn now(&mut self) -> Now {
        let at = self.now();
        Now {
            time: at.time,
            tip: [at.tip.x, at.tip.y, at.tip.z],
            velocity: at.tip_velocity,
            cables: at.cables,
            kinetic: at.kinetic_energy,
            strained: at.strain_energy,
            works: at.works,
        }
    }

    fn shape(&self, places: &[f64]) -> (MotionShape, Vec<f64>) {
        let stations: Vec<SpatialMotionStation> = places.iter().map(|s| self.station(*s)).collect();
        (MotionShape::in_space(self.time(), &stations), stations.iter().map(|at| at.strains[0]).collect())
    }
}
