//! Arguments, and the help that teaches them.

mod equilibria;
mod identify;
mod path;
mod picture;
mod plot;
mod reach;
mod serve;
mod snaps;
mod sweep;
mod validate;

use std::path::PathBuf;

use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};

pub(crate) use equilibria::{EquilibriaArgs, Over};
pub(crate) use identify::IdentifyArgs;
pub(crate) use path::PathArgs;
pub(crate) use picture::{Form, PageArgs, PictureArgs, form, picture};
pub(crate) use plot::PlotArgs;
pub(crate) use reach::{By, Point, ReachArgs};
pub(crate) use serve::ServeArgs;
pub(crate) use snaps::SnapArgs;
pub(crate) use sweep::SweepArgs;
pub(crate) use validate::ValidateArgs;

const EXIT: &str = "\
Exit status:
  0  solved
  2  the request is wrong: arguments, arm file, an output path that cannot be written
  3  the arm has no such equilibrium, or it was not found; standard error says why
  1  anything else";

/// What `stable` means wherever it is said.
const STABLE: &str = "\
Stable means: against static divergence, with motions that water resists and inertia does not bear
on (docs/model.md, section 7). Flutter, which takes inertia, is beyond statics and is not seen.";

const EXAMPLES: &str = "\
Examples:
  hydrostat                                             remake the source's figure in ./figures
  hydrostat solve paper --plot paper.svg                solve a shipped arm and draw it
  hydrostat solve silicone --tension 0.5,0 --flow-speed 0.2
  hydrostat arms silicone > my.toml                     start an arm file of your own
  hydrostat check my.toml                               see what it means
  hydrostat path silicone --vary cable[0].tension=0:1   follow the shapes as a tension rises
  hydrostat equilibria silicone --flow-speed 0.2 --set flow.direction=180
                                                        all shapes under the same loads
  hydrostat reach silicone --target 0.182,0.078         the tensions that bring the tip there
  hydrostat identify silicone data.csv --fit young      parameters from measured shapes
  hydrostat sweep paper --vary flow.speed=0:1:101 --vary cable[0].tension=0:80:101 -o out.parquet
  hydrostat serve silicone --open                       pull on an arm in the browser
  hydrostat solve my.toml --format csv --stations 101 -o my.csv
  hydrostat validate -o report                          every check again, with numbers and plots";

/// The static shape of a soft arm under water: driven by cables, keeping its volume, in a stream.
///
/// Without a command, solves the arm of the source's figure, prints what its text claims beside
/// what the numbers say, and writes the figure into ./figures.
#[derive(Debug, Parser)]
#[command(name = "hydrostat", version, after_help = format!("{EXAMPLES}\n\n{EXIT}"), disable_help_subcommand = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Solve an arm: shape, forces, cable strokes
    Solve(SolveArgs),
    /// Follow the equilibria over a range of one parameter, through limit points and bifurcations
    Path(PathArgs),
    /// Find all equilibria under the same loads, with their stability
    Equilibria(EquilibriaArgs),
    /// Find the tensions that bring the tip to a place or along a path, or what bounds the places it reaches
    Reach(ReachArgs),
    /// Find parameters of an arm from measured shapes, with intervals and what the data cannot tell
    Identify(Box<IdentifyArgs>),
    /// Solve an arm over grids, lists or samples of any keys of its file, into Parquet or CSV
    Sweep(SweepArgs),
    /// Draw a sweep: a map over two keys, and where the tip goes
    Plot(PlotArgs),
    /// Show an arm in the browser, to pull on
    Serve(ServeArgs),
    /// Remake the source's Fig. 1a, 1b and 1c as SVG, PDF, PNG and CSV
    Figures(FiguresArgs),
    /// List the arms that ship with the program, or print one as TOML
    Arms(ArmsArgs),
    /// Read an arm file and say what it means: units, defaults, Cauchy number, tension limits
    Check(CheckArgs),
    /// Run every check behind the program's claims again, and write a report with numbers and plots
    Validate(ValidateArgs),
}

