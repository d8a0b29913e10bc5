//! Arguments of `hydrostat completions` and `hydrostat man`.

use std::path::PathBuf;

use clap::Args as ClapArgs;
use clap_complete::Shell;

/// Prints a script that completes commands and options in a shell.
#[derive(Debug, ClapArgs)]
#[command(after_help = "\
Examples:
  hydrostat completions bash > ~/.local/share/bash-completion/completions/hydrostat
  hydrostat completions zsh > \"${fpath[1]}/_hydrostat\"
  hydrostat completions fish > ~/.config/fish/completions/hydrostat.fish")]
pub(crate) struct CompletionsArgs {
    /// Shell
    #[arg(value_enum)]
    pub(crate) shell: Shell,
}

/// Prints the manual page of the program or of a command, or writes all pages into a directory.
#[derive(Debug, ClapArgs)]
#[command(after_help = "\
Examples:
  hydrostat man solve | man -l -
  hydrostat man -o ~/.local/share/man/man1")]
pub(crate) struct ManArgs {
    /// Command [default: the program]
    #[arg(value_name = "COMMAND", conflicts_with = "output")]
    pub(crate) command: Option<String>,
    /// Write the pages of all commands into DIR, created if it does not exist
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}
