//! The body of an arm in space: a tube of rings in millimetres, painted from the far end to the near one.

use hydrostat::SpatialConfiguration;

use crate::axes::Axes;
use crate::hull::hull;
use crate::palette::{BODY, Color, GREY, INK, PAPER};
use crate::placement::Occupied;
use crate::scene::{Point, Scene, Stroke};
use crate::view::{Vector, View, cross, dot, minus, plus, unit};

const MM: f64 = 1e3;
/// Equal parts of the length; every second border is drawn as a ring.
const PARTS: u32 = 48;
/// Parts are halved until their ends turn by less than this (cosine), or so often.
const TURN: f64 = 0.985;
const HALVINGS: u32 = 6;

/// A section of the arm, mm.
#[derive(Debug, Clone, Copy)]
struct Ring {
    /// Place along the arm, m.
    s: f64,
    centre: Vector,
    a: Vector,
    b: Vector,
    c: Vector,
    radius: f64,
    inner_radius: f64,
    /// Whether it is drawn.
    marked: bool,
}

impl Ring {
    fn corners(&self, radius: f64, sides: usize) -> Vec<Vector> {
        let corner = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / sides as f64).sin_cos();
            plus(&plus(&self.centre, radius * cos, &self.b), radius * sin, &self.c)
        };
        (0..sides).map(corner).collect()
    }
}

/// An arm in space, ready to be painted from anywhere.
#[derive(Debug, Clone)]
pub(crate) struct Solid {
    rings: Vec<Ring>,
    /// Where each cable passes the rings, as far as it runs.
    cables: Vec<Vec<Vector>>,
}

/// How the surface is painted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Paint {
    /// One colour, paler far away.
    Flat,
    /// Lit from above and the left.
    Lit,
}

impl Paint {
    /// Sides of the tube.
    fn sides(self) -> usize {
        match self {
            Self::Flat => 20,
            Self::Lit => 18,
        }
    }
}

impl Solid {
    pub(crate) fn new(configuration: &SpatialConfiguration) -> Self {
        let arm = &configuration.arm;
        let ring = |s: f64, marked: bool| {
            let st = configuration.at(s);
            let radius = |profile: &hydrostat::Profile| MM * st.beta * profile.at(st.s, arm.length).value;
            Ring {
                s,
                centre: [st.x, st.y, st.z].map(|v| MM * v),
                a: st.a,
                b: st.b,
                c: st.c,
                radius: radius(&arm.radius),
                inner_radius: radius(&arm.inner_radius),
                marked,
            }
        };
        let even = (0..=PARTS).map(|k| (arm.length * f64::from(k) / f64::from(PARTS), k % 2 == 0));
        let mut places: Vec<(f64, bool)> = even.chain(arm.cables.iter().map(|c| (c.end * arm.length, false))).collect();
        places.sort_by(|x, y| x.0.total_cmp(&y.0));
        places.dedup_by(|y, x| y.0 - x.0 < 1e-9 * arm.length);
        let mut rings: Vec<Ring> = Vec::new();
        for (s, marked) in places {
            let next = ring(s, marked);
            if let Some(last) = rings.last().copied() {
                halve(&mut rings, &last, &next, HALVINGS, &|s| ring(s, false));
            }
            rings.push(next);
        }
        let cable = |c: usize| {
            let at = |ring: &Ring| configuration.cable_point(c, ring.s).map(|p| p.map(|v| MM * v));
            rings.iter().map_while(at).collect()
        };
        let cables = (0..arm.cables.len()).map(cable).collect();
        Self { rings, cables }
    }

    /// Places on the surface.
    pub(crate) fn surface(&self) -> impl Iterator<Item = Vector> {
        self.rings.iter().flat_map(|ring| ring.corners(ring.radius, 12))
    }

    /// Smallest and largest x, y and z.
    pub(crate) fn bounds(&self) -> [[f64; 2]; 3] {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        self.surface().fold([none; 3], |mut bounds, p| {
            for (range, v) in bounds.iter_mut().zip(p) {
                *range = [range[0].min(v), range[1].max(v)];
            }
            bounds
        })
    }

    /// Middle of the tip section and its directors.
    pub(crate) fn tip(&self) -> (Vector, [Vector; 3]) {
        self.rings.last().map_or(([0.0; 3], [[0.0; 3]; 3]), |ring| (ring.centre, [ring.a, ring.b, ring.c]))
    }

