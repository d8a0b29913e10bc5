//! How an equilibrium changes with what is given: exact derivatives of tip, strokes and stations.
//!
//! With F the converged equations and p a parameter, F_z dz/dp = -F_p (the implicit function theorem). F_z is the
//! derivative of the discrete equations themselves, beta' and beta'' included (`sensitivity/linear`), factorised once; the
//! entries of F_z and F_p are exact, from the code of the slopes running on numbers that carry derivatives
//! (`equilibrium/partials`). No solve is repeated and nothing is differenced.
//!
//! Forward, every parameter is one back-substitution, and every output a sum over it. Adjoint, every output is one
//! transposed solve, and every parameter a sum over that. Both give the same numbers to rounding.
//!
//! Where strokes are commanded, tensions t are unknown, and with s the strokes:
//!
//! ```text
//! d out = out_p + out_t dt,    s_t dt = d command - s_p
//! ```

mod band;
pub(crate) mod dual;
mod linear;

use self::linear::{Drift, Functional, Linear};
use crate::arm::Arm;
use crate::configuration::Wrench;
use crate::engine::{Engine, M, Trouble, solved};
use crate::equilibrium::{Asked, CLOSED, Equilibrium, N, OUT, RATE, Spot};
use crate::parameter::{Parameter, Unfit};
use crate::readings::Support;
use crate::sensitivity::dual::WAYS;
use crate::solve::Solver;
use crate::verdict::SolveError;

/// What Newton's last round moves (rad, and the tip over L) before an exact derivative is taken.
const CONVERGED: f64 = 1e-12;

/// The same where rounding, or a kink of the load, does not let it get there.
const NEARLY: f64 = 1e-7;

/// Rounds until then.
const ROUNDS: usize = 10;

/// Which way derivatives are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum SensitivityMethod {
    /// Whichever takes fewer solves.
    #[default]
    Best,
    /// One solve a parameter.
    Forward,
    /// One solve an output.
    Adjoint,
}

/// What is asked for beside the tip.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SensitivityOptions {
    /// Places along the arm (m, in [0, L]) whose poses are differentiated.
    pub stations: Vec<f64>,
    /// Which way.
    pub method: SensitivityMethod,
}

/// Change of a pose a unit of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PoseChange {
    /// Along e1, m.
    pub x: f64,
    /// Along e2, m.
    pub y: f64,
    /// Turn of the section, rad.
    pub theta: f64,
    /// Of the angle from the section's normal to the tangent, rad.
    pub alpha: f64,
}

/// A place along the arm with the changes of its pose.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitiveStation {
    /// m.
    pub s: f64,
    /// One a parameter, in their order.
    pub changes: Vec<PoseChange>,
}

/// Derivatives of an equilibrium by parameters, each a unit of [`Parameter::unit`].
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivities {
    /// What they are by.
    pub parameters: Vec<Parameter>,
    /// Of the tip, one a parameter.
    pub tip: Vec<PoseChange>,
    /// Of the stroke (m) of every cable, row by row, one a parameter.
    pub strokes: Vec<Vec<f64>>,
    /// Of the tension (N) of every cable: zero but where a stroke is commanded, and one by itself.
    pub tensions: Vec<Vec<f64>>,
    /// Of what support and cable anchors exert on the arm at the base, one a parameter.
    pub base: Vec<Wrench>,
    /// Of the places asked for, in their order.
    pub stations: Vec<SensitiveStation>,
}

/// Where the tip goes with a unit of effort: the image of the unit circle (or ball) of what it is by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    /// Half axes, the longer first, m a unit of the parameters.
    pub half_axes: [f64; 2],
    /// The direction of the longer one from e1, rad, in (-pi/2, pi/2].
    pub direction: f64,
}

