//! How an equilibrium in space changes with what is given: exact derivatives of tip, stations, strokes and base, by
//! the same linearised equations as in the plane ([`crate::sensitivity`]).
//!
//! A pose changes by a motion in space and a turn phi of the section, of which the directors follow: d a = phi x a.

use hydrostat_bvp::{Collocation, Forcing, Lanes, each};
use nalgebra::Matrix3;

use super::cable_paths::StageData;
use super::configuration::SpatialWrench;
use super::engine::Engine;
use super::equations::{FORCE, L, M, MOMENT, N, Q};
use super::kinks::kink_resolution;
use super::rotation::{Directors, Vector, cross, dot, turn};
use super::solve::{SpatialError, SpatialSolver};
use crate::numerics::rounds::{correct, linearise};
use crate::rod::arm::Arm;
use crate::rod::parameter::Parameter;
use crate::statics::engine::Trouble;
use crate::statics::equations::Way;
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::sensitivity::derivatives::{self, Derivatives, at_given_tensions, hold};
use crate::statics::sensitivity::{
    SensitiveStation, Sensitivities, SensitivityError, SensitivityMethod, SensitivityOptions, check, unsettled,
};

/// What Newton's last round moves (rad, and the tip over L) before an exact derivative is taken.
const CONVERGED: f64 = 1e-12;

/// The same where rounding, or a kink of the load, does not let it get there.
const NEARLY: f64 = 1e-7;

/// Rounds until then.
const ROUNDS: usize = 10;

/// Places (over L) that are this near are the same.
const SAME: f64 = 1e-9;

/// Change of a pose in space a unit of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpatialPoseChange {
    /// Of the centreline, m.
    pub place: [f64; 3],
    /// Turn of the section about e1, e2 and e3, rad.
    pub turn: [f64; 3],
}

impl SpatialPoseChange {
    /// The change of a director that is `director` now.
    pub fn of_director(&self, director: [f64; 3]) -> [f64; 3] {
        cross(&self.turn, &director)
    }
}

/// Where the tip of an arm in space goes with a unit of effort: the image of the unit ball of what it is by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    /// Half axes, the longest first, m a unit of the parameters.
    pub half_axes: [f64; 3],
    /// The direction of each.
    pub directions: [[f64; 3]; 3],
}

impl Ellipsoid {
    /// Of a jacobian, given by its columns: from the singular values of J J^T.
    pub fn of(columns: &[[f64; 3]]) -> Self {
        let square = |i: usize, j: usize| columns.iter().map(|column| column[i] * column[j]).sum::<f64>();
        let found = Matrix3::from_fn(square).symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| found.eigenvalues[*b].total_cmp(&found.eigenvalues[*a]));
        Self {
            half_axes: order.map(|k| found.eigenvalues[k].max(0.0).sqrt()),
            directions: order.map(|k| each(|axis| found.eigenvectors[(axis, k)])),
        }
    }
}

impl Sensitivities<SpatialPoseChange, SpatialWrench> {
    /// d (x, y, z) of the tip by the parameters given that were asked for: one column each, m a unit.
    pub fn tip_jacobian(&self, parameters: &[Parameter]) -> Vec<[f64; 3]> {
        parameters.iter().filter_map(|p| self.index(*p)).map(|k| self.tip[k].place).collect()
    }

    /// Compliance of the tip: rows x, y, z (m) and the turns about e1, e2, e3 (rad); columns the dead forces (N) and
    /// moments (N m) along and about them. `None` where one of these was not asked for.
    pub fn compliance(&self) -> Option<[[f64; 6]; 6]> {
        let moments = [Parameter::TipMomentAbout(0), Parameter::TipMomentAbout(1), Parameter::TipMoment];
        let mut out = [[0.0; 6]; 6];
        for (column, load) in [0, 1, 2].map(Parameter::TipForce).into_iter().chain(moments).enumerate() {
            let change = self.tip[self.index(load)?];
            for (row, value) in out.iter_mut().zip(change.place.into_iter().chain(change.turn)) {
                row[column] = value;
            }
        }
        Some(out)
    }

    /// The manipulability ellipsoid of the tip by the tensions (or strokes) of the cables that were asked for. `None`
    /// where none was.
    pub fn manipulability(&self) -> Option<Ellipsoid> {
        let cables = self.cables();
        (!cables.is_empty()).then(|| Ellipsoid::of(&self.tip_jacobian(&cables)))
    }
}

type Outcome<T> = Result<T, SensitivityError<SpatialError>>;

