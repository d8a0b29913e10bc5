//! Numbers with units: "8 mm", "110 kPa", "30 deg".
//!
//! Every dimension has a list of spellings and nothing else is accepted, so that the schema can
//! list them too. A decimal prefix is applied to the decimal text before it becomes binary:
//! "0.1 mm" is exactly the number that `1e-4` is.

use std::fmt;

use crate::error::shortened;

/// What a number measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// Fractions, strains, coefficients: no unit.
    Number,
    /// m.
    Length,
    /// rad; a bare number is in degrees.
    Angle,
    /// m/s.
    Speed,
    /// kg/m3.
    Density,
    /// Pa.
    Pressure,
    /// N.
    Force,
    /// N m.
    Moment,
    /// m/s2.
    Acceleration,
    /// 1/m.
    Curvature,
    /// N/m.
    ForcePerLength,
    /// N m/m.
    MomentPerLength,
    /// s.
    Time,
    /// Pa s.
    Viscosity,
}

/// How a number in a unit becomes SI.
#[derive(Debug, Clone, Copy)]
enum Scale {
    /// Times a power of ten.
    Decimal(i64),
    /// Times the first, over the second.
    Ratio(f64, f64),
    /// Degrees.
    Degrees,
}
use Scale::{Decimal, Degrees, Ratio};

/// Spellings of one unit, the first of them shown in messages, and its size.
type Unit = (&'static [&'static str], Scale);

/// Standard gravity, m/s2: the unit "g".
pub const STANDARD_GRAVITY: f64 = 9.806_65;

const LENGTH: &[Unit] = &[
    (&["m"], Decimal(0)),
    (&["cm"], Decimal(-2)),
    (&["mm"], Decimal(-3)),
    (&["um", "\u{b5}m", "\u{3bc}m"], Decimal(-6)),
    (&["in"], Ratio(0.0254, 1.0)),
    (&["ft"], Ratio(0.3048, 1.0)),
];
const ANGLE: &[Unit] = &[(&["deg", "\u{b0}"], Degrees), (&["rad"], Decimal(0)), (&["mrad"], Decimal(-3))];
const SPEED: &[Unit] = &[
    (&["m/s"], Decimal(0)),
    (&["cm/s"], Decimal(-2)),
    (&["mm/s"], Decimal(-3)),
    (&["km/h"], Ratio(1.0, 3.6)),
    (&["kn"], Ratio(1852.0, 3600.0)),
];
const DENSITY: &[Unit] = &[
    (&["kg/m3", "kg/m^3", "kg/m\u{b3}"], Decimal(0)),
    (&["g/cm3", "g/cm^3", "g/cm\u{b3}"], Decimal(3)),
    (&["kg/l", "kg/L"], Decimal(3)),
    (&["g/ml", "g/mL"], Decimal(3)),
];
const PRESSURE: &[Unit] = &[
    (&["Pa"], Decimal(0)),
    (&["kPa"], Decimal(3)),
    (&["MPa"], Decimal(6)),
    (&["GPa"], Decimal(9)),
    (&["N/m2", "N/m^2", "N/m\u{b2}"], Decimal(0)),
    (&["N/mm2", "N/mm^2", "N/mm\u{b2}"], Decimal(6)),
    (&["mbar"], Decimal(2)),
    (&["bar"], Decimal(5)),
    (&["psi"], Ratio(6_894.757_293_168_361, 1.0)),
];
const FORCE: &[Unit] = &[
    (&["N"], Decimal(0)),
    (&["kN"], Decimal(3)),
    (&["mN"], Decimal(-3)),
    (&["uN", "\u{b5}N", "\u{3bc}N"], Decimal(-6)),
    (&["gf"], Ratio(STANDARD_GRAVITY, 1000.0)),
    (&["kgf"], Ratio(STANDARD_GRAVITY, 1.0)),
    (&["lbf"], Ratio(4.448_221_615_260_5, 1.0)),
];
const MOMENT: &[Unit] = &[
    (&["N m", "Nm", "N*m", "N\u{b7}m"], Decimal(0)),
    (&["mN m", "mNm", "mN*m", "mN\u{b7}m"], Decimal(-3)),
    (&["N cm", "Ncm", "N*cm", "N\u{b7}cm"], Decimal(-2)),
    (&["N mm", "Nmm", "N*mm", "N\u{b7}mm"], Decimal(-3)),
];
const ACCELERATION: &[Unit] = &[
    (&["m/s2", "m/s^2", "m/s\u{b2}"], Decimal(0)),
    (&["cm/s2", "cm/s^2", "cm/s\u{b2}"], Decimal(-2)),
    (&["g"], Ratio(STANDARD_GRAVITY, 1.0)),
];
const CURVATURE: &[Unit] = &[
    (&["1/m", "/m", "m^-1", "rad/m"], Decimal(0)),
    (&["1/cm", "/cm", "cm^-1", "rad/cm"], Decimal(2)),
    (&["1/mm", "/mm", "mm^-1", "rad/mm"], Decimal(3)),
    (&["deg/m"], Degrees),
];
const FORCE_PER_LENGTH: &[Unit] =
    &[(&["N/m"], Decimal(0)), (&["mN/m"], Decimal(-3)), (&["N/cm"], Decimal(2)), (&["N/mm"], Decimal(3))];
