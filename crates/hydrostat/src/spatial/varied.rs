//! The equations of an arm in space whose loads, support or material follow one parameter over a range, as in the
//! plane.

use std::f64::consts::TAU;

use hydrostat_bvp::{Forcing, Lanes, each};

use super::equations::{Equations, L, N, Q};
use super::loads::water;
use super::place::base_of;
use super::rotation::{Directors, Vector, spin, times, turned};
use super::section::CableAt;
use crate::rod::arm::Arm;
use crate::rod::parameter::Parameter;
use crate::statics::equations::{Change, StrokeControl, Varied};
use crate::statics::path::traced::Turn;
use crate::statics::verdict::Phase;

impl Equations {
    /// Lets `parameter` run from `from` to `to`; the equations are at fraction 0 of the range.
    pub(super) fn vary(&mut self, parameter: Parameter, from: f64, to: f64) {
        self.vary_together(vec![Change { parameter, from, to }]);
    }

    /// Lets several parameters run together, along a straight line; the equations are at fraction 0 of it.
    pub(crate) fn vary_together(&mut self, ways: Vec<Change>) {
        self.varied = Some(Varied { ways, fraction: 0.0 });
        self.set_range_fraction(0.0);
    }

    /// Takes the place of the base of another arm, which moves the arm as it is.
    pub(crate) fn take_place_of_base(&mut self, arm: &Arm) {
        (self.arm.base.x, self.arm.base.y) = (arm.base.x, arm.base.y);
        let z = arm.space.as_ref().map_or(0.0, |space| space.z);
        self.arm.space.get_or_insert_default().z = z;
        self.space.z = z;
    }

    /// Lets the base turn about `axis`, a unit vector in space, once round; the equations are at fraction 0.
    pub(super) fn turn_base(&mut self, axis: Vector<f64>) {
        self.turning = Some(axis);
        self.varied = Some(Varied { ways: Vec::new(), fraction: 0.0 });
        self.set_range_fraction(0.0);
    }

    /// Turns the base about `axis` by a number of turns, where it stays while loads rise.
    pub(super) fn stand_turned(&mut self, axis: Vector<f64>, turns: f64) {
        self.turn_base(axis);
        self.set_range_fraction(turns);
        let base = self.base;
        self.hold();
        self.base = base;
    }

    /// Lets nothing vary: the base is where the arm has it.
    pub(super) fn hold(&mut self) {
        self.turning = None;
        self.varied = None;
        self.take_base();
    }

    /// The change of the equations a turn of the base, at a fixed solution.
    pub(super) fn change_by_turn(&self, axis: &Vector<f64>) -> Forcing<N, Q, L> {
        let about = times(TAU, &Directors::of(&self.base).to_body(axis));
        let moved = spin(&self.base, &about);
        let mut out = Forcing::default();
        for k in 0..4 {
            out.left[k] = -moved[k];
        }
        out
    }

    /// The parameter's value at a fraction of its range.
    pub(super) fn value_at(&self, fraction: f64) -> f64 {
        self.varied_over().and_then(|ways| ways.first()).map_or(fraction, |way| way.value(fraction))
    }

    /// Where in the range the equations are.
    pub(super) fn range_fraction(&self) -> f64 {
        self.varied.as_ref().map_or(0.0, |v| v.fraction)
    }

    /// Takes the arm at a fraction of the range, within it or beyond.
    pub(crate) fn set_range_fraction(&mut self, fraction: f64) {
        let Some(varied) = &mut self.varied else { return };
        varied.fraction = fraction;
        for way in varied.ways.clone() {
            self.set_parameter(way.parameter, way.value(fraction));
        }
        if self.turning.is_some() {
            self.take_base();
        }
    }

    /// Takes the arm with another value of a parameter that it was checked to have.
    pub(super) fn set_parameter(&mut self, parameter: Parameter, value: f64) {
        let _ = parameter.set(&mut self.arm, value);
        self.take_arm(parameter.is_of_sections());
    }

    /// Takes loads, base and tensions of the arm of other equations, which may be at another fraction of a range,
    /// before anything is placed.
    pub(super) fn take_arm_of(&mut self, other: &Self) {
        if other.varied.is_some() {
            self.arm.clone_from(&other.arm);
            self.take_arm(false);
            self.base = other.base;
        }
        self.tensions.clone_from(&other.tensions);
    }

