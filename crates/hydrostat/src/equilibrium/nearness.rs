//! How near the limits of the section law an arm comes.

use hydrostat_bvp::{LANES, Lanes, Real};

/// Where a section law failed and how near each limit it was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SectionFailure {
    /// Over L.
    pub(crate) s: f64,
    /// Smallest tau.a / nu of the pulled cables.
    pub(crate) openness: f64,
    /// Stretch when it failed.
    pub(crate) nu: f64,
    /// Determinant of the section law over that of the slack one.
    pub(crate) regularity: f64,
}

/// How near the limits of the section law the stations came, each with its place (over L).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Nearness {
    /// Smallest tau.a / nu of a pulled cable.
    pub(crate) openness: (f64, f64),
    /// Smallest stretch.
    pub(crate) nu: (f64, f64),
    /// Smallest determinant of the section law over that of the slack one.
    pub(crate) regularity: (f64, f64),
}

impl Nearness {
    pub(super) const FAR: Self =
        Self { openness: (1.0, 0.0), nu: (f64::INFINITY, 0.0), regularity: (f64::INFINITY, 0.0) };

    #[inline(always)]
    pub(crate) fn note(&mut self, s: f64, openness: f64, nu: f64, regularity: f64) {
        for (least, value) in [(&mut self.openness, openness), (&mut self.nu, nu), (&mut self.regularity, regularity)] {
            if value < least.0 {
                *least = (value, s);
            }
        }
    }
}

/// [`Nearness`] lane by lane: openness, stretch, determinant.
pub(super) struct NearnessLanes {
    least: [Lanes; 3],
    s: [Lanes; 3],
}

impl NearnessLanes {
    #[inline(always)]
    pub(super) fn far() -> Self {
        let infinity = Lanes::of(f64::INFINITY);
        Self { least: [Lanes::of(1.0), infinity, infinity], s: [Lanes::of(0.0); 3] }
    }

    #[inline(always)]
    pub(super) fn note(&mut self, s: Lanes, values: [Lanes; 3]) {
        for k in 0..3 {
            self.s[k] = values[k].if_less(self.least[k], s, self.s[k]);
            self.least[k] = values[k].min(self.least[k]);
        }
    }

    /// The nearest of all lanes, of the equally near the first along the arm.
    pub(super) fn nearest(&self) -> Nearness {
        let [openness, nu, regularity] = [0, 1, 2].map(|k| {
            let each = (0..LANES).map(|lane| (self.least[k].0[lane], self.s[k].0[lane]));
            each.reduce(|a, b| if b < a { b } else { a }).unwrap_or((f64::INFINITY, 0.0))
        });
        Nearness { openness, nu, regularity }
    }
}
