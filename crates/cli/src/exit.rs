//! The one place that turns errors into messages and exit codes.

use std::io;
use std::process::ExitCode;

use hydrostat::{PathError, ReachError, SensitivityError, SolveError};
use hydrostat_figures::source::StudyError;
use hydrostat_files::{FileError, FitKeyError, MeasurementsError, TargetsError, WriteError};
use hydrostat_identify::{IdentifyError, Trial};
use hydrostat_serve::ServeError;
use hydrostat_sweep::SweepError;

use crate::command::{Advised, NoAnswer};
use crate::request::WrongRequest;

/// Arguments, arm file or output path are wrong.
const WRONG_REQUEST: u8 = 2;
/// The arm has no such equilibrium, or it was not found.
const NO_EQUILIBRIUM: u8 = 3;
/// Anything else.
const OTHER: u8 = 1;
/// Ended by Ctrl-C: what shells make of a program that its signal ended.
const INTERRUPTED: i32 = 130;

/// Of a command's outcome; says on standard error what went wrong.
pub(crate) fn of(result: anyhow::Result<()>) -> ExitCode {
    let Err(error) = result else { return ExitCode::SUCCESS };
    if is_broken_pipe(&error) {
        // Whoever read standard output has seen enough: `hydrostat arms | head -1` is no failure.
        return ExitCode::SUCCESS;
    }
    // The first message says it all: those of the libraries carry what caused them.
    eprintln!("error: {error}");
    if let Some(advice) = advice(&error) {
        eprintln!("try: {advice}");
    }
    ExitCode::from(code(&error))
}

/// From now on Ctrl-C ends the program at once, after these words.
pub(crate) fn at_ctrl_c(words: &'static str) {
    std::thread::spawn(move || {
        // Without it Ctrl-C ends the program as ever.
        let Ok(runtime) = tokio::runtime::Builder::new_current_thread().enable_all().build() else { return };
        if runtime.block_on(tokio::signal::ctrl_c()).is_ok() {
            // The terminal shows ^C, and a bar may stand there.
            eprintln!("\n{words}");
            std::process::exit(INTERRUPTED);
        }
    });
}

/// Of arguments that the parser refused, or of a request for help.
pub(crate) fn of_usage(error: &clap::Error) -> ExitCode {
    if error.use_stderr() { ExitCode::from(WRONG_REQUEST) } else { ExitCode::SUCCESS }
}

/// Of a panic, whose message has been printed.
pub(crate) fn defect() -> ExitCode {
    eprintln!("error: this is a defect of the program, not of the request");
    ExitCode::from(OTHER)
}

fn code(error: &anyhow::Error) -> u8 {
    for cause in error.chain() {
        if let Some(solve) = solve_error(cause) {
            return match solve {
                SolveError::Arm(_) | SolveError::Option { .. } => WRONG_REQUEST,
                SolveError::NoEquilibrium(_) => NO_EQUILIBRIUM,
            };
        }
        if cause.is::<NoAnswer>() {
            return NO_EQUILIBRIUM;
        }
        if let Some(
            PathError::Value { .. }
            | PathError::Option { .. }
            | PathError::Support
            | PathError::Stroke { .. }
            | PathError::Friction { .. },
        ) = cause.downcast_ref()
        {
            return WRONG_REQUEST;
        }
        if cause.downcast_ref().is_some_and(asks_for_no_derivative) {
            return WRONG_REQUEST;
        }
        if let Some(error) = reach_error(cause) {
            match error {
                ReachError::NoCables | ReachError::Target | ReachError::Option { .. } => return WRONG_REQUEST,
                ReachError::Sensitivity(error) if asks_for_no_derivative(error) => return WRONG_REQUEST,
                _ => {}
            }
        }
        // Whatever a sweep cannot do is wrong with its request: keys, values, options, files.
        if matches!(cause.downcast_ref(), Some(error) if !matches!(error, SweepError::Threads(_))) {
            return WRONG_REQUEST;
        }
        if let Some(error) = cause.downcast_ref::<IdentifyError>() {
            return code_of_fit(error);
        }
        if let Some(StudyError::NoCable { .. } | StudyError::Faster { .. } | StudyError::NoTension { .. }) =
            cause.downcast_ref()
        {
            return WRONG_REQUEST;
        }
        if let Some(ServeError::Bind { .. }) = cause.downcast_ref() {
            return WRONG_REQUEST;
        }
        if cause.is::<MeasurementsError>() || cause.is::<FitKeyError>() || cause.is::<TargetsError>() {
            return WRONG_REQUEST;
        }
        if cause.is::<WrongRequest>() || cause.is::<FileError>() || cause.is::<WriteError>() {
            return WRONG_REQUEST;
        }
    }
    OTHER
}

/// Whether derivatives are asked for that this arm cannot have.
fn asks_for_no_derivative(error: &SensitivityError) -> bool {
    matches!(error, SensitivityError::Rubbing(_) | SensitivityError::Support | SensitivityError::Station { .. })
}

/// Where a search cannot start for want of an equilibrium there is none; all else is wrong with the request.
fn code_of_fit(error: &IdentifyError) -> u8 {
    let IdentifyError::Start { source, .. } = error else { return WRONG_REQUEST };
    match source.as_ref() {
        Trial::Sensitivity(
            SensitivityError::Solve(SolveError::NoEquilibrium(_))
            | SensitivityError::Singular
            | SensitivityError::Unsettled(_),
        ) => NO_EQUILIBRIUM,
        _ => WRONG_REQUEST,
    }
}

fn advice(error: &anyhow::Error) -> Option<&str> {
    if let Some(advised) = error.chain().find_map(|cause| cause.downcast_ref::<Advised>()) {
        return Some(advised.advice());
    }
    if let Some(StudyError::NoTension { .. }) = error.chain().find_map(|cause| cause.downcast_ref()) {
        return Some(
            "this figure needs an arm whose tip section turns that far, such as `paper` and `paper-statements`; \
             `hydrostat path ARM --vary cable[0].tension=FROM:TO --plot-shapes FILE` draws any arm under a rising tension",
        );
    }
    error.chain().find_map(solve_error).and_then(|solve| match solve {
        SolveError::NoEquilibrium(failure) => Some(failure.verdict.advice()),
        _ => None,
    })
}

fn solve_error<'a>(cause: &'a (dyn std::error::Error + 'static)) -> Option<&'a SolveError> {
    match cause.downcast_ref::<StudyError>() {
        Some(StudyError::Solve { source, .. }) => Some(source),
        _ => match reach_error(cause) {
            Some(ReachError::Solve(source)) => Some(source),
            _ => cause.downcast_ref::<SolveError>(),
        },
    }
}

fn reach_error<'a>(cause: &'a (dyn std::error::Error + 'static)) -> Option<&'a ReachError> {
    match cause.downcast_ref::<StudyError>() {
        Some(StudyError::Reach(source)) => Some(source),
        _ => cause.downcast_ref::<ReachError>(),
    }
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let kind = |cause: &(dyn std::error::Error + 'static)| cause.downcast_ref::<io::Error>().map(io::Error::kind);
    // Only standard output is a pipe that may break; files fail with `WriteError`.
    !error.chain().any(<dyn std::error::Error>::is::<WriteError>)
        && error.chain().filter_map(kind).any(|k| k == io::ErrorKind::BrokenPipe)
}
