//! Cables whose length is commanded in place of their tension.
//!
//! The stroke of a cable is its length at the reference strains less its present length, positive when
//! reeled in; an elastic one of stiffness EA is longer by T/EA of its unstretched length, so that reeling in its
//! stroke s means
//!
//! ```text
//! length of its path = (length at the reference strains - s) (1 + T/EA)
//! ```
//!
//! Its tension is then unknown, and a cable does not push: with the slack g, the stroke that the path of the cable has
//! (unstretched) less the one commanded,
//!
//! ```text
//! T >= 0,  g >= 0,  T g = 0
//! ```
//!
//! for every such cable, which is solved as it stands: Newton rounds on the shape and the tensions of the
//! taut cables together, whose set changes until no taut cable pushes and no slack one is too short.
//!
//! Several shapes can have the same strokes. The one meant is the end of this path: loads and given tensions first,
//! the commanded cables slack (section 7 of `docs/model.md`), then all commanded strokes in proportion, from
//! those that the slack cables have there to those asked for. An arm that lies straight in the stream has kinks of
//! the load all along it there; then the path starts from a small pull.

use hydrostat_bvp::{Collocation, Correction};

use crate::arm::Arm;
use crate::engine::{Engine, Guess, HOP, M, State, Trouble, evaluate, kink_resolution, solve};
use crate::equilibrium::{Equilibrium, N, Q};
use crate::parameter::Parameter;
use crate::path::{LOOSE, name_limit};
use crate::verdict::{Phase, Verdict, VerdictKind};

/// Corrections (rad) above which a Newton round is shortened.
const LONGEST: f64 = 1.0;
/// Largest turn of a section (rad) in one step of the strokes.
const LARGEST_TURN: f64 = 0.3;
/// Shortest step of the strokes, over the way that they have to go.
const SHORTEST: f64 = 1e-7;
/// Difference over which strokes are differentiated along a change of the shape.
const DIFFERENCE: f64 = 1e-6;

/// Cables with a commanded stroke, and where their strokes are on the way to it.
#[derive(Debug, Clone)]
pub(crate) struct Strokes {
    /// Their indices.
    cables: Vec<usize>,
    /// Strokes at the start of the path, over L.
    from: Vec<f64>,
    /// Strokes commanded, over L.
    to: Vec<f64>,
    /// Whether each is taut.
    taut: Vec<bool>,
    /// Sign of the determinant of shape and tensions together where the path began, and at the last balance.
    sign: f64,
    last_sign: f64,
    /// Steps taken.
    pub(crate) steps: usize,
}

/// The arm with its commanded cables slack or, to start from, pulled with a share of the tensions that their strokes take
/// in a straight arm: integral of T (1/(C1 A) + y^2/(C3 A)).
pub(crate) fn started(arm: &Arm, equations: &Equilibrium, share: f64) -> Arm {
    let mut start = arm.clone();
    for (c, cable) in start.cables.iter_mut().enumerate() {
        if let Some(stroke) = cable.stroke {
            let tension = stroke / (arm.length * equations.cable_compliance(c)) * equations.units.force;
            cable.tension = (share * tension).max(0.0);
        }
    }
    start
}

impl Strokes {
    /// From the engine's configuration, whose commanded cables are taut where they have a tension.
    pub(crate) fn new(engine: &mut Engine, arm: &Arm) -> Result<Self, Trouble> {
        engine.refresh().map_err(Trouble::Section)?;
        let cables: Vec<usize> = (0..arm.cables.len()).filter(|c| arm.cables[*c].stroke.is_some()).collect();
        let from = strokes_of(&engine.equations, &engine.system.gauss.b, &cables);
        let to = cables.iter().map(|c| arm.cables[*c].stroke.unwrap_or(0.0) / arm.length).collect();
        let taut: Vec<bool> = cables.iter().map(|c| engine.equations.arm().cables[*c].tension > 0.0).collect();
        let sign = engine.system.determinant().sign;
        let mut this = Self { cables, from, to, taut, sign, last_sign: sign, steps: 0 };
        if this.taut.contains(&true) {
            let start = this.from.clone();
            this.sign = this.balance(engine, &start, 1e-6)?;
        }
        Ok(this)
    }

