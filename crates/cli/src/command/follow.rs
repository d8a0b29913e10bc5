//! `hydrostat reach --path`: targets one after the other.

use std::path::Path;

use hydrostat::{Arm, Followed, Follower, Target};
use hydrostat_files::{FollowedDocument, followed_csv, number, parse_targets, read_targets};

use super::table::{counted, distance_cell, table};
use super::targets::{far_off, options};
use super::{Advised, NoAnswer};
use crate::args::{Format, ReachArgs};
use crate::input;
use crate::output;
use crate::progress::Progress;
use crate::say;

pub(super) fn run(arm: &Arm, path: &Path, args: &ReachArgs) -> anyhow::Result<()> {
    let targets = if input::is_standard(path) {
        parse_targets(&input::text()?, input::NAME, args.station)?
    } else {
        read_targets(path, args.station)?
    };
    let mut follower = Follower::new(arm, &targets[..1], &options(args))?;
    let mut progress = Progress::new();
    let mut rows: Vec<(Target, Followed)> = Vec::with_capacity(targets.len());
    for target in &targets {
        progress.say(|| format!("target {} of {}", rows.len() + 1, targets.len()));
        rows.push((*target, follower.follow(&[*target])?));
    }
    drop(progress);
    let text = match args.format {
        Format::Text => summary(arm, &rows),
        Format::Json => output::line(FollowedDocument::new(arm, &rows).to_json()),
        Format::Csv => followed_csv(arm.cables.len(), &rows),
    };
    output::put(args.output.as_deref(), &text)?;
    for (index, _) in rows.iter().enumerate().filter(|(_, (_, found))| found.jumped) {
        say::warning(format_args!(
            "on the way to target {} the arm jumped to another branch of its equilibria",
            index + 1
        ));
    }
    let missed: Vec<usize> = (0..rows.len()).filter(|k| !rows[*k].1.reached).collect();
    match missed.first() {
        Some(first) => {
            let farthest = rows.iter().map(|(_, found)| found.distance).fold(0.0, f64::max);
            let off = number(1e3 * farthest * arm.length);
            let count = format!("{} of {} targets are not reached", missed.len(), rows.len());
            let error =
                NoAnswer(format!("{count}, the first is target {}; the largest distance is {off} mm", first + 1));
            Err(Advised::with(error, far_off(arm, &rows[*first].0)))
        }
        None => Ok(()),
    }
}

fn summary(arm: &Arm, rows: &[(Target, Followed)]) -> String {
    let mut head: Vec<String> = ["target", "x (mm)", "y (mm)"].map(str::to_owned).into();
    head.extend(arm.cables.iter().map(|cable| format!("{} (N)", cable.name)));
    head.extend(["distance (mm)", "reached", "jumped"].map(str::to_owned));
    let yes = |flag: bool| if flag { "yes" } else { "no" }.to_owned();
    let mut all = vec![head];
    for (index, (target, found)) in rows.iter().enumerate() {
        let mut row = vec![(index + 1).to_string(), number(1e3 * target.x), number(1e3 * target.y)];
        row.extend(found.tensions.iter().map(|tension| number(*tension)));
        row.push(distance_cell(found.distance * arm.length));
        row.extend([yes(found.reached), yes(found.jumped)]);
        all.push(row);
    }
    let jumps = rows.iter().filter(|(_, found)| found.jumped).count();
    let reached = rows.iter().filter(|(_, found)| found.reached).count();
    format!(
        "{}: {reached} of {} reached, {}\n\n{}",
        arm.name,
        counted(rows.len(), "target"),
        counted(jumps, "jump"),
        table(&all, 2)
    )
}
