//! Vectors in space, and the rotation of a section as a quaternion.

use hydrostat_bvp::{Real, each};

/// A vector.
pub(crate) type Vector<R> = [R; 3];

#[inline(always)]
pub(crate) fn dot<R: Real>(a: &Vector<R>, b: &Vector<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(crate) fn cross<R: Real>(a: &Vector<R>, b: &Vector<R>) -> Vector<R> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(crate) fn sum<R: Real>(a: &Vector<R>, b: &Vector<R>) -> Vector<R> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(crate) fn times<R: Real>(f: R, a: &Vector<R>) -> Vector<R> {
    [f * a[0], f * a[1], f * a[2]]
}

/// The directors of a section in space: right-handed, orthonormal, `a` normal to the section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Directors<R> {
    pub(crate) a: Vector<R>,
    pub(crate) b: Vector<R>,
    pub(crate) c: Vector<R>,
}

impl<R: Real> Directors<R> {
    /// Of the quaternion q, scalar part first: those of q/|q|, because at the stages of a collocation |q| is one to
    /// the order of the stages only.
    #[inline(always)]
    pub(crate) fn of(q: &[R; 4]) -> Self {
        let [w, x, y, z] = *q;
        let (ww, xx, yy, zz) = (w * w, x * x, y * y, z * z);
        let inverse = R::of(1.0) / (ww + xx + yy + zz);
        let two = inverse + inverse;
        Self {
            a: [(ww + xx - yy - zz) * inverse, (x * y + w * z) * two, (x * z - w * y) * two],
            b: [(x * y - w * z) * two, (ww - xx + yy - zz) * inverse, (y * z + w * x) * two],
            c: [(x * z + w * y) * two, (y * z - w * x) * two, (ww - xx - yy + zz) * inverse],
        }
    }

    /// Components along the directors of a vector in space.
    #[inline(always)]
    pub(crate) fn to_body(self, v: &Vector<R>) -> Vector<R> {
        [dot(&self.a, v), dot(&self.b, v), dot(&self.c, v)]
    }

    /// The vector in space with these components along the directors.
    #[inline(always)]
    pub(crate) fn to_space(self, v: &Vector<R>) -> Vector<R> {
        each(|k| self.a[k] * v[0] + self.b[k] * v[1] + self.c[k] * v[2])
    }

    /// The linear map in space that is `m` in the directors.
    #[inline(always)]
    pub(crate) fn matrix_to_space(self, m: &[Vector<R>; 3]) -> [Vector<R>; 3] {
        // Rows and columns one after the other.
        let rows: [Vector<R>; 3] = each(|k| self.to_space(&m[k]));
        each(|k| each(|c| self.a[k] * rows[0][c] + self.b[k] * rows[1][c] + self.c[k] * rows[2][c]))
    }
}

impl Directors<f64> {
    /// The unit quaternion, scalar part first and not negative, that has these directors.
    pub(crate) fn quaternion(&self) -> [f64; 4] {
        let Self { a, b, c } = self;
        // Four times the square of each component; the largest is at least one.
        let squares =
            [1.0 + a[0] + b[1] + c[2], 1.0 + a[0] - b[1] - c[2], 1.0 - a[0] + b[1] - c[2], 1.0 - a[0] - b[1] + c[2]];
        let largest = (0..4).fold(0, |best, k| if squares[k] > squares[best] { k } else { best });
        let (wx, wy, wz) = (b[2] - c[1], c[0] - a[2], a[1] - b[0]);
        let (xy, xz, yz) = (b[0] + a[1], c[0] + a[2], c[1] + b[2]);
        let row = match largest {
            0 => [squares[0], wx, wy, wz],
            1 => [wx, squares[1], xy, xz],
            2 => [wy, xy, squares[2], yz],
            _ => [wz, xz, yz, squares[3]],
        };
        let norm = row.iter().map(|v| v * v).sum::<f64>().sqrt();
        let sign = if row[0] < 0.0 { -1.0 } else { 1.0 };
        row.map(|v| sign * v / norm)
    }
}

/// The rotation about the directors, (rad), that a change of the quaternion q is: d phi = `turn(q)` dq. A change of |q|
/// is none.
#[inline(always)]
pub(crate) fn turn<R: Real>(q: &[R; 4]) -> [[R; 4]; 3] {
    let [w, x, y, z] = *q;
    let f = R::of(2.0) / (w * w + x * x + y * y + z * z);
    [[-(f * x), f * w, f * z, -(f * y)], [-(f * y), -(f * z), f * w, f * x], [-(f * z), f * y, -(f * x), f * w]]
}

/// The turn (rad, about the directors) that a change of a state is, which begins with q.
pub(crate) fn turn_of<const N: usize>(z: &[f64; N], dz: &[f64; N]) -> Vector<f64> {
    let turns = turn(&each::<f64, 4>(|k| z[k]));
    each(|a| (0..4).map(|k| turns[a][k] * dz[k]).sum())
}

