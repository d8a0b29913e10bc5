//! Results as text, JSON and CSV, and where they go.

use super::{columns, directory, hydrostat_in, json, picture, solved};

/// Columns and rows of a CSV of numbers.
fn csv(text: &str) -> (Vec<&str>, Vec<Vec<f64>>) {
    let (names, rows) = columns(text);
    (names, rows.iter().map(|row| row.iter().map(|cell| cell.parse().unwrap()).collect()).collect())
}

#[test]
fn text_says_what_matters() {
    let run = solved(&["solve", "paper"]);
    for word in ["tip", "alpha(L) 56.40", "left", "tension 40 N", "base reaction", "fold margin", "tip error", "work"] {
        assert!(run.out.contains(word), "{word}:\n{}", run.out);
    }
    // Its tip is compressed far beyond a linear law: a warning, which is no result.
    assert!(run.err.contains("warning: the stretch nu"), "{}", run.err);
    assert!(!run.out.contains("warning"));
}

#[test]
fn json_is_one_document_with_everything() {
    let run = solved(&["solve", "paper", "--format", "json"]);
    let document = json(&run.out);
    assert_eq!(document["schema"], 1);
    assert_eq!(document["converged"], true);
    assert_eq!(document["warnings"][0]["kind"], "strain_range");
    let alpha = document["tip"]["alpha"].as_f64().unwrap().to_degrees();
    assert!((alpha - 56.4004).abs() < 1e-3, "{alpha}");
    assert_eq!(document["cables"].as_array().unwrap().len(), 2);
    assert_eq!(document["inputs"]["flow"]["speed"], 0.5);
    let count = document["stations"]["s"].as_array().unwrap().len();
    for name in ["x", "y", "theta", "nu", "eta", "mu", "beta", "alpha", "n_a", "n_b", "m"] {
        assert_eq!(document["stations"][name].as_array().unwrap().len(), count, "{name}");
    }
}

/// Two cables squeeze the tip of this arm, which keeps it from being known to a part in 1e12.
#[test]
fn a_tolerance_that_was_missed_is_a_warning_everywhere() {
    let run = solved(&["solve", "paper", "--tension", "86,40", "--tol", "1e-12", "--format", "json"]);
    let document = json(&run.out);
    let asked = 1e-12 * document["inputs"]["arm"]["length"].as_f64().unwrap();
    assert!(document["error_estimate"].as_f64().unwrap() > asked, "met by now: ask this of another arm");
    let warnings = document["warnings"].as_array().unwrap();
    let missed = warnings.iter().find(|w| w["kind"] == "tolerance_missed").unwrap();
    assert!(run.err.contains(&format!("warning: {}\n", missed["message"].as_str().unwrap())), "{}", run.err);
    let met = json(&solved(&["solve", "paper", "--tension", "86,40", "--format", "json"]).out);
    assert!(met["warnings"].as_array().unwrap().iter().all(|w| w["kind"] != "tolerance_missed"));
}

#[test]
fn csv_has_a_row_a_station() {
    let run = solved(&["solve", "paper", "--format", "csv", "--stations", "5"]);
    let (names, rows) = csv(&run.out);
    assert_eq!(names[..3], ["s_m", "x_m", "y_m"]);
    let places: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let expected = [0.0, 0.05, 0.1, 0.15, 0.2];
    assert!(places.iter().zip(expected).all(|(s, e)| (s - e).abs() < 1e-15) && rows.len() == 5, "{places:?}");
}

#[test]
fn resampling_keeps_the_tip() {
    let nodes = json(&solved(&["solve", "paper", "--format", "json"]).out);
    let two = json(&solved(&["solve", "paper", "--format", "json", "--stations", "2"]).out);
    assert_eq!(nodes["tip"], two["tip"]);
    assert_eq!(two["stations"]["s"].as_array().unwrap().len(), 2);
}

