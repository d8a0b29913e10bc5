//! `hydrostat sweep` and `hydrostat plot`, also when they are stopped in the middle.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, SystemTime};

use super::{columns, directory, files, hydrostat_in, picture, refused};

const KEYS: [&str; 4] = ["--vary", "flow.speed=0:50 cm/s:4", "--vary", "cable[0].tension=0:60:5"];

fn sweep<'a>(more: &[&'a str]) -> Vec<&'a str> {
    ["sweep", "paper"].iter().chain(&KEYS).chain(more).copied().collect()
}

#[test]
fn a_sweep_is_a_table_and_its_pictures() {
    let directory = directory();
    let run = hydrostat_in(directory.path(), &sweep(&["-o", "out.csv", "--columns", "tip,fold", "--threads", "2"]));
    assert_eq!((run.code, run.out.as_str()), (0, ""), "{}", run.err);
    assert!(run.err.starts_with("out.csv: 20 rows of paper, 20 with an equilibrium"), "{}", run.err);
    let text = std::fs::read_to_string(directory.path().join("out.csv")).unwrap();
    let (names, rows) = columns(&text);
    assert_eq!(names[..4], ["row", "flow_speed_m_s", "cable_0_tension_N", "tip_x_m"]);
    assert_eq!((rows.len(), rows[19][1], rows[19][2], rows[19][0]), (20, "0.5", "60.0", "19"));

    let run = hydrostat_in(directory.path(), &sweep(&["-o", "out.parquet"]));
    assert_eq!(run.code, 0, "{}", run.err);
    let run = hydrostat_in(directory.path(), &["plot", "out.parquet"]);
    let written = "out.map.svg\nout.map.png\nout.workspace.svg\nout.workspace.png\n";
    assert_eq!((run.code, run.out.as_str(), run.err.as_str()), (0, written, ""));
    let pictures = ["out.map.png", "out.map.svg", "out.parquet", "out.workspace.png", "out.workspace.svg"];
    assert_eq!(files(directory.path()), [&["out.csv", "out.csv.json"][..], &pictures].concat());
    let read = |name: &str| std::fs::read(directory.path().join(name)).unwrap();
    let (width, height) = picture(&read("out.map.png"));
    assert!(width == 1875 && height > 1000);
    picture(&read("out.workspace.png"));
    let map = String::from_utf8(read("out.map.svg")).unwrap();
    for text in ["flow.speed (cm/s)", "cable[0].tension (N)", "α(L) (°)", "data:image/png;base64,"] {
        assert!(map.contains(text), "{text}");
    }
    // What stands beside a CSV knows the units of its keys; a single key gives a curve.
    let args = ["plot", "out.csv", "--quantity", "fold_margin", "--over", "flow.speed", "--map", "curve.svg"];
    assert_eq!(hydrostat_in(directory.path(), &args).code, 0);
    let curve = String::from_utf8(read("curve.svg")).unwrap();
    assert!(curve.contains("flow.speed (cm/s)") && curve.contains("fold margin"), "{curve}");
}

#[test]
fn rows_without_an_equilibrium_are_rows() {
    let directory = directory();
    let args = ["sweep", "silicone", "--vary", "cable[0].tension=0.5,1.5", "-o", "out.csv"];
    let run = hydrostat_in(directory.path(), &args);
    assert!(run.code == 0 && run.err.contains("2 rows of silicone, 1 with an equilibrium"), "{}", run.err);
    let text = std::fs::read_to_string(directory.path().join("out.csv")).unwrap();
    let (names, rows) = columns(&text);
    let verdict = names.iter().position(|name| *name == "verdict").unwrap();
    assert_eq!((rows[0][verdict], rows[1][verdict], rows[1][verdict + 1]), ("", "cable_fold", "tension"));
    let run =
        hydrostat_in(directory.path(), &["sweep", "silicone", "--vary", "cable[0].tension=1.2,1.4", "-o", "none.csv"]);
    assert_eq!((run.code, run.out.as_str()), (3, ""));
    assert!(run.err.contains("none.csv: 2 rows of silicone, 0 with an equilibrium"), "{}", run.err);
    assert_eq!(files(directory.path()), ["none.csv", "none.csv.json", "out.csv", "out.csv.json"]);
}

