//! Likely slips of the unit, and several errors at once: what is said, and that the status is what it was.

use super::{directory, files, hydrostat_in, refused, solved};

const ARM: &str = "[arm]\nlength = LENGTH\nradius = { base = \"10 mm\", tip = \"2 mm\" }\ndensity = DENSITY\n\
                   [material]\nyoung = YOUNG\n[flow]\nspeed = \"1 cm/s\"\n";

fn arm(length: &str, density: &str, young: &str) -> String {
    ARM.replace("LENGTH", length).replace("DENSITY", density).replace("YOUNG", young)
}

#[test]
fn a_wrong_unit_was_answered_in_silence() {
    let directory = directory();
    let here = directory.path();
    for (text, words) in [
        (arm("300", "1080", "110e3"), "warning: arm.length = 300 m: is it mm?\n"),
        (arm("0.245", "1080", "70"), "warning: material.young = 70 Pa: is it kPa?\n"),
        (arm("0.245", "1.07", "110e3"), "warning: arm.density = 1.07 kg/m3: is it g/cm3?\n"),
    ] {
        std::fs::write(here.join("my.toml"), text).unwrap();
        for command in [
            &["check", "my.toml"][..],
            &["solve", "my.toml"],
            &["sweep", "my.toml", "--vary", "flow.speed=0.01,0.02", "-o", "out.csv"],
            &["path", "my.toml", "--vary", "flow.speed=0.01:0.011"],
        ] {
            let run = hydrostat_in(here, command);
            assert!(run.err.contains(words), "{command:?}: {}", run.err);
            assert!(command[0] != "check" || run.code == 0, "{}", run.err);
            for file in ["out.csv", "out.csv.json"] {
                let _ = std::fs::remove_file(here.join(file));
            }
        }
    }
    let run = solved(&["check", "silicone"]);
    assert_eq!(run.err, "");
    let run = solved(&["check", "silicone", "--set", "arm.length=300", "--tension", "0.1,0"]);
    assert_eq!(run.err, "warning: arm.length = 300 m: is it mm?\n");
    assert!(run.out.contains("\nlength = 300.0\n") && run.out.contains("\ntension = 0.1\n"), "{}", run.out);
}

#[test]
fn a_torque_in_the_wrong_unit_is_named() {
    let torque = super::hydrostat(&["solve", "silicone", "--set", "tip.moment=0.5"]);
    assert!(
        torque.err.contains("warning: tip.moment = 0.5 N m, which alone would turn the tip about "),
        "{}",
        torque.err
    );
    assert!(torque.err.contains(" times: is it N mm?\n"), "{}", torque.err);
    let pull =
        super::hydrostat(&["solve", "silicone", "--set", "cable[0].max_tension=1000", "--set", "cable[0].tension=200"]);
    assert!(pull.err.contains("warning: cable[0].tension = 200 N, which alone") && pull.code == 3, "{}", pull.err);
}

/// Only the arm's own numbers were looked at, not those that they are to take.
#[test]
fn ranges_and_loads_over_time_are_asked_about() {
    let directory = directory();
    let here = directory.path();
    std::fs::write(here.join("loads.csv"), "t_s,cable[0].tension\n0,0\n1,1000\n").unwrap();
    std::fs::write(here.join("data.csv"), "s_mm,x_mm,y_mm\n245,244,1\n").unwrap();
    let wide = ["--set", "cable[0].max_tension=1e5"];
    let sweep = |range: &'static str| ["sweep", "silicone", "--vary", range, "-o", "out.csv"];
    for (args, words) in [
        (&sweep("arm.density=1.07,1000")[..], "arm.density = 1.07 kg/m3: is it g/cm3?"),
        (&sweep("arm.length=245,300"), "arm.length = 245 m: is it mm?"),
        (&sweep("tip.moment=195,200"), "tip.moment = 195 N m, which"),
        (&["path", "silicone", "--vary", "material.young=70:110000"], "material.young = 70 Pa: is it kPa?"),
        (&[&["path", "silicone", "--vary", "cable.0.tension=0:5000"], &wide[..]].concat(), "cable[0].tension = 5000 N"),
        (&["equilibria", "silicone", "--over", "material.young=70:100:2"], "material.young = 70 Pa: is it kPa?"),
        (&["modes", "silicone", "--over", "material.young=70:100:2"], "material.young = 70 Pa: is it kPa?"),
        (&["history", "silicone", "--input", "loads.csv"], "cable[0].tension = 1000 N, which"),
        (&["simulate", "silicone", "--input", "loads.csv", "--until", "1e-9"], "cable[0].tension = 1000 N, which"),
        (
            &["simulate", "silicone", "--vary", "cable[0].tension=ramp:0:1000:0:1", "--until", "1e-9"],
            "cable[0].tension = 1000 N, which",
        ),
        (
            &["identify", "silicone", "data.csv", "--fit", "young=70", "--sd", "1 mm"],
            "material.young = 70 Pa: is it kPa?",
        ),
        (&["reach", "silicone", "--target", "0.2,0.05", "--max-tension", "1000"], "--max-tension = 1000 N, which"),
    ] {
        let run = hydrostat_in(here, args);
        let said = format!("warning: {words}");
        assert_eq!(run.err.matches(&said).count(), 1, "{args:?}: {}", run.err);
        for file in ["out.csv", "out.csv.json"] {
            let _ = std::fs::remove_file(here.join(file));
        }
    }
}

