//! What friction leaves of the tensions, in the equations: see [`crate::statics::friction`].

use super::section_state::SectionState;
use super::system::Equations;
use crate::statics::friction::CapstanFactors;

impl Equations {
    /// Angle of cable `c` from the section normal at a place.
    pub(crate) fn cable_angle(&self, c: usize, s: f64, at: &SectionState) -> f64 {
        let offset = self.offset(c, s);
        let [nu, eta, mu] = at.strain;
        let along = nu - offset.y * at.beta * mu;
        (eta + offset.slope * at.beta + offset.y * at.beta_slope).atan2(along)
    }

    /// Takes what friction leaves of the tensions, at every station.
    pub(crate) fn set_capstan(&mut self, capstan: Option<&CapstanFactors>) {
        self.capstan = capstan.cloned();
        self.take_pulls();
    }

    /// What friction leaves of the tension of cable `c` at `s`.
    pub(crate) fn tension_ratio(&self, c: usize, s: f64, from_left: bool) -> f64 {
        self.capstan.as_ref().map_or(1.0, |capstan| capstan.tension_ratio(c, s, from_left))
    }
}
