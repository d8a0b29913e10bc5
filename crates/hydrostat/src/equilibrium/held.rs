//! Cables whose length is commanded, as the equations know them: which are taut, how the slopes follow the tension of one
//! cable, and how the length of one follows the state.

use hydrostat_bvp::{Groups, Lanes, Real, each};

use super::few::Few;
use super::gradients::by_strain_change;
use super::strains::{STATION, solve_section};
use super::{Equations, LANES, N, Q};
use crate::cable::{pull, tangent};
use crate::parameter::Parameter;
use crate::section::apply3;
use crate::sincos::sin_cos;
use crate::swelling::swelling;
use crate::verdict::Phase;

/// The cables whose stroke is commanded.
#[derive(Debug, Clone)]
pub(crate) struct Held {
    /// Their indices among the arm's.
    pub(crate) cables: Vec<usize>,
    /// Whether each is taut: then its tension is unknown and its stroke given, else its tension is zero.
    pub(crate) taut: Vec<bool>,
    /// Strokes that the phase of strokes starts from, over L.
    from: Vec<f64>,
    /// The share of the way from these to those commanded.
    share: f64,
    /// Whether rounds may change which cables are taut. Along a path that is an event of its own.
    pub(crate) switching: bool,
}

/// How strains and beta' at the stations change with a parameter at a fixed state.
#[derive(Debug, Clone, Default)]
pub(crate) struct Column {
    pub(super) strain: Vec<[Lanes; 3]>,
    pub(super) beta_slope: Vec<Lanes>,
}

impl Column {
    /// Nothing follows the parameter, at so many blocks of stations.
    pub(super) fn clear(&mut self, blocks: usize) {
        self.strain = vec![[Lanes::of(0.0); 3]; blocks];
        self.beta_slope = vec![Lanes::of(0.0); blocks];
    }
}

impl Held {
    /// Which of the commanded cables are taut.
    pub(crate) fn tight(&self) -> Vec<usize> {
        (0..self.cables.len()).filter(|index| self.taut[*index]).collect()
    }
}

impl Equations {
    /// Commands the strokes of the arm, no cable taut but those that have a tension.
    pub(crate) fn hold_strokes(&mut self) {
        let commanded = |cable: &usize| self.arm.cables[*cable].stroke.is_some();
        let cables: Vec<usize> = (0..self.arm.cables.len()).filter(commanded).collect();
        let taut = cables.iter().map(|cable| self.tensions[*cable] > 0.0).collect();
        let from = vec![0.0; cables.len()];
        self.held = (!cables.is_empty()).then_some(Held { cables, taut, from, share: 1.0, switching: true });
    }

    /// Leaves all cables to their tensions.
    pub(crate) fn let_go(&mut self) {
        self.held = None;
    }

    /// Starts the phase of strokes from those that the cables have.
    pub(crate) fn start_strokes_from(&mut self, strokes: Vec<f64>) {
        if let Some(held) = &mut self.held {
            held.from = strokes;
        }
    }

    /// Makes held cable `index` slack that was taut, or the other way round: which it is of the arm's, and whether it is slack now.
    pub(crate) fn change_over(&mut self, index: usize) -> (usize, bool) {
        let Some(mut held) = self.held.take() else { return (index, false) };
        held.taut[index] = !held.taut[index];
        let (cable, slack) = (held.cables[index], !held.taut[index]);
        if slack {
            self.set_tension(cable, 0.0);
        }
        self.held = Some(held);
        (cable, slack)
    }

    /// Whether rounds may change which cables are taut.
    pub(crate) fn let_cables_switch(&mut self, may: bool) {
        if let Some(held) = &mut self.held {
            held.switching = may;
        }
    }

    pub(super) fn set_stroke_share(&mut self, phase: Phase, fraction: f64) {
        if let Some(held) = &mut self.held {
            held.share = if phase == Phase::Stroke { fraction } else { 1.0 };
        }
    }

    /// Stroke that is commanded of held cable `index` now, over L.
    pub(crate) fn command(&self, held: &Held, index: usize) -> f64 {
        let (from, to) = (held.from[index], self.whole_command(held.cables[index]));
        if held.share == 1.0 { to } else { from + held.share * (to - from) }
    }

