//! From which side an element takes the closure variable over.
//!
//! The closure variable w is, on every element, a polynomial of degree M + 1. It meets its equation at the M stages and at the end
//! towards which disturbances fade, which is the element's own; at the other end it has the value of the neighbour. Where
//! there is no such neighbour (an end of the interval, a jump of w, a neighbour that takes over from here) the element is
//! closing: it meets the equation at the other end too.

use crate::groups::Groups;
use crate::real::LANES;

/// An end of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// Its start.
    #[default]
    Left,
    /// Its end.
    Right,
}

impl Side {
    /// 0 or 1.
    #[inline(always)]
    pub fn index(self) -> usize {
        usize::from(self == Self::Right)
    }

    /// The place in an element of length one.
    #[inline(always)]
    pub fn place(self) -> f64 {
        f64::from(u8::from(self == Self::Right))
    }

    /// The other one.
    #[inline(always)]
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

/// What passes a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Flow {
    /// The closure variable is not shared there.
    #[default]
    None,
    /// The element on the left takes it from the one on the right.
    Left,
    /// The element on the right takes it from the one on the left.
    Right,
}

/// The ends of elements in the four lanes of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EndPlace {
    /// The elements.
    pub elements: [usize; LANES],
    /// Which end of each.
    pub sides: [Side; LANES],
}

/// The sides of all elements of a mesh, and what follows from them.
#[derive(Debug, PartialEq, Eq, Default)]
pub struct Directions {
    /// The own end of every element; empty for problems without a closure variable.
    sides: Vec<Side>,
    /// Whether w jumps at a node.
    jumps: Vec<bool>,
    pub(crate) flow: Vec<Flow>,
    /// Elements that meet the equation at their other end too.
    pub(crate) closings: Vec<usize>,
    /// The own ends, a block for every group of elements, then the other ends of closing elements.
    pub(crate) ends: Vec<EndPlace>,
}

impl Clone for Directions {
    fn clone(&self) -> Self {
        Self {
            sides: self.sides.clone(),
            jumps: self.jumps.clone(),
            flow: self.flow.clone(),
            closings: self.closings.clone(),
            ends: self.ends.clone(),
        }
    }

    /// Without allocation where there is room.
    fn clone_from(&mut self, other: &Self) {
        self.sides.clone_from(&other.sides);
        self.jumps.clone_from(&other.jumps);
        self.flow.clone_from(&other.flow);
        self.closings.clone_from(&other.closings);
        self.ends.clone_from(&other.ends);
    }
}

impl Directions {
    /// Takes the own end of every element; `jumps` are the nodes at which w jumps.
    pub fn set(&mut self, sides: impl Iterator<Item = Side>, jumps: impl Fn(usize) -> bool) {
        self.sides.clear();
        self.sides.extend(sides);
        let n = self.sides.len();
        self.jumps.clear();
        self.jumps.extend((0..=n).map(jumps));
        self.flow.clear();
        self.flow.resize(n + 1, Flow::None);
        self.closings.clear();
        for i in 0..n {
            let (node, flow) = match self.sides[i] {
                Side::Left => (i + 1, Flow::Left),
                Side::Right => (i, Flow::Right),
            };
            let neighbour = match self.sides[i] {
                Side::Left if i + 1 < n => Some(i + 1),
                Side::Right if i > 0 => Some(i - 1),
                _ => None,
            };
            if !self.jumps[node] && neighbour.is_some_and(|other| self.sides[other] == self.sides[i]) {
                self.flow[node] = flow;
            } else {
                self.closings.push(i);
            }
        }
        self.ends.clear();
        let groups = Groups { elements: n, stages: 1 };
        for g in 0..groups.count() {
            let elements = std::array::from_fn(|lane| groups.element(g, lane));
            self.ends.push(EndPlace { elements, sides: elements.map(|i| self.sides[i]) });
        }
        for four in self.closings.chunks(LANES) {
            let elements = std::array::from_fn(|lane| four[lane.min(four.len() - 1)]);
            self.ends.push(EndPlace { elements, sides: elements.map(|i| self.sides[i].other()) });
        }
    }

    /// No closure variable.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// The own end of element `i`.
    #[inline(always)]
    pub fn side(&self, i: usize) -> Side {
        self.sides.get(i).copied().unwrap_or_default()
    }

    /// The element that `i` takes the closure variable over from; none where it is closing.
    #[inline(always)]
    pub(crate) fn taken_from(&self, i: usize) -> Option<usize> {
        match self.side(i) {
            Side::Left if self.flow[i + 1] == Flow::Left => Some(i + 1),
            Side::Right if self.flow[i] == Flow::Right => Some(i - 1),
            _ => None,
        }
    }

    /// Block and lane of the end whose value element `i` takes over: the neighbour's own, or its own other end where it is closing.
    #[inline(always)]
    pub(crate) fn end_taken(&self, i: usize) -> (usize, usize) {
        if let Some(neighbour) = self.taken_from(i) {
            return (neighbour / LANES, neighbour % LANES);
        }
        let k = self.closings.iter().position(|c| *c == i).unwrap_or(0);
        (self.sides.len().div_ceil(LANES) + k / LANES, k % LANES)
    }

    /// The ends at which the inner equations are met, in blocks.
    pub fn ends(&self) -> &[EndPlace] {
        &self.ends
    }

    /// Whether there is a closure variable.
    #[inline(always)]
    pub fn is_closed(&self) -> bool {
        !self.sides.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_close_at_ends_jumps_and_where_flows_meet() {
        let sides = [Side::Left, Side::Left, Side::Right, Side::Right, Side::Left, Side::Left];
        let mut directions = Directions::default();
        directions.set(sides.into_iter(), |node| node == 5);
        // 1 and 2 flow into each other, 4 meets a jump, 5 the end.
        assert_eq!(directions.closings, [1, 2, 4, 5]);
        let flow = [Flow::None, Flow::Left, Flow::None, Flow::Right, Flow::None, Flow::None, Flow::None];
        assert_eq!(directions.flow, flow);
    }
}
