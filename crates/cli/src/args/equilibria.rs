//! Arguments of `hydrostat equilibria`.

use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use clap::Args as ClapArgs;
use hydrostat_figures::Quantity;
use hydrostat_files::Varied;

use super::common::STABLE;
use super::{ArmArgs, Format, PictureArgs, picture};

const EXIT: &str = "\
Exit status:
  0  at least one equilibrium was found
  2  wrong request: arguments, arm file, or an output that cannot be written
  3  none was found; standard error says why
  1  any other error";

/// Finds all equilibria under the same loads, including those that `solve` does not reach.
///
/// The equilibria for all base angles form one curve that closes after a full turn of the tip. The search follows this
/// curve. If the result says "complete", the curve was closed and there are no other equilibria.
///
/// For an arm in space the search turns the base about axes across it from each equilibrium that it finds. There may be
/// others; the result says so, and says where it is known that one is missing.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat equilibria silicone --flow-speed 0.2 --set flow.direction=180 --plot all.svg
  hydrostat equilibria silicone --set flow.direction=180 --over flow.speed=0.02:0.3:29 --plot-over speeds.svg

{STABLE}

{EXIT}"))]
pub(crate) struct EquilibriaArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    /// Tolerance on the tip position, relative to the arm's length, from 1e-12 to 1e-3
    #[arg(long, value_name = "TOL", default_value = "1e-8", allow_hyphen_values = true)]
    pub(crate) tol: f64,
    /// Stop a search after this many seconds and report the part that it covered; with --over, at each value
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
    pub(crate) time_limit: Option<Duration>,
    /// text: a summary; json: all results except shapes; csv: one row per equilibrium
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub(crate) format: Format,
    /// Write the result to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Draw all shapes to scale; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture, conflicts_with = "over")]
    pub(crate) plot: Option<PathBuf>,
    /// Search at COUNT equally spaced values of a parameter, such as flow.speed=0:0.5:26
    #[arg(long, value_name = "KEY=FROM:TO:COUNT", allow_hyphen_values = true)]
    pub(crate) over: Option<Over>,
    /// Plot a quantity of all equilibria against that parameter; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture, requires = "over")]
    pub(crate) plot_over: Option<PathBuf>,
    /// Quantity of --plot-over: tip.x, tip.y, tip.theta, tip.alpha, or the stroke of a cable, stroke.0
    #[arg(long, value_name = "NAME", default_value = "tip.y")]
    pub(crate) quantity: Quantity,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

fn seconds(text: &str) -> Result<Duration, String> {
    let number = text.parse().ok().filter(|seconds: &f64| *seconds > 0.0);
    let limit = number.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    limit.ok_or_else(|| format!("expected a number of seconds above 0, found \"{text}\""))
}

/// What `--over` asks for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Over {
    pub(crate) varied: Varied,
    pub(crate) count: usize,
}

impl FromStr for Over {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const MOST: usize = 10_000;
        // A key that cannot vary and an end of the range that is no value are the first things to mend.
        let form = || format!("{text}: expected KEY=FROM:TO:COUNT, such as flow.speed=0:0.5:26");
        let (range, count) = text.rsplit_once(':').filter(|(range, _)| range.contains(':')).ok_or_else(form)?;
        let varied = range.parse().map_err(|e: hydrostat_files::VariedError| e.to_string())?;
        match count.trim().trim_matches('"').parse() {
            Ok(count) if (2..=MOST).contains(&count) => Ok(Self { varied, count }),
            _ => Err(format!("{text}: expected a whole number from 2 to {MOST} as COUNT, found \"{count}\"")),
        }
    }
}
