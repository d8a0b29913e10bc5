//! The equations of an arm whose loads, support or material follow one parameter over a range.

use hydrostat_bvp::{Local, Problem, Real, each};

use super::{Column, Equations, LANES, Lanes, N};
use crate::arm::{Arm, TipLoad};
use crate::parameter::Parameter;

/// Part of the range over which derivatives by the parameter are differences of, on either side. Rounding is then about 1e-10 of what is
/// differenced, the error of the second order 1e-12 of the third derivative by the share, which is large where the range is wide.
const DIFFERENCE: f64 = 1e-6;

/// An arm along the range of a parameter.
#[derive(Debug, Clone)]
pub(crate) struct Varied {
    parameter: Parameter,
    /// Values at the shares 0 and 1 of the range.
    from: f64,
    to: f64,
    /// Where the equations are.
    share: f64,
}

impl Varied {
    fn value(&self, share: f64) -> f64 {
        self.from + share * (self.to - self.from)
    }
}

impl Equations {
    /// Lets `parameter` run from `from` to `to`; the equations are at share 0 of the range.
    pub(crate) fn vary(&mut self, parameter: Parameter, from: f64, to: f64) {
        self.varied = Some(Varied { parameter, from, to, share: 0.0 });
        self.set_share(0.0);
    }

    /// The parameter's value at a share of its range.
    pub(crate) fn value_at(&self, share: f64) -> f64 {
        self.varied.as_ref().map_or(share, |v| v.value(share))
    }

    /// Takes the arm at a share of the range, within it or beyond.
    pub(crate) fn set_share(&mut self, share: f64) {
        let Some(varied) = &mut self.varied else { return };
        varied.share = share;
        let (parameter, value) = (varied.parameter, varied.value(share));
        // That the arm has the parameter was checked when the range was.
        let _ = parameter.set(&mut self.arm, value);
        self.take_arm(parameter.is_of_sections());
    }

    /// Takes the arm of other equations, which may be at another share of a range.
    pub(crate) fn take_arm_of(&mut self, other: &Self) {
        if let Some(varied) = &other.varied {
            self.arm.clone_from(&other.arm);
            self.take_arm(varied.parameter.is_of_sections());
        }
        self.tensions.clone_from(&other.tensions);
    }

    /// Varies nothing any more: the arm is `arm`, of the same geometry and material, with all angles less by whole
    /// turns of the size `angle`.
    pub(crate) fn hold(&mut self, arm: &Arm, angle: f64) {
        self.varied = None;
        for memory in &mut self.memory {
            memory.z[0] -= Lanes::of(angle);
        }
        self.arm.clone_from(arm);
        self.take_arm(false);
    }

    fn take_arm(&mut self, sections: bool) {
        self.water = super::water(&self.arm);
        self.set_tensions();
        if sections {
            self.take_sections();
        }
    }

    /// What is varied, and by how much over its range.
    pub(super) fn varied_over(&self) -> Option<(Parameter, f64)> {
        self.varied.as_ref().map(|v| (v.parameter, v.to - v.from))
    }

    /// Sets the tension of one cable, N.
    pub(crate) fn set_tension(&mut self, cable: usize, tension: f64) {
        self.arm.cables[cable].tension = tension;
        self.tensions[cable] = tension / self.units.force;
    }

    /// Where in the range the equations are.
    pub(crate) fn share(&self) -> f64 {
        self.varied.as_ref().map_or(0.0, |v| v.share)
    }

    /// Makes the derivative by the parameter that by a couple along the arm, of the shape `couple` over s/L.
    pub(crate) fn impose_couple(&mut self, couple: Option<&dyn Fn(f64) -> f64>) {
        self.imposed = couple.map(|couple| self.stations.iter().map(|s| couple(*s)).collect());
    }

    /// What follows the parameter, `change` of the range further: itself, at the last state.
    fn moved_on(&self, change: f64) -> Option<Self> {
        let share = self.varied.as_ref()?.share;
        let mut moved = self.clone();
        moved.set_share(share + change);
        Some(moved)
    }

    /// d z' / d share at the state of the last evaluation. False where no parameter is varied or where a
    /// section has no strains so near.
    pub(super) fn drift_by_share(&mut self, out: &mut [[Lanes; N]]) -> bool {
        if let Some(couple) = &self.imposed {
            self.column.clear(out.len());
            for (block, drift) in out.iter_mut().enumerate() {
                *drift = [Lanes::of(0.0); N];
                for lane in 0..LANES {
                    drift[N - 1].0[lane] = -couple[self.groups.station_in(block, lane)];
                }
            }
            return true;
        }
        let state: Vec<[Lanes; N]> = self.memory.iter().map(|memory| memory.z).collect();
        let mut sides = [vec![Local::default(); out.len()], vec![Local::default(); out.len()]];
        let mut ends = [Column::default(), Column::default()];
        for ((side, locals), end) in [-DIFFERENCE, DIFFERENCE].into_iter().zip(&mut sides).zip(&mut ends) {
            let Some(mut moved) = self.moved_on(side) else { return false };
            if moved.slopes::<false>(self.groups, &state, locals).is_err() {
                return false;
            }
            if self.held.is_some() {
                end.strain = moved.memory.iter().map(|memory| memory.strain).collect();
                end.beta_slope = moved.beta.slope;
            }
        }
        let over = |after: Lanes, before: Lanes| (after - before) / Lanes::of(2.0 * DIFFERENCE);
        let [before, after] = &ends;
        let strains = after.strain.iter().zip(&before.strain);
        self.column.strain = strains.map(|(after, before)| each(|k| over(after[k], before[k]))).collect();
        let slopes = after.beta_slope.iter().zip(&before.beta_slope);
        self.column.beta_slope = slopes.map(|(after, before)| over(*after, *before)).collect();
        let [before, after] = &sides;
        for (k, drift) in out.iter_mut().enumerate() {
            for a in 0..N {
                drift[a] = over(after[k].slope[a], before[k].slope[a]);
            }
        }
        true
    }

    /// d (base angle) / d share.
    pub(super) fn base_turn(&self) -> f64 {
        match &self.varied {
            Some(Varied { parameter: Parameter::BaseAngle, from, to, .. })
                if self.imposed.is_none() && self.pulled.is_none() =>
            {
                to - from
            }
            _ => 0.0,
        }
    }

    /// d (tip load) / d share at the angle `theta` of the tip.
    pub(super) fn tip_drift(&self, theta: f64) -> [f64; 3] {
        let Some(varied) = self.varied.as_ref().filter(|_| self.imposed.is_none() && self.pulled.is_none()) else {
            return [0.0; 3];
        };
        self.tip_load_by(varied.parameter, theta).map(|by| by * (varied.to - varied.from))
    }

    /// d (tip load) / d parameter at the angle `theta` of the tip.
    pub(crate) fn tip_load_by(&self, parameter: Parameter, theta: f64) -> [f64; 3] {
        let mut tip = TipLoad::default();
        match parameter {
            Parameter::TipForce(k) => tip.force[k.min(1)] = 1.0,
            Parameter::TipMoment => tip.moment = 1.0,
            Parameter::TipFollower(k) => tip.follower[k.min(1)] = 1.0,
            _ => return [0.0; 3],
        }
        self.load_of(&tip, theta).0
    }
}
