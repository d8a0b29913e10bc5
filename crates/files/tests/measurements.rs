//! Measured shapes as CSV: what is read, and what is said of what cannot be.

use hydrostat::Parameter;
use hydrostat_files::{ArmFile, Deviations, parse_measurements, shipped};
use hydrostat_identify::{Case, Quantity, Unknown};
use proptest::prelude::*;

fn read_with(text: &str, sd: &[&str], fitted: &[Unknown]) -> Result<Vec<Case>, String> {
    let file = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap();
    let mut deviations = Deviations::default();
    for text in sd {
        deviations.add(text).unwrap();
    }
    parse_measurements(text, "data.csv", &file, &deviations, fitted).map_err(|error| error.to_string())
}

fn read(text: &str) -> Result<Vec<Case>, String> {
    read_with(text, &["1 mm", "1 deg", "1 mN", "0.1 N mm"], &[])
}

fn refused(text: &str) -> String {
    read(text).unwrap_err()
}

#[test]
fn a_table_gives_cases_with_their_loads() {
    let text = "\u{feff}# markers from the left camera\r\n\
        case,cable[0].tension [mN],flow.speed [cm/s],flow.law,s [mm],x [mm],y [mm],angle [deg],stroke[1] [mm],base moment [N mm],sd x [mm],sd position [mm]\r\n\
        still,200,,,0.1,0.1,0,,,,0.5,2\r\n\
        still,,,,,230.5,40,12,-3,5.5,,2\r\n\
        ,,,,,,,,,,,\r\n\
        \"a, b\",,10,quadratic-drag,245,200,,,,,,\r\n";
    let cases = read(text).unwrap();
    let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names, ["still", "a, b"]);
    assert_eq!((cases[0].arm.cables[0].tension, cases[0].arm.flow.speed), (0.2, 0.0));
    assert_eq!(cases[1].arm.flow.speed, 0.1);
    assert!(matches!(cases[1].arm.flow.law, hydrostat::FlowLaw::QuadraticDrag { cn, .. } if cn == 2.5));
    let own: Vec<_> = cases[0].measurements.iter().map(|m| (m.quantity, m.value, m.sd, m.row)).collect();
    let degrees = |value: f64| value.to_radians();
    assert_eq!(
        own,
        [
            (Quantity::X(1e-4), 1e-4, 5e-4, 3),
            (Quantity::Y(1e-4), 0.0, 2e-3, 3),
            (Quantity::X(0.245), 0.2305, 1e-3, 4),
            (Quantity::Y(0.245), 0.04, 2e-3, 4),
            (Quantity::Angle(0.245), degrees(12.0), degrees(1.0), 4),
            (Quantity::Stroke(1), -0.003, 1e-3, 4),
            (Quantity::BaseMoment, 5.5e-3, 1e-4, 4),
        ]
    );
}

/// With `x [m]` over millimetres a fit went on for 100 steps and found a stiffness of 42 GPa.
#[test]
fn positions_of_a_thousand_lengths_were_fitted() {
    assert_eq!(
        refused("case,s [mm],x [m],y [mm]\na,122.5,110,3\na,245,230.5,40\n"),
        "data.csv, row 2, column \"x [m]\": 110000 mm from the base is 448.98 lengths of the arm; see the unit of the column, and arm.base"
    );
    assert!(refused("s [mm],y [m]\n245,-40\n").contains("row 2, column \"y [m]\": 40000 mm from the base"));
    // A badly stretched arm, and one whose base stands elsewhere.
    assert!(read("s [mm],x [mm],y [mm]\n245,500,500\n").is_ok());
    assert!(read("arm.base.x [m],s [mm],x [m]\n7,245,7.2\n").is_ok());
}

#[test]
fn spreadsheets_with_semicolons_and_decimal_commas_are_read() {
    let cases = read("case;s [mm];x [mm];y [mm]\na;122,5;110,25;-3,5e0\n").unwrap();
    let values: Vec<f64> = cases[0].measurements.iter().map(|m| m.value).collect();
    assert_eq!((values, cases[0].measurements[0].quantity), (vec![0.11025, -0.0035], Quantity::X(0.1225)));
    let cases = read("s [m]\tx [m]\n0.1\t0.1\n0.2\t0.19\n").unwrap();
    assert_eq!((cases.len(), cases[0].name.as_str(), cases[0].measurements.len()), (1, "1", 2));
}