const MOMENT_PER_LENGTH: &[Unit] =
    &[(&["N m/m", "Nm/m", "N*m/m", "N\u{b7}m/m", "N"], Decimal(0)), (&["mN m/m", "mNm/m", "mN"], Decimal(-3))];
const TIME: &[Unit] = &[
    (&["s"], Decimal(0)),
    (&["ms"], Decimal(-3)),
    (&["us", "\u{b5}s", "\u{3bc}s"], Decimal(-6)),
    (&["min"], Ratio(60.0, 1.0)),
];
const VISCOSITY: &[Unit] = &[
    (&["Pa s", "Pas", "Pa*s", "Pa\u{b7}s"], Decimal(0)),
    (&["kPa s", "kPas", "kPa*s", "kPa\u{b7}s"], Decimal(3)),
    (&["mPa s", "mPas", "mPa*s", "mPa\u{b7}s"], Decimal(-3)),
];

impl Dimension {
    /// All of them.
    pub const ALL: [Self; 14] = [
        Self::Number,
        Self::Length,
        Self::Angle,
        Self::Speed,
        Self::Density,
        Self::Pressure,
        Self::Force,
        Self::Moment,
        Self::Acceleration,
        Self::Curvature,
        Self::ForcePerLength,
        Self::MomentPerLength,
        Self::Time,
        Self::Viscosity,
    ];