impl SpatialSolver {
    /// [`crate::Solver::sensitivities`] in space.
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Options, Parameter, Profile, Space, SpatialSolver};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// for k in 0..3 {
    ///     let angle = f64::from(k) * std::f64::consts::TAU / 3.0;
    ///     arm.cables.push(Cable::new(format!("cable {k}"), Profile::linear(0.005, 0.001)).at_angle(angle));
    /// }
    /// arm.cables[1].tension = 0.1;
    /// arm.space = Some(Space::default());
    /// let mut solver = SpatialSolver::new(&arm, Options::default())?;
    /// let found = solver.sensitivities(&[Parameter::Tension(1)])?;
    /// assert!(found.tip[0].place[1] < 0.0 && found.tip[0].place[2] > 0.0, "it bends on to its side");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SensitivityError`].
    pub fn sensitivities(
        &mut self,
        parameters: &[Parameter],
    ) -> Result<Sensitivities<SpatialPoseChange, SpatialWrench>, SensitivityError<SpatialError>> {
        self.sensitivities_with(parameters, &SensitivityOptions::default())
    }

    /// [`SpatialSolver::sensitivities`], at stations along the arm too.
    ///
    /// # Errors
    /// [`SensitivityError`].
    pub fn sensitivities_with(
        &mut self,
        parameters: &[Parameter],
        options: &SensitivityOptions,
    ) -> Result<Sensitivities<SpatialPoseChange, SpatialWrench>, SensitivityError<SpatialError>> {
        let places = self.settle_for_derivatives(parameters, &options.stations)?;
        let engine = &self.engine;
        let cables = engine.equations.arm().cables.len();
        let mut quantities = engine.pose_at(1.0).to_vec();
        for place in &places {
            quantities.extend(engine.pose_at(*place));
        }
        quantities.extend((0..cables).map(Quantity::Stroke));
        quantities.extend((0..6).map(Quantity::Base));
        let sums = quantities.iter().map(|quantity| vec![(*quantity, 1.0)]).collect();
        let found = engine.derivatives(sums, parameters, options.method).ok_or(SensitivityError::Singular)?;
        let count = parameters.len();
        let three = |first: usize, k: usize| -> Vector<f64> { each(|axis| found.rows[first + axis][k]) };
        let pose = |first: usize, k: usize| SpatialPoseChange { place: three(first, k), turn: three(first + 3, k) };
        let poses = |first: usize| (0..count).map(|k| pose(first, k)).collect::<Vec<_>>();
        let after = POSE * (places.len() + 1);
        let wrench = |k: usize| SpatialWrench { force: three(after + cables, k), moment: three(after + cables + 3, k) };
        let stations = options.stations.iter().enumerate();
        Ok(Sensitivities {
            parameters: parameters.to_vec(),
            tip: poses(0),
            strokes: found.rows[after..after + cables].to_vec(),
            base: (0..count).map(wrench).collect(),
            stations: stations.map(|(i, s)| SensitiveStation { s: *s, changes: poses(POSE * (i + 1)) }).collect(),
            tensions: found.tensions,
        })
    }

    /// [`crate::Solver::gradient`] in space: `weights` are the number's own derivatives by the poses of places along
    /// the arm (m), a metre and a radian each.
    ///
    /// # Errors
    /// [`SensitivityError`].
    pub fn gradient(
        &mut self,
        parameters: &[Parameter],
        weights: &[(f64, SpatialPoseChange)],
    ) -> Result<Vec<f64>, SensitivityError<SpatialError>> {
        let stations: Vec<f64> = weights.iter().map(|(s, _)| *s).collect();
        let places = self.settle_for_derivatives(parameters, &stations)?;
        let mut sum = Vec::with_capacity(POSE * places.len());
        for (place, (_, by)) in places.iter().zip(weights) {
            sum.extend(self.engine.pose_at(*place).into_iter().zip(by.place.into_iter().chain(by.turn)));
        }
        let found = self.engine.derivatives(vec![sum], parameters, SensitivityMethod::Adjoint);
        Ok(found.ok_or(SensitivityError::Singular)?.rows.into_iter().next().unwrap_or_default())
    }

    /// Keeps nodes at these places (over L) from now on; whether the solution settles with them.
    pub(crate) fn watch_places(&mut self, places: &[f64]) -> bool {
        self.engine.watch(places, self.options.tol).is_ok()
    }

    /// The centreline from the base (over L) and a at a place (over L) that is watched.
    pub(crate) fn pose_of(&self, place: f64) -> ([f64; 3], [f64; 3]) {
        let engine = &self.engine;
        let node = engine.node_at(place).unwrap_or(engine.solution.mesh.elements());
        let mut out = [0.0; 3];
        for span in &engine.spans[..node] {
            for k in 0..3 {
                out[k] += span[k];
            }
        }
        (out, engine.directors_at(node).a)
    }

    /// The quantities of the pose at a place (over L).
    pub(crate) fn pose_at(&self, place: f64) -> [Quantity; POSE] {
        self.engine.pose_at(place)
    }

    /// Derivatives of weighted sums of quantities about the present solution.
    pub(crate) fn derivatives_of(
        &self,
        sums: Vec<Sum>,
        parameters: &[Parameter],
        method: SensitivityMethod,
    ) -> Option<Derivatives> {
        self.engine.derivatives(sums, parameters, method)
    }

    /// Strokes of the first cables as they are commanded, over L.
    pub(crate) fn strokes_now(&self, count: usize) -> Vec<f64> {
        let at = StageData::of(&self.engine.system, &self.engine.solution);
        (0..count).map(|c| self.engine.equations.stroke(c, at)[0]).collect()
    }

    /// The force (N) that bends `arm` a good deal at its length.
    pub(crate) fn unit_force(arm: &Arm) -> f64 {
        Engine::new(arm).equations.units.force
    }

    /// Solves, with nodes at the stations (m), until rounds move nothing any more. The stations over L.
    fn settle_for_derivatives(&mut self, parameters: &[Parameter], stations: &[f64]) -> Outcome<Vec<f64>> {
        let arm = self.engine.equations.arm();
        check(arm, parameters, stations)?;
        let places: Vec<f64> = stations.iter().map(|s| s / arm.length).collect();
        self.refresh().map_err(SensitivityError::Solve)?;
        self.engine.watch(&places, self.options.tol).map_err(|trouble| unsettled(&trouble))?;
        self.engine.converge_fully().map_err(|trouble| unsettled(&trouble))?;
        Ok(places)
    }
}

