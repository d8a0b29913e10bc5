//! The boundary of what the tip can reach with bounded tensions.
//!
//! The tip's place is a map of the box of tensions. Its image ends where the box does, and where the map folds: with
//! J_f, J_g the tip's derivatives by two tensions that are between their bounds,
//!
//! ```text
//! edges of the box                     one tension between its bounds
//! det(J_f, J_g) = 0                    two of them
//! ```
//!
//! Edges are followed by their tension, folds by arclength in the plane of the two: a step along the level line, back
//! to it along the gradient. Seeds of folds are changes of sign between the nodes of a lattice. A point with further
//! cables at a bound is inside where these push to both sides of the line, and left out. Tensions without an
//! equilibrium end the image, too: where all others are slack their border is followed ray by ray, since solves raise
//! all tensions in proportion.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::prelude::*;

use super::in_plane::Goal;
use super::problem::{ReachError, ReachOptions, Target};
use super::search::{Search, State};
use crate::rod::arm::Arm;
use crate::statics::configuration::Tip;
use crate::statics::verdict::SolveError;

/// Most cables: faces of the box grow as fast as powers of two.
const CABLES: usize = 8;
/// Intervals of the lattice of a face, of arms with few cables and with many.
const LATTICE: [usize; 2] = [12, 5];
/// Cables that are few.
const FEW: usize = 3;
/// Rays of a plane of tensions, and how often the gap between two is halved.
const RAYS: usize = 24;
const HALVINGS: usize = 5;
/// The shortest step, over the largest tension.
pub(super) const LEAST: f64 = 1e-5;

/// How a boundary is traced.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundaryOptions {
    /// The largest tension of every cable, N; of this and the cable's own `max_tension` the smaller counts. Every cable
    /// needs one.
    pub max_tension: Option<f64>,
    /// Distance of points over L, in [1e-3, 0.1].
    pub spacing: f64,
    /// Error of tips over L, in [1e-9, 1e-3].
    pub tol: f64,
}

impl Default for BoundaryOptions {
    fn default() -> Self {
        Self { max_tension: None, spacing: 0.01, tol: 1e-7 }
    }
}

/// What bounds the places that can be reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BoundaryKind {
    /// All cables but this one are at a bound.
    Edge(usize),
    /// These two move the tip along the same line.
    Fold([usize; 2]),
    /// These two pulled further have no equilibrium.
    Limit([usize; 2]),
}

/// A place of the tip on the boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundaryPoint {
    /// N.
    pub tensions: Vec<f64>,
    /// The tip.
    pub tip: Tip,
}

/// Places one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundaryPiece {
    /// Why it is a boundary.
    pub kind: BoundaryKind,
    /// At least two.
    pub points: Vec<BoundaryPoint>,
}

/// How far a boundary is traced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoundaryProgress {
    /// Edges, faces and planes of the box of tensions that are done.
    pub done: usize,
    /// How many there are.
    pub of: usize,
    /// Shapes that were asked for.
    pub shapes: usize,
}

/// All that bounds what the tip can reach, and pieces inside where the image lies over itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    /// Edges first, then folds, then limits.
    pub pieces: Vec<BoundaryPiece>,
}

impl Arm {
    /// The boundary of the places that the tip reaches with tensions from 0 to their largest, at the shapes that solves
    /// give.
    ///
    /// Folds narrower than a lattice of 12 (with more than three cables, 5) intervals a tension can be missed.
    ///
    /// # Errors
    /// [`ReachError`]; with [`ReachError::Option`] for cables without a largest tension, and for more than 8 of them.
    ///
    /// ```
    /// use hydrostat::{Arm, BoundaryOptions, Cable, Profile};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    /// arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    /// let options = BoundaryOptions { max_tension: Some(0.2), spacing: 0.05, ..BoundaryOptions::default() };
    /// let boundary = arm.reachable(&options)?;
    /// assert_eq!(boundary.pieces.len(), 4, "the edges of the box: nothing folds");
    /// # Ok::<(), hydrostat::ReachError>(())
    /// ```
    pub fn reachable(&self, options: &BoundaryOptions) -> Result<Boundary, ReachError> {
        self.reachable_while(options, |_| true)
    }

