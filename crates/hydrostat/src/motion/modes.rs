//! Small motions about an equilibrium: rates and frequencies.
//!
//! About rest the equations of a stage ([`super::equations`]) are, with u = (x, y, theta) and the strains e at the
//! stages of the mesh, and G what loads and what changes of the section law there move, by the tangent of the statics
//! (beta', ends, cables, stream and follower loads in it),
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

use hydrostat_bvp::{Correction, Forcing, LANES, Lanes, LinearisationError, Real, StageForcing};
use nalgebra::linalg::Schur;
use nalgebra::{Complex, DMatrix, DVector};

use super::dimensions::X;
use super::equations::Linear;
use super::error::MotionError;
use super::in_plane::{Planar, start_at_rest};
use super::settling::Moves;
use super::start::not_found;
use crate::rod::arm::Arm;
use crate::statics::dimensions::{L, M};

/// Real parts below this share of a rate are what rounding leaves of none.
const NOTHING: f64 = 1e-7;

/// Rates within this share of -1/t_v are left out: they gather there without end, and are no motion of the arm but
/// its material that relaxes.
const RELAXATION: f64 = 0.02;

/// Vectors of the space in which the slowest motions are looked for.
const SPACE: usize = 96;

/// One motion about an equilibrium: a real rate, or a conjugate pair of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Real and imaginary part of lambda, 1/s: the motion goes as exp(lambda t); of a pair the one with the positive
    /// imaginary part.
    pub rate: [f64; 2],
}

impl Mode {
    /// |Im lambda|/(2 pi), Hz; zero where the motion does not swing.
    pub fn frequency(&self) -> f64 {
        self.rate[1].abs() / (2.0 * std::f64::consts::PI)
    }

    /// -Re lambda/|lambda|: 0 of a free swing, 1 of one that only decays, negative where it grows.
    pub fn damping_ratio(&self) -> f64 {
        let size = self.rate[0].hypot(self.rate[1]);
        // Taken from zero, what is nothing is 0 and not -0.
        if size > 0.0 { 0.0 - self.rate[0] / size } else { 0.0 }
    }

    /// Whether it grows.
    pub fn grows(&self) -> bool {
        self.rate[0] > NOTHING * self.rate[0].hypot(self.rate[1])
    }

    /// Whether it grows as it swings.
    pub fn is_flutter(&self) -> bool {
        self.grows() && self.rate[1] != 0.0
    }
}

/// The slowest motions about an equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// In order of frequency, those of one frequency by the size of their rates.
    pub modes: Vec<Mode>,
    /// x, y (m) and theta (rad) of the tip in the equilibrium.
    pub tip: [f64; 3],
}

impl Modes {
    /// Whether no motion grows, of those found.
    pub fn is_stable(&self) -> bool {
        !self.modes.iter().any(Mode::grows)
    }
}

impl Arm {
    /// The `count` slowest motions about the equilibrium of this arm, by size of their rates, on a mesh of `elements`
    /// elements (8 are fine for some eight bending modes). The relaxation of the material itself, at -1/t_v, is not
    /// among them.
    ///
    /// ```
    /// use hydrostat::{Arm, Volume};
    ///
    /// let mut rod = Arm::cone(1.0, 0.001, 0.001, 1e9, 0.5); // m, Pa
    /// rod.readings.volume = Volume::None;
    /// rod.flow.density = 0.0; // a vacuum
    /// let modes = rod.modes(3, 8)?;
    /// // omega = b^2 sqrt(E I/(rho A L^4)) with b = 1.8751041.
    /// let omega = 1.875_104_069_f64.powi(2) * (1e9 * 0.25e-6 / 1000.0_f64).sqrt();
    /// let found = 2.0 * std::f64::consts::PI * modes.modes[0].frequency();
    /// assert!((found / omega - 1.0).abs() < 1e-5, "{found} {omega}");
    /// assert!(modes.is_stable());
    /// # Ok::<(), hydrostat::MotionError>(())
    /// ```
    ///
    /// # Errors
    /// [`MotionError`] where there is no equilibrium, or the arm cannot move.
    pub fn modes(&self, count: usize, elements: usize) -> Result<Modes, MotionError> {
        if !(1..=64).contains(&elements) {
            return Err(MotionError::Option { option: "elements", value: elements as f64, expected: "in [1, 64]" });
        }
        if let Some(i) = self.cables.iter().position(|cable| cable.stroke.is_some()) {
            let reason = "modes are those at given tensions: give the tension that `solve` finds";
            return Err(MotionError::Unsupported { key: format!("cable[{i}].stroke"), reason });
        }
        let mut settling = Planar::new(self);
        start_at_rest(&mut settling, self, Some(elements), 1e-8, 0.0)?;
        let rates = rates(&mut settling)?;
        let time = self.dynamics.relaxation_time;
        let mut modes: Vec<Mode> = rates
            .into_iter()
            .filter(|[re, im]| *im >= 0.0 && (re * time + 1.0).hypot(im * time) > RELAXATION)
            .map(|[re, im]| {
                let size = re.hypot(im);
                let swings = im > NOTHING * size;
                Mode { rate: [if re.abs() < 1e-12 * size { 0.0 } else { re }, if swings { im } else { 0.0 }] }
            })
            .collect();
        let size = |mode: &Mode| mode.rate[0].hypot(mode.rate[1]);
        modes.sort_by(|a, b| size(a).total_cmp(&size(b)));
        modes.truncate(count);
        modes.sort_by(|a, b| a.frequency().total_cmp(&b.frequency()).then(size(a).total_cmp(&size(b))));
        let end = settling.solution.nodes[settling.solution.mesh.elements()];
        let length = self.length;
        Ok(Modes { modes, tip: [end[X] * length, end[X + 1] * length, end[0]] })
    }
}

