//! What a command can fail with, as one enum.

use std::error::Error;

use hydrostat::{
    AfterSnapError, LoadingError, MotionError, PathError, ReachError, SensitivityError, SolveError, SpatialError,
};
use hydrostat_figures::source::StudyError;
use hydrostat_files::{
    FileError, FitKeyError, MeasurementsError, SavedMotionError, ShapedError, TargetsError, TimeLoadsError, WriteError,
};
use hydrostat_identify::{IdentifyError, Trial};
use hydrostat_serve::ServeError;
use hydrostat_sweep::SweepError;

use crate::command::NoAnswer;
use crate::request::WrongRequest;

/// Who is to blame, which is what exit codes tell apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Blame {
    /// The request: arguments, arm file, data, or an output path.
    Request,
    /// The arm, which has no such equilibrium, or the search, which did not find it.
    Arm,
    /// The user, who did not want it after all.
    User,
    /// Anything else.
    Other,
}

/// An error of a library or of the program.
pub(crate) enum Cause<'a> {
    Solve(&'a SolveError),
    Spatial(&'a SpatialError),
    Path(&'a PathError),
    PathInSpace(&'a PathError<SpatialError>),
    Motion(&'a MotionError),
    AfterSnap(&'a AfterSnapError),
    AfterSnapInSpace(&'a AfterSnapError<SpatialError>),
    Loading(&'a LoadingError),
    TimeLoads,
    SavedMotion,
    Sensitivity(&'a SensitivityError),
    Reach(&'a ReachError),
    ReachInSpace(&'a ReachError<SpatialError>),
    Sweep(&'a SweepError),
    Identify(&'a IdentifyError),
    Study(&'a StudyError),
    Serve(&'a ServeError),
    Measurements,
    FitKey,
    Targets,
    File,
    Write,
    Request(&'a WrongRequest),
    NoAnswer,
}

impl<'a> Cause<'a> {
    /// Of one error of a chain; `None` for those that say nothing here, such as a failure to print.
    pub(crate) fn of(error: &'a (dyn Error + 'static)) -> Option<Self> {
        let found = error.downcast_ref().map(Self::Solve);
        let found = found.or_else(|| error.downcast_ref().map(Self::Spatial));
        let found = found.or_else(|| error.downcast_ref().map(Self::Path));
        let found = found.or_else(|| error.downcast_ref().map(Self::PathInSpace));
        let found = found.or_else(|| error.downcast_ref().map(Self::Motion));
        let found = found.or_else(|| error.downcast_ref().map(Self::AfterSnap));
        let found = found.or_else(|| error.downcast_ref().map(Self::AfterSnapInSpace));
        let found = found.or_else(|| error.downcast_ref().map(Self::Loading));
        let found = found.or_else(|| error.is::<TimeLoadsError>().then_some(Self::TimeLoads));
        let found = found.or_else(|| error.is::<ShapedError>().then_some(Self::TimeLoads));
        let found = found.or_else(|| error.is::<SavedMotionError>().then_some(Self::SavedMotion));
        let found = found.or_else(|| error.downcast_ref().map(Self::Sensitivity));
        let found = found.or_else(|| error.downcast_ref().map(Self::Reach));
        let found = found.or_else(|| error.downcast_ref().map(Self::ReachInSpace));
        let found = found.or_else(|| error.downcast_ref().map(Self::Sweep));
        let found = found.or_else(|| error.downcast_ref().map(Self::Identify));
        let found = found.or_else(|| error.downcast_ref().map(Self::Study));
        let found = found.or_else(|| error.downcast_ref().map(Self::Serve));
        let found = found.or_else(|| error.is::<MeasurementsError>().then_some(Self::Measurements));
        let found = found.or_else(|| error.is::<FitKeyError>().then_some(Self::FitKey));
        let found = found.or_else(|| error.is::<TargetsError>().then_some(Self::Targets));
        let found = found.or_else(|| error.is::<FileError>().then_some(Self::File));
        let found = found.or_else(|| error.is::<WriteError>().then_some(Self::Write));
        let found = found.or_else(|| error.downcast_ref().map(Self::Request));
        found.or_else(|| error.is::<NoAnswer>().then_some(Self::NoAnswer))
    }

    /// The first of a chain that says something.
    pub(crate) fn behind(error: &'a anyhow::Error) -> Option<Self> {
        error.chain().find_map(Self::of)
    }

    /// Every error has its line here: one that is new does not compile until it has one, too.
    pub(crate) fn blame(&self) -> Blame {
        match self {
            Self::Solve(error) => solve(error),
            Self::Spatial(error) => solve_in_space(error),
            Self::Path(error) => path(error, solve),
            Self::PathInSpace(error) => path(error, solve_in_space),
            Self::Motion(error) => motion(error),
            Self::AfterSnap(error) => after_snap(error, solve),
            Self::AfterSnapInSpace(error) => after_snap(error, solve_in_space),
            Self::Loading(error) => loading(error),
            Self::Sensitivity(error) => sensitivity(error, solve),
            Self::Reach(error) => reach(error, solve),
            Self::ReachInSpace(error) => reach(error, solve_in_space),
            Self::Sweep(error) => sweep(error),
            Self::Identify(error) => identify(error),
            Self::Study(error) => study(error),
            Self::Serve(ServeError::Run(_)) => Blame::Other,
            Self::Request(WrongRequest::Declined | WrongRequest::Interrupted(..)) => Blame::User,
            Self::Serve(ServeError::Bind { .. })
            | Self::Measurements
            | Self::FitKey
            | Self::Targets
            | Self::TimeLoads
            | Self::SavedMotion
            | Self::File
            | Self::Write
            | Self::Request(_) => Blame::Request,
            Self::NoAnswer => Blame::Arm,
        }
    }

    /// The failed solve behind it, if that is what it is.
    pub(crate) fn solve(&self) -> Option<&'a SolveError> {
        match self {
            Self::Solve(error) => Some(error),
            Self::Path(PathError::Start { source, .. })
            | Self::AfterSnap(AfterSnapError::Solve(source))
            | Self::Loading(LoadingError::Start(AfterSnapError::Solve(source))) => Some(source),
            Self::Motion(MotionError::Start(source)) | Self::Study(StudyError::Solve { source, .. }) => Some(source),
            Self::Reach(error) => solve_of_reach(error),
            Self::Study(StudyError::Reach(error)) => solve_of_reach(error),
            Self::Spatial(_)
            | Self::Path(_)
            | Self::PathInSpace(_)
            | Self::ReachInSpace(_)
            | Self::Motion(_)
            | Self::AfterSnap(_)
            | Self::AfterSnapInSpace(_)
            | Self::Loading(_)
            | Self::TimeLoads
            | Self::SavedMotion
            | Self::Sensitivity(_)
            | Self::Sweep(_)
            | Self::Identify(_)
            | Self::Study(_)
            | Self::Serve(_)
            | Self::Measurements
            | Self::FitKey
            | Self::Targets
            | Self::File
            | Self::Write
            | Self::Request(_)
            | Self::NoAnswer => None,
        }
    }
}

impl<'a> Cause<'a> {
    /// The failed solve of an arm in space behind it, if that is what it is.
    pub(crate) fn solve_in_space(&self) -> Option<&'a SpatialError> {
        match self {
            Self::Spatial(error) => Some(error),
            Self::PathInSpace(PathError::Start { source, .. })
            | Self::AfterSnapInSpace(AfterSnapError::Solve(source))
            | Self::ReachInSpace(
                ReachError::Solve(source) | ReachError::Sensitivity(SensitivityError::Solve(source)),
            ) => Some(source),
            Self::Motion(MotionError::SpatialStart(source)) => Some(source),
            _ => None,
        }
    }
}

fn solve_of_reach(error: &ReachError) -> Option<&SolveError> {
    match error {
        ReachError::Solve(source) | ReachError::Sensitivity(SensitivityError::Solve(source)) => Some(source),
        ReachError::Sensitivity(_) | ReachError::NoCables | ReachError::Target | ReachError::Option { .. } => None,
    }
}

fn motion(error: &MotionError) -> Blame {
    match error {
        MotionError::Ended(_) => Blame::Arm,
        MotionError::Start(source) => solve(source),
        MotionError::SpatialStart(source) => solve_in_space(source),
        MotionError::Arm(_)
        | MotionError::Unfit(_)
        | MotionError::Unsupported { .. }
        | MotionError::Option { .. }
        | MotionError::State { .. }
        | MotionError::Course { .. } => Blame::Request,
    }
}

fn after_snap<E>(error: &AfterSnapError<E>, solve: fn(&E) -> Blame) -> Blame {
    match error {
        AfterSnapError::Solve(source) => solve(source),
        AfterSnapError::Motion { motion: source, .. } => motion(source),
        AfterSnapError::NoRest { .. } => Blame::Arm,
    }
}

fn loading(error: &LoadingError) -> Blame {
    match error {
        LoadingError::Start(source) => after_snap(source, solve),
        LoadingError::Motion { motion: source, .. } => motion(source),
        LoadingError::Limit { .. } | LoadingError::NoRest { .. } => Blame::Arm,
        LoadingError::Arm(_) | LoadingError::Unsupported { .. } => Blame::Request,
    }
}

fn solve(error: &SolveError) -> Blame {
    match error {
        SolveError::Arm(_) | SolveError::Option { .. } => Blame::Request,
        SolveError::NoEquilibrium(_) => Blame::Arm,
    }
}

fn solve_in_space(error: &SpatialError) -> Blame {
    match error {
        SpatialError::Arm(_) | SpatialError::Option { .. } => Blame::Request,
        SpatialError::NoEquilibrium(_) => Blame::Arm,
    }
}

fn path<E>(error: &PathError<E>, solve: impl Fn(&E) -> Blame) -> Blame {
    match error {
        PathError::Value { .. }
        | PathError::Option { .. }
        | PathError::Support
        | PathError::Stroke { .. }
        | PathError::Friction { .. } => Blame::Request,
        PathError::Start { source, .. } => solve(source),
    }
}

fn sensitivity<E>(error: &SensitivityError<E>, solve: impl Fn(&E) -> Blame) -> Blame {
    match error {
        SensitivityError::Solve(source) => solve(source),
        SensitivityError::Singular | SensitivityError::Unsettled(_) => Blame::Arm,
        SensitivityError::Unfit(_)
        | SensitivityError::Commanded(_)
        | SensitivityError::NotCommanded(_)
        | SensitivityError::Station { .. }
        | SensitivityError::Friction(_)
        | SensitivityError::Support => Blame::Request,
    }
}

fn reach<E>(error: &ReachError<E>, solve: impl Fn(&E) -> Blame) -> Blame {
    match error {
        ReachError::Solve(source) => solve(source),
        ReachError::Sensitivity(source) => sensitivity(source, solve),
        ReachError::NoCables | ReachError::Target | ReachError::Option { .. } => Blame::Request,
    }
}

fn sweep(error: &SweepError) -> Blame {
    match error {
        SweepError::Plan(_)
        | SweepError::Value(_)
        | SweepError::Option(_)
        | SweepError::Shard { .. }
        | SweepError::Exists { .. }
        | SweepError::Begun { .. }
        | SweepError::Other { .. }
        | SweepError::Locked { .. }
        | SweepError::Write(_)
        | SweepError::Read { .. }
        | SweepError::Damaged { .. }
        | SweepError::Stopped => Blame::Request,
        SweepError::Threads(_) => Blame::Other,
    }
}

/// Where a search cannot start for want of an equilibrium there is none; all else is wrong with the request.
fn identify(error: &IdentifyError) -> Blame {
    match error {
        IdentifyError::Start { source, .. } => match source.as_ref() {
            Trial::Sensitivity(source) => sensitivity(source, solve),
            Trial::InSpace(source) => sensitivity(source, solve_in_space),
            Trial::Arm(_) => Blame::Request,
        },
        IdentifyError::NoParameter
        | IdentifyError::NoData
        | IdentifyError::Twice(_)
        | IdentifyError::Range { .. }
        | IdentifyError::Measurement { .. }
        | IdentifyError::Quantity { .. }
        | IdentifyError::Unfit { .. }
        | IdentifyError::Freedom { .. } => Blame::Request,
    }
}

fn study(error: &StudyError) -> Blame {
    match error {
        StudyError::NoCable { .. } | StudyError::Faster { .. } | StudyError::NoTension { .. } => Blame::Request,
        StudyError::Solve { source, .. } => solve(source),
        StudyError::Reach(source) => reach(source, solve),
    }
}