/// q' = 1/2 q (0, u), u in the directors.
#[inline(always)]
pub(crate) fn spin<R: Real>(q: &[R; 4], u: &Vector<R>) -> [R; 4] {
    let [w, x, y, z] = *q;
    let half = R::of(0.5);
    let [u1, u2, u3] = times(half, u);
    [-(x * u1 + y * u2 + z * u3), w * u1 + y * u3 - z * u2, w * u2 + z * u1 - x * u3, w * u3 + x * u2 - y * u1]
}

/// The rotation from the quaternion `from` to `q` as 2 tan(angle/2) times its axis, in the directors of either; their
/// lengths do not matter.
#[inline(always)]
pub(crate) fn relative<R: Real>(from: &[R; 4], q: &[R; 4]) -> Vector<R> {
    let [w, x, y, z] = *from;
    let [a, b, c, d] = *q;
    let fraction = R::of(2.0) / (w * a + x * b + y * c + z * d);
    [
        fraction * (w * b - x * a - y * d + z * c),
        fraction * (w * c - y * a - z * b + x * d),
        fraction * (w * d - z * a - x * c + y * b),
    ]
}

/// The quaternion that is turned from `from` as [`relative`] says, of length one if `from` is.
#[inline(always)]
pub(crate) fn turned_by<R: Real>(from: &[R; 4], c: &Vector<R>) -> [R; 4] {
    let own = spin(from, c);
    let fraction = R::of(1.0) / (R::of(1.0) + R::of(0.25) * dot(c, c)).sqrt();
    each(|k| fraction * (from[k] + own[k]))
}

/// The quaternion q turned by the rotation vector `phi` in its directors.
pub(crate) fn turned(q: &[f64; 4], phi: &Vector<f64>) -> [f64; 4] {
    let angle = dot(phi, phi).sqrt();
    let f = if angle < 1e-8 { 1.0 } else { (0.5 * angle).sin() / (0.5 * angle) };
    let cos = (0.5 * angle).cos();
    let by = spin(q, &times(f, phi));
    each(|k| cos * q[k] + by[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    const Q: [f64; 4] = [0.4, -0.3, 0.7, 0.2];

    #[test]
    fn directors_are_orthonormal_and_come_back_as_their_quaternion() {
        for q in [Q, [0.01, 0.9, 0.1, -0.2], [0.02, -0.1, 0.8, 0.3], [0.0, 0.1, 0.2, 0.9]] {
            let d = Directors::of(&q);
            assert!((dot(&cross(&d.a, &d.b), &d.c) - 1.0).abs() < 1e-15);
            let back = Directors::of(&d.quaternion());
            for k in 0..3 {
                assert!((d.a[k] - back.a[k]).abs() + (d.b[k] - back.b[k]).abs() + (d.c[k] - back.c[k]).abs() < 1e-14);
            }
        }
    }

    /// The turn of a change of q turns the directors by d a = d phi x a, and a change of length does nothing.
    #[test]
    fn turns_match_differences() {
        let d = Directors::of(&Q);
        for k in 0..4 {
            let step = 1e-6;
            let [hi, lo] = [step, -step].map(|h| {
                let mut q = Q;
                q[k] += h;
                Directors::of(&q)
            });
            let phi = turn(&Q).map(|row| row[k]);
            let axis = d.to_space(&phi);
            for (of, [hi, lo]) in [(d.a, [hi.a, lo.a]), (d.b, [hi.b, lo.b]), (d.c, [hi.c, lo.c])] {
                let moved = cross(&axis, &of);
                for j in 0..3 {
                    assert!(((hi[j] - lo[j]) / (2.0 * step) - moved[j]).abs() < 1e-8);
                }
            }
        }
        let along: [f64; 3] = each(|a| (0..4).map(|k| turn(&Q)[a][k] * Q[k]).sum());
        assert!(along.iter().all(|v| v.abs() < 1e-15));
    }

    #[test]
    fn relative_rotations_lead_back() {
        let far = turned(&Q, &[0.5, 0.2, -0.9]);
        let c = relative(&Q, &far);
        let angle = dot(&[0.5, 0.2, -0.9], &[0.5, 0.2, -0.9]).sqrt();
        assert!((dot(&c, &c).sqrt() - 2.0 * (0.5 * angle).tan()).abs() < 1e-14);
        let back = turned_by(&Q, &c);
        assert!((0..4).all(|k| (far[k] - back[k]).abs() < 1e-14));
    }

    #[test]
    fn spinning_is_turning_at_the_rate_u() {
        let u = [0.3, -1.2, 0.8];
        let dq = spin(&Q, &u);
        let phi: [f64; 3] = each(|a| (0..4).map(|k| turn(&Q)[a][k] * dq[k]).sum());
        assert!((0..3).all(|k| (phi[k] - u[k]).abs() < 1e-14));
        let far = turned(&Q, &[0.5, 0.2, -0.9]);
        let steps = (0..1000).fold(Q, |q, _| turned(&q, &[0.0005, 0.0002, -0.0009]));
        assert!((0..4).all(|k| (far[k] - steps[k]).abs() < 1e-12));
    }
}