    /// The outline of each part between two rings, moved by `to`, on the page: for a shadow.
    pub(crate) fn parts<'a>(&'a self, to: impl Fn(Vector) -> Point + 'a) -> impl Iterator<Item = Vec<Point>> + 'a {
        self.rings.windows(2).map(move |pair| {
            let corners = pair.iter().flat_map(|ring| ring.corners(ring.radius, 16)).map(|p| (to(p), false));
            hull(corners.collect()).into_iter().map(|(p, _)| p).collect()
        })
    }

    /// Paints the arm as `view` sees it; `strokes` are those of the cables.
    pub(crate) fn draw(&self, scene: &mut Scene, axes: &Axes, view: &View, paint: Paint, strokes: &[Stroke]) {
        let painter = Painter { solid: self, axes, view, paint, strokes, depths: self.depths(view) };
        if self.rings.len() < 2 {
            return;
        }
        let mut order: Vec<(f64, bool, usize)> =
            (0..self.rings.len() - 1).map(|i| (self.nearness(view, i), false, i)).collect();
        // Lines lie on top of what is next to them along the arm: of a part seen aslant it would hide their ends.
        let lines: Vec<(f64, bool, usize)> =
            (0..order.len()).map(|i| (self.nearest_beside(&order, i), true, i)).collect();
        order.extend(lines);
        order.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        for (_, is_lines, i) in order {
            if is_lines { painter.lines(scene, i) } else { painter.surface(scene, i) }
        }
    }

    /// Keeps labels off the arm.
    pub(crate) fn occupy(&self, page: &mut Occupied, axes: &Axes, view: &View) {
        for part in self.parts(|p| axes.at(view.place(&p))) {
            page.add_line(&part);
        }
    }

    fn middle(&self, i: usize) -> Vector {
        let (from, to) = (&self.rings[i], &self.rings[i + 1]);
        plus(&from.centre, 0.5, &minus(&to.centre, &from.centre))
    }

    fn nearness(&self, view: &View, i: usize) -> f64 {
        view.nearness(&self.middle(i))
    }

    /// The nearness of the nearest part that is near part `i` along the arm.
    fn nearest_beside(&self, nearness: &[(f64, bool, usize)], i: usize) -> f64 {
        let reach = 2.5 * self.rings[i].radius / MM;
        let beside = |j: &usize| (self.rings[*j].s - self.rings[i].s).abs() <= reach;
        let found = (0..nearness.len()).filter(beside).map(|j| nearness[j].0);
        found.fold(nearness[i].0, f64::max)
    }

    /// The farthest and the nearest middle of a ring, at least a third of the length apart: an arm across the page is not
    /// paler at one end.
    fn depths(&self, view: &View) -> [f64; 2] {
        let all = self.rings.iter().map(|ring| view.nearness(&ring.centre));
        let [far, near] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[far, near], d| [far.min(d), near.max(d)]);
        let length = self.rings.last().map_or(1.0, |ring| MM * ring.s);
        [far.min(near - length / 3.0), near]
    }
}

/// Rings between `from` and `to`, until none turns far from the next.
fn halve(rings: &mut Vec<Ring>, from: &Ring, to: &Ring, left: u32, ring: &dyn Fn(f64) -> Ring) {
    if left == 0 || dot(&from.a, &to.a) > TURN {
        return;
    }
    let between = ring(0.5 * (from.s + to.s));
    halve(rings, from, &between, left - 1, ring);
    rings.push(between);
    halve(rings, &between, to, left - 1, ring);
}

const EDGE: Stroke = Stroke::solid(INK, 0.8);
const RING: Stroke = Stroke::solid(GREY, 0.35);

struct Painter<'a> {
    solid: &'a Solid,
    axes: &'a Axes,
    view: &'a View,
    paint: Paint,
    strokes: &'a [Stroke],
    /// The farthest and the nearest.
    depths: [f64; 2],
}

/// What is between two rings.
struct Part {
    corners: [Vec<Vector>; 2],
    page: [Vec<Point>; 2],
    /// Sides that face whoever looks: the corners that they run between.
    seen: Vec<[usize; 2]>,
}

impl Part {
    fn quad(&self, [j, k]: [usize; 2]) -> [Point; 4] {
        let [first, second] = &self.page;
        [first[j], first[k], second[k], second[j]]
    }

