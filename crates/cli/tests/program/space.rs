//! Arms in space.

use super::{columns, directory, hydrostat, hydrostat_in, json, refused, solved};

#[test]
fn an_arm_in_space_is_solved_in_every_format() {
    let document = json(&solved(&["solve", "silicone-spatial", "--set", "flow.speed=0.05", "--format", "json"]).out);
    assert_eq!((&document["converged"], &document["stable"]), (&true.into(), &true.into()));
    let tip = &document["tip"];
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    assert!(number(&tip["y"]) > 0.0 && number(&tip["z"]) > 0.0, "towards the two cables that pull: {tip}");
    let [a, b, c] = ["a", "b", "c"].map(|name| [0, 1, 2].map(|k| number(&tip[name][k])));
    let cross: [f64; 3] = std::array::from_fn(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
    assert!((0..3).all(|k| (cross[k] - c[k]).abs() < 1e-12));
    assert_eq!(document["base"]["force"].as_array().unwrap().len(), 3);
    assert_eq!(document["inputs"]["arm"]["space"], "spatial");

    let table = solved(&["solve", "silicone-spatial", "--format", "csv", "--stations", "5"]).out;
    let (names, rows) = columns(&table);
    let expected = "s_m x_m y_m z_m a_x a_y a_z b_x b_y b_z c_x c_y c_z nu eta zeta tau_per_m kappa_per_m mu_per_m beta alpha_rad n_a_N \
                    n_b_N n_c_N m_a_Nm m_b_Nm m_c_Nm";
    assert_eq!(names, expected.split_whitespace().collect::<Vec<_>>());
    assert_eq!(rows.len(), 5);

    let text = solved(&["solve", "octopus-spatial"]).out;
    assert!(text.contains("in space") && text.contains(", stable"), "{text}");
}

#[test]
fn an_arm_in_space_is_drawn_in_every_form() {
    let directory = directory();
    for (file, head) in [("arm.svg", &b"<svg"[..]), ("arm.pdf", b"%PDF"), ("arm.png", b"\x89PNG")] {
        let args = ["solve", "octopus-spatial", "--plot", file, "--width", "85 mm", "--title", "four cables"];
        let run = hydrostat_in(directory.path(), &args);
        assert_eq!(run.code, 0, "{}", run.err);
        assert!(std::fs::read(directory.path().join(file)).unwrap().starts_with(head), "{file}");
    }
}

#[test]
fn shapes_along_a_path_in_space_are_drawn_in_three_views() {
    let directory = directory();
    let vary = ["path", "silicone-spatial", "--vary", "cable[2].tension=0:300 mN"];
    let run = hydrostat_in(directory.path(), &[&vary[..], &["--plot-shapes", "shapes.svg", "--svg-text"]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let svg = std::fs::read_to_string(directory.path().join("shapes.svg")).unwrap();
    assert!(svg.contains("300 mN") && svg.matches("(mm)").count() >= 3);
}

#[test]
fn tips_of_a_sweep_in_space_are_drawn_from_three_sides() {
    let directory = directory();
    // As many keys as cables: more than a map has axes.
    let keys = [0, 1, 2].map(|cable| format!("cable[{cable}].tension=0:0.2:3"));
    let tensions: Vec<&str> = keys.iter().flat_map(|key| ["--vary", key]).collect();
    let swept =
        hydrostat_in(directory.path(), &[&["sweep", "silicone-spatial", "-o", "rows.csv"], &tensions[..]].concat());
    assert_eq!(swept.code, 0, "{}", swept.err);
    let drawn = hydrostat_in(directory.path(), &["plot", "rows.csv", "--workspace", "tips.svg", "--svg-text"]);
    assert_eq!(drawn.code, 0, "{}", drawn.err);
    let svg = std::fs::read_to_string(directory.path().join("tips.svg")).unwrap();
    assert!(svg.matches("(mm)").count() >= 3);
}

/// With the word for space alone, an arm has the shape that it has in the plane.
#[test]
fn a_planar_file_in_space_gives_the_planar_answer() {
    let args = ["solve", "silicone", "--set", "cable[0].tension=0.3", "--set", "flow.speed=0.1", "--format", "json"];
    let plane = json(&solved(&args).out);
    let space = json(&solved(&[&args[..], &["--set", "arm.space=spatial"]].concat()).out);
    for key in ["x", "y"] {
        let [a, b] = [&plane, &space].map(|document| document["tip"][key].as_f64().unwrap());
        assert!((a - b).abs() < 1e-9, "{key}: {a} {b}");
    }
}

#[test]
fn a_fold_in_space_is_a_verdict_with_the_last_good_shape() {
    let directory = directory();
    let args = ["solve", "silicone-spatial", "--set", "cable[0].tension=1.4", "--format", "json"];
    let run = hydrostat_in(directory.path(), &args);
    assert_eq!(run.code, 3, "{}", run.err);
    let document = json(&run.out);
    assert_eq!(document["verdict"]["kind"], "cable_fold");
    assert!(document["last_good"]["tip"]["z"].is_number());
    let drawn = hydrostat_in(directory.path(), &[&args[..4], &["--plot", "last.svg", "--svg-text"]].concat());
    let svg = std::fs::read_to_string(directory.path().join("last.svg")).unwrap();
    assert!(drawn.code == 3 && svg.contains("Last good shape, at"), "{}", drawn.err);
    assert!(run.err.contains("try: "), "{}", run.err);
}

#[test]
fn what_is_for_arms_in_the_plane_says_so() {
    let words = refused(&["figures", "silicone-spatial"]);
    assert!(words.starts_with("error: `hydrostat figures` is for arms in the plane"), "{words}");
    assert!(words.contains("spatial"), "{words}");
    for (args, words) in [
        (&["reach", "silicone-spatial", "--target", "200 mm,50 mm"][..], "expected X,Y,Z"),
        (&["workspace", "silicone-spatial"], "it is for arms in the plane"),
        (&["reach", "silicone", "--target", "0.2,0.05,0"], "expected X,Y of an arm in the plane"),
        (&["reach", "silicone-spatial", "--target", "0.2,0.05,0", "--angle", "10"], "--direction"),
        (&["reach", "silicone", "--target", "0.2,0.05", "--direction", "1,0,0"], "space = \"spatial\""),
        (&["reach", "silicone-spatial", "--target", "0.2,0.05,0", "--direction", "0,0,0"], "not all 0"),
        (&["path", "silicone-spatial", "--vary", "flow.speed=0:0.1", "--quantity", "tip.theta"], "tip.z"),
        (&["path", "silicone", "--vary", "flow.speed=0:0.1", "--quantity", "tip.z"], "tip.theta"),
        (&["path", "silicone", "--vary", "flow.direction[2]=0:1"], "is of an arm in space"),
        (&["path", "silicone-spatial", "--vary", "material.c4=1:2"], "homogeneous"),
    ] {
        let said = refused(args);
        assert!(said.contains(words), "{args:?}: {said}");
    }
    let words = refused(&["solve", "silicone", "--set", "tip.force=[0, 0, 1]"]);
    assert!(words.contains("tip.force") && words.contains("space = \"spatial\""), "{words}");
    let words = refused(&["solve", "silicone-spatial", "--set", "cable[0].friction=0.1"]);
    assert!(words.contains("cable[0].friction"), "{words}");
    assert!(solved(&["check", "silicone-spatial"]).out.contains("space = \"spatial\""));
    let unknown = refused(&["solve", "silicon-spatial"]);
    assert!(
        unknown.contains("octopus-spatial, silicone-spatial, tentacle); did you mean `silicone-spatial`?"),
        "{unknown}"
    );
    let far = hydrostat(&["solve", "silicone-spatial", "--set", "arm.length=300"]);
    assert!(far.err.ends_with("try: look at the units first: arm.length = 300 m: is it mm?\n"), "{}", far.err);
}

#[test]
fn a_path_in_space_has_every_format() {
    let directory = directory();
    let path = ["path", "silicone-spatial", "--vary", "flow.direction[2]=-1:1", "--set", "flow.speed=0.05"];
    let text = solved(&path).out;
    assert!(text.contains("z (mm)") && text.contains("stable throughout"), "{text}");
    let document = json(&solved(&[&path[..], &["--format", "json"]].concat()).out);
    let points = document["branches"][0]["points"].as_array().unwrap();
    assert!(points.len() > 3 && points[0]["tip"]["z"].is_number() && points[0]["tip"]["a"][2].is_number());
    assert_eq!(points[0]["value"], -1.0);
    let (names, rows) = columns_of(&solved(&[&path[..], &["--format", "csv"]].concat()).out);
    assert_eq!(rows, points.len());
    for name in ["branch", "tip_z_m", "tip_a_x", "tip_c_z", "tip_alpha_rad", "stroke_2_m", "event"] {
        assert!(names.iter().any(|own| own == name), "{name}: {names:?}");
    }
    let drawn = hydrostat_in(
        directory.path(),
        &[&path[..], &["--quantity", "tip.z", "--plot", "z.svg", "--svg-text"]].concat(),
    );
    assert_eq!(drawn.code, 0, "{}", drawn.err);
    assert!(std::fs::read_to_string(directory.path().join("z.svg")).unwrap().contains("flow.direction[2]"));
}

#[test]
fn a_target_in_space_is_reached_or_missed_with_the_closest() {
    let arm = ["silicone-spatial", "--set", "flow.speed=0.05"];
    let tip = json(&solved(&[&["solve"], &arm[..], &["--format", "json"]].concat()).out)["tip"].clone();
    let [x, y, z] = ["x", "y", "z"].map(|name| tip[name].as_f64().unwrap());
    let target = format!("{x},{y},{z}");
    let reach = [&["reach"], &arm[..], &["--target", &target, "--max-tension", "0.5"]].concat();
    let document = json(&solved(&[&reach[..], &["--format", "json"]].concat()).out);
    assert_eq!(document["reached"], true);
    let found = &document["solutions"][0]["tip"];
    for (name, value) in [("x", x), ("y", y), ("z", z)] {
        assert!((found[name].as_f64().unwrap() - value).abs() < 1e-8, "{name}");
    }
    let (names, rows) = columns_of(&solved(&[&reach[..], &["--format", "csv"]].concat()).out);
    assert!(rows >= 1 && names.contains(&"tip_b_y".to_owned()));
    let directory = directory();
    let far = ["--target", "0.4,0,0", "--max-tension", "0.5", "--plot", "closest.svg"];
    let missed = hydrostat_in(directory.path(), &[&["reach"], &arm[..], &far].concat());
    assert_eq!(missed.code, 3, "{}", missed.err);
    assert!(missed.err.contains("the target is not reached") && missed.out.contains("z (mm)"), "{}", missed.err);
    assert!(directory.path().join("closest.svg").exists());
}

/// The names of a table, and how many rows it has.
fn columns_of(table: &str) -> (Vec<String>, usize) {
    let mut lines = table.lines();
    let names = lines.next().unwrap().split(',').map(str::to_owned).collect();
    (names, lines.count())
}

#[test]
fn equilibria_in_space_are_listed_and_drawn() {
    let directory = tempfile::tempdir().unwrap();
    let arm = ["equilibria", "silicone", "--set", "arm.space=spatial", "--set", "flow.direction=175", "--flow-speed"];
    let json_of = |more: &[&str]| {
        json(
            &hydrostat_in(
                directory.path(),
                &[&arm[..], more, &["--format", "json", "--plot", "all.svg", "--svg-text"]].concat(),
            )
            .out,
        )
    };
    let all = json_of(&["0.2"]);
    assert_eq!((all["complete"].as_bool(), all["misses_some"].as_bool()), (Some(false), Some(false)));
    assert_eq!(all["sum_of_signs"], 1);
    assert_eq!(all["equilibria"].as_array().unwrap().len(), 5);
    assert!(all["equilibria"][0]["tip"]["z"].is_number());
    let svg = std::fs::read_to_string(directory.path().join("all.svg")).unwrap();
    assert!(svg.contains("unstable"));
    let text = solved(&[&arm[..], &["0.05"]].concat()).out;
    assert!(text.contains("there may be others"), "{text}");
    let over = [&arm[..], &["0.05", "--over", "cable[0].tension=0:0.01:2", "--format", "csv"]].concat();
    let table = solved(&over).out;
    assert!(table.starts_with("cable_0_tension_N,complete,number,tip_x_m,tip_y_m,tip_z_m,"), "{table}");
    assert!(table.lines().count() >= 3);
}

/// The message named the option as the library has it, `tol`.
#[test]
fn a_wrong_tolerance_is_named_as_on_the_command_line_in_space_too() {
    for arm in ["silicone", "silicone-spatial"] {
        let message = refused(&["solve", arm, "--tol", "1"]);
        assert!(message.contains("--tol: expected a number in [1e-12, 1e-2], found 1"), "{message}");
    }
}
