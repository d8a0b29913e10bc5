//! Nodes on [0, 1] and their redistribution.

use crate::real::LANES;

/// Nodes of a mesh on [0, 1], increasing, first 0 and last 1. Pinned nodes (ends, breaks of the
/// data, kinks of the solution) survive redistribution.
#[derive(Debug, PartialEq)]
pub struct Mesh {
    nodes: Vec<f64>,
    pinned: Vec<Pin>,
}

/// Whether a node may be moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pin {
    Free,
    Pinned,
    /// Pinned to a kink that is looked for again.
    Loose,
}

impl Default for Mesh {
    /// One element.
    fn default() -> Self {
        Self::uniform(1, &[])
    }
}

impl Clone for Mesh {
    fn clone(&self) -> Self {
        Self { nodes: self.nodes.clone(), pinned: self.pinned.clone() }
    }

    /// Without allocation where there is room.
    fn clone_from(&mut self, other: &Self) {
        self.nodes.clone_from(&other.nodes);
        self.pinned.clone_from(&other.pinned);
    }
}

/// The shortest element that any operation here makes.
const SHORTEST: f64 = 1e-7;

/// Part of an element over which a free node is moved onto a kink: over half of it, so that a kink does not open a
/// group of elements for itself where it can be helped.
const FREE_REACH: f64 = 0.5;

/// The same for a node that was on a kink before.
const LOOSE_REACH: f64 = 0.7;

/// The number of elements that `count` stands for: at least one, and no more than anyone can solve on.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to what fits")]
fn whole(count: f64) -> usize {
    count.ceil().clamp(1.0, 1e6) as usize
}

impl Mesh {
    /// At least `elements` elements, uniform between the `breaks` (in (0, 1), increasing), which are pinned.
    pub fn uniform(elements: usize, breaks: &[f64]) -> Self {
        let mut mesh = Self { nodes: vec![0.0], pinned: vec![Pin::Pinned] };
        let mut from = 0.0;
        for &to in breaks.iter().chain(std::iter::once(&1.0)) {
            let count = whole((to - from) * elements as f64);
            mesh.fill(from, to, count, |t| t);
            from = to;
        }
        mesh
    }

    /// About `elements` elements between the `breaks` (in (0, 1), increasing), which are pinned, each with the same
    /// integral of `density`, a positive function on [0, 1]. The integral is taken on 64 equal parts.
    pub fn graded(elements: usize, breaks: &[f64], density: impl Fn(f64) -> f64) -> Self {
        const PARTS: usize = 64;
        let part = |k: usize| k as f64 / PARTS as f64;
        let mut passed = [0.0; PARTS + 1];
        for k in 0..PARTS {
            passed[k + 1] = passed[k] + density(0.5 * (part(k) + part(k + 1)));
        }
        let whole_integral = passed[PARTS];
        let upto = |s: f64| {
            let place = s * PARTS as f64;
            let k = (0..PARTS).rev().find(|k| part(*k) <= s).unwrap_or(0);
            passed[k] + (place - k as f64) * (passed[k + 1] - passed[k])
        };
        let place = |goal: f64| {
            let k = passed.partition_point(|v| *v <= goal).clamp(1, PARTS) - 1;
            (k as f64 + (goal - passed[k]) / (passed[k + 1] - passed[k])) / PARTS as f64
        };
        let mut mesh = Self { nodes: vec![0.0], pinned: vec![Pin::Pinned] };
        let (mut from, mut before) = (0.0, 0.0);
        for &to in breaks.iter().chain(std::iter::once(&1.0)) {
            let behind = upto(to);
            let count = whole((behind - before) / whole_integral * elements as f64 - 1e-9);
            mesh.fill(from, to, count, |t| (place(before + t * (behind - before)) - from) / (to - from));
            (from, before) = (to, behind);
        }
        mesh
    }

    /// With these nodes, of which the `breaks` (in (0, 1), increasing) are pinned; `None` unless they increase from 0
    /// to 1 and have the breaks among them.
    pub fn with_nodes(nodes: &[f64], breaks: &[f64]) -> Option<Self> {
        let whole = nodes.first() == Some(&0.0) && nodes.last() == Some(&1.0);
        // Not a number is not longer than anything.
        let apart = nodes.windows(2).all(|pair| pair[1] - pair[0] >= SHORTEST);
        let broken = breaks.iter().all(|at| nodes.contains(at));
        let pin = |node: &f64| if [0.0, 1.0].contains(node) || breaks.contains(node) { Pin::Pinned } else { Pin::Free };
        (whole && apart && broken).then(|| Self { nodes: nodes.to_vec(), pinned: nodes.iter().map(pin).collect() })
    }

