//! Numbers that look like a slip of the unit: an arm of 300 m, a modulus of 70 Pa.

use std::f64::consts::{PI, TAU};
use std::fmt;

use hydrostat::{Arm, Cable, Material, Parameter};

use crate::digits::number;

/// A number that was hardly meant as it stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Slip {
    /// The dotted key.
    pub key: String,
    /// The number with its unit: `300 m`.
    pub found: String,
    /// What it would do, where that is what is wrong with it; else empty.
    pub effect: String,
    /// The unit that may have been meant.
    pub unit: &'static str,
}

impl fmt::Display for Slip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}{}: is it {}?", self.key, self.found, self.effect, self.unit)
    }
}

impl Slip {
    fn new(key: impl Into<String>, value: f64, own: &str, unit: &'static str) -> Self {
        Self { key: key.into(), found: format!("{} {own}", number(value)), effect: String::new(), unit }
    }
}

/// Turns of the tip, as a linear beam would make them, from which a pull looks like a slip. The shipped arms make 2 to 30 at the largest
/// tension that they carry.
const PULLED: f64 = 100.0;
/// Turns from which a moment or a force on the tip looks like one.
const TURNED: f64 = 20.0;
/// Turns from which a load is worth a question where no equilibrium was found.
const DOUBTED: f64 = 2.0;

/// All numbers of an arm that look like a slip of the unit, geometry first. They are still an arm: nothing is refused.
///
/// ```
/// use hydrostat::Arm;
///
/// let slips = hydrostat_files::unit_slips(&Arm::cone(300.0, 0.010, 0.002, 110e3, 0.5));
/// assert_eq!(slips[0].to_string(), "arm.length = 300 m: is it mm?");
/// assert!(hydrostat_files::unit_slips(&Arm::cone(0.3, 0.010, 0.002, 110e3, 0.5)).is_empty());
/// ```
pub fn unit_slips(arm: &Arm) -> Vec<Slip> {
    let mut out = geometry(arm);
    out.extend(material(arm));
    out.extend(surroundings(arm));
    // An arm of the wrong size turns by anything.
    if out.is_empty() {
        out.extend(loads(arm).into_iter().filter(|(turns, least, _)| turns >= least).map(|(_, _, slip)| slip));
    }
    out
}

/// The slip that most likely keeps an arm from having an equilibrium: one of [`unit_slips`], or else the load that turns it most.
pub fn likeliest_slip(arm: &Arm) -> Option<Slip> {
    let most = || loads(arm).into_iter().filter(|(turns, ..)| *turns >= DOUBTED).max_by(|a, b| a.0.total_cmp(&b.0));
    unit_slips(arm).into_iter().next().or_else(|| most().map(|(.., slip)| slip))
}

/// Slips of arms that differ from `base` in what varies, one a key; those of `base` itself are left out.
pub fn slips_beside(base: &Arm, others: impl IntoIterator<Item = Arm>) -> Vec<Slip> {
    let own = unit_slips(base);
    let mut out: Vec<Slip> = Vec::new();
    for slip in others.into_iter().flat_map(|arm| unit_slips(&arm)) {
        if own.iter().chain(&out).all(|known| known.key != slip.key) {
            out.push(slip);
        }
    }
    out
}

/// What one quantity of an arm runs through.
#[derive(Debug, Clone, PartialEq)]
pub struct Span {
    /// The key, as [`Parameter`] names it.
    pub key: String,
    /// The least and the largest value, or both ends of a range, in SI units (rad for angles).
    pub ends: [f64; 2],
}

impl Span {
    /// Of all finite values of a key; `None` where there is none.
    pub fn of(key: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let finite = values.into_iter().filter(|value| value.is_finite());
        let ends = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
        (ends[0] <= ends[1]).then(|| Self { key: key.into(), ends })
    }

    /// `arm` with either end, where it has such a quantity.
    fn arms(&self, arm: &Arm) -> Vec<Arm> {
        let Ok(parameter) = self.key.parse::<Parameter>() else { return Vec::new() };
        let with = |value: &f64| {
            let mut arm = arm.clone();
            parameter.set(&mut arm, *value).is_ok().then_some(arm)
        };
        self.ends.iter().filter_map(with).collect()
    }
}

/// Slips at the ends of what varies, one a key; those of the arm itself are left out.
///
/// ```
/// use hydrostat::Arm;
/// use hydrostat_files::{Span, slips_of_spans};
///
/// let arm = Arm::cone(0.3, 0.010, 0.002, 110e3, 0.5);
/// let span = Span { key: "material.young".to_owned(), ends: [70.0, 110e3] };
/// assert_eq!(slips_of_spans(&arm, &[span])[0].to_string(), "material.young = 70 Pa: is it kPa?");
/// ```
pub fn slips_of_spans(arm: &Arm, spans: &[Span]) -> Vec<Slip> {
    slips_beside(arm, spans.iter().flat_map(|span| span.arms(arm)))
}

