//! What a shape is off by: Newton's method on the equations of `mechanics`, from the shape to the equilibrium beside it.
//!
//! Gauss collocation with polynomials of degree 8 on elements that end where the configuration's do, where the arm changes its
//! law and where the loads have kinks. What the residuals of an answer do to its tip is then no estimate: the tip moves by it.

use crate::banded::{Banded, Factors};
use crate::mechanics::{Model, NoStrains, Place, State, Strains, directors};
use crate::polynomials::Points;
use crate::shape::{POINTS, Shape};
use hydrostat::{Configuration, Support};

/// Rounds of what stands still while Newton's method runs: turns of cables before an element, tensions that follow from strokes.
const OUTER: usize = 40;

/// How far the equilibrium beside a shape is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Correction {
    /// The corrected tip, m.
    pub(crate) tip: [f64; 2],
    /// theta there.
    pub(crate) theta: f64,
    /// How much the last rounds and finer elements still moved the tip, m: how far this can be trusted.
    pub(crate) doubt: f64,
    /// n_f, m_f at the base.
    pub(crate) base: [f64; 3],
}

/// Why there is none.
#[derive(Debug, Clone, Copy)]
pub(crate) enum NoCorrection {
    /// A section has no strains.
    Section,
    /// The linear equations have none.
    Singular,
    /// Corrections grow.
    Diverged,
}

impl From<NoStrains> for NoCorrection {
    fn from(_: NoStrains) -> Self {
        Self::Section
    }
}

type Matrix = [[f64; 4]; 4];

/// The equations at a shape, linearised.
struct Linear {
    elements: Vec<LinearElement>,
    whole: Factors,
}

struct LinearElement {
    /// d slopes at point i / d state at point j, in scaled units.
    by_state: Vec<Vec<Matrix>>,
    stages: Factors,
    /// How the states at the points follow that at the element's start: one column a component.
    by_start: [Vec<f64>; 4],
}

struct Newton<'a, 'b> {
    shape: &'b mut Shape<'a>,
    /// At the points of the elements, and at the nodes; in scaled units.
    inner: Vec<Vec<State>>,
    nodes: Vec<State>,
    scale: State,
}

/// The equilibrium beside an answer, on as many elements as it takes to know it well against the answer's own estimate.
pub(crate) fn equilibrium_beside(model: &Model, solved: &Configuration) -> Result<Correction, NoCorrection> {
    equilibrium_near(model, solved, solved)
}

/// [`equilibrium_beside`], looked for from the shape of another answer.
pub(crate) fn equilibrium_near(
    model: &Model,
    from: &Configuration,
    solved: &Configuration,
) -> Result<Correction, NoCorrection> {
    let points = Points::new(POINTS);
    let tip = solved.tip();
    let mut out = correct(&mut Shape::read(model, &points, from, 1))?;
    for parts in [2, 4] {
        let finer = correct(&mut Shape::read(model, &points, from, parts))?;
        let by = (finer.tip[0] - out.tip[0]).hypot(finer.tip[1] - out.tip[1]);
        out = Correction { doubt: finer.doubt.max(by), ..finer };
        let off = (out.tip[0] - tip.x).hypot(out.tip[1] - tip.y);
        if out.doubt <= 0.1 * solved.error_estimate.max(off) + 1e-14 * model.arm.length {
            break;
        }
    }
    Ok(out)
}

/// The equilibrium beside `shape`, which takes its strains.
pub(crate) fn correct(shape: &mut Shape<'_>) -> Result<Correction, NoCorrection> {
    let mut out = correct_once(shape)?;
    if !shape.has_kinks() {
        return Ok(out);
    }
    // Kinks are elsewhere in the equilibrium than in the shape that it was looked for from.
    for _ in 0..3 {
        shape.move_kinks();
        let moved = correct_once(shape)?;
        let by = (moved.tip[0] - out.tip[0]).hypot(moved.tip[1] - out.tip[1]);
        out = Correction { doubt: moved.doubt.max(by), ..moved };
        if by < 1e-13 * shape.model.arm.length {
            break;
        }
    }
    Ok(out)
}

