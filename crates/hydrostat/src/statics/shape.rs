//! The plain data of a configuration: stations along the arm, tip, cables, reactions.

use crate::statics::dimensions::Units;

/// State at one place of the arm.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Station {
    /// Reference arc length, m.
    pub s: f64,
    /// Centreline, m.
    pub x: f64,
    /// Centreline, m.
    pub y: f64,
    /// Section rotation, rad, continuous along the arm.
    pub theta: f64,
    /// Stretch.
    pub nu: f64,
    /// Shear strain.
    pub eta: f64,
    /// Bending strain, 1/m.
    pub mu: f64,
    /// Section stretch.
    pub beta: f64,
    /// Slope of the section stretch, 1/m.
    pub beta_slope: f64,
    /// Angle from section normal to centreline tangent, rad.
    pub alpha: f64,
    /// Contact force along a, N.
    pub n_a: f64,
    /// Contact force along b, N.
    pub n_b: f64,
    /// Contact moment, N m.
    pub m: f64,
}

/// Many [`Station`]s, one array a field (units as there).
#[derive(Debug, Clone, PartialEq, Default)]
#[allow(missing_docs, reason = "the fields are those of `Station`")]
pub struct Stations {
    pub s: Vec<f64>,
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub theta: Vec<f64>,
    pub nu: Vec<f64>,
    pub eta: Vec<f64>,
    pub mu: Vec<f64>,
    pub beta: Vec<f64>,
    pub alpha: Vec<f64>,
    pub n_a: Vec<f64>,
    pub n_b: Vec<f64>,
    pub m: Vec<f64>,
}

impl Stations {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.s.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.s.is_empty()
    }

    pub(crate) fn reserve(&mut self, count: usize) {
        for field in [
            &mut self.s,
            &mut self.x,
            &mut self.y,
            &mut self.theta,
            &mut self.nu,
            &mut self.eta,
            &mut self.mu,
            &mut self.beta,
            &mut self.alpha,
            &mut self.n_a,
            &mut self.n_b,
            &mut self.m,
        ] {
            field.reserve_exact(count);
        }
    }

    pub(crate) fn push(&mut self, station: &Station) {
        self.s.push(station.s);
        self.x.push(station.x);
        self.y.push(station.y);
        self.theta.push(station.theta);
        self.nu.push(station.nu);
        self.eta.push(station.eta);
        self.mu.push(station.mu);
        self.beta.push(station.beta);
        self.alpha.push(station.alpha);
        self.n_a.push(station.n_a);
        self.n_b.push(station.n_b);
        self.m.push(station.m);
    }
}

/// The tip.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tip {
    /// m.
    pub x: f64,
    /// m.
    pub y: f64,
    /// rad.
    pub theta: f64,
    /// rad.
    pub alpha: f64,
}

/// Where a tip is and how it is turned: [`Tip`], or [`SpatialTip`](crate::SpatialTip).
pub trait Pose: Copy {
    /// How far another one is, m.
    fn distance_to(&self, other: &Self) -> f64;
    /// By how much another one is turned, rad, never negative.
    fn turn_to(&self, other: &Self) -> f64;
}

impl Pose for Tip {
    fn distance_to(&self, other: &Self) -> f64 {
        (other.x - self.x).hypot(other.y - self.y)
    }

    fn turn_to(&self, other: &Self) -> f64 {
        (other.theta - self.theta).abs()
    }
}

/// A force (N, in space) and a moment (N m).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wrench {
    /// Force along e1, e2, N.
    pub force: [f64; 2],
    /// Moment, N m, counterclockwise.
    pub moment: f64,
}

impl Wrench {
    /// What holds the base against the unknowns of its node.
    pub(crate) fn of_base([_, n1, n2, m]: [f64; 4], units: &Units) -> Self {
        // Taken from zero, what is nothing is 0 and not -0.
        let against = |value: f64| 0.0 - value;
        let force = units.force;
        Self { force: [against(n1 * force), against(n2 * force)], moment: against(m * force * units.length) }
    }
}

/// How far the surface is from folding over itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FoldMargin {
    /// min over s of (nu - beta R |mu|) / nu; at or below zero the surface folds.
    pub value: f64,
    /// Where, m.
    pub s: f64,
}

/// A cable in a configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct CableState {
    /// Its name.
    pub name: String,
    /// Tension, N.
    pub tension: f64,
    /// Length of its path from base to anchor, m.
    pub length: f64,
    /// Length at the reference strains less present length, m: positive when reeled in.
    pub stroke: f64,
    /// What was commanded, where the length was.
    pub command: Option<Command>,
}

/// The length that was commanded of a cable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Command {
    /// Stroke, m: of the length at the reference strains, what is reeled in.
    pub stroke: f64,
    /// The unstretched length that this leaves between base and anchor, m. The path of a slack cable,
    /// [`CableState::length`], is shorter.
    pub length: f64,
    /// Whether the cable hangs slack: pulling it that far would take a push.
    pub slack: bool,
}

/// What a solve took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Elements of the final mesh.
    pub elements: usize,
    /// Collocation stages an element.
    pub stages: usize,
    /// Newton rounds, all meshes together.
    pub newton_rounds: usize,
    /// Meshes used.
    pub meshes: usize,
    /// Load steps of the ramp; zero when the direct solve was enough.
    pub load_steps: usize,
    /// Section laws and loads evaluated (one a station a round).
    pub evaluations: usize,
}