/// Why there are no derivatives.
#[derive(Debug, Clone, thiserror::Error)]
pub enum SensitivityError {
    /// The arm has no equilibrium.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The arm has no such quantity.
    #[error(transparent)]
    Unfit(#[from] Unfit),
    /// The tension of a cable whose stroke is commanded.
    #[error("`cable[{0}].tension` follows from the stroke that is commanded of the cable")]
    Commanded(usize),
    /// The stroke of a cable whose tension is given.
    #[error("`cable[{0}].stroke` follows from the tension of the cable: command it to differentiate by it")]
    NotCommanded(usize),
    /// A place off the arm.
    #[error("there is no station at {s} m: the arm is {length} m long")]
    Station {
        /// m.
        s: f64,
        /// Of the arm, m.
        length: f64,
    },
    /// Cables rub: which way they slide decides what a change does.
    #[error("an arm whose cables rub has no one derivative: it depends on which way they slide")]
    Rubbing,
    /// The support option whose arm is no equilibrium at the tip.
    #[error("sensitivities need a clamped base")]
    Support,
    /// A limit point or a bifurcation.
    #[error("the equilibrium is at a limit point or a bifurcation, where it has no derivative")]
    Singular,
    /// The rounds do not settle.
    #[error("the equilibrium could not be settled closely enough: rounds still move it by {0:e}")]
    Unsettled(f64),
}

impl Parameter {
    /// All parameters that `arm` can be differentiated by: strokes of the cables that are commanded, tensions of the others.
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Parameter};
    ///
    /// let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    /// arm.cables.push(Cable::new("left", 0.001));
    /// let all = Parameter::all_of(&arm);
    /// assert_eq!(all[0], Parameter::Tension(0));
    /// assert!(all.contains(&Parameter::Young) && !all.contains(&Parameter::Stroke(0)));
    /// ```
    pub fn all_of(arm: &Arm) -> Vec<Self> {
        let cables = arm.cables.iter().enumerate().map(|(c, cable)| match cable.stroke {
            Some(_) => Self::Stroke(c),
            None => Self::Tension(c),
        });
        let plain = crate::parameter::PLAIN.into_iter().filter(|parameter| parameter.of(arm).is_ok());
        let offsets = arm.cables.iter().enumerate();
        let offsets = offsets.flat_map(|(c, cable)| cable.offset.points().into_iter().map(move |p| Self::Offset(c, p)));
        let radii = arm.radius.points().into_iter().map(Self::Radius);
        cables.chain(plain).chain(offsets).chain(radii).collect()
    }
}

impl Sensitivities {
    /// Of the parameter, if it was asked for: its place in the lists.
    pub fn index(&self, parameter: Parameter) -> Option<usize> {
        self.parameters.iter().position(|own| *own == parameter)
    }

    /// d (x, y) of the tip by the parameters given that were asked for: one column each, m a unit.
    pub fn tip_jacobian(&self, parameters: &[Parameter]) -> Vec<[f64; 2]> {
        parameters.iter().filter_map(|p| self.index(*p)).map(|k| [self.tip[k].x, self.tip[k].y]).collect()
    }

    /// Compliance of the tip: rows x (m), y (m), theta (rad); columns the dead forces along e1 and e2 (N) and the moment (N m).
    /// `None` where one of these was not asked for.
    pub fn compliance(&self) -> Option<[[f64; 3]; 3]> {
        let loads = [Parameter::TipForce(0), Parameter::TipForce(1), Parameter::TipMoment];
        let mut out = [[0.0; 3]; 3];
        for (column, load) in loads.into_iter().enumerate() {
            let change = self.tip[self.index(load)?];
            for (row, value) in out.iter_mut().zip([change.x, change.y, change.theta]) {
                row[column] = value;
            }
        }
        Some(out)
    }

    /// The manipulability ellipse of the tip by the tensions (or strokes) of the cables that were asked for: where the tip goes when the
    /// sum of their squares is one. `None` where none was.
    pub fn manipulability(&self) -> Option<Ellipse> {
        let is_cable = |p: &Parameter| matches!(p, Parameter::Tension(_) | Parameter::Stroke(_));
        let cables: Vec<Parameter> = self.parameters.iter().copied().filter(is_cable).collect();
        (!cables.is_empty()).then(|| Ellipse::of(&self.tip_jacobian(&cables)))
    }
}

