//! What can be fitted: a number of the arm, its place, or a factor on the tensions that the load cases give.

use std::fmt;
use std::str::FromStr;

use hydrostat::parameter::{BASE_PLACE, Unfit, UnknownParameter};
use hydrostat::{Arm, Parameter};

use crate::quantity::Quantity;

/// A number that is fitted. The tensions of a load case are often those at a motor: what reaches the arm is a part of them, by friction in
/// guides and by the pulley's true radius.
///
/// ```
/// use hydrostat::Parameter;
/// use hydrostat_identify::Unknown;
///
/// assert_eq!("material.young".parse(), Ok(Unknown::Of(Parameter::Young)));
/// assert_eq!("tension_factor".parse(), Ok(Unknown::TensionFactor));
/// assert_eq!(Unknown::CableFactor(1).to_string(), "cable[1].tension_factor");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Unknown {
    /// A number of the arm.
    Of(Parameter),
    /// A factor on the given tensions of all cables.
    TensionFactor,
    /// A factor on the given tensions of one cable.
    CableFactor(usize),
    /// x (0), y (1) or, of an arm in space, z (2) of the base, m: shapes are moved as they are.
    Base(usize),
}

/// The key of a factor on all tensions.
const ALL: &str = "tension_factor";

impl From<Parameter> for Unknown {
    fn from(parameter: Parameter) -> Self {
        Self::Of(parameter)
    }
}

impl PartialEq<Parameter> for Unknown {
    fn eq(&self, other: &Parameter) -> bool {
        *self == Self::Of(*other)
    }
}

impl fmt::Display for Unknown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Of(parameter) => parameter.fmt(f),
            Self::TensionFactor => f.write_str(ALL),
            Self::CableFactor(c) => write!(f, "cable[{c}].{ALL}"),
            Self::Base(k) => f.write_str(BASE_PLACE[*k.min(&2)]),
        }
    }
}

impl FromStr for Unknown {
    type Err = UnknownParameter;

    fn from_str(name: &str) -> Result<Self, UnknownParameter> {
        if name == ALL {
            return Ok(Self::TensionFactor);
        }
        if let Some(k) = BASE_PLACE.iter().position(|key| *key == name) {
            return Ok(Self::Base(k));
        }
        let index =
            name.strip_prefix("cable[").and_then(|rest| rest.strip_suffix(ALL)?.strip_suffix("].")?.parse().ok());
        match index {
            Some(index) => Ok(Self::CableFactor(index)),
            None => name.parse().map(Self::Of),
        }
    }
}

impl Unknown {
    /// The number of the arm that it is, if it is one.
    pub fn parameter(self) -> Option<Parameter> {
        match self {
            Self::Of(parameter) => Some(parameter),
            _ => None,
        }
    }

    /// The unit of its values; empty for a plain number.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Of(parameter) => parameter.unit(),
            Self::Base(_) => "m",
            Self::TensionFactor | Self::CableFactor(_) => "",
        }
    }

    /// Its value in `arm`: of a factor 1, as the tensions are those that are given.
    ///
    /// # Errors
    /// [`Unfit`] when the arm has no such quantity.
    pub fn of(self, arm: &Arm) -> Result<f64, Unfit> {
        match self {
            Self::Of(parameter) => parameter.of(arm),
            Self::CableFactor(c) if c >= arm.cables.len() => {
                Err(Unfit::Cable { key: self.to_string(), cables: arm.cables.len() })
            }
            Self::TensionFactor | Self::CableFactor(_) => Ok(1.0),
            Self::Base(axis) => arm.base_place(axis),
        }
    }

    /// Sets its value in `arm`; a factor multiplies the tensions, strokes that are commanded stay.
    ///
    /// # Errors
    /// [`Unfit`] when the arm has no such quantity.
    pub fn set(self, arm: &mut Arm, value: f64) -> Result<(), Unfit> {
        if let Self::Of(parameter) = self {
            return parameter.set(arm, value);
        }
        self.of(arm)?;
        if let Self::Base(axis) = self {
            *arm.base_place_mut(axis)? = value;
        }
        for cable in self.cables(arm) {
            arm.cables[cable].tension *= value;
        }
        Ok(())
    }

    /// The cables whose given tensions it multiplies.
    fn cables(self, arm: &Arm) -> Vec<usize> {
        let given = arm.cables.iter().enumerate().filter(|(_, cable)| cable.stroke.is_none()).map(|(c, _)| c);
        given
            .filter(|c| match self {
                Self::Of(_) | Self::Base(_) => false,
                Self::TensionFactor => true,
                Self::CableFactor(own) => own == *c,
            })
            .collect()
    }
}

