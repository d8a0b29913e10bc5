//! The command line itself: help, other names of commands and keys, completions, manual pages, standard input.

use std::io::Write as _;
use std::process::{Command, Stdio};

use super::{Run, directory, files, hydrostat, hydrostat_in, refused, solved};

/// Runs `hydrostat` with a text on standard input.
fn fed(args: &[&str], text: &str) -> Run {
    let mut child = Command::new(env!("CARGO_BIN_EXE_hydrostat"))
        .args(args)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A program that was refused before it read has closed its end.
    let _ = child.stdin.take().unwrap().write_all(text.as_bytes());
    let output = child.wait_with_output().unwrap();
    Run {
        code: output.status.code().unwrap(),
        out: String::from_utf8(output.stdout).unwrap(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}

#[test]
fn help_of_a_command_is_asked_for_either_way() {
    for command in ["solve", "reach", "workspace", "init", "man"] {
        assert_eq!(solved(&["help", command]).out, solved(&[command, "--help"]).out, "{command}");
    }
    assert_eq!(solved(&["help", "inverse"]).out, solved(&["reach", "--help"]).out);
    assert!(hydrostat(&["help", "fly"]).code == 2);
}

#[test]
fn commands_have_the_names_that_people_look_for() {
    let target = ["silicone", "--target", "0.182,0.078", "--format", "csv"];
    let with = |command: &str| solved(&[&[command], &target[..]].concat()).out;
    assert_eq!(with("inverse"), with("reach"));
    let path = ["silicone", "--vary", "flow.speed=0:0.05", "--format", "csv"];
    let with = |command: &str| solved(&[&[command], &path[..]].concat()).out;
    assert_eq!(with("continue"), with("path"));
    let bounds = ["--max-tension", "0.3 N", "--spacing", "0.1", "--format", "csv"];
    let boundary = solved(&[&["reach", "silicone", "--boundary"], &bounds[..]].concat()).out;
    assert_eq!(solved(&[&["workspace", "silicone"], &bounds[..]].concat()).out, boundary);
}

#[test]
fn keys_take_their_indices_with_points() {
    let with = |key: &str| solved(&["solve", "silicone", "--set", key, "--format", "csv"]).out;
    assert_eq!(with("cable.0.tension=0.2"), with("cable[0].tension=0.2"));
    let path =
        |key: &str| solved(&["path", "silicone", "--vary", key, "--quantity", "stroke.0", "--format", "csv"]).out;
    assert_eq!(path("cable.0.tension=0:0.1"), path("cable[0].tension=0:0.1"));
    let directory = directory();
    let sweep = |key: &str, file: &str| {
        let run = hydrostat_in(directory.path(), &["sweep", "silicone", "--vary", key, "-o", file]);
        assert_eq!(run.code, 0, "{}", run.err);
        std::fs::read(directory.path().join(file)).unwrap()
    };
    assert_eq!(sweep("cable.0.tension=0:0.1:3", "a.csv"), sweep("cable[0].tension=0:0.1:3", "b.csv"));
}

#[test]
fn numbers_that_toml_does_not_know_are_numbers() {
    let with = |tension: &str| solved(&["solve", "silicone", "--tension", tension, "--format", "csv"]).out;
    let expected = with("0.1,0.05");
    for tension in [".1,.05", "1.e-1,5.e-2", "+.1,0.05", "\".1\",0.05"] {
        assert_eq!(with(tension), expected, "{tension}");
    }
    assert_eq!(with("0.,.1"), with("0,0.1"));
    assert_eq!(
        solved(&["solve", "silicone", "--set", "flow.speed=.1", "--format", "csv"]).out,
        solved(&["solve", "silicone", "--flow-speed", "0.1", "--format", "csv"]).out
    );
}

#[test]
fn shells_get_completions() {
    for (shell, words) in [
        ("bash", "complete -F _hydrostat"),
        ("zsh", "#compdef hydrostat"),
        ("fish", "complete -c hydrostat"),
        ("powershell", "Register-ArgumentCompleter"),
        ("elvish", "edit:completion:arg-completer[hydrostat]"),
    ] {
        let script = solved(&["completions", shell]).out;
        assert!(script.contains(words), "{shell}");
        for word in ["solve", "--flow-speed", "equilibria"] {
            assert!(script.contains(word.trim_start_matches("--")), "{shell}: {word}");
        }
    }
    assert!(hydrostat(&["completions", "csh"]).code == 2);
}

#[test]
fn manual_pages_are_printed_and_written() {
    let page = solved(&["man"]).out;
    assert!(page.contains(".TH hydrostat 1") && page.contains("hydrostat\\-solve(1)"), "{page}");
    let page = solved(&["man", "solve"]).out;
    assert!(page.contains(".TH hydrostat-solve 1") && page.contains("\\-\\-flow\\-speed"), "{page}");
    assert!(refused(&["man", "fly"]).contains("`fly` is not a command; the commands are solve, path"));
    let directory = directory();
    assert_eq!(hydrostat_in(directory.path(), &["man", "-o", "man1"]).code, 0);
    let pages = files(&directory.path().join("man1"));
    for name in ["hydrostat.1", "hydrostat-solve.1", "hydrostat-workspace.1", "hydrostat-completions.1"] {
        assert!(pages.iter().any(|page| page == name), "{name} in {pages:?}");
    }
    assert!(!pages.iter().any(|page| page.contains("help")), "{pages:?}");
}

#[test]
fn a_dash_is_standard_input() {
    let text = solved(&["arms", "silicone"]).out;
    let solve = ["--tension", "0.2,0", "--format", "csv"];
    let run = fed(&[&["solve", "-"], &solve[..]].concat(), &text);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert_eq!(run.out, solved(&[&["solve", "silicone"], &solve[..]].concat()).out);
    let run = fed(&["check", "-"], "[arm]\nlenght = 1\n");
    assert_eq!(run.code, 2);
    assert!(run.err.starts_with("error: standard input:2: arm.lenght: unknown key; "), "{}", run.err);

    let targets = "x_m,y_m\n0.182,0.078\n0.181,0.079\n";
    let follow = ["reach", "silicone", "--path"];
    let run = fed(&[&follow[..], &["-", "--format", "csv"]].concat(), targets);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(run.out.lines().count(), 3);
    let run = fed(&[&follow[..], &["-"]].concat(), "x_m,z_m\n");
    assert!(run.code == 2 && run.err.starts_with("error: standard input:1: expected a header"), "{}", run.err);

    let data = "s [mm],x [mm],y [mm]\n245,230.1,62.3\n";
    let run =
        fed(&["identify", "silicone", "-", "--fit", "young", "--sd", "1 mm", "--set", "cable[0].tension=0.2"], data);
    assert!(run.code == 0 && run.out.contains("material.young (Pa)"), "{}{}", run.out, run.err);

    for args in [&["reach", "-", "--path", "-"][..], &["identify", "-", "-", "--fit", "young"]] {
        let run = fed(args, &text);
        assert!(run.code == 2 && run.err.contains("is read only once"), "{}", run.err);
    }
    let run = Command::new(env!("CARGO_BIN_EXE_hydrostat")).args(["solve", "-"]).stdin(Stdio::null()).output().unwrap();
    assert_eq!(run.status.code(), Some(2));
}

/// A tension that is given and does not count was taken in silence.
#[test]
fn identify_has_one_word_for_each_output() {
    let help = solved(&["identify", "--help"]).out;
    assert!(
        help.contains("--fitted <FILE>") && help.contains("-o, --output <FILE>") && !help.contains("--out "),
        "{help}"
    );
}
