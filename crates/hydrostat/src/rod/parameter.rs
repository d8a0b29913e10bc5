//! Quantities of an arm that a path varies, under the names that the arm file has for them.

use std::fmt;
use std::str::FromStr;

use crate::rod::arm::{Arm, ArmError, BaseDirections, FlowLaw, Gravity, Material};
use crate::rod::profile::{Point, Profile};

/// One number of an arm that can be varied. Its name is the dotted key of the arm file.
///
/// ```
/// use hydrostat::Parameter;
///
/// let parameter: Parameter = "cable[0].tension".parse().unwrap();
/// assert_eq!(parameter, Parameter::Tension(0));
/// assert_eq!(parameter.to_string(), "cable[0].tension");
/// assert_eq!(parameter.unit(), "N");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Parameter {
    /// Tension of a cable, N.
    Tension(usize),
    /// Stroke of a cable that is commanded in place of its tension, m.
    Stroke(usize),
    /// Offset of a cable, m: one of the numbers that its profile is given by.
    Offset(usize, Point),
    /// Angle of a cable in the section from b towards c, rad: the same, of an arm in space.
    CableAngle(usize, Point),
    /// Radius of the arm, m: the same.
    Radius(Point),
    /// Twist or bending of the unloaded arm, 1/m: the same.
    Reference(Curvature, Point),
    /// Length of the arm, m, where no profile is a table: its points are at places in m.
    Length,
    /// Speed of the stream, m/s.
    FlowSpeed,
    /// Direction of the stream from e1, rad.
    FlowDirection,
    /// The part of the stream's direction along e1 (0), e2 (1) or e3 (2), of an arm in space.
    StreamAlong(usize),
    /// Density of the water, kg/m3.
    FlowDensity,
    /// Gravity, m/s2.
    GravityAcceleration,
    /// Direction of gravity from e1, rad.
    GravityDirection,
    /// The part of gravity's direction along e1 (0), e2 (1) or e3 (2), of an arm in space.
    GravityAlong(usize),
    /// Dead force on the tip along e1 (0) or e2 (1), in space e3 (2), N.
    TipForce(usize),
    /// Moment on the tip, in space that about e3, N m.
    TipMoment,
    /// Dead moment on the tip of an arm in space about e1 (0) or e2 (1), N m.
    TipMomentAbout(usize),
    /// Follower force on the tip along a (0) or b (1), in space c (2), N.
    TipFollower(usize),
    /// Dead force along the arm, per metre of undeformed length, along e1 (0), e2 (1) or, in space, e3 (2), N/m: one of
    /// the numbers that its profile is given by.
    DistributedForce(usize, Point),
    /// Dead couple along the arm about e3 (2), in space also about e1 (0) and e2 (1), N m/m: the same.
    DistributedCouple(usize, Point),
    /// Angle of the base from e1, rad.
    BaseAngle,
    /// The part of the direction of a at the base along e1 (0), e2 (1) or e3 (2), of an arm in space.
    BaseAlong(usize),
    /// The same of the direction that b at the base is projected from.
    SectionAlong(usize),
    /// Density of the arm, kg/m3.
    Density,
    /// Young's modulus of a homogeneous arm, Pa.
    Young,
    /// Poisson's ratio of a homogeneous arm.
    Poisson,
    /// Shear correction of a homogeneous arm.
    ShearFactor,
    /// C1 (0, Pa), C2 (1, Pa), C3 (2, N) or, in space, C4 (3, N), where the coefficients are given and this one is the
    /// same all along.
    Coefficient(usize),
    /// C_n of quadratic drag.
    DragNormal,
    /// C_t of quadratic drag.
    DragTangential,
}

/// A curvature of the unloaded arm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Curvature {
    /// Twist tau_o about a, of an arm in space.
    Tau,
    /// Bending kappa_o about b, of an arm in space.
    Kappa,
    /// Bending mu_o about c: in the plane of an arm that has one.
    Mu,
}

impl Curvature {
    pub(crate) const ALL: [Self; 3] = [Self::Tau, Self::Kappa, Self::Mu];

    fn key(self) -> &'static str {
        match self {
            Self::Tau => "reference.tau",
            Self::Kappa => "reference.kappa",
            Self::Mu => "reference.mu",
        }
    }

    /// Its profile; none of an arm in the plane that is not bent in it.
    pub(crate) fn of(self, arm: &Arm) -> Option<&Profile> {
        match self {
            Self::Mu => Some(&arm.reference.mu),
            Self::Tau => arm.space.as_ref().map(|space| &space.tau),
            Self::Kappa => arm.space.as_ref().map(|space| &space.kappa),
        }
    }

    fn set(self, arm: &mut Arm, profile: Profile) {
        match (self, &mut arm.space) {
            (Self::Mu, _) => arm.reference.mu = profile,
            (Self::Tau, Some(space)) => space.tau = profile,
            (Self::Kappa, Some(space)) => space.kappa = profile,
            // That the arm has it was checked.
            (_, None) => {}
        }
    }
}

