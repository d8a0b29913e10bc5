//! The arm of a row.

use hydrostat::{Arm, ArmError, Parameter};
use hydrostat_files::{ArmFile, Axis, AxisValue, AxisValues, FileError};

/// How a key gets its value.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Way {
    /// In the arm itself: loads, which change from row to row.
    Load(Parameter),
    /// Through the arm file, as any key can be set.
    File,
}

/// Makes arms of rows.
#[derive(Debug, Clone)]
pub(crate) struct Arms {
    file: ArmFile,
    arm: Arm,
    axes: Vec<Axis>,
    ways: Vec<Way>,
}

/// The arm of the last row, and what the file's keys were in it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Last {
    texts: Vec<String>,
    arm: Option<Result<Arm, String>>,
}

/// A value of one key that makes no arm by itself.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct ValueError(Box<FileError>);

impl From<FileError> for ValueError {
    fn from(error: FileError) -> Self {
        Self(Box::new(error))
    }
}

const OPTION: &str = "--vary";
/// What messages of rows leave out, whose values are not those of one option.
const PREFIX: &str = "--vary ";

impl Arms {
    /// Of a file whose arm is `arm`, with these keys varied.
    ///
    /// # Errors
    /// [`ValueError`] for a key that the file cannot have, and for a value that makes no arm whatever the other keys are.
    pub(crate) fn new(file: &ArmFile, axes: &[Axis]) -> Result<Self, ValueError> {
        let arm = file.arm()?;
        for axis in axes {
            check(file, axis, axes.len() == 1)?;
        }
        let ways = axes.iter().map(|axis| way(&arm, axis)).collect();
        Ok(Self { file: file.clone(), arm, axes: axes.to_vec(), ways })
    }

    /// The arm of the file, which rows vary.
    pub(crate) fn base(&self) -> &Arm {
        &self.arm
    }

    /// The arm with these values, in the order of the keys.
    ///
    /// # Errors
    /// In words, why they do not go together. Loads are looked at when the arm is solved.
    pub(crate) fn arm<'a>(&self, values: &[AxisValue<'_>], last: &'a mut Last) -> Result<&'a Arm, String> {
        let texts: Vec<String> = self.by_way(values, Way::File).map(|(axis, value)| axis.text(value)).collect();
        if texts != last.texts {
            last.arm = None;
        }
        let made = last.arm.get_or_insert_with(|| {
            let made = if texts.is_empty() { Ok(self.arm.clone()) } else { self.through_file(values) };
            made.map_err(|error| error.to_string().trim_start_matches(PREFIX).to_owned())
        });
        last.texts = texts;
        let arm = made.as_mut().map_err(|reason| reason.clone())?;
        for (way, value) in self.ways.iter().zip(values) {
            if let (Way::Load(parameter), AxisValue::Number(value)) = (way, value) {
                // The parameters are those that the arm was seen to have.
                let _ = parameter.set(arm, *value);
            }
        }
        Ok(arm)
    }

    fn by_way<'a>(
        &'a self,
        values: &'a [AxisValue<'a>],
        wanted: Way,
    ) -> impl Iterator<Item = (&'a Axis, AxisValue<'a>)> {
        let all = self.axes.iter().zip(&self.ways).zip(values);
        all.filter(move |((_, way), _)| **way == wanted).map(|((axis, _), value)| (axis, *value))
    }

    fn through_file(&self, values: &[AxisValue<'_>]) -> Result<Arm, FileError> {
        let mut file = self.file.clone();
        for (axis, value) in self.by_way(values, Way::File) {
            file.set_by(OPTION, &axis.key, &axis.text(value))?;
        }
        file.arm()
    }
}

fn way(arm: &Arm, axis: &Axis) -> Way {
    let space = arm.space.as_ref();
    match axis.key.parse() {
        // Angles take the place of directions in space, which the file knows.
        Ok(Parameter::FlowDirection) if space.is_some_and(|space| space.stream.is_some()) => Way::File,
        Ok(Parameter::GravityDirection) if space.is_some_and(|space| space.gravity.is_some()) => Way::File,
        // The tension of a cable whose stroke is commanded takes the stroke's place, which the file knows.
        Ok(Parameter::Tension(cable)) if arm.cables.get(cable).is_none_or(|cable| cable.stroke.is_some()) => Way::File,
        Ok(
            parameter @ (Parameter::Tension(_)
            | Parameter::FlowSpeed
            | Parameter::FlowDirection
            | Parameter::FlowDensity
            | Parameter::TipForce(_)
            | Parameter::TipMoment
            | Parameter::TipFollower(_)),
        ) => Way::Load(parameter),
        Ok(parameter @ (Parameter::GravityAcceleration | Parameter::GravityDirection)) if arm.gravity.is_some() => {
            Way::Load(parameter)
        }
        _ => Way::File,
    }
}

/// Tries the values of a key one at a time, the ends of ranges.
fn check(file: &ArmFile, axis: &Axis, alone: bool) -> Result<(), ValueError> {
    let values: Vec<AxisValue<'_>> = match &axis.values {
        AxisValues::Even { from, to, .. } | AxisValues::Span { from, to } => {
            [from, to].map(|v| AxisValue::Number(*v)).into()
        }
        AxisValues::List(list) => list.iter().map(|v| AxisValue::Number(*v)).collect(),
        AxisValues::Words(words) => words.iter().map(|word| AxisValue::Word(word)).collect(),
    };
    for value in values {
        let mut file = file.clone();
        file.set_by(OPTION, &axis.key, &axis.text(value))?;
        match file.arm() {
            Ok(_) => {}
            Err(FileError::Arm { ref source, .. }) if is_of_a_row(source) || !alone && depends_on_others(source) => {}
            Err(error) => return Err(error.into()),
        }
    }
    Ok(())
}

/// Whether it is a matter of single rows: a range of tensions may go beyond what a cable takes, as loads may go beyond what an arm takes.
fn is_of_a_row(error: &ArmError) -> bool {
    matches!(error, ArmError::TensionAboveMax { .. })
}

/// Whether another key can mend it.
fn depends_on_others(error: &ArmError) -> bool {
    matches!(error, ArmError::InnerRadius { .. } | ArmError::OffsetOutside { .. } | ArmError::TableDoesNotCover { .. })
}
