//! What the source's text says about its figure, held against solved shapes.

use hydrostat::{Arm, Configuration, Volume};

use super::claim::{Claim, Finding};
use super::shapes::Study;
use super::solves::{RESOLUTION, SPEED, TIP_ANGLE, loaded, solved, speed, tension, tip_angle};
use crate::numbers::short;

const SAMPLES: u32 = 400;

pub(super) fn judge(study: &Study, arm: &Arm) -> Vec<Claim> {
    vec![
        more_tension(study),
        straight_tip(study),
        tip_rises(study),
        volume(study),
        less_deformed(study),
        tip_turns_less(study),
        grows_along(study),
        locally_smaller(study),
        fluid_matters(study),
        precision(study, arm),
    ]
}

/// How far the tip has left its place in the straight arm, mm.
fn deflection(c: &Configuration) -> f64 {
    let (tip, base) = (c.tip(), c.arm.base);
    let (sin, cos) = base.angle.sin_cos();
    1e3 * (tip.x - base.x - c.arm.length * cos).hypot(tip.y - base.y - c.arm.length * sin)
}

fn joined(values: impl Iterator<Item = String>) -> String {
    values.collect::<Vec<_>>().join(", ")
}

/// How many neighbours in `values` rise.
fn rising(values: &[f64]) -> usize {
    values.windows(2).filter(|w| w[1] > w[0]).count()
}

fn more_tension(study: &Study) -> Claim {
    let bend: Vec<f64> = study.raised.iter().map(|c| c.tip().theta.to_degrees()).collect();
    let off: Vec<f64> = study.raised.iter().map(deflection).collect();
    let held = rising(&bend) + rising(&off);
    Claim {
        statement: "The arm deforms more at higher tension of the cable (1a).",
        finding: Finding::of(held, 2 * (bend.len() - 1)),
        evidence: format!(
            "T1 = {} N: the tip is displaced by {} mm and turned by {} deg.",
            joined(study.raised.iter().map(|c| short(tension(c)))),
            joined(off.iter().map(|v| format!("{v:.1}"))),
            joined(bend.iter().map(|v| format!("{v:.1}"))),
        ),
    }
}

fn straight_tip(study: &Study) -> Claim {
    let angle = study.raised.first().map_or(f64::NAN, tip_angle);
    Claim {
        statement: "In the straight arm the tip section is perpendicular to the centreline, alpha(L) = 0.0 deg (1a).",
        finding: Finding::of(usize::from(angle.abs() < 1e-9), 1),
        evidence: format!("alpha(L) = {angle:.1} deg at T1 = 0 in the stream of {SPEED} m/s."),
    }
}

fn tip_rises(study: &Study) -> Claim {
    let angles: Vec<f64> = study.raised.iter().map(tip_angle).collect();
    Claim {
        statement: "alpha(L) rises gradually with the tension, to 72.25 deg at the highest (1a).",
        finding: Finding::of(rising(&angles), angles.len() - 1),
        evidence: format!(
            "alpha(L) = {} deg; {TIP_ANGLE} deg is reached at T1 = {:.2} N (the tension is not \
             published).",
            joined(angles.iter().map(|v| format!("{v:.2}"))),
            study.highest_tension(),
        ),
    }
}

fn volume(study: &Study) -> Claim {
    let shapes = || study.raised.iter().chain(&study.faster).chain(&study.faster_highest);
    let (mut off, mut widest, mut round) = (0.0_f64, 1.0_f64, 1.0_f64);
    for c in shapes() {
        for s in places(c) {
            let at = c.at(s);
            off = off.max((at.nu * at.beta - 1.0).abs());
            widest = widest.max(at.beta);
            round = round.max(at.nu * at.beta * at.beta);
        }
    }
    Claim {
        statement: "The radius adjusts along the arm so that the volume is preserved locally, det F = 1 (15).",
        finding: Finding::of(usize::from(off < 1e-9), 1),
        evidence: format!(
            "Mean of det F over a section, nu beta: 1 within {off:.0e}, with beta up to {widest:.2}. That is the planar \
             reading of (16); the volume of a round section, nu beta^2, grows up to {round:.2} times.",
        ),
    }
}

