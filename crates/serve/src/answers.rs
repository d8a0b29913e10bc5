//! What the HTTP interface answers: the documents of the program, from the same types.

use hydrostat::{
    Arm, Configuration, NoEquilibrium, Options, PathOptions, ReachOptions, SolveError, Solver, Stability, Target,
    VerdictKind,
};
use hydrostat_figures::{
    Abscissa, Page, Quantity, Scene, arm_figure, equilibria_figure, last_good_note, path_figure, reach_figure,
};
use hydrostat_files::{
    Dimension, EquilibriaDocument, FailureDocument, Inputs, Note, Others, PathDocument, ReachDocument,
    SolutionDocument, Varied, arm_to_toml, equilibria_csv, path_csv, reach_csv, shipped, stations_csv,
};
use serde::Serialize;
use serde_json::json;

use crate::arm_source::{Given, tension_scale};
use crate::drawing::Silhouette;
use crate::limits;
use crate::problem::Problem;
use crate::requests::{
    AboutAnArm, By, CheckRequest, EquilibriaRequest, Format, PathRequest, ReachRequest, SolveRequest, count, stations,
    varied,
};
use crate::work::Deadline;

/// The tolerance at which others are counted where a path turns back.
const COARSE: f64 = 1e-6;

/// A body with its type.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) content_type: &'static str,
    pub(crate) bytes: Vec<u8>,
}

const JSON: &str = "application/json";

impl Answer {
    pub(crate) fn json(document: &impl Serialize) -> Self {
        Self { content_type: JSON, bytes: hydrostat_files::json(document).into_bytes() }
    }

    fn csv(text: String) -> Self {
        Self { content_type: "text/csv; charset=utf-8", bytes: text.into_bytes() }
    }

    fn figure(scene: &Scene, format: Format) -> Result<Self, Problem> {
        let (content_type, bytes) = match format {
            Format::Svg => ("image/svg+xml", scene.svg().into_bytes()),
            Format::Pdf => ("application/pdf", scene.pdf()),
            Format::Png | Format::Json | Format::Csv => ("image/png", scene.png().map_err(|_| Problem::defect())?),
        };
        Ok(Self { content_type, bytes })
    }
}

#[derive(Serialize)]
struct ShippedOut {
    name: String,
    description: String,
    toml: String,
}

/// The arms that can be chosen; first the one that the program was started with, if it is none of the shipped.
pub(crate) fn arms(given: Option<&Given>) -> Answer {
    let shipped = shipped::names().map(|name| ShippedOut {
        name: name.to_owned(),
        description: shipped::description(name).unwrap_or_default().to_owned(),
        toml: shipped::get(name).unwrap_or_default().to_owned(),
    });
    let is_shipped = |given: &&Given| shipped::get(&given.name) == Some(given.text.as_str());
    let own = given.filter(|given| !is_shipped(given)).map(|given| json!({ "name": given.name, "toml": given.text }));
    let start = given.filter(is_shipped).map(|given| given.name.as_str());
    Answer::json(&json!({
        "schema": hydrostat_files::results::SCHEMA,
        "version": env!("CARGO_PKG_VERSION"),
        "arms": shipped.collect::<Vec<_>>(),
        "start": start,
        "given": own,
    }))
}

/// What an arm means: every default filled in.
pub(crate) fn check(request: &CheckRequest) -> Result<Answer, Problem> {
    let arm = request.arm()?;
    Ok(Answer::json(&json!({
        "schema": hydrostat_files::results::SCHEMA,
        "version": env!("CARGO_PKG_VERSION"),
        "name": arm.name,
        "inputs": Inputs::new(&arm),
        "toml": arm_to_toml(&arm),
        "tension_scale": (0..arm.cables.len()).map(|c| tension_scale(&arm, c)).collect::<Vec<_>>(),
    })))
}

