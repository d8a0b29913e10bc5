//! Arguments of `hydrostat sweep`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args as ClapArgs;
use hydrostat_files::Axis;
use hydrostat_sweep::{Format, Output, Sample, Shard};

use super::common::count;
use super::{ArmArgs, SnapArgs};

const EXIT: &str = "\
Exit status:
  0  all rows are written, and at least one has an equilibrium
  2  wrong request: arguments, arm file, or an output that exists or cannot be written
  3  all rows are written, and none has an equilibrium
  1  any other error
  130  interrupted by Ctrl-C or declined; resume with --resume";

/// Solves an arm for all combinations of values of some keys of its file, or for a sample, and writes a table with one row each.
///
/// A row without an equilibrium has a verdict. Finished parts are kept in a directory next to the output, named like it with
/// .parts appended, and joined at the end; resume an interrupted sweep with --resume. On one machine, rows are identical to the last bit
/// for any number of threads, shards and interruptions.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat sweep paper --vary flow.speed=0:1:101 --vary 'cable[0].tension=0:80:101' -o out.parquet
  hydrostat sweep silicone --vary 'material.young=80:150 kPa' --sample lhs:500 -o out.csv
  hydrostat sweep paper --vary model.volume=planar,none --vary cable.0.tension=0:80:81 -o out.csv
  hydrostat sweep my.toml --vary cable.0.tension=0:2:1001 --shard 3/16 --resume -o part-3.parquet

{EXIT}"))]
pub(crate) struct SweepArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    /// Key of the arm file with its values: FROM:TO:COUNT, a list V1,V2,..., or FROM:TO for a sample. Repeatable; the last key varies fastest
    #[arg(long, value_name = "KEY=VALUES", required = true, allow_hyphen_values = true)]
    pub(crate) vary: Vec<Axis>,
    /// Draw a sample of N rows instead of all combinations: lhs:N, a Latin hypercube, or sobol:N, a Sobol sequence
    #[arg(long, value_name = "KIND:N")]
    pub(crate) sample: Option<Sample>,
    /// Seed of the sample
    #[arg(long, value_name = "SEED", default_value = "0")]
    pub(crate) seed: u64,
    /// Columns of the table: tip, alpha, strokes, tensions, base, fold, stability, error, snaps, warnings, verdict
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        default_value = "tip,alpha,strokes,base,error,warnings,verdict"
    )]
    pub(crate) columns: Vec<Output>,
    /// Also write the shape of each row, at N equally spaced stations, at least 2
    #[arg(long, value_name = "N", value_parser = stations)]
    pub(crate) shapes: Option<usize>,
    /// Tolerance on the tip position, relative to the arm's length, from 1e-12 to 1e-2
    #[arg(long, value_name = "TOL", default_value = "1e-6", allow_hyphen_values = true)]
    pub(crate) tol: f64,
    #[command(flatten)]
    pub(crate) snaps: SnapArgs,
    /// Solve only share I of N, counted from 1
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub(crate) shard: Option<Shard>,
    /// Resume an interrupted run of the same sweep; without one, start from the beginning
    #[arg(long)]
    pub(crate) resume: bool,
    /// Number of threads [default: all processors]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub(crate) threads: Option<usize>,
    /// Output table; FILE ends in .parquet or .csv
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
