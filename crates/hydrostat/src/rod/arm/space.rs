//! What takes an arm out of the plane.

use crate::rod::profile::Profile;

/// What an arm in space has beside what an arm in the plane has ([`super::Arm::space`]): the components that leave
/// the plane e1-e2.
///
/// With the default, nothing does: the arm has the shape that it has in the plane, and may leave it where it is
/// unstable.
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

    /// The loads that are numbers: directions of stream and gravity, and what acts on the tip.
    pub(crate) fn loads(&self) -> impl Iterator<Item = f64> {
        let directions = [self.stream, self.gravity].into_iter().flat_map(Option::unwrap_or_default);
        directions.chain([self.tip_force, self.tip_follower]).chain(self.tip_moment)
    }

    /// Whether the same loads act along both.
    pub(crate) fn is_loaded_along_as(&self, other: &Self) -> bool {
        (&self.force, &self.couple) == (&other.force, &other.couple)
    }

    /// Whether both are alike but for their loads.
    pub(super) fn is_laid_out_as(&self, other: &Self) -> bool {
        let Self { stream, gravity, tip_force, tip_follower, tip_moment, .. } = *other;
        let (force, couple) = (other.force.clone(), other.couple.clone());
        let loaded = Self { stream, gravity, tip_force, tip_follower, tip_moment, force, couple, ..self.clone() };
        *other == loaded
    }

    /// Takes the loads away.
    pub(super) fn unload(&mut self) {
        (self.tip_force, self.tip_follower, self.tip_moment) = (0.0, 0.0, [0.0; 2]);
        (self.force, self.couple) = (0.0.into(), [0.0.into(), 0.0.into()]);
    }
}
