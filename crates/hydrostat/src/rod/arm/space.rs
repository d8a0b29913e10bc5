//! What takes an arm out of the plane.

use super::check::{finite, positive_profile};
use super::{Arm, ArmError};
use crate::rod::profile::Profile;
use crate::rod::readings::FlowSurface;

/// What an arm in space has beside what an arm in the plane has ([`Arm::space`]): the components that leave the plane e1-e2.
///
/// With the default, nothing does: the arm has the shape that it has in the plane, and may leave it where it is unstable.
///
/// ```
/// use hydrostat::{Arm, Cable, Profile, Space, SpatialSolver, Options};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// for k in 0..3 {
///     let angle = f64::from(k) * std::f64::consts::TAU / 3.0;
///     arm.cables.push(Cable::new(format!("cable {k}"), Profile::linear(0.005, 0.001)).at_angle(angle));
/// }
/// arm.cables[1].tension = 0.1; // N
/// arm.space = Some(Space::default());
/// let shape = SpatialSolver::new(&arm, Options::default())?.solve()?;
/// let tip = shape.tip();
/// assert!(tip.y < 0.0 && tip.z > 0.0, "it bends to the side of the pulled cable");
/// # Ok::<(), hydrostat::SpatialError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Space {
    /// z of the base, m.
    pub z: f64,
    /// Directors at the base; without, [`super::Base::angle`] in the plane with c = e3.
    pub base: Option<BaseDirections>,
    /// Direction of the stream, of any length but zero; without, [`super::Flow::direction`] in the plane.
    pub stream: Option<[f64; 3]>,
    /// Direction of gravity, of any length but zero; without, [`super::Gravity::direction`] in the plane.
    pub gravity: Option<[f64; 3]>,
    /// Dead force on the tip along e3, N.
    pub tip_force: f64,
    /// Force on the tip along c(L), N.
    pub tip_follower: f64,
    /// Dead moment on the tip about e1 and e2, N m; that about e3 is [`super::TipLoad::moment`].
    pub tip_moment: [f64; 2],
    /// Dead force along e3, N/m.
    pub force: Profile,
    /// Dead couple about e1 and e2, N m/m; that about e3 is [`super::DistributedLoad::couple`].
    pub couple: [Profile; 2],
    /// Shear strain zeta_o along c of the unloaded arm.
    pub zeta: Profile,
    /// Twist tau_o of the unloaded arm, 1/m.
    pub tau: Profile,
    /// Bending kappa_o about b of the unloaded arm, 1/m.
    pub kappa: Profile,
    /// C4 against twist, N; without, that of one isotropic round section: E (R^2 + R_in^2) / (4 (1 + poisson)), or
    /// C2 (R^2 + R_in^2) / 2 where the coefficients are given.
    pub c4: Option<Profile>,
}

/// Directors at the base of an arm in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseDirections {
    /// Direction of a, of any length but zero.
    pub direction: [f64; 3],
    /// What b is projected from, normal to a; without, b is e3 x a, or e2 where a is along e3.
    pub section: Option<[f64; 3]>,
}

impl Default for Space {
    fn default() -> Self {
        Self {
            z: 0.0,
            base: None,
            stream: None,
            gravity: None,
            tip_force: 0.0,
            tip_follower: 0.0,
            tip_moment: [0.0; 2],
            force: 0.0.into(),
            couple: [0.0.into(), 0.0.into()],
            zeta: 0.0.into(),
            tau: 0.0.into(),
            kappa: 0.0.into(),
            c4: None,
        }
    }
}

impl Space {
    /// The profiles with their keys.
    pub(super) fn profiles(&self) -> impl Iterator<Item = (&'static str, &Profile)> {
        [
            ("distributed.force[2]", &self.force),
            ("distributed.couple[0]", &self.couple[0]),
            ("distributed.couple[1]", &self.couple[1]),
            ("reference.zeta", &self.zeta),
            ("reference.tau", &self.tau),
            ("reference.kappa", &self.kappa),
        ]
        .into_iter()
        .chain(self.c4.iter().map(|c4| ("material.c4", c4)))
    }

    /// Takes the loads away.
    pub(super) fn unload(&mut self) {
        (self.tip_force, self.tip_follower, self.tip_moment) = (0.0, 0.0, [0.0; 2]);
        (self.force, self.couple) = (0.0.into(), [0.0.into(), 0.0.into()]);
    }
}

