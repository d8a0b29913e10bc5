//! What is given: geometry, material, cables, support and loads of an arm.
//!
//! SI units; angles in radians. All fields are public: set what you need, then
//! [`Arm::check`] (which every solve calls) says whether it makes an arm.

mod breaks;
mod cable;
mod check;
mod check_space;
mod error;
mod space;

use crate::rod::model_options::ModelOptions;
use crate::rod::profile::Profile;

pub use self::cable::{Cable, Motion};
pub use self::error::ArmError;
pub use self::space::{BaseDirections, Space};

/// A soft arm and everything that acts on it.
///
/// ```
/// use hydrostat::{Arm, Cable, Profile};
///
/// let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
/// arm.flow.speed = 0.1;
/// arm.check().unwrap();
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Arm {
    /// A name for people.
    pub name: String,
    /// Undeformed length L, m.
    pub length: f64,
    /// Undeformed radius R(s), m: the source's X2(s), (3).
    pub radius: Profile,
    /// Radius of the cavity R_in(s), m; zero where the arm is solid.
    pub inner_radius: Profile,
    /// What fills the cavity.
    pub cavity: Cavity,
    /// Density of the wall rho_arm, kg/m3.
    pub density: f64,
    /// Where the arm is held.
    pub base: Base,
    /// Stiffness.
    pub material: Material,
    /// Strains of the unloaded arm.
    pub reference: Reference,
    /// The cables, in the order in which results name them.
    pub cables: Vec<Cable>,
    /// The stream.
    pub flow: Flow,
    /// Gravity in the plane, if any.
    pub gravity: Option<Gravity>,
    /// Loads on the tip.
    pub tip: TipLoad,
    /// Loads along the arm besides water and weight.
    pub distributed: DistributedLoad,
    /// What moves it in time, besides its masses.
    pub dynamics: Dynamics,
    /// Options of the model.
    pub model: ModelOptions,
    /// What takes the arm out of the plane; `None` for an arm in the plane.
    pub space: Option<Space>,
}

/// What the motion of an arm depends on besides its masses. Equilibria do not.
///
/// ```
/// use hydrostat::{Arm, Dynamics};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// // Silicone: 300 Pa s over 110 kPa.
/// arm.dynamics = Dynamics { relaxation_time: 300.0 / 110e3, ..Dynamics::default() };
/// arm.check().unwrap();
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dynamics {
    /// Coefficient C_a of the mass of water that moves along across the arm; 0 turns it off.
    pub added_mass: f64,
    /// Relaxation time t_v of the material (Kelvin-Voigt), s, the same for all strains; 0 turns it off.
    pub relaxation_time: f64,
    /// Whether arm and water have inertia; without it the motion is overdamped.
    pub inertia: bool,
}

impl Default for Dynamics {
    fn default() -> Self {
        Self { added_mass: 1.0, relaxation_time: 0.0, inertia: true }
    }
}

/// What is inside a hollow arm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Cavity {
    /// Water moves in and out: only the wall has weight and displaces water.
    #[default]
    Flooded,
    /// Empty: the whole outline displaces water. An approximation, because the outside pressure,
    /// which would load the wall, is left out.
    Sealed,
}

/// Place and angle of the section at s = 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Base {
    /// m.
    pub x: f64,
    /// m.
    pub y: f64,
    /// rad, from e1.
    pub angle: f64,
}

/// Stiffness of the section law (14): C1 (Pa) against stretch, C2 (Pa) against shear, C3 (N) against bending.
#[derive(Debug, Clone, PartialEq)]
pub enum Material {
    /// One isotropic material throughout:
    /// C1 = E, C2 = shear_factor E / (2 (1 + poisson)), C3 = E (R^2 + R_in^2) / 4.
    Homogeneous {
        /// Young's modulus E, Pa.
        young: f64,
        /// Poisson's ratio.
        poisson: f64,
        /// Timoshenko's shear correction k.
        shear_factor: f64,
    },
    /// The three coefficients themselves.
    Coefficients {
        /// C1, Pa.
        c1: Profile,
        /// C2, Pa.
        c2: Profile,
        /// C3, N.
        c3: Profile,
    },
}

