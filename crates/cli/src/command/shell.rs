//! `hydrostat completions` and `hydrostat man`: what shells and manuals take from the program's own help.

use std::path::Path;

use clap::{Command, CommandFactory as _};
use clap_mangen::Man;
use hydrostat_files::write_whole;

use crate::args::{Args, CompletionsArgs, ManArgs};
use crate::output;
use crate::request::WrongRequest;

const NAME: &str = "hydrostat";

pub(crate) fn completions(args: &CompletionsArgs) -> anyhow::Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Args::command(), NAME, &mut text);
    Ok(output::print(&String::from_utf8_lossy(&text))?)
}

pub(crate) fn man(args: &ManArgs) -> anyhow::Result<()> {
    let mut program = Args::command();
    // Names each command as it is called and as its page is: `hydrostat solve`, `hydrostat-solve`.
    program.build();
    if let Some(directory) = &args.output {
        return write_all(&program, directory);
    }
    let page = match &args.command {
        None => page(program)?,
        Some(name) => match program.find_subcommand(name) {
            Some(command) => page(command.clone())?,
            None => return Err(WrongRequest::NoCommand(name.clone(), names(&program)).into()),
        },
    };
    Ok(output::print(&page)?)
}

/// A page for each command, and one for the program.
fn write_all(program: &Command, directory: &Path) -> anyhow::Result<()> {
    output::make_directory(directory)?.keep();
    write_whole(directory.join(format!("{NAME}.1")), page(program.clone())?.as_bytes())?;
    for command in commands(program) {
        let path = directory.join(format!("{NAME}-{}.1", command.get_name()));
        write_whole(path, page(command.clone())?.as_bytes())?;
    }
    Ok(())
}

/// The commands that the help lists, without itself.
fn commands(program: &Command) -> impl Iterator<Item = &Command> {
    program.get_subcommands().filter(|command| !command.is_hide_set() && command.get_name() != "help")
}

fn names(program: &Command) -> Vec<String> {
    commands(program).map(|command| command.get_name().to_owned()).collect()
}

fn page(command: Command) -> anyhow::Result<String> {
    let mut text = Vec::new();
    Man::new(command).render(&mut text)?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}
