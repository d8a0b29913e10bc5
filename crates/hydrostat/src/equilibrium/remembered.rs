//! What the last evaluation left at the stations, there and between them.

use hydrostat_bvp::{Hermite, LANES, Lanes, Real};

use super::Equations;
use crate::swelling::swelling;

impl Equations {
    /// Strains at station `k`.
    pub(crate) fn strain(&self, k: usize) -> [f64; 3] {
        let (block, lane) = self.groups.station(k);
        self.memory[block].strain.map(|v| v.0[lane])
    }

    /// Strains, beta' and beta'' at station `k`.
    pub(crate) fn station_guess(&self, k: usize) -> ([f64; 3], f64, f64) {
        let (block, lane) = self.groups.station(k);
        (self.strain(k), self.beta.slope[block].0[lane], self.beta.curvature[block].0[lane])
    }

    /// Switch `which` of the load at stage `j` of element `i`.
    pub(crate) fn switch(&self, i: usize, j: usize, which: usize) -> f64 {
        let (block, lane) = self.groups.at(i, j);
        self.switches[block][which].0[lane]
    }

    /// Strains, and beta' and beta'', between the stages of element `i`, weighed by `weights`.
    pub(crate) fn remembered<const M: usize>(&self, i: usize, weights: &[f64; M]) -> ([f64; 3], [f64; 2]) {
        let mut strain = [0.0; 3];
        let mut beta = [0.0; 2];
        for (j, w) in weights.iter().enumerate() {
            let (block, lane) = self.groups.at(i, j);
            for a in 0..3 {
                strain[a] += w * self.memory[block].strain[a].0[lane];
            }
            beta[0] += w * self.beta.slope[block].0[lane];
            beta[1] += w * self.beta.curvature[block].0[lane];
        }
        (strain, beta)
    }

    /// [`Equations::remembered`] with beta' and beta'' from the polynomial through beta and beta' at the stages where
    /// the element is long enough for it.
    pub(crate) fn remembered_sharply<const M: usize>(
        &self,
        i: usize,
        weights: &[f64; M],
        sharp: &Hermite<M>,
    ) -> ([f64; 3], [f64; 2]) {
        let (mut strain, mut beta) = ([0.0; 3], [0.0; 2]);
        let (group, own) = (i / LANES, i % LANES);
        let inverse = 1.0 / self.steps[group].0[own];
        if self.beta.is_short(group, own, inverse) {
            return self.remembered(i, weights);
        }
        for l in 0..M {
            let block = group * self.groups.stages + l;
            for a in 0..3 {
                strain[a] += weights[l] * self.memory[block].strain[a].0[own];
            }
            let (value, slope) = (self.beta.value[block].0[own] * inverse, self.beta.slope[block].0[own]);
            beta[0] += sharp.slope[0][l] * value + sharp.slope[1][l] * slope;
            beta[1] += (sharp.curvature[0][l] * value + sharp.curvature[1][l] * slope) * inverse;
        }
        (strain, beta)
    }

    /// Strains of the unloaded arm at station `k`, mu times L.
    pub(crate) fn reference_strain(&self, k: usize) -> [f64; 3] {
        let (block, lane) = self.groups.station(k);
        self.places[block].stiffness.reference.map(|v| v.0[lane])
    }

    /// Takes the reference strains at every station.
    pub(crate) fn forget_strains(&mut self) {
        for (memory, place) in self.memory.iter_mut().zip(&self.places) {
            memory.strain = place.stiffness.reference;
        }
    }

    /// Place (over L), nu and mu (times L), and beta R (over L), in a lane of a block.
    pub(crate) fn stretched(&self, block: usize, lane: usize) -> (f64, [f64; 2], f64) {
        let (place, [nu, _, mu]) = (&self.places[block], self.memory[block].strain);
        let half_width = self.beta.value[block] * place.body.radius;
        (place.s.0[lane], [nu.0[lane], mu.0[lane]], half_width.0[lane])
    }

    /// Strain measure 1/2 (C1 (nu-nu_o)^2 + C2 (eta-eta_o)^2 + C3 (mu-mu_o)^2) A per length in a block of stations.
    #[inline(always)]
    pub(crate) fn strain_energy(&self, block: usize) -> Lanes {
        let stiffness = &self.places[block].stiffness;
        let strain = self.memory[block].strain;
        let beta = swelling(self.volume, strain[0]).beta;
        let mut sum = Lanes::of(0.0);
        for a in 0..3 {
            let strained = strain[a] - stiffness.reference[a];
            sum += Lanes::of(0.5) * stiffness.value[a] * beta * beta * strained * strained;
        }
        sum
    }
}