/// Strains nu_o, eta_o (1) and mu_o (1/m) of the unloaded arm, (13).
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Stretch.
    pub nu: Profile,
    /// Shear.
    pub eta: Profile,
    /// Bending, 1/m.
    pub mu: Profile,
}

impl Default for Reference {
    fn default() -> Self {
        Self { nu: 1.0.into(), eta: 0.0.into(), mu: 0.0.into() }
    }
}

/// The stream: free-stream velocity U = speed (cos direction, sin direction).
#[derive(Debug, Clone, PartialEq)]
pub struct Flow {
    /// v_inf, m/s.
    pub speed: f64,
    /// psi, rad, from e1.
    pub direction: f64,
    /// Density of the water rho_w, kg/m3; zero is a vacuum.
    pub density: f64,
    /// h_inf of (7), m. Matters for local velocities, not for forces.
    pub layer_thickness: f64,
    /// How the stream loads the arm.
    pub law: FlowLaw,
}

impl Default for Flow {
    fn default() -> Self {
        Self { speed: 0.0, direction: 0.0, density: 1000.0, layer_thickness: 0.005, law: FlowLaw::Momentum }
    }
}

/// The law that turns the stream into loads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlowLaw {
    /// The source's: change of momentum in control volumes on both sides, (8)-(10).
    Momentum,
    /// Quadratic drag with coefficients.
    QuadraticDrag {
        /// C_n, on the diameter, against the normal speed.
        cn: f64,
        /// C_t, on the perimeter, against the tangential speed.
        ct: f64,
    },
}

/// Gravity in the plane of the arm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity {
    /// m/s2.
    pub acceleration: f64,
    /// rad, from e1; straight down is -pi/2.
    pub direction: f64,
}

impl Default for Gravity {
    fn default() -> Self {
        Self { acceleration: 9.81, direction: -std::f64::consts::FRAC_PI_2 }
    }
}

/// Loads on the tip section.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TipLoad {
    /// Dead force in space, N.
    pub force: [f64; 2],
    /// Moment, N m, counterclockwise.
    pub moment: f64,
    /// Force that turns with the tip section, N, along a(L) and b(L).
    pub follower: [f64; 2],
}

/// Dead loads along the arm, per metre of undeformed length.
#[derive(Debug, Clone, PartialEq)]
pub struct DistributedLoad {
    /// Force along e1 and e2, N/m.
    pub force: [Profile; 2],
    /// Couple, N m/m.
    pub couple: Profile,
}

impl Default for DistributedLoad {
    fn default() -> Self {
        Self { force: [0.0.into(), 0.0.into()], couple: 0.0.into() }
    }
}

impl Arm {
    /// A solid straight cone of one isotropic material (shear factor 1), without cables, in still
    /// water without gravity: `length`, base and tip radius in m, Young's modulus in Pa.
    pub fn cone(length: f64, base_radius: f64, tip_radius: f64, young: f64, poisson: f64) -> Self {
        Self {
            name: "arm".to_owned(),
            length,
            radius: Profile::linear(base_radius, tip_radius),
            inner_radius: 0.0.into(),
            cavity: Cavity::default(),
            density: 1000.0,
            base: Base::default(),
            material: Material::Homogeneous { young, poisson, shear_factor: 1.0 },
            reference: Reference::default(),
            cables: Vec::new(),
            flow: Flow::default(),
            gravity: None,
            tip: TipLoad::default(),
            distributed: DistributedLoad::default(),
            dynamics: Dynamics::default(),
            model: ModelOptions::default(),
            space: None,
        }
    }

    /// Sets all tensions (N), in the order of the cables; no stroke is commanded of them any more.
    ///
    /// # Errors
    /// [`ArmError::TensionCount`] when their number is not that of the cables.
    pub fn set_tensions(&mut self, tensions: &[f64]) -> Result<(), ArmError> {
        if tensions.len() != self.cables.len() {
            return Err(ArmError::TensionCount { cables: self.cables.len(), given: tensions.len() });
        }
        for (cable, tension) in self.cables.iter_mut().zip(tensions) {
            cable.tension = *tension;
            cable.stroke = None;
        }
        Ok(())
    }

