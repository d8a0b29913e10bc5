//! A tree read against the format: one typed value in SI a dotted key.

use std::collections::HashMap;

use hydrostat::profile::TableError;
use hydrostat::{ArmError, Join, Profile};

use crate::document::{Entry, Field, Node, Origin, segment};
use crate::format::{
    self, COEFFICIENTS, DRAG, ENDS, HOMOGENEOUS, JOINED, Key, Kind, MAX_CABLES, MAX_POINTS, PULL, RATE, SPACES,
};
use crate::quantity::Dimension;

/// What is wrong, without the names of files.
#[derive(Debug)]
pub(crate) struct Fault {
    pub(crate) origin: Origin,
    pub(crate) key: String,
    pub(crate) kind: FaultKind,
}

#[derive(Debug)]
pub(crate) enum FaultKind {
    Unknown { expected: String, suggestion: Option<String> },
    Missing { expected: String },
    Value { expected: String, found: String },
    Arm(ArmError),
}

/// A value in SI, angles in rad.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Text(String),
    Word(&'static str),
    Number(f64),
    Flag(bool),
    Pair([f64; 2]),
    Triple([f64; 3]),
    Profile(Profile),
    Profiles([Profile; 2]),
    ThreeProfiles(Box<[Profile; 3]>),
    /// A table that is there.
    Group,
}

/// The most that is said of one file: who has more mends these first.
pub(crate) const MOST_FAULTS: usize = 50;

/// A radius (m) within which every offset is.
const WIDE: f64 = 1e9;

/// What is asked of several keys of a table at once.
type Check = fn(&Values) -> Vec<Fault>;

/// All values of a file by dotted key, where they were written, and what is wrong with the others.
#[derive(Debug, Default)]
pub(crate) struct Values {
    found: HashMap<String, (Value, Origin)>,
    faults: Vec<Fault>,
    /// How many cables there are.
    pub(crate) cables: usize,
}

impl Values {
    /// Reads a file's fields, in which no value is relative to others any more: see [`crate::relative::resolved`].
    pub(crate) fn read(fields: &[Field]) -> Self {
        let mut values = Self::default();
        values.table("", format::FILE, fields, Origin::Text(0));
        // What a key of a table should be is open while another is wrong.
        let checks: [(&str, Check); 6] = [
            ("material", |values| values.check_material().err().into_iter().collect()),
            ("flow", Self::check_drag),
            ("cable", Self::check_pull),
            ("arm", |values| values.check_base().err().into_iter().collect()),
            ("arm.space", |values| values.check_space().err().into_iter().collect()),
            ("dynamics", |values| values.check_rate().err().into_iter().collect()),
        ];
        for (table, check) in checks {
            if !values.is_faulty(table) {
                values.faults.extend(check(&values));
            }
        }
        values
    }

    /// What is wrong, in the order in which it was met.
    pub(crate) fn into_faults(self) -> Vec<Fault> {
        self.faults
    }

    /// What was wrong first, if anything was.
    pub(crate) fn take_first_fault(&mut self) -> Option<Fault> {
        (!self.faults.is_empty()).then(|| self.faults.swap_remove(0))
    }

    /// Whether a key, or one below it, is wrong.
    pub(crate) fn is_faulty(&self, key: &str) -> bool {
        self.faults.iter().any(|fault| {
            fault.key.strip_prefix(key).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        })
    }

    /// Whether a key, or the value that it is a part of, was read.
    pub(crate) fn is_read(&self, key: &str) -> bool {
        let mut key = key;
        loop {
            match (self.found.get(key), key.rfind(['.', '['])) {
                (Some((value, _)), _) => return *value != Value::Group,
                (None, Some(end)) => key = &key[..end],
                (None, None) => return false,
            }
        }
    }

