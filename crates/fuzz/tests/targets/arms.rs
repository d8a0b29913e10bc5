//! Arms of any size through `solve`: finite numbers, or a verdict with its own, in bounded work.

use hydrostat::{Options, SolveError, Solver};
use hydrostat_files::{ArmFile, shipped};
use hydrostat_fuzz::fuzz;
use proptest::collection::vec;
use proptest::prelude::any;
use proptest::prop_oneof;
use proptest::sample::select;
use proptest::strategy::Strategy;

/// Keys of an arm file that take a number.
const KEYS: [&str; 24] = [
    "arm.length",
    "arm.radius",
    "arm.inner_radius",
    "arm.density",
    "arm.base.angle",
    "material.young",
    "material.poisson",
    "material.shear_factor",
    "reference.nu",
    "reference.eta",
    "reference.mu",
    "cable[0].tension",
    "cable[0].offset",
    "cable[0].end",
    "cable[0].stroke",
    "cable[0].stiffness",
    "cable[0].friction",
    "flow.speed",
    "flow.direction",
    "flow.layer_thickness",
    "gravity.acceleration",
    "tip.moment",
    "distributed.couple",
    "tip.force",
];

const WORDS: [(&str, &str); 8] = [
    ("model.volume", "none"),
    ("model.volume", "circular"),
    ("model.flow_surface", "lateral"),
    ("model.entering_speed", "resultant"),
    ("model.displaced", "section"),
    ("model.closure", "literal"),
    ("model.support", "unstrained-base"),
    ("arm.cavity", "sealed"),
];

/// Numbers of any size, and some that are near a limit.
fn number() -> impl Strategy<Value = f64> {
    let sized =
        (-12.0..6.0_f64, any::<bool>()).prop_map(|(e, minus)| if minus { -(10_f64.powf(e)) } else { 10_f64.powf(e) });
    prop_oneof![4 => sized, 1 => select(vec![0.0, 1.0, -1.0, 180.0, 0.5, f64::MAX, f64::MIN_POSITIVE, 1e-300])]
}

fn setting() -> impl Strategy<Value = (String, String)> {
    let valued = (select(KEYS.to_vec()), number()).prop_map(|(key, value)| {
        let text = if key == "tip.force" { format!("[{value:?}, 0]") } else { format!("{value:?}") };
        (key.to_owned(), text)
    });
    prop_oneof![6 => valued, 1 => select(WORDS.to_vec()).prop_map(|(key, word)| (key.to_owned(), word.to_owned()))]
}

#[test]
fn arms() {
    let cases =
        (select(shipped::names().collect::<Vec<_>>()), vec(setting(), 1..4), select(vec![1e-2, 1e-3, 1e-6, 1e-8]));
    fuzz("arms", &cases, |(name, settings, tol)| {
        let mut file = ArmFile::parse(shipped::get(name).unwrap(), name).unwrap();
        for (key, value) in &settings {
            // A key may not fit this arm: then that is said.
            let _ = file.set(key, value);
        }
        let Ok(arm) = file.arm() else { return Ok(()) };
        match Solver::new(&arm, Options::with_tol(tol)).and_then(|mut solver| solver.solve()) {
            Ok(solved) => {
                let tip = solved.tip();
                let fine = [tip.x, tip.y, tip.theta, solved.error_estimate].iter().all(|v| v.is_finite());
                let _ = (solved.warnings(), solved.fold_margin(), solved.stability());
                if fine { Ok(()) } else { Err(format!("{tip:?}, {}", solved.error_estimate)) }
            }
            Err(SolveError::NoEquilibrium(no)) => {
                let fine = (0.0..=1.0).contains(&no.verdict.load_fraction) && no.verdict.s.is_none_or(f64::is_finite);
                if fine { Ok(()) } else { Err(format!("{:?}", no.verdict)) }
            }
            Err(error) => Err(format!("an arm that was checked is refused: {error}")),
        }
    });
}