/// A name that no parameter has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{}` cannot vary along a path; keys that can: {}", on_one_line(.name), names().join(", "))]
pub struct UnknownParameter {
    /// The name given.
    pub name: String,
}

/// The beginning of what may be anything, as a message can show it.
fn on_one_line(name: &str) -> String {
    name.chars().take(60).flat_map(char::escape_debug).collect()
}

/// A parameter that the arm at hand does not have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Unfit {
    /// A cable that is not there.
    #[error("`{key}`: the arm has {cables} cables, counted from 0")]
    Cable {
        /// The parameter.
        key: String,
        /// Cables of the arm.
        cables: usize,
    },
    /// A point of a profile that is given in another way.
    #[error("`{key}`: the arm gives this profile in another way; {expected}")]
    Point {
        /// The parameter.
        key: String,
        /// Which keys it has.
        expected: String,
    },
    /// A homogeneous material's property where the coefficients are given.
    #[error("`{key}`: the arm gives c1, c2 and c3 in place of a homogeneous material")]
    Coefficients {
        /// The parameter.
        key: String,
    },
    /// A coefficient where a homogeneous material is given.
    #[error("`{key}`: the arm gives a homogeneous material in place of c1, c2 and c3")]
    Homogeneous {
        /// The parameter.
        key: String,
    },
    /// A coefficient that follows from others.
    #[error("`{key}` is not given: it follows from c2")]
    Unset {
        /// The parameter.
        key: String,
    },
    /// A coefficient that is a profile.
    #[error("`{key}` varies along the arm: it is no single number")]
    Profile {
        /// The parameter.
        key: String,
    },
    /// The length where a profile is a table.
    #[error(
        "`arm.length`: `{key}` is a table, whose points stay where they are, so that the arm would not only be longer"
    )]
    Table {
        /// The profile.
        key: String,
    },
    /// The length where places in m are measured.
    #[error(
        "`arm.length`: by it there are derivatives at fractions of the arm, and the places of measurements are in m"
    )]
    Places,
    /// A quantity of an arm in the plane that one in space does not vary.
    #[error("`{key}` is varied of arms in the plane alone, and this one is in space")]
    OnlyInPlane {
        /// The parameter.
        key: String,
    },
    /// A quantity of space of an arm in the plane.
    #[error("`{key}` is of an arm in space, and this one is in the plane: say space = \"spatial\" under [arm]")]
    InPlane {
        /// The parameter.
        key: String,
    },
    /// An angle where the direction is given by its parts.
    #[error("`{key}` does not act: the arm gives this direction by its parts, `{parts}[0]` to `{parts}[2]`")]
    Parts {
        /// The parameter.
        key: String,
        /// The key of the parts.
        parts: &'static str,
    },
    /// A drag coefficient without quadratic drag.
    #[error("`{key}` does not act: flow.law is momentum, not quadratic-drag")]
    Momentum {
        /// The parameter.
        key: String,
    },
}

/// The names of all parameters, those of the cables with the index 0, those of profiles as of linear ones.
pub fn names() -> Vec<String> {
    let of_cables = [Parameter::Tension(0), Parameter::Stroke(0)].into_iter();
    let ends = [Point::Base, Point::Tip];
    let geometry = ends.map(|end| Parameter::Offset(0, end)).into_iter().chain(ends.map(Parameter::Radius));
    let angle = [Parameter::CableAngle(0, Point::Whole)];
    let curvatures = Curvature::ALL.map(|curvature| Parameter::Reference(curvature, Point::Whole));
    let in_space = IN_SPACE.into_iter().chain(angle);
    let along = distributed().map(|own| own(Point::Whole));
    let all = of_cables.chain(PLAIN).chain(geometry).chain(curvatures).chain(along).chain(in_space);
    all.map(|parameter| parameter.to_string()).collect()
}

/// The loads along the arm, of a point of their profiles.
fn distributed() -> impl Iterator<Item = impl Fn(Point) -> Parameter> {
    let couples = [2, 0, 1].map(|axis| (true, axis));
    let all = [0, 1, 2].map(|axis| (false, axis)).into_iter().chain(couples);
    all.map(|(couple, axis)| {
        move |point| {
            if couple { Parameter::DistributedCouple(axis, point) } else { Parameter::DistributedForce(axis, point) }
        }
    })
}