    /// Takes a value out that the core refuses, so that it can be asked about the others; false where nothing is left to
    /// take out.
    pub(crate) fn set_aside(&mut self, key: &str) -> bool {
        // What an arm cannot be without gets a value beside which all others are right.
        let stand_in = match key {
            "arm.length" | "material.young" => Value::Number(1.0),
            "arm.radius" => Value::Profile(Profile::Constant(WIDE)),
            "material.c1" | "material.c2" | "material.c3" | "reference.nu" => Value::Profile(Profile::Constant(1.0)),
            _ => return self.take_out(key),
        };
        let origin = self.origin(key);
        let before = self.found.insert(key.to_owned(), (stand_in.clone(), origin));
        before.is_none_or(|(before, _)| before != stand_in)
    }

    fn take_out(&mut self, key: &str) -> bool {
        let mut key = key;
        loop {
            match self.found.get_mut(key) {
                Some((Value::Group, _)) => return false,
                // The default of an offset need not be inside the section.
                Some((Value::Profile(profile), _)) => {
                    let changed = *profile != Profile::Constant(0.0);
                    *profile = Profile::Constant(0.0);
                    return changed;
                }
                Some(_) => return self.found.remove(key).is_some(),
                None => match key.rfind(['.', '[']) {
                    Some(end) => key = &key[..end],
                    None => return false,
                },
            }
        }
    }

    /// A profile, where it is one.
    pub(crate) fn profile_of(&mut self, dimension: Dimension, entry: &Entry) -> Option<Profile> {
        self.profile_at("", Kind::Profile(dimension), dimension, entry).ok()
    }

    /// Where `key` was written, or else the nearest table around it.
    pub(crate) fn origin(&self, key: &str) -> Origin {
        let mut key = key;
        loop {
            if let Some((_, origin)) = self.found.get(key) {
                return *origin;
            }
            match key.rfind(['.', '[']) {
                Some(end) => key = &key[..end],
                None => return Origin::Text(0),
            }
        }
    }

    pub(crate) fn has(&self, key: &str) -> bool {
        self.found.contains_key(key)
    }

    pub(crate) fn text(&self, key: &str) -> Option<String> {
        match self.found.get(key) {
            Some((Value::Text(text), _)) => Some(text.clone()),
            _ => None,
        }
    }

