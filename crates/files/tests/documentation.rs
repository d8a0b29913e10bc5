//! `docs/interface.md` says what the parser, the schema and the results do.

use std::collections::{BTreeMap, BTreeSet};

use hydrostat::VerdictKind::{CableFold, LimitPoint, LoadJump, NoSectionSolution, NotFound, SectionCrushed};
use hydrostat::parameter::names;
use hydrostat::{
    Arm, Boundary, BoundaryOptions, Cable, Event, Follower, Loading, LoadingStep, PathEnd, PathOptions, Phase, Reach,
    ReachOptions, Stations, Target,
};
use hydrostat_files::{
    ArmFile, BoundaryDocument, Dimension, EquilibriaDocument, FollowedDocument, LoadRows, LoadingRow,
    MOTION_EVENT_HEADS, MOTION_SHAPE_HEADS, OverDocument, PathDocument, ReachDocument, Varied, boundary_csv,
    followed_csv, loading_csv, mode_shapes_csv, modes_over_csv, motion_columns, over_csv, path_csv, reach_csv, schema,
    spatial_motion_heads, stations_csv,
};
use serde_json::Value;

const PAGE: &str = include_str!("../../../docs/interface.md");

/// The blocks of the page in a language.
fn blocks(language: &str) -> Vec<&'static str> {
    let fence = format!("```{language}\n");
    PAGE.split(fence.as_str()).skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

/// The part of the page below a heading of the third level.
fn part(heading: &str) -> &'static str {
    let start = format!("### {heading}\n");
    let rest = PAGE.split_once(&start).unwrap_or_else(|| panic!("no heading {heading}")).1;
    rest.split("\n#").next().unwrap()
}

/// The rows of a part's tables by their key, without it.
fn rows(part: &'static str) -> BTreeMap<&'static str, Vec<&'static str>> {
    let rows = part.lines().filter_map(|line| line.strip_prefix("| `")?.split_once("` | "));
    rows.map(|(key, cells)| (key, cells.trim_end_matches('|').split(" | ").map(str::trim).collect())).collect()
}

/// Numbers are equal whether they are written as integers or not.
fn plain(value: &Value) -> Value {
    match value {
        Value::Number(number) => Value::from(number.as_f64().unwrap()),
        Value::Array(values) => values.iter().map(plain).collect(),
        Value::Object(fields) => fields.iter().map(|(key, value)| (key.clone(), plain(value))).collect(),
        other => other.clone(),
    }
}

#[test]
fn its_arm_files_are_read() {
    let files = blocks("toml");
    assert_eq!(files.len(), 3);
    for text in files {
        ArmFile::parse(text, "interface.md").unwrap().arm().unwrap_or_else(|e| panic!("{e}\n{text}"));
    }
}

/// Every key of the schema has a row, no row has another, and defaults are those of the schema.
#[test]
fn its_tables_are_the_schema() {
    let schema = schema::arm_schema();
    let tables = schema["properties"].as_object().unwrap();
    let documented = rows(part("The file"));
    assert!(documented.keys().copied().eq(tables.keys().map(String::as_str).collect::<BTreeSet<_>>()));
    let mut defaults = 0;
    for (table, properties) in tables {
        let (heading, keys) = match &properties["items"]["properties"] {
            Value::Object(keys) => (format!("`[[{table}]]`"), keys),
            _ => match &properties["properties"] {
                Value::Object(keys) => (format!("`[{table}]`"), keys),
                _ => continue,
            },
        };
        let mut documented = rows(part(&heading));
        for (key, property) in keys {
            let cells = documented.remove(key.as_str()).unwrap_or_else(|| panic!("{heading}: no row for {key}"));
            for word in property["enum"].as_array().into_iter().flatten().filter_map(Value::as_str) {
                assert!(cells[0].contains(&format!("`\"{word}\"`")), "{heading} {key}: {word} in `{}`", cells[0]);
            }
            if let Some(default) = property.get("default") {
                let text = format!("x = {}", cells[1].trim_matches('`'));
                let written: Value = toml::from_str(&text).unwrap_or_else(|e| panic!("{heading} {key}: {e}"));
                assert_eq!(plain(&written["x"]), plain(default), "{heading} {key}");
                defaults += 1;
            }
        }
        assert!(documented.is_empty(), "{heading}: {documented:?}");
    }
    assert_eq!(defaults, 31);
}

