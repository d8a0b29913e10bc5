//! What the page offers and how it looks: readings and flow laws with what they mean, and the palette of the program's drawings. The page
//! has no copy of any of this.

use std::fmt::Write as _;

use hydrostat::{Displaced, EnteringSpeed, FlowSurface, Hydrostatics, LayerMean, Support, Volume, WettedLength};
use hydrostat_figures::Palette;
use serde::Serialize;

/// One word of an option.
#[derive(Debug, Serialize)]
struct Word {
    word: &'static str,
    meaning: &'static str,
}

/// A choice among words. The first is the default.
#[derive(Debug, Serialize)]
struct Choice {
    /// Its key in arm files.
    key: &'static str,
    label: &'static str,
    /// What is decided.
    meaning: &'static str,
    words: Vec<Word>,
}

/// The document of `/api/options`.
#[derive(Debug, Serialize)]
pub(crate) struct OptionsDocument {
    schema: u32,
    version: &'static str,
    /// Where the source can be read in more than one way.
    readings: Vec<Choice>,
    flow_law: Choice,
}

fn words<T: Copy>(all: &[T], name: fn(T) -> &'static str, meaning: fn(T) -> &'static str) -> Vec<Word> {
    all.iter().map(|one| Word { word: name(*one), meaning: meaning(*one) }).collect()
}

impl OptionsDocument {
    pub(crate) fn new() -> Self {
        Self {
            schema: hydrostat_files::results::SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            readings: readings(),
            flow_law: Choice {
                key: "flow.law",
                label: "Law",
                meaning: "How the stream loads the arm",
                words: vec![
                    Word {
                        word: "momentum",
                        meaning: "The source's (8) and (9): the momentum that the boundary layer loses along the arm",
                    },
                    Word {
                        word: "quadratic-drag",
                        meaning: "Drag across and along the arm with your own coefficients C_n and C_t; both are required",
                    },
                ],
            },
        }
    }
}

fn readings() -> Vec<Choice> {
    let choice = |key, label, meaning, words| Choice { key, label, meaning, words };
    vec![
        choice(
            "model.volume",
            "Volume",
            "How a section widens where the arm is compressed, (15) and (16)",
            words(&Volume::ALL, Volume::name, |one| match one {
                Volume::Planar => "beta = 1/nu: the area in the plane is kept, as the source writes it",
                Volume::Circular => "beta = 1/sqrt(nu): the volume of a round section is kept",
                Volume::None => "beta = 1: sections keep their size, as in a classical rod",
            }),
        ),
        choice(
            "model.flow_surface",
            "Surface of the flow",
            "Which surface gives the direction of the stream's load, (7) to (10)",
            words(&FlowSurface::ALL, FlowSurface::name, |one| match one {
                FlowSurface::Centreline => "Tangent and normal of the centreline",
                FlowSurface::Lateral => {
                    "Tangent and normal of the windward surface; the load jumps where the windward side changes"
                }
            }),
        ),
        choice(
            "model.entering_speed",
            "Entering speed",
            "The meaning of V_in in (8), which has no subscript in the source",
            words(&EnteringSpeed::ALL, EnteringSpeed::name, |one| match one {
                EnteringSpeed::Tangential => "The tangential speed alone",
                EnteringSpeed::Resultant => {
                    "Tangential and normal speed together; leaves a force along the arm at normal incidence"
                }
            }),
        ),
        choice(
            "model.layer_mean",
            "Mean over the layer",
            "Which mean of the speed profile (7) is used",
            words(&LayerMean::ALL, LayerMean::name, |one| match one {
                LayerMean::Speed => "The mean of the speed, 2/3 of the speed outside the layer",
                LayerMean::Momentum => "The root of the mean square, sqrt(8/15) of the speed outside the layer",
            }),
        ),
        choice(
            "model.wetted_length",
            "Wetted length",
            "The length on which the stream acts",
            words(&WettedLength::ALL, WettedLength::name, |one| match one {
                WettedLength::Reference => "The length of the undeformed arm",
                WettedLength::Deformed => "The length of the deformed arm, which is the one in the water",
            }),
        ),
        choice(
            "model.displaced",
            "Displaced water",
            "The water that a section displaces, in proportion to that of the unloaded arm",
            words(&Displaced::ALL, Displaced::name, |one| match one {
                Displaced::Volume => "The arm's volume, which (15) keeps: buoyancy stays as cables pull",
                Displaced::Section => "The round section's, times nu beta^2: under planar it grows as cables pull",
            }),
        ),
        choice(
            "model.hydrostatics",
            "Hydrostatics",
            "Which part of weight and buoyancy acts, (9) and (10)",
            words(&Hydrostatics::ALL, Hydrostatics::name, |one| match one {
                Hydrostatics::Archimedes => "All of it",
                Hydrostatics::NormalOnly => "Its part normal to the flow surface, as the source writes it",
            }),
        ),
        choice(
            "model.support",
            "Support",
            "The conditions at the base",
            words(&Support::ALL, Support::name, |one| match one {
                Support::Clamped => "Place and angle of the base are given; the tip carries the tip loads",
                Support::UnstrainedBase => "No strain at the base; the balance at the tip is then not met",
            }),
        ),
    ]
}

/// The palette as a style sheet: variables that the page's own sheet makes its colours of.
pub(crate) fn palette_css() -> String {
    let Palette { series, shades, body, water } = hydrostat_figures::palette();
    let hex = |[r, g, b]: [u8; 3]| format!("#{r:02x}{g:02x}{b:02x}");
    let mut out = ":root {\n".to_owned();
    let named = series.iter().enumerate().map(|(k, color)| (format!("drawn-{k}"), *color));
    let named = named.chain(shades.iter().enumerate().map(|(k, color)| (format!("shade-{k}"), *color)));
    for (name, color) in named.chain([("drawn-body".to_owned(), body), ("drawn-water".to_owned(), water)]) {
        let _ = writeln!(out, "  --{name}: {};", hex(color));
    }
    out.push_str("}\n");
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use hydrostat_files::schema::arm_schema;
    use serde_json::Value;

    /// The words that an arm file may have for a key.
    fn known(schema: &Value, key: &str) -> Vec<String> {
        let mut at = schema;
        for part in key.split('.') {
            at = &at["properties"][part];
            if let Some(name) = at["$ref"].as_str() {
                at = schema.pointer(name.trim_start_matches('#')).unwrap();
            }
        }
        at["enum"].as_array().unwrap().iter().map(|word| word.as_str().unwrap().to_owned()).collect()
    }

    #[test]
    fn options_are_those_of_arm_files() {
        let schema = arm_schema();
        let document = OptionsDocument::new();
        for choice in document.readings.iter().chain([&document.flow_law]) {
            let own: Vec<String> = choice.words.iter().map(|word| word.word.to_owned()).collect();
            assert_eq!(own, known(&schema, choice.key), "{}", choice.key);
            assert!(!choice.meaning.is_empty() && choice.words.iter().all(|word| !word.meaning.is_empty()));
        }
        let model = schema.pointer("/properties/model/properties").or(schema.pointer("/$defs/model/properties"));
        let keys = model.unwrap().as_object().unwrap().keys().filter(|key| *key != "closure").count();
        assert_eq!(document.readings.len(), keys, "every reading is offered");
    }

    #[test]
    fn the_palette_is_a_style_sheet() {
        let css = palette_css();
        assert!(css.contains("--drawn-0: #d55e00;") && css.contains("--shade-4: #"), "{css}");
    }
}