    /// [`Arm::reachable`] while `go_on`, which is asked before every shape, from several threads, says so; then with
    /// what was found until then.
    ///
    /// # Errors
    /// [`ReachError`].
    pub fn reachable_while(
        &self,
        options: &BoundaryOptions,
        go_on: impl Fn(BoundaryProgress) -> bool + Sync,
    ) -> Result<Boundary, ReachError> {
        for (option, value, [from, to], expected) in [
            ("spacing", options.spacing, [1e-3, 0.1], "in [1e-3, 0.1]"),
            ("tol", options.tol, [1e-9, 1e-3], "in [1e-9, 1e-3]"),
            ("cables", self.cables.len() as f64, [0.0, CABLES as f64], "up to 8"),
        ] {
            if !(from..=to).contains(&value) {
                return Err(ReachError::Option { option, value, expected });
            }
        }
        let reach = ReachOptions { max_tension: options.max_tension, tol: options.tol, ..ReachOptions::default() };
        let search: Search = Search::new(self, Goal::Places(vec![Target::tip(self.base.x, self.base.y)]), &reach)?;
        if let Some(value) = search.most.iter().copied().find(|most| !most.is_finite()) {
            return Err(ReachError::Option {
                option: "max_tension",
                value,
                expected: "that is finite, for every cable",
            });
        }
        let cables = search.most.len();
        let lattice = LATTICE[usize::from(cables > FEW)];
        // Nothing pulls: the one shape that has to be there.
        search.at(&vec![0.0; cables])?;

        let mut jobs = Vec::new();
        for f in 0..cables {
            jobs.extend(search.corners(&[f]).into_iter().map(|corner| Job::Edge(f, corner)));
        }
        let pairs = || (0..cables).flat_map(|f| (f + 1..cables).map(move |g| [f, g]));
        for pair in pairs() {
            jobs.extend(search.corners(&pair).into_iter().map(|corner| Job::Fold(pair, corner)));
        }
        jobs.extend(pairs().map(Job::Limit));
        let (of, done, shapes) = (jobs.len(), AtomicUsize::new(0), AtomicUsize::new(0));
        let stopped = AtomicBool::new(false);
        let ask = || {
            let shapes = shapes.fetch_add(1, Ordering::Relaxed);
            let on = || go_on(BoundaryProgress { done: done.load(Ordering::Relaxed), of, shapes });
            if !stopped.load(Ordering::Relaxed) && !on() {
                stopped.store(true, Ordering::Relaxed);
            }
            !stopped.load(Ordering::Relaxed)
        };
        let tracer = Tracer { search, spacing: options.spacing, lattice, go_on: &ask };
        let run = |job| {
            let pieces = tracer.run(job);
            done.fetch_add(1, Ordering::Relaxed);
            pieces
        };
        let pieces: Vec<Vec<BoundaryPiece>> = jobs.par_iter().map(run).collect();
        Ok(Boundary { pieces: pieces.into_iter().flatten().collect() })
    }
}

/// A part of the work.
enum Job {
    Edge(usize, Vec<f64>),
    Fold([usize; 2], Vec<f64>),
    Limit([usize; 2]),
}

pub(super) struct Tracer<'a> {
    pub(super) search: Search,
    pub(super) spacing: f64,
    pub(super) lattice: usize,
    /// SectionQuery before every shape; when it says no there are no more shapes, which ends every line.
    go_on: &'a (dyn Fn() -> bool + Sync),
}

/// A shape with the tip's derivatives by the tensions, over L.
#[derive(Clone)]
pub(super) struct Here {
    pub(super) state: State,
    pub(super) columns: Vec<Vec<f64>>,
    tip: Tip,
}

impl Here {
    fn point(&self) -> BoundaryPoint {
        BoundaryPoint { tensions: self.state.tensions.clone(), tip: self.tip }
    }
}

