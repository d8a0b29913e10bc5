//! What holds for any arm and any text.

use std::sync::LazyLock;

use hydrostat::{
    Arm, Base, Cable, Cavity, Displaced, DistributedLoad, EnteringSpeed, Flow, FlowLaw, FlowSurface, Gravity,
    Hydrostatics, Join, LayerMean, Material, ModelOptions, Motion, Profile, Reference, Support, TipLoad, Volume,
    WettedLength,
};
use hydrostat_files::{ArmFile, Inputs, arm_to_toml, schema, shipped};
use proptest::prelude::*;
use proptest::sample::select;

static SCHEMA: LazyLock<jsonschema::Validator> =
    LazyLock::new(|| jsonschema::validator_for(&schema::arm_schema()).unwrap());

/// Any profile with values in a range, on an arm of a given length.
fn profile(low: f64, high: f64, length: f64) -> impl Strategy<Value = Profile> {
    prop_oneof![
        (low..high).prop_map(Profile::Constant),
        (low..high, low..high).prop_map(|(base, tip)| Profile::linear(base, tip)),
        (proptest::collection::vec((0.1..1.0, low..high), 2..6), select(Join::ALL.to_vec())).prop_map(
            move |(steps, join)| {
                let total: f64 = steps[1..].iter().map(|(step, _)| step).sum();
                let mut s = 0.0;
                let mut points: Vec<[f64; 2]> = Vec::new();
                for (i, (step, value)) in steps.iter().enumerate() {
                    s += if i == 0 { 0.0 } else { step / total * length };
                    points.push([s, *value]);
                }
                let last = points.len() - 1;
                points[last][0] = length;
                Profile::joined(&points, join).unwrap()
            }
        ),
    ]
}

fn angle() -> impl Strategy<Value = f64> {
    prop_oneof![-7.0..7.0, select(vec![0.0, -0.0, 30_f64.to_radians(), -90_f64.to_radians(), 1e-300])]
}

fn readings() -> impl Strategy<Value = ModelOptions> {
    (
        select(vec![Volume::Planar, Volume::Circular, Volume::None]),
        select(vec![FlowSurface::Centreline, FlowSurface::Lateral]),
        select(vec![EnteringSpeed::Tangential, EnteringSpeed::Resultant]),
        select(vec![LayerMean::Speed, LayerMean::Momentum]),
        select(vec![WettedLength::Reference, WettedLength::Deformed]),
        select(Displaced::ALL.to_vec()),
        select(vec![Hydrostatics::Archimedes, Hydrostatics::NormalOnly]),
        select(vec![Support::Clamped, Support::UnstrainedBase]),
    )
        .prop_map(
            |(volume, flow_surface, entering_speed, layer_mean, wetted_length, displaced, hydrostatics, support)| {
                ModelOptions {
                    volume,
                    flow_surface,
                    entering_speed,
                    layer_mean,
                    wetted_length,
                    displaced,
                    hydrostatics,
                    support,
                }
            },
        )
}

fn material(length: f64) -> impl Strategy<Value = Material> {
    prop_oneof![
        (1e3..1e9, 0.0..0.5, 0.5..1.0)
            .prop_map(|(young, poisson, shear_factor)| { Material::Homogeneous { young, poisson, shear_factor } }),
        (profile(1e3, 1e9, length), profile(1e3, 1e9, length), profile(1e-3, 1e3, length))
            .prop_map(|(c1, c2, c3)| Material::Coefficients { c1, c2, c3 }),
    ]
}

fn cable(length: f64) -> impl Strategy<Value = Cable> {
    use proptest::option::of;
    let pull = (0.0..5.0, of(-0.01..0.01), of(1.0..1e3), of(5.0..9.0));
    (any::<String>(), profile(-0.01, 0.01, length), pull, (select(vec![0.0, 0.3]), any::<bool>()), 0.01..=1.0).prop_map(
        |(name, offset, (tension, stroke, stiffness, max_tension), (friction, out), end)| {
            let motion = if out && friction > 0.0 { Motion::Out } else { Motion::In };
            // A file has one of both.
            let tension = if stroke.is_some() { 0.0 } else { tension };
            let cable = Cable::new(name, offset).ending_at(end);
            Cable { tension, stroke, stiffness, max_tension, ..cable.with_friction(friction, motion) }
        },
    )
}

fn flow() -> impl Strategy<Value = Flow> {
    let law = prop_oneof![
        Just(FlowLaw::Momentum),
        (0.0..3.0, 0.0..1.0).prop_map(|(cn, ct)| FlowLaw::QuadraticDrag { cn, ct })
    ];
    (0.0..2.0, angle(), 0.0..2000.0, 1e-6..0.1, law).prop_map(|(speed, direction, density, layer_thickness, law)| {
        Flow { speed, direction, density, layer_thickness, law }
    })
}

fn loads(length: f64) -> impl Strategy<Value = (TipLoad, DistributedLoad, Reference, Option<Gravity>)> {
    let pair = || proptest::array::uniform2(-1.0..1.0);
    let tip = (pair(), -1.0..1.0, pair()).prop_map(|(force, moment, follower)| TipLoad { force, moment, follower });
    let along = (profile(-1.0, 1.0, length), profile(-1.0, 1.0, length), profile(-1.0, 1.0, length))
        .prop_map(|(e1, e2, couple)| DistributedLoad { force: [e1, e2], couple });
    let reference = (profile(0.5, 1.5, length), profile(-0.1, 0.1, length), profile(-20.0, 20.0, length))
        .prop_map(|(nu, eta, mu)| Reference { nu, eta, mu });
    let gravity = (0.0..20.0, angle()).prop_map(|(acceleration, direction)| Gravity { acceleration, direction });
    (tip, along, reference, proptest::option::of(gravity))
}

