//! The options of the model: where the source can be read in more than one way.
//!
//! Each default is the reading that is physically consistent and smooth. Each alternative changes
//! one thing, so that a reader of the source can see what it does.

/// How a section swells: the section stretch `beta` as a function of the stretch `nu`, (15) and (16).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Volume {
    /// beta = 1/nu: (15) and (16) read literally, planar determinant, mean over the section.
    #[default]
    Planar,
    /// beta = nu^(-1/2): a round section that keeps its true volume, nu beta^2 = 1.
    Circular,
    /// beta = 1: the classical rod, and every textbook check.
    None,
}

impl Volume {
    /// All of them, in the order of [`Volume::NAMES`].
    pub const ALL: [Self; 3] = [Self::Planar, Self::Circular, Self::None];
    /// Their words in arm files.
    pub const NAMES: [&'static str; 3] = ["planar", "circular", "none"];

    /// Its word in arm files.
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// The surface whose tangent and normal direct the loads of the stream, (7)-(10).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FlowSurface {
    /// The centreline's tangent and normal.
    #[default]
    Centreline,
    /// Those of the windward lateral surface, "tangent vector to the arm surface". The windward
    /// side can change, and there the load jumps.
    Lateral,
}

impl FlowSurface {
    /// All of them, in the order of [`FlowSurface::NAMES`].
    pub const ALL: [Self; 2] = [Self::Centreline, Self::Lateral];
    /// Their words in arm files.
    pub const NAMES: [&'static str; 2] = ["centreline", "lateral"];

    /// Its word in arm files.
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// The entering speed of (8), which has no subscript in the source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum EnteringSpeed {
    /// V_in = V_tin: f_t = S (V_t^2 + 2 V_t V_n).
    #[default]
    Tangential,
    /// V_in^2 = V_tin^2 + V_nin^2: f_t = S (V_t + V_n)^2. Leaves a force along the arm at normal
    /// incidence, whose sign jumps there.
    Resultant,
}

impl EnteringSpeed {
    /// All of them, in the order of [`EnteringSpeed::NAMES`].
    pub const ALL: [Self; 2] = [Self::Tangential, Self::Resultant];
    /// Their words in arm files.
    pub const NAMES: [&'static str; 2] = ["tangential", "resultant"];

    /// Its word in arm files.
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// Which mean of the layer profile (7) enters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LayerMean {
    /// The mean of the speed: V_tin = 2/3 v_t_inf.
    #[default]
    Speed,
    /// The root of the mean square: V_tin = sqrt(8/15) v_t_inf.
    Momentum,
}

impl LayerMean {
    /// All of them, in the order of [`LayerMean::NAMES`].
    pub const ALL: [Self; 2] = [Self::Speed, Self::Momentum];
    /// Their words in arm files.
    pub const NAMES: [&'static str; 2] = ["speed", "momentum"];

    /// Its word in arm files.
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// V_tin / v_t_inf.
    pub fn factor(self) -> f64 {
        match self {
            Self::Speed => 2.0 / 3.0,
            Self::Momentum => (8.0_f64 / 15.0).sqrt(),
        }
    }
}

/// The length on which the stream acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum WettedLength {
    /// ds is the undeformed length.
    #[default]
    Reference,
    /// S times |r'|: it is the deformed arm that is wet.
    Deformed,
}

impl WettedLength {
    /// All of them, in the order of [`WettedLength::NAMES`].
    pub const ALL: [Self; 2] = [Self::Reference, Self::Deformed];
    /// Their words in arm files.
    pub const NAMES: [&'static str; 2] = ["reference", "deformed"];

    /// Its word in arm files.
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// The water that a section displaces, in proportion to that of the unloaded arm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Displaced {
    /// The volume of the arm, which (15) keeps: that of the unloaded arm under [`Volume::Planar`] and
    /// [`Volume::Circular`], times nu under [`Volume::None`], whose rigid sections keep no volume.
    #[default]
    Volume,
    /// What the round section below (12) sweeps, times nu beta^2. Under [`Volume::Planar`] that grows with
    /// beta, so that an arm is lifted as its cables pull.
    Section,
}

impl Displaced {
    /// All of them, in the order of [`Displaced::NAMES`].
    pub const ALL: [Self; 2] = [Self::Volume, Self::Section];
    /// Their words in arm files.
    pub const NAMES: [&'static str; 2] = ["volume", "section"];

    /// Its word in arm files.
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// Which part of weight and buoyancy acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Hydrostatics {
    /// The whole of it.
    #[default]
    Archimedes,
    /// Its part along the normal of the [`FlowSurface`], as (9) and (10) act along u_n only: that of the centreline, or
    /// of the windward lateral surface. Where both sides tie, as they do without a stream, the mean of both.
    NormalOnly,
}

impl Hydrostatics {
    /// All of them, in the order of [`Hydrostatics::NAMES`].
    pub const ALL: [Self; 2] = [Self::Archimedes, Self::NormalOnly];
    /// Their words in arm files.
    pub const NAMES: [&'static str; 2] = ["archimedes", "normal-only"];

    /// Its word in arm files.
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// The conditions at the base.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Support {
    /// Place and angle of the base section are given; the tip carries the tip loads.
    #[default]
    Clamped,
    /// nu = beta = 1, eta = mu = 0 at the base, integrated to the tip, whose balance is then left
    /// unmet: the source's closing line read as conditions on the solution.
    UnstrainedBase,
}

impl Support {
    /// All of them, in the order of [`Support::NAMES`].
    pub const ALL: [Self; 2] = [Self::Clamped, Self::UnstrainedBase];
    /// Their words in arm files.
    pub const NAMES: [&'static str; 2] = ["clamped", "unstrained-base"];

    /// Its word in arm files.
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// All options together. `ModelOptions::default()` has the consistent readings of the source,
/// [`ModelOptions::LITERAL`] those closest to its words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct ModelOptions {
    /// Section stretch.
    pub volume: Volume,
    /// Surface that directs the flow loads.
    pub flow_surface: FlowSurface,
    /// Entering speed.
    pub entering_speed: EnteringSpeed,
    /// Mean over the layer.
    pub layer_mean: LayerMean,
    /// Wetted length.
    pub wetted_length: WettedLength,
    /// Displaced water.
    pub displaced: Displaced,
    /// Hydrostatic part.
    pub hydrostatics: Hydrostatics,
    /// Support.
    pub support: Support,
}

impl ModelOptions {
    /// `closure = "literal"`: lateral, resultant, speed, reference, normal-only, planar, clamped. The water displaced
    /// is that of the default.
    ///
    /// These are the surface, the speed and the directions that the source's sentences name. The signs of (8) are not:
    /// as printed, minus along u_t, the stream would push the arm against itself. Here as in every reading they are
    /// those with which water resists.
    pub const LITERAL: Self = Self {
        volume: Volume::Planar,
        flow_surface: FlowSurface::Lateral,
        entering_speed: EnteringSpeed::Resultant,
        layer_mean: LayerMean::Speed,
        wetted_length: WettedLength::Reference,
        displaced: Displaced::Volume,
        hydrostatics: Hydrostatics::NormalOnly,
        support: Support::Clamped,
    };

