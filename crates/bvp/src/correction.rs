//! Corrections of discrete solutions.

use crate::real::{LANES, Lanes};
use crate::solution::{End, Solution, Stage};

/// A Newton correction, or a tangent.
#[derive(Debug, Clone)]
pub struct Correction<const N: usize, const M: usize, const Q: usize, const L: usize = 0> {
    /// At the nodes.
    pub nodes: Vec<[f64; N]>,
    /// At the stages, in blocks.
    pub stages: Vec<Stage<N, L>>,
    /// At the ends, in blocks.
    pub ends: Vec<End<L>>,
    /// Of the quadratures over each element.
    pub by_element: Vec<[f64; Q]>,
    /// Of the quadratures over [0, 1].
    pub total: [f64; Q],
}

impl<const N: usize, const M: usize, const Q: usize, const L: usize> Default for Correction<N, M, Q, L> {
    fn default() -> Self {
        Self { nodes: Vec::new(), stages: Vec::new(), ends: Vec::new(), by_element: Vec::new(), total: [0.0; Q] }
    }
}

impl<const N: usize, const M: usize, const Q: usize, const L: usize> Correction<N, M, Q, L> {
    /// Multiplies it by `factor`.
    pub fn scale(&mut self, factor: f64) {
        let by = Lanes([factor; LANES]);
        self.nodes.as_flattened_mut().iter_mut().for_each(|v| *v *= factor);
        for stage in &mut self.stages {
            stage.slope.iter_mut().for_each(|v| *v = *v * by);
            stage.inner.iter_mut().for_each(|v| *v = *v * by);
            stage.closure_slope = stage.closure_slope * by;
        }
        for end in &mut self.ends {
            end.inner.iter_mut().for_each(|v| *v = *v * by);
            end.closure_slope = end.closure_slope * by;
        }
        self.by_element.as_flattened_mut().iter_mut().for_each(|v| *v *= factor);
        self.total.iter_mut().for_each(|v| *v *= factor);
    }

    /// Adds `factor` times another correction on the same mesh.
    pub fn add(&mut self, other: &Self, factor: f64) {
        let by = Lanes([factor; LANES]);
        let plain = |own: &mut [f64], other: &[f64]| {
            own.iter_mut().zip(other).for_each(|(own, other)| *own += factor * other);
        };
        plain(self.nodes.as_flattened_mut(), other.nodes.as_flattened());
        plain(self.by_element.as_flattened_mut(), other.by_element.as_flattened());
        plain(&mut self.total, &other.total);
        for (own, other) in self.stages.iter_mut().zip(&other.stages) {
            own.slope.iter_mut().zip(&other.slope).for_each(|(own, other)| *own += by * *other);
            own.inner.iter_mut().zip(&other.inner).for_each(|(own, other)| *own += by * *other);
            own.closure_slope += by * other.closure_slope;
        }
        for (own, other) in self.ends.iter_mut().zip(&other.ends) {
            own.inner.iter_mut().zip(&other.inner).for_each(|(own, other)| *own += by * *other);
            own.closure_slope += by * other.closure_slope;
        }
    }

    /// Largest change of an inner unknown, at stages and ends.
    pub fn largest_inner(&self) -> f64 {
        let mut largest = [0.0_f64; LANES];
        let all = self.stages.iter().map(|stage| &stage.inner).chain(self.ends.iter().map(|end| &end.inner));
        for v in all.flatten() {
            for lane in 0..LANES {
                largest[lane] = largest[lane].max(v.0[lane].abs());
            }
        }
        largest.into_iter().fold(0.0, f64::max)
    }

    /// Largest change of component `a` at the nodes.
    pub fn largest(&self, a: usize) -> f64 {
        self.nodes.iter().fold(0.0, |m, z| if z[a].is_nan() { f64::NAN } else { f64::max(m, z[a].abs()) })
    }
}

impl<const N: usize, const M: usize, const L: usize> Solution<N, M, L> {
    /// Adds `factor` times a correction.
    #[inline(always)]
    pub fn add<const Q: usize>(&mut self, correction: &Correction<N, M, Q, L>, factor: f64) {
        for (z, dz) in self.nodes.iter_mut().zip(&correction.nodes) {
            for a in 0..N {
                z[a] += factor * dz[a];
            }
        }
        let f = Lanes([factor; LANES]);
        for (own, change) in self.stages.iter_mut().zip(&correction.stages) {
            for a in 0..N {
                own.slope[a] += f * change.slope[a];
            }
            for a in 0..L {
                own.inner[a] += f * change.inner[a];
            }
            own.closure_slope += f * change.closure_slope;
        }
        for (own, change) in self.ends.iter_mut().zip(&correction.ends) {
            for a in 0..L {
                own.inner[a] += f * change.inner[a];
            }
            own.closure_slope += f * change.closure_slope;
        }
    }
}
