//! What is differentiated, and how each of it follows the solution and what is given.

use hydrostat_bvp::{Collocation, EndWeights, Forcing, LANES, Lanes, Real, Side, each};

use super::derivatives::{self, Derivatives, SensitivityMethod, at_given_tensions, hold};
use super::error::{SensitivityError, unsettled};
use crate::rod::parameter::Parameter;
use crate::statics::engine::{Engine, M, Trouble, linearise, response_change};
use crate::statics::equations::{L, N, Q, StationData, Way};

type System = Collocation<N, M, Q, L>;
type Row = derivatives::Row<N, Q, L>;

/// What Newton's last round moves (rad, and the tip over L) before an exact derivative is taken.
const CONVERGED: f64 = 1e-12;

/// The same where rounding, or a kink of the load, does not let it get there.
const NEARLY: f64 = 1e-7;

/// Rounds until then.
const ROUNDS: usize = 10;

/// Something that is differentiated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    /// x or y (m) at a node.
    Position(usize, usize),
    /// theta (rad) at a node.
    Theta(usize),
    /// alpha (rad) at a node.
    Alpha(usize),
    /// The length (m) of the path of a cable less than at the reference strains.
    Stroke(usize),
    /// What has to be reeled in (m) of a cable for that, its own stretch aside.
    Command(usize),
    /// Force along e1 (0), e2 (1) (N) or moment (2) (N m) on the base.
    Base(usize),
}

/// Quantities with weights.
type Sum = Vec<(Quantity, f64)>;

/// Quantities of a pose.
pub(crate) const POSE: usize = 4;

impl Engine {
    /// The quantities of the pose at a node (over L).
    pub(crate) fn pose_at(&self, place: f64) -> [Quantity; POSE] {
        let node = self.node_at(place).unwrap_or(self.solution.mesh.elements());
        [Quantity::Position(node, 0), Quantity::Position(node, 1), Quantity::Theta(node), Quantity::Alpha(node)]
    }

    /// Rounds until nothing moves any more, and what the equations are at that.
    pub(crate) fn converge_fully(&mut self) -> Result<(), SensitivityError> {
        // Rounds that move nothing but rounding are not made, so that derivatives taken twice are the same.
        self.linearise().map_err(|trouble| unsettled(&trouble))?;
        if self.equations.stroke_control.is_none() && self.correction_here() < CONVERGED {
            return Ok(());
        }
        match self.newton(CONVERGED, ROUNDS) {
            Err(Trouble::Stalled(size)) if size < NEARLY => {}
            other => other.map_err(|trouble| unsettled(&trouble))?,
        }
        Ok(())
    }

    /// Derivatives by `parameters` at the last evaluation, cables that are commanded held. `None` where the system is
    /// singular.
    pub(crate) fn derivatives(
        &self,
        quantities: &[Quantity],
        parameters: &[Parameter],
        method: SensitivityMethod,
    ) -> Option<Derivatives> {
        let rows: Vec<Sum> = quantities.iter().map(|quantity| vec![(*quantity, 1.0)]).collect();
        self.derivatives_of(rows, parameters, method)
    }

    /// Derivatives of one weighted sum of poses.
    pub(crate) fn gradient(&self, sum: &[(Quantity, f64)], parameters: &[Parameter]) -> Option<Derivatives> {
        self.derivatives_of(vec![sum.to_vec()], parameters, SensitivityMethod::Adjoint)
    }

