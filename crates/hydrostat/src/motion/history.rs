//! What the time methods know of an arm: values, rates and second rates at the stations, flat in memory.
//!
//! In blocks of four elements side by side: theta, x, y at the stages; the same at the nodes (one block each, its
//! last lane empty); these have second rates. Then nu, eta, mu and beta' at the stages, which have rates alone.

use hydrostat_bvp::{Collocation, LANES, Lanes, Real};

use super::dimensions::{S, Shape, X};
use crate::statics::dimensions::{L, M};

/// Where what stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Layout {
    pub(super) blocks: usize,
    pub(super) nodes: usize,
}

impl Layout {
    /// Blocks that have second rates.
    pub(super) fn second(self) -> usize {
        3 * self.blocks + self.nodes
    }

    /// All blocks.
    pub(super) fn all(self) -> usize {
        self.second() + 4 * self.blocks
    }
}

/// What the rates of a stage start from: rate = cv (value - `values`), second rate = cv (rate - `rates`).
#[derive(Debug, Clone, Default)]
pub(super) struct History {
    layout: Layout,
    pub(super) values: Vec<Lanes>,
    pub(super) rates: Vec<Lanes>,
}

impl History {
    pub(super) fn set_layout(&mut self, layout: Layout) {
        self.layout = layout;
        self.values = vec![Lanes::of(0.0); layout.all()];
        self.rates = vec![Lanes::of(0.0); layout.second()];
    }

    /// Of theta, x, y (k = 0, 1, 2) in a block of stages.
    #[inline(always)]
    pub(super) fn value(&self, block: usize, k: usize) -> Lanes {
        self.values[3 * block + k]
    }

    #[inline(always)]
    pub(super) fn rate(&self, block: usize, k: usize) -> Lanes {
        self.rates[3 * block + k]
    }

    /// Rates of theta, x, y at the tip that a stage starts from.
    pub(super) fn last_rate(&self) -> [f64; 3] {
        if self.layout.nodes == 0 { [0.0; 3] } else { node_of(self.layout, &self.rates, self.layout.nodes - 1) }
    }

    /// Of nu, eta, mu in a block of stages.
    #[inline(always)]
    pub(super) fn strain(&self, block: usize, k: usize) -> Lanes {
        self.values[self.layout.second() + 4 * block + k]
    }
}

/// The motion at one time.
#[derive(Debug, Clone, Default)]
pub(super) struct Snapshot {
    pub(super) layout: Layout,
    pub(super) values: Vec<Lanes>,
    pub(super) rates: Vec<Lanes>,
    pub(super) second: Vec<Lanes>,
}

impl Snapshot {
    /// At rest, with these values.
    pub(super) fn at_rest(layout: Layout) -> Self {
        let zero = Lanes::of(0.0);
        Self {
            layout,
            values: vec![zero; layout.all()],
            rates: vec![zero; layout.all()],
            second: vec![zero; layout.second()],
        }
    }

    /// Takes the values of a solution whose states have the sizes `scales`, that of theta one; `system` is for its
    /// memory.
    pub(super) fn take(&mut self, system: &mut Collocation<S, M, 0, L>, solution: &Shape, scales: &[f64; S]) {
        system.take_stations(solution);
        let layout = self.layout;
        let size = scales[X];
        for (block, station) in system.stations().iter().enumerate() {
            let own = &mut self.values[3 * block..3 * block + 3];
            let per = Lanes::of(size);
            own.copy_from_slice(&[station.z[0], per * station.z[X], per * station.z[X + 1]]);
            let [nu, eta, mu] = solution.stages[block].inner;
            let first = layout.second() + 4 * block;
            self.values[first..first + 4].copy_from_slice(&[nu, eta, mu, solution.stages[block].closure_slope]);
        }
        for (i, z) in solution.nodes.iter().enumerate() {
            self.values[3 * layout.blocks + i] = Lanes([z[0], size * z[X], size * z[X + 1], 0.0]);
        }
    }

    /// Rates and second rates of the values that a solve gave, by what it started from.
    pub(super) fn rates_from(&mut self, cv: f64, history: &History) {
        let cv = Lanes::of(cv);
        for ((rate, value), from) in self.rates.iter_mut().zip(&self.values).zip(&history.values) {
            *rate = cv * (*value - *from);
        }
        for ((second, rate), from) in self.second.iter_mut().zip(&self.rates).zip(&history.rates) {
            *second = cv * (*rate - *from);
        }
    }

    /// theta, x, y of node `i`.
    pub(super) fn node(&self, i: usize) -> [f64; 3] {
        node_of(self.layout, &self.values, i)
    }

    /// Their rates.
    pub(super) fn node_rate(&self, i: usize) -> [f64; 3] {
        node_of(self.layout, &self.rates, i)
    }

    /// theta, x, y in a block of stages, and their rates.
    pub(super) fn stage(&self, block: usize) -> [[Lanes; 3]; 2] {
        let of = |list: &[Lanes]| std::array::from_fn(|k| list[3 * block + k]);
        [of(&self.values), of(&self.rates)]
    }

    /// Accelerations of x, y in a block of stages.
    pub(super) fn acceleration(&self, block: usize) -> [Lanes; 2] {
        [self.second[3 * block + 1], self.second[3 * block + 2]]
    }

    /// nu, eta, mu, beta' in a block of stages, and their rates.
    pub(super) fn strains(&self, block: usize) -> [[Lanes; 4]; 2] {
        let first = self.layout.second() + 4 * block;
        let of = |list: &[Lanes]| std::array::from_fn(|k| list[first + k]);
        [of(&self.values), of(&self.rates)]
    }
}