    /// Whether bodies, cables and model options of both arms are laid out alike, whatever they are made of and whatever
    /// loads them.
    pub(crate) fn has_geometry_of(&self, other: &Self) -> bool {
        self.length == other.length
            && self.radius == other.radius
            && self.inner_radius == other.inner_radius
            && self.cavity == other.cavity
            && self.reference == other.reference
            && self.model == other.model
            && match (&self.space, &other.space) {
                (Some(own), Some(other)) => own.is_laid_out_as(other),
                (own, other) => own == other,
            }
            && self.cables.len() == other.cables.len()
            && self
                .cables
                .iter()
                .zip(&other.cables)
                .all(|(a, b)| a.offset == b.offset && a.angle == b.angle && a.end == b.end)
    }

    /// The arm with slack cables: no tension, and no stroke commanded.
    ///
    /// ```
    /// use hydrostat::{Arm, Cable};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.cables.push(Cable::new("left", 0.001).pulled(0.3));
    /// assert_eq!(arm.slackened().cables[0].tension, 0.0);
    /// ```
    #[must_use]
    pub fn slackened(&self) -> Self {
        let mut out = self.clone();
        for cable in &mut out.cables {
            (cable.tension, cable.stroke) = (0.0, None);
        }
        out
    }

    /// The arm with nothing that loads it: slack cables ([`Arm::slackened`]), still water, no weight, no load on the
    /// tip or along the arm.
    ///
    /// ```
    /// use hydrostat::{Arm, Cable};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.cables.push(Cable::new("left", 0.001).reeled_in(0.01));
    /// arm.flow.speed = 0.3;
    /// let tip = arm.unloaded().solve()?.tip();
    /// assert!((tip.x - 0.245).abs() < 1e-9 && tip.y.abs() < 1e-9);
    /// # Ok::<(), hydrostat::SolveError>(())
    /// ```
    #[must_use]
    pub fn unloaded(&self) -> Self {
        let mut out = self.slackened();
        out.flow.speed = 0.0;
        out.gravity = None;
        out.tip = TipLoad::default();
        out.distributed = DistributedLoad::default();
        if let Some(space) = &mut out.space {
            space.unload();
        }
        out
    }

    /// C1 A0 and C2 A0 (N) and C3 A0 (N m2) of the section at `s` (m), as it is before anything acts.
    ///
    /// ```
    /// use hydrostat::Arm;
    ///
    /// let [ea, ga, ei] = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5).stiffness_at(0.0);
    /// let area = std::f64::consts::PI * 0.010 * 0.010;
    /// assert!((ea / (110e3 * area) - 1.0).abs() < 1e-12);
    /// assert!((ga / (ea / 3.0) - 1.0).abs() < 1e-12);
    /// assert!((ei / (110e3 * area * 0.010 * 0.010 / 4.0) - 1.0).abs() < 1e-12);
    /// ```
    pub fn stiffness_at(&self, s: f64) -> [f64; 3] {
        let at = |profile: &Profile| profile.at(s, self.length).value;
        let (square, inner) = (at(&self.radius).powi(2), at(&self.inner_radius).powi(2));
        let coefficients = match &self.material {
            Material::Homogeneous { young, poisson, shear_factor } => {
                [*young, shear_factor * young / (2.0 * (1.0 + poisson)), 0.25 * young * (square + inner)]
            }
            Material::Coefficients { c1, c2, c3 } => [at(c1), at(c2), at(c3)],
        };
        coefficients.map(|c| c * std::f64::consts::PI * (square - inner))
    }

    /// Whether a cable that may be pulled has friction in its channel.
    pub(crate) fn has_friction(&self) -> bool {
        self.cables.iter().any(|c| c.friction > 0.0)
    }

    /// Whether a cable's tension follows from its stroke.
    pub(crate) fn is_commanded(&self) -> bool {
        self.cables.iter().any(|c| c.stroke.is_some())
    }

    /// The free-stream velocity U, m/s.
    pub fn stream(&self) -> [f64; 2] {
        let (sin, cos) = self.flow.direction.sin_cos();
        [self.flow.speed * cos, self.flow.speed * sin]
    }
}
