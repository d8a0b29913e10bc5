//! Colours for the values of a column.

use crate::arm_figure::kind_words;
use crate::chart::padded;
use crate::font::Label;
use crate::palette::{Color, series, shade};

/// Where there is no answer.
const NOTHING: Color = Color { rgb: [200, 200, 200], opacity: 1.0 };

/// A quantity that gives colours, a value a row.
#[derive(Debug, Clone, PartialEq)]
pub enum Coloured {
    /// Numbers in the unit of the column's name; NaN where there is no answer.
    Numbers(Vec<f64>),
    /// Words; nothing where all is well.
    Words(Vec<Option<String>>),
}

/// A column of a sweep that gives colours.
#[derive(Debug, Clone, PartialEq)]
pub struct ColouredColumn {
    /// Its name, such as `tip_alpha_rad`.
    pub name: String,
    /// A value a row.
    pub values: Coloured,
}

impl ColouredColumn {
    /// The same column of some rows.
    pub fn of(&self, rows: &[usize]) -> Self {
        let values = match &self.values {
            Coloured::Numbers(all) => Coloured::Numbers(rows.iter().map(|row| all[*row]).collect()),
            Coloured::Words(all) => Coloured::Words(rows.iter().map(|row| all[*row].clone()).collect()),
        };
        Self { name: self.name.clone(), values }
    }
}

/// What colours mean.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Shades {
    /// Numbers from and to.
    Range([f64; 2]),
    /// One colour a word, `None` first where there is such a row.
    Words(Vec<Option<String>>),
}

/// A column with a colour for every row.
#[derive(Debug, Clone)]
pub(crate) struct Shading {
    title: Label,
    per_si: f64,
    shades: Shades,
    values: Coloured,
}

impl Shading {
    pub(crate) fn new(column: &ColouredColumn) -> Self {
        let (title, per_si) = title(&column.name);
        let shades = match &column.values {
            Coloured::Numbers(values) => {
                let found = values.iter().filter(|v| v.is_finite()).map(|v| v * per_si);
                let range = found.fold([f64::INFINITY, f64::NEG_INFINITY], |r, v| [r[0].min(v), r[1].max(v)]);
                Shades::Range(padded(range, 0.0))
            }
            Coloured::Words(words) => {
                let mut all: Vec<Option<String>> = words.clone();
                all.sort();
                all.dedup();
                Shades::Words(all)
            }
        };
        Self { title, per_si, shades, values: column.values.clone() }
    }

    /// The column for people.
    pub(crate) fn title(&self) -> &Label {
        &self.title
    }

    /// How many of the unit in the title an SI unit is.
    pub(crate) fn per_si(&self) -> f64 {
        self.per_si
    }

    pub(crate) fn shades(&self) -> &Shades {
        &self.shades
    }

    pub(crate) fn is_answered(&self, row: usize) -> bool {
        match &self.values {
            Coloured::Numbers(values) => values[row].is_finite(),
            Coloured::Words(words) => words[row].is_none(),
        }
    }

    pub(crate) fn color(&self, row: usize) -> Color {
        match (&self.values, &self.shades) {
            (Coloured::Numbers(values), Shades::Range([from, to])) if values[row].is_finite() => {
                shade((values[row] * self.per_si - from) / (to - from))
            }
            (Coloured::Words(words), Shades::Words(all)) => word_color(all, words[row].as_ref()),
            _ => NOTHING,
        }
    }

    /// What a row without a word is.
    fn nothing(&self) -> &'static str {
        if self.title.to_string() == "verdict" { "equilibrium" } else { "none" }
    }

    /// What is not on the bar of colours.
    pub(crate) fn legend(&self) -> Vec<(Color, String)> {
        match (&self.shades, &self.values) {
            (Shades::Words(all), _) => all
                .iter()
                .map(|word| (word_color(all, word.as_ref()), kind_words(word.as_deref().unwrap_or(self.nothing()))))
                .collect(),
            (Shades::Range(_), Coloured::Numbers(values)) if values.iter().any(|v| !v.is_finite()) => {
                vec![(NOTHING, "no equilibrium".to_owned())]
            }
            _ => Vec::new(),
        }
    }
}

