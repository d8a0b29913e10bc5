//! The motion against an explicit method of lines that shares nothing with the program: a staggered grid along the arm,
//! second differences, the classical Runge-Kutta method of order 4 at the steps that stretch waves allow.
//!
//! Places stand at nodes, angles between them. Sections are rigid (`volume = "none"`); what acts are the tip's load,
//! drag by the square of the speed, and added mass. Two grids are extrapolated.

use std::f64::consts::PI;

use hydrostat::{Arm, Course, FlowLaw, Inputs, MotionOptions, Simulation, Volume};

/// A tapered arm as the lines have it.
struct Lines {
    count: usize,
    arm: Arm,
    /// Force on the tip along e2 over time.
    force: fn(f64) -> f64,
}

/// Place and angle with their rates, at one node or between two.
type Point = [f64; 2];

#[derive(Clone)]
struct Motion {
    place: Vec<Point>,
    velocity: Vec<Point>,
    /// Angle and its rate.
    turn: Vec<Point>,
}

impl Motion {
    /// `self + factor rates`.
    fn plus(&self, factor: f64, rates: &Self) -> Self {
        let add = |own: &[Point], other: &[Point]| {
            own.iter().zip(other).map(|(a, b)| [a[0] + factor * b[0], a[1] + factor * b[1]]).collect()
        };
        Self {
            place: add(&self.place, &rates.place),
            velocity: add(&self.velocity, &rates.velocity),
            turn: add(&self.turn, &rates.turn),
        }
    }
}

impl Lines {
    fn step(&self) -> f64 {
        self.arm.length / self.count as f64
    }

    fn straight(&self) -> Motion {
        Motion {
            place: (0..=self.count).map(|i| [i as f64 * self.step(), 0.0]).collect(),
            velocity: vec![[0.0; 2]; self.count + 1],
            turn: vec![[0.0; 2]; self.count],
        }
    }

    fn radius(&self, s: f64) -> f64 {
        self.arm.radius.at(s, self.arm.length).value
    }

    fn rates(&self, time: f64, motion: &Motion) -> Motion {
        let (n, h, arm) = (self.count, self.step(), &self.arm);
        let water = arm.flow.density;
        // Force and moment of each piece in space, and r'.
        let pieces: Vec<([f64; 2], [f64; 2])> = (0..n)
            .map(|j| {
                let stiffness = arm.stiffness_at((j as f64 + 0.5) * h);
                let slope = [0, 1].map(|k| (motion.place[j + 1][k] - motion.place[j][k]) / h);
                let (sin, cos) = motion.turn[j][0].sin_cos();
                let (nu, eta) = (slope[0] * cos + slope[1] * sin, slope[1] * cos - slope[0] * sin);
                let (along, across) = (stiffness[0] * (nu - 1.0), stiffness[1] * eta);
                ([along * cos - across * sin, along * sin + across * cos], slope)
            })
            .collect();
        // At node i, between the pieces i - 1 and i; the clamp is half a step before the first.
        let moment = |i: usize| {
            let stiffness = arm.stiffness_at(i as f64 * h)[2];
            match i {
                0 => stiffness * motion.turn[0][0] / (0.5 * h),
                i if i == n => 0.0,
                i => stiffness * (motion.turn[i][0] - motion.turn[i - 1][0]) / h,
            }
        };
        let turn = (0..n)
            .map(|j| {
                let (force, slope) = pieces[j];
                let area = PI * self.radius((j as f64 + 0.5) * h).powi(2);
                let rotary = arm.density * area * area / (4.0 * PI);
                let couple = (moment(j + 1) - moment(j)) / h + slope[0] * force[1] - slope[1] * force[0];
                [motion.turn[j][1], couple / rotary]
            })
            .collect();
        let velocity = (0..=n)
            .map(|i| {
                if i == 0 {
                    return [0.0; 2];
                }
                let (before, after, fraction) = if i == n {
                    (pieces[n - 1], ([0.0, (self.force)(time)], pieces[n - 1].1), 0.5)
                } else {
                    (pieces[i - 1], pieces[i], 1.0)
                };
                let slope = [0, 1].map(|k| 0.5 * (before.1[k] + after.1[k]));
                let stretch = slope[0].hypot(slope[1]);
                let (u, w) = ([slope[0] / stretch, slope[1] / stretch], [-slope[1] / stretch, slope[0] / stretch]);
                // The tip's half cell has its middle a quarter of a step before the tip.
                let radius = self.radius(if i == n { arm.length - 0.25 * h } else { i as f64 * h });
                let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
                let own = motion.velocity[i];
                let mut force = [0, 1].map(|k| (after.0[k] - before.0[k]) / (fraction * h));
                if let FlowLaw::QuadraticDrag { cn, ct } = arm.flow.law {
                    let (along, across) = (-dot(own, u), -dot(own, w));
                    let [along, across] =
                        [PI * water * ct * radius * along.abs() * along, water * cn * radius * across.abs() * across];
                    force = [0, 1].map(|k| force[k] + along * u[k] + across * w[k]);
                }
                let area = PI * radius * radius;
                // Along the centreline the arm's own mass moves; across it, water besides.
                let nu = stretch;
                let (alone, with) = (arm.density * area, arm.density * area + water * area * nu);
                let (along, across) = (dot(force, u) / alone, dot(force, w) / with);
                [0, 1].map(|k| along * u[k] + across * w[k])
            })
            .collect();
        Motion { place: motion.velocity.clone(), velocity, turn }
    }

