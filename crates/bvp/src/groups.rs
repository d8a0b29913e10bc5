//! Elements in groups of four side by side.

use crate::real::LANES;

/// `Vec::resize` with room for twice as much at first, because meshes grow from the first on: moving what is there costs more than it.
#[inline(always)]
pub(crate) fn resize<T: Copy>(list: &mut Vec<T>, count: usize, blank: T) {
    make_room(list, count);
    list.resize(count, blank);
}

/// The room for [`resize`].
#[inline(always)]
pub(crate) fn make_room<T>(list: &mut Vec<T>, count: usize) {
    if list.capacity() < count {
        list.reserve_exact(2 * count - list.len());
    }
}

/// How the stages of a mesh stand in blocks: block `g M + j` holds stage `j` of the elements of group
/// `g`, one a lane. The last group is filled up with the last element, again and again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Groups {
    /// Elements of the mesh.
    pub elements: usize,
    /// Stages an element.
    pub stages: usize,
}

impl Groups {
    /// How many groups there are.
    #[inline(always)]
    pub fn count(self) -> usize {
        self.elements.div_ceil(LANES)
    }

    /// The element in a lane of group `g`.
    #[inline(always)]
    pub fn element(self, g: usize, lane: usize) -> usize {
        (g * LANES + lane).min(self.elements - 1)
    }

    /// How many lanes of group `g` hold elements of their own.
    #[inline(always)]
    pub fn filled(self, g: usize) -> usize {
        (self.elements - g * LANES).min(LANES)
    }

    /// Block and lane of stage `j` of element `i`.
    #[inline(always)]
    pub fn at(self, i: usize, j: usize) -> (usize, usize) {
        (i / LANES * self.stages + j, i % LANES)
    }

    /// Block and lane of station `k`, the stations counted along the mesh.
    #[inline(always)]
    pub fn station(self, k: usize) -> (usize, usize) {
        self.at(k / self.stages, k % self.stages)
    }

    /// The station, counted along the mesh, in a lane of a block.
    #[inline(always)]
    pub fn station_in(self, block: usize, lane: usize) -> usize {
        self.element(block / self.stages, lane) * self.stages + block % self.stages
    }
}