fn correct_once(shape: &mut Shape<'_>) -> Result<Correction, NoCorrection> {
    let mut newton = Newton::new(shape);
    newton.solve()?;
    let length = newton.shape.model.arm.length;
    let mut tip = newton.shape.tip();
    let mut settled = 0.0;
    if newton.shape.hangs_on_more() {
        let (mut last, mut fraction) = (f64::INFINITY, 1.0);
        for _ in 0..OUTER {
            newton.shape.follow(fraction);
            newton.reel()?;
            newton.solve()?;
            let moved = newton.shape.tip();
            settled = (moved[0] - tip[0]).hypot(moved[1] - tip[1]);
            tip = moved;
            if settled < 1e-14 * length || (settled < 1e-10 * length && settled > 0.7 * last) {
                break;
            }
            if settled > 0.7 * last {
                fraction = 0.5;
            }
            last = settled;
        }
    }
    let end = newton.nodes[newton.nodes.len() - 1];
    let [theta, ..] = newton.unscaled(end);
    let [_, b1, b2, bm] = newton.unscaled(newton.nodes[0]);
    Ok(Correction { tip, theta, doubt: settled, base: [b1, b2, bm] })
}

impl<'a, 'b> Newton<'a, 'b> {
    fn new(shape: &'b mut Shape<'a>) -> Self {
        let model = shape.model;
        let force = model.place(0.0, 0.0).stiffness[2] / model.arm.length.powi(2);
        let scale = [1.0, force, force, force * model.arm.length];
        let scaled = |z: State| [0, 1, 2, 3].map(|k| z[k] / scale[k]);
        let count = shape.elements.len();
        let inner: Vec<Vec<State>> = (0..count).map(|k| shape.states(k).into_iter().map(scaled).collect()).collect();
        let node = |k: usize, x: f64| {
            [0, 1, 2, 3].map(|c| {
                let values: Vec<f64> = inner[k].iter().map(|z| z[c]).collect();
                shape.points.value(&values, x)
            })
        };
        let mut nodes: Vec<State> = (0..count).map(|k| node(k, 0.0)).collect();
        nodes.push(node(count - 1, 1.0));
        Self { shape, inner, nodes, scale }
    }

    fn unscaled(&self, z: State) -> State {
        [0, 1, 2, 3].map(|k| z[k] * self.scale[k])
    }

    /// Newton's method at given beta' and tensions; the linear equations serve as long as they are good.
    fn solve(&mut self) -> Result<(), NoCorrection> {
        let mut linear: Option<Linear> = None;
        let mut before = f64::INFINITY;
        for _ in 0..40 {
            self.solve_sections()?;
            if linear.is_none() {
                linear = Some(self.linearise()?);
            }
            let step = self.step(linear.as_ref().ok_or(NoCorrection::Singular)?);
            if !step.is_finite() || step > 2.0 {
                return Err(NoCorrection::Diverged);
            }
            if step < 1e-14 || (step < 1e-11 && step > 0.3 * before) {
                break;
            }
            if step > 0.1 * before {
                linear = None;
            }
            before = step;
        }
        self.solve_sections()?;
        Ok(())
    }

    fn solve_sections(&mut self) -> Result<(), NoCorrection> {
        for k in 0..self.inner.len() {
            let states = self.states(k);
            self.shape.elements[k].carry(self.shape.model, self.shape.points, &states)?;
        }
        Ok(())
    }

    fn states(&self, k: usize) -> Vec<State> {
        self.inner[k].iter().map(|z| self.unscaled(*z)).collect()
    }

    fn slopes(&self, k: usize, j: usize) -> State {
        let element = &self.shape.elements[k];
        let z = self.unscaled(self.inner[k][j]);
        let slopes = self.shape.model.slopes(&element.places[j], z, element.strains[j], element.beta_slope[j]);
        [0, 1, 2, 3].map(|c| slopes[c] / self.scale[c])
    }

