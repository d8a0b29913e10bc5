//! What a drawing needs beside the stations of an answer, at the same stations.

use hydrostat::{Arm, Cable, Configuration, Options, Solver, SpatialConfiguration, SpatialSolver};
use serde::Serialize;

/// Radii and cables of the straight arm at the stations of an answer: with x, y, theta and beta there they give the surface,
/// r +- beta R b, and the cables, r + y beta b.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Drawing {
    /// R(s), m.
    radius: Vec<f64>,
    /// y(s) of each cable from the base to its anchor, m.
    offsets: Vec<Vec<f64>>,
    /// The same along c, of an arm in space.
    #[serde(skip_serializing_if = "Option::is_none")]
    offsets_c: Option<Vec<Vec<f64>>>,
    /// C1 A of the unloaded section at each cable's anchor, N.
    tension_scale: Vec<f64>,
    /// Where there is a stream.
    #[serde(skip_serializing_if = "Option::is_none")]
    layer: Option<Layer>,
    /// Where the arm passes through itself, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    crossing: Option<[f64; 2]>,
}

/// The layer of the stream over the windward surface, (7), at the stations.
#[derive(Debug, Clone, Serialize)]
struct Layer {
    /// Speed along the surface outside of the layer, m/s: positive towards the tip.
    speed: Vec<f64>,
    /// The side that the stream meets: 1 left, -1 right.
    windward: Vec<i8>,
    /// From the surface outwards, at equal distances: the share of the speed outside.
    profile: Vec<f64>,
}

impl Layer {
    /// Heights at which the profile is given.
    const HEIGHTS: u32 = 8;

    fn new(configuration: &Configuration) -> Option<Self> {
        let (arm, stations) = (&configuration.arm, &configuration.stations);
        let (speed, direction, thickness) = (arm.flow.speed, arm.flow.direction, arm.flow.layer_thickness);
        if speed <= 0.0 {
            return None;
        }
        let windward = |(theta, alpha): (&f64, &f64)| if (direction - theta - alpha).sin() > 0.0 { -1 } else { 1 };
        let outside: Vec<f64> = stations.s.iter().map(|s| configuration.layer_speed(*s, thickness)).collect();
        let fastest = (0..outside.len()).max_by(|a, b| outside[*a].abs().total_cmp(&outside[*b].abs()))?;
        let share = |k: u32| {
            let height = thickness * f64::from(k) / f64::from(Self::HEIGHTS);
            // Where nothing flows along the arm the profile is that of still water.
            if outside[fastest] == 0.0 {
                return 0.0;
            }
            configuration.layer_speed(stations.s[fastest], height) / outside[fastest]
        };
        Some(Self {
            windward: stations.theta.iter().zip(&stations.alpha).map(windward).collect(),
            profile: (0..=Self::HEIGHTS).map(share).collect(),
            speed: outside,
        })
    }
}

impl Drawing {
    pub(crate) fn new(configuration: &Configuration) -> Self {
        let (layer, crossing) = (Layer::new(configuration), crossing(configuration));
        Self { layer, crossing, ..Self::at(&configuration.arm, &configuration.stations.s) }
    }

    /// In space the cables are at r + beta (y b + z c).
    pub(crate) fn in_space(configuration: &SpatialConfiguration) -> Self {
        Self::at(&configuration.arm, &configuration.stations.s)
    }

    /// Of the straight arm alone, in the plane or in space.
    pub(crate) fn at(arm: &Arm, stations: &[f64]) -> Self {
        let along = |cable: &Cable, part: fn(f64) -> f64| -> Vec<f64> {
            let anchor = cable.end * arm.length * (1.0 + 1e-12);
            let place = |s: &f64| cable.offset.at(*s, arm.length).value * part(cable.angle.at(*s, arm.length).value);
            stations.iter().take_while(|s| **s <= anchor).map(place).collect()
        };
        let all = |part: fn(f64) -> f64| arm.cables.iter().map(|cable| along(cable, part)).collect::<Vec<_>>();
        Self {
            radius: stations.iter().map(|s| arm.radius.at(*s, arm.length).value).collect(),
            offsets: if arm.space.is_some() { all(f64::cos) } else { all(|_| 1.0) },
            offsets_c: arm.space.is_some().then(|| all(f64::sin)),
            tension_scale: (0..arm.cables.len()).map(|c| crate::arm_source::tension_scale(arm, c)).collect(),
            layer: None,
            crossing: None,
        }
    }
}

