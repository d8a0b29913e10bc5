//! The one place that turns errors into messages and exit codes.

use std::f64::consts::TAU;
use std::io;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use hydrostat::{SolveError, SpatialConfiguration, SpatialError, VerdictKind};
use hydrostat_figures::source::StudyError;
use hydrostat_files::WriteError;

use crate::cause::{Blame, Cause};
use crate::command::Advised;
use crate::say;

/// Arguments, arm file or output path are wrong.
const WRONG_REQUEST: u8 = 2;
/// The arm has no such equilibrium, or it was not found.
const NO_EQUILIBRIUM: u8 = 3;
/// Anything else.
const OTHER: u8 = 1;
/// Ended by Ctrl-C: what shells make of a program that its signal ended.
const INTERRUPTED: u8 = 130;

/// Of a command's outcome; says on standard error what went wrong.
pub(crate) fn of(result: anyhow::Result<()>) -> ExitCode {
    let Err(error) = result else { return ExitCode::SUCCESS };
    if is_broken_pipe(&error) {
        // Whoever read standard output has seen enough: `hydrostat arms | head -1` is no failure.
        return ExitCode::SUCCESS;
    }
    // The first message says it all: those of the libraries carry what caused them.
    say::error(&error);
    if let Some(seen) = last_seen(&error) {
        say::note(seen);
    }
    if let Some(advice) = advice(&error) {
        say::advice(advice);
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
            say::line(format_args!("\n{words}"));
            std::process::exit(i32::from(INTERRUPTED));
        }
    });
}

/// From now on Ctrl-C raises the flag, so that what is there can be written; a second one ends the program at once.
pub(crate) fn flag_at_ctrl_c() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    std::thread::spawn(move || {
        let Ok(runtime) = tokio::runtime::Builder::new_current_thread().enable_all().build() else { return };
        while runtime.block_on(tokio::signal::ctrl_c()).is_ok() {
            if raised.swap(true, Ordering::Relaxed) {
                std::process::exit(i32::from(INTERRUPTED));
            }
        }
    });
    flag
}

/// Of arguments that the parser refused, or of a request for help.
pub(crate) fn of_usage(error: &clap::Error) -> ExitCode {
    if error.use_stderr() { ExitCode::from(WRONG_REQUEST) } else { ExitCode::SUCCESS }
}

/// Of a panic, whose message has been printed.
pub(crate) fn defect() -> ExitCode {
    say::error("this is a bug in the program, not a mistake in the request");
    ExitCode::from(OTHER)
}

fn code(error: &anyhow::Error) -> u8 {
    match Cause::behind(error).map_or(Blame::Other, |cause| cause.blame()) {
        Blame::Request => WRONG_REQUEST,
        Blame::Arm => NO_EQUILIBRIUM,
        Blame::User => INTERRUPTED,
        Blame::Other => OTHER,
    }
}

fn advice(error: &anyhow::Error) -> Option<&str> {
    if let Some(advised) = error.chain().find_map(|cause| cause.downcast_ref::<Advised>()) {
        return Some(advised.advice());
    }
    let cause = Cause::behind(error)?;
    if let Cause::Study(StudyError::NoTension { .. }) = cause {
        return Some(
            "this figure needs an arm whose tip section turns that far, such as `paper` and `paper-statements`; \
             `hydrostat path ARM --vary cable.0.tension=FROM:TO --plot-shapes FILE` draws any arm under a rising tension",
        );
    }
    if let Some(SpatialError::NoEquilibrium(failure)) = cause.solve_in_space() {
        return Some(failure.verdict.advice());
    }
    match cause.solve()? {
        SolveError::NoEquilibrium(failure) => Some(failure.verdict.advice()),
        SolveError::Arm(_) | SolveError::Option { .. } => None,
    }
}

/// The last shape on the way, where the solver gave up without a limit of the arm: what is far from any arm shows there.
fn last_seen(error: &anyhow::Error) -> Option<String> {
    let cause = Cause::behind(error)?;
    if let Some(SpatialError::NoEquilibrium(failure)) = cause.solve_in_space() {
        let shape = failure.last_good.as_ref().filter(|_| failure.verdict.kind == VerdictKind::NotFound)?;
        return Some(last_in_space(shape));
    }
    let SolveError::NoEquilibrium(failure) = cause.solve()? else { return None };
    if failure.verdict.kind != VerdictKind::NotFound {
        return None;
    }
    let shape = failure.last_good.as_ref()?;
    let turns = (shape.tip().theta - shape.arm.base.angle) / TAU;
    Some(format!(
        "in the last shape that was found the tip is turned by {turns:.2} turns, with a fold margin of {:.3} (below 0 the surface passes \
         through itself)",
        shape.fold_margin().value
    ))
}

/// In space no angle says how far the tip is turned: what counts is how much the arm bends and twists on the way to it.
fn last_in_space(shape: &SpatialConfiguration) -> String {
    let st = &shape.stations;
    let over = |rate: &dyn Fn(usize) -> f64| -> f64 {
        (1..st.len()).map(|k| 0.5 * (rate(k - 1) + rate(k)) * (st.s[k] - st.s[k - 1])).sum::<f64>() / TAU
    };
    let bent = over(&|k| st.kappa[k].hypot(st.mu[k]));
    let twisted = over(&|k| st.tau[k].abs());
    format!(
        "in the last shape that was found the arm bends by {bent:.2} turns and twists by {twisted:.2} turns from base to tip, with a fold \
         margin of {:.3} (below 0 the surface passes through itself)",
        shape.fold_margin().value
    )
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let kind = |cause: &(dyn std::error::Error + 'static)| cause.downcast_ref::<io::Error>().map(io::Error::kind);
    // Only standard output is a pipe that may break; files fail with `WriteError`.
    !error.chain().any(<dyn std::error::Error>::is::<WriteError>)
        && error.chain().filter_map(kind).any(|k| k == io::ErrorKind::BrokenPipe)
}
