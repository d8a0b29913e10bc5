//! Balance of whole arms and of their parts: what acts beyond a section against what its strains carry.
//!
//! The loads are written out a second time (`loads`) and integrated over the dense solution by an adaptive quadrature of
//! its own, so that nothing is shared with the solver but the shape.

use std::sync::atomic::{AtomicUsize, Ordering};

use hydrostat::{Arm, Cavity, Configuration, FlowLaw, Gravity, Options, Profile, SolveError, Solver, VerdictKind};
use rayon::prelude::*;

use crate::loads::{Pair, cross, sectional, spread, stream_load, switches, weight};
use crate::numbers::{larger, size};
use crate::report::{Check, Row, Section, Table};
use crate::scope::{Listener, Scope};
use crate::{readings, shipped};

/// How far a configuration is from balance, over the largest force (or moment) in play.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residuals {
    /// The base reaction against everything that acts on the arm.
    pub whole: f64,
    /// The largest over twelve sections: what its strains carry against everything that acts beyond it.
    pub parts: f64,
    /// The largest over the same sections: n, m and beta as reported against the section law.
    pub law: f64,
}

/// Adds up the loads of a configuration.
///
/// ```
/// let arm = hydrostat::cases::distributed_loads().remove(1).arm;
/// let off = hydrostat_validate::balance::residuals(&arm.solve().unwrap());
/// assert!(off.whole < 1e-8 && off.law < 1e-8);
/// ```
pub fn residuals(solved: &Configuration) -> Residuals {
    let arm = &solved.arm;
    let scale = sizes(solved);
    let base = solved.at(0.0);
    let pieces = pieces(solved);
    let total = beyond(solved, 0.0, &pieces, scale);
    let reaction = &solved.base_reaction;
    let about_base = total[2] - cross([base.x, base.y], [total[0], total[1]]);
    let whole = worst([
        (total[0] + reaction.force[0]) / scale[0],
        (total[1] + reaction.force[1]) / scale[0],
        (about_base + reaction.moment) / scale[1],
    ]);
    let mut out = Residuals { whole, parts: 0.0, law: 0.0 };
    for k in 0..12 {
        let s = arm.length * (f64::from(k) + 0.37) / 12.0;
        let st = solved.at(s);
        let want = beyond(solved, s, &pieces, scale);
        let got = sectional(arm, &st);
        let about = want[2] - cross([st.x, st.y], [want[0], want[1]]);
        let [n1, n2, m] = got.carried;
        let off = worst([(n1 - want[0]) / scale[0], (n2 - want[1]) / scale[0], (m - about) / scale[1]]);
        out.parts = larger(out.parts, off);
        out.law = larger(out.law, got.law);
    }
    out
}

fn worst(values: [f64; 3]) -> f64 {
    values.iter().fold(0.0, |most, v| larger(most, v.abs()))
}

/// Places in [0, 1] on either side of the middle, with the weights of Kronrod-15 and of Gauss-7.
const KRONROD: [[f64; 3]; 8] = [
    [0.0, 0.209_482_141_084_727_83, 0.417_959_183_673_469_4],
    [0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0],
    [0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9],
    [0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0],
    [0.741_531_185_599_394_4, 0.140_653_259_715_525_92, 0.279_705_391_489_276_64],
    [0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0],
    [0.949_107_912_342_758_5, 0.063_092_092_629_978_55, 0.129_484_966_168_869_7],
    [0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0],
];

/// Bisects until Gauss and Kronrod agree to what is `allowed`.
fn integral(f: &dyn Fn(f64) -> [f64; 3], from: f64, to: f64, allowed: [f64; 3], depth: u32) -> [f64; 3] {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let (mut fine, mut rough) = ([0.0; 3], [0.0; 3]);
    for (i, [x, kronrod, gauss]) in KRONROD.into_iter().enumerate() {
        for side in [-1.0, 1.0] {
            if i > 0 || side > 0.0 {
                let v = f(middle + side * x * half);
                for k in 0..3 {
                    fine[k] += half * kronrod * v[k];
                    rough[k] += half * gauss * v[k];
                }
            }
        }
    }
    if depth == 0 || (0..3).all(|k| (fine[k] - rough[k]).abs() <= allowed[k]) {
        return fine;
    }
    let [left, right] = [(from, middle), (middle, to)].map(|(a, b)| integral(f, a, b, allowed, depth - 1));
    [0, 1, 2].map(|k| left[k] + right[k])
}

