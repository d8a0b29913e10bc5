//! Results as people and programs get them: JSON and CSV.
//!
//! Numbers are written with the fewest digits that read back as the same number. What is not
//! finite is `null` in JSON and an empty field in CSV.

use hydrostat::{
    AfterSnap, CableState, Configuration, NoEquilibrium, Pose, Snap, SnapMotion, Stability, Stations, Statistics, Tip,
    Verdict, Warning, Wrench,
};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::others::Others;
use crate::slips::Slip;
use crate::written::Inputs;

/// The version of the JSON documents' structure.
pub const SCHEMA: u32 = 1;

/// The document of an equilibrium that was found.
#[derive(Debug, Clone, Serialize)]
pub struct SolutionDocument<'a> {
    schema: u32,
    version: &'static str,
    converged: bool,
    stable: Option<bool>,
    warnings: &'a [Note],
    snaps: Vec<SnapOut>,
    tip: TipOut,
    stations: StationsOut<'a>,
    cables: Vec<CableOut<'a>>,
    base: WrenchOut,
    #[serde(skip_serializing_if = "Option::is_none")]
    unmet: Option<WrenchOut>,
    error_estimate: f64,
    fold_margin: f64,
    inputs: Inputs,
    statistics: StatisticsOut,
}

/// The document of a solve without an answer.
#[derive(Debug, Clone, Serialize)]
pub struct FailureDocument<'a> {
    schema: u32,
    version: &'static str,
    converged: bool,
    verdict: VerdictOut<'a>,
    last_good: Option<SolutionDocument<'a>>,
}

/// The kind of the note on an answer that is less accurate than was asked for.
pub const TOLERANCE_MISSED: &str = "tolerance_missed";

/// The kind of the note on a number of the arm that looks like a slip of the unit.
pub const UNIT_SLIP: &str = "unit_slip";

/// Something that should be known about an answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Note {
    /// The name in results: `surface_fold` and so on.
    pub kind: &'static str,
    /// The note in a sentence.
    pub message: String,
}

impl Note {
    /// All notes on `configuration`, of which a tip error of `tol` over the length was asked for: its
    /// warnings, and `tolerance_missed` where the estimate is above that.
    pub fn all(configuration: &Configuration, tol: f64) -> Vec<Self> {
        let mut notes: Vec<Self> = configuration.warnings().iter().map(Self::from).collect();
        let asked = tol * configuration.arm.length;
        if configuration.error_estimate > asked {
            let [found, asked] = [configuration.error_estimate, asked].map(|metres| 1e3 * metres);
            let message = format!("the tip error, about {found:.1e} mm, is above the tolerance of {asked:.1e} mm");
            notes.push(Self { kind: TOLERANCE_MISSED, message });
        }
        notes
    }
}

impl Note {
    /// The notes on a shape after snaps whose motions were followed.
    pub fn after_snap(found: &AfterSnap, tol: f64) -> Vec<Self> {
        let length = found.configuration.arm.length;
        let mut notes = Self::all(&found.configuration, tol);
        for (note, motion) in notes.iter_mut().filter(|note| note.kind == "snap").zip(&found.snaps) {
            note.message = motion.message(length);
        }
        notes
    }
}

impl From<&Slip> for Note {
    fn from(slip: &Slip) -> Self {
        Self { kind: UNIT_SLIP, message: slip.to_string() }
    }
}

impl From<&Warning> for Note {
    fn from(warning: &Warning) -> Self {
        Self { kind: warning.kind(), message: warning.message() }
    }
}

#[derive(Debug, Clone, Serialize)]
pub(crate) struct TipOut {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) theta: f64,
    pub(crate) alpha: f64,
}

#[derive(Debug, Clone, Serialize)]
struct StationsOut<'a> {
    s: &'a [f64],
    x: &'a [f64],
    y: &'a [f64],
    theta: &'a [f64],
    nu: &'a [f64],
    eta: &'a [f64],
    mu: &'a [f64],
    beta: &'a [f64],
    alpha: &'a [f64],
    n_a: &'a [f64],
    n_b: &'a [f64],
    m: &'a [f64],
}

#[derive(Debug, Clone, Serialize)]
pub(crate) struct CableOut<'a> {
    name: &'a str,
    pub(crate) tension: f64,
    length: f64,
    pub(crate) stroke: f64,
    /// Only where the stroke was commanded.
    #[serde(skip_serializing_if = "Option::is_none")]
    command: Option<CommandOut>,
}