/// The angle (rad) that the sections at the tips of two solutions are turned against each other.
pub(crate) fn turn_between(a: &SpatialSolver, b: &SpatialSolver) -> f64 {
    let at_tip = |solver: &SpatialSolver| solver.engine.directors_at(solver.engine.solution.mesh.elements());
    let (p, q) = (at_tip(a), at_tip(b));
    let trace = dot(&p.a, &q.a) + dot(&p.b, &q.b) + dot(&p.c, &q.c);
    (0.5 * (trace - 1.0)).clamp(-1.0, 1.0).acos()
}

/// Something that is differentiated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    /// x, y or z (m) at a node.
    Position(usize, usize),
    /// The turn (rad) about e1, e2 or e3 at a node.
    Turn(usize, usize),
    /// The length (m) of the path of a cable less than at the reference strains.
    Stroke(usize),
    /// What has to be reeled in (m) of a cable for that, its own stretch aside.
    Command(usize),
    /// Force (0 to 2, N) or moment (3 to 5, N m) on the base.
    Base(usize),
}

/// Quantities of a pose.
pub(crate) const POSE: usize = 6;

/// Quantities with weights.
pub(crate) type Sum = Vec<(Quantity, f64)>;

type System = Collocation<N, M, Q, L>;
type Row = derivatives::Row<N, Q, L>;

impl Engine {
    /// The node at `s` (over L), if there is one.
    fn node_at(&self, s: f64) -> Option<usize> {
        self.solution.mesh.nodes().iter().position(|node| (node - s).abs() < SAME)
    }

    fn directors_at(&self, node: usize) -> Directors<f64> {
        let z = self.solution.nodes[node];
        Directors::of(&[z[0], z[1], z[2], z[3]])
    }

    /// The quantities of the pose at a node (over L).
    fn pose_at(&self, place: f64) -> [Quantity; POSE] {
        let node = self.node_at(place).unwrap_or(self.solution.mesh.elements());
        std::array::from_fn(|k| if k < 3 { Quantity::Position(node, k) } else { Quantity::Turn(node, k - 3) })
    }

    /// Keeps a node at each of these places (over L), from now on, and settles on the mesh that has them.
    fn watch(&mut self, places: &[f64], tolerance: f64) -> Result<(), Trouble> {
        let new: Vec<f64> = places.iter().copied().filter(|s| self.node_at(*s).is_none()).collect();
        for s in places.iter().filter(|s| **s > SAME && **s < 1.0 - SAME) {
            if !self.breaks.iter().any(|own| (own - s).abs() < SAME) {
                self.breaks.push(*s);
            }
        }
        self.breaks.sort_by(f64::total_cmp);
        if new.is_empty() {
            return Ok(());
        }
        let mut moving = self.kinks(10.0 * kink_resolution(tolerance, self.equations.arm().model.load_can_jump()));
        moving.extend(&new);
        let mut mesh = self.solution.mesh.clone();
        mesh.pin(&self.breaks, &moving);
        self.remap_to(mesh);
        self.settle(tolerance, First::Fair).map(|_| ())
    }

