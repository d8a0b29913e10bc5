//! A solution and what is remembered of it, carried over to another mesh.

use hydrostat_bvp::{Mesh, Solution};

use super::{Engine, Guess};
use crate::equilibrium::N;

impl Engine {
    /// Moves the solution to another mesh.
    pub(crate) fn move_to(&mut self, mesh: Mesh) {
        std::mem::swap(&mut self.solution, &mut self.before);
        self.solution.mesh = mesh;
        self.come_from_before();
    }

    /// Carries the solution before over to the mesh of the present one.
    pub(super) fn come_from_before(&mut self) {
        self.meshes += 1;
        let gauss = &self.system.gauss;
        let old = &self.before;
        old.onto(gauss, &mut self.solution);
        let mesh = &self.solution.mesh;
        self.system.stations(mesh, &mut self.stations);
        self.guesses.clear();
        let mut element = 0;
        for s in &self.stations {
            while element + 1 < old.mesh.elements() && old.mesh.nodes()[element + 1] <= *s {
                element += 1;
            }
            let weights = gauss.cardinals((s - old.mesh.nodes()[element]) / old.mesh.step(element));
            let (strain, [slope, curvature]) = self.equations.remembered(element, &weights);
            self.guesses.push((strain, slope, curvature));
        }
        let guesses = &self.guesses;
        self.equations.place_stations(&self.stations, mesh, |k| guesses[k]);
    }

    /// Moves the solution on by `share` times its way from the solution `before`, nodes on kinks with it. Left as it is where the
    /// two do not correspond node by node.
    pub(crate) fn lead_on(&mut self, before: &Guess, share: f64) {
        let Some(mesh) = self.solution.mesh.led_on(&before.mesh, share) else { return };
        let lead = |own: &mut [f64; N], other: &[f64; N]| {
            for a in 0..N {
                own[a] += share * (own[a] - other[a]);
            }
        };
        let Solution { nodes, slopes, .. } = &mut self.solution;
        nodes.iter_mut().zip(&before.nodes).for_each(|(own, other)| lead(own, other));
        slopes.iter_mut().flatten().zip(before.slopes.iter().flatten()).for_each(|(own, other)| lead(own, other));
        if mesh == self.solution.mesh {
            return;
        }
        self.foresee();
        let remembered = (0..self.stations.len()).map(|k| self.equations.station_guess(k));
        self.guesses.clear();
        self.guesses.extend(remembered);
        self.solution.mesh = mesh;
        self.system.stations(&self.solution.mesh, &mut self.stations);
        let guesses = &self.guesses;
        self.equations.place_stations(&self.stations, &self.solution.mesh, |k| guesses[k]);
    }
}
