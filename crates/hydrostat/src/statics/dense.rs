//! A solution between its nodes.

use hydrostat_bvp::{Gauss, LANES, Solution};

use crate::numerics::dispatch::widest;
use crate::numerics::elimination::solve_in_place;
use crate::statics::configuration::Station;
use crate::statics::engine::{Engine, M, asked_in, sharpened};
use crate::statics::equations::{Equations, L, N, Q, SectionFailure, SectionQuery, SectionState};

/// Unknowns of a step between nodes: the slopes at its stages.
const SLOPES: usize = N * M;

/// A state, and the way of x, y over L since the start of its element.
type Reached = ([f64; N], [f64; Q]);

/// What it takes to evaluate a configuration anywhere: the nodes, which are accurate to the order
/// of the method, and enough of the stages to start from.
#[derive(Debug, Clone)]
pub(crate) struct Dense {
    pub(crate) equations: Equations,
    pub(crate) solution: Solution<N, M, L>,
    /// x, y over L at the nodes, from the base.
    positions: Vec<[f64; Q]>,
    gauss: Gauss<M>,
}

impl Dense {
    /// Of the engine's solution, settled.
    pub(crate) fn new(engine: &Engine) -> Self {
        let mesh = &engine.solution.mesh;
        let gauss = engine.system.gauss.clone();
        let spans = &engine.spans;
        let mut positions = vec![[0.0; Q]; mesh.elements() + 1];
        for i in 0..mesh.elements() {
            positions[i + 1] = positions[i];
            for q in 0..Q {
                positions[i + 1][q] += spans[i][q];
            }
        }
        Self { equations: engine.equations.clone(), solution: engine.solution.clone(), positions, gauss }
    }

    /// What is known at `s` in element `i`, where the state is `z`.
    fn asked(&self, i: usize, s: f64, z: [f64; N]) -> SectionQuery {
        let mesh = &self.solution.mesh;
        let x = (s - mesh.nodes()[i]) / mesh.step(i);
        SectionQuery { s, ..asked_in(&self.solution, &self.gauss, i, x, z) }
    }

    /// What is asked with beta' as outputs have it, given everything there with the beta' of the polynomial.
    fn sharp(&self, i: usize, asked: SectionQuery, here: &SectionState) -> SectionQuery {
        let mesh = &self.solution.mesh;
        let x = (asked.s - mesh.nodes()[i]) / mesh.step(i);
        widest(
            #[inline(always)]
            || sharpened(&self.equations, &self.solution, &self.gauss, (i, x), asked, here),
        )
    }

    /// Everything at a place with the beta' of the polynomial.
    fn place(&self, i: usize, asked: SectionQuery) -> Result<SectionState, SectionFailure> {
        match self.equations.at_place(&asked) {
            Err(_) => {
                // Extrapolated strains can be off: start from the nearest stage instead.
                let nearest = if asked.from_left { M - 1 } else { 0 };
                self.equations.at_place(&SectionQuery { strain: self.solution.inner(i, nearest).inner, ..asked })
            }
            found => found,
        }
    }

    /// The same with beta' as outputs have it.
    fn section(&self, i: usize, s: f64, from_left: bool, z: [f64; N]) -> Result<SectionState, SectionFailure> {
        let asked = SectionQuery { from_left, ..self.asked(i, s, z) };
        let found = self.place(i, asked)?;
        Ok(self.equations.at_place(&self.sharp(i, asked, &found)).unwrap_or(found))
    }

    /// Everything at stages within element `i`.
    fn stages(&self, i: usize, s: &[f64; M], z: &[[f64; N]; M]) -> Result<[SectionState; M], SectionFailure> {
        const { assert!(M == LANES, "the stages of a step are solved side by side") };
        let asked: [SectionQuery; LANES] =
            std::array::from_fn(|j| SectionQuery { from_left: false, ..self.asked(i, s[j], z[j]) });
        let found = widest(
            #[inline(always)]
            || self.equations.at_places(&asked),
        );
        if let Some(found) = found {
            return Ok(std::array::from_fn(|j| found.lane(j)));
        }
        let one = |j: usize| self.place(i, asked[j]);
        Ok([one(0)?, one(1)?, one(2)?, one(3)?])
    }

    /// One Gauss step from the start of element `i` to `s`: the state and the place there, to the order of the nodes.
    /// `None` where its equations are singular.
    fn step(&self, i: usize, s: f64) -> Result<Option<Reached>, SectionFailure> {
        let mesh = &self.solution.mesh;
        let (start, from) = (mesh.nodes()[i], self.solution.nodes[i]);
        let h = s - start;
        let fraction = h / mesh.step(i);
        let places = self.gauss.c.map(|c| start + h * c);
        let mut slopes: [[f64; N]; M] =
            std::array::from_fn(|j| self.solution.slope_in(&self.gauss, i, fraction * self.gauss.c[j]));
        let mut rates = [[0.0; Q]; M];
        for _ in 0..8 {
            let mut states = [from; M];
            for j in 0..M {
                for l in 0..M {
                    for a in 0..N {
                        states[j][a] += h * self.gauss.a[j][l] * slopes[l][a];
                    }
                }
            }
            let at = self.stages(i, &places, &states)?;
            let mut matrix = [[0.0; SLOPES]; SLOPES];
            let mut right = [[0.0]; SLOPES];
            for j in 0..M {
                rates[j] = at[j].rate;
                for a in 0..N {
                    let row = N * j + a;
                    right[row][0] = at[j].slope[a] - slopes[j][a];
                    matrix[row][row] += 1.0;
                    for l in 0..M {
                        for b in 0..N {
                            matrix[row][N * l + b] -= h * self.gauss.a[j][l] * at[j].jacobian[a][b];
                        }
                    }
                }
            }
            if !solve_in_place(&mut matrix, &mut right, 0.0) {
                return Ok(None);
            }
            let mut size = 0.0_f64;
            for j in 0..M {
                for a in 0..N {
                    slopes[j][a] += right[N * j + a][0];
                    size = size.max(right[N * j + a][0].abs() / (1.0 + slopes[j][a].abs()));
                }
            }
            if size * h.abs() < 1e-11 {
                break;
            }
        }
        let (mut end, mut moved) = (from, [0.0; Q]);
        for j in 0..M {
            for a in 0..N {
                end[a] += h * self.gauss.b[j] * slopes[j][a];
            }
            for q in 0..Q {
                moved[q] += h * self.gauss.b[j] * rates[j][q];
            }
        }
        Ok(Some((end, moved)))
    }

