//! Outputs: what rows say, in Parquet and in CSV, on any number of threads, in shards and after stops.

use std::path::Path;

use hydrostat::{Options, Solver, Stability};
use hydrostat_files::{ArmFile, Axis, head_of, shipped};
use hydrostat_sweep::{Data, NO_ARM, NOTE, Output, Plan, Sample, Shard, Sweep, SweepError, SweepOptions, Table, names};

fn file(name: &str) -> ArmFile {
    ArmFile::parse(shipped::get(name).unwrap(), name).unwrap()
}

fn plan(texts: &[&str], sample: Sample) -> Plan {
    Plan::new(texts.iter().map(|text| text.parse::<Axis>().unwrap()).collect(), sample, 1).unwrap()
}

fn sweep(name: &str, texts: &[&str], options: &SweepOptions) -> Sweep {
    Sweep::new(&file(name), plan(texts, Sample::Grid), options).unwrap()
}

fn all(path: &Path) -> Table {
    let names = names(path).unwrap();
    Table::read(path, &names.iter().map(String::as_str).collect::<Vec<_>>()).unwrap()
}

const GRID: [&str; 2] = ["flow.speed=0:0.8:6", "cable[0].tension=0:60:40"];

#[test]
fn rows_are_the_arms_own_solves() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out.parquet");
    let keys =
        ["arm.radius.tip=2 mm, 3 mm", "cable[1].stroke=-2 mm,1 mm", "flow.direction=0,30", "gravity.direction=-90,0"];
    let options = SweepOptions { outputs: Output::ALL.to_vec(), stations: 3, ..SweepOptions::default() };
    let sweep = sweep("silicone", &keys, &options);
    let summary = sweep.run(&out, false, 2, &|_| {}).unwrap();
    assert_eq!((summary.rows, summary.resumed), (16, 0));
    let table = all(&out);
    let column = |name: &str| table.numbers(name).unwrap_or_else(|| panic!("{name}"));
    for row in [0_usize, 5, 10, 15] {
        let mut file = file("silicone");
        for (key, at) in [
            ("arm.radius.tip", "_m"),
            ("cable[1].stroke", "_m"),
            ("flow.direction", "_rad"),
            ("gravity.direction", "_rad"),
        ] {
            let value = column(&head_of(key, at.trim_start_matches('_')))[row];
            let unit = if at == "_rad" { " rad" } else { "" };
            file.set(key, &format!("{value:?}{unit}")).unwrap();
        }
        let own = Solver::new(&file.arm().unwrap(), Options::with_tol(1e-6)).unwrap().solve().unwrap();
        let close = |name: &str, want: f64| {
            let found = column(name)[row];
            assert!((found - want).abs() <= 1e-5 * want.abs().max(0.01), "{name} of row {row}: {found} {want}");
        };
        close("tip_x_m", own.tip().x);
        close("tip_theta_rad", own.tip().theta);
        close("tip_alpha_rad", own.tip().alpha);
        close("stroke_1_m", own.cables[1].stroke);
        close("tension_1_N", own.cables[1].tension);
        close("base_force_y_N", own.base_reaction.force[1]);
        close("base_moment_Nm", own.base_reaction.moment);
        close("fold_margin", own.fold_margin().value);
        close("shape_y_2_m", own.tip().y);
        close("shape_theta_1_rad", own.at(0.5 * own.arm.length).theta);
        let stable = table.words("stability").unwrap()[row].clone();
        assert_eq!(stable.as_deref() == Some("stable"), own.stability() == Some(Stability::Stable));
    }
}

