//! Outputs of sweeps with bytes changed are read or refused.

use std::path::Path;
use std::sync::LazyLock;

use hydrostat_files::{ArmFile, Axis, shipped};
use hydrostat_fuzz::{fuzz, mutations_of};
use hydrostat_sweep::{Output, Plan, Sample, Sweep, SweepOptions, Table, names, varied_keys};
use proptest::strategy::{Just, Strategy};

const NAMES: [&str; 3] = ["out.csv", "out.parquet", "out.csv.json"];

/// A small sweep as CSV and as Parquet, and what stands beside the CSV.
static WHOLE: LazyLock<[Vec<u8>; 3]> = LazyLock::new(|| {
    let directory = tempfile::tempdir().unwrap();
    let file = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap();
    let keys = ["flow.speed=0,0.1", "cable[0].tension=0:1.2:3"];
    let options = SweepOptions { outputs: Output::ALL.to_vec(), stations: 2, ..SweepOptions::default() };
    for name in ["out.csv", "out.parquet"] {
        let axes = keys.iter().map(|key| key.parse::<Axis>().unwrap()).collect();
        let plan = Plan::new(axes, Sample::Grid, 0).unwrap();
        Sweep::new(&file, plan, &options).unwrap().run(&directory.path().join(name), false, 1, &|_| {}).unwrap();
    }
    NAMES.map(|name| std::fs::read(directory.path().join(name)).unwrap())
});

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

#[test]
fn tables() {
    let which = (0..3_usize).prop_flat_map(|which| (Just(which), mutations_of(vec![WHOLE[which].clone()])));
    fuzz("tables", &which, |(which, bytes)| {
        let directory = tempfile::tempdir().map_err(|e| e.to_string())?;
        for (k, name) in NAMES.iter().enumerate() {
            let content = if k == which { &bytes.0 } else { &WHOLE[k] };
            std::fs::write(directory.path().join(name), content).map_err(|e| e.to_string())?;
        }
        for name in ["out.csv", "out.parquet"] {
            read(&directory.path().join(name));
        }
        Ok(())
    });
}
