//! Whatever bytes a table has, whatever numbers an arm has: an answer or an error, never a panic.
//!
//! `HYDROSTAT_FUZZ_CASES` says how many cases of each are tried; few by default. Tables and arms are those of real runs with bytes and
//! numbers changed, as bytes at random rarely get past the first line. Arm files as text are the subject of `crates/files/tests/properties.rs`.

use std::path::Path;
use std::sync::LazyLock;

use hydrostat::{Options, Solver};
use hydrostat_files::{ArmFile, Axis, shipped};
use hydrostat_sweep::{Output, Plan, Sample, Sweep, SweepOptions, Table, names, varied_keys};
use proptest::prelude::*;
use proptest::sample::{Index, select};

fn cases(default: u32) -> ProptestConfig {
    let asked = std::env::var("HYDROSTAT_FUZZ_CASES").ok().and_then(|text| text.parse().ok());
    ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(asked.unwrap_or(default)) }
}

/// A small sweep as CSV and as Parquet, and what stands beside the CSV.
static WHOLE: LazyLock<[(&str, Vec<u8>); 3]> = LazyLock::new(|| {
    let directory = tempfile::tempdir().unwrap();
    let file = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap();
    let keys = ["flow.speed=0,0.1", "cable[0].tension=0:1.2:3"];
    let options = SweepOptions { outputs: Output::ALL.to_vec(), stations: 2, ..SweepOptions::default() };
    for name in ["out.csv", "out.parquet"] {
        let axes = keys.iter().map(|key| key.parse::<Axis>().unwrap()).collect();
        let plan = Plan::new(axes, Sample::Grid, 0).unwrap();
        Sweep::new(&file, plan, &options).unwrap().run(&directory.path().join(name), false, 1, &|_| {}).unwrap();
    }
    ["out.csv", "out.parquet", "out.csv.json"].map(|name| (name, std::fs::read(directory.path().join(name)).unwrap()))
});

/// One change of some bytes.
#[derive(Debug, Clone)]
enum Change {
    Set(Index, u8),
    Remove(Index, usize),
    Repeat(Index, usize),
    Cut(Index),
}

fn change() -> impl Strategy<Value = Change> {
    prop_oneof![
        (any::<Index>(), any::<u8>()).prop_map(|(at, byte)| Change::Set(at, byte)),
        (any::<Index>(), 1..40_usize).prop_map(|(at, count)| Change::Remove(at, count)),
        (any::<Index>(), 1..40_usize).prop_map(|(at, count)| Change::Repeat(at, count)),
        any::<Index>().prop_map(Change::Cut),
    ]
}

fn changed(bytes: &[u8], changes: &[Change]) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for change in changes {
        if out.is_empty() {
            break;
        }
        match change {
            Change::Set(at, byte) => {
                let at = at.index(out.len());
                out[at] = *byte;
            }
            Change::Remove(at, count) => {
                let at = at.index(out.len());
                let end = (at + count).min(out.len());
                out.drain(at..end);
            }
            Change::Repeat(at, count) => {
                let at = at.index(out.len());
                let end = (at + count).min(out.len());
                let part = out[at..end].to_vec();
                out.splice(at..at, part);
            }
            Change::Cut(at) => out.truncate(at.index(out.len())),
        }
    }
    out
}

/// Everything that reads a table.
fn read(path: &Path) {
    let _ = varied_keys(path);
    let Ok(names) = names(path) else { return };
    let wanted: Vec<&str> = names.iter().map(String::as_str).collect();
    let Ok(table) = Table::read(path, &wanted) else { return };
    for name in wanted {
        let _ = (table.numbers(name), table.words(name));
    }
}

/// Keys of an arm file that take a number.
const KEYS: [&str; 16] = [
    "arm.length",
    "arm.radius",
    "arm.density",
    "arm.base.angle",
    "material.young",
    "material.poisson",
    "reference.nu",
    "reference.mu",
    "cable[0].tension",
    "cable[0].offset",
    "cable[0].end",
    "cable[0].stroke",
    "flow.speed",
    "flow.direction",
    "gravity.acceleration",
    "tip.moment",
];

/// Numbers of any size, and some that are near a limit.
fn number() -> impl Strategy<Value = f64> {
    let sized =
        (-12.0..6.0_f64, any::<bool>()).prop_map(|(e, minus)| if minus { -(10_f64.powf(e)) } else { 10_f64.powf(e) });
    prop_oneof![4 => sized, 1 => select(vec![0.0, 1.0, -1.0, 180.0, 0.5, f64::MAX, f64::MIN_POSITIVE, 1e-300])]
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn damaged_tables_are_read_or_refused(which in 0..3_usize, changes in proptest::collection::vec(change(), 1..5)) {
        let directory = tempfile::tempdir().unwrap();
        for (k, (name, bytes)) in WHOLE.iter().enumerate() {
            let bytes = if k == which { changed(bytes, &changes) } else { bytes.clone() };
            std::fs::write(directory.path().join(name), bytes).unwrap();
        }
        for name in ["out.csv", "out.parquet"] {
            read(&directory.path().join(name));
        }
    }
}

proptest! {
    #![proptest_config(cases(40))]

    #[test]
    #[ignore = "arms of any size take up to seconds each"]
    fn arms_of_any_size_are_solved_or_refused(
        name in select(shipped::names().collect::<Vec<_>>()),
        settings in proptest::collection::vec((select(KEYS.to_vec()), number()), 1..4),
    ) {
        let mut file = ArmFile::parse(shipped::get(name).unwrap(), name).unwrap();
        for (key, value) in settings {
            // A key may not fit this arm: then that is said.
            let _ = file.set(key, &format!("{value:?}"));
        }
        let Ok(arm) = file.arm() else { return Ok(()) };
        if let Ok(solved) = Solver::new(&arm, Options { tol: 1e-3 }).and_then(|mut solver| solver.solve()) {
            let tip = solved.tip();
            prop_assert!([tip.x, tip.y, tip.theta, solved.error_estimate].iter().all(|v| v.is_finite()), "{tip:?}");
            let _ = (solved.warnings(), solved.fold_margin(), solved.stability());
        }
    }
}
