//! What is given: geometry, material, cables, support and loads of an arm.
//!
//! SI units; angles in radians. All fields are public: set what you need, then
//! [`Arm::check`] (which every solve calls) says whether it makes an arm.

mod breaks;

use crate::profile::{Profile, TableError};
use crate::readings::Readings;

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
    /// Options of the model.
    pub readings: Readings,
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

/// A longitudinal cable.
#[derive(Debug, Clone, PartialEq)]
pub struct Cable {
    /// A name for people.
    pub name: String,
    /// Signed offset y(s) in the straight arm, left positive, m.
    pub offset: Profile,
    /// Tension T >= 0, N. With a commanded stroke it follows from that, and what is given here does not count.
    pub tension: f64,
    /// Commanded stroke, m: the length that is reeled in, of the cable's length at the reference strains; negative when
    /// paid out. See [`crate::configuration::Command`].
    pub stroke: Option<f64>,
    /// Stiffness EA, N, of an elastic cable; `None` when it does not stretch. Matters only with a commanded stroke.
    pub stiffness: Option<f64>,
    /// Coefficient of friction against its channel; 0 slides freely. With it, the tension given is that at the base.
    pub friction: f64,
    /// Which way a cable with friction slid last.
    pub motion: Motion,
    /// The largest tension that makes sense, N, if stated.
    pub max_tension: Option<f64>,
    /// Where it is anchored, as a fraction of the length in (0, 1].
    pub end: f64,
}

/// Which way a cable slides through its channel, which decides where friction takes from its tension.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Motion {
    /// Reeled in at the base: the tension falls towards the tip.
    #[default]
    In,
    /// Paid out: it rises.
    Out,
}

impl Cable {
    /// A slack cable that runs to the tip.
    pub fn new(name: impl Into<String>, offset: impl Into<Profile>) -> Self {
        Self {
            name: name.into(),
            offset: offset.into(),
            tension: 0.0,
            stroke: None,
            stiffness: None,
            friction: 0.0,
            motion: Motion::In,
            max_tension: None,
            end: 1.0,
        }
    }

    /// This cable pulled with `tension` (N).
    pub fn pulled(mut self, tension: f64) -> Self {
        self.tension = tension;
        self
    }

    /// This cable reeled in by `stroke` (m), at whatever tension that takes.
    pub fn reeled_in(mut self, stroke: f64) -> Self {
        self.stroke = Some(stroke);
        self
    }

    /// This cable with a coefficient of friction against its channel, having slid in or out.
    pub fn rubbing(mut self, friction: f64, motion: Motion) -> Self {
        self.friction = friction;
        self.motion = motion;
        self
    }

