//! The largest eigenvalues of a matrix, by Arnoldi's iteration, and their vectors.

use nalgebra::linalg::Schur;
use nalgebra::{Complex, DMatrix, DVector};

/// Eigenvalues within this fraction of each other are the same one.
const SAME: f64 = 1e-6;

/// How far from an eigenvalue inverse iteration is done.
const BESIDE: f64 = 1e-10;

/// Rounds of inverse iteration: the first one leaves 1e-10 of other vectors.
const ROUNDS: usize = 3;

/// The largest eigenvalues of a matrix, with its projection onto the space in which they are.
pub(super) struct Spectrum {
    /// The eigenvalues.
    pub(super) values: Vec<Complex<f64>>,
    projection: DMatrix<f64>,
    basis: Vec<DVector<f64>>,
    /// Subdiagonals of the projection that are not zero.
    twins: usize,
}

impl Spectrum {
    /// The largest eigenvalues: those of the matrix's projection onto the Krylov space, of at most `most` vectors, of
    /// `twins` vectors that have a part of everything. An eigenvalue that is there several times is found at most
    /// `twins` times. The whole matrix may have so many of next to nothing that Schur's iteration does not settle.
    pub(super) fn largest(matrix: &DMatrix<f64>, most: usize, twins: usize) -> Option<Self> {
        let (whole, basis) = projected(matrix, most.min(matrix.nrows()), twins);
        let used = whole.nrows();
        [used, used * 3 / 4, used / 2, used / 3].into_iter().filter(|n| *n > 0).find_map(|n| {
            let projection = whole.view((0, 0), (n, n)).into_owned();
            let schur = Schur::try_new(projection.clone(), f64::EPSILON, 200 * n)?;
            let values = schur.complex_eigenvalues().iter().copied().collect();
            Some(Self { values, projection, basis: basis[..n].to_vec(), twins })
        })
    }

    /// An eigenvector of each of these values, which are eigenvalues but for rounding; those of one that is there
    /// several times are normal to each other. `None` where rounding leaves none.
    pub(super) fn vectors(&self, values: &[Complex<f64>]) -> Option<Vec<DVector<Complex<f64>>>> {
        let mut found: Vec<DVector<Complex<f64>>> = Vec::new();
        for (k, value) in values.iter().enumerate() {
            let same: Vec<usize> = (0..k).filter(|i| (values[*i] - value).norm() < SAME * value.norm()).collect();
            let n = self.projection.nrows();
            let beside = value * (1.0 + BESIDE);
            let shifted = DMatrix::from_fn(n, n, |i, j| {
                let own = Complex::new(self.projection[(i, j)], 0.0);
                if i == j { own - beside } else { own }
            });
            let turns = 0.618_033_988_75 + 0.414_213_562 * k as f64;
            let mut own = DVector::from_fn(n, |i, _| Complex::new((1.0 + i as f64 * turns).sin(), 0.0));
            for _ in 0..ROUNDS {
                own = solved(shifted.clone(), own, self.twins);
                for other in same.iter().map(|i| &found[*i]) {
                    let part = other.dotc(&own);
                    own.axpy(-part, other, Complex::new(1.0, 0.0));
                }
                let size = own.norm();
                if !(size > 0.0 && size.is_finite()) {
                    return None;
                }
                own.unscale_mut(size);
            }
            found.push(own);
        }
        let whole = |own: &DVector<Complex<f64>>| {
            let mut out = DVector::from_element(self.basis[0].len(), Complex::new(0.0, 0.0));
            for (vector, part) in self.basis.iter().zip(own.iter()) {
                out.zip_apply(vector, |sum, v| *sum += part * v);
            }
            out
        };
        Some(found.iter().map(whole).collect())
    }
}