    /// Derivatives of weighted sums.
    fn derivatives_of(
        &self,
        mut sums: Vec<Sum>,
        parameters: &[Parameter],
        method: SensitivityMethod,
    ) -> Option<Derivatives> {
        let (stroke_control, cables) = (self.equations.stroke_control.clone(), self.equations.arm().cables.len());
        let taut: Vec<usize> = stroke_control.map_or(Vec::new(), |stroke_control| {
            stroke_control.taut_cables().iter().map(|i| stroke_control.cables[*i]).collect()
        });
        let mut sources = parameters.to_vec();
        sources.extend(taut.iter().map(|c| Parameter::Tension(*c)));
        let asked = sums.len();
        sums.extend(taut.iter().map(|c| vec![(Quantity::Command(*c), 1.0)]));
        // About the solution itself: the engine's last linearisation may be a round behind.
        let mut system = System::with(self.system.gauss.clone());
        linearise(&mut system, &self.equations, &self.solution).ok()?;
        let about = About { engine: self, system: &system };
        let rows: Vec<Row> = sums.iter().map(|sum| about.sum_row(sum, &sources)).collect::<Option<_>>()?;
        let change = |source: &Parameter| response_change(&self.equations, &system, &self.solution, Way::Of(*source));
        let changes: Vec<Forcing<N, Q, L>> = sources.iter().map(change).collect();
        let rows = at_given_tensions(&system, &self.solution, &rows, &changes, method)?;
        hold(rows, asked, parameters, &taut, cables)
    }
}

/// Derivatives about the engine's solution.
struct About<'e> {
    engine: &'e Engine,
    system: &'e System,
}