#[test]
fn threads_and_shards_do_not_matter() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    let sweep_of = |shard| sweep("paper", &GRID, &SweepOptions { shard, ..SweepOptions::default() });
    let whole = sweep_of(None);
    for (threads, name) in [(1, "one.parquet"), (2, "two.parquet"), (3, "three.parquet")] {
        whole.run(&at(name), false, threads, &|_| {}).unwrap();
    }
    let bytes = |name: &str| std::fs::read(at(name)).unwrap();
    assert!(bytes("one.parquet") == bytes("two.parquet") && bytes("one.parquet") == bytes("three.parquet"));

    whole.run(&at("whole.csv"), false, 2, &|_| {}).unwrap();
    let mut joined = String::new();
    for index in 1..=2 {
        let name = format!("{index}.csv");
        sweep_of(Some(Shard { index, of: 2 })).run(&at(&name), false, 1, &|_| {}).unwrap();
        let text = std::fs::read_to_string(at(&name)).unwrap();
        joined.push_str(if index == 1 { &text } else { text.split_once('\n').unwrap().1 });
    }
    assert_eq!(joined, std::fs::read_to_string(at("whole.csv")).unwrap());
    // More shards than tiles: their rows are those of the whole sweep, too.
    let (mut joined, of) = (String::new(), whole.tiles().end + 3);
    for index in 1..=of {
        let part = tempfile::tempdir().unwrap();
        let path = part.path().join("part.csv");
        let shard = sweep_of(Some(Shard { index, of }));
        let summary = shard.run(&path, false, 1, &|_| {}).unwrap();
        assert_eq!(summary.rows, shard.rows().end - shard.rows().start);
        let text = std::fs::read_to_string(&path).unwrap();
        joined.push_str(if index == 1 { &text } else { text.split_once('\n').unwrap().1 });
    }
    assert_eq!(joined, std::fs::read_to_string(at("whole.csv")).unwrap());
    // Nothing is left but the outputs.
    let mut left: Vec<_> =
        std::fs::read_dir(directory.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    left.sort();
    let parquet = ["one.parquet", "three.parquet", "two.parquet"];
    let csv = ["1.csv", "1.csv.json", "2.csv", "2.csv.json"];
    assert_eq!(left, [&csv[..], &parquet, &["whole.csv", "whole.csv.json"]].concat());
}

#[test]
fn parquet_and_csv_say_the_same() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    let keys = ["model.volume=planar,none", "cable[0].tension=0:1.2:9"];
    let outputs = [Output::Tip, Output::Fold, Output::Stability, Output::Strokes].to_vec();
    let sweep = sweep("silicone", &keys, &SweepOptions { outputs, ..SweepOptions::default() });
    for name in ["out.parquet", "out.csv"] {
        let summary = sweep.run(&at(name), false, 2, &|_| {}).unwrap();
        assert!(summary.answered > 9 && summary.answered < summary.rows, "{summary:?}");
    }
    let (parquet, csv) = (all(&at("out.parquet")), all(&at("out.csv")));
    assert_eq!(names(&at("out.parquet")).unwrap(), names(&at("out.csv")).unwrap());
    for column in parquet.columns() {
        if let Data::Text(words) = &column.data {
            assert_eq!(csv.words(&column.name).as_ref(), Some(words), "{}", column.name);
            continue;
        }
        let bits =
            |table: &Table| -> Vec<u64> { table.numbers(&column.name).unwrap().iter().map(|v| v.to_bits()).collect() };
        assert_eq!(bits(&parquet), bits(&csv), "{}", column.name);
    }
    // What has no answer says why.
    let verdicts = parquet.words("verdict").unwrap();
    let tips = parquet.numbers("tip_x_m").unwrap();
    assert!(verdicts.iter().zip(&tips).all(|(verdict, tip)| verdict.is_some() == tip.is_nan()));
    assert!(verdicts.iter().any(|verdict| verdict.as_deref() == Some("cable_fold")));
    let fractions = parquet.numbers("load_fraction").unwrap();
    assert!(fractions.iter().zip(&tips).all(|(fraction, tip)| fraction.is_nan() != tip.is_nan()));
}