    /// Outwards.
    fn normal(&self, [j, k]: [usize; 2]) -> Vector {
        let [first, second] = &self.corners;
        unit(&cross(&minus(&first[k], &second[j]), &minus(&second[k], &first[j])))
    }

    /// The outline on the page; marked are the corners on the second ring.
    fn outline(&self) -> Vec<(Point, bool)> {
        let marked = |k: usize| self.page[k].iter().map(move |p| (*p, k == 1));
        hull(marked(0).chain(marked(1)).collect())
    }
}

impl Painter<'_> {
    fn at(&self, p: &Vector) -> Point {
        self.axes.at(self.view.place(p))
    }

    fn on_page(&self, points: &[Vector]) -> Vec<Point> {
        points.iter().map(|p| self.at(p)).collect()
    }

    /// A colour at part `i`: what is far away is paler.
    fn hazy(&self, color: Color, i: usize) -> Color {
        let [far, near] = self.depths;
        color.towards(PAPER, 0.45 * (near - self.solid.nearness(self.view, i)) / (near - far))
    }

    /// The part between rings `i` and `i + 1`.
    fn part(&self, i: usize) -> Part {
        let sides = self.paint.sides();
        let corners = [0, 1].map(|k| self.solid.rings[i + k].corners(self.solid.rings[i + k].radius, sides));
        let page = [0, 1].map(|k| self.on_page(&corners[k]));
        let mut part = Part { corners, page, seen: Vec::new() };
        let facets = (0..sides).map(|j| [j, (j + 1) % sides]);
        part.seen = facets.filter(|facet| area_up(&part.quad(*facet)) > 0.0).collect();
        part
    }

    fn surface(&self, scene: &mut Scene, i: usize) {
        let part = self.part(i);
        match self.paint {
            Paint::Flat => {
                let points: Vec<Point> = part.outline().iter().map(|(p, _)| *p).collect();
                let color = self.hazy(BODY.towards(PAPER, 0.25), i);
                scene.area(&points, Some(color), Some(Stroke::solid(color, SEAM)));
            }
            Paint::Lit => {
                for facet in &part.seen {
                    let color = self.hazy(lit(&self.view.turned(&part.normal(*facet))), i);
                    scene.area(&part.quad(*facet), Some(color), Some(Stroke::solid(color, SEAM)));
                }
            }
        }
    }

    /// What lies on part `i`: rings, edges, cables, and an end of the arm.
    fn lines(&self, scene: &mut Scene, i: usize) {
        let part = self.part(i);
        let last = self.solid.rings.len() - 1;
        let edge = Stroke { color: self.hazy(EDGE.color, i), ..EDGE };
        for (k, page) in part.page.iter().enumerate() {
            let is_end = i + k == 0 || i + k == last;
            if is_end || self.solid.rings[i + k].marked {
                let ring = if is_end { edge } else { Stroke { color: self.hazy(RING.color, i), ..RING } };
                for line in joined(&part.seen) {
                    scene.line(&line.iter().map(|j| page[*j]).collect::<Vec<Point>>(), ring);
                }
            }
        }
        let outline = part.outline();
        for k in 0..outline.len() {
            let ((from, first), (to, second)) = (outline[k], outline[(k + 1) % outline.len()]);
            if first != second {
                scene.line(&[from, to], edge);
            }
        }
        self.cables(scene, i);
        for (ring, outwards) in [(i, -1.0), (i + 1, 1.0)] {
            if ring == 0 || ring == last {
                self.end(scene, &self.solid.rings[ring], outwards, edge);
            }
        }
    }

    /// The flat end of the arm where it is seen, with the bore of a hollow arm.
    fn end(&self, scene: &mut Scene, ring: &Ring, outwards: f64, edge: Stroke) {
        let normal = ring.a.map(|v| outwards * v);
        if dot(&normal, &self.view.towards(&ring.centre)) <= 0.0 {
            return;
        }
        let color = BODY.towards(PAPER, 0.55);
        scene.area(&self.on_page(&ring.corners(ring.radius, 36)), Some(color), Some(edge));
        if ring.inner_radius > 0.0 {
            let bore = self.on_page(&ring.corners(ring.inner_radius, 36));
            scene.area(&bore, Some(GREY.towards(BODY, 0.3)), Some(Stroke { width: 0.5, ..edge }));
        }
    }

    /// The cables in part `i`: pale on the far side of the section.
    fn cables(&self, scene: &mut Scene, i: usize) {
        let centre = self.solid.middle(i);
        let towards = self.view.towards(&centre);
        let sides = self.solid.cables.iter().zip(self.strokes).filter_map(|(cable, stroke)| {
            let [from, to] = cable.get(i..i + 2).and_then(|pair| <[Vector; 2]>::try_from(pair).ok())?;
            let middle = plus(&from, 0.5, &minus(&to, &from));
            let off = minus(&middle, &centre);
            // What is beside the centreline, or on it, counts as near.
            let is_near = dot(&off, &towards) >= -0.2 * dot(&off, &off).sqrt();
            Some((is_near, cable, [from, to], *stroke))
        });
        let (near, far): (Vec<_>, Vec<_>) = sides.partition(|(is_near, ..)| *is_near);
        for (is_near, cable, ends, stroke) in far.into_iter().chain(near) {
            let color = self.hazy(if is_near { stroke.color } else { stroke.color.towards(BODY, 0.65) }, i);
            let solid = Stroke::solid(color, stroke.width);
            let ends = ends.map(|p| self.at(&p));
            match stroke.dash {
                None => scene.line(&ends, solid),
                Some(dash) => {
                    for dash in dashes(ends, self.length_before(cable, i), dash) {
                        scene.line(&dash, solid);
                    }
                }
            }
        }
    }

    /// The length on the page of a cable before ring `i`.
    fn length_before(&self, cable: &[Vector], i: usize) -> f64 {
        let page = self.on_page(&cable[..=i]);
        page.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum()
    }
}