    /// Whether the load of the stream can jump with the motion under these readings.
    pub fn load_can_jump(&self) -> bool {
        self.flow_surface == FlowSurface::Lateral || self.entering_speed == EnteringSpeed::Resultant
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_in_the_order_of_the_options() {
        assert!(Volume::ALL.iter().enumerate().all(|(k, one)| one.name() == Volume::NAMES[k]));
        assert!(FlowSurface::ALL.iter().enumerate().all(|(k, one)| one.name() == FlowSurface::NAMES[k]));
        assert!(EnteringSpeed::ALL.iter().enumerate().all(|(k, one)| one.name() == EnteringSpeed::NAMES[k]));
        assert!(LayerMean::ALL.iter().enumerate().all(|(k, one)| one.name() == LayerMean::NAMES[k]));
        assert!(WettedLength::ALL.iter().enumerate().all(|(k, one)| one.name() == WettedLength::NAMES[k]));
        assert!(Displaced::ALL.iter().enumerate().all(|(k, one)| one.name() == Displaced::NAMES[k]));
        assert!(Hydrostatics::ALL.iter().enumerate().all(|(k, one)| one.name() == Hydrostatics::NAMES[k]));
        assert!(Support::ALL.iter().enumerate().all(|(k, one)| one.name() == Support::NAMES[k]));
    }
}
