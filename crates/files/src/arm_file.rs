//! Arm files: TOML text, overrides, and the [`Arm`] they mean.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use hydrostat::{
    Arm, ArmError, Base, BaseDirections, Cable, Cavity, Displaced, DistributedLoad, Dynamics, EnteringSpeed, Flow,
    FlowLaw, FlowSurface, Gravity, Hydrostatics, LayerMean, Material, ModelOptions, Motion, Profile, Reference, Space,
    Support, TipLoad, Volume, WettedLength,
};

use crate::document::{self, Field, Origin};
use crate::error::{FileError, Place, shortened};
use crate::format::MAX_BYTES;
use crate::reading::{Fault, FaultKind, MOST_FAULTS, Values};
use crate::relative::resolved;
use crate::setting;
use crate::syntax_hint::hint;

/// Keys of the format are shorter by far.
const LONGEST_KEY: usize = 200;

/// An arm file: its text, where it came from, and what overrides it.
///
/// ```
/// use hydrostat_files::ArmFile;
///
/// let text = r#"
///     [arm]
///     length = "245 mm"
///     radius = { base = "10 mm", tip = "2 mm" }
///     [material]
///     young = "110 kPa"
/// "#;
/// let mut file = ArmFile::parse(text, "arm.toml").unwrap();
/// file.set("flow.speed", "0.5").unwrap();
/// let arm = file.arm().unwrap();
/// assert_eq!((arm.length, arm.flow.speed), (0.245, 0.5));
///
/// let wrong = ArmFile::parse("[arm]\nlenght = 0.2", "arm.toml").unwrap().arm().unwrap_err();
/// assert!(wrong.to_string().starts_with("arm.toml:2: arm.lenght: unknown key; expected"));
/// assert!(wrong.to_string().ends_with("did you mean `length`?"));
/// ```
#[derive(Debug, Clone)]
pub struct ArmFile {
    path: String,
    text: String,
    fields: Vec<Field>,
    /// Option and text of each override.
    settings: Vec<String>,
}

