//! The rates of small motions about an equilibrium, in the plane or in space.
//!
//! About rest the equations of a stage are, with u = (places, turns) and the strains e at the stages of the mesh, and
//! G what loads and what changes of the section law there move, by the tangent of the statics (beta', ends, cables,
//! stream and follower loads in it),
//!
//! ```text
//! (u, e) = G (D lambda + M lambda^2) (u, e)
//! ```
//!
//! for a motion that grows as exp(lambda t). M has the masses of [`crate::rod::inertia`], D the drag's derivative by
//! the velocity, and, for e, t_v times the section's stiffness. With kappa = 1/lambda and v = lambda u it is a plain
//! eigenvalue problem,
//!
//! ```text
//! kappa (u, e) = G D (u, e) + G M v        kappa v = u
//! ```
//!
//! in which slow motions are the largest and best known eigenvalues, and what a mesh does not resolve falls to zero.

use hydrostat_bvp::{
    Correction, EndPlace, Forcing, Inner, LANES, Lanes, LinearisationError, Local, Real, StageForcing, Station,
};
use nalgebra::{Complex, DMatrix, DVector};

use super::eigenvalues::Spectrum;
use super::error::MotionError;
use super::settling::{Moves, Settling};
use super::start::not_found;
use crate::statics::dimensions::M;

/// What a small motion about rest adds in a block of stations: per coordinate, the places in space and then the turns.
#[derive(Clone, Copy)]
pub(super) struct Linear<const C: usize, const L: usize> {
    /// Derivative of -force by the velocity (L/s).
    pub(super) damping: [[Lanes; C]; C],
    /// By the acceleration (L/s2, 1/s2 of turns).
    pub(super) mass: [[Lanes; C]; C],
    /// What the section carries by the strains' rates.
    pub(super) viscous: [Lanes; L],
}

/// The boundary-value problem of one stage about rest, with `C` coordinates of a station.
pub(super) trait Vibrates<const S: usize, const L: usize, const C: usize>: Moves<S, L> {
    /// Vectors of the space in which the slowest motions are looked for, and how many it starts from: as many as there
    /// may be motions of one rate.
    const SPACE: [usize; 2];

    fn linear(&self, block: usize, station: &Station<S, L>) -> Linear<C, L>;

    /// Slopes of a unit load against a coordinate.
    fn load(&self, field: usize, station: &Station<S, L>) -> [Lanes; S];

    /// Place (over L) and directors of a section in a state.
    fn section(z: &[f64; S]) -> ([f64; 3], [[f64; 3]; 3]);

    /// The displacement (over L) and the turn in space of a section in a state whose coordinates change.
    fn in_space(z: &[f64; S], moved: &[f64; C]) -> [[f64; 3]; 2];

    /// The coordinates' change with one of the states.
    fn moved(&self, station: &Station<S, L>, change: &[Lanes; S]) -> [Lanes; C];

    /// What a change of what sections carry, in a block of stations, changes at fixed states: the strains follow, and
    /// with them the slopes.
    fn stage_forcing(
        &self,
        block: usize,
        station: &Station<S, L>,
        local: &Local<S, 0, L, Lanes>,
        carried: [Lanes; L],
    ) -> StageForcing<S, 0, L>;

    /// The same at a block of ends: strains, and the section stretch.
    fn end_forcing(
        &self,
        station: &Station<S, L>,
        inner: &Inner<S, L, Lanes>,
        carried: [Lanes; L],
    ) -> ([Lanes; L], Lanes);

    fn end_places(&self) -> &[EndPlace];
}

/// All small motions about the equilibrium of `settling` that the mesh has.
pub(super) fn spectrum<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(
    settling: &mut Settling<P, S, L>,
) -> Result<Spectrum, MotionError> {
    let arm = settling.moving.arm().clone();
    let failed = |failure| not_found(0.0, 0.0, failure, &arm);
    settling.linearise().map_err(|error| match error {
        LinearisationError::Slopes(failure) => failed(Some(failure)),
        LinearisationError::Singular(_) => failed(None),
    })?;
    let matrix = matrix(settling, settling.moving.time_unit());
    let [space, twins] = P::SPACE;
    Spectrum::largest(&matrix, space, twins).ok_or_else(|| failed(None))
}

/// The rates of small motions, real and imaginary part, 1/s: their eigenvalues are kappa over `time` (s).
pub(super) fn rates(spectrum: &Spectrum, time: f64) -> Vec<[f64; 2]> {
    let largest = spectrum.values.iter().map(|kappa| kappa.norm()).fold(0.0, f64::max);
    let rate = |kappa: &Complex<f64>| {
        let square = kappa.norm_sqr() * time;
        [kappa.re / square, -kappa.im / square]
    };
    spectrum.values.iter().filter(|kappa| kappa.norm() > 1e-9 * largest).map(rate).collect()
}

