//! The arm in motion: `docs/motion.md` in code.
//!
//! # Design
//!
//! **Time first.** A diagonally implicit Runge-Kutta method (`tableau`) makes velocity, acceleration and strain
//! rate of a stage affine in its unknowns: v = cv q + hv, a = ca q + ha with q = (x, y, theta), and the strains' rate
//! = cv e + he. So every stage is a boundary-value problem along the arm: the static one with x and y as states, and
//! with loads that depend on them. At cv = 0 it is the static one.
//!
//! **The boundary-value problem** (`equations`) has the states (theta, n_f, m_f, x, y). It is written over the static
//! equations' own data, section law, loads and derivatives, and solved by the same collocation, `hydrostat-bvp` with 4
//! Gauss stages: beta' stays exact (a polynomial on each element), cables, ends and elimination are those of the
//! statics, and an arm at rest agrees with the static solver by construction. x and y could be eliminated at the
//! stages, which would leave 16 unknowns an element in place of 24; that would be a second elimination to keep right.
//!
//! **Material with memory of rate** only shifts the section law: C (e - e_o + t_v e.) = C (1 + t_v cv) (e - (e_o -
//! t_v he)/(1 + t_v cv)).
//!
//! **History** (`history`) is what time methods need to know: q, v, a at the stages and nodes of the mesh, strains
//! and their rates at the stages. n_f and m_f have none. At the ends of elements, where beta meets the section law,
//! strain rates follow from the polynomial through the stages.
//!
//! **Steps** (`stepper`): Newton's method from the motion extrapolated through the last three solves, on a fixed
//! mesh. The embedded error of the centreline over all stations decides the step. Steps end at every corner of an
//! input; after a jump of a load, a stream's acceleration or the base's velocity the next one is by an all-implicit
//! method.
//!
//! **Works** (`powers`, `works`) are added up beside the motion by the weights of the time method, so that what is left
//! of the balance of energy says what the steps did to it.
//!
//! **Answers** (`simulation`) are read between the steps by Hermite interpolation, independent of the steps, and
//! given one by one: memory does not grow with the run. A step that fails is halved; if it cannot be done the run
//! ends with a [`MotionVerdict`] that names time and limit, after all before it was given.
//!
//! **Eigenmodes** (`modes`, `small_motions`, `mode_shapes`) are those of the same equations, linearised about
//! an equilibrium.

mod after_snap;
mod along;
mod border;
mod dimensions;
mod eigenvalues;
mod equations;
mod equilibria_in_space;
mod error;
mod event;
mod history;
mod in_plane;
mod in_space;
mod inputs;
mod landing;
mod loading;
mod mode;
mod mode_shapes;
mod modes;
mod modes_in_plane;
mod options;
mod places;
mod powers;
mod pulls;
mod quasi_static;
mod ranged;
mod relaxation;
mod rest;
mod resting;
mod resumed;
mod run;
mod settling;
mod simulation;
mod small_motions;
mod start;
mod state;
mod stepper;
mod strokes;
mod tableau;
mod warning;
mod works;

pub use self::after_snap::{AfterSnap, AfterSnapError, SnapMotion, SpatialSnapMotion};
pub use self::error::{MotionError, MotionVerdict, MotionVerdictKind};
pub use self::event::{MotionEvent, MotionEventKind};
pub use self::in_space::{SpatialInstant, SpatialMotionStation, SpatialQuasiStatic, SpatialSimulation};
pub use self::inputs::{Course, Inputs};
pub use self::landing::Rest;
pub use self::loading::{Loading, LoadingError, LoadingSnap, LoadingStep};
pub use self::mode::Mode;
pub use self::mode_shapes::{ModeSection, ModeShape, ModeStation};
pub use self::modes::Modes;
pub use self::options::{CableMotion, MotionOptions, MotionStatistics};
pub use self::places::MotionStation;
pub use self::quasi_static::QuasiStatic;
pub use self::resting::Restless;
pub use self::simulation::{Instant, Simulation};
pub use self::state::MotionState;
pub use self::warning::MotionWarning;
pub use self::works::Works;
