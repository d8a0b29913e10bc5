//! The answer is the one that small steps along the path lead to, on random arms.

use super::*;
use crate::statics::solve::{Options, Solver};
use crate::{Arm, Cable, Gravity, Profile, SolveError};

/// Numbers in [0, 1) that are the same everywhere (Knuth's MMIX generator).
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(self.0 >> 32).unwrap()) / 4_294_967_296.0
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.roll()
    }

    fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
        let fraction = self.roll() * of.len() as f64;
        *of.iter().enumerate().find(|(i, _)| fraction < (*i + 1) as f64).unwrap().1
    }
}

pub(crate) fn random_arm(dice: &mut Dice) -> Arm {
    let length = dice.between(0.1, 0.4);
    let base = length * dice.between(0.03, 0.06);
    let tip = base * dice.between(0.1, 0.6);
    let young = 10_f64.powf(dice.between(4.0, 5.7));
    let mut arm = Arm::cone(length, base, tip, young, 0.5);
    arm.density = dice.between(1000.0, 1150.0);
    let fraction = dice.between(0.4, 0.8);
    let most = 0.05 * young * std::f64::consts::PI * tip * tip;
    let tension = most * dice.between(0.0, 1.5);
    arm.cables.push(Cable::new("left", Profile::linear(fraction * base, fraction * tip)).pulled(tension));
    arm.cables.push(Cable::new("right", Profile::linear(-fraction * base, -fraction * tip)));
    arm.flow.speed = dice.between(0.0, 1.0);
    arm.flow.direction = dice.one_of(&[0.0_f64, 60.0, 90.0, 180.0]).to_radians();
    arm.gravity = dice.one_of(&[None, Some(Gravity::default())]);
    arm
}

/// The answer is the one that small steps of arclength lead to.
fn compare(count: usize) {
    const SMALL: StepControl = StepControl { longest: 0.05, straightness: 0.995, most: 30_000, accuracy: 1e-7 };
    let mut dice = Dice(7);
    let (mut solved, mut verdicts, mut direct) = (0, 0, 0);
    let mut wrong = Vec::new();
    for case in 0..count {
        let arm = random_arm(&mut dice);
        let ours = Solver::new(&arm, Options::default()).unwrap().solve();
        let truth = Solver::new(&arm, Options::default()).unwrap().solve_along_the_path(SMALL);
        match (ours, truth) {
            (Ok(ours), Ok(truth)) => {
                solved += 1;
                direct += usize::from(ours.statistics.load_steps == 0);
                let (a, b) = (ours.tip(), truth.tip());
                if (a.x - b.x).hypot(a.y - b.y) > 1e-5 * arm.length {
                    wrong.push(format!("{case}: tips {a:?} and {b:?}, {} load steps", ours.statistics.load_steps));
                }
            }
            (Err(SolveError::NoEquilibrium(ours)), Err(SolveError::NoEquilibrium(truth))) => {
                verdicts += 1;
                let (a, b) = (ours.verdict, truth.verdict);
                if a.kind != b.kind || a.phase != b.phase || (a.load_fraction - b.load_fraction).abs() > 0.01 {
                    wrong.push(format!("{case}: {a:?} and {b:?}"));
                }
            }
            (ours, truth) => {
                let say = |r: Result<crate::Configuration, SolveError>| match r {
                    Ok(c) => format!("{:?} after {} load steps", c.tip(), c.statistics.load_steps),
                    Err(e) => e.to_string(),
                };
                wrong.push(format!("{case}: {} and {}", say(ours), say(truth)));
            }
        }
    }
    println!("{count} arms: {solved} solved ({direct} directly), {verdicts} verdicts, {} differ", wrong.len());
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn answers_are_those_of_small_steps() {
    compare(40);
}

#[test]
#[ignore = "takes most of a minute"]
fn slow_answers_are_those_of_small_steps_on_600_arms() {
    compare(600);
}