    fn linearise(&mut self) -> Result<Linear, NoCorrection> {
        let (model, points) = (self.shape.model, self.shape.points);
        let (count, size) = (points.count(), 4 * points.count());
        let mut elements = Vec::with_capacity(self.inner.len());
        for k in 0..self.inner.len() {
            let states = self.states(k);
            let element = &mut self.shape.elements[k];
            let response = element.response(model, points, &states).ok_or(NoCorrection::Singular)?;
            let scale = self.scale;
            let scaled = |own: Matrix| [0, 1, 2, 3].map(|r| [0, 1, 2, 3].map(|c| own[r][c] * scale[c] / scale[r]));
            let by_state: Vec<Vec<Matrix>> = (0..count)
                .map(|i| {
                    let direct =
                        model.direct_slopes(&element.places[i], states[i], element.strains[i], element.beta_slope[i]);
                    (0..count).map(|j| scaled(direct.by_state(&response.by_state[i][j], i == j))).collect()
                })
                .collect();
            let mut matrix = Banded::new(size, size - 1, 0);
            for i in 0..count {
                for j in 0..count {
                    for r in 0..4 {
                        for c in 0..4 {
                            let one = f64::from(u8::from(i == j && r == c));
                            let sum: f64 = (0..count).map(|k| points.upto[i][k] * by_state[k][j][r][c]).sum();
                            matrix.set(4 * i + r, 4 * j + c, one - element.step * sum);
                        }
                    }
                }
            }
            let stages = matrix.factor().ok_or(NoCorrection::Singular)?;
            let by_start = [0, 1, 2, 3].map(|c| {
                let right = (0..size).map(|r| f64::from(u8::from(r % 4 == c))).collect();
                stages.solve(right)
            });
            elements.push(LinearElement { by_state, stages, by_start });
        }
        let whole = self.whole(&elements).factor().ok_or(NoCorrection::Singular)?;
        Ok(Linear { elements, whole })
    }

    /// How much of an element's end the states at its points make.
    fn gathered(&self, k: usize, linear: &LinearElement, stages: &[f64]) -> State {
        let (points, step) = (self.shape.points, self.shape.elements[k].step);
        let mut out = [0.0; 4];
        for (i, row) in linear.by_state.iter().enumerate() {
            for (j, by) in row.iter().enumerate() {
                for (r, out) in out.iter_mut().enumerate() {
                    let slope: f64 = (0..4).map(|c| by[r][c] * stages[4 * j + c]).sum();
                    *out += step * points.weight[i] * slope;
                }
            }
        }
        out
    }

    fn at_base(&self) -> usize {
        if self.shape.model.arm.model.support == Support::UnstrainedBase { 4 } else { 1 }
    }

    fn whole(&self, elements: &[LinearElement]) -> Banded {
        let (count, first) = (elements.len(), self.at_base());
        let mut matrix = Banded::new(4 * (count + 1), 7, 6);
        for r in 0..first {
            matrix.set(r, r, 1.0);
        }
        for (k, element) in elements.iter().enumerate() {
            for c in 0..4 {
                let gathered = self.gathered(k, element, &element.by_start[c]);
                for r in 0..4 {
                    let one = f64::from(u8::from(r == c));
                    matrix.set(first + 4 * k + r, 4 * k + c, -one - gathered[r]);
                    matrix.set(first + 4 * k + r, 4 * k + 4 + c, one);
                }
            }
        }
        if first == 1 {
            let theta = self.nodes[count][0];
            let d = 1e-6;
            let [high, low] = [theta + d, theta - d].map(|theta| self.shape.model.tip_load(theta));
            for r in 0..3 {
                let row = 4 * count + 1 + r;
                matrix.set(row, 4 * count, -(high[r] - low[r]) / (2.0 * d) / self.scale[r + 1]);
                matrix.set(row, 4 * count + 1 + r, 1.0);
            }
        }
        matrix
    }

