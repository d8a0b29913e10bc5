//! A solved arm in a few lines for people.

use std::fmt::Write as _;

use hydrostat::{CableState, Configuration, NoEquilibrium, Pose, Stability, Statistics, Wrench};
use hydrostat_files::number;

use super::table::{counted, decimals};

/// What is known of the stability of `c`, in words.
pub(super) fn stability(c: &Configuration) -> Option<String> {
    let has_friction = || c.arm.cables.iter().any(|cable| cable.friction > 0.0);
    stability_in_words(c.stability(), c.stable)
        .or_else(|| has_friction().then(|| "stability is not established with friction".to_owned()))
}

/// What a count of unstable directions, or else what the solve came to know, says in words.
pub(super) fn stability_in_words(counted: Option<Stability>, known: Option<bool>) -> Option<String> {
    match (counted, known) {
        (Some(Stability::Stable), _) => Some("stable".to_owned()),
        (Some(Stability::Unstable(1)), _) => Some("UNSTABLE in 1 direction".to_owned()),
        (Some(Stability::Unstable(count)), _) => Some(format!("UNSTABLE in {count} directions")),
        (Some(Stability::Marginal), _) => Some("marginal: neither stable nor unstable".to_owned()),
        (None, Some(false)) => Some("UNSTABLE".to_owned()),
        (None, _) => None,
    }
}

/// What lies beyond the snap that was refused.
pub(super) fn beyond<C, T: Pose>(failure: &NoEquilibrium<C, T>, place: impl Fn(&C) -> String) -> Option<String> {
    let (snap, _) = (failure.snaps.last()?, failure.after_snap.as_ref()?);
    let leads = match &failure.at_full_loads {
        Some(shape) => {
            let place = place(shape);
            format!("the path continues to the full loads, with the tip at {place}; --follow-snaps gives that shape")
        }
        None => "the path does not continue to the full loads".to_owned(),
    };
    Some(format!("{}; {leads}", snap.message()))
}

pub(super) fn summary(c: &Configuration) -> String {
    let arm = &c.arm;
    let tip = c.tip();
    let mut out = String::new();
    let mm = |length: f64| decimals(1e3 * length, 4);
    let mut row = |name: &str, text: &str| {
        let _ = writeln!(out, "{name:<15}{text}");
    };
    let stability = stability(c).map_or_else(String::new, |words| format!(", {words}"));
    let stream = match arm.flow.speed {
        0.0 => "still water".to_owned(),
        speed => format!("stream {speed} m/s at {} deg", number(arm.flow.direction.to_degrees())),
    };
    row("arm", &format!("{}, {} mm, {stream}{stability}", arm.name, number(1e3 * arm.length)));
    row("tip", &format!("x {} mm, y {} mm, turned by {}", mm(tip.x), mm(tip.y), degrees(tip.theta)));
    row("tip section", &format!("alpha(L) {}", degrees(tip.alpha)));
    for (i, text) in cable_rows(&c.cables).into_iter().enumerate() {
        row(if i == 0 { "cables" } else { "" }, &text);
    }
    row("base reaction", &wrench(&c.base_reaction));
    if let Some(unmet) = &c.unmet {
        row("unmet at tip", &wrench(unmet));
    }
    let fold = c.fold_margin();
    // Of a flat minimum three digits can be told.
    let place = format!("{:.2e}", 1e3 * fold.s).parse().unwrap_or(1e3 * fold.s);
    row("fold margin", &format!("{:.3}, least at s = {place} mm (the surface folds at 0)", fold.value));
    row("tip error", &format!("about {:.1e} mm", 1e3 * c.error_estimate));
    row("work", &work(&c.statistics));
    out
}

/// What a solve took.
pub(super) fn work(s: &Statistics) -> String {
    format!(
        "{} elements of {} stages, {} on {}, {}, {} sections",
        s.elements,
        s.stages,
        counted(s.newton_rounds, "Newton round"),
        if s.meshes == 1 { "1 mesh".to_owned() } else { format!("{} meshes", s.meshes) },
        if s.load_steps == 0 { "no load steps".to_owned() } else { counted(s.load_steps, "load step") },
        s.evaluations
    )
}

/// A line a cable.
pub(super) fn cable_rows(cables: &[CableState]) -> Vec<String> {
    let widest = cables.iter().map(|cable| cable.name.chars().count()).max().unwrap_or(0);
    let row = |cable: &CableState| {
        let mut text = format!(
            "{:widest$}  tension {} N, length {:.3} mm, stroke {:.3} mm",
            cable.name,
            number(cable.tension),
            1e3 * cable.length,
            1e3 * cable.stroke + 0.0
        );
        if let Some(command) = cable.command.filter(|command| command.slack) {
            let _ = write!(
                text,
                " (slack: commanded stroke {:.3} mm, {:.3} mm of cable)",
                1e3 * command.stroke,
                1e3 * command.length
            );
        }
        text
    };
    cables.iter().map(row).collect()
}

fn wrench(w: &Wrench) -> String {
    format!("force ({}, {}) N, moment {} N m", signed(w.force[0]), signed(w.force[1]), signed(w.moment))
}

/// Five digits that matter, without the sign of a zero.
pub(super) fn signed(value: f64) -> String {
    number(if value.abs() < 1e-12 { 0.0 } else { value })
}

fn degrees(angle: f64) -> String {
    format!("{} deg", decimals(angle.to_degrees(), 4))
}
