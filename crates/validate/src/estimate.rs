//! Estimated errors against true ones.

use std::sync::atomic::{AtomicUsize, Ordering};

use hydrostat::{Arm, Configuration, EnteringSpeed, FlowSurface, Options, SolveError, Solver, Support, VerdictKind};
use hydrostat_figures::{Measure, Page, Panel, Scale, lines_figure};
use hydrostat_files::ArmFile;
use rayon::prelude::*;
use serde::Deserialize;

use crate::convergence::arms;
use crate::numbers::{fixed, larger, quantile, size};
use crate::report::{Check, Row, Section, Table};
use crate::scope::{Listener, Scope};

const REFERENCE: &str = include_str!("../data/cases.json");

/// Arms whose answer hangs on the water that is displaced, as the default reading has it.
const WEIGHT: &str = include_str!("../data/weight.json");

/// Ends in a limit point here, with the tangent rising ever less before it; the reference steps over it
/// with a smoothed load.
const SNAPS: &str = "random 7";

/// An arm and its shape by the independent program.
#[derive(Debug, Clone, Deserialize)]
pub struct Reference {
    /// Its name.
    pub name: String,
    toml: String,
    /// How good the program thinks its own answer is, over L.
    pub accuracy: f64,
    tip: ReferenceTip,
    stations: ReferenceStations,
    base: ReferenceBase,
}

#[derive(Debug, Clone, Deserialize)]
struct ReferenceTip {
    x: f64,
    y: f64,
}

#[derive(Debug, Clone, Deserialize)]
struct ReferenceStations {
    s: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
    theta: Vec<f64>,
}

#[derive(Debug, Clone, Deserialize)]
struct ReferenceBase {
    force: [f64; 2],
}

/// What became of a reference here.
#[derive(Debug, Clone, PartialEq)]
pub enum Compared {
    /// Solved.
    Solved {
        /// Distance of the tips over L.
        off: f64,
        /// What the answer itself says of its distance from the exact one.
        estimate: f64,
        /// That distance over L: to the reference, and for arms with knots to an answer at a tolerance of 1e-11. The references let beta jump where
        /// the curvature of a profile does, by what beta' jumps there, and are up to 1.3e-8 L off for that: with such jumps answers agree with them to
        /// within 1.02 estimates.
        distance: f64,
        /// The largest difference of places over L and of angles, along the arm.
        shape: f64,
        /// The difference of the base's forces over that force, or over 1e-6 N where there is hardly any.
        reaction: f64,
        /// Whether the reading makes loads that jump, where answers are unique only within a gap.
        loose: bool,
        /// Whether the support is the unstrained base, whose estimate means something else: the tip's balance is not met.
        unmet: bool,
    },
    /// Not solved, and it is known why not.
    Explained(String),
    /// Not solved.
    Lost(String),
}

impl Compared {
    /// Whether the reference is met: within 3e-8 L or three estimates, and 100 times that along the arm and at the base.
    pub fn holds(&self) -> bool {
        match self {
            Self::Solved { off, estimate, shape, reaction, loose, .. } => {
                let bound = if *loose { 2e-4 } else { 3e-8_f64.max(3.0 * estimate) };
                *off <= bound && *shape <= 100.0 * bound && *reaction <= 100.0 * bound
            }
            Self::Explained(_) => true,
            Self::Lost(_) => false,
        }
    }
}

/// The references of `crates/validate/data/cases.json`; `None` where the file is not what it should be.
pub fn references() -> Option<Vec<Reference>> {
    serde_json::from_str(REFERENCE).ok()
}

/// Those of `crates/validate/data/weight.json`: arms whose answer hangs on the water that is displaced.
pub fn references_with_weight() -> Option<Vec<Reference>> {
    serde_json::from_str(WEIGHT).ok()
}

