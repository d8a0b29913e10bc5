//! Where Newton starts from.

use hydrostat_bvp::{Mesh, Solution};

use super::{Engine, M, Trouble};

impl Engine {
    /// Strains from the cables alone (no stream, weight or tip load): a start that is exact when
    /// nothing else acts.
    pub(crate) fn start_from_cables(&mut self, elements: usize) -> Result<(), Trouble> {
        self.place_unloaded(Mesh::uniform(elements, &self.breaks));
        self.equations.beta.blunt = true;
        let strains = self.strains_from_cables();
        self.equations.beta.blunt = false;
        strains?;
        self.turn_by(|this, k| this.system.local(k / M, k % M).slope[0]);
        Ok(())
    }

    /// The unloaded arm: reference strains, nothing carried.
    pub(crate) fn start_unloaded(&mut self, elements: usize) {
        self.place_unloaded(Mesh::uniform(elements, &self.breaks));
        self.turn_by(|this, k| this.equations.strain(k)[2]);
    }

    /// Stations on a mesh, each with the reference strains, and nothing carried.
    fn place_unloaded(&mut self, mesh: Mesh) {
        self.meshes += 1;
        self.system.stations(&mesh, &mut self.stations);
        self.equations.place_stations(&self.stations, &mesh, |_| ([0.0; 3], 0.0, 0.0));
        self.equations.forget_strains();
        let angle = self.equations.arm().base.angle;
        self.solution = Solution::constant(mesh, [angle, 0.0, 0.0, 0.0]);
    }

    /// Turns the sections by the bending strain `mu` of each station, from the base.
    fn turn_by(&mut self, mu: impl Fn(&Self, usize) -> f64) {
        for i in 0..self.solution.mesh.elements() {
            let h = self.solution.mesh.step(i);
            let mut next = self.solution.nodes[i];
            for j in 0..M {
                let mu = mu(self, i * M + j);
                self.solution.slopes[i][j] = [mu, 0.0, 0.0, 0.0];
                next[0] += h * self.system.gauss.b[j] * mu;
            }
            self.solution.nodes[i + 1] = next;
        }
    }

    fn strains_from_cables(&mut self) -> Result<(), Trouble> {
        let whole = self.equations.fraction;
        let mut fine = self.refresh().is_ok();
        if !fine {
            // Raise the tensions in steps, each from the strains of the last.
            for k in 1..=16 {
                self.equations.fraction[1] = whole[1] * f64::from(k) / 16.0;
                fine = self.refresh().is_ok();
                if !fine {
                    break;
                }
            }
            self.equations.fraction = whole;
        }
        for _ in 0..2 {
            self.refresh().map_err(Trouble::Section)?;
        }
        Ok(())
    }
}