/// What an arm in space has beside an arm in the plane, but the cables' angles and the loads along the arm.
pub(crate) const IN_SPACE: [Parameter; 17] = [
    Parameter::StreamAlong(0),
    Parameter::StreamAlong(1),
    Parameter::StreamAlong(2),
    Parameter::GravityAlong(0),
    Parameter::GravityAlong(1),
    Parameter::GravityAlong(2),
    Parameter::TipForce(2),
    Parameter::TipFollower(2),
    Parameter::TipMomentAbout(0),
    Parameter::TipMomentAbout(1),
    Parameter::BaseAlong(0),
    Parameter::BaseAlong(1),
    Parameter::BaseAlong(2),
    Parameter::SectionAlong(0),
    Parameter::SectionAlong(1),
    Parameter::SectionAlong(2),
    Parameter::Coefficient(3),
];

/// All of an arm in the plane but the cables', the geometry's and the loads along the arm.
pub(crate) const PLAIN: [Parameter; 21] = [
    Parameter::FlowSpeed,
    Parameter::FlowDirection,
    Parameter::FlowDensity,
    Parameter::GravityAcceleration,
    Parameter::GravityDirection,
    Parameter::TipForce(0),
    Parameter::TipForce(1),
    Parameter::TipMoment,
    Parameter::TipFollower(0),
    Parameter::TipFollower(1),
    Parameter::BaseAngle,
    Parameter::Length,
    Parameter::Density,
    Parameter::Young,
    Parameter::Poisson,
    Parameter::ShearFactor,
    Parameter::Coefficient(0),
    Parameter::Coefficient(1),
    Parameter::Coefficient(2),
    Parameter::DragNormal,
    Parameter::DragTangential,
];

impl Parameter {
    /// The numbers that the loads along `arm` are given by.
    pub(crate) fn of_distributed(arm: &Arm) -> Vec<Self> {
        let points = |own: Self| match own.profile(arm) {
            Ok(Some((profile, _))) => profile.points(),
            _ => Vec::new(),
        };
        distributed().flat_map(|own| points(own(Point::Whole)).into_iter().map(own).collect::<Vec<_>>()).collect()
    }

    /// Whether it may change while an arm moves, or is led along its loads: loads, and how the base stands.
    pub(crate) const fn may_be_led(self) -> bool {
        matches!(
            self,
            Self::Tension(_)
                | Self::Stroke(_)
                | Self::FlowSpeed
                | Self::FlowDirection
                | Self::GravityAcceleration
                | Self::GravityDirection
                | Self::StreamAlong(_)
                | Self::GravityAlong(_)
                | Self::TipForce(_)
                | Self::TipMoment
                | Self::TipMomentAbout(_)
                | Self::TipFollower(_)
                | Self::DistributedForce(..)
                | Self::DistributedCouple(..)
                | Self::BaseAngle
                | Self::BaseAlong(_)
                | Self::SectionAlong(_)
        )
    }
}

/// The indices of a component along or about an axis.
const AXES: [&str; 3] = ["[0]", "[1]", "[2]"];

/// The keys of the place of the base, along e1, e2 and e3.
pub const BASE_PLACE: [&str; 3] = ["arm.base.x", "arm.base.y", "arm.base.z"];

impl Arm {
    /// The place of the base along e1 (0), e2 (1) or, in space, e3 (2), m. It moves shapes as they are.
    ///
    /// ```
    /// let mut arm = hydrostat::Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    /// *arm.base_place_mut(1)? = 0.1;
    /// assert_eq!(arm.base.y, 0.1);
    /// assert!(arm.base_place_mut(2).is_err());
    /// # Ok::<(), hydrostat::parameter::Unfit>(())
    /// ```
    ///
    /// # Errors
    /// [`Unfit::InPlane`] along e3 of an arm in the plane.
    pub fn base_place_mut(&mut self, axis: usize) -> Result<&mut f64, Unfit> {
        match (axis, &mut self.space) {
            (0, _) => Ok(&mut self.base.x),
            (1, _) => Ok(&mut self.base.y),
            (_, Some(space)) => Ok(&mut space.z),
            (_, None) => Err(Unfit::InPlane { key: BASE_PLACE[2].to_owned() }),
        }
    }

