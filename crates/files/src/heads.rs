//! Heads of columns: plain identifiers with the unit at their end, such as `flow_speed_m_s` and `cable_0_tension_N`, which databases and data
//! frames take as they are; and keys of the arm file read back from them.

use crate::format::{self, FILE, Key, Kind, dimension_at, is_key};
use crate::quantity::Dimension;

/// A name, such as a key of the arm file, and its unit as the head of a column.
///
/// ```
/// use hydrostat_files::head_of;
///
/// assert_eq!(head_of("flow.speed", "m/s"), "flow_speed_m_s");
/// assert_eq!(head_of("stroke[0]", "m"), "stroke_0_m");
/// assert_eq!(head_of("reference.mu", "1/m"), "reference_mu_per_m");
/// assert_eq!(head_of("base moment", "N mm"), "base_moment_Nmm");
/// assert_eq!(head_of("model.volume", ""), "model_volume");
/// ```
pub fn head_of(name: &str, unit: &str) -> String {
    let name = identifier(name);
    if unit.is_empty() { name } else { format!("{name}_{}", unit_in_head(unit)) }
}

/// A name with `_` for all that is no letter and no digit.
pub(crate) fn identifier(name: &str) -> String {
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("_")
}

fn unit_in_head(unit: &str) -> String {
    let unit = unit.replace("1/", "per_").replace('/', "_");
    unit.chars().filter(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// The head that a column has now, of one that earlier versions wrote: `flow_speed_m_s` of `flow.speed_m_per_s`.
///
/// ```
/// use hydrostat_files::head_now;
///
/// assert_eq!(head_now("flow.speed_m_per_s"), "flow_speed_m_s");
/// assert_eq!(head_now("shape_x[3]_m"), "shape_x_3_m");
/// assert_eq!(head_now("arm.density_kg_per_m3"), "arm_density_kg_m3");
/// assert_eq!(head_now("mu_per_m"), "mu_per_m");
/// ```
pub fn head_now(old: &str) -> String {
    let mut out = identifier(old);
    for unit in ["_m", "_kg", "_N", "_Nm"] {
        out = out.replace(&format!("{unit}_per_"), &format!("{unit}_"));
    }
    out
}

/// A head as name and unit, in every way in which it can be read: `x [mm]`, `x_mm`, or a name alone, the longest name first.
pub(crate) fn readings(head: &str) -> Vec<(&str, &str)> {
    if let Some((name, unit)) = head.strip_suffix(']').and_then(|rest| rest.rsplit_once('['))
        && !unit.trim().bytes().all(|byte| byte.is_ascii_digit())
    {
        return vec![(name.trim(), unit.trim())];
    }
    let ends = head.match_indices('_').map(|(at, _)| at).rev();
    std::iter::once((head, "")).chain(ends.map(|at| (&head[..at], &head[at + 1..]))).collect()
}

/// The unit of a dimension that stands in a head: as it is, or with what an identifier has in place of its signs.
pub(crate) fn unit_of(dimension: Dimension, found: &str) -> Option<&'static str> {
    let is_it = |known: &str| {
        let old = known.replace("1/", "per_").replace('/', "_per_");
        known == found
            || unit_in_head(known) == found
            || old.replace(' ', "") == found
            || known.replace([' ', '/'], "_") == found
    };
    dimension.spellings().find(|known| is_it(known))
}

/// The key of the arm file that a name of a column means, as `cable[0].tension` or as `cable_0_tension`.
pub(crate) fn key_named(name: &str) -> Option<String> {
    if name.contains('.') && is_key(name) { Some(name.to_owned()) } else { key_in(FILE, name) }
}

/// The key of the arm file whose column has this head, of any version, with what it measures.
///
/// ```
/// use hydrostat_files::{Dimension, key_of_head};
///
/// let key = |head: &str| key_of_head(head).map(|(key, _)| key);
/// assert_eq!(key("cable_0_tension_N").as_deref(), Some("cable[0].tension"));
/// assert_eq!(key("cable[0].tension_N").as_deref(), Some("cable[0].tension"));
/// assert_eq!(key_of_head("flow_speed_m_s"), Some(("flow.speed".to_owned(), Some(Dimension::Speed))));
/// assert_eq!((key("arm_radius_1_0_m").as_deref(), key("tip_x_m")), (Some("arm.radius[1][0]"), None));
/// ```
pub fn key_of_head(head: &str) -> Option<(String, Option<Dimension>)> {
    readings(head).into_iter().find_map(|(name, unit)| {
        let key = key_named(name)?;
        let dimension = dimension_at(&key);
        let fits = match dimension {
            None | Some(Dimension::Number) => unit.is_empty(),
            Some(dimension) => unit_of(dimension, unit).is_some(),
        };
        fits.then_some((key, dimension))
    })
}

fn key_in(keys: &[Key], text: &str) -> Option<String> {
    keys.iter().find_map(|key| {
        let rest = text.strip_prefix(key.name)?;
        let rest = if rest.is_empty() { None } else { Some(rest.strip_prefix('_')?) };
        match key.kind {
            Kind::Text | Kind::Choice(_) | Kind::Flag | Kind::Quantity(_) | Kind::Part => {
                rest.is_none().then(|| key.name.to_owned())
            }
            Kind::Axial(_) | Kind::Heading => match rest {
                None => Some(key.name.to_owned()),
                Some(index) => Some(format!("{}[{}]", key.name, number(index)?)),
            },
            Kind::Table(inner) => Some(format!("{}.{}", key.name, key_in(inner, rest?)?)),
            Kind::Tables(inner) => {
                let (index, rest) = rest?.split_once('_')?;
                Some(format!("{}[{}].{}", key.name, number(index)?, key_in(inner, rest)?))
            }
            Kind::Pair(_) | Kind::Direction => Some(format!("{}[{}]", key.name, number(rest?)?)),
            Kind::Profile(_) | Kind::Offset(_) => in_profile(key.name.to_owned(), rest),
            Kind::AxialProfile(_) => in_profile(key.name.to_owned(), rest).or_else(|| in_component(key.name, rest?)),
            Kind::ProfilePair(_) => in_component(key.name, rest?),
        }
    })
}

/// What is left of a key behind that of a profile: nothing, one of its ends, or a number of its table.
fn in_profile(key: String, rest: Option<&str>) -> Option<String> {
    match rest {
        None => Some(key),
        Some(end) if format::ENDS.contains(&end) => Some(format!("{key}.{end}")),
        Some(point) => {
            let (point, part) = point.split_once('_')?;
            Some(format!("{key}[{}][{}]", number(point)?, number(part)?))
        }
    }
}

/// The same behind the index of one of two or three profiles.
fn in_component(key: &str, rest: &str) -> Option<String> {
    let (index, rest) = rest.split_once('_').map_or((rest, None), |(index, rest)| (index, Some(rest)));
    in_profile(format!("{key}[{}]", number(index)?), rest)
}

fn number(text: &str) -> Option<usize> {
    text.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every key of the format, with indices where it has them.
    fn keys(keys: &[Key], path: &str, out: &mut Vec<String>) {
        for key in keys {
            let here = if path.is_empty() { key.name.to_owned() } else { format!("{path}.{}", key.name) };
            match key.kind {
                Kind::Text | Kind::Choice(_) | Kind::Flag | Kind::Quantity(_) | Kind::Part => out.push(here),
                Kind::Axial(_) | Kind::Heading => out.extend(["", "[2]"].map(|end| format!("{here}{end}"))),
                Kind::Table(inner) => self::keys(inner, &here, out),
                Kind::Tables(inner) => self::keys(inner, &format!("{here}[12]"), out),
                Kind::Pair(_) | Kind::Direction => out.push(format!("{here}[1]")),
                Kind::Profile(_) | Kind::Offset(_) | Kind::AxialProfile(_) | Kind::ProfilePair(_) => {
                    let alone = ["", ".base", ".tip", "[3][0]", "[3][1]"];
                    let of_components = ["[0]", "[1].tip", "[1][2][1]"];
                    let ends = match key.kind {
                        Kind::AxialProfile(_) => [&alone[..], &of_components].concat(),
                        Kind::ProfilePair(_) => of_components.to_vec(),
                        _ => alone.to_vec(),
                    };
                    out.extend(ends.into_iter().map(|end| format!("{here}{end}")));
                }
            }
        }
    }

    /// Plain identifiers, no two the same, that are read as the key and in the unit that they were written of.
    #[test]
    fn every_key_of_the_format_comes_back_from_its_head() {
        let mut all = Vec::new();
        keys(FILE, "", &mut all);
        let mut heads: Vec<String> = Vec::new();
        for key in &all {
            let dimension = dimension_at(key);
            let units = dimension.map_or(vec![""], Dimension::units_shown);
            for unit in if units.is_empty() { vec![""] } else { units } {
                let head = head_of(key, unit);
                assert!(head.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_'), "{head}");
                assert_eq!(key_of_head(&head), Some((key.clone(), dimension)), "{head}");
                assert_eq!(head_now(&head), head);
                heads.push(head);
            }
        }
        let count = heads.len();
        heads.sort();
        heads.dedup();
        assert!(heads.len() == count && count > 200, "{count}");
    }

    #[test]
    fn heads_are_read_in_brackets_and_as_identifiers() {
        assert_eq!(readings("x [mm]"), [("x", "mm")]);
        assert_eq!(readings("x[mm]"), [("x", "mm")]);
        assert_eq!(readings("stroke[0]"), [("stroke[0]", "")]);
        assert_eq!(readings("sd_x_mm"), [("sd_x_mm", ""), ("sd_x", "mm"), ("sd", "x_mm")]);
        for (dimension, found, unit) in [
            (Dimension::Speed, "m_s", Some("m/s")),
            (Dimension::Speed, "m_per_s", Some("m/s")),
            (Dimension::Speed, "km/h", Some("km/h")),
            (Dimension::Moment, "Nmm", Some("N mm")),
            (Dimension::Moment, "N_mm", Some("N mm")),
            (Dimension::Curvature, "per_m", Some("1/m")),
            (Dimension::Length, "N", None),
        ] {
            assert_eq!(unit_of(dimension, found), unit, "{found}");
        }
        for none in ["tip_x_m", "cable_tension_N", "cable_0_tension_mm", "flow_speed", "row", ""] {
            assert_eq!(key_of_head(none), None, "{none}");
        }
    }
}
