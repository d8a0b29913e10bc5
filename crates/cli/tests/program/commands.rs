//! The other commands: the main job, figures, arms, check, help.

use std::io::Read as _;
use std::path::Path;
use std::process::{Command, Stdio};

use super::{directory, files, hydrostat, hydrostat_in, picture, refused, solved};

const TWELVE: [&str; 12] = [
    "fig1a.csv",
    "fig1a.pdf",
    "fig1a.png",
    "fig1a.svg",
    "fig1b.csv",
    "fig1b.pdf",
    "fig1b.png",
    "fig1b.svg",
    "fig1c.csv",
    "fig1c.pdf",
    "fig1c.png",
    "fig1c.svg",
];

fn check_figures(directory: &Path) {
    assert_eq!(files(directory), TWELVE);
    for name in TWELVE {
        let bytes = std::fs::read(directory.join(name)).unwrap();
        match name.rsplit('.').next() {
            Some("png") => assert!(picture(&bytes).0 > 1000),
            Some("pdf") => assert!(bytes.starts_with(b"%PDF-1.7") && bytes.ends_with(b"%%EOF")),
            Some("svg") => assert!(bytes.starts_with(b"<svg") && bytes.ends_with(b"</svg>\n")),
            _ => {
                let text = String::from_utf8(bytes).unwrap();
                let columns = text.lines().next().unwrap().split(',').count();
                assert!(text.lines().count() > 800, "{name}");
                for row in text.lines().skip(1) {
                    assert_eq!(row.split(',').filter(|cell| cell.parse::<f64>().is_ok()).count(), columns);
                }
            }
        }
    }
}

#[test]
fn alone_it_prints_the_claims_and_writes_the_figures() {
    let directory = directory();
    let run = hydrostat_in(directory.path(), &[]);
    assert_eq!(run.code, 0, "{}", run.err);
    for words in ["holds in part", "72.25 deg is reached at T1 = 86.24", "det F", "found by trial", "figures/fig1c.csv"]
    {
        let text = run.out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(words), "{words}:\n{}", run.out);
    }
    assert!(run.out.lines().all(|line| line.chars().count() <= 120 || line.starts_with("Written")));
    check_figures(&directory.path().join("figures"));
}

