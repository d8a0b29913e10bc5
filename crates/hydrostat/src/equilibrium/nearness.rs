//! How near the limits of the section law an arm comes.

use hydrostat_bvp::Station;

use super::few::Few;
use super::{Equations, L, N};

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
    pub(crate) const FAR: Self =
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

impl Equations {
    /// How near the limits of the section law stations and ends are.
    pub(crate) fn nearness(&self, stations: &[Station<N, L>]) -> Nearness {
        let mut out = Nearness::FAR;
        let mut pulled = Few::new();
        for (block, station) in stations.iter().enumerate() {
            let (_, _, solved) = self.solved_in(block, station, &mut pulled);
            let s = self.places[block].s;
            for lane in 0..self.groups.filled(block / self.groups.stages) {
                let [openness, nu, regularity] =
                    [solved.balance.openness, solved.strain[0], solved.regularity].map(|v| v.0[lane]);
                out.note(s.0[lane], openness, nu, regularity);
            }
        }
        out
    }
}
