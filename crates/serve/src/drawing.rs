//! What a drawing needs beside the stations of an answer, at the same stations.

use hydrostat::{Arm, Configuration, Options, Solver};
use serde::Serialize;

/// Radii and cables of the straight arm at the stations of an answer: with x, y, theta and beta there they give the surface,
/// r +- beta R b, and the cables, r + y beta b.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Drawing {
    /// R(s), m.
    radius: Vec<f64>,
    /// y(s) of each cable from the base to its anchor, m.
    offsets: Vec<Vec<f64>>,
    /// C1 A of the unloaded section at each cable's anchor, N.
    tension_scale: Vec<f64>,
}

impl Drawing {
    pub(crate) fn new(configuration: &Configuration) -> Self {
        let (arm, stations) = (&configuration.arm, &configuration.stations);
        let radius = stations.s.iter().map(|s| arm.radius.at(*s, arm.length).value).collect();
        let offsets = arm.cables.iter().map(|cable| {
            let anchor = cable.end * arm.length * (1.0 + 1e-12);
            stations.s.iter().take_while(|s| **s <= anchor).map(|s| cable.offset.at(*s, arm.length).value).collect()
        });
        let tension_scale = (0..arm.cables.len()).map(|c| crate::arm_source::tension_scale(arm, c)).collect();
        Self { radius, offsets: offsets.collect(), tension_scale }
    }
}

/// The unloaded arm.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Ghost {
    x: Vec<f64>,
    y: Vec<f64>,
    theta: Vec<f64>,
    /// Half widths beta R, m.
    half_width: Vec<f64>,
}

impl Ghost {
    /// Of the arm without its loads; `None` where even that has no shape.
    pub(crate) fn new(arm: &Arm, count: usize) -> Option<Self> {
        let bare = arm.unloaded();
        let shape = Solver::new(&bare, Options { tol: 1e-6 }).and_then(|mut solver| solver.solve()).ok()?;
        let stations = shape.resampled(count);
        let radius = |s: &f64| bare.radius.at(*s, bare.length).value;
        let half_width = stations.s.iter().zip(&stations.beta).map(|(s, beta)| beta * radius(s)).collect();
        Some(Self { x: stations.x, y: stations.y, theta: stations.theta, half_width })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hydrostat_files::{ArmFile, shipped};

    #[test]
    fn surfaces_and_cables_follow_from_stations_and_drawing() {
        for name in shipped::names() {
            let mut arm = ArmFile::parse(shipped::get(name).unwrap(), name).unwrap().arm().unwrap();
            arm.cables[0].tension = 0.2 * arm.cables[0].max_tension.unwrap();
            let mut shape = arm.solve().unwrap();
            shape.stations = shape.resampled(37);
            let drawing = Drawing::new(&shape);
            let st = &shape.stations;
            for i in 0..st.len() {
                let place =
                    |distance: f64| [st.x[i] - distance * st.theta[i].sin(), st.y[i] + distance * st.theta[i].cos()];
                let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9;
                let [left, right] = shape.surfaces(st.s[i]);
                assert!(near(left, place(st.beta[i] * drawing.radius[i])));
                assert!(near(right, place(-st.beta[i] * drawing.radius[i])));
                for (c, offsets) in drawing.offsets.iter().enumerate() {
                    let point = shape.cable_point(c, st.s[i]);
                    assert_eq!(point.is_some(), i < offsets.len(), "{name}, cable {c}, station {i}");
                    if let (Some(point), Some(y)) = (point, offsets.get(i)) {
                        assert!(near(point, place(st.beta[i] * y)));
                    }
                }
            }
        }
    }

    #[test]
    fn the_ghost_of_a_straight_arm_is_straight() {
        let arm = ArmFile::parse(shipped::get("paper").unwrap(), "paper").unwrap().arm().unwrap();
        let ghost = Ghost::new(&arm, 11).unwrap();
        assert!(ghost.y.iter().all(|y| y.abs() < 1e-12));
        assert!((ghost.x[10] - 0.2).abs() < 1e-12 && (ghost.half_width[0] - 0.010).abs() < 1e-12);
    }
}