fn node_of(layout: Layout, list: &[Lanes], i: usize) -> [f64; 3] {
    let [theta, x, y, _] = list[3 * layout.blocks + i].0;
    [theta, x, y]
}

/// The motion at the share `x` of a step of length `h`: quintic where there are second rates, else cubic (Hermite).
pub(super) fn between(from: &Snapshot, to: &Snapshot, h: f64, x: f64, out: &mut Snapshot) {
    out.clone_from(from);
    let quintic = quintic(x);
    let (quintic_rate, quintic_second) = (quintic_rate(x), quintic_second(x));
    let (value, rate) = (cubic(x), cubic_rate(x));
    let second = from.layout.second();
    let by = |w: f64| Lanes::of(w);
    for i in 0..out.values.len() {
        let [p, q] = [from, to].map(|s| (s.values[i], s.rates[i]));
        if i < second {
            let [a, b] = [from, to].map(|s| s.second[i]);
            let terms = [p.0, by(h) * p.1, by(h * h) * a, q.0, by(h) * q.1, by(h * h) * b];
            let sum = |w: &[f64; 6]| terms.iter().zip(w).fold(by(0.0), |sum, (term, w)| sum + *term * by(*w));
            out.values[i] = sum(&quintic);
            out.rates[i] = sum(&quintic_rate) * by(1.0 / h);
            out.second[i] = sum(&quintic_second) * by(1.0 / (h * h));
        } else {
            let terms = [p.0, by(h) * p.1, q.0, by(h) * q.1];
            let sum = |w: &[f64; 4]| terms.iter().zip(w).fold(by(0.0), |sum, (term, w)| sum + *term * by(*w));
            out.values[i] = sum(&value);
            out.rates[i] = sum(&rate) * by(1.0 / h);
        }
    }
}

/// Weights of value, rate, second rate at the start and the end.
fn quintic(x: f64) -> [f64; 6] {
    let (x3, x4, x5) = (x.powi(3), x.powi(4), x.powi(5));
    [
        1.0 - 10.0 * x3 + 15.0 * x4 - 6.0 * x5,
        x - 6.0 * x3 + 8.0 * x4 - 3.0 * x5,
        0.5 * (x * x - 3.0 * x3 + 3.0 * x4 - x5),
        10.0 * x3 - 15.0 * x4 + 6.0 * x5,
        -4.0 * x3 + 7.0 * x4 - 3.0 * x5,
        0.5 * (x3 - 2.0 * x4 + x5),
    ]
}

fn quintic_rate(x: f64) -> [f64; 6] {
    let (x2, x3, x4) = (x * x, x.powi(3), x.powi(4));
    [
        -30.0 * x2 + 60.0 * x3 - 30.0 * x4,
        1.0 - 18.0 * x2 + 32.0 * x3 - 15.0 * x4,
        0.5 * (2.0 * x - 9.0 * x2 + 12.0 * x3 - 5.0 * x4),
        30.0 * x2 - 60.0 * x3 + 30.0 * x4,
        -12.0 * x2 + 28.0 * x3 - 15.0 * x4,
        0.5 * (3.0 * x2 - 8.0 * x3 + 5.0 * x4),
    ]
}

fn quintic_second(x: f64) -> [f64; 6] {
    let (x2, x3) = (x * x, x.powi(3));
    [
        -60.0 * x + 180.0 * x2 - 120.0 * x3,
        -36.0 * x + 96.0 * x2 - 60.0 * x3,
        1.0 - 9.0 * x + 18.0 * x2 - 10.0 * x3,
        60.0 * x - 180.0 * x2 + 120.0 * x3,
        -24.0 * x + 84.0 * x2 - 60.0 * x3,
        3.0 * x - 12.0 * x2 + 10.0 * x3,
    ]
}

/// Weights of value and rate at the start and the end.
fn cubic(x: f64) -> [f64; 4] {
    let (x2, x3) = (x * x, x.powi(3));
    [1.0 - 3.0 * x2 + 2.0 * x3, x - 2.0 * x2 + x3, 3.0 * x2 - 2.0 * x3, x3 - x2]
}

fn cubic_rate(x: f64) -> [f64; 4] {
    let x2 = x * x;
    [6.0 * (x2 - x), 1.0 - 4.0 * x + 3.0 * x2, 6.0 * (x - x2), 3.0 * x2 - 2.0 * x]
}

const _: () = assert!(LANES == 4, "a node's three numbers stand in one block");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_is_exact_for_polynomials_of_its_degree() {
        let layout = Layout { blocks: 1, nodes: 0 };
        let at = |t: f64| {
            let mut s = Snapshot::at_rest(layout);
            for i in 0..layout.all() {
                let n = if i < layout.second() { 5 } else { 3 };
                s.values[i] = Lanes::of(t.powi(n));
                s.rates[i] = Lanes::of(f64::from(n) * t.powi(n - 1));
                if i < layout.second() {
                    s.second[i] = Lanes::of(20.0 * t.powi(3));
                }
            }
            s
        };
        let (from, to, mut out) = (at(0.4), at(0.9), Snapshot::default());
        between(&from, &to, 0.5, 0.3, &mut out);
        let want = at(0.55);
        for i in 0..layout.all() {
            assert!((out.values[i].0[0] - want.values[i].0[0]).abs() < 1e-14);
            assert!((out.rates[i].0[0] - want.rates[i].0[0]).abs() < 1e-13);
            assert!(i >= layout.second() || (out.second[i].0[0] - want.second[i].0[0]).abs() < 1e-12);
        }
    }
}
