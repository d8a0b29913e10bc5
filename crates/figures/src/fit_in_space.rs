//! Fitted shapes in space with what was measured: centrelines in three views at one scale.

use hydrostat::SpatialConfiguration;
use hydrostat_identify::{Marker, Shape};

use crate::legend::Mark;
use crate::page::Page;
use crate::palette::{Color, INK};
use crate::scene::{Scene, Stroke};
use crate::three_views::{Placed, ThreeViews, centreline};

/// Places that a centreline is drawn through.
const PLACES: usize = 60;
/// Room around what is drawn over its widest extent.
const PAD: f64 = 0.05;

/// One load case.
pub(crate) struct SpatialCase<'a> {
    pub(crate) shape: &'a SpatialConfiguration,
    /// Markers with their measured places, m.
    pub(crate) markers: &'a [(Marker, [f64; 3])],
    pub(crate) color: Color,
}

/// The views on the page, with the lines that they show, mm.
pub(crate) struct InSpace {
    placed: Placed,
    centrelines: Vec<Vec<[f64; 3]>>,
    /// Of each load case: rods from the centreline to the fitted places of markers.
    rods: Vec<Vec<[[f64; 3]; 2]>>,
}

impl InSpace {
    pub(crate) fn new(cases: &[SpatialCase<'_>], top: f64, page: &Page) -> Self {
        let mm = |place: [f64; 3]| place.map(|v| 1e3 * v);
        let rods = |case: &SpatialCase<'_>| -> Vec<[[f64; 3]; 2]> {
            let shape = Shape::Space(Box::new(case.shape.clone()));
            let foot = |marker: &Marker| shape.place(Marker { offset: [0.0; 3], ..*marker });
            case.markers.iter().map(|(marker, _)| [mm(foot(marker)), mm(shape.place(*marker))]).collect()
        };
        let centrelines: Vec<Vec<[f64; 3]>> = cases.iter().map(|case| centreline(case.shape, PLACES)).collect();
        let rods: Vec<Vec<[[f64; 3]; 2]>> = cases.iter().map(rods).collect();
        let measured = cases.iter().flat_map(|case| case.markers).map(|(_, place)| mm(*place));
        let drawn = centrelines.iter().flatten().copied().chain(rods.iter().flatten().map(|rod| rod[1]));
        let views = ThreeViews::around(drawn.chain(measured), PAD, page);
        Self { placed: views.placed(top), centrelines, rods }
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.placed.bottom
    }

    pub(crate) fn draw(&self, scene: &mut Scene, cases: &[SpatialCase<'_>]) {
        self.placed.draw(scene);
        for (axes, view) in &self.placed.views {
            for ((case, centreline), rods) in cases.iter().zip(&self.centrelines).zip(&self.rods) {
                let on_page = |places: &[[f64; 3]]| {
                    let flat: Vec<[f64; 2]> = places.iter().map(|place| view.place(place)).collect();
                    axes.all(&flat)
                };
                scene.line(&on_page(centreline), Stroke::solid(case.color, 1.2));
                for rod in rods {
                    scene.line(&on_page(rod), Stroke::solid(case.color.with_opacity(0.6), 0.6));
                }
                for (_, place) in case.markers {
                    let place = view.place(&place.map(|v| 1e3 * v));
                    Mark::Cross(case.color.towards(INK, 0.4)).draw(scene, axes.at(place));
                }
            }
        }
    }
}
