//! The arm in space: closed forms, a published bend, first integrals, and whatever lies in a plane.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use hydrostat::cases::{Case, Measure, column, column_buckling_load};
use hydrostat::{
    Arm, BaseDirections, Material, Options, Space, SpatialConfiguration, SpatialSolver, SpatialStation, Stability,
    Volume,
};

use crate::numbers::{fixed, larger, size};
use crate::report::{Check, Row, Section, Table};

/// What is asked of each solve.
const TOL: f64 = 1e-11;
/// What an answer may be off, over the known value's size or one, beside the error of the known value.
const ALLOWED: f64 = 1e-10;
/// The same at places between the nodes.
const BETWEEN: f64 = 1e-9;
/// The plane that cases are turned into, about e1, rad.
const TILT: f64 = 0.9;

fn solve(arm: &Arm) -> Option<SpatialConfiguration> {
    SpatialSolver::new(arm, Options::with_tol(TOL)).and_then(|mut solver| solver.solve()).ok()
}

/// The section. Public within the crate, with the planar cases, so that a test can pass wrong numbers and see them found.
pub(crate) fn section(planar: &[Case]) -> Section {
    let mut section = Section::new("space", "Arms in space");
    section.text(
        "The solver of arms in space (docs/model.md, the arm in space), each problem to a tolerance of 1e-11. A deviation may be 1e-10 of the value's size \
         (1e-9 at places between the nodes), and half of the last digit that the reference prints.",
    );
    section.table(helix());
    section.table(bend());
    section.table(double_loads());
    section.table(integrals());
    section.table(plane(planar));
    section
}

/// A rod of one section with EA, GA, EI and GJ (N, N, N m2, N m2) and no change of area.
fn rod(length: f64, [ea, ga, ei, gj]: [f64; 4]) -> Arm {
    let mut arm = Arm::cone(length, 0.1 * length, 0.1 * length, 1.0, 0.0);
    let area = PI * (0.1 * length).powi(2);
    arm.material = Material::Coefficients { c1: (ea / area).into(), c2: (ga / area).into(), c3: (ei / area).into() };
    arm.model.volume = Volume::None;
    arm.space = Some(Space { c4: Some((gj / area).into()), ..Space::default() });
    arm
}

fn helix() -> Table {
    let mut table = Table::new(
        "Helices by natural bending and twist",
        "closed form: radius kappa/(kappa^2 + tau^2), pitch 2 pi tau/(kappa^2 + tau^2), no load; the largest distance from the helix at 21 places.",
        &["kappa, tau (1/m)", "radius (m)", "pitch (m)", "largest distance/L"],
    );
    for (kappa, tau) in [(3.0, 2.0), (8.0, 1.0), (1.0, 12.0)] {
        let mut arm = rod(1.0, [1.0; 4]);
        let space = arm.space.get_or_insert_default();
        (space.kappa, space.tau) = (kappa.into(), tau.into());
        let rate = f64::hypot(kappa, tau);
        let (radius, pitch) = (kappa / (rate * rate), TAU * tau / (rate * rate));
        // About an axis along tau a + kappa b of the base, at the radius from it on the side of -c.
        let axis = [tau / rate, kappa / rate, 0.0];
        let solved = solve(&arm);
        let off = |s: f64| {
            let Some(shape) = &solved else { return f64::NAN };
            let st = shape.at(s);
            let d = [st.x, st.y, st.z + radius];
            let along: f64 = (0..3).map(|k| d[k] * axis[k]).sum();
            let across = (0..3).map(|k| (d[k] - along * axis[k]).powi(2)).sum::<f64>().sqrt();
            (across - radius).hypot(along - pitch * s * rate / TAU)
        };
        let largest = (0..=20).map(|k| off(f64::from(k) / 20.0)).fold(0.0, larger);
        table.push(
            Row::new([format!("{kappa}, {tau}"), fixed(radius, 6), fixed(pitch, 6), size(largest)])
                .checked(Check::within(largest, BETWEEN)),
        );
    }
    table
}

fn bend() -> Table {
    let mut table = Table::new(
        "The 45-degree bend of Bathe and Bolourchi under a load out of its plane",
        "an independent spectral program for this radius (100), square section (1 x 1), E = 1e7, no lateral contraction, shear factor 1, to its nine \
         digits; published tips of several element formulations at 600 are about (47.2, 15.7, 53.4).",
        &["load", "J", "tip here", "known", "distance/L"],
    );
    for (load, j, known) in [
        (600.0, 1.0 / 6.0, [47.150_438_6, 15.684_800_5, 53.474_858_8]),
        (600.0, 0.140_577, [46.891_924_8, 15.557_785_8, 53.607_369_3]),
        (300.0, 1.0 / 6.0, [58.779_122_5, 22.244_780_9, 40.191_891_7]),
    ] {
        let (young, radius) = (1e7, 100.0);
        let length = radius * FRAC_PI_4;
        let mut arm = rod(length, [young, 0.5 * young, young / 12.0, 0.5 * young * j]);
        arm.reference.mu = (1.0 / radius).into();
        arm.space.get_or_insert_default().tip_force = load;
        let tip = solve(&arm).map_or([f64::NAN; 3], |solved| place(&solved));
        let off = apart(tip, known) / length;
        let words = |tip: [f64; 3]| tip.map(|v| fixed(v, 7)).join(", ");
        table.push(
            Row::new([fixed(load, 0), fixed(j, 6), words(tip), words(known), size(off)])
                .checked(Check::within(off, 1e-7 / length + ALLOWED)),
        );
    }
    table
}

