//! The engine of space, as paths lead to the loads of its arm.

use super::engine::Engine;
use super::equations::Guess;
use super::path::SpatialSnap;
use super::tip::SpatialTip;
use crate::statics::path::loaded::Loaded;
use crate::statics::phase::Phase;

impl Loaded for Engine {
    type Tip = SpatialTip;
    type Snap = SpatialSnap;
    type Guess = Guess;

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

    fn snap(phase: Phase, load_fraction: f64, before: SpatialTip, after: SpatialTip) -> SpatialSnap {
        SpatialSnap { phase, load_fraction, before, after }
    }

    fn jump(snap: &SpatialSnap) -> [f64; 2] {
        [snap.distance(), snap.angle()]
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
