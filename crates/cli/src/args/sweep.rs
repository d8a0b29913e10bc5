//! Arguments of `hydrostat sweep`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args as ClapArgs;
use hydrostat_files::Axis;
use hydrostat_sweep::{Format, Output, Sample, Shard};

use super::{ArmArgs, SnapArgs, count};

const EXIT: &str = "\
Exit status:
  0  all rows are written, and at least one has an answer
  2  the request is wrong: arguments, arm file, an output that is there or cannot be written
  3  all rows are written, and none has an answer
  1  anything else
  130  ended by Ctrl-C; --resume goes on";

/// Solves an arm for every combination of values of some keys of its file, or for a sample of them, and writes a row each.
///
/// Rows without an equilibrium are rows with a verdict. Whole parts are written beside the output, into a directory
/// of its name with .parts behind it, and joined at the end: a sweep that was stopped goes on with --resume. Rows are the same to the last bit
/// whatever threads, shards and stops there were, on the same machine.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat sweep paper --vary flow.speed=0:1:101 --vary cable[0].tension=0:80:101 -o out.parquet
  hydrostat sweep silicone --vary \"material.young=80 kPa:150 kPa\" --vary arm.radius.tip=\"1 mm:3 mm\" --sample lhs:500 -o out.csv
  hydrostat sweep paper --vary model.volume=planar,circular,none --vary cable[0].tension=0:80:81 -o out.parquet
  hydrostat sweep my.toml --vary flow.speed=0:1:1001 --vary cable[0].tension=0:2:1001 --shard 3/16 --resume -o part-3.parquet

{EXIT}"))]
pub(crate) struct SweepArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    /// A key of the arm file with its values: `FROM:TO:COUNT`, a list `V1,V2,...`, or `FROM:TO` to draw from. Repeatable; the last one runs fastest
    #[arg(long, value_name = "KEY=VALUES", required = true, allow_hyphen_values = true)]
    pub(crate) vary: Vec<Axis>,
    /// Draw N rows in place of every combination: lhs:N, a Latin hypercube, or sobol:N
    #[arg(long, value_name = "KIND:N")]
    pub(crate) sample: Option<Sample>,
    /// Seed of the sample
    #[arg(long, value_name = "SEED", default_value = "0")]
    pub(crate) seed: u64,
    /// What is written of each row: tip, alpha, strokes, tensions, base, fold, stability, error, warnings, verdict
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        default_value = "tip,alpha,strokes,base,error,warnings,verdict"
    )]
    pub(crate) columns: Vec<Output>,
    /// Write the shape of each row, too, at N equally spaced stations (at least 2)
    #[arg(long, value_name = "N", value_parser = stations)]
    pub(crate) shapes: Option<usize>,
    /// Error of the tip position over the length that is asked for, from 1e-12 to 1e-2
    #[arg(long, value_name = "TOL", default_value = "1e-6", allow_hyphen_values = true)]
    pub(crate) tol: f64,
    #[command(flatten)]
    pub(crate) snaps: SnapArgs,
    /// Solve share I of N only, from 1
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub(crate) shard: Option<Shard>,
    /// Go on with what an earlier run of the same sweep has left, if there is any
    #[arg(long)]
    pub(crate) resume: bool,
    /// Threads [default: as many as the machine has]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub(crate) threads: Option<usize>,
    /// Where the rows go; FILE ends in .parquet or .csv
    #[arg(short, long, value_name = "FILE", value_parser = table)]
    pub(crate) output: PathBuf,
}

/// A path whose ending says how rows are written.
pub(super) fn table(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match Format::of(&path) {
        Some(_) => Ok(path),
        None => Err("expected a file name that ends in .parquet or .csv".to_owned()),
    }
}

fn stations(text: &str) -> Result<usize, String> {
    count(text, 1000)
}

fn threads(text: &str) -> Result<usize, String> {
    const MOST: usize = 1024;
    match text.parse() {
        Ok(threads) if (1..=MOST).contains(&threads) => Ok(threads),
        _ => Err(format!("expected a whole number from 1 to {MOST}")),
    }
}

fn shard(text: &str) -> Result<Shard, String> {
    let number = |text: &str| u64::from_str(text.trim()).ok().filter(|number| *number > 0);
    match text.split_once('/').map(|(index, of)| (number(index), number(of))) {
        Some((Some(index), Some(of))) if index <= of => Ok(Shard { index, of }),
        _ => Err("expected I/N with I from 1 to N, such as 3/16".to_owned()),
    }
}
