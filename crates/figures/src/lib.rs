//! Drawings of soft arms, as SVG, PDF and PNG from one description.
//!
//! A [`Scene`] is what a figure shows: lines, areas and text on a page measured in points. Its
//! [`svg`](Scene::svg), [`pdf`](Scene::pdf) and [`png`](Scene::png) cannot disagree, because text becomes glyph
//! outlines before any of them is made; that also needs no font on the machine that shows the figure.
//! [`svg_with_text`](Scene::svg_with_text) keeps text as text. A [`Page`] says how wide a figure is and what its title is.
//!
//! [`arm_figure`] draws one configuration to scale, [`spatial_arm_figure`] one in space, [`path_shapes_figure`] and [`equilibria_figure`]
//! several, [`boundary_figure`] the places that a tip reaches; [`path_figure`] and [`over_figure`] draw a [`Quantity`]
//! over a parameter; [`map_figure`], [`workspace_figure`], [`spatial_workspace_figure`] and [`curve_figure`] draw a sweep, [`fit_figure`] a fit beside
//! its data, [`loading_figure`] a load that rises and falls, [`strobe_figure`], [`spatial_strobe_figure`] and [`motion_figure`] a motion, [`mode_shapes_figure`] small ones, and
//! [`lines_figure`] whatever numbers are compared. [`source`] solves what the source's Fig. 1
//! shows, judges what its text says about it, and draws the three parts.

mod arm_figure;
mod axes;
mod boundary;
mod chart;
mod fit;
mod fit_in_space;
mod font;
mod geometry;
mod hull;
mod legend;
mod lines;
mod loading;
mod mode_shapes;
mod motion;
mod numbers;
mod outline;
mod page;
mod palette;
mod pdf;
mod perspective;
mod picked;
mod placement;
mod png;
mod quantity;
mod region;
mod root_locus;
mod scene;
mod shaded;
mod shapes;
mod solid;
pub mod source;
mod spatial_figure;
mod spatial_shapes;
mod surroundings;
mod svg;
mod sweep;
mod three_views;
mod tip_labels;
mod view;

pub use arm_figure::{arm_figure, last_good_note, reach_figure};
pub use axes::Scale;
pub use boundary::boundary_figure;
pub use chart::{Abscissa, over_figure, path_figure, spatial_over_figure, spatial_path_figure};
pub use fit::fit_figure;
pub use lines::{Measure, Panel, lines_figure};
pub use loading::{LoadingPoint, loading_figure};
pub use mode_shapes::mode_shapes_figure;
pub use motion::{MotionFrame, motion_figure, spatial_strobe_figure, strobe_figure};
pub use page::Page;
pub use palette::{Palette, palette};
pub use png::PngError;
pub use quantity::{Posed, Quantity, UnknownQuantity};
pub use root_locus::root_locus_figure;
pub use scene::Scene;
pub use shaded::{Coloured, ColouredColumn};
pub use shapes::{equilibria_figure, path_shapes_figure};
pub use spatial_figure::spatial_arm_figure;
pub use spatial_shapes::{spatial_equilibria_figure, spatial_path_shapes_figure};
pub use sweep::{KeyValues, curve_figure, map_figure, spatial_workspace_figure, value_text, workspace_figure};
