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
    /// One number.
    Quantity(Dimension),
    /// Two numbers, `[_, _]`.
    Pair(Dimension),
    /// A quantity along the arm: a number, `{ base, tip }`, `[[s, value], ...]` or `{ points, join }`.
    Profile(Dimension),
    /// Two profiles, `[_, _]`.
    ProfilePair(Dimension),
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
use Kind::{Choice, Pair, Profile, ProfilePair, Quantity, Table, Tables, Text};

pub(crate) const FILE: &[Key] = &[
    optional("name", Text, "A name for people. Default: the file's name."),
    required("arm", Table(ARM), "Geometry and place."),
    required("material", Table(MATERIAL), "Stiffness: young, poisson, shear_factor, or c1, c2, c3."),
    optional("reference", Table(REFERENCE), "Strains of the unloaded arm."),
    optional("cable", Tables(CABLE), "The cables."),
    optional("flow", Table(FLOW), "The stream. Left out: still water of 1000 kg/m3."),
    optional("gravity", Table(GRAVITY), "Gravity in the plane. Left out: none."),
    optional("tip", Table(TIP), "Loads on the tip."),
    optional("distributed", Table(DISTRIBUTED), "Dead loads along the arm, per metre of undeformed length."),
    optional("model", Table(MODEL), "Options of the model."),
];

const ARM: &[Key] = &[
    required("length", Quantity(D::Length), "Undeformed length L."),
    required("radius", Profile(D::Length), "Undeformed radius R(s), above zero."),
    default("inner_radius", Profile(D::Length), "0", "Radius of the cavity R_in(s), below the radius; 0 is solid."),
    default("cavity", Choice(&["flooded", "sealed"]), "\"flooded\"", "What is inside a hollow arm: water, or nothing."),
    default("density", Quantity(D::Density), "1000", "Density of the wall."),
    default("base", Table(BASE), "{ x = 0, y = 0, angle = 0 }", "Place and angle of the section at s = 0."),
];

const BASE: &[Key] = &[
    default("x", Quantity(D::Length), "0", "Along e1."),
    default("y", Quantity(D::Length), "0", "Along e2."),
    default("angle", Quantity(D::Angle), "0", "From e1."),
];

/// Required unless [`COEFFICIENTS`] are given.
pub(crate) const HOMOGENEOUS: [&str; 3] = ["young", "poisson", "shear_factor"];
/// Required together, instead of [`HOMOGENEOUS`].
pub(crate) const COEFFICIENTS: [&str; 3] = ["c1", "c2", "c3"];

const MATERIAL: &[Key] = &[
    optional("young", Quantity(D::Pressure), "Young's modulus E. Required unless c1, c2 and c3 are given."),
    default("poisson", Quantity(D::Number), "0.5", "Poisson's ratio."),
    default("shear_factor", Quantity(D::Number), "1.0", "Timoshenko's shear correction."),
    optional("c1", Profile(D::Pressure), "Stiffness against stretch."),
    optional("c2", Profile(D::Pressure), "Stiffness against shear."),
    optional("c3", Profile(D::Force), "Stiffness against bending."),
];

const REFERENCE: &[Key] = &[
    default("nu", Profile(D::Number), "1", "Stretch of the unloaded arm."),
    default("eta", Profile(D::Number), "0", "Shear strain of the unloaded arm."),
    default("mu", Profile(D::Curvature), "0", "Bending strain of the unloaded arm."),
];

const CABLE: &[Key] = &[
    optional("name", Text, "A name for people. Default: its index."),
    default(
        "offset",
        Profile(D::Length),
        "{ base = 0.005, tip = 0.001 }",
        "Signed offset in the straight arm, positive is left; inside the section as far as the cable runs.",
    ),
    default("tension", Quantity(D::Force), "0", "Tension at the base, not negative; or stroke."),
    optional(
        "stroke",
        Quantity(D::Length),
        "In place of the tension: the length that is reeled in, of the cable's length in the unloaded arm; negative is paid out.",
    ),
    optional("stiffness", Quantity(D::Force), "EA of an elastic cable, with a stroke. Left out: it does not stretch."),
    default("friction", Quantity(D::Number), "0", "Coefficient of friction against its channel, at most 2."),
    default(
        "motion",
        Choice(&["in", "out"]),
        "\"in\"",
        "Which way it slid last, with friction: reeled in or paid out.",
    ),
    optional("max_tension", Quantity(D::Force), "The largest tension that makes sense."),
    default("end", Quantity(D::Number), "1.0", "Where it is anchored, as a fraction of the length in (0, 1]."),
];

