//! Everything at a place between stations, or at four of them.

use hydrostat_bvp::{LANES, Lanes, Real, each};

use super::gradients::{in_directors, jacobian, strain_by_state};
use super::limits::SectionFailure;
use super::place::{Place, blank_cable};
use super::system::Equations;
use crate::numerics::sincos::sin_cos;
use crate::rod::cable_list::CableList;
use crate::rod::section::CableAt;
use crate::rod::section_solve::{FOLDED, solve_section};
use crate::statics::dimensions::N;

/// A place between stations, and what is known there.
#[derive(Clone, Copy)]
pub(crate) struct SectionQuery {
    /// Over L.
    pub(crate) s: f64,
    /// Decides whether a cable that ends here still acts.
    pub(crate) from_left: bool,
    pub(crate) z: [f64; N],
    /// A guess of the strains.
    pub(crate) strain: [f64; 3],
    pub(crate) beta_slope: f64,
}

/// Everything at one place, or at four, in the solver's units.
#[derive(Clone)]
pub(crate) struct SectionState<R = f64> {
    pub(crate) strain: [R; 3],
    pub(crate) beta: R,
    pub(crate) beta_slope: R,
    /// n.a, n.b, m: what the body carries.
    pub(crate) contact: [R; 3],
    /// Smallest tau.a / nu of the pulled cables.
    pub(crate) openness: R,
    /// Determinant of the section law over that of the slack one.
    pub(crate) regularity: R,
    /// z' and its derivatives by z.
    pub(crate) slope: [R; N],
    pub(crate) jacobian: [[R; N]; N],
    /// (x, y)'.
    pub(crate) rate: [R; 2],
    /// d strain / d z.
    pub(crate) strain_by_state: [[R; N]; 3],
    /// Undeformed radius.
    pub(crate) radius: R,
    /// Load switches.
    pub(crate) switches: [R; 3],
}

impl SectionState<Lanes> {
    /// That of one of the four places.
    pub(crate) fn lane(&self, lane: usize) -> SectionState {
        SectionState {
            strain: self.strain.map(|v| v.0[lane]),
            beta: self.beta.0[lane],
            beta_slope: self.beta_slope.0[lane],
            contact: self.contact.map(|v| v.0[lane]),
            openness: self.openness.0[lane],
            regularity: self.regularity.0[lane],
            slope: self.slope.map(|v| v.0[lane]),
            jacobian: self.jacobian.map(|row| row.map(|v| v.0[lane])),
            rate: self.rate.map(|v| v.0[lane]),
            strain_by_state: self.strain_by_state.map(|row| row.map(|v| v.0[lane])),
            radius: self.radius.0[lane],
            switches: self.switches.map(|v| v.0[lane]),
        }
    }
}

/// State, guess of the strains and beta' of four places.
#[inline(always)]
fn in_lanes(asked: &[SectionQuery; LANES]) -> ([Lanes; N], [Lanes; 3], Lanes) {
    let z = each(|a| Lanes(each(|lane| asked[lane].z[a])));
    let strain = each(|a| Lanes(each(|lane| asked[lane].strain[a])));
    (z, strain, Lanes(each(|lane| asked[lane].beta_slope)))
}

/// Steps of the section law that may be left to what is read at a place: forces of cables do not take them up.
const SHARP_STEP: f64 = 1e-12;

/// Steps of the section law that leave beta right to rounding: it takes up their first order.
const ROUGH_STEP: f64 = 1e-9;

impl Equations {
    /// Solves section law and loads at one place, for output between stations.
    pub(crate) fn at_place(&self, asked: &SectionQuery) -> Result<SectionState, SectionFailure> {
        let mut place = self.place(asked.s);
        place.body.couple *= self.fraction[0];
        let mut cables = CableList::new();
        for c in (0..self.tensions.len()).filter(|c| self.acts_at(*c, asked)) {
            cables.push(self.cable_at(c, asked));
        }
        let cables = cables.as_slice();
        let (sin, cos) = asked.z[0].sin_cos();
        let (at, fine) = self.solve_place(&place, cables, [cos, sin], asked.z, asked.strain, asked.beta_slope);
        if fine {
            Ok(at)
        } else {
            Err(SectionFailure { s: asked.s, openness: at.openness, nu: at.strain[0], regularity: at.regularity })
        }
    }

