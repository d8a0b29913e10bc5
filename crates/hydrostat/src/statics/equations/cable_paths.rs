//! The paths that cables take through the deformed arm.

use hydrostat_bvp::{Collocation, Correction, Lanes, Real, Station};

use super::system::Equations;
use crate::rod::area_law::area_law;
use crate::rod::cable::{Tangent, tangent};
use crate::statics::dimensions::{L, N, Q};

/// The stations of a solution, with what integrates over them.
#[derive(Clone, Copy)]
pub(crate) struct StationData<'a> {
    /// Of the stages.
    pub(crate) weights: &'a [f64],
    /// Lengths of elements, a group.
    pub(crate) steps: &'a [Lanes],
    pub(crate) stations: &'a [Station<N, L>],
}

impl<'a> StationData<'a> {
    /// The stations that `system` has.
    pub(crate) fn of<const M: usize>(system: &'a Collocation<N, M, Q, L>) -> Self {
        Self { weights: &system.gauss.b, steps: system.steps(), stations: system.stations() }
    }
}

impl Equations {
    /// The tangent of cable `c` in a block of stations.
    #[inline(always)]
    pub(crate) fn cable_tangent(&self, c: usize, block: usize, station: &Station<N, L>) -> Tangent<Lanes> {
        let offset = &self.cables_in(block)[c].offset;
        let [nu, ..] = station.inner;
        tangent(offset, station.inner, &area_law(self.volume, nu), station.closure_slope)
    }

    /// |tau| of cable `c` in a block of stations at the reference strains.
    #[inline(always)]
    fn reference_stretch(&self, c: usize, block: usize) -> Lanes {
        let offset = &self.cables_in(block)[c].offset;
        let stiffness = &self.places[block].stiffness;
        let reference = area_law(self.volume, stiffness.reference[0]);
        let slope = reference.slope * stiffness.reference_slope;
        tangent(offset, stiffness.reference, &reference, slope).stretch
    }

    /// The angle chi of cable `c` in space in a block of stations: see [`crate::statics::friction`].
    pub(crate) fn cable_angle_in(&self, c: usize, block: usize, station: &Station<N, L>) -> Lanes {
        let t = self.cable_tangent(c, block, station);
        let mut out = station.z[0];
        for lane in 0..hydrostat_bvp::LANES {
            out.0[lane] += t.b.0[lane].atan2(t.a.0[lane]);
        }
        out
    }

    /// Sums `value` over the path of cable `c`.
    #[inline(always)]
    fn along_cable(&self, c: usize, at: StationData<'_>, value: impl Fn(usize) -> Lanes) -> f64 {
        let groups = self.groups;
        let mut sum = 0.0;
        for block in 0..groups.count() * groups.stages {
            let (group, stage) = (block / groups.stages, block % groups.stages);
            let value = value(block);
            for lane in 0..groups.filled(group) {
                if self.stations[groups.station_in(block, lane)] < self.ends[c] {
                    sum += at.steps[group].0[lane] * at.weights[stage] * value.0[lane];
                }
            }
        }
        sum
    }

    /// Length of the path of cable `c`, now and at the reference strains, over L.
    pub(crate) fn cable_lengths(&self, c: usize, at: StationData<'_>) -> [f64; 2] {
        [
            self.along_cable(c, at, |block| self.cable_tangent(c, block, &at.stations[block]).stretch),
            self.along_cable(c, at, |block| self.reference_stretch(c, block)),
        ]
    }