    /// With its article, as in "expected a length".
    pub fn name(self) -> &'static str {
        match self {
            Self::Number => "a number without unit",
            Self::Length => "a length",
            Self::Angle => "an angle",
            Self::Speed => "a speed",
            Self::Density => "a density",
            Self::Pressure => "a pressure",
            Self::Force => "a force",
            Self::Moment => "a moment",
            Self::Acceleration => "an acceleration",
            Self::Curvature => "a curvature",
            Self::ForcePerLength => "a force per length",
            Self::MomentPerLength => "a moment per length",
            Self::Time => "a time",
            Self::Viscosity => "a viscosity",
        }
    }

    /// The unit of a bare number in a file.
    pub fn bare_unit(self) -> &'static str {
        match self {
            Self::Angle => "degrees",
            other => other.units().first().map_or("", |(names, _)| names[0]),
        }
    }

    fn units(self) -> &'static [Unit] {
        match self {
            Self::Number => &[],
            Self::Length => LENGTH,
            Self::Angle => ANGLE,
            Self::Speed => SPEED,
            Self::Density => DENSITY,
            Self::Pressure => PRESSURE,
            Self::Force => FORCE,
            Self::Moment => MOMENT,
            Self::Acceleration => ACCELERATION,
            Self::Curvature => CURVATURE,
            Self::ForcePerLength => FORCE_PER_LENGTH,
            Self::MomentPerLength => MOMENT_PER_LENGTH,
            Self::Time => TIME,
            Self::Viscosity => VISCOSITY,
        }
    }

    /// Every accepted spelling of its units.
    pub fn spellings(self) -> impl Iterator<Item = &'static str> {
        self.units().iter().flat_map(|(names, _)| names.iter().copied())
    }

    /// One spelling of each of its units.
    pub(crate) fn units_shown(self) -> Vec<&'static str> {
        self.units().iter().map(|(names, _)| names[0]).collect()
    }

    /// What a value of this dimension may be, in words: the dimension and the accepted units.
    pub fn expected(self) -> String {
        if self == Self::Number {
            return self.name().to_owned();
        }
        let units = self.units_shown();
        format!("{} (a number in {}, or a string with one of {})", self.name(), self.bare_unit(), units.join(", "))
    }

    /// A bare number of a file in SI (rad for angles).
    pub fn bare(self, value: f64) -> f64 {
        if self == Self::Angle { value.to_radians() } else { value }
    }

    /// A number with its unit in SI (rad for angles).
    ///
    /// ```
    /// use hydrostat_files::Dimension;
    ///
    /// assert_eq!(Dimension::Length.parse("8 mm"), Ok(0.008));
    /// assert_eq!(Dimension::Density.parse("1.08 g/cm3"), Ok(1080.0));
    /// assert_eq!(Dimension::Acceleration.parse("2 g"), Ok(19.6133));
    /// assert!(Dimension::Length.parse("8 kPa").is_err());
    /// ```
    ///
    /// # Errors
    /// [`QuantityError`] when there is no number, no unit, or the unit measures something else.
    pub fn parse(self, text: &str) -> Result<f64, QuantityError> {
        let (number, unit) = split(text.trim()).ok_or(QuantityError::NoNumber)?;
        if unit.is_empty() {
            return Err(QuantityError::NoUnit);
        }
        let scale = self.scale(unit).ok_or_else(|| {
            let other = Self::ALL.into_iter().find(|d| d.scale(unit).is_some());
            match other {
                Some(found) => QuantityError::OtherDimension { unit: unit.to_owned(), found },
                None if unit.starts_with(',') => QuantityError::Comma,
                None => QuantityError::UnknownUnit { unit: unit.to_owned(), near: self.near(unit) },
            }
        })?;
        number.in_si(scale).ok_or(QuantityError::TooLarge)
    }

    /// A number with or without unit in SI (rad for angles), and the unit that it is written with.
    ///
    /// ```
    /// use hydrostat_files::Dimension;
    ///
    /// assert_eq!(Dimension::Force.read("200 mN"), Ok((0.2, Some("mN"))));
    /// assert_eq!(Dimension::Force.read("0.2"), Ok((0.2, None)));
    /// assert_eq!(Dimension::Angle.read("180"), Ok((std::f64::consts::PI, None)));
    /// ```
    ///
    /// # Errors
    /// [`QuantityError`] when there is no number, or the unit measures something else.
    pub fn read(self, text: &str) -> Result<(f64, Option<&'static str>), QuantityError> {
        match split(text.trim()) {
            Some((number, "")) => {
                number.in_si(Decimal(0)).map(|value| (self.bare(value), None)).ok_or(QuantityError::TooLarge)
            }
            Some((_, unit)) => Ok((self.parse(text)?, self.spellings().find(|known| *known == unit))),
            None => Err(QuantityError::NoNumber),
        }
    }

    /// How many of `unit` an SI unit (rad for angles) is; `None` for what is no unit of this dimension.
    ///
    /// ```
    /// use hydrostat_files::Dimension;
    ///
    /// assert_eq!(Dimension::Length.per_si("mm"), Some(1000.0));
    /// assert_eq!(Dimension::Angle.per_si("rad"), Some(1.0));
    /// assert_eq!(Dimension::Angle.per_si("N"), None);
    /// ```
    pub fn per_si(self, unit: &str) -> Option<f64> {
        Some(match self.scale(unit)? {
            Decimal(power) => 10.0_f64.powi(i32::try_from(-power).ok()?),
            Ratio(times, over) => over / times,
            Degrees => 1.0_f64.to_degrees(),
        })
    }

    /// The unit that may be meant: the same letters, or those that a written-out name begins with.
    fn near(self, unit: &str) -> Option<&'static str> {
        let begins = |known: &&str| {
            known.len() > 1 && unit.get(..known.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(known))
        };
        let longest = self.spellings().filter(begins).max_by_key(|known| known.len());
        self.spellings().find(|known| known.eq_ignore_ascii_case(unit)).or(longest)
    }

    fn scale(self, unit: &str) -> Option<Scale> {
        self.units().iter().find(|(names, _)| names.contains(&unit)).map(|(_, scale)| *scale)
    }
}

