//! Arms in space, and arms in the plane turned into space.

use std::f64::consts::TAU;

use hydrostat::{Arm, BaseDirections, Cable, Gravity, Options, Profile, Space, SpatialConfiguration, SpatialSolver};

pub(crate) fn solved(arm: &Arm, tol: f64) -> SpatialConfiguration {
    SpatialSolver::new(arm, Options::with_tol(tol)).unwrap().solve().unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn tip(shape: &SpatialConfiguration) -> [f64; 3] {
    let tip = shape.tip();
    [tip.x, tip.y, tip.z]
}

pub(crate) fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

pub(crate) fn in_space(arm: &Arm) -> Arm {
    Arm { space: Some(Space::default()), ..arm.clone() }
}

/// A rotation matrix from three angles.
pub(crate) fn rotation(a: f64, b: f64, c: f64) -> [[f64; 3]; 3] {
    let about = |axis: usize, angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut m = [[0.0; 3]; 3];
        m[axis][axis] = 1.0;
        (m[i][i], m[j][j], m[i][j], m[j][i]) = (cos, cos, -sin, sin);
        m
    };
    times(&times(&about(2, a), &about(1, b)), &about(0, c))
}

pub(crate) fn times(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

pub(crate) fn turned(m: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|k| m[i][k] * v[k]).sum())
}

/// An arm in the plane with base, loads, stream and gravity turned into another plane.
pub(crate) fn turned_arm(arm: &Arm, m: &[[f64; 3]; 3]) -> Arm {
    let mut out = arm.clone();
    let (sin, cos) = arm.base.angle.sin_cos();
    let in_plane = |angle: f64| [angle.cos(), angle.sin(), 0.0];
    let force = turned(m, [arm.tip.force[0], arm.tip.force[1], 0.0]);
    let moment = turned(m, [0.0, 0.0, arm.tip.moment]);
    out.tip.force = [force[0], force[1]];
    out.tip.moment = moment[2];
    let base = turned(m, [arm.base.x, arm.base.y, 0.0]);
    (out.base.x, out.base.y) = (base[0], base[1]);
    out.space = Some(Space {
        z: base[2],
        base: Some(BaseDirections {
            direction: turned(m, [cos, sin, 0.0]),
            section: Some(turned(m, [-sin, cos, 0.0])),
        }),
        stream: Some(turned(m, in_plane(arm.flow.direction))),
        gravity: arm.gravity.map(|g| turned(m, in_plane(g.direction))),
        tip_force: force[2],
        tip_moment: [moment[0], moment[1]],
        ..Space::default()
    });
    out
}

pub(crate) fn silicone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1080.0;
    arm.flow.density = 1022.0;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

pub(crate) fn three_cables() -> Arm {
    let mut arm = silicone();
    arm.cables.clear();
    for (k, tension) in [0.1, 0.05, 0.0].into_iter().enumerate() {
        let cable = Cable::new(format!("{k}"), Profile::linear(0.005, 0.001)).pulled(tension);
        arm.cables.push(cable.at_angle(k as f64 * TAU / 3.0));
    }
    arm.flow.speed = 0.1;
    arm.gravity = Some(Gravity { acceleration: 2.0, direction: 0.0 });
    arm.space = Some(Space {
        base: Some(BaseDirections { direction: [1.0, 0.2, 0.1], section: Some([0.0, 1.0, 0.3]) }),
        stream: Some([0.6, 0.5, -0.7]),
        gravity: Some([0.1, 0.2, -1.0]),
        tip_force: 0.0005,
        tip_moment: [1e-5, 0.0],
        ..Space::default()
    });
    arm
}