#[test]
fn values_that_do_not_go_together_are_a_verdict() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out.csv");
    let keys = ["arm.radius.tip=1 mm,4 mm", "arm.inner_radius=0,\"3 mm\""];
    let summary = sweep("silicone", &keys, &SweepOptions::default()).run(&out, false, 1, &|_| {}).unwrap();
    assert_eq!((summary.rows, summary.answered), (4, 3));
    let verdicts = all(&out).words("verdict").unwrap();
    assert_eq!(verdicts[1].as_deref(), Some(NO_ARM));
    let reasons = all(&out).words("reason").unwrap();
    assert!(reasons[1].as_ref().is_some_and(|words| words.contains("less than the radius")), "{reasons:?}");
    assert_eq!(reasons.iter().flatten().count(), 1);
    let refused = |keys: &[&str]| {
        Sweep::new(&file("silicone"), plan(keys, Sample::Grid), &SweepOptions::default()).unwrap_err().to_string()
    };
    assert!(
        refused(&["arm.length=-1:1:3"]).starts_with("--vary arm.length=-1.0: arm.length: expected a value above zero")
    );
    assert!(refused(&["flow.law=momentum,magnus"]).contains("--vary flow.law=magnus"));
    assert!(refused(&["cable[7].tension=0:1:3"]).contains("2 cables"));
    assert!(refused(&["arm.inner_radius=\"20 mm\",0"]).contains("less than the radius"));
}

#[test]
fn one_tension_above_its_most_refused_the_whole_sweep() {
    let directory = tempfile::tempdir().unwrap();
    let options = SweepOptions::default();
    let above = |pull: f64| format!("`cable[0].tension` is {pull} N, above its max_tension of 100 N");
    let alone = ["cable[0].tension=80,101,120"];
    for (keys, want) in [
        (&alone[..], [None, Some(above(101.0)), Some(above(120.0))].to_vec()),
        (
            &["flow.speed=0,0.1", "cable[0].tension=80,101"],
            [None, Some(above(101.0)), None, Some(above(101.0))].to_vec(),
        ),
    ] {
        let outs = ["csv", "parquet"].map(|ending| directory.path().join(format!("{}.{ending}", keys.len())));
        for out in outs {
            let summary = sweep("paper", keys, &options).run(&out, false, 1, &|_| {}).unwrap();
            let table = all(&out);
            assert_eq!(table.words("reason").unwrap(), want);
            let verdicts = table.words("verdict").unwrap();
            assert!(verdicts.iter().zip(&want).all(|(kind, why)| why.is_none() || kind.as_deref() == Some(NO_ARM)));
            assert_eq!(summary.answered, verdicts.iter().filter(|kind| kind.is_none()).count() as u64);
        }
    }
}

#[test]
fn a_file_says_what_it_is_of() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out.parquet");
    let sweep = sweep("paper", &["flow.speed=0:50 cm/s:3"], &SweepOptions::default());
    sweep.run(&out, false, 1, &|_| {}).unwrap();
    let keys = hydrostat_sweep::varied_keys(&out).unwrap();
    assert_eq!((keys[0].name.as_str(), keys[0].unit.as_str(), keys[0].per_si), ("flow.speed", "cm/s", 100.0));
    let text = String::from_utf8_lossy(&std::fs::read(&out).unwrap()).into_owned();
    for note in [NOTE, "hydrostat.arm", "hydrostat.version", "[[cable]]", "\"tol\""] {
        assert!(text.contains(note), "{note}");
    }
}

