//! Discrete solutions, and corrections of them.

use crate::gauss::Gauss;
use crate::mesh::Mesh;

/// A discrete solution: states at the nodes and slopes at the stages.
#[derive(Debug, Clone)]
pub struct Solution<const N: usize, const M: usize> {
    /// The mesh.
    pub mesh: Mesh,
    /// States at the nodes.
    pub nodes: Vec<[f64; N]>,
    /// Slopes at the stages of each element.
    pub slopes: Vec<[[f64; N]; M]>,
}

impl<const N: usize, const M: usize> Solution<N, M> {
    /// The state `z` everywhere.
    pub fn constant(mesh: Mesh, z: [f64; N]) -> Self {
        let n = mesh.elements();
        Self { mesh, nodes: vec![z; n + 1], slopes: vec![[[0.0; N]; M]; n] }
    }

    /// State at `s` from the collocation polynomial of element `i`.
    pub fn state_in(&self, gauss: &Gauss<M>, i: usize, s: f64) -> [f64; N] {
        let h = self.mesh.step(i);
        let w = gauss.integrals((s - self.mesh.nodes()[i]) / h);
        let mut z = self.nodes[i];
        for j in 0..M {
            for a in 0..N {
                z[a] += h * w[j] * self.slopes[i][j][a];
            }
        }
        z
    }

    /// Carries the solution over to the mesh of `out` by its polynomials; elements that both meshes have stay as they are.
    pub fn onto(&self, gauss: &Gauss<M>, out: &mut Self) {
        let Self { mesh, nodes, slopes } = out;
        nodes.clear();
        slopes.clear();
        let mut e = 0;
        let mut advance = |s: f64| {
            while e + 1 < self.mesh.elements() && self.mesh.nodes()[e + 1] <= s {
                e += 1;
            }
            e
        };
        for (i, &s) in mesh.nodes().iter().enumerate() {
            let e = advance(s);
            let start = self.mesh.nodes()[e];
            nodes.push(if s == start { self.nodes[e] } else { self.state_in(gauss, e, s) });
            if i == mesh.elements() {
                break;
            }
            if s == start && mesh.nodes()[i + 1] == self.mesh.nodes()[e + 1] {
                slopes.push(self.slopes[e]);
                continue;
            }
            let h = mesh.step(i);
            let mut k = [[0.0; N]; M];
            for j in 0..M {
                let at = s + h * gauss.c[j];
                let e = advance(at);
                let l = gauss.cardinals((at - self.mesh.nodes()[e]) / self.mesh.step(e));
                for m in 0..M {
                    for a in 0..N {
                        k[j][a] += l[m] * self.slopes[e][m][a];
                    }
                }
            }
            slopes.push(k);
        }
    }

    /// This solution's polynomials sampled as a solution with `K` stages on the same mesh: `weights` are the cardinal
    /// polynomials at the stages.
    pub fn resample<const K: usize>(&self, weights: &[[f64; M]; K], out: &mut Solution<N, K>) {
        out.mesh.clone_from(&self.mesh);
        out.nodes.clone_from(&self.nodes);
        out.slopes.clear();
        out.slopes.extend(self.slopes.iter().map(|own| {
            let mut slopes = [[0.0; N]; K];
            for (slope, l) in slopes.iter_mut().zip(weights) {
                for m in 0..M {
                    for a in 0..N {
                        slope[a] += l[m] * own[m][a];
                    }
                }
            }
            slopes
        }));
    }

    /// Adds `factor` times a correction.
    #[inline(always)]
    pub fn add<const Q: usize>(&mut self, correction: &Correction<N, M, Q>, factor: f64) {
        for (z, dz) in self.nodes.iter_mut().zip(&correction.nodes) {
            for a in 0..N {
                z[a] += factor * dz[a];
            }
        }
        for (k, dk) in self.slopes.iter_mut().zip(&correction.slopes) {
            for j in 0..M {
                for a in 0..N {
                    k[j][a] += factor * dk[j][a];
                }
            }
        }
    }
}

/// A Newton correction, or a tangent.
#[derive(Debug, Clone)]
pub struct Correction<const N: usize, const M: usize, const Q: usize> {
    /// At the nodes.
    pub nodes: Vec<[f64; N]>,
    /// At the stages, of the slopes.
    pub slopes: Vec<[[f64; N]; M]>,
    /// Of the quadratures over each element.
    pub by_element: Vec<[f64; Q]>,
    /// Of the quadratures over [0, 1].
    pub total: [f64; Q],
}

impl<const N: usize, const M: usize, const Q: usize> Default for Correction<N, M, Q> {
    fn default() -> Self {
        Self { nodes: Vec::new(), slopes: Vec::new(), by_element: Vec::new(), total: [0.0; Q] }
    }
}

impl<const N: usize, const M: usize, const Q: usize> Correction<N, M, Q> {
    /// Multiplies it by `factor`.
    pub fn scale(&mut self, factor: f64) {
        self.for_each(&Self::default(), |own, _| *own *= factor);
    }

    /// Adds `factor` times another correction on the same mesh.
    pub fn add(&mut self, other: &Self, factor: f64) {
        self.for_each(other, |own, other| *own += factor * other);
    }

    /// Every number with its counterpart, zero where there is none.
    fn for_each(&mut self, other: &Self, mut change: impl FnMut(&mut f64, f64)) {
        let z = [0.0; N];
        for (i, own) in self.nodes.iter_mut().enumerate() {
            let other = other.nodes.get(i).unwrap_or(&z);
            own.iter_mut().zip(other).for_each(|(own, other)| change(own, *other));
        }
        for (i, own) in self.slopes.iter_mut().flatten().enumerate() {
            let other = other.slopes.as_flattened().get(i).unwrap_or(&z);
            own.iter_mut().zip(other).for_each(|(own, other)| change(own, *other));
        }
        for (i, own) in self.by_element.iter_mut().enumerate() {
            let other = other.by_element.get(i).unwrap_or(&[0.0; Q]);
            own.iter_mut().zip(other).for_each(|(own, other)| change(own, *other));
        }
        for (own, other) in self.total.iter_mut().zip(&other.total) {
            change(own, *other);
        }
    }

    /// Largest change of component `a` at the nodes.
    pub fn largest(&self, a: usize) -> f64 {
        self.nodes.iter().fold(0.0, |m, z| if z[a].is_nan() { f64::NAN } else { f64::max(m, z[a].abs()) })
    }
}
