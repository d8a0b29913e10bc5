//! Solvers that follow an arm along a line from one sequence of loads to another, and which loads these may be.

use super::landing::{Lands, PAST};
use crate::rod::arm::Arm;
use crate::rod::parameter::{IN_SPACE, PLAIN, Parameter};
use crate::spatial::SpatialSolver;
use crate::spatial::engine::Engine as SpatialEngine;
use crate::statics::engine::Engine;
use crate::statics::equations::Change;
use crate::statics::path::loaded::Loaded;
use crate::statics::path::traced::Traced;
use crate::statics::snap::SnapBounds;
use crate::statics::solve::{Options, Solver};
use crate::statics::verdict::{Phase, SolveError};

/// The shapes of a solver, their tips, and why there is none.
pub(super) type ShapeOf<S> = <<S as Ranged>::Engine as Traced>::Shape;
pub(super) type TipOf<S> = <<S as Ranged>::Engine as Loaded>::Tip;
pub(super) type ErrorOf<S> = SolveError<ShapeOf<S>, TipOf<S>>;

/// Every snap ends a path: its motion is followed.
pub(super) const EVERY_SNAP: SnapBounds = SnapBounds { distance: 0.0, angle: 0.0 };

/// A solver in the plane or in space.
pub(super) trait Ranged: Clone {
    type Engine: Lands;

    fn new(arm: &Arm, options: Options) -> Result<Self, ErrorOf<Self>>;
    fn arm(&self) -> &Arm;
    fn engine_mut(&mut self) -> &mut Self::Engine;
    fn take_place_of_base(&mut self, arm: &Arm);
    /// Lets several parameters run together, from where they are.
    fn vary_together(&mut self, ways: Vec<Change>);
    /// The equilibrium of the arm, from nothing.
    fn solve(&mut self) -> Result<ShapeOf<Self>, ErrorOf<Self>>;
    /// Follows the path on to whole loads from the engine's equilibrium at a fraction of a phase.
    fn solve_on(&mut self, from: (Phase, f64)) -> Result<ShapeOf<Self>, ErrorOf<Self>>;
    /// The engine's equilibrium, read again.
    fn resettle(&mut self) -> Result<ShapeOf<Self>, ErrorOf<Self>>;
    /// Follows the range from the engine's equilibrium at a fraction of it, behind a limit point down to a lowest one.
    fn along_range(&mut self, from: [f64; 2]) -> Result<ShapeOf<Self>, ErrorOf<Self>>;

    /// A solver that holds a configuration of `arm`.
    fn at(arm: &Arm, configuration: &ShapeOf<Self>, tol: f64) -> Result<Self, ErrorOf<Self>> {
        let mut solver = Self::new(arm, Options { snaps: EVERY_SNAP, ..Options::with_tol(tol) })?;
        solver.engine_mut().take(configuration);
        Ok(solver)
    }
}

/// What both solvers have under the same names.
macro_rules! alike {
    () => {
        fn new(arm: &Arm, options: Options) -> Result<Self, ErrorOf<Self>> {
            Self::new(arm, options)
        }

        fn arm(&self) -> &Arm {
            self.arm()
        }

        fn engine_mut(&mut self) -> &mut Self::Engine {
            self.engine_mut()
        }

        fn vary_together(&mut self, ways: Vec<Change>) {
            self.engine_mut().equations.vary_together(ways);
        }

        fn solve(&mut self) -> Result<ShapeOf<Self>, ErrorOf<Self>> {
            self.solve()
        }

        fn solve_on(&mut self, from: (Phase, f64)) -> Result<ShapeOf<Self>, ErrorOf<Self>> {
            self.solve_on(from)
        }

        fn resettle(&mut self) -> Result<ShapeOf<Self>, ErrorOf<Self>> {
            self.resettle()
        }

        fn along_range(&mut self, from: [f64; 2]) -> Result<ShapeOf<Self>, ErrorOf<Self>> {
            self.solve_along_range(from)
        }
    };
}

impl Ranged for Solver {
    type Engine = Engine;

    alike!();

    fn take_place_of_base(&mut self, arm: &Arm) {
        let own = &mut self.engine_mut().equations.arm.base;
        (own.x, own.y) = (arm.base.x, arm.base.y);
    }
}