/// `NaN` and `NA` were refused, and a byte order mark with decimal commas read.
#[test]
fn what_programs_write_for_nothing_was_refused() {
    for text in [
        "s [mm],x [mm],y [mm]\n50,42.51,-23.16\n150,NaN,NaN\n245,84.83,NA\n",
        "s_mm,x_mm,y_mm\n50,42.51,-23.16\n150,,\n245,84.83,nan\n",
        "\u{feff}s [mm];x [mm];y [mm]\r\n50;42,51;-23,16\r\n245;84,83;\r\n",
        "s [mm]\tx [mm]\ty [mm]\n50\t42,51\t-23.16\n245\t84.83\tNA\n",
    ] {
        let cases = read(text).unwrap();
        let values: Vec<f64> = cases[0].measurements.iter().map(|m| m.value).collect();
        assert_eq!(values, [0.04251, -0.02316, 0.08483], "{text}");
    }
}

#[test]
fn heads_are_read_as_identifiers() {
    let bracketed = "case,cable[0].tension [mN],flow.speed [m/s],flow.law,s [mm],x [mm],base force x [N],base moment [N mm],stroke[1] [mm],sd x [mm]\n";
    let plain = "case,cable_0_tension_mN,flow_speed_m_s,flow_law,s_mm,x_mm,base_force_x_N,base_moment_Nmm,stroke_1_mm,sd_x_mm\n";
    let row = "a,200,0.1,quadratic-drag,245,230,0.1,2,3,0.5\n";
    let [first, second] = [bracketed, plain].map(|heads| read(&format!("{heads}{row}")).unwrap().remove(0));
    assert_eq!((&first.arm, &first.measurements), (&second.arm, &second.measurements));
    assert_eq!((first.arm.cables[0].tension, first.measurements.len()), (0.2, 4));
    assert!(
        refused("s_mm,x\n1,1\n").contains("column \"x\": expected a length in m, cm, mm, um, in, ft; write the unit")
    );
    assert!(refused("s_mm,x_N\n1,1\n").contains("`N` is the unit of a force"));
    assert!(refused("s_mm,flow_sped_m_s\n1,1\n").contains("did you mean `flow.speed`?"));
}

/// A table of stations is read as measured positions; its angles count where they have a standard deviation.
#[test]
fn the_tables_of_solves_are_measurements() {
    let mut arm = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap();
    arm.set("cable[0].end", "0.5").unwrap();
    arm.set("cable[0].tension", "0.2").unwrap();
    let solved = hydrostat::Solver::new(&arm.arm().unwrap(), hydrostat::Options::default()).unwrap().solve().unwrap();
    let text = hydrostat_files::stations_csv(&solved.stations);
    let nodes = solved.stations.len();
    let positions = read_with(&text, &["1 mm"], &[]).unwrap();
    // The end of the cable stands there twice.
    assert_eq!(positions[0].measurements.len(), 2 * (nodes - 1));
    let angles = read_with(&text, &["1 mm", "1 deg"], &[]).unwrap();
    assert_eq!(angles[0].measurements.len(), 3 * (nodes - 1));
}

/// The first column was said to be unknown.
#[test]
fn columns_of_markers_are_refused_with_how_to_turn_them_round() {
    let message = refused("frame,time,m1_x,m1_y,m2_x,m2_y\n7,0.0,0.0653,-0.0679,0.0848,-0.2109\n");
    assert!(message.starts_with("data.csv, row 1: has columns for each marker (m1_x, m1_y, m2_x, m2_y)"), "{message}");
    assert!(message.contains("\"case,s_mm,x_mm,y_mm\"") && message.contains("\"7,s,0.0653,-0.0679\""), "{message}");
}

#[test]
fn columns_that_cannot_be_meant_are_named() {
    for (head, says) in [
        ("x [N]", "expected a length in m, cm, mm, um, in, ft; `N` is the unit of a force"),
        ("x", "write the unit behind the name, as in \"x [m]\""),
        ("x [parsec]", "`parsec` is not a known unit here"),
        ("w [mm]", "is not a column of measurements"),
        ("angel [deg]", "did you mean `angle`?"),
        ("case [m]", "expected no unit, found [m]"),
        ("flow.speed", "write the unit behind the name, as in \"flow.speed [m/s]\""),
        ("flow.sped [m/s]", "did you mean `flow.speed`?"),
        ("cable[0].tension [mm]", "`mm` is the unit of a length"),
        ("sd bending [mm]", "is not a column"),
        ("", "is not a column"),
    ] {
        let message = refused(&format!("case,{head},s [mm]\na,1,1\n"));
        assert!(message.starts_with(&format!("data.csv, row 1, column \"{head}\": ")), "{message}");
        assert!(message.contains(says), "{head}: {message}");
    }
    assert!(
        refused("x [mm],y [mm],x [cm]\n1,1,1\n")
            .contains("row 1, column \"x [cm]\": the column \"x [mm]\" has the same")
    );
    let given = read_with("flow.speed [m/s],x [mm]\n0.1,1\n", &["1 mm"], &[Parameter::FlowSpeed.into()]).unwrap_err();
    assert_eq!(given, "data.csv, row 1, column \"flow.speed [m/s]\": is fitted, so that no load case can give it");
}