/// Either of them, not both.
pub(crate) const PULL: [&str; 2] = ["tension", "stroke"];

/// Required with `law = "quadratic-drag"`.
pub(crate) const DRAG: [&str; 2] = ["cn", "ct"];

const FLOW: &[Key] = &[
    default("speed", Quantity(D::Speed), "0", "Speed of the free stream."),
    default("direction", Quantity(D::Angle), "0", "Direction of the free stream, from e1."),
    default("density", Quantity(D::Density), "1000", "Density of the water; 0 is a vacuum."),
    default("layer_thickness", Quantity(D::Length), "0.005", "Thickness of the boundary layer h_inf."),
    default("law", Choice(&["momentum", "quadratic-drag"]), "\"momentum\"", "How the stream loads the arm."),
    optional("cn", Quantity(D::Number), "Normal drag coefficient. Required by quadratic-drag, unused otherwise."),
    optional("ct", Quantity(D::Number), "Tangential drag coefficient. Required by quadratic-drag, unused otherwise."),
];

const GRAVITY: &[Key] = &[
    default("acceleration", Quantity(D::Acceleration), "9.81", "Acceleration of gravity in the plane."),
    default("direction", Quantity(D::Angle), "-90", "Its direction, from e1."),
];

const TIP: &[Key] = &[
    default("force", Pair(D::Force), "[0.0, 0.0]", "Dead force, fixed in space."),
    default("moment", Quantity(D::Moment), "0.0", "Moment, counterclockwise."),
    default("follower", Pair(D::Force), "[0.0, 0.0]", "Force along a(L), b(L), which turns with the tip."),
];

const DISTRIBUTED: &[Key] = &[
    default("force", ProfilePair(D::ForcePerLength), "[0.0, 0.0]", "Force along e1 and e2."),
    default("couple", Profile(D::MomentPerLength), "0.0", "Couple, counterclockwise."),
];

const MODEL: &[Key] = &[
    default(
        "closure",
        Choice(&["default", "literal"]),
        "\"default\"",
        "All readings together, but `displaced`: `literal` has those closest to the source's words.",
    ),
    optional("volume", Choice(&Volume::NAMES), "How a section swells."),
    optional("flow_surface", Choice(&FlowSurface::NAMES), "The surface that directs the loads of the stream."),
    optional("entering_speed", Choice(&EnteringSpeed::NAMES), "The speed that enters the layer."),
    optional("layer_mean", Choice(&LayerMean::NAMES), "The mean over the layer's profile."),
    optional("wetted_length", Choice(&WettedLength::NAMES), "The length on which the stream acts."),
    optional("displaced", Choice(&Displaced::NAMES), "The water that a section displaces."),
    optional("hydrostatics", Choice(&Hydrostatics::NAMES), "The part of weight and buoyancy that acts."),
    optional("support", Choice(&Support::NAMES), "The conditions at the base."),
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
            Quantity(dimension) => dimension.expected(),
            Pair(dimension) => format!("two values [_, _], each {}", dimension.expected()),
            Profile(dimension) => {
                format!(
                    "{}, as one value, {{ base = _, tip = _ }}, [[s, value], ...] or {{ points = [[s, value], ...], join = \"linear\" }}",
                    dimension.expected()
                )
            }
            ProfilePair(_) => "two profiles [_, _]".to_owned(),
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
            Quantity(dimension) | Pair(dimension) if last && !end => found = Some(dimension),
            Profile(dimension) | ProfilePair(dimension) if last => {
                let place =
                    matches!(keys.iter().find(|key| key.name == name)?.kind, Profile(_)) && indices.ends_with("][0]");
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
            // At most a point of a table, and its place or value.
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
