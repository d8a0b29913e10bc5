//! What keeps numbers from being an arm.

use crate::rod::profile::TableError;

/// What keeps numbers from being an arm. `key` is the dotted path that the arm file uses.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ArmError {
    /// NaN or infinite.
    #[error("`{key}` is not a finite number")]
    NotFinite {
        /// Which quantity.
        key: String,
    },
    /// Zero or below where only above zero makes sense.
    #[error("`{key}` must be above zero{place}, found {value}", place = at(*.s))]
    NotPositive {
        /// Which quantity.
        key: String,
        /// What it is.
        value: f64,
        /// Where along the arm, m, if it varies.
        s: Option<f64>,
    },
    /// Below zero.
    #[error("`{key}` must not be negative, found {value}")]
    Negative {
        /// Which quantity.
        key: String,
        /// What it is.
        value: f64,
    },
    /// Outside an interval.
    #[error("`{key}` must be {expected}, found {value}")]
    OutOfRange {
        /// Which quantity.
        key: String,
        /// What it is.
        value: f64,
        /// The interval, in words.
        expected: &'static str,
    },
    /// The cavity reaches the surface.
    #[error("`arm.inner_radius` must stay below `arm.radius`: {inner} m against {outer} m at s = {s} m")]
    InnerRadius {
        /// Where, m.
        s: f64,
        /// R_in there, m.
        inner: f64,
        /// R there, m.
        outer: f64,
    },
    /// A cable outside the section.
    #[error("`{key}` leaves the section: {offset} m at s = {s} m, where the radius is {radius} m")]
    OffsetOutside {
        /// Which cable offset.
        key: String,
        /// Where, m.
        s: f64,
        /// The offset there, m.
        offset: f64,
        /// The radius there, m.
        radius: f64,
    },
    /// A tension above the stated largest one.
    #[error("`{key}` is {tension} N, above its max_tension of {max_tension} N")]
    TensionAboveMax {
        /// Which tension.
        key: String,
        /// N.
        tension: f64,
        /// N.
        max_tension: f64,
    },
    /// A table that does not run from base to tip.
    #[error("the table `{key}` must run from s = 0 to the length {length} m, it runs from {from} to {to} m")]
    TableDoesNotCover {
        /// Which profile.
        key: String,
        /// Its first place, m.
        from: f64,
        /// Its last place, m.
        to: f64,
        /// The arm's length, m.
        length: f64,
    },
    /// Points that do not make a table.
    #[error("`{key}`: {source}")]
    Table {
        /// Which profile.
        key: String,
        /// Why.
        source: TableError,
    },
    /// More places at which tables have points and cables end than meshes have room for.
    #[error("`{key}`: tables have points and cables end at {found} places, an arm like this may have {most}")]
    TooManyBreaks {
        /// The longest table.
        key: String,
        /// How many places.
        found: usize,
        /// The most with as many cables.
        most: usize,
    },
    /// Something out of the plane on an arm in the plane.
    #[error("`{key}` takes the arm out of the plane e1-e2: that needs `space = \"spatial\"` in `[arm]`")]
    OutOfPlane {
        /// What.
        key: String,
    },
    /// An arm in space where only one in the plane can be worked on.
    #[error("{what} is for arms in the plane, and this arm has `space = \"spatial\"`")]
    OnlyInPlane {
        /// What was asked for.
        what: &'static str,
    },
    /// What arms in space do not have yet, or cannot have.
    #[error("`{key}` {why} for an arm with `space = \"spatial\"`")]
    NotInSpace {
        /// What.
        key: String,
        /// Why not, as the rest of a sentence.
        why: &'static str,
    },
    /// A direction without length, or two that are parallel.
    #[error("`{key}` {why}")]
    Direction {
        /// Which direction.
        key: &'static str,
        /// What is wrong, as the rest of a sentence.
        why: &'static str,
    },
    /// A number of tensions that is not the number of cables.
    #[error(
        "the arm has {cables} cable{}, {given} tension{} given",
        if *.cables == 1 { "" } else { "s" },
        if *.given == 1 { " was" } else { "s were" }
    )]
    TensionCount {
        /// Cables of the arm.
        cables: usize,
        /// Tensions given.
        given: usize,
    },
}

fn at(s: Option<f64>) -> String {
    s.map_or_else(String::new, |s| format!(" (at s = {s} m)"))
}
