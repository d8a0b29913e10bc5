//! `hydrostat equilibria`: all equilibria under the same loads.

use std::fmt::Write as _;
use std::time::Instant;

use anyhow::Context as _;
use hydrostat::{
    Arm, Configuration, Equilibria, PathError, SolveError, SpatialConfiguration, SpatialEquilibria, SpatialError,
    Stability,
};
use hydrostat_figures::{
    Abscissa, Page, Quantity, Scene, equilibria_figure, over_figure, spatial_equilibria_figure, spatial_over_figure,
};
use hydrostat_files::equilibria::{curve_message, side_message};
use hydrostat_files::{EquilibriaDocument, Others, OverDocument, Search, Varied, equilibria_csv, number, over_csv};

use super::over::{Value, at_values, say_what_is_missing};
use super::path::{abscissa, check_quantity, title};
use super::shape::Shape;
use super::table::{stability_words, table};
use super::{NoAnswer, wrong_option};
use crate::args::{EquilibriaArgs, Format, Over};
use crate::output;
use crate::progress::Progress;
use crate::request::{self, WrongRequest};

/// What a search finds, in the plane or in space.
trait EquilibriaIn: Sized {
    /// The shapes.
    type Shape: Shape<Error = Self::Error>;
    /// Why there is no equilibrium to start from.
    type Error: std::error::Error + Send + Sync + 'static;
    /// What there are points of, for the progress.
    const CURVES: &'static str;
    /// What a picture of them is called.
    const CALLED: &'static str;

    fn search(arm: &Arm, tol: f64, go_on: impl FnMut(usize) -> bool) -> Result<Self, PathError<Self::Error>>;
    fn all(&self) -> Search<'_>;
    fn shapes(&self) -> Vec<(&Self::Shape, Option<Stability>)>;
    /// Whether the search is complete, and what it covered.
    fn extent(&self) -> String;
    fn figure(&self, title: &str, page: &Page) -> Scene;
    fn chart(found: &[(f64, &Self)], over: &Abscissa, quantity: Quantity, title: &str, page: &Page) -> Scene;
}

impl EquilibriaIn for Equilibria {
    type Shape = Configuration;
    type Error = SolveError;
    const CURVES: &'static str = "the curve of equilibria";
    const CALLED: &'static str = "all equilibria";

    fn search(arm: &Arm, tol: f64, go_on: impl FnMut(usize) -> bool) -> Result<Self, PathError> {
        arm.equilibria_while(tol, go_on)
    }

    fn all(&self) -> Search<'_> {
        self.into()
    }

    fn shapes(&self) -> Vec<(&Configuration, Option<Stability>)> {
        self.found.iter().map(|one| (&one.configuration, one.stability)).collect()
    }

    fn extent(&self) -> String {
        // Hundredths, without those that rounding leaves of nothing.
        let angle = |rad: f64| number((100.0 * rad.to_degrees()).round() / 100.0 + 0.0);
        let range = |[from, to]: [f64; 2]| format!("{} to {} deg", angle(from), angle(to));
        let angles = format!("tip at {}, base at {}", range(self.tip_angles), range(self.base_angles));
        if self.complete {
            return format!("complete: the curve of equilibria was followed all the way around\n({angles})");
        }
        let ends: Vec<String> =
            (0..2).filter_map(|side| self.ends[side].map(|end| side_message(end, self.base_angles[side]))).collect();
        format!("not complete: the curve of equilibria was followed in part\n({angles}),\nthen {}", ends.join("; and "))
    }

    fn figure(&self, title: &str, page: &Page) -> Scene {
        equilibria_figure(self, title, page)
    }

    fn chart(found: &[(f64, &Self)], over: &Abscissa, quantity: Quantity, title: &str, page: &Page) -> Scene {
        over_figure(found, over, quantity, title, page)
    }
}

impl EquilibriaIn for SpatialEquilibria {
    type Shape = SpatialConfiguration;
    type Error = SpatialError;
    const CURVES: &'static str = "curves over turns of the base";
    // There may be others.
    const CALLED: &'static str = "equilibria";