/// The first place where the surface meets another part of itself. Parts that are no further apart along the arm than it is wide do not
/// count: there the surface folds, which is a warning of the solver's own.
fn crossing(configuration: &Configuration) -> Option<[f64; 2]> {
    let (arm, stations) = (&configuration.arm, &configuration.stations);
    let width = |i: usize| 2.0 * stations.beta[i] * arm.radius.at(stations.s[i], arm.length).value;
    let sides: Vec<[[f64; 2]; 2]> = stations.s.iter().map(|s| configuration.surfaces(*s)).collect();
    let count = sides.len().saturating_sub(1);
    for i in 0..count {
        for j in i + 1..count {
            let far = stations.s[j] - stations.s[i + 1] > width(i).max(width(j));
            let apart = (stations.x[j] - stations.x[i]).hypot(stations.y[j] - stations.y[i]);
            // Steps are short beside widths: what is further apart cannot meet.
            let step = stations.s[i + 1] - stations.s[i] + stations.s[j + 1] - stations.s[j];
            if !far || apart > 0.5 * (width(i) + width(j)) + 2.0 * step {
                continue;
            }
            for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let met = meeting([sides[i][a], sides[i + 1][a]], [sides[j][b], sides[j + 1][b]]);
                if met.is_some() {
                    return met;
                }
            }
        }
    }
    None
}

/// Where two lines cross.
fn meeting([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let cross = |u: [f64; 2], v: [f64; 2]| u[0] * v[1] - u[1] * v[0];
    let to = |p: [f64; 2], q: [f64; 2]| [q[0] - p[0], q[1] - p[1]];
    let (along, other, between) = (to(a, b), to(c, d), to(a, c));
    let whole = cross(along, other);
    if whole == 0.0 {
        return None;
    }
    let (t, u) = (cross(between, other) / whole, cross(between, along) / whole);
    let inside = (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&u);
    inside.then(|| [a[0] + t * along[0], a[1] + t * along[1]])
}

/// A shape without its cables: enough to draw its surface.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Silhouette {
    x: Vec<f64>,
    y: Vec<f64>,
    #[serde(flatten)]
    turned: Turned,
    /// Half widths beta R, m.
    half_width: Vec<f64>,
}

/// How its sections are turned.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
enum Turned {
    Plane {
        theta: Vec<f64>,
    },
    Space {
        z: Vec<f64>,
        /// Normals.
        a: Vec<[f64; 3]>,
    },
}

impl Silhouette {
    /// At so many equally spaced stations.
    pub(crate) fn new(shape: &Configuration, count: usize) -> Self {
        let st = shape.resampled(count);
        let half_width = half_widths(&shape.arm, &st.s, &st.beta);
        Self { x: st.x, y: st.y, turned: Turned::Plane { theta: st.theta }, half_width }
    }

    /// The same of an arm in space.
    pub(crate) fn in_space(shape: &SpatialConfiguration, count: usize) -> Self {
        let st = shape.resampled(count);
        let half_width = half_widths(&shape.arm, &st.s, &st.beta);
        Self { x: st.x, y: st.y, turned: Turned::Space { z: st.z, a: st.a }, half_width }
    }

    /// Of the arm without its loads; `None` where even that has no shape.
    pub(crate) fn unloaded(arm: &Arm, count: usize) -> Option<Self> {
        /// Over L.
        const TOL: f64 = 1e-6;
        let bare = arm.unloaded();
        if arm.space.is_some() {
            let shape = SpatialSolver::new(&bare, Options::with_tol(TOL)).and_then(|mut solver| solver.solve());
            return shape.ok().map(|shape| Self::in_space(&shape, count));
        }
        let shape = Solver::new(&bare, Options::with_tol(TOL)).and_then(|mut solver| solver.solve());
        shape.ok().map(|shape| Self::new(&shape, count))
    }
}

