//! Arms at random: what is answered is an equilibrium of the equations written out anew, as near as it says.

use std::collections::BTreeMap;

use hydrostat::Arm;
use rayon::prelude::*;

use crate::arms::{Draw, arm};
use crate::judge::{Judged, Outcome, judge, phase_is_there};
use crate::shooting;

fn number(key: &str, default: u64) -> u64 {
    std::env::var(key).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// Solves and judges the arms of seeds; HYDROSTAT_ARMS_FROM is the first.
fn judged(count: u64, draw: &Draw) -> Vec<(u64, Arm, Outcome)> {
    let from = number("HYDROSTAT_ARMS_FROM", 0);
    println!("{count} arms from the seed {from}: HYDROSTAT_ARMS_FROM begins elsewhere");
    (from..from + count)
        .into_par_iter()
        .map(|seed| {
            let arm = arm(seed, draw);
            let outcome = judge(&arm, 1e-8);
            (seed, arm, outcome)
        })
        .collect()
}

/// Of which kind an arm is, for how well its answers are known.
fn kind(arm: &Arm) -> &'static str {
    let pulled = |own: &hydrostat::Cable| own.tension > 0.0 || own.stroke.is_some();
    let tip = arm.radius.at(arm.length, arm.length).value;
    if arm.cables.iter().any(|cable| cable.friction > 0.0 && pulled(cable)) {
        "friction"
    } else if arm.model.load_can_jump() && arm.flow.speed > 0.0 {
        "jumps"
    } else if tip < 5e-3 * arm.radius.at(0.0, arm.length).value {
        "pointed"
    } else if arm.cables.iter().any(|cable| cable.stroke.is_some()) {
        "strokes"
    } else {
        "plain"
    }
}

/// Counts by kind of arm and what became of it; what is wrong is printed, and written to the directory HYDROSTAT_FINDINGS.
fn tell(cases: &[(u64, Arm, Outcome)], times: f64) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for (seed, arm, outcome) in cases {
        let kind = kind(arm);
        let (what, words) = match outcome {
            Outcome::Answered(own) if !own.is_known(times) => ("open", Some(line(own))),
            Outcome::Answered(own) if !own.is_within(times) => ("off", Some(line(own))),
            Outcome::Answered(_) => ("right", None),
            Outcome::Refused(verdict) if !phase_is_there(arm, verdict.phase) => {
                ("empty phase", Some(verdict.message()))
            }
            Outcome::Refused(verdict) => {
                let lost = verdict.kind == hydrostat::VerdictKind::NotFound;
                (verdict.kind.name(), lost.then(|| verdict.message()))
            }
            Outcome::NoArm(error) => ("no arm", Some(error.clone())),
        };
        *counts.entry(format!("{kind}: {what}")).or_insert(0) += 1;
        if let Some(words) = words {
            println!("seed {seed}, {kind}, {what}: {words}");
            if let Ok(directory) = std::env::var("HYDROSTAT_FINDINGS") {
                let text = format!("# seed {seed}, {kind}, {what}: {words}\n{}", hydrostat_files::arm_to_toml(arm));
                std::fs::write(format!("{directory}/{}-{seed}.toml", what.replace(' ', "-")), text)
                    .expect("a directory to write to");
            }
        }
    }
    for (what, count) in &counts {
        println!("{count:6} {what}");
    }
    counts
}

fn line(own: &Judged) -> String {
    let off = own.off.map_or("no equilibrium beside it".to_owned(), |off| format!("off by {off:.1e} L"));
    format!("{off}, estimate {:.1e} L, known to {:.1e} L", own.estimate, own.doubt)
}

fn count(counts: &BTreeMap<String, usize>, what: &str) -> usize {
    counts.get(what).copied().unwrap_or(0)
}

