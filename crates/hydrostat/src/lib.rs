//! The static shape of a soft arm under water.

pub mod arm;
pub mod profile;
pub mod readings;

pub use arm::{
    Arm, ArmError, Base, Cable, Cavity, DistributedLoad, Flow, FlowLaw, Gravity, Material, Reference, TipLoad,
};
pub use profile::{Profile, Sample};
pub use readings::{
    EnteringSpeed, FlowSurface, Hydrostatics, LayerMean, Readings, Support, Volume, WettedLength,
};
