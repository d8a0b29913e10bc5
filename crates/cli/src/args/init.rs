//! Arguments of `hydrostat init`.

use std::path::PathBuf;

use clap::Args as ClapArgs;

const EXIT: &str = "\
Exit status:
  0  written
  2  wrong request: an unknown arm, or a file that exists or cannot be written
  1  any other error";

/// Writes a commented arm file to start from.
///
/// Without --from it describes a silicone cone with two cables, the left one pulled, in a stream, with measured drag coefficients.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat init                         writes arm.toml
  hydrostat init my.toml --from octopus
  hydrostat init - | hydrostat solve -

{EXIT}"))]
pub(crate) struct InitArgs {
    /// File to write, which must not exist; - is standard output
    #[arg(value_name = "FILE", default_value = "arm.toml")]
    pub(crate) file: PathBuf,
    /// Start from a shipped arm (see `hydrostat arms`)
    #[arg(long, value_name = "ARM")]
    pub(crate) from: Option<String>,
}
