//! beta carried from element to element, where the fast mode is about as long as elements.
//!
//! With beta'' in it, beta = beta(nu(z, beta')) is a differential equation for beta of its own, of which `reach` is the length scale: a
//! disturbance grows towards the tip where `reach` is above zero, towards the base where it is below. On elements much longer than that
//! only the smooth solution can be seen, and each finds it alone. On shorter ones beta is a state: collocated on the element, with its
//! value taken over from the neighbour on the side that disturbances grow to, so that they fade. Where the last of such elements has no neighbour,
//! at an end of the arm or of a cable, the element's own polynomial is as smooth as can be; what it is off by fades within `reach` there.
//!
//! ```text
//! beta_j + reach_j (beta'_j - used_j) = beta_R - h sum (b_l - a_jl) beta'_l        carried from the right
//! beta_j + reach_j (beta'_j - used_j) = beta_L + h sum a_jl beta'_l                from the left
//! ```
//!
//! beta_j being that of the strains evaluated with `used_j`. Without it tips of arms squeezed by two cables were off by up to 3e-5 L.

use hydrostat_bvp::{LANES, Lanes, Local};

use super::{BetaAlong, MOST_STAGES, OWN, Weights};
use crate::elimination::solve_in_place;
use crate::equilibrium::{N, Q};

/// `reach` over the length of the shortest elements whose beta is carried, or fades at an end.
const SHORTEST: f64 = 4.0;

/// `reach` over the length of the shortest of other elements.
const SHORTEST_ALONE: f64 = 0.25;

/// The side that an element takes its beta over from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    Left,
    Right,
}

impl BetaAlong {
    /// Takes the elements at whose right end beta jumps, in order.
    pub(crate) fn take_jumps(&mut self, jumps: impl Iterator<Item = usize>) {
        self.jumps.clear();
        self.jumps.extend(jumps);
    }

    /// The shortest part of element `i` of `elements` on which beta' can still be found.
    pub(crate) fn shortest(&self, i: usize, elements: usize) -> f64 {
        let (group, lane) = (i / LANES, i % LANES);
        let reach = |j: usize| self.reach[group * self.stages + j].0[lane];
        let most = self.largest_reach(group, lane);
        let Some(side) = self.side(group, lane) else { return most / SHORTEST_ALONE };
        // What an element without neighbour is off by has to fade near its end only.
        let last = if side == Side::Right { self.stages - 1 } else { 0 };
        let alone = self.neighbour(i, elements, side).is_none();
        if alone { reach(last).abs() / SHORTEST } else { most / SHORTEST }
    }

    /// The side that disturbances of beta grow to, if it is the same all over an element.
    fn side(&self, group: usize, lane: usize) -> Option<Side> {
        let reach = &self.reach[group * self.stages..(group + 1) * self.stages];
        if reach.iter().all(|reach| reach.0[lane] > 0.0) {
            Some(Side::Right)
        } else if reach.iter().all(|reach| reach.0[lane] < 0.0) {
            Some(Side::Left)
        } else {
            None
        }
    }

    /// The element next to `i` whose beta goes on in it, unless disturbances grow towards `i` there.
    fn neighbour(&self, i: usize, elements: usize, side: Side) -> Option<usize> {
        let other = match side {
            Side::Right => Some(i + 1).filter(|other| *other < elements)?,
            Side::Left => i.checked_sub(1)?,
        };
        let meets = self.side(other / LANES, other % LANES).is_some_and(|own| own != side);
        (!meets && self.jumps.binary_search(&i.min(other)).is_err()).then_some(other)
    }