impl Ellipse {
    /// Of a jacobian, given by its columns: from the eigenvalues of J J^T.
    pub fn of(columns: &[[f64; 2]]) -> Self {
        let [mut xx, mut xy, mut yy] = [0.0; 3];
        for [x, y] in columns {
            xx += x * x;
            xy += x * y;
            yy += y * y;
        }
        let (mean, radius) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        let longer = mean + radius;
        // The product of the eigenvalues is the determinant, a sum of squares of minors: without cancellation.
        let mut minors = 0.0;
        for (k, a) in columns.iter().enumerate() {
            for b in &columns[k + 1..] {
                let minor = a[0] * b[1] - a[1] * b[0];
                minors += minor * minor;
            }
        }
        let shorter = if longer > 0.0 { minors / longer } else { 0.0 };
        Self { half_axes: [longer.sqrt(), shorter.sqrt()], direction: 0.5 * (2.0 * xy).atan2(xx - yy) }
    }
}

impl Solver {
    /// Exact derivatives of the tip and of the strokes by `parameters`, about the equilibrium of the present loads, which is
    /// solved for where it was not yet.
    ///
    /// They are those of the discrete solution: what they differ by from the true ones is of the size of the error of the
    /// solution over that of its shape. At a kink of the load that lies on a station, at a limit point and where a cable just
    /// goes slack there is no derivative.
    ///
    /// # Errors
    /// [`SensitivityError`].
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Options, Parameter, Profile, Solver};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.2));
    /// arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).pulled(0.1));
    /// arm.flow.speed = 0.1;
    /// let mut solver = Solver::new(&arm, Options::default())?;
    ///
    /// let found = solver.sensitivities(&Parameter::all_of(&arm))?;
    /// let left = found.index(Parameter::Tension(0)).unwrap();
    /// let change = found.tip[left]; // m/N, rad/N
    /// assert!(change.theta > 0.0, "pulling the left cable turns the tip to the left");
    /// assert!(found.strokes[0][left] > 0.0, "and reels it in");
    ///
    /// // 1 mN more, against the derivative.
    /// let before = solver.update()?.tip;
    /// solver.set_tensions(&[0.201, 0.1])?;
    /// let after = solver.update()?.tip;
    /// assert!((after.y - before.y - 1e-3 * change.y).abs() < 1e-2 * (after.y - before.y).abs());
    ///
    /// let ellipse = found.manipulability().unwrap();
    /// assert!(ellipse.half_axes[0] >= ellipse.half_axes[1]);
    /// # Ok::<(), hydrostat::SensitivityError>(())
    /// ```
    pub fn sensitivities(&mut self, parameters: &[Parameter]) -> Result<Sensitivities, SensitivityError> {
        self.sensitivities_with(parameters, &SensitivityOptions::default())
    }

    /// [`Solver::sensitivities`], at stations along the arm too.
    ///
    /// # Errors
    /// [`SensitivityError`].
    pub fn sensitivities_with(
        &mut self,
        parameters: &[Parameter],
        options: &SensitivityOptions,
    ) -> Result<Sensitivities, SensitivityError> {
        let places = self.settle_for_derivatives(parameters, &options.stations)?;
        let engine = &self.engine;
        let cables = engine.equations.arm().cables.len();
        let mut quantities = engine.pose_at(1.0).to_vec();
        for place in &places {
            quantities.extend(engine.pose_at(*place));
        }
        quantities.extend((0..cables).map(Quantity::Stroke));
        quantities.extend((0..3).map(Quantity::Base));
        let found = engine.derivatives(&quantities, parameters, options.method).ok_or(SensitivityError::Singular)?;

        let pose = |first: usize, k: usize| PoseChange {
            x: found.rows[first][k],
            y: found.rows[first + 1][k],
            theta: found.rows[first + 2][k],
            alpha: found.rows[first + 3][k],
        };
        let poses = |first: usize| (0..parameters.len()).map(|k| pose(first, k)).collect::<Vec<_>>();
        let (strokes, base) = found.rows[POSE * (places.len() + 1)..].split_at(cables);
        let wrench = |k: usize| Wrench { force: [base[0][k], base[1][k]], moment: base[2][k] };
        let stations = options.stations.iter().enumerate();
        let stations = stations.map(|(i, s)| SensitiveStation { s: *s, changes: poses(POSE * (i + 1)) }).collect();
        Ok(Sensitivities {
            parameters: parameters.to_vec(),
            tip: poses(0),
            strokes: strokes.to_vec(),
            base: (0..parameters.len()).map(wrench).collect(),
            tensions: found.tensions,
            stations,
        })
    }

    /// The gradient of one number that follows the shape, by `parameters`, whose unit it is a unit of: for optimisation with many
    /// parameters. One adjoint solve, however many these and the places are.
    ///
    /// `weights` are the number's own derivatives by the poses of places along the arm (m; the tip is at its length), a metre or
    /// a radian each.
    ///
    /// # Errors
    /// [`SensitivityError`].
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Options, Parameter, PoseChange, Profile, Solver};
    ///
    /// let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    /// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.2));
    /// let mut solver = Solver::new(&arm, Options::default())?;
    /// let parameters = Parameter::all_of(&arm);
    ///
    /// // Of the square of the tip's height.
    /// let y = solver.update()?.tip.y;
    /// let weights = [(0.2, PoseChange { y: 2.0 * y, ..PoseChange::default() })];
    /// let gradient = solver.gradient(&parameters, &weights)?;
    ///
    /// let tip = solver.sensitivities(&parameters)?.tip;
    /// assert!(gradient.iter().zip(&tip).all(|(g, t)| (g - 2.0 * y * t.y).abs() < 1e-10 * g.abs().max(1e-9)));
    /// # Ok::<(), hydrostat::SensitivityError>(())
    /// ```
    pub fn gradient(
        &mut self,
        parameters: &[Parameter],
        weights: &[(f64, PoseChange)],
    ) -> Result<Vec<f64>, SensitivityError> {
        let stations: Vec<f64> = weights.iter().map(|(s, _)| *s).collect();
        let places = self.settle_for_derivatives(parameters, &stations)?;
        let mut sum = Vec::with_capacity(POSE * places.len());
        for (place, (_, by)) in places.iter().zip(weights) {
            sum.extend(self.engine.pose_at(*place).into_iter().zip([by.x, by.y, by.theta, by.alpha]));
        }
        let found = self.engine.gradient(&sum, parameters).ok_or(SensitivityError::Singular)?;
        Ok(found.rows.into_iter().next().unwrap_or_default())
    }

    /// Solves, with nodes at the stations (m), until rounds move nothing any more. The stations over L.
    fn settle_for_derivatives(
        &mut self,
        parameters: &[Parameter],
        stations: &[f64],
    ) -> Result<Vec<f64>, SensitivityError> {
        let arm = self.engine.equations.arm();
        check(arm, parameters, stations)?;
        let places: Vec<f64> = stations.iter().map(|s| s / arm.length).collect();
        self.be_solved()?;
        self.engine.watch(&places, self.options.tol).map_err(|trouble| unsettled(&trouble))?;
        self.engine.converge_fully()?;
        Ok(places)
    }
}