impl Arm {
    pub(super) fn check_space(&self, length: f64) -> Result<(), ArmError> {
        let Some(space) = &self.space else {
            return match self.cables.iter().position(|c| !c.angle.is_zero()) {
                Some(i) => Err(ArmError::OutOfPlane { key: format!("cable[{i}].angle") }),
                None => Ok(()),
            };
        };
        finite("arm.base.z", space.z)?;
        for (key, profile) in space.profiles() {
            profile.check(key, length)?;
        }
        if let Some(c4) = &space.c4 {
            positive_profile("material.c4", c4, length)?;
        }
        finite("tip.force", space.tip_force)?;
        finite("tip.follower", space.tip_follower)?;
        finite("tip.moment", space.tip_moment[0])?;
        finite("tip.moment", space.tip_moment[1])?;
        if let Some(base) = space.base {
            let a = unit("arm.base.direction", base.direction)?;
            if let Some(section) = base.section {
                let b = unit("arm.base.section", section)?;
                let along: f64 = (0..3).map(|k| a[k] * b[k]).sum();
                if along.abs() > 1.0 - 1e-12 {
                    let why = "must not be parallel to `arm.base.direction`";
                    return Err(ArmError::Direction { key: "arm.base.section", why });
                }
            }
        }
        space.stream.map_or(Ok([0.0; 3]), |d| unit("flow.direction", d))?;
        space.gravity.map_or(Ok([0.0; 3]), |d| unit("gravity.direction", d))?;
        if self.readings.flow_surface == FlowSurface::Lateral {
            let why = "has no windward side";
            return Err(ArmError::NotInSpace { key: "model.flow_surface".to_owned(), why });
        }
        if let Some(i) = self.cables.iter().position(|c| c.friction > 0.0) {
            let why = "is not solved yet";
            return Err(ArmError::NotInSpace { key: format!("cable[{i}].friction"), why });
        }
        if let Some(i) = self.cables.iter().position(|c| c.stroke.is_some()) {
            let why = "is not solved yet (give the tension)";
            return Err(ArmError::NotInSpace { key: format!("cable[{i}].stroke"), why });
        }
        Ok(())
    }

    /// Directors a and b of the base in space.
    pub(crate) fn base_directors(&self) -> [[f64; 3]; 2] {
        let (sin, cos) = self.base.angle.sin_cos();
        let in_plane = [[cos, sin, 0.0], [-sin, cos, 0.0]];
        let Some(base) = self.space.as_ref().and_then(|space| space.base) else { return in_plane };
        let Ok(a) = unit("arm.base.direction", base.direction) else { return in_plane };
        let sideways = a[0].hypot(a[1]);
        let from = match base.section {
            Some(section) => section,
            None if sideways > 1e-12 => [-a[1], a[0], 0.0],
            None => [0.0, 1.0, 0.0],
        };
        let along: f64 = (0..3).map(|k| a[k] * from[k]).sum();
        let b = unit("arm.base.section", [0, 1, 2].map(|k| from[k] - along * a[k]));
        b.map_or(in_plane, |b| [a, b])
    }

    /// The free-stream velocity U in space, m/s.
    pub(crate) fn stream_in_space(&self) -> [f64; 3] {
        let [x, y] = self.stream();
        match self.space.as_ref().and_then(|space| space.stream).map(|d| unit("flow.direction", d)) {
            Some(Ok(direction)) => direction.map(|d| self.flow.speed * d),
            _ => [x, y, 0.0],
        }
    }

    /// The acceleration of gravity in space, m/s2.
    pub(crate) fn gravity_in_space(&self) -> [f64; 3] {
        let Some(gravity) = self.gravity else { return [0.0; 3] };
        let given = self.space.as_ref().and_then(|space| space.gravity).map(|d| unit("gravity.direction", d));
        if let Some(Ok(direction)) = given {
            return direction.map(|d| gravity.acceleration * d);
        }
        let (sin, cos) = gravity.direction.sin_cos();
        [gravity.acceleration * cos, gravity.acceleration * sin, 0.0]
    }
}

/// A direction of length one.
fn unit(key: &'static str, direction: [f64; 3]) -> Result<[f64; 3], ArmError> {
    for v in direction {
        finite(key, v)?;
    }
    let largest = direction.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if largest == 0.0 {
        return Err(ArmError::Direction { key, why: "must have a length: a direction of zeros is none" });
    }
    let scaled = direction.map(|v| v / largest);
    let norm = scaled.iter().map(|v| v * v).sum::<f64>().sqrt();
    Ok(scaled.map(|v| v / norm))
}
