//! The program `hydrostat`: the static shape of a soft arm under water.

mod args;
mod cause;
mod command;
mod exit;
mod input;
mod output;
mod progress;
mod question;
mod rate;
mod request;
mod say;
mod wrong_request;

use std::process::ExitCode;

use clap::Parser;

use args::{Args, Command};

fn main() -> ExitCode {
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(error) => {
            // Help and version go to standard output, usage errors to standard error; a reader that
            // has gone away has seen enough.
            let _ = error.print();
            return exit::of_usage(&error);
        }
    };
    // A defect should not look like a verdict: whatever panics ends with the status of "anything else".
    let outcome = std::panic::catch_unwind(|| match args.command {
        None => command::main_job::run(),
        Some(Command::Solve(args)) => command::solve::run(&args),
        Some(Command::Path(args)) => command::path::run(&args),
        Some(Command::Equilibria(args)) => command::equilibria::run(&args),
        Some(Command::History(args)) => command::history::run(&args),
        Some(Command::Simulate(args)) => command::simulate::run(&args),
        Some(Command::Modes(args)) => command::modes::run(&args),
        Some(Command::Reach(args)) => command::reach::run(&args),
        Some(Command::Workspace(args)) => command::reach::run(&args.into()),
        Some(Command::Identify(args)) => command::identify::run(&args),
        Some(Command::Sweep(args)) => command::sweep::run(&args),
        Some(Command::Plot(args)) => command::plot::run(&args),
        Some(Command::Serve(args)) => command::serve::run(&args),
        Some(Command::Figures(args)) => command::figures::run(&args),
        Some(Command::Init(args)) => command::init::run(&args),
        Some(Command::Arms(args)) => command::arms::run(&args),
        Some(Command::Check(args)) => command::check::run(&args),
        Some(Command::Validate(args)) => command::validate::run(&args),
        Some(Command::Completions(args)) => command::shell::completions(&args),
        Some(Command::Man(args)) => command::shell::man(&args),
    });
    match outcome {
        Ok(result) => exit::of(result),
        Err(_) => exit::defect(),
    }
}