/// Solves one of them at the default tolerance.
pub fn compare(reference: &Reference) -> Compared {
    let arm = match ArmFile::parse(&reference.toml, &reference.name).and_then(|file| file.arm()) {
        Ok(arm) => arm,
        Err(error) => return Compared::Lost(error.to_string()),
    };
    let readings = arm.model;
    let jumps = readings.flow_surface == FlowSurface::Lateral || readings.entering_speed == EnteringSpeed::Resultant;
    let unstrained = readings.support == Support::UnstrainedBase;
    let off = |solved: &Configuration| {
        (solved.tip().x - reference.tip.x).hypot(solved.tip().y - reference.tip.y) / arm.length
    };
    match Solver::new(&arm, Options::default()).and_then(|mut solver| solver.solve()) {
        Ok(solved) => Compared::Solved {
            off: off(&solved),
            distance: if has_knots(&arm) { from_sharp(&arm, &solved) } else { off(&solved) },
            estimate: solved.error_estimate / arm.length,
            shape: shape_error(&solved, &reference.stations),
            reaction: reaction_error(&solved, reference.base.force),
            loose: jumps,
            unmet: unstrained,
        },
        Err(SolveError::NoEquilibrium(no)) => {
            let kind = no.verdict.kind;
            let known = match kind {
                VerdictKind::LoadJump => jumps,
                VerdictKind::LimitPoint => reference.name == SNAPS || unstrained,
                // An unstable initial-value problem, left out where it is sensitive.
                _ => unstrained,
            };
            let words = kind.name().replace('_', " ");
            if known { Compared::Explained(words) } else { Compared::Lost(words) }
        }
        Err(error) => Compared::Lost(error.to_string()),
    }
}

/// Whether the curvature of a profile jumps somewhere along the arm: the breaks that are no ends of cables.
fn has_knots(arm: &Arm) -> bool {
    let ends = |s: f64| arm.cables.iter().any(|cable| (cable.end * arm.length - s).abs() <= 1e-9 * arm.length);
    arm.breaks().into_iter().any(|s| !ends(s))
}

/// Distance of the tip from that of an answer at a tolerance of 1e-11, over L.
fn from_sharp(arm: &Arm, solved: &Configuration) -> f64 {
    let sharp = Solver::new(arm, Options::with_tol(1e-11)).and_then(|mut solver| solver.solve());
    sharp.map_or(f64::INFINITY, |sharp| {
        (solved.tip().x - sharp.tip().x).hypot(solved.tip().y - sharp.tip().y) / arm.length
    })
}

fn shape_error(solved: &Configuration, stations: &ReferenceStations) -> f64 {
    let places = stations.s.iter().zip(&stations.x).zip(&stations.y).zip(&stations.theta);
    places
        .map(|(((s, x), y), theta)| {
            let own = solved.at(*s);
            ((own.x - x).hypot(own.y - y) / solved.arm.length).max((own.theta - theta).abs())
        })
        .fold(0.0, larger)
}

fn reaction_error(solved: &Configuration, [x, y]: [f64; 2]) -> f64 {
    let own = solved.base_reaction.force;
    (own[0] - x).hypot(own[1] - y) / x.hypot(y).max(1e-6)
}

