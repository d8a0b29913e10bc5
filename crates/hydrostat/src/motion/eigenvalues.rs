//! The largest eigenvalues of a matrix, by Arnoldi's iteration.

use nalgebra::linalg::Schur;
use nalgebra::{Complex, DMatrix, DVector};

/// The largest eigenvalues of a matrix: those of its projection onto the Krylov space, of at most `most` vectors, of
/// `twins` vectors that have a part of everything. An eigenvalue that is there several times is found at most `twins`
/// times. The whole matrix may have so many of next to nothing that Schur's iteration does not settle.
pub(super) fn largest_eigenvalues(matrix: &DMatrix<f64>, most: usize, twins: usize) -> Option<Vec<Complex<f64>>> {
    let part = projection(matrix, most.min(matrix.nrows()), twins);
    let used = part.nrows();
    [used, used * 3 / 4, used / 2, used / 3].into_iter().filter(|n| *n > 0).find_map(|n| {
        let part = part.view((0, 0), (n, n)).into_owned();
        Some(Schur::try_new(part, f64::EPSILON, 200 * n)?.complex_eigenvalues().iter().copied().collect())
    })
}

/// The matrix on its Krylov space, in an orthonormal basis of that.
fn projection(matrix: &DMatrix<f64>, most: usize, twins: usize) -> DMatrix<f64> {
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
    out.view((0, 0), (used, used)).into_owned()
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
        let mut found = largest_eigenvalues(&matrix, 24, 2).unwrap();
        found.sort_by(|a, b| b.re.total_cmp(&a.re));
        for k in 0..6 {
            assert!((found[k].re - values[k]).abs() < 1e-9 && found[k].im.abs() < 1e-9, "{k}: {}", found[k]);
        }
    }
}
