//! Files that are refused: every message names the file, the line, the key, what was expected and
//! what was found.

mod common;

use hydrostat_files::{ArmFile, Axis, Deviations, FileError, Place, parse_measurements};

use common::ARM;

fn refusal(text: &str) -> FileError {
    match ArmFile::parse(text, "case.toml").and_then(|file| file.arm()) {
        Ok(arm) => panic!("accepted as {arm:?}:\n{text}"),
        Err(error) => error,
    }
}

#[track_caller]
fn check(text: &str, line: usize, key: &str, parts: &[&str]) {
    let error = refusal(text);
    let message = error.to_string();
    let start = format!("case.toml:{line}: {key}: ");
    let said =
        message.strip_prefix(&start).unwrap_or_else(|| panic!("wanted `{start}...`, got `{message}` for:\n{text}"));
    let expected = said.starts_with("expected ") && said.contains(", found ");
    let others = ["unknown key; expected ", "missing; expected ", "not valid TOML: ", "the key is given twice"];
    assert!(expected || others.iter().any(|start| said.starts_with(start)), "{message}");
    assert!(!message.contains('\n'), "{message}");
    for part in parts {
        assert!(message.contains(part), "wanted `{part}` in `{message}` for:\n{text}");
    }
    assert_eq!(error.key(), Some(key));
    assert!(matches!(error.place(), Some(Place::Line { line: l, .. }) if *l == line));
}

/// What follows the arm, the line and the key of the refusal, and parts of its message.
type Case = (&'static str, usize, &'static str, &'static [&'static str]);

fn check_added(cases: &[Case]) {
    assert!(cases.len() >= 30);
    for (added, line, key, parts) in cases {
        check(&format!("{ARM}{added}"), *line, key, parts);
    }
}

