//! Tables and pictures of what was found.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

use hydrostat::{EnteringSpeed, FlowSurface, LayerMean, ModelOptions, Options, Solver, Volume, WettedLength};
use hydrostat_figures::{
    Abscissa, Coloured, ColouredColumn, KeyValues, Measure, Page, Panel, Scale, arm_figure, lines_figure, map_figure,
};
use hydrostat_files::{arm_to_toml, number, write_whole};

use crate::search::Found;
use crate::set::{LENGTH, Set};
use crate::statements::{Judged, SPEEDS, Statement, alphas};
use crate::verification::verification;

/// Sets of each kind in the table of the best.
const BEST: usize = 20;
/// Stations of a curve alpha(s).
const STATIONS: usize = 41;
/// Tolerance of the shapes that are drawn.
const TOL: f64 = 1e-9;

/// Writes tables and pictures of the sample and of the best sets at the highest tension and at every tension into `folder`; what the sample says
/// is the text that comes back.
///
/// # Errors
/// What cannot be written.
pub fn write(folder: &Path, drawn: &[Found], scopes: &[Vec<Found>; 2]) -> anyhow::Result<String> {
    std::fs::create_dir_all(folder)?;
    let [highest, every] = scopes;
    let text = summary(drawn, scopes);
    write_whole(folder.join("summary.txt"), text.as_bytes())?;
    write_whole(folder.join("best.csv"), best_csv(highest, every).as_bytes())?;
    write_whole(folder.join("failing.png"), &map_of_failing(drawn).png()?)?;
    for (name, found) in [("highest", highest), ("every", every)] {
        if let Some(best) = found.first() {
            curves(&folder.join(format!("alpha-{name}.svg")), best)?;
            let tension = best.outcome.map_or(0.0, |judged| judged.tension);
            let mut arm = best.set.arm(tension, SPEEDS[0]);
            arm.name = format!("best at {name} tension");
            let shape = Solver::new(&arm, Options::with_tol(TOL))?.solve()?;
            write_whole(
                folder.join(format!("shape-{name}.svg")),
                arm_figure(&shape, None, &Page::default()).svg().as_bytes(),
            )?;
            write_whole(folder.join(format!("best-{name}.toml")), arm_to_toml(&arm).as_bytes())?;
            let table = verification(&best.set, tension);
            write_whole(folder.join(format!("streams-{name}.csv")), table.as_bytes())?;
        }
    }
    Ok(text)
}

fn judged(found: &[Found]) -> impl Iterator<Item = (&Found, Judged)> {
    found.iter().filter_map(|one| one.outcome.ok().map(|judged| (one, judged)))
}

/// How many sets satisfy what.
pub fn summary(drawn: &[Found], [highest, every]: &[Vec<Found>; 2]) -> String {
    let mut out = String::new();
    let reached: Vec<Judged> = judged(drawn).map(|(_, judged)| judged).collect();
    let _ = writeln!(out, "{} sets drawn, {} judged at their highest tension\n", drawn.len(), reached.len());

    let mut why: BTreeMap<&str, usize> = BTreeMap::new();
    for miss in drawn.iter().filter_map(|one| one.outcome.err()) {
        *why.entry(miss.why).or_default() += 1;
    }
    for (why, count) in why {
        let _ = writeln!(out, "{count:>7} not judged: {why}");
    }

    let _ = writeln!(out, "\nof those judged   at the highest tension   at every tension");
    for (k, statement) in Statement::ALL.into_iter().enumerate() {
        let held = [false, true].map(|every| reached.iter().filter(|j| j.margins(every)[k] > 0.0).count());
        let _ = writeln!(out, "{:>24} {:>24}   {}", held[0], held[1], statement.words());
    }
    let all = [false, true].map(|every| reached.iter().filter(|j| j.failing(every).is_empty()).count());
    let _ = writeln!(out, "{:>24} {:>24}   all statements", all[0], all[1]);

    let _ = writeln!(out, "\nfailing alone, at the highest tension and at every one:");
    for statement in Statement::ALL {
        let alone = [false, true].map(|every| reached.iter().filter(|j| j.failing(every) == [statement]).count());
        let _ = writeln!(out, "{:>24} {:>24}   {}", alone[0], alone[1], statement.words());
    }

    let _ = writeln!(out, "\nreading: sets judged, all statements at the highest tension, at every one");
    for (name, has) in OPTIONS {
        let own: Vec<Judged> = judged(drawn).filter(|(one, _)| has(&one.set.model)).map(|(_, judged)| judged).collect();
        let all = [false, true].map(|every| own.iter().filter(|j| j.failing(every).is_empty()).count());
        let _ = writeln!(out, "{name:>24} {:>8} {:>6} {:>6}", own.len(), all[0], all[1]);
    }

    let stretch = reached.iter().map(|j| j.least_stretch).fold(0.0, f64::max);
    let _ = writeln!(out, "\nlargest of the least stretches nu of the sets judged: {stretch:.3}");
    for (name, found) in [("the highest tension", highest), ("every tension", every)] {
        let whole = judged(found).filter(|(_, j)| j.failing(name == "every tension").is_empty()).count();
        let _ = writeln!(out, "looked around the best at {name}: {whole} of {} satisfy all statements", found.len());
    }
    out
}

