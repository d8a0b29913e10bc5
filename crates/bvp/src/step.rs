//! One Gauss step from a known state: values of a solution between its nodes, to the order of the nodes.

use crate::condense::eliminate;
use crate::gauss::Gauss;
use crate::problem::Local;

/// Follows the solution from `z` at `s` over the length `h` with one `M`-stage step. `slopes` are
/// guesses of the stage slopes, `locals` evaluates the problem at the places of all stages and their states. Returns the
/// state at `s + h` and the quadratures over the step; `None` when the step's equations are singular.
///
/// # Errors
/// Those of `locals`.
#[allow(clippy::type_complexity)]
pub fn step<const N: usize, const M: usize, const Q: usize, E>(
    gauss: &Gauss<M>,
    z: [f64; N],
    s: f64,
    h: f64,
    mut slopes: [[f64; N]; M],
    mut locals: impl FnMut(&[f64; M], &[[f64; N]; M]) -> Result<[Local<N, Q>; M], E>,
) -> Result<Option<([f64; N], [f64; Q])>, E> {
    let places = gauss.c.map(|c| s + h * c);
    let mut at = [Local::default(); M];
    for _ in 0..8 {
        let mut states = [z; M];
        for j in 0..M {
            for l in 0..M {
                for a in 0..N {
                    states[j][a] += h * gauss.a[j][l] * slopes[l][a];
                }
            }
        }
        at = locals(&places, &states)?;
        let mut response = [[[0.0; N]; N]; M];
        let mut load = [[[0.0; N]; M]; 1];
        for j in 0..M {
            for a in 0..N {
                load[0][j][a] = at[j].slope[a] - slopes[j][a];
            }
        }
        if !eliminate(h, gauss, &at, &mut response, &mut load) {
            return Ok(None);
        }
        let mut size = 0.0_f64;
        for j in 0..M {
            for a in 0..N {
                slopes[j][a] += load[0][j][a];
                size = size.max(load[0][j][a].abs() / (1.0 + slopes[j][a].abs()));
            }
        }
        if size * h.abs() < 1e-11 {
            break;
        }
    }
    let (mut end, mut total) = (z, [0.0; Q]);
    for j in 0..M {
        for a in 0..N {
            end[a] += h * gauss.b[j] * slopes[j][a];
        }
        for q in 0..Q {
            total[q] += h * gauss.b[j] * at[j].rate[q];
        }
    }
    Ok(Some((end, total)))
}
