//! The shapes of small motions about an equilibrium, along the arm.

use nalgebra::{Complex, DVector};

use super::eigenvalues::Spectrum;
use super::error::MotionError;
use super::mode::Mode;
use super::settling::Settling;
use super::small_motions::{Vibrates, changes};
use super::start::not_found;
use crate::statics::dimensions::M;

/// Equally spaced places along the arm at which shapes are given.
const PLACES: usize = 51;

/// Rates within this fraction of each other are those of twins.
pub(super) const TWINS: f64 = 1e-6;

/// What two shapes of twins have to differ by, over their sizes, to be told apart by their displacements at a place.
const APART: f64 = 1e-3;

/// A section in the equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeSection {
    /// Arc length of the undeformed arm from the base, m.
    pub s: f64,
    /// Centreline, m.
    pub place: [f64; 3],
    /// Directors a, b and c.
    pub directors: [[f64; 3]; 3],
}

/// A section in the shape of a mode: complex amplitudes, real and imaginary part, along e1, e2 and e3.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ModeStation {
    /// Of the centreline's displacement, m.
    pub displacement: [[f64; 2]; 3],
    /// Of the turn, rad: a director d moves by turn x d.
    pub turn: [[f64; 2]; 3],
}

/// The shape of a mode at the places of [`Modes::sections`](crate::Modes::sections): where displacement and turn have
/// the amplitudes u, the motion is Re(u exp(lambda t)). Its size is such that the largest of |displacement| and radius
/// times |turn| is 1 m, its phase such that the largest displacement, or turn where turns are larger, is real and
/// positive along the axis on which it is largest. Of two modes of one rate, as a round arm has them in space, the one
/// moves along one axis and the other along another where both move most.
pub type ModeShape = Vec<ModeStation>;

type Amplitude = [[Complex<f64>; 3]; 2];

/// Where places are in the mesh: the element, and the weights of its stages and ends.
struct Between {
    s: f64,
    element: usize,
    stages: [f64; M],
    ends: [f64; 2],
}

fn between<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(
    settling: &Settling<P, S, L>,
) -> impl Iterator<Item = Between> + '_ {
    let (mesh, gauss) = (&settling.solution.mesh, &settling.system.gauss);
    (0..PLACES).map(move |k| {
        let s = k as f64 / (PLACES - 1) as f64;
        let element = mesh.element_of(s).min(mesh.elements() - 1);
        let (stages, ends) = gauss.cardinals_with_ends((s - mesh.nodes()[element]) / mesh.step(element));
        Between { s, element, stages, ends }
    })
}

/// The equilibrium at the places of the shapes.
pub(super) fn sections<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(
    settling: &Settling<P, S, L>,
) -> Vec<ModeSection> {
    let length = settling.moving.arm().length;
    let section = |at: Between| {
        let z = settling.solution.state_in(&settling.system.gauss, at.element, at.s);
        let (place, directors) = P::section(&z);
        ModeSection { s: length * at.s, place: place.map(|v| length * v), directors }
    };
    between(settling).map(section).collect()
}

/// The shapes of modes, which are in order of frequency.
pub(super) fn shapes<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(
    settling: &Settling<P, S, L>,
    spectrum: &Spectrum,
    modes: &[Mode],
) -> Result<Vec<ModeShape>, MotionError> {
    let arm = settling.moving.arm();
    let time = settling.moving.time_unit();
    let rates: Vec<Complex<f64>> = modes.iter().map(|mode| Complex::new(mode.rate[0], mode.rate[1])).collect();
    let kappas: Vec<Complex<f64>> = rates.iter().map(|rate| (rate * time).inv()).collect();
    let vectors = spectrum.vectors(&kappas).ok_or_else(|| not_found(0.0, 0.0, None, arm))?;
    let radii: Vec<f64> = between(settling).map(|at| arm.radius.at(arm.length * at.s, arm.length).value).collect();
    let mut found: Vec<Vec<Amplitude>> =
        vectors.iter().zip(&rates).map(|(own, rate)| along(settling, *rate, own)).collect();
    let mut k = 0;
    while k + 1 < found.len() {
        if (rates[k + 1] - rates[k]).norm() < TWINS * rates[k].norm() {
            if let [one, other] = &mut found[k..k + 2] {
                part_twins(one, other);
            }
            k += 1;
        }
        k += 1;
    }
    Ok(found.into_iter().map(|own| normalised(&own, &radii)).collect())
}