#[test]
fn all_errors_of_a_file_are_told_at_once() {
    let directory = directory();
    let text = "[arm]\nlength = \"2 kg\"\nbase_radius = 0.01\n\n[material]\nyoungs_modulus = 1e5\n\n[flow]\nspeed = true\n\n\
                [[cable]]\noffset = \"70 %\"\nend = \"tip\"\n";
    std::fs::write(directory.path().join("my.toml"), text).unwrap();
    let run = hydrostat_in(directory.path(), &["solve", "my.toml"]);
    assert_eq!(run.code, 2);
    let lines: Vec<&str> = run.err.lines().collect();
    assert_eq!(lines.len(), 5, "{}", run.err);
    for (line, [start, end]) in lines.iter().zip([
        ["error: my.toml:2: arm.length: expected a length", "`kg` is not known"],
        ["error: my.toml:3: arm.base_radius: ", "did you mean `arm.radius.base`?"],
        ["error: my.toml:6: material.youngs_modulus: ", "did you mean `material.young`?"],
        ["error: my.toml:9: flow.speed: ", "found true"],
        ["error: my.toml:13: cable[0].end: ", "found \"tip\"; at the tip it is 1.0"],
    ]) {
        assert!(line.starts_with(start) && line.contains(end), "{line}");
    }
    // Numbers that do not go together are among them.
    let text =
        arm("0.245", "-5", "110e3") + "density = -1\n[[cable]]\noffset = 0.5\ntension = -3\n[[cable]]\nend = 7\n";
    std::fs::write(directory.path().join("my.toml"), text).unwrap();
    let run = hydrostat_in(directory.path(), &["check", "my.toml"]);
    let keys: Vec<&str> = run.err.lines().filter_map(|line| line.split(": ").nth(2)).collect();
    let mut sorted = keys.clone();
    sorted.sort_unstable();
    let all = ["arm.density", "cable[0].offset", "cable[0].tension", "cable[1].end", "flow.density"];
    assert_eq!(sorted, all, "{}", run.err);
}

#[test]
fn hints_name_what_was_meant() {
    let directory = directory();
    let said = |text: &str| {
        std::fs::write(directory.path().join("my.toml"), text).unwrap();
        let run = hydrostat_in(directory.path(), &["check", "my.toml"]);
        assert_eq!(run.code, 2, "{text}");
        run.err
    };
    assert!(said("arm:\n  length: 0.3\n").contains("this looks like YAML"));
    assert!(said("{ \"arm\": { \"length\": 0.3 } }\n").contains("this looks like JSON"));
    assert!(said("[arm]\nlength = 0,3\n").contains("decimals follow a point: 0.3"));
    assert!(said("[arm]\nlength = .3\n").contains("a number begins with a digit: 0.3"));
    assert!(said("[arm]\nlength = 245 mm\n").contains("a number with a unit stands in quotes: \"245 mm\""));
    assert!(said("[arm]\nlength = 1\nradius = 0.01\n[material]\nE = 1e5\n").contains("did you mean `material.young`?"));
    assert!(refused(&["solve", "silicone", "--set", "E=1e5"]).contains("did you mean `material.young`?"));
    assert!(refused(&["path", "silicone", "--vary", "E=1e5:2e5"]).contains("did you mean `material.young`?"));
    let message = refused(&["path", "silicone", "--vary", "flow.speed=0:1:20"]);
    assert!(message.contains("found a COUNT after the range") && message.contains("sweep --vary"), "{message}");
    // Both are in mm: a target far away is not what is wrong.
    let run = super::hydrostat(&["reach", "silicone", "--target", "150,-200 mm", "--max-tension", "0.6 N"]);
    assert!(!run.err.contains("millimetres are meant"), "{}", run.err);
}

