//! The engine of space, as paths lead to the loads of its arm.

use super::engine::Engine;
use super::equations::Guess;
use super::tip::SpatialTip;
use crate::statics::engine::Trouble;
use crate::statics::path::loaded::Loaded;

impl Loaded for Engine {
    type Tip = SpatialTip;
    type Guess = Guess;

    fn has_loads(&self) -> bool {
        self.equations.has_loads()
    }

    fn has_tension(&self) -> bool {
        self.equations.has_tension()
    }

    fn start_unloaded(&mut self) {
        self.start_unloaded(8);
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

    fn tip(&self) -> Option<SpatialTip> {
        self.read_tip()
    }

    fn tip_place(&self) -> [f64; 3] {
        self.tip
    }

    fn measure(&mut self) -> Result<(), Trouble> {
        self.linearise()?;
        self.system.quadratures(&mut self.spans);
        self.tip = self.system.totals();
        Ok(())
    }

    fn spent(&self) -> Option<usize> {
        (self.work() >= self.allowed).then(|| self.work())
    }

    /// Not looked for: accuracy costs little.
    fn may_be_in_line(&mut self) -> bool {
        true
    }

    /// Loads in space do not jump.
    fn place_of_jump(&mut self) -> Option<f64> {
        None
    }
}