fn geometry(arm: &Arm) -> Vec<Slip> {
    const LONGEST: f64 = 10.0;
    const SHORTEST: f64 = 1e-3;
    const WIDEST: f64 = 1.0;
    let mut out = Vec::new();
    let length = arm.length;
    if length >= LONGEST {
        out.push(Slip::new("arm.length", length, "m", if length >= 10.0 * LONGEST { "mm" } else { "cm" }));
    } else if length < SHORTEST {
        out.push(Slip::new("arm.length", 1e3 * length, "mm", "m"));
    }
    let widest = places(length).chain([0.0, length]).map(|s| arm.radius.at(s, length).value).fold(0.0, f64::max);
    if widest >= WIDEST || widest > length {
        out.push(Slip::new("arm.radius", widest, "m", "mm"));
    }
    if arm.flow.layer_thickness >= WIDEST {
        out.push(Slip::new("flow.layer_thickness", arm.flow.layer_thickness, "m", "mm"));
    }
    out
}

fn material(arm: &Arm) -> Vec<Slip> {
    const SOFTEST: f64 = 1e3;
    const LIGHTEST: f64 = 10.0;
    let mut out = Vec::new();
    let mut soft = |key: &str, value: f64| {
        if value < SOFTEST {
            out.push(Slip::new(key, value, "Pa", "kPa"));
        }
    };
    match &arm.material {
        Material::Homogeneous { young, .. } => soft("material.young", *young),
        // C2 says little: shear that hardly resists is within the law.
        Material::Coefficients { c1, .. } => soft("material.c1", c1.at(0.0, arm.length).value),
    }
    // Zero is said by those who leave weight out.
    if arm.density > 0.0 && arm.density < LIGHTEST {
        out.push(Slip::new("arm.density", arm.density, "kg/m3", "g/cm3"));
    }
    out
}

fn surroundings(arm: &Arm) -> Vec<Slip> {
    const FASTEST: f64 = 20.0;
    const HEAVIEST: f64 = 100.0;
    let mut out = Vec::new();
    // Air has 1.2 kg/m3; water has 1 g/cm3.
    if (0.95..1.1).contains(&arm.flow.density) {
        out.push(Slip::new("flow.density", arm.flow.density, "kg/m3", "g/cm3"));
    }
    if arm.flow.speed >= FASTEST {
        out.push(Slip::new("flow.speed", arm.flow.speed, "m/s", "cm/s"));
    }
    let mut angle = |key: &str, rad: f64| {
        let degrees = rad.to_degrees();
        let is_part_of_a_turn = |part: f64| (degrees.abs() - part).abs() < 2e-3;
        if [PI / 4.0, PI / 2.0, PI, 1.5 * PI, TAU].into_iter().any(is_part_of_a_turn) {
            out.push(Slip::new(key, degrees, "deg", "rad"));
        }
    };
    angle("arm.base.angle", arm.base.angle);
    angle("flow.direction", arm.flow.direction);
    if let Some(gravity) = &arm.gravity {
        angle("gravity.direction", gravity.direction);
        if gravity.acceleration >= HEAVIEST {
            out.push(Slip::new("gravity.acceleration", gravity.acceleration, "m/s2", "cm/s2"));
        }
    }
    out
}

/// Loads with the turns that each would make alone, and the turns from which it looks like a slip.
fn loads(arm: &Arm) -> Vec<(f64, f64, Slip)> {
    let length = arm.length;
    let mut out = Vec::new();
    let mut add = |key: String, value: f64, own: &str, unit: &'static str, turns: f64, least: f64| {
        let effect = format!(", which alone would turn the tip about {} times", number(turns.round()));
        out.push((turns, least, Slip { effect, ..Slip::new(key, value, own, unit) }));
    };
    for (index, cable) in arm.cables.iter().enumerate().filter(|(_, cable)| cable.stroke.is_none()) {
        let turns = turns(arm, |s| cable.tension * lever(cable, s, length));
        add(format!("cable[{index}].tension"), cable.tension, "N", "mN", turns, PULLED);
    }
    add("tip.moment".to_owned(), arm.tip.moment, "N m", "N mm", turns(arm, |_| arm.tip.moment), TURNED);
    for (name, force) in [("force", arm.tip.force), ("follower", arm.tip.follower)] {
        for (index, part) in force.into_iter().enumerate() {
            add(format!("tip.{name}[{index}]"), part, "N", "mN", turns(arm, |s| part * (length - s)), TURNED);
        }
    }
    out
}

/// The lever of a cable about the centreline, m.
fn lever(cable: &Cable, s: f64, length: f64) -> f64 {
    if s <= cable.end * length { cable.offset.at(s, length).value } else { 0.0 }
}

/// How often bending moments (N m) turn the tip of a linear beam.
fn turns(arm: &Arm, moment: impl Fn(f64) -> f64) -> f64 {
    let curvature = |s: f64| {
        let [_, _, stiffness] = arm.stiffness_at(s);
        moment(s).abs() / stiffness
    };
    let all: f64 = places(arm.length).map(curvature).sum();
    all * arm.length / PLACES as f64 / TAU
}

