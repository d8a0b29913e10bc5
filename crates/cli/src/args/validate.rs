//! Arguments of `hydrostat validate`.

use std::path::PathBuf;

use clap::Args as ClapArgs;

const EXIT: &str = "\
Exit status:
  0  all checks hold
  1  a check fails; the report is written and names it
  2  wrong request: arguments, a directory that cannot be written,
     or a --peers file that cannot be read";

/// Runs all validation checks and writes a report with numbers and plots.
///
/// The checks are closed-form solutions and published tables, orders of convergence, error estimates against true errors, force
/// balances, a grid of arms with a map of verdicts, the statements of the source about its figure, the readings of the source compared,
/// the drag of a flexible blade, and comparisons with other programs. The report is index.html, which needs no network, and
/// report.md with its figures. It takes minutes; with --quick, seconds.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat validate -o report
  hydrostat validate --quick

{EXIT}"))]
pub(crate) struct ValidateArgs {
    /// Directory of the report, created if it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "report")]
    pub(crate) output: PathBuf,
    /// Run the same checks on fewer cases
    #[arg(long)]
    pub(crate) quick: bool,
    /// Results of other programs, written by `validation/peers/tips.py` [default: those included in this program]
    #[arg(long, value_name = "FILE")]
    pub(crate) peers: Option<PathBuf>,
}
