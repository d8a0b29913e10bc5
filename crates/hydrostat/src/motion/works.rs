//! Works: what was done on the arm since the start, added up beside the motion by the weights of the time method.
//!
//! ```text
//! kinetic + strain energy - (cables + water + gravity + loads + base + volume - dissipated) = constant
//! ```
//!
//! holds for the equations themselves, so that what is left of it says what the steps in time did to the energy.

use super::tableau::Tableau;

/// How many works there are.
pub(super) const WORKS: usize = 7;

/// What was done on the arm since the start of the run, J.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Works {
    /// By the cables: tension times the rate of the stroke.
    pub cables: f64,
    /// By the water: the stream's load with the motion in it (drag), added mass, and a stream that speeds up.
    pub water: f64,
    /// By weight less buoyancy.
    pub gravity: f64,
    /// By the loads on the tip and along the arm.
    pub loads: f64,
    /// By the base, where it moves.
    pub base: f64,
    /// What the material's memory of rate took (not on the arm but from it).
    pub dissipated: f64,
    /// What sections that swell or thin give: the forces of the model do no work on that, so that strain energy,
    /// cables and rotary inertia need it. Zero with [`Volume::None`](crate::Volume::None), which alone has an energy
    /// that is kept.
    pub volume: f64,
}

impl Works {
    pub(super) fn of([cables, water, gravity, loads, base, dissipated, volume]: [f64; WORKS]) -> Self {
        Self { cables, water, gravity, loads, base, dissipated, volume }
    }

    pub(super) fn in_units_of(self, unit: f64) -> Self {
        let Self { cables, water, gravity, loads, base, dissipated, volume } = self;
        Self::of([cables, water, gravity, loads, base, dissipated, volume].map(|work| work * unit))
    }

    /// All of them on the arm, less what was dissipated: by how much the kinetic energy and that of strain grew, J.
    pub fn sum(&self) -> f64 {
        self.cables + self.water + self.gravity + self.loads + self.base + self.volume - self.dissipated
    }
}

/// n_f and m_f at the base, three components each; in the plane those that leave it are zero.
pub(super) type Carried = [f64; 6];

/// What one stage in time tells besides the motion: powers, and what the base carries.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Reading {
    pub(super) time: f64,
    pub(super) powers: [f64; WORKS],
    /// n_f(0) and m_f(0).
    pub(super) base: Carried,
}

/// The works until now, and the readings of the last step.
#[derive(Debug, Clone, Default)]
pub(super) struct Ledger {
    /// Works at the start of the last step, and at its end.
    works: [[f64; WORKS]; 2],
    /// Powers there.
    powers: [[f64; WORKS]; 2],
    /// What the base carried through the last step.
    base: Vec<(f64, Carried)>,
    /// Of the step that is tried.
    stages: Vec<Reading>,
    /// Kinetic energy and that of strain at the start of the run, and their largest sum above it.
    start: f64,
    largest: f64,
    /// What the steps gained of energy.
    gap: f64,
}

impl Ledger {
    /// At the start of a run, with what the base carries, the energy of the arm, and works and powers until then.
    pub(super) fn new(time: f64, base: Carried, energy: f64, [works, powers]: [[f64; WORKS]; 2]) -> Self {
        let start = energy - Works::of(works).sum();
        Self { works: [works; 2], powers: [powers; 2], base: vec![(time, base)], start, ..Self::default() }
    }

    /// Starts a step at `time`, whose first stage is the end of the last one if `explicit_first`.
    pub(super) fn start(&mut self, time: f64, explicit_first: bool) {
        self.stages.clear();
        if explicit_first {
            let base = self.base.last().map_or([0.0; 6], |(_, base)| *base);
            self.stages.push(Reading { time, powers: self.powers[1], base });
        }
    }

    /// Takes the next stage.
    pub(super) fn take(&mut self, stage: Reading) {
        self.stages.push(stage);
    }

