//! A few numbers about an equilibrium: the row of a table.

use crate::statics::configuration::{Configuration, FoldMargin, Stations, Tip, Warning, Wrench};
use crate::statics::engine::Engine;
use crate::statics::equations::StationData;
use crate::statics::kept::Solved;
use crate::statics::snap::Snap;
use crate::statics::stability::Stability;

/// What is asked of every row beyond tip, base reaction and error estimate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[allow(clippy::struct_excessive_bools, reason = "each is asked for by itself")]
pub struct Wanted {
    /// How far each cable is reeled in.
    pub strokes: bool,
    /// How far the surface is from folding: reads the whole configuration.
    pub fold_margin: bool,
    /// Stability, two to three milliseconds.
    pub stability: bool,
    /// What should be known about the answer: reads the whole configuration.
    pub warnings: bool,
    /// So many equally spaced stations; none below two.
    pub stations: usize,
}

impl Wanted {
    /// Whether it takes the whole configuration.
    pub(crate) fn reads_stations(self) -> bool {
        self.fold_margin || self.stability || self.warnings || self.stations >= 2
    }
}

/// The answer of one row, in the plane or, as [`crate::SpatialRow`], in space.
#[derive(Debug, Clone, PartialEq)]
pub struct Row<T = Tip, W = Wrench, S = Stations> {
    /// Where the tip is.
    pub tip: T,
    /// What support and cable anchors exert on the arm at the base.
    pub base_reaction: W,
    /// Estimated error of the tip position, m.
    pub error_estimate: f64,
    /// Tension of each cable at the base, N.
    pub tensions: Vec<f64>,
    /// How far each cable is reeled in, m; empty unless asked for.
    pub strokes: Vec<f64>,
    /// How far the surface is from folding, if asked for.
    pub fold_margin: Option<FoldMargin>,
    /// `None` where it was not asked for or is not established.
    pub stability: Option<Stability>,
    /// What should be known about the answer; empty unless asked for.
    pub warnings: Vec<Warning>,
    /// The snaps that the arm makes as its loads grow from nothing to these.
    pub snaps: Vec<Snap<T>>,
    /// How long each of them takes, s, where their motions were followed; else empty.
    pub snap_durations: Vec<f64>,
    /// Empty unless asked for.
    pub stations: S,
}

/// The row of what is wanted of a configuration, in the plane or in space.
macro_rules! row_of {
    ($configuration:expr, $wanted:expr) => {{
        let (configuration, wanted): (_, $crate::statics::row::Wanted) = ($configuration, $wanted);
        let cables = &configuration.cables;
        Self {
            tip: configuration.tip(),
            base_reaction: configuration.base_reaction,
            error_estimate: configuration.error_estimate,
            tensions: cables.iter().map(|cable| cable.tension).collect(),
            strokes: if wanted.strokes { cables.iter().map(|cable| cable.stroke).collect() } else { Vec::new() },
            fold_margin: wanted.fold_margin.then(|| configuration.fold_margin()),
            stability: if wanted.stability { configuration.stability() } else { None },
            warnings: if wanted.warnings { configuration.warnings() } else { Vec::new() },
            snaps: configuration.snaps.clone(),
            snap_durations: Vec::new(),
            stations: if wanted.stations < 2 { Default::default() } else { configuration.resampled(wanted.stations) },
        }
    }};
}
pub(crate) use row_of;

impl Row {
    /// What is wanted of a configuration.
    ///
    /// ```
    /// use hydrostat::{Arm, Row, Wanted};
    ///
    /// let shape = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5).solve()?;
    /// let row = Row::new(&shape, Wanted { fold_margin: true, ..Wanted::default() });
    /// assert_eq!((row.tip, row.fold_margin.is_some()), (shape.tip(), true));
    /// # Ok::<(), hydrostat::SolveError>(())
    /// ```
    pub fn new(configuration: &Configuration, wanted: Wanted) -> Self {
        row_of!(configuration, wanted)
    }

    /// From what the engine has at hand, where that is enough for what is wanted. `None` where the tip cannot be read.
    pub(crate) fn at_hand(engine: &mut Engine, solved: &Solved, wanted: Wanted) -> Option<Self> {
        let mut strokes = Vec::new();
        if wanted.strokes {
            engine.system.take_stations(&engine.solution);
            let (equations, at) = (&engine.equations, StationData::of(&engine.system));
            let stroke = |cable| {
                let [now, unloaded] = equations.cable_lengths(cable, at);
                equations.units.length * (unloaded - now)
            };
            strokes = (0..equations.arm().cables.len()).map(stroke).collect();
        }
        let tip = engine.read_tip().ok()?;
        let (arm, units) = (engine.equations.arm(), engine.equations.units);
        Some(Self {
            tip,
            base_reaction: Wrench::of_base(engine.solution.nodes[0], &units),
            error_estimate: solved.estimate * units.length,
            tensions: arm.cables.iter().map(|cable| cable.tension).collect(),
            strokes,
            fold_margin: None,
            stability: None,
            warnings: Vec::new(),
            snaps: solved.snaps.clone(),
            snap_durations: Vec::new(),
            stations: Stations::default(),
        })
    }
}