    fn search(arm: &Arm, tol: f64, go_on: impl FnMut(usize) -> bool) -> Result<Self, PathError<SpatialError>> {
        arm.equilibria_in_space_while(tol, go_on)
    }

    fn all(&self) -> Search<'_> {
        self.into()
    }

    fn shapes(&self) -> Vec<(&SpatialConfiguration, Option<Stability>)> {
        self.found.iter().map(|one| (&one.configuration, one.stability)).collect()
    }

    fn extent(&self) -> String {
        let followed = format!("{} curves over turns of the base were followed", self.curves.len());
        let mut out = if self.misses_some() {
            format!("not complete, at least one is missing: {followed}")
        } else {
            format!("there may be others: {followed}")
        };
        if self.circles {
            out.push_str(",\narm and loads are alike on all sides of the axis: a bent shape stands for all that are turned about it");
        }
        let mut ends: Vec<String> = self.curves.iter().flatten().map(|end| curve_message(*end)).collect();
        ends.sort();
        ends.dedup();
        if !ends.is_empty() {
            let _ = write!(out, ",\nsome to an end: {}", ends.join("; "));
        }
        out
    }

    fn figure(&self, title: &str, page: &Page) -> Scene {
        spatial_equilibria_figure(self, title, page)
    }

    fn chart(found: &[(f64, &Self)], over: &Abscissa, quantity: Quantity, title: &str, page: &Page) -> Scene {
        spatial_over_figure(found, over, quantity, title, page)
    }
}

pub(crate) fn run(args: &EquilibriaArgs) -> anyhow::Result<()> {
    let arm = request::arm_in_space(&args.arm)?;
    check_quantity(&arm, args.quantity)?;
    if let Some(Over { varied, .. }) = &args.over {
        varied.parameter.of(&arm).map_err(|e| WrongRequest::Unfit("--over", e))?;
    }
    let pictures = [("--plot", args.plot.as_deref()), ("--plot-over", args.plot_over.as_deref())];
    let outputs = [("-o", args.output.as_deref()), pictures[0], pictures[1]];
    request::check_outputs(&[request::arm_input(&args.arm.file)], &outputs)?;
    request::check_picture(&args.picture, &pictures)?;
    match (&args.over, arm.space.is_some()) {
        (Some(over), false) => over_range::<Equilibria>(args, &arm, *over),
        (Some(over), true) => over_range::<SpatialEquilibria>(args, &arm, *over),
        (None, false) => at_loads::<Equilibria>(args, &arm),
        (None, true) => at_loads::<SpatialEquilibria>(args, &arm),
    }
}

fn at_loads<F: EquilibriaIn>(args: &EquilibriaArgs, arm: &Arm) -> anyhow::Result<()> {
    let all: F = search(arm, args)?;
    let nothing = all.shapes().is_empty();
    if let Some(file) = args.plot.as_ref().filter(|_| !nothing) {
        let title = format!("{}: {}", arm.name, F::CALLED);
        output::draw(&all.figure(&title, &args.picture.page()), file, &args.picture.page)?;
    }
    let text = match args.format {
        Format::Text => summary(arm, &all),
        Format::Json => output::line(EquilibriaDocument::new(arm, all.all()).to_json()),
        Format::Csv => equilibria_csv(arm.cables.len(), all.all()),
    };
    output::put(args.output.as_deref(), &text)?;
    if nothing {
        return Err(NoAnswer(format!("no equilibrium was found; {}", all.extent().replace('\n', " "))).into());
    }
    Ok(())
}

/// The equilibria of `arm` that are found within the time limit. `place` says where the search is among others.
fn within<F: EquilibriaIn>(
    arm: &Arm,
    args: &EquilibriaArgs,
    progress: &mut Progress,
    place: &str,
) -> Result<F, PathError<F::Error>> {
    let start = Instant::now();
    F::search(arm, args.tol, |points| {
        progress.say(|| format!("{place}{points} points of {}", F::CURVES));
        args.time_limit.is_none_or(|limit| start.elapsed() < limit)
    })
}

