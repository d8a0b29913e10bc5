//! Cables whose length is commanded in place of their tension.
//!
//! The stroke of a cable is its length at the reference strains less its present length, positive when
//! reeled in; an elastic one of stiffness EA is longer by T/EA of its unstretched length, so that reeling in its
//! stroke q means
//!
//! ```text
//! length of its path = (length at the reference strains - q) (1 + T/EA)
//! ```
//!
//! Its tension is then unknown, and a cable does not push: with the slack c, the stroke that the path of the cable has
//! (unstretched) less the one commanded,
//!
//! ```text
//! T >= 0,  c >= 0,  T c = 0
//! ```
//!
//! for every such cable, which is solved as it stands: Newton rounds on the shape and the tensions of the taut cables
//! together (`engine/stroke_control`), whose set changes until no taut cable pushes and no slack one is too short.
//!
//! Several shapes can have the same strokes. The one meant is the end of this path: loads and given tensions first,
//! the commanded cables slack (section 7 of `docs/model.md`), then all commanded strokes in proportion, from
//! those that the slack cables have there to those asked for. It is followed by arclength (`path/load_stepping`,
//! `path/contact`) unless the direct solve (Newton from the tensions of a straight arm) leads to a shape that no load
//! pushes hard against: then that stands. If the path cannot leave its start, the direct shape also stands when the
//! path in its tensions leads to the same shape.

use crate::rod::arm::Arm;
use crate::statics::configuration::Configuration;
use crate::statics::engine::Trouble;
use crate::statics::path::{PathSummary, StepControl, Stopped, follow_strokes};
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::solve::{SAME, Solver, known_on_the_way};
use crate::statics::verdict::{Phase, SolveError, Verdict, VerdictKind};

/// Shares of the tensions of a straight arm from which the path of strokes may start: slack, unless that is in line
/// with the stream, with kinks of the load all along it, from where the path does not get away.
const STARTS: [f64; 4] = [0.0, 0.02, 0.2, 0.7];

/// The fraction that a path of strokes has to reach to have got away from its start.
const AWAY: f64 = 1e-4;

/// Sweeps of the tensions that commanded strokes take in a straight arm.
const SWEEPS: usize = 60;

impl Solver {
    /// With the strokes of some cables commanded.
    pub(crate) fn solve_strokes(&mut self) -> Result<Configuration, SolveError> {
        let arm = self.engine.equations.arm().clone();
        if let Ok(configuration) = self.solve_strokes_directly(&arm) {
            return Ok(configuration);
        }
        let guess = self.straight_tensions(&arm);
        let mut first = None;
        for fraction in STARTS {
            match self.solve_strokes_from(&with_tensions(&arm, |c| fraction * guess[c])) {
                Err(SolveError::NoEquilibrium(no)) if is_start(&no.verdict) => {
                    first = first.or(Some(SolveError::NoEquilibrium(no)));
                }
                other => return other,
            }
            if self.engine.spent().is_some() {
                break;
            }
        }
        if let Some(configuration) = self.solve_strokes_by_tensions(&arm) {
            return Ok(configuration);
        }
        Err(first.unwrap_or_else(|| {
            let verdict = self.last_verdict(Some(0.0));
            self.no_equilibrium(verdict)
        }))
    }

    /// Along the path from the tensions of `start`.
    fn solve_strokes_from(&mut self, start: &Arm) -> Result<Configuration, SolveError> {
        self.engine.equations.let_go();
        self.engine.set_loads(start);
        let mut snaps = self.solve_tensions()?.snaps;
        self.forget();
        let travelled = match self.follow_strokes_from_here(StepControl::BRISK) {
            Ok(travelled) => travelled,
            Err(mut stopped) => {
                snaps.append(&mut stopped.snaps);
                return Err(self.no_equilibrium(Stopped { snaps, ..stopped }));
            }
        };
        let bifurcations = travelled.bifurcations;
        let settled = self.engine.settle(self.options.tol, First::Rough);
        let Ok(mut configuration) = settled.and_then(|estimate| self.read(estimate, travelled)) else {
            let verdict = Verdict { phase: Phase::Stroke, ..self.last_verdict(Some(1.0)) };
            return Err(self.no_equilibrium(verdict));
        };
        let sign = self.engine.determinant().sign;
        snaps.append(&mut configuration.snaps);
        configuration.snaps = snaps;
        configuration.stable = known_on_the_way(&configuration, bifurcations, sign < 0.0);
        self.keep(&configuration, sign);
        Ok(configuration)
    }