pub(crate) fn check(arm: &Arm, parameters: &[Parameter], stations: &[f64]) -> Result<(), SensitivityError> {
    for parameter in parameters {
        parameter.of(arm)?;
        match *parameter {
            Parameter::Tension(c) if arm.cables[c].stroke.is_some() => return Err(SensitivityError::Commanded(c)),
            Parameter::Stroke(c) if arm.cables[c].stroke.is_none() => return Err(SensitivityError::NotCommanded(c)),
            _ => {}
        }
    }
    if arm.rubs() {
        return Err(SensitivityError::Rubbing);
    }
    if arm.readings.support != Support::Clamped {
        return Err(SensitivityError::Support);
    }
    match stations.iter().find(|s| !(0.0..=arm.length).contains(*s)) {
        Some(s) => Err(SensitivityError::Station { s: *s, length: arm.length }),
        None => Ok(()),
    }
}

fn unsettled(trouble: &Trouble) -> SensitivityError {
    match *trouble {
        Trouble::Singular => SensitivityError::Singular,
        Trouble::Stalled(size) => SensitivityError::Unsettled(size),
        Trouble::Section(_) | Trouble::Mesh | Trouble::Spent => SensitivityError::Unsettled(f64::NAN),
    }
}

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
const POSE: usize = 4;

