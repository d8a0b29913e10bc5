//! The shape of one arm as lines in millimetres.

use hydrostat::Configuration;

use crate::axes::Axes;
use crate::palette::Color;
use crate::placement::Occupied;
use crate::scene::{Scene, Stroke};

/// An arm's lines, mm.
#[derive(Debug, Clone)]
pub(crate) struct Outline {
    /// Left surface from base to tip, then right surface from tip to base: closed, (4).
    pub(crate) surface: Vec<[f64; 2]>,
    pub(crate) centreline: Vec<[f64; 2]>,
    /// Section lines from the left to the right surface.
    pub(crate) sections: Vec<[[f64; 2]; 2]>,
    /// Cables from base to anchor.
    pub(crate) cables: Vec<Vec<[f64; 2]>>,
}

/// How an arm is drawn.
#[derive(Debug, Clone)]
pub(crate) struct Style {
    pub(crate) fill: Color,
    pub(crate) surface: Stroke,
    pub(crate) sections: Stroke,
    pub(crate) centreline: Stroke,
    /// One a cable.
    pub(crate) cables: Vec<Stroke>,
}

const MM: f64 = 1e3;

impl Outline {
    /// Of a configuration, with `sections` equally spaced section lines.
    pub(crate) fn new(configuration: &Configuration, sections: usize) -> Self {
        let length = configuration.arm.length;
        let places = places(configuration);
        let mut outline = Self::along(configuration, &places);
        outline.sections = (0..sections)
            .map(|k| configuration.surfaces(length * k as f64 / (sections.max(2) - 1) as f64).map(millimetres))
            .collect();
        outline.cables = (0..configuration.arm.cables.len())
            .map(|c| places.iter().map_while(|s| configuration.cable_point(c, *s)).map(millimetres).collect())
            .collect();
        outline
    }

    /// Surface and centreline at these places along the arm, m.
    fn along(configuration: &Configuration, places: &[f64]) -> Self {
        let (mut left, mut right, mut centreline) = (Vec::new(), Vec::new(), Vec::new());
        for s in places {
            let [l, r] = configuration.surfaces(*s).map(millimetres);
            left.push(l);
            right.push(r);
            // The two surfaces are mirror images in the centreline.
            centreline.push([0.5 * (l[0] + r[0]), 0.5 * (l[1] + r[1])]);
        }
        left.extend(right.into_iter().rev());
        Self { surface: left, centreline, sections: Vec::new(), cables: Vec::new() }
    }

    /// Surface and centreline of a weighted mean of shapes; the weights add up to 1.
    pub(crate) fn mean(shapes: &[(&Configuration, f64)]) -> Self {
        let mut places: Vec<f64> = shapes.iter().flat_map(|(shape, _)| places(shape)).collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|b, a| *b - *a < 1e-9);
        let outlines: Vec<(Self, f64)> = shapes.iter().map(|(shape, w)| (Self::along(shape, &places), *w)).collect();
        let mean = |line: fn(&Self) -> &Vec<[f64; 2]>| {
            let count = outlines.first().map_or(0, |(outline, _)| line(outline).len());
            let of =
                |k: usize, axis: usize| outlines.iter().map(|(outline, w)| w * line(outline)[k][axis]).sum::<f64>();
            (0..count).map(|k| [of(k, 0), of(k, 1)]).collect()
        };
        let (surface, centreline) = (mean(|o| &o.surface), mean(|o| &o.centreline));
        Self { surface, centreline, sections: Vec::new(), cables: Vec::new() }
    }

    /// Where the tip is, mm.
    pub(crate) fn tip(&self) -> [f64; 2] {
        self.centreline.last().copied().unwrap_or_default()
    }

    /// Smallest and largest x and y.
    pub(crate) fn bounds(&self) -> [[f64; 2]; 2] {
        bounds(&self.surface)
    }

    pub(crate) fn draw(&self, scene: &mut Scene, axes: &Axes, style: &Style) {
        scene.area(&axes.all(&self.surface), Some(style.fill), None);
        for section in &self.sections {
            scene.line(&axes.all(section), style.sections);
        }
        scene.line(&axes.all(&self.centreline), style.centreline);
        scene.area(&axes.all(&self.surface), None, Some(style.surface));
        for (cable, stroke) in self.cables.iter().zip(&style.cables) {
            scene.line(&axes.all(cable), *stroke);
        }
    }

    /// Keeps labels off this arm.
    pub(crate) fn occupy(&self, page: &mut Occupied, axes: &Axes) {
        page.add_line(&axes.all(&self.surface));
        for section in &self.sections {
            page.add_line(&axes.all(section));
        }
        for cable in &self.cables {
            page.add_line(&axes.all(cable));
        }
    }
}

/// Smallest and largest x and y of `points`.
pub(crate) fn bounds(points: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    points.iter().fold([none, none], |mut b, p| {
        for axis in 0..2 {
            b[axis] = [b[axis][0].min(p[axis]), b[axis][1].max(p[axis])];
        }
        b
    })
}

fn millimetres([x, y]: [f64; 2]) -> [f64; 2] {
    [MM * x, MM * y]
}

/// Evenly spaced places, the nodes of the mesh (dense where the arm curls) and the cables' ends.
fn places(configuration: &Configuration) -> Vec<f64> {
    const EVEN: u32 = 200;
    let arm = &configuration.arm;
    let mut places: Vec<f64> = (0..=EVEN).map(|k| arm.length * f64::from(k) / f64::from(EVEN)).collect();
    let nodes = &configuration.stations.s;
    places.extend(nodes);
    places.extend(nodes.windows(2).map(|w| 0.5 * (w[0] + w[1])));
    places.extend(arm.cables.iter().map(|c| c.end * arm.length));
    places.sort_by(f64::total_cmp);
    places.dedup_by(|b, a| *b - *a < 1e-9 * arm.length);
    places
}