/// All rates that the mesh has, real and imaginary part, 1/s.
fn rates(settling: &mut Planar) -> Result<Vec<[f64; 2]>, MotionError> {
    let arm = settling.moving.statics.arm().clone();
    let failed = |failure| not_found(0.0, 0.0, failure, &arm);
    settling.linearise().map_err(|error| match error {
        LinearisationError::Slopes(failure) => failed(Some(failure)),
        LinearisationError::Singular(_) => failed(None),
    })?;
    let (moving, system) = (&settling.moving, &settling.system);
    let linear: Vec<Linear> =
        system.stations().iter().enumerate().map(|(b, station)| moving.linear(b, station)).collect();
    let groups = moving.statics.groups;
    let stations = groups.elements * M;
    let rate_law = moving.statics.arm().dynamics.relaxation_time > 0.0;
    let fields = if rate_law { 6 } else { 3 };
    let size = fields * stations;
    // Columns of G: what a unit load, or a unit change of what a section carries, at one station moves.
    let mut compliance = DMatrix::<f64>::zeros(size, size);
    let mut response = Correction::default();
    let mut forcing = Forcing { stages: vec![StageForcing::default(); linear.len()], ..Forcing::default() };
    let at_ends = [system.gauss.cardinals(0.0), system.gauss.cardinals(1.0)];
    for k in 0..stations {
        let (block, lane) = groups.station(k);
        // The last group is filled up with its last element.
        let lanes = if groups.station_in(block, LANES - 1) == k { lane..LANES } else { lane..lane + 1 };
        for field in 0..fields {
            let stage = &mut forcing.stages[block];
            if field < 3 {
                for lane in lanes.clone() {
                    stage.slope[1 + field].0[lane] = 1.0;
                }
            } else {
                let mut carried = [Lanes::of(0.0); L];
                for lane in lanes.clone() {
                    carried[field - 3].0[lane] = 1.0;
                }
                *stage = moving.drift(block, &system.stations()[block], &system.locals()[block], carried);
                // At ends sections follow the polynomial through the stages.
                for (b, place) in moving.statics.end_places.iter().enumerate() {
                    let mut carried = [Lanes::of(0.0); L];
                    for l in (0..LANES).filter(|l| place.elements[*l] == k / M) {
                        carried[field - 3].0[l] = at_ends[place.sides[l].index()][k % M];
                    }
                    forcing.ends.push(moving.end_drift(&system.end_stations()[b], &system.ends()[b], carried));
                }
            }
            settling.respond(&forcing, &mut response);
            forcing.stages[block] = StageForcing::default();
            forcing.ends.clear();
            let states = system.moved_states(&response);
            for i in 0..stations {
                let (b, l) = groups.station(i);
                let moved = [states[b][X], states[b][X + 1], states[b][0]];
                for f in 0..fields {
                    let value = if f < 3 { moved[f] } else { response.stages[b].inner[f - 3] };
                    compliance[(fields * i + f, fields * k + field)] = value.0[l];
                }
            }
        }
    }
    // G D and G M; the time unit makes the slowest swing of size one.
    let time = moving.time_unit();
    let whole = size + 3 * stations;
    let mut matrix = DMatrix::<f64>::zeros(whole, whole);
    for k in 0..stations {
        let (block, lane) = groups.station(k);
        let of = &linear[block];
        for row in 0..size {
            let c = |f: usize| compliance[(row, fields * k + f)];
            for a in 0..2 {
                let by = |m: &[[Lanes; 2]; 2]| c(0) * m[0][a].0[lane] + c(1) * m[1][a].0[lane];
                matrix[(row, fields * k + a)] = by(&of.damping) / time;
                matrix[(row, size + 3 * k + a)] = by(&of.mass) / (time * time);
            }
            matrix[(row, size + 3 * k + 2)] = c(2) * of.rotary.0[lane] / (time * time);
            for a in 3..fields {
                matrix[(row, fields * k + a)] = c(a) * of.viscous[a - 3].0[lane] / time;
            }
        }
        for a in 0..3 {
            matrix[(size + 3 * k + a, fields * k + a)] = 1.0;
        }
    }
    let eigenvalues = largest_eigenvalues(&matrix).ok_or_else(|| failed(None))?;
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

/// The largest eigenvalues of a matrix, by Arnoldi's iteration: those of its projection onto the Krylov space of a
/// vector that has a part of everything. Eigenvalues fall as the square of a mode's number, so that a space of this
/// size has dozens. The whole matrix has so many of next to nothing that Schur's iteration does not settle.
fn largest_eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let size = matrix.nrows();
    let most = SPACE.min(size);
    let mut basis = vec![DVector::from_fn(size, |i, _| (1.0 + i as f64 * 0.618_033_988_75).sin()).normalize()];
    let mut hessenberg = DMatrix::<f64>::zeros(most, most);
    let mut used = most;
    let whole = matrix.norm();
    for k in 0..most {
        let mut next = matrix * &basis[k];
        // Twice, so that rounding leaves nothing of the space before.
        for _ in 0..2 {
            for (i, own) in basis.iter().enumerate() {
                let part = own.dot(&next);
                next.axpy(-part, own, 1.0);
                hessenberg[(i, k)] += part;
            }
        }
        let left = next.norm();
        if k + 1 == most || left < 1e-13 * whole {
            used = k + 1;
            break;
        }
        hessenberg[(k + 1, k)] = left;
        basis.push(next / left);
    }
    [used, used * 3 / 4, used / 2, used / 3].into_iter().filter(|n| *n > 0).find_map(|n| {
        let part = hessenberg.view((0, 0), (n, n)).into_owned();
        Some(Schur::try_new(part, f64::EPSILON, 200 * n)?.complex_eigenvalues().iter().copied().collect())
    })
}
