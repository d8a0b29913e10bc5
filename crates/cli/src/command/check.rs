//! `hydrostat check`: what an arm file means.

use std::fmt::Write as _;

use hydrostat::{Arm, Displaced, FlowLaw, Volume};
use hydrostat_files::{arm_to_toml, number};

use super::limits::{Limit, limits};
use crate::args::CheckArgs;
use crate::output;
use crate::request;

pub(crate) fn run(args: &CheckArgs) -> anyhow::Result<()> {
    let arm = request::arm_in_space(&args.arm)?;
    let mut out = String::new();
    let _ = writeln!(out, "# {}: a valid arm. In full, in SI units and degrees:\n", arm.name);
    out.push_str(&arm_to_toml(&arm));
    out.push('\n');
    cauchy(&mut out, &arm);
    weight(&mut out, &arm);
    if arm.space.is_none() {
        tension_limits(&mut out, &arm);
    }
    Ok(output::print(&out)?)
}

/// The stream against the bending stiffness, Ca = 1/2 rho C_n D U^2 L^3 / (EI), with the section at
/// the base and the one at half length: a tapered arm has no single D and EI.
fn cauchy(out: &mut String, arm: &Arm) {
    let (law, cn) = match arm.flow.law {
        FlowLaw::Momentum => ("C_n = pi for the momentum law", std::f64::consts::PI),
        FlowLaw::QuadraticDrag { cn, .. } => ("C_n of the arm file", cn),
    };
    let _ = writeln!(
        out,
        "# Cauchy number Ca = 1/2 rho C_n D U^2 L^3 / (C3 A), {law}; above Ca = 1 the stream bends the arm noticeably:"
    );
    for (place, s) in [("at the base", 0.0), ("at half length", 0.5 * arm.length)] {
        let radius = arm.radius.at(s, arm.length).value;
        let [_, _, stiffness] = arm.stiffness_at(s);
        let ca = 0.5 * arm.flow.density * cn * 2.0 * radius * arm.flow.speed.powi(2) * arm.length.powi(3) / stiffness;
        let _ = writeln!(
            out,
            "#   with D = {} mm and EI = C3 A = {} N m2 {place}: Ca = {}",
            number(2e3 * radius),
            number(stiffness),
            number(ca)
        );
    }
}

/// Which volume law a weight asks for.
fn weight(out: &mut String, arm: &Arm) {
    if arm.gravity.is_none() || arm.model.volume != Volume::Planar {
        return;
    }
    out.push_str(
        "# The arm has weight, and model.volume is \"planar\", the law of the source's figure. Rubber and muscle keep the volume of a\n\
         # round section: use \"circular\" for a real arm.\n",
    );
    if arm.model.displaced == Displaced::Section && arm.flow.density > 0.0 {
        out.push_str(
            "# model.displaced is \"section\": the water displaced grows with the section, so that the arm can float when its cables pull;\n\
             # with \"volume\" it is constant.\n",
        );
    }
}

fn tension_limits(out: &mut String, arm: &Arm) {
    if arm.cables.is_empty() {
        return;
    }
    let _ = writeln!(out, "# Largest tension that the arm carries, in still water without other loads:");
    for (who, limit) in limits(arm) {
        let text = match limit {
            Limit::Reached { tension, why, s: Some(s) } => {
                format!("{} N; beyond it {why}, at s = {} mm", number(tension), number(1e3 * s))
            }
            Limit::Reached { tension, why, s: None } => format!("{} N; beyond it {why}", number(tension)),
            Limit::NoneBelow(tension) => format!("no limit below {} N", number(tension)),
            Limit::Unknown(tension) => format!("not established; shapes were found up to {} N", number(tension)),
        };
        let _ = writeln!(out, "#   {who}: {text}");
    }
}
