//! Arguments, and the help that teaches them.

mod common;
mod equilibria;
mod history;
mod identify;
mod init;
mod modes;
mod path;
mod picture;
mod plot;
mod reach;
mod serve;
mod shell;
mod simulate;
mod snaps;
mod sweep;
mod validate;
mod workspace;

use std::path::PathBuf;

use clap::builder::styling::{AnsiColor, Styles};
use clap::{Args as ClapArgs, Parser, Subcommand};
use hydrostat_files::Dimension;

use common::count;
pub(crate) use common::{ArmArgs, Format};
pub(crate) use equilibria::{EquilibriaArgs, Over};
pub(crate) use history::HistoryArgs;
pub(crate) use identify::IdentifyArgs;
pub(crate) use init::InitArgs;
pub(crate) use modes::ModesArgs;
pub(crate) use path::PathArgs;
pub(crate) use picture::{Form, PageArgs, PictureArgs, form, picture};
pub(crate) use plot::PlotArgs;
pub(crate) use reach::{By, Direction, Point, ReachArgs};
pub(crate) use serve::ServeArgs;
pub(crate) use shell::{CompletionsArgs, ManArgs};
pub(crate) use simulate::{MotionFormat, ShapeTimes, SimulateArgs, StationAt};
pub(crate) use snaps::SnapArgs;
pub(crate) use sweep::SweepArgs;
pub(crate) use validate::ValidateArgs;
pub(crate) use workspace::WorkspaceArgs;

const EXIT: &str = "\
Exit status:
  0  solved
  2  wrong request: arguments, arm file, or an output that cannot be written
  3  there is no such equilibrium, or none was found; standard error says why
  1  any other error";

const EXAMPLES: &str = "\
Examples:
  hydrostat solve silicone --tension 0.5,0 --plot arm.svg   solve a shipped arm and draw it
  hydrostat init my.toml                                    start an arm file of your own
  hydrostat check my.toml                                   show units, defaults and tension limits
  hydrostat solve my.toml --format csv --stations 101 -o my.csv
  hydrostat path silicone --vary 'cable[0].tension=0:0.9'   follow the shapes as a tension rises
  hydrostat equilibria silicone --flow-speed 0.2 --set flow.direction=180
                                                            all shapes under the same loads
  hydrostat history silicone --input loads.csv --plot loading.svg
                                                            load and unload, with snaps
  hydrostat simulate silicone --input loads.csv --until 2s -o motion.csv
                                                            move in time under changing loads
  hydrostat reach silicone --target 0.182,0.078             inverse kinematics
  hydrostat identify silicone data.csv --fit young          fit parameters to measured shapes
  hydrostat sweep silicone --vary flow.speed=0:0.4:21 --vary 'cable[0].tension=0:0.9:31' -o out.csv
  hydrostat serve silicone --open                           drag an arm in the browser
  hydrostat help solve                                      the help of a command";

/// Colours of help and of refused arguments, on a terminal.
const STYLES: Styles = Styles::styled()
    .header(AnsiColor::Green.on_default().bold())
    .usage(AnsiColor::Green.on_default().bold())
    .literal(AnsiColor::Cyan.on_default().bold())
    .placeholder(AnsiColor::Cyan.on_default())
    .error(AnsiColor::Red.on_default().bold())
    .valid(AnsiColor::Green.on_default())
    .invalid(AnsiColor::Yellow.on_default());

/// Computes shapes and motions of soft, cable-driven arms under water.
///
/// Without a command, it solves the arm of the source's figure, compares the statements of the source with the
/// numbers, and writes the figure into ./figures.
#[derive(Debug, Parser)]
#[command(name = "hydrostat", version, after_help = format!("{EXAMPLES}\n\n{EXIT}"), max_term_width = 120, styles = STYLES)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

// The line of each in the list of commands. As a doc comment it would take the place of the whole description, which its arguments have.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    #[command(about = "Solve one arm: shape, forces and cable strokes")]
    Solve(SolveArgs),
    #[command(about = "Follow equilibria while one parameter varies (continuation)", visible_alias = "continue")]
    Path(PathArgs),
    #[command(about = "Find all equilibria under the same loads, with stability")]
    Equilibria(EquilibriaArgs),
    #[command(about = "Follow equilibria along loads that rise and fall, with snaps")]
    History(HistoryArgs),
    #[command(about = "Move the arm in time under loads that change")]
    Simulate(SimulateArgs),
    #[command(about = "Find small motions about the equilibrium: frequencies, damping, flutter")]
    Modes(ModesArgs),
    #[command(about = "Find tensions for tip positions (inverse kinematics)", visible_alias = "inverse")]
    Reach(ReachArgs),
    #[command(about = "Trace the boundary of the tip's workspace")]
    Workspace(WorkspaceArgs),
    #[command(about = "Fit parameters to measured shapes, with confidence intervals")]
    Identify(Box<IdentifyArgs>),
    #[command(about = "Solve grids, lists or samples of parameters into a Parquet or CSV table")]
    Sweep(SweepArgs),
    #[command(about = "Draw a sweep: a map over two keys, and the tip positions")]
    Plot(PlotArgs),
    #[command(about = "Show an arm in the browser and drag it")]
    Serve(ServeArgs),
    #[command(about = "Reproduce Fig. 1 of the source as SVG, PDF, PNG and CSV")]
    Figures(FiguresArgs),
    #[command(about = "Write a commented arm file to start from")]
    Init(InitArgs),
    #[command(about = "List the shipped arms, or print one")]
    Arms(ArmsArgs),
    #[command(about = "Show what an arm file means: units, defaults, tension limits")]
    Check(CheckArgs),
    #[command(about = "Run all validation checks and write a report")]
    Validate(ValidateArgs),
    #[command(about = "Print shell completions")]
    Completions(CompletionsArgs),
    #[command(about = "Print a manual page, or write all pages")]
    Man(ManArgs),
}