fn less_deformed(study: &Study) -> Claim {
    let bend: Vec<f64> = study.faster.iter().map(|c| c.tip().theta.to_degrees()).collect();
    let off: Vec<f64> = study.faster.iter().map(deflection).collect();
    let steps = bend.len() - 1;
    Claim {
        statement: "At a fixed tension the arm deforms less in a faster stream (1b).",
        finding: Finding::of(2 * steps - rising(&bend) - rising(&off), 2 * steps),
        evidence: format!(
            "T1 = {} N in {} m/s: the tip is displaced by {} mm and turned by {} deg.",
            short(study.faster.first().map_or(0.0, tension)),
            joined(study.faster.iter().map(|c| speed(c).to_string())),
            joined(off.iter().map(|v| format!("{v:.1}"))),
            joined(bend.iter().map(|v| format!("{v:.1}"))),
        ),
    }
}

fn tip_turns_less(study: &Study) -> Claim {
    let rows = study.rows();
    let angles: Vec<Vec<f64>> = rows.iter().map(|row| row.iter().map(tip_angle).collect()).collect();
    let steps: usize = angles.iter().map(|row| row.len() - 1).sum();
    let falls: usize = angles.iter().map(|row| row.windows(2).filter(|w| w[1] < w[0] - RESOLUTION).count()).sum();
    let words = |i: usize| {
        format!(
            "at {:.1} N {} deg",
            rows[i].first().map_or(0.0, tension),
            joined(angles[i].iter().map(|v| format!("{v:.3}")))
        )
    };
    Claim {
        statement: "Therefore the tip section turns less in a faster stream, alpha(L) (1b).",
        finding: Finding::of(falls, steps),
        evidence: format!(
            "In {} m/s: {}: no more than {:.3} deg apart, because nothing but the cable loads the tip section.",
            joined(study.faster.iter().map(|c| speed(c).to_string())),
            (0..rows.len()).map(words).collect::<Vec<_>>().join("; "),
            angles.iter().map(|row| spread(row)).fold(0.0, f64::max),
        ),
    }
}

fn spread(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - values.iter().copied().fold(f64::INFINITY, f64::min)
}

fn places(c: &Configuration) -> impl Iterator<Item = f64> + use<> {
    let length = c.arm.length;
    (0..=SAMPLES).map(move |k| length * f64::from(k) / f64::from(SAMPLES))
}

fn alphas(c: &Configuration) -> Vec<f64> {
    places(c).map(|s| c.at(s).alpha.to_degrees()).collect()
}

/// The fraction of `flags` that is set.
fn fraction(flags: impl Iterator<Item = bool>) -> f64 {
    let (set, all) = flags.fold((0u32, 0u32), |(set, all), flag| (set + u32::from(flag), all + 1));
    f64::from(set) / f64::from(all.max(1))
}

fn grows_along(study: &Study) -> Claim {
    let shapes = study.angle_configurations();
    let grown = |c: &Configuration| fraction(alphas(c).windows(2).map(|w| w[1] > w[0]));
    let grows: Vec<f64> = shapes.iter().map(|c| grown(c)).collect();
    let everywhere = grows.iter().filter(|g| **g == 1.0).count();
    let lots: Vec<String> = study
        .rows()
        .into_iter()
        .map(|row| {
            let percent = joined(row.iter().map(|c| format!("{:.0}", 100.0 * grown(c))));
            format!("{percent} % at {:.1} N", row.first().map_or(0.0, tension))
        })
        .collect();
    let in_all = shapes.iter().filter(|c| c.tip().alpha > c.at(0.0).alpha).count();
    Claim {
        statement: "The rotation angle alpha(s) grows along the arm (1c).",
        finding: if everywhere == 0 && grows.iter().any(|g| *g > 0.5) {
            Finding::InPart
        } else {
            Finding::of(everywhere, shapes.len())
        },
        evidence: format!(
            "It grows over this fraction of the length, in {} m/s: {}. From base to tip it grows in {in_all} of {}{}.",
            joined(study.faster.iter().map(|c| speed(c).to_string())),
            lots.join(", "),
            shapes.len(),
            if everywhere == shapes.len() { "" } else { "; near the base drag shears the section" },
        ),
    }
}

