//! Results of arms in space as JSON and CSV: the documents of arms in the plane, with three components and directors.

use hydrostat::{
    AfterSnap, NoSpatialEquilibrium, SpatialConfiguration, SpatialSnapMotion, SpatialStations, SpatialTip,
    SpatialWrench,
};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::results::{CableOut, Note, SCHEMA, SnapOut, StatisticsOut, TOLERANCE_MISSED, VerdictHead, cell, json};
use crate::written::Inputs;

/// The document of an equilibrium in space.
#[derive(Debug, Clone, Serialize)]
pub struct SpatialSolutionDocument<'a> {
    schema: u32,
    version: &'static str,
    converged: bool,
    stable: Option<bool>,
    warnings: &'a [Note],
    snaps: Vec<SnapOut<TipOut>>,
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

/// The document of a solve in space without an answer.
#[derive(Debug, Clone, Serialize)]
pub struct SpatialFailureDocument<'a> {
    schema: u32,
    version: &'static str,
    converged: bool,
    verdict: VerdictOut<'a>,
    last_good: Option<SpatialSolutionDocument<'a>>,
}

#[derive(Debug, Clone, Serialize)]
pub(crate) struct TipOut {
    x: f64,
    y: f64,
    z: f64,
    a: [f64; 3],
    b: [f64; 3],
    c: [f64; 3],
    alpha: f64,
}

impl TipOut {
    /// The heads of [`TipOut::numbers`].
    pub(crate) const COLUMNS: [&str; 13] = [
        "tip_x_m",
        "tip_y_m",
        "tip_z_m",
        "tip_a_x",
        "tip_a_y",
        "tip_a_z",
        "tip_b_x",
        "tip_b_y",
        "tip_b_z",
        "tip_c_x",
        "tip_c_y",
        "tip_c_z",
        "tip_alpha_rad",
    ];

    pub(crate) fn numbers(&self) -> Vec<f64> {
        let directors = self.a.into_iter().chain(self.b).chain(self.c);
        [self.x, self.y, self.z].into_iter().chain(directors).chain([self.alpha]).collect()
    }
}

#[derive(Debug, Clone, Serialize)]
struct StationsOut<'a> {
    s: &'a [f64],
    x: &'a [f64],
    y: &'a [f64],
    z: &'a [f64],
    a: &'a [[f64; 3]],
    b: &'a [[f64; 3]],
    c: &'a [[f64; 3]],
    nu: &'a [f64],
    eta: &'a [f64],
    zeta: &'a [f64],
    tau: &'a [f64],
    kappa: &'a [f64],
    mu: &'a [f64],
    beta: &'a [f64],
    alpha: &'a [f64],
    n_a: &'a [f64],
    n_b: &'a [f64],
    n_c: &'a [f64],
    m_a: &'a [f64],
    m_b: &'a [f64],
    m_c: &'a [f64],
}

#[derive(Debug, Clone, Serialize)]
struct WrenchOut {
    force: [f64; 3],
    moment: [f64; 3],
}

#[derive(Debug, Clone, Serialize)]
struct VerdictOut<'a> {
    #[serde(flatten)]
    head: VerdictHead,
    snaps: Vec<SnapOut<TipOut>>,
    after_snap: Option<SpatialSolutionDocument<'a>>,
    at_full_loads: Option<SpatialSolutionDocument<'a>>,
}

impl From<SpatialTip> for TipOut {
    fn from(SpatialTip { x, y, z, a, b, c, alpha }: SpatialTip) -> Self {
        Self { x, y, z, a, b, c, alpha }
    }
}

impl From<SpatialWrench> for WrenchOut {
    fn from(SpatialWrench { force, moment }: SpatialWrench) -> Self {
        Self { force, moment }
    }
}

impl Note {
    /// The notes on a shape in space after snaps whose motions were followed.
    pub fn after_snap_in_space(found: &AfterSnap<SpatialConfiguration, SpatialTip>, tol: f64) -> Vec<Self> {
        let mut notes = Self::all_in_space(&found.configuration, tol);
        for (note, motion) in notes.iter_mut().filter(|note| note.kind == "snap").zip(&found.snaps) {
            note.message = motion.message(found.configuration.arm.length);
        }
        notes
    }

    /// All notes on a configuration in space, as [`Note::all`].
    pub fn all_in_space(configuration: &SpatialConfiguration, tol: f64) -> Vec<Self> {
        let snaps = configuration.snaps.iter().map(|snap| Self { kind: "snap", message: snap.message() });
        let mut notes: Vec<Self> = snaps.chain(configuration.warnings().iter().map(Self::from)).collect();
        let asked = tol * configuration.arm.length;
        if configuration.error_estimate > asked {
            let [found, asked] = [configuration.error_estimate, asked].map(|metres| 1e3 * metres);
            let message = format!("the tip error, about {found:.1e} mm, is above the {asked:.1e} mm asked for");
            notes.push(Self { kind: TOLERANCE_MISSED, message });
        }
        notes
    }
}