impl ArmFile {
    /// Reads a file.
    ///
    /// # Errors
    /// [`FileError`] when it cannot be read, or is not TOML.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, FileError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let mut bytes = Vec::new();
        File::open(path)
            .and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut bytes))
            .map_err(|source| FileError::Read { path: name.clone(), source })?;
        Self::parse_bytes(&bytes, &name)
    }

    /// Reads bytes that came from `path`, which messages name.
    ///
    /// # Errors
    /// [`FileError`] when they are not UTF-8, or not TOML.
    pub fn parse_bytes(bytes: &[u8], path: &str) -> Result<Self, FileError> {
        match std::str::from_utf8(bytes) {
            Ok(text) => Self::parse(text, path),
            Err(error) => {
                let at = error.valid_up_to();
                let valid = std::str::from_utf8(&bytes[..at]).unwrap_or_default();
                let byte = bytes.get(at).copied().unwrap_or_default();
                Err(FileError::NotText { place: line_of(path, valid, at), byte })
            }
        }
    }

    /// Reads text that came from `path`, which messages name and which is the default of `name`.
    ///
    /// # Errors
    /// [`FileError`] when it is not TOML.
    pub fn parse(text: &str, path: &str) -> Result<Self, FileError> {
        if text.len() as u64 > MAX_BYTES {
            return Err(FileError::TooLarge { path: path.to_owned(), limit: MAX_BYTES });
        }
        let fields = document::parse(text).map_err(|error| {
            let place = line_of(path, text, error.at);
            // A key may be as long as the file, a message may not.
            let short = |key: String| if key.len() > LONGEST_KEY { shortened(&key) } else { key };
            let key = document::key_at(text, error.at).map(short);
            if error.message == "duplicate key" {
                // Inside an inline table the line's key is not the one that is there twice.
                let what = error.what.trim();
                let key = key.unwrap_or_default();
                let whole = key.split(['.', '[', ']']).any(|part| part == what);
                let key = if whole || key.is_empty() { key } else { crate::reading::join(&key, what) };
                return FileError::Duplicate { place, key };
            }
            let message = format!("{}{}", error.message, hint(text, error.at));
            FileError::Syntax { place, key, message }
        })?;
        Ok(Self { path: path.to_owned(), text: text.to_owned(), fields, settings: Vec::new() })
    }

    /// The path or name that messages carry.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The text, without what overrides it.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Overrides one value: `key` is a dotted path (`flow.speed`, `cable[0].tension`), `value` is
    /// TOML or, where it is none, a string. Tables that are not there are made; cables are not.
    ///
    /// # Errors
    /// [`FileError`] when the format has no such key, or the arm no such cable. Whether the value
    /// fits is seen by [`ArmFile::arm`].
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), FileError> {
        self.set_by("--set", key, value)
    }

    /// [`ArmFile::set`] by another option, which messages name.
    ///
    /// # Errors
    /// [`FileError`] as there.
    pub fn set_by(&mut self, option: &str, key: &str, value: &str) -> Result<(), FileError> {
        let index = self.settings.len();
        self.settings.push(format!("{option} {key}={value}"));
        // On a copy, so that a refused override leaves nothing behind.
        let mut fields = self.fields.clone();
        match setting::apply(&mut fields, key, value, index) {
            Ok(()) => {
                self.fields = fields;
                Ok(())
            }
            Err(fault) => {
                let error = self.error(fault);
                self.settings.pop();
                Err(error)
            }
        }
    }

    /// The arm that this file with its overrides means, checked.
    ///
    /// # Errors
    /// [`FileError`] for the first thing that is wrong, with its place. [`ArmFile::errors`] has all.
    pub fn arm(&self) -> Result<Arm, FileError> {
        let mut values = Values::read(&resolved(&self.fields));
        if let Some(fault) = values.take_first_fault() {
            return Err(self.error(fault));
        }
        let arm = self.built(&values);
        arm.check().map_err(|source| {
            let key = source.key().to_owned();
            self.error(Fault { origin: values.origin(&key), key, kind: FaultKind::Arm(source) })
        })?;
        Ok(arm)
    }

    /// Everything that is wrong with the file and its overrides, as far as it can be told at once, each with its place; nothing where
    /// [`ArmFile::arm`] is an arm.
    ///
    /// ```
    /// use hydrostat_files::ArmFile;
    ///
    /// let text = "[arm]\nlength = \"2 kg\"\nradus = 0.01\n[material]\nE = 1e5\n";
    /// let errors = ArmFile::parse(text, "arm.toml").unwrap().errors();
    /// let keys: Vec<_> = errors.iter().filter_map(|error| error.key()).collect();
    /// assert_eq!(keys, ["arm.length", "arm.radus", "material.E"]);
    /// ```
    pub fn errors(&self) -> Vec<FileError> {
        let mut values = Values::read(&resolved(&self.fields));
        let mut refused: Vec<Fault> = Vec::new();
        // One by one, what the core refuses is set aside until it takes the rest.
        while refused.len() < MOST_FAULTS
            && let Err(source) = self.built(&values).check()
        {
            let key = source.key().to_owned();
            let origin = values.origin(&key);
            let is_of = |own: &str| values.is_faulty(own) || refused.iter().any(|fault| fault.key == own);
            // What was not read stands in for what is missing or wrong, and was told.
            let is_old = !values.is_read(&key) || is_of(&key) || (is_of("arm.length") && is_against_length(&source));
            let goes_on = values.set_aside(&key);
            if !is_old {
                refused.push(Fault { origin, key, kind: FaultKind::Arm(source) });
            }
            if !goes_on {
                break;
            }
        }
        refused.sort_by_key(|fault| match fault.origin {
            Origin::Text(at) => (0, at),
            Origin::Setting(index) => (1, index),
        });
        let all = values.into_faults().into_iter().chain(refused).take(MOST_FAULTS);
        all.map(|fault| self.error(fault)).collect()
    }

    fn built(&self, values: &Values) -> Arm {
        let stem = Path::new(&self.path).file_stem().map(|s| s.to_string_lossy().into_owned());
        build(values, stem.unwrap_or_else(|| self.path.clone()))
    }

    fn error(&self, fault: Fault) -> FileError {
        let Fault { origin, key, kind } = fault;
        let place = match origin {
            Origin::Text(at) => line_of(&self.path, &self.text, at),
            Origin::Setting(i) => Place::Setting { setting: self.settings.get(i).cloned().unwrap_or_default() },
        };
        match kind {
            FaultKind::Unknown { expected, suggestion } => FileError::UnknownKey { place, key, expected, suggestion },
            FaultKind::Missing { expected } => FileError::Missing { place, key, expected },
            FaultKind::Value { expected, found } => FileError::Value { place, key, expected, found },
            FaultKind::Arm(source) => FileError::Arm { place, key, source: Box::new(source) },
        }
    }
}