#[test]
fn what_a_csv_is_of_stands_beside_it() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    let of = |tol| sweep("paper", &["flow.speed=0:50 cm/s:3"], &SweepOptions { tol, ..SweepOptions::default() });
    let sweep = of(1e-6);
    sweep.run(&at("out.csv"), false, 1, &|_| {}).unwrap();
    let note = std::fs::read_to_string(at("out.csv.json")).unwrap();
    assert_eq!(note, sweep.note());
    let note: serde_json::Value = serde_json::from_str(&note).unwrap();
    assert_eq!((&note["version"], &note["tol"]), (&env!("CARGO_PKG_VERSION").into(), &1e-6.into()));
    assert!(note["arm"].as_str().unwrap().contains("[[cable]]"), "{note}");
    let unit = || hydrostat_sweep::varied_keys(&at("out.csv")).unwrap()[0].unit.clone();
    assert_eq!(unit(), "cm/s");
    // What is whole is left as it is, and only to the sweep that it is of.
    assert_eq!(sweep.run(&at("out.csv"), true, 1, &|_| {}).unwrap().resumed, 3);
    let other = of(1e-7).run(&at("out.csv"), true, 1, &|_| {}).unwrap_err();
    assert!(matches!(other, SweepError::Other { what: "tolerance", .. }), "{other}");
    // Alone, a CSV has its columns to go by, and nobody goes on with it.
    std::fs::remove_file(at("out.csv.json")).unwrap();
    assert_eq!(unit(), "m/s");
    assert!(matches!(sweep.run(&at("out.csv"), true, 1, &|_| {}), Err(SweepError::Exists { .. })));
    // A file of that name that says something else is not overwritten.
    std::fs::write(at("new.csv.json"), "{}").unwrap();
    let taken = sweep.run(&at("new.csv"), false, 1, &|_| {}).unwrap_err();
    assert!(matches!(&taken, SweepError::Exists { path } if *path == at("new.csv.json")), "{taken}");
    assert_eq!(std::fs::read_to_string(at("new.csv.json")).unwrap(), "{}");
    assert!(!at("new.csv").exists() && !at("new.csv.parts").exists());
}

/// Nothing that acts leaves nothing at the base, and that is written `0.0`.
#[test]
fn still_rows_have_no_negative_zeros() {
    let directory = tempfile::tempdir().unwrap();
    for (name, columns) in [("warm.csv", Output::DEFAULT.to_vec()), ("read.csv", Output::ALL.to_vec())] {
        let options = SweepOptions { outputs: columns, ..SweepOptions::default() };
        let out = directory.path().join(name);
        sweep("paper", &["flow.speed=0,0", "cable[0].tension=0,0.1,40"], &options)
            .run(&out, false, 1, &|_| {})
            .unwrap();
        let text = std::fs::read_to_string(&out).unwrap();
        assert!(text.contains(",0.0,") && !text.contains("-0.0,"), "{text}");
    }
}

#[test]
fn a_stopped_sweep_goes_on_and_no_other() {
    let directory = tempfile::tempdir().unwrap();
    let (out, want) = (directory.path().join("out.parquet"), directory.path().join("want.parquet"));
    let whole = sweep("paper", &GRID, &SweepOptions::default());
    whole.run(&want, false, 2, &|_| {}).unwrap();
    // Stopped by a place that cannot be written once the first part is there.
    let parts = directory.path().join("out.parquet.parts");
    let stop = |done: u64| {
        if done > 0 && !out.exists() {
            std::fs::create_dir(&out).unwrap();
        }
    };
    assert!(matches!(whole.run(&out, false, 1, &stop), Err(SweepError::Write(_))));
    std::fs::remove_dir(&out).unwrap();
    let kept = std::fs::read_dir(&parts).unwrap().count();
    assert!(kept > 2, "{kept}");

    assert!(matches!(whole.run(&out, false, 1, &|_| {}), Err(SweepError::Begun { .. })));
    let other = sweep("paper", &GRID, &SweepOptions { tol: 1e-7, ..SweepOptions::default() });
    let error = other.run(&out, true, 1, &|_| {}).unwrap_err();
    assert!(matches!(error, SweepError::Other { what: "tolerance", .. }), "{error}");

    // One part is lost, another was never renamed, and neither was the whole.
    let part = std::fs::read_dir(&parts).unwrap().flatten().find(|e| e.file_name() != "plan.json").unwrap();
    std::fs::remove_file(part.path()).unwrap();
    std::fs::write(parts.join(".000000-1.parquet.1-0.tmp"), "half").unwrap();
    let leftover = directory.path().join(".out.parquet.1-0.tmp");
    std::fs::write(&leftover, "half").unwrap();
    let summary = whole.run(&out, true, 2, &|_| {}).unwrap();
    assert!(summary.resumed > 0 && summary.resumed < 240, "{summary:?}");
    assert!(std::fs::read(&out).unwrap() == std::fs::read(&want).unwrap());
    assert!(!parts.exists() && !leftover.exists());

    let again = whole.run(&out, true, 2, &|_| {}).unwrap();
    assert_eq!((again.rows, again.resumed, again.answered), (240, 240, summary.answered));
    assert!(matches!(whole.run(&out, false, 2, &|_| {}), Err(SweepError::Exists { .. })));
    assert!(matches!(other.run(&out, true, 2, &|_| {}), Err(SweepError::Other { .. })));
}