#[test]
fn offsets_may_be_shares_of_the_radius_and_ends_lengths() {
    let directory = directory();
    let here = directory.path();
    let solve = |cable: &str| {
        let text = arm("0.245", "1080", "110e3") + "[[cable]]\ntension = 0.05\n" + cable;
        std::fs::write(here.join("my.toml"), text).unwrap();
        let run = hydrostat_in(here, &["solve", "my.toml", "--format", "csv"]);
        assert_eq!(run.code, 0, "{cable}: {}", run.err);
        run.out
    };
    let plain = solve("offset = { base = \"5 mm\", tip = \"1 mm\" }\nend = 0.4");
    assert_eq!(solve("offset = \"50 %\"\nend = \"98 mm\""), plain);
    assert_eq!(solve("offset = { base = \"50 %\", tip = \"50 %\" }\nend = \"40 %\""), plain);
    assert_eq!(solve("offset = { base = \"50 %\", tip = 0.001 }\nend = 0.4"), plain);
    let run = hydrostat_in(here, &["solve", "my.toml", "--set", "cable[0].offset=\"120 %\""]);
    assert!(run.code == 2 && run.err.contains("an offset inside the section"), "{}", run.err);
    let set = ["--set", "cable[0].offset=50 %", "--set", "cable.0.end=98 mm", "--format", "csv"];
    let run = hydrostat_in(here, &[&["solve", "my.toml"], &set[..]].concat());
    assert_eq!((run.code, run.out), (0, plain), "{}", run.err);
}

#[test]
fn init_writes_a_file_that_solves_without_a_warning() {
    let directory = directory();
    let here = directory.path();
    let run = hydrostat_in(here, &["init"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert!(run.out.starts_with("arm.toml: written"), "{}", run.out);
    let text = std::fs::read_to_string(here.join("arm.toml")).unwrap();
    for words in ["length = \"245 mm\"", "# Undeformed length", "young = \"110 kPa\"", "# [gravity]", "# friction = 0"]
    {
        assert!(text.contains(words), "{words}:\n{text}");
    }
    let run = hydrostat_in(here, &["solve", "arm.toml", "--plot", "arm.svg"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{}", run.out);
    assert!(run.out.contains("stable") && files(here) == ["arm.svg", "arm.toml"]);
    let run = hydrostat_in(here, &["check", "arm.toml"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    // Nothing is written over.
    let run = hydrostat_in(here, &["init"]);
    assert!(run.code == 2 && run.err.contains("arm.toml exists"), "{}", run.err);

    for name in ["paper", "paper-statements", "silicone", "multi-bending", "octopus"] {
        let text = solved(&["init", "-", "--from", name]).out;
        std::fs::write(here.join("copy.toml"), text).unwrap();
        let solve = |arm: &str| hydrostat_in(here, &["solve", arm, "--format", "csv"]).out;
        assert_eq!(solve("copy.toml"), solve(name), "{name}");
    }
    assert!(refused(&["init", "--from", "silicon"]).contains("did you mean `silicone`?"));
}

#[test]
fn where_nothing_was_found_the_last_shape_is_told() {
    // No limit of the arm is met: a moment that winds it up without end.
    let run = super::hydrostat(&["solve", "silicone", "--set", "tip.moment=0.5"]);
    assert_eq!(run.code, 3, "{}{}", run.out, run.err);
    assert!(run.err.contains("note: in the last shape that was found the tip is turned by "), "{}", run.err);
    assert!(run.err.contains("\ntry: look at the units first: tip.moment = 0.5 N m"), "{}", run.err);
}

#[test]
fn where_nothing_was_found_in_space_the_last_shape_is_told() {
    let run = super::hydrostat(&["solve", "silicone-spatial", "--set", "arm.length=300"]);
    assert_eq!(run.code, 3, "{}{}", run.out, run.err);
    assert!(run.err.contains("note: in the last shape that was found the arm bends by "), "{}", run.err);
}