/// The solution of a system of equations whose matrix has so many subdiagonals. A pivot of nothing is taken for very
/// little, as it is beside an eigenvalue.
fn solved(mut matrix: DMatrix<Complex<f64>>, mut right: DVector<Complex<f64>>, below: usize) -> DVector<Complex<f64>> {
    let n = right.len();
    let little = Complex::new(f64::EPSILON * matrix.norm(), 0.0);
    for j in 0..n {
        let last = (j + below).min(n - 1);
        let pivot =
            (j..=last).fold(j, |best, i| if matrix[(i, j)].norm() > matrix[(best, j)].norm() { i } else { best });
        matrix.swap_rows(j, pivot);
        right.swap_rows(j, pivot);
        if matrix[(j, j)].norm() < little.re {
            matrix[(j, j)] = little;
        }
        for i in j + 1..=last {
            let factor = matrix[(i, j)] / matrix[(j, j)];
            for k in j..n {
                let own = matrix[(j, k)];
                matrix[(i, k)] -= factor * own;
            }
            let own = right[j];
            right[i] -= factor * own;
        }
    }
    for i in (0..n).rev() {
        let known: Complex<f64> = (i + 1..n).map(|k| matrix[(i, k)] * right[k]).sum();
        right[i] = (right[i] - known) / matrix[(i, i)];
    }
    right
}

/// The matrix on its Krylov space, in an orthonormal basis of that, and the basis.
fn projected(matrix: &DMatrix<f64>, most: usize, twins: usize) -> (DMatrix<f64>, Vec<DVector<f64>>) {
    let mut basis: Vec<DVector<f64>> = Vec::with_capacity(most);
    let mut out = DMatrix::<f64>::zeros(most, most);
    let whole = matrix.norm();
    for twin in 0..twins.min(most) {
        let turns = 0.618_033_988_75 + 0.414_213_562 * twin as f64;
        let mut own = DVector::from_fn(matrix.nrows(), |i, _| (1.0 + i as f64 * turns).sin()).normalize();
        without(&mut own, &basis, |_, _| {});
        basis.push(own.normalize());
    }
    let mut used = 0;
    while used < basis.len() {
        let mut next = matrix * &basis[used];
        without(&mut next, &basis, |i, part| out[(i, used)] += part);
        let left = next.norm();
        let last = basis.len();
        if last < most && left >= 1e-13 * whole {
            out[(last, used)] = left;
            basis.push(next / left);
        }
        used += 1;
    }
    basis.truncate(used);
    (out.view((0, 0), (used, used)).into_owned(), basis)
}

/// Takes the parts along an orthonormal basis away: twice, so that rounding leaves nothing of them.
fn without(vector: &mut DVector<f64>, basis: &[DVector<f64>], mut part_taken: impl FnMut(usize, f64)) {
    for _ in 0..2 {
        for (i, own) in basis.iter().enumerate() {
            let part = own.dot(vector);
            vector.axpy(-part, own, 1.0);
            part_taken(i, part);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice the eigenvalues 1, 1/2, 1/3 and so on, in other axes than the matrix's own.
    #[test]
    fn double_eigenvalues_are_found_twice() {
        let size = 40;
        let turned = DMatrix::from_fn(size, size, |i, j| ((i * j) as f64 + 0.3 * j as f64).sin()).qr().q();
        let values = DVector::from_fn(size, |i, _| 1.0 / (1.0 + (i / 2) as f64));
        let matrix = &turned * DMatrix::from_diagonal(&values) * turned.transpose();
        let spectrum = Spectrum::largest(&matrix, 32, 2).unwrap();
        let mut found = spectrum.values.clone();
        found.sort_by(|a, b| b.re.total_cmp(&a.re));
        for k in 0..6 {
            assert!((found[k].re - values[k]).abs() < 1e-9 && found[k].im.abs() < 1e-9, "{k}: {}", found[k]);
        }
        let vectors = spectrum.vectors(&found[..4]).unwrap();
        let complex = matrix.map(|v| Complex::new(v, 0.0));
        for (vector, value) in vectors.iter().zip(&found) {
            let left = (&complex * vector - vector.scale(value.re)).norm() / vector.norm();
            assert!(left < 1e-6, "{value}: {left:e}");
        }
        assert!(vectors[0].dotc(&vectors[1]).norm() < 1e-8, "two vectors of one value");
    }
}