/// Keys, types and units that are none, added to an arm that is right.
#[test]
fn added_keys_types_and_units() {
    let cases: &[Case] = &[
        // Unknown keys.
        ("[flow]\nspede = 1", 7, "flow.spede", &["speed, direction", "unknown key", "did you mean `speed`?"]),
        ("[flwo]\nspeed = 1", 6, "flwo", &["did you mean `flow`?"]),
        ("[[cable]]\noffset = 0\n\ntensoin = 1", 9, "cable[0].tensoin", &["did you mean `tension`?"]),
        ("[[cable]]\n[[cable]]\nTension = 1", 8, "cable[1].Tension", &["did you mean `tension`?"]),
        ("[tip]\nyoung = 1", 7, "tip.young", &["did you mean `material.young`?"]),
        ("[tip]\nwhatever = 1", 7, "tip.whatever", &["force, moment, follower", "unknown key"]),
        ("\"a b\\n\" = 1", 6, "material.\"a b\\n\"", &["unknown key"]),
        ("poison = 0.4", 6, "material.poison", &["did you mean `poisson`?"]),
        ("[arm.base]\nz = 0", 7, "arm.base.z", &["`space = \"spatial\"`", "found an arm in the plane"]),
        ("[reference]\nmu = { base = 0, top = 1 }", 7, "reference.mu.top", &["base and tip", "did you mean `tip`?"]),
        // Wrong types.
        ("[flow]\nspeed = true", 7, "flow.speed", &["a speed (a number in m/s,", "found true"]),
        ("[flow]\nspeed = [1]", 7, "flow.speed", &["found an array of 1 value"]),
        ("[flow]\nspeed = { base = 1, tip = 2 }", 7, "flow.speed", &["found a table with base, tip"]),
        ("[flow]\nspeed = 2024-01-01", 7, "flow.speed", &["found the date 2024-01-01"]),
        ("flow = 3", 6, "material.flow", &["did you mean", "unknown key"]),
        ("[[flow]]\nspeed = 1", 6, "flow", &["a table with speed, direction", "an array of 1 value"]),
        ("[cable]\noffset = 0", 6, "cable", &["[[cable]] tables, each with name", "a table with offset"]),
        ("[[cable]]\nname = 3", 7, "cable[0].name", &["a string", "found 3"]),
        ("[flow]\nlaw = \"drag\"", 7, "flow.law", &["\"momentum\" or \"quadratic-drag\"", "found \"drag\""]),
        ("[flow]\nlaw = 1", 7, "flow.law", &["\"momentum\" or \"quadratic-drag\"", "found 1"]),
        (
            "[model]\nvolume = \"plain\"",
            7,
            "model.volume",
            &["\"planar\" or \"circular\" or \"none\"", "found \"plain\""],
        ),
        ("[model]\nclosure = \"litteral\"", 7, "model.closure", &["\"default\" or \"literal\""]),
        ("[tip]\nforce = 1", 7, "tip.force", &["two values [_, _]", "found 1"]),
        ("[tip]\nforce = [1, 2, 3]", 7, "tip.force", &["found an arm in the plane"]),
        ("[tip]\nforce = [1,\n  \"2 m\"]", 8, "tip.force[1]", &["a force", "`m` is the unit of a length"]),
        ("[reference]\nmu = \"a lot\"", 7, "reference.mu", &["a curvature", "it does not start with a number"]),
        ("[distributed]\nforce = [0, true]", 7, "distributed.force[1]", &["a force per length", "found true"]),
        ("[distributed]\nforce = 1", 7, "distributed.force", &["two profiles", "found 1"]),
        // Wrong units.
        ("[flow]\nspeed = \"0.5 m\"", 7, "flow.speed", &["m/s, cm/s", "found \"0.5 m\": `m` is the unit of a length"]),
        ("[flow]\nspeed = \"0.5\"", 7, "flow.speed", &["found \"0.5\": it has no unit"]),
        ("[flow]\nspeed = \"0.5 mph\"", 7, "flow.speed", &["the unit `mph` is not known"]),
        ("[flow]\ndirection = \"1 m\"", 7, "flow.direction", &["an angle (a number in degrees", "deg, rad"]),
        ("[gravity]\nacceleration = \"9.81 m/s\"", 7, "gravity.acceleration", &["an acceleration", "m/s2", "a speed"]),
        (
            "[[cable]]\nend = \"50 kg\"",
            7,
            "cable[0].end",
            &["a fraction of the length", "a length such as", "\"50 kg\""],
        ),
        ("poisson = \"0.5\"", 6, "material.poisson", &["a number without unit", "found \"0.5\""]),
    ];
    check_added(cases);
}