#[test]
fn overrides_reach_the_arm() {
    let run = solved(&[
        "solve",
        "silicone",
        "--tension",
        "300 mN,0",
        "--flow-speed",
        "20 cm/s",
        "--set",
        "flow.law=quadratic-drag",
        "--set",
        "flow.direction=90 deg",
        "--set",
        "arm.length=\"24 cm\"",
        "--set",
        "cable[1].name=other",
        "--format",
        "json",
    ]);
    let document = json(&run.out);
    assert_eq!(document["cables"][0]["tension"], 0.3);
    assert_eq!(document["cables"][1]["name"], "other");
    assert_eq!(document["inputs"]["arm"]["length"], 0.24);
    assert_eq!(document["inputs"]["flow"]["speed"], 0.2);
    assert_eq!(document["inputs"]["flow"]["direction"], 90.0);
    assert_eq!(document["inputs"]["flow"]["law"], "quadratic-drag");
}

#[test]
fn tensions_may_replace_ones_that_are_refused() {
    let directory = directory();
    let text = solved(&["arms", "silicone"]).out.replacen("tension = 0", "tension = 99", 1);
    std::fs::write(directory.path().join("arm.toml"), text).unwrap();
    assert_eq!(hydrostat_in(directory.path(), &["solve", "arm.toml"]).code, 2);
    assert_eq!(hydrostat_in(directory.path(), &["solve", "arm.toml", "--tension", "0.1,0"]).code, 0);
}

#[test]
fn a_file_gets_what_standard_output_would() {
    let directory = directory();
    let args = ["solve", "paper", "--format", "csv", "-o", "arm.csv"];
    let run = hydrostat_in(directory.path(), &args);
    assert_eq!((run.code, run.out.as_str()), (0, ""));
    let written = std::fs::read_to_string(directory.path().join("arm.csv")).unwrap();
    assert_eq!(written, solved(&["solve", "paper", "--format", "csv"]).out);
}

#[test]
fn plots_are_svg_pdf_or_png() {
    let directory = directory();
    for name in ["arm.svg", "arm.pdf", "arm.PNG"] {
        let run = hydrostat_in(directory.path(), &["solve", "silicone", "--tension", "0.3,0", "--plot", name]);
        assert_eq!(run.code, 0, "{}", run.err);
        // The drawing does not replace the result.
        assert!(run.out.starts_with("arm "));
    }
    let svg = std::fs::read_to_string(directory.path().join("arm.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n") && svg.contains("left: 0.3 N"));
    let (width, height) = picture(&std::fs::read(directory.path().join("arm.PNG")).unwrap());
    assert!(width > 1000 && height > 400, "{width} x {height}");
    let pdf = std::fs::read(directory.path().join("arm.pdf")).unwrap();
    assert!(pdf.starts_with(b"%PDF-1.7") && pdf.ends_with(b"%%EOF"));
}

#[test]
fn a_picture_has_the_width_and_the_title_that_are_asked_for() {
    let directory = directory();
    let with = |more: &[&str]| hydrostat_in(directory.path(), &[&["solve", "paper"], more].concat());
    let run = with(&["--plot", "arm.svg", "--width", "90 mm", "--title", "In the stream", "--svg-text"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let svg = std::fs::read_to_string(directory.path().join("arm.svg")).unwrap();
    assert!(svg.contains("width=\"255.12pt\"") && svg.contains(">In the stream</text>") && !svg.contains("aria-label"));
    for wrong in ["90", "20 mm", "wide", "3 m"] {
        let run = with(&["--plot", "arm.svg", "--width", wrong]);
        assert!(run.code == 2 && run.err.contains("such as \"85 mm\""), "{wrong}: {}", run.err);
    }
    for (option, args) in
        [("--title", &["--title", "T"][..]), ("--width", &["--width", "9 cm"]), ("--svg-text", &["--svg-text"])]
    {
        let run = with(args);
        assert!(run.code == 2 && run.err.contains(&format!("{option}: nothing is drawn; give --plot")), "{}", run.err);
    }
}

#[test]
fn a_looser_tolerance_needs_less() {
    let evaluations = |tol| {
        let run = solved(&["solve", "paper", "--format", "json", "--tol", tol]);
        json(&run.out)["statistics"]["evaluations"].as_u64().unwrap()
    };
    assert!(evaluations("1e-3") < evaluations("1e-8"));
}
