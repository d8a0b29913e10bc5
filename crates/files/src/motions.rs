//! Motions as JSON and CSV.

use hydrostat::{
    Arm, Instant, MotionEvent, MotionStation, MotionStatistics, MotionVerdict, MotionWarning, SpatialMotionStation,
    Tip, Works,
};
use serde::Serialize;

use crate::csv_text::csv_row;
use crate::results::{Note, SCHEMA, cell, json};
use crate::written::Inputs;

/// The heads of [`motion_row`] for an arm with so many cables.
pub fn motion_columns(cables: usize) -> Vec<String> {
    motion_heads(cables, 0, false)
}

/// The heads of a row with so many stations, and with the equilibrium of the same loads if `equilibrium`: those of
/// [`motion_numbers`], then of [`place_numbers`] for each station, then of [`equilibrium_numbers`].
pub fn motion_heads(cables: usize, stations: usize, equilibrium: bool) -> Vec<String> {
    let mut out: Vec<String> = ["t_s", "tip_x_m", "tip_y_m", "tip_theta_rad"].map(str::to_owned).into();
    out.extend((0..cables).flat_map(|c| [format!("stroke_{c}_m"), format!("tension_{c}_N")]));
    let others = [
        "kinetic_energy_J",
        "strain_energy_J",
        "tip_vx_m_s",
        "tip_vy_m_s",
        "base_force_x_N",
        "base_force_y_N",
        "base_moment_Nm",
    ];
    out.extend(others.into_iter().chain(WORK_HEADS).map(str::to_owned));
    for k in 0..stations {
        out.extend(["s_m", "x_m", "y_m", "theta_rad", "vx_m_s", "vy_m_s"].map(|head| format!("place_{k}_{head}")));
    }
    if equilibrium {
        let heads = ["x_m", "y_m", "theta_rad", "distance"];
        out.extend(heads.map(|head| format!("equilibrium_{head}")));
    }
    out
}

/// The heads of [`work_numbers`].
pub(crate) const WORK_HEADS: [&str; 7] =
    ["cable_work_J", "water_work_J", "gravity_work_J", "load_work_J", "base_work_J", "volume_work_J", "dissipated_J"];

/// Works in the order of rows.
pub(crate) fn work_numbers(works: &Works) -> [f64; 7] {
    [works.cables, works.water, works.gravity, works.loads, works.base, works.volume, works.dissipated]
}

/// One time of a motion as the numbers of a row, in the order of [`motion_columns`].
pub fn motion_numbers(at: &Instant) -> Vec<f64> {
    let mut out = vec![at.time, at.tip[0], at.tip[1], at.tip_theta];
    out.extend(at.cables.iter().flat_map(|cable| [cable.stroke, cable.tension]));
    out.extend([at.kinetic_energy, at.strain_energy, at.tip_velocity[0], at.tip_velocity[1]]);
    let base = at.base_reaction;
    out.extend([base.force[0], base.force[1], base.moment]);
    out.extend(work_numbers(&at.works));
    out
}

/// A station at one time as the numbers that a row has of it.
pub fn place_numbers(at: &MotionStation) -> [f64; 6] {
    [at.s, at.x, at.y, at.theta, at.velocity[0], at.velocity[1]]
}

/// The tip of the equilibrium under the loads of the same time, and how far from it the tip is over the arm's `length`
/// (m); not a number where there is none.
pub fn equilibrium_numbers(at: &Instant, equilibrium: Option<Tip>, length: f64) -> [f64; 4] {
    equilibrium
        .map_or([f64::NAN; 4], |tip| [tip.x, tip.y, tip.theta, (at.tip[0] - tip.x).hypot(at.tip[1] - tip.y) / length])
}

/// One time of a motion as a line of CSV, with its end of line. Of all numbers there are as many digits as it takes.
pub fn motion_row(at: &Instant) -> String {
    motion_line(&motion_numbers(at))
}

/// Numbers as a line of CSV, with its end of line; what is no number is an empty cell.
pub fn motion_line(numbers: &[f64]) -> String {
    let cells: Vec<String> = numbers.iter().copied().map(cell).collect();
    csv_row(&cells)
}

/// The heads of [`motion_shape_lines`].
pub const MOTION_SHAPE_HEADS: &str = "t_s,s_m,x_m,y_m,theta_rad,nu,eta,mu_per_m,vx_m_s,vy_m_s,omega_rad_s";

/// A whole shape at one time (s) as lines of CSV, one a station.
pub fn motion_shape_lines(time: f64, stations: &[MotionStation]) -> String {
    let line = |at: &MotionStation| {
        let [vx, vy] = at.velocity;
        motion_line(&[time, at.s, at.x, at.y, at.theta, at.nu, at.eta, at.mu, vx, vy, at.omega])
    };
    stations.iter().map(line).collect()
}

/// The heads of [`motion_event_line`].
pub const MOTION_EVENT_HEADS: &str = "t_s,event,cable,s_m";

/// An event as a line of CSV.
pub fn motion_event_line(event: &EventOut) -> String {
    let cable = event.cable.map_or_else(String::new, |cable| cable.to_string());
    csv_row(&[cell(event.time), event.kind.to_owned(), cable, event.s.map_or_else(String::new, cell)])
}

/// An event as documents have it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EventOut {
    /// s.
    pub time: f64,
    /// `slack`, `taut`, `surface_folds`, `surface_unfolds`, or the limit that ended the motion: `cable_fold` and so on.
    pub kind: &'static str,
    /// The index of the cable.
    pub cable: Option<usize>,
    /// Where along the arm, m.
    pub s: Option<f64>,
}