/// Solves the arm under its loads and prints the tip, the cables, the base reaction and the margins.
///
/// Results go to standard output, warnings to standard error. Numbers in --tension, --flow-speed and --set are in SI
/// units (angles in degrees) unless they carry a unit: "20 N", "0.5 m/s", "8 mm".
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat solve paper --tension 20,0
  hydrostat solve paper --tension '20 N,0' --flow-speed '50 cm/s' --plot arm.png
  hydrostat solve octopus --set flow.law=quadratic-drag --set 'flow.direction=90 deg' --flow-speed 0.1
  hydrostat solve my.toml --set cable.1.tension=0.4 --set model.volume=circular --format json
  hydrostat init - | hydrostat solve -

{EXIT}"))]
pub(crate) struct SolveArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    /// Tolerance on the tip position, relative to the arm's length, from 1e-12 to 1e-2
    #[arg(long, value_name = "TOL", default_value = "1e-8", allow_hyphen_values = true)]
    pub(crate) tol: f64,
    #[command(flatten)]
    pub(crate) snaps: SnapArgs,
    /// Report N equally spaced stations, at least 2, instead of the mesh nodes
    #[arg(long, value_name = "N", value_parser = stations)]
    pub(crate) stations: Option<usize>,
    /// text: a summary; json: all results; csv: one row per station
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub(crate) format: Format,
    /// Write the result to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Draw the arm to scale; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

/// Reproduces Fig. 1a, 1b and 1c of the source, each as SVG, PDF, PNG and CSV, and compares the source's statements
/// about them with the numbers.
///
/// The source publishes only the flow speed, 0.5 m/s, and alpha(L) = 72.25 deg at the highest tension; the other
/// parameters were found by trial. The lower tensions are 1/16, 1/8, 1/4 and 1/2 of the highest, to one digit. The arm must
/// be able to turn its tip section by that angle: the shipped arms `paper` and `paper-statements` are.
#[derive(Debug, ClapArgs)]
#[command(after_help = "\
Examples:
  hydrostat figures
  hydrostat figures paper-statements --at-highest --faster 1    all statements hold")]
pub(crate) struct FiguresArgs {
    /// Arm file, or name of a shipped arm. The first cable is pulled, the others are slack
    #[arg(value_name = "ARM", default_value = "paper")]
    pub(crate) arm: String,
    /// Compare flow speeds at the highest tension only, not also at half of it
    #[arg(long)]
    pub(crate) at_highest: bool,
    /// Further flow speeds, m/s, above 0.5 m/s and in rising order
    #[arg(long, value_name = "SPEED,...", default_value = "1,2", value_parser = speeds, allow_hyphen_values = true)]
    pub(crate) faster: Speeds,
    /// Output directory, created if it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "figures")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) page: PageArgs,
}

/// Lists the arms that ship with the program. With a name, prints the file of that arm.
#[derive(Debug, ClapArgs)]
pub(crate) struct ArmsArgs {
    /// Arm to print
    pub(crate) name: Option<String>,
}

/// Reads an arm file and prints what it means: SI units, defaults, the Cauchy number of the stream, and the largest
/// tension of each cable.
///
/// Numbers that look like a wrong unit get a warning.
#[derive(Debug, ClapArgs)]
#[command(after_help = "\
Examples:
  hydrostat check my.toml
  hydrostat check my.toml --set arm.length='300 mm' --set material.young='80 kPa'")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
}

/// Speeds, m/s.
#[derive(Debug, Clone)]
pub(crate) struct Speeds(pub(crate) Vec<f64>);

fn speeds(text: &str) -> Result<Speeds, String> {
    common::list(Dimension::Speed, "SPEED", text).map(Speeds)
}

/// A number of stations.
fn stations(text: &str) -> Result<usize, String> {
    count(text, 1_000_000)
}