impl Search {
    /// All choices of bounds for the cables but `free`, which are 0.
    fn corners(&self, free: &[usize]) -> Vec<Vec<f64>> {
        let mut all = vec![vec![0.0; self.most.len()]];
        for (c, most) in self.most.iter().enumerate().filter(|(c, _)| !free.contains(c)) {
            let pulled: Vec<Vec<f64>> = all
                .iter()
                .map(|corner| {
                    let mut corner = corner.clone();
                    corner[c] = *most;
                    corner
                })
                .collect();
            all.extend(pulled);
        }
        all
    }
}

impl Tracer<'_> {
    fn run(&self, job: &Job) -> Vec<BoundaryPiece> {
        match job {
            Job::Edge(f, corner) => outer(BoundaryKind::Edge(*f), self.edge(*f, corner), &[*f]),
            Job::Fold(pair, corner) => outer(BoundaryKind::Fold(*pair), self.folds(*pair, corner), pair),
            Job::Limit(pair) => {
                let kind = BoundaryKind::Limit(*pair);
                self.limits(*pair).into_iter().map(|points| BoundaryPiece { kind, points }).collect()
            }
        }
    }

    pub(super) fn at(&self, tensions: &[f64]) -> Option<Here> {
        if !(self.go_on)() {
            return None;
        }
        self.here(self.search.at(tensions).ok()?)
    }

    /// From another shape.
    pub(super) fn to(&self, from: &Here, tensions: &[f64]) -> Option<Here> {
        if !(self.go_on)() {
            return None;
        }
        let mut solver = from.state.solver.clone();
        solver.set_tensions(tensions).ok()?;
        solver.update().ok()?;
        self.here(self.search.state(solver, tensions.to_vec()))
    }

    fn here(&self, mut state: State) -> Option<Here> {
        let columns = self.search.jacobian(&state.solver)?;
        let tip = state.solver.tip().ok()?;
        Some(Here { state, columns, tip })
    }

    /// Between two tips, over L.
    pub(super) fn apart(&self, a: &Here, b: &Here) -> f64 {
        (a.tip.x - b.tip.x).hypot(a.tip.y - b.tip.y) / self.search.arm.length
    }

    /// The lines on which tension `f` goes from 0 to its largest: more than one where shapes are missing, or leap,
    /// between.
    fn edge(&self, f: usize, corner: &[f64]) -> Vec<Vec<Here>> {
        let most = self.search.most[f];
        let mut out = Vec::new();
        let mut covered = -1.0;
        for k in 0..=self.lattice {
            let tension = if k == self.lattice { most } else { most * k as f64 / self.lattice as f64 };
            if tension <= covered {
                continue;
            }
            let mut tensions = corner.to_vec();
            tensions[f] = tension;
            let Some(start) = self.at(&tensions) else { continue };
            let mut line = self.walk(&start, f, -1.0, covered);
            line.reverse();
            line.push(start.clone());
            line.extend(self.walk(&start, f, 1.0, covered));
            covered = line.last().map_or(tension, |last| last.state.tensions[f]);
            out.push(line);
        }
        out
    }

    /// From a shape on, up or down, as far as shapes go without a leap, and not below `covered`.
    fn walk(&self, start: &Here, f: usize, sign: f64, covered: f64) -> Vec<Here> {
        let most = self.search.most[f];
        let end = if sign > 0.0 { most } else { covered.max(0.0) };
        let mut out: Vec<Here> = Vec::new();
        let mut step = most / self.lattice as f64;
        loop {
            let here = out.last().unwrap_or(start);
            let from = here.state.tensions[f];
            let room = sign * (end - from);
            if room <= 0.0 {
                return out;
            }
            step = (2.0 * step).min(self.spacing / size(&here.columns[f])).min(most / self.lattice as f64);
            let next = loop {
                let mut tensions = here.state.tensions.clone();
                tensions[f] = if step >= room { end } else { from + sign * step };
                let next = self.to(here, &tensions).filter(|next| self.apart(here, next) <= 2.0 * self.spacing);
                step *= if next.is_some() { 1.0 } else { 0.5 };
                if next.is_some() || step < LEAST * most {
                    break next;
                }
            };
            match next {
                Some(next) => out.push(next),
                None => return out,
            }
        }
    }

    /// The last shapes before there are none, for rays of the plane of two tensions, all others slack.
    fn limits(&self, pair: [usize; 2]) -> Vec<Vec<BoundaryPoint>> {
        // Along the outer edges of the plane.
        let at = |k: f64| if k <= 1.0 { [1.0, k] } else { [2.0 - k, 1.0] };
        let ray = |k: f64| (k, self.limit_on(pair, at(k)));
        let mut rays: Vec<(f64, Option<BoundaryPoint>)> =
            (0..=RAYS).map(|k| ray(2.0 * k as f64 / RAYS as f64)).collect();
        let length = self.search.arm.length;
        for _ in 0..HALVINGS {
            let mut finer = Vec::with_capacity(2 * rays.len());
            for pair in rays.windows(2) {
                finer.push(pair[0].clone());
                let wide = match (&pair[0].1, &pair[1].1) {
                    (Some(a), Some(b)) => (a.tip.x - b.tip.x).hypot(a.tip.y - b.tip.y) > self.spacing * length,
                    (a, b) => a.is_some() != b.is_some(),
                };
                if wide {
                    finer.push(ray(0.5 * (pair[0].0 + pair[1].0)));
                }
            }
            finer.extend(rays.pop());
            if finer.len() == rays.len() + 1 {
                rays = finer;
                break;
            }
            rays = finer;
        }
        rays.split(|(_, limit)| limit.is_none())
            .filter(|run| run.len() > 1)
            .map(|run| run.iter().filter_map(|(_, limit)| limit.clone()).collect())
            .collect()
    }

    /// The last shape on the way to these fractions of the largest tensions; `None` where there is no end on it.
    fn limit_on(&self, pair: [usize; 2], fraction: [f64; 2]) -> Option<BoundaryPoint> {
        if !(self.go_on)() {
            return None;
        }
        let slack = vec![0.0; self.search.most.len()];
        match self.search.at(&self.in_face(pair, &slack, fraction)) {
            Err(ReachError::Solve(SolveError::NoEquilibrium(no))) => {
                let last = no.last_good?;
                let tensions = last.arm.cables.iter().map(|cable| cable.tension).collect();
                Some(BoundaryPoint { tensions, tip: last.tip() })
            }
            _ => None,
        }
    }
}

