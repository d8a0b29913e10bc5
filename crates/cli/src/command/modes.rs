//! `hydrostat modes`: small motions about the equilibrium.

use std::fmt::Write as _;

use hydrostat::{Arm, Modes};
use hydrostat_files::{ModesDocument, mode_kind, number};

use super::simulate::refused;
use super::table::table;
use crate::args::{ModesArgs, ModesFormat};
use crate::output;
use crate::request;

pub(crate) fn run(args: &ModesArgs) -> anyhow::Result<()> {
    let arm = request::arm(&args.arm, "`hydrostat modes`")?;
    request::check_outputs(&[request::arm_input(&args.arm.file)], &[("-o", args.output.as_deref())])?;
    let modes = arm.modes(args.count, args.elements).map_err(refused)?;
    let text = match args.format {
        ModesFormat::Text => summary(&arm, &modes),
        ModesFormat::Json => output::line(ModesDocument::new(&arm, &modes).to_json()),
    };
    output::put(args.output.as_deref(), &text)
}

fn summary(arm: &Arm, modes: &Modes) -> String {
    let mut out = format!("modes  {}\n\n", arm.name);
    let heads = ["mode", "growth rate (1/s)", "angular frequency (rad/s)", "frequency (Hz)", "damping ratio", "kind"];
    let mut rows = vec![heads.map(str::to_owned).to_vec()];
    for (k, mode) in modes.modes.iter().enumerate() {
        let numbers = [mode.rate[0], mode.rate[1], mode.frequency(), mode.damping_ratio()].map(number);
        let mut row = vec![(k + 1).to_string()];
        row.extend(numbers);
        row.push(mode_kind(mode).to_owned());
        rows.push(row);
    }
    out.push_str(&table(&rows, 1));
    let words =
        if modes.is_stable() { "stable: none of these motions grows" } else { "UNSTABLE: a small motion grows" };
    let _ = writeln!(out, "\n{words}");
    out
}
