//! One equilibrium of several: what documents and tables say of it.

use hydrostat::{Configuration, SpatialConfiguration, SpatialTip, Stability, Tip};
use serde::Serialize;

use crate::results::{CableOut, TipOut, cell};
use crate::spatial_results::TipOut as SpatialTipOut;

/// Whether an equilibrium is stable, and in how many directions it is not.
#[derive(Debug, Clone, Copy, Serialize)]
struct StabilityOut {
    state: Option<&'static str>,
    directions: Option<usize>,
}

impl From<Option<Stability>> for StabilityOut {
    fn from(stability: Option<Stability>) -> Self {
        Self { state: stability.map(Stability::name), directions: stability.and_then(Stability::directions) }
    }
}

/// The tip in the plane or in space.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub(crate) enum AnyTip {
    Plane(TipOut),
    Space(SpatialTipOut),
}

impl From<Tip> for AnyTip {
    fn from(tip: Tip) -> Self {
        Self::Plane(tip.into())
    }
}

impl From<SpatialTip> for AnyTip {
    fn from(tip: SpatialTip) -> Self {
        Self::Space(tip.into())
    }
}

/// An equilibrium without its stations.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct State<'a> {
    tip: AnyTip,
    cables: Vec<CableOut<'a>>,
    stability: StabilityOut,
    error_estimate: f64,
}

impl<'a> State<'a> {
    pub(crate) fn new(configuration: &'a Configuration, stability: Option<Stability>) -> Self {
        Self {
            tip: AnyTip::Plane(TipOut::new(configuration)),
            cables: CableOut::all(configuration),
            stability: stability.into(),
            error_estimate: configuration.error_estimate,
        }
    }

    pub(crate) fn in_space(configuration: &'a SpatialConfiguration, stability: Option<Stability>) -> Self {
        Self {
            tip: AnyTip::Space(configuration.tip().into()),
            cables: CableOut::of(&configuration.cables),
            stability: stability.into(),
            error_estimate: configuration.error_estimate,
        }
    }

    /// The heads of [`State::cells`] for an arm with so many cables; `more` come before the last one.
    pub(crate) fn columns(cables: usize, more: &[&str]) -> Vec<String> {
        Self::columns_after(&["tip_x_m", "tip_y_m", "tip_theta_rad", "tip_alpha_rad"], cables, more)
    }

    /// The same of an arm in space.
    pub(crate) fn columns_in_space(cables: usize, more: &[&str]) -> Vec<String> {
        Self::columns_after(&SpatialTipOut::COLUMNS, cables, more)
    }

    fn columns_after(tip: &[&str], cables: usize, more: &[&str]) -> Vec<String> {
        let mut out: Vec<String> = tip.iter().map(|name| (*name).to_owned()).collect();
        out.extend((0..cables).flat_map(|c| [format!("stroke_{c}_m"), format!("tension_{c}_N")]));
        out.extend(["stability", "unstable_directions"].map(str::to_owned));
        out.extend(more.iter().chain(&["error_estimate_m"]).map(|name| (*name).to_owned()));
        out
    }

    pub(crate) fn cells(&self, more: &[&str]) -> Vec<String> {
        let mut out: Vec<String> = match &self.tip {
            AnyTip::Plane(TipOut { x, y, theta, alpha }) => [x, y, theta, alpha].map(|v| cell(*v)).into(),
            AnyTip::Space(tip) => tip.numbers().into_iter().map(cell).collect(),
        };
        out.extend(self.cables.iter().flat_map(|c| [cell(c.stroke), cell(c.tension)]));
        out.push(self.stability.state.unwrap_or_default().to_owned());
        out.push(self.stability.directions.map_or_else(String::new, |count| count.to_string()));
        out.extend(more.iter().map(|text| (*text).to_owned()));
        out.push(cell(self.error_estimate));
        out
    }
}
