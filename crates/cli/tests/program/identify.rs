//! `hydrostat identify`.

use std::fmt::Write as _;
use std::path::Path;

use super::{columns, directory, files, hydrostat, hydrostat_in, json, picture, refused};

const CASES: [(&str, [f64; 2], f64); 3] =
    [("pulled", [0.25, 0.0], 0.0), ("stream", [0.0, 0.05], 0.12), ("both", [0.1, 0.0], 0.2)];
const DRAG: [&str; 4] = ["--set", "flow.law=quadratic-drag", "--set", "flow.direction=70"];

/// Shapes of `silicone` as the program solves them, with errors of 0.5 mm to and fro.
fn measure(here: &Path) {
    let mut text = "case,cable[0].tension [N],cable[1].tension [N],flow.speed [m/s],s [mm],x [mm],y [mm]\n".to_owned();
    let mut sign = 0.5;
    for (name, tensions, speed) in CASES {
        let tension = format!("{},{}", tensions[0], tensions[1]);
        let speed = speed.to_string();
        let mut args = vec!["solve", "silicone", "--tension", &tension, "--flow-speed", &speed, "--stations", "6"];
        args.extend(DRAG);
        args.extend(["--format", "json"]);
        let run = hydrostat(&args);
        assert_eq!(run.code, 0, "{}", run.err);
        let document = json(&run.out);
        for k in 1..6 {
            let at = |field: &str| 1e3 * document["stations"][field][k].as_f64().unwrap();
            let loads = if k == 1 { format!("{tension},{speed}") } else { ",,".to_owned() };
            let (x, y) = (at("x") + sign, at("y") - sign);
            writeln!(text, "{name},{loads},{:.4},{x:.4},{y:.4}", at("s")).unwrap();
            sign = -sign;
        }
    }
    std::fs::write(here.join("data.csv"), text).unwrap();
}

fn identify<'a>(fit: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut args = vec!["identify", "silicone", "data.csv", "--fit", fit, "--sd", "0.5 mm"];
    args.extend(DRAG);
    args.extend(more);
    args
}

#[test]
fn parameters_are_found_written_and_drawn() {
    let here = directory();
    measure(here.path());
    let more = ["--json", "--out", "fitted.toml", "--plot", "fit.png"];
    let run = hydrostat_in(here.path(), &identify("young=80 kPa,flow.cn=1", &more));
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(files(here.path()), ["data.csv", "fit.png", "fitted.toml"]);
    picture(&std::fs::read(here.path().join("fit.png")).unwrap());
    let document = json(&run.out);
    assert_eq!(document["converged"], true);
    for (one, (key, truth)) in
        document["parameters"].as_array().unwrap().iter().zip([("material.young", 110e3), ("flow.cn", 2.5)])
    {
        assert_eq!(one["key"], key);
        let [from, to] = [0, 1].map(|k| one["interval"][k].as_f64().unwrap());
        assert!(from < truth && truth < to && to - from < 0.2 * truth, "{one}");
    }
    assert_eq!(document["verdict"][0], "the data determine all parameters");
    assert_eq!(document["residuals"].as_array().unwrap().len(), 30);
    assert_eq!(document["residuals"][0]["row"], 2);
    assert_eq!(document["cross_validation"].as_array().unwrap().len(), 3);
    // The arm that was written is the one found.
    let again = hydrostat_in(here.path(), &["solve", "fitted.toml", "--format", "json"]);
    assert_eq!(again.code, 0, "{}", again.err);
    let young = json(&again.out)["inputs"]["material"]["young"].as_f64().unwrap();
    assert_eq!(young, document["parameters"][0]["estimate"].as_f64().unwrap());

    let run = hydrostat_in(here.path(), &identify("young", &["--format", "csv"]));
    let (names, rows) = columns(&run.out);
    assert_eq!((names[0], names[7], rows.len()), ("case", "residual_sd", 30));
    let predicted = hydrostat_in(here.path(), &identify("young", &["--format", "csv", "--predict", "data.csv"]));
    let (names, rows) = columns(&predicted.out);
    assert_eq!((names[10], rows.len()), ("predicted", 60), "{}", predicted.err);
    assert!(rows[..30].iter().all(|row| row[10] == "false") && rows[30..].iter().all(|row| row[10] == "true"));
    for (own, other) in rows[..30].iter().zip(&rows[30..]) {
        assert_eq!(own[..6], other[..6], "the same numbers");
    }
    let report = hydrostat_in(here.path(), &identify("young,cn", &[]));
    for part in ["material.young (Pa)", "verdict: the data determine", "correlation", "singular value", "predicted"] {
        assert!(report.out.contains(part), "{part}: {}", report.out);
    }
}