    /// The nodes.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Length of element `i`.
    #[inline]
    pub fn step(&self, i: usize) -> f64 {
        self.nodes[i + 1] - self.nodes[i]
    }

    /// Weights of the nodes in an integral over [0, 1], by the trapezoidal rule.
    pub fn node_weights(&self) -> impl Iterator<Item = f64> + '_ {
        let n = self.elements();
        (0..=n).map(move |i| {
            let left = if i > 0 { self.step(i - 1) } else { 0.0 };
            let right = if i < n { self.step(i) } else { 0.0 };
            0.5 * (left + right)
        })
    }

    /// Whether node `i` is pinned.
    pub fn is_pinned(&self, i: usize) -> bool {
        self.pinned[i] == Pin::Pinned
    }

    /// The element that holds `s`; at a node the one to its right.
    pub fn element_of(&self, s: f64) -> usize {
        self.nodes.partition_point(|node| *node <= s).saturating_sub(1).min(self.elements() - 1)
    }

    fn fill(&mut self, from: f64, to: f64, count: usize, place: impl Fn(f64) -> f64) {
        for k in 1..count {
            self.nodes.push(from + (to - from) * place(k as f64 / count as f64));
            self.pinned.push(Pin::Free);
        }
        self.nodes.push(to);
        self.pinned.push(Pin::Pinned);
    }

    /// Moves the nodes on by `fraction` times their way from the mesh `before` to this one; `None` where the two do not
    /// correspond node by node, or where that would more than halve or double an element.
    pub fn extrapolated(&self, before: &Self, fraction: f64) -> Option<Self> {
        if self.pinned != before.pinned {
            return None;
        }
        let ahead = |i: usize| self.nodes[i] + fraction * (self.nodes[i] - before.nodes[i]);
        let fits = |i: usize| (0.5..=2.0).contains(&((ahead(i + 1) - ahead(i)) / self.step(i)));
        let nodes = (0..self.nodes.len()).map(ahead).collect();
        (0..self.elements()).all(fits).then_some(Self { nodes, pinned: self.pinned.clone() })
    }

    /// This mesh with every element cut into `parts` equal ones.
    pub fn cut(&self, parts: usize) -> Self {
        let mut mesh = Self { nodes: vec![0.0], pinned: vec![Pin::Pinned] };
        for i in 0..self.elements() {
            mesh.fill(self.nodes[i], self.nodes[i + 1], parts.max(1), |t| t);
            if let Some(last) = mesh.pinned.last_mut() {
                *last = self.pinned[i + 1];
            }
        }
        mesh
    }

    /// This mesh with every element cut into equal ones no longer than `longest`.
    pub fn cut_to(&self, longest: f64) -> Self {
        let mut mesh = Self { nodes: vec![0.0], pinned: vec![Pin::Pinned] };
        for i in 0..self.elements() {
            mesh.fill(self.nodes[i], self.nodes[i + 1], whole(self.step(i) / longest - 1e-9), |t| t);
            if let Some(last) = mesh.pinned.last_mut() {
                *last = self.pinned[i + 1];
            }
        }
        mesh
    }

    /// Pins exactly `fixed` (breaks of the data) and `moving` (kinks of the solution), both inside
    /// (0, 1). A node that was pinned for a kink follows it; a free node close to a new kink is
    /// moved there, otherwise one is added; nodes pinned for what is gone become free.
    pub fn pin(&mut self, fixed: &[f64], moving: &[f64]) {
        for i in 1..self.elements() {
            let is_fixed = fixed.iter().any(|s| (s - self.nodes[i]).abs() < SHORTEST);
            self.pinned[i] = match (is_fixed, self.pinned[i]) {
                (true, _) => Pin::Pinned,
                (false, Pin::Pinned) => Pin::Loose,
                (false, other) => other,
            };
        }
        for &s in moving {
            let i = self.element_of(s);
            let h = self.step(i);
            let (left, right) = (s - self.nodes[i], self.nodes[i + 1] - s);
            if (left < SHORTEST && self.is_pinned(i)) || (right < SHORTEST && self.is_pinned(i + 1)) {
                continue;
            }
            let reach = |node: usize| match self.pinned[node] {
                Pin::Free => FREE_REACH * h,
                Pin::Loose => LOOSE_REACH * h,
                Pin::Pinned => 0.0,
            };
            let at = if left < reach(i) && (left <= right || self.pinned[i + 1] != Pin::Loose) {
                i
            } else if right < reach(i + 1) {
                i + 1
            } else {
                self.nodes.insert(i + 1, s);
                self.pinned.insert(i + 1, Pin::Pinned);
                continue;
            };
            self.nodes[at] = s;
            self.pinned[at] = Pin::Pinned;
        }
        for pin in &mut self.pinned {
            if *pin == Pin::Loose {
                *pin = Pin::Free;
            }
        }
    }

    /// A new mesh on which every element would have the same `error`, given the present ones, an
    /// order `order` of the local error, and a sum of errors `target`. Pinned nodes stay. No element is made shorter than `shortest` says for the one it lies in.
    pub fn redistributed(&self, error: &[f64], shortest: &[f64], order: f64, target: f64, limits: Limits) -> Self {
        let n = self.elements();
        // What is far below its fraction says nothing about the solution: it may be rounding.
        let floor = 1e-3 * target / n as f64;
        // Density of new nodes in each present element, up to a common factor.
        let mut density: Vec<f64> =
            (0..n).map(|i| (error[i] - floor).max(0.0).powf(1.0 / order) / self.step(i)).collect();
        // An element is cut into a few at once, whatever its error says: orders fail on what is unresolved.
        let typical = {
            let mut counts: Vec<f64> = (0..n).map(|i| density[i] * self.step(i)).collect();
            counts.sort_by(f64::total_cmp);
            counts[n / 2]
        };
        if typical > 0.0 {
            for i in 0..n {
                density[i] = density[i].min(limits.cut * typical / self.step(i));
            }
        }
        for i in 0..n {
            density[i] = density[i].max(1e-300);
        }
        let mean: f64 = (0..n).map(|i| density[i] * self.step(i)).sum();
        let least = if mean > 0.0 { limits.least * mean } else { 1.0 };
        for d in &mut density {
            *d = d.max(least);
        }
        let weight: f64 = (0..n).map(|i| density[i] * self.step(i)).sum();
        let wanted = (weight.powf(order) / target).powf(1.0 / (order - 1.0));
        let most = limits.most.min(whole(n as f64 * limits.growth)) as f64;
        let wanted = wanted.clamp(limits.fewest as f64, most.max(limits.fewest as f64));
        // Here the density is a number of new elements a length, so it can be capped.
        let per_length = wanted / weight;
        for i in 0..n {
            density[i] = (density[i] * per_length).min(1.0 / shortest[i]);
        }
        let mut stretches: Vec<Stretch> = Vec::new();
        let mut start = 0;
        for end in 1..=n {
            if self.is_pinned(end) {
                let fraction = (start..end).map(|i| density[i] * self.step(i)).sum();
                stretches.push(Stretch { start, end, fraction, count: 1 });
                start = end;
            }
        }
        allot(&mut stretches, limits.most);
        let mut mesh = Self { nodes: vec![0.0], pinned: vec![Pin::Pinned] };
        for Stretch { start, end, fraction, count } in stretches {
            let mut i = start;
            let mut passed = 0.0;
            for k in 1..count {
                let goal = fraction * k as f64 / count as f64;
                while i + 1 < end && passed + density[i] * self.step(i) < goal {
                    passed += density[i] * self.step(i);
                    i += 1;
                }
                mesh.nodes.push(self.nodes[i] + (goal - passed) / density[i]);
                mesh.pinned.push(Pin::Free);
            }
            mesh.nodes.push(self.nodes[end]);
            mesh.pinned.push(Pin::Pinned);
        }
        mesh
    }
}

