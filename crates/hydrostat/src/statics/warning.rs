//! What should be known about an answer that was found.

use crate::statics::snap::Snap;

/// The largest tangential drag coefficient that is published for such arms.
pub(crate) const PUBLISHED_CT: f64 = 0.03;

/// Something the user should know about an answer that was found.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// The surface folds over itself: nu <= beta R |mu| somewhere.
    SurfaceFold {
        /// min over s of (nu - beta R |mu|) / nu.
        margin: f64,
        /// Where, m.
        s: f64,
    },
    /// Stretch beyond what a linear law can mean.
    StrainRange {
        /// The worst nu.
        nu: f64,
        /// Where, m.
        s: f64,
    },
    /// The commanded stroke of a cable takes more tension than it may have.
    TensionAboveMax {
        /// Its name.
        cable: String,
        /// Its tension, N.
        tension: f64,
        /// Its `max_tension`, N.
        max: f64,
    },
    /// A sealed cavity, whose outside pressure is left out.
    SealedCavity,
    /// The arm snaps on the way to its loads, no further than [`crate::Options::snaps`] lets it.
    Snap(Snap),
    /// The answer depends strongly on the tangential load of the source's momentum law.
    TangentialLoad {
        /// C_t that the law corresponds to along the stream: 4/9, or 8/15 with [`crate::LayerMean::Momentum`].
        ct: f64,
        /// How far the tip would move, over L, if the tangential load were 0.03/C_t of what it is: 0.03 is the largest
        /// coefficient published.
        tip_shift: f64,
    },
}

impl Warning {
    /// The name in results: `surface_fold` and so on.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::SurfaceFold { .. } => "surface_fold",
            Self::StrainRange { .. } => "strain_range",
            Self::TensionAboveMax { .. } => "tension_above_max",
            Self::SealedCavity => "sealed_cavity",
            Self::Snap(_) => "snap",
            Self::TangentialLoad { .. } => "tangential_load",
        }
    }

    /// The warning in a sentence.
    pub fn message(&self) -> String {
        match self {
            Self::SurfaceFold { margin, s } => {
                format!("the surface folds over itself at s = {s:.4} m: (nu - beta R |mu|)/nu is {margin:.3} there")
            }
            Self::StrainRange { nu, s } => format!(
                "the stretch nu = {nu:.3} at s = {s:.4} m is outside [0.5, 1.5], the range of a linear section law"
            ),
            Self::TensionAboveMax { cable, tension, max } => {
                format!(
                    "the commanded stroke of cable `{cable}` needs {tension:.4} N, more than its max_tension of {max} N"
                )
            }
            Self::SealedCavity => {
                "the cavity is sealed: the pressure of the outside water on the wall is left out".to_owned()
            }
            Self::Snap(snap) => snap.message(),
            Self::TangentialLoad { ct, tip_shift } => format!(
                "the shape depends strongly on the tangential load of the momentum law (C_t = {ct:.3} along the stream; published values for \
                 arms are 0.005 to {PUBLISHED_CT}): with C_t = {PUBLISHED_CT} the tip would move by about {tip_shift:.3} of the arm's length"
            ),
        }
    }
}
