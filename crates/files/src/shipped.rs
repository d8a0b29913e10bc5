//! The arms that ship with the program.

struct Shipped {
    name: &'static str,
    description: &'static str,
    text: &'static str,
}

const ARMS: [Shipped; 5] = [
    Shipped {
        name: "paper",
        description: "the source's arm: two cables, the left one pulled, 0.5 m/s; parameters found by trial",
        text: include_str!("../arms/paper.toml"),
    },
    Shipped {
        name: "paper-statements",
        description: "the same with parameters that meet every statement of the source at the highest tension",
        text: include_str!("../arms/paper-statements.toml"),
    },
    Shipped {
        name: "silicone",
        description: "silicone cone of 245 mm, two cables (Renda et al. 2018)",
        text: include_str!("../arms/silicone.toml"),
    },
    Shipped {
        name: "multi-bending",
        description: "silicone cone of 418 mm, six cables that end at three places (Renda et al.)",
        text: include_str!("../arms/multi-bending.toml"),
    },
    Shipped {
        name: "octopus",
        description: "octopus arm of 200 mm, 10 kPa, two cables (Chang et al., drag of Yekutieli et al. 2005)",
        text: include_str!("../arms/octopus.toml"),
    },
];

/// Arms in space.
const SPATIAL: [Shipped; 3] = [
    Shipped {
        name: "octopus-spatial",
        description: "the octopus arm in space, four cables at 90 degrees",
        text: include_str!("../arms/octopus-spatial.toml"),
    },
    Shipped {
        name: "silicone-spatial",
        description: "the silicone cone in space, three cables at 120 degrees",
        text: include_str!("../arms/silicone-spatial.toml"),
    },
    Shipped {
        name: "tentacle",
        description: "a built arm of 360 mm in air, two tendons, with 22 measured poses (SoRoMoX)",
        text: include_str!("../arms/tentacle.toml"),
    },
];

/// The names of those in space.
pub fn spatial_names() -> impl Iterator<Item = &'static str> {
    SPATIAL.iter().map(|arm| arm.name)
}

/// The names of those in the plane.
pub fn names() -> impl Iterator<Item = &'static str> {
    ARMS.iter().map(|arm| arm.name)
}

/// The names of all, those in space last.
pub fn all_names() -> impl Iterator<Item = &'static str> {
    names().chain(spatial_names())
}

/// The text of an arm's file.
///
/// ```
/// use hydrostat_files::{ArmFile, shipped};
///
/// let file = ArmFile::parse(shipped::get("paper").unwrap(), "paper").unwrap();
/// assert_eq!(file.arm().unwrap().length, 0.2);
/// ```
pub fn get(name: &str) -> Option<&'static str> {
    ARMS.iter().chain(&SPATIAL).find(|arm| arm.name == name).map(|arm| arm.text)
}

/// What an arm is, in a line.
pub fn description(name: &str) -> Option<&'static str> {
    ARMS.iter().chain(&SPATIAL).find(|arm| arm.name == name).map(|arm| arm.description)
}
