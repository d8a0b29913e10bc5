//! The readings of the source side by side: what each changes.

use hydrostat::{
    Arm, Displaced, EnteringSpeed, FlowSurface, Gravity, Hydrostatics, LayerMean, ModelOptions, Options, SolveError,
    Solver, Support, VerdictKind, Volume, WettedLength,
};
use hydrostat_figures::{Measure, Page, Panel, Scale, Scene, lines_figure};
use rayon::prelude::*;

use crate::numbers::{fixed, larger};
use crate::report::{Check, Row, Section, Table};
use crate::scope::Scope;
use crate::shipped;

/// The default reading, each alternative alone, and all that the source's letter asks for, under the words of the arm file. The
/// support [`Support::UnstrainedBase`], under which balances are not met, is not among them.
pub fn alternatives() -> Vec<(&'static str, ModelOptions)> {
    let default = ModelOptions::default();
    vec![
        ("default", default),
        ("volume = circular", ModelOptions { volume: Volume::Circular, ..default }),
        ("volume = none", ModelOptions { volume: Volume::None, ..default }),
        ("flow_surface = lateral", ModelOptions { flow_surface: FlowSurface::Lateral, ..default }),
        ("entering_speed = resultant", ModelOptions { entering_speed: EnteringSpeed::Resultant, ..default }),
        ("layer_mean = momentum", ModelOptions { layer_mean: LayerMean::Momentum, ..default }),
        ("wetted_length = deformed", ModelOptions { wetted_length: WettedLength::Deformed, ..default }),
        ("displaced = section", ModelOptions { displaced: Displaced::Section, ..default }),
        ("hydrostatics = normal-only", ModelOptions { hydrostatics: Hydrostatics::NormalOnly, ..default }),
        ("closure = literal", ModelOptions::LITERAL),
    ]
}

const UNSTRAINED: &str = "support = unstrained-base";

fn with_support() -> Vec<(&'static str, ModelOptions)> {
    let mut all = alternatives();
    all.push((UNSTRAINED, ModelOptions { support: Support::UnstrainedBase, ..ModelOptions::default() }));
    all
}

/// Why there is no tip.
#[derive(Debug, Clone)]
struct NoTip {
    why: String,
    /// Whether that is a limit of the arm, and not of the solver.
    physical: bool,
}

/// A tip as numbers that can be compared.
type Outcome = Result<[f64; 4], NoTip>;

/// x, y (mm), theta and alpha (deg) of the tip.
fn tip(arm: &Arm) -> Outcome {
    match Solver::new(arm, Options::default()).and_then(|mut solver| solver.solve()) {
        Ok(solved) => {
            let tip = solved.tip();
            Ok([1e3 * tip.x, 1e3 * tip.y, tip.theta.to_degrees(), tip.alpha.to_degrees()])
        }
        Err(SolveError::NoEquilibrium(no)) => {
            let kind = no.verdict.kind;
            Err(NoTip { why: kind.name().replace('_', " "), physical: kind != VerdictKind::NotFound })
        }
        Err(error) => Err(NoTip { why: error.to_string(), physical: false }),
    }
}

fn loaded(arm: &Arm, readings: ModelOptions, tension: f64, speed: f64) -> Arm {
    let mut arm = arm.clone();
    arm.model = readings;
    for (k, cable) in arm.cables.iter_mut().enumerate() {
        cable.tension = if k == 0 { tension } else { 0.0 };
    }
    arm.flow.speed = speed;
    arm
}

/// One arm under all readings.
struct Study {
    arm: Arm,
    /// Of the table, N and m/s.
    at: [f64; 2],
    /// The largest of the figures.
    upto: [f64; 2],
}

fn studies() -> Vec<Study> {
    let paper = shipped::arm("paper").map(|arm| Study { arm, at: [40.0, 0.5], upto: [100.0, 2.0] });
    let silicone = shipped::arm("silicone").map(|mut arm| {
        arm.gravity = Some(Gravity::default());
        "silicone with its weight".clone_into(&mut arm.name);
        arm.flow.direction = 0.5;
        Study { arm, at: [0.15, 0.1], upto: [0.4, 0.3] }
    });
    paper.into_iter().chain(silicone).collect()
}

pub(crate) fn section(scope: Scope) -> Section {
    let mut section = Section::new("readings", "Readings of the source compared");
    section.text(
        "Where the source is open, each option changes one thing (docs/model.md, section 9). Tip and alpha(L) of two arms under each; the silicone \
         arm's stream is at 28.6 degrees, and its weight acts, without which hydrostatics would change nothing. A verdict stands where there \
         is no equilibrium: the load of the lateral surface and of the resultant speed can jump against the motion. The unstrained base leaves the tip's \
         balance unmet; its shapes come of an initial-value problem that soft arms make unstable, and are not checked.",
    );
    let studies = studies();
    let mut expected = Table::new(
        "What is stated of the readings",
        "docs/model.md, section 9: stated from the equations, not from a publication.",
        &["statement", "here"],
    );
    expected.push(
        Row::new(["both arms are there".to_owned(), studies.len().to_string()]).checked(Check::so(studies.len() == 2)),
    );
    for study in &studies {
        section.table(tips(study));
        for (name, scene) in figures(study, scope) {
            section.figure(
                format!("readings-{name}-{}", study.arm.name.split(' ').next().unwrap_or_default()),
                format!("{}: the readings over {name}. Above alpha(L), below how far the tip is from that of the default reading.", study.arm.name),
                scene,
            );
        }
    }
    if let Some(study) = studies.first() {
        statements(study, &mut expected);
    }
    section.table(expected);
    section
}

