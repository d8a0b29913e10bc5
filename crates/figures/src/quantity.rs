//! What a chart can show of an equilibrium.

use std::fmt;
use std::str::FromStr;

use hydrostat::{CableState, Configuration, Pose, SpatialConfiguration, SpatialTip, Tip};

use crate::font::Label;

/// One number of a configuration.
///
/// ```
/// use hydrostat_figures::Quantity;
///
/// assert_eq!("tip.y".parse(), Ok(Quantity::TipY));
/// assert_eq!("stroke[1]".parse(), Ok(Quantity::Stroke(1)));
/// assert!("tip".parse::<Quantity>().is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// x of the tip.
    TipX,
    /// y of the tip.
    TipY,
    /// z of the tip, in space.
    TipZ,
    /// The angle of the tip's section, in the plane.
    TipTheta,
    /// alpha at the tip.
    TipAlpha,
    /// How far a cable is reeled in.
    Stroke(usize),
}

/// A name that no quantity has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("expected tip.x, tip.y, tip.z, tip.theta, tip.alpha or the stroke of a cable such as stroke[0]")]
pub struct UnknownQuantity;

impl FromStr for Quantity {
    type Err = UnknownQuantity;

    fn from_str(name: &str) -> Result<Self, UnknownQuantity> {
        let bracketed = || name.strip_prefix("stroke[")?.strip_suffix(']');
        let stroke = || bracketed().or_else(|| name.strip_prefix("stroke."))?.parse().ok();
        match name {
            "tip.x" => Ok(Self::TipX),
            "tip.y" => Ok(Self::TipY),
            "tip.z" => Ok(Self::TipZ),
            "tip.theta" => Ok(Self::TipTheta),
            "tip.alpha" => Ok(Self::TipAlpha),
            _ => stroke().map(Self::Stroke).ok_or(UnknownQuantity),
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TipX => f.write_str("tip.x"),
            Self::TipY => f.write_str("tip.y"),
            Self::TipZ => f.write_str("tip.z"),
            Self::TipTheta => f.write_str("tip.theta"),
            Self::TipAlpha => f.write_str("tip.alpha"),
            Self::Stroke(cable) => write!(f, "stroke[{cable}]"),
        }
    }
}

impl Quantity {
    /// Whether an arm in space has it, or, if `in_space` is false, one in the plane.
    pub fn is_of(self, in_space: bool) -> bool {
        match self {
            Self::TipZ => in_space,
            Self::TipTheta => !in_space,
            Self::TipX | Self::TipY | Self::TipAlpha | Self::Stroke(_) => true,
        }
    }

    /// Its value, in mm or degrees.
    pub(crate) fn of<C: Posed>(self, c: &C) -> f64 {
        match self {
            Self::Stroke(cable) => c.cables().get(cable).map_or(f64::NAN, |cable| 1e3 * cable.stroke),
            of_tip => C::of_tip(of_tip, &c.posed()).unwrap_or(f64::NAN),
        }
    }

    /// Its name on an axis.
    pub(crate) fn title(self) -> Label {
        match self {
            Self::TipX => Label::math("$x$($L$) (mm)"),
            Self::TipY => Label::math("$y$($L$) (mm)"),
            Self::TipZ => Label::math("$z$($L$) (mm)"),
            Self::TipTheta => Label::math("$θ$($L$) (°)"),
            Self::TipAlpha => Label::math("$α$($L$) (°)"),
            Self::Stroke(cable) => Label::plain(format!("stroke of cable {cable} (mm)")),
        }
    }
}

/// A shape whose tip is shown, in the plane or in space.
pub trait Posed {
    /// Where its tip is.
    type Tip: Pose;

    /// Its tip.
    fn posed(&self) -> Self::Tip;
    /// Its cables.
    fn cables(&self) -> &[CableState];
    /// A quantity of a tip alone, in mm or degrees, where that is enough; not a number where it has none.
    fn of_tip(quantity: Quantity, tip: &Self::Tip) -> Option<f64>;
}

impl Posed for Configuration {
    type Tip = Tip;

    fn posed(&self) -> Tip {
        self.tip()
    }

    fn cables(&self) -> &[CableState] {
        &self.cables
    }

    fn of_tip(quantity: Quantity, tip: &Tip) -> Option<f64> {
        match quantity {
            Quantity::TipX => Some(1e3 * tip.x),
            Quantity::TipY => Some(1e3 * tip.y),
            Quantity::TipTheta => Some(tip.theta.to_degrees()),
            Quantity::TipAlpha => Some(tip.alpha.to_degrees()),
            Quantity::TipZ => Some(0.0),
            Quantity::Stroke(_) => None,
        }
    }
}

impl Posed for SpatialConfiguration {
    type Tip = SpatialTip;

    fn posed(&self) -> SpatialTip {
        self.tip()
    }

    fn cables(&self) -> &[CableState] {
        &self.cables
    }

    fn of_tip(quantity: Quantity, tip: &SpatialTip) -> Option<f64> {
        match quantity {
            Quantity::TipX => Some(1e3 * tip.x),
            Quantity::TipY => Some(1e3 * tip.y),
            Quantity::TipZ => Some(1e3 * tip.z),
            Quantity::TipTheta => Some(f64::NAN),
            Quantity::TipAlpha => Some(tip.alpha.to_degrees()),
            Quantity::Stroke(_) => None,
        }
    }
}