fn double_loads() -> Table {
    const NEAR: f64 = 1e-3;
    let mut table = Table::new(
        "Euler's column becomes unstable in two directions at once",
        "P (1 + P (1/GA - 1/EA)) = pi^2 EI/(4 L^2) for a clamped-free rod that is round; the determinant does not change its sign there, unstable \
         directions are counted.",
        &["EA, GA (N)", "known load (N)", "at 0.999 of it", "at 1.001 of it"],
    );
    for (ea, ga) in [(1e6, 3e5), (400.0, 130.0), (100.0, 33.0)] {
        let Some(known) = column_buckling_load(ea, ga) else { continue };
        let at = |fraction: f64| {
            let arm = Arm { space: Some(Space::default()), ..column(ea, ga, fraction * known, 0.0) };
            solve(&arm).and_then(|solved| solved.stability())
        };
        let [below, above] = [1.0 - NEAR, 1.0 + NEAR].map(at);
        let words = |stability: Option<Stability>| match stability {
            Some(Stability::Unstable(count)) => format!("unstable in {count}"),
            Some(other) => other.name().to_owned(),
            None => "not established".to_owned(),
        };
        let so = below == Some(Stability::Stable) && above == Some(Stability::Unstable(2));
        table.push(
            Row::new([format!("{ea}, {ga}"), fixed(known, 8), words(below), words(above)]).checked(Check::so(so)),
        );
    }
    table
}

fn integrals() -> Table {
    let mut table = Table::new(
        "First integrals of Kirchhoff's rod under dead tip loads",
        "the contact force in space, its product with the moment, and the complement of the strain energy with the stretch are the same at every s, \
         with volume = none.",
        &["tip force (N)", "tip moment (N m)", "quantity", "at the tip", "largest change along 20 places"],
    );
    let [ea, ga, ei, gj] = [40.0, 15.0, 0.01, 0.008];
    for (force, moment) in [([0.02, 0.03, -0.015], [0.02, -0.005, 0.01]), ([-0.01, 0.04, 0.02], [0.0, 0.01, -0.02])] {
        let mut arm = rod(1.0, [ea, ga, ei, gj]);
        arm.tip.force = [force[0], force[1]];
        arm.tip.moment = moment[2];
        let space = arm.space.get_or_insert_default();
        (space.tip_force, space.tip_moment) = (force[2], [moment[0], moment[1]]);
        let solved = solve(&arm);
        let along = |s: f64| {
            solved.as_ref().map_or([f64::NAN; 5], |solved| {
                let st = solved.at(s);
                let (n, m) = (in_space(&st, [st.n_a, st.n_b, st.n_c]), in_space(&st, [st.m_a, st.m_b, st.m_c]));
                let complement = 0.5 * (st.m_a.powi(2) / gj + (st.m_b.powi(2) + st.m_c.powi(2)) / ei)
                    + st.n_a
                    + 0.5 * (st.n_a.powi(2) / ea + (st.n_b.powi(2) + st.n_c.powi(2)) / ga);
                [n[0], n[1], n[2], n[0] * m[0] + n[1] * m[1] + n[2] * m[2], complement]
            })
        };
        let tip = along(1.0);
        for (k, quantity) in ["n . e1", "n . e2", "n . e3", "n . m", "complement"].into_iter().enumerate() {
            let off = (0..20).map(|i| (along(f64::from(i) / 20.0)[k] - tip[k]).abs()).fold(0.0, larger);
            table.push(
                Row::new([
                    force.map(|v| v.to_string()).join(", "),
                    moment.map(|v| v.to_string()).join(", "),
                    quantity.to_owned(),
                    fixed(tip[k], 9),
                    size(off),
                ])
                .checked(Check::within(off, BETWEEN)),
            );
        }
    }
    table
}