/// Values that make no arm, added to one that is right.
#[test]
fn added_values() {
    let cases: &[Case] = &[
        // Not finite.
        ("[flow]\nspeed = nan", 7, "flow.speed", &["found NaN, which is not finite"]),
        ("[tip]\nforce = [0, -inf]", 7, "tip.force[1]", &["-inf, which is not finite"]),
        ("[flow]\nspeed = 1e999", 7, "flow.speed", &["expected", "found"]),
        ("[flow]\nspeed = \"1e999 m/s\"", 7, "flow.speed", &["the number is too large"]),
        // Values out of range.
        ("[flow]\nspeed = -1", 7, "flow.speed", &["not negative", "found -1"]),
        ("[flow]\ndensity = -1", 7, "flow.density", &["not negative", "found -1"]),
        ("[flow]\nlayer_thickness = 0", 7, "flow.layer_thickness", &["above zero", "found 0"]),
        ("[flow]\nlaw = \"quadratic-drag\"\ncn = -1\nct = 0", 8, "flow.cn", &["not negative", "found -1"]),
        ("[flow]\nlaw = \"quadratic-drag\"\ncn = 1", 7, "flow.ct", &["a number without unit with law", "missing"]),
        ("[flow]\nlaw = \"quadratic-drag\"", 7, "flow.cn", &["missing"]),
        ("[gravity]\nacceleration = -9.81", 7, "gravity.acceleration", &["not negative", "found -9.81"]),
        ("poisson = 0.6", 6, "material.poisson", &["0.5", "found 0.6"]),
        ("shear_factor = 0", 6, "material.shear_factor", &["above zero"]),
        ("[reference]\nnu = { base = 1, tip = 0 }", 7, "reference.nu", &["above zero", "0 at s = 0.2 m"]),
        ("[[cable]]\noffset = 0.02", 7, "cable[0].offset", &["inside the section", "0.02 m there"]),
        ("[[cable]]\noffset = 0.009\n", 7, "cable[0].offset", &["inside the section, at most"]),
        ("[[cable]]\noffset = 0\ntension = -1", 8, "cable[0].tension", &["not negative", "found -1"]),
        (
            "[[cable]]\noffset = 0\nmax_tension = 1\ntension = 2",
            9,
            "cable[0].tension",
            &["at most its max_tension of 1 N", "found 2 N"],
        ),
        ("[[cable]]\noffset = 0\nmax_tension = 0", 8, "cable[0].max_tension", &["above zero"]),
        ("[[cable]]\noffset = 0\nend = 0", 8, "cable[0].end", &["in (0, 1]", "found 0"]),
        ("[[cable]]\noffset = 0\nend = 1.5", 8, "cable[0].end", &["in (0, 1]", "found 1.5"]),
        // Tables.
        ("[reference]\nmu = [[0, 1]]", 7, "reference.mu", &["at least two points [s, value]", "found 1"]),
        ("[reference]\nmu = []", 7, "reference.mu", &["at least two points [s, value]", "found 0"]),
        ("[reference]\nmu = [[0, 1], [0.1, 2]]", 7, "reference.mu", &["length, 0.2 m", "from 0 m to 0.1 m"]),
        (
            "[reference]\nmu = [\n  [0, 1],\n  [0.1, 2],\n  [0.1, 3],\n  [0.2, 1]]",
            10,
            "reference.mu[2]",
            &["increasing places, here one above s = 0.1 m", "found s = 0.1 m"],
        ),
        ("[reference]\nmu = [0, 1]", 7, "reference.mu[0]", &["a point [s, value]", "found 0"]),
        ("[reference]\nmu = [[0, 1, 2], [1, 2]]", 7, "reference.mu[0]", &["a point", "found an array of 3 values"]),
        ("[reference]\nmu = [[0, 1],\n[\"1 kg\", 2]]", 8, "reference.mu[1][0]", &["a length", "`kg` is not known"]),
        ("[reference]\nmu = { base = 1 }", 7, "reference.mu.tip", &["a curvature", "missing"]),
        // Material given twice.
        ("c1 = 1", 6, "material.c1", &["either young, poisson, shear_factor or c1, c2, c3", "c1, young together"]),
        // Not TOML.
        ("[flow]\nspeed = ", 7, "flow.speed", &["TOML"]),
        ("[flow]\nspeed = 0.5 m/s", 7, "flow.speed", &["TOML"]),
        ("[flow]\nspeed", 7, "flow.speed", &["TOML"]),
        ("[flow", 6, "flow", &["TOML"]),
        ("[[cable]]\n[[cable]]\noffset = { base = 1, tip = ", 8, "cable[1].offset", &["TOML"]),
        ("name = \"open", 6, "material.name", &["TOML"]),
        // Twice.
        ("[flow]\nspeed = 1\nspeed = 2", 8, "flow.speed", &["given twice"]),
        ("[flow]\n[arm]", 7, "arm", &["given twice"]),
        ("[flow]\n[tip]\n[flow]", 8, "flow", &["given twice"]),
        ("[arm.base]\nx = 1\nx = 1", 8, "arm.base.x", &["given twice"]),
        ("[[cable]]\noffset = { base = 0, base = 0 }", 7, "cable[0].offset.base", &["given twice"]),
    ];
    check_added(cases);
}

