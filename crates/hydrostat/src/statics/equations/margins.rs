//! How near the limits of the section law an arm comes.

use hydrostat_bvp::Station;

use super::limits::Margins;
use super::system::Equations;
use crate::rod::cable_list::CableList;
use crate::statics::dimensions::{L, N};

impl Equations {
    /// How near the limits of the section law stations and ends are.
    pub(crate) fn margins(&self, stations: &[Station<N, L>]) -> Margins {
        let mut out = Margins::FAR;
        let mut pulled = CableList::new();
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