    fn whole_command(&self, cable: usize) -> f64 {
        self.arm.cables[cable].stroke.unwrap_or(0.0) / self.units.length
    }

    /// The change of that stroke a unit of the parameter.
    pub(crate) fn command_drift(&self, held: &Held, index: usize) -> f64 {
        let cable = held.cables[index];
        match self.varied_over() {
            _ if self.imposed.is_some() => 0.0,
            Some((Parameter::Stroke(varied), change)) if varied == cable => change / self.units.length,
            None if self.phase == Phase::Stroke => self.whole_command(cable) - held.from[index],
            _ => 0.0,
        }
    }

    /// Whether the parameter moves commands and nothing else.
    pub(crate) fn only_commands_move(&self) -> bool {
        match self.varied_over() {
            _ if self.imposed.is_some() => false,
            Some((parameter, _)) => matches!(parameter, Parameter::Stroke(_)),
            None => self.phase == Phase::Stroke,
        }
    }

    /// Unstretched stroke of `cable` at the last evaluation, over L, with the weights of the stages, and its derivatives by
    /// the length of the path and by the tension (in the unit of force).
    pub(crate) fn stroke(&self, cable: usize, weights: &[f64]) -> [f64; 3] {
        let [now, reference] = self.cable_lengths(cable, weights);
        let per_force = self.arm.cables[cable].stiffness.map_or(0.0, |stiffness| self.units.force / stiffness);
        let longer = 1.0 + self.tensions[cable] * per_force;
        [reference - now / longer, -1.0 / longer, now * per_force / (longer * longer)]
    }

    /// d z' / d tension of `cable` (in the unit of force) at the last state, which also fills the column. False where a
    /// section has no strains.
    pub(super) fn drift_by_tension(&mut self, cable: usize, out: &mut [[Lanes; N]]) -> bool {
        let cable_count = self.tensions.len();
        let mut pulled = Few::new();
        let mut column = std::mem::take(&mut self.column);
        column.strain.clear();
        let mut beta_drift = Vec::with_capacity(out.len());
        for (block, out) in out.iter_mut().enumerate() {
            self.pulled_in(block, &mut pulled);
            let memory = &self.memory[block];
            let (z, place) = (memory.z, &self.places[block]);
            let (sin, cos) = sin_cos(z[0]);
            let contact = [cos * z[1] + sin * z[2], cos * z[2] - sin * z[1], z[3]];
            let along = [self.beta.slope[block], self.beta.curvature[block]];
            let (stiffness, pulled) = (&place.stiffness, pulled.as_slice());
            let solved = solve_section(self.volume, stiffness, pulled, contact, memory.strain, along, STATION);
            if !solved.fine() {
                return false;
            }
            let own = &self.cables[block * cable_count + cable];
            let (by_tension, _) = pull(own.tension, &own.offset, solved.strain, &solved.balance.swelling, along);
            let strain = apply3(&solved.inverse, each(|k| -by_tension.load[k]));
            let load = self.load(place, [cos, sin], &solved, along[0]);
            *out = by_strain_change(&load, contact, strain);
            beta_drift.push(solved.balance.swelling.slope * strain[0]);
            column.strain.push(strain);
        }
        self.beta.follow_drift(&self.steps, &beta_drift, out, &mut column.beta_slope);
        self.column = column;
        true
    }

    /// Change of the length of `cable` (over L) with a change of the state at the stations, and of a parameter where the
    /// strains and beta' follow one at a fixed state.
    pub(crate) fn length_change(&self, cable: usize, weights: &[f64], change: &[[Lanes; N]], with_column: bool) -> f64 {
        let groups = self.groups;
        let mut sum = 0.0;
        for (block, moved) in change.iter().enumerate() {
            let (group, stage) = (block / groups.stages, block % groups.stages);
            let (by_strain, by_beta_slope) = self.stretch_gradient(cable, block);
            let by_state = self.through_strains(block, &by_strain, by_beta_slope);
            let mut rate = Lanes::of(0.0);
            for a in 0..N {
                rate += by_state[a] * moved[a];
            }
            if with_column {
                for (by, strain) in by_strain.iter().zip(&self.column.strain[block]) {
                    rate += *by * *strain;
                }
                rate += by_beta_slope * self.column.beta_slope[block];
            }
            for lane in self.along_cable(cable, block) {
                sum += self.steps[group].0[lane] * weights[stage] * rate.0[lane];
            }
        }
        sum
    }