/// Displacement (m) and turn along the arm of a motion with an eigenvector.
fn along<P: Vibrates<S, L, C>, const S: usize, const L: usize, const C: usize>(
    settling: &Settling<P, S, L>,
    rate: Complex<f64>,
    own: &DVector<Complex<f64>>,
) -> Vec<Amplitude> {
    let length = settling.moving.arm().length;
    let [stages, nodes] = changes(settling, rate, own);
    let amplitude = |at: Between| {
        let i = at.element;
        let coordinate = |a: usize| -> Complex<f64> {
            let inner: Complex<f64> = (0..M).map(|j| stages[M * i + j][a] * at.stages[j]).sum();
            inner + nodes[i][a] * at.ends[0] + nodes[i + 1][a] * at.ends[1]
        };
        let moved: [Complex<f64>; C] = std::array::from_fn(coordinate);
        let z = settling.solution.state_in(&settling.system.gauss, i, at.s);
        let [re, im] = [moved.map(|v| v.re), moved.map(|v| v.im)].map(|part| P::in_space(&z, &part));
        let complex = |which: usize, by: f64| std::array::from_fn(|k| Complex::new(re[which][k], im[which][k]) * by);
        [complex(0, length), complex(1, 1.0)]
    };
    between(settling).map(amplitude).collect()
}

/// Of two shapes of one rate, of which every sum is one, those that move along one axis each where they move most.
fn part_twins(one: &mut [Amplitude], other: &mut [Amplitude]) {
    let size = |at: &Amplitude| at[0].iter().map(Complex::norm_sqr).sum::<f64>();
    let sizes = one.iter().zip(other.iter()).map(|(a, b)| size(a) + size(b));
    let Some((place, _)) = sizes.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)) else { return };
    let (a, b) = (one[place][0], other[place][0]);
    let determinant = |(i, j): (usize, usize)| a[i] * b[j] - a[j] * b[i];
    let axes = [(0, 1), (0, 2), (1, 2)];
    let Some(best) = axes.into_iter().max_by(|p, q| determinant(*p).norm().total_cmp(&determinant(*q).norm())) else {
        return;
    };
    let whole = determinant(best);
    if whole.norm() < APART * (size(&one[place]) * size(&other[place])).sqrt() {
        return;
    }
    let (i, j) = best;
    // The first has nothing along the axis j there, the second nothing along i.
    let parts = [[b[j] / whole, -a[j] / whole], [-b[i] / whole, a[i] / whole]];
    for (p, q) in one.iter_mut().zip(other.iter_mut()) {
        let of = |[s, t]: [Complex<f64>; 2]| -> Amplitude {
            std::array::from_fn(|w| std::array::from_fn(|k| s * p[w][k] + t * q[w][k]))
        };
        (*p, *q) = (of(parts[0]), of(parts[1]));
    }
}

/// With the size and the phase that [`ModeShape`] says.
fn normalised(own: &[Amplitude], radii: &[f64]) -> ModeShape {
    let size = |v: &[Complex<f64>; 3]| v.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
    let mut largest = (0.0, Complex::new(1.0, 0.0));
    for (at, radius) in own.iter().zip(radii) {
        for (vector, by) in [(&at[0], 1.0), (&at[1], *radius)] {
            if by * size(vector) > largest.0 {
                let leading = vector.iter().copied().fold(Complex::new(0.0, 0.0), |best, v| {
                    // Of components that are alike the first one leads.
                    if v.norm() > 1.0001 * best.norm() { v } else { best }
                });
                largest = (by * size(vector), leading);
            }
        }
    }
    let (most, leading) = largest;
    let by = leading.conj() / (leading.norm().max(f64::MIN_POSITIVE) * most.max(f64::MIN_POSITIVE));
    let parts = |v: &[Complex<f64>; 3]| v.map(|v| v * by).map(|v| [v.re, v.im]);
    own.iter().map(|at| ModeStation { displacement: parts(&at[0]), turn: parts(&at[1]) }).collect()
}