    /// Takes the step of length `h` that was tried, by the weights of `tableau`; the arm has the energy `energy` then.
    pub(super) fn accept(&mut self, tableau: &Tableau, h: f64, energy: f64) {
        let weights = tableau.a[tableau.c.len() - 1];
        let [_, start] = self.works;
        let mut end = start;
        for (stage, weight) in self.stages.iter().zip(weights) {
            for (work, power) in end.iter_mut().zip(stage.powers) {
                *work += h * weight * power;
            }
        }
        self.works = [start, end];
        self.gap = energy - Works::of(end).sum() - self.start;
        self.largest = self.largest.max((energy - self.start).abs());
        let last = self.stages.last().map_or([0.0; WORKS], |stage| stage.powers);
        // Where powers jump at the start, the parabola that ends as the step does tells them.
        let first = match self.stages.first() {
            Some(stage) if tableau.explicit_first => stage.powers,
            _ => std::array::from_fn(|k| 2.0 * (end[k] - start[k]) / h - last[k]),
        };
        self.powers = [first, last];
        self.base.clear();
        self.base.extend(self.stages.iter().map(|stage| (stage.time, stage.base)));
        self.base.sort_by(|a, b| a.0.total_cmp(&b.0));
    }

    /// What the steps gained of energy (negative: lost), and the largest change of the energy of the arm until now.
    pub(super) fn gap(&self) -> [f64; 2] {
        [self.gap, self.largest]
    }

    /// Works and powers at the fraction `x` of the last step, of length `h`.
    pub(super) fn at(&self, x: f64, h: f64) -> [[f64; WORKS]; 2] {
        let powers = std::array::from_fn(|k| self.powers[0][k] * (1.0 - x) + self.powers[1][k] * x);
        [self.works_in_units(x, h), powers]
    }

    /// The works at the fraction `x` of the last step, of length `h`: the cubic through works and powers at its ends.
    pub(super) fn works_at(&self, x: f64, h: f64) -> Works {
        Works::of(self.works_in_units(x, h))
    }

    fn works_in_units(&self, x: f64, h: f64) -> [f64; WORKS] {
        let (x2, x3) = (x * x, x * x * x);
        let weights = [1.0 - 3.0 * x2 + 2.0 * x3, h * (x - 2.0 * x2 + x3), 3.0 * x2 - 2.0 * x3, h * (x3 - x2)];
        std::array::from_fn(|k| {
            let of = [self.works[0][k], self.powers[0][k], self.works[1][k], self.powers[1][k]];
            of.iter().zip(weights).map(|(value, weight)| value * weight).sum()
        })
    }

    /// n_f(0) and m_f(0) at `time` in the last step: the cubic through the four stages nearest to it.
    pub(super) fn base_at(&self, time: f64) -> Carried {
        let count = self.base.len();
        let past = self.base.partition_point(|(t, _)| *t < time);
        let first = past.saturating_sub(2).min(count.saturating_sub(4));
        let near = &self.base[first..(first + 4).min(count)];
        // No stage is before the first one after a jump.
        let time = near.first().map_or(time, |(t, _)| time.max(*t));
        let mut out = [0.0; 6];
        for (i, (t, own)) in near.iter().enumerate() {
            let others = near.iter().enumerate().filter(|(j, _)| *j != i);
            let weight: f64 = others.map(|(_, (u, _))| (time - u) / (t - u)).product();
            for (sum, value) in out.iter_mut().zip(own) {
                *sum += weight * value;
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::tableau::{RUNNING, STARTING};

    /// A power that is a cubic in time is integrated exactly by either method, and read between the steps with the
    /// order of the interpolation.
    #[test]
    fn works_are_integrals_of_powers() {
        let power = |t: f64| 1.0 + 2.0 * t - 3.0 * t * t;
        let work = |t: f64| t + t * t - t * t * t;
        for tableau in [&RUNNING, &STARTING] {
            let mut ledger = Ledger::new(0.0, [power(0.0); 6], 0.0, [[0.0; WORKS], [power(0.0); WORKS]]);
            ledger.start(0.0, tableau.explicit_first);
            let h = 0.4;
            for c in tableau.c.iter().skip(usize::from(tableau.explicit_first)) {
                let own = power(c * h);
                ledger.take(Reading { time: c * h, powers: [own; WORKS], base: [own; 6] });
            }
            ledger.accept(tableau, h, 0.0);
            let end = ledger.works_at(1.0, h);
            assert!((end.water - work(h)).abs() < 1e-14, "{end:?}");
            if tableau.explicit_first {
                assert!((ledger.works_at(0.3, h).base - work(0.3 * h)).abs() < 1e-14);
            }
            for t in [0.1, 0.25, 0.4] {
                assert!((ledger.base_at(t)[1] - power(t)).abs() < 1e-13, "{t}");
            }
        }
    }
}