fn word_color(all: &[Option<String>], word: Option<&String>) -> Color {
    let at = all.iter().flatten().position(|own| Some(own) == word);
    at.map_or(NOTHING, series)
}

/// A column's name for people, and how many of the unit shown an SI unit is.
fn title(name: &str) -> (Label, f64) {
    let known = match name {
        "tip_x_m" => Some("$x$($L$) (mm)"),
        "tip_y_m" => Some("$y$($L$) (mm)"),
        "tip_z_m" => Some("$z$($L$) (mm)"),
        "tip_theta_rad" => Some("$θ$($L$) (°)"),
        "tip_alpha_rad" => Some("$α$($L$) (°)"),
        _ => None,
    };
    // Those that end as another one come first.
    let units = [
        ("_rad", " (°)", 1.0_f64.to_degrees()),
        ("_Nm_m", " (N m/m)", 1.0),
        ("_N_m", " (N/m)", 1.0),
        ("_per_m", " (1/m)", 1.0),
        ("_m_s2", " (m/s²)", 1.0),
        ("_m_s", " (m/s)", 1.0),
        ("_kg_m3", " (kg/m³)", 1.0),
        ("_Pa", " (Pa)", 1.0),
        ("_Nm", " (N m)", 1.0),
        ("_N", " (N)", 1.0),
        ("_m", " (mm)", 1e3),
    ];
    let (stem, unit, per_si) = units
        .into_iter()
        .find_map(|(ending, unit, per_si)| Some((name.strip_suffix(ending)?, unit, per_si)))
        .unwrap_or((name, "", 1.0));
    let label = known.map_or_else(|| Label::plain(format!("{}{unit}", words(stem))), Label::math);
    (label, per_si)
}

/// `stroke_0` as `stroke[0]`, and `fold_margin` as `fold margin`.
fn words(stem: &str) -> String {
    let index = stem.rsplit_once('_').filter(|(_, index)| index.bytes().all(|byte| byte.is_ascii_digit()));
    match index {
        Some((stem, index)) => format!("{}[{index}]", stem.replace('_', " ")),
        None => stem.replace('_', " "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_have_names_and_units() {
        for (name, words, per_si) in [
            ("tip_x_m", "x(L) (mm)", 1e3),
            ("stroke_0_m", "stroke[0] (mm)", 1e3),
            ("shape_x_12_m", "shape x[12] (mm)", 1e3),
            ("flow_speed_m_s", "flow speed (m/s)", 1.0),
            ("base_moment_Nm", "base moment (N m)", 1.0),
            ("base_force_x_N", "base force x (N)", 1.0),
            ("fold_margin", "fold margin", 1.0),
            ("tip_theta_rad", "θ(L) (°)", 1.0_f64.to_degrees()),
        ] {
            let (label, factor) = title(name);
            assert_eq!((label.to_string().as_str(), factor), (words, per_si));
        }
    }

    #[test]
    fn rows_without_an_answer_are_set_apart() {
        let numbers = Coloured::Numbers(vec![1.0, f64::NAN, 3.0]);
        let shading = Shading::new(&ColouredColumn { name: "fold_margin".to_owned(), values: numbers });
        assert_eq!([0, 1, 2].map(|row| shading.color(row)), [shade(0.0), NOTHING, shade(1.0)]);
        assert_eq!(shading.legend().len(), 1);
        let words = [None, Some("a"), Some("b")].map(|word| word.map(str::to_owned)).to_vec();
        let shading = Shading::new(&ColouredColumn { name: "verdict".to_owned(), values: Coloured::Words(words) });
        assert_eq!([0, 1, 2].map(|row| shading.color(row)), [NOTHING, series(0), series(1)]);
        assert_eq!(shading.legend().len(), 3);
    }
}
