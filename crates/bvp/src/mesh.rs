//! Nodes on [0, 1] and their redistribution.

/// Nodes of a mesh on [0, 1], increasing, first 0 and last 1. Pinned nodes (ends, breaks of the
/// data, kinks of the solution) survive redistribution.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    nodes: Vec<f64>,
    pinned: Vec<bool>,
}

/// The shortest element that any operation here makes.
const SHORTEST: f64 = 1e-7;

/// The number of elements that `count` stands for: at least one, and no more than anyone can solve on.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to what fits")]
fn whole(count: f64) -> usize {
    count.ceil().clamp(1.0, 1e6) as usize
}

impl Mesh {
    /// At least `elements` elements, uniform between the `breaks` (in (0, 1), increasing), which are pinned.
    pub fn uniform(elements: usize, breaks: &[f64]) -> Self {
        let mut mesh = Self { nodes: vec![0.0], pinned: vec![true] };
        let mut from = 0.0;
        for &to in breaks.iter().chain(std::iter::once(&1.0)) {
            let count = whole((to - from) * elements as f64);
            mesh.fill(from, to, count, |t| t);
            from = to;
        }
        mesh
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

    /// Whether node `i` is pinned.
    pub fn is_pinned(&self, i: usize) -> bool {
        self.pinned[i]
    }

    /// The element that holds `s`; at a node the one to its right.
    pub fn element_of(&self, s: f64) -> usize {
        self.nodes.partition_point(|node| *node <= s).saturating_sub(1).min(self.elements() - 1)
    }

    fn fill(&mut self, from: f64, to: f64, count: usize, place: impl Fn(f64) -> f64) {
        for k in 1..count {
            self.nodes.push(from + (to - from) * place(k as f64 / count as f64));
            self.pinned.push(false);
        }
        self.nodes.push(to);
        self.pinned.push(true);
    }

    /// This mesh with every element cut into `parts` equal ones.
    pub fn cut(&self, parts: usize) -> Self {
        let mut mesh = Self { nodes: vec![0.0], pinned: vec![true] };
        for i in 0..self.elements() {
            mesh.fill(self.nodes[i], self.nodes[i + 1], parts.max(1), |t| t);
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
        let last = self.elements();
        let mut old: Vec<bool> = vec![false; last + 1];
        for i in 1..last {
            let is_fixed = fixed.iter().any(|s| (s - self.nodes[i]).abs() < SHORTEST);
            old[i] = self.pinned[i] && !is_fixed;
            self.pinned[i] = is_fixed;
        }
        for &s in moving {
            let i = self.element_of(s);
            let h = self.step(i);
            let (left, right) = (s - self.nodes[i], self.nodes[i + 1] - s);
            if (left < SHORTEST && self.pinned[i]) || (right < SHORTEST && self.pinned[i + 1]) {
                continue;
            }
            let left_reach = if old[i] { 0.7 } else { 0.3 };
            let right_reach = if old[i + 1] { 0.7 } else { 0.3 };
            let at = if left < left_reach * h && !self.pinned[i] && (left <= right || !old[i + 1]) {
                i
            } else if right < right_reach * h && !self.pinned[i + 1] {
                i + 1
            } else {
                self.nodes.insert(i + 1, s);
                self.pinned.insert(i + 1, true);
                old.insert(i + 1, false);
                continue;
            };
            self.nodes[at] = s;
            self.pinned[at] = true;
            old[at] = false;
        }
    }

    /// A new mesh on which every element would have the same `error`, given the present ones, an
    /// order `order` of the local error, and a sum of errors `target`. Pinned nodes stay. No element is made shorter than `shortest` says for the one it lies in.
    pub fn redistributed(&self, error: &[f64], shortest: &[f64], order: f64, target: f64, limits: Limits) -> Self {
        let n = self.elements();
        // What is far below its share says nothing about the solution: it may be rounding.
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
        let mut mesh = Self { nodes: vec![0.0], pinned: vec![true] };
        let mut start = 0;
        while start < n {
            let mut end = start + 1;
            while !self.pinned[end] {
                end += 1;
            }
            let share: f64 = (start..end).map(|i| density[i] * self.step(i)).sum();
            let count = whole(share - 0.02);
            let mut i = start;
            let mut passed = 0.0;
            for k in 1..count {
                let goal = share * k as f64 / count as f64;
                while i + 1 < end && passed + density[i] * self.step(i) < goal {
                    passed += density[i] * self.step(i);
                    i += 1;
                }
                mesh.nodes.push(self.nodes[i] + (goal - passed) / density[i]);
                mesh.pinned.push(false);
            }
            mesh.nodes.push(self.nodes[end]);
            mesh.pinned.push(true);
            start = end;
        }
        mesh
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