/// The shape of an arm, or the verdict.
pub(crate) fn solve(request: &SolveRequest, deadline: Deadline) -> Result<Answer, Problem> {
    let arm = request.arm()?;
    let stations = stations(request.stations.clone())?;
    let tol = request.tol.unwrap_or(Options::default().tol);
    let mut solver = Solver::new(&arm, Options::with_tol(tol))?;
    match solver.solve() {
        Ok(mut configuration) => {
            let notes = Note::all(&configuration, tol);
            let margin = configuration.fold_margin().value;
            if let (Format::Svg | Format::Pdf | Format::Png, format) = (request.format, request.format) {
                let note = said(&configuration, &notes);
                return Answer::figure(&arm_figure(&configuration, note.as_deref(), &Page::default()), format);
            }
            if let Some(stations) = stations {
                configuration.stations = configuration.resampled(stations);
            }
            match request.format {
                Format::Csv => Ok(Answer::csv(stations_csv(&configuration.stations))),
                _ => Ok(Answer::json(&SolutionDocument::new(&configuration, margin, &notes))),
            }
        }
        Err(SolveError::NoEquilibrium(failure)) => no_shape(request, &arm, *failure, stations, deadline),
        Err(error) => Err(error.into()),
    }
}

/// What a drawing says of a shape that is not simply stable.
fn said(configuration: &Configuration, notes: &[Note]) -> Option<String> {
    let unstable = configuration.stability().map_or(configuration.stable, Stability::is_stable) == Some(false);
    let words: Vec<&str> = unstable
        .then_some("UNSTABLE: the arm would leave this shape at the slightest push")
        .into_iter()
        .chain(notes.iter().map(|note| note.message.as_str()))
        .collect();
    (!words.is_empty()).then(|| words.join("; "))
}

/// JSON gets the verdict, a drawing the last good shape, which says that it is one; a table has nothing to say.
fn no_shape(
    request: &SolveRequest,
    arm: &Arm,
    mut failure: NoEquilibrium,
    stations: Option<usize>,
    deadline: Deadline,
) -> Result<Answer, Problem> {
    let refused = |failure| Problem::from(SolveError::NoEquilibrium(Box::new(failure)));
    match request.format {
        Format::Csv => Err(refused(failure)),
        Format::Svg | Format::Pdf | Format::Png => match &failure.last_good {
            Some(shape) => {
                let note = last_good_note(&failure.verdict);
                Answer::figure(&arm_figure(shape, Some(&note), &Page::default()), request.format)
            }
            None => Err(refused(failure)),
        },
        Format::Json => {
            // A tolerance was asked of the answer, not of the last good shape.
            let notes = failure.last_good.as_ref().map(|c| Note::all(c, f64::INFINITY)).unwrap_or_default();
            let margin = failure.last_good.as_ref().map_or(f64::NAN, |c| c.fold_margin().value);
            if let (Some(shape), Some(stations)) = (&mut failure.last_good, stations) {
                shape.stations = shape.resampled(stations);
            }
            let others = others(arm, failure.verdict.kind, deadline);
            Ok(Answer::json(&FailureDocument::new(&failure, margin, &notes).with_others(others)))
        }
    }
}

/// The equilibria that the path does not lead to, where it turns back.
fn others(arm: &Arm, kind: VerdictKind, deadline: Deadline) -> Option<Others> {
    if kind != VerdictKind::LimitPoint {
        return None;
    }
    arm.equilibria_while(COARSE, |_| deadline.is_ahead()).ok().map(|all| Others::of(&all))
}

/// A path over the range of a parameter.
pub(crate) fn path(request: &PathRequest, deadline: Deadline) -> Result<Answer, Problem> {
    let arm = request.arm()?;
    let varied = varied(request.vary.as_ref())?;
    varied.parameter.of(&arm).map_err(|error| Problem::field("vary", format!("vary: {error}")))?;
    let default = PathOptions::default();
    let options = PathOptions {
        tol: request.tol.unwrap_or(default.tol),
        longest: request.max_step.unwrap_or(default.longest),
        most: count("max_points", request.max_points.clone(), limits::POINTS)?.unwrap_or(default.most),
        branches: request.branches,
    };
    let path = arm.path_with(varied.parameter, varied.range, &options, |_| deadline.is_ahead())?;
    let document = PathDocument::new(&path, &varied)
        .ok_or_else(|| Problem::field("vary", "vary: no point of the path was established at its start"))?;
    match request.format {
        Format::Json => Ok(Answer::json(&document)),
        Format::Csv => Ok(Answer::csv(path_csv(&path, &varied))),
        format => {
            let title = format!("{}: equilibria over {}", arm.name, varied.parameter);
            let page = Page::default();
            Answer::figure(&path_figure(&path, &abscissa(&varied), Quantity::TipY, &title, &page), format)
        }
    }
}