/// A reading with its name.
type Choice = (&'static str, fn(&ModelOptions) -> bool);

const OPTIONS: [Choice; 10] = [
    ("planar", |r| r.volume == Volume::Planar),
    ("circular", |r| r.volume == Volume::Circular),
    ("centreline", |r| r.flow_surface == FlowSurface::Centreline),
    ("lateral", |r| r.flow_surface == FlowSurface::Lateral),
    ("tangential", |r| r.entering_speed == EnteringSpeed::Tangential),
    ("resultant", |r| r.entering_speed == EnteringSpeed::Resultant),
    ("speed", |r| r.layer_mean == LayerMean::Speed),
    ("momentum", |r| r.layer_mean == LayerMean::Momentum),
    ("reference", |r| r.wetted_length == WettedLength::Reference),
    ("deformed", |r| r.wetted_length == WettedLength::Deformed),
];

fn readings_words(model: ModelOptions) -> Vec<&'static str> {
    OPTIONS.iter().filter(|(_, has)| has(&model)).map(|(name, _)| *name).collect()
}

/// One row a set, those of the highest tension first.
pub fn best_csv(highest: &[Found], every: &[Found]) -> String {
    let mut out = "scope,number,length_m,base_radius_m,tip_radius_m,base_offset_m,tip_offset_m,c1_Pa,c2_Pa,base_c3_N,tip_c3_N,\
                   volume,flow_surface,entering_speed,layer_mean,wetted_length,tension_N,turned_deg,least_nu,fold_margin,\
                   growing_share,smaller_share,straight_tip,tip_angle,tip_rises,deforms_more,deforms_less,tip_turns_less,\
                   grows_along,locally_smaller,failing\n"
        .to_owned();
    for (scope, found) in [("highest", highest), ("every", every)] {
        for (one, judged) in judged(found).take(BEST) {
            let everywhere = scope == "every";
            let set = &one.set;
            let mut cells = vec![scope.to_owned(), one.number.to_string()];
            let numbers = [LENGTH]
                .into_iter()
                .chain(set.radii())
                .chain(set.offsets())
                .chain([set.c1, set.shear * set.c1])
                .chain(set.bending_stiffness());
            cells.extend(numbers.map(|v| format!("{v:?}")));
            cells.extend(readings_words(set.model).into_iter().map(str::to_owned));
            let results = [
                judged.tension,
                judged.turned,
                judged.least_stretch,
                judged.fold_margin,
                judged.growing,
                judged.smaller,
            ];
            cells.extend(results.into_iter().chain(*judged.margins(everywhere)).map(|v| format!("{v:.6}")));
            let failing: Vec<&str> = judged.failing(everywhere).into_iter().map(Statement::words).collect();
            cells.push(format!("\"{}\"", failing.join("; ")));
            out.push_str(&cells.join(","));
            out.push('\n');
        }
    }
    out
}

/// Drag at 0.5 m/s over bending stiffness at the base: 1/2 rho U^2 2 R L^3 / (C3 A).
fn cauchy(set: &Set) -> f64 {
    let [radius, _] = set.radii();
    let [c3, _] = set.bending_stiffness();
    500.0 * SPEEDS[0].powi(2) * 2.0 * radius * LENGTH.powi(3) / (c3 * PI * radius * radius)
}

/// Which statement fails first at the highest tension, over the turn of the tip and the drag.
fn map_of_failing(drawn: &[Found]) -> hydrostat_figures::Scene {
    let all: Vec<(&Found, Judged)> = judged(drawn).collect();
    let key = |name: &str, unit: &str, values: Vec<f64>| KeyValues {
        axis: Abscissa { name: name.to_owned(), unit: unit.to_owned(), per_si: 1.0 },
        values,
    };
    let keys = [
        key("turn of the tip at the highest tension", "deg", all.iter().map(|(_, j)| j.turned).collect()),
        key("log10 of the Cauchy number", "", all.iter().map(|(one, _)| cauchy(&one.set).log10()).collect()),
    ];
    let word = |judged: &Judged| judged.failing(false).last().map(|s| s.words().to_owned());
    let words = all.iter().map(|(_, judged)| word(judged)).collect();
    let column = ColouredColumn { name: "failing".to_owned(), values: Coloured::Words(words) };
    map_figure(&keys, &column, "the last statement that fails, at the highest tension", &Page::default())
}

/// alpha(s) of a set at its highest tension in several streams.
fn curves(file: &Path, best: &Found) -> anyhow::Result<()> {
    let tension = best.outcome.map_or(0.0, |judged| judged.tension);
    let mut lines = [Vec::new(), Vec::new()];
    for speed in [0.0, SPEEDS[0], SPEEDS[1]] {
        let shape = Solver::new(&best.set.arm(tension, speed), Options::with_tol(TOL))?.solve()?;
        let angles = alphas(&shape);
        let step = (angles.len() - 1) / (STATIONS - 1);
        let at = |k: usize| LENGTH * 1e3 * (k * step) as f64 / (angles.len() - 1) as f64;
        lines[0].push((0..STATIONS).map(|k| [at(k), angles[k * step]]).collect::<Vec<[f64; 2]>>());
    }
    let still = lines[0][0].clone();
    for line in &lines[0].clone() {
        lines[1].push(line.iter().zip(&still).map(|(own, still)| [own[0], own[1] - still[1]]).collect());
    }
    let measure = |title: &str| Measure { title: title.to_owned(), scale: Scale::Even };
    let [angles, less] = lines;
    let panels = [
        Panel { up: measure("alpha(s) (°)"), lines: angles },
        Panel { up: measure("less that at 0 m/s (°)"), lines: less },
    ];
    let title = format!("alpha(s) at {} N", number(tension));
    let figure = lines_figure(&title, &measure("s (mm)"), &["0 m/s", "0.5 m/s", "1 m/s"], &panels, &Page::default());
    write_whole(file, figure.svg().as_bytes())?;
    Ok(())
}
