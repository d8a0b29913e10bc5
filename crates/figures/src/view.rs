//! How places in space come onto the page: along an axis, or from an eye nearby.

/// A place or a direction in space.
pub(crate) type Vector = [f64; 3];

/// Directions on the page, and where it is seen from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View {
    right: Vector,
    up: Vector,
    /// Out of the page, to whoever looks.
    back: Vector,
    /// Without, all lines of sight are parallel.
    eye: Option<Eye>,
}

/// An eye at a distance from the middle of what is seen.
#[derive(Debug, Clone, Copy)]
struct Eye {
    middle: Vector,
    distance: f64,
}

impl View {
    /// e1 to the right, e2 up: from e3.
    pub(crate) const E1_E2: Self = Self::parallel([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    /// e1 to the right, e3 up: against e2.
    pub(crate) const E1_E3: Self = Self::parallel([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]);
    /// e2 to the right, e3 up: from e1.
    pub(crate) const E2_E3: Self = Self::parallel([0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);

    const fn parallel(right: Vector, up: Vector, back: Vector) -> Self {
        Self { right, up, back, eye: None }
    }

    /// From an eye in direction `back`, which is not along e2, at `distance` from `middle`; e2 is up.
    pub(crate) fn perspective(back: Vector, middle: Vector, distance: f64) -> Self {
        let back = unit(&back);
        let right = unit(&cross(&[0.0, 1.0, 0.0], &back));
        Self { right, up: cross(&back, &right), back, eye: Some(Eye { middle, distance }) }
    }

    /// A direction in those of the page: to the right, up, and out of it.
    pub(crate) fn turned(&self, v: &Vector) -> Vector {
        [dot(v, &self.right), dot(v, &self.up), dot(v, &self.back)]
    }

    /// Where a place is on the page, y up. In perspective lengths are as they are at the depth of the middle.
    pub(crate) fn place(&self, p: &Vector) -> [f64; 2] {
        let Some(Eye { middle, distance }) = self.eye else { return [dot(p, &self.right), dot(p, &self.up)] };
        let [right, up, back] = self.turned(&minus(p, &middle));
        // What is near the eye or behind it is in no picture, as the eye keeps its distance from all that is seen.
        let scale = distance / (distance - back).max(0.05 * distance);
        [scale * right, scale * up]
    }

    /// How near a place is: the larger, the nearer.
    pub(crate) fn nearness(&self, p: &Vector) -> f64 {
        let Some(Eye { middle, distance }) = self.eye else { return dot(p, &self.back) };
        let to_eye = minus(&self.back.map(|b| distance * b), &minus(p, &middle));
        -dot(&to_eye, &to_eye).sqrt()
    }

    /// The direction from a place to whoever looks.
    pub(crate) fn towards(&self, p: &Vector) -> Vector {
        let Some(Eye { middle, distance }) = self.eye else { return self.back };
        unit(&minus(&self.back.map(|b| distance * b), &minus(p, &middle)))
    }
}

pub(crate) fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: &Vector, b: &Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn minus(a: &Vector, b: &Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a` + `t` `b`.
pub(crate) fn plus(a: &Vector, t: f64, b: &Vector) -> Vector {
    [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]]
}

/// The direction of `v`; nothing where it has none.
pub(crate) fn unit(v: &Vector) -> Vector {
    let length = dot(v, v).sqrt();
    if length > 0.0 { v.map(|x| x / length) } else { [0.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_view_is_right_handed() {
        let nearby = View::perspective([0.4, 0.5, 1.0], [0.0; 3], 10.0);
        for view in [View::E1_E2, View::E1_E3, View::E2_E3, nearby] {
            let out = minus(&cross(&view.right, &view.up), &view.back);
            assert!(dot(&out, &out) < 1e-24, "{view:?}");
        }
    }

    #[test]
    fn what_is_nearer_is_larger_in_perspective_alone() {
        let nearby = View::perspective([0.0, 0.0, 1.0], [0.0; 3], 10.0);
        let size = |view: &View, z: f64| view.place(&[1.0, 0.0, z])[0];
        assert!((size(&nearby, 0.0) - 1.0).abs() < 1e-12 && (size(&nearby, 5.0) - 2.0).abs() < 1e-12);
        assert!((size(&View::E1_E2, 5.0) - 1.0).abs() < 1e-12);
        for view in [nearby, View::E1_E2] {
            assert!(view.nearness(&[0.0, 0.0, 1.0]) > view.nearness(&[0.0; 3]));
            assert!(view.towards(&[0.0; 3])[2] > 0.999);
        }
    }
}
