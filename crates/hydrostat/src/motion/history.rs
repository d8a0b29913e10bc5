//! What the time methods know of an arm: values, rates and second rates at the stations, flat in memory.
//!
//! In blocks of four elements side by side: the coordinates (theta, x, y in the plane) at the stages; the same at the
//! nodes (one block each or more, the last lanes empty); these have second rates. Then the strains and beta' at the
//! stages, which have rates alone.

use hydrostat_bvp::{EndPlace, Gauss, Groups, LANES, Lanes, Real, each};

use crate::statics::dimensions::M;

/// Where what stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Layout {
    pub(super) blocks: usize,
    pub(super) nodes: usize,
    /// Coordinates of a station that turn it (one in the plane, three in space), and those of its place after them.
    pub(super) turns: usize,
    pub(super) places: usize,
    /// Strains of a station.
    pub(super) strains: usize,
}

impl Layout {
    /// Coordinates of a station.
    pub(super) fn coordinates(self) -> usize {
        self.turns + self.places
    }

    /// Blocks of one node.
    fn node_blocks(self) -> usize {
        self.coordinates().div_ceil(LANES)
    }

    /// Block and lane of a coordinate of node `i`.
    pub(super) fn at_node(self, i: usize, k: usize) -> (usize, usize) {
        (self.coordinates() * self.blocks + self.node_blocks() * i + k / LANES, k % LANES)
    }

    /// Blocks that have second rates.
    pub(super) fn second(self) -> usize {
        self.coordinates() * self.blocks + self.node_blocks() * self.nodes
    }

    /// Where the strains of a block of stages stand, beta' after them.
    pub(super) fn first_strain(self, block: usize) -> usize {
        self.second() + (self.strains + 1) * block
    }

    /// All blocks.
    pub(super) fn all(self) -> usize {
        self.first_strain(self.blocks)
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

    /// Of coordinate `k` (theta, x, y in the plane) in a block of stages.
    #[inline(always)]
    pub(super) fn value(&self, block: usize, k: usize) -> Lanes {
        self.values[self.layout.coordinates() * block + k]
    }

    #[inline(always)]
    pub(super) fn rate(&self, block: usize, k: usize) -> Lanes {
        self.rates[self.layout.coordinates() * block + k]
    }

    /// Rates of the coordinates of the tip that a stage starts from.
    pub(super) fn last_rate<const C: usize>(&self) -> [f64; C] {
        if self.layout.nodes == 0 { [0.0; C] } else { node_of(self.layout, &self.rates, self.layout.nodes - 1) }
    }

    /// Of a strain (nu, eta, mu in the plane) in a block of stages.
    #[inline(always)]
    pub(super) fn strain(&self, block: usize, k: usize) -> Lanes {
        self.values[self.layout.first_strain(block) + k]
    }

    /// Velocity and acceleration of coordinate `k` in a block of stages where it is `z`.
    #[inline(always)]
    pub(super) fn rates_of(&self, cv: f64, block: usize, k: usize, z: Lanes) -> [Lanes; 2] {
        let cv = Lanes::of(cv);
        let velocity = cv * (z - self.value(block, k));
        [velocity, cv * (velocity - self.rate(block, k))]
    }

    /// Strain rates in a block of stages are cv times the strains, and these.
    #[inline(always)]
    pub(super) fn strain_rates<const K: usize>(&self, cv: f64, block: usize) -> [Lanes; K]
    where
        [Lanes; K]: Default,
    {
        each(|k| Lanes::of(-cv) * self.strain(block, k))
    }

    /// The same at ends of elements, by the polynomials through the stages of these.
    pub(super) fn end_rates<'a, const K: usize>(
        &'a self,
        cv: f64,
        gauss: &Gauss<M>,
        groups: Groups,
        ends: &'a [EndPlace],
    ) -> impl Iterator<Item = [Lanes; K]> + 'a {
        let at_ends = [gauss.cardinals(0.0), gauss.cardinals(1.0)];
        ends.iter().map(move |place| {
            let mut rates = [Lanes::of(0.0); K];
            for lane in 0..LANES {
                let (block, from) = groups.at(place.elements[lane], 0);
                for (j, weight) in at_ends[place.sides[lane].index()].iter().enumerate() {
                    for (k, rate) in rates.iter_mut().enumerate() {
                        rate.0[lane] -= cv * weight * self.strain(block + j, k).0[from];
                    }
                }
            }
            rates
        })
    }
}

