//! `hydrostat reach`: the tensions that bring the arm to a place.

use std::path::Path;

use hydrostat::{Arm, Bound, CableState, Reach, Reached, SpatialTarget, Target};
use hydrostat_figures::{reach_figure, spatial_arm_figure};
use hydrostat_files::number;

use super::shape::Shape;
use super::slip;
use super::table::{distance_cell, stability_words, table};
use super::targets::{far_off, options};
use super::{Advised, NoAnswer};
use super::{boundary, follow};
use crate::args::{By, Direction, Format, Point, ReachArgs};
use crate::input;
use crate::output;
use crate::request::{self, WrongRequest};

pub(crate) fn run(args: &ReachArgs) -> anyhow::Result<()> {
    if args.arm.tension.is_some() && args.path.is_none() {
        return Err(WrongRequest::TensionsAreFound.into());
    }
    input::check_once(&[("ARM", Some(Path::new(&args.arm.file))), ("--path", args.path.as_deref())])?;
    let arm = request::arm_in_space(&args.arm)?;
    slip::warn_of_bound(&arm, args.max_tension);
    let inputs = [request::arm_input(&args.arm.file), args.path.as_deref().map(|path| ("--path", input::source(path)))];
    request::check_outputs(&inputs, &[("-o", args.output.as_deref()), ("--plot", args.plot.as_deref())])?;
    request::check_picture(&args.picture, &[("--plot", args.plot.as_deref())])?;
    let (x, y) = match (args.target, &args.path, arm.space.is_some()) {
        (Some(Point::Space(place)), _, true) => return in_space(&arm, place, args),
        (Some(Point::Plane(_)), _, true) => return Err(WrongRequest::Coordinates { in_space: true }.into()),
        (Some(Point::Space(_)), _, false) => return Err(WrongRequest::Coordinates { in_space: false }.into()),
        (None, Some(_), true) => return Err(WrongRequest::NotInSpace("--path", "give one --target X,Y,Z").into()),
        (None, None, true) => {
            let instead = "`sweep` and `plot --workspace` draw a cloud of tips";
            return Err(WrongRequest::NotInSpace("--boundary", instead).into());
        }
        (None, Some(path), false) => return follow::run(&arm, path, args),
        (None, None, false) => return boundary::run(&arm, args),
        (Some(Point::Plane([x, y])), _, false) => (x, y),
    };
    if args.direction.is_some() {
        return Err(WrongRequest::OnlyInSpace("--direction", "--angle is for arms in the plane").into());
    }
    let target = Target { s: args.station, angle: args.angle, ..Target::tip(x, y) };
    let options = options(args);
    let found = match args.by {
        By::Tensions => arm.reach(&[target], &options)?,
        By::Strokes => arm.reach_by_strokes(&[target], &options)?,
    };
    let best = found.solutions.first().or(found.closest.as_ref());
    if let (Some(file), Some(best)) = (&args.plot, best) {
        let note = found.closest.as_ref().map(|closest| miss(&arm, closest));
        let figure = reach_figure(&best.configuration, &[[x, y]], note.as_deref(), &args.picture.page());
        output::draw(&figure, file, &args.picture.page)?;
    }
    report(&arm, &found, far_off(&arm, &target), args)
}

/// A target of an arm in space.
fn in_space(arm: &Arm, place: [f64; 3], args: &ReachArgs) -> anyhow::Result<()> {
    if args.angle.is_some() {
        return Err(WrongRequest::NotInSpace("--angle", "give --direction X,Y,Z of the normal a").into());
    }
    let direction = args.direction.map(|Direction(direction)| direction);
    let target = SpatialTarget { s: args.station, direction, ..SpatialTarget::tip(place) };
    let options = options(args);
    let found = match args.by {
        By::Tensions => arm.reach_in_space(&[target], &options)?,
        By::Strokes => arm.reach_in_space_by_strokes_while(&[target], &options, || true)?,
    };
    let best = found.solutions.first().or(found.closest.as_ref());
    if let (Some(file), Some(best)) = (&args.plot, best) {
        let note = found.closest.as_ref().map(|closest| miss(arm, closest));
        let figure = spatial_arm_figure(&best.configuration, note.as_deref(), &args.picture.page());
        output::draw(&figure, file, &args.picture.page)?;
    }
    report(arm, &found, None, args)
}

