//! An arm written out in the form of its file: as TOML, and as the `inputs` of results.

use std::fmt::Write;

use hydrostat::{Arm, Cavity, FlowLaw, Join, Material, ModelOptions, Profile};
use serde::{Serialize, Serializer};

/// An arm in the form of its file, every default filled in: SI numbers, angles as bare numbers in
/// degrees. Serialized as JSON it has the keys of the arm file, and reads back as the same arm (an
/// angle to its last digit).
#[derive(Debug, Clone, PartialEq)]
pub struct Inputs(Tree);

impl Inputs {
    /// Of this arm.
    pub fn new(arm: &Arm) -> Self {
        Self(plain_tree(arm))
    }
}

impl Serialize for Inputs {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

/// An arm as the text of an arm file, every default filled in. Reading it gives the same arm, to
/// the last bit: an angle that no number of degrees gives exactly is written in rad.
///
/// ```
/// use hydrostat::{Arm, Cable, Profile};
/// use hydrostat_files::{ArmFile, arm_to_toml};
///
/// let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
/// let text = arm_to_toml(&arm);
/// assert_eq!(ArmFile::parse(&text, "copy.toml").unwrap().arm().unwrap(), arm);
/// ```
pub fn arm_to_toml(arm: &Arm) -> String {
    let angle = |rad: f64| {
        let degrees = nearest_degrees(rad);
        if degrees.to_radians().to_bits() == rad.to_bits() {
            Tree::Number(degrees)
        } else {
            Tree::Text(format!("{rad:?} rad"))
        }
    };
    let mut out = String::new();
    if let Tree::Table(tables) = tree(arm, &angle) {
        for (name, value) in tables {
            match value {
                Tree::Table(keys) => section(&mut out, &format!("[{name}]"), &keys),
                Tree::Array(elements) => {
                    for element in elements {
                        if let Tree::Table(keys) = element {
                            section(&mut out, &format!("[[{name}]]"), &keys);
                        }
                    }
                }
                other => assign(&mut out, name, &other),
            }
        }
    }
    out
}

fn section(out: &mut String, header: &str, keys: &[(&'static str, Tree)]) {
    out.push('\n');
    out.push_str(header);
    out.push('\n');
    for (name, value) in keys {
        assign(out, name, value);
    }
}

fn assign(out: &mut String, name: &str, value: &Tree) {
    out.push_str(name);
    out.push_str(" = ");
    value.write_toml(out);
    out.push('\n');
}

/// Values in the order in which they are written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Tree {
    Text(String),
    Number(f64),
    Flag(bool),
    Array(Vec<Tree>),
    Table(Vec<(&'static str, Tree)>),
}

impl Tree {
    fn word(word: &str) -> Self {
        Self::Text(word.to_owned())
    }

    fn triple(triple: [f64; 3]) -> Self {
        Self::Array(triple.into_iter().map(Self::Number).collect())
    }

    fn pair(pair: [f64; 2]) -> Self {
        Self::Array(pair.into_iter().map(Self::Number).collect())
    }

    fn profile(profile: &Profile) -> Self {
        match profile {
            Profile::Constant(value) => Self::Number(*value),
            Profile::Linear { base, tip } => {
                Self::Table(vec![("base", Self::Number(*base)), ("tip", Self::Number(*tip))])
            }
            Profile::Table(table) => {
                let points = Self::Array(table.points().map(Self::pair).collect());
                match table.join() {
                    Join::Cubic => points,
                    join @ Join::Linear => {
                        Self::Table(vec![("points", points), ("join", Self::Text(join.name().to_owned()))])
                    }
                }
            }
        }
    }

    pub(crate) fn write_toml(&self, out: &mut String) {
        match self {
            Self::Text(text) => write_string(out, text),
            Self::Number(value) => {
                // TOML spells what is not finite in lower case.
                let text = format!("{value:?}");
                out.push_str(if value.is_nan() { "nan" } else { &text });
            }
            Self::Flag(flag) => out.push_str(if *flag { "true" } else { "false" }),
            Self::Array(elements) => {
                out.push('[');
                for (i, element) in elements.iter().enumerate() {
                    out.push_str(if i == 0 { "" } else { ", " });
                    element.write_toml(out);
                }
                out.push(']');
            }
            Self::Table(keys) => {
                for (i, (name, value)) in keys.iter().enumerate() {
                    out.push_str(if i == 0 { "{ " } else { ", " });
                    out.push_str(name);
                    out.push_str(" = ");
                    value.write_toml(out);
                }
                out.push_str(" }");
            }
        }
    }
}

impl Serialize for Tree {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Text(text) => serializer.serialize_str(text),
            Self::Number(value) => serializer.serialize_f64(*value),
            Self::Flag(flag) => serializer.serialize_bool(*flag),
            Self::Array(elements) => serializer.collect_seq(elements),
            Self::Table(keys) => serializer.collect_map(keys.iter().map(|(k, v)| (k, v))),
        }
    }
}

fn write_string(out: &mut String, text: &str) {
    out.push('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => {
                out.push('\\');
                out.push(c);
            }
            c if c.is_control() => {
                // Writing to a string cannot fail.
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
}

/// The degrees that are read as `rad`, or as near as degrees come to it; of several the one with
/// the fewest digits.
fn nearest_degrees(rad: f64) -> f64 {
    let degrees = rad.to_degrees();
    if !degrees.is_finite() {
        return degrees;
    }
    let rounded: Option<f64> = format!("{degrees:.14e}").parse().ok();
    let candidates = [rounded.unwrap_or(degrees), degrees, degrees.next_down(), degrees.next_up()];
    candidates.into_iter().find(|d| d.to_radians().to_bits() == rad.to_bits()).unwrap_or(degrees)
}

/// An arm as values, angles in degrees.
pub(crate) fn plain_tree(arm: &Arm) -> Tree {
    tree(arm, &|rad| Tree::Number(nearest_degrees(rad)))
}

fn tree(arm: &Arm, angle: &dyn Fn(f64) -> Tree) -> Tree {
    let number = Tree::Number;
    let mut file = vec![("name", Tree::Text(arm.name.clone()))];
    let space = arm.space.as_ref();
    let mut geometry = match space {
        Some(_) => vec![("space", Tree::word("spatial"))],
        None => Vec::new(),
    };
    geometry.extend([
        ("length", number(arm.length)),
        ("radius", Tree::profile(&arm.radius)),
        ("inner_radius", Tree::profile(&arm.inner_radius)),
        (
            "cavity",
            Tree::word(match arm.cavity {
                Cavity::Flooded => "flooded",
                Cavity::Sealed => "sealed",
            }),
        ),
        ("density", number(arm.density)),
        ("base", base(arm, angle)),
    ]);
    file.push(("arm", Tree::Table(geometry)));
    let mut stiffness = material(&arm.material);
    if let (Tree::Table(keys), Some(c4)) = (&mut stiffness, space.and_then(|space| space.c4.as_ref())) {
        keys.push(("c4", Tree::profile(c4)));
    }
    file.push(("material", stiffness));
    let mut reference = vec![
        ("nu", Tree::profile(&arm.reference.nu)),
        ("eta", Tree::profile(&arm.reference.eta)),
        ("mu", Tree::profile(&arm.reference.mu)),
    ];
    if let Some(space) = space {
        reference.extend([
            ("zeta", Tree::profile(&space.zeta)),
            ("tau", Tree::profile(&space.tau)),
            ("kappa", Tree::profile(&space.kappa)),
        ]);
    }
    file.push(("reference", Tree::Table(reference)));
    if !arm.cables.is_empty() {
        file.push(("cable", Tree::Array(arm.cables.iter().map(|c| cable(c, angle)).collect())));
    }
    file.push(("flow", flow(arm, angle)));
    if let Some(gravity) = &arm.gravity {
        let direction = space.and_then(|space| space.gravity).map_or_else(|| angle(gravity.direction), Tree::triple);
        let keys = vec![("acceleration", number(gravity.acceleration)), ("direction", direction)];
        file.push(("gravity", Tree::Table(keys)));
    }
    let [f1, f2] = arm.tip.force;
    let [a, b] = arm.tip.follower;
    let [e1, e2] = &arm.distributed.force;
    let (tip, distributed) = match space {
        None => (
            vec![
                ("force", Tree::pair(arm.tip.force)),
                ("moment", number(arm.tip.moment)),
                ("follower", Tree::pair(arm.tip.follower)),
            ],
            vec![
                ("force", Tree::Array(vec![Tree::profile(e1), Tree::profile(e2)])),
                ("couple", Tree::profile(&arm.distributed.couple)),
            ],
        ),
        Some(space) => (
            vec![
                ("force", Tree::triple([f1, f2, space.tip_force])),
                ("moment", Tree::triple([space.tip_moment[0], space.tip_moment[1], arm.tip.moment])),
                ("follower", Tree::triple([a, b, space.tip_follower])),
            ],
            vec![
                ("force", Tree::Array([e1, e2, &space.force].map(Tree::profile).to_vec())),
                (
                    "couple",
                    Tree::Array(
                        [&space.couple[0], &space.couple[1], &arm.distributed.couple].map(Tree::profile).to_vec(),
                    ),
                ),
            ],
        ),
    };
    file.push(("tip", Tree::Table(tip)));
    file.push(("distributed", Tree::Table(distributed)));
    if arm.dynamics != hydrostat::Dynamics::default() {
        let own = arm.dynamics;
        let keys = vec![
            ("added_mass", number(own.added_mass)),
            ("relaxation_time", number(own.relaxation_time)),
            ("inertia", Tree::Flag(own.inertia)),
        ];
        file.push(("dynamics", Tree::Table(keys)));
    }
    file.push(("model", model(arm.model)));
    Tree::Table(file)
}

fn material(material: &Material) -> Tree {
    Tree::Table(match material {
        Material::Homogeneous { young, poisson, shear_factor } => vec![
            ("young", Tree::Number(*young)),
            ("poisson", Tree::Number(*poisson)),
            ("shear_factor", Tree::Number(*shear_factor)),
        ],
        Material::Coefficients { c1, c2, c3 } => {
            vec![("c1", Tree::profile(c1)), ("c2", Tree::profile(c2)), ("c3", Tree::profile(c3))]
        }
    })
}

fn cable(cable: &hydrostat::Cable, angle: &dyn Fn(f64) -> Tree) -> Tree {
    let mut keys = vec![("name", Tree::Text(cable.name.clone())), ("offset", Tree::profile(&cable.offset))];
    if !cable.angle.is_zero() {
        keys.push(("angle", angle_profile(&cable.angle, angle)));
    }
    match cable.stroke {
        Some(stroke) => keys.push(("stroke", Tree::Number(stroke))),
        None => keys.push(("tension", Tree::Number(cable.tension))),
    }
    if let Some(stiffness) = cable.stiffness {
        keys.push(("stiffness", Tree::Number(stiffness)));
    }
    if cable.friction > 0.0 {
        let motion = match cable.motion {
            hydrostat::Motion::In => "in",
            hydrostat::Motion::Out => "out",
        };
        keys.extend([("friction", Tree::Number(cable.friction)), ("motion", Tree::word(motion))]);
    }
    if let Some(max_tension) = cable.max_tension {
        keys.push(("max_tension", Tree::Number(max_tension)));
    }
    keys.push(("end", Tree::Number(cable.end)));
    Tree::Table(keys)
}

/// A profile of angles.
fn angle_profile(profile: &Profile, angle: &dyn Fn(f64) -> Tree) -> Tree {
    match profile {
        Profile::Constant(value) => angle(*value),
        Profile::Linear { base, tip } => Tree::Table(vec![("base", angle(*base)), ("tip", angle(*tip))]),
        Profile::Table(table) => {
            let points = table.points().map(|[s, value]| Tree::Array(vec![Tree::Number(s), angle(value)])).collect();
            match table.join() {
                Join::Cubic => Tree::Array(points),
                join @ Join::Linear => {
                    Tree::Table(vec![("points", Tree::Array(points)), ("join", Tree::Text(join.name().to_owned()))])
                }
            }
        }
    }
}

fn base(arm: &Arm, angle: &dyn Fn(f64) -> Tree) -> Tree {
    let mut keys = vec![("x", Tree::Number(arm.base.x)), ("y", Tree::Number(arm.base.y))];
    let Some(space) = &arm.space else {
        keys.push(("angle", angle(arm.base.angle)));
        return Tree::Table(keys);
    };
    keys.push(("z", Tree::Number(space.z)));
    match space.base {
        Some(base) => {
            keys.push(("direction", Tree::triple(base.direction)));
            keys.extend(base.section.map(|section| ("section", Tree::triple(section))));
        }
        None => keys.push(("angle", angle(arm.base.angle))),
    }
    Tree::Table(keys)
}

fn flow(arm: &Arm, angle: &dyn Fn(f64) -> Tree) -> Tree {
    let mut keys = vec![
        ("speed", Tree::Number(arm.flow.speed)),
        (
            "direction",
            arm.space.as_ref().and_then(|space| space.stream).map_or_else(|| angle(arm.flow.direction), Tree::triple),
        ),
        ("density", Tree::Number(arm.flow.density)),
        ("layer_thickness", Tree::Number(arm.flow.layer_thickness)),
    ];
    match arm.flow.law {
        FlowLaw::Momentum => keys.push(("law", Tree::word("momentum"))),
        FlowLaw::QuadraticDrag { cn, ct } => {
            keys.extend([("law", Tree::word("quadratic-drag")), ("cn", Tree::Number(cn)), ("ct", Tree::Number(ct))]);
        }
    }
    Tree::Table(keys)
}

/// The readings by their words.
pub(crate) fn model(r: ModelOptions) -> Tree {
    let words = [
        ("volume", r.volume.name()),
        ("flow_surface", r.flow_surface.name()),
        ("entering_speed", r.entering_speed.name()),
        ("layer_mean", r.layer_mean.name()),
        ("wetted_length", r.wetted_length.name()),
        ("displaced", r.displaced.name()),
        ("hydrostatics", r.hydrostatics.name()),
        ("support", r.support.name()),
    ];
    Tree::Table(words.into_iter().map(|(key, word)| (key, Tree::word(word))).collect())
}
