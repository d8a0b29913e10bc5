//! Shooting from the tip: with theta(L) given all conditions stand there, and the base's angle is a function of it.
//!
//! For arms whose beta' does nothing (no cable pulls and the stream acts by the centreline, or `none`), so that sections follow
//! from what is integrated alone; and for loads that leave the map from tip to base tame.

use hydrostat::{Arm, FlowSurface, Support, Volume};

use crate::march::{Motion, march};
use crate::mechanics::{Model, Place, Strains, advance};

/// Whether `arm` can be shot.
pub(crate) fn applies(arm: &Arm) -> bool {
    let pulled = arm.cables.iter().any(|cable| cable.tension > 0.0 || cable.stroke.is_some());
    let rubs = arm.cables.iter().any(|cable| cable.friction > 0.0);
    let lateral = arm.flow.speed > 0.0 && arm.model.flow_surface == FlowSurface::Lateral;
    let follows = arm.model.volume != Volume::None && (pulled || lateral);
    !follows && !rubs && arm.model.support == Support::Clamped
}

/// How fast the base may turn with the tip: beyond, other equilibria are too near in theta(L).
const STEEPEST: f64 = 300.0;

struct Backwards<'a> {
    model: &'a Model,
    tensions: Vec<f64>,
    /// Inside the present piece, which says which cables are there.
    inside: f64,
    strains: Strains,
    force: f64,
}

impl Backwards<'_> {
    fn section(&mut self, s: f64, y: &[f64; 6]) -> Option<(Place, Strains)> {
        let place = self.model.place(s, self.inside);
        let z = [y[0], y[1], y[2], y[3]];
        let strains = self.model.strains(&place, &self.tensions, z, 0.0, self.strains).ok()?;
        self.strains = strains;
        Some((place, strains))
    }
}

impl Motion<6> for Backwards<'_> {
    fn slopes(&mut self, s: f64, y: &[f64; 6]) -> Option<[f64; 6]> {
        let (place, e) = self.section(s, y)?;
        let z = [y[0], y[1], y[2], y[3]];
        let [theta, n1, n2, m] = self.model.slopes(&place, z, e, 0.0);
        let [x, y] = advance(z[0], e);
        Some([theta, n1, n2, m, x, y])
    }

    fn scale(&self, y: &[f64; 6]) -> [f64; 6] {
        let length = self.model.arm.length;
        let force = self.force.max(y[1].hypot(y[2]));
        [1.0, force, force, force * length, length, length]
    }

    fn switches(&mut self, s: f64, y: &[f64; 6]) -> Vec<f64> {
        let Some((place, e)) = self.section(s, y) else { return Vec::new() };
        self.model.switches(&place, y[0], e, 0.0)
    }

    fn lost(&self, y: &[f64; 6]) -> bool {
        y[0].is_nan() || y[0].abs() > 1e3
    }
}

/// Angle of the base, and the way from there to the tip, of the shape with theta(L) = `theta`.
fn shot(model: &Model, theta: f64, tol: f64) -> Option<[f64; 3]> {
    let length = model.arm.length;
    let [n1, n2, m] = model.tip_load(theta);
    let force = model.place(0.0, 0.0).stiffness[2] / (length * length);
    let tensions = model.arm.cables.iter().map(|cable| cable.tension).collect();
    let reference = model.place(length, length).reference;
    let mut motion = Backwards { model, tensions, inside: length, strains: reference, force };
    let mut y = [theta, n1, n2, m, 0.0, 0.0];
    let breaks = model.breaks();
    for piece in breaks.windows(2).rev() {
        motion.inside = 0.5 * (piece[0] + piece[1]);
        y = march(&mut motion, piece[1], piece[0], y, tol)?;
    }
    Some([y[0], -y[4], -y[5]])
}

/// Tip x, y and theta of the shape that ends at an angle near `guess`; `None` where shooting finds none there.
pub(crate) fn tip(arm: &Arm, guess: f64) -> Option<[f64; 3]> {
    let model = Model::new(arm);
    let base = &arm.base;
    let off = |theta: f64| shot(&model, theta, 1e-13).map(|end| end[0] - base.angle);
    let (mut old, mut new) = (guess, guess + 1e-4);
    let (mut before, mut here) = (off(old)?, off(new)?);
    if (here - before).abs() > STEEPEST * (new - old) {
        return None;
    }
    for _ in 0..40 {
        if here == before {
            break;
        }
        let next = new - here * (new - old) / (here - before);
        let next = new + (next - new).clamp(-0.3, 0.3);
        (old, before) = (new, here);
        new = next;
        here = off(new)?;
        if (new - old).abs() < 1e-13 * new.abs().max(1.0) || here == 0.0 {
            break;
        }
    }
    let [angle, x, y] = shot(&model, new, 1e-13)?;
    let arrived = (angle - base.angle).abs() < 1e-9 && (new - guess).abs() < 2e-3;
    arrived.then_some([base.x + x, base.y + y, new])
}