/// The two files have every key.
#[test]
fn its_largest_file_has_every_key() {
    let files = blocks("toml");
    let read = |text: &str| toml::from_str::<Value>(text).unwrap();
    let (largest, other) = (read(files[1]), read(files[2]));
    for (table, properties) in schema::arm_schema()["properties"].as_object().unwrap() {
        assert!(largest.get(table).is_some(), "{table}");
        let keys = properties["properties"].as_object().or(properties["items"]["properties"].as_object());
        for key in keys.into_iter().flatten().map(|(key, _)| key) {
            let has = |file: &Value| {
                let items = file[table].as_array().into_iter().flatten();
                items.chain([&file[table]]).any(|table| table.get(key).is_some())
            };
            assert!(has(&largest) || has(&other), "{table}.{key}");
        }
    }
}

#[test]
fn its_units_are_those_of_the_parser() {
    for dimension in Dimension::ALL.into_iter().filter(|d| *d != Dimension::Number) {
        let name = dimension.name().trim_start_matches("an ").trim_start_matches("a ");
        let start = format!("| {name} | ");
        let row = PAGE.lines().find(|line| line.starts_with(&start)).unwrap_or_else(|| panic!("no row for {name}"));
        for unit in row.split('`').skip(1).step_by(2) {
            assert!(dimension.parse(&format!("1 {unit}")).is_ok(), "{name}: {unit}");
        }
        let expected = dimension.expected();
        let units = expected.rsplit("with one of ").next().unwrap().trim_end_matches(')').split(", ");
        for unit in units {
            assert!(row.contains(&format!("| {unit} |")) || row.contains(&format!("`{unit}`")), "{name}: {unit}");
        }
    }
}

fn pulled() -> (Arm, Varied) {
    let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", 0.001));
    (arm, "flow.speed=0:0.01".parse().unwrap())
}

fn path_header() -> String {
    let (arm, varied) = pulled();
    let path = arm.path(varied.parameter, varied.range, &PathOptions::default()).unwrap();
    path_csv(&path, &varied).lines().next().unwrap().to_owned() + "\n"
}

fn reach_header() -> String {
    reach_csv(1, &Reach { solutions: Vec::new(), closest: None })
}

fn over_header() -> String {
    over_csv(1, &pulled().1, &[])
}

/// Every key of the documents of paths and searches stands in a table.
#[test]
fn its_keys_are_those_of_the_documents() {
    let (arm, varied) = pulled();
    let path = arm.path(varied.parameter, varied.range, &PathOptions::default()).unwrap();
    let all = arm.equilibria(1e-6).unwrap();
    let searches = [(0.0, Ok((&all).into())), (0.01, Err("none".to_owned()))];
    let far = Target::tip(0.3, 0.0);
    let middle = Target { s: Some(0.1), ..far };
    let found = arm.reach(&[middle], &ReachOptions { max_tension: Some(0.1), ..ReachOptions::default() }).unwrap();
    let mut follower = Follower::new(&arm, &[far], &ReachOptions::default()).unwrap();
    let rows = [(far, follower.follow(&[far]).unwrap())];
    let options = BoundaryOptions { max_tension: Some(0.1), spacing: 0.1, ..BoundaryOptions::default() };
    let boundary = arm.reachable(&options).unwrap();
    let documents = [
        serde_json::to_value(PathDocument::new(&path, &varied).unwrap()).unwrap(),
        serde_json::to_value(EquilibriaDocument::new(&arm, &all)).unwrap(),
        serde_json::to_value(OverDocument::new(&arm, &varied, &searches)).unwrap(),
        serde_json::to_value(ReachDocument::new(&arm, &found)).unwrap(),
        serde_json::to_value(FollowedDocument::new(&arm, &rows)).unwrap(),
        serde_json::to_value(BoundaryDocument::new(&arm, &boundary)).unwrap(),
    ];
    let here = PAGE.split_once("## `--format json`").unwrap().1;
    let mut inner = vec![&documents[0]["branches"][0], &documents[0]["branches"][0]["points"][0]];
    inner.extend([&documents[1]["equilibria"][0]["stability"], &documents[2]["values"][0]]);
    let closest = &documents[3]["closest"];
    inner.extend([closest, &closest["bounds"][0], &closest["places"][0]]);
    inner.extend([&documents[4]["points"][0], &documents[4]["points"][0]["target"]]);
    inner.extend([&documents[5]["pieces"][0], &documents[5]["pieces"][0]["points"][0]]);
    for document in documents.iter().chain(inner) {
        for key in document.as_object().unwrap().keys() {
            assert!(here.contains(&format!("`{key}`")), "{key}");
        }
    }
    assert_eq!(documents[2]["values"][1], serde_json::json!({ "value": 0.01, "message": "none" }));
}

