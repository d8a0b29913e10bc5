//! What arms can move, their meshes, and the verdict on what cannot be done.

use hydrostat_bvp::Mesh;

use super::error::{MotionError, MotionVerdict, MotionVerdictKind};
use crate::rod::arm::Arm;
use crate::rod::model_options::{Support, Volume};
use crate::statics::equations::{Margins, SectionFailure};
use crate::statics::limit::limit_at;
use crate::statics::refinement::{Refinable, graded};
use crate::statics::verdict::VerdictKind;

/// The verdict on a step that cannot be done.
pub(super) fn not_found(time: f64, step: f64, failure: Option<SectionFailure>, arm: &Arm) -> MotionError {
    let near = failure.map(|SectionFailure { s, openness, nu, regularity }| Margins {
        openness: (openness, s),
        nu: (nu, s),
        regularity: (regularity, s),
    });
    let kind = match near.and_then(|near| limit_at(near, arm.model.volume)) {
        Some((VerdictKind::CableFold, _)) => MotionVerdictKind::CableFold,
        Some((VerdictKind::SectionCrushed, _)) => MotionVerdictKind::SectionCrushed,
        Some((VerdictKind::NoSectionSolution, _)) if has_short_waves(arm) => MotionVerdictKind::ShortWaves,
        Some((VerdictKind::NoSectionSolution, _)) => MotionVerdictKind::NoSectionSolution,
        _ => MotionVerdictKind::NotFound,
    };
    MotionError::Ended(MotionVerdict { kind, time, s: failure.map(|f| f.s * arm.length), step })
}

/// Whether the equations let short waves grow: a cable's pull has beta' in it where sections swell, which couples shear
/// and stretch by one derivative more than the stiffness has, and only a relaxation time damps by two.
fn has_short_waves(arm: &Arm) -> bool {
    let pulls = arm.cables.iter().any(|cable| cable.tension > 0.0 || cable.stroke.is_some());
    pulls && arm.model.volume != Volume::None && arm.dynamics.inertia && arm.dynamics.relaxation_time == 0.0
}

/// Elements for a tolerance. In water, kinks of the drag that move over the mesh bound what it can do, not modes: a
/// silicone arm that is let go in still water is off by 1.7e-4 L on 12 elements, by 2.6e-5 on 20 and by 1.5e-5 on 32.
pub(super) fn fair_elements(arm: &Arm, tol: f64) -> usize {
    let count = if tol >= 5e-4 {
        8
    } else if tol >= 5e-5 {
        20
    } else {
        32
    };
    if arm.flow.density == 0.0 { 8.min(count) } else { count }
}

/// A mesh that is finer where the arm is thin.
pub(super) fn mesh(arm: &Arm, elements: usize) -> Mesh {
    let breaks: Vec<f64> = arm.breaks().iter().map(|s| s / arm.length).collect();
    graded(arm, &breaks, elements)
}

/// Kinks nearer to each other than this fraction of a mean element have one node: the mesh stays while kinks move, and
/// an element much shorter than its neighbours leaves beta' there to rounding.
const APART: f64 = 0.2;

/// A mesh with nodes on the kinks that the stream's load has at the shape of the engine.
pub(super) fn mesh_at(engine: &mut impl Refinable, elements: usize) -> Mesh {
    let mut mesh = mesh(engine.arm(), elements);
    let mut kinks = engine.kinks(1e-6);
    kinks.sort_by(f64::total_cmp);
    kinks.dedup_by(|next, before| *next - *before < APART / mesh.elements() as f64);
    if kinks.len() <= mesh.elements() {
        mesh.pin(engine.breaks(), &kinks);
    }
    mesh
}

/// Refuses what cannot move.
pub(super) fn check(arm: &Arm) -> Result<(), MotionError> {
    arm.check()?;
    let refuse = |key: String, reason| Err(MotionError::Unsupported { key, reason });
    if arm.model.support == Support::UnstrainedBase {
        return refuse("model.support".to_owned(), "only a clamped arm can move");
    }
    if let Some(i) = arm.cables.iter().position(|c| c.friction > 0.0) {
        return refuse(
            format!("cable[{i}].friction"),
            "cables with friction stick as they turn back, which motion leaves out",
        );
    }
    if !arm.dynamics.inertia && arm.flow.density == 0.0 && arm.dynamics.relaxation_time == 0.0 {
        return refuse(
            "dynamics.inertia".to_owned(),
            "without inertia, water and relaxation time nothing resists the motion",
        );
    }
    if arm.dynamics.inertia && arm.density == 0.0 {
        return refuse("arm.density".to_owned(), "an arm without mass has no motion; set `dynamics.inertia = false`");
    }
    Ok(())
}

/// The force that bends the arm as a whole, N: the mean of EI over L^2, soft pieces (a hinge) foremost.
pub(super) fn force_unit(arm: &Arm) -> f64 {
    let mut at = vec![0.0];
    at.extend(arm.breaks());
    at.push(arm.length);
    // By Simpson's rule on eight parts between breaks.
    let soft = |s: f64| arm.stiffness_at(s)[2].recip();
    let sum = |ends: &[f64]| -> f64 {
        let h = (ends[1] - ends[0]) / 8.0;
        (0..8)
            .map(|k| ends[0] + f64::from(k) * h)
            .map(|s| h / 6.0 * (soft(s) + 4.0 * soft(s + 0.5 * h) + soft(s + h)))
            .sum()
    };
    let compliance: f64 = at.windows(2).map(sum).sum();
    (compliance * arm.length).recip()
}