/// Whole files.
#[test]
fn whole_files() {
    let cases: &[Case] = &[
        ("", 1, "arm", &["a table with space, length, radius", "missing"]),
        ("# only a comment\n", 1, "arm", &["missing"]),
        ("\u{feff}", 1, "arm", &["missing"]),
        ("[arm]\nlength = 1\nradius = 1\n", 1, "material", &["young", "missing"]),
        ("[material]\nyoung = 1\n\n[arm]\nradius = 1", 4, "arm.length", &["a length", "missing"]),
        ("[material]\nyoung = 1\n\n[arm]\nlength = 1", 4, "arm.radius", &["a length", "missing"]),
        ("[arm]\nlength = 1\nradius = 0.1\n[material]\npoisson = 0.5", 4, "material.young", &["a pressure", "or c1"]),
        ("[arm]\nlength = 1\nradius = 0.1\n[material]\nc1 = 1\nc3 = 1", 4, "material.c2", &["c1, c2 and c3 together"]),
        ("arm = 1\nmaterial = 2", 1, "arm", &["a table", "found 1"]),
        ("[arm]\nlength = 0\nradius = 0.1\n[material]\nyoung = 1", 2, "arm.length", &["above zero", "found 0"]),
        ("[arm]\nlength = -1\nradius = 0.1\n[material]\nyoung = 1", 2, "arm.length", &["above zero", "found -1"]),
        ("[arm]\nlength = \"1 kg\"\nradius = 1", 2, "arm.length", &["m, cm, mm", "the unit `kg` is not known"]),
        (
            "[arm]\nlength = 1\nradius = { base = 0.1, tip = 0 }\n[material]\nyoung = 1",
            3,
            "arm.radius",
            &["above zero", "0 at s = 1 m"],
        ),
        (
            "[arm]\nlength = 1\nradius = 0.1\ninner_radius = 0.1\n[material]\nyoung = 1",
            4,
            "arm.inner_radius",
            &["less than the radius, 0.1 m", "0.1 m there"],
        ),
        (
            "[arm]\nlength = 1\nradius = 0.1\ninner_radius = -0.1\n[material]\nyoung = 1",
            4,
            "arm.inner_radius",
            &["not negative"],
        ),
        ("[arm]\nlength = 1\nradius = 0.1\ndensity = -1\n[material]\nyoung = 1", 4, "arm.density", &["not negative"]),
        ("[arm]\nlength = 1\nradius = 0.1\ncavity = \"air\"", 4, "arm.cavity", &["\"flooded\" or \"sealed\""]),
        ("[arm]\nlength = 1\nradius = 0.1\n[material]\nyoung = 0", 5, "material.young", &["above zero"]),
        ("[arm]\nlength = 1\nradius = 0.1\n[material]\nc1 = 1\nc2 = 0\nc3 = 1", 6, "material.c2", &["above zero"]),
        (
            "[arm]\nlength = 1\nradius = [[0, 0.1], [0.5, 0.1]]\n[material]\nyoung = 1",
            3,
            "arm.radius",
            &["from s = 0 to the length, 1 m", "from 0 m to 0.5 m"],
        ),
        ("[arm]\r\nlength = 1\r\nlenght = 2\r\n", 3, "arm.lenght", &["did you mean `length`?"]),
        ("\u{feff}[arm]\nlenght = 2\n", 2, "arm.lenght", &["did you mean `length`?"]),
        ("nme = \"x\"\n", 1, "nme", &["did you mean `name`?"]),
        ("name = 1\n", 1, "name", &["a string", "found 1"]),
        ("name = \"a\"\nname = \"b\"\n", 2, "name", &["given twice"]),
    ];
    for (text, line, key, parts) in cases {
        check(text, *line, key, parts);
    }
}

