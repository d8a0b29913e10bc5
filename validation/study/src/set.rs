//! What the source leaves open, and the arm that it makes.

use hydrostat::{
    Arm, Cable, EnteringSpeed, FlowSurface, LayerMean, Material, ModelOptions, Profile, Support, Volume, WettedLength,
};

/// Coordinates of a set in the unit cube.
pub const COORDINATES: usize = 13;
/// The first of those that choose a reading; those before it are continuous.
pub const READINGS: usize = 8;

/// The arm's length, m: without weight the equations know ratios of lengths only.
pub const LENGTH: f64 = 0.2;

/// A range that is sampled, evenly or by equal ratios.
#[derive(Debug, Clone, Copy)]
struct Range {
    from: f64,
    to: f64,
    ratios: bool,
}

impl Range {
    const fn even(from: f64, to: f64) -> Self {
        Self { from, to, ratios: false }
    }

    const fn ratios(from: f64, to: f64) -> Self {
        Self { from, to, ratios: true }
    }

    fn at(self, share: f64) -> f64 {
        if self.ratios {
            self.from * (self.to / self.from).powf(share)
        } else {
            self.from + share * (self.to - self.from)
        }
    }
}

const RANGES: [Range; READINGS] = [
    Range::ratios(0.02, 0.15),
    Range::ratios(0.04, 1.0),
    Range::even(0.1, 0.98),
    Range::ratios(0.01, 0.95),
    Range::ratios(2e3, 5e6),
    Range::ratios(0.02, 1.0),
    Range::ratios(0.1, 100.0),
    Range::even(0.0, 2.0),
];

/// One choice of everything that the source leaves open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Set {
    /// Where in the unit cube it was drawn.
    pub place: [f64; COORDINATES],
    /// Radius at the base over the length.
    pub slenderness: f64,
    /// Radius at the tip over that at the base.
    pub taper: f64,
    /// Offset of the cable at the base over the radius there.
    pub base_offset: f64,
    /// Offset of the cable at the tip over the radius there.
    pub tip_offset: f64,
    /// C1, Pa.
    pub c1: f64,
    /// C2 over C1.
    pub shear: f64,
    /// C3 at the base over that of a solid homogeneous section, C1 R^2 / 4.
    pub bending: f64,
    /// C3 at the tip over that at the base is the taper to this power: 2 for a homogeneous arm.
    pub bending_taper: f64,
    /// How the source is read.
    pub model: ModelOptions,
}

impl Set {
    /// The set at a place of the unit cube.
    pub fn at(place: [f64; COORDINATES]) -> Self {
        let value = |k: usize| RANGES[k].at(place[k]);
        let second = |k: usize| place[READINGS + k] >= 0.5;
        let model = ModelOptions {
            volume: if second(0) { Volume::Circular } else { Volume::Planar },
            flow_surface: if second(1) { FlowSurface::Lateral } else { FlowSurface::Centreline },
            entering_speed: if second(2) { EnteringSpeed::Resultant } else { EnteringSpeed::Tangential },
            layer_mean: if second(3) { LayerMean::Momentum } else { LayerMean::Speed },
            wetted_length: if second(4) { WettedLength::Deformed } else { WettedLength::Reference },
            ..ModelOptions::default()
        };
        Self {
            place,
            slenderness: value(0),
            taper: value(1),
            base_offset: value(2),
            tip_offset: value(3),
            c1: value(4),
            shear: value(5),
            bending: value(6),
            bending_taper: value(7),
            model,
        }
    }

    /// Radius at base and tip, m.
    pub fn radii(&self) -> [f64; 2] {
        let base = self.slenderness * LENGTH;
        [base, base * self.taper]
    }

    /// Offset of the pulled cable at base and tip, m.
    pub fn offsets(&self) -> [f64; 2] {
        let [base, tip] = self.radii();
        [self.base_offset * base, self.tip_offset * tip]
    }

    /// C3 at base and tip, N.
    pub fn bending_stiffness(&self) -> [f64; 2] {
        let [base, _] = self.radii();
        let at_base = self.bending * self.c1 * base * base / 4.0;
        [at_base, at_base * self.taper.powf(self.bending_taper)]
    }

    /// The arm: its left cable pulled with `tension` (N), its right one slack, in a stream of `speed` (m/s) along it.
    pub fn arm(&self, tension: f64, speed: f64) -> Arm {
        let linear = |[base, tip]: [f64; 2]| Profile::linear(base, tip);
        let [base, tip] = self.radii();
        let mut arm = Arm::cone(LENGTH, base, tip, self.c1, 0.5);
        let [c2, c3] = [Profile::from(self.shear * self.c1), linear(self.bending_stiffness())];
        arm.material = Material::Coefficients { c1: self.c1.into(), c2, c3 };
        arm.cables = vec![
            Cable::new("left", linear(self.offsets())).pulled(tension),
            Cable::new("right", linear(self.offsets().map(|y| -y))),
        ];
        arm.flow.speed = speed;
        arm.model = self.model;
        arm
    }

    /// The same with the base read word by word: unstrained.
    pub fn with_unstrained_base(mut self) -> Self {
        self.model.support = Support::UnstrainedBase;
        self
    }
}
