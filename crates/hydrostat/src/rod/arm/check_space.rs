//! What keeps numbers from being an arm in space.

use super::check::{finite, positive_profile};
use super::{Arm, ArmError};
use crate::rod::model_options::FlowSurface;

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
                    let why = "is parallel to `arm.base.direction`";
                    return Err(ArmError::Direction { key: "arm.base.section", why });
                }
            }
        }
        space.stream.map_or(Ok([0.0; 3]), |d| unit("flow.direction", d))?;
        space.gravity.map_or(Ok([0.0; 3]), |d| unit("gravity.direction", d))?;
        if self.model.flow_surface == FlowSurface::Lateral {
            let why = "has no windward side";
            return Err(ArmError::NotInSpace { key: "model.flow_surface".to_owned(), why });
        }
        if let Some(i) = self.cables.iter().position(|c| c.friction > 0.0) {
            let why = "is not solved yet";
            return Err(ArmError::NotInSpace { key: format!("cable[{i}].friction"), why });
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
    ///
    /// ```
    /// let mut arm = hydrostat::Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    /// arm.flow.speed = 0.1;
    /// arm.space = Some(hydrostat::Space { stream: Some([0.0, 0.0, 2.0]), ..Default::default() });
    /// assert_eq!(arm.stream_in_space(), [0.0, 0.0, 0.1]);
    /// ```
    pub fn stream_in_space(&self) -> [f64; 3] {
        let [x, y] = self.stream();
        match self.space.as_ref().and_then(|space| space.stream).map(|d| unit("flow.direction", d)) {
            Some(Ok(direction)) => direction.map(|d| self.flow.speed * d),
            _ => [x, y, 0.0],
        }
    }

    /// The acceleration of gravity in space, m/s2; zero without [`Arm::gravity`].
    ///
    /// ```
    /// let mut arm = hydrostat::Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    /// arm.gravity = Some(hydrostat::Gravity::default());
    /// assert!((arm.gravity_in_space()[1] + 9.81).abs() < 1e-12);
    /// ```
    pub fn gravity_in_space(&self) -> [f64; 3] {
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
        return Err(ArmError::Direction { key, why: "is the zero vector" });
    }
    let scaled = direction.map(|v| v / largest);
    let norm = scaled.iter().map(|v| v * v).sum::<f64>().sqrt();
    Ok(scaled.map(|v| v / norm))
}