impl<'a> SpatialSolutionDocument<'a> {
    /// Of a configuration with the notes on it.
    pub fn new(configuration: &'a SpatialConfiguration, notes: &'a [Note]) -> Self {
        let SpatialConfiguration { arm, stations: s, base_reaction, unmet, error_estimate, stable, statistics, .. } =
            configuration;
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            converged: true,
            stable: configuration.stability().map_or(*stable, hydrostat::Stability::is_stable),
            warnings: notes,
            snaps: configuration.snaps.iter().map(SnapOut::from).collect(),
            tip: configuration.tip().into(),
            stations: StationsOut {
                s: &s.s,
                x: &s.x,
                y: &s.y,
                z: &s.z,
                a: &s.a,
                b: &s.b,
                c: &s.c,
                nu: &s.nu,
                eta: &s.eta,
                zeta: &s.zeta,
                tau: &s.tau,
                kappa: &s.kappa,
                mu: &s.mu,
                beta: &s.beta,
                alpha: &s.alpha,
                n_a: &s.n_a,
                n_b: &s.n_b,
                n_c: &s.n_c,
                m_a: &s.m_a,
                m_b: &s.m_b,
                m_c: &s.m_c,
            },
            cables: CableOut::of(&configuration.cables),
            base: (*base_reaction).into(),
            unmet: unmet.map(Into::into),
            error_estimate: *error_estimate,
            fold_margin: configuration.fold_margin().value,
            inputs: Inputs::new(arm),
            statistics: (*statistics).into(),
        }
    }

    /// With what is known of the motions after its snaps.
    pub fn with_motions(mut self, motions: &[SpatialSnapMotion], length: f64) -> Self {
        self.snaps = motions.iter().map(|motion| SnapOut::of_motion(motion, length)).collect();
        self
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

impl<'a> SpatialFailureDocument<'a> {
    /// Of a verdict, with the notes on its last good configuration (not used if there is none).
    pub fn new(failure: &'a NoSpatialEquilibrium, notes: &'a [Note]) -> Self {
        let shape = |c: &'a SpatialConfiguration| SpatialSolutionDocument::new(c, &[]);
        let verdict = VerdictOut {
            head: (&failure.verdict).into(),
            snaps: failure.snaps.iter().map(SnapOut::from).collect(),
            after_snap: failure.after_snap.as_ref().map(shape),
            at_full_loads: failure.at_full_loads.as_ref().map(shape),
        };
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            converged: false,
            verdict,
            last_good: failure.last_good.as_ref().map(|c| SpatialSolutionDocument::new(c, notes)),
        }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

/// The stations of an arm in space, one row each, with names and units in the first row.
pub fn spatial_stations_csv(st: &SpatialStations) -> String {
    let part = |vectors: &[[f64; 3]], k: usize| -> Vec<f64> { vectors.iter().map(|v| v[k]).collect() };
    let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
    let mut push = |name: &str, values: Vec<f64>| columns.push((name.to_owned(), values));
    for (name, values) in [("s_m", &st.s), ("x_m", &st.x), ("y_m", &st.y), ("z_m", &st.z)] {
        push(name, values.clone());
    }
    for (name, vectors) in [("a", &st.a), ("b", &st.b), ("c", &st.c)] {
        for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
            push(&format!("{name}_{axis}"), part(vectors, k));
        }
    }
    for (name, values) in [
        ("nu", &st.nu),
        ("eta", &st.eta),
        ("zeta", &st.zeta),
        ("tau_per_m", &st.tau),
        ("kappa_per_m", &st.kappa),
        ("mu_per_m", &st.mu),
        ("beta", &st.beta),
        ("alpha_rad", &st.alpha),
        ("n_a_N", &st.n_a),
        ("n_b_N", &st.n_b),
        ("n_c_N", &st.n_c),
        ("m_a_Nm", &st.m_a),
        ("m_b_Nm", &st.m_b),
        ("m_c_Nm", &st.m_c),
    ] {
        push(name, values.clone());
    }
    let names: Vec<String> = columns.iter().map(|(name, _)| name.clone()).collect();
    let mut out = Rows::new(&names);
    for index in 0..st.len() {
        let row: Vec<String> =
            columns.iter().map(|(_, values)| values.get(index).copied().map_or_else(String::new, cell)).collect();
        out.row(&row);
    }
    out.text()
}

/// Columns of [`spatial_stations_csv`] that nobody measures.
pub(crate) const INNER_IN_SPACE: [&str; 23] = [
    "a_x",
    "a_y",
    "a_z",
    "b_x",
    "b_y",
    "b_z",
    "c_x",
    "c_y",
    "c_z",
    "nu",
    "eta",
    "zeta",
    "tau_per_m",
    "kappa_per_m",
    "mu_per_m",
    "beta",
    "alpha_rad",
    "n_a_N",
    "n_b_N",
    "n_c_N",
    "m_a_Nm",
    "m_b_Nm",
    "m_c_Nm",
];
