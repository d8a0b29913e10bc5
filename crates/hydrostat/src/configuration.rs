//! The answer: the arm's shape and what it carries.

use crate::arm::Arm;

/// The static configuration of an arm.
#[derive(Debug, Clone)]
pub struct Configuration {
    /// The arm with the loads that this configuration balances.
    pub arm: Arm,
    /// The mesh nodes, base to tip; the end of a cable appears twice, with the values on either side.
    pub stations: Stations,
    /// One entry a cable, in the arm's order.
    pub cables: Vec<CableState>,
    /// What support and cable anchors exert on the arm at the base: force in space (N) and moment
    /// about r(0) (N m).
    pub base_reaction: Wrench,
    /// With [`Support::UnstrainedBase`](crate::Support::UnstrainedBase): n_f(L), m_f(L) less the tip loads.
    pub unmet: Option<Wrench>,
    /// Estimated error of the tip position, m.
    pub error_estimate: f64,
    /// `Some(false)`: unstable. `Some(true)`: stable against static divergence. `None`: not established.
    pub stable: Option<bool>,
    /// What the solve took.
    pub statistics: Statistics,
}

/// A force (N, in space) and a moment (N m).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wrench {
    /// Force along e1, e2, N.
    pub force: [f64; 2],
    /// Moment, N m, counterclockwise.
    pub moment: f64,
}

/// State at one place of the arm.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Station {
    /// Reference arc length, m.
    pub s: f64,
    /// Centreline, m.
    pub x: f64,
    /// Centreline, m.
    pub y: f64,
    /// Section rotation, rad, continuous along the arm.
    pub theta: f64,
    /// Stretch.
    pub nu: f64,
    /// Shear strain.
    pub eta: f64,
    /// Bending strain, 1/m.
    pub mu: f64,
    /// Section stretch.
    pub beta: f64,
    /// Slope of the section stretch, 1/m.
    pub beta_slope: f64,
    /// Angle from section normal to centreline tangent, rad.
    pub alpha: f64,
    /// Contact force along a, N.
    pub n_a: f64,
    /// Contact force along b, N.
    pub n_b: f64,
    /// Contact moment, N m.
    pub m: f64,
}

/// Many [`Station`]s, one array a field (units as there).
#[derive(Debug, Clone, PartialEq, Default)]
#[allow(missing_docs, reason = "the fields are those of `Station`")]
pub struct Stations {
    pub s: Vec<f64>,
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub theta: Vec<f64>,
    pub nu: Vec<f64>,
    pub eta: Vec<f64>,
    pub mu: Vec<f64>,
    pub beta: Vec<f64>,
    pub alpha: Vec<f64>,
    pub n_a: Vec<f64>,
    pub n_b: Vec<f64>,
    pub m: Vec<f64>,
}

/// A cable in a configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct CableState {
    /// Its name.
    pub name: String,
    /// Tension, N.
    pub tension: f64,
    /// Length of its path from base to anchor, m.
    pub length: f64,
    /// Length at the reference strains less present length, m: positive when reeled in.
    pub stroke: f64,
}

/// The tip.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tip {
    /// m.
    pub x: f64,
    /// m.
    pub y: f64,
    /// rad.
    pub theta: f64,
    /// rad.
    pub alpha: f64,
}

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
    /// A sealed cavity, whose outside pressure is left out.
    SealedCavity,
    /// The answer hangs on the tangential load of the source's momentum law.
    TangentialLoad {
        /// How far the tip would move, over L, with a published tangential coefficient.
        tip_shift: f64,
    },
}

impl Warning {
    /// The name in results: `surface_fold` and so on.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::SurfaceFold { .. } => "surface_fold",
            Self::StrainRange { .. } => "strain_range",
            Self::SealedCavity => "sealed_cavity",
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
                "the stretch nu = {nu:.3} at s = {s:.4} m is outside [0.5, 1.5], beyond what a linear law can mean"
            ),
            Self::SealedCavity => {
                "the cavity is sealed: the pressure of the water outside, which would load the wall, is left out"
                    .to_owned()
            }
            Self::TangentialLoad { tip_shift } => format!(
                "the shape hangs on the tangential load of the momentum law (C_t = 4/9; published arms have 0.005 to 0.03): \
                 with C_t = 0.03 the tip would move by about {tip_shift:.3} of the length"
            ),
        }
    }
}

/// What a solve took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Elements of the final mesh.
    pub elements: usize,
    /// Collocation stages an element.
    pub stages: usize,
    /// Newton rounds, all meshes together.
    pub newton_rounds: usize,
    /// Meshes used.
    pub meshes: usize,
    /// Load steps of the ramp; zero when the direct solve was enough.
    pub load_steps: usize,
    /// Section laws and loads evaluated (one a station a round).
    pub evaluations: usize,
}

impl Stations {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.s.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.s.is_empty()
    }

    pub(crate) fn push(&mut self, station: &Station) {
        self.s.push(station.s);
        self.x.push(station.x);
        self.y.push(station.y);
        self.theta.push(station.theta);
        self.nu.push(station.nu);
        self.eta.push(station.eta);
        self.mu.push(station.mu);
        self.beta.push(station.beta);
        self.alpha.push(station.alpha);
        self.n_a.push(station.n_a);
        self.n_b.push(station.n_b);
        self.m.push(station.m);
    }
}

impl Configuration {
    /// Where the tip is.
    pub fn tip(&self) -> Tip {
        let last = |v: &[f64]| v.last().copied().unwrap_or_default();
        Tip {
            x: last(&self.stations.x),
            y: last(&self.stations.y),
            theta: last(&self.stations.theta),
            alpha: last(&self.stations.alpha),
        }
    }
}