/// The motion at one time.
#[derive(Debug, Clone, Default)]
pub(super) struct Snapshot {
    pub(super) layout: Layout,
    pub(super) values: Vec<Lanes>,
    pub(super) rates: Vec<Lanes>,
    pub(super) second: Vec<Lanes>,
    /// In space, the rotations that the coordinates turn from; none in the plane.
    pub(super) from: Vec<[Lanes; 4]>,
}

impl Snapshot {
    /// At rest, with all coordinates zero.
    pub(super) fn at_rest(layout: Layout) -> Self {
        let zero = Lanes::of(0.0);
        Self {
            layout,
            values: vec![zero; layout.all()],
            rates: vec![zero; layout.all()],
            second: vec![zero; layout.second()],
            from: Vec::new(),
        }
    }

    /// Takes the coordinates of a block of stages, its strains and beta'.
    pub(super) fn take_stage<const C: usize, const K: usize>(
        &mut self,
        block: usize,
        coordinates: [Lanes; C],
        strains: [Lanes; K],
        beta_slope: Lanes,
    ) {
        self.values[C * block..C * (block + 1)].copy_from_slice(&coordinates);
        let first = self.layout.first_strain(block);
        self.values[first..first + K].copy_from_slice(&strains);
        self.values[first + K] = beta_slope;
    }

    /// Takes the coordinates of node `i`.
    pub(super) fn take_node<const C: usize>(&mut self, i: usize, coordinates: [f64; C]) {
        for (k, value) in coordinates.into_iter().enumerate() {
            let (block, lane) = self.layout.at_node(i, k);
            self.values[block].0[lane] = value;
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

    /// The coordinates of node `i`: theta, x, y in the plane.
    pub(super) fn node<const C: usize>(&self, i: usize) -> [f64; C] {
        node_of(self.layout, &self.values, i)
    }

    /// Their rates.
    pub(super) fn node_rate<const C: usize>(&self, i: usize) -> [f64; C] {
        node_of(self.layout, &self.rates, i)
    }

    /// The coordinates in a block of stages, and their rates.
    pub(super) fn stage<const C: usize>(&self, block: usize) -> [[Lanes; C]; 2] {
        let of = |list: &[Lanes]| std::array::from_fn(|k| list[C * block + k]);
        [of(&self.values), of(&self.rates)]
    }

    /// Second rates of the coordinates in a block of stages.
    pub(super) fn second<const C: usize>(&self, block: usize) -> [Lanes; C] {
        std::array::from_fn(|k| self.second[C * block + k])
    }

    /// Strains and beta' in a block of stages (nu, eta, mu, beta' in the plane), and their rates.
    pub(super) fn strains<const K: usize>(&self, block: usize) -> [[Lanes; K]; 2] {
        let first = self.layout.first_strain(block);
        let of = |list: &[Lanes]| std::array::from_fn(|k| list[first + k]);
        [of(&self.values), of(&self.rates)]
    }

    /// x, y (and z) of the centreline at node `i`, and their rates; z is 0 in the plane.
    pub(super) fn node_place(&self, i: usize) -> [[f64; 3]; 2] {
        [&self.values, &self.rates].map(|list| self.place_in(list, i))
    }

    /// The place part of node `i` in a list like [`Snapshot::values`].
    pub(super) fn place_in(&self, list: &[Lanes], i: usize) -> [f64; 3] {
        std::array::from_fn(|k| {
            if k >= self.layout.places {
                return 0.0;
            }
            let (block, lane) = self.layout.at_node(i, self.layout.turns + k);
            list[block].0[lane]
        })
    }
}

fn node_of<const C: usize>(layout: Layout, list: &[Lanes], i: usize) -> [f64; C] {
    std::array::from_fn(|k| {
        let (block, lane) = layout.at_node(i, k);
        list[block].0[lane]
    })
}

/// The motion at the fraction `x` of a step of length `h`: quintic where there are second rates, else cubic (Hermite).
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
pub(super) fn cubic(x: f64) -> [f64; 4] {
    let (x2, x3) = (x * x, x.powi(3));
    [1.0 - 3.0 * x2 + 2.0 * x3, x - 2.0 * x2 + x3, 3.0 * x2 - 2.0 * x3, x3 - x2]
}

fn cubic_rate(x: f64) -> [f64; 4] {
    let x2 = x * x;
    [6.0 * (x2 - x), 1.0 - 4.0 * x + 3.0 * x2, 6.0 * (x - x2), 3.0 * x2 - 2.0 * x]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_is_exact_for_polynomials_of_its_degree() {
        let layout = Layout { blocks: 1, nodes: 0, turns: 1, places: 2, strains: 3 };
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
