//! Every shipped arm over tensions, streams and gravity: each case is solved or ends in a verdict.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use hydrostat::{Arm, Gravity, Options, SolveError, Solver, VerdictKind};
use hydrostat_figures::{Abscissa, Coloured, ColouredColumn, KeyValues, Page, Scene, map_figure};
use rayon::prelude::*;

use crate::numbers::fixed;
use crate::report::{Check, Row, Section, Table};
use crate::scope::{Listener, Scope};
use crate::shipped;

/// The cases of one arm with their names, every `thin`-th of them: which cables pull, how hard, the stream, and gravity.
pub fn cases(arm: &Arm, thin: usize) -> Vec<(String, Arm)> {
    let mut out = Vec::new();
    let mut index = 0;
    for side in ["left", "right", "all"] {
        for k in 0..=12 {
            for (speed, direction) in std::iter::once((0.0, 0.0))
                .chain([0.05, 0.1, 0.3, 0.5, 1.0].iter().flat_map(|v| [0.0_f64, 60.0, 90.0, 180.0].map(|d| (*v, d))))
            {
                for gravity in [false, true] {
                    index += 1;
                    if index % thin != 0 {
                        continue;
                    }
                    let mut case = arm.clone();
                    for cable in &mut case.cables {
                        let left = cable.offset.at(0.0, arm.length).value > 0.0;
                        let pulls = side == "all" || (side == "left") == left;
                        let most = cable.max_tension.unwrap_or(0.0);
                        cable.tension = if pulls { most * f64::from(k) / 12.0 } else { 0.0 };
                    }
                    case.flow.speed = speed;
                    case.flow.direction = direction.to_radians();
                    case.gravity = gravity.then(Gravity::default);
                    let name = format!("{} {side} {k}/12 v {speed} from {direction} gravity {gravity}", arm.name);
                    out.push((name, case));
                }
            }
        }
    }
    out
}

/// What became of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    Solved,
    /// With an estimate above the tolerance.
    Loosely,
    Verdict(&'static str),
    /// No physical reason was established, or the solve ended with another error.
    Lost,
}

impl Outcome {
    fn of(arm: &Arm) -> Self {
        let options = Options::default();
        match Solver::new(arm, options).and_then(|mut solver| solver.solve()) {
            Ok(solved) => {
                let tip = solved.tip();
                let finite = [tip.x, tip.y, tip.alpha, solved.error_estimate].iter().all(|v| v.is_finite());
                match solved.error_estimate <= options.tol * arm.length {
                    _ if !finite => Self::Lost,
                    true => Self::Solved,
                    false => Self::Loosely,
                }
            }
            Err(SolveError::NoEquilibrium(no)) => match no.verdict.kind {
                VerdictKind::NotFound => Self::Lost,
                kind => Self::Verdict(kind.name()),
            },
            Err(_) => Self::Lost,
        }
    }

    fn words(self) -> String {
        match self {
            Self::Solved => "solved".to_owned(),
            Self::Loosely => "solved, estimate above 1e-8 L".to_owned(),
            Self::Verdict(name) => name.replace('_', " "),
            Self::Lost => "not found".to_owned(),
        }
    }
}

