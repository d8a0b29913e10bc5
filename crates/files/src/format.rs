//! The arm file's format as data. Parser, `--set`, schema and messages all read this one table.

use hydrostat::{Displaced, EnteringSpeed, FlowSurface, Hydrostatics, LayerMean, Support, Volume, WettedLength};

use crate::quantity::Dimension;

/// What may stand at a key.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Kind {
    /// Any string.
    Text,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// True or false.
    Flag,
    /// One number.
    Quantity(Dimension),
    /// Two numbers, `[_, _]`, or three in space.
    Pair(Dimension),
    /// One number, or three in space, `[_, _, _]`.
    Axial(Dimension),
    /// An angle, or three numbers in space, `[_, _, _]`.
    Heading,
    /// Three numbers, `[_, _, _]`, of any size.
    Direction,
    /// A quantity along the arm: a number, `{ base, tip }`, `[[s, value], ...]` or `{ points, join }`.
    Profile(Dimension),
    /// Two profiles, `[_, _]`, or three in space.
    ProfilePair(Dimension),
    /// One profile, or three in space, `[_, _, _]`.
    AxialProfile(Dimension),
    /// A profile, or fractions of the radius.
    Offset(Dimension),
    /// A fraction of the length, or a length.
    Part,
    /// A table.
    Table(&'static [Key]),
    /// An array of tables.
    Tables(&'static [Key]),
}

/// A key of a table.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) required: bool,
    /// As it would be written in a file. `None`: required, or there is none.
    pub(crate) default: Option<&'static str>,
    pub(crate) doc: &'static str,
}

/// Most cables that an arm can have. Keeps the time to check a file bounded.
pub(crate) const MAX_CABLES: usize = 100;
/// The longest text, in characters: names are drawn.
pub(crate) const MAX_NAME: usize = 200;
/// Most points that a profile's table can have. Keeps the time to check a file bounded.
pub(crate) const MAX_POINTS: usize = 10_000;
/// Largest arm file, in bytes.
pub(crate) const MAX_BYTES: u64 = 4 << 20;

const fn optional(name: &'static str, kind: Kind, doc: &'static str) -> Key {
    Key { name, kind, required: false, default: None, doc }
}

const fn required(name: &'static str, kind: Kind, doc: &'static str) -> Key {
    Key { required: true, ..optional(name, kind, doc) }
}

const fn default(name: &'static str, kind: Kind, default: &'static str, doc: &'static str) -> Key {
    Key { default: Some(default), ..optional(name, kind, doc) }
}

use Dimension as D;
use Kind::{
    Axial, AxialProfile, Choice, Direction, Flag, Heading, Offset, Pair, Part, Profile, ProfilePair, Quantity, Table,
    Tables, Text,
};

pub(crate) const FILE: &[Key] = &[
    optional("name", Text, "Name of the arm. Default: the name of the file."),
    required("arm", Table(ARM), "Geometry and position."),
    required("material", Table(MATERIAL), "Stiffness: young, poisson and shear_factor, or c1, c2 and c3."),
    optional("reference", Table(REFERENCE), "Strains of the unloaded arm."),
    optional("cable", Tables(CABLE), "Cables, one table each."),
    optional("flow", Table(FLOW), "Stream. Default: still water of 1000 kg/m3."),
    optional("gravity", Table(GRAVITY), "Gravity in the plane. Default: none."),
    optional("tip", Table(TIP), "Loads on the tip."),
    optional("distributed", Table(DISTRIBUTED), "Dead loads along the arm, per metre of undeformed length."),
    optional("dynamics", Table(DYNAMICS), "Settings of motion; equilibria do not depend on them."),
    optional("model", Table(MODEL), "Options of the model."),
];