    /// The direct solve, where the path of the tensions that it finds leads to the same shape. An arm that lies in a
    /// fast stream has kinks all along when its cables begin to pull, and the path of the strokes may not get past
    /// them.
    fn solve_strokes_by_tensions(&mut self, arm: &Arm) -> Option<Configuration> {
        // Loads that stretch the arm leave cables less to reel in than a straight arm would.
        let slack = self.solve_beside(&without_strokes(&with_tensions(arm, |_| 0.0)))?;
        let mut left = arm.clone();
        for (cable, state) in left.cables.iter_mut().zip(&slack.cables) {
            cable.stroke = cable.stroke.map(|stroke| stroke - state.stroke);
        }
        let guess = self.straight_tensions(&left);
        let estimate = self.settle_strokes(arm, &guess).ok()?;
        if self.engine.determinant().sign < 0.0 {
            return None;
        }
        let found = self.read_strokes(estimate).ok()?;
        let pulled = without_strokes(&with_tensions(arm, |c| found.cables[c].tension));
        let led = self.solve_beside(&pulled)?;
        let off = (led.tip().x - found.tip().x).hypot(led.tip().y - found.tip().y);
        if off > SAME * arm.length {
            self.forget();
            return None;
        }
        Some(found)
    }

    /// Another arm, in what work is left.
    fn solve_beside(&mut self, arm: &Arm) -> Option<Configuration> {
        let mut other = Self::new(arm, self.options).ok()?;
        let solved = other.solve_within(self.engine.left());
        self.engine.count_beside(other.engine.work());
        solved.ok()
    }

    /// From the tensions that the strokes take in a straight arm without other loads.
    fn solve_strokes_directly(&mut self, arm: &Arm) -> Result<Configuration, Trouble> {
        let estimate = self.settle_strokes(arm, &self.straight_tensions(arm))?;
        if self.engine.needs_continuation() || self.engine.determinant().sign < 0.0 {
            return Err(Trouble::Singular);
        }
        self.read_strokes(estimate)
    }

    /// Newton from the tensions `guess`, N.
    fn settle_strokes(&mut self, arm: &Arm, guess: &[f64]) -> Result<f64, Trouble> {
        self.forget();
        self.engine.set_phase(Phase::Tension, 1.0);
        self.engine.set_loads(&with_tensions(arm, |c| guess[c]));
        self.engine.equations.hold_strokes();
        self.engine.start_from_cables(8)?;
        self.engine.settle(self.options.tol, First::Rough)
    }

    fn read_strokes(&mut self, estimate: f64) -> Result<Configuration, Trouble> {
        let configuration = self.read(estimate, PathSummary::default())?;
        self.keep(&configuration, 1.0);
        Ok(configuration)
    }

    /// The phase of strokes, from the engine's equilibrium, in which the commanded cables are slack or hardly pulled.
    fn follow_strokes_from_here(&mut self, control: StepControl) -> Result<PathSummary, Stopped> {
        let bounds = self.options.snaps;
        let engine = &mut self.engine;
        engine.equations.hold_strokes();
        engine.set_phase(Phase::Stroke, 1.0);
        if engine.refresh().is_ok()
            && let Some(stroke_control) = engine.equations.stroke_control.clone()
        {
            let strokes = engine.strokes(stroke_control.cables.iter().copied());
            let all_slack = !stroke_control.taut.contains(&true);
            if all_slack
                && strokes.iter().enumerate().all(|(i, stroke)| *stroke >= engine.equations.command(&stroke_control, i))
            {
                // All stay slack.
                return Ok(PathSummary::default());
            }
            engine.equations.start_strokes_from(strokes);
        }
        follow_strokes(engine, control, bounds)
    }

