//! The cables that pull at a place.

use hydrostat_bvp::Real;

use crate::rod::cable::Offset;
use crate::rod::section::CableAt;

/// Cables that fit on the stack.
const MOST_IN_PLACE: usize = 8;

/// A list that allocates only when it is long.
pub(crate) struct CableList<R> {
    count: usize,
    in_place: [CableAt<R>; MOST_IN_PLACE],
    many: Vec<CableAt<R>>,
}

impl<R: Real> CableList<R> {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        let zero = R::of(0.0);
        let blank = CableAt { offset: Offset { y: zero, slope: zero }, tension: zero };
        Self { count: 0, in_place: [blank; MOST_IN_PLACE], many: Vec::new() }
    }

    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.count = 0;
        self.many.clear();
    }

    #[inline(always)]
    pub(crate) fn push(&mut self, cable: CableAt<R>) {
        if self.many.is_empty() && self.count < MOST_IN_PLACE {
            self.in_place[self.count] = cable;
        } else {
            self.spill(cable);
        }
        self.count += 1;
    }

    #[cold]
    #[inline(never)]
    fn spill(&mut self, cable: CableAt<R>) {
        if self.many.is_empty() {
            self.many.extend_from_slice(&self.in_place);
        }
        self.many.push(cable);
    }

    #[inline(always)]
    pub(crate) fn as_slice(&self) -> &[CableAt<R>] {
        if self.many.is_empty() { &self.in_place[..self.count] } else { &self.many }
    }
}
