//! The places at which something about an arm changes its law. Meshes have a node at each, so that their number is
//! bounded.

use super::{Arm, ArmError, Material, Space};
use crate::rod::profile::Profile;

/// Cables that make a station about twice as dear as one without.
const AS_DEAR: usize = 8;

/// The most places of an arm with few cables: a mesh that has them all takes some 200 MB, and a direct solve on it
/// seconds.
const MOST: usize = 10_000;

impl Arm {
    /// The places inside (0, L), sorted, where a profile's curvature jumps or a cable ends, m.
    pub fn breaks(&self) -> Vec<f64> {
        let mut at: Vec<f64> = Vec::new();
        self.each_profile(|_, profile| at.extend_from_slice(profile.knots()));
        at.extend(self.cables.iter().map(|c| c.end * self.length));
        let slack = 1e-9 * self.length;
        at.retain(|s| *s > slack && *s < self.length - slack);
        at.sort_by(f64::total_cmp);
        at.dedup_by(|b, a| *b - *a <= slack);
        at
    }

    /// The key of a profile that is a table, if there is one.
    pub(crate) fn first_table(&self) -> Option<String> {
        let mut found = None;
        self.each_profile(|key, profile| {
            if found.is_none() && matches!(profile, Profile::Table(_)) {
                found = Some(key());
            }
        });
        found
    }

    /// What a station of this arm costs, in time and memory, over one of an arm with few cables.
    pub(crate) fn cost_factor(&self) -> usize {
        1 + self.cables.len() / AS_DEAR
    }

    /// Refuses more places than meshes have room for.
    pub(super) fn check_breaks(&self) -> Result<(), ArmError> {
        let most = MOST / self.cost_factor();
        let mut knots = self.cables.len();
        let mut longest = ("cable".to_owned(), 0);
        self.each_profile(|key, profile| {
            let own = profile.knots().len();
            knots += own;
            if own > longest.1 {
                longest = (key(), own);
            }
        });
        if knots <= most {
            return Ok(());
        }
        let found = self.breaks().len();
        if found <= most { Ok(()) } else { Err(ArmError::TooManyBreaks { key: longest.0, found, most }) }
    }

    /// Calls `visit` with every profile and what gives its key.
    fn each_profile(&self, mut visit: impl FnMut(&dyn Fn() -> String, &Profile)) {
        let mut named = |key: &'static str, profile| visit(&|| key.to_owned(), profile);
        named("arm.radius", &self.radius);
        named("arm.inner_radius", &self.inner_radius);
        if let Material::Coefficients { c1, c2, c3 } = &self.material {
            named("material.c1", c1);
            named("material.c2", c2);
            named("material.c3", c3);
        }
        named("reference.nu", &self.reference.nu);
        named("reference.eta", &self.reference.eta);
        named("reference.mu", &self.reference.mu);
        named("distributed.force[0]", &self.distributed.force[0]);
        named("distributed.force[1]", &self.distributed.force[1]);
        named("distributed.couple", &self.distributed.couple);
        for (key, profile) in self.space.iter().flat_map(Space::profiles) {
            named(key, profile);
        }
        for (i, cable) in self.cables.iter().enumerate() {
            visit(&|| format!("cable[{i}].offset"), &cable.offset);
            visit(&|| format!("cable[{i}].angle"), &cable.angle);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Cable;

    fn table(points: usize) -> Profile {
        let points: Vec<[f64; 2]> = (0..points).map(|i| [i as f64 / (points - 1) as f64, 0.01]).collect();
        Profile::table(&points).unwrap()
    }

    #[test]
    fn more_places_than_meshes_have_room_for_are_refused_with_the_longest_table() {
        let mut arm = Arm::cone(1.0, 0.01, 0.01, 1e5, 0.5);
        arm.reference.mu = table(100);
        arm.radius = table(MOST + 2);
        let refused = arm.check().unwrap_err();
        assert!(
            refused.key() == "arm.radius" && refused.to_string().ends_with("an arm like this may have 10000"),
            "{refused}"
        );
        // Tables that have their points at the same places count once.
        arm.reference.mu = table(MOST + 2);
        arm.check().unwrap();
        arm.cables = (0..8).map(|_| Cable::new("one", 0.001)).collect();
        assert_eq!(
            arm.check().unwrap_err(),
            ArmError::TooManyBreaks { key: "arm.radius".to_owned(), found: MOST, most: MOST / 2 }
        );
    }
}