/// The tables of the plane, their arms turned into another plane.
fn plane(planar: &[Case]) -> Table {
    let mut table = Table::new(
        "Tables and closed forms of the plane by the solver of space",
        "the known numbers of the section on exact answers. Each arm with all that acts on it is turned by 0.9 rad about e1, and its answer back.",
        &["problem", "quantity", "here", "known", "deviation"],
    );
    for case in planar {
        let length = case.arm.length;
        let solved = solve(&tilted(&case.arm));
        for quantity in &case.exact {
            let unit = match quantity.what {
                Measure::TipX | Measure::TipY => 1.0 / length,
                Measure::MiddleMu => length,
                _ => 1.0,
            };
            let (got, name) = match &solved {
                Some(solved) => read(solved, quantity.what, length),
                None => (f64::NAN, "not solved"),
            };
            let (got, known) = (unit * got, unit * quantity.value);
            // A section that is turned by whole turns is the same.
            let off = if quantity.what == Measure::TipTheta {
                let turned = (got - known).rem_euclid(TAU);
                turned.min(TAU - turned)
            } else {
                (got - known).abs()
            };
            let allowed = unit * quantity.tolerance + ALLOWED * known.abs().max(1.0);
            table.push(
                Row::new([case.name.clone(), name.to_owned(), fixed(got, 10), fixed(known, 10), size(off)])
                    .checked(Check::within(off, allowed)),
            );
        }
    }
    table
}

/// A quantity of the plane, with its name, of an arm that [`tilted`] has turned.
fn read(shape: &SpatialConfiguration, what: Measure, length: f64) -> (f64, &'static str) {
    let (sin, cos) = TILT.sin_cos();
    let (tip, middle) = (shape.tip(), shape.at(0.5 * length));
    match what {
        Measure::TipX => (tip.x, "x(L)/L"),
        Measure::TipY => (cos * tip.y + sin * tip.z, "y(L)/L"),
        Measure::TipTheta => ((cos * tip.a[1] + sin * tip.a[2]).atan2(tip.a[0]), "theta(L)"),
        Measure::MiddleNu => (middle.nu, "nu(L/2)"),
        Measure::MiddleEta => (middle.eta, "eta(L/2)"),
        Measure::MiddleMu => (middle.mu, "mu(L/2) L"),
        Measure::MiddleBeta => (middle.beta, "beta(L/2)"),
    }
}

/// An arm in the plane with base and loads, turned about e1.
fn tilted(arm: &Arm) -> Arm {
    let (sin, cos) = TILT.sin_cos();
    let turned = |[x, y]: [f64; 2]| [x, cos * y, sin * y];
    let along = |angle: f64| turned([angle.cos(), angle.sin()]);
    let angle = arm.base.angle;
    let mut out = arm.clone();
    let [x, y, z] = turned([arm.base.x, arm.base.y]);
    (out.base.x, out.base.y) = (x, y);
    let force = turned(arm.tip.force);
    out.tip.force = [force[0], force[1]];
    out.tip.moment = cos * arm.tip.moment;
    let [_, across] = &arm.distributed.force;
    let couple = &arm.distributed.couple;
    out.distributed.force[1] = across.scaled(cos, 1.0);
    out.distributed.couple = couple.scaled(cos, 1.0);
    out.space = Some(Space {
        z,
        base: Some(BaseDirections { direction: along(angle), section: Some(turned([-angle.sin(), angle.cos()])) }),
        stream: Some(along(arm.flow.direction)),
        gravity: arm.gravity.map(|gravity| along(gravity.direction)),
        tip_force: force[2],
        tip_moment: [0.0, -sin * arm.tip.moment],
        force: across.scaled(sin, 1.0),
        couple: [0.0.into(), couple.scaled(-sin, 1.0)],
        ..Space::default()
    });
    out
}

fn place(shape: &SpatialConfiguration) -> [f64; 3] {
    let tip = shape.tip();
    [tip.x, tip.y, tip.z]
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// A vector that is given by its components along the directors.
fn in_space(st: &SpatialStation, v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| v[0] * st.a[k] + v[1] * st.b[k] + v[2] * st.c[k])
}

#[cfg(test)]
mod tests {
    use super::*;
    use hydrostat::cases;

    /// The rows that do not hold, for people.
    fn failing(section: &Section) -> Vec<String> {
        let rows = section.tables().flat_map(|table| &table.rows);
        let failing = rows.filter(|row| row.check.as_ref().is_some_and(|check| !check.holds()));
        failing.map(|row| row.cells.join(" | ")).collect()
    }

    /// Everything holds, and a reference that is wrong in its seventh digit is found.
    #[test]
    fn a_wrong_reference_is_found_in_space() {
        let mut planar = cases::end_loads();
        assert_eq!(failing(&section(&planar)), Vec::<String>::new());
        planar[1].exact[0].value += 1e-7;
        assert_eq!(failing(&section(&planar)).len(), 1);
    }

    #[test]
    fn the_tables_of_the_plane_hold_in_space() {
        let table = plane(&cases::all());
        let mut section = Section::new("plane", "plane");
        section.table(table);
        assert_eq!(failing(&section), Vec::<String>::new());
        assert!(section.checks() > 60, "{}", section.checks());
    }
}