    /// Tensions (N) of the cables that their commanded strokes take in a straight arm, and those given: with the
    /// strokes that unit tensions reel in there, T >= 0 and the slack >= 0, one of them zero, by sweeps over the
    /// cables.
    fn straight_tensions(&self, arm: &Arm) -> Vec<f64> {
        let equations = &self.engine.equations;
        let mut tensions: Vec<f64> =
            arm.cables.iter().map(|c| if c.stroke.is_some() { 0.0 } else { c.tension }).collect();
        let by = |a: usize, b: usize| arm.length * equations.straight_compliance(a, b) / equations.units.force;
        let commanded: Vec<(usize, f64, Vec<f64>)> = arm
            .cables
            .iter()
            .enumerate()
            .filter_map(|(c, cable)| {
                let mut row: Vec<f64> = (0..arm.cables.len()).map(|other| by(c, other)).collect();
                row[c] += cable.stiffness.map_or(0.0, |stiffness| cable.end * arm.length / stiffness);
                Some((c, cable.stroke?, row))
            })
            .collect();
        for _ in 0..SWEEPS {
            for (c, stroke, row) in &commanded {
                let reeled: f64 = row.iter().zip(&tensions).map(|(by, tension)| by * tension).sum();
                tensions[*c] = (tensions[*c] + (stroke - reeled) / row[*c]).max(0.0);
            }
        }
        tensions
    }
}

/// Whether a path of strokes did not get away from its start.
fn is_start(verdict: &Verdict) -> bool {
    verdict.phase == Phase::Stroke && verdict.kind == VerdictKind::NotFound && verdict.load_fraction < AWAY
}

/// The arm with other tensions (N) of its commanded cables.
fn with_tensions(arm: &Arm, tension: impl Fn(usize) -> f64) -> Arm {
    let mut out = arm.clone();
    for (c, cable) in out.cables.iter_mut().enumerate().filter(|(_, cable)| cable.stroke.is_some()) {
        cable.tension = tension(c);
    }
    out
}

/// The arm with its tensions in place of commands.
fn without_strokes(arm: &Arm) -> Arm {
    let mut out = arm.clone();
    for cable in out.cables.iter_mut().filter(|cable| cable.stroke.is_some()) {
        (cable.stroke, cable.max_tension) = (None, None);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statics::engine::Engine;
    use crate::statics::refinement::First;
    use crate::{Cable, Options, Profile};

    fn arm(strokes: [f64; 2], speed: f64, direction: f64) -> Arm {
        let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
        arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).reeled_in(strokes[0]));
        arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).reeled_in(strokes[1]));
        arm.flow.speed = speed;
        arm.flow.direction = direction;
        arm
    }

    /// The direct solve stands only where the path, followed closely, leads to the same shape.
    #[test]
    fn a_direct_solve_is_where_the_path_of_strokes_leads() {
        let (mut both, mut direct) = (0, 0);
        for strokes in [[0.004, -0.004], [0.012, -0.002], [0.008, 0.006], [-0.003, 0.015], [0.016, -0.030]] {
            for speed in [0.0, 0.1, 0.3] {
                for direction in [0.0, 1.2, 2.4, 3.0] {
                    let arm = arm(strokes, speed, direction);
                    let mut solver = Solver::new(&arm, Options::with_tol(1e-9)).unwrap();
                    let Ok(one) = solver.solve_strokes_directly(&arm) else { continue };
                    direct += 1;
                    let mut other = Solver::new(&arm, Options::with_tol(1e-9)).unwrap();
                    other.engine = Engine::new(&with_tensions(&arm, |_| 0.0));
                    other.solve_tensions().unwrap();
                    let control = StepControl { longest: 0.1, straightness: 0.99, most: 2000, accuracy: 1e-6 };
                    other.engine.equations.hold_strokes();
                    other.follow_strokes_from_here(control).map_err(|stopped| stopped.verdict).unwrap();
                    other.engine.settle(1e-9, First::Warm).unwrap();
                    let two = other.read(1e-9, PathSummary::default()).unwrap();
                    both += 1;
                    let off = (one.tip().x - two.tip().x).hypot(one.tip().y - two.tip().y) / arm.length;
                    assert!(off < 1e-7, "{strokes:?} m, {speed} m/s from {direction}: {off:e} L apart");
                    for (a, b) in one.cables.iter().zip(&two.cables) {
                        assert!((a.tension - b.tension).abs() < 1e-6, "{strokes:?}: {a:?} {b:?}");
                    }
                }
            }
        }
        println!("{direct} direct, {both} compared");
        assert!(both > 30, "{both}");
    }
}