/// The parts of lines on which all cables at bounds, let go, move the tip to the same side.
fn outer(kind: BoundaryKind, lines: Vec<Vec<Here>>, free: &[usize]) -> Vec<BoundaryPiece> {
    let is_outer = |here: &Here| {
        let along = free.iter().max_by(|a, b| size(&here.columns[**a]).total_cmp(&size(&here.columns[**b])));
        let Some(along) = along else { return true };
        let sides = (0..here.columns.len()).filter(|c| !free.contains(c)).map(|c| {
            let inwards = if here.state.tensions[c] > 0.0 { -1.0 } else { 1.0 };
            inwards * cross(&here.columns[*along], &here.columns[c])
        });
        let (mut left, mut right) = (false, false);
        for side in sides {
            left |= side > 0.0;
            right |= side < 0.0;
        }
        !(left && right)
    };
    let mut out = Vec::new();
    for line in lines {
        for run in line.chunk_by(|a, b| is_outer(a) == is_outer(b)) {
            if run.len() > 1 && is_outer(&run[0]) {
                out.push(BoundaryPiece { kind, points: run.iter().map(Here::point).collect() });
            }
        }
    }
    out
}

fn size(column: &[f64]) -> f64 {
    column.iter().fold(0.0, |m: f64, v| m.hypot(*v)).max(f64::MIN_POSITIVE)
}

pub(super) fn cross(a: &[f64], b: &[f64]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