    pub(crate) fn word(&self, key: &str) -> Option<&'static str> {
        match self.found.get(key) {
            Some((Value::Word(word), _)) => Some(word),
            _ => None,
        }
    }

    pub(crate) fn number(&self, key: &str) -> Option<f64> {
        match self.found.get(key) {
            Some((Value::Number(value), _)) => Some(*value),
            _ => None,
        }
    }

    pub(crate) fn flag(&self, key: &str) -> Option<bool> {
        match self.found.get(key) {
            Some((Value::Flag(flag), _)) => Some(*flag),
            _ => None,
        }
    }

    pub(crate) fn profile(&self, key: &str) -> Option<Profile> {
        match self.found.get(key) {
            Some((Value::Profile(profile), _)) => Some(profile.clone()),
            _ => None,
        }
    }

    pub(crate) fn profiles(&self, key: &str) -> Option<[Profile; 2]> {
        match self.found.get(key) {
            Some((Value::Profiles(profiles), _)) => Some(profiles.clone()),
            _ => None,
        }
    }

    fn table(&mut self, path: &str, keys: &'static [Key], fields: &[Field], at: Origin) {
        let mut meant: Vec<String> = Vec::new();
        for field in fields {
            if self.faults.len() >= MOST_FAULTS {
                return;
            }
            let here = join(path, &field.name);
            let read = match keys.iter().find(|k| k.name == field.name) {
                Some(key) => self.value(&here, key.kind, &field.entry),
                None => Err(unknown(field.origin, here, &field.name, keys)),
            };
            if let Err(fault) = read {
                if let FaultKind::Unknown { suggestion: Some(suggestion), .. } = &fault.kind {
                    meant.push(suggestion.clone());
                }
                self.faults.push(fault);
            }
        }
        for key in keys.iter().filter(|k| k.required) {
            let here = join(path, key.name);
            // A key that is there under a wrong name is not missing as well.
            let is_meant = meant.iter().any(|one| one == key.name || one.starts_with(&here));
            if !is_meant && !fields.iter().any(|f| f.name == key.name) {
                let expected = key.kind.expected();
                self.faults.push(Fault { origin: at, key: here, kind: FaultKind::Missing { expected } });
            }
        }
    }

    fn value(&mut self, path: &str, kind: Kind, entry: &Entry) -> Result<(), Fault> {
        let value = match (kind, &entry.node) {
            (Kind::Text, Node::Text(text)) if text.chars().count() <= format::MAX_NAME => Value::Text(text.clone()),
            (Kind::Choice(words), Node::Text(text)) => match words.iter().find(|w| *w == text) {
                Some(word) => Value::Word(word),
                None => return Err(refuse(path, kind, entry)),
            },
            (Kind::Flag, Node::Boolean(flag)) => Value::Flag(*flag),
            (Kind::Quantity(dimension), _) => Value::Number(quantity(path, dimension, entry)?),
            (Kind::Axial(dimension), Node::Number(_) | Node::Text(_)) => {
                Value::Number(quantity(path, dimension, entry)?)
            }
            (Kind::Heading, Node::Number(_) | Node::Text(_)) => Value::Number(quantity(path, Dimension::Angle, entry)?),
            (Kind::Pair(dimension) | Kind::Axial(dimension), Node::Array(entries)) if entries.len() == 3 => {
                Value::Triple(triple(path, dimension, entries)?)
            }
            (Kind::Heading | Kind::Direction, Node::Array(entries)) if entries.len() == 3 => {
                Value::Triple(triple(path, Dimension::Number, entries)?)
            }
            (Kind::Pair(dimension), Node::Array(entries)) => match entries.as_slice() {
                [a, b] => Value::Pair([
                    quantity(&format!("{path}[0]"), dimension, a)?,
                    quantity(&format!("{path}[1]"), dimension, b)?,
                ]),
                _ => return Err(refuse(path, kind, entry)),
            },
            (Kind::Part, Node::Number(_)) => Value::Number(quantity(path, Dimension::Number, entry)?),
            (Kind::Part, Node::Text(text)) => {
                let tip = if text.trim() == "tip" { "; at the tip it is 1.0" } else { "" };
                let found = format!("{}{tip}", entry.node.describe());
                return Err(value_fault(path, entry.origin, kind.expected(), found));
            }
            (Kind::Profile(dimension) | Kind::Offset(dimension), _) => {
                Value::Profile(self.profile_at(path, kind, dimension, entry)?)
            }
            (Kind::AxialProfile(dimension), Node::Array(entries))
                if entries.len() == 3 && !entries.iter().all(is_point) =>
            {
                Value::ThreeProfiles(Box::new(self.three_profiles(path, dimension, entries)?))
            }
            (Kind::AxialProfile(dimension), _) => Value::Profile(self.profile_at(path, kind, dimension, entry)?),
            (Kind::ProfilePair(dimension), Node::Array(entries)) if entries.len() == 3 => {
                Value::ThreeProfiles(Box::new(self.three_profiles(path, dimension, entries)?))
            }
            (Kind::ProfilePair(dimension), Node::Array(entries)) => match entries.as_slice() {
                [a, b] => Value::Profiles([
                    self.profile_at(&format!("{path}[0]"), Kind::Profile(dimension), dimension, a)?,
                    self.profile_at(&format!("{path}[1]"), Kind::Profile(dimension), dimension, b)?,
                ]),
                _ => return Err(refuse(path, kind, entry)),
            },
            (Kind::Table(keys), Node::Table(fields)) => {
                self.table(path, keys, fields, entry.origin);
                Value::Group
            }
            (Kind::Tables(keys), Node::Array(entries)) => {
                if entries.len() > MAX_CABLES {
                    let expected = format!("at most {MAX_CABLES} cables");
                    return Err(value_fault(path, entry.origin, expected, format!("{}", entries.len())));
                }
                for (i, element) in entries.iter().enumerate() {
                    let here = format!("{path}[{i}]");
                    let Node::Table(fields) = &element.node else {
                        self.faults.push(refuse(&here, Kind::Table(keys), element));
                        continue;
                    };
                    self.table(&here, keys, fields, element.origin);
                    self.found.insert(here, (Value::Group, element.origin));
                }
                self.cables = entries.len();
                Value::Group
            }
            _ => return Err(refuse(path, kind, entry)),
        };
        self.found.insert(path.to_owned(), (value, entry.origin));
        Ok(())
    }

    fn three_profiles(&mut self, path: &str, dimension: Dimension, entries: &[Entry]) -> Result<[Profile; 3], Fault> {
        let mut out = [0.0, 0.0, 0.0].map(Profile::Constant);
        for (k, (out, entry)) in out.iter_mut().zip(entries).enumerate() {
            *out = self.profile_at(&format!("{path}[{k}]"), Kind::Profile(dimension), dimension, entry)?;
        }
        Ok(out)
    }

    /// `kind` is that of the profile, whose values are of `dimension`.
    fn profile_at(&mut self, path: &str, kind: Kind, dimension: Dimension, entry: &Entry) -> Result<Profile, Fault> {
        let profile = match &entry.node {
            Node::Table(fields) if fields.iter().any(|field| JOINED.contains(&field.name.as_str())) => {
                joined(path, dimension, entry, fields)?
            }
            Node::Table(fields) => {
                let mut ends = [None; 2];
                for field in fields {
                    let here = join(path, &field.name);
                    let Some(end) = ENDS.iter().position(|e| *e == field.name) else {
                        let expected = "base and tip".to_owned();
                        let suggestion = format::nearest(&field.name, ENDS.into_iter()).map(str::to_owned);
                        let kind = FaultKind::Unknown { expected, suggestion };
                        return Err(Fault { origin: field.origin, key: here, kind });
                    };
                    ends[end] = Some(quantity(&here, dimension, &field.entry)?);
                }
                let missing = |name: &str| Fault {
                    origin: entry.origin,
                    key: join(path, name),
                    kind: FaultKind::Missing { expected: dimension.expected() },
                };
                Profile::linear(ends[0].ok_or_else(|| missing("base"))?, ends[1].ok_or_else(|| missing("tip"))?)
            }
            Node::Array(points) => profile_table(path, dimension, entry, points, Join::Cubic)?,
            Node::Number(_) | Node::Text(_) => {
                quantity(path, dimension, entry).map(Profile::Constant).map_err(|fault| match fault.kind {
                    FaultKind::Value { found, .. } => value_fault(path, entry.origin, kind.expected(), found),
                    _ => fault,
                })?
            }
            _ => return Err(refuse(path, kind, entry)),
        };
        // Under its own key as well, because the core names the two profiles of a pair one by one.
        self.found.insert(path.to_owned(), (Value::Profile(profile.clone()), entry.origin));
        Ok(profile)
    }

    /// Three numbers in space; of two the third is zero.
    pub(crate) fn triple(&self, key: &str) -> Option<[f64; 3]> {
        match self.found.get(key) {
            Some((Value::Triple(triple), _)) => Some(*triple),
            Some((Value::Pair([x, y]), _)) => Some([*x, *y, 0.0]),
            _ => None,
        }
    }

    /// Three profiles in space.
    pub(crate) fn three(&self, key: &str) -> Option<[Profile; 3]> {
        match self.found.get(key) {
            Some((Value::ThreeProfiles(three), _)) => Some((**three).clone()),
            _ => None,
        }
    }

    /// Whether the arm may leave the plane.
    pub(crate) fn is_spatial(&self) -> bool {
        self.word("arm.space") == Some(SPACES[1])
    }

    /// One way to give the directions of the base, and C4 with the other coefficients.
    fn check_base(&self) -> Result<(), Fault> {
        let angle = "arm.base.angle";
        let directions = ["arm.base.direction", "arm.base.section"];
        if self.has(angle)
            && let Some(key) = directions.into_iter().find(|key| self.has(key))
        {
            let expected = "either angle or direction and section".to_owned();
            return Err(value_fault(key, self.origin(key), expected, "both".to_owned()));
        }
        if self.has(directions[1]) && !self.has(directions[0]) {
            let kind = FaultKind::Missing { expected: "the direction of a, with section".to_owned() };
            return Err(Fault { origin: self.origin(directions[1]), key: directions[0].to_owned(), kind });
        }
        if self.has("material.c4") && !self.has("material.c1") {
            let expected = "c4 with c1, c2 and c3 (from young and poisson it follows)".to_owned();
            return Err(value_fault("material.c4", self.origin("material.c4"), expected, "it without them".to_owned()));
        }
        Ok(())
    }

    /// Nothing leaves the plane of an arm in the plane.
    fn check_space(&self) -> Result<(), Fault> {
        if self.is_spatial() {
            return Ok(());
        }
        let leaves = |key: &str, value: &Value| {
            matches!(value, Value::Triple(_) | Value::ThreeProfiles(_))
                || OUT_OF_PLANE.contains(&key)
                || (key.starts_with("cable[") && key.ends_with("].angle"))
        };
        let mut keys: Vec<&String> =
            self.found.iter().filter(|(key, (value, _))| leaves(key, value)).map(|(key, _)| key).collect();
        keys.sort();
        keys.first().map_or(Ok(()), |key| {
            let source = ArmError::OutOfPlane { key: (*key).clone() };
            Err(Fault { origin: self.origin(key), key: (*key).clone(), kind: FaultKind::Arm(source) })
        })
    }

    /// One way to give the stiffness, and the whole of it.
    fn check_material(&self) -> Result<(), Fault> {
        let given =
            |names: [&str; 3]| names.into_iter().map(|n| format!("material.{n}")).filter(|k| self.has(k)).collect();
        let (homogeneous, coefficients): (Vec<String>, Vec<String>) = (given(HOMOGENEOUS), given(COEFFICIENTS));
        let missing = |name: &str, expected: String| Fault {
            origin: self.origin("material"),
            key: format!("material.{name}"),
            kind: FaultKind::Missing { expected },
        };
        match (homogeneous.first(), coefficients.first()) {
            (Some(_), Some(_)) => {
                // An override is what the user can mend soonest.
                let both = coefficients.iter().chain(&homogeneous);
                let by_setting = |k: &&String| matches!(self.origin(k), Origin::Setting(_));
                let key = both.clone().find(by_setting).unwrap_or(&coefficients[0]);
                let expected = "either young, poisson, shear_factor or c1, c2, c3".to_owned();
                let all: Vec<&str> = both.map(|k| k.trim_start_matches("material.")).collect();
                Err(value_fault(key, self.origin(key), expected, format!("{} together", all.join(", "))))
            }
            (None, Some(_)) => match COEFFICIENTS.into_iter().find(|n| !self.has(&format!("material.{n}"))) {
                Some(name) => {
                    let expected = "c1, c2 and c3 together".to_owned();
                    Err(missing(name, expected))
                }
                None => Ok(()),
            },
            _ if self.has("material.young") => Ok(()),
            _ => {
                let expected = format!("{}, or c1, c2 and c3", Dimension::Pressure.expected());
                Err(missing("young", expected))
            }
        }
    }

    /// A file gives a cable a tension or a stroke; an override of one takes the place of the other.
    fn check_pull(&self) -> Vec<Fault> {
        let by_setting = |key: &str| matches!(self.origin(key), Origin::Setting(_));
        let twice = |index: usize| {
            let [tension, stroke] = PULL.map(|name| format!("cable[{index}].{name}"));
            let is_twice = self.has(&tension) && self.has(&stroke) && by_setting(&tension) == by_setting(&stroke);
            let expected = || "either tension or stroke".to_owned();
            is_twice.then(|| value_fault(&stroke, self.origin(&stroke), expected(), "both".to_owned()))
        };
        (0..self.cables).filter_map(twice).collect()
    }

    /// Whether cable `index` is given by its stroke.
    pub(crate) fn has_stroke(&self, index: usize) -> bool {
        let [tension, stroke] = PULL.map(|name| format!("cable[{index}].{name}"));
        let overridden = self.has(&tension) && matches!(self.origin(&tension), Origin::Setting(_));
        self.has(&stroke) && !overridden
    }

    /// A file gives a relaxation time or a viscosity; an override of one takes the place of the other. A viscosity is one
    /// time only where C1 is one number.
    fn check_rate(&self) -> Result<(), Fault> {
        let [time, viscosity] = RATE.map(|name| format!("dynamics.{name}"));
        let by_setting = |key: &str| matches!(self.origin(key), Origin::Setting(_));
        if self.has(&time) && self.has(&viscosity) && by_setting(&time) == by_setting(&viscosity) {
            let expected = "either relaxation_time or viscosity".to_owned();
            return Err(value_fault(&viscosity, self.origin(&viscosity), expected, "both".to_owned()));
        }
        if self.has_viscosity() && self.profile("material.c1").is_some_and(|c1| !matches!(c1, Profile::Constant(_))) {
            let expected = "relaxation_time, as c1 varies along the arm".to_owned();
            return Err(value_fault(&viscosity, self.origin(&viscosity), expected, "viscosity".to_owned()));
        }
        Ok(())
    }

    /// Whether the material's rate is given by a viscosity.
    pub(crate) fn has_viscosity(&self) -> bool {
        let [time, viscosity] = RATE.map(|name| format!("dynamics.{name}"));
        let overridden = self.has(&time) && matches!(self.origin(&time), Origin::Setting(_));
        self.has(&viscosity) && !overridden
    }

    fn check_drag(&self) -> Vec<Fault> {
        if self.word("flow.law") != Some("quadratic-drag") {
            return Vec::new();
        }
        let missing = DRAG.into_iter().map(|n| format!("flow.{n}")).filter(|k| !self.has(k));
        let fault = |key: String| {
            let expected = format!("{} with law = \"quadratic-drag\"", Dimension::Number.expected());
            Fault { origin: self.origin("flow.law"), key, kind: FaultKind::Missing { expected } }
        };
        missing.map(fault).collect()
    }
}

