//! The engine of the plane, as paths lead to the loads of its arm.

use super::discrete::Engine;
use crate::statics::dimensions::Guess;
use crate::statics::path::loaded::Loaded;
use crate::statics::phase::Phase;
use crate::statics::shape::Tip;
use crate::statics::snap::Snap;

impl Loaded for Engine {
    type Tip = Tip;
    type Snap = Snap;
    type Guess = Guess;

    fn guess(&self) -> Guess {
        self.solution.clone()
    }

    fn take_guess(&mut self, guess: &Guess) {
        self.solution.clone_from(guess);
    }

    fn tip(&self) -> Option<Tip> {
        self.read_tip().ok()
    }

    fn tip_place(&self) -> [f64; 3] {
        let [x, y] = self.tip;
        [x, y, 0.0]
    }

    fn snap(phase: Phase, load_fraction: f64, before: Tip, after: Tip) -> Snap {
        Snap { phase, load_fraction, before, after }
    }

    fn jump(snap: &Snap) -> [f64; 2] {
        [snap.distance(), snap.angle()]
    }

    fn spent(&self) -> Option<usize> {
        self.spent()
    }

    fn may_be_in_line(&mut self) -> bool {
        self.is_in_line()
    }

    fn place_of_jump(&mut self) -> Option<f64> {
        self.nearest_switch()
    }
}
