//! A solution between its nodes.

use hydrostat_bvp::{Gauss, Solution, step};

use crate::configuration::Station;
use crate::engine::{Engine, M};
use crate::equilibrium::{AtPlace, Equilibrium, N, Q, SectionFailure};

/// What it takes to evaluate a configuration anywhere: the nodes, which are accurate to the order
/// of the method, and enough of the stages to start from.
#[derive(Debug, Clone)]
pub(crate) struct Dense {
    pub(crate) equations: Equilibrium,
    pub(crate) solution: Solution<N, M>,
    /// x, y over L at the nodes, from the base.
    positions: Vec<[f64; Q]>,
    gauss: Gauss<M>,
}

impl Dense {
    /// Of the engine's solution, whose stages must be up to date.
    pub(crate) fn new(engine: &Engine) -> Self {
        let mesh = &engine.solution.mesh;
        let gauss = engine.system.gauss.clone();
        let mut positions = vec![[0.0; Q]; mesh.elements() + 1];
        for i in 0..mesh.elements() {
            positions[i + 1] = positions[i];
            for j in 0..M {
                for q in 0..Q {
                    positions[i + 1][q] += mesh.step(i) * gauss.b[j] * engine.system.locals()[i * M + j].rate[q];
                }
            }
        }
        Self { equations: engine.equations.clone(), solution: engine.solution.clone(), positions, gauss }
    }

    /// Strains, beta' and beta'' of element `i` at `x` in [0, 1], from its stages.
    fn guess(&self, i: usize, x: f64) -> ([f64; 3], [f64; 2]) {
        self.equations.remembered(i, &self.gauss.cardinals(x))
    }

    fn section(&self, i: usize, s: f64, from_left: bool, z: [f64; N]) -> Result<AtPlace, SectionFailure> {
        let mesh = &self.solution.mesh;
        let (strain, beta) = self.guess(i, (s - mesh.nodes()[i]) / mesh.step(i));
        self.equations.at_place(s, from_left, z, strain, beta).or_else(|_| {
            // Extrapolated strains can be off: start from the nearest stage instead.
            let nearest = if from_left { i * M + M - 1 } else { i * M };
            self.equations.at_place(s, from_left, z, self.equations.strain(nearest), beta)
        })
    }

    /// Everything at `s` (over L), as seen from element `i`, which holds it or ends there.
    pub(crate) fn at(&self, i: usize, s: f64) -> Result<(Station, AtPlace), SectionFailure> {
        let mesh = &self.solution.mesh;
        let (start, end) = (mesh.nodes()[i], mesh.nodes()[i + 1]);
        let (z, position) = if s <= start {
            (self.solution.nodes[i], self.positions[i])
        } else if s >= end {
            (self.solution.nodes[i + 1], self.positions[i + 1])
        } else {
            let h = s - start;
            let share = h / (end - start);
            let mut slopes = [[0.0; N]; M];
            for j in 0..M {
                let w = self.gauss.cardinals(share * self.gauss.c[j]);
                for l in 0..M {
                    for a in 0..N {
                        slopes[j][a] += w[l] * self.solution.slopes[i][l][a];
                    }
                }
            }
            let from = self.solution.nodes[i];
            let local = |_: usize, s: f64, z: &[f64; N]| self.section(i, s, false, *z).map(|p| p.local);
            match step(&self.gauss, from, start, h, slopes, local)? {
                Some((z, moved)) => {
                    let p = self.positions[i];
                    (z, [p[0] + moved[0], p[1] + moved[1]])
                }
                None => (self.solution.state_in(&self.gauss, i, s), self.positions[i]),
            }
        };
        let place = self.section(i, s, s > start, z)?;
        Ok((self.station(s, z, position, &place), place))
    }

    fn station(&self, s: f64, z: [f64; N], position: [f64; Q], place: &AtPlace) -> Station {
        let (l, f) = (self.equations.units.length, self.equations.units.force);
        let base = &self.equations.arm().base;
        let [nu, eta, mu] = place.strain;
        Station {
            s: s * l,
            x: base.x + l * position[0],
            y: base.y + l * position[1],
            theta: z[0],
            nu,
            eta,
            mu: mu / l,
            beta: place.beta,
            beta_slope: place.beta_slope / l,
            alpha: eta.atan2(nu),
            n_a: f * place.contact[0],
            n_b: f * place.contact[1],
            m: f * l * place.contact[2],
        }
    }
}