/// The parts of a sweep, in their order.
fn parts_of(out: &Path) -> Vec<std::path::PathBuf> {
    let directory = out.with_file_name(format!("{}.parts", out.file_name().unwrap().display()));
    let entries = std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path());
    let mut parts: Vec<_> = entries.filter(|path| path.extension() == out.extension()).collect();
    parts.sort();
    parts
}

/// A sweep of 960 rows, where it is to go, and where it is, whole.
fn of_many_parts(directory: &Path, ending: &str) -> (Sweep, [std::path::PathBuf; 2]) {
    let keys = ["arm.density=1000:1100:8", "cable[0].tension=0:0.5:120"];
    let whole = sweep("silicone", &keys, &SweepOptions::default());
    let [out, want] = ["out", "want"].map(|name| directory.join(format!("{name}.{ending}")));
    whole.run(&want, false, 2, &|_| {}).unwrap();
    (whole, [out, want])
}

/// Of CSV the rows beyond the cut were missing, with a line that was half a row; of Parquet changed values were joined as they stood, and a cut was an
/// error without advice.
#[test]
fn cut_parts_were_joined() {
    let directory = tempfile::tempdir().unwrap();
    for ending in ["csv", "parquet"] {
        let (whole, [out, want]) = of_many_parts(directory.path(), ending);
        let stopped = whole.run_while(&out, false, 1, &|rows| rows < 480);
        assert!(matches!(stopped, Err(SweepError::Stopped)), "{stopped:?}");
        let parts = parts_of(&out);
        assert!(parts.len() > 3, "{parts:?}");
        let bytes = std::fs::read(&parts[0]).unwrap();
        std::fs::write(&parts[0], &bytes[..bytes.len() / 2]).unwrap();
        std::fs::write(&parts[1], "").unwrap();
        let mut bytes = std::fs::read(&parts[2]).unwrap();
        // A digit of a CSV, a byte of a page.
        let place = bytes.iter().skip(5).position(u8::is_ascii_digit).unwrap() + 5;
        bytes[place] ^= 1;
        std::fs::write(&parts[2], bytes).unwrap();

        let summary = whole.run(&out, true, 2, &|_| {}).unwrap();
        assert_eq!((summary.rows, summary.damaged), (960, 3), "{summary:?}");
        assert!(summary.resumed > 0, "{summary:?}");
        assert!(std::fs::read(&out).unwrap() == std::fs::read(&want).unwrap(), "{ending}");
    }
}

/// A part that was written by the same run can be cut before it is joined, too.
#[test]
fn parts_cut_on_the_way_are_not_joined() {
    let directory = tempfile::tempdir().unwrap();
    for ending in ["csv", "parquet"] {
        let (whole, [out, want]) = of_many_parts(directory.path(), ending);
        let cut = |done| {
            if done == 960 {
                let first = &parts_of(&out)[0];
                let bytes = std::fs::read(first).unwrap();
                std::fs::write(first, &bytes[..bytes.len() - 9]).unwrap();
            }
        };
        let error = whole.run(&out, false, 1, &cut).unwrap_err();
        assert!(matches!(error, SweepError::Damaged { .. }) && error.to_string().contains("--resume"), "{error}");
        assert!(!out.exists());
        assert_eq!(whole.run(&out, true, 1, &|_| {}).unwrap().damaged, 1);
        assert!(std::fs::read(&out).unwrap() == std::fs::read(&want).unwrap(), "{ending}");
    }
}