    /// What [`base_place_mut`](Self::base_place_mut) sets.
    ///
    /// # Errors
    /// As there.
    pub fn base_place(&self, axis: usize) -> Result<f64, Unfit> {
        match (axis, &self.space) {
            (0, _) => Ok(self.base.x),
            (1, _) => Ok(self.base.y),
            (_, Some(space)) => Ok(space.z),
            (_, None) => Err(Unfit::InPlane { key: BASE_PLACE[2].to_owned() }),
        }
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tension(c) => write!(f, "cable[{c}].tension"),
            Self::Stroke(c) => write!(f, "cable[{c}].stroke"),
            Self::Offset(c, point) => write!(f, "cable[{c}].offset{point}"),
            Self::CableAngle(c, point) => write!(f, "cable[{c}].angle{point}"),
            Self::Radius(point) => write!(f, "arm.radius{point}"),
            Self::Reference(curvature, point) => write!(f, "{}{point}", curvature.key()),
            Self::FlowSpeed => f.write_str("flow.speed"),
            Self::FlowDirection => f.write_str("flow.direction"),
            Self::StreamAlong(k) => write!(f, "flow.direction[{k}]"),
            Self::FlowDensity => f.write_str("flow.density"),
            Self::GravityAcceleration => f.write_str("gravity.acceleration"),
            Self::GravityDirection => f.write_str("gravity.direction"),
            Self::GravityAlong(k) => write!(f, "gravity.direction[{k}]"),
            Self::TipForce(k) => write!(f, "tip.force[{k}]"),
            Self::TipMoment => f.write_str("tip.moment"),
            Self::TipMomentAbout(k) => write!(f, "tip.moment[{k}]"),
            Self::TipFollower(k) => write!(f, "tip.follower[{k}]"),
            Self::DistributedForce(k, point) => write!(f, "distributed.force[{k}]{point}"),
            Self::DistributedCouple(2.., point) => write!(f, "distributed.couple{point}"),
            Self::DistributedCouple(k, point) => write!(f, "distributed.couple[{k}]{point}"),
            Self::BaseAngle => f.write_str("arm.base.angle"),
            Self::Length => f.write_str("arm.length"),
            Self::BaseAlong(k) => write!(f, "arm.base.direction[{k}]"),
            Self::SectionAlong(k) => write!(f, "arm.base.section[{k}]"),
            Self::Density => f.write_str("arm.density"),
            Self::Young => f.write_str("material.young"),
            Self::Poisson => f.write_str("material.poisson"),
            Self::ShearFactor => f.write_str("material.shear_factor"),
            Self::Coefficient(k) => write!(f, "material.c{}", k.min(&3) + 1),
            Self::DragNormal => f.write_str("flow.cn"),
            Self::DragTangential => f.write_str("flow.ct"),
        }
    }
}

impl FromStr for Parameter {
    type Err = UnknownParameter;

    fn from_str(name: &str) -> Result<Self, UnknownParameter> {
        if let Some((index, of)) = name.strip_prefix("cable[").and_then(|rest| rest.split_once("].")) {
            match (index.parse(), of) {
                (Ok(index), "tension") => return Ok(Self::Tension(index)),
                (Ok(index), "stroke") => return Ok(Self::Stroke(index)),
                (Ok(index), other) => {
                    if let Some(point) = other.strip_prefix("offset").and_then(Point::read) {
                        return Ok(Self::Offset(index, point));
                    }
                    if let Some(point) = other.strip_prefix("angle").and_then(Point::read) {
                        return Ok(Self::CableAngle(index, point));
                    }
                }
                _ => {}
            }
        }
        if let Some(point) = name.strip_prefix("arm.radius").and_then(Point::read) {
            return Ok(Self::Radius(point));
        }
        let read = |curvature: Curvature| {
            let point = name.strip_prefix(curvature.key()).and_then(Point::read)?;
            Some(Self::Reference(curvature, point))
        };
        if let Some(found) = Curvature::ALL.into_iter().find_map(read) {
            return Ok(found);
        }
        if let Some(rest) = name.strip_prefix("distributed.force") {
            let along = |k: usize| Some(Self::DistributedForce(k, Point::read(rest.strip_prefix(AXES[k])?)?));
            if let Some(found) = (0..3).find_map(along) {
                return Ok(found);
            }
        }
        if let Some(rest) = name.strip_prefix("distributed.couple") {
            // `[0][1]` is a value of a table about e3, `[0]` the couple about e1.
            let about = |k: usize| Some(Self::DistributedCouple(k, Point::read(rest.strip_prefix(AXES[k])?)?));
            let about_e3 = || Point::read(rest).map(|point| Self::DistributedCouple(2, point));
            if let Some(found) = about_e3().or_else(|| (0..3).find_map(about)) {
                return Ok(found);
            }
        }
        if name == "tip.moment[2]" {
            return Ok(Self::TipMoment);
        }
        let mut all = PLAIN.into_iter().chain(IN_SPACE);
        all.find(|p| p.to_string() == name).ok_or_else(|| UnknownParameter { name: name.to_owned() })
    }
}