/// Solves the arm under its loads and prints tip, cables, base reaction and margins.
///
/// Results go to standard output, warnings to standard error. Numbers in --tension, --flow-speed
/// and --set are in SI units (angles in degrees), or have a unit: "20 N", "0.5 m/s", "8 mm".
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat solve paper --tension 20,0
  hydrostat solve paper --tension \"20 N,0\" --flow-speed \"50 cm/s\" --plot arm.png
  hydrostat solve octopus --set flow.law=quadratic-drag --set flow.direction=\"90 deg\" --flow-speed 0.1
  hydrostat solve my.toml --set cable[1].tension=0.4 --set model.volume=circular --format json

{EXIT}"))]
pub(crate) struct SolveArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    /// Error of the tip position over the length that is asked for, from 1e-12 to 1e-2
    #[arg(long, value_name = "TOL", default_value = "1e-8", allow_hyphen_values = true)]
    pub(crate) tol: f64,
    #[command(flatten)]
    pub(crate) snaps: SnapArgs,
    /// Report N equally spaced stations (at least 2) in place of the nodes of the mesh
    #[arg(long, value_name = "N", value_parser = stations)]
    pub(crate) stations: Option<usize>,
    /// text: a summary; json: everything; csv: the stations
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub(crate) format: Format,
    /// Write the result to FILE in place of standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Draw the arm to scale; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

// An arm and what is to be different from its file. As a doc comment this would replace the help of each command.
#[derive(Debug, ClapArgs)]
pub(crate) struct ArmArgs {
    /// An arm file, or the name of a shipped arm (see `hydrostat arms`)
    #[arg(value_name = "ARM")]
    pub(crate) file: String,
    /// Tensions of all cables, in their order, N; as in 20,0
    #[arg(long, value_name = "T,T,...", value_delimiter = ',', allow_hyphen_values = true)]
    pub(crate) tension: Option<Vec<String>>,
    /// Speed of the stream, m/s
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true)]
    pub(crate) flow_speed: Option<String>,
    /// Override a value of the arm file: a dotted path and its value, as in `cable[0].tension="20 N"`
    #[arg(long, value_name = "KEY=VALUE", allow_hyphen_values = true)]
    pub(crate) set: Vec<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum Format {
    #[default]
    Text,
    Json,
    Csv,
}

/// Remakes the source's Fig. 1a, 1b and 1c: twelve files, each part as SVG, PDF, PNG and CSV. Prints what the
/// source says about them beside the numbers.
///
/// Of the figure's parameters only the speed of the stream, 0.5 m/s, and alpha(L) = 72.25 deg at
/// the highest tension are published; the rest was found by trial. Tensions below the highest are
/// sixteenths, eighths, quarters and halves of it, to one digit. The arm has to turn its tip section by that
/// angle: of the shipped arms `paper` and `paper-statements` do.
#[derive(Debug, ClapArgs)]
#[command(after_help = "\
Examples:
  hydrostat figures
  hydrostat figures paper-statements --at-highest --faster 1    all statements hold")]
pub(crate) struct FiguresArgs {
    /// An arm file, or the name of a shipped arm. Its first cable is pulled, the others are slack
    #[arg(value_name = "ARM", default_value = "paper")]
    pub(crate) arm: String,
    /// Compare streams at the highest tension alone, not at half of it, too
    #[arg(long)]
    pub(crate) at_highest: bool,
    /// The streams beside still water and 0.5 m/s, m/s, rising
    #[arg(long, value_name = "SPEED,...", value_delimiter = ',', default_value = "1,2")]
    pub(crate) faster: Vec<f64>,
    /// The directory, made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "figures")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) page: PageArgs,
}

/// Lists the arms that ship with the program. With a name, prints that arm as TOML, to start from.
#[derive(Debug, ClapArgs)]
pub(crate) struct ArmsArgs {
    /// The arm to print
    pub(crate) name: Option<String>,
}

/// Reads an arm file and prints what it means: units resolved, defaults filled in, the Cauchy
/// number of its stream, and the tension at which each cable ends what a section can carry.
#[derive(Debug, ClapArgs)]
pub(crate) struct CheckArgs {
    /// An arm file, or the name of a shipped arm
    pub(crate) arm: String,
}

/// A number of stations.
fn stations(text: &str) -> Result<usize, String> {
    count(text, 1_000_000)
}

/// A whole number of at least 2.
fn count(text: &str, most: usize) -> Result<usize, String> {
    match text.parse() {
        Ok(n) if (2..=most).contains(&n) => Ok(n),
        _ => Err(format!("expected a whole number from 2 to {most}")),
    }
}
