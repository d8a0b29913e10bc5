//! The static shape of a soft arm under water.

pub mod arm;
mod cable;
pub mod cases;
pub mod configuration;
mod dense;
mod engine;
mod equilibrium;
mod flow;
mod loads;
mod path;
pub mod profile;
pub mod readings;
mod real;
mod section;
pub mod solve;
mod swelling;
pub mod verdict;

pub use arm::{
    Arm, ArmError, Base, Cable, Cavity, DistributedLoad, Flow, FlowLaw, Gravity, Material, Reference, TipLoad,
};
pub use configuration::{CableState, Configuration, FoldMargin, Station, Stations, Statistics, Tip, Warning, Wrench};
pub use profile::{Profile, Sample};
pub use readings::{EnteringSpeed, FlowSurface, Hydrostatics, LayerMean, Readings, Support, Volume, WettedLength};
pub use solve::{Options, Solver};
pub use verdict::{NoEquilibrium, Phase, SolveError, Verdict, VerdictKind};
