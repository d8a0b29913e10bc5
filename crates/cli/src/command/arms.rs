//! `hydrostat arms`: what ships with the program.

use std::fmt::Write as _;

use hydrostat_files::shipped;

use crate::args::ArmsArgs;
use crate::output;
use crate::request::WrongRequest;

fn names() -> impl Iterator<Item = &'static str> {
    shipped::names().chain(shipped::spatial_names())
}

pub(crate) fn run(args: &ArmsArgs) -> anyhow::Result<()> {
    if let Some(name) = &args.name {
        let text = shipped::get(name).ok_or_else(|| WrongRequest::UnknownArm(name.clone()))?;
        return Ok(output::print(text)?);
    }
    let widest = names().map(str::len).max().unwrap_or(0);
    let mut out = String::new();
    for name in names() {
        let _ = writeln!(out, "{name:widest$}  {}", shipped::description(name).unwrap_or_default());
    }
    Ok(output::print(&out)?)
}
