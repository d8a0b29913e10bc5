//! The equations of an arm whose loads, support or material follow a range of parameters.

use super::range::{Change, Varied};
use super::system::{Equations, water};
use crate::rod::arm::Arm;
use crate::rod::parameter::Parameter;

impl Equations {
    /// Lets `parameter` run from `from` to `to`; the equations are at fraction 0 of the range.
    pub(crate) fn vary(&mut self, parameter: Parameter, from: f64, to: f64) {
        self.vary_together(vec![Change { parameter, from, to }]);
    }

    /// Lets several parameters run together, along a straight line; the equations are at fraction 0 of it.
    pub(crate) fn vary_together(&mut self, ways: Vec<Change>) {
        self.varied = Some(Varied { ways, fraction: 0.0 });
        self.set_range_fraction(0.0);
    }

    /// The value of the (first) parameter at a fraction of its range.
    pub(crate) fn value_at(&self, fraction: f64) -> f64 {
        self.varied_over().and_then(|ways| ways.first()).map_or(fraction, |way| way.value(fraction))
    }

    /// Takes the arm at a fraction of the range, within it or beyond.
    pub(crate) fn set_range_fraction(&mut self, fraction: f64) {
        self.set_range_fraction_with(fraction, true);
    }

    /// [`Equations::set_range_fraction`], without what is along the arm where that is not asked for.
    pub(super) fn set_range_fraction_with(&mut self, fraction: f64, sections: bool) {
        let Some(varied) = &mut self.varied else { return };
        varied.fraction = fraction;
        for way in &varied.ways {
            // That the arm has the parameter was checked when the range was.
            let _ = way.parameter.set(&mut self.arm, way.value(fraction));
        }
        let of_sections = varied.ways.iter().any(|way| way.parameter.is_of_sections());
        self.take_arm(sections && of_sections);
    }

    /// Takes the arm of other equations, which may be at another fraction of a range.
    pub(crate) fn take_arm_of(&mut self, other: &Self) {
        if let Some(varied) = &other.varied {
            self.arm.clone_from(&other.arm);
            self.take_arm(varied.ways.iter().any(|way| way.parameter.is_of_sections()));
        }
        self.tensions.clone_from(&other.tensions);
    }

    /// Varies nothing any more: the arm is `arm`, of the same geometry and material, with all angles less by whole
    /// turns.
    pub(crate) fn hold(&mut self, arm: &Arm) {
        self.varied = None;
        self.arm.clone_from(arm);
        self.take_arm(false);
    }

    pub(super) fn take_arm(&mut self, sections: bool) {
        // The state is in units of the length that the arm has now; the unit of force stays.
        self.units.length = self.arm.length;
        self.water = water(&self.arm);
        self.set_tensions();
        if sections {
            self.take_sections();
        }
    }

    /// What is varied.
    pub(super) fn varied_over(&self) -> Option<&[Change]> {
        self.varied.as_ref().map(|varied| varied.ways.as_slice())
    }

    /// Sets the tension of one cable, N.
    pub(crate) fn set_tension(&mut self, cable: usize, tension: f64) {
        self.arm.cables[cable].tension = tension;
        self.tensions[cable] = tension / self.units.force;
    }

    /// Where in the range the equations are.
    pub(crate) fn range_fraction(&self) -> f64 {
        self.varied.as_ref().map_or(0.0, |v| v.fraction)
    }

    /// Makes the derivative by the parameter that by a couple along the arm, of the shape `couple` over s/L.
    pub(crate) fn impose_couple(&mut self, couple: Option<&dyn Fn(f64) -> f64>) {
        self.imposed = couple.map(|couple| self.stations.iter().map(|s| couple(*s)).collect());
    }

    /// The same equations without stations, for the conditions at the ends.
    pub(super) fn without_stations(&self) -> Self {
        Self {
            arm: self.arm.clone(),
            tensions: self.tensions.clone(),
            ends: self.ends.clone(),
            varied: self.varied.clone(),
            stroke_control: self.stroke_control.clone(),
            capstan: None,
            imposed: None,
            stations: Vec::new(),
            places: Vec::new(),
            cables: Vec::new(),
            end_places: Vec::new(),
            end_sections: Vec::new(),
            end_cables: Vec::new(),
            #[cfg(test)]
            manufactured: None,
            ..*self
        }
    }
}
