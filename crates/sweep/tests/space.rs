//! Sweeps over arms in space.

use std::path::Path;

use hydrostat::{Options, SpatialSolver};
use hydrostat_files::{ArmFile, shipped};
use hydrostat_sweep::{Plan, Sample, Shard, Sweep, SweepOptions, Table};

fn file() -> ArmFile {
    let mut file = ArmFile::parse(shipped::get("silicone-spatial").unwrap(), "silicone-spatial").unwrap();
    file.set("flow.speed", "0.05").unwrap();
    file.set("flow.direction", "[1, 0, 0]").unwrap();
    file
}

/// Two directions of the stream, four tensions of which the last folds the tip.
fn sweep(shard: Option<Shard>, columns: usize) -> Sweep {
    let keys = ["flow.direction[2]=-1,1", "cable[0].tension=0:1.2:4"].map(|key| key.parse().unwrap());
    let plan = Plan::new(keys.into(), Sample::Grid, 0).unwrap();
    let options = SweepOptions { shard, stations: columns, ..SweepOptions::default() };
    Sweep::new(&file(), plan, &options).unwrap()
}

fn bytes(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn a_row_is_what_a_solve_gives() {
    let directory = tempfile::tempdir().unwrap();
    for name in ["out.csv", "out.parquet"] {
        let out = directory.path().join(name);
        let summary = sweep(None, 3).run(&out, false, 2, &|_| {}).unwrap();
        assert_eq!((summary.rows, summary.answered), (8, 6));
        let wanted =
            ["tip_x_m", "tip_z_m", "tip_b_y", "base_force_z_N", "base_moment_x_Nm", "shape_z_2_m", "shape_b_y_2"];
        let table = Table::read(&out, &[&wanted[..], &["verdict", "cable_0_tension_N"]].concat()).unwrap();
        let verdicts = table.words("verdict").unwrap();
        assert_eq!(verdicts[3].as_deref(), Some("cable_fold"));
        let mut file = file();
        file.set("flow.direction[2]", "1").unwrap();
        file.set("cable[0].tension", "0.4").unwrap();
        let solved = SpatialSolver::new(&file.arm().unwrap(), Options::with_tol(1e-6)).unwrap().solve().unwrap();
        let (tip, base) = (solved.tip(), solved.base_reaction);
        let expected = [tip.x, tip.z, tip.b[1], base.force[2], base.moment[0], tip.z, tip.b[1]];
        for (name, expected) in wanted.into_iter().zip(expected) {
            let found = table.numbers(name).unwrap();
            assert!((found[5] - expected).abs() < 1e-12, "{name}: {} {expected}", found[5]);
            assert!(found[3].is_nan());
        }
    }
}

#[test]
fn shards_and_resumed_runs_have_the_same_rows() {
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name);
    sweep(None, 0).run(&path("all.csv"), false, 1, &|_| {}).unwrap();
    let all = bytes(&path("all.csv"));
    let mut joined = String::new();
    for (k, name) in ["1.csv", "2.csv"].into_iter().enumerate() {
        let shard = Shard { index: k as u64 + 1, of: 2 };
        sweep(Some(shard), 0).run(&path(name), false, 2, &|_| {}).unwrap();
        let text = bytes(&path(name));
        joined.push_str(if k == 0 { &text } else { text.split_once('\n').unwrap().1 });
    }
    assert_eq!(joined, all);
    let again = sweep(None, 0).run(&path("all.csv"), true, 1, &|_| {}).unwrap();
    assert_eq!((again.rows, again.resumed), (8, 8));
}

#[test]
fn plane_and_space_do_not_share_columns() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out.csv");
    let planar = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap();
    let plan = Plan::new(vec!["arm.space=planar,spatial".parse().unwrap()], Sample::Grid, 0).unwrap();
    let summary = Sweep::new(&planar, plan, &SweepOptions::default()).unwrap().run(&out, false, 1, &|_| {}).unwrap();
    assert_eq!((summary.rows, summary.answered), (2, 1));
    assert!(bytes(&out).contains("`arm.space`: expected the same in all rows"));
}