/// Places between which the spread loads are smooth: those of the arm's own steps, and where a switch of the stream's load
/// changes sign. A rule that bisects comes no nearer to a jump than its last halving, 6e-5 of the length.
fn pieces(solved: &Configuration) -> Vec<f64> {
    const SAMPLES: u32 = 512;
    let arm = &solved.arm;
    let mut out = arm.breaks();
    if arm.flow.speed > 0.0 {
        let at = |s: f64| switches(arm, &solved.at(s));
        let samples: Vec<f64> = (0..=SAMPLES).map(|k| arm.length * f64::from(k) / f64::from(SAMPLES)).collect();
        let values: Vec<[f64; 3]> = samples.iter().map(|s| at(*s)).collect();
        for (ends, values) in samples.windows(2).zip(values.windows(2)) {
            for k in 0..3 {
                if values[0][k] * values[1][k] >= 0.0 {
                    continue;
                }
                let (mut low, mut high) = (ends[0], ends[1]);
                for _ in 0..50 {
                    let middle = 0.5 * (low + high);
                    let same = at(middle)[k] * values[0][k] > 0.0;
                    if same { low = middle } else { high = middle }
                }
                out.push(high);
            }
        }
    }
    out.push(arm.length);
    out.sort_by(f64::total_cmp);
    out
}

/// What the spread loads and the tip add up to beyond `from`: force and moment about the origin.
fn beyond(solved: &Configuration, from: f64, pieces: &[f64], scale: Pair) -> [f64; 3] {
    let arm = &solved.arm;
    let tip = solved.tip();
    let (a, b) = ([tip.theta.cos(), tip.theta.sin()], [-tip.theta.sin(), tip.theta.cos()]);
    let force = [0, 1].map(|k| arm.tip.force[k] + arm.tip.follower[0] * a[k] + arm.tip.follower[1] * b[k]);
    let mut total = [force[0], force[1], arm.tip.moment + cross([tip.x, tip.y], force)];
    let allowed = [1e-9 * scale[0], 1e-9 * scale[0], 1e-9 * scale[1]];
    let mut places = vec![from];
    places.extend(pieces.iter().filter(|s| **s > from));
    for piece in places.windows(2) {
        // No point lies on the ends, where `at` gives the tip's side of a step.
        let part = integral(&|s| spread(arm, &solved.at(s)), piece[0], piece[1], allowed, 14);
        for k in 0..3 {
            total[k] += part[k];
        }
    }
    total
}

/// Sizes of the largest force and moment in play.
fn sizes(solved: &Configuration) -> Pair {
    let arm = &solved.arm;
    let reach = (0..=64)
        .map(|k| {
            let st = solved.at(arm.length * f64::from(k) / 64.0);
            arm.length * stream_load(arm, &st)[0].hypot(stream_load(arm, &st)[1]).max(weight(arm, &st)[1].abs())
        })
        .fold(0.0, f64::max);
    let tensions: f64 = arm.cables.iter().map(|c| c.tension).sum();
    let tip = arm.tip.force[0].hypot(arm.tip.force[1]).max(arm.tip.follower[0].hypot(arm.tip.follower[1]));
    let force = reach.max(tip).max(solved.base_reaction.force[0].hypot(solved.base_reaction.force[1]));
    let moment = (force * arm.length).max(arm.tip.moment.abs()).max(solved.base_reaction.moment.abs());
    [force.max(1e-3 * tensions), moment.max(1e-3 * tensions * arm.radius.at(0.0, arm.length).value)]
}

/// What a balance may be off by at the tolerance 1e-8.
const ALLOWED: f64 = 1e-6;

/// The same where the reading makes loads that jump. Which side of the jump a section is on depends on beta', and beta' on the load: between the
/// places at which the one and the other load change sides, neither or both would do. That gap is about
/// R df / (C1 A) |U| / |u_t'| wide, no tolerance closes it, and the solver's node lies in it. For `silicone` with `closure = "literal"`, where df = 0.05 N/m, it is
/// 3.4e-6 of the length at tolerances from 1e-7 to 1e-11, and a residual of 1.0e-6.
const ALLOWED_AT_JUMPS: f64 = 1e-5;