/// Derivatives of quantities, one row each, and of the tensions of all cables.
pub(crate) struct Found {
    pub(crate) rows: Vec<Vec<f64>>,
    pub(crate) tensions: Vec<Vec<f64>>,
}

/// A quantity as weights on the change of the solution, with what follows a parameter beside that.
struct Row {
    functional: Functional,
    /// What a unit of it is in SI.
    unit: f64,
    /// One a source, in SI.
    direct: Vec<f64>,
}

impl Engine {
    /// The quantities of the pose at a node (over L).
    pub(crate) fn pose_at(&self, place: f64) -> [Quantity; POSE] {
        let node = self.node_at(place).unwrap_or(self.solution.mesh.elements());
        [Quantity::Position(node, 0), Quantity::Position(node, 1), Quantity::Theta(node), Quantity::Alpha(node)]
    }

    /// Rounds until nothing moves any more, and what the equations are at that.
    pub(crate) fn converge_fully(&mut self) -> Result<(), SensitivityError> {
        match self.newton(CONVERGED, ROUNDS) {
            Err(Trouble::Stalled(size)) if size < NEARLY => {}
            other => other.map_err(|trouble| unsettled(&trouble))?,
        }
        self.refresh().map_err(|failure| unsettled(&Trouble::Section(failure)))
    }

    /// Derivatives by `parameters` at the last evaluation, cables that are commanded held. `None` where the system is singular.
    pub(crate) fn derivatives(
        &self,
        quantities: &[Quantity],
        parameters: &[Parameter],
        method: SensitivityMethod,
    ) -> Option<Found> {
        let rows: Vec<Sum> = quantities.iter().map(|quantity| vec![(*quantity, 1.0)]).collect();
        self.derivatives_of(rows, parameters, method)
    }

    /// Derivatives of one weighted sum of poses.
    fn gradient(&self, sum: &[(Quantity, f64)], parameters: &[Parameter]) -> Option<Found> {
        self.derivatives_of(vec![sum.to_vec()], parameters, SensitivityMethod::Adjoint)
    }

    /// Derivatives of weighted sums.
    fn derivatives_of(&self, mut sums: Vec<Sum>, parameters: &[Parameter], method: SensitivityMethod) -> Option<Found> {
        let equations = &self.equations;
        let (held, cables) = (equations.held.as_ref(), equations.arm().cables.len());
        let taut: Vec<usize> = held.map_or(Vec::new(), |held| held.tight().iter().map(|i| held.cables[*i]).collect());
        let mut sources = parameters.to_vec();
        sources.extend(taut.iter().map(|c| Parameter::Tension(*c)));
        let asked = sums.len();
        sums.extend(taut.iter().map(|c| vec![(Quantity::Command(*c), 1.0)]));
        let mut rows = self.unheld_derivatives(&sums, &sources, method)?;

        let count = parameters.len();
        let strokes = rows.split_off(asked);
        let mut tensions = vec![vec![0.0; count]; cables];
        for k in 0..count {
            if let Parameter::Tension(c) = parameters[k] {
                tensions[c][k] = 1.0;
            }
            if taut.is_empty() {
                continue;
            }
            let row = |(stroke, c): (&Vec<f64>, &usize)| {
                let command = f64::from(u8::from(parameters[k] == Parameter::Stroke(*c)));
                (stroke[count..].to_vec(), [command - stroke[k], 0.0])
            };
            let (changes, _) = solved(strokes.iter().zip(&taut).map(row).collect())?;
            for (t, (c, [change, _])) in taut.iter().zip(&changes).enumerate() {
                tensions[*c][k] = *change;
                for row in &mut rows {
                    row[k] += row[count + t] * change;
                }
            }
        }
        for row in &mut rows {
            row.truncate(count);
        }
        Some(Found { rows, tensions })
    }