    /// This cable anchored at the fraction `end` of the length.
    pub fn ending_at(mut self, end: f64) -> Self {
        self.end = end;
        self
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

/// What keeps numbers from being an arm. `key` is the dotted path that the arm file uses.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ArmError {
    /// NaN or infinite.
    #[error("`{key}` is not a finite number")]
    NotFinite {
        /// Which quantity.
        key: String,
    },
    /// Zero or below where only above zero makes sense.
    #[error("`{key}` must be above zero{place}, found {value}", place = at(*.s))]
    NotPositive {
        /// Which quantity.
        key: String,
        /// What it is.
        value: f64,
        /// Where along the arm, m, if it varies.
        s: Option<f64>,
    },
    /// Below zero.
    #[error("`{key}` must not be negative, found {value}")]
    Negative {
        /// Which quantity.
        key: String,
        /// What it is.
        value: f64,
    },
    /// Outside an interval.
    #[error("`{key}` must be {expected}, found {value}")]
    OutOfRange {
        /// Which quantity.
        key: String,
        /// What it is.
        value: f64,
        /// The interval, in words.
        expected: &'static str,
    },
    /// The cavity reaches the surface.
    #[error("`arm.inner_radius` must stay below `arm.radius`: {inner} m against {outer} m at s = {s} m")]
    InnerRadius {
        /// Where, m.
        s: f64,
        /// R_in there, m.
        inner: f64,
        /// R there, m.
        outer: f64,
    },
    /// A cable outside the section.
    #[error("`{key}` leaves the section: {offset} m at s = {s} m, where the radius is {radius} m")]
    OffsetOutside {
        /// Which cable offset.
        key: String,
        /// Where, m.
        s: f64,
        /// The offset there, m.
        offset: f64,
        /// The radius there, m.
        radius: f64,
    },
    /// A tension above the stated largest one.
    #[error("`{key}` is {tension} N, above its max_tension of {max_tension} N")]
    TensionAboveMax {
        /// Which tension.
        key: String,
        /// N.
        tension: f64,
        /// N.
        max_tension: f64,
    },
    /// A table that does not run from base to tip.
    #[error("the table `{key}` must run from s = 0 to the length {length} m, it runs from {from} to {to} m")]
    TableDoesNotCover {
        /// Which profile.
        key: String,
        /// Its first place, m.
        from: f64,
        /// Its last place, m.
        to: f64,
        /// The arm's length, m.
        length: f64,
    },
    /// Points that do not make a table.
    #[error("`{key}`: {source}")]
    Table {
        /// Which profile.
        key: String,
        /// Why.
        source: TableError,
    },
    /// More places at which tables have points and cables end than meshes have room for.
    #[error("`{key}`: tables have points and cables end at {found} places, an arm like this may have {most}")]
    TooManyBreaks {
        /// The longest table.
        key: String,
        /// How many places.
        found: usize,
        /// The most with as many cables.
        most: usize,
    },
    /// A number of tensions that is not the number of cables.
    #[error(
        "the arm has {cables} cable{}, {given} tension{} given",
        if *.cables == 1 { "" } else { "s" },
        if *.given == 1 { " was" } else { "s were" }
    )]
    TensionCount {
        /// Cables of the arm.
        cables: usize,
        /// Tensions given.
        given: usize,
    },
}

impl ArmError {
    /// The dotted key that is wrong, as in the arm file.
    pub fn key(&self) -> &str {
        match self {
            Self::NotFinite { key }
            | Self::NotPositive { key, .. }
            | Self::Negative { key, .. }
            | Self::OutOfRange { key, .. }
            | Self::OffsetOutside { key, .. }
            | Self::TensionAboveMax { key, .. }
            | Self::TableDoesNotCover { key, .. }
            | Self::TooManyBreaks { key, .. }
            | Self::Table { key, .. } => key,
            Self::InnerRadius { .. } => "arm.inner_radius",
            Self::TensionCount { .. } => "cable",
        }
    }
}