#[test]
fn what_cannot_be_told_apart_is_said_in_words() {
    let here = directory();
    measure(here.path());
    // So wide a prior keeps the search from going on along what the data do not know.
    let wide = ["--prior", "flow.density=1022±400", "--no-cross-validation"];
    let run = hydrostat_in(here.path(), &identify("young,cn,flow.density", &wide));
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("verdict: the data do not separate"), "{}", run.out);
    assert!(run.out.contains("flow.density") && run.out.contains("Fix one of them, add a prior"), "{}", run.out);
    let prior = ["--prior", "flow.density=1022±5", "--loss", "huber", "--rescale"];
    let run = hydrostat_in(here.path(), &identify("young,cn,flow.density", &prior));
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("prior 1022 ± 5"), "{}", run.out);
}

#[test]
fn a_template_can_be_filled_in() {
    let here = directory();
    let run = hydrostat_in(here.path(), &["identify", "silicone", "--template", "-o", "data.csv"]);
    assert_eq!((run.code, run.out.as_str()), (0, ""), "{}", run.err);
    let run = hydrostat_in(here.path(), &["identify", "silicone", "data.csv", "--fit", "young"]);
    let words = "error: data.csv: there is no measured value; fill in x and y, or another measured quantity\n";
    assert_eq!((run.code, run.err.as_str()), (2, words));
    let template = std::fs::read_to_string(here.path().join("data.csv")).unwrap();
    let filled = template.replacen("a,0,0,0,61.25,,,,", "a,0.1,0,0,61.25,61,2,,", 1);
    assert_ne!(filled, template);
    std::fs::write(here.path().join("data.csv"), filled).unwrap();
    let run = hydrostat_in(here.path(), &["identify", "silicone", "data.csv", "--fit", "young"]);
    assert_eq!(run.code, 0, "{}", run.err);
}

#[test]
fn wrong_data_and_requests_are_refused() {
    let here = directory();
    measure(here.path());
    let refused_in = |args: &[&str]| {
        let run = hydrostat_in(here.path(), args);
        assert_eq!((run.code, run.out.as_str()), (2, ""), "{args:?}: {}", run.err);
        run.err
    };
    let bare = ["identify", "silicone", "data.csv", "--fit", "young"];
    assert!(refused_in(&bare).contains("data.csv, row 2, column \"x [mm]\": has no standard deviation"));
    assert!(refused_in(&identify("arm.length", &[])).contains("cannot be fitted"));
    assert!(refused_in(&identify("flow.speed", &[])).contains("column \"flow.speed [m/s]\": is fitted"));
    assert!(refused_in(&identify("c1", &[])).contains("the arm gives a homogeneous material"));
    assert!(refused_in(&identify("young", &["--prior", "cn=2±1"])).contains("add it to --fit"));
    assert!(refused_in(&identify("young,material.young", &[])).contains("given twice"));
    assert!(refused_in(&identify("young=3:1:2", &[])).contains("a start within the bounds"));
    assert!(refused_in(&["identify", "silicone", "none.csv", "--fit", "young"]).contains("none.csv: cannot be read"));
    assert!(refused(&["identify", "silicone"]).contains("--fit"));
    std::fs::write(here.path().join("data.csv"), "s [mm],x [mm]\n1,2,3\n").unwrap();
    assert!(refused_in(&identify("young", &[])).contains("data.csv, row 2: expected 2 cells"));
}

#[test]
fn a_start_without_equilibrium_ends_with_status_3() {
    let here = directory();
    measure(here.path());
    let run = hydrostat_in(here.path(), &identify("young=10 kPa", &[]));
    assert_eq!((run.code, run.out.as_str()), (3, ""), "{}", run.err);
    assert!(
        run.err.contains("case pulled has no equilibrium at the start values: a cable compresses its side"),
        "{}",
        run.err
    );
}

/// The words of a command, with those in quotes as one.
fn words(command: &str) -> Vec<&str> {
    let parts = command.split('"').enumerate();
    parts.flat_map(|(k, part)| if k % 2 == 1 { vec![part] } else { part.split_whitespace().collect() }).collect()
}

#[test]
fn the_example_of_the_documentation_prints_what_stands_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = std::fs::read_to_string(root.join("docs/identification.md")).unwrap();
    let section = |head: &str| page.split_once(head).unwrap().1.split_once("\n## ").unwrap().0;
    let mut compared = 0;
    for (head, blocks_a_command) in [("## An example", 1), ("## A built arm in space", 2)] {
        let example = section(head);
        let commands = example.lines().filter_map(|line| line.strip_prefix("    hydrostat "));
        let mut blocks = example.split("```text\n").skip(1).map(|rest| rest.split_once("```").unwrap().0);
        for command in commands {
            let run = hydrostat_in(&root, &words(command));
            assert_eq!(run.code, 0, "{command}: {}", run.err);
            for block in blocks.by_ref().take(blocks_a_command) {
                assert!(run.out.contains(block), "{command}:\n{}\nfor\n{block}", run.out);
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 4);
}