const ARM: &[Key] = &[
    default("space", Choice(&SPACES), "\"planar\"", "Whether the arm stays in the plane e1-e2."),
    required("length", Quantity(D::Length), "Undeformed length L."),
    required("radius", Profile(D::Length), "Undeformed radius R(s)."),
    default("inner_radius", Profile(D::Length), "0", "Radius R_in(s) of the cavity; 0 is solid."),
    default("cavity", Choice(&["flooded", "sealed"]), "\"flooded\"", "Content of a hollow arm: water, or nothing."),
    default("density", Quantity(D::Density), "1000", "Density of the wall."),
    default("base", Table(BASE), "{ x = 0, y = 0, angle = 0 }", "Position and angle of the section at s = 0."),
];

const BASE: &[Key] = &[
    default("x", Quantity(D::Length), "0", "Along e1."),
    default("y", Quantity(D::Length), "0", "Along e2."),
    default("angle", Quantity(D::Angle), "0", "From e1. In space: of a in the plane e1-e2; not with direction."),
    optional("z", Quantity(D::Length), "Along e3, in space. Default: 0."),
    optional("direction", Direction, "Direction of a, normal to the section, in space."),
    optional(
        "section",
        Direction,
        "Direction that b is projected from, in space. Default: e3 x a, or e2 where a is along e3.",
    ),
];

/// The words of `arm.space`.
pub(crate) const SPACES: [&str; 2] = ["planar", "spatial"];

/// Required unless [`COEFFICIENTS`] are given.
pub(crate) const HOMOGENEOUS: [&str; 3] = ["young", "poisson", "shear_factor"];
/// Required together, instead of [`HOMOGENEOUS`].
pub(crate) const COEFFICIENTS: [&str; 3] = ["c1", "c2", "c3"];

const MATERIAL: &[Key] = &[
    optional("young", Quantity(D::Pressure), "Young's modulus E."),
    default("poisson", Quantity(D::Number), "0.5", "Poisson's ratio."),
    default("shear_factor", Quantity(D::Number), "1.0", "Timoshenko's shear correction."),
    optional("c1", Profile(D::Pressure), "Stiffness against stretch."),
    optional("c2", Profile(D::Pressure), "Stiffness against shear."),
    optional("c3", Profile(D::Force), "Stiffness against bending."),
    optional(
        "c4",
        Profile(D::Force),
        "Stiffness against twist, in space, with c1 to c3. Default: that of one isotropic round section.",
    ),
];

const REFERENCE: &[Key] = &[
    default("nu", Profile(D::Number), "1", "Stretch of the unloaded arm."),
    default("eta", Profile(D::Number), "0", "Shear strain of the unloaded arm."),
    default("mu", Profile(D::Curvature), "0", "Bending strain of the unloaded arm; in space about c."),
    optional("zeta", Profile(D::Number), "Shear strain along c of the unloaded arm, in space. Default: 0."),
    optional("tau", Profile(D::Curvature), "Twist of the unloaded arm, in space. Default: 0."),
    optional("kappa", Profile(D::Curvature), "Bending strain about b of the unloaded arm, in space. Default: 0."),
];

const CABLE: &[Key] = &[
    optional("name", Text, "Name of the cable. Default: its index."),
    default(
        "offset",
        Offset(D::Length),
        "{ base = 0.005, tip = 0.001 }",
        "Offset from the centreline, left positive, or a fraction of the radius: \"70 %\".",
    ),
    optional("angle", Profile(D::Angle), "Angle of the offset in the section, from b towards c, in space. Default: 0."),
    default("tension", Quantity(D::Force), "0", "Tension at the base. Either this or stroke."),
    optional("stroke", Quantity(D::Length), "Length reeled in, measured from the unloaded arm; negative: paid out."),
    optional("stiffness", Quantity(D::Force), "EA of an elastic cable with a stroke. Default: it does not stretch."),
    default("friction", Quantity(D::Number), "0", "Friction coefficient in its channel, at most 2."),
    default("motion", Choice(&["in", "out"]), "\"in\"", "With friction: direction of the last sliding."),
    optional("max_tension", Quantity(D::Force), "Largest tension; more is refused."),
    default("end", Part, "1.0", "Anchor: a fraction of the length in (0, 1], or a length: \"98 mm\"."),
];