impl Parameter {
    /// The unit of its values in the library; empty for a plain number.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Tension(_) | Self::TipForce(_) | Self::TipFollower(_) | Self::Coefficient(2..) => "N",
            Self::FlowSpeed => "m/s",
            Self::FlowDirection | Self::GravityDirection | Self::BaseAngle | Self::CableAngle(..) => "rad",
            Self::FlowDensity | Self::Density => "kg/m3",
            Self::GravityAcceleration => "m/s2",
            Self::Stroke(_) | Self::Offset(..) | Self::Radius(_) | Self::Length => "m",
            Self::TipMoment | Self::TipMomentAbout(_) => "N m",
            Self::DistributedForce(..) => "N/m",
            Self::DistributedCouple(..) => "N m/m",
            Self::Young | Self::Coefficient(_) => "Pa",
            Self::Reference(..) => "1/m",
            Self::Poisson
            | Self::ShearFactor
            | Self::DragNormal
            | Self::DragTangential
            | Self::StreamAlong(_)
            | Self::GravityAlong(_)
            | Self::BaseAlong(_)
            | Self::SectionAlong(_) => "",
        }
    }

    /// A value of it (in [`Parameter::unit`]) with its unit, angles in degrees.
    pub(crate) fn shown(self, value: f64) -> String {
        match self.unit() {
            "rad" => format!("{} deg", value.to_degrees()),
            "" => value.to_string(),
            unit => format!("{value} {unit}"),
        }
    }

    /// Its value in `arm`.
    ///
    /// # Errors
    /// [`Unfit`] when the arm has no such quantity.
    pub fn of(self, arm: &Arm) -> Result<f64, Unfit> {
        if let Some((profile, point)) = self.profile(arm)? {
            return profile.point(point).ok_or_else(|| self.no_point(profile));
        }
        let mut arm = arm.clone();
        self.place(&mut arm).map(|value| *value)
    }

    /// Sets its value in `arm`; gravity that was left out points down, a cable is given by its tension or by its
    /// stroke.
    ///
    /// # Errors
    /// [`Unfit`] when the arm has no such quantity.
    pub fn set(self, arm: &mut Arm, value: f64) -> Result<(), Unfit> {
        if let Some((profile, point)) = self.profile(arm)? {
            let moved = profile.with_point(point, value).ok_or_else(|| self.no_point(profile))?;
            match self {
                Self::Offset(c, _) => arm.cables[c].offset = moved,
                Self::CableAngle(c, _) => arm.cables[c].angle = moved,
                Self::Reference(curvature, _) => curvature.set(arm, moved),
                Self::DistributedForce(..) | Self::DistributedCouple(..) => self.set_distributed(arm, moved),
                _ => arm.radius = moved,
            }
            return Ok(());
        }
        *self.place(arm)? = value;
        Ok(())
    }

    /// The profile that it is a number of.
    pub(crate) fn profile(self, arm: &Arm) -> Result<Option<(&Profile, Point)>, Unfit> {
        match self {
            Self::CableAngle(..) if arm.space.is_none() => Err(self.in_plane()),
            Self::Offset(c, point) | Self::CableAngle(c, point) => match arm.cables.get(c) {
                Some(cable) if matches!(self, Self::Offset(..)) => Ok(Some((&cable.offset, point))),
                Some(cable) => Ok(Some((&cable.angle, point))),
                None => Err(Unfit::Cable { key: self.to_string(), cables: arm.cables.len() }),
            },
            Self::Radius(point) => Ok(Some((&arm.radius, point))),
            Self::DistributedForce(k @ ..2, point) => Ok(Some((&arm.distributed.force[k], point))),
            Self::DistributedCouple(2.., point) => Ok(Some((&arm.distributed.couple, point))),
            Self::DistributedForce(_, point) => match &arm.space {
                Some(space) => Ok(Some((&space.force, point))),
                None => Err(self.in_plane()),
            },
            Self::DistributedCouple(k, point) => match &arm.space {
                Some(space) => Ok(Some((&space.couple[k], point))),
                None => Err(self.in_plane()),
            },
            Self::Reference(curvature, point) => match curvature.of(arm) {
                Some(profile) => Ok(Some((profile, point))),
                None => Err(self.in_plane()),
            },
            _ => Ok(None),
        }
    }

    /// Sets the profile of a load along the arm, which the arm was checked to have.
    fn set_distributed(self, arm: &mut Arm, profile: Profile) {
        match (self, &mut arm.space) {
            (Self::DistributedForce(k @ ..2, _), _) => arm.distributed.force[k] = profile,
            (Self::DistributedCouple(2.., _), _) => arm.distributed.couple = profile,
            (Self::DistributedForce(..), Some(space)) => space.force = profile,
            (Self::DistributedCouple(k, _), Some(space)) => space.couple[k] = profile,
            _ => {}
        }
    }

    fn no_point(self, profile: &Profile) -> Unfit {
        let of = |point: Point| match self {
            Self::Offset(c, _) => Self::Offset(c, point).to_string(),
            Self::CableAngle(c, _) => Self::CableAngle(c, point).to_string(),
            Self::Reference(curvature, _) => Self::Reference(curvature, point).to_string(),
            Self::DistributedForce(k, _) => Self::DistributedForce(k, point).to_string(),
            Self::DistributedCouple(k, _) => Self::DistributedCouple(k, point).to_string(),
            _ => Self::Radius(point).to_string(),
        };
        let names: Vec<String> = profile.points().into_iter().map(of).collect();
        let expected = match &names[..] {
            [one] => format!("it has `{one}`"),
            [first, .., last] => format!("it has `{first}` to `{last}`"),
            [] => String::new(),
        };
        Unfit::Point { key: self.to_string(), expected }
    }

    /// Where its number stands, of all but profiles'.
    fn place(self, arm: &mut Arm) -> Result<&mut f64, Unfit> {
        let gravity = Gravity { acceleration: 0.0, ..Gravity::default() };
        let parts = |parts| Unfit::Parts { key: self.to_string(), parts };
        let space = arm.space.as_ref();
        Ok(match self {
            Self::TipForce(2..)
            | Self::TipFollower(2..)
            | Self::TipMomentAbout(_)
            | Self::StreamAlong(_)
            | Self::GravityAlong(_)
            | Self::BaseAlong(_)
            | Self::SectionAlong(_)
            | Self::Coefficient(3..) => return self.place_in_space(arm),
            Self::FlowDirection if space.is_some_and(|s| s.stream.is_some()) => return Err(parts("flow.direction")),
            Self::GravityDirection if space.is_some_and(|s| s.gravity.is_some()) => {
                return Err(parts("gravity.direction"));
            }
            Self::BaseAngle if space.is_some_and(|s| s.base.is_some()) => return Err(parts("arm.base.direction")),
            Self::Tension(c) | Self::Stroke(c) => {
                let cables = arm.cables.len();
                let missing = || Unfit::Cable { key: self.to_string(), cables };
                let cable = arm.cables.get_mut(c).ok_or_else(missing)?;
                if let Self::Stroke(_) = self {
                    if cable.stroke.is_none() {
                        cable.tension = 0.0;
                    }
                    cable.stroke.get_or_insert(0.0)
                } else {
                    cable.stroke = None;
                    &mut cable.tension
                }
            }
            // Not by itself: the slopes of a table go with it.
            Self::Offset(..)
            | Self::CableAngle(..)
            | Self::Radius(_)
            | Self::Reference(..)
            | Self::DistributedForce(..)
            | Self::DistributedCouple(..) => {
                return Err(Unfit::Point { key: self.to_string(), expected: String::new() });
            }
            Self::FlowSpeed => &mut arm.flow.speed,
            Self::FlowDirection => &mut arm.flow.direction,
            Self::FlowDensity => &mut arm.flow.density,
            Self::GravityAcceleration => &mut arm.gravity.get_or_insert(gravity).acceleration,
            Self::GravityDirection => &mut arm.gravity.get_or_insert(gravity).direction,
            Self::TipForce(k) => &mut arm.tip.force[k.min(1)],
            Self::TipMoment => &mut arm.tip.moment,
            Self::TipFollower(k) => &mut arm.tip.follower[k.min(1)],
            Self::BaseAngle => &mut arm.base.angle,
            Self::Length if arm.space.is_some() => return Err(Unfit::OnlyInPlane { key: self.to_string() }),
            Self::Length => match arm.first_table() {
                Some(key) => return Err(Unfit::Table { key }),
                None => &mut arm.length,
            },
            Self::Density => &mut arm.density,
            Self::Young | Self::Poisson | Self::ShearFactor => match &mut arm.material {
                Material::Homogeneous { young, poisson, shear_factor } => match self {
                    Self::Young => young,
                    Self::Poisson => poisson,
                    _ => shear_factor,
                },
                Material::Coefficients { .. } => return Err(Unfit::Coefficients { key: self.to_string() }),
            },
            Self::Coefficient(k) => match &mut arm.material {
                Material::Homogeneous { .. } => return Err(Unfit::Homogeneous { key: self.to_string() }),
                Material::Coefficients { c1, c2, c3 } => match [c1, c2, c3][k.min(2)] {
                    Profile::Constant(value) => value,
                    _ => return Err(Unfit::Profile { key: self.to_string() }),
                },
            },
            Self::DragNormal | Self::DragTangential => match &mut arm.flow.law {
                FlowLaw::Momentum => return Err(Unfit::Momentum { key: self.to_string() }),
                FlowLaw::QuadraticDrag { cn, ct } => {
                    if self == Self::DragNormal {
                        cn
                    } else {
                        ct
                    }
                }
            },
        })
    }

    /// [`Parameter::place`] of what an arm in the plane has not. A direction that is given by its angle gets parts.
    fn place_in_space(self, arm: &mut Arm) -> Result<&mut f64, Unfit> {
        let in_plane = |angle: f64| [angle.cos(), angle.sin(), 0.0];
        let directors = arm.base_directors();
        let (stream, down) = (in_plane(arm.flow.direction), in_plane(arm.gravity.unwrap_or_default().direction));
        let homogeneous = matches!(arm.material, Material::Homogeneous { .. });
        let Some(space) = &mut arm.space else { return Err(self.in_plane()) };
        let base = BaseDirections { direction: directors[0], section: None };
        Ok(match self {
            Self::TipForce(_) => &mut space.tip_force,
            Self::TipFollower(_) => &mut space.tip_follower,
            Self::TipMomentAbout(k) => &mut space.tip_moment[k.min(1)],
            Self::StreamAlong(k) => &mut space.stream.get_or_insert(stream)[k.min(2)],
            Self::GravityAlong(k) => {
                arm.gravity.get_or_insert(Gravity { acceleration: 0.0, ..Gravity::default() });
                &mut space.gravity.get_or_insert(down)[k.min(2)]
            }
            Self::BaseAlong(k) => &mut space.base.get_or_insert(base).direction[k.min(2)],
            Self::SectionAlong(k) => &mut space.base.get_or_insert(base).section.get_or_insert(directors[1])[k.min(2)],
            _ if homogeneous => return Err(Unfit::Homogeneous { key: self.to_string() }),
            _ => match &mut space.c4 {
                Some(Profile::Constant(value)) => value,
                Some(_) => return Err(Unfit::Profile { key: self.to_string() }),
                None => return Err(Unfit::Unset { key: self.to_string() }),
            },
        })
    }

    fn in_plane(self) -> Unfit {
        Unfit::InPlane { key: self.to_string() }
    }

    /// The length of the direction that it is a part of.
    fn length_of_direction(self, arm: &Arm) -> Option<f64> {
        let all = match self {
            Self::StreamAlong(_) => [0, 1, 2].map(Self::StreamAlong),
            Self::GravityAlong(_) => [0, 1, 2].map(Self::GravityAlong),
            Self::BaseAlong(_) => [0, 1, 2].map(Self::BaseAlong),
            Self::SectionAlong(_) => [0, 1, 2].map(Self::SectionAlong),
            _ => return None,
        };
        Some(all.iter().filter_map(|part| part.of(arm).ok()).map(|v| v * v).sum::<f64>().sqrt())
    }

    /// A change of it that counts for the arm, in its unit, given the unit of force of the equations (N).
    pub(crate) fn scale(self, arm: &Arm, force: f64) -> f64 {
        let least = match self {
            Self::Tension(_) | Self::TipForce(_) | Self::TipFollower(_) | Self::DistributedCouple(..) => force,
            Self::Stroke(_) => arm.length,
            Self::Offset(..) | Self::Radius(_) => 1e-3 * arm.length,
            Self::Reference(..) => 1.0 / arm.length,
            Self::FlowSpeed => 0.1,
            Self::FlowDensity | Self::Density => 1000.0,
            Self::GravityAcceleration => 10.0,
            Self::TipMoment | Self::TipMomentAbout(_) => force * arm.length,
            Self::DistributedForce(..) => force / arm.length,
            Self::FlowDirection | Self::GravityDirection | Self::BaseAngle | Self::CableAngle(..) => return 1.0,
            Self::StreamAlong(_) | Self::GravityAlong(_) | Self::BaseAlong(_) | Self::SectionAlong(_) => {
                self.length_of_direction(arm).unwrap_or(1.0)
            }
            Self::DragNormal | Self::DragTangential => 1.0,
            Self::Length | Self::Young | Self::Poisson | Self::ShearFactor | Self::Coefficient(_) => 0.0,
        };
        let value = self.of(arm).unwrap_or(0.0).abs().max(least);
        if value > 0.0 { value } else { 1.0 }
    }

    /// Whether the data of the sections depend on it.
    pub(crate) fn is_of_sections(self) -> bool {
        matches!(
            self,
            Self::Offset(..)
                | Self::CableAngle(..)
                | Self::Radius(_)
                | Self::Reference(..)
                | Self::DistributedForce(..)
                | Self::DistributedCouple(..)
                | Self::Length
                | Self::FlowDensity
                | Self::GravityAcceleration
                | Self::GravityDirection
                | Self::GravityAlong(_)
                | Self::Density
                | Self::Young
                | Self::Poisson
                | Self::ShearFactor
                | Self::Coefficient(_)
        )
    }

    /// `arm` with this value, checked.
    pub(crate) fn checked(self, arm: &Arm, value: f64) -> Result<Arm, Refused> {
        let mut arm = arm.clone();
        self.set(&mut arm, value)?;
        arm.check()?;
        Ok(arm)
    }
}

