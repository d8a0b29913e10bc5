//! Sobol's sequence with a random shift of its digits.
//!
//! Primitive polynomials and first direction numbers are those of S. Joe and F. Y. Kuo, "Constructing Sobol sequences
//! with better two-dimensional projections", SIAM J. Sci. Comput. 30 (2008), of their table for many dimensions.

use crate::draw::hash;

/// Digits of a point: as many rows can be drawn as they tell apart.
const BITS: usize = 32;

/// Degree and inner coefficients of the polynomial, and the first odd numbers, of all dimensions but the first.
const FIRST: [(usize, u32, &[u32]); DIMENSIONS - 1] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
    (5, 11, &[1, 1, 5, 1, 1]),
    (5, 13, &[1, 1, 1, 3, 11]),
    (5, 14, &[1, 3, 5, 5, 31]),
    (6, 1, &[1, 3, 3, 9, 7, 49]),
    (6, 13, &[1, 1, 1, 15, 21, 21]),
    (6, 16, &[1, 3, 1, 13, 27, 49]),
];

/// The most keys that can be drawn together.
pub(crate) const DIMENSIONS: usize = 16;
/// The most rows.
pub(crate) const MOST: u64 = 1 << BITS;

/// The sequence in its first dimensions.
///
/// ```
/// use hydrostat_sweep::Sobol;
///
/// let points = Sobol::new(2, 7); // two coordinates, seed 7
/// let left = (0..64).filter(|index| points.point(*index)[0] < 0.5).count();
/// assert_eq!(left, 32, "half of them in each half");
/// ```
#[derive(Debug, Clone)]
pub struct Sobol {
    directions: Vec<[u32; BITS]>,
    shifts: Vec<u32>,
}

impl Sobol {
    /// Coordinates that a point can have.
    pub const MOST_DIMENSIONS: usize = DIMENSIONS;

    /// Of at most [`Sobol::MOST_DIMENSIONS`], others are left out; the digits are shifted by what `seed` draws.
    pub fn new(dimensions: usize, seed: u64) -> Self {
        let directions = (0..dimensions.min(DIMENSIONS)).map(directions).collect();
        let shifts = (0..dimensions as u64).map(|d| (hash(seed, d, 0) >> 32) as u32).collect();
        Self { directions, shifts }
    }

    /// Point `index` (below 2^32), coordinates in (0, 1).
    pub fn point(&self, index: u64) -> Vec<f64> {
        (0..self.directions.len()).map(|dimension| self.at(dimension, index)).collect()
    }

    /// Coordinate `dimension` of point `index`, in (0, 1).
    pub(crate) fn at(&self, dimension: usize, index: u64) -> f64 {
        let directions = &self.directions[dimension];
        let set = (0..BITS).filter(|bit| index >> bit & 1 == 1);
        let digits = set.fold(self.shifts[dimension], |digits, bit| digits ^ directions[bit]);
        (f64::from(digits) + 0.5) / MOST as f64
    }
}

fn directions(dimension: usize) -> [u32; BITS] {
    let mut out = [0; BITS];
    let Some((degree, inner, first)) = dimension.checked_sub(1).map(|k| FIRST[k]) else {
        for (bit, direction) in out.iter_mut().enumerate() {
            *direction = 1 << (BITS - 1 - bit);
        }
        return out;
    };
    for bit in 0..BITS {
        out[bit] = if bit < degree {
            first[bit] << (BITS - 1 - bit)
        } else {
            let mut next = out[bit - degree] ^ (out[bit - degree] >> degree);
            for k in 1..degree {
                if inner >> (degree - 1 - k) & 1 == 1 {
                    next ^= out[bit - k];
                }
            }
            next
        };
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each dimension by itself has one point in each of 2^k intervals, and so has every pair of neighbours of the first
    /// ones in boxes of some shape.
    #[test]
    fn points_are_spread_evenly() {
        let sobol = Sobol::new(DIMENSIONS, 5);
        for dimension in 0..DIMENSIONS {
            let mut seen = [false; 256];
            for index in 512..768 {
                let place = (256.0 * sobol.at(dimension, index)).floor();
                let cell = (0..256).find(|k| f64::from(*k) == place).unwrap();
                assert!(!std::mem::replace(&mut seen[usize::try_from(cell).unwrap()], true), "{dimension}");
            }
        }
        let boxes: std::collections::BTreeSet<[u64; 2]> = (0..256_u64)
            .map(|index| [0, 1].map(|d| [16.0, 16.0][d] * sobol.at(d, index)).map(|v| v.floor().to_bits()))
            .collect();
        assert_eq!(boxes.len(), 256);
    }

    /// The mean of a product over the cube is far closer than that of as many random points.
    #[test]
    fn products_are_integrated_well() {
        let count = 4096;
        for dimensions in [2, 5, DIMENSIONS] {
            let sobol = Sobol::new(dimensions, 1);
            let product = |index| (0..dimensions).map(|d| 1.0 + 0.5 * (sobol.at(d, index) - 0.5)).product::<f64>();
            let mean = (0..count).map(product).sum::<f64>() / count as f64;
            let random = (dimensions as f64 / 48.0 / count as f64).sqrt();
            assert!((mean - 1.0).abs() < 0.1 * random, "{dimensions}: {:e} {random:e}", mean - 1.0);
        }
    }
}
