//! The paths that cables take through the deformed arm in space, and their strokes: as in the plane.
//!
//! The stroke of a cable is its length at the reference strains less its present one. An elastic cable of stiffness
//! EA is longer by T/EA of its unstretched length, so that what is reeled in of it is counted unstretched:
//!
//! ```text
//! stroke = int |tau_ref| ds - int |tau| ds / (1 + T/EA)
//! ```

use hydrostat_bvp::{Collocation, Correction, Lanes, Real, Solution, Stage};

use super::equations::{Equations, L, N, Q};
use super::rotation::{cross, dot, times};
use super::section::{STRAINS, tangent};
use crate::rod::area_law::area_law;
use crate::rod::parameter::Parameter;
use crate::statics::equations::{PLACES, Way};

/// Strains at the stages of a solution, with what integrates over them.
#[derive(Clone, Copy)]
pub(crate) struct StageData<'a> {
    /// Of the stages.
    pub(crate) weights: &'a [f64],
    /// Lengths of elements, a group.
    pub(crate) steps: &'a [Lanes],
    pub(crate) stages: &'a [Stage<N, L>],
}

impl<'a> StageData<'a> {
    /// Of a solution that `system` was evaluated at.
    pub(super) fn of<const S: usize>(system: &'a Collocation<N, S, Q, L>, solution: &'a Solution<N, S, L>) -> Self {
        Self { weights: &system.gauss.b, steps: system.steps(), stages: &solution.stages }
    }
}

impl Equations {
    /// Sums `value` over the path of cable `c`.
    fn along_cable(&self, c: usize, at: StageData<'_>, value: impl Fn(usize) -> Lanes) -> f64 {
        let groups = self.groups;
        let mut sum = 0.0;
        for block in 0..groups.count() * groups.stages {
            let (group, stage) = (block / groups.stages, block % groups.stages);
            let value = value(block) * self.cables_in(block)[c].tension;
            for lane in 0..groups.filled(group) {
                sum += at.steps[group].0[lane] * at.weights[stage] * value.0[lane];
            }
        }
        sum
    }

    /// |tau| of cable `c` in a block of stations.
    fn stretch(&self, c: usize, block: usize, stage: &Stage<N, L>) -> Lanes {
        let section_stretch = area_law(self.volume, stage.inner[0]);
        let tau = tangent(&self.cables_in(block)[c], &stage.inner, &section_stretch, stage.closure_slope).tau;
        dot(&tau, &tau).sqrt()
    }

    /// |tau| of cable `c` in a block of stations at the reference strains.
    fn reference_stretch(&self, c: usize, block: usize) -> Lanes {
        let place = &self.places[block];
        let section_stretch = area_law(self.volume, place.stiffness.reference[0]);
        let slope = section_stretch.slope * place.reference_slope;
        let tau = tangent(&self.cables_in(block)[c], &place.stiffness.reference, &section_stretch, slope).tau;
        dot(&tau, &tau).sqrt()
    }

    /// Lengths of the path of cable `c`, now and at the reference strains, over L.
    pub(crate) fn cable_lengths(&self, c: usize, at: StageData<'_>) -> [f64; 2] {
        [
            self.along_cable(c, at, |block| self.stretch(c, block, &at.stages[block])),
            self.along_cable(c, at, |block| self.reference_stretch(c, block)),
        ]
    }

    /// 1 + T/EA of cable `c`, and its derivative by the tension (in the unit of force).
    fn elongation(&self, c: usize) -> [f64; 2] {
        let per_force = self.arm.cables[c].stiffness.map_or(0.0, |stiffness| self.units.force / stiffness);
        [1.0 + per_force * self.tension(c), per_force]
    }

    /// Unstretched stroke of cable `c`, over L, and its derivative by the tension (in the unit of force).
    pub(crate) fn stroke(&self, c: usize, at: StageData<'_>) -> [f64; 2] {
        let [now, unloaded] = self.cable_lengths(c, at);
        let [longer, by_tension] = self.elongation(c);
        [unloaded - now / longer, now * by_tension / (longer * longer)]
    }

    /// Change of the stroke of cable `c` (over L) with a change of the solution, at fixed tension.
    pub(crate) fn stroke_change<const A: usize, const S: usize, const P: usize>(
        &self,
        c: usize,
        at: StageData<'_>,
        change: &Correction<A, S, P, L>,
    ) -> f64 {
        let longer = self.along_cable(c, at, |block| {
            let (by_strain, by_beta_slope) = self.stretch_gradient(c, block, &at.stages[block]);
            let stage = &change.stages[block];
            let mut sum = by_beta_slope * stage.closure_slope;
            for k in 0..STRAINS {
                sum += by_strain[k] * stage.inner[k];
            }
            sum
        });
        -longer / self.elongation(c)[0]
    }

    /// What a change of |tau| changes the stroke of cable `c` by, as it is commanded.
    pub(super) fn stroke_by_stretch(&self, c: usize) -> f64 {
        -1.0 / self.elongation(c)[0]
    }

    /// How the stroke of cable `c` (of its path, or as it is commanded) follows `way` at a fixed solution, over L.
    pub(super) fn stroke_by(&self, c: usize, commanded: bool, way: Way, at: StageData<'_>) -> f64 {
        let geometric =
            matches!(way, Way::Of(Parameter::Offset(..) | Parameter::CableAngle(..) | Parameter::Reference(..)));
        let pulled = commanded && matches!(way, Way::Of(Parameter::Tension(k)) if k == c);
        if !geometric && !pulled {
            return 0.0;
        }
        let stroke = |equations: &Self| {
            if commanded {
                return equations.stroke(c, at)[0];
            }
            let [now, reference] = equations.cable_lengths(c, at);
            reference - now
        };
        let step = way.step(&self.arm, self.units.force, self.varied_over());
        let one = |(steps, weight): (f64, f64)| {
            self.moved(way, steps * step).map_or(0.0, |moved| weight / step * stroke(&moved))
        };
        PLACES.into_iter().map(one).sum()
    }

    /// Derivatives of |tau| by the strains and by beta': d|tau| = t . dtau with
    /// dtau = dv + du x p + d(beta) (u x p + p')/beta + d(beta') p/beta.
    pub(super) fn stretch_gradient(&self, c: usize, block: usize, stage: &Stage<N, L>) -> ([Lanes; STRAINS], Lanes) {
        let section_stretch = area_law(self.volume, stage.inner[0]);
        let path = tangent(&self.cables_in(block)[c], &stage.inner, &section_stretch, stage.closure_slope);
        let t = times(Lanes::of(1.0) / dot(&path.tau, &path.tau).sqrt(), &path.tau);
        // t . (du x p) = du . (p x t).
        let lever = cross(&times(section_stretch.beta, &path.place), &t);
        let by_nu = t[0] + section_stretch.slope * dot(&t, &path.by_beta);
        ([by_nu, t[1], t[2], lever[0], lever[1], lever[2]], dot(&t, &path.place))
    }
}
