//! What the guide shows is what the program does: its commands are run, their output is compared, its arm files are read, and its
//! pictures are drawn again.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use super::{directory, hydrostat_in};

/// Where its chapters are.
fn pages() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../guide/src")
}

/// The chapters, in the order of their names.
fn chapters() -> Vec<PathBuf> {
    let entries = fs::read_dir(pages()).unwrap().map(|entry| entry.unwrap().path());
    let mut all: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|e| e == "md")).collect();
    all.sort();
    all
}

/// Words of a command as a shell would split them.
pub(super) fn words(command: &str) -> Vec<String> {
    let (mut out, mut word, mut quote, mut begun) = (Vec::new(), String::new(), None, false);
    for c in command.chars() {
        match (quote, c) {
            (Some(q), c) if c == q => quote = None,
            (None, '"' | '\'') => (quote, begun) = (Some(c), true),
            (None, ' ') if !word.is_empty() || begun => {
                out.push(std::mem::take(&mut word));
                begun = false;
            }
            (None, ' ') => {}
            (_, c) => word.push(c),
        }
    }
    if !word.is_empty() || begun {
        out.push(word);
    }
    assert!(quote.is_none(), "{command}");
    out
}

/// The chapter with the outputs of its commands as they are now, played in `place`, where pictures are left.
fn played(text: &str, place: &Path) -> String {
    let mut out = String::new();
    let mut lines = text.split_inclusive('\n');
    while let Some(line) = lines.next() {
        out.push_str(line);
        let Some(language) = line.trim_end().strip_prefix("```").filter(|language| !language.is_empty()) else {
            continue;
        };
        let block: Vec<&str> = lines.by_ref().take_while(|line| line.trim_end() != "```").collect();
        match language {
            "console" => {
                for command in block.iter().filter_map(|line| line.strip_prefix("$ ")) {
                    let words = words(command.trim_end());
                    assert_eq!(words[0], "hydrostat", "{command}");
                    let arguments: Vec<&str> = words[1..].iter().map(String::as_str).collect();
                    let run = hydrostat_in(place, &arguments);
                    assert!(matches!(run.code, 0 | 3), "{command}{}", run.err);
                    let _ = write!(out, "$ {}\n{}{}", command.trim_end(), run.out, run.err);
                    out.push('\n');
                }
                // One empty line between two commands, none at the end.
                out.truncate(out.trim_end().len());
                out.push('\n');
            }
            "toml" => {
                let text = block.concat();
                let name = text.lines().next().and_then(|line| line.strip_prefix("# ")).expect("a file's name");
                fs::write(place.join(name), &text).unwrap();
                let run = hydrostat_in(place, &["check", name]);
                assert_eq!(run.code, 0, "{name}: {}", run.err);
                out.push_str(&text);
            }
            "csv" => {
                let text = block.concat();
                let name = text.lines().next().and_then(|line| line.strip_prefix("# ")).expect("a file's name");
                fs::write(place.join(name), &text).unwrap();
                out.push_str(&text);
            }
            _ => out.push_str(&block.concat()),
        }
        out.push_str("```\n");
    }
    out
}

/// The pictures that a chapter shows.
fn pictures(text: &str) -> Vec<&str> {
    text.split("](pictures/").skip(1).filter_map(|rest| rest.split(')').next()).collect()
}

/// The texts of a drawing. Its lines may differ in their last digit from one processor to another.
fn labels(svg: &str) -> Vec<&str> {
    svg.split("aria-label=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

/// What is the same on every processor: not what a solve or a sweep took, not its error, and no rounding.
fn steady(text: &str) -> Vec<String> {
    let word = |word: &str| {
        let rounding = word.parse::<f64>().is_ok_and(|v| v != 0.0 && v.abs() < 1e-9);
        if rounding { "0".to_owned() } else { word.to_owned() }
    };
    let line = |line: &str| {
        let kept = line.split_once(" with an equilibrium, ").map_or(line, |(rows, _)| rows);
        kept.split_whitespace().map(word).collect::<Vec<_>>().join(" ")
    };
    let effort = ["work ", "tip error ", "steps  ", "error  "];
    let took = |line: &&str| !effort.iter().any(|begin| line.starts_with(begin));
    text.lines().filter(took).map(line).collect()
}

#[test]
fn the_guide_shows_what_the_program_does() {
    let mut commands = 0;
    for chapter in chapters() {
        let text = fs::read_to_string(&chapter).unwrap();
        let place = directory();
        let now = played(&text, place.path());
        commands += now.matches("\n$ hydrostat").count();
        assert_eq!(steady(&text).len(), steady(&now).len(), "{}; {REFRESH}", chapter.display());
        for (said, shown) in steady(&text).iter().zip(steady(&now)) {
            assert_eq!(said, &shown, "{}; {REFRESH}", chapter.display());
        }
        for picture in pictures(&text) {
            let drawn = fs::read_to_string(place.path().join(picture)).unwrap_or_else(|e| panic!("{picture}: {e}"));
            let kept = fs::read_to_string(pages().join("pictures").join(picture)).unwrap();
            assert_eq!(labels(&drawn), labels(&kept), "{picture}; {REFRESH}");
        }
    }
    assert!(commands >= 10, "{commands}");
}

const REFRESH: &str =
    "to write outputs and pictures anew: cargo test --profile ci -p hydrostat-cli --test program -- --ignored guide";

#[test]
#[ignore = "writes the guide's outputs and pictures anew"]
fn write_the_guide_anew() {
    for chapter in chapters() {
        let text = fs::read_to_string(&chapter).unwrap();
        let place = directory();
        fs::write(&chapter, played(&text, place.path())).unwrap();
        for picture in pictures(&text) {
            fs::copy(place.path().join(picture), pages().join("pictures").join(picture)).unwrap();
        }
    }
}

/// What a heading of a page is linked by.
fn anchor_of(line: &str) -> Option<String> {
    let heading = line.strip_prefix('#')?.trim_start_matches('#').trim().to_lowercase();
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    Some(kept.map(|c| if c == ' ' { '-' } else { c }).collect())
}

#[test]
fn every_chapter_is_listed_and_every_link_leads_somewhere() {
    let summary = fs::read_to_string(pages().join("SUMMARY.md")).unwrap();
    for chapter in chapters() {
        let name = chapter.file_name().unwrap().to_str().unwrap();
        assert!(name == "SUMMARY.md" || summary.contains(&format!("({name})")), "{name} is not in SUMMARY.md");
        let text = fs::read_to_string(&chapter).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let (page, anchor) = link.split_once('#').unwrap_or((link, ""));
            let page = if page.is_empty() { name } else { page };
            assert!(link.starts_with("http") || pages().join(page).exists(), "{name}: {link}");
            if !link.starts_with("http") && !anchor.is_empty() {
                let text = fs::read_to_string(pages().join(page)).unwrap();
                assert!(text.lines().filter_map(anchor_of).any(|own| own == anchor), "{name}: {link}");
            }
        }
    }
}