#[test]
fn sweeps_that_cannot_be_meant() {
    let vary = |text: &str| refused(&["sweep", "paper", "--vary", text, "-o", "out.parquet"]);
    for (text, said) in [
        ("flow.sped=0:1:5", "did you mean `flow.speed`?"),
        ("flow.speed=0:1:0", "expected a whole number from 1"),
        ("flow.speed=", "expected at least one value"),
        ("flow.speed=0:1", "expected FROM:TO:COUNT or a list"),
        ("flow.speed=0:1 N:5", "expected a speed"),
        ("flow.speed=-1:1:5", "--vary flow.speed=-1.0: flow.speed: expected a value that is not negative"),
        ("flow.law=magnus", "--vary flow.law=magnus"),
        ("flow.speed", "expected KEY=FROM:TO:COUNT"),
    ] {
        let message = vary(text);
        assert!(message.contains(said) && message.contains("--vary"), "{text}: {message}");
    }
    let with = |more: &[&str]| refused(&sweep(&[&["-o", "out.parquet"], more].concat()));
    assert!(with(&["--vary", "flow.speed=1,2"]).contains("flow.speed: the key is given twice"));
    assert!(with(&["--sample", "lhs:5"]).contains("expected FROM:TO or a list"));
    assert!(with(&["--sample", "lhs:0"]).contains("--sample"));
    assert!(with(&["--columns", "tip,tap"]).contains("expected some of tip, alpha"));
    assert!(with(&["--shard", "3/2"]).contains("expected I/N"));
    assert!(with(&["--shard", "1/21"]).contains("at most 20 shards, because the sweep has 20 rows"));
    assert!(with(&["--tol", "1"]).contains("--tol: expected a number in [1e-12, 1e-2], found 1"));
    assert!(with(&["--threads", "0"]).contains("--threads"));
    assert!(with(&["--shapes", "1"]).contains("from 2 to 1000"));
    assert!(refused(&sweep(&["-o", "out.txt"])).contains(".parquet or .csv"));
    assert!(refused(&sweep(&["-o", "nowhere/out.csv"])).contains("cannot write nowhere/out.csv"));
    refused(&["sweep", "paper", "-o", "out.csv"]);
}

#[test]
fn outputs_that_are_there_and_plots_that_cannot_be() {
    let directory = directory();
    let here = directory.path();
    std::fs::write(here.join("out.csv"), "kept").unwrap();
    for more in [&["-o", "out.csv"][..], &["-o", "out.csv", "--resume"]] {
        let run = hydrostat_in(here, &sweep(more));
        assert_eq!(run.code, 2);
        assert_eq!(run.err, "error: out.csv exists; remove it or choose another name\n");
    }
    let refused = |args: &[&str]| {
        let run = hydrostat_in(here, args);
        assert_eq!((run.code, run.out.as_str()), (2, ""), "{args:?}: {}", run.err);
        run.err
    };
    assert!(refused(&["plot", "out.csv"]).contains("expected the output of a sweep"));
    assert!(refused(&["plot", "none.parquet"]).contains("none.parquet: "));
    assert_eq!(std::fs::read_to_string(here.join("out.csv")).unwrap(), "kept");
    let args = [
        "sweep",
        "paper",
        "--vary",
        "flow.speed=0,1",
        "--vary",
        "cable[0].tension=0,1",
        "--vary",
        "arm.density=1000,1080",
        "--vary",
        "model.volume=none,planar",
    ];
    assert_eq!(hydrostat_in(here, &[&args[..], &["-o", "three.csv"]].concat()).code, 0);
    assert!(refused(&["plot", "three.csv"]).contains("--over: expected one or two"));
    assert!(refused(&["plot", "three.csv", "--over", "flow.speed,flow.speed"]).contains("--over"));
    assert!(refused(&["plot", "three.csv", "--over", "flow.speed,model.volume"]).contains("words"));
    let over = ["plot", "three.csv", "--over", "flow.speed,cable[0].tension"];
    assert!(refused(&[&over[..], &["--quantity", "tip_z"]].concat()).contains("expected one of row, flow_speed_m_s"));
    assert!(refused(&[&over[..], &["--map", "nowhere/a.svg"]].concat()).contains("cannot write nowhere/a.svg"));
    assert_eq!(files(here), ["out.csv", "three.csv", "three.csv.json"]);
}