#[test]
fn bytes_that_are_no_text() {
    let error = ArmFile::parse_bytes(b"[arm]\nname = \"\xff\"", "case.toml").unwrap_err();
    assert_eq!(error.to_string(), "case.toml:2: not UTF-8 text: the byte 0xff");
}

#[test]
fn a_file_that_is_not_there() {
    let error = ArmFile::read("no/such/arm.toml").unwrap_err();
    assert!(error.to_string().starts_with("no/such/arm.toml: cannot be read: "), "{error}");
}

#[test]
fn messages_stay_short() {
    let long = "x".repeat(100_000);
    for text in [format!("{long} = 1"), format!("name = 1\n[arm]\nlength = \"{long}\""), format!("name = {long}")] {
        let message = refusal(&text).to_string();
        assert!(message.len() < 500, "{} characters", message.len());
    }
}

/// A megabyte of anything is answered, and soon.
#[test]
fn large_and_deep_files() {
    let started = std::time::Instant::now();
    let mega = 1 << 20;
    let points = |n: usize| {
        let list: Vec<String> = (0..n).map(|i| format!("[{}, 0.01]", i as f64 / (n - 1) as f64)).collect();
        format!("[{}]", list.join(","))
    };
    let arm = |radius: &str| format!("[arm]\nlength = 1\nradius = {radius}\n[material]\nyoung = 1\n");
    let cases = [
        "[".repeat(mega),
        "x = ".to_owned() + &"[".repeat(mega),
        "x = ".to_owned() + &"{a=".repeat(mega / 3),
        "a.".repeat(mega / 2) + "b = 1",
        format!("[{}]", "a.".repeat(70) + "b") + &format!("\nx = {}1", "{a.a.a.a.a.a.a.a=".repeat(70)),
        format!("x = {}1{}", "{a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a=".repeat(75), "}".repeat(75)),
        format!("[{}b]\n", "a.".repeat(70)).repeat(mega / 150),
        "[[cable]]\n".repeat(mega / 10),
        "x=1\n".repeat(mega / 4),
        (0..mega / 12).fold(String::new(), |text, i| text + &format!("k{i}=1\n")),
        "\"".repeat(mega),
        "#".repeat(mega),
        "\n".repeat(mega),
        "name = \"".to_owned() + &"\\u0041".repeat(mega / 6) + "\"",
        arm(&points(60_000)),
        arm(&points(9_000)) + &"[[cable]]\noffset=0\n".repeat(101),
    ];
    for text in cases {
        assert!(ArmFile::parse(&text, "large.toml").and_then(|f| f.arm()).is_err());
    }
    let cables = "[[cable]]\noffset=0\n".repeat(100);
    let largest = arm(&points(760)) + &cables;
    assert_eq!(ArmFile::parse(&largest, "large.toml").unwrap().arm().unwrap().cables.len(), 100);
    // Both at their largest take more memory than meshes may.
    let both = ArmFile::parse(&(arm(&points(9_000)) + &cables), "large.toml").unwrap().arm().unwrap_err().to_string();
    assert!(both.contains("arm.radius: expected at most 769 places") && both.contains("found 8998"), "{both}");
    assert!(started.elapsed().as_secs() < 60, "{:?}", started.elapsed());
}

/// A name of a megabyte was drawn letter by letter, in 500 MB.
/// The parser counts a level less for brackets that close nothing, and went down until the stack was full.
#[test]
fn nesting_behind_stray_brackets_filled_the_stack() {
    for unit in ["a = {[b]]\nc = 1\nd = {[b]]\n", "a = {b]", "a = [{b]}", "a = {[]]", "a={b=[}]"] {
        let text = format!("[arm]\n{}", unit.repeat(1_000_000 / unit.len()));
        let error = refusal(&text).to_string();
        assert!(error.starts_with("case.toml:") && error.len() < 4000, "{error}");
        let value = unit.repeat(100_000 / unit.len());
        let mut file = ArmFile::parse(ARM, "case.toml").unwrap();
        assert!(file.set("arm.length", &value).is_err() || file.arm().is_err(), "{unit}");
    }
}