impl About<'_> {
    /// The row of a sum.
    fn sum_row(&self, sum: &Sum, sources: &[Parameter]) -> Option<Row> {
        let mut out = Row { direct: vec![0.0; sources.len()], ..Row::default() };
        for (quantity, weight) in sum.iter().filter(|(_, weight)| *weight != 0.0) {
            self.add_quantity(*quantity, *weight, sources, &mut out)?;
        }
        Some(out)
    }

    /// Adds `weight` times a quantity to a row.
    fn add_quantity(&self, quantity: Quantity, weight: f64, sources: &[Parameter], row: &mut Row) -> Option<()> {
        let equations = &self.engine.equations;
        let (length, force) = (equations.units.length, equations.units.force);
        if let Some(by_length) = sources.iter().position(|source| *source == Parameter::Length) {
            row.direct[by_length] += weight * self.by_unit_of_length(quantity);
        }
        let mut state = |i: usize, a: usize, weight: f64| {
            let mut weights = [0.0; N];
            weights[a] = weight;
            row.functional.nodes.push((i, weights));
        };
        match quantity {
            Quantity::Position(node, q) => {
                row.add_position(self.system, self.engine.solution.groups(), [node, q], weight * length);
            }
            Quantity::Theta(node) => state(node, 0, weight),
            Quantity::Base(k) => state(0, k + 1, -weight * if k < 2 { force } else { force * length }),
            Quantity::Alpha(node) => self.add_alpha(node, weight, sources, row)?,
            Quantity::Stroke(c) => self.add_stroke(c, false, weight * length, sources, row),
            Quantity::Command(c) => self.add_stroke(c, true, weight * length, sources, row),
        }
        Some(())
    }

    /// How a quantity follows the unit of length where its number in that unit stays.
    fn by_unit_of_length(&self, quantity: Quantity) -> f64 {
        let (equations, solution) = (&self.engine.equations, &self.engine.solution);
        match quantity {
            Quantity::Position(node, q) => {
                let mut place = 0.0;
                for (block, local) in self.system.locals().iter().enumerate() {
                    let (g, j) = (block / M, block % M);
                    for lane in 0..solution.groups().filled(g) {
                        if g * LANES + lane < node {
                            place += self.system.steps()[g].0[lane] * self.system.gauss.b[j] * local.rate[q].0[lane];
                        }
                    }
                }
                place
            }
            Quantity::Stroke(c) => {
                let [now, reference] = equations.cable_lengths(c, StationData::of(self.system));
                reference - now
            }
            Quantity::Command(c) => equations.stroke(c, StationData::of(self.system))[0],
            Quantity::Base(2) => -solution.nodes[0][3] * equations.units.force,
            Quantity::Theta(_) | Quantity::Alpha(_) | Quantity::Base(_) => 0.0,
        }
    }

    /// The stroke of a cable: of its path, or, unstretched, as it is commanded.
    fn add_stroke(&self, c: usize, commanded: bool, factor: f64, sources: &[Parameter], row: &mut Row) {
        let equations = &self.engine.equations;
        let groups = self.engine.solution.groups();
        let end = equations.cable_end(c);
        row.reserve(groups.count() * M);
        for (block, (local, station)) in self.system.locals().iter().zip(self.system.stations()).enumerate() {
            let (g, j) = (block / M, block % M);
            let (by_strain, by_slope) = equations.stretch_gradient(c, block, station);
            let by_stretch = if commanded { equations.stroke_by_stretch(c, block) } else { Lanes::of(-1.0) };
            let mut weight = Lanes::default();
            for lane in 0..groups.filled(g) {
                if equations.stations()[groups.station_in(block, lane)] < end {
                    let own = factor * self.system.steps()[g].0[lane] * self.system.gauss.b[j];
                    weight.0[lane] = own * by_stretch.0[lane];
                }
            }
            let own = &mut row.functional.stages[block];
            own.closure_slope += weight * by_slope;
            for (k, by) in by_strain.iter().enumerate() {
                for a in 0..N {
                    own.state[a] += weight * *by * local.inner.gradient[k][a];
                }
                own.closure_slope += weight * *by * local.inner.by_closure[k];
                row.stages[block].1[k] += weight * *by;
            }
        }
        for (direct, source) in row.direct.iter_mut().zip(sources) {
            *direct += factor * equations.stroke_by(c, commanded, Way::Of(*source), StationData::of(self.system));
        }
    }

    /// alpha at a node, where it ends an element, or, at the base and where it is met there alone, begins one.
    fn add_alpha(&self, node: usize, weight: f64, sources: &[Parameter], row: &mut Row) -> Option<()> {
        let turn = |[nu, eta, _]: [f64; L]| {
            let square = nu * nu + eta * eta;
            [-weight * eta / square, weight * nu / square, 0.0]
        };
        let Some((block, lane)) = self.end_at(node) else {
            // Without a closure strains follow the state and what is given alone.
            let asked = self.engine.asked_beside(node, node > 0);
            let found = self.engine.equations.at_place(&asked).ok()?;
            let by = turn(found.strain);
            let weights = each(|a| (0..L).map(|k| by[k] * found.strain_by_state[k][a]).sum());
            row.functional.nodes.push((node, weights));
            for (direct, source) in row.direct.iter_mut().zip(sources) {
                let change = self.engine.equations.strain_by(&asked, Way::Of(*source));
                *direct += (0..L).map(|k| by[k] * change[k]).sum::<f64>();
            }
            return Some(());
        };
        let inner = &self.system.ends()[block];
        let strain = self.system.end_stations()[block].inner.map(|v| v.0[lane]);
        let by = turn(each(|k| strain[k] + inner.change[k].0[lane]));
        row.functional.ends.push(EndWeights {
            block,
            lane,
            state: each(|a| (0..L).map(|k| by[k] * inner.gradient[k][a].0[lane]).sum()),
            closure_slope: (0..L).map(|k| by[k] * inner.by_closure[k].0[lane]).sum(),
        });
        row.ends.push((block, lane, by));
        Some(())
    }

    /// The end at a node at which the section law is met.
    fn end_at(&self, node: usize) -> Option<(usize, usize)> {
        let places = self.engine.solution.directions.ends();
        let find = |element: usize, side: Side| {
            places.iter().enumerate().find_map(|(block, place)| {
                let lane = (0..LANES).find(|l| place.elements[*l] == element && place.sides[*l] == side)?;
                Some((block, lane))
            })
        };
        let before = node.checked_sub(1).and_then(|element| find(element, Side::Right));
        before.or_else(|| find(node, Side::Left))
    }
}