/// Either of them, not both.
pub(crate) const PULL: [&str; 2] = ["tension", "stroke"];

/// Required with `law = "quadratic-drag"`.
pub(crate) const DRAG: [&str; 2] = ["cn", "ct"];

const FLOW: &[Key] = &[
    default("speed", Quantity(D::Speed), "0", "Speed of the free stream."),
    default("direction", Heading, "0", "Direction of the free stream, from e1; in space also [_, _, _]."),
    default("density", Quantity(D::Density), "1000", "Density of the water; 0 is a vacuum."),
    default("layer_thickness", Quantity(D::Length), "0.005", "Thickness of the boundary layer h_inf."),
    default("law", Choice(&["momentum", "quadratic-drag"]), "\"momentum\"", "Law of the stream's load."),
    optional("cn", Quantity(D::Number), "Normal drag coefficient, of quadratic-drag only."),
    optional("ct", Quantity(D::Number), "Tangential drag coefficient, of quadratic-drag only."),
];

const GRAVITY: &[Key] = &[
    default("acceleration", Quantity(D::Acceleration), "9.81", "Acceleration of gravity in the plane."),
    default("direction", Heading, "-90", "Direction, from e1; in space also [_, _, _]."),
];

const TIP: &[Key] = &[
    default("force", Pair(D::Force), "[0.0, 0.0]", "Dead force, fixed in space."),
    default("moment", Axial(D::Moment), "0.0", "Moment, counterclockwise; in space about e3, or [_, _, _]."),
    default("follower", Pair(D::Force), "[0.0, 0.0]", "Force along a(L), b(L), which turns with the tip."),
];

const DISTRIBUTED: &[Key] = &[
    default("force", ProfilePair(D::ForcePerLength), "[0.0, 0.0]", "Force along e1 and e2."),
    default(
        "couple",
        AxialProfile(D::MomentPerLength),
        "0.0",
        "Couple, counterclockwise; in space about e3, or [_, _, _].",
    ),
];

/// Either of them, not both.
pub(crate) const RATE: [&str; 2] = ["relaxation_time", "viscosity"];

const DYNAMICS: &[Key] = &[
    default("added_mass", Quantity(D::Number), "1.0", "Coefficient C_a of the added mass of the water; 0 is none."),
    default("relaxation_time", Quantity(D::Time), "0.0", "Relaxation time of the material (Kelvin-Voigt)."),
    optional("viscosity", Quantity(D::Viscosity), "relaxation_time as a viscosity: relaxation_time times C1."),
    default("inertia", Flag, "true", "Whether arm and water have inertia; without it motion is overdamped."),
];

const MODEL: &[Key] = &[
    default(
        "closure",
        Choice(&["default", "literal"]),
        "\"default\"",
        "All options below together, except `displaced`.",
    ),
    optional("volume", Choice(&Volume::NAMES), "Volume law: how a section widens under compression."),
    optional("flow_surface", Choice(&FlowSurface::NAMES), "Surface that gives the direction of the load."),
    optional("entering_speed", Choice(&EnteringSpeed::NAMES), "Speed that enters the boundary layer."),
    optional("layer_mean", Choice(&LayerMean::NAMES), "Mean over the profile of the boundary layer."),
    optional("wetted_length", Choice(&WettedLength::NAMES), "Length on which the stream acts."),
    optional("displaced", Choice(&Displaced::NAMES), "Water that a section displaces."),
    optional("hydrostatics", Choice(&Hydrostatics::NAMES), "Weight and buoyancy: in full, or normal to the arm."),
    optional("support", Choice(&Support::NAMES), "Conditions at the base."),
];

/// The keys of a profile given at both ends.
pub(crate) const ENDS: [&str; 2] = ["base", "tip"];
/// The keys of a profile given by points and how they are joined.
pub(crate) const JOINED: [&str; 2] = ["points", "join"];