/// Elements between two pinned nodes, and how many new ones they ask for and get.
struct Stretch {
    start: usize,
    end: usize,
    fraction: f64,
    count: usize,
}

/// The largest fraction of an element that is as good as one: with orders of 8 or more it costs a factor below 3.
const CROWDED: f64 = 1.12;

/// Gives every stretch its number of elements, and all of them together a multiple of [`LANES`], because an element
/// more costs nothing until its group is full.
fn allot(stretches: &mut [Stretch], most: usize) {
    let asked: f64 = stretches.iter().map(|s| s.fraction.max(1.0)).sum();
    let mut left = whole(asked / CROWDED).next_multiple_of(LANES).saturating_sub(stretches.len());
    let mut total = stretches.len();
    loop {
        let Some(fullest) = stretches.iter_mut().max_by(|a, b| a.crowding().total_cmp(&b.crowding())) else { return };
        if left == 0 {
            if fullest.crowding() <= CROWDED || total >= most {
                return;
            }
            left = LANES;
        }
        fullest.count += 1;
        total += 1;
        left -= 1;
    }
}

impl Stretch {
    /// Share an element.
    fn crowding(&self) -> f64 {
        self.fraction / self.count as f64
    }
}

/// Bounds on a redistribution.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Fewest elements.
    pub fewest: usize,
    /// Most elements.
    pub most: usize,
    /// Largest factor by which their number grows at once.
    pub growth: f64,
    /// Largest number of new elements in an old one, over the median one.
    pub cut: f64,
    /// Smallest density over the mean one.
    pub least: f64,
}