fn at(s: Option<f64>) -> String {
    s.map_or_else(String::new, |s| format!(" (at s = {s} m)"))
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
            readings: Readings::default(),
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

    /// What [`Arm::set_tensions`] and [`Arm::check`] would say to these tensions, without a word where they are fine.
    pub(crate) fn check_tensions(&self, tensions: &[f64]) -> Result<(), ArmError> {
        if tensions.len() != self.cables.len() {
            return Err(ArmError::TensionCount { cables: self.cables.len(), given: tensions.len() });
        }
        for (i, (cable, &tension)) in self.cables.iter().zip(tensions).enumerate() {
            self.check_tension(i, cable, tension)?;
        }
        Ok(())
    }

    /// Whether bodies, cables and readings of both arms are laid out alike, whatever they are made of and whatever loads them.
    pub(crate) fn has_geometry_of(&self, other: &Self) -> bool {
        self.length == other.length
            && self.radius == other.radius
            && self.inner_radius == other.inner_radius
            && self.cavity == other.cavity
            && self.reference == other.reference
            && self.readings == other.readings
            && self.cables.len() == other.cables.len()
            && self.cables.iter().zip(&other.cables).all(|(a, b)| a.offset == b.offset && a.end == b.end)
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

    /// Whether a cable that may be pulled rubs in its channel.
    pub(crate) fn rubs(&self) -> bool {
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

    /// Says whether these numbers make an arm.
    ///
    /// # Errors
    /// The first thing that is wrong, with its key and its numbers.
    pub fn check(&self) -> Result<(), ArmError> {
        let length = positive("arm.length", self.length)?;
        self.check_breaks()?;
        self.radius.check("arm.radius", length)?;
        self.inner_radius.check("arm.inner_radius", length)?;
        self.check_sections(length)?;
        not_negative("arm.density", self.density)?;
        finite("arm.base.x", self.base.x)?;
        finite("arm.base.y", self.base.y)?;
        finite("arm.base.angle", self.base.angle)?;
        self.check_material(length)?;
        self.reference.eta.check("reference.eta", length)?;
        self.reference.mu.check("reference.mu", length)?;
        positive_profile("reference.nu", &self.reference.nu, length)?;
        for (i, cable) in self.cables.iter().enumerate() {
            self.check_cable(i, cable, length)?;
        }
        self.check_flow()?;
        self.check_weight_and_tip()?;
        self.distributed.force[0].check("distributed.force[0]", length)?;
        self.distributed.force[1].check("distributed.force[1]", length)?;
        self.distributed.couple.check("distributed.couple", length)
    }

    fn check_sections(&self, length: f64) -> Result<(), ArmError> {
        positive_profile("arm.radius", &self.radius, length)?;
        let (lowest, _) = self.inner_radius.range(length, length);
        not_negative("arm.inner_radius", lowest)?;
        if self.inner_radius.is_zero() {
            return Ok(());
        }
        for s in self.places(&[&self.radius, &self.inner_radius], length) {
            let (inner, outer) = (self.inner_radius.at(s, length).value, self.radius.at(s, length).value);
            if inner >= outer {
                return Err(ArmError::InnerRadius { s, inner, outer });
            }
        }
        Ok(())
    }

    fn check_material(&self, length: f64) -> Result<(), ArmError> {
        match &self.material {
            Material::Homogeneous { young, poisson, shear_factor } => {
                positive("material.young", *young)?;
                finite("material.poisson", *poisson)?;
                if !(*poisson > -1.0 && *poisson <= 0.5) {
                    let expected = "above -1 and at most 0.5";
                    return Err(ArmError::OutOfRange { key: "material.poisson".to_owned(), value: *poisson, expected });
                }
                positive("material.shear_factor", *shear_factor)?;
            }
            Material::Coefficients { c1, c2, c3 } => {
                for (key, c) in [("material.c1", c1), ("material.c2", c2), ("material.c3", c3)] {
                    positive_profile(key, c, length)?;
                }
            }
        }
        Ok(())
    }

    fn check_cable(&self, index: usize, cable: &Cable, length: f64) -> Result<(), ArmError> {
        let key = |name: &str| format!("cable[{index}].{name}");
        cable.offset.check(&key("offset"), length)?;
        not_negative(&key("tension"), cable.tension)?;
        if let Some(stroke) = cable.stroke {
            finite(&key("stroke"), stroke)?;
            if stroke.abs() >= length {
                let expected = "shorter than the arm";
                return Err(ArmError::OutOfRange { key: key("stroke"), value: stroke, expected });
            }
        }
        not_negative(&key("friction"), cable.friction)?;
        if cable.friction > 2.0 {
            let expected = "in [0, 2]";
            return Err(ArmError::OutOfRange { key: key("friction"), value: cable.friction, expected });
        }
        if let Some(stiffness) = cable.stiffness {
            positive(&key("stiffness"), stiffness)?;
        }
        if let Some(max_tension) = cable.max_tension {
            positive(&key("max_tension"), max_tension)?;
            if cable.tension > max_tension && cable.stroke.is_none() {
                return Err(ArmError::TensionAboveMax { key: key("tension"), tension: cable.tension, max_tension });
            }
        }
        finite(&key("end"), cable.end)?;
        if !(cable.end > 0.0 && cable.end <= 1.0) {
            return Err(ArmError::OutOfRange { key: key("end"), value: cable.end, expected: "in (0, 1]" });
        }
        for s in self.places(&[&self.radius, &cable.offset], cable.end * length) {
            let (offset, radius) = (cable.offset.at(s, length).value, self.radius.at(s, length).value);
            if offset.abs() > radius * (1.0 + 1e-12) {
                return Err(ArmError::OffsetOutside { key: key("offset"), s, offset, radius });
            }
        }
        Ok(())
    }

    /// Tensions, stream, weight and tip loads of an arm whose other numbers were checked.
    pub(crate) fn check_loads(&self) -> Result<(), ArmError> {
        for (i, cable) in self.cables.iter().enumerate() {
            self.check_tension(i, cable, cable.tension)?;
        }
        self.check_flow()?;
        self.check_weight_and_tip()
    }

    /// A tension of cable `i`; keys are only written where they are needed.
    fn check_tension(&self, i: usize, cable: &Cable, tension: f64) -> Result<(), ArmError> {
        let fine = tension >= 0.0 && tension.is_finite() && cable.max_tension.is_none_or(|most| tension <= most);
        if fine { Ok(()) } else { self.check_cable(i, &Cable { tension, stroke: None, ..cable.clone() }, self.length) }
    }

    fn check_weight_and_tip(&self) -> Result<(), ArmError> {
        if let Some(gravity) = &self.gravity {
            not_negative("gravity.acceleration", gravity.acceleration)?;
            finite("gravity.direction", gravity.direction)?;
        }
        for v in self.tip.force {
            finite("tip.force", v)?;
        }
        finite("tip.moment", self.tip.moment)?;
        for v in self.tip.follower {
            finite("tip.follower", v)?;
        }
        Ok(())
    }

    pub(crate) fn check_flow(&self) -> Result<(), ArmError> {
        not_negative("flow.speed", self.flow.speed)?;
        finite("flow.direction", self.flow.direction)?;
        not_negative("flow.density", self.flow.density)?;
        positive("flow.layer_thickness", self.flow.layer_thickness)?;
        if let FlowLaw::QuadraticDrag { cn, ct } = self.flow.law {
            not_negative("flow.cn", cn)?;
            not_negative("flow.ct", ct)?;
        }
        Ok(())
    }

    /// Where two profiles are compared on [0, upto]: at all knots, and densely between them when
    /// one is a cubic (two straight lines need their ends only).
    fn places(&self, profiles: &[&Profile], upto: f64) -> Vec<f64> {
        let mut at = vec![0.0, upto];
        if profiles.iter().any(|p| matches!(p, Profile::Table(_))) {
            for p in profiles {
                at.extend(p.knots().iter().copied().filter(|s| *s < upto));
            }
            at.sort_by(f64::total_cmp);
            let between: Vec<f64> =
                at.windows(2).flat_map(|w| (1..16).map(move |k| w[0] + (w[1] - w[0]) * f64::from(k) / 16.0)).collect();
            at.extend(between);
        }
        debug_assert!(upto <= self.length * (1.0 + 1e-12));
        at
    }
}

fn finite(key: &str, value: f64) -> Result<f64, ArmError> {
    if value.is_finite() { Ok(value) } else { Err(ArmError::NotFinite { key: key.to_owned() }) }
}

fn positive(key: &str, value: f64) -> Result<f64, ArmError> {
    if finite(key, value)? > 0.0 {
        Ok(value)
    } else {
        Err(ArmError::NotPositive { key: key.to_owned(), value, s: None })
    }
}

fn not_negative(key: &str, value: f64) -> Result<f64, ArmError> {
    if finite(key, value)? >= 0.0 { Ok(value) } else { Err(ArmError::Negative { key: key.to_owned(), value }) }
}

fn positive_profile(key: &str, profile: &Profile, length: f64) -> Result<(), ArmError> {
    profile.check(key, length)?;
    let places = std::iter::once(0.0).chain(profile.knots().iter().copied()).chain(std::iter::once(length));
    for s in places {
        let value = profile.at(s, length).value;
        if value <= 0.0 {
            return Err(ArmError::NotPositive { key: key.to_owned(), value, s: Some(s) });
        }
    }
    Ok(())
}