fn half_widths(arm: &Arm, s: &[f64], beta: &[f64]) -> Vec<f64> {
    s.iter().zip(beta).map(|(s, beta)| beta * arm.radius.at(*s, arm.length).value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hydrostat_files::{ArmFile, shipped};

    #[test]
    fn surfaces_and_cables_follow_from_stations_and_drawing() {
        for name in shipped::all_names() {
            let mut arm = ArmFile::parse(shipped::get(name).unwrap(), name).unwrap().arm().unwrap();
            if arm.space.is_some() {
                cables_in_space_follow(&arm);
                continue;
            }
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

    fn cables_in_space_follow(arm: &Arm) {
        let mut shape = SpatialSolver::new(arm, Options::default()).unwrap().solve().unwrap();
        shape.stations = shape.resampled(23);
        let drawing = Drawing::in_space(&shape);
        let (st, along_c) = (&shape.stations, drawing.offsets_c.unwrap());
        for (c, offsets) in drawing.offsets.iter().enumerate() {
            for (i, y) in offsets.iter().enumerate() {
                let own = shape.cable_point(c, st.s[i]).unwrap();
                let centre = [st.x[i], st.y[i], st.z[i]];
                let drawn = [0, 1, 2].map(|k| centre[k] + st.beta[i] * (y * st.b[i][k] + along_c[c][i] * st.c[i][k]));
                assert!(own.iter().zip(drawn).all(|(a, b)| (a - b).abs() < 1e-12), "{own:?} {drawn:?}");
            }
        }
    }

    #[test]
    fn the_layer_is_that_of_the_solution() {
        let mut arm = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap().arm().unwrap();
        assert!(Layer::new(&arm.solve().unwrap()).is_none(), "still water has no layer");
        (arm.flow.speed, arm.flow.direction) = (0.2, 1.2);
        let mut shape = arm.solve().unwrap();
        shape.stations = shape.resampled(21);
        let layer = Layer::new(&shape).unwrap();
        // (7): 2 y - y^2 over the thickness.
        for (k, share) in layer.profile.iter().enumerate() {
            let y = k as f64 / 8.0;
            assert!((share - (2.0 * y - y * y)).abs() < 1e-12, "{share} at {y}");
        }
        for (i, speed) in layer.speed.iter().enumerate() {
            let phi = shape.stations.theta[i] + shape.stations.alpha[i];
            assert!((speed - 0.2 * (1.2 - phi).cos()).abs() < 1e-12);
        }
        // The water comes from below on the right.
        assert!(layer.windward.iter().all(|side| *side == -1), "{:?}", layer.windward);
    }

    /// A cable of constant offset curls the arm to a circle that the pull can close.
    #[test]
    fn an_arm_that_passes_through_itself_was_not_told_from_others() {
        let mut arm = Arm::cone(0.3, 0.006, 0.006, 110e3, 0.5);
        arm.cables.push(hydrostat::Cable::new("left", hydrostat::Profile::from(0.005)));
        let mut turned: Vec<(f64, bool)> = Vec::new();
        for k in 1..=40 {
            arm.cables[0].tension = 0.1 * f64::from(k);
            let Ok(mut shape) = arm.solve() else { break };
            shape.stations = shape.resampled(121);
            turned.push((shape.tip().theta, Drawing::new(&shape).crossing.is_some()));
        }
        let (most, last) = *turned.last().unwrap();
        assert!(most > 7.0 && last, "the arm goes round more than once: {turned:?}");
        assert!(
            turned.iter().all(|(theta, crosses)| *theta > 5.0 || !crosses),
            "an open arm does not cross: {turned:?}"
        );
    }

    #[test]
    fn the_ghost_of_a_straight_arm_is_straight() {
        let arm = ArmFile::parse(shipped::get("paper").unwrap(), "paper").unwrap().arm().unwrap();
        let ghost = Silhouette::unloaded(&arm, 11).unwrap();
        assert!(ghost.y.iter().all(|y| y.abs() < 1e-12));
        assert!((ghost.x[10] - 0.2).abs() < 1e-12 && (ghost.half_width[0] - 0.010).abs() < 1e-12);
    }
}
