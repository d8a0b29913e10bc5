//! The sections of an element: strains at its points that carry given states.
//!
//! beta' is the slope of the polynomial through beta at all points, and what a cable with friction has lost hangs on how it turned since the
//! element's start: where either matters, the points are solved together.

use hydrostat::{FlowSurface, Volume};

use crate::banded::{Banded, Factors};
use crate::mechanics::{Model, NoStrains, State, directors};
use crate::polynomials::Points;
use crate::shape::{Element, turned_to};

/// How strains follow states: `by_state[i][j]` is d strains at point i / d state at point j.
pub(crate) struct Response {
    pub(crate) by_state: Vec<Vec<[[f64; 4]; 3]>>,
}

impl Model {
    /// Whether strains at a point hang on those at others.
    fn is_coupled(&self, element: &Element) -> bool {
        let pulled = element.start.iter().any(|tension| *tension != 0.0);
        let lateral = self.arm.flow.speed > 0.0 && self.arm.model.flow_surface == FlowSurface::Lateral;
        let swells = self.arm.model.volume != Volume::None;
        (swells && (pulled || lateral)) || self.rubs(element)
    }

    fn rubs(&self, element: &Element) -> bool {
        (0..element.start.len()).any(|cable| self.grip(cable) != 0.0 && element.start[cable] != 0.0)
    }
}

impl Element {
    /// What the strains carry less what the states ask for, row by row over the stiffness; beta' and tensions follow.
    fn unbalanced(&mut self, model: &Model, points: &Points, states: &[State]) -> Vec<f64> {
        self.follow_beta(model, points);
        self.follow_turns(model, points);
        let mut out = Vec::with_capacity(3 * states.len());
        for (j, z) in states.iter().enumerate() {
            let place = &self.places[j];
            let (got, _) = model.carried(place, &self.tensions[j], self.strains[j], self.beta_slope[j]);
            let [a, b] = directors(z[0]);
            let want = [z[1] * a[0] + z[2] * a[1], z[1] * b[0] + z[2] * b[1], z[3]];
            let sizes = self.sizes(j);
            out.extend((0..3).map(|k| (got[k] - want[k]) / sizes[k]));
        }
        out
    }

    /// Forces and moments that strain a section by one.
    fn sizes(&self, j: usize) -> [f64; 3] {
        let [c1, c2, c3] = self.places[j].stiffness;
        [c1, c2, c3 / self.places[j].radius]
    }

    /// Strain components of about the same size: mu by the radius.
    fn unit(&self, j: usize, k: usize) -> f64 {
        if k == 2 { 1.0 / self.places[j].radius } else { 1.0 }
    }

    /// Derivatives of `unbalanced` by the strains, by differences.
    fn linearised(&mut self, model: &Model, points: &Points, states: &[State]) -> Option<Factors> {
        let size = 3 * states.len();
        let mut matrix = Banded::new(size, size - 1, 0);
        let here = self.unbalanced(model, points, states);
        for j in 0..states.len() {
            for k in 0..3 {
                let kept = self.strains[j][k];
                let step = 1e-7 * if k == 0 { kept } else { 1.0 };
                self.strains[j][k] = kept + step * self.unit(j, k);
                let there = self.unbalanced(model, points, states);
                self.strains[j][k] = kept;
                for r in 0..size {
                    matrix.set(r, 3 * j + k, (there[r] - here[r]) / step);
                }
            }
        }
        self.unbalanced(model, points, states);
        matrix.factor()
    }