#[derive(Debug, Clone, Serialize)]
struct CommandOut {
    stroke: f64,
    length: f64,
    slack: bool,
}

#[derive(Debug, Clone, Serialize)]
struct WrenchOut {
    force: [f64; 2],
    moment: f64,
}

#[derive(Debug, Clone, Serialize)]
pub(crate) struct StatisticsOut {
    elements: usize,
    stages: usize,
    newton_rounds: usize,
    meshes: usize,
    load_steps: usize,
    evaluations: usize,
}

/// A snap, with the phase and load fraction at which the arm leaves its path.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct SnapOut<T = TipOut> {
    phase: &'static str,
    load_fraction: f64,
    before: T,
    after: T,
    /// m
    distance: f64,
    /// rad
    angle: f64,
    /// Only where the motion after the snap was followed.
    #[serde(flatten)]
    motion: Option<SnapMotionOut>,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct SnapMotionOut {
    /// s
    duration: f64,
    /// Whether the motion ends in another shape than the curve of equilibria; `null` if the curve does not continue.
    lands_elsewhere: Option<bool>,
}

impl<T> SnapOut<T> {
    pub(crate) fn of_motion<P: Pose + Into<T>>(motion: &SnapMotion<P>, length: f64) -> Self {
        let lands_elsewhere = motion.on_curve.map(|_| motion.lands_elsewhere(length));
        let followed = SnapMotionOut { duration: motion.duration, lands_elsewhere };
        Self { motion: Some(followed), ..Self::from(&motion.snap) }
    }
}

impl<P: Pose + Into<T>, T> From<&Snap<P>> for SnapOut<T> {
    fn from(snap: &Snap<P>) -> Self {
        Self {
            phase: snap.phase.name(),
            load_fraction: snap.load_fraction,
            before: snap.before.into(),
            after: snap.after.into(),
            distance: snap.distance(),
            angle: snap.angle(),
            motion: None,
        }
    }
}

/// What every verdict says.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct VerdictHead {
    kind: &'static str,
    phase: &'static str,
    load_fraction: f64,
    s: Option<f64>,
    residual: f64,
    message: String,
    advice: String,
}

#[derive(Debug, Clone, Serialize)]
struct VerdictOut<'a> {
    #[serde(flatten)]
    head: VerdictHead,
    other_equilibria: Option<Others>,
    snaps: Vec<SnapOut>,
    after_snap: Option<SolutionDocument<'a>>,
    at_full_loads: Option<SolutionDocument<'a>>,
}

impl TipOut {
    pub(crate) fn new(configuration: &Configuration) -> Self {
        configuration.tip().into()
    }
}

impl From<Tip> for TipOut {
    fn from(Tip { x, y, theta, alpha }: Tip) -> Self {
        Self { x, y, theta, alpha }
    }
}

impl<'a> CableOut<'a> {
    pub(crate) fn all(configuration: &'a Configuration) -> Vec<Self> {
        Self::of(&configuration.cables)
    }

    pub(crate) fn of(cables: &'a [CableState]) -> Vec<Self> {
        let out = |c: &'a CableState| Self {
            name: &c.name,
            tension: c.tension,
            length: c.length,
            stroke: c.stroke,
            command: c.command.map(|c| CommandOut { stroke: c.stroke, length: c.length, slack: c.slack }),
        };
        cables.iter().map(out).collect()
    }
}

impl From<Wrench> for WrenchOut {
    fn from(w: Wrench) -> Self {
        Self { force: w.force, moment: w.moment }
    }
}

impl From<&Verdict> for VerdictHead {
    fn from(v: &Verdict) -> Self {
        Self {
            kind: v.kind.name(),
            phase: v.phase.name(),
            load_fraction: v.load_fraction,
            s: v.s,
            residual: v.residual,
            message: v.message(),
            advice: v.advice().to_string(),
        }
    }
}

impl From<Statistics> for StatisticsOut {
    fn from(statistics: Statistics) -> Self {
        let Statistics { elements, stages, newton_rounds, meshes, load_steps, evaluations } = statistics;
        Self { elements, stages, newton_rounds, meshes, load_steps, evaluations }
    }
}