pub(crate) fn section(scope: Scope, listener: &dyn Listener) -> Section {
    // A prime leaves no direction, speed or tension out.
    let thin = if scope == Scope::Quick { 37 } else { 1 };
    let all: Vec<(String, (String, Arm))> = shipped::arms()
        .into_iter()
        .flat_map(|arm| cases(&arm, thin).into_iter().map(move |case| (arm.name.clone(), case)))
        .collect();
    let done = AtomicUsize::new(0);
    let outcomes: Vec<Outcome> = all
        .par_iter()
        .map(|(_, (_, arm))| {
            let outcome = Outcome::of(arm);
            listener.advances(1 + done.fetch_add(1, Ordering::Relaxed), all.len());
            outcome
        })
        .collect();
    let mut counts: BTreeMap<Outcome, BTreeMap<&str, usize>> = BTreeMap::new();
    for ((name, _), outcome) in all.iter().zip(&outcomes) {
        *counts.entry(*outcome).or_default().entry(name).or_default() += 1;
    }
    let mut section = Section::new("grid", "A grid of arms: solved, or a physical reason why not");
    section.text(
        "Every shipped arm with its left, its right or all cables at 0 to 12 twelfths of their largest tension, in still water and streams of 0.05, 0.1, \
         0.3, 0.5 and 1 m/s from 0, 60, 90 and 180 degrees, with and without weight. A verdict names a limit: a cable that compresses its side of the \
         arm to zero length, a section that no strains can balance, a limit point beyond which the arm snaps.",
    );
    let arms = shipped::arms();
    let names: Vec<&str> = arms.iter().map(|arm| arm.name.as_str()).collect();
    let columns: Vec<&str> =
        ["outcome"].into_iter().chain(names.iter().copied()).chain(["all", "fraction (%)"]).collect();
    let mut table = Table::new(
        "Outcomes",
        "none: Hydrostat alone. No more than 0.5 % may be not found; that an answer is the right one is the subject of the other sections.",
        &columns,
    );
    let total = all.len();
    counts.entry(Outcome::Lost).or_default();
    for (outcome, by_arm) in &counts {
        let count: usize = by_arm.values().sum();
        let fraction = 100.0 * count as f64 / total.max(1) as f64;
        let mut cells = vec![outcome.words()];
        cells.extend(names.iter().map(|name| by_arm.get(name).copied().unwrap_or(0).to_string()));
        cells.extend([count.to_string(), fixed(fraction, 2)]);
        let row = Row::new(cells);
        table.push(if *outcome == Outcome::Lost { row.checked(Check::within(fraction, 0.5)) } else { row });
    }
    let mut cells = vec!["all".to_owned()];
    cells.extend(names.iter().map(|name| all.iter().filter(|(own, _)| own == name).count().to_string()));
    cells.extend([total.to_string(), "100.00".to_owned()]);
    table.push(Row::new(cells).checked(Check::so(arms.len() == 5 && total > 0)));
    section.table(table);
    let lost: Vec<&str> = all
        .iter()
        .zip(&outcomes)
        .filter(|(_, o)| **o == Outcome::Lost)
        .map(|((_, (label, _)), _)| label.as_str())
        .collect();
    if !lost.is_empty() {
        section.text(format!("Not found: {}.", lost.join("; ")));
    }
    for arm in &arms {
        section.figure(
            format!("verdicts-{}", arm.name),
            format!(
                "{}: what becomes of its left cable's tension and of the stream's direction, at 0.2 m/s and without weight.",
                arm.name
            ),
            map(arm, scope),
        );
    }
    section
}

/// Verdicts over the tension of the first cable and the direction of the stream.
fn map(arm: &Arm, scope: Scope) -> Scene {
    let (columns, lines) = if scope == Scope::Quick { (9, 7) } else { (31, 19) };
    let most = arm.cables.first().and_then(|cable| cable.max_tension).unwrap_or(1.0);
    let places: Vec<[f64; 2]> = (0..lines)
        .flat_map(|line| {
            (0..columns).map(move |column| {
                [most * f64::from(column) / f64::from(columns - 1), 180.0 * f64::from(line) / f64::from(lines - 1)]
            })
        })
        .collect();
    let words: Vec<Option<String>> = places
        .par_iter()
        .map(|[tension, direction]| {
            let mut arm = arm.clone();
            for (k, cable) in arm.cables.iter_mut().enumerate() {
                cable.tension = if k == 0 { *tension } else { 0.0 };
            }
            arm.gravity = None;
            arm.flow.speed = 0.2;
            arm.flow.direction = direction.to_radians();
            match Outcome::of(&arm) {
                Outcome::Solved | Outcome::Loosely => None,
                other => Some(other.words()),
            }
        })
        .collect();
    let key = |k: usize, name: &str, unit: &str| KeyValues {
        axis: Abscissa { name: name.to_owned(), unit: unit.to_owned(), per_si: 1.0 },
        values: places.iter().map(|p| p[k]).collect(),
    };
    let keys = [key(0, "T1", "N"), key(1, "direction of the stream", "deg")];
    let column = ColouredColumn { name: "verdict".to_owned(), values: Coloured::Words(words) };
    map_figure(&keys, &column, &arm.name, &Page::default())
}
