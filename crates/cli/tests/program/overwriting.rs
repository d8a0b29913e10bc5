//! Nothing that is read is written over.

use std::fs;
use std::path::Path;

use super::{directory, files, hydrostat_in, refused, solved};

const DATA: &str = "s [mm],x [mm],y [mm]\n245,230.1,62.3\n";
const TARGETS: &str = "x_m,y_m\n0.182,0.078\n";

/// A directory with an arm, measurements and targets, and links to the arm.
fn place() -> tempfile::TempDir {
    let directory = directory();
    let here = directory.path();
    fs::write(here.join("my.toml"), solved(&["arms", "silicone"]).out).unwrap();
    fs::write(here.join("data.csv"), DATA).unwrap();
    fs::write(here.join("targets.csv"), TARGETS).unwrap();
    fs::create_dir(here.join("sub")).unwrap();
    fs::hard_link(here.join("my.toml"), here.join("hard.svg")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("my.toml", here.join("soft.svg")).unwrap();
    directory
}

fn contents(here: &Path) -> Vec<(String, Vec<u8>)> {
    let read = |name: String| fs::read(here.join(&name)).ok().map(|bytes| (name, bytes));
    files(here).into_iter().filter_map(read).collect()
}

/// `solve my.toml -o my.toml` left a summary where the arm was.
#[test]
fn inputs_were_replaced_by_outputs() {
    let directory = place();
    let here = directory.path();
    let before = contents(here);
    let identify = ["identify", "my.toml", "data.csv", "--fit", "young", "--sd", "1 mm"];
    let soft = if cfg!(unix) { "soft.svg" } else { "hard.svg" };
    for (args, option) in [
        (&["solve", "my.toml", "-o", "my.toml"][..], "-o"),
        (&["solve", "my.toml", "-o", "./sub/../my.toml"], "-o"),
        (&["solve", "my.toml", "--plot", "hard.svg"], "--plot"),
        (&["solve", "my.toml", "--plot", soft], "--plot"),
        (&["solve", "hard.svg", "-o", "my.toml"], "-o"),
        (&["path", "my.toml", "--vary", "flow.speed=0:0.1", "-o", "my.toml"], "-o"),
        (&["path", "my.toml", "--vary", "flow.speed=0:0.1", "--plot", "hard.svg"], "--plot"),
        (&["path", "my.toml", "--vary", "flow.speed=0:0.1", "--plot-shapes", soft], "--plot-shapes"),
        (&["equilibria", "my.toml", "-o", "my.toml"], "-o"),
        (&["equilibria", "my.toml", "--plot", "hard.svg"], "--plot"),
        (&["equilibria", "my.toml", "--over", "flow.speed=0:0.1:2", "--plot-over", soft], "--plot-over"),
        (&["reach", "my.toml", "--target", "0.18,0.07", "-o", "my.toml"], "-o"),
        (&["reach", "my.toml", "--target", "0.18,0.07", "--plot", "hard.svg"], "--plot"),
        (&["reach", "my.toml", "--path", "targets.csv", "-o", "targets.csv"], "-o"),
        (&["reach", "my.toml", "--path", "targets.csv", "-o", "my.toml"], "-o"),
        (&[&identify[..], &["-o", "data.csv"]].concat(), "-o"),
        (&[&identify[..], &["-o", "my.toml"]].concat(), "-o"),
        (&[&identify[..], &["--fitted", "my.toml"]].concat(), "--fitted"),
        (&[&identify[..], &["--plot", soft]].concat(), "--plot"),
        (&["identify", "my.toml", "--template", "-o", "my.toml"], "-o"),
    ] {
        let run = hydrostat_in(here, args);
        assert_eq!((run.code, run.out.as_str()), (2, ""), "{args:?}: {}", run.err);
        let said =
            run.err.starts_with(&format!("error: {option} ")) && run.err.contains("inputs are never overwritten");
        assert!(said, "{args:?}: {}", run.err);
        assert!(contents(here) == before, "{args:?}");
    }
    // Two outputs in one file under two names.
    let run = hydrostat_in(here, &["solve", "my.toml", "-o", "new.svg", "--plot", "sub/../new.svg"]);
    assert!(run.code == 2 && run.err.contains("-o and --plot both name"), "{}", run.err);
    // A shipped arm is no file, and another file is another file.
    assert_eq!(hydrostat_in(here, &["solve", "silicone", "-o", "silicone"]).code, 0);
    assert_eq!(hydrostat_in(here, &["solve", "my.toml", "-o", "new.txt"]).code, 0);
}

/// `solve - -o my.toml < my.toml` did the same.
#[cfg(unix)]
#[test]
fn what_standard_input_comes_from_is_an_input() {
    let directory = place();
    let here = directory.path();
    let before = contents(here);
    for args in [&["solve", "-", "-o", "my.toml"][..], &["path", "-", "--vary", "flow.speed=0:0.1", "-o", "my.toml"]] {
        let run = std::process::Command::new(env!("CARGO_BIN_EXE_hydrostat"))
            .args(args)
            .current_dir(here)
            .stdin(fs::File::open(here.join("my.toml")).unwrap())
            .output()
            .unwrap();
        let err = String::from_utf8(run.stderr).unwrap();
        assert!(run.status.code() == Some(2) && err.contains("also read, as ARM"), "{args:?}: {err}");
        assert!(contents(here) == before, "{args:?}");
    }
}

#[test]
fn figures_sweeps_and_plots_keep_what_they_read() {
    let directory = place();
    let here = directory.path();
    let refuse = |args: &[&str]| {
        let before = contents(here);
        let run = hydrostat_in(here, args);
        assert_eq!((run.code, run.out.as_str()), (2, ""), "{args:?}: {}", run.err);
        assert!(run.err.contains("inputs are never overwritten"), "{args:?}: {}", run.err);
        assert!(contents(here) == before, "{args:?}");
    };
    fs::copy(here.join("my.toml"), here.join("fig1a.csv")).unwrap();
    refuse(&["figures", "fig1a.csv", "-o", "."]);
    fs::copy(here.join("my.toml"), here.join("out.csv.json")).unwrap();
    refuse(&["sweep", "out.csv.json", "--vary", "flow.speed=0,0.1", "-o", "out.csv"]);
    refuse(&["sweep", "fig1a.csv", "--vary", "flow.speed=0,0.1", "-o", "fig1a.csv", "--resume"]);
    let sweep = ["sweep", "my.toml", "--vary", "flow.speed=0,0.1", "-o", "sweep.csv"];
    assert_eq!(hydrostat_in(here, &sweep).code, 0);
    fs::hard_link(here.join("sweep.csv"), here.join("sweep.svg")).unwrap();
    refuse(&["plot", "sweep.csv", "--map", "sweep.svg"]);
    refuse(&["plot", "sweep.csv", "--workspace", "sweep.svg"]);
}

#[test]
fn reach_took_tensions_and_did_not_use_them() {
    let message = refused(&["reach", "silicone", "--target", "0.182,0.078", "--tension", "0.2,0"]);
    assert!(message.starts_with("error: --tension: reach finds the tensions itself"), "{message}");
    assert!(message.contains("--max-tension"), "{message}");
    refused(&["reach", "silicone", "--boundary", "--max-tension", "0.6", "--tension", "0.2,0"]);
}