/// The Python package made them, where the program refused the same path.
#[test]
fn missing_directories_were_made() {
    let directory = tempfile::tempdir().unwrap();
    let missing = directory.path().join("no");
    for name in ["out.csv", "out.parquet"] {
        let whole = sweep("paper", &["flow.speed=0:0.1:2"], &SweepOptions::default());
        let error = whole.run(&missing.join(name), false, 1, &|_| {}).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains("make the directory"), "{error}");
    }
    assert!(!missing.exists());
}

#[test]
fn what_is_no_sweep_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    for (name, text) in [("a.csv", "s_m,x_m\n0,0\n"), ("b.parquet", "PAR1 not"), ("c.csv", ""), ("d.csv", "row,a\n1\n")]
    {
        let path = directory.path().join(name);
        std::fs::write(&path, text).unwrap();
        let error = Table::read(&path, &["a"]).unwrap_err();
        assert!(matches!(error, SweepError::Read { .. }), "{name}: {error}");
    }
}

#[test]
fn tiles_by_themselves_are_those_of_the_output() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    let sweep = sweep("paper", &GRID, &SweepOptions::default());
    sweep.run(&at("whole.parquet"), false, 2, &|_| {}).unwrap();
    let whole = all(&at("whole.parquet"));
    assert_eq!(sweep.tiles(), 0..2);
    let mut joined: Vec<f64> = Vec::new();
    for tile in sweep.tiles() {
        let part = at(&format!("{tile}.parquet"));
        let (rows, answered) = sweep.write_tiles(&(tile..tile + 1), &part, &|_| true).unwrap();
        let columns = sweep.columns(&(tile..tile + 1), &|_| true);
        let tip = columns.iter().find(|column| column.name == "tip_x_m").unwrap();
        let Data::Number(numbers) = &tip.data else { panic!("{tip:?}") };
        assert_eq!(all(&part).numbers("tip_x_m").unwrap(), *numbers);
        assert_eq!((rows, answered), (numbers.len() as u64, rows));
        joined.extend(numbers);
    }
    assert_eq!(whole.numbers("tip_x_m").unwrap(), joined);
}

#[test]
fn a_sweep_that_is_ended_goes_on() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out.parquet");
    let sweep = sweep("paper", &GRID, &SweepOptions::default());
    let ended = sweep.run_while(&out, false, 1, &|rows| rows < 130);
    assert!(matches!(ended, Err(SweepError::Stopped)), "{ended:?}");
    assert!(!out.exists());
    // It ends after the row, not after the tile: of the second tile nothing is kept.
    let summary = sweep.run_while(&out, true, 1, &|_| true).unwrap();
    assert_eq!((summary.rows, summary.resumed), (240, 120));
}

/// Of what a file says of its columns at its end every number can be wrong: places before the file's begin, and dictionaries that are not there, were panics.
#[test]
fn damaged_columns_panicked() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("out.parquet");
    sweep("silicone", &["cable[0].tension=0,0.1"], &SweepOptions::default()).run(&path, false, 1, &|_| {}).unwrap();
    let whole = std::fs::read(&path).unwrap();
    // The footer's length stands before the last word.
    let place = whole.len() - 8;
    let length = u32::from_le_bytes(whole[place..place + 4].try_into().unwrap()) as usize;
    let mut refused = 0;
    for k in (place - length..place).step_by(7) {
        let mut changed = whole.clone();
        changed[k] ^= 1;
        std::fs::write(&path, changed).unwrap();
        let table = names(&path).and_then(|names| {
            let wanted: Vec<&str> = names.iter().map(String::as_str).collect();
            Table::read(&path, &wanted)
        });
        refused += usize::from(table.is_err());
    }
    assert!(refused > 20, "{refused} of the footer's {length} bytes matter");
}