fn tips(study: &Study) -> Table {
    let [tension, speed] = study.at;
    let mut table = Table::new(
        format!("The tip of {} at {tension} N in {speed} m/s", study.arm.name),
        "none: Hydrostat alone. What is checked is that every reading has a shape, or a physical reason why not.",
        &["reading", "x (mm)", "y (mm)", "turned (deg)", "alpha(L) (deg)", "from the default (mm)"],
    );
    let all: Vec<(&str, Outcome)> =
        with_support().into_par_iter().map(|(name, r)| (name, tip(&loaded(&study.arm, r, tension, speed)))).collect();
    let default = all[0].1.clone().unwrap_or([f64::NAN; 4]);
    for (name, outcome) in all {
        let row = match outcome {
            Ok(tip) => {
                let away = (tip[0] - default[0]).hypot(tip[1] - default[1]);
                Row::new([
                    name.to_owned(),
                    fixed(tip[0], 3),
                    fixed(tip[1], 3),
                    fixed(tip[2], 3),
                    fixed(tip[3], 3),
                    fixed(away, 3),
                ])
                .checked(Check::so(true))
            }
            Err(NoTip { why, physical }) => {
                let row = Row::new([name.to_owned(), why, String::new(), String::new(), String::new(), String::new()]);
                // The unstrained base makes an initial-value problem of it, whose solutions grow without bound along a soft arm.
                if name == UNSTRAINED { row } else { row.checked(Check::so(physical)) }
            }
        };
        table.push(row);
    }
    table
}

/// Over tension at the speed of the table, and over speed at its tension.
fn figures(study: &Study, scope: Scope) -> Vec<(&'static str, Scene)> {
    let steps = if scope == Scope::Quick { 6 } else { 20 };
    let all = with_support();
    let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
    let fraction = |k: u32| f64::from(k) / f64::from(steps);
    let [tension, speed] = study.at;
    [("tension", "T1 (N)", true), ("speed", "v (m/s)", false)]
        .into_iter()
        .map(|(name, across, raised)| {
            let places: Vec<[f64; 2]> =
                (0..=steps)
                    .map(|k| {
                        if raised {
                            [fraction(k) * study.upto[0], speed]
                        } else {
                            [tension, fraction(k) * study.upto[1]]
                        }
                    })
                    .collect();
            let at = |place: &[f64; 2]| if raised { place[0] } else { place[1] };
            let solved: Vec<Vec<Option<[f64; 4]>>> = all
                .par_iter()
                .map(|(_, r)| places.iter().map(|[t, v]| tip(&loaded(&study.arm, *r, *t, *v)).ok()).collect())
                .collect();
            let angles = solved
                .iter()
                .map(|row| places.iter().zip(row).filter_map(|(p, tip)| tip.map(|tip| [at(p), tip[3]])).collect())
                .collect();
            let away = solved
                .iter()
                .map(|row| {
                    let pairs = row.iter().zip(&solved[0]).zip(&places);
                    pairs
                        .filter_map(|((tip, default), p)| {
                            let (tip, default) = ((*tip)?, (*default)?);
                            Some([at(p), (tip[0] - default[0]).hypot(tip[1] - default[1])])
                        })
                        .collect()
                })
                .collect();
            let panel =
                |title: &str, lines| Panel { up: Measure { title: title.to_owned(), scale: Scale::Even }, lines };
            let scene = lines_figure(
                &format!("{}: readings", study.arm.name),
                &Measure { title: across.to_owned(), scale: Scale::Even },
                &names,
                &[panel("alpha(L) (°)", angles), panel("from the default (mm)", away)],
                &Page::default(),
            );
            (name, scene)
        })
        .collect()
}

/// What docs/model.md says of the unstrained base, on `paper`.
fn statements(study: &Study, table: &mut Table) {
    let unstrained = ModelOptions { support: Support::UnstrainedBase, ..ModelOptions::default() };
    let still: Vec<Outcome> = [10.0, 40.0].iter().map(|t| tip(&loaded(&study.arm, unstrained, *t, 0.0))).collect();
    let aside = still.iter().map(|tip| tip.as_ref().map_or(f64::NAN, |tip| tip[1].abs())).fold(0.0, larger);
    table.push(
        Row::new([
            "an unstrained base: no bending without flow, at 10 N and 40 N".to_owned(),
            format!("tip aside by {aside:.1e} mm"),
        ])
        .checked(Check::within(aside, 1e-6)),
    );
    let bent: Vec<f64> = [0.0, 0.1, 0.2]
        .iter()
        .map(|v| tip(&loaded(&study.arm, unstrained, 3.0, *v)).map_or(f64::NAN, |tip| tip[2].abs()))
        .collect();
    table.push(
        Row::new([
            "an unstrained base: more flow bends it more, at 3 N".to_owned(),
            format!("turned by {:.3}, {:.3}, {:.3} deg in 0, 0.1, 0.2 m/s", bent[0], bent[1], bent[2]),
        ])
        .checked(Check::so(bent.windows(2).all(|w| w[1] > w[0]))),
    );
    let clamped: Vec<f64> = [0.0, 0.5, 1.0]
        .iter()
        .map(|v| tip(&loaded(&study.arm, ModelOptions::default(), 40.0, *v)).map_or(f64::NAN, |tip| tip[2].abs()))
        .collect();
    table.push(
        Row::new([
            "clamped: more flow bends it less, as in the source's Fig. 1b, at 40 N".to_owned(),
            format!("turned by {:.3}, {:.3}, {:.3} deg in 0, 0.5, 1 m/s", clamped[0], clamped[1], clamped[2]),
        ])
        .checked(Check::so(clamped.windows(2).all(|w| w[1] < w[0]))),
    );
}