/// Keys that only arms in space have.
const OUT_OF_PLANE: [&str; 7] = [
    "arm.base.direction",
    "arm.base.section",
    "arm.base.z",
    "material.c4",
    "reference.kappa",
    "reference.tau",
    "reference.zeta",
];

/// Three numbers.
fn triple(path: &str, dimension: Dimension, entries: &[Entry]) -> Result<[f64; 3], Fault> {
    let mut out = [0.0; 3];
    for (k, (out, entry)) in out.iter_mut().zip(entries).enumerate() {
        *out = quantity(&format!("{path}[{k}]"), dimension, entry)?;
    }
    Ok(out)
}

/// Whether an entry is a point [s, value] of a table, not a profile.
fn is_point(entry: &Entry) -> bool {
    match &entry.node {
        Node::Array(pair) => pair.len() == 2 && pair.iter().all(|e| matches!(e.node, Node::Number(_) | Node::Text(_))),
        _ => false,
    }
}

/// A profile of points, with how they are joined.
fn joined(path: &str, dimension: Dimension, entry: &Entry, fields: &[Field]) -> Result<Profile, Fault> {
    let (mut points, mut way) = (None, Join::Cubic);
    for field in fields {
        let here = join(path, &field.name);
        match (field.name.as_str(), &field.entry.node) {
            ("points", Node::Array(all)) => points = Some((&field.entry, all)),
            ("join", Node::Text(word)) if Join::NAMES.contains(&word.as_str()) => {
                way = Join::ALL.into_iter().find(|join| join.name() == word).unwrap_or_default();
            }
            ("points", node) => {
                return Err(value_fault(&here, field.origin, "points [[s, value], ...]".to_owned(), node.describe()));
            }
            ("join", _) => return Err(refuse(&here, Kind::Choice(&Join::NAMES), &field.entry)),
            (name, _) => {
                let suggestion = format::nearest(name, JOINED.into_iter()).map(str::to_owned);
                let kind = FaultKind::Unknown { expected: "points and join".to_owned(), suggestion };
                return Err(Fault { origin: field.origin, key: here, kind });
            }
        }
    }
    let Some((own, points)) = points else {
        let kind = FaultKind::Missing { expected: "points [[s, value], ...]".to_owned() };
        return Err(Fault { origin: entry.origin, key: join(path, "points"), kind });
    };
    profile_table(path, dimension, own, points, way)
}

