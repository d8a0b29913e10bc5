//! Motions in the plane and in space, as `hydrostat simulate` follows them.

use hydrostat::{Instant, MotionError, MotionEvent, MotionState, Simulation, SpatialInstant, SpatialSimulation};
use hydrostat_files::{
    MotionShape, motion_numbers, motion_shape_lines, place_numbers, spatial_motion_numbers, spatial_motion_shape_lines,
    spatial_place_numbers,
};

use super::motion_output::Told;

/// A motion in the plane or in space, row by row.
pub(super) trait Moving {
    type At;

    fn time(&self) -> f64;
    fn advance_to(&mut self, time: f64) -> Result<Self::At, MotionError>;
    fn events(&self) -> &[MotionEvent];
    /// The numbers of a row, those of stations at `places` (m) after them.
    fn numbers(&self, at: &Self::At, places: &[f64]) -> Vec<f64>;
    /// The shape at `places` (m) as lines of a table and as documents have it.
    fn shape(&self, places: &[f64]) -> (String, MotionShape);
    fn told(&self) -> Told;
    /// What another run goes on from.
    fn state(&self) -> MotionState;
}

macro_rules! told {
    ($simulation:expr) => {
        Told {
            statistics: $simulation.statistics(),
            estimate: $simulation.error_estimate(),
            energy_gap: $simulation.energy_gap(),
            warnings: $simulation.warnings(),
            events: $simulation.events().to_vec(),
            state: $simulation.state(),
        }
    };
}

impl Moving for Simulation {
    type At = Instant;

    fn time(&self) -> f64 {
        Self::time(self)
    }

    fn advance_to(&mut self, time: f64) -> Result<Instant, MotionError> {
        Self::advance_to(self, time)
    }

    fn events(&self) -> &[MotionEvent] {
        Self::events(self)
    }

    fn numbers(&self, at: &Instant, places: &[f64]) -> Vec<f64> {
        let mut out = motion_numbers(at);
        out.extend(places.iter().flat_map(|s| place_numbers(&self.station(*s))));
        out
    }

    fn shape(&self, places: &[f64]) -> (String, MotionShape) {
        let stations: Vec<_> = places.iter().map(|s| self.station(*s)).collect();
        (motion_shape_lines(self.time(), &stations), MotionShape::in_plane(self.time(), &stations))
    }

    fn told(&self) -> Told {
        told!(self)
    }

    fn state(&self) -> MotionState {
        Self::state(self)
    }
}

impl Moving for SpatialSimulation {
    type At = SpatialInstant;

    fn time(&self) -> f64 {
        Self::time(self)
    }

    fn advance_to(&mut self, time: f64) -> Result<SpatialInstant, MotionError> {
        Self::advance_to(self, time)
    }

    fn events(&self) -> &[MotionEvent] {
        Self::events(self)
    }

    fn numbers(&self, at: &SpatialInstant, places: &[f64]) -> Vec<f64> {
        let mut out = spatial_motion_numbers(at);
        out.extend(places.iter().flat_map(|s| spatial_place_numbers(&self.station(*s))));
        out
    }

    fn shape(&self, places: &[f64]) -> (String, MotionShape) {
        let stations: Vec<_> = places.iter().map(|s| self.station(*s)).collect();
        (spatial_motion_shape_lines(self.time(), &stations), MotionShape::in_space(self.time(), &stations))
    }

    fn told(&self) -> Told {
        told!(self)
    }

    fn state(&self) -> MotionState {
        Self::state(self)
    }
}