impl Kind {
    /// What a value may be, in words.
    pub(crate) fn expected(self) -> String {
        match self {
            Text => format!("a string of at most {MAX_NAME} characters"),
            Choice(words) => {
                let quoted: Vec<String> = words.iter().map(|w| format!("{w:?}")).collect();
                quoted.join(" or ")
            }
            Flag => "true or false".to_owned(),
            Quantity(dimension) => dimension.expected(),
            Pair(dimension) => {
                format!("two values [_, _], each {}; in space also three", dimension.expected())
            }
            Axial(dimension) => format!("{}; in space also three of them, [_, _, _]", dimension.expected()),
            Heading => format!("{}; in space also three numbers, [_, _, _]", D::Angle.expected()),
            Direction => "three numbers, [_, _, _]".to_owned(),
            Profile(dimension) => {
                format!(
                    "{}, as one value, {{ base = _, tip = _ }}, [[s, value], ...] or {{ points = [[s, value], ...], join = \"linear\" }}",
                    dimension.expected()
                )
            }
            ProfilePair(_) => "two profiles [_, _], in space also three".to_owned(),
            AxialProfile(dimension) => {
                format!("{}; in space also three profiles, [_, _, _]", Profile(dimension).expected())
            }
            Offset(dimension) => {
                format!("{}; or a fraction of the radius, such as \"70 %\"", Profile(dimension).expected())
            }
            Part => "a fraction of the length (a number, or a string such as \"40 %\"), or a length such as \"98 mm\""
                .to_owned(),
            Table(keys) => format!("a table with {}", names(keys)),
            Tables(keys) => format!("[[cable]] tables, each with {}", names(keys)),
        }
    }
}

/// The keys of a table, for messages.
pub(crate) fn names(keys: &[Key]) -> String {
    let names: Vec<&str> = keys.iter().map(|k| k.name).collect();
    names.join(", ")
}

/// The name and the indices of a step of a key; `None` where what follows the name is not indices.
fn indexed(step: &str) -> Option<(&str, &str)> {
    let (name, indices) = step.split_at(step.find('[').unwrap_or(step.len()));
    let mut rest = indices;
    while !rest.is_empty() {
        let (index, after) = rest.strip_prefix('[')?.split_once(']')?;
        if index.is_empty() || !index.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
        rest = after;
    }
    Some((name, indices))
}

/// What the number at a dotted key measures, such as `cable[0].tension` or `tip.force[1]`, or a profile, one of its ends or a
/// number of its table; `None` where there is none.
pub(crate) fn dimension_at(key: &str) -> Option<Dimension> {
    let (whole, end) = match key.rsplit_once('.') {
        Some((whole, end)) if ENDS.contains(&end) => (whole, true),
        _ => (key, false),
    };
    let (mut keys, mut found) = (FILE, None);
    let steps: Vec<&str> = whole.split('.').collect();
    for (k, step) in steps.iter().enumerate() {
        let (name, indices) = indexed(step)?;
        let last = k + 1 == steps.len();
        match keys.iter().find(|key| key.name == name)?.kind {
            Table(inner) | Tables(inner) if !last => keys = inner,
            Quantity(dimension) | Pair(dimension) | Axial(dimension) if last && !end => found = Some(dimension),
            Heading if last && !end => {
                found = Some(if indices.is_empty() { Dimension::Angle } else { Dimension::Number });
            }
            Part | Direction if last && !end => found = Some(Dimension::Number),
            kind @ (Profile(dimension) | Offset(dimension) | ProfilePair(dimension) | AxialProfile(dimension))
                if last =>
            {
                let place = !matches!(kind, ProfilePair(_)) && indices.ends_with("][0]");
                found = Some(if place { Dimension::Length } else { dimension });
            }
            _ => return None,
        }
    }
    found
}