#[test]
fn rows_that_cannot_be_meant_are_named() {
    let head = "case,cable[0].tension [N],s [mm],x [mm],y [mm],sd position [mm]\n";
    for (rows, says) in [
        ("a,0.1,100,1\n", ", row 2: expected 6 cells, as many as there are column heads, found 4"),
        ("a,0.1,100,1,1,1,1\n", ", row 2: expected 6 cells"),
        ("a,0.1,100,one,1,1\n", ", row 2, column \"x [mm]\": expected a number (mm, as the head says), found \"one\""),
        ("a,0.1,100,5 mm,1,1\n", "found \"5 mm\""),
        ("a,0.1,100,inf,1,1\n", "found \"inf\""),
        (
            "a,0.1,NaN,1,1,1\n",
            "column \"s [mm]\": expected a place along the arm, or nothing for the tip, found \"NaN\"",
        ),
        ("a,0.1,100,1e999,1,1\n", "found \"1e999\""),
        ("a,0.1,300,1,1,1\n", ", row 2, column \"s [mm]\": 300 mm is beyond the arm, which goes from 0 to 245 mm"),
        ("a,0.1,-1,1,1,1\n", "-1 mm is beyond the arm"),
        (
            "a,0.1,100,1,1,0\n",
            ", row 2, column \"sd position [mm]\": expected a standard deviation above zero, found 0",
        ),
        (",0.1,100,1,1,1\n", ", row 2, column \"case\": expected the name of a load case, found nothing"),
        (
            "a,0.1,100,1,1,1\na,,50,1,,1\n# again\na,,100,,2,1\n",
            ", row 5, column \"y [mm]\": y at s = 100 mm of load case a is in row 2 already",
        ),
        (
            "a,0.1,,1,1,1\na,,245,1,,1\n",
            ", row 3, column \"x [mm]\": x at s = 245 mm of load case a is in row 2 already",
        ),
        (
            "a,0.1,100,1,1,1\na,0.2,50,1,1,1\n",
            ", row 3, column \"cable[0].tension [N]\": load case a has \"0.1 N\" in row 2",
        ),
        ("a,-1,100,1,1,1\n", ", row 2: load case a: "),
        ("a,x,100,1,1,1\n", ", row 2, column \"cable[0].tension [N]\": expected a number"),
    ] {
        let message = refused(&format!("{head}{rows}"));
        assert!(message.starts_with("data.csv") && message.contains(says), "{rows}: {message}");
    }
    assert!(refused("").contains("is empty"));
    let bare = read_with("x [mm],angle [deg]\n1,2\n", &["1 mm"], &[]).unwrap_err();
    assert_eq!(
        bare,
        "data.csv, row 2, column \"angle [deg]\": has no standard deviation: add a column \"sd angle [deg]\", or --sd with an angle"
    );
}

#[test]
fn words_and_indices_are_checked_by_the_arm_file() {
    let message = refused("model.volume,x [mm]\nround,1\n");
    assert!(message.starts_with("data.csv, row 2: load case 1: "), "{message}");
    assert!(message.contains("planar"), "{message}");
    let message = refused("cable[7].tension [N],x [mm]\n1,1\n");
    assert!(message.starts_with("data.csv, row 2, column \"cable[7].tension [N]\": "), "{message}");
    assert!(message.contains("2 cables"), "{message}");
}

proptest! {
    #![proptest_config(hydrostat_fuzz::property(256))]

    #[test]
    fn no_table_panics(text in "(case|s \\[mm\\]|x \\[mm\\]|sd x \\[mm\\]|flow.speed \\[m/s\\]|[,;\t\n\"#a0-9.e-]){0,60}") {
        if let Err(message) = read(&text) {
            prop_assert!(message.starts_with("data.csv"), "{}", message);
        }
    }
}