    /// [`Equations::at_place`] at four places; `None` when one of them has no solution.
    #[inline(always)]
    pub(crate) fn at_places(&self, asked: &[SectionQuery; LANES]) -> Option<SectionState<Lanes>> {
        let mut place = self.place_four(Lanes(each(|lane| asked[lane].s)));
        place.body.couple = place.body.couple * Lanes::of(self.fraction[0]);
        let cables = self.cables_at(asked, place.s);
        let (z, strain, beta_slope) = in_lanes(asked);
        let (sin, cos) = sin_cos(z[0]);
        let (at, fine) = self.solve_place(&place, cables.as_slice(), [cos, sin], z, strain, beta_slope);
        fine.then_some(at)
    }

    /// beta alone at four places near strains that are known; `None` when one of them has no solution.
    #[inline(always)]
    pub(crate) fn beta_at(&self, asked: &[SectionQuery; LANES]) -> Option<[f64; LANES]> {
        let place = self.place_four(Lanes(each(|lane| asked[lane].s)));
        let cables = self.cables_at(asked, place.s);
        let (z, strain, beta_slope) = in_lanes(asked);
        let (sin, cos) = sin_cos(z[0]);
        let contact = in_directors([cos, sin], &z);
        let (volume, stiffness) = (self.volume, &place.stiffness);
        let solved = solve_section(volume, stiffness, cables.as_slice(), contact, strain, beta_slope, ROUGH_STEP);
        let section_stretch = &solved.balance.section_stretch;
        solved.size.all_below(ROUGH_STEP).then(|| (section_stretch.beta + section_stretch.slope * solved.change[0]).0)
    }

    /// The cables that pull at one of four places.
    #[inline(always)]
    fn cables_at(&self, asked: &[SectionQuery; LANES], s: Lanes) -> CableList<Lanes> {
        let mut cables = CableList::new();
        for c in 0..self.tensions.len() {
            let mut cable = blank_cable();
            for (lane, asked) in asked.iter().enumerate().filter(|(_, asked)| self.acts_at(c, asked)) {
                cable.tension.0[lane] = self.tension_at(c, asked);
            }
            if cable.tension != Lanes::of(0.0) {
                cables.push(CableAt { offset: self.offset_four(c, s), ..cable });
            }
        }
        cables
    }

    /// Cable `c` at a place up to its end.
    fn cable_at(&self, c: usize, asked: &SectionQuery) -> CableAt<f64> {
        CableAt { offset: self.offset(c, asked.s), tension: self.tension_at(c, asked) }
    }

    /// The tension of cable `c` at a place up to its end.
    fn tension_at(&self, c: usize, asked: &SectionQuery) -> f64 {
        self.tension(c) * self.tension_ratio(c, asked.s, asked.from_left)
    }

    /// Whether cable `c` pulls at a place.
    fn acts_at(&self, c: usize, asked: &SectionQuery) -> bool {
        let runs = if asked.from_left { asked.s <= self.ends[c] + 1e-12 } else { asked.s < self.ends[c] - 1e-12 };
        runs && self.tension(c) != 0.0
    }

    /// Everything at places, and whether it could be solved at all of them.
    #[inline(always)]
    fn solve_place<R: Real>(
        &self,
        place: &Place<R>,
        cables: &[CableAt<R>],
        [cos, sin]: [R; 2],
        z: [R; N],
        strain: [R; 3],
        beta_slope: R,
    ) -> (SectionState<R>, bool) {
        let contact = in_directors([cos, sin], &z);
        let solved = solve_section(self.volume, &place.stiffness, cables, contact, strain, beta_slope, SHARP_STEP);
        let fine = solved.size.all_below(1e-9)
            && (-solved.regularity).all_below(0.0)
            && (-solved.balance.openness).all_below(-FOLDED);
        let load = self.load(place, [cos, sin], solved.strain, &solved.balance.section_stretch, beta_slope);
        let by_state = strain_by_state(&solved.inverse, [cos, sin], contact);
        let [nu, eta, mu] = solved.strain;
        let at = SectionState {
            strain: each(|k| solved.strain[k] + solved.change[k]),
            beta: solved.balance.section_stretch.beta + solved.balance.section_stretch.slope * solved.change[0],
            beta_slope,
            contact: each(|k| contact[k] - solved.balance.cables[k]),
            openness: solved.balance.openness,
            regularity: solved.regularity,
            slope: [mu, -load.force[0], -load.force[1], eta * contact[0] - nu * contact[1] - place.body.couple],
            jacobian: jacobian([cos, sin], contact, &solved, &load, &by_state),
            rate: [nu * cos - eta * sin, nu * sin + eta * cos],
            strain_by_state: by_state,
            radius: place.body.radius,
            switches: load.switches,
        };
        (at, fine)
    }
}