fn abscissa(varied: &Varied) -> Abscissa {
    Abscissa { name: varied.parameter.to_string(), unit: varied.unit.to_owned(), per_si: varied.per_si }
}

/// The document of all equilibria with what draws them.
#[derive(Serialize)]
struct WithShapes<'a> {
    #[serde(flatten)]
    document: EquilibriaDocument<'a>,
    /// In the order of the equilibria.
    #[serde(skip_serializing_if = "Option::is_none")]
    shapes: Option<Vec<Silhouette>>,
}

/// All equilibria, as far as the time goes.
pub(crate) fn equilibria(request: &EquilibriaRequest, deadline: Deadline) -> Result<Answer, Problem> {
    let arm = request.arm()?;
    let stations = stations(request.stations.clone())?;
    let all = arm.equilibria_while(request.tol.unwrap_or(1e-8), |_| deadline.is_ahead())?;
    match request.format {
        Format::Json => {
            let document = EquilibriaDocument::new(&arm, &all);
            let shape = |count| all.found.iter().map(|one| Silhouette::new(&one.configuration, count)).collect();
            Ok(Answer::json(&WithShapes { document, shapes: stations.map(shape) }))
        }
        Format::Csv => Ok(Answer::csv(equilibria_csv(arm.cables.len(), &all))),
        format => {
            let title = format!("{}: all equilibria", arm.name);
            Answer::figure(&equilibria_figure(&all, &title, &Page::default()), format)
        }
    }
}

/// The tensions that bring a place of the arm to a target.
pub(crate) fn reach(request: &ReachRequest, deadline: Deadline) -> Result<Answer, Problem> {
    let arm = request.arm()?;
    let [x, y] = request.target.as_ref().ok_or_else(|| Problem::missing("target", "[x, y] in m"))?;
    let [x, y] = [x.value("target[0]", Dimension::Length)?, y.value("target[1]", Dimension::Length)?];
    let read = |field: &str, amount: &Option<_>, dimension| {
        amount.as_ref().map(|amount: &crate::requests::Amount| amount.value(field, dimension)).transpose()
    };
    let target = Target {
        s: read("station", &request.station, Dimension::Length)?,
        angle: read("angle", &request.angle, Dimension::Angle)?,
        ..Target::tip(x, y)
    };
    let options = ReachOptions {
        max_tension: read("max_tension", &request.max_tension, Dimension::Force)?,
        max_stroke: read("max_stroke", &request.max_stroke, Dimension::Length)?,
        tol: request.tol.unwrap_or(ReachOptions::default().tol),
        ..ReachOptions::default()
    };
    let found = match request.by {
        By::Tensions => arm.reach_while(&[target], &options, || deadline.is_ahead())?,
        By::Strokes => arm.reach_by_strokes_while(&[target], &options, || deadline.is_ahead())?,
    };
    if !deadline.is_ahead() {
        // What was not looked at may have been the answer.
        return Err(Problem::too_long());
    }
    match request.format {
        Format::Json => Ok(Answer::json(&ReachDocument::new(&arm, &found))),
        Format::Csv => Ok(Answer::csv(reach_csv(arm.cables.len(), &found))),
        format => match found.solutions.first().or(found.closest.as_ref()) {
            Some(best) => {
                let note = found.closest.is_some().then_some("Not reached: the closest that was found");
                Answer::figure(&reach_figure(&best.configuration, &[[x, y]], note, &Page::default()), format)
            }
            None => Err(Problem::field("target", "target: nothing was found")),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requests::read;
    use crate::work::{Weight, Work};

    #[tokio::test]
    async fn a_path_out_of_time_was_called_one_of_too_many_points() {
        let text =
            r#"{ "arm": "silicone", "vary": "arm.base.angle=80:-80", "set": { "flow.speed": 0.1 }, "branches": true }"#;
        let request = read::<PathRequest>(text.as_bytes()).unwrap();
        let work = Work::new(std::time::Duration::from_millis(1));
        let answer = work.run(Weight::Heavy, move |deadline| path(&request, deadline)).await.unwrap().unwrap();
        let document: serde_json::Value = serde_json::from_slice(&answer.bytes).unwrap();
        let branches = document["branches"].as_array().unwrap();
        assert_eq!((branches.len(), &branches[0]["end"]["kind"]), (1, &serde_json::Value::from("stopped")));
    }
}