impl<'a> SolutionDocument<'a> {
    /// Of a configuration with its `fold_margin` (the least (nu - beta R |mu|)/nu) and the notes on it.
    pub fn new(configuration: &'a Configuration, fold_margin: f64, notes: &'a [Note]) -> Self {
        let Configuration { arm, stations: s, base_reaction, unmet, error_estimate, stable, statistics, .. } =
            configuration;
        let stable = configuration.stability().map_or(*stable, Stability::is_stable);
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            converged: true,
            stable,
            warnings: notes,
            snaps: configuration.snaps.iter().map(SnapOut::from).collect(),
            tip: TipOut::new(configuration),
            stations: StationsOut {
                s: &s.s,
                x: &s.x,
                y: &s.y,
                theta: &s.theta,
                nu: &s.nu,
                eta: &s.eta,
                mu: &s.mu,
                beta: &s.beta,
                alpha: &s.alpha,
                n_a: &s.n_a,
                n_b: &s.n_b,
                m: &s.m,
            },
            cables: CableOut::all(configuration),
            base: (*base_reaction).into(),
            unmet: unmet.map(Into::into),
            error_estimate: *error_estimate,
            fold_margin,
            inputs: Inputs::new(arm),
            statistics: (*statistics).into(),
        }
    }

    /// With what is known of the motions after its snaps.
    pub fn with_motions(mut self, motions: &[SnapMotion], length: f64) -> Self {
        self.snaps = motions.iter().map(|motion| SnapOut::of_motion(motion, length)).collect();
        self
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

impl<'a> FailureDocument<'a> {
    /// Of a verdict, with the fold margin of its last good configuration and the notes on it (not used
    /// if there is none).
    pub fn new(failure: &'a NoEquilibrium, fold_margin: f64, notes: &'a [Note]) -> Self {
        let shape = |c: &'a Configuration| SolutionDocument::new(c, c.fold_margin().value, &[]);
        let verdict = VerdictOut {
            head: (&failure.verdict).into(),
            other_equilibria: None,
            snaps: failure.snaps.iter().map(SnapOut::from).collect(),
            after_snap: failure.after_snap.as_ref().map(shape),
            at_full_loads: failure.at_full_loads.as_ref().map(shape),
        };
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            converged: false,
            verdict,
            last_good: failure.last_good.as_ref().map(|c| SolutionDocument::new(c, fold_margin, notes)),
        }
    }

    /// With what a search for other equilibria at the same loads found.
    pub fn with_others(mut self, others: Option<Others>) -> Self {
        self.verdict.other_equilibria = others;
        self
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

/// A document of fields, numbers, words and lists as JSON, one line. Such a document always becomes JSON: what does not is a map whose
/// keys are no texts, or what its own `Serialize` refuses.
pub fn json(document: &impl Serialize) -> String {
    let text = serde_json::to_string(document);
    debug_assert!(text.is_ok(), "{text:?}");
    text.unwrap_or_default()
}

/// A number as a cell of CSV; empty if it is not finite.
pub(crate) fn cell(value: f64) -> String {
    if value.is_finite() { format!("{value:?}") } else { String::new() }
}

/// The stations, one row each, with names and units in the first row.
pub fn stations_csv(stations: &Stations) -> String {
    let columns: [(&str, &[f64]); 12] = [
        (PLACE, &stations.s),
        ("x_m", &stations.x),
        ("y_m", &stations.y),
        (THETA, &stations.theta),
        ("nu", &stations.nu),
        ("eta", &stations.eta),
        ("mu_per_m", &stations.mu),
        ("beta", &stations.beta),
        ("alpha_rad", &stations.alpha),
        ("n_a_N", &stations.n_a),
        ("n_b_N", &stations.n_b),
        ("m_Nm", &stations.m),
    ];
    let mut out = Rows::new(&columns.map(|(name, _)| name.to_owned()));
    for index in 0..stations.len() {
        out.row(&columns.map(|(_, values)| values.get(index).copied().map_or_else(String::new, cell)));
    }
    out.text()
}

/// The head of the place in [`stations_csv`].
pub(crate) const PLACE: &str = "s_m";
/// The head of the section's angle in [`stations_csv`].
pub(crate) const THETA: &str = "theta_rad";
/// Heads of [`stations_csv`] that are no measurements: readers of tables leave them out.
pub(crate) const INNER: [&str; 8] = ["nu", "eta", "mu_per_m", "beta", "alpha_rad", "n_a_N", "n_b_N", "m_Nm"];
