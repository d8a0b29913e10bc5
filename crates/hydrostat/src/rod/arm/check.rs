//! Whether numbers make an arm.

use std::fmt;

use super::cable::Cable;
use super::error::ArmError;
use super::{Arm, FlowLaw, Material};
use crate::rod::profile::Profile;

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
            | Self::OutOfPlane { key }
            | Self::NotInSpace { key, .. }
            | Self::Table { key, .. } => key,
            Self::Direction { key, .. } => key,
            Self::OnlyInPlane { .. } => "arm.space",
            Self::InnerRadius { .. } => "arm.inner_radius",
            Self::TensionCount { .. } => "cable",
        }
    }
}

impl Arm {
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
        not_negative("dynamics.added_mass", self.dynamics.added_mass)?;
        not_negative("dynamics.relaxation_time", self.dynamics.relaxation_time)?;
        self.distributed.force[0].check("distributed.force[0]", length)?;
        self.distributed.force[1].check("distributed.force[1]", length)?;
        self.distributed.couple.check("distributed.couple", length)?;
        self.check_space(length)
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
        let key = |name: &'static str| CableKey { index, name };
        cable.offset.check(key("offset"), length)?;
        cable.angle.check(key("angle"), length)?;
        not_negative(key("tension"), cable.tension)?;
        if let Some(stroke) = cable.stroke {
            finite(key("stroke"), stroke)?;
            if stroke.abs() >= length {
                let expected = "shorter than the arm";
                return Err(ArmError::OutOfRange { key: key("stroke").to_string(), value: stroke, expected });
            }
        }
        not_negative(key("friction"), cable.friction)?;
        if cable.friction > 2.0 {
            let expected = "in [0, 2]";
            return Err(ArmError::OutOfRange { key: key("friction").to_string(), value: cable.friction, expected });
        }
        if let Some(stiffness) = cable.stiffness {
            positive(key("stiffness"), stiffness)?;
        }
        if let Some(max_tension) = cable.max_tension {
            positive(key("max_tension"), max_tension)?;
            if cable.tension > max_tension && cable.stroke.is_none() {
                return Err(ArmError::TensionAboveMax {
                    key: key("tension").to_string(),
                    tension: cable.tension,
                    max_tension,
                });
            }
        }
        finite(key("end"), cable.end)?;
        if !(cable.end > 0.0 && cable.end <= 1.0) {
            return Err(ArmError::OutOfRange { key: key("end").to_string(), value: cable.end, expected: "in (0, 1]" });
        }
        for s in self.places(&[&self.radius, &cable.offset], cable.end * length) {
            let (offset, radius) = (cable.offset.at(s, length).value, self.radius.at(s, length).value);
            if offset.abs() > radius * (1.0 + 1e-12) {
                return Err(ArmError::OffsetOutside { key: key("offset").to_string(), s, offset, radius });
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

/// The key of a cable's quantity, which is only written where something is wrong.
#[derive(Clone, Copy)]
struct CableKey {
    index: usize,
    name: &'static str,
}

impl fmt::Display for CableKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cable[{}].{}", self.index, self.name)
    }
}

pub(super) fn finite(key: impl fmt::Display, value: f64) -> Result<f64, ArmError> {
    if value.is_finite() { Ok(value) } else { Err(ArmError::NotFinite { key: key.to_string() }) }
}

fn positive(key: impl fmt::Display, value: f64) -> Result<f64, ArmError> {
    if finite(&key, value)? > 0.0 {
        Ok(value)
    } else {
        Err(ArmError::NotPositive { key: key.to_string(), value, s: None })
    }
}

fn not_negative(key: impl fmt::Display, value: f64) -> Result<f64, ArmError> {
    if finite(&key, value)? >= 0.0 { Ok(value) } else { Err(ArmError::Negative { key: key.to_string(), value }) }
}

pub(super) fn positive_profile(key: &str, profile: &Profile, length: f64) -> Result<(), ArmError> {
    profile.check(key, length)?;
    let places = std::iter::once(0.0).chain(profile.knots().iter().copied()).chain(std::iter::once(length));
    for s in places {
        let value = profile.at(s, length).value;
        if value <= 0.0 {
            return Err(ArmError::NotPositive { key: key.to_string(), value, s: Some(s) });
        }
    }
    Ok(())
}