/// Whether a value is refused because of the arm's length: nothing is known of it while the length is wrong itself.
fn is_against_length(source: &ArmError) -> bool {
    match source {
        ArmError::TableDoesNotCover { .. } => true,
        ArmError::OutOfRange { key, .. } => key.ends_with("].stroke"),
        _ => false,
    }
}

fn line_of(path: &str, text: &str, at: usize) -> Place {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    let before = &text[..at];
    let start = before.rfind('\n').map_or(0, |i| i + 1);
    let line = before.bytes().filter(|b| *b == b'\n').count() + 1;
    let column = before[start..].trim_start_matches('\u{feff}').chars().count() + 1;
    Place::Line { path: path.to_owned(), line, column }
}

/// The arm that the values mean. The format has made sure that what is required is there; what is
/// not falls back on the defaults of the core.
fn build(v: &Values, name: String) -> Arm {
    let zero = || Profile::Constant(0.0);
    Arm {
        name: v.text("name").unwrap_or(name),
        length: v.number("arm.length").unwrap_or_default(),
        radius: v.profile("arm.radius").unwrap_or_else(zero),
        inner_radius: v.profile("arm.inner_radius").unwrap_or_else(zero),
        cavity: match v.word("arm.cavity") {
            Some("sealed") => Cavity::Sealed,
            _ => Cavity::Flooded,
        },
        density: v.number("arm.density").unwrap_or(1000.0),
        base: Base {
            x: v.number("arm.base.x").unwrap_or_default(),
            y: v.number("arm.base.y").unwrap_or_default(),
            angle: v.number("arm.base.angle").unwrap_or_default(),
        },
        material: material(v),
        reference: reference(v),
        cables: (0..v.cables).map(|i| cable(v, i)).collect(),
        flow: flow(v),
        gravity: v.has("gravity").then(|| {
            let default = Gravity::default();
            Gravity {
                acceleration: v.number("gravity.acceleration").unwrap_or(default.acceleration),
                direction: v.number("gravity.direction").unwrap_or(default.direction),
            }
        }),
        tip: TipLoad {
            force: in_plane(v.triple("tip.force")),
            moment: v.number("tip.moment").or(v.triple("tip.moment").map(|m| m[2])).unwrap_or_default(),
            follower: in_plane(v.triple("tip.follower")),
        },
        distributed: DistributedLoad {
            force: match v.three("distributed.force") {
                Some([x, y, _]) => [x, y],
                None => v.profiles("distributed.force").unwrap_or_else(|| [zero(), zero()]),
            },
            couple: match v.three("distributed.couple") {
                Some([_, _, z]) => z,
                None => v.profile("distributed.couple").unwrap_or_else(zero),
            },
        },
        dynamics: dynamics(v),
        model: readings(v),
        space: v.is_spatial().then(|| space(v)),
    }
}

/// The components along e1 and e2.
fn in_plane(vector: Option<[f64; 3]>) -> [f64; 2] {
    vector.map_or([0.0; 2], |[x, y, _]| [x, y])
}

/// What takes the arm out of the plane.
fn space(v: &Values) -> Space {
    let zero = || Profile::Constant(0.0);
    let third = |key: &str| v.triple(key).map_or(0.0, |vector| vector[2]);
    let profile = |key: &str| v.profile(key).unwrap_or_else(zero);
    Space {
        z: v.number("arm.base.z").unwrap_or_default(),
        base: v
            .triple("arm.base.direction")
            .map(|direction| BaseDirections { direction, section: v.triple("arm.base.section") }),
        stream: v.triple("flow.direction"),
        gravity: v.triple("gravity.direction"),
        tip_force: third("tip.force"),
        tip_follower: third("tip.follower"),
        tip_moment: in_plane(v.triple("tip.moment")),
        force: v.three("distributed.force").map_or_else(zero, |[_, _, z]| z),
        couple: v.three("distributed.couple").map_or_else(|| [zero(), zero()], |[x, y, _]| [x, y]),
        zeta: profile("reference.zeta"),
        tau: profile("reference.tau"),
        kappa: profile("reference.kappa"),
        c4: v.profile("material.c4"),
    }
}