    /// Derivatives with all tensions given.
    fn unheld_derivatives(
        &self,
        sums: &[Sum],
        sources: &[Parameter],
        method: SensitivityMethod,
    ) -> Option<Vec<Vec<f64>>> {
        let equations = &self.equations;
        let spots = equations.spots();
        let linear = Linear::new(self, &spots)?;
        let drifts = self.drifts(&spots, sources);
        let rows: Option<Vec<Row>> = sums.iter().map(|sum| self.sum_row(&linear, &spots, sum, sources)).collect();
        let rows = rows?;
        let forward = match method {
            SensitivityMethod::Forward => true,
            SensitivityMethod::Adjoint => false,
            SensitivityMethod::Best => sources.len() <= rows.len(),
        };
        let mut out = vec![vec![0.0; sources.len()]; rows.len()];
        if forward {
            for (k, drift) in drifts.iter().enumerate() {
                let response = linear.response(drift);
                for (out, row) in out.iter_mut().zip(&rows) {
                    out[k] = row.unit * linear.apply(&row.functional, &response, drift) + row.direct[k];
                }
            }
        } else {
            for (out, row) in out.iter_mut().zip(&rows) {
                let cotangent = linear.adjoint(&row.functional);
                for (k, drift) in drifts.iter().enumerate() {
                    out[k] = row.unit * linear.along(&row.functional, &cotangent, drift) + row.direct[k];
                }
            }
        }
        Some(out)
    }

    /// The row of a sum; of several quantities, all of them poses.
    fn sum_row(&self, linear: &Linear, spots: &[Spot], sum: &Sum, sources: &[Parameter]) -> Option<Row> {
        if let [(quantity, weight)] = sum[..]
            && weight == 1.0
        {
            return self.row(linear, spots, quantity, sources);
        }
        let mut out = Row { functional: Functional::default(), unit: 1.0, direct: vec![0.0; sources.len()] };
        for (quantity, weight) in sum.iter().filter(|(_, weight)| *weight != 0.0) {
            let row = self.row(linear, spots, *quantity, sources)?;
            out.functional.add(weight * row.unit, &row.functional);
            for (out, own) in out.direct.iter_mut().zip(&row.direct) {
                *out += weight * own;
            }
        }
        Some(out)
    }

    fn row(&self, linear: &Linear, spots: &[Spot], quantity: Quantity, sources: &[Parameter]) -> Option<Row> {
        let equations = &self.equations;
        let length = equations.units.length;
        let mut direct = vec![0.0; sources.len()];
        let (functional, unit) = match quantity {
            Quantity::Position(node, q) => (linear.position(node, q), length),
            Quantity::Theta(node) => (Linear::state(node, 0), 1.0),
            Quantity::Alpha(node) => (self.alpha_row(linear, node, sources, &mut direct)?, 1.0),
            Quantity::Stroke(c) => {
                self.reference_row(spots, c, sources, &mut direct);
                (linear.length(equations, c, -1.0), length)
            }
            Quantity::Base(k) => {
                let force = equations.units.force;
                (Linear::state(0, k + 1), if k < 2 { -force } else { -force * length })
            }
            Quantity::Command(c) => {
                self.reference_row(spots, c, sources, &mut direct);
                let [_, by_length, by_tension] = equations.stroke(c, &self.system.gauss.b);
                for (direct, source) in direct.iter_mut().zip(sources) {
                    if *source == Parameter::Tension(c) {
                        *direct = by_tension * length / equations.units.force;
                    }
                }
                (linear.length(equations, c, by_length), length)
            }
        };
        Some(Row { functional, unit, direct })
    }

    /// What the length of a cable at the reference strains makes of the geometry.
    fn reference_row(&self, spots: &[Spot], c: usize, sources: &[Parameter], direct: &mut [f64]) {
        let equations = &self.equations;
        for (direct, source) in direct.iter_mut().zip(sources) {
            let by = equations.reference_length_by(spots, c, *source, &self.system.gauss.b);
            *direct = by * equations.units.length;
        }
    }