fn arm() -> impl Strategy<Value = Arm> {
    (0.01..5.0).prop_flat_map(|length| {
        let geometry = (
            any::<String>(),
            profile(0.0101, 0.5, length),
            profile(0.0, 0.01, length),
            select(vec![Cavity::Flooded, Cavity::Sealed]),
            0.0..3000.0,
            (-1.0..1.0, -1.0..1.0, angle()).prop_map(|(x, y, angle)| Base { x, y, angle }),
        );
        let cables = proptest::collection::vec(cable(length), 0..4);
        (geometry, material(length), cables, flow(), loads(length), readings()).prop_map(
            move |(geometry, material, cables, flow, (tip, distributed, reference, gravity), readings)| {
                let (name, radius, inner_radius, cavity, density, base) = geometry;
                Arm {
                    name,
                    length,
                    radius,
                    inner_radius,
                    cavity,
                    density,
                    base,
                    material,
                    reference,
                    cables,
                    flow,
                    gravity,
                    tip,
                    distributed,
                    dynamics: hydrostat::Dynamics::default(),
                    model: readings,
                    space: None,
                }
            },
        )
    })
}

/// Text made of the pieces of arm files, in any order.
fn nearly_toml() -> impl Strategy<Value = String> {
    let pieces = vec![
        "[arm]",
        "[[cable]]",
        "[material]",
        "[flow]",
        "[model]",
        "[",
        "]",
        "{",
        "}",
        "=",
        " = ",
        ",",
        ".",
        "\n",
        "\r\n",
        "\"",
        "'",
        "'''",
        "#",
        "length",
        "radius",
        "offset",
        "base",
        "tip",
        "young",
        "speed",
        "law",
        "\"8 mm\"",
        "\"1e",
        "0.2",
        "-1",
        "nan",
        "1e999",
        "0x",
        "true",
        "1979-05-27",
        "[[0, 1], [0.2, 1]]",
        "\\u",
        "\u{feff}",
        "\u{0}",
        "e",
    ];
    proptest::collection::vec(select(pieces), 0..60).prop_map(|p| p.concat())
}

/// A shipped arm with some of its text changed.
fn damaged() -> impl Strategy<Value = String> {
    let texts: Vec<&str> = shipped::names().filter_map(shipped::get).collect();
    (select(texts), proptest::collection::vec((any::<prop::sample::Index>(), any::<char>(), 0..3), 1..6)).prop_map(
        |(text, edits)| {
            let mut text: Vec<char> = text.chars().collect();
            for (at, c, what) in edits {
                let at = at.index(text.len());
                match what {
                    0 => text[at] = c,
                    1 => text.insert(at, c),
                    _ => drop(text.remove(at)),
                }
            }
            text.into_iter().collect()
        },
    )
}

/// Reads the text; whatever comes of it, a message says where.
fn read(text: &str) -> Result<(), TestCaseError> {
    if let Err(error) = ArmFile::parse(text, "any.toml").and_then(|f| f.arm()) {
        let message = error.to_string();
        prop_assert!(message.starts_with("any.toml:"), "{}", message);
        let expected = message.contains("expected ") && message.contains("found ");
        let others = ["unknown key; expected ", "missing; expected ", "not valid TOML: ", "the key is given twice"];
        prop_assert!(expected || others.iter().any(|part| message.contains(part)), "{}", message);
    }
    Ok(())
}

proptest! {
    #![proptest_config(hydrostat_fuzz::property(300))]

    #[test]
    fn an_arm_written_out_reads_back_the_same(arm in arm()) {
        prop_assert_eq!(arm.check(), Ok(()));
        let text = arm_to_toml(&arm);
        let back = ArmFile::parse(&text, "copy.toml").and_then(|f| f.arm());
        match back {
            Ok(back) => prop_assert_eq!(back, arm),
            Err(error) => prop_assert!(false, "{}\n{}", error, text),
        }
    }

    #[test]
    fn inputs_follow_the_schema(arm in arm()) {
        let inputs = serde_json::to_value(Inputs::new(&arm)).unwrap();
        prop_assert!(SCHEMA.is_valid(&inputs), "{}", inputs);
    }

    #[test]
    fn any_bytes_are_answered(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        if let Ok(file) = ArmFile::parse_bytes(&bytes, "any.toml") {
            let _ = file.arm();
        }
    }

    #[test]
    fn any_text_is_answered(text in ".{0,200}") {
        read(&text)?;
    }

    #[test]
    fn anything_like_an_arm_is_answered(text in nearly_toml()) {
        read(&text)?;
    }

    #[test]
    fn damaged_arms_are_answered(text in damaged()) {
        read(&text)?;
    }

    #[test]
    fn any_override_is_answered(key in "[a-z_.\\[\\]0-9]{0,20}", value in ".{0,20}", known in select(vec![
        "cable[0].offset", "arm.radius", "arm.radius.base", "tip.force[0]", "model.volume", "name", "flow", "cable",
    ])) {
        let mut file = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap();
        for key in [key.as_str(), known] {
            let _ = file.set(key, &value);
            let _ = file.arm();
        }
    }
}
