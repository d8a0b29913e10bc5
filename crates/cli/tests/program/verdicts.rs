//! Arms without an equilibrium: status 3, the verdict, and the last good shape.

use serde_json::Value;

use super::{directory, files, hydrostat, hydrostat_in, picture};

/// Classical rods have no volume to keep: 40 N on a tip that carries 1 N crush it.
const CRUSHED: [&str; 4] = ["solve", "paper", "--set", "model.volume=none"];

fn crushed<'a>(more: &[&'a str]) -> Vec<&'a str> {
    CRUSHED.iter().chain(more).copied().collect()
}

#[test]
fn text_and_csv_have_nothing_to_say() {
    for format in ["text", "csv"] {
        let run = hydrostat(&crushed(&["--format", format]));
        assert_eq!((run.code, run.out.as_str()), (3, ""));
        assert!(run.err.starts_with("error: "), "{}", run.err);
        assert!(run.err.contains("\ntry: "), "{}", run.err);
        let words: Vec<&str> = run.err.split_whitespace().collect();
        let percent = words.windows(2).find(|pair| pair[1] == "%").and_then(|pair| pair[0].parse::<f64>().ok());
        assert!(percent.is_some_and(|p| p > 0.0 && p < 100.0), "no percentage in: {}", run.err);
        assert!(run.err.contains(" % of the requested tensions, other loads fully applied"), "{}", run.err);
    }
}

/// A cable that is wound in has no tension to lower.
#[test]
fn advice_for_a_stroke_was_that_for_a_tension() {
    let run = hydrostat(&["solve", "silicone", "--set", "cable[0].stroke=\"100 mm\""]);
    assert_eq!(run.code, 3, "{}", run.err);
    assert!(run.err.contains("\ntry: reel in less") && !run.err.contains("lower the tension"), "{}", run.err);
}

#[test]
fn json_holds_the_verdict_and_the_last_good_shape() {
    let run = hydrostat(&crushed(&["--format", "json", "--stations", "3"]));
    assert_eq!(run.code, 3);
    let document: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(document["converged"], false);
    let verdict = &document["verdict"];
    let fraction = verdict["load_fraction"].as_f64().unwrap();
    assert!(fraction > 0.0 && fraction < 1.0, "{fraction}");
    for key in ["kind", "phase", "message", "advice"] {
        assert!(!verdict[key].as_str().unwrap().is_empty(), "{key}");
    }
    assert!(run.err.contains(verdict["message"].as_str().unwrap()));
    let last_good = &document["last_good"];
    assert_eq!(last_good["stations"]["s"].as_array().unwrap().len(), 3);
    let tension = last_good["cables"][0]["tension"].as_f64().unwrap();
    assert!(tension > 0.0 && tension < 40.0, "{tension}");
}

#[test]
fn the_plot_shows_the_last_good_shape_and_says_so() {
    let directory = directory();
    let run = hydrostat_in(directory.path(), &crushed(&["--plot", "arm.svg"]));
    assert_eq!(run.code, 3);
    let svg = std::fs::read_to_string(directory.path().join("arm.svg")).unwrap();
    assert!(
        svg.contains("Last good shape, at ")
            && svg.contains(" % of the requested tensions, other loads fully applied (side compressed to zero length)"),
        "{}",
        &svg[..400]
    );
    hydrostat_in(directory.path(), &crushed(&["--plot", "arm.png"]));
    picture(&std::fs::read(directory.path().join("arm.png")).unwrap());
}

#[test]
fn an_output_file_gets_the_verdict_as_json_and_nothing_else() {
    let directory = directory();
    let here = directory.path();
    assert_eq!(hydrostat_in(here, &crushed(&["-o", "arm.txt"])).code, 3);
    assert!(files(here).is_empty());
    let run = hydrostat_in(here, &crushed(&["--format", "json", "-o", "arm.json"]));
    assert_eq!((run.code, run.out.as_str()), (3, ""));
    let text = std::fs::read_to_string(here.join("arm.json")).unwrap();
    assert_eq!(serde_json::from_str::<Value>(&text).unwrap()["converged"], false);
}