    /// Takes all that follows from the arm but the data of sections, and these where they changed.
    pub(super) fn take_arm(&mut self, sections: bool) {
        self.space = self.arm.space.clone().unwrap_or_default();
        self.upright.clone_from(&self.arm);
        self.take_gravity();
        self.water = water(&self.arm);
        self.take_base();
        self.set_tensions();
        if sections {
            self.take_sections();
        }
    }

    /// Takes loads, stream, base and tensions of an arm of the same geometry and material.
    pub(crate) fn set_loads(&mut self, arm: &Arm) {
        let own = &self.arm;
        let forces =
            |arm: &Arm| arm.space.as_ref().map(|space| (space.force.clone(), space.couple.clone(), space.gravity));
        let same_sections =
            own.gravity == arm.gravity && own.distributed == arm.distributed && forces(own) == forces(arm);
        self.arm.clone_from(arm);
        self.take_arm(!same_sections);
    }

    /// Takes another unit of force, N, before anything is placed.
    pub(crate) fn set_force_unit(&mut self, force: f64) {
        self.units.force = force;
        self.set_tensions();
    }

    /// Where the base is, over L.
    pub(crate) fn base_place(&self) -> [f64; 3] {
        [self.arm.base.x, self.arm.base.y, self.space.z].map(|v| v / self.units.length)
    }

    pub(super) fn take_gravity(&mut self) {
        if let Some(gravity) = &mut self.upright.gravity {
            gravity.direction = 0.0;
        }
        let pull = self.arm.gravity_in_space();
        let size = pull.iter().map(|v| v * v).sum::<f64>().sqrt();
        self.gravity = if size > 0.0 { pull.map(|v| v / size) } else { [0.0; 3] };
    }

    /// The quaternion of the base; of both that mean it, that nearer to the last one.
    fn take_base(&mut self) {
        let mut base = base_of(&self.arm);
        if let Some(axis) = &self.turning {
            base = turned(&base, &times(TAU * self.range_fraction(), &Directors::of(&base).to_body(axis)));
        }
        let along: f64 = (0..4).map(|k| base[k] * self.base[k]).sum();
        self.base = if along < 0.0 { base.map(|v| -v) } else { base };
    }

    /// Takes the data of sections and cables anew at all stations and ends.
    fn take_sections(&mut self) {
        let count = self.tensions.len();
        for block in 0..self.places.len() {
            let s = self.places[block].s;
            self.places[block] = self.place_four(s);
            for c in 0..count {
                let own = block * count + c;
                self.cables[own] = CableAt { tension: self.cables[own].tension, ..self.cable_four(c, s) };
            }
        }
        for block in 0..self.end_sections.len() {
            let s = self.end_sections[block].0;
            self.end_sections[block].1 = self.place_four(s).stiffness;
            for c in 0..count {
                let own = block * count + c;
                self.end_cables[own] = CableAt { tension: self.end_cables[own].tension, ..self.cable_four(c, s) };
            }
        }
    }

    /// What is varied.
    pub(super) fn varied_over(&self) -> Option<&[Change]> {
        self.varied.as_ref().map(|varied| varied.ways.as_slice())
    }

    /// Makes the derivative by the parameter that by a couple along the arm, about the directors, over s/L.
    pub(super) fn impose_couple(&mut self, couple: Option<&dyn Fn(f64) -> Turn>) {
        self.imposed = couple.map(|couple| {
            let four = |s: Lanes| {
                let own: [Turn; 4] = each(|lane| couple(s.0[lane]));
                each(|k| Lanes(each(|lane| own[lane][k])))
            };
            self.places.iter().map(|place| four(place.s)).collect()
        });
    }

    /// The change of the stroke that is commanded of held cable `index` a unit of the parameter, over L.
    pub(super) fn command_derivative(&self, stroke_control: &StrokeControl, index: usize) -> f64 {
        let cable = stroke_control.cables[index];
        match self.varied_over() {
            _ if self.imposed.is_some() => 0.0,
            Some(ways) => {
                let own = ways.iter().find(|way| way.parameter == Parameter::Stroke(cable));
                own.map_or(0.0, |way| way.whole() / self.units.length)
            }
            None if self.phase == Phase::Stroke => {
                self.arm.cables[cable].stroke.unwrap_or(0.0) / self.units.length - stroke_control.from[index]
            }
            _ => 0.0,
        }
    }
}