impl EventOut {
    /// The events of a motion, and the limit of the arm that ended it.
    pub fn all(events: &[MotionEvent], end: Option<&MotionVerdict>) -> Vec<Self> {
        let one = |event: &MotionEvent| {
            let kind = event.kind;
            Self { time: event.time, kind: kind.name(), cable: kind.cable(), s: kind.place() }
        };
        let last = |end: &MotionVerdict| Self { time: end.time, kind: end.kind.name(), cable: None, s: end.s };
        events.iter().map(one).chain(end.map(last)).collect()
    }
}

/// A whole shape at one time, as documents have it.
#[derive(Debug, Clone, Serialize)]
pub struct MotionShape {
    time: f64,
    #[serde(flatten)]
    lists: ShapeLists,
}

#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
enum ShapeLists {
    Plane {
        s: Vec<f64>,
        x: Vec<f64>,
        y: Vec<f64>,
        theta: Vec<f64>,
        nu: Vec<f64>,
        eta: Vec<f64>,
        mu: Vec<f64>,
    },
    Space {
        s: Vec<f64>,
        x: Vec<f64>,
        y: Vec<f64>,
        z: Vec<f64>,
        a: Vec<[f64; 3]>,
        b: Vec<[f64; 3]>,
        c: Vec<[f64; 3]>,
        nu: Vec<f64>,
        eta: Vec<f64>,
        zeta: Vec<f64>,
        tau: Vec<f64>,
        kappa: Vec<f64>,
        mu: Vec<f64>,
    },
}

impl MotionShape {
    /// Of an arm in the plane at `time` (s).
    pub fn in_plane(time: f64, stations: &[MotionStation]) -> Self {
        let list = |of: fn(&MotionStation) -> f64| stations.iter().map(of).collect();
        let lists = ShapeLists::Plane {
            s: list(|at| at.s),
            x: list(|at| at.x),
            y: list(|at| at.y),
            theta: list(|at| at.theta),
            nu: list(|at| at.nu),
            eta: list(|at| at.eta),
            mu: list(|at| at.mu),
        };
        Self { time, lists }
    }

    /// Of an arm in space at `time` (s).
    pub fn in_space(time: f64, stations: &[SpatialMotionStation]) -> Self {
        let list = |of: fn(&SpatialMotionStation) -> f64| stations.iter().map(of).collect();
        let vectors = |of: fn(&SpatialMotionStation) -> [f64; 3]| stations.iter().map(of).collect();
        let lists = ShapeLists::Space {
            s: list(|at| at.s),
            x: list(|at| at.place[0]),
            y: list(|at| at.place[1]),
            z: list(|at| at.place[2]),
            a: vectors(|at| at.a),
            b: vectors(|at| at.b),
            c: vectors(|at| at.c),
            nu: list(|at| at.strains[0]),
            eta: list(|at| at.strains[1]),
            zeta: list(|at| at.strains[2]),
            tau: list(|at| at.strains[3]),
            kappa: list(|at| at.strains[4]),
            mu: list(|at| at.strains[5]),
        };
        Self { time, lists }
    }
}

/// The document of a motion.
#[derive(Debug, Clone, Serialize)]
pub struct MotionDocument {
    schema: u32,
    version: &'static str,
    /// Whether the motion was known up to the time asked for.
    complete: bool,
    /// Why not.
    verdict: Option<String>,
    error_estimate: f64,
    statistics: StatisticsOut,
    /// What the steps gained or lost of energy, J.
    energy_gap: Option<f64>,
    warnings: Vec<Note>,
    events: Vec<EventOut>,
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
    shapes: Vec<MotionShape>,
    inputs: Inputs,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct StatisticsOut {
    steps: usize,
    rejected: usize,
    solves: usize,
    rounds: usize,
    elements: usize,
}

impl MotionDocument {
    /// Of a run of `arm`, whose estimated error of the tip is `error_estimate` (m); `verdict` says why it ended early.
    pub fn new(
        arm: &Arm,
        instants: &[Instant],
        statistics: MotionStatistics,
        error_estimate: f64,
        verdict: Option<String>,
    ) -> Self {
        let MotionStatistics { steps, rejected, solves, rounds, elements } = statistics;
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            complete: verdict.is_none(),
            verdict,
            error_estimate,
            statistics: StatisticsOut { steps, rejected, solves, rounds, elements },
            energy_gap: None,
            warnings: Vec::new(),
            events: Vec::new(),
            columns: motion_columns(arm.cables.len()),
            rows: instants.iter().map(motion_numbers).collect(),
            shapes: Vec::new(),
            inputs: Inputs::new(arm),
        }
    }

    /// The same with a table of its own, whose heads are `columns`.
    pub fn with_table(self, columns: Vec<String>, rows: Vec<Vec<f64>>) -> Self {
        Self { columns, rows, ..self }
    }

    /// The same with whole shapes.
    pub fn with_shapes(self, shapes: Vec<MotionShape>) -> Self {
        Self { shapes, ..self }
    }

    /// The same with what happened on the way, what should be known, and what the steps gained of energy (J).
    pub fn with_notes(self, events: Vec<EventOut>, warnings: &[MotionWarning], energy_gap: f64) -> Self {
        let note = |warning: &MotionWarning| Note { kind: warning.kind(), message: warning.message() };
        Self { events, warnings: warnings.iter().map(note).collect(), energy_gap: Some(energy_gap), ..self }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}
