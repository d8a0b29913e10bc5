//! The end of a motion and what it took, for people.

use std::fmt::Write as _;

use hydrostat::{Arm, CableMotion, Instant, SpatialInstant, Works};
use hydrostat_files::{EventOut, number};

use super::motion_output::Told;

/// Of a motion in the plane; `wall` is what it took, s.
pub(super) fn in_plane(arm: &Arm, at: &Instant, events: &[EventOut], told: &Told, wall: f64) -> String {
    let mut text = format!(
        "motion {}\n\nafter  {} s the tip is at ({}, {}) mm, turned by {} deg, and moves at {} m/s\n",
        arm.name,
        number(at.time),
        number(1e3 * at.tip[0]),
        number(1e3 * at.tip[1]),
        number(at.tip_theta.to_degrees()),
        number(at.tip_velocity[0].hypot(at.tip_velocity[1]))
    );
    add_cables(arm, &at.cables, &mut text);
    let base = at.base_reaction;
    let _ = writeln!(
        text,
        "base   reaction: force ({}, {}) N, moment {} N m",
        number(base.force[0]),
        number(base.force[1]),
        number(base.moment)
    );
    add_energies([at.kinetic_energy, at.strain_energy], &at.works, &mut text);
    add_end(at.time, events, told, wall, &mut text);
    text
}

/// Of a motion in space.
pub(super) fn in_space(arm: &Arm, at: &SpatialInstant, events: &[EventOut], told: &Told, wall: f64) -> String {
    let triple = |v: [f64; 3]| format!("({})", v.map(number).join(", "));
    let speed = at.tip_velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
    let mut text = format!(
        "motion {}\n\nafter  {} s the tip is at {} mm, its normal along {}, and moves at {} m/s\n",
        arm.name,
        number(at.time),
        triple([at.tip.x, at.tip.y, at.tip.z].map(|v| 1e3 * v)),
        triple(at.tip.a),
        number(speed)
    );
    add_cables(arm, &at.cables, &mut text);
    let base = at.base_reaction;
    let _ = writeln!(text, "base   reaction: force {} N, moment {} N m", triple(base.force), triple(base.moment));
    add_energies([at.kinetic_energy, at.strain_energy], &at.works, &mut text);
    add_end(at.time, events, told, wall, &mut text);
    text
}

/// The tip of the equilibrium of the last row (m), and how far from it the tip is and was at most, over the length.
pub(super) fn add_equilibrium(tip: &[f64], [distance, most]: [f64; 2], text: &mut String) {
    let _ = writeln!(
        text,
        "statics in equilibrium the tip would be at ({}) mm, {} of the length away; at most {} on the way",
        tip.iter().map(|v| number(1e3 * v)).collect::<Vec<_>>().join(", "),
        number(distance),
        number(most)
    );
}

fn add_cables(arm: &Arm, cables: &[CableMotion], text: &mut String) {
    for (cable, own) in arm.cables.iter().zip(cables) {
        let _ = writeln!(
            text,
            "cable  {}: tension {} N, stroke {} mm",
            cable.name,
            number(own.tension),
            number(1e3 * own.stroke)
        );
    }
}

fn add_energies([kinetic, strain]: [f64; 2], works: &Works, text: &mut String) {
    let all = [works.cables, works.water, works.gravity, works.loads, works.base, works.volume, works.dissipated];
    let largest = all.iter().fold(strain, |largest, work| largest.max(work.abs()));
    // What rounding leaves of nothing is nothing.
    let all = all.map(|work| number(if work.abs() < 1e-12 * largest { 0.0 } else { work }));
    let [cables, water, gravity, loads, own_base, volume, dissipated] = all;
    let _ = writeln!(
        text,
        "energy {} J kinetic, {} J of strain\n\
         work   {cables} J by cables, {water} by water, {gravity} by gravity, {loads} by loads, {own_base} by the base, \
         {volume} by changes of volume; {dissipated} dissipated",
        number(kinetic),
        number(strain),
    );
}

fn add_end(time: f64, events: &[EventOut], told: &Told, wall: f64, text: &mut String) {
    for event in events {
        let of = event.cable.map_or_else(String::new, |cable| format!(", cable {cable}"));
        let place = event.s.map_or_else(String::new, |s| format!(", s = {} m", number(s)));
        let _ = writeln!(text, "event  {} s: {}{of}{place}", number(event.time), event.kind);
    }
    let statistics = told.statistics;
    let _ = writeln!(
        text,
        "steps  {} in time, {} rejected, on {} elements, in {} s of computing: {} s of motion per second\n\
         error  about {} mm at the tip by the steps",
        statistics.steps,
        statistics.rejected,
        statistics.elements,
        number(wall),
        number(time / wall),
        number(1e3 * told.estimate)
    );
}