impl Dimension {
    /// [`Dimension::read`] for the value of a key, which may stand in quotes.
    pub(crate) fn value_of(self, key: &str, text: &str) -> Result<(f64, Option<&'static str>), WrongValue> {
        let text = text.trim().trim_matches('"').trim();
        let wrong = |source| WrongValue { key: key.to_owned(), dimension: self, text: text.to_owned(), source };
        self.read(text).map_err(wrong)
    }
}

/// A text that is no value of a key.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: expected {}, found \"{}\": {source}", shortened(.key), .dimension.expected(), shortened(.text))]
pub struct WrongValue {
    /// The key.
    pub key: String,
    /// What it measures.
    pub dimension: Dimension,
    /// What was given.
    pub text: String,
    /// What is wrong with it.
    pub source: QuantityError,
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Why a string is not a quantity of some dimension.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum QuantityError {
    /// It does not start with a number.
    #[error("it does not start with a number")]
    NoNumber,
    /// A number only.
    #[error("it has no unit")]
    NoUnit,
    /// A unit that nothing has.
    #[error("the unit `{}` is not known{}", crate::error::shortened(.unit), .near.map_or_else(String::new, |near| format!("; did you mean `{near}`?")))]
    UnknownUnit {
        /// The unit.
        unit: String,
        /// One that is known and may be meant.
        near: Option<&'static str>,
    },
    /// A comma in a number.
    #[error("the number contains a comma; write decimals with a point, and thousands without a separator")]
    Comma,
    /// A unit of another dimension.
    #[error("`{unit}` is the unit of {found}")]
    OtherDimension {
        /// The unit.
        unit: String,
        /// What it measures.
        found: Dimension,
    },
    /// A number beyond the largest that can be represented.
    #[error("the number is too large")]
    TooLarge,
}

/// A decimal number as text: mantissa and power of ten.
struct DecimalText<'a> {
    mantissa: &'a str,
    exponent: i64,
}

impl DecimalText<'_> {
    fn in_si(&self, scale: Scale) -> Option<f64> {
        let read = |shift: i64| -> Option<f64> {
            let exponent = self.exponent.saturating_add(shift);
            format!("{}e{exponent}", self.mantissa).parse().ok()
        };
        let value = match scale {
            Decimal(shift) => read(shift)?,
            Ratio(times, over) => read(0)? * times / over,
            Degrees => read(0)?.to_radians(),
        };
        value.is_finite().then_some(value)
    }
}

/// What a fraction such as "70 %" is of one.
pub(crate) fn percent(text: &str) -> Option<f64> {
    let (number, unit) = split(text.trim())?;
    if unit == "%" { number.in_si(Decimal(-2)) } else { None }
}

/// The number that a text is, without a unit.
pub(crate) fn bare_number(text: &str) -> Option<f64> {
    match split(text.trim())? {
        (number, "") => number.in_si(Decimal(0)),
        _ => None,
    }
}

/// The number at the start of `text`, `None` where it is too large, and what stands behind it.
pub(crate) fn parted(text: &str) -> Option<(Option<f64>, &str)> {
    split(text.trim()).map(|(number, unit)| (number.in_si(Decimal(0)), unit))
}