/// `plot` complained of `--over`, which was not given.
#[test]
fn a_sweep_over_a_word_and_a_number_is_drawn_over_the_number() {
    let directory = directory();
    let here = directory.path();
    let words = ["--vary", "model.volume=planar,none"];
    let sweep = |more: &[&str]| hydrostat_in(here, &[&["sweep", "paper"], &words[..], more].concat()).code;
    assert_eq!(sweep(&["--vary", "cable[0].tension=0:80:5", "-o", "w.csv"]), 0);
    let run = hydrostat_in(here, &["plot", "w.csv", "--map", "w.svg", "--svg-text"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let svg = std::fs::read_to_string(here.join("w.svg")).unwrap();
    assert!(svg.contains("cable[0].tension (N)") && svg.contains("w.csv, model.volume = planar"), "{svg}");
    assert_eq!(sweep(&["-o", "words.csv"]), 0);
    let run = hydrostat_in(here, &["plot", "words.csv"]);
    assert!(run.code == 2 && run.err.contains("the values of model.volume are words"), "{}", run.err);
}

/// A disk that takes no more: what is written stops at a limit that the shell sets.
#[cfg(unix)]
#[test]
fn a_disk_that_is_full_is_said_to_be() {
    let directory = directory();
    let script = format!(
        "trap '' XFSZ; ulimit -f 20; exec '{}' sweep paper --vary flow.speed=0:1:20 --vary cable[0].tension=0:60:130 \
         --shapes 20 -o out.parquet",
        env!("CARGO_BIN_EXE_hydrostat")
    );
    let run = Command::new("sh").arg("-c").arg(&script).current_dir(directory.path()).output().unwrap();
    let said = String::from_utf8(run.stderr).unwrap();
    assert_eq!(run.status.code(), Some(2), "{said}");
    assert!(said.starts_with("error: cannot write out.parquet.parts/"), "{said}");
    assert_eq!(files(directory.path()), ["out.parquet.parts"]);
    assert!(files(&directory.path().join("out.parquet.parts")).iter().all(|name| !name.starts_with('.')));
}

/// A sweep of a second or so and of sixty parts, begun or gone on with.
fn begin(directory: &Path, output: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_hydrostat"))
        .args(begun(output))
        .current_dir(directory)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

fn begun(output: &str) -> [&str; 12] {
    [
        "sweep",
        "paper",
        "--vary",
        "flow.speed=0:0.5:60",
        "--vary",
        "cable[0].tension=0:60:130",
        "--columns",
        "tip,fold",
        "--threads=2",
        "--resume",
        "-o",
        output,
    ]
}

/// When each whole part was written.
fn parts(directory: &Path) -> BTreeMap<String, SystemTime> {
    let Ok(entries) = std::fs::read_dir(directory) else { return BTreeMap::new() };
    let whole = |name: &str| name.ends_with(".parquet") && !name.starts_with('.');
    entries
        .flatten()
        .filter_map(|entry| Some((entry.file_name().into_string().ok()?, entry.metadata().ok()?.modified().ok()?)))
        .filter(|(name, _)| whole(name))
        .collect()
}

/// Kills sweeps at so many random moments; each must come to the bytes of one that was never stopped, and keep its whole
/// parts.
fn kill(times: u32) {
    let directory = directory();
    let here = directory.path();
    assert!(begin(here, "want.parquet").wait().unwrap().success());
    let want = std::fs::read(here.join("want.parquet")).unwrap();
    let mut random = u64::from(std::process::id());
    let (mut killed, mut kept) = (0_u32, 0);
    for number in 0.. {
        let name = format!("{number}.parquet");
        let there = here.join(format!("{name}.parts"));
        loop {
            let before = parts(&there);
            kept += before.len();
            let mut child = begin(here, &name);
            // Every other kill comes after a part more, however slow the machine is.
            while killed.is_multiple_of(2) && parts(&there).len() <= before.len() && child.try_wait().unwrap().is_none()
            {
                std::thread::sleep(Duration::from_millis(5));
            }
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            std::thread::sleep(Duration::from_millis((random >> 33) % 400));
            let ended = killed >= times || child.try_wait().unwrap().is_some();
            if !ended {
                child.kill().unwrap();
                killed += 1;
            }
            let status = child.wait().unwrap();
            if status.success() {
                break;
            }
            assert!(status.code().is_none(), "{status}");
            let after = parts(&there);
            if here.join(&name).exists() {
                // Killed between the renaming of the output and the end: its parts are being removed.
                continue;
            }
            assert!(before.iter().all(|(part, at)| after.get(part) == Some(at)), "{before:?} {after:?}");
        }
        assert!(std::fs::read(here.join(&name)).unwrap() == want, "after {killed} kills");
        if killed >= times {
            break;
        }
    }
    assert!(kept > 0, "every kill came before the first part");
    assert!(files(here).iter().all(|name| name.ends_with(".parquet")));
}

/// It ended without a word of how to go on.
#[cfg(unix)]
#[test]
fn ctrl_c_said_nothing() {
    let directory = directory();
    let child = Command::new(env!("CARGO_BIN_EXE_hydrostat"))
        .args(["sweep", "paper", "--vary", "flow.speed=0:0.5:6000", "--vary", "cable[0].tension=0:60:130"])
        .args(["--threads", "1", "-o", "out.parquet"])
        .current_dir(directory.path())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    while parts(&directory.path().join("out.parquet.parts")).is_empty() {
        std::thread::sleep(Duration::from_millis(20));
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let ended = child.wait_with_output().unwrap();
    let said = String::from_utf8(ended.stderr).unwrap();
    // On a slow machine lines of progress come before.
    let last = said.lines().last();
    assert_eq!((ended.status.code(), last), (Some(130), Some("stopped: resume with the same command and --resume")));
}

/// One was told to remove the directory in which another sweep was at work.
#[test]
fn a_second_sweep_was_told_to_remove_the_first() {
    let directory = directory();
    let here = directory.path();
    let keys = ["--vary", "flow.speed=0:0.5:6000", "--vary", "cable[0].tension=0:60:130", "-o", "out.parquet"];
    let sweep = [&["sweep", "paper"][..], &keys].concat();
    let mut first = Command::new(env!("CARGO_BIN_EXE_hydrostat"))
        .args(&sweep)
        .args(["--threads", "1"])
        .current_dir(here)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while parts(&here.join("out.parquet.parts")).is_empty() {
        std::thread::sleep(Duration::from_millis(20));
    }
    for more in [&[][..], &["--resume"]] {
        let run = hydrostat_in(here, &[&sweep[..], more].concat());
        let said = "error: another sweep is writing out.parquet; wait until it ends, or choose another name\n";
        assert_eq!((run.code, run.err.as_str()), (2, said), "{more:?}");
    }
    first.kill().unwrap();
    first.wait().unwrap();
    let run = hydrostat_in(here, &sweep);
    assert!(run.code == 2 && run.err.contains("an interrupted sweep; resume it with --resume"), "{}", run.err);
}

/// A part that was cut was joined as it was, and its rows were missing.
#[test]
fn cut_parts_were_joined() {
    let directory = directory();
    let here = directory.path();
    let there = here.join("out.parquet.parts");
    let mut child = begin(here, "out.parquet");
    while parts(&there).is_empty() {
        assert!(child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let (part, _) = parts(&there).pop_first().unwrap();
    std::fs::write(there.join(part), "PAR1").unwrap();
    let run = hydrostat_in(here, &begun("out.parquet"));
    assert!(run.err.starts_with("note: 1 part of an earlier run had changed since; solved again\n"), "{}", run.err);
    assert!(run.err.contains("out.parquet: 7800 rows of paper"), "{}", run.err);
    assert_eq!(run.code, 0);
}

#[test]
fn killed_sweeps_go_on() {
    kill(5);
}

#[test]
#[ignore = "takes a minute; five kills are in the test above"]
fn slow_fifty_kills() {
    kill(50);
}
