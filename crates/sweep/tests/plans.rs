//! Plans: which rows there are, what values they have, and how they fall into tiles.

use std::collections::BTreeSet;

use hydrostat_files::{ArmFile, Axis, AxisValue, shipped};
use hydrostat_sweep::{Plan, PlanError, Sample, Shard, Sweep, SweepOptions};
use proptest::prelude::*;

fn axes(texts: &[&str]) -> Vec<Axis> {
    texts.iter().map(|text| text.parse().unwrap()).collect()
}

fn number(value: AxisValue<'_>) -> f64 {
    match value {
        AxisValue::Number(number) => number,
        AxisValue::Word(word) => panic!("{word}"),
    }
}

#[test]
fn a_grid_has_every_combination_once() {
    let plan =
        Plan::new(axes(&["flow.speed=0:1:5", "cable[0].tension=3,1,2", "arm.length=0.1:0.4:4"]), Sample::Grid, 0);
    let plan = plan.unwrap();
    let rows: Vec<Vec<f64>> = (0..plan.rows()).map(|row| plan.values(row).into_iter().map(number).collect()).collect();
    assert_eq!((rows.len(), &rows[0][..], &rows[59][..]), (60, &[0.0, 3.0, 0.1][..], &[1.0, 2.0, 0.4][..]));
    assert_eq!(rows[1], [0.0, 3.0, 0.2], "the last key runs fastest");
    let all: BTreeSet<String> = rows.iter().map(|row| format!("{row:?}")).collect();
    assert_eq!(all.len(), 60);
}

#[test]
fn plans_that_are_none() {
    let plan = |texts: &[&str], sample| Plan::new(axes(texts), sample, 0).unwrap_err();
    assert_eq!(plan(&[], Sample::Grid), PlanError::NoAxes);
    assert!(matches!(plan(&["flow.speed=0:1:2", "flow.speed=3"], Sample::Grid), PlanError::Twice { .. }));
    assert!(matches!(plan(&["flow.speed=0:1"], Sample::Grid), PlanError::NoCount { .. }));
    assert!(matches!(plan(&["flow.speed=0:1:9"], Sample::Lhs(5)), PlanError::Counted { count: 9, .. }));
    let many = "flow.speed=0:1:1000000000";
    assert!(matches!(plan(&[many, "arm.length=1:2:10000"], Sample::Grid), PlanError::TooMany));
    let keys: Vec<String> = (0..17).map(|k| format!("cable[{k}].tension=0:1")).collect();
    let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
    assert!(matches!(plan(&keys, Sample::Sobol(8)), PlanError::Sobol { keys: 17, .. }));
    for text in ["lhs", "lhs:0", "lhs:-1", "halton:5", "sobol:x", "5"] {
        assert!(text.parse::<Sample>().unwrap_err().contains("expected lhs:N or sobol:N"), "{text}");
    }
}

#[test]
fn lists_are_drawn_in_equal_parts() {
    let plan = Plan::new(axes(&["model.volume=planar,none", "flow.speed=0:1"]), Sample::Lhs(200), 3).unwrap();
    let words = (0..200).filter(|row| plan.values(*row)[0] == AxisValue::Word("none")).count();
    assert_eq!(words, 100);
}