    /// Strokes commanded now, over L.
    pub(crate) fn command(&mut self, arm: &Arm) {
        for (to, c) in self.to.iter_mut().zip(&self.cables) {
            *to = arm.cables[*c].stroke.unwrap_or(0.0) / arm.length;
        }
    }

    /// Whether the determinant still has the sign that it had where the path began.
    pub(crate) fn kept_its_branch(&self) -> bool {
        self.sign == self.last_sign
    }

    fn commanded(&self, share: f64) -> Vec<f64> {
        self.from.iter().zip(&self.to).map(|(from, to)| from + share * (to - from)).collect()
    }

    /// Follows the strokes to those commanded, or to a verdict, with the engine at the last good point.
    pub(crate) fn follow(&mut self, engine: &mut Engine) -> Result<(), Verdict> {
        let (mut share, mut step) = (0.0_f64, 1.0_f64);
        while share < 1.0 {
            let kept = (engine.state(), self.taut.clone());
            let next = (share + step).min(1.0);
            match self.advance(engine, next, &kept.0) {
                Ok(()) => {
                    share = next;
                    step *= 1.6;
                    self.steps += 1;
                }
                Err(error) => {
                    engine.restore(&kept.0);
                    self.taut = kept.1;
                    step = 0.4 * step.min(1.0 - share);
                    if step < SHORTEST {
                        return Err(Self::end(engine, share, &error));
                    }
                }
            }
        }
        Ok(())
    }

    /// One step of the strokes from `kept`.
    fn advance(&mut self, engine: &mut Engine, share: f64, kept: &State) -> Result<(), Trouble> {
        let goal = self.commanded(share);
        let sign = self.balance(engine, &goal, 1e-6)?;
        let turn = engine
            .solution
            .nodes
            .iter()
            .zip(&kept.solution.nodes)
            .fold(0.0_f64, |most, (now, before)| most.max((now[0] - before[0]).abs()));
        if turn > LARGEST_TURN {
            return Err(Trouble::Stalled(turn));
        }
        for _ in 0..3 {
            let kinks = engine.kinks(0.01);
            if !engine.pin(&kinks, 0.1 * LOOSE.sqrt()) {
                break;
            }
            self.balance(engine, &goal, 1e-6)?;
        }
        for _ in 0..4 {
            if engine.estimate(LOOSE)? <= LOOSE {
                break;
            }
            engine.refine(0.05 * LOOSE, 400);
            self.balance(engine, &goal, 1e-6)?;
        }
        engine.ends_fine()?;
        // Where the determinant of shape and tensions has changed its sign, the path has turned back in between.
        if sign == self.sign { Ok(()) } else { Err(Trouble::Singular) }
    }

    /// Refines at the commanded strokes until the estimate meets `tolerance` (tip position over L).
    pub(crate) fn settle(&mut self, engine: &mut Engine, tolerance: f64) -> Result<f64, Trouble> {
        let goal = self.commanded(1.0);
        let mut best: Option<(f64, State)> = None;
        let mut rest = tolerance.max(1e-6);
        for _ in 0..10 {
            let estimate = match self.settle_on_this_mesh(engine, &goal, rest, tolerance) {
                Ok(estimate) => estimate,
                Err(trouble) if best.is_none() => return Err(trouble),
                Err(_) => break,
            };
            if estimate <= tolerance && rest <= 0.1 * tolerance {
                return Ok(estimate);
            }
            rest = (1e-4 * estimate).clamp(0.1 * tolerance, tolerance.max(1e-6));
            if best.as_ref().is_none_or(|b| estimate < b.0) {
                best = Some((estimate, engine.state()));
            }
            engine.refine(0.2 * tolerance, 2000);
        }
        match best {
            Some((estimate, state)) if estimate < 1e-5 => {
                engine.restore(&state);
                // The shape may be as good as it gets, the strokes can still be met.
                if self.balance(engine, &goal, 0.1 * tolerance).is_err() {
                    engine.restore(&state);
                }
                Ok(estimate)
            }
            _ => Err(Trouble::Mesh),
        }
    }