/// True errors over estimates, sorted, of those whose answer is unique; below 1e-11 both are rounding.
pub fn ratios<'a>(compared: impl IntoIterator<Item = &'a Compared>) -> Vec<f64> {
    let mut ratios: Vec<f64> = compared
        .into_iter()
        .filter_map(|c| match c {
            Compared::Solved { distance, estimate, loose: false, unmet: false, .. } => {
                Some(distance.max(1e-11) / estimate.max(1e-11))
            }
            _ => None,
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    ratios
}

pub(crate) fn section(scope: Scope, listener: &dyn Listener) -> Section {
    let mut section = Section::new("estimates", "Error estimates against true errors");
    section.text(
        "Each answer carries an estimate of the error of its tip. It is held against arms solved by independent programs \
         (validation/reference), and, on smooth arms, against the answer at the tightest tolerance.",
    );
    against_references(&mut section, scope, listener);
    against_tolerances(&mut section, scope);
    section
}

fn against_references(section: &mut Section, scope: Scope, listener: &dyn Listener) {
    let sets = [
        (references(), "Arms solved by an independent program, tol 1e-8", ORIGIN, ARMS),
        (
            references_with_weight(),
            "Arms with weight, and water displaced by the default reading, tol 1e-8",
            WEIGHT_ORIGIN,
            WITH_WEIGHT,
        ),
    ]
    .map(|(all, title, origin, count)| (all.unwrap_or_default(), title, origin, count));
    let step = if scope == Scope::Quick { 4 } else { 1 };
    let total: usize = sets.iter().map(|(all, ..)| all.len().div_ceil(step)).sum();
    let done = AtomicUsize::new(0);
    let mut every_ratio = Vec::new();
    for (all, title, origin, count) in &sets {
        let chosen: Vec<&Reference> = all.iter().step_by(step).collect();
        let compared: Vec<Compared> = chosen
            .par_iter()
            .map(|reference| {
                let compared = compare(reference);
                listener.advances(1 + done.fetch_add(1, Ordering::Relaxed), total);
                compared
            })
            .collect();
        let ratios = ratios(&compared);
        section.table(summary(&compared, &ratios, title, origin, all.len() == *count));
        let names: Vec<&str> = chosen.iter().map(|reference| reference.name.as_str()).collect();
        section.table(furthest_off(&names, &compared, origin));
        every_ratio.extend(ratios);
    }
    every_ratio.sort_by(f64::total_cmp);
    let count = every_ratio.len() as f64;
    let fractions: Vec<[f64; 2]> =
        every_ratio.iter().enumerate().map(|(k, r)| [*r, 100.0 * (k + 1) as f64 / count]).collect();
    let panel =
        Panel { up: Measure { title: "fraction of arms (%)".to_owned(), scale: Scale::Even }, lines: vec![fractions] };
    let across = Measure { title: "true error / estimate".to_owned(), scale: Scale::Logarithmic };
    section.figure(
        "estimates",
        "How many of the arms have a true error below so many estimates. To the left of 1 the estimate is on the safe side.",
        lines_figure("arms solved by independent programs", &across, &["arms"], &[panel], &Page::default()),
    );
}

/// How many arms each file has.
const ARMS: usize = 160;
const WITH_WEIGHT: usize = 64;

/// Where the references are from.
const ORIGIN: &str = "crates/validate/data/cases.json: an independent program, Gauss collocation of order 9 to 10, to 1e-8 or better in 155 of the 160 and \
                      to 8e-7 in the other five.";

/// Where those with weight are from.
const WEIGHT_ORIGIN: &str = "crates/validate/data/weight.json: validation/reference/solve.py, Chebyshev collocation in NumPy and SciPy, to 1e-9 or better.";

/// How many arms were answered and how well; `complete` if the file has as many as it should.
fn summary(compared: &[Compared], ratios: &[f64], title: &str, origin: &str, complete: bool) -> Table {
    let mut table = Table::new(title, origin, &["what", "here"]);
    let mut offs: Vec<f64> =
        compared.iter().filter_map(|c| if let Compared::Solved { off, .. } = c { Some(*off) } else { None }).collect();
    offs.sort_by(f64::total_cmp);
    let explained = compared.iter().filter(|c| matches!(c, Compared::Explained(_))).count();
    let count = |n: usize| n.to_string();
    table.push(Row::new(["arms compared".to_owned(), count(compared.len())]).checked(Check::so(complete)));
    table.push(Row::new(["answered".to_owned(), count(offs.len())]));
    table.push(Row::new(["not answered, for a known reason".to_owned(), count(explained)]));
    table.push(Row::new(["median distance of the tips / L".to_owned(), size(quantile(&offs, 0.5))]));
    table.push(Row::new(["largest distance / L".to_owned(), size(quantile(&offs, 1.0))]));
    let bounds = [
        ("true error over estimate: median", quantile(ratios, 0.5), f64::NAN),
        ("true error over estimate: 95 % are below", quantile(ratios, 0.95), 3.0),
        ("true error over estimate: largest", quantile(ratios, 1.0), 10.0),
        ("estimate over true error: median", 1.0 / quantile(ratios, 0.5), 30.0),
    ];
    for (what, value, allowed) in bounds {
        let row = Row::new([what.to_owned(), fixed(value, 2)]);
        table.push(if allowed.is_nan() { row } else { row.checked(Check::within(value, allowed)) });
    }
    table
}

/// The arms that are furthest off, and all without an answer.
fn furthest_off(names: &[&str], compared: &[Compared], origin: &str) -> Table {
    let mut table = Table::new(
        "The arms that are furthest off, and all without an answer",
        format!(
            "{origin} An answer may be off by 3e-8 L or three estimates, along the arm and in the base's force by 100 times that; where the reading makes loads that jump, by 2e-4 L."
        ),
        &["arm", "tip off / L", "estimate / L", "shape off", "base's force off", "outcome"],
    );
    let mut order: Vec<usize> = (0..compared.len()).collect();
    let key = |k: &usize| if let Compared::Solved { off, .. } = &compared[*k] { *off } else { f64::INFINITY };
    order.sort_by(|a, b| key(b).total_cmp(&key(a)));
    // Every failure is among them, however many there are.
    let listed = order.iter().enumerate().filter(|(rank, k)| *rank < 14 || !compared[**k].holds());
    for (_, k) in listed {
        let name = names[*k].to_owned();
        let row = match &compared[*k] {
            Compared::Solved { off, estimate, shape, reaction, loose, .. } => {
                let words = if *loose { "solved; its load can jump" } else { "solved" };
                Row::new([name, size(*off), size(*estimate), size(*shape), size(*reaction), words.to_owned()])
            }
            Compared::Explained(why) | Compared::Lost(why) => {
                Row::new([name, String::new(), String::new(), String::new(), String::new(), why.clone()])
            }
        };
        table.push(row.checked(Check::so(compared[*k].holds())));
    }
    table
}

/// Rounding, and the error of the answer at the tightest tolerance, over L.
const FLOOR: f64 = 5e-12;

fn against_tolerances(section: &mut Section, scope: Scope) {
    let digits: Vec<i32> = if scope == Scope::Quick { vec![5, 8] } else { (4..=10).collect() };
    let arms = arms();
    let solve =
        |arm: &Arm, tol: f64| Solver::new(arm, Options::with_tol(tol)).and_then(|mut solver| solver.solve()).ok();
    let rows: Vec<Vec<Row>> = arms
        .par_iter()
        .map(|arm| {
            let best = solve(arm, 1e-12);
            let row = |k: &i32| {
                let tol = 10_f64.powi(-k);
                let [off, estimate] = match (&best, solve(arm, tol)) {
                    (Some(best), Some(solved)) => {
                        let (a, b) = (solved.tip(), best.tip());
                        [(a.x - b.x).hypot(a.y - b.y) / arm.length, solved.error_estimate / arm.length]
                    }
                    _ => [f64::NAN; 2],
                };
                // An estimate far below what was asked for may be low, but not by what matters.
                let allowed = tol.min(3.0 * estimate + 0.15 * tol + FLOOR);
                Row::new([arm.name.clone(), format!("1e-{k}"), size(off), size(estimate)])
                    .checked(Check::within(off, allowed))
            };
            digits.iter().map(row).collect()
        })
        .collect();
    let mut table = Table::new(
        "Errors at several tolerances",
        "Hydrostat at tol 1e-12. Allowed: the tolerance asked for, and three estimates with 15 % of the tolerance.",
        &["arm", "tol", "true error / L", "estimate / L"],
    );
    rows.into_iter().flatten().for_each(|row| table.push(row));
    section.table(table);
}