fn locally_smaller(study: &Study) -> Claim {
    let rows = study.rows();
    // For each tension how far alpha falls from each speed to the next, deg, at all places.
    let falls: Vec<Vec<Vec<f64>>> = rows
        .iter()
        .map(|row| {
            let angles: Vec<Vec<f64>> = row.iter().map(alphas).collect();
            angles.windows(2).map(|w| w[0].iter().zip(&w[1]).map(|(slow, fast)| slow - fast).collect()).collect()
        })
        .collect();
    // The fractions of the length over which it does.
    let fractions: Vec<Vec<f64>> =
        falls.iter().map(|row| row.iter().map(|fall| fraction(fall.iter().map(|d| *d > 0.0))).collect()).collect();
    let all = || fractions.iter().flatten();
    let least = falls.iter().flatten().flatten().copied().fold(f64::INFINITY, f64::min);
    let list = |i: usize| {
        let percent = joined(fractions[i].iter().map(|s| format!("{:.0}", 100.0 * s)));
        format!("{percent} % at {:.1} N", rows[i].first().map_or(0.0, tension))
    };
    let base = if least > 0.0 {
        format!("everywhere it falls by at least {least:.4} deg, and alpha(0) =")
    } else {
        "but at the base, where drag shears the section, alpha(0) =".to_owned()
    };
    let middles = joined(study.faster.iter().map(|c| format!("{:.2}", c.at(0.5 * c.arm.length).alpha.to_degrees())));
    let bases = joined(study.faster.iter().map(|c| format!("{:.2}", c.at(0.0).alpha.to_degrees())));
    Claim {
        statement: "alpha(s) is locally smaller for the faster stream (1c).",
        finding: if all().all(|s| *s == 1.0) {
            Finding::Holds
        } else if all().all(|s| *s == 0.0) {
            Finding::DoesNotHold
        } else {
            Finding::InPart
        },
        evidence: format!(
            "From each of {} m/s to the next it becomes smaller over this fraction of the length: {}. At {} N \
             alpha(L/2) = {middles} deg, {base} {bases} deg.",
            joined(study.faster.iter().map(|c| speed(c).to_string())),
            (0..rows.len()).map(list).collect::<Vec<_>>().join(", "),
            short(study.faster.first().map_or(0.0, tension)),
        ),
    }
}

/// How far apart the tips are, mm.
fn apart(a: &Configuration, b: &Configuration) -> f64 {
    let (a, b) = (a.tip(), b.tip());
    1e3 * (a.x - b.x).hypot(a.y - b.y)
}

fn fluid_matters(study: &Study) -> Claim {
    let still = &study.faster[0];
    let moved: Vec<f64> = study.faster[1..].iter().map(|c| apart(c, still)).collect();
    // Two percent of the length would be seen in any experiment.
    let limit = 20.0 * still.arm.length;
    Claim {
        statement: "It is of significant importance to account for the surrounding fluid (conclusion).",
        finding: Finding::of(moved.iter().filter(|m| **m > limit).count(), moved.len()),
        evidence: format!(
            "From still water to {} m/s the tip moves by {} mm at {} N; {limit:.0} mm (2 % of L) is taken as significant.",
            joined(study.faster[1..].iter().map(|c| speed(c).to_string())),
            joined(moved.iter().map(|v| format!("{v:.1}"))),
            short(tension(still)),
        ),
    }
}

fn precision(study: &Study, arm: &Arm) -> Claim {
    let planar = &study.faster[1];
    let mut round = loaded(arm, tension(planar), speed(planar));
    round.model.volume = Volume::Circular;
    let otherwise = match solved(&round, tension(planar), speed(planar)) {
        Ok(round) => format!("moves the tip by {:.1} mm", apart(planar, &round)),
        Err(_) => "leaves the arm without an equilibrium".to_owned(),
    };
    Claim {
        statement: "Free rotation and planar deformation of the section enhance the precision (conclusion).",
        finding: Finding::Open,
        evidence: format!(
            "The source has no measurement to be precise about. They do matter: at {} N the tip section stands at \
             alpha(L) = {:.1} deg, and a section that keeps its round volume instead {otherwise}.",
            short(tension(planar)),
            tip_angle(planar),
        ),
    }
}