    fn settle_on_this_mesh(
        &mut self,
        engine: &mut Engine,
        goal: &[f64],
        rest: f64,
        tolerance: f64,
    ) -> Result<f64, Trouble> {
        self.balance(engine, goal, rest)?;
        let resolution = kink_resolution(tolerance);
        for _ in 0..4 {
            let kinks = engine.kinks(10.0 * resolution);
            if !engine.pin(&kinks, resolution) {
                break;
            }
            self.balance(engine, goal, rest)?;
        }
        engine.estimate(tolerance)
    }

    /// Newton on shape and tensions at the strokes `goal` (over L), with the taut cables chosen so that none pushes
    /// and no slack one is too short. Gives the sign of the determinant.
    fn balance(&mut self, engine: &mut Engine, goal: &[f64], tolerance: f64) -> Result<f64, Trouble> {
        for _ in 0..4 * self.cables.len() + 4 {
            let (sign, slack) = self.newton(engine, goal, tolerance)?;
            let mut changed = false;
            for (i, c) in self.cables.iter().enumerate() {
                if self.taut[i] && engine.equations.arm().cables[*c].tension < 0.0 {
                    self.taut[i] = false;
                    engine.equations.set_tension(*c, 0.0);
                    changed = true;
                } else if !self.taut[i] && slack[i] < -tolerance {
                    self.taut[i] = true;
                    changed = true;
                }
            }
            if !changed {
                engine.take_stock()?;
                self.last_sign = sign;
                return Ok(sign);
            }
        }
        Err(Trouble::Stalled(f64::INFINITY))
    }

    /// Newton with the taut cables as they are; the sign of the determinant, and the slack of every cable.
    fn newton(&mut self, engine: &mut Engine, goal: &[f64], tolerance: f64) -> Result<(f64, Vec<f64>), Trouble> {
        let active: Vec<usize> = (0..self.cables.len()).filter(|i| self.taut[*i]).collect();
        let unit = engine.equations.units.force;
        let mut before = f64::INFINITY;
        for round in 0..25 {
            let (mut rest, mut by_tension) = (Correction::default(), Vec::new());
            if active.is_empty() {
                engine.linearise(false)?;
                solve(&engine.system, &engine.solution, 0, &mut rest);
            }
            for i in &active {
                let c = self.cables[*i];
                let tension = engine.equations.arm().cables[c].tension;
                engine.equations.vary(Parameter::Tension(c), tension, tension + unit);
                let linear = engine.linearise(true);
                engine.equations.vary_nothing();
                linear?;
                solve(&engine.system, &engine.solution, 0, &mut rest);
                let mut response = Correction::default();
                solve(&engine.system, &engine.solution, 1, &mut response);
                by_tension.push(response);
            }
            let sign = engine.system.determinant().sign;
            let weights = engine.system.gauss.b;
            let now = strokes_of(&engine.equations, &weights, &self.cables);
            // Strokes after the shape's own correction, and their change with every tension.
            let along = |correction: &Correction<N, M, Q>, pulled: Option<usize>| -> Result<Vec<f64>, Trouble> {
                let pulled = pulled.map(|i| (self.cables[i], unit));
                let before = self.strokes_along(engine, correction, pulled, -DIFFERENCE)?;
                let after = self.strokes_along(engine, correction, pulled, DIFFERENCE)?;
                // From both sides, because beta' is a round behind at either.
                Ok(after.iter().zip(&before).map(|(after, before)| (after - before) / (2.0 * DIFFERENCE)).collect())
            };
            let by_rest = along(&rest, None)?;
            let mut matrix = vec![vec![0.0; active.len() + 1]; active.len()];
            let mut columns = Vec::with_capacity(active.len());
            for (a, i) in active.iter().enumerate() {
                columns.push(along(&by_tension[a], Some(*i))?);
            }
            for (row, i) in matrix.iter_mut().zip(&active) {
                for (a, column) in columns.iter().enumerate() {
                    row[a] = column[*i];
                }
                row[active.len()] = goal[*i] - now[*i] - by_rest[*i];
            }
            let (changes, determinant) = solved(matrix).ok_or(Trouble::Singular)?;

            let mut total = rest;
            for (change, response) in changes.iter().zip(&by_tension) {
                total.add(response, *change);
            }
            let size = total.largest(0);
            let off = active.iter().fold(0.0_f64, |most, i| most.max((goal[*i] - now[*i]).abs()));
            if !size.is_finite() || (round > 4 && size > 10.0 * before) {
                return Err(Trouble::Stalled(size));
            }
            let share = if size > LONGEST { LONGEST / size } else { 1.0 };
            engine.solution.add(&total, share);
            for (change, i) in changes.iter().zip(&active) {
                let c = self.cables[*i];
                let tension = engine.equations.arm().cables[c].tension + share * change * unit;
                engine.equations.set_tension(c, tension);
            }
            engine.last = size;
            before = size;
            // Across a kink of the load corrections can hop between two shapes that are near enough for a path.
            let hops = round == 24 && tolerance >= 1e-6 && size.max(off) <= HOP;
            let least = tolerance.max(1e-13);
            if hops || (share == 1.0 && 0.03 * size <= least && off <= least) {
                let slack = now.iter().zip(goal).map(|(now, goal)| now - goal).collect();
                return Ok((sign * determinant.signum(), slack));
            }
        }
        Err(Trouble::Stalled(before))
    }

