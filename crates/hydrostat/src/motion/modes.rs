//! Small motions about an equilibrium: rates and frequencies ([`super::small_motions`]).

use super::dimensions::X;
use super::error::MotionError;
use super::in_plane::{Planar, start_at_rest};
use super::mode::{Mode, NOTHING};
use super::mode_shapes::{ModeSection, ModeShape, TWINS, sections, shapes};
use super::settling::Settling;
use super::small_motions::{Vibrates, rates, spectrum};
use crate::rod::arm::Arm;

/// Rates within this fraction of -1/t_v are left out: they gather there without end, and are no motion of the arm but
/// its material that relaxes.
const RELAXATION: f64 = 0.02;

/// The slowest motions about an equilibrium, in the plane or in space.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes<T = [f64; 3]> {
    /// In order of frequency, those of one frequency by the size of their rates.
    pub modes: Vec<Mode>,
    /// The shape of each.
    pub shapes: Vec<ModeShape>,
    /// The equilibrium at the places of the shapes.
    pub sections: Vec<ModeSection>,
    /// The tip in the equilibrium: x, y (m) and theta (rad) in the plane.
    pub tip: T,
}

impl<T> Modes<T> {
    /// Whether no motion grows, of those found.
    pub fn is_stable(&self) -> bool {
        !self.modes.iter().any(Mode::grows)
    }
}

impl Arm {
    /// The `count` slowest motions about the equilibrium of this arm, by size of their rates, on a mesh of `elements`
    /// elements (8 are fine for some eight bending modes). The relaxation of the material itself, at -1/t_v, is not
    /// among them.
    ///
    /// ```
    /// use hydrostat::{Arm, Volume};
    ///
    /// let mut rod = Arm::cone(1.0, 0.001, 0.001, 1e9, 0.5); // m, Pa
    /// rod.model.volume = Volume::None;
    /// rod.flow.density = 0.0; // a vacuum
    /// let modes = rod.modes(3, 8)?;
    /// // omega = b^2 sqrt(E I/(rho A L^4)) with b = 1.8751041.
    /// let omega = 1.875_104_069_f64.powi(2) * (1e9 * 0.25e-6 / 1000.0_f64).sqrt();
    /// let found = 2.0 * std::f64::consts::PI * modes.modes[0].frequency();
    /// assert!((found / omega - 1.0).abs() < 1e-5, "{found} {omega}");
    /// assert!(modes.is_stable());
    /// # Ok::<(), hydrostat::MotionError>(())
    /// ```
    ///
    /// # Errors
    /// [`MotionError`] where there is no equilibrium, or the arm cannot move.
    pub fn modes(&self, count: usize, elements: usize) -> Result<Modes, MotionError> {
        let start = |arm: &Self| {
            let mut settling = Planar::new(arm);
            start_at_rest(&mut settling, arm, Some(elements), 1e-8, 0.0).map(|()| settling)
        };
        let (slowest, settling) = slowest(self, count, elements, start)?;
        let end = settling.solution.nodes[settling.solution.mesh.elements()];
        let length = self.length;
        Ok(slowest.with([end[X] * length, end[X + 1] * length, end[0]]))
    }
}

/// The slowest motions, before the tip is read.
pub(super) struct Slowest {
    modes: Vec<(Mode, ModeShape)>,
    sections: Vec<ModeSection>,
}

impl Slowest {
    pub(super) fn with<T>(self, tip: T) -> Modes<T> {
        let (modes, shapes) = self.modes.into_iter().unzip();
        Modes { modes, shapes, sections: self.sections, tip }
    }
}

/// The `count` slowest motions about the equilibrium in which `start` leaves the arm.
pub(super) fn slowest<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(
    arm: &Arm,
    count: usize,
    elements: usize,
    start: impl Fn(&Arm) -> Result<Settling<P, S, L>, MotionError>,
) -> Result<(Slowest, Settling<P, S, L>), MotionError> {
    if !(1..=64).contains(&elements) {
        return Err(MotionError::Option { option: "elements", value: elements as f64, expected: "in [1, 64]" });
    }
    if let Some(i) = arm.cables.iter().position(|cable| cable.stroke.is_some()) {
        let reason = "modes are those at given tensions: give the tension that `solve` finds";
        return Err(MotionError::Unsupported { key: format!("cable[{i}].stroke"), reason });
    }
    let mut settling = start(arm)?;
    let spectrum = spectrum(&mut settling)?;
    let time = arm.dynamics.relaxation_time;
    let mut modes: Vec<Mode> = rates(&spectrum, settling.moving.time_unit())
        .into_iter()
        .filter(|[re, im]| *im >= 0.0 && (re * time + 1.0).hypot(im * time) > RELAXATION)
        .map(|[re, im]| {
            let size = re.hypot(im);
            let swings = im > NOTHING * size;
            Mode { rate: [if re.abs() < 1e-12 * size { 0.0 } else { re }, if swings { im } else { 0.0 }] }
        })
        .collect();
    let size = |mode: &Mode| mode.rate[0].hypot(mode.rate[1]);
    modes.sort_by(|a, b| size(a).total_cmp(&size(b)));
    // The last one may have a twin.
    modes.truncate(count + 1);
    modes.sort_by(|a, b| a.frequency().total_cmp(&b.frequency()).then(size(a).total_cmp(&size(b))));
    let sections = sections(&settling);
    let shapes = shapes(&settling, &spectrum, &modes)?;
    let mut modes: Vec<(Mode, ModeShape)> = modes.into_iter().zip(shapes).collect();
    let largest = modes.iter().map(|(mode, _)| size(mode)).fold(0.0, f64::max);
    if modes.len() > count
        && let Some(last) = modes.iter().rposition(|(mode, _)| size(mode) >= (1.0 - TWINS) * largest)
    {
        modes.remove(last);
    }
    Ok((Slowest { modes, sections }, settling))
}