fn profile_table(
    path: &str,
    dimension: Dimension,
    entry: &Entry,
    points: &[Entry],
    way: Join,
) -> Result<Profile, Fault> {
    if points.len() > MAX_POINTS {
        let expected = format!("at most {MAX_POINTS} points");
        return Err(value_fault(path, entry.origin, expected, format!("{}", points.len())));
    }
    let mut pairs = Vec::with_capacity(points.len());
    for (i, point) in points.iter().enumerate() {
        let here = format!("{path}[{i}]");
        match &point.node {
            Node::Array(pair) if pair.len() == 2 => pairs.push([
                quantity(&format!("{here}[0]"), Dimension::Length, &pair[0])?,
                quantity(&format!("{here}[1]"), dimension, &pair[1])?,
            ]),
            other => {
                let expected = "a point [s, value]".to_owned();
                return Err(value_fault(&here, point.origin, expected, other.describe()));
            }
        }
    }
    Profile::joined(&pairs, way).map_err(|source| {
        let (origin, key) = match &source {
            TableError::NotFinite { index, .. } | TableError::NotIncreasing { index, .. } => {
                (points[*index].origin, format!("{path}[{index}]"))
            }
            TableError::TooShort { .. } => (entry.origin, path.to_owned()),
        };
        Fault { origin, kind: FaultKind::Arm(ArmError::Table { key: key.clone(), source }), key }
    })
}