    /// Strokes (over L) a small way along a change of the shape, with the change of one cable's tension (N).
    fn strokes_along(
        &self,
        engine: &Engine,
        change: &Correction<N, M, Q>,
        pulled: Option<(usize, f64)>,
        way: f64,
    ) -> Result<Vec<f64>, Trouble> {
        let mut equations = engine.equations.clone();
        let mut moved: Guess = engine.solution.clone();
        moved.add(change, way);
        if let Some((c, unit)) = pulled {
            let tension = equations.arm().cables[c].tension + way * unit;
            equations.set_tension(c, tension);
        }
        let mut system = Collocation::new();
        evaluate(&mut system, &mut equations, &moved).map_err(Trouble::Section)?;
        Ok(strokes_of(&equations, &system.gauss.b, &self.cables))
    }

    fn end(engine: &mut Engine, share: f64, trouble: &Trouble) -> Verdict {
        let turned_back = matches!(trouble, Trouble::Singular);
        let residual = engine.last;
        let (kind, s) = name_limit(engine, Some(trouble), residual);
        let kind = if kind == VerdictKind::NotFound && turned_back { VerdictKind::LimitPoint } else { kind };
        Verdict { kind, phase: Phase::Stroke, load_fraction: share, s, residual }
    }
}

/// Unstretched strokes of `cables` at the last evaluation, over L.
fn strokes_of(equations: &Equilibrium, weights: &[f64; M], cables: &[usize]) -> Vec<f64> {
    cables
        .iter()
        .map(|c| {
            let [now, reference] = equations.cable_lengths(*c, weights);
            let cable = &equations.arm().cables[*c];
            let strain = cable.stiffness.map_or(0.0, |stiffness| cable.tension / stiffness);
            reference - now / (1.0 + strain)
        })
        .collect()
}

/// Solves equations whose right side is the last column, with the determinant.
fn solved(mut rows: Vec<Vec<f64>>) -> Option<(Vec<f64>, f64)> {
    let n = rows.len();
    let mut determinant = 1.0;
    for k in 0..n {
        let best = (k..n).max_by(|i, j| rows[*i][k].abs().total_cmp(&rows[*j][k].abs()))?;
        if best != k {
            rows.swap(k, best);
            determinant = -determinant;
        }
        let pivot = rows[k][k];
        if pivot == 0.0 || !pivot.is_finite() {
            return None;
        }
        determinant *= pivot;
        let own = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            if i != k {
                let factor = row[k] / pivot;
                for (v, o) in row.iter_mut().zip(&own) {
                    *v -= factor * o;
                }
            }
        }
    }
    Some(((0..n).map(|k| rows[k][n] / rows[k][k]).collect(), determinant))
}