    /// Rounds until nothing moves any more.
    fn converge_fully(&mut self) -> Result<(), Trouble> {
        self.linearise()?;
        correct(&mut self.system, &self.solution, &mut self.correction);
        let stroke_control = self.hold_lengths()?;
        let moved = super::engine::largest_turn(&self.solution, &self.correction);
        if moved.max(stroke_control.off) < CONVERGED {
            return Ok(());
        }
        match self.iterate(CONVERGED, ROUNDS, None) {
            Err(Trouble::Stalled(size)) if size < NEARLY => Ok(()),
            other => other,
        }
    }

    /// Derivatives of weighted sums by `parameters` at the solution, cables that are commanded held. `None` where the
    /// system is singular.
    pub(super) fn derivatives(
        &self,
        mut sums: Vec<Sum>,
        parameters: &[Parameter],
        method: SensitivityMethod,
    ) -> Option<Derivatives> {
        let taut: Vec<usize> = self.stroke_control.as_ref().map_or(Vec::new(), |stroke_control| {
            stroke_control.taut_cables().iter().map(|i| stroke_control.cables[*i]).collect()
        });
        let mut sources = parameters.to_vec();
        sources.extend(taut.iter().map(|c| Parameter::Tension(*c)));
        let asked = sums.len();
        sums.extend(taut.iter().map(|c| vec![(Quantity::Command(*c), 1.0)]));
        // About the solution itself: the engine's last linearisation may be a round behind.
        let mut system = System::with(self.system.gauss.clone());
        linearise(&mut system, &self.equations, &self.solution).ok()?;
        let ends = [&self.solution.nodes[0], &self.solution.nodes[self.solution.mesh.elements()]];
        let change = |source: &Parameter| {
            self.equations.change_by(Way::Of(*source), system.stations(), system.end_stations(), ends).ok()
        };
        let changes: Vec<Forcing<N, Q, L>> = sources.iter().map(change).collect::<Option<_>>()?;
        let rows: Vec<Row> = sums.iter().map(|sum| self.sum_row(&system, sum, &sources)).collect();
        let rows = at_given_tensions(&system, &self.solution, &rows, &changes, method)?;
        hold(rows, asked, parameters, &taut, self.equations.arm().cables.len())
    }

    /// The row of a sum.
    fn sum_row(&self, system: &System, sum: &Sum, sources: &[Parameter]) -> Row {
        let mut row = Row { direct: vec![0.0; sources.len()], ..Row::default() };
        let (length, force) = (self.equations.units.length, self.equations.units.force);
        for (quantity, weight) in sum.iter().filter(|(_, weight)| *weight != 0.0) {
            match *quantity {
                Quantity::Position(node, q) => {
                    row.add_position(system, self.solution.groups(), [node, q], weight * length);
                }
                Quantity::Turn(node, axis) => {
                    let z = self.solution.nodes[node];
                    let q: [f64; 4] = each(|k| z[k]);
                    let (turns, directors) = (turn(&q), Directors::of(&q));
                    let along = [directors.a[axis], directors.b[axis], directors.c[axis]];
                    let mut weights = [0.0; N];
                    for k in 0..4 {
                        weights[k] = weight * (0..3).map(|j| along[j] * turns[j][k]).sum::<f64>();
                    }
                    row.functional.nodes.push((node, weights));
                }
                Quantity::Base(k) => {
                    let mut weights = [0.0; N];
                    weights[if k < 3 { FORCE + k } else { MOMENT + k - 3 }] =
                        -weight * if k < 3 { force } else { force * length };
                    row.functional.nodes.push((0, weights));
                }
                Quantity::Stroke(c) => self.add_stroke(system, c, false, weight * length, sources, &mut row),
                Quantity::Command(c) => self.add_stroke(system, c, true, weight * length, sources, &mut row),
            }
        }
        row
    }

    /// The stroke of a cable: of its path, or, unstretched, as it is commanded.
    fn add_stroke(
        &self,
        system: &System,
        c: usize,
        commanded: bool,
        factor: f64,
        sources: &[Parameter],
        row: &mut Row,
    ) {
        let equations = &self.equations;
        let groups = self.solution.groups();
        let by_stretch = if commanded { equations.stroke_by_stretch(c) } else { -1.0 };
        row.reserve(groups.count() * M);
        for (block, local) in system.locals().iter().enumerate() {
            let (g, j) = (block / M, block % M);
            let (by_strain, by_slope) = equations.stretch_gradient(c, block, &self.solution.stages[block]);
            let runs = equations.cables_in(block)[c].tension;
            let mut weight = Lanes::default();
            for lane in 0..groups.filled(g) {
                let own = factor * by_stretch * system.steps()[g].0[lane] * system.gauss.b[j];
                weight.0[lane] = own * runs.0[lane];
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
        let at = StageData::of(system, &self.solution);
        for (direct, source) in row.direct.iter_mut().zip(sources) {
            *direct += factor * equations.stroke_by(c, commanded, Way::Of(*source), at);
        }
    }
}