/// The number at the start of `text`, and the rest without the space between.
fn split(text: &str) -> Option<(DecimalText<'_>, &str)> {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut at = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let whole = digits(at);
    at += whole;
    let mut decimals = 0;
    if bytes.get(at) == Some(&b'.') {
        decimals = digits(at + 1);
        at += 1 + decimals;
    }
    if whole + decimals == 0 {
        return None;
    }
    let mantissa = &text[..at];
    let mut exponent = 0;
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        let n = bytes.get(at + 1 + sign..).map_or(0, |_| digits(at + 1 + sign));
        if n > 0 {
            let end = at + 1 + sign + n;
            let negative = bytes[at + 1] == b'-';
            exponent = text[at + 1..end].parse().unwrap_or(if negative { i64::MIN } else { i64::MAX });
            at = end;
        }
    }
    Some((DecimalText { mantissa, exponent }, text[at..].trim_start()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_become_si() {
        use Dimension as D;
        let cases: &[(D, &str, f64)] = &[
            (D::Length, "8 mm", 0.008),
            (D::Length, "245mm", 0.245),
            (D::Length, "0.1 mm", 1e-4),
            (D::Length, " 1.5e-1 m ", 0.15),
            (D::Length, "-3 \u{b5}m", -3e-6),
            (D::Length, "10 in", 0.254),
            (D::Angle, "30 deg", std::f64::consts::FRAC_PI_6),
            (D::Angle, "-90\u{b0}", -std::f64::consts::FRAC_PI_2),
            (D::Angle, "0.5 rad", 0.5),
            (D::Speed, "0.5 m/s", 0.5),
            (D::Speed, "3.6 km/h", 1.0),
            (D::Density, "1.08 g/cm3", 1080.0),
            (D::Density, "1022 kg/m^3", 1022.0),
            (D::Pressure, "110 kPa", 110e3),
            (D::Pressure, ".1 MPa", 1e5),
            (D::Force, "150 mN", 0.15),
            (D::Force, "100 gf", 0.980_665),
            (D::Moment, "2 N mm", 0.002),
            (D::Moment, "3 Nm", 3.0),
            (D::Acceleration, "2 g", 19.6133),
            (D::Acceleration, "9.81 m/s2", 9.81),
            (D::Curvature, "5 1/m", 5.0),
            (D::Curvature, "5/m", 5.0),
            (D::Curvature, "180 deg/m", std::f64::consts::PI),
            (D::ForcePerLength, "3 mN/m", 0.003),
            (D::MomentPerLength, "3 N m/m", 3.0),
        ];
        for (dimension, text, want) in cases {
            let got = dimension.parse(text).unwrap();
            assert!((got - want).abs() <= f64::EPSILON * want.abs(), "{text}: {got} {want}");
        }
    }

    #[test]
    fn bad_quantities_say_why() {
        use QuantityError as E;
        let length = |text: &str| Dimension::Length.parse(text).unwrap_err();
        assert_eq!(length("mm"), E::NoNumber);
        assert_eq!(length(""), E::NoNumber);
        assert_eq!(length("."), E::NoNumber);
        assert_eq!(length("inf m"), E::NoNumber);
        assert_eq!(length("8"), E::NoUnit);
        assert_eq!(length("8 MM"), E::UnknownUnit { unit: "MM".to_owned(), near: Some("mm") });
        assert_eq!(length("8 e"), E::UnknownUnit { unit: "e".to_owned(), near: None });
        assert_eq!(length("245,5 mm"), E::Comma);
        assert_eq!(length("1,000"), E::Comma);
        assert_eq!(length("8 kPa"), E::OtherDimension { unit: "kPa".to_owned(), found: Dimension::Pressure });
        assert_eq!(length("1e999 m"), E::TooLarge);
        assert_eq!(length("1e99999999999999999999 m"), E::TooLarge);
        assert_eq!(Dimension::Length.parse("1e-99999999999999999999 m"), Ok(0.0));
        assert!(matches!(Dimension::Number.parse("0.5 m"), Err(E::OtherDimension { .. })));
    }

    #[test]
    fn units_that_may_be_meant_are_named() {
        let said = |dimension: Dimension, text: &str| dimension.parse(text).unwrap_err().to_string();
        assert_eq!(said(Dimension::Pressure, "150 kpa"), "the unit `kpa` is not known; did you mean `kPa`?");
        assert_eq!(said(Dimension::Speed, "2 knots"), "the unit `knots` is not known; did you mean `kn`?");
        assert_eq!(said(Dimension::Angle, "30 degrees"), "the unit `degrees` is not known; did you mean `deg`?");
        assert_eq!(said(Dimension::Speed, "2 mph"), "the unit `mph` is not known");
        assert_eq!(said(Dimension::Length, "2 \u{fc}mm"), "the unit `\u{fc}mm` is not known");
    }

    #[test]
    fn no_spelling_means_two_things_in_one_dimension() {
        for dimension in Dimension::ALL {
            let mut all: Vec<&str> = dimension.spellings().collect();
            let n = all.len();
            all.sort_unstable();
            all.dedup();
            assert_eq!(all.len(), n, "{dimension}");
        }
    }
}