/// Arms with all kinds of loads, under every reading of the source.
fn arms(scope: Scope) -> Vec<Arm> {
    let mut arms = Vec::new();
    for arm in shipped::arms() {
        for (name, reading) in readings::alternatives() {
            let mut arm = arm.clone();
            arm.name = format!("{}, {name}", arm.name);
            arm.model = reading;
            if let Some(cable) = arm.cables.first_mut() {
                cable.tension = 0.2 * cable.max_tension.unwrap_or(0.0);
            }
            arm.flow.speed = 0.05;
            arm.flow.direction = 1.1;
            arm.gravity = Some(Gravity::default());
            arms.push(arm);
        }
    }
    if scope == Scope::Quick {
        arms = arms.into_iter().step_by(3).collect();
    }
    let mut soft = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    soft.density = 1080.0;
    soft.cables.push(hydrostat::Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.3));
    let named = |name: &str| {
        let mut arm = soft.clone();
        name.clone_into(&mut arm.name);
        arm
    };
    let mut tip = named("cone with tip and distributed loads");
    tip.tip.force = [0.01, -0.004];
    tip.tip.moment = 2e-5;
    tip.tip.follower = [-0.003, 0.002];
    tip.distributed.force = [Profile::linear(0.01, -0.02), Profile::linear(0.0, 0.05)];
    tip.distributed.couple = 1e-4.into();
    tip.base.angle = -0.3;
    arms.push(tip);
    for cavity in [Cavity::Flooded, Cavity::Sealed] {
        let mut hollow = named(&format!("hollow cone, {cavity:?}"));
        hollow.inner_radius = Profile::linear(0.006, 0.001);
        hollow.cavity = cavity;
        hollow.gravity = Some(Gravity::default());
        hollow.flow.speed = 0.05;
        hollow.flow.direction = 0.5;
        arms.push(hollow);
    }
    let mut drag = named("cone in quadratic drag");
    drag.flow.law = FlowLaw::QuadraticDrag { cn: 2.5, ct: 0.005 };
    drag.flow.speed = 0.15;
    drag.flow.direction = 1.3;
    arms.push(drag);
    let mut curved = named("cone curved when unloaded, cable ending at 0.45 L");
    curved.reference.mu = Profile::linear(2.0, -1.0);
    curved.reference.nu = Profile::linear(1.0, 1.02);
    curved.cables[0].offset = 0.0025.into();
    curved.cables[0].end = 0.45;
    curved.flow.speed = 0.05;
    curved.flow.direction = 0.8;
    arms.push(curved);
    arms
}

pub(crate) fn section(scope: Scope, listener: &dyn Listener) -> Section {
    let arms = arms(scope);
    let done = AtomicUsize::new(0);
    let rows: Vec<Row> = arms
        .par_iter()
        .map(|arm| {
            let row = row(arm);
            listener.advances(1 + done.fetch_add(1, Ordering::Relaxed), arms.len());
            row
        })
        .collect();
    let mut table = Table::new(
        "Residuals over the largest force and moment in play, at tol 1e-8",
        "the loads of docs/model.md, sections 2 to 7, written out a second time in crates/validate/src/loads.rs and integrated by an \
         adaptive Gauss-Kronrod rule. The larger of whole and parts is checked; where a \
         reading makes loads that jump, answers are unique only within a gap of some 1e-6 of the length, and 1e-5 is allowed.",
        &["arm and reading", "whole", "parts", "section law"],
    );
    for row in rows {
        table.push(row);
    }
    let mut section = Section::new("balances", "Balances");
    section.text(
        "The support's reaction against everything that acts on the arm; what the strains of twelve sections carry against everything \
         that acts beyond them; contact force, moment and section stretch against the section law. The shipped arms have a fifth of their \
         largest tension on the first cable, weight, and a stream of 0.05 m/s at 63 degrees.",
    );
    section.table(table);
    section
}

fn row(arm: &Arm) -> Row {
    match Solver::new(arm, Options::default()).and_then(|mut solver| solver.solve()) {
        Ok(solved) => {
            let off = residuals(&solved);
            // The section law holds to what Newton leaves there, a tenth of the balance's fraction.
            let checked = larger(larger(off.whole, off.parts), 10.0 * off.law);
            let allowed = if arm.model.load_can_jump() { ALLOWED_AT_JUMPS } else { ALLOWED };
            Row::new([arm.name.clone(), size(off.whole), size(off.parts), size(off.law)])
                .checked(Check::within(checked, allowed))
        }
        Err(SolveError::NoEquilibrium(no)) => {
            let kind = no.verdict.kind;
            let row = Row::new([arm.name.clone(), kind.name().replace('_', " "), String::new(), String::new()]);
            if kind == VerdictKind::NotFound { row.checked(Check::so(false)) } else { row }
        }
        Err(error) => {
            Row::new([arm.name.clone(), error.to_string(), String::new(), String::new()]).checked(Check::so(false))
        }
    }
}
