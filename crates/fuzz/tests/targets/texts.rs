//! Arm files, measurements, targets and what is given on the command line: an arm, or one line that says what is wrong and where.

use std::path::Path;

use hydrostat_files::{ArmFile, Axis, Deviations, Varied, arm_to_toml, parse_measurements, parse_targets, shipped};
use hydrostat_fuzz::{fuzz, mutations_of};

/// A message for people.
fn said(message: &str) -> Result<(), String> {
    let fine = !message.is_empty() && message.len() < 4000 && !message.contains('\n');
    if fine { Ok(()) } else { Err(format!("a message that is none: {message:?}")) }
}

fn shipped_arms() -> Vec<Vec<u8>> {
    shipped::names().map(|name| shipped::get(name).unwrap().as_bytes().to_vec()).collect()
}

fn document(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)).unwrap()
}

#[test]
fn arm_files() {
    fuzz("arm files", &mutations_of(shipped_arms()), |bytes| {
        match ArmFile::parse_bytes(&bytes.0, "arm.toml").and_then(|file| file.arm()) {
            Err(error) => {
                let message = error.to_string();
                if !message.starts_with("arm.toml:") {
                    return Err(format!("no place: {message}"));
                }
                said(&message)
            }
            Ok(arm) => {
                let again = ArmFile::parse(&arm_to_toml(&arm), "again").and_then(|file| file.arm());
                match again {
                    Ok(again) if again == arm => Ok(()),
                    Ok(again) => Err(format!("{again:?}\nin place of\n{arm:?}")),
                    Err(error) => Err(format!("what was written is refused: {error}")),
                }
            }
        }
    });
}

#[test]
fn measurements() {
    let arm = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap();
    let wholes = vec![
        document("docs/identification.csv"),
        b"case,cable[0].tension [N],s [mm],x [mm],y [mm],sd position [mm]\na,0.1,245,230.1,62.3,1\na,,120,118.2,,1\n"
            .to_vec(),
        b"case;s [mm];x [mm];y [mm];theta [deg]\nb;245;230,1;62,3;\nb;120;118,2;;4\n".to_vec(),
    ];
    fuzz("measurements", &mutations_of(wholes), |bytes| {
        let text = String::from_utf8_lossy(&bytes.0);
        match parse_measurements(&text, "data.csv", &arm, &Deviations::default(), &[]) {
            Err(error) => said(&error.to_string()),
            Ok(cases) => {
                let mut numbers = cases.iter().flat_map(|case| &case.measurements);
                let fine = numbers.all(|m| m.sd > 0.0 && m.value.is_finite());
                if fine { Ok(()) } else { Err(format!("{cases:?}")) }
            }
        }
    });
}

#[test]
fn targets() {
    let wholes = vec![
        b"x_mm,y_mm,angle_deg\n180,70,30\n181,71,31\n".to_vec(),
        b"# a path\nx_m,y_m\n\n0.1,0.2\n\"0.3\", 0.4 # there\n".to_vec(),
    ];
    fuzz("targets", &mutations_of(wholes), |bytes| {
        let text = String::from_utf8_lossy(&bytes.0);
        match parse_targets(&text, "path.csv", None) {
            Err(error) => said(&error.to_string()),
            Ok(targets) if targets.iter().all(|t| t.x.is_finite() && t.y.is_finite()) => Ok(()),
            Ok(targets) => Err(format!("{targets:?}")),
        }
    });
}

#[test]
fn ranges_and_grids() {
    let wholes: Vec<Vec<u8>> = [
        "flow.speed=0:1 m/s:5",
        "cable[0].tension=0,0.5,1",
        "base.angle=-90 deg:90 deg",
        "arm.length=0.1:0.2",
        "young=80 kPa:1:1e9",
    ]
    .map(|text| text.as_bytes().to_vec())
    .to_vec();
    fuzz("ranges and grids", &mutations_of(wholes), |bytes| {
        let text = String::from_utf8_lossy(&bytes.0).into_owned();
        if let Err(error) = text.parse::<Axis>() {
            said(&error.to_string())?;
        }
        if let Err(error) = text.parse::<Varied>() {
            said(&error.to_string())?;
        }
        Ok(())
    });
}
