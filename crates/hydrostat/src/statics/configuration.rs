//! The answer: the arm's shape and what it carries.

use crate::rod::arm::{Arm, Cable, FlowLaw};
use crate::rod::flow::layer_profile;
use crate::rod::loads::stream_along;
use crate::rod::model_options::Support;
use crate::statics::dense::Dense;
use crate::statics::engine::{Engine, M, shift_by_tangential_load};
use crate::statics::equations::{SectionFailure, StationData};
use crate::statics::snap::Snap;
use crate::statics::warning::PUBLISHED_CT;

pub use crate::statics::shape::{CableState, Command, FoldMargin, Station, Stations, Statistics, Tip, Wrench};
pub use crate::statics::warning::Warning;

/// The static configuration of an arm.
#[derive(Debug, Clone)]
pub struct Configuration {
    /// The arm with the loads that this configuration balances.
    pub arm: Arm,
    /// The mesh nodes, base to tip; the end of a cable appears twice, with the values on either side.
    pub stations: Stations,
    /// One entry a cable, in the arm's order.
    pub cables: Vec<CableState>,
    /// What support and cable anchors exert on the arm at the base: force in space (N) and moment
    /// about r(0) (N m).
    pub base_reaction: Wrench,
    /// With [`Support::UnstrainedBase`]: n_f(L), m_f(L) less the tip loads.
    pub unmet: Option<Wrench>,
    /// Estimated error of the tip position, m.
    pub error_estimate: f64,
    /// What the solve came to know on its way: `Some(false)` where the determinant says that an odd number of
    /// directions is unstable, or where the path passed bifurcations and a count finds unstable directions, else
    /// `None`. [`Configuration::stability`] establishes it.
    pub stable: Option<bool>,
    /// The snaps that the arm makes as its loads grow from nothing to these, in their order.
    pub snaps: Vec<Snap>,
    /// What the solve took.
    pub statistics: Statistics,
    extremes: Extremes,
    energy: f64,
    dense: Box<Dense>,
}

/// What is looked for along the arm, at the nodes and at the stages between them.
#[derive(Debug, Clone, Copy)]
struct Extremes {
    fold: FoldMargin,
    /// The stretch that is furthest from one.
    nu: f64,
    /// Where, m.
    nu_at: f64,
}

impl Extremes {
    fn note(&mut self, s: f64, [nu, mu]: [f64; 2], half_width: f64) {
        let value = (nu - half_width * mu.abs()) / nu;
        if value < self.fold.value {
            self.fold = FoldMargin { value, s };
        }
        if (nu - 1.0).abs() > (self.nu - 1.0).abs() {
            (self.nu, self.nu_at) = (nu, s);
        }
    }
}

impl Configuration {
    /// Reads the engine's solution out; the engine must be settled.
    pub(crate) fn read(
        engine: &mut Engine,
        error_estimate: f64,
        statistics: Statistics,
    ) -> Result<Self, SectionFailure> {
        engine.system.take_stations(&engine.solution);
        let dense = Box::new(Dense::new(engine));
        let arm = dense.equations.arm_at_fraction();
        let mesh = &dense.solution.mesh;
        let n = mesh.elements();
        let mut extremes = Extremes { fold: FoldMargin { value: 1.0, s: 0.0 }, nu: 1.0, nu_at: 0.0 };
        let (length, force) = (arm.length, dense.equations.units.force);
        let nodes = sides_of_nodes(&dense);
        let mut stations = Stations::default();
        stations.reserve(nodes.len());
        for (station, place) in dense.at_nodes(&nodes)? {
            extremes.note(station.s, [station.nu, station.mu * length], station.beta * place.radius);
            stations.push(&station);
        }

        let mut energy = 0.0;
        let (equations, groups) = (&dense.equations, dense.equations.groups());
        for block in 0..groups.count() * M {
            let station = &engine.system.stations()[block];
            let strained = equations.strain_energy(block, station);
            let weight = |i: usize| length * mesh.step(i) * engine.system.gauss.b[block % M];
            let own = (0..groups.filled(block / M)).map(|lane| (lane, groups.element(block / M, lane)));
            for (lane, i) in own {
                energy += weight(i) * strained.0[lane];
                let (s, [nu, mu], half_width) = equations.stretched(block, station, lane);
                extremes.note(s * length, [nu, mu], half_width);
            }
        }
        let cables = cable_states(&arm, engine);
        let base_reaction = Wrench::of_base(dense.solution.nodes[0], &dense.equations.units);
        let unmet = (arm.model.support == Support::UnstrainedBase).then(|| {
            let end = dense.solution.nodes[n];
            let (load, _) = dense.equations.tip_load(end[0]);
            Wrench {
                force: [force * (end[1] - load[0]), force * (end[2] - load[1])],
                moment: force * length * (end[3] - load[2]),
            }
        });
        Ok(Self {
            arm,
            stations,
            cables,
            base_reaction,
            unmet,
            error_estimate,
            stable: None,
            snaps: Vec::new(),
            statistics,
            extremes,
            energy: energy * force,
            dense,
        })
    }