/// Writes what was found; `advice` on a target that is out of reach.
fn report<C: Shape>(
    arm: &Arm,
    found: &Reach<C, C::Place>,
    advice: Option<String>,
    args: &ReachArgs,
) -> anyhow::Result<()> {
    let text = match args.format {
        Format::Text => summary(arm, found, args.station, args.by),
        Format::Json => output::line(C::reach_document(arm, found).to_json()),
        Format::Csv => C::reach_csv(arm.cables.len(), found),
    };
    output::put(args.output.as_deref(), &text)?;
    match &found.closest {
        Some(closest) => {
            let bounds: Vec<String> = closest.bounds.iter().map(|bound| bound_words(arm, *bound)).collect();
            let why = if bounds.is_empty() { String::new() } else { format!("; {}", bounds.join(", ")) };
            let fixed = if args.station.is_some_and(|s| s <= 0.0) { "; the base cannot move" } else { "" };
            let error = NoAnswer(format!("the target is not reached: {}{why}{fixed}", miss(arm, closest)));
            Err(Advised::with(error, advice.or_else(|| just_missed(closest))))
        }
        None => Ok(()),
    }
}

/// By how much the closest misses.
fn miss<C, P>(arm: &Arm, closest: &Reached<C, P>) -> String {
    format!("the closest shape that was found is {} mm away", number(1e3 * closest.distance * arm.length))
}

/// Misses up to this, over L, are those of a target that was rounded.
const ROUNDED: f64 = 1e-4;

/// What to try where a target is missed by little.
fn just_missed<C, P>(closest: &Reached<C, P>) -> Option<String> {
    let missed = closest.distance;
    (missed <= ROUNDED).then(|| {
        format!(
            "--tol 1e{:.0}: the target is missed by {missed:.1e} of the length (for a target angle, one radian counts as one length)",
            missed.log10().ceil()
        )
    })
}

/// The stroke to command, m.
fn stroke(cable: &CableState) -> f64 {
    cable.command.map_or(cable.stroke, |command| command.stroke)
}

fn bound_words(arm: &Arm, bound: Bound) -> String {
    match bound {
        Bound::Slack(c) => format!("cable {} is slack and cannot push", arm.cables[c].name),
        Bound::Most(c) => format!("cable {} is at its largest tension", arm.cables[c].name),
        Bound::Stroke(c) => format!("cable {} is at its largest stroke", arm.cables[c].name),
    }
}

fn summary<C: Shape>(arm: &Arm, found: &Reach<C, C::Place>, station: Option<f64>, by: By) -> String {
    let place = station.map_or_else(String::new, |s| format!(" for the station at s = {} mm", number(1e3 * s)));
    let mut out = match found.solutions.len() {
        0 => format!("{}: not reached{place}; the closest shape is\n\n", arm.name),
        1 => format!("{}: 1 solution{place}\n\n", arm.name),
        count => format!("{}: {count} solutions{place}, least effort first\n\n", arm.name),
    };
    let mut head: Vec<String> = arm.cables.iter().map(|cable| format!("{} (N)", cable.name)).collect();
    if by == By::Strokes {
        head.extend(arm.cables.iter().map(|cable| format!("{} (mm)", cable.name)));
    }
    head.push("effort (N2)".to_owned());
    match station {
        None => head.extend(C::TIP.map(str::to_owned)),
        Some(_) => head.extend(["place ", "tip "].iter().flat_map(|of| C::TIP.map(|name| format!("{of}{name}")))),
    }
    head.push("distance (mm)".to_owned());
    head.extend(["stability", "given by solve"].map(str::to_owned));
    let mut rows = vec![head];
    for one in found.solutions.iter().chain(&found.closest) {
        let mut row: Vec<String> = one.tensions.iter().map(|t| number(*t)).collect();
        if by == By::Strokes {
            row.extend(one.configuration.cables().iter().map(|cable| number(1e3 * stroke(cable))));
        }
        row.push(number(one.effort));
        for place in &one.places {
            row.extend(C::place_cells(place));
        }
        row.extend(one.configuration.tip_cells());
        row.push(distance_cell(one.distance * arm.length));
        row.push(stability_words(one.stability));
        row.push(if one.on_the_path { "yes" } else { "no" }.to_owned());
        rows.push(row);
    }
    out.push_str(&table(&rows, 2));
    out
}
