//! What the HTTP interface answers: the documents of the program, from the same types.

use hydrostat::{Arm, Configuration, Options, PathOptions, ReachOptions, SpatialConfiguration, VerdictKind};
use hydrostat_figures::{Abscissa, Page, Scene, last_good_note};
use hydrostat_files::{
    Dimension, EquilibriaDocument, Inputs, Note, Others, Varied, arm_to_toml, equilibria_csv, shipped, unit_slips,
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
use crate::shape::{Aim, Shape, Unsolved};
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
    let shipped = shipped::all_names().map(|name| ShippedOut {
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
    if arm.space.is_some() {
        return solved::<SpatialConfiguration>(request, &arm, deadline);
    }
    solved::<Configuration>(request, &arm, deadline)
}

fn solved<C: Shape>(request: &SolveRequest, arm: &Arm, deadline: Deadline) -> Result<Answer, Problem>
where
    Problem: From<Box<C::Failure>>,
{
    let stations = stations(request.stations.clone())?;
    let tol = request.tol.unwrap_or(Options::default().tol);
    match C::solve(arm, tol) {
        Ok(mut shape) => {
            let notes = shape.notes(tol);
            if let (Format::Svg | Format::Pdf | Format::Png, format) = (request.format, request.format) {
                let note = said(&shape, &notes);
                return Answer::figure(&shape.figure(note.as_deref(), &Page::default()), format);
            }
            if let Some(stations) = stations {
                shape.resample(stations);
            }
            match request.format {
                Format::Csv => Ok(Answer::csv(shape.csv())),
                _ => Ok(Answer::json(&shape.document(&with_slips(arm, notes)))),
            }
        }
        Err(Unsolved::Verdict(failure)) => no_shape::<C>(request, arm, failure, stations, deadline),
        Err(Unsolved::Refused(problem)) => Err(problem),
    }
}

/// Slips of the unit, as the program warns of them, before what is to be said of the shape.
pub(crate) fn with_slips(arm: &Arm, notes: Vec<Note>) -> Vec<Note> {
    unit_slips(arm).iter().map(Note::from).chain(notes).collect()
}

/// What a drawing says of a shape that is not simply stable.
fn said<C: Shape>(shape: &C, notes: &[Note]) -> Option<String> {
    let words: Vec<&str> = (shape.is_stable() == Some(false))
        .then_some("UNSTABLE: the arm would leave this shape at the slightest push")
        .into_iter()
        .chain(notes.iter().map(|note| note.message.as_str()))
        .collect();
    (!words.is_empty()).then(|| words.join("; "))
}

/// JSON gets the verdict, a drawing the last good shape, which says that it is one; a table has nothing to say.
fn no_shape<C: Shape>(
    request: &SolveRequest,
    arm: &Arm,
    mut failure: Box<C::Failure>,
    stations: Option<usize>,
    deadline: Deadline,
) -> Result<Answer, Problem>
where
    Problem: From<Box<C::Failure>>,
{
    match request.format {
        Format::Csv => Err(failure.into()),
        Format::Svg | Format::Pdf | Format::Png => {
            let note = last_good_note(C::verdict(&failure));
            match C::last_good(&mut failure) {
                Some(shape) => Answer::figure(&shape.figure(Some(&note), &Page::default()), request.format),
                None => Err(failure.into()),
            }
        }
        Format::Json => {
            // A tolerance was asked of the answer, not of the last good shape.
            let mut notes = Vec::new();
            if let Some(shape) = C::last_good(&mut failure) {
                notes = shape.notes(f64::INFINITY);
                if let Some(stations) = stations {
                    shape.resample(stations);
                }
            }
            let others = others(arm, C::verdict(&failure).kind, deadline);
            Ok(Answer::json(&C::failure(&failure, &with_slips(arm, notes), others)))
        }
    }
}

/// The equilibria that the path does not lead to, where it turns back.
fn others(arm: &Arm, kind: VerdictKind, deadline: Deadline) -> Option<Others> {
    if kind != VerdictKind::LimitPoint || arm.space.is_some() {
        return None;
    }
    arm.equilibria_while(COARSE, |_| deadline.is_ahead()).ok().map(|all| Others::of(&all))
}

/// A path over the range of a parameter.
pub(crate) fn path(request: &PathRequest, deadline: Deadline) -> Result<Answer, Problem> {
    let arm = request.arm()?;
    if arm.space.is_some() {
        return followed::<SpatialConfiguration>(request, &arm, deadline);
    }
    followed::<Configuration>(request, &arm, deadline)
}

fn followed<C: Shape>(request: &PathRequest, arm: &Arm, deadline: Deadline) -> Result<Answer, Problem> {
    let varied = varied(request.vary.as_ref())?;
    varied.parameter.of(arm).map_err(|error| Problem::field("vary", format!("vary: {error}")))?;
    let default = PathOptions::default();
    let options = PathOptions {
        tol: request.tol.unwrap_or(default.tol),
        longest: request.max_step.unwrap_or(default.longest),
        most: count("max_points", request.max_points.clone(), limits::POINTS)?.unwrap_or(default.most),
        branches: request.branches,
    };
    let path = C::path(arm, varied.parameter, varied.range, &options, deadline)?;
    let document = C::path_document(&path, &varied)
        .ok_or_else(|| Problem::field("vary", "vary: no point of the path was established at its start"))?;
    match request.format {
        Format::Json => Ok(Answer::json(&document)),
        Format::Csv => Ok(Answer::csv(C::path_csv(&path, &varied))),
        format => {
            let title = format!("{}: equilibria over {}", arm.name, varied.parameter);
            Answer::figure(&C::path_figure(&path, &abscissa(&varied), &title, &Page::default()), format)
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

/// All equilibria, as far as the time goes; in space those that were found.
pub(crate) fn equilibria(request: &EquilibriaRequest, deadline: Deadline) -> Result<Answer, Problem> {
    let arm = request.arm()?;
    if arm.space.is_some() {
        return found::<SpatialConfiguration>(request, &arm, deadline);
    }
    found::<Configuration>(request, &arm, deadline)
}

fn found<C: Shape>(request: &EquilibriaRequest, arm: &Arm, deadline: Deadline) -> Result<Answer, Problem> {
    let stations = stations(request.stations.clone())?;
    let all = C::all(arm, request.tol.unwrap_or(1e-8), deadline)?;
    match request.format {
        Format::Json => {
            let document = EquilibriaDocument::new(arm, C::search(&all));
            let shapes =
                stations.map(|count| C::found(&all).iter().map(|one| one.configuration.silhouette(count)).collect());
            Ok(Answer::json(&WithShapes { document, shapes }))
        }
        Format::Csv => Ok(Answer::csv(equilibria_csv(arm.cables.len(), C::search(&all)))),
        format => Answer::figure(&C::all_figure(&all, arm, &Page::default()), format),
    }
}

/// The tensions that bring a place of the arm to a target.
pub(crate) fn reach(request: &ReachRequest, deadline: Deadline) -> Result<Answer, Problem> {
    let arm = request.arm()?;
    if arm.space.is_some() {
        return reached::<SpatialConfiguration>(request, &arm, deadline);
    }
    reached::<Configuration>(request, &arm, deadline)
}

fn reached<C: Shape>(request: &ReachRequest, arm: &Arm, deadline: Deadline) -> Result<Answer, Problem> {
    let expected = if arm.space.is_some() { "[x, y, z] in m" } else { "[x, y] in m" };
    let target = request.target.as_ref().ok_or_else(|| Problem::missing("target", expected))?;
    let place = target.iter().enumerate().map(|(k, v)| v.value(&format!("target[{k}]"), Dimension::Length));
    let read = |field: &str, amount: &Option<_>, dimension| {
        amount.as_ref().map(|amount: &crate::requests::Amount| amount.value(field, dimension)).transpose()
    };
    let aim = Aim {
        place: place.collect::<Result<_, _>>()?,
        station: read("station", &request.station, Dimension::Length)?,
        angle: read("angle", &request.angle, Dimension::Angle)?,
        direction: request.direction,
    };
    let options = ReachOptions {
        max_tension: read("max_tension", &request.max_tension, Dimension::Force)?,
        max_stroke: read("max_stroke", &request.max_stroke, Dimension::Length)?,
        tol: request.tol.unwrap_or(ReachOptions::default().tol),
        ..ReachOptions::default()
    };
    let found = C::reach(arm, &aim, request.by == By::Strokes, &options, deadline)?;
    if !deadline.is_ahead() {
        // What was not looked at may have been the answer.
        return Err(Problem::too_long());
    }
    match request.format {
        Format::Json => Ok(Answer::json(&C::reach_document(arm, &found))),
        Format::Csv => Ok(Answer::csv(C::reach_csv(arm.cables.len(), &found))),
        format => match found.solutions.first().or(found.closest.as_ref()) {
            Some(best) => {
                let note = found.closest.is_some().then_some("Not reached: the closest that was found");
                Answer::figure(&best.configuration.reach_figure(&aim, note, &Page::default()), format)
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