    /// What it takes to evaluate this configuration anywhere.
    pub(crate) fn dense(&self) -> &Dense {
        &self.dense
    }

    /// Where the tip is.
    pub fn tip(&self) -> Tip {
        let last = |v: &[f64]| v.last().copied().unwrap_or_default();
        Tip {
            x: last(&self.stations.x),
            y: last(&self.stations.y),
            theta: last(&self.stations.theta),
            alpha: last(&self.stations.alpha),
        }
    }

    /// Everything at `s` (m), to the accuracy of the nodes; `s` outside [0, L] is moved to the
    /// nearer end. At the end of a cable, the values on the tip's side. Should the section law have no strains at a
    /// place between two nodes that have some, the values of the nearest node.
    pub fn at(&self, s: f64) -> Station {
        let fraction = (s / self.arm.length).clamp(0.0, 1.0);
        let fraction = if fraction.is_nan() { 0.0 } else { fraction };
        let element = self.dense.solution.mesh.element_of(fraction);
        match self.dense.at(element, fraction) {
            Ok((station, _)) => station,
            // A section that cannot be solved between two that can: as near as the nodes come.
            Err(_) => self.nearest(element, fraction),
        }
    }

    /// What was read at the nearer node of `element` to `fraction` (over L).
    fn nearest(&self, element: usize, fraction: f64) -> Station {
        let st = &self.stations;
        let nodes = self.dense.solution.mesh.nodes();
        let at_end = nodes[element + 1] - fraction < fraction - nodes[element];
        let node = nodes[element + usize::from(at_end)] * self.arm.length;
        let i = (0..st.len())
            .min_by(|i, j| (st.s[*i] - node).abs().total_cmp(&(st.s[*j] - node).abs()))
            .unwrap_or_default();
        Station {
            s: st.s[i],
            x: st.x[i],
            y: st.y[i],
            theta: st.theta[i],
            nu: st.nu[i],
            eta: st.eta[i],
            mu: st.mu[i],
            beta: st.beta[i],
            beta_slope: self.dense.beta_slope_beside(element, at_end) / self.arm.length,
            alpha: st.alpha[i],
            n_a: st.n_a[i],
            n_b: st.n_b[i],
            m: st.m[i],
        }
    }

    /// `count` (at least two) equally spaced stations from base to tip.
    pub fn resampled(&self, count: usize) -> Stations {
        let count = count.max(2);
        let mut out = Stations::default();
        for k in 0..count {
            out.push(&self.at(self.arm.length * k as f64 / (count - 1) as f64));
        }
        out
    }

    /// The deformed surface on the left and on the right at `s` (m): x = r +- beta R b, (4), m.
    pub fn surfaces(&self, s: f64) -> [[f64; 2]; 2] {
        let st = self.at(s);
        let half_width = st.beta * self.arm.radius.at(st.s, self.arm.length).value;
        [offset_point(&st, half_width), offset_point(&st, -half_width)]
    }

    /// Cable `cable` at `s` (m): r + y beta b, m; `None` past its anchor or for a cable that is not there.
    pub fn cable_point(&self, cable: usize, s: f64) -> Option<[f64; 2]> {
        let cable = self.arm.cables.get(cable)?;
        if s > cable.end * self.arm.length * (1.0 + 1e-12) {
            return None;
        }
        let st = self.at(s);
        Some(offset_point(&st, st.beta * cable.offset.at(st.s, self.arm.length).value))
    }

    /// Speed (m/s) of the water along the arm at `s` (m) and the distance `y` (m) from the windward
    /// surface, (7): positive towards the tip. No slip at y = 0, the stream's tangential part from
    /// y = h_inf on: along the centreline, or, with [`crate::FlowSurface::Lateral`], along the windward surface.
    pub fn layer_speed(&self, s: f64, y: f64) -> f64 {
        let st = self.at(s);
        let radius = self.arm.radius.at(st.s, self.arm.length);
        let outer = stream_along(
            self.arm.stream(),
            self.arm.model.flow_surface,
            [st.theta, st.alpha],
            [st.nu, st.eta, st.mu],
            [st.beta, st.beta_slope],
            [radius.value, radius.slope],
        );
        layer_profile(outer, y, self.arm.flow.layer_thickness)
    }

