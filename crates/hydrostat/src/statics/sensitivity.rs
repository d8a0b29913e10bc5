//! How an equilibrium changes with what is given: exact derivatives of tip, strokes and stations.
//!
//! With F the converged equations and p a parameter, F_z dz/dp = -F_p (the implicit function theorem). F_z is the
//! exact derivative of the discrete equations, beta' included, factorised once. F_p is exact for tensions; for other
//! parameters it is a difference of the fourth order of the explicit terms at the fixed solution (`equations/change`).
//! No solve is repeated.
//!
//! Forward, every parameter is one back-substitution, and every output a sum over it. Adjoint, every output is one
//! transposed solve, and every parameter a sum over that. Both give the same numbers to rounding.
//!
//! Where strokes are commanded, tensions t are unknown, and with s the strokes:
//!
//! ```text
//! d out = out_p + out_t dt,    s_t dt = d command - s_p
//! ```

pub(crate) mod derivatives;
mod error;
mod quantities;

pub use self::derivatives::SensitivityMethod;
pub use self::error::SensitivityError;
pub(crate) use self::error::unsettled;
use self::quantities::POSE;
pub(crate) use self::quantities::Quantity;
use crate::rod::arm::Arm;
use crate::rod::model_options::Support;
use crate::rod::parameter::{Curvature, IN_SPACE, PLAIN, Parameter};
use crate::statics::configuration::Wrench;
use crate::statics::solve::Solver;

/// What is asked for beside the tip.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SensitivityOptions {
    /// Places along the arm (m, in [0, L]) whose poses are differentiated; by the length of the arm, places that keep
    /// their fraction of it.
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
pub struct SensitiveStation<P = PoseChange> {
    /// m.
    pub s: f64,
    /// One a parameter, in their order.
    pub changes: Vec<P>,
}

/// Derivatives of an equilibrium by parameters, each a unit of [`Parameter::unit`]: in the plane, or with
/// [`crate::SpatialPoseChange`] and [`crate::SpatialWrench`] in space.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivities<P = PoseChange, W = Wrench> {
    /// What they are by.
    pub parameters: Vec<Parameter>,
    /// Of the tip, one a parameter.
    pub tip: Vec<P>,
    /// Of the stroke (m) of every cable, row by row, one a parameter.
    pub strokes: Vec<Vec<f64>>,
    /// Of the tension (N) of every cable: zero but where a stroke is commanded, and one by itself.
    pub tensions: Vec<Vec<f64>>,
    /// Of what support and cable anchors exert on the arm at the base, one a parameter.
    pub base: Vec<W>,
    /// Of the places asked for, in their order.
    pub stations: Vec<SensitiveStation<P>>,
}

/// Where the tip goes with a unit of effort: the image of the unit circle (or ball) of what it is by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    /// Half axes, the longer first, m a unit of the parameters.
    pub half_axes: [f64; 2],
    /// The direction of the longer one from e1, rad, in (-pi/2, pi/2].
    pub direction: f64,
}

impl Parameter {
    /// All parameters that `arm` can be differentiated by: strokes of the cables that are commanded, tensions of the
    /// others; of the loads along the arm those that it has, as others are asked for by name.
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
        let plain = PLAIN.into_iter().chain(IN_SPACE).filter(|parameter| parameter.of(arm).is_ok());
        let offsets = arm.cables.iter().enumerate();
        let offsets = offsets.flat_map(|(c, cable)| cable.offset.points().into_iter().map(move |p| Self::Offset(c, p)));
        let angles = arm.cables.iter().enumerate().filter(|_| arm.space.is_some());
        let angles =
            angles.flat_map(|(c, cable)| cable.angle.points().into_iter().map(move |p| Self::CableAngle(c, p)));
        let radii = arm.radius.points().into_iter().map(Self::Radius);
        let curvatures = Curvature::ALL.into_iter().filter_map(|own| Some((own, own.of(arm)?)));
        let curvatures =
            curvatures.flat_map(|(own, profile)| profile.points().into_iter().map(move |p| Self::Reference(own, p)));
        let has = |own: &Self| matches!(own.profile(arm), Ok(Some((profile, _))) if !profile.is_zero());
        let along = Self::of_distributed(arm).into_iter().filter(has);
        cables.chain(plain).chain(offsets).chain(angles).chain(radii).chain(curvatures).chain(along).collect()
    }
}

impl<P, W> Sensitivities<P, W> {
    /// Of the parameter, if it was asked for: its place in the lists.
    pub fn index(&self, parameter: Parameter) -> Option<usize> {
        self.parameters.iter().position(|own| *own == parameter)
    }

    /// The tensions and strokes of cables that were asked for.
    pub(crate) fn cables(&self) -> Vec<Parameter> {
        let is_cable = |p: &Parameter| matches!(p, Parameter::Tension(_) | Parameter::Stroke(_));
        self.parameters.iter().copied().filter(is_cable).collect()
    }
}

impl Sensitivities {
    /// d (x, y) of the tip by the parameters given that were asked for: one column each, m a unit.
    pub fn tip_jacobian(&self, parameters: &[Parameter]) -> Vec<[f64; 2]> {
        parameters.iter().filter_map(|p| self.index(*p)).map(|k| [self.tip[k].x, self.tip[k].y]).collect()
    }

    /// Compliance of the tip: rows x (m), y (m), theta (rad); columns the dead forces along e1 and e2 (N) and the
    /// moment (N m). `None` where one of these was not asked for.
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

    /// The manipulability ellipse of the tip by the tensions (or strokes) of the cables that were asked for: where the
    /// tip goes when the sum of their squares is one. `None` where none was.
    pub fn manipulability(&self) -> Option<Ellipse> {
        let cables = self.cables();
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
    /// Exact derivatives of the tip and of the strokes by `parameters`, about the equilibrium of the present loads,
    /// which is solved for where it was not yet.
    ///
    /// They are those of the discrete solution: what they differ by from the true ones is of the size of the error of
    /// the solution over that of its shape. At a kink of the load that lies on a station, at a limit point and where a
    /// cable just goes slack there is no derivative.
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

    /// The gradient of one number that follows the shape, by `parameters`, whose unit it is a unit of: for optimisation
    /// with many parameters. One adjoint solve, however many these and the places are.
    ///
    /// `weights` are the number's own derivatives by the poses of places along the arm (m; the tip is at its length), a
    /// metre or a radian each.
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
        self.refresh()?;
        self.engine.watch(&places, self.options.tol).map_err(|trouble| unsettled(&trouble))?;
        self.engine.converge_fully()?;
        Ok(places)
    }
}

/// Whether there are such derivatives.
pub(crate) fn check<E>(arm: &Arm, parameters: &[Parameter], stations: &[f64]) -> Result<(), SensitivityError<E>> {
    for parameter in parameters {
        parameter.of(arm)?;
        match *parameter {
            Parameter::Tension(c) if arm.cables[c].stroke.is_some() => return Err(SensitivityError::Commanded(c)),
            Parameter::Stroke(c) if arm.cables[c].stroke.is_none() => return Err(SensitivityError::NotCommanded(c)),
            _ => {}
        }
    }
    if let Some(cable) = arm.cables.iter().position(|cable| cable.friction > 0.0) {
        return Err(SensitivityError::Friction(cable));
    }
    if arm.model.support != Support::Clamped {
        return Err(SensitivityError::Support);
    }
    match stations.iter().find(|s| !(0.0..=arm.length).contains(*s)) {
        Some(s) => Err(SensitivityError::Station { s: *s, length: arm.length }),
        None => Ok(()),
    }
}
