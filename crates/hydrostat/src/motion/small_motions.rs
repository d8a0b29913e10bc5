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
use nalgebra::DMatrix;

use super::eigenvalues::largest_eigenvalues;
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

/// All rates of small motions about the equilibrium of `settling` that the mesh has, real and imaginary part, 1/s.
pub(super) fn rates<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(
    settling: &mut Settling<P, S, L>,
) -> Result<Vec<[f64; 2]>, MotionError> {
    let arm = settling.moving.arm().clone();
    let failed = |failure| not_found(0.0, 0.0, failure, &arm);
    settling.linearise().map_err(|error| match error {
        LinearisationError::Slopes(failure) => failed(Some(failure)),
        LinearisationError::Singular(_) => failed(None),
    })?;
    let time = settling.moving.time_unit();
    let matrix = matrix(settling, time);
    let [space, twins] = P::SPACE;
    let eigenvalues = largest_eigenvalues(&matrix, space, twins).ok_or_else(|| failed(None))?;
    let largest = eigenvalues.iter().map(|kappa| kappa.norm()).fold(0.0, f64::max);
    Ok(eigenvalues
        .iter()
        .filter(|kappa| kappa.norm() > 1e-9 * largest)
        .map(|kappa| {
            let square = kappa.norm_sqr() * time;
            [kappa.re / square, -kappa.im / square]
        })
        .collect())
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
    let fields = if moving.arm().dynamics.relaxation_time > 0.0 { C + L } else { C };
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