/// Width of the line that closes the seams between areas, points.
const SEAM: f64 = 0.3;

/// The body's colour where its surface is normal to `n` (to the right, up, out of the page).
fn lit(n: &Vector) -> Color {
    const LIGHT: Vector = [-0.40, 0.69, 0.60];
    let fraction = dot(n, &LIGHT);
    if fraction > 0.75 {
        BODY.towards(PAPER, 2.4 * (fraction - 0.75))
    } else {
        BODY.towards(INK, 0.42 * (0.75 - fraction))
    }
}

/// Twice the area of a polygon on the page, positive if it runs counterclockwise as seen.
fn area_up(points: &[Point]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(p, q)| q[0] * p[1] - p[0] * q[1]).sum()
}

/// Corners of facets that follow each other, as lines.
fn joined(facets: &[[usize; 2]]) -> Vec<Vec<usize>> {
    let mut lines: Vec<Vec<usize>> = Vec::new();
    for [j, k] in facets {
        match lines.last_mut() {
            Some(line) if line.last() == Some(j) => line.push(*k),
            _ => lines.push(vec![*j, *k]),
        }
    }
    // The first corner is where the count begins, not where the surface does.
    if lines.len() > 1 && lines[0][0] == 0 && lines[lines.len() - 1].last() == Some(&0) {
        let first = lines.remove(0);
        if let Some(line) = lines.last_mut() {
            line.extend(&first[1..]);
        }
    }
    lines
}

/// The parts of a line from `ends[0]` to `ends[1]` that a dashed line shows which has run for `before`.
fn dashes(ends: [Point; 2], before: f64, [on, off]: [f64; 2]) -> Vec<[Point; 2]> {
    let length = (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]);
    let period = on + off;
    let mut out = Vec::new();
    let mut from = -(before % period);
    while from < length && length > 0.0 {
        let (start, end) = (from.max(0.0), (from + on).min(length));
        if start < end {
            let at = |d: f64| [0, 1].map(|k| ends[0][k] + d / length * (ends[1][k] - ends[0][k]));
            out.push([at(start), at(end)]);
        }
        from += period;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_go_on_from_part_to_part() {
        let parts = dashes([[0.0, 0.0], [10.0, 0.0]], 1.0, [3.0, 2.0]);
        assert_eq!(parts, [[[0.0, 0.0], [2.0, 0.0]], [[4.0, 0.0], [7.0, 0.0]], [[9.0, 0.0], [10.0, 0.0]]]);
        assert!(dashes([[1.0, 1.0], [1.0, 1.0]], 0.0, [3.0, 2.0]).is_empty());
    }

    #[test]
    fn facets_that_follow_each_other_are_one_line() {
        assert_eq!(joined(&[[0, 1], [1, 2], [5, 0]]), [vec![5, 0, 1, 2]]);
        assert_eq!(joined(&[[1, 2], [3, 4]]), [vec![1, 2], vec![3, 4]]);
    }
}