    /// d stroke / d z of `cable` at the stages of every element, times the weight of the stage.
    pub(crate) fn stroke_gradients<const M: usize>(&self, cable: usize, weights: &[f64; M]) -> Vec<[[f64; N]; M]> {
        let (groups, by_length) = (self.groups, self.stroke(cable, weights)[1]);
        let mut out = vec![[[0.0; N]; M]; groups.elements];
        for block in 0..groups.count() * M {
            let (group, stage) = (block / M, block % M);
            let (by_strain, by_beta_slope) = self.stretch_gradient(cable, block);
            let by_state = self.through_strains(block, &by_strain, by_beta_slope);
            for lane in self.along_cable(cable, block) {
                let weight = by_length * self.steps[group].0[lane] * weights[stage];
                out[groups.element(group, lane)][stage] = by_state.map(|v| weight * v.0[lane]);
            }
        }
        out
    }

    /// How x' and y' follow a parameter at a fixed state, given how the strains do.
    pub(crate) fn rate_drift(&self, column: &Column, block: usize) -> [Lanes; Q] {
        let (sin, cos) = sin_cos(self.memory[block].z[0]);
        let [nu, eta, _] = column.strain[block];
        let [x, y] = self.beta.coupling[block].rate;
        let beta_slope = column.beta_slope[block];
        [nu * cos - eta * sin + x * beta_slope, nu * sin + eta * cos + y * beta_slope]
    }

    /// The lanes of a block whose stations `cable` runs along.
    fn along_cable(&self, cable: usize, block: usize) -> impl Iterator<Item = usize> + use<> {
        let groups: Groups = self.groups;
        let inside: [bool; LANES] =
            std::array::from_fn(|lane| self.stations[groups.station_in(block, lane)] < self.ends[cable]);
        (0..groups.filled(block / groups.stages)).filter(move |lane| inside[*lane])
    }

    fn through_strains(&self, block: usize, by_strain: &[Lanes; 3], by_beta_slope: Lanes) -> [Lanes; N] {
        let (by_state, beta_by_state) = (&self.memory[block].by_state, self.beta.by_state(block));
        each(|a| {
            let mut sum = by_beta_slope * beta_by_state[a];
            for (by, strain) in by_strain.iter().zip(by_state) {
                sum += *by * strain[a];
            }
            sum
        })
    }

    /// d |tau| of `cable` in a block of stations by the strains at fixed beta', and by beta' with what strains follow it.
    fn stretch_gradient(&self, cable: usize, block: usize) -> ([Lanes; 3], Lanes) {
        let offset = &self.cables[block * self.tensions.len() + cable].offset;
        let memory = &self.memory[block];
        let strain = memory.strain;
        let swelling = swelling(self.volume, strain[0]);
        let along = tangent(offset, strain, &swelling, self.beta.slope[block]);
        let by_nu = along.a * (Lanes::of(1.0) - offset.y * swelling.slope * strain[2])
            + along.b * offset.slope * swelling.slope;
        let by_strain = [by_nu, along.b, -(along.a * offset.y * swelling.beta)];
        // The strains that follow beta' at a fixed state, from how theta' and the centreline do.
        let (sin, cos) = sin_cos(memory.z[0]);
        let coupling = &self.beta.coupling[block];
        let [x, y] = coupling.rate;
        let following = [x * cos + y * sin, y * cos - x * sin, coupling.slope[0]];
        let mut by_beta_slope = along.b * offset.y;
        for (by, strain) in by_strain.iter().zip(&following) {
            by_beta_slope += *by * *strain;
        }
        (by_strain, by_beta_slope)
    }
}