#[test]
fn figures_go_where_they_are_asked_to() {
    let directory = directory();
    let run = hydrostat_in(directory.path(), &["figures", "-o", "deep/er"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(run.out.lines().filter(|line| line.starts_with("deep/er/fig1")).count(), 12);
    assert!(run.out.contains("holds in part"), "{}", run.out);
    check_figures(&directory.path().join("deep/er"));
    let svg = std::fs::read_to_string(directory.path().join("deep/er/fig1a.svg")).unwrap();
    assert!(svg.contains("α(L) = 72.25°") && svg.contains("α(L) = 0.00°"));
}

/// The arm that was found for it: all that the source says of its figure, in a faster stream and at the highest tension.
#[test]
fn every_statement_about_the_figure_holds_on_one_shipped_arm() {
    let directory = directory();
    let run = hydrostat_in(directory.path(), &["figures", "paper-statements", "--at-highest", "--faster", "1"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let text = run.out.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in ["(1a).", "(15).", "(1b).", "(1c)."] {
        assert!(text.contains(part), "{part}: {}", run.out);
    }
    // Findings stand in a column of their own; the two last ones are the source's conclusions, which are about more than the figure.
    let findings: Vec<&str> = run.out.lines().skip(1).filter_map(|line| line.get(..19)).map(str::trim).collect();
    let findings: Vec<&str> = findings.into_iter().filter(|word| !word.is_empty()).take(10).collect();
    assert_eq!(findings[..8], ["holds"; 8], "{}", run.out);
    assert_eq!(findings[8..], ["holds in part", "cannot be decided"], "{}", run.out);
    assert_eq!(files(&directory.path().join("figures")), TWELVE);
    let message = refused(&["figures", "--faster", "0.2"]);
    assert!(message.contains("expected rising speeds above 0.5 m/s"), "{message}");
}

/// The angle had 17 digits, nothing was advised, and an empty directory stayed.
#[test]
fn an_arm_that_does_not_turn_its_tip_so_far_left_an_empty_directory() {
    let directory = directory();
    let run = hydrostat_in(directory.path(), &["figures", "octopus", "-o", "deep/er"]);
    assert_eq!((run.code, run.out.as_str()), (2, ""), "{}", run.err);
    let words = "error: no tension up to 0.02 N turns the tip section by 72.25 deg; the nearest that was found is 2.43 deg, at 0.0";
    assert!(run.err.starts_with(words), "{}", run.err);
    assert!(run.err.contains("\ntry: ") && run.err.contains("`paper` and `paper-statements`"), "{}", run.err);
    assert!(files(directory.path()).is_empty());
    // What was there before stays, empty or not.
    std::fs::create_dir(directory.path().join("mine")).unwrap();
    assert_eq!(hydrostat_in(directory.path(), &["figures", "octopus", "-o", "mine"]).code, 2);
    assert_eq!(files(directory.path()), ["mine"]);
}

#[test]
fn shipped_arms_are_listed_printed_and_valid() {
    let list = solved(&["arms"]).out;
    let names: Vec<&str> = list.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
    let all = [
        "paper",
        "paper-statements",
        "silicone",
        "multi-bending",
        "octopus",
        "octopus-spatial",
        "silicone-spatial",
        "tentacle",
    ];
    assert_eq!(names, all);
    let directory = directory();
    for name in names {
        let text = solved(&["arms", name]).out;
        std::fs::write(directory.path().join("copy.toml"), text).unwrap();
        for args in [["solve", "copy.toml"], ["check", "copy.toml"]] {
            let run = hydrostat_in(directory.path(), &args);
            assert_eq!(run.code, 0, "{name}: {}", run.err);
        }
    }
}

#[test]
fn check_says_what_the_file_means_and_can_be_read_back() {
    let directory = directory();
    let text = "[arm]\nlength = \"10 cm\"\nradius = 0.01\n[material]\nyoung = \"100 kPa\"\n[flow]\nspeed = 1\n\
                [[cable]]\nname = \"pull\"\noffset = 0.005\n";
    std::fs::write(directory.path().join("mine.toml"), text).unwrap();
    let run = hydrostat_in(directory.path(), &["check", "mine.toml"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    for words in ["length = 0.1\n", "young = 100000.0", "poisson = 0.5", "volume = \"planar\""] {
        assert!(run.out.contains(words), "{words}:\n{}", run.out);
    }
    // Ca = 1/2 rho pi 2R U^2 L^3 / (pi E R^4 / 4) = 4 rho U^2 L^3 / (E R^3).
    assert!(run.out.contains("Ca = 40\n"), "{}", run.out);
    // Uniform arm, one cable at half the radius: the section law folds it shut near half of C1 A.
    assert!(run.out.contains("pull alone: "), "{}", run.out);
    std::fs::write(directory.path().join("again.toml"), &run.out).unwrap();
    let again = hydrostat_in(directory.path(), &["check", "again.toml"]);
    assert_eq!((again.code, again.out), (0, run.out));
}

#[test]
fn check_says_which_volume_law_a_weight_asks_for() {
    let heavy = "[arm]\nlength = 0.1\nradius = 0.01\n[material]\nyoung = 1e5\n[gravity]\n";
    let says = |model: &str| {
        let directory = directory();
        std::fs::write(directory.path().join("heavy.toml"), format!("{heavy}[model]\n{model}\n")).unwrap();
        let run = hydrostat_in(directory.path(), &["check", "heavy.toml"]);
        assert_eq!(run.code, 0, "{}", run.err);
        [run.out.contains("use \"circular\" for a real arm"), run.out.contains("can float")]
    };
    assert_eq!(says(""), [true, false]);
    assert_eq!(says("displaced = \"section\""), [true, true]);
    assert_eq!(says("volume = \"circular\"\ndisplaced = \"section\""), [false, false]);
    assert_eq!(says("volume = \"none\""), [false, false]);
    assert!(!solved(&["check", "silicone"]).out.contains("real arm"), "no weight");
}

#[test]
fn help_teaches() {
    let help = solved(&["--help"]).out;
    for words in ["solve", "path", "equilibria", "figures", "arms", "check", "Exit status", "Examples"] {
        assert!(help.contains(words), "{words}");
    }
    let help = solved(&["solve", "--help"]).out;
    for words in ["--tension", "--flow-speed", "--set", "--tol", "--stations", "--format", "--plot", "Exit status"] {
        assert!(help.contains(words), "{words}");
    }
    // The whole description, which was lost behind the line that the list of commands has.
    for (command, words) in
        [("solve", "unless they carry a unit"), ("reach", "sum of the squared tensions"), ("sweep", "last bit")]
    {
        let text = solved(&[command, "--help"]).out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(words), "{command}: {text}");
    }
    for (command, option) in [("path", "--vary"), ("equilibria", "--over")] {
        let help = solved(&[command, "--help"]).out;
        for words in [option, "--quantity", "--flow-speed", "against static divergence", "Flutter", "Exit status"] {
            assert!(help.contains(words), "{command}: {words}");
        }
    }
    for command in ["figures", "arms", "check", "init", "workspace", "completions", "man"] {
        solved(&[command, "--help"]);
    }
    let version = solved(&["--version"]).out;
    assert_eq!(version, format!("hydrostat {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_hydrostat"))
        .args(["solve", "paper", "--format", "csv", "--stations", "50000"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut first = [0; 3];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    assert_eq!(&first, b"s_m");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(!String::from_utf8(output.stderr).unwrap().contains("panicked"));
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_a_failure_of_another_kind() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let status = Command::new(env!("CARGO_BIN_EXE_hydrostat")).arg("arms").stdout(full).stderr(Stdio::null()).status();
    assert_eq!(status.unwrap().code(), Some(1));
    // As a file that was asked for, it is a path that cannot be written.
    assert_eq!(hydrostat(&["solve", "paper", "-o", "/dev/full"]).code, 2);
}

/// Every command of the program, and every option of a command, stands in `docs/interface.md` or, for fits, in `docs/identification.md`.
#[test]
fn serve_and_validate_were_not_documented() {
    let page = include_str!("../../../../docs/interface.md");
    let fits = include_str!("../../../../docs/identification.md");
    let listed = |help: &str, heading: &str| -> Vec<String> {
        let part = help.split_once(heading).unwrap_or_else(|| panic!("no {heading} in {help}")).1;
        // What goes on in a second line is further in.
        let begins = |line: &&str| line.starts_with("  ") && !line.starts_with("         ");
        part.split("\n\nEx").next().unwrap().lines().filter(begins).map(|line| line.trim().to_owned()).collect()
    };
    let help = hydrostat(&["--help"]).out;
    let commands: Vec<String> = listed(help.split("\nOptions:").next().unwrap(), "Commands:\n")
        .iter()
        .filter_map(|line| line.split_whitespace().next().map(str::to_owned))
        .collect();
    assert!(commands.len() > 10, "{commands:?}");
    for command in &commands {
        assert!(page.contains(&format!("\n    hydrostat {command} ")), "{command}");
        // Which is what is asked for here, and has no options.
        if command == "help" {
            continue;
        }
        let help = hydrostat(&[command, "--help"]).out;
        for line in listed(&help, "Options:\n") {
            let Some(option) = line.split_whitespace().find(|word| word.starts_with("--")) else { continue };
            if !line.starts_with('-') || option == "--help" {
                continue;
            }
            let (whole, valued) = (format!("`{option}`"), format!("`{option} "));
            let found = [page, fits].iter().any(|text| text.contains(&whole) || text.contains(&valued));
            assert!(found, "{command} {option}");
        }
    }
}
