//! How much work a solve may be, counted so that every machine ends it at the same place.
//!
//! A piece of work is one evaluation of the section law and the loads at a station, more with many cables
//! ([`crate::Arm::cost_factor`]). All ways of a solve to its answer are finite in themselves, but meshes of an arm that
//! winds thousands of times through the stream are long, and rounds on them many.

use super::discrete::Engine;
use super::trouble::Trouble;

/// The work of one solve: some seconds.
pub(crate) const WORK: usize = 4_000_000;

impl Engine {
    /// Work done since [`Engine::allow`].
    pub(crate) fn work(&self) -> usize {
        self.done_beside + (self.system.evaluations + self.check.evaluations - self.worked_from) * self.equations.work()
    }

    /// Allows so much work from now on.
    pub(crate) fn allow(&mut self, work: usize) {
        (self.worked_from, self.done_beside) = (self.system.evaluations + self.check.evaluations, 0);
        self.allowed = work;
    }

    /// Goes on counting, and allows whatever is done from now on.
    pub(crate) fn lift_limit(&mut self) {
        self.allowed = usize::MAX;
    }

    /// What is left to be done.
    pub(crate) fn left(&self) -> usize {
        self.allowed.saturating_sub(self.work())
    }

    /// Counts work that another engine did for this one's solve.
    pub(crate) fn count_beside(&mut self, work: usize) {
        self.done_beside += work;
    }

    /// The work that was done, where that is all that was allowed.
    pub(crate) fn spent(&self) -> Option<usize> {
        (self.left() == 0).then(|| self.work())
    }

    /// Refuses to go on where nothing is left.
    pub(super) fn may_go_on(&self) -> Result<(), Trouble> {
        if self.left() == 0 { Err(Trouble::Spent) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::WORK;
    use crate::statics::path::small_steps::{Dice, random_arm};
    use crate::statics::solve::{Options, Solver};
    use crate::statics::verdict::{SolveError, VerdictKind};
    use crate::{Arm, Cable, Gravity, Profile};

    /// Arms that take every way to an answer: directly, along the path, by strokes, with friction, and to a limit.
    fn arms() -> Vec<Arm> {
        let mut plain = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
        plain.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.3));
        plain.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
        let mut stream = plain.clone();
        stream.flow.speed = 0.1;
        stream.flow.direction = 1.2;
        let mut reeled = stream.clone();
        reeled.cables[0] = Cable::new("left", Profile::linear(0.005, 0.001)).reeled_in(0.01);
        let mut with_friction = stream.clone();
        with_friction.cables[0].friction = 0.3;
        with_friction.gravity = Some(Gravity::default());
        let mut too_much = stream.clone();
        too_much.cables[0].tension = 40.0;
        vec![plain, stream, reeled, with_friction, too_much]
    }

    #[test]
    fn arms_of_every_day_take_a_small_part_of_what_is_allowed() {
        let mut dice = Dice(11);
        let mut most = 0;
        for _ in 0..100 {
            let mut solver = Solver::new(&random_arm(&mut dice), Options::default()).unwrap();
            let _ = solver.solve();
            most = most.max(solver.engine.work());
        }
        println!("at most {most} of {WORK}");
        assert!(most > 0 && most < WORK / 10, "{most}");
    }

    #[test]
    fn whatever_is_allowed_a_solve_ends_there_and_says_so() {
        let (mut spent, mut ended) = (0, 0);
        for arm in arms() {
            for work in [0, 1, 100, 1000, 3000, 10_000, 30_000, 100_000, 1_000_000] {
                let mut solver = Solver::new(&arm, Options::default()).unwrap();
                let solved = solver.solve_within(work);
                // The last evaluation is of a whole mesh, at stations and, for the check, at more of them; reading out
                // takes some.
                let done = solver.engine.work();
                assert!(done <= work + 8000, "{done} of {work}");
                match solved {
                    Err(SolveError::NoEquilibrium(no)) if no.verdict.spent.is_some() => {
                        let verdict = no.verdict;
                        assert!(verdict.spent >= Some(work), "{verdict:?}");
                        assert_eq!(verdict.kind, VerdictKind::NotFound);
                        let said = format!("in {} evaluations", verdict.spent.unwrap());
                        assert!(verdict.message().contains(&said), "{}", verdict.message());
                        spent += 1;
                    }
                    Ok(_) | Err(SolveError::NoEquilibrium(_)) => ended += 1,
                    Err(error) => panic!("{error}"),
                }
            }
        }
        assert!(spent >= 15 && ended >= 10, "{spent} spent, {ended} ended");
    }
}