/// The fields of a station in the matrix, its coordinates first.
fn fields<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(moving: &P) -> usize {
    if moving.arm().dynamics.relaxation_time > 0.0 { C + L } else { C }
}

/// The changes (complex) of the coordinates at the stages, station by station, and at the nodes, with a motion that
/// goes as exp(rate t) (1/s) and has the eigenvector `own`: the response to what it adds at the stations, so that it is
/// known as well between them.
pub(super) fn changes<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(
    settling: &Settling<P, S, L>,
    rate: Complex<f64>,
    own: &DVector<Complex<f64>>,
) -> [Vec<[Complex<f64>; C]>; 2] {
    let parts = [0, 1].map(|part| {
        let forcing = forcing(settling, |k, field, linear: &Linear<C, L>, lane| {
            let at = fields(&settling.moving) * k;
            let added = if field < C {
                let by = |m: &[[Lanes; C]; C]| (0..C).map(|a| own[at + a] * m[field][a].0[lane]).sum::<Complex<f64>>();
                rate * by(&linear.damping) + rate * rate * by(&linear.mass)
            } else {
                rate * own[at + field] * linear.viscous[field - C].0[lane]
            };
            if part == 0 { added.re } else { added.im }
        });
        let mut response = Correction::default();
        settling.respond(&forcing, &mut response);
        moved_by(settling, &response)
    });
    let [[re, re_nodes], [im, im_nodes]] = parts;
    let complex = |re: Vec<[f64; C]>, im: Vec<[f64; C]>| {
        re.iter().zip(&im).map(|(re, im)| std::array::from_fn(|a| Complex::new(re[a], im[a]))).collect()
    };
    [complex(re, im), complex(re_nodes, im_nodes)]
}

/// What a change of each field (station, field, what acts there, lane) adds to the equations.
fn forcing<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(
    settling: &Settling<P, S, L>,
    added: impl Fn(usize, usize, &Linear<C, L>, usize) -> f64,
) -> Forcing<S, 0, L> {
    let (moving, system) = (&settling.moving, &settling.system);
    let groups = settling.solution.groups();
    let fields = fields(moving);
    let mut stages = Vec::with_capacity(system.stations().len());
    let mut carried_by: Vec<[Lanes; L]> = Vec::with_capacity(stages.capacity());
    for (block, station) in system.stations().iter().enumerate() {
        let linear = moving.linear(block, station);
        let own = |field: usize| {
            let lane = |lane: usize| added(groups.station_in(block, lane), field, &linear, lane);
            if field < fields { Lanes(std::array::from_fn(lane)) } else { Lanes::of(0.0) }
        };
        let carried: [Lanes; L] = std::array::from_fn(|l| own(C + l));
        let mut stage = if fields > C {
            moving.stage_forcing(block, station, &system.locals()[block], carried)
        } else {
            StageForcing::default()
        };
        for field in 0..C {
            let (value, load) = (own(field), moving.load(field, station));
            for (slope, load) in stage.slope.iter_mut().zip(&load) {
                *slope += value * *load;
            }
        }
        stages.push(stage);
        carried_by.push(carried);
    }
    let at_ends = [system.gauss.cardinals(0.0), system.gauss.cardinals(1.0)];
    let mut ends = Vec::new();
    for (b, place) in moving.end_places().iter().enumerate().filter(|_| fields > C) {
        // At ends sections follow the polynomial through the stages.
        let mut carried = [Lanes::of(0.0); L];
        for l in 0..LANES {
            for (j, weight) in at_ends[place.sides[l].index()].iter().enumerate() {
                let (block, lane) = groups.at(place.elements[l], j);
                for (sum, own) in carried.iter_mut().zip(&carried_by[block]) {
                    sum.0[l] += weight * own.0[lane];
                }
            }
        }
        ends.push(moving.end_forcing(&system.end_stations()[b], &system.ends()[b], carried));
    }
    Forcing { stages, ends, ..Forcing::default() }
}

/// The changes of the coordinates with a response: at the stages, station by station, and at the nodes.
fn moved_by<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(
    settling: &Settling<P, S, L>,
    response: &Correction<S, M, 0, L>,
) -> [Vec<[f64; C]>; 2] {
    let (moving, system) = (&settling.moving, &settling.system);
    let groups = settling.solution.groups();
    let states = system.moved_states(response);
    let blocks: Vec<[Lanes; C]> =
        states.iter().zip(system.stations()).map(|(change, own)| moving.moved(own, change)).collect();
    let at_stage = |k: usize| {
        let (block, lane) = groups.station(k);
        std::array::from_fn(|a| blocks[block][a].0[lane])
    };
    let at_node = |(z, change): (&[f64; S], &[f64; S])| {
        let station = Station { z: z.map(Lanes::of), inner: [Lanes::of(0.0); L], closure_slope: Lanes::of(0.0) };
        moving.moved(&station, &change.map(Lanes::of)).map(|own| own.0[0])
    };
    let stages = (0..groups.elements * M).map(at_stage).collect();
    [stages, settling.solution.nodes.iter().zip(&response.nodes).map(at_node).collect()]
}