    /// One round; how far the largest angle moved.
    fn step(&mut self, linear: &Linear) -> f64 {
        let points = self.shape.points;
        let (count, first, n) = (points.count(), self.at_base(), self.inner.len());
        let mut right = vec![0.0; 4 * (n + 1)];
        let base = if first == 1 {
            [self.shape.model.arm.base.angle, 0.0, 0.0, 0.0]
        } else {
            self.shape.model.unstrained_base(&self.shape.tensions)
        };
        for r in 0..first {
            right[r] = base[r] / self.scale[r] - self.nodes[0][r];
        }
        let mut free = Vec::with_capacity(n);
        for k in 0..n {
            let step = self.shape.elements[k].step;
            let slopes: Vec<State> = (0..count).map(|j| self.slopes(k, j)).collect();
            let mut residual = vec![0.0; 4 * count];
            for i in 0..count {
                for c in 0..4 {
                    let sum: f64 = (0..count).map(|j| points.upto[i][j] * slopes[j][c]).sum();
                    residual[4 * i + c] = self.nodes[k][c] + step * sum - self.inner[k][i][c];
                }
            }
            let own = linear.elements[k].stages.solve(residual);
            let gathered = self.gathered(k, &linear.elements[k], &own);
            for c in 0..4 {
                let sum: f64 = (0..count).map(|j| points.weight[j] * slopes[j][c]).sum();
                let off = self.nodes[k][c] + step * sum - self.nodes[k + 1][c];
                right[first + 4 * k + c] = off + gathered[c];
            }
            free.push(own);
        }
        if first == 1 {
            let wanted = self.shape.model.tip_load(self.nodes[n][0]);
            for r in 0..3 {
                right[4 * n + 1 + r] = wanted[r] / self.scale[r + 1] - self.nodes[n][r + 1];
            }
        }
        let change = linear.whole.solve(right);
        let mut most: f64 = 0.0;
        for k in 0..n {
            let start = &change[4 * k..4 * k + 4];
            for j in 0..count {
                for c in 0..4 {
                    let by: f64 = (0..4).map(|p| linear.elements[k].by_start[p][4 * j + c] * start[p]).sum();
                    self.inner[k][j][c] += free[k][4 * j + c] + by;
                }
                let turn: f64 = (0..4).map(|p| linear.elements[k].by_start[p][4 * j] * start[p]).sum();
                most = most.max((free[k][4 * j] + turn).abs());
            }
        }
        for k in 0..=n {
            for c in 0..4 {
                self.nodes[k][c] += change[4 * k + c];
            }
            most = most.max(change[4 * k].abs());
        }
        if change.iter().all(|v| v.is_finite()) { most } else { f64::NAN }
    }

    /// Brings taut cables of commanded stroke nearer to their lengths: by differences of one solve a cable.
    fn reel(&mut self) -> Result<(), NoCorrection> {
        let taut: Vec<usize> = self.shape.taut();
        if taut.is_empty() {
            return Ok(());
        }
        self.solve()?;
        let off = |newton: &Self| -> Vec<f64> { taut.iter().map(|cable| newton.shape.off_command(*cable)).collect() };
        let here = off(self);
        let size = taut.len();
        let mut matrix = Banded::new(size, size - 1, size - 1);
        for (c, cable) in taut.iter().enumerate() {
            let kept = self.shape.tensions[*cable];
            let model = self.shape.model;
            let stiffness = model.place(0.0, 0.0).stiffness[0];
            let step = 1e-4 * kept.max(1e-4 * stiffness);
            self.shape.set_tension(*cable, kept + step);
            self.solve()?;
            for (r, there) in off(self).iter().enumerate() {
                matrix.set(r, c, (there - here[r]) / step);
            }
            self.shape.set_tension(*cable, kept);
        }
        let change = matrix.factor().ok_or(NoCorrection::Singular)?.solve(here);
        for (cable, change) in taut.iter().zip(change) {
            self.shape.set_tension(*cable, self.shape.tensions[*cable] - change);
        }
        Ok(())
    }
}