proptest! {
    #![proptest_config(hydrostat_fuzz::property(60))]

    /// Each key of a Latin hypercube has one row in each of as many parts of its range as there are rows.
    #[test]
    fn a_latin_hypercube_meets_every_part_once(count in 1_u64..700, seed: u64, keys in 1_usize..5) {
        let texts: Vec<String> = (0..keys).map(|k| format!("cable[{k}].tension=0:1")).collect();
        let axes: Vec<Axis> = texts.iter().map(|text| text.parse().unwrap()).collect();
        let plan = Plan::new(axes.clone(), Sample::Lhs(count), seed).unwrap();
        for key in 0..keys {
            let part = |row| (number(plan.values(row)[key]) * count as f64).floor();
            let parts: BTreeSet<u64> = (0..count).map(|row| part(row).to_bits()).collect();
            prop_assert_eq!(parts.len() as u64, count);
        }
        let again = Plan::new(axes.clone(), Sample::Lhs(count), seed).unwrap();
        let other = Plan::new(axes, Sample::Lhs(count), seed.wrapping_add(1)).unwrap();
        prop_assert!((0..count).all(|row| plan.values(row) == again.values(row)));
        prop_assert!((0..count).any(|row| plan.values(row) != other.values(row)));
    }

    #[test]
    fn a_sobol_sample_is_even_and_follows_its_seed(power in 1_u32..9, seed: u64) {
        let count = 1_u64 << power;
        let axes = axes(&["flow.speed=0:1", "arm.length=0:1", "arm.density=0:1"]);
        let plan = Plan::new(axes.clone(), Sample::Sobol(count), seed).unwrap();
        for key in 0..3 {
            let part = |row| (number(plan.values(row)[key]) * count as f64).floor();
            let parts: BTreeSet<u64> = (0..count).map(|row| part(row).to_bits()).collect();
            prop_assert_eq!(parts.len() as u64, count);
        }
        let again = Plan::new(axes.clone(), Sample::Sobol(count), seed).unwrap();
        let other = Plan::new(axes, Sample::Sobol(count), seed.wrapping_add(1)).unwrap();
        prop_assert!((0..count).all(|row| plan.values(row) == again.values(row)));
        prop_assert!((0..count).any(|row| plan.values(row) != other.values(row)));
    }

    /// Tiles hold all rows in their order, and solve each of theirs once.
    #[test]
    fn tiles_hold_every_row_once(first in 1_u64..40, last in 1_u64..900, sample: bool) {
        let grid = |key: &str, count| if count == 1 { format!("{key}=1") } else { format!("{key}=0:1:{count}") };
        let texts = [grid("flow.speed", first), grid("arm.density", last)];
        let plan = if sample {
            Plan::new(axes(&["flow.speed=0:1", "arm.density=0:1"]), Sample::Lhs(last), 1).unwrap()
        } else {
            Plan::new(texts.iter().map(|text| text.parse().unwrap()).collect(), Sample::Grid, 0).unwrap()
        };
        let mut next = 0;
        for tile in 0..plan.tiles() {
            let rows = plan.tile(tile);
            prop_assert_eq!(rows.start, next);
            prop_assert!(rows.end > rows.start && rows.end - rows.start <= 256);
            let mut order = plan.order(tile);
            order.sort_unstable();
            prop_assert!(order.into_iter().eq(rows.clone()));
            next = rows.end;
        }
        prop_assert_eq!(next, plan.rows());
    }
}

#[test]
fn shards_share_all_rows() {
    let file = ArmFile::parse(shipped::get("paper").unwrap(), "paper").unwrap();
    let plan = Plan::new(axes(&["flow.speed=0:1:7", "cable[0].tension=0:80:400"]), Sample::Grid, 0).unwrap();
    for of in [1, 2, 5, 14, 15, 700, 2800] {
        let mut next = 0;
        for index in 1..=of {
            let options = SweepOptions { shard: Some(Shard { index, of }), ..SweepOptions::default() };
            let rows = Sweep::new(&file, plan.clone(), &options).unwrap().rows();
            assert!(rows.start == next && rows.end > next);
            next = rows.end;
        }
        assert_eq!(next, 2800);
    }
    for (index, of) in [(0, 3), (4, 3), (1, 2801)] {
        let options = SweepOptions { shard: Some(Shard { index, of }), ..SweepOptions::default() };
        let error = Sweep::new(&file, plan.clone(), &options).unwrap_err().to_string();
        assert!(error.starts_with(&format!("--shard {index}/{of}: expected a number from 1")), "{error}");
    }
}
