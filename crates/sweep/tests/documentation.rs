//! `docs/interface.md` says what a sweep writes.

use hydrostat_files::{ArmFile, Axis, shipped};
use hydrostat_sweep::{NO_ARM, Output, Plan, Sample, Sweep, SweepOptions, names};

const PAGE: &str = include_str!("../../../docs/interface.md");

#[test]
fn it_has_every_column_of_arms_in_space() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out.csv");
    let file = ArmFile::parse(shipped::get("silicone-spatial").unwrap(), "silicone-spatial").unwrap();
    let plan = Plan::new(vec!["flow.speed=0,0.1".parse::<Axis>().unwrap()], Sample::Grid, 0).unwrap();
    let options = SweepOptions { outputs: Output::ALL.to_vec(), stations: 2, ..SweepOptions::default() };
    Sweep::new(&file, plan, &options).unwrap().run(&out, false, 1, &|_| {}).unwrap();
    let columns = names(&out).unwrap();
    assert_eq!(columns.len(), 61);
    // Of directors the page has the first of each kind.
    let rest = ["tip_b_y", "tip_b_z", "tip_c_", "_1_", "_2_", "shape_a_", "shape_b_", "_1"];
    for column in columns.iter().filter(|column| !rest.iter().any(|part| column.contains(part))) {
        assert!(PAGE.contains(&format!("`{column}`")), "{column}");
    }
}

#[test]
fn it_has_every_column() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out.csv");
    let file = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap();
    let plan = Plan::new(vec!["flow.speed=0,0.1".parse::<Axis>().unwrap()], Sample::Grid, 0).unwrap();
    let options = SweepOptions { outputs: Output::ALL.to_vec(), stations: 2, ..SweepOptions::default() };
    Sweep::new(&file, plan, &options).unwrap().run(&out, false, 1, &|_| {}).unwrap();
    let beside = std::fs::read_dir(directory.path()).unwrap().flatten().map(|entry| entry.file_name());
    for file in beside {
        assert!(PAGE.contains(&format!("`{}`", file.to_str().unwrap())), "{file:?}");
    }
    let columns = names(&out).unwrap();
    assert_eq!(columns.len(), 35);
    assert!(columns.iter().all(|column| column.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')), "{columns:?}");
    for column in columns.iter().filter(|column| !column.contains("_1_")) {
        assert!(PAGE.contains(&format!("`{column}`")), "{column}");
    }
    for output in Output::ALL {
        assert!(PAGE.contains(&format!("\n| `{output}` | ")), "{output}");
    }
    assert!(PAGE.contains(&format!("`{NO_ARM}`")));
    let defaults = Output::DEFAULT.map(Output::name).join(",");
    assert!(PAGE.contains(&format!("`{defaults}`")), "{defaults}");
    for note in ["hydrostat.sweep", "hydrostat.arm", "hydrostat.version"] {
        assert!(PAGE.contains(&format!("`{note}`")), "{note}");
    }
}
