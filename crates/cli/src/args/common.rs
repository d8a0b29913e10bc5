//! Arguments of several commands.

use clap::{Args as ClapArgs, ValueEnum};
use hydrostat_files::{Dimension, shared_unit};

/// What `stable` means wherever it is said.
pub(super) const STABLE: &str = "\
Stable means stable against static divergence, for overdamped motion (docs/model.md, section 7).
Flutter is a dynamic instability: see `hydrostat modes`.";

// An arm and what is to be different from its file. As a doc comment this would replace the help of each command.
#[derive(Debug, ClapArgs)]
pub(crate) struct ArmArgs {
    /// Arm file, name of a shipped arm (see `hydrostat arms`), or - for standard input
    #[arg(value_name = "ARM")]
    pub(crate) file: String,
    /// Tensions of all cables in their order, N, such as 20,0
    #[arg(long, value_name = "T,T,...", value_delimiter = ',', allow_hyphen_values = true)]
    pub(crate) tension: Option<Vec<String>>,
    /// Speed of the stream, m/s
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true)]
    pub(crate) flow_speed: Option<String>,
    // A doc comment would take [0] for a link.
    #[arg(
        long,
        value_name = "KEY=VALUE",
        allow_hyphen_values = true,
        help = "Override a value of the arm file, such as 'cable[0].tension=20 N' or cable.0.tension=20. Repeatable"
    )]
    pub(crate) set: Vec<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum Format {
    #[default]
    Text,
    Json,
    Csv,
}

/// A whole number of at least 2.
pub(super) fn count(text: &str, most: usize) -> Result<usize, String> {
    match text.parse() {
        Ok(n) if (2..=most).contains(&n) => Ok(n),
        _ => Err(format!("expected a whole number from 2 to {most}")),
    }
}

/// Numbers of one dimension with commas between them, in SI units; a unit after the last one holds for all. `name` is what one of them is
/// called.
pub(super) fn list(dimension: Dimension, name: &str, text: &str) -> Result<Vec<f64>, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let texts = shared_unit(dimension, name, &parts, ",").map_err(|error| error.to_string())?;
    let one = |part: &String| match dimension.read(part) {
        Ok((value, _)) => Ok(value),
        Err(error) => Err(format!("expected {}, found \"{part}\": {error}", dimension.expected())),
    };
    texts.iter().map(one).collect()
}