    /// Puts beta' of elements that are short against `reach` right, from neighbour to neighbour, and into slopes and rates
    /// what that adds. After [`BetaAlong::close`]; `used` is what beta' of a station was evaluated with, `steps` are element lengths, a group.
    #[cold]
    #[inline(never)]
    pub(crate) fn carry(
        &mut self,
        elements: usize,
        steps: &[Lanes],
        used: impl Fn(usize, usize) -> f64,
        out: &mut [Local<N, Q, Lanes>],
    ) {
        self.at_ends.clear();
        self.sides.clear();
        for i in 0..elements {
            let (group, lane) = (i / LANES, i % LANES);
            let h = steps[group].0[lane];
            let mut ends = [0.0; 2];
            for j in 0..self.stages {
                let b = group * self.stages + j;
                let slope = self.slope[b].0[lane];
                let value = self.value[b].0[lane] + self.reach[b].0[lane] * (slope - used(b, lane));
                for (end, [by_value, by_slope]) in ends.iter_mut().zip(&self.weights.ends) {
                    *end += by_value[j] * value + h * by_slope[j] * slope;
                }
            }
            self.at_ends.push(ends);
            let side = self.side(group, lane).filter(|_| self.largest_reach(group, lane) >= OWN * h);
            self.sides.push(side.and_then(|side| Some((side, self.neighbour(i, elements, side)?))));
        }
        for i in (0..elements).rev() {
            if let Some((Side::Right, neighbour)) = self.sides[i] {
                let known = self.at_ends[neighbour][0];
                self.carry_into(i, (Side::Right, known), steps[i / LANES].0[i % LANES], &used, out);
            }
        }
        for i in 0..elements {
            if let Some((Side::Left, neighbour)) = self.sides[i] {
                let known = self.at_ends[neighbour][1];
                self.carry_into(i, (Side::Left, known), steps[i / LANES].0[i % LANES], &used, out);
            }
        }
    }

    fn carry_into(
        &mut self,
        i: usize,
        (side, known): (Side, f64),
        h: f64,
        used: &impl Fn(usize, usize) -> f64,
        out: &mut [Local<N, Q, Lanes>],
    ) {
        let stages = self.stages;
        let (group, lane) = (i / LANES, i % LANES);
        let carried = Carried { side, whole: &self.weights.whole, upto: &self.weights.upto };
        let mut matrix = [[0.0; MOST_STAGES]; MOST_STAGES];
        let mut next = [[0.0]; MOST_STAGES];
        for j in 0..MOST_STAGES {
            if j >= stages {
                matrix[j][j] = 1.0;
                continue;
            }
            let b = group * stages + j;
            let reach = self.reach[b].0[lane];
            for l in 0..stages {
                matrix[j][l] = h * carried.since_known(j, l);
            }
            matrix[j][j] -= reach;
            next[j][0] = self.value[b].0[lane] - reach * used(b, lane) - known;
        }
        if !solve_in_place(&mut matrix, &mut next, 0.0) {
            self.sides[i] = None;
            return;
        }
        let total: f64 = (0..stages).map(|l| h * self.weights.whole[l] * next[l][0]).sum();
        self.at_ends[i] = match side {
            Side::Right => [known - total, known],
            Side::Left => [known, known + total],
        };
        for j in 0..stages {
            let b = group * stages + j;
            let change = next[j][0] - self.slope[b].0[lane];
            let by = &self.coupling[b];
            for a in 0..N {
                out[b].slope[a].0[lane] += by.slope[a].0[lane] * change;
            }
            for q in 0..Q {
                out[b].rate[q].0[lane] += by.rate[q].0[lane] * change;
            }
            self.slope[b].0[lane] = next[j][0];
            self.curvature[b].0[lane] = (0..stages).map(|l| self.weights.plain[j][l] * next[l][0]).sum::<f64>() / h;
        }
    }
}

/// The formula of an element whose beta is carried, with weights for a length of one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Carried<'a> {
    pub(crate) side: Side,
    pub(super) whole: &'a [f64; MOST_STAGES],
    pub(super) upto: &'a Weights,
}

impl Carried<'_> {
    /// What beta' at stage `l` adds to beta between the end where it is known and stage `j`.
    pub(crate) fn since_known(&self, j: usize, l: usize) -> f64 {
        match self.side {
            Side::Right => self.upto[j][l] - self.whole[l],
            Side::Left => self.upto[j][l],
        }
    }
}