/// The matrix whose eigenvalues are kappa over `time` (s): that makes the slowest swing of size one.
fn matrix<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(
    settling: &Settling<P, S, L>,
    time: f64,
) -> DMatrix<f64> {
    let (moving, system) = (&settling.moving, &settling.system);
    let groups = settling.solution.groups();
    let stations = groups.elements * M;
    let compliance = compliance(settling);
    let size = compliance.nrows();
    let fields = size / stations;
    let linear: Vec<Linear<C, L>> =
        system.stations().iter().enumerate().map(|(b, station)| moving.linear(b, station)).collect();
    let whole = size + C * stations;
    let mut matrix = DMatrix::<f64>::zeros(whole, whole);
    for k in 0..stations {
        let (block, lane) = groups.station(k);
        let of = &linear[block];
        for row in 0..size {
            let c = |f: usize| compliance[(row, fields * k + f)];
            for a in 0..C {
                let by = |m: &[[Lanes; C]; C]| (0..C).map(|f| c(f) * m[f][a].0[lane]).sum::<f64>();
                matrix[(row, fields * k + a)] = by(&of.damping) / time;
                matrix[(row, size + C * k + a)] = by(&of.mass) / (time * time);
            }
            for a in C..fields {
                matrix[(row, fields * k + a)] = c(a) * of.viscous[a - C].0[lane] / time;
            }
        }
        for a in 0..C {
            matrix[(size + C * k + a, fields * k + a)] = 1.0;
        }
    }
    matrix
}

/// G: its columns are what a unit load, or a unit change of what a section carries (where the material has a memory of
/// rate), at one station moves.
fn compliance<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(
    settling: &Settling<P, S, L>,
) -> DMatrix<f64> {
    let (moving, system) = (&settling.moving, &settling.system);
    let groups = settling.solution.groups();
    let stations = groups.elements * M;
    let fields = fields(moving);
    let size = fields * stations;
    let mut compliance = DMatrix::<f64>::zeros(size, size);
    let mut response = Correction::default();
    let blocks = system.stations().len();
    let mut forcing = Forcing { stages: vec![StageForcing::default(); blocks], ..Forcing::default() };
    let at_ends = [system.gauss.cardinals(0.0), system.gauss.cardinals(1.0)];
    for k in 0..stations {
        let (block, lane) = groups.station(k);
        // The last group is filled up with its last element.
        let lanes = if groups.station_in(block, LANES - 1) == k { lane..LANES } else { lane..lane + 1 };
        let station = &system.stations()[block];
        for field in 0..fields {
            if field < C {
                let load = moving.load(field, station);
                for lane in lanes.clone() {
                    for (slope, load) in forcing.stages[block].slope.iter_mut().zip(&load) {
                        slope.0[lane] = load.0[lane];
                    }
                }
            } else {
                let mut carried = [Lanes::of(0.0); L];
                for lane in lanes.clone() {
                    carried[field - C].0[lane] = 1.0;
                }
                forcing.stages[block] = moving.stage_forcing(block, station, &system.locals()[block], carried);
                // At ends sections follow the polynomial through the stages.
                for (b, place) in moving.end_places().iter().enumerate() {
                    let mut carried = [Lanes::of(0.0); L];
                    for l in (0..LANES).filter(|l| place.elements[*l] == k / M) {
                        carried[field - C].0[l] = at_ends[place.sides[l].index()][k % M];
                    }
                    forcing.ends.push(moving.end_forcing(&system.end_stations()[b], &system.ends()[b], carried));
                }
            }
            settling.respond(&forcing, &mut response);
            forcing.stages[block] = StageForcing::default();
            forcing.ends.clear();
            let states = system.moved_states(&response);
            for (b, (change, own)) in states.iter().zip(system.stations()).enumerate() {
                let moved = moving.moved(own, change);
                for l in 0..groups.filled(b / M) {
                    let i = groups.station_in(b, l);
                    for f in 0..fields {
                        let value = if f < C { moved[f] } else { response.stages[b].inner[f - C] };
                        compliance[(fields * i + f, fields * k + field)] = value.0[l];
                    }
                }
            }
        }
    }
    compliance
}
