//! Numbers that are written together, and the unit behind the last of them.

use super::{columns, directory, hydrostat_in, json, refused, solved};

/// `5:20 cm/s` went from 5 m/s to 20 cm/s, in silence.
#[test]
fn a_unit_behind_a_range_was_that_of_its_end_alone() {
    let directory = directory();
    let values = |args: &[&str]| -> Vec<f64> {
        let _ = std::fs::remove_file(directory.path().join("out.csv"));
        let _ = std::fs::remove_file(directory.path().join("out.csv.json"));
        let run = hydrostat_in(directory.path(), &[&["sweep", "silicone", "-o", "out.csv"], args].concat());
        assert!(matches!(run.code, 0 | 3), "{args:?}: {}", run.err);
        let text = std::fs::read_to_string(directory.path().join("out.csv")).unwrap();
        columns(&text).1.iter().map(|row| row[1].parse().unwrap()).collect()
    };
    assert_eq!(values(&["--vary", "flow.speed=5:20 cm/s:4"]), [0.05, 0.1, 0.15, 0.2]);
    assert_eq!(values(&["--vary", "material.young=50:100 kPa:3"]), [50e3, 75e3, 100e3]);
    assert_eq!(values(&["--vary", "flow.speed=5,20 cm/s"]), [0.05, 0.2]);
    assert_eq!(values(&["--vary", "flow.speed=50 mm/s:20 cm/s:2"]), [0.05, 0.2]);
    let drawn = values(&["--vary", "flow.speed=5:20 cm/s", "--sample", "lhs:4"]);
    assert!(drawn.iter().all(|speed| (0.05..=0.2).contains(speed)), "{drawn:?}");

    let path = solved(&["path", "silicone", "--vary", "flow.speed=5:20 cm/s", "--format", "json"]);
    assert_eq!(json(&path.out)["range"], serde_json::json!([0.05, 0.2]));
    let over = ["equilibria", "silicone", "--over", "flow.speed=5:6 cm/s:2", "--format", "json"];
    assert_eq!(json(&solved(&over).out)["range"], serde_json::json!([0.05, 0.06]));
    let tensions = solved(&["solve", "silicone", "--tension", "200,100 mN", "--format", "json"]);
    assert_eq!(json(&tensions.out)["inputs"]["cable"][1]["tension"], 0.1);
    assert_eq!(json(&tensions.out)["inputs"]["cable"][0]["tension"], 0.2);
    let ramp = |shape: &str| {
        let vary = format!("cable[0].tension={shape}");
        let motion = ["simulate", "silicone", "--until", "0.02", "--every", "0.01", "--format", "csv", "--vary", &vary];
        solved(&motion).out
    };
    assert_eq!(ramp("ramp:50:100 mN:0:20 ms"), ramp("ramp:0.05:0.1:0:0.02"));
    let figures = refused(&["figures", "paper", "--faster", "1,2 cm/s", "-o", "figures"]);
    assert!(figures.contains("0.01") && !figures.contains("invalid float"), "{figures}");
    let reached = solved(&["reach", "silicone", "--target", "182,78 mm", "--max-tension", "0.6 N", "--format", "json"]);
    assert_eq!(json(&reached.out)["reached"], true);
}

#[test]
fn a_unit_behind_the_first_number_alone_has_two_readings() {
    for (args, shared, each) in [
        (&["sweep", "paper", "-o", "out.csv", "--vary", "flow.speed=5 cm/s:20:4"][..], "5:20 cm/s", "5 cm/s:20 m/s"),
        (&["sweep", "paper", "-o", "out.csv", "--vary", "flow.speed=5 cm/s,20"], "5,20 cm/s", "5 cm/s,20 m/s"),
        (&["path", "paper", "--vary", "flow.speed=5 cm/s:20"], "5:20 cm/s", "5 cm/s:20 m/s"),
        (&["equilibria", "paper", "--over", "flow.speed=5 cm/s:20:4"], "5:20 cm/s", "5 cm/s:20 m/s"),
        (&["solve", "paper", "--tension", "20 mN,10"], "20,10 mN", "20 mN,10 N"),
        (&["reach", "paper", "--target", "150 mm,-100"], "150,-100 mm", "150 mm,-100 m"),
        (&["figures", "--faster", "100 cm/s,2"], "100,2 cm/s", "100 cm/s,2 m/s"),
        (
            &["simulate", "silicone", "--until", "1", "--vary", "flow.speed=ramp:5 cm/s:20:0:1"],
            "5:20 cm/s",
            "5 cm/s:20 m/s",
        ),
    ] {
        let message = refused(args);
        assert!(message.contains(&format!("\"{shared}\"")) && message.contains(&format!("\"{each}\"")), "{message}");
    }
    // Zero is zero in every unit.
    solved(&["solve", "silicone", "--tension", "200 mN,0"]);
}