/// The equilibria of `arm`; an error says what a solve at its own base angle says.
fn search<F: EquilibriaIn>(arm: &Arm, args: &EquilibriaArgs) -> anyhow::Result<F> {
    within(arm, args, &mut Progress::new(), "").map_err(|error| match error {
        PathError::Start { source, .. } => {
            let message = format!("no equilibrium was found at any base angle; at the angle of the arm, {source}");
            anyhow::Error::new(source).context(message)
        }
        PathError::Option { option, value, expected } => wrong_option(option, value, expected, error),
        other => other.into(),
    })
}

fn over_range<F: EquilibriaIn>(args: &EquilibriaArgs, arm: &Arm, over: Over) -> anyhow::Result<()> {
    let varied = over.varied;
    let mut progress = Progress::new();
    let searches = at_values(arm, over, |there, Value { number, count, at }| {
        let place = format!("value {number} of {count}, {at}, ");
        match within::<F>(there, args, &mut progress, &place) {
            Ok(all) => Ok(Ok(all)),
            Err(PathError::Start { source, .. }) => Ok(Err(source.to_string())),
            Err(other) => Err(other).with_context(|| at.clone()),
        }
    })?;
    if let Some(file) = &args.plot_over {
        let found: Vec<(f64, &F)> =
            searches.iter().filter_map(|(value, all)| Some((*value, all.as_ref().ok()?))).collect();
        let (title, page) = (title(arm, &varied), args.picture.page());
        let figure = F::chart(&found, &abscissa(&varied), args.quantity, &title, &page);
        output::draw(&figure, file, &args.picture.page)?;
    }
    let found: Vec<(f64, Result<Search<'_>, String>)> =
        searches.iter().map(|(value, all)| (*value, all.as_ref().map(F::all).map_err(Clone::clone))).collect();
    let text = match args.format {
        Format::Text => over_summary(arm, &varied, &found),
        Format::Json => output::line(OverDocument::new(arm, &varied, &found).to_json()),
        Format::Csv => over_csv(arm.cables.len(), &varied, &found),
    };
    output::put(args.output.as_deref(), &text)?;
    say_what_is_missing(&varied, &found, |all| Others::of(*all).count > 0)
}

fn summary<F: EquilibriaIn>(arm: &Arm, all: &F) -> String {
    let mut out = format!("{}: {}\n", arm.name, counted(all.all()));
    let _ = writeln!(out, "{}\n", all.extent());
    let mut head = vec!["number".to_owned()];
    head.extend(F::Shape::TIP.map(str::to_owned));
    head.push("stability".to_owned());
    let mut rows = vec![head];
    for (index, (shape, stability)) in all.shapes().into_iter().enumerate() {
        let mut row = vec![(index + 1).to_string()];
        row.extend(shape.tip_cells());
        row.push(stability_words(stability));
        rows.push(row);
    }
    out.push_str(&table(&rows, 1));
    out
}

/// How many, and how many of them stable.
fn counted(all: Search<'_>) -> String {
    let Others { count, stable, .. } = Others::of(all);
    format!("{count} equilibri{}, {stable} of them stable", if count == 1 { "um" } else { "a" })
}

fn over_summary(arm: &Arm, varied: &Varied, searches: &[(f64, Result<Search<'_>, String>)]) -> String {
    let [from, to] = varied.range.map(|value| varied.with_unit(value));
    let mut out =
        format!("{}: equilibria at {} values of {}, {from} to {to}\n\n", arm.name, searches.len(), varied.parameter);
    let unit = if varied.unit.is_empty() { "value" } else { varied.unit };
    let mut rows = vec![[unit, "equilibria", "stable", "search"].map(str::to_owned).to_vec()];
    for (value, found) in searches {
        let value = number(varied.shown(*value));
        rows.push(match found {
            Ok(all) => {
                let Others { count, stable, complete } = Others::of(*all);
                let search = if complete { "complete" } else { "not complete" };
                vec![value, count.to_string(), stable.to_string(), search.to_owned()]
            }
            Err(_) => vec![value, "0".to_owned(), "0".to_owned(), "none found".to_owned()],
        });
    }
    out.push_str(&table(&rows, 1));
    out
}