/// `name` under `path`.
pub(crate) fn join(path: &str, name: &str) -> String {
    if path.is_empty() { segment(name) } else { format!("{path}.{}", segment(name)) }
}

/// A key that is not in `keys`, with the one that was probably meant.
pub(crate) fn unknown(origin: Origin, path: String, name: &str, keys: &'static [Key]) -> Fault {
    let near = || format::nearest(name, keys.iter().map(|k| k.name));
    let suggestion = format::synonym(name).or_else(near).map(str::to_owned).or_else(|| format::home_of(name));
    let expected = format!("one of {}", format::names(keys));
    Fault { origin, key: path, kind: FaultKind::Unknown { expected, suggestion } }
}

pub(crate) fn value_fault(key: &str, origin: Origin, expected: String, found: String) -> Fault {
    Fault { origin, key: key.to_owned(), kind: FaultKind::Value { expected, found } }
}

fn refuse(path: &str, kind: Kind, entry: &Entry) -> Fault {
    value_fault(path, entry.origin, kind.expected(), entry.node.describe())
}

/// A number, where it is one.
pub(crate) fn quantity_at(dimension: Dimension, entry: &Entry) -> Option<f64> {
    quantity("", dimension, entry).ok()
}

fn quantity(path: &str, dimension: Dimension, entry: &Entry) -> Result<f64, Fault> {
    let refused = |found: String| value_fault(path, entry.origin, dimension.expected(), found);
    match &entry.node {
        Node::Number(value) if value.is_finite() => Ok(dimension.bare(*value)),
        Node::Number(_) => Err(refused(format!("{}, which is not finite", entry.node.describe()))),
        Node::Text(text) => dimension.parse(text).map_err(|e| refused(format!("{}: {e}", entry.node.describe()))),
        other => Err(refused(other.describe())),
    }
}