fn loading_header(arm: &Arm) -> String {
    let (_, first) = Loading::start(arm, 1e-8).unwrap();
    let step = LoadingStep { configuration: first.configuration, snaps: Vec::new() };
    let loads = LoadRows::new(&["arm.base.angle".to_owned()], vec![vec![0.0]]);
    let csv = loading_csv(&loads, &[LoadingRow::new(None, vec![0.0], step)]);
    csv.lines().next().unwrap().to_owned() + "\n"
}

#[test]
fn its_names_are_those_of_the_results() {
    let header = stations_csv(&Stations::default());
    let reached = [reach_header(), followed_csv(1, &[]), boundary_csv(1, &Boundary { pieces: Vec::new() })];
    let motion = motion_columns(1).join(",") + "\n";
    let (arm, _) = pulled();
    let beside = format!("{MOTION_SHAPE_HEADS}\n{MOTION_EVENT_HEADS}\n");
    assert_eq!(blocks("csv")[..4], [header, path_header(), motion, beside]);
    let motion = spatial_motion_heads(1, 0, false).join(",") + "\n";
    assert!(blocks("csv")[4].starts_with(&motion), "{}", blocks("csv")[4]);
    assert_eq!(blocks("csv")[5..7], [loading_header(&arm), over_header()]);
    let varied: Varied = "flow.speed=0:1".parse().unwrap();
    assert_eq!(blocks("csv")[7], modes_over_csv::<[f64; 3]>(&varied, &[]));
    let head = |text: String| text.lines().next().unwrap().to_owned() + "\n";
    let shapes = [mode_shapes_csv(&arm.modes(1, 4).unwrap()), mode_shapes_csv(&arm.modes_in_space(1, 4).unwrap())];
    assert_eq!(blocks("csv")[8], shapes.map(head).concat());
    assert_eq!(blocks("csv")[9..], reached);
    let middle = Target { s: Some(0.1), ..Target::tip(0.09, 0.0) };
    let columns = reach_csv(1, &arm.reach(&[middle], &ReachOptions::default()).unwrap());
    for name in columns.lines().next().unwrap().split(',').filter(|name| name.starts_with("place")) {
        assert!(PAGE.contains(&format!("`{name}`")), "{name}");
    }
    for name in names() {
        assert!(PAGE.contains(&format!("`{name}`")), "{name}");
    }
    for event in [Event::LimitPoint, Event::Bifurcation, Event::Slack(0), Event::Taut(0)] {
        assert!(PAGE.contains(&format!("`\"{}\"`", event.name())), "{}", event.name());
    }
    for end in [PathEnd::ReachedEnd, PathEnd::ReachedStart, PathEnd::MostPoints, PathEnd::Stopped] {
        assert!(PAGE.contains(&format!("`{}`", end.name())), "{}", end.name());
    }
    for kind in [CableFold, SectionCrushed, NoSectionSolution, LimitPoint, LoadJump, NotFound] {
        assert!(PAGE.contains(&format!("\n| `{}` | ", kind.name())), "{}", kind.name());
    }
    for phase in [Phase::Loads, Phase::Tension, Phase::Stroke, Phase::Friction] {
        assert!(PAGE.contains(&format!("`{}`: ", phase.name())), "{}", phase.name());
    }
}