/// Why an arm cannot have a value.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Refused {
    /// It has no such quantity.
    #[error(transparent)]
    Unfit(#[from] Unfit),
    /// It would be no arm.
    #[error(transparent)]
    Arm(#[from] ArmError),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_read_back() {
        for parameter in PLAIN.into_iter().chain(IN_SPACE).chain([
            Parameter::CableAngle(1, Point::Tip),
            Parameter::Tension(0),
            Parameter::Tension(13),
            Parameter::Stroke(0),
            Parameter::Stroke(7),
            Parameter::Offset(3, Point::Whole),
            Parameter::Offset(0, Point::Tip),
            Parameter::Radius(Point::Base),
            Parameter::Radius(Point::Knot(12)),
            Parameter::Reference(Curvature::Mu, Point::Whole),
            Parameter::Reference(Curvature::Kappa, Point::Tip),
            Parameter::Reference(Curvature::Tau, Point::Knot(2)),
            Parameter::DistributedForce(0, Point::Whole),
            Parameter::DistributedForce(2, Point::Knot(1)),
            Parameter::DistributedCouple(0, Point::Whole),
            Parameter::DistributedCouple(1, Point::Knot(2)),
            Parameter::DistributedCouple(2, Point::Whole),
            Parameter::DistributedCouple(2, Point::Tip),
            Parameter::DistributedCouple(2, Point::Knot(0)),
        ]) {
            assert_eq!(parameter.to_string().parse(), Ok(parameter));
        }
        assert_eq!("distributed.couple[2].base".parse(), Ok(Parameter::DistributedCouple(2, Point::Base)));
        for wrong in [
            "",
            "distributed.force",
            "distributed.force[3]",
            "distributed.couple[0][0]",
            "cable.tension",
            "cable[].tension",
            "cable[-1].tension",
            "tip.force",
            "flow.Speed",
            "cable[0].offset[1]",
            "arm.radiusx",
        ] {
            assert!(wrong.parse::<Parameter>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_value_that_is_set_is_found() {
        let mut arm = Arm::cone(0.2, 0.01, 0.002, 1e5, 0.5);
        arm.cables.push(crate::Cable::new("left", 0.001));
        arm.flow.law = FlowLaw::QuadraticDrag { cn: 1.0, ct: 0.02 };
        let mut given = arm.clone();
        given.material = Material::Coefficients { c1: 1e5.into(), c2: 3e4.into(), c3: Profile::linear(2.0, 0.1) };
        let others = [Parameter::Tension(0), Parameter::Stroke(0), Parameter::Offset(0, Point::Whole)];
        let radii = [Point::Base, Point::Tip].map(Parameter::Radius);
        let bent = [Parameter::Reference(Curvature::Mu, Point::Whole)];
        let along = [0, 1].map(|k| Parameter::DistributedForce(k, Point::Whole));
        let along = along.into_iter().chain([Parameter::DistributedCouple(2, Point::Whole)]);
        for (k, parameter) in PLAIN.into_iter().chain(others).chain(radii).chain(bent).chain(along).enumerate() {
            let arm = if matches!(parameter, Parameter::Coefficient(_)) { &mut given } else { &mut arm };
            if parameter == Parameter::Coefficient(2) {
                assert!(matches!(parameter.of(arm), Err(Unfit::Profile { .. })));
                continue;
            }
            parameter.set(arm, k as f64).unwrap();
            assert_eq!(parameter.of(arm), Ok(k as f64));
        }
        let curvatures = [Curvature::Tau, Curvature::Kappa].map(|own| Parameter::Reference(own, Point::Whole));
        let couples = [0, 1].map(|k| Parameter::DistributedCouple(k, Point::Whole));
        let out_of_plane = [Parameter::CableAngle(0, Point::Whole), Parameter::DistributedForce(2, Point::Whole)];
        let in_space = || IN_SPACE.into_iter().chain(curvatures).chain(couples).chain(out_of_plane);
        for parameter in in_space() {
            assert!(matches!(parameter.of(&arm), Err(Unfit::InPlane { .. })), "{parameter}");
        }
        let mut there = given.clone();
        there.cables.push(crate::Cable::new("left", 0.001));
        there.space = Some(crate::Space { c4: Some(2.0.into()), ..crate::Space::default() });
        for (k, parameter) in in_space().enumerate() {
            parameter.set(&mut there, k as f64).unwrap();
            assert_eq!(parameter.of(&there), Ok(k as f64));
        }
        for angle in [Parameter::FlowDirection, Parameter::GravityDirection, Parameter::BaseAngle] {
            assert!(matches!(angle.of(&there), Err(Unfit::Parts { .. })), "{angle}");
        }
        for missing in [Parameter::Tension(1), Parameter::Offset(1, Point::Whole)] {
            assert!(matches!(missing.of(&arm), Err(Unfit::Cable { cables: 1, .. })));
        }
        let other = Parameter::Offset(0, Point::Tip);
        assert_eq!(other.of(&arm).err(), other.set(&mut arm.clone(), 1.0).err());
        assert!(other.of(&arm).is_err());
        let words = Parameter::Radius(Point::Knot(1)).of(&arm).unwrap_err().to_string();
        assert!(words.ends_with("it has `arm.radius.base` to `arm.radius.tip`"), "{words}");
        assert!(matches!(Parameter::Coefficient(0).of(&arm), Err(Unfit::Homogeneous { .. })));
        arm.flow.law = FlowLaw::Momentum;
        assert!(matches!(Parameter::DragNormal.of(&arm), Err(Unfit::Momentum { .. })));
    }
}