    /// The unstretched length of cable `c` over L: the integral of |tau| / (1 + T(s)/EA), with its derivative by the
    /// tension (in the unit of force).
    fn unstretched(&self, c: usize, at: StationData<'_>) -> [f64; 2] {
        let per_force = self.per_force(c);
        let tension = self.tensions[c];
        let stretch = |block: usize| self.cable_tangent(c, block, &at.stations[block]).stretch;
        let fraction = |block: usize| self.cables_in(block)[c].tension;
        if per_force == 0.0 {
            return [self.along_cable(c, at, stretch), 0.0];
        }
        let longer = |block: usize| Lanes::of(1.0) + fraction(block) * Lanes::of(tension * per_force);
        [
            self.along_cable(c, at, |block| stretch(block) / longer(block)),
            self.along_cable(c, at, |block| {
                let longer = longer(block);
                -(stretch(block) * fraction(block) * Lanes::of(per_force)) / (longer * longer)
            }),
        ]
    }

    /// The unit of force over EA of cable `c`; zero where it does not stretch.
    fn per_force(&self, c: usize) -> f64 {
        self.arm.cables[c].stiffness.map_or(0.0, |stiffness| self.units.force / stiffness)
    }

    /// Unstretched stroke of `cable`, over L, and its derivative by the tension (in the unit of force).
    pub(crate) fn stroke(&self, cable: usize, at: StationData<'_>) -> [f64; 2] {
        let [now, by_tension] = self.unstretched(cable, at);
        let reference = self.along_cable(cable, at, |block| self.reference_stretch(cable, block));
        [reference - now, -by_tension]
    }

    /// Derivatives of |tau| of cable `c` in a block of stations by the strains and by beta'.
    #[inline(always)]
    pub(crate) fn stretch_gradient(&self, c: usize, block: usize, station: &Station<N, L>) -> ([Lanes; L], Lanes) {
        let offset = &self.cables_in(block)[c].offset;
        let [nu, _, mu] = station.inner;
        let section_stretch = area_law(self.volume, nu);
        let t = tangent(offset, station.inner, &section_stretch, station.closure_slope);
        let by_nu =
            t.a * (Lanes::of(1.0) - offset.y * section_stretch.slope * mu) + t.b * offset.slope * section_stretch.slope;
        ([by_nu, t.b, -(t.a * offset.y * section_stretch.beta)], t.b * offset.y)
    }

    /// What a change of |tau| changes the stroke of cable `c` by, in a block of stations: with a stretch of its own
    /// less.
    #[inline(always)]
    pub(crate) fn stroke_by_stretch(&self, c: usize, block: usize) -> Lanes {
        let stretched = self.cables_in(block)[c].tension * Lanes::of(self.tensions[c] * self.per_force(c));
        Lanes::of(-1.0) / (Lanes::of(1.0) + stretched)
    }

    /// Change of the stroke of `cable` (over L) with a change of the solution, at fixed tension.
    pub(crate) fn stroke_change<const S: usize, const M: usize, const P: usize>(
        &self,
        cable: usize,
        at: StationData<'_>,
        change: &Correction<S, M, P, L>,
    ) -> f64 {
        self.along_cable(cable, at, |block| {
            let (by_strain, by_beta_slope) = self.stretch_gradient(cable, block, &at.stations[block]);
            let stage = &change.stages[block];
            let mut rate = by_beta_slope * stage.closure_slope;
            for (by, strain) in by_strain.iter().zip(&stage.inner) {
                rate += *by * *strain;
            }
            rate * self.stroke_by_stretch(cable, block)
        })
    }

    /// Stroke (over L) of cable `a` a unit of tension of cable `b` in the straight arm, by compression and bending.
    pub(crate) fn straight_compliance(&self, a: usize, b: usize) -> f64 {
        let end = self.ends[a].min(self.ends[b]);
        (0..64).map(|k| (f64::from(k) + 0.5) / 64.0).filter(|s| *s < end).fold(0.0, |sum, s| {
            let [axial, _, bending] = self.place(s).stiffness.value;
            sum + (1.0 / axial + self.offset(a, s).y * self.offset(b, s).y / bending) / 64.0
        })
    }

    /// Where cable `c` ends, over L.
    pub(crate) fn cable_end(&self, c: usize) -> f64 {
        self.ends[c]
    }
}