/// `arm` with these values, factors after tensions.
pub(crate) fn set_all(arm: &Arm, unknowns: &[Unknown], x: &[f64]) -> Arm {
    let mut arm = arm.clone();
    let ordered = unknowns.iter().zip(x);
    let factors = ordered.clone().filter(|(one, _)| one.parameter().is_none());
    for (one, x) in ordered.filter(|(one, _)| one.parameter().is_some()).chain(factors) {
        // That the arm has it was checked.
        let _ = one.set(&mut arm, *x);
    }
    arm
}

/// The derivatives by unknowns as sums over those by numbers of the arm.
#[derive(Debug, Clone)]
pub(crate) struct Chain {
    /// The numbers of the arm that there are derivatives by.
    pub(crate) parameters: Vec<Parameter>,
    /// Of each unknown: indices in these, with weights.
    pub(crate) sums: Vec<Vec<(usize, f64)>>,
    /// Which unknowns move places along which axis.
    moves: Vec<Option<usize>>,
}

impl Chain {
    /// At the values `x` of the unknowns; `given` is the arm without factors.
    pub(crate) fn new(given: &Arm, unknowns: &[Unknown], x: &[f64]) -> Self {
        let numbers: Vec<Unknown> = unknowns.iter().copied().filter(|one| one.parameter().is_some()).collect();
        let values: Vec<f64> =
            unknowns.iter().zip(x).filter(|(one, _)| one.parameter().is_some()).map(|(_, x)| *x).collect();
        let tensions = set_all(given, &numbers, &values);
        // What multiplies the tension of a cable, but for one factor.
        let others = |c: usize, but: Option<Unknown>| -> f64 {
            let own = unknowns.iter().zip(x).filter(|(one, _)| Some(**one) != but && one.cables(given).contains(&c));
            own.map(|(_, x)| *x).product()
        };
        let mut out = Self { parameters: Vec::new(), sums: Vec::new(), moves: Vec::new() };
        for unknown in unknowns {
            let sum = match unknown {
                Unknown::Of(Parameter::Tension(c)) => vec![(out.index(Parameter::Tension(*c)), others(*c, None))],
                Unknown::Of(parameter) => vec![(out.index(*parameter), 1.0)],
                _ => {
                    let pulled = unknown.cables(given).into_iter();
                    // With the tensions t = f T, d/df = sum T d/dt.
                    let weights = pulled.map(|c| (c, tensions.cables[c].tension * others(c, Some(*unknown))));
                    weights
                        .filter(|(_, weight)| *weight != 0.0)
                        .map(|(c, weight)| (out.index(Parameter::Tension(c)), weight))
                        .collect()
                }
            };
            out.sums.push(sum);
            out.moves.push(if let Unknown::Base(k) = unknown { Some(*k) } else { None });
        }
        out
    }

    /// The derivatives of a quantity by the unknowns, of those by the numbers of the arm.
    pub(crate) fn row(&self, quantity: Quantity, by: impl Fn(usize) -> f64) -> Vec<f64> {
        let along = quantity.marker().map(|(_, axis)| axis);
        let one = |(sum, moves): (&Vec<(usize, f64)>, &Option<usize>)| {
            let moved = if moves.is_some() && *moves == along { 1.0 } else { 0.0 };
            moved + sum.iter().map(|(k, weight)| weight * by(*k)).sum::<f64>()
        };
        self.sums.iter().zip(&self.moves).map(one).collect()
    }

    fn index(&mut self, parameter: Parameter) -> usize {
        let at = self.parameters.iter().position(|own| *own == parameter);
        at.unwrap_or_else(|| {
            self.parameters.push(parameter);
            self.parameters.len() - 1
        })
    }
}
