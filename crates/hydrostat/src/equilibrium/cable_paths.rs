//! The paths that cables take through the deformed arm.

use hydrostat_bvp::{Lanes, Real};

use super::Equations;
use crate::cable::tangent;
use crate::swelling::swelling;

impl Equations {
    /// |tau| of cable `c` in a block of stations, now and at the reference strains.
    #[inline(always)]
    fn cable_stretch(&self, c: usize, block: usize) -> [Lanes; 2] {
        let offset = &self.cables[block * self.tensions.len() + c].offset;
        let stiffness = &self.places[block].stiffness;
        let reference = swelling(self.volume, stiffness.reference[0]);
        let reference_slope = reference.slope * stiffness.reference_slope[0];
        let strain = self.memory[block].strain;
        [
            tangent(offset, strain, &swelling(self.volume, strain[0]), self.beta.slope[block]).stretch,
            tangent(offset, stiffness.reference, &reference, reference_slope).stretch,
        ]
    }

    /// chi' of cable `c` in a block of stations, over L: see [`crate::friction`].
    pub(crate) fn cable_turns(&self, c: usize, block: usize) -> Lanes {
        let offset = &self.cables[block * self.tensions.len() + c].offset;
        let [nu, eta, mu] = self.memory[block].strain;
        let [nu_s, eta_s, mu_s] = self.strain_slopes[block];
        let beta = swelling(self.volume, nu).beta;
        let (beta_s, beta_ss) = (self.beta.slope[block], self.beta.curvature[block]);
        let along = nu - offset.y * beta * mu;
        let across = eta + offset.slope * beta + offset.y * beta_s;
        let along_s = nu_s - (offset.slope * beta + offset.y * beta_s) * mu - offset.y * beta * mu_s;
        let twice = Lanes::of(2.0) * offset.slope * beta_s;
        let across_s = eta_s + offset.curvature * beta + twice + offset.y * beta_ss;
        mu + (along * across_s - across * along_s) / (along * along + across * across)
    }

    /// Length of the path of cable `c`, now and at the reference strains, over L, with the weights of the stages.
    pub(crate) fn cable_lengths(&self, c: usize, weights: &[f64]) -> [f64; 2] {
        let mut lengths = [0.0; 2];
        let groups = self.groups();
        for block in 0..groups.count() * groups.stages {
            let (group, stage) = (block / groups.stages, block % groups.stages);
            let stretches = self.cable_stretch(c, block);
            for lane in 0..groups.filled(group) {
                if self.stations[groups.station_in(block, lane)] < self.ends[c] {
                    let weight = self.steps[group].0[lane] * weights[stage];
                    lengths[0] += weight * stretches[0].0[lane];
                    lengths[1] += weight * stretches[1].0[lane];
                }
            }
        }
        lengths
    }

    /// Stroke (over L) of cable `a` a unit of tension of cable `b` in the straight arm, by compression and bending.
    pub(crate) fn straight_compliance(&self, a: usize, b: usize) -> f64 {
        let end = self.ends[a].min(self.ends[b]);
        (0..64).map(|k| (f64::from(k) + 0.5) / 64.0).filter(|s| *s < end).fold(0.0, |sum, s| {
            let [axial, _, bending] = self.place(s).stiffness.value;
            sum + (1.0 / axial + self.offset(a, s).y * self.offset(b, s).y / bending) / 64.0
        })
    }

    /// Where cable `c` ends, over L.
    pub(crate) fn cable_end(&self, c: usize) -> f64 {
        self.ends[c]
    }
}
