//! The convex outline of points.

use crate::scene::Point;

/// The corners of the convex outline of `points` in their order round it, each with its mark.
pub(crate) fn hull(mut points: Vec<(Point, bool)>) -> Vec<(Point, bool)> {
    points.sort_by(|(p, _), (q, _)| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    let mut outline = chain(points.iter().copied());
    let other = chain(points.iter().rev().copied());
    // Each chain begins where the other ends.
    outline.pop();
    outline.extend(&other[..other.len().saturating_sub(1)]);
    outline
}

/// The side of the outline that lies to the right of its points in their order.
fn chain(points: impl Iterator<Item = (Point, bool)>) -> Vec<(Point, bool)> {
    let mut out: Vec<(Point, bool)> = Vec::new();
    for (p, mark) in points {
        while let [.., (o, _), (a, _)] = out.as_slice()
            && (a[0] - o[0]) * (p[1] - o[1]) - (a[1] - o[1]) * (p[0] - o[0]) <= 0.0
        {
            out.pop();
        }
        out.push((p, mark));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inner_points_are_left_out() {
        let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0], [1.0, 0.0]];
        let outline = hull(points.iter().map(|p| (*p, p[0] > 1.0)).collect());
        assert_eq!(outline.len(), 4);
        assert_eq!(outline.iter().filter(|(_, mark)| *mark).count(), 2);
    }

    #[test]
    fn few_points_are_their_own_outline() {
        assert!(hull(Vec::new()).is_empty());
        assert!(hull(vec![([1.0, 1.0], true)]).len() <= 1);
    }
}
