//! Longitudinal cables.

use crate::rod::profile::Profile;

/// A longitudinal cable.
#[derive(Debug, Clone, PartialEq)]
pub struct Cable {
    /// A name for people.
    pub name: String,
    /// Signed offset y(s) in the straight arm, left positive, m; in space the distance from the centreline along the
    /// angle.
    pub offset: Profile,
    /// Angle of the offset in the section, from b towards c, rad: zero in the plane. A profile that turns along the arm
    /// routes a helix.
    pub angle: Profile,
    /// Tension T >= 0, N. With a commanded stroke it follows from that, and what is given here does not count.
    pub tension: f64,
    /// Commanded stroke, m: the length that is reeled in, of the cable's length at the reference strains; negative when
    /// paid out. See [`crate::statics::configuration::Command`].
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
            angle: 0.0.into(),
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
    pub fn with_friction(mut self, friction: f64, motion: Motion) -> Self {
        self.friction = friction;
        self.motion = motion;
        self
    }

    /// This cable at an angle (rad) in the section, from b towards c, for arms in space.
    pub fn at_angle(mut self, angle: impl Into<Profile>) -> Self {
        self.angle = angle.into();
        self
    }

    /// This cable anchored at the fraction `end` of the length.
    pub fn ending_at(mut self, end: f64) -> Self {
        self.end = end;
        self
    }
}