/// 300 arms of every option. What an answer misses the equations by moves its tip by no more than three times its estimate:
/// no exception where nothing rubs, jumps or is commanded, and no tip is pointed. Of all kinds, some ten are off by more or
/// not known well enough to say, two of them by more than the tolerance (one pointed, one whose load jumps on its lateral
/// surface), and some ten are lost: pointed ones, streams of 30 to 190 m/s, bases without strains, a cable that rubs.
#[test]
fn answers_are_equilibria_of_the_equations_written_out_anew() {
    let cases = judged(number("HYDROSTAT_ARMS", 300), &Draw::ALL);
    let counts = tell(&cases, 3.0);
    assert_eq!(count(&counts, "plain: off") + count(&counts, "plain: open"), 0);
    assert!(count(&counts, "plain: right") > 80 * cases.len() / 300 && count(&counts, "friction: right") > 0);
    let ending = |ends: &[&str]| -> usize {
        counts.iter().filter(|(what, _)| ends.iter().any(|end| what.ends_with(end))).map(|(_, count)| count).sum()
    };
    let (wrong, lost) = (ending(&[": off", ": open"]), ending(&["not_found", "empty phase", "no arm"]));
    assert!(wrong * 20 <= cases.len() && lost * 20 <= cases.len(), "{wrong} are off, {lost} are lost");
    // Whatever the kind, what every place must meet by itself is met.
    for (seed, arm, outcome) in &cases {
        let Outcome::Answered(own) = outcome else { continue };
        let off = &own.residuals;
        assert!(off.law < 1e-6 && off.volume < 1e-12, "seed {seed}: {off:?}");
        if kind(arm) == "strokes" {
            assert!(off.command < 1e-8, "seed {seed}: {off:?}");
        }
    }
    // Sums over the shape between the nodes.
    let far = between_nodes(&cases);
    assert!(far.len() * 20 < cases.len(), "{}", far.join("\n"));
}

/// Plain arms whose shape between the nodes is not as good as at them.
fn between_nodes(cases: &[(u64, Arm, Outcome)]) -> Vec<String> {
    let far = |(seed, arm, outcome): &(u64, Arm, Outcome)| {
        let Outcome::Answered(own) = outcome else { return None };
        let off = &own.residuals;
        let met = off.place < 3.0 * own.estimate + 1e-7 && off.stroke < 3.0 * own.estimate + 1e-7;
        let balanced = off.balance < 1e-6 && off.reaction < 1e-6 && off.unmet < 1e-6;
        (kind(arm) == "plain" && !(met && balanced)).then(|| format!("seed {seed}: {off:?}"))
    };
    cases.iter().filter_map(far).collect()
}

/// Where shooting from the tip applies it arrives at the same tip.
#[test]
fn answers_agree_with_shooting_from_the_tip() {
    let draw = Draw { extreme: 1.5, friction: false, strokes: false, jumps: false };
    let from = number("HYDROSTAT_ARMS_FROM", 0);
    let off: Vec<(u64, f64, f64)> = (from..from + number("HYDROSTAT_ARMS", 300))
        .into_par_iter()
        .filter_map(|seed| {
            let mut arm = arm(seed, &draw);
            if seed % 2 == 0 {
                arm.cables.clear();
            }
            if !shooting::applies(&arm) || kind(&arm) == "pointed" {
                return None;
            }
            let solved = arm.solve().ok()?;
            let tip = solved.tip();
            // From an angle that has forgotten most of the answer's digits.
            let shot = shooting::tip(&arm, (tip.theta * 1e3).round() / 1e3)?;
            let off = (shot[0] - tip.x).hypot(shot[1] - tip.y) / arm.length;
            Some((seed, off, solved.error_estimate / arm.length))
        })
        .collect();
    println!("{} arms were shot", off.len());
    assert!(off.len() > 60);
    for (seed, off, estimate) in off {
        assert!(off < 3.0 * estimate + 1e-10, "seed {seed}: off by {off:.1e} L, estimate {estimate:.1e} L");
    }
}
