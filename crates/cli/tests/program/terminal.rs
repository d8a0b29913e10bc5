//! What is different where a person looks on: colour, width, questions, progress.

use std::fs::File;
use std::io::{Read as _, Write as _};
use std::process::{Child, Command, Stdio};

use rustix::fs::{Mode, OFlags, open};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{Winsize, tcsetwinsize};

use super::directory;

/// Both ends of a terminal so many columns wide: what it shows, and what a program gets.
fn terminal(columns: u16) -> (File, File) {
    let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&master).unwrap();
    unlockpt(&master).unwrap();
    let name = ptsname(&master, Vec::new()).unwrap();
    let own = open(name.as_c_str(), OFlags::RDWR | OFlags::NOCTTY, Mode::empty()).unwrap();
    tcsetwinsize(&own, Winsize { ws_row: 50, ws_col: columns, ws_xpixel: 0, ws_ypixel: 0 }).unwrap();
    (master.into(), own.into())
}

/// Everything that the terminal shows until the program ends.
fn shown(mut child: Child, mut screen: File) -> (i32, String) {
    let mut out = Vec::new();
    // At the end of the last program the terminal is gone, which is an error of its own.
    let _ = screen.read_to_end(&mut out);
    (child.wait().unwrap().code().unwrap(), String::from_utf8_lossy(&out).into_owned())
}

fn program(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hydrostat"));
    command.args(args).env("TERM", "xterm").env_remove("NO_COLOR").env_remove("CI");
    command
}

/// A text without what sets colours.
fn plain(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("\u{1b}[") {
        out.push_str(before);
        rest = after.split_once(|c: char| c.is_ascii_alphabetic()).map_or("", |(_, rest)| rest);
    }
    out + rest
}

#[test]
fn help_is_as_wide_as_the_terminal_and_has_colours_there() {
    for columns in [60, 90] {
        let (screen, own) = terminal(columns);
        let child = program(&["solve", "--help"]).stdout(own).stdin(Stdio::null()).spawn().unwrap();
        let (code, text) = shown(child, screen);
        assert_eq!(code, 0);
        assert!(text.contains("\u{1b}["), "{text}");
        let lines: Vec<String> = plain(&text).lines().map(|line| line.trim_end().to_owned()).collect();
        let widest = lines.iter().map(|line| line.chars().count()).max().unwrap();
        assert!(widest <= usize::from(columns) && widest > usize::from(columns) - 20, "{widest} of {columns}\n{text}");
    }
    let piped = super::solved(&["solve", "--help"]).out;
    assert!(!piped.contains('\u{1b}') && piped.lines().all(|line| line.chars().count() <= 120), "{piped}");
}

#[test]
fn many_rows_are_asked_about() {
    let directory = directory();
    let keys = ["--vary", "flow.speed=0:1:100000", "--vary", "cable[0].tension=0:1:100000"];
    let args = [&["sweep", "silicone", "-o", "out.csv"][..], &keys].concat();
    for answer in ["n\n", "\n", "what?\n"] {
        let (mut screen, own) = terminal(80);
        let child = program(&args)
            .current_dir(directory.path())
            .stdin(own.try_clone().unwrap())
            .stderr(own)
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        screen.write_all(answer.as_bytes()).unwrap();
        let (code, text) = shown(child, screen);
        assert_eq!(code, 130, "{text}");
        assert!(text.contains("10000000000 rows: even at 30000 rows/s they take 3 days 21 h."), "{text}");
        assert!(text.contains("Go on? [y/N]") && plain(&text).contains("error: nothing was solved"), "{text}");
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 0);
    }
}

#[test]
fn long_work_says_where_it_is() {
    let (screen, own) = terminal(100);
    let over = ["equilibria", "silicone", "--set", "flow.direction=180", "--over", "flow.speed=0.1:0.3:6"];
    let child = program(&over).stdout(Stdio::null()).stdin(Stdio::null()).stderr(own).spawn().unwrap();
    let (code, text) = shown(child, screen);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains(" of 6, at flow.speed = ") && text.contains("points of the curve of equilibria"), "{text}");
    // The line is gone at the end.
    assert!(text.ends_with("\r\u{1b}[K"), "{text:?}");
}

/// Words that say what a line is have a colour where a person reads them, and nowhere else.
#[test]
fn errors_and_warnings_have_colours_on_a_terminal() {
    let said = |args: &[&str], no_color: bool| {
        let (screen, own) = terminal(100);
        let mut command = program(args);
        if no_color {
            command.env("NO_COLOR", "1");
        }
        let child = command.stdout(Stdio::null()).stdin(Stdio::null()).stderr(own).spawn().unwrap();
        drop(command);
        shown(child, screen).1
    };
    let slip = ["check", "silicone", "--set", "arm.length=300"];
    let text = said(&slip, false);
    assert!(text.contains("\u{1b}[") && plain(&text).starts_with("warning: arm.length = 300 m"), "{text:?}");
    assert!(said(&["solve", "nowhere.toml"], false).starts_with("\u{1b}["));
    assert!(said(&["solve", "--nothing"], false).contains("\u{1b}["));
    assert!(!said(&slip, true).contains('\u{1b}'));
    assert!(!super::solved(&slip).err.contains('\u{1b}'));
}