/// Whether a dotted key is one of the format, whatever its indices and what is inside profiles and pairs.
pub(crate) fn is_key(key: &str) -> bool {
    let mut keys = FILE;
    for step in key.split('.') {
        let Some((name, indices)) = indexed(step) else { return false };
        let depth = indices.matches('[').count();
        match keys.iter().find(|key| key.name == name).map(|key| key.kind) {
            Some(Table(inner)) if depth == 0 => keys = inner,
            Some(Tables(inner)) if depth <= 1 => keys = inner,
            Some(Table(_) | Tables(_)) | None => return false,
            // At most a component, a point of a table, and its place or value.
            Some(ProfilePair(_) | AxialProfile(_)) => return depth <= 3,
            Some(_) => return depth <= 2,
        }
    }
    true
}

/// Where in the format some key stands, as a dotted path, the first if there are several.
pub(crate) fn home_of(name: &str) -> Option<String> {
    fn search(keys: &[Key], name: &str, path: &str) -> Option<String> {
        keys.iter().find_map(|k| {
            let here = if path.is_empty() { k.name.to_owned() } else { format!("{path}.{}", k.name) };
            match k.kind {
                _ if k.name == name => Some(here),
                Table(inner) => search(inner, name, &here),
                Tables(inner) => search(inner, name, &format!("{here}[0]")),
                _ => None,
            }
        })
    }
    search(FILE, name, "")
}

/// Names that people look for, and the keys that they mean.
const SYNONYMS: [(&str, &str); 31] = [
    ("e", "material.young"),
    ("youngs_modulus", "material.young"),
    ("young_modulus", "material.young"),
    ("young's_modulus", "material.young"),
    ("elastic_modulus", "material.young"),
    ("modulus", "material.young"),
    ("stiffness", "material.young"),
    ("poisson_ratio", "material.poisson"),
    ("poissons_ratio", "material.poisson"),
    ("base_radius", "arm.radius.base"),
    ("radius_base", "arm.radius.base"),
    ("tip_radius", "arm.radius.tip"),
    ("radius_tip", "arm.radius.tip"),
    ("r", "arm.radius"),
    ("diameter", "arm.radius"),
    ("l", "arm.length"),
    ("arm_length", "arm.length"),
    ("rho", "arm.density"),
    ("velocity", "flow.speed"),
    ("flow_speed", "flow.speed"),
    ("u", "flow.speed"),
    ("v", "flow.speed"),
    ("cd", "flow.cn"),
    ("c_n", "flow.cn"),
    ("c_t", "flow.ct"),
    ("fluid", "flow"),
    ("water", "flow"),
    ("cables", "cable"),
    ("tendon", "cable"),
    ("tendons", "cable"),
    ("g", "gravity.acceleration"),
];

/// The key that is meant by a name that people look for.
pub(crate) fn synonym(name: &str) -> Option<&'static str> {
    let plain = name.to_lowercase().replace(['-', ' '], "_");
    SYNONYMS.iter().find(|(own, _)| *own == plain).map(|(_, key)| *key)
}

/// A key with its indices in brackets: `cable.0.tension` is `cable[0].tension`.
pub(crate) fn bracketed(key: &str) -> String {
    let mut out = String::with_capacity(key.len() + 2);
    for (k, step) in key.split('.').enumerate() {
        let is_index = k > 0 && !step.is_empty() && step.bytes().all(|byte| byte.is_ascii_digit());
        match (is_index, k) {
            (true, _) => out.extend(["[", step, "]"]),
            (false, 0) => out.push_str(step),
            (false, _) => out.extend([".", step]),
        }
    }
    out
}

/// The name of `candidates` that `name` is most likely a slip of.
pub(crate) fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    // Longer names are no slip of any key, and distances cost their product.
    if name.len() > 64 {
        return None;
    }
    let plain = name.to_lowercase().replace(['-', ' '], "_");
    candidates
        .map(|c| (strsim::damerau_levenshtein(&plain, c), c))
        .filter(|(distance, c)| *distance <= 1 + c.len() / 4)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, c)| c)
}
