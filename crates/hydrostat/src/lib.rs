//! The static shape of a soft arm under water.

pub mod arm;
mod cable;
pub mod configuration;
mod equilibrium;
mod flow;
mod loads;
mod real;
mod section;
mod solve;
mod swelling;
pub mod profile;
pub mod readings;
pub mod verdict;

pub use arm::{
    Arm, ArmError, Base, Cable, Cavity, DistributedLoad, Flow, FlowLaw, Gravity, Material, Reference, TipLoad,
};
pub use configuration::{CableState, Configuration, Station, Stations, Statistics, Tip, Warning, Wrench};
pub use profile::{Profile, Sample};
pub use readings::{EnteringSpeed, FlowSurface, Hydrostatics, LayerMean, Readings, Support, Volume, WettedLength};
pub use verdict::{NoEquilibrium, Phase, SolveError, Verdict, VerdictKind};