#[test]
fn a_name_as_long_as_the_file_was_drawn() {
    let message = refusal(&format!("name = \"{}\"\n", "n".repeat(900_000))).to_string();
    assert!(message.starts_with("case.toml:1: name: expected a string of at most 200 characters"), "{message:.300}");
    assert!(message.len() < 500, "{} bytes", message.len());
}

/// The message had the whole key, as long as the file.
#[test]
fn a_key_as_long_as_the_file_filled_the_message() {
    for text in [format!("[{}a]", "a.".repeat(400_000)), format!("{}a = 1", "a.".repeat(400_000))] {
        let message = refusal(&text).to_string();
        assert!(message.starts_with("case.toml:1: ") && message.len() < 500, "{} bytes", message.len());
    }
}

/// Found by fuzzing: the key of a grid and the unit of a column stood in messages as they were, over many lines or pages.
#[test]
fn keys_of_grids_and_units_of_columns_filled_the_message() {
    for text in ["[[cable]]\nflow.speed=0:1:5".to_owned(), "\u{e}\n=".to_owned(), format!("{}=1", "k".repeat(9000))] {
        let message = text.parse::<Axis>().unwrap_err().to_string();
        assert!(!message.contains('\n') && message.len() < 500, "{message:?}");
    }
    let arm = ArmFile::parse(ARM, "arm.toml").unwrap();
    let text = format!("case,s [{}],x [mm]\n", "m[".repeat(4000));
    let message = parse_measurements(&text, "data.csv", &arm, &Deviations::default(), &[]).unwrap_err().to_string();
    assert!(message.len() < 500, "{} bytes", message.len());
}

#[test]
fn names_of_load_cases_and_ends_of_ranges_filled_the_message() {
    let (digits, indices) = ("3".repeat(9000), "[0]".repeat(3000));
    for text in [
        format!("flow.speed=0.1:0.{digits}:1"),
        format!("flow.speed=0.1:0.2:{digits}"),
        format!("cable{indices}.tension=0:x:3"),
        format!("cable{indices}.tension=0:1:x"),
        format!("cable{indices}=0:1:x"),
        format!("cable{indices}=0,x"),
    ] {
        let message = text.parse::<Axis>().unwrap_err().to_string();
        assert!(message.len() < 500, "{} bytes: {message:.200}", message.len());
    }
    let arm = ArmFile::parse(ARM, "arm.toml").unwrap();
    let name = "bo\n".repeat(3000);
    for rows in [
        format!("case,s [mm],x [mm]\n\"{name}\",50,49\n\"{name}\",50,49\n"),
        format!("case,flow.speed [m/s],s [mm],x [mm]\n\"{name}\",0.1,50,49\n\"{name}\",0.2,60,59\n"),
        format!("case,flow.speed [m/s],s [mm],x [mm]\n\"{name}\",-0.1,50,49\n"),
        format!("case,s [mm],x [mm],sd position [mm]\na,50,49,{}\n", "0".repeat(9000)),
    ] {
        let message = parse_measurements(&rows, "data.csv", &arm, &Deviations::default(), &[]).unwrap_err().to_string();
        assert!(!message.contains('\n') && message.len() < 500, "{} bytes: {message:.200?}", message.len());
    }
}

#[test]
fn a_share_of_the_radius_of_an_arm_of_negative_length_panicked() {
    let text = "[arm]\nlength = -0.2\nradius = { base = 0.010, tip = 0.002 }\n[material]\nyoung = 110e3\n[[cable]]\noffset = [[0, \"50 %\"], [0.2, \"20 %\"]]\n";
    let error = ArmFile::parse(text, "case.toml").and_then(|file| file.arm()).unwrap_err();
    assert!(error.to_string().contains("arm.length"), "{error}");
}