impl Shape<'_> {
    fn has_kinks(&self) -> bool {
        self.model.arm.flow.speed > 0.0 || self.model.arm.cables.iter().any(|cable| cable.friction != 0.0)
    }

    /// Whether something of it stands still while Newton's method runs.
    fn hangs_on_more(&self) -> bool {
        self.model.arm.cables.iter().any(|cable| cable.friction != 0.0) || !self.taut().is_empty()
    }

    /// The tensions along the arm, by the present strains; a `fraction` of the way.
    fn follow(&mut self, fraction: f64) {
        let before: Vec<Vec<f64>> = self.elements.iter().map(|own| own.start.clone()).collect();
        self.rub();
        for (element, old) in self.elements.iter_mut().zip(before) {
            for (new, old) in element.start.iter_mut().zip(old) {
                *new = fraction * *new + (1.0 - fraction) * old;
            }
            element.follow_turns(self.model, self.points);
        }
    }

    /// Cables of commanded stroke that pull.
    fn taut(&self) -> Vec<usize> {
        let cables = self.model.arm.cables.iter().enumerate();
        cables.filter(|(i, cable)| cable.stroke.is_some() && self.tensions[*i] > 0.0).map(|(i, _)| i).collect()
    }

    /// Unstretched length less what the command leaves of it, m.
    fn off_command(&self, cable: usize) -> f64 {
        let unloaded = self.lengths(cable)[1];
        self.unstretched(cable) - (unloaded - self.model.arm.cables[cable].stroke.unwrap_or(0.0))
    }

    fn set_tension(&mut self, cable: usize, tension: f64) {
        let factor = tension / self.tensions[cable];
        self.tensions[cable] = tension;
        for element in &mut self.elements {
            element.start[cable] *= factor;
            element.follow_turns(self.model, self.points);
        }
    }
}

/// How slopes follow a state and strains, each by itself.
struct Direct {
    z: State,
    e: Strains,
    load_by_theta: [f64; 2],
    load_by_strain: [[f64; 2]; 3],
}

impl Model {
    /// At fixed strains and at a fixed state: the loads' part by differences.
    fn direct_slopes(&self, place: &Place, z: State, e: Strains, beta_slope: f64) -> Direct {
        let load = |theta: f64, e: Strains| self.load(place, theta, e, beta_slope);
        let difference = |high: [f64; 3], low: [f64; 3], by: f64| [0, 1].map(|k| (high[k] - low[k]) / (2.0 * by));
        let d = 1e-6;
        let load_by_theta = difference(load(z[0] + d, e), load(z[0] - d, e), d);
        let load_by_strain = [0, 1, 2].map(|k| {
            let d = if k == 2 { d / place.radius } else { d * e[0] };
            let (mut high, mut low) = (e, e);
            high[k] += d;
            low[k] -= d;
            difference(load(z[0], high), load(z[0], low), d)
        });
        Direct { z, e, load_by_theta, load_by_strain }
    }
}

impl Direct {
    /// d slopes / d a state, by which the strains change as `strain` says; `own` is the state of this point.
    fn by_state(&self, strain: &[[f64; 4]; 3], own: bool) -> Matrix {
        let (z, e, [a, b]) = (self.z, self.e, directors(self.z[0]));
        let (n_a, n_b) = (z[1] * a[0] + z[2] * a[1], z[1] * b[0] + z[2] * b[1]);
        let forces = [[n_b, -n_a], [a[0], b[0]], [a[1], b[1]], [0.0, 0.0]];
        let mut out = [[0.0; 4]; 4];
        for c in 0..4 {
            let change = [strain[0][c], strain[1][c], strain[2][c]];
            let [a_by, b_by] = if own { forces[c] } else { [0.0; 2] };
            out[0][c] = change[2];
            for k in 0..2 {
                let turned = if c == 0 && own { self.load_by_theta[k] } else { 0.0 };
                out[1 + k][c] = -turned - (0..3).map(|i| self.load_by_strain[i][k] * change[i]).sum::<f64>();
            }
            out[3][c] = -(change[0] * n_b + e[0] * b_by - change[1] * n_a - e[1] * a_by);
        }
        out
    }
}