const PLACES: usize = 64;

/// Places all along an arm, m.
fn places(length: f64) -> impl Iterator<Item = f64> {
    (0..PLACES).map(move |k| (k as f64 + 0.5) / PLACES as f64 * length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ArmFile, shipped};

    fn arm(name: &str, keys: &[(&str, &str)]) -> Arm {
        let mut file = ArmFile::parse(shipped::get(name).unwrap(), name).unwrap();
        for (key, value) in keys {
            file.set(key, value).unwrap();
        }
        file.arm().unwrap()
    }

    fn slips(keys: &[(&str, &str)]) -> String {
        unit_slips(&arm("silicone", keys)).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    }

    /// Not even at the largest tension that the section carries.
    #[test]
    fn shipped_arms_have_none() {
        for name in shipped::names() {
            let mut arm = arm(name, &[]);
            for cable in &mut arm.cables {
                cable.tension = cable.max_tension.unwrap_or(cable.tension);
            }
            assert_eq!(unit_slips(&arm), [], "{name}: {:?}", loads(&arm).iter().map(|(t, ..)| *t).collect::<Vec<_>>());
        }
    }

    #[test]
    fn likely_slips_are_asked_about() {
        for (keys, words) in [
            (&[("arm.length", "300")][..], "arm.length = 300 m: is it mm?"),
            (&[("arm.length", "24.5")], "arm.length = 24.5 m: is it cm?"),
            (&[("arm.radius", "10")], "arm.radius = 10 m: is it mm?"),
            (&[("material.young", "70")], "material.young = 70 Pa: is it kPa?"),
            (&[("arm.density", "1.07")], "arm.density = 1.07 kg/m3: is it g/cm3?"),
            (&[("flow.density", "1.022")], "flow.density = 1.022 kg/m3: is it g/cm3?"),
            (&[("flow.speed", "50")], "flow.speed = 50 m/s: is it cm/s?"),
            (&[("flow.direction", "3.1416")], "flow.direction = 3.1416 deg: is it rad?"),
            (&[("gravity.acceleration", "981")], "gravity.acceleration = 981 m/s2: is it cm/s2?"),
            (&[("flow.density", "1.2")], ""),
            (&[("arm.density", "0")], ""),
        ] {
            assert_eq!(slips(keys), words, "{keys:?}");
        }
        let moment = slips(&[("tip.moment", "0.5")]);
        assert!(moment.starts_with("tip.moment = 0.5 N m, which alone would turn the tip about "), "{moment}");
        assert!(moment.ends_with(" times: is it N mm?"), "{moment}");
        let pull = slips(&[("cable[0].max_tension", "300"), ("cable[0].tension", "200")]);
        assert!(pull.starts_with("cable[0].tension = 200 N, which") && pull.ends_with("is it mN?"), "{pull}");
    }

    #[test]
    fn the_load_that_turns_most_is_the_likeliest() {
        let many =
            arm("silicone", &[("cable[0].max_tension", "30"), ("cable[0].tension", "20"), ("tip.moment", "1e-5")]);
        assert_eq!(unit_slips(&many), []);
        assert_eq!(likeliest_slip(&many).unwrap().key, "cable[0].tension");
        assert_eq!(likeliest_slip(&arm("silicone", &[])), None);
    }

    #[test]
    fn ends_of_ranges_are_asked_about_once_a_key() {
        let silicone = arm("silicone", &[]);
        let span = |key: &str, ends| Span { key: key.to_owned(), ends };
        let slips = |base: &Arm, spans: &[Span]| -> Vec<String> {
            slips_of_spans(base, spans).into_iter().map(|slip| slip.key).collect()
        };
        for (key, ends) in [
            ("arm.density", [1.07, 1000.0]),
            ("arm.length", [245.0, 300.0]),
            ("tip.moment", [195.0, 200.0]),
            ("material.young", [70.0, 110e3]),
            ("cable[0].tension", [0.0, 5000.0]),
            ("flow.speed", [50.0, 10.0]),
        ] {
            assert_eq!(slips(&silicone, &[span(key, ends)]), [key]);
        }
        assert!(slips(&silicone, &[span("flow.speed", [0.0, 0.5]), span("cable[0].tension", [0.0, 0.9])]).is_empty());
        // What the arm has was said of the arm; what it cannot have is refused elsewhere.
        let soft = arm("silicone", &[("material.young", "70")]);
        assert!(
            slips(&soft, &[span("material.young", [60.0, 80.0]), span("cable[7].tension", [0.0, 5000.0])]).is_empty()
        );
        assert_eq!(Span::of("flow.speed", [f64::NAN, 2.0, 1.0]), Some(span("flow.speed", [1.0, 2.0])));
        assert_eq!(Span::of("flow.speed", [f64::NAN]), None);
    }
}
