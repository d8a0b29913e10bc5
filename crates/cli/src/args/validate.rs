//! Arguments of `hydrostat validate`.

use std::path::PathBuf;

use clap::Args as ClapArgs;

const EXIT: &str = "\
Exit status:
  0  every check holds
  1  a check does not hold; the report says which, and is written all the same
  2  the request is wrong: arguments, a directory that cannot be written, a file of other programs' numbers that is none";

/// Runs every check behind the program's claims again and writes a report with numbers and plots.
///
/// Closed forms and tables, orders of convergence, error estimates against true errors, balances, a grid of arms with a map of its
/// verdicts, what the source says about its figure, the readings of the source side by side, the drag of a flexible blade, and the numbers of
/// other programs. Writes index.html, one file that needs no network, and report.md with its figures. Takes some minutes, with --quick some seconds.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat validate -o report
  hydrostat validate --quick

{EXIT}"))]
pub(crate) struct ValidateArgs {
    /// The directory of the report, made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "report")]
    pub(crate) output: PathBuf,
    /// The same checks on fewer cases
    #[arg(long)]
    pub(crate) quick: bool,
    /// Numbers of other programs as `validation/peers/tips.py` wrote them, in place of those that came with this program
    #[arg(long, value_name = "FILE")]
    pub(crate) peers: Option<PathBuf>,
}