impl Ranged for SpatialSolver {
    type Engine = SpatialEngine;

    alike!();

    fn take_place_of_base(&mut self, arm: &Arm) {
        self.engine_mut().equations.take_place_of_base(arm);
    }
}

/// The loads of an arm that may change, those of its first `cables` cables.
fn loads(arm: &Arm, cables: usize) -> impl Iterator<Item = Parameter> {
    let of_cables = (0..cables).flat_map(|c| [Parameter::Tension(c), Parameter::Stroke(c)]);
    let plain = PLAIN.into_iter().chain(IN_SPACE).filter(|parameter| parameter.may_be_led());
    of_cables.chain(plain).chain(Parameter::of_distributed(arm))
}

/// What changes from one arm to another of the same kind.
pub(super) fn ways(own: &Arm, arm: &Arm) -> Result<Vec<Change>, (String, &'static str)> {
    let mut moved = own.clone();
    let mut out = Vec::new();
    for parameter in loads(own, arm.cables.len().min(own.cables.len())) {
        let commanded = |c: usize| own.cables[c].stroke.is_some();
        let acts = match parameter {
            Parameter::Tension(c) => !commanded(c),
            Parameter::Stroke(c) => commanded(c) && arm.cables[c].stroke.is_some(),
            Parameter::GravityAcceleration | Parameter::GravityDirection => {
                own.gravity.is_some() && arm.gravity.is_some()
            }
            _ => true,
        };
        // An angle and the parts of its direction are one load.
        let (Ok(from), Ok(to)) = (parameter.of(&moved), parameter.of(arm)) else { continue };
        if acts && from != to {
            out.push(Change { parameter, from, to });
            // It is a load of this arm.
            let _ = parameter.set(&mut moved, to);
        }
    }
    (moved.base.x, moved.base.y) = (arm.base.x, arm.base.y);
    if let (Some(space), Some(other)) = (&mut moved.space, &arm.space) {
        space.z = other.z;
    }
    for (own, other) in moved.cables.iter_mut().zip(&arm.cables) {
        // Tensions of cables whose strokes are commanded follow from these.
        if own.stroke.is_some() && other.stroke.is_some() {
            own.tension = other.tension;
        }
    }
    if moved == *arm {
        return Ok(out);
    }
    let key = if moved.cables.iter().zip(&arm.cables).any(|(a, b)| a.stroke.is_some() != b.stroke.is_some()) {
        "cable.stroke"
    } else if moved.gravity.is_some() != arm.gravity.is_some() {
        "gravity"
    } else {
        "arm"
    };
    let reason = "only tensions or strokes of the same cables, stream, gravity, loads on the tip and along the arm, and \
                  the base may change";
    Err((key.to_owned(), reason))
}

/// The fraction of the way, at most 0, down to which the curve behind a limit point is followed: there the first load
/// that is not negative is nothing.
pub(super) fn lowest(ways: &[Change]) -> f64 {
    /// How many ways back is far enough.
    const FAR: f64 = -100.0;
    let own = |way: &Change| match way.parameter {
        Parameter::Tension(_) | Parameter::FlowSpeed | Parameter::GravityAcceleration if way.to > way.from => {
            -way.from / (way.to - way.from)
        }
        _ => FAR,
    };
    ways.iter().map(own).fold(FAR, f64::max).min(0.0)
}

/// The fraction of the way by which loads are past a limit point while the arm moves: [`PAST`] of the largest load that
/// changes, so that it does not hang on how finely the way is cut.
pub(super) fn past(ways: &[Change]) -> f64 {
    let own = |way: &Change| {
        let size = match way.parameter {
            // Angles and parts of directions have no size.
            Parameter::FlowDirection
            | Parameter::GravityDirection
            | Parameter::BaseAngle
            | Parameter::StreamAlong(_)
            | Parameter::GravityAlong(_)
            | Parameter::BaseAlong(_)
            | Parameter::SectionAlong(_) => 1.0,
            _ => way.from.abs().max(way.to.abs()),
        };
        PAST * size / (way.to - way.from).abs()
    };
    ways.iter().map(own).fold(f64::INFINITY, f64::min)
}