    /// The strain measure 1/2 int (C1 (nu-nu_o)^2 + C2 (eta-eta_o)^2 + C3 (mu-mu_o)^2) A ds, J. Not
    /// a potential of the section law, whose area follows nu: a measure, no more.
    pub fn strain_energy(&self) -> f64 {
        self.energy
    }

    /// How far the surface is from folding over itself.
    pub fn fold_margin(&self) -> FoldMargin {
        self.extremes.fold
    }

    /// What should be known about this answer. Whether it is as good as was asked for is no part of that: compare
    /// [`Configuration::error_estimate`] with the tolerance; results in files note `tolerance_missed`.
    pub fn warnings(&self) -> Vec<Warning> {
        let mut out: Vec<Warning> = self.snaps.iter().copied().map(Warning::Snap).collect();
        let Extremes { fold, nu, nu_at } = self.extremes;
        if fold.value <= 0.0 {
            out.push(Warning::SurfaceFold { margin: fold.value, s: fold.s });
        }
        if !(0.5..=1.5).contains(&nu) {
            out.push(Warning::StrainRange { nu, s: nu_at });
        }
        for cable in self.arm.cables.iter().filter(|cable| cable.stroke.is_some()) {
            if let Some(max) = cable.max_tension.filter(|max| cable.tension > *max) {
                out.push(Warning::TensionAboveMax { cable: cable.name.clone(), tension: cable.tension, max });
            }
        }
        if self.arm.cavity == crate::Cavity::Sealed && !self.arm.inner_radius.is_zero() {
            out.push(Warning::SealedCavity);
        }
        if let Some(ct) = momentum_ct(&self.arm)
            && let Some(tip_shift) =
                shift_by_tangential_load(&self.dense.equations, &self.dense.solution, PUBLISHED_CT / ct)
            && tip_shift > 0.01
        {
            out.push(Warning::TangentialLoad { ct, tip_shift });
        }
        out
    }
}

/// The nodes as the elements with their ends: the left end (false), and the right end (true) of the last and of those
/// at which a cable ends, where the two sides differ.
fn sides_of_nodes(dense: &Dense) -> Vec<(usize, bool)> {
    let mesh = &dense.solution.mesh;
    let (n, cables) = (mesh.elements(), dense.equations.arm().cables.len());
    let mut out = Vec::with_capacity(n + 1 + cables);
    for i in 0..n {
        let s = mesh.nodes()[i];
        if i > 0 && (0..cables).any(|cable| (dense.equations.cable_end(cable) - s).abs() < 1e-9) {
            out.push((i - 1, true));
        }
        out.push((i, false));
    }
    out.push((n - 1, true));
    out
}

/// Lengths and strokes of the cables at the last evaluation, with what is commanded of them.
fn cable_states(arm: &Arm, engine: &Engine) -> Vec<CableState> {
    let equations = &engine.equations;
    let taut = |cable: usize| {
        let stroke_control = equations.stroke_control.as_ref();
        stroke_control.is_some_and(|stroke_control| {
            stroke_control.cables.iter().zip(&stroke_control.taut).any(|(own, taut)| *own == cable && *taut)
        })
    };
    let state = |(index, cable): (usize, &Cable)| {
        let [now, unloaded] = equations.cable_lengths(index, StationData::of(&engine.system));
        let (length, stroke) = (arm.length * now, arm.length * (unloaded - now));
        let command =
            cable.stroke.map(|given| Command { stroke: given, length: length + stroke - given, slack: !taut(index) });
        CableState { name: cable.name.clone(), tension: cable.tension, length, stroke, command }
    };
    arm.cables.iter().enumerate().map(state).collect()
}

/// The tangential coefficient that the momentum law corresponds to along the stream, the square of the layer's mean
/// over its outer speed. `None` where that law does not act.
fn momentum_ct(arm: &Arm) -> Option<f64> {
    let acts = arm.flow.law == FlowLaw::Momentum && arm.flow.speed > 0.0 && arm.flow.density > 0.0;
    acts.then(|| arm.model.layer_mean.factor().powi(2))
}

fn offset_point(st: &Station, distance: f64) -> [f64; 2] {
    let (sin, cos) = st.theta.sin_cos();
    [st.x - distance * sin, st.y + distance * cos]
}