    /// Everything at nodes, each the start of an element, or its end.
    pub(crate) fn at_nodes(&self, nodes: &[(usize, bool)]) -> Result<Vec<(Station, SectionState)>, SectionFailure> {
        let mesh = &self.solution.mesh;
        let mut out = Vec::with_capacity(nodes.len());
        for four in nodes.chunks(LANES) {
            let places: [(usize, bool); LANES] = std::array::from_fn(|lane| four[lane.min(four.len() - 1)]);
            let asked = places.map(|(i, end)| {
                let k = i + usize::from(end);
                SectionQuery { from_left: end, ..self.asked(i, mesh.nodes()[k], self.solution.nodes[k]) }
            });
            let solved = |asked: &[SectionQuery; LANES]| {
                widest(
                    #[inline(always)]
                    || self.equations.at_places(asked),
                )
            };
            let found = solved(&asked).and_then(|first| {
                solved(&std::array::from_fn(|lane| self.sharp(places[lane].0, asked[lane], &first.lane(lane))))
            });
            for (lane, (i, end)) in four.iter().enumerate() {
                let SectionQuery { s, z, .. } = asked[lane];
                let place = match &found {
                    Some(found) => found.lane(lane),
                    None => self.section(*i, s, *end, z)?,
                };
                out.push((self.station(s, z, self.positions[*i + usize::from(*end)], &place), place));
            }
        }
        Ok(out)
    }

    /// Everything at `s` (over L), as seen from element `i`, which holds it or ends there.
    pub(crate) fn at(&self, i: usize, s: f64) -> Result<(Station, SectionState), SectionFailure> {
        let mesh = &self.solution.mesh;
        let (start, end) = (mesh.nodes()[i], mesh.nodes()[i + 1]);
        let (z, position) = if s <= start {
            (self.solution.nodes[i], self.positions[i])
        } else if s >= end {
            (self.solution.nodes[i + 1], self.positions[i + 1])
        } else {
            match self.step(i, s)? {
                Some((z, moved)) => {
                    let p = self.positions[i];
                    (z, [p[0] + moved[0], p[1] + moved[1]])
                }
                // Equations of the step that are singular: by the polynomials, which are of lower order.
                None => (self.solution.state_in(&self.gauss, i, s), self.position_in(i, s)),
            }
        };
        let place = self.section(i, s, s > start, z)?;
        Ok((self.station(s, z, position, &place), place))
    }

    /// x, y over L at `s` (over L) in element `i`, by the polynomial through the centreline's slopes at the stages.
    fn position_in(&self, i: usize, s: f64) -> [f64; Q] {
        let mesh = &self.solution.mesh;
        let (start, step) = (mesh.nodes()[i], mesh.step(i));
        let weights = self.gauss.integrals((s - start) / step);
        let mut out = self.positions[i];
        for (j, weight) in weights.iter().enumerate() {
            let [theta, ..] = self.solution.state_in(&self.gauss, i, start + step * self.gauss.c[j]);
            let [nu, eta, _] = self.solution.inner(i, j).inner;
            let (sin, cos) = theta.sin_cos();
            out[0] += step * weight * (nu * cos - eta * sin);
            out[1] += step * weight * (nu * sin + eta * cos);
        }
        out
    }

    /// beta' (times L) at the start or the end of element `i`, as its stages have it.
    pub(crate) fn beta_slope_beside(&self, i: usize, end: bool) -> f64 {
        self.solution.inner_in(&self.gauss, i, f64::from(u8::from(end))).closure_slope
    }

    fn station(&self, s: f64, z: [f64; N], position: [f64; Q], place: &SectionState) -> Station {
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

#[cfg(test)]
mod tests {
    use crate::{Arm, Cable, Profile};

    /// Where a step between the nodes cannot be made, its place was that of the element's first node.
    #[test]
    fn a_place_by_the_polynomials_was_that_of_the_node_before() {
        let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
        arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.3));
        arm.flow.speed = 0.1;
        let found = arm.solve().unwrap();
        let dense = found.dense();
        let nodes = dense.solution.mesh.nodes();
        for i in 0..nodes.len() - 1 {
            for fraction in [0.1, 0.5, 0.8, 1.0] {
                let s = nodes[i] + fraction * (nodes[i + 1] - nodes[i]);
                let (station, _) = dense.at(i, s).unwrap();
                let [x, y] = dense.position_in(i, s).map(|v| arm.length * v);
                let off = (x - station.x).hypot(y - station.y) / arm.length;
                assert!(off < 1e-6, "{off:e} L off at s = {s} L");
                let slope = dense.beta_slope_beside(i, true) / arm.length;
                let (end, _) = dense.at(i, nodes[i + 1]).unwrap();
                assert!(
                    (slope - end.beta_slope).abs() < 1e-3 * end.beta_slope.abs().max(1.0),
                    "{slope} {}",
                    end.beta_slope
                );
            }
        }
    }
}
