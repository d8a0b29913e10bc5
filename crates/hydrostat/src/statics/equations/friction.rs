//! What friction leaves of the tensions, in the equations: see [`crate::statics::friction`].

use super::at_place::AtPlace;
use super::system::Equations;
use crate::statics::friction::Grip;

impl Equations {
    /// Angle of cable `c` from the section normal at a place.
    pub(crate) fn cable_angle(&self, c: usize, s: f64, at: &AtPlace) -> f64 {
        let offset = self.offset(c, s);
        let [nu, eta, mu] = at.strain;
        let along = nu - offset.y * at.beta * mu;
        (eta + offset.slope * at.beta + offset.y * at.beta_slope).atan2(along)
    }

    /// Takes what friction leaves of the tensions, at every station.
    pub(crate) fn set_grip(&mut self, grip: Option<&Grip>) {
        self.grip = grip.cloned();
        self.take_pulls();
    }

    /// What friction leaves of the tension of cable `c` at `s`.
    pub(crate) fn pull_share(&self, c: usize, s: f64, from_left: bool) -> f64 {
        self.grip.as_ref().map_or(1.0, |grip| grip.share(c, s, from_left))
    }
}
