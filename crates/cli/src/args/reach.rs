//! Arguments of `hydrostat reach`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args as ClapArgs, ValueEnum};
use hydrostat_files::{Dimension, shared_unit};

use super::common::STABLE;
use super::{ArmArgs, Format, PictureArgs, picture};

const EXIT: &str = "\
Exit status:
  0  reached (with --path, every target; with --boundary, always)
  2  wrong request: arguments, arm file, or an output that cannot be written
  3  not reached; the closest shape that was found is written
  1  any other error";

/// Inverse kinematics: finds the tensions that bring the tip, or another station, to a target or along a path of targets.
///
/// Each cable has a tension between 0 and its largest; tensions and strokes in the arm file are ignored. Solutions are
/// listed by effort, the sum of the squared tensions. With three or more cables, each solution has the least effort nearby. A path
/// is followed from target to target, starting from the previous tensions. --boundary traces the boundary of the workspace.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat reach silicone --target 0.182,0.078 --max-tension '0.6 N'
  hydrostat reach silicone --target '182,-78 mm' --plot reached.svg
  hydrostat reach paper --target 0.1,0.03 --station 0.15 --flow-speed 0.2
  hydrostat reach multi-bending --target 0.3,0.15 --angle '60 deg'
  hydrostat reach silicone --target 0.182,0.078 --by strokes --max-stroke '20 mm'
  hydrostat reach silicone --target 0.182,0.078 --max-stroke '12 mm'    not reached
  hydrostat reach silicone --path targets.csv --max-tension '0.6 N' --format csv -o followed.csv
  hydrostat reach silicone-spatial --target 0.2,0.05,0.05 --max-tension '0.5 N'
  hydrostat reach silicone --boundary --max-tension '0.6 N' --plot boundary.svg

{STABLE}

{EXIT}"))]
pub(crate) struct ReachArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    /// Target position, m, such as 0.12,0.05 or '120,50 mm'; of an arm in space X,Y,Z
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, group = "what", required_unless_present_any = ["path", "boundary"])]
    pub(crate) target: Option<Point>,
    /// Follow the targets of a CSV file with columns x_m,y_m (or x_mm,y_mm) and optionally angle_deg; - is standard input
    #[arg(long, value_name = "FILE", group = "what")]
    pub(crate) path: Option<PathBuf>,
    /// Trace the boundary of the tip's workspace: tensions at their bounds, singularities, and the last equilibria
    #[arg(long, group = "what")]
    pub(crate) boundary: bool,
    /// Target angle of the section, from e1, deg [default: any]
    #[arg(long, value_name = "ANGLE", value_parser = angle, allow_hyphen_values = true, requires = "target")]
    pub(crate) angle: Option<f64>,
    /// Target direction of the section's normal a of an arm in space, of any length, such as 1,0,-1 [default: any]
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true, requires = "target", conflicts_with = "angle")]
    pub(crate) direction: Option<Direction>,
    /// Station that is to reach the target, m along the arm [default: the tip]
    #[arg(long, value_name = "S", value_parser = length, allow_hyphen_values = true, conflicts_with = "boundary")]
    pub(crate) station: Option<f64>,
    /// Control of the cables: by their tensions, or by the strokes that these tensions give
    #[arg(long, value_name = "WHAT", value_enum, default_value_t, requires = "target")]
    pub(crate) by: By,
    /// Largest tension of every cable, N; limits in the arm file also apply
    #[arg(long, value_name = "T", value_parser = force, allow_hyphen_values = true)]
    pub(crate) max_tension: Option<f64>,
    /// Largest stroke of every taut cable, m
    #[arg(long, value_name = "S", value_parser = length, allow_hyphen_values = true, conflicts_with = "boundary")]
    pub(crate) max_stroke: Option<f64>,
    /// Tolerance on the distance to the target, relative to the arm's length, from 1e-10 to 1e-2 [default: 1e-8]; with --boundary, on tip positions, from 1e-9 to 1e-3 [default: 1e-7]
    #[arg(long, value_name = "TOL", allow_hyphen_values = true)]
    pub(crate) tol: Option<f64>,
    /// Distance between points of the boundary, relative to the arm's length, from 0.001 to 0.1 [default: 0.01]
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, requires = "boundary")]
    pub(crate) spacing: Option<f64>,
    /// text: a table; json: all results except shapes; csv: one row per solution, target or point
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub(crate) format: Format,
    /// Write the result to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Draw the arm at the first solution, or at the closest shape, with the target; or the boundary. FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture, conflicts_with = "path")]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

/// What holds cables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum By {
    #[default]
    Tensions,
    Strokes,
}

/// A place in the plane or in space, m.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Point {
    Plane([f64; 2]),
    Space([f64; 3]),
}

/// Three numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Direction(pub(crate) [f64; 3]);

fn direction(text: &str) -> Result<Direction, String> {
    let wrong = || format!("expected three numbers X,Y,Z that are not all 0, as in 1,0,-1; found \"{text}\"");
    let parts: Vec<f64> =
        text.split(',').map(|part| part.trim().parse()).collect::<Result<_, _>>().map_err(|_| wrong())?;
    match parts[..] {
        [x, y, z] if [x, y, z].iter().all(|v| v.is_finite()) && [x, y, z] != [0.0; 3] => Ok(Direction([x, y, z])),
        _ => Err(wrong()),
    }
}

impl FromStr for Point {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(',').collect();
        let wrong = || format!("expected X,Y, or X,Y,Z of an arm in space, as in 0.12,0.05; found \"{text}\"");
        let names = match parts.len() {
            2 => "X,Y",
            3 => "X,Y,Z",
            _ => return Err(wrong()),
        };
        let texts = shared_unit(Dimension::Length, names, &parts, ",").map_err(|error| error.to_string())?;
        let values = texts.iter().map(|part| length(part)).collect::<Result<Vec<f64>, _>>()?;
        match values[..] {
            [x, y] => Ok(Self::Plane([x, y])),
            [x, y, z] => Ok(Self::Space([x, y, z])),
            _ => Err(wrong()),
        }
    }
}

fn quantity(dimension: Dimension, text: &str) -> Result<f64, String> {
    let found = dimension.read(text.trim().trim_matches('"'));
    found.map(|(value, _)| value).map_err(|error| format!("expected {}: {error}", dimension.expected()))
}

fn length(text: &str) -> Result<f64, String> {
    quantity(Dimension::Length, text)
}

pub(super) fn angle(text: &str) -> Result<f64, String> {
    quantity(Dimension::Angle, text)
}

pub(super) fn force(text: &str) -> Result<f64, String> {
    quantity(Dimension::Force, text)
}