    /// Tips at equal times.
    fn tips(&self, every: f64, times: usize) -> Vec<Point> {
        let [axial, _, _] = self.arm.stiffness_at(0.0);
        let wave = (axial / (self.arm.density * PI * self.radius(0.0).powi(2))).sqrt();
        let longest = 0.5 * self.step() / wave;
        let parts = (1_u32..1_000_000).find(|parts| every / f64::from(*parts) <= longest).unwrap();
        let dt = every / f64::from(parts);
        let mut motion = self.straight();
        let mut out = Vec::new();
        for row in 0..times {
            for part in 0..parts {
                let time = row as f64 * every + f64::from(part) * dt;
                let a = self.rates(time, &motion);
                let b = self.rates(time + 0.5 * dt, &motion.plus(0.5 * dt, &a));
                let c = self.rates(time + 0.5 * dt, &motion.plus(0.5 * dt, &b));
                let d = self.rates(time + dt, &motion.plus(dt, &c));
                for (rates, weight) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
                    motion = motion.plus(weight * dt / 6.0, &rates);
                }
            }
            out.push(motion.place[self.count]);
        }
        out
    }
}

/// How far the tips are apart at most, over the length, and how far the tip goes.
fn compare(arm: &Arm, force: fn(f64) -> f64, rows: &[(f64, f64)], every: f64, times: usize) -> [f64; 2] {
    let [coarse, fine] = [32, 64].map(|count| Lines { count, arm: arm.clone(), force }.tips(every, times));
    let mut inputs = Inputs::default();
    inputs.set("tip.force[1]", Course::Table(rows.to_vec())).unwrap();
    let options = MotionOptions { tol: 1e-6, ..MotionOptions::default() };
    let mut simulation = Simulation::new(arm, inputs, options).unwrap();
    let (mut off, mut far) = (0.0_f64, 0.0_f64);
    for (a, b) in coarse.iter().zip(&fine) {
        let at = simulation.step(every).unwrap();
        let extrapolated = [0, 1].map(|k| (4.0 * b[k] - a[k]) / 3.0);
        off = off.max((at.tip[0] - extrapolated[0]).hypot(at.tip[1] - extrapolated[1]) / arm.length);
        far = far.max(at.tip[1].abs() / arm.length);
    }
    [off, far]
}

/// A tapered arm of rigid sections.
fn arm() -> Arm {
    let mut arm = Arm::cone(1.0, 0.06, 0.04, 1e5, 0.5);
    arm.density = 1000.0;
    arm.flow.density = 0.0;
    arm.model.volume = Volume::None;
    arm
}

/// A smooth push of the tip over half a second, as the lines and as a table have it.
fn push(time: f64) -> f64 {
    if time < 0.5 { 4.0 * (2.0 * PI * time).sin().powi(2) } else { 0.0 }
}

fn rows() -> Vec<(f64, f64)> {
    (0..=500).map(|k| f64::from(k) * 1e-3).map(|time| (time, push(time))).collect()
}

#[test]
fn a_large_swing_in_a_vacuum_is_that_of_an_explicit_method_of_lines() {
    let [off, far] = compare(&arm(), push, &rows(), 0.25, 8);
    assert!(far > 0.2, "{far}");
    assert!(off < 1e-4, "{off:.1e}");
}

#[test]
fn a_large_swing_in_still_water_is_that_of_an_explicit_method_of_lines() {
    let mut arm = arm();
    arm.flow.density = 1000.0;
    arm.flow.law = FlowLaw::QuadraticDrag { cn: 1.1, ct: 0.02 };
    let [off, far] = compare(&arm, push, &rows(), 0.25, 8);
    assert!(far > 0.1, "{far}");
    assert!(off < 1e-4, "{off:.1e}");
}
