//! Motions in the plane and in space, as `hydrostat simulate` follows them.

use hydrostat::{
    Arm, Instant, MotionError, MotionEvent, MotionState, QuasiStatic, Simulation, SpatialInstant, SpatialQuasiStatic,
    SpatialSimulation,
};
use hydrostat_figures::{MotionFrame, Page, Scene, spatial_strobe_figure, strobe_figure};
use hydrostat_files::{
    EventOut, MOTION_SHAPE_HEADS, MotionShape, SPATIAL_MOTION_SHAPE_HEADS, equilibrium_numbers, motion_heads,
    motion_numbers, motion_shape_lines, place_numbers, spatial_equilibrium_numbers, spatial_motion_heads,
    spatial_motion_numbers, spatial_motion_shape_lines, spatial_place_numbers,
};

use super::motion_output::Told;
use super::motion_text;

/// A motion in the plane or in space, whose places have `D` coordinates, row by row.
pub(super) trait Moving<const D: usize> {
    type At: Clone;
    /// The equilibria of the same loads.
    type Statics;

    /// The heads of whole shapes.
    const SHAPE_HEADS: &'static str;

    /// The heads of rows with so many cables and stations, and with the equilibrium of the same loads.
    fn heads(cables: usize, stations: usize, equilibrium: bool) -> Vec<String>;
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
    fn statics(&self) -> Result<Self::Statics, MotionError>;
    /// What a row has of the equilibrium of its loads: the place of its tip first, the distance from it last.
    fn equilibrium(statics: &mut Self::Statics, at: &Self::At, length: f64) -> Vec<f64>;
    /// The present shape, as pictures have it.
    fn frame(&self, at: &Self::At) -> MotionFrame<D>;
    /// The end of the motion and what it took, for people; `wall` is what it took, s.
    fn text(arm: &Arm, at: &Self::At, events: &[EventOut], told: &Told, wall: f64) -> String;
    fn strobe(frames: &[MotionFrame<D>], shapes: usize, title: &str, page: &Page) -> Scene;
}

/// What both kinds of motion are asked for alike.
macro_rules! alike {
    ($at:ty, $statics:ty) => {
        type At = $at;
        type Statics = $statics;

        fn time(&self) -> f64 {
            Self::time(self)
        }

        fn advance_to(&mut self, time: f64) -> Result<$at, MotionError> {
            Self::advance_to(self, time)
        }

        fn events(&self) -> &[MotionEvent] {
            Self::events(self)
        }

        fn told(&self) -> Told {
            Told {
                statistics: self.statistics(),
                estimate: self.error_estimate(),
                energy_gap: self.energy_gap(),
                warnings: self.warnings(),
                events: Self::events(self).to_vec(),
                state: Self::state(self),
            }
        }

        fn state(&self) -> MotionState {
            Self::state(self)
        }

        fn statics(&self) -> Result<$statics, MotionError> {
            self.quasi_static()
        }
    };
}

impl Moving<2> for Simulation {
    alike!(Instant, QuasiStatic);

    const SHAPE_HEADS: &'static str = MOTION_SHAPE_HEADS;

    fn heads(cables: usize, stations: usize, equilibrium: bool) -> Vec<String> {
        motion_heads(cables, stations, equilibrium)
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

    fn equilibrium(statics: &mut QuasiStatic, at: &Instant, length: f64) -> Vec<f64> {
        equilibrium_numbers(at, statics.tip(at.time).ok(), length).into()
    }

    fn frame(&self, at: &Instant) -> MotionFrame {
        let centreline = Self::shape(self).iter().map(|[_, x, y, _]| [*x, *y]).collect();
        let Instant { time, kinetic_energy, strain_energy, .. } = *at;
        MotionFrame { time, centreline, kinetic_energy, strain_energy }
    }

    fn text(arm: &Arm, at: &Instant, events: &[EventOut], told: &Told, wall: f64) -> String {
        motion_text::in_plane(arm, at, events, told, wall)
    }

    fn strobe(frames: &[MotionFrame], shapes: usize, title: &str, page: &Page) -> Scene {
        strobe_figure(frames, shapes, title, page)
    }
}

impl Moving<3> for SpatialSimulation {
    alike!(SpatialInstant, SpatialQuasiStatic);

    const SHAPE_HEADS: &'static str = SPATIAL_MOTION_SHAPE_HEADS;

    fn heads(cables: usize, stations: usize, equilibrium: bool) -> Vec<String> {
        spatial_motion_heads(cables, stations, equilibrium)
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

    fn equilibrium(statics: &mut SpatialQuasiStatic, at: &SpatialInstant, length: f64) -> Vec<f64> {
        spatial_equilibrium_numbers(at, statics.tip(at.time).ok(), length).into()
    }

    fn frame(&self, at: &SpatialInstant) -> MotionFrame<3> {
        let centreline = Self::shape(self).iter().map(|[_, place @ ..]| *place).collect();
        let SpatialInstant { time, kinetic_energy, strain_energy, .. } = *at;
        MotionFrame { time, centreline, kinetic_energy, strain_energy }
    }

    fn text(arm: &Arm, at: &SpatialInstant, events: &[EventOut], told: &Told, wall: f64) -> String {
        motion_text::in_space(arm, at, events, told, wall)
    }

    fn strobe(frames: &[MotionFrame<3>], shapes: usize, title: &str, page: &Page) -> Scene {
        spatial_strobe_figure(frames, shapes, title, page)
    }
}
