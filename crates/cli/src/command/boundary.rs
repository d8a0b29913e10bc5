//! `hydrostat reach --boundary`: what bounds the places that the tip reaches.

use std::sync::Mutex;

use hydrostat::{Arm, Boundary, BoundaryKind, BoundaryOptions, BoundaryPiece, BoundaryProgress};
use hydrostat_figures::boundary_figure;
use hydrostat_files::{BoundaryDocument, boundary_csv};

use super::table::table;
use crate::args::{Format, ReachArgs};
use crate::output;
use crate::progress::Progress;
use crate::request::WrongRequest;

pub(super) fn run(arm: &Arm, args: &ReachArgs) -> anyhow::Result<()> {
    let bounded = |own: Option<f64>| own.or(args.max_tension).is_some();
    if let Some(cable) = arm.cables.iter().find(|cable| !bounded(cable.max_tension)) {
        return Err(WrongRequest::Unbounded(cable.name.clone()).into());
    }
    let usual = BoundaryOptions::default();
    let options = BoundaryOptions {
        max_tension: args.max_tension,
        spacing: args.spacing.unwrap_or(usual.spacing),
        tol: args.tol.unwrap_or(usual.tol),
    };
    let progress = Mutex::new(Progress::new());
    let say = |BoundaryProgress { done, of, shapes }| {
        if let Ok(mut progress) = progress.lock() {
            progress.say(|| format!("{done} of {of} edges, faces and planes of tensions, {shapes} shapes"));
        }
        true
    };
    let found = arm.reachable_while(&options, say)?;
    drop(progress);
    if let Some(file) = &args.plot {
        let figure = boundary_figure(&found, &arm.slackened().solve()?, &args.picture.page());
        output::draw(&figure, file, &args.picture.page)?;
    }
    let text = match args.format {
        Format::Text => summary(arm, &found),
        Format::Json => output::line(BoundaryDocument::new(arm, &found).to_json()),
        Format::Csv => boundary_csv(arm.cables.len(), &found),
    };
    output::put(args.output.as_deref(), &text)
}

fn summary(arm: &Arm, found: &Boundary) -> String {
    let all = || found.pieces.iter().flat_map(|piece| &piece.points).map(|point| point.tip);
    let range = |value: fn(hydrostat::Tip) -> f64| {
        let (low, high) = all().map(value).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        format!("{:.3} to {:.3} mm", 1e3 * low, 1e3 * high)
    };
    let head = ["pieces", "points", "kind of boundary"].map(str::to_owned).to_vec();
    let mut rows = vec![head];
    for (kind, words) in [
        (BoundaryKind::Edge(0), "edge: all cables except one at a bound"),
        (BoundaryKind::Fold([0; 2]), "singularity: two cables move the tip along the same line"),
        (BoundaryKind::Limit([0; 2]), "limit: no equilibrium beyond"),
    ] {
        let is = |piece: &&BoundaryPiece| std::mem::discriminant(&piece.kind) == std::mem::discriminant(&kind);
        let own: Vec<&BoundaryPiece> = found.pieces.iter().filter(is).collect();
        let points: usize = own.iter().map(|piece| piece.points.len()).sum();
        rows.push(vec![own.len().to_string(), points.to_string(), words.to_owned()]);
    }
    let places = format!("x {}, y {}", range(|tip| tip.x), range(|tip| tip.y));
    format!("{}: the tip reaches {places}\n\n{}", arm.name, table(&rows, 1))
}