    /// Strains that carry `states`, from the present ones, with beta' and tensions.
    pub(crate) fn carry(&mut self, model: &Model, points: &Points, states: &[State]) -> Result<(), NoStrains> {
        for (theta, z) in self.theta.iter_mut().zip(states) {
            *theta = z[0];
        }
        if !model.is_coupled(self) {
            for (j, z) in states.iter().enumerate() {
                let (place, tensions) = (&self.places[j], &self.tensions[j]);
                self.strains[j] = model.strains(place, tensions, *z, self.beta_slope[j], self.strains[j])?;
            }
            self.follow_beta(model, points);
            return Ok(());
        }
        let failed = NoStrains { s: self.from };
        let (mut factors, mut before) = (None, f64::INFINITY);
        for _ in 0..60 {
            if factors.is_none() {
                factors = self.linearised(model, points, states);
            }
            let off = self.unbalanced(model, points, states);
            let step = factors.as_ref().ok_or(failed)?.solve(off);
            let size = step.iter().fold(0.0, |most: f64, v| if v.is_nan() { f64::NAN } else { most.max(v.abs()) });
            if size.is_nan() {
                return Err(failed);
            }
            // No strain changes by more than a part of what keeps a section open.
            let narrowest = self.strains.iter().map(|e| e[0]).fold(1.0, f64::min);
            let fraction = (0.3 * narrowest / size).min(1.0);
            for j in 0..states.len() {
                for k in 0..3 {
                    let unit = self.unit(j, k);
                    self.strains[j][k] -= fraction * step[3 * j + k] * unit;
                }
            }
            if size < 1e-14 || (size < 1e-9 && size > 0.3 * before) {
                self.unbalanced(model, points, states);
                return Ok(());
            }
            if size > 0.2 * before {
                factors = None;
            }
            before = size;
        }
        Err(failed)
    }

    /// How the strains follow the states.
    pub(crate) fn response(&mut self, model: &Model, points: &Points, states: &[State]) -> Option<Response> {
        let count = states.len();
        let wants = |z: &State| {
            let [a, b] = directors(z[0]);
            let (n_a, n_b) = (z[1] * a[0] + z[2] * a[1], z[1] * b[0] + z[2] * b[1]);
            [[n_b, -n_a, 0.0], [a[0], b[0], 0.0], [a[1], b[1], 0.0], [0.0, 0.0, 1.0]]
        };
        let mut by_state = vec![vec![[[0.0; 4]; 3]; count]; count];
        if !model.is_coupled(self) {
            for (j, z) in states.iter().enumerate() {
                let (place, tensions) = (&self.places[j], &self.tensions[j]);
                let (_, by) = model.carried(place, tensions, self.strains[j], self.beta_slope[j]);
                for (c, want) in wants(z).into_iter().enumerate() {
                    let own = crate::mechanics::solve3(by, want);
                    for r in 0..3 {
                        by_state[j][j][r][c] = own[r];
                    }
                }
            }
            return Some(Response { by_state });
        }
        let factors = self.linearised(model, points, states)?;
        let here = self.unbalanced(model, points, states);
        for (j, z) in states.iter().enumerate() {
            let sizes = self.sizes(j);
            for (c, want) in wants(z).into_iter().enumerate() {
                let mut right = vec![0.0; 3 * count];
                if c == 0 && model.rubs(self) {
                    // Cables turn with the section.
                    let step = 1e-7;
                    self.theta[j] += step;
                    let there = self.unbalanced(model, points, states);
                    self.theta[j] -= step;
                    for r in 0..3 * count {
                        right[r] = -(there[r] - here[r]) / step;
                    }
                }
                for k in 0..3 {
                    right[3 * j + k] += want[k] / sizes[k];
                }
                let own = factors.solve(right);
                for i in 0..count {
                    for r in 0..3 {
                        by_state[i][j][r][c] = own[3 * i + r] * self.unit(i, r);
                    }
                }
            }
        }
        self.unbalanced(model, points, states);
        Some(Response { by_state })
    }

    /// Tensions at the points by those at the start and the turns since.
    pub(crate) fn follow_turns(&mut self, model: &Model, points: &Points) {
        if self.tensions.len() != self.places.len() {
            self.tensions = vec![self.start.clone(); self.places.len()];
        }
        for cable in 0..self.start.len() {
            let grip = model.grip(cable);
            let turns = (grip != 0.0 && self.start[cable] != 0.0).then(|| self.directions(model, cable)).flatten();
            for j in 0..self.places.len() {
                let turned =
                    turns.as_ref().map_or(0.0, |chi| turned_to(points, chi, &self.senses[cable], points.at[j]));
                self.tensions[j][cable] = self.start[cable] * (grip * turned).exp();
            }
        }
    }
}
