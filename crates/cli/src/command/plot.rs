//! `hydrostat plot`: pictures of a sweep.

use crate::args::PlotArgs;

pub(crate) fn run(_args: &PlotArgs) -> anyhow::Result<()> {
    Ok(())
}
