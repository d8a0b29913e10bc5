//! The static shape of a soft arm under water: a planar Cosserat rod, driven by cables, whose
//! section widens under compression so that the volume is kept, in a stream, with weight and buoyancy.
//!
//! SI units throughout, angles in radians. The arm is straight and along e1 before anything acts;
//! `s` in [0, L] is the length along it, from base to tip; left is the side of positive y. Numbers
//! in brackets, (5), are equations of the source, "Quasi-static continuum model of octopus arm
//! configuration under water".
//!
//! # A tour
//!
//! An [`Arm`] holds geometry, material and loads; [`Arm::solve`] finds its [`Configuration`]:
//!
//! ```
//! use hydrostat::{Arm, Cable, Profile};
//!
//! # fn main() -> Result<(), hydrostat::SolveError> {
//! // A silicone cone: 245 mm long, radius 10 mm at the base and 2 mm at the tip, E = 110 kPa.
//! let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
//! arm.density = 1080.0; // kg/m3
//! arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.2)); // N
//! arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
//! arm.flow.speed = 0.1; // m/s, along e1
//!
//! let shape = arm.solve()?;
//! let tip = shape.tip();
//! println!("tip at ({:.4}, {:.4}) m, turned by {:.1} deg", tip.x, tip.y, tip.theta.to_degrees());
//! assert!(tip.y > 0.0, "it bends to the side of the pulled cable");
//! assert!(shape.error_estimate < 1e-8 * arm.length);
//! # Ok(())
//! # }
//! ```
//!
//! ## What a configuration holds
//!
//! [`Configuration::stations`] are the nodes of the solver's mesh, closer where the shape changes
//! fast; [`Configuration::at`] gives the same anywhere, to the accuracy of the nodes, and
//! [`Configuration::resampled`] at equal spacing.
//!
//! ```
//! # use hydrostat::{Arm, Cable, Profile};
//! # let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
//! # arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.2));
//! # arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
//! # arm.flow.speed = 0.1;
//! let shape = arm.solve()?;
//!
//! // Nodes: one array per field.
//! let st = &shape.stations;
//! assert_eq!(st.s.len(), st.alpha.len());
//! assert_eq!((st.s[0], st.x[0], st.y[0]), (0.0, 0.0, 0.0));
//!
//! // Anywhere: strains, section stretch and what the body carries.
//! let middle = shape.at(0.1225); // m
//! assert!((middle.beta * middle.nu - 1.0).abs() < 1e-12, "planar: beta = 1/nu");
//! let force = middle.n_a.hypot(middle.n_b); // N
//! assert!(force > 0.0);
//!
//! // The outline and the cables, for a drawing.
//! let [left, right] = shape.surfaces(0.1225);
//! let cable = shape.cable_point(0, 0.1225).expect("the cable runs to the tip");
//! let to = |p: [f64; 2]| (p[0] - middle.x).hypot(p[1] - middle.y);
//! assert!((to(left) - to(right)).abs() < 1e-12 && to(cable) < to(left));
//!
//! // The stroke of each cable, and the base reaction.
//! assert!(shape.cables[0].stroke > 0.0 && shape.cables[1].stroke < shape.cables[0].stroke);
//! println!("base reaction {:?} N, {} N m", shape.base_reaction.force, shape.base_reaction.moment);
//!
//! // Limits of the model that the answer is near: a folding surface, strains outside the linear range, ...
//! for warning in shape.warnings() {
//!     println!("{}: {}", warning.kind(), warning.message());
//! }
//! # Ok::<(), hydrostat::SolveError>(())
//! ```
//!
//! ## Other loads, readings and tolerances
//!
//! Every field of an arm is public, and so are weight, tip loads and loads along the arm. Where the
//! source leaves a point open, [`ModelOptions`] selects the reading that is solved.
//!
//! ```
//! use hydrostat::{Arm, Gravity, Options, ModelOptions, Solver, Volume};
//!
//! let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
//! arm.density = 1080.0; // in still water of 1000 kg/m3: it sinks a little
//! arm.gravity = Some(Gravity::default()); // 9.81 m/s2 along -e2
//! arm.tip.force = [0.0, 1e-3]; // N, dead: keeps its direction
//! arm.model = ModelOptions { volume: Volume::Circular, ..ModelOptions::default() };
//!
//! // Another tolerance: error of the tip over L, from 1e-12 to 1e-2.
//! let shape = Solver::new(&arm, Options::with_tol(1e-6))?.solve()?;
//! // The support carries the weight less the buoyancy less the tip load. A circular section keeps
//! // its volume, so that the buoyancy is that of the unloaded cone.
//! let volume = std::f64::consts::PI * 0.2 / 3.0 * (0.010_f64.powi(2) + 0.010 * 0.002 + 0.002_f64.powi(2));
//! let excess = (1080.0 - 1000.0) * volume * 9.81;
//! assert!((shape.base_reaction.force[1] - (excess - 1e-3)).abs() < 1e-8);
//! # Ok::<(), hydrostat::SolveError>(())
//! ```
//!
//! ## No answer
//!
//! Not every arm has an equilibrium. A strong pull compresses the cable's side of a soft tip to zero
//! length; a stream against the arm makes it snap. Then the error is a [`Verdict`]: the kind of limit, the
//! fraction of the loads at which it was met (first all loads but the cables', then the tensions), the
//! place along the arm, and the last good configuration before it.
//!
//! ```
//! use hydrostat::{Arm, Cable, Phase, Profile, SolveError, VerdictKind};
//!
//! let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
//! arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(1.5)); // N: too much
//!
//! let Err(SolveError::NoEquilibrium(no)) = arm.solve() else { panic!("1.5 N are too much") };
//! assert_eq!(no.verdict.kind, VerdictKind::CableFold);
//! assert_eq!(no.verdict.phase, Phase::Tension);
//! println!("{}; {}", no.verdict.message(), no.verdict.advice());
//!
//! // The last good shape carries its own loads: the tension just below the limit.
//! let last = no.last_good.expect("most of the pull can be carried");
//! let tension = last.arm.cables[0].tension;
//! assert!((tension / 1.5 - no.verdict.load_fraction).abs() < 1e-3);
//! assert!(0.9 < tension && tension < 1.0);
//! ```
//!
//! # What is not in the model
//!
//! Equilibria are quasi-static; [`motion`] has the arm in time, in the plane. An arm in space ([`Arm::space`]) has a
//! solver of its own, [`SpatialSolver`], with derivatives, paths ([`Arm::path_in_space`]) and tensions for a place
//! ([`Arm::reach_in_space`]); everything else is for arms in the plane. The section law is linear in the strains.
//! Cables act by their tension alone: they do not press into the material. Contact of the arm with itself is not
//! detected; [`Configuration::fold_margin`] is about the surface of a single section. The outside pressure on the
//! wall of a sealed cavity is left out. The tangential load of the source's flow law corresponds to C_t = 4/9;
//! published coefficients of arms are 0.005 to 0.03. An answer that depends strongly on this load carries a
//! [`Warning::TangentialLoad`]; [`FlowLaw::QuadraticDrag`] is the alternative.