    /// alpha where a node ends an element (at the base, begins one): beta' there is by the closed form, and beta'' from the element.
    fn alpha_row(&self, linear: &Linear, node: usize, sources: &[Parameter], direct: &mut [f64]) -> Option<Functional> {
        let equations = &self.equations;
        let left = node > 0;
        let (element, nearest) = if left { (node - 1, node * M - 1) } else { (0, 0) };
        let asked = self.asked_beside(node, left);
        let found = match equations.at_place(&asked) {
            Err(_) => equations.at_place(&Asked { strain: equations.strain(nearest), ..asked }).ok()?,
            Ok(found) => found,
        };
        let beta = [found.beta_slope, asked.beta[1]];
        let spot = equations.spot_at(&Asked { strain: found.strain, beta, ..asked });
        let spot = std::slice::from_ref(&spot);
        let state = *equations.by_state(spot, &mut Vec::new()).first()?;
        let [x, y] = state.rate;
        let square = x * x + y * y;
        // alpha is the direction of (x, y)' less theta.
        let turn = |by_x: f64, by_y: f64| (x * by_y - y * by_x) / square;
        let one = |out: usize, way: usize| state.by[out][way];
        let by_beta = turn(one(RATE, N), one(RATE + 1, N));
        let share = by_beta / (1.0 - one(CLOSED, N));
        let mut weights: [f64; N] =
            std::array::from_fn(|a| turn(one(RATE, a), one(RATE + 1, a)) + share * one(CLOSED, a));
        weights[0] -= 1.0;
        for (direct, source) in direct.iter_mut().zip(sources) {
            let own = direct_change(equations, spot, *source);
            *direct = turn(own[RATE], own[RATE + 1]) + share * own[CLOSED];
        }
        Some(linear.at_end(equations, (node, weights), (element, usize::from(left)), share * state.reach))
    }

    fn drifts(&self, spots: &[Spot], sources: &[Parameter]) -> Vec<Drift> {
        let equations = &self.equations;
        let mut out: Vec<Drift> = sources.iter().map(|source| self.end_drift(*source)).collect();
        let of_sections: Vec<usize> = (0..sources.len()).filter(|k| is_of_section_law(sources[*k])).collect();
        for ways in of_sections.chunks(WAYS) {
            let parameters: Vec<Parameter> = ways.iter().map(|k| sources[*k]).collect();
            let mut stretch = Vec::new();
            let found = equations.by_section(spots, &parameters, &mut stretch);
            for (way, k) in ways.iter().enumerate() {
                out[*k].stations = found.iter().map(|by| by.map(|by| by.0[way])).collect();
                out[*k].stretch = stretch.iter().map(|by| by.0[way]).collect();
            }
        }
        for (drift, source) in out.iter_mut().zip(sources).filter(|(_, source)| is_of_loads(**source)) {
            drift.stations = spots.iter().map(|spot| equations.by_load(spot, *source)).collect();
        }
        out
    }

    /// What the conditions at the ends make of a parameter.
    fn end_drift(&self, source: Parameter) -> Drift {
        let left = f64::from(u8::from(source == Parameter::BaseAngle));
        let right = self.equations.tip_load_by(source, self.tip_angle());
        Drift { left, right, ..Drift::default() }
    }
}

/// How what is evaluated at one place follows a parameter.
fn direct_change(equations: &Equilibrium, spot: &[Spot], source: Parameter) -> [f64; OUT] {
    if is_of_section_law(source) {
        return equations.by_section(spot, &[source], &mut Vec::new())[0].map(|by| by.0[0]);
    }
    if is_of_loads(source) { equations.by_load(&spot[0], source) } else { [0.0; OUT] }
}

/// Whether strains follow it at a fixed state.
fn is_of_section_law(parameter: Parameter) -> bool {
    matches!(
        parameter,
        Parameter::Tension(_)
            | Parameter::Young
            | Parameter::Poisson
            | Parameter::ShearFactor
            | Parameter::Offset(..)
            | Parameter::Radius(_)
            | Parameter::Coefficient(_)
    )
}

/// Whether the loads along the arm follow it.
fn is_of_loads(parameter: Parameter) -> bool {
    matches!(
        parameter,
        Parameter::FlowSpeed
            | Parameter::FlowDirection
            | Parameter::FlowDensity
            | Parameter::GravityAcceleration
            | Parameter::GravityDirection
            | Parameter::Density
            | Parameter::DragNormal
            | Parameter::DragTangential
    )
}