fn dynamics(v: &Values) -> Dynamics {
    let default = Dynamics::default();
    let c1 = || match (v.number("material.young"), v.profile("material.c1")) {
        (_, Some(Profile::Constant(c1))) | (Some(c1), _) => c1,
        _ => f64::NAN,
    };
    let time = if v.has_viscosity() {
        v.number("dynamics.viscosity").map(|viscosity| viscosity / c1())
    } else {
        v.number("dynamics.relaxation_time")
    };
    Dynamics {
        added_mass: v.number("dynamics.added_mass").unwrap_or(default.added_mass),
        relaxation_time: time.unwrap_or(default.relaxation_time),
        inertia: v.flag("dynamics.inertia").unwrap_or(default.inertia),
    }
}

fn material(v: &Values) -> Material {
    let c = |name: &str| v.profile(&format!("material.{name}"));
    match (c("c1"), c("c2"), c("c3")) {
        (Some(c1), Some(c2), Some(c3)) => Material::Coefficients { c1, c2, c3 },
        _ => Material::Homogeneous {
            young: v.number("material.young").unwrap_or_default(),
            poisson: v.number("material.poisson").unwrap_or(0.5),
            shear_factor: v.number("material.shear_factor").unwrap_or(1.0),
        },
    }
}

fn reference(v: &Values) -> Reference {
    let default = Reference::default();
    Reference {
        nu: v.profile("reference.nu").unwrap_or(default.nu),
        eta: v.profile("reference.eta").unwrap_or(default.eta),
        mu: v.profile("reference.mu").unwrap_or(default.mu),
    }
}

fn cable(v: &Values, index: usize) -> Cable {
    let key = |name: &str| format!("cable[{index}].{name}");
    Cable {
        name: v.text(&key("name")).unwrap_or_else(|| index.to_string()),
        offset: v.profile(&key("offset")).unwrap_or(Profile::Linear { base: 0.005, tip: 0.001 }),
        angle: v.profile(&key("angle")).unwrap_or(Profile::Constant(0.0)),
        tension: v.number(&key("tension")).filter(|_| !v.has_stroke(index)).unwrap_or_default(),
        stroke: v.number(&key("stroke")).filter(|_| v.has_stroke(index)),
        stiffness: v.number(&key("stiffness")),
        friction: v.number(&key("friction")).unwrap_or_default(),
        motion: match v.word(&key("motion")) {
            Some("out") => Motion::Out,
            _ => Motion::In,
        },
        max_tension: v.number(&key("max_tension")),
        end: v.number(&key("end")).unwrap_or(1.0),
    }
}

fn flow(v: &Values) -> Flow {
    let default = Flow::default();
    Flow {
        speed: v.number("flow.speed").unwrap_or(default.speed),
        direction: v.number("flow.direction").unwrap_or(default.direction),
        density: v.number("flow.density").unwrap_or(default.density),
        layer_thickness: v.number("flow.layer_thickness").unwrap_or(default.layer_thickness),
        law: match v.word("flow.law") {
            Some("quadratic-drag") => FlowLaw::QuadraticDrag {
                cn: v.number("flow.cn").unwrap_or_default(),
                ct: v.number("flow.ct").unwrap_or_default(),
            },
            _ => FlowLaw::Momentum,
        },
    }
}

fn readings(v: &Values) -> ModelOptions {
    let mut r =
        if v.word("model.closure") == Some("literal") { ModelOptions::LITERAL } else { ModelOptions::default() };
    take(v, "volume", &Volume::ALL, &Volume::NAMES, &mut r.volume);
    take(v, "flow_surface", &FlowSurface::ALL, &FlowSurface::NAMES, &mut r.flow_surface);
    take(v, "entering_speed", &EnteringSpeed::ALL, &EnteringSpeed::NAMES, &mut r.entering_speed);
    take(v, "layer_mean", &LayerMean::ALL, &LayerMean::NAMES, &mut r.layer_mean);
    take(v, "wetted_length", &WettedLength::ALL, &WettedLength::NAMES, &mut r.wetted_length);
    take(v, "displaced", &Displaced::ALL, &Displaced::NAMES, &mut r.displaced);
    take(v, "hydrostatics", &Hydrostatics::ALL, &Hydrostatics::NAMES, &mut r.hydrostatics);
    take(v, "support", &Support::ALL, &Support::NAMES, &mut r.support);
    r
}

/// Sets an option to what its word at `key` means, if there is one.
fn take<T: Copy>(v: &Values, key: &str, all: &[T], names: &[&str], out: &mut T) {
    let word = v.word(&format!("model.{key}"));
    if let Some((one, _)) = all.iter().zip(names).find(|(_, name)| word == Some(**name)) {
        *out = *one;
    }
}