pub mod cases;
mod inverse;
pub mod motion;
mod numerics;
mod rod;
pub mod spatial;
mod statics;

pub use inverse::reach;
pub use rod::{arm, model_options, parameter, profile};
pub use statics::{configuration, many, path, row, sensitivity, snap, solve, stability, verdict, warm_start};

pub use arm::{
    Arm, ArmError, Base, BaseDirections, Cable, Cavity, DistributedLoad, Dynamics, Flow, FlowLaw, Gravity, Material,
    Motion, Reference, Space, TipLoad,
};
pub use configuration::{
    CableState, Command, Configuration, FoldMargin, Station, Stations, Statistics, Tip, Warning, Wrench,
};
pub use many::{ManyOptions, NoRow, RowSolver, Rows, solve_many};
pub use model_options::{
    Displaced, EnteringSpeed, FlowSurface, Hydrostatics, LayerMean, ModelOptions, Support, Volume, WettedLength,
};
pub use motion::{
    AfterSnap, AfterSnapError, CableMotion, Course, Inputs, Instant, Loading, LoadingError, LoadingSnap, LoadingStep,
    Mode, ModeSection, ModeShape, ModeStation, Modes, MotionError, MotionEvent, MotionEventKind, MotionOptions,
    MotionState, MotionStation, MotionStatistics, MotionVerdict, MotionVerdictKind, MotionWarning, QuasiStatic, Rest,
    Restless, Simulation, SnapMotion, SpatialInstant, SpatialMotionStation, SpatialQuasiStatic, SpatialSimulation,
    SpatialSnapMotion, Works,
};
pub use numerics::dispatch::has_wide_vectors;
pub use parameter::Parameter;
pub use path::{Branch, Equilibria, Equilibrium, Event, Path, PathEnd, PathError, PathOptions, PathPoint};
pub use profile::{Join, Point, Profile, Sample, TableError};
pub use reach::{
    Bound, Boundary, BoundaryKind, BoundaryOptions, BoundaryPiece, BoundaryPoint, BoundaryProgress, Followed, Follower,
    Reach, ReachError, ReachOptions, Reached, SpatialFollower, SpatialTarget, Target,
};
pub use row::{Row, Wanted};
pub use sensitivity::{
    Ellipse, PoseChange, SensitiveStation, Sensitivities, SensitivityError, SensitivityMethod, SensitivityOptions,
};
pub use snap::{Snap, SnapBounds};
pub use solve::{Answer, Options, Solver};
pub use spatial::{
    Ellipsoid, NoSpatialEquilibrium, SpatialConfiguration, SpatialEquilibria, SpatialError, SpatialPoseChange,
    SpatialRow, SpatialSnap, SpatialSolver, SpatialStation, SpatialStations, SpatialTip, SpatialWrench,
    solve_many_in_space,
};
pub use stability::{Growth, Stability};
pub use statics::shape::Pose;
pub use verdict::{NoEquilibrium, Phase, SolveError, Verdict, VerdictKind};
pub use warm_start::WarmStart;
