//! The engine of the plane, as paths lead to the loads of its arm.

use super::discrete::Engine;
use super::trouble::Trouble;
use crate::statics::dimensions::Guess;
use crate::statics::path::loaded::Loaded;
use crate::statics::shape::Tip;

impl Loaded for Engine {
    type Tip = Tip;
    type Guess = Guess;

    fn has_loads(&self) -> bool {
        self.equations.has_loads()
    }

    fn has_tension(&self) -> bool {
        self.equations.has_tension()
    }

    fn start_unloaded(&mut self) {
        self.start_unloaded(10);
    }

    fn hurry(&mut self, hurry: bool) {
        self.in_a_hurry = hurry;
    }

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

    fn measure(&mut self) -> Result<(), Trouble> {
        self.measure().map_err(Trouble::Section)
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
