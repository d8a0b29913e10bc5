//! A table of measured shapes to fill in.

use hydrostat::Arm;

use crate::csv_text::Rows;
use crate::measurements::rounded_mm;

const IN_PLANE: &str = "x and y: the centreline, in the coordinates of the arm file; angle: the section, from e1";
const IN_SPACE: &str = "x, y and z: a marker, in the coordinates of the arm file; offsets: where it is beside the centreline, along the section's b and c";
const OTHERS_IN_PLANE: &str =
    "tangent_deg, offset_a_mm, offset_b_mm, stroke_0_mm, tension_0_N, base_force_x_N, base_force_y_N, base_moment_Nmm";
const OTHERS_IN_SPACE: &str =
    "offset_a_mm, stroke_0_mm, tension_0_N, base_force_x_N to base_force_z_N, base_moment_x_Nmm to base_moment_z_Nmm";

/// A table to fill in: two load cases of `arm` with four places each.
///
/// ```
/// use hydrostat_files::{ArmFile, Deviations, measurements_template, parse_measurements, shipped};
///
/// let file = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap();
/// let template = measurements_template(&file.arm().unwrap());
/// let cases = parse_measurements(&template, "template", &file, &Deviations::default(), &[]).unwrap();
/// assert_eq!((cases.len(), cases[0].measurements.len()), (2, 0), "nothing is measured yet");
/// ```
pub fn measurements_template(arm: &Arm) -> String {
    let in_space = arm.space.is_some();
    let mut out = format!(
        "# Measured shapes of {}, for `hydrostat identify`. Lines that begin with # are ignored.\n\
         # Each row is one station in one load case. s is measured along the unloaded arm, from its base; empty is the tip.\n\
         # {}. Leave a cell empty where nothing was measured.\n\
         # The first row of a case has its loads: any key of the arm file, with its unit. sd is a standard deviation.\n\
         # Other columns of measurements: {}.\n",
        arm.name.escape_debug(),
        if in_space { IN_SPACE } else { IN_PLANE },
        if in_space { OTHERS_IN_SPACE } else { OTHERS_IN_PLANE },
    );
    let mut heads = vec!["case".to_owned()];
    heads.extend((0..arm.cables.len()).map(|c| {
        let commanded = arm.cables[c].stroke.is_some();
        if commanded { format!("cable_{c}_stroke_mm") } else { format!("cable_{c}_tension_N") }
    }));
    let measured: &[&str] = if in_space {
        &["offset_b_mm", "offset_c_mm", "x_mm", "y_mm", "z_mm", "sd_position_mm"]
    } else {
        &["x_mm", "y_mm", "angle_deg", "sd_position_mm", "sd_angle_deg"]
    };
    heads.extend(["flow_speed_m_s", "s_mm"].iter().chain(measured).map(|head| (*head).to_owned()));
    let mut rows = Rows::new(&heads);
    for case in ["a", "b"] {
        for quarter in 1..=4 {
            let loads = |cable: &hydrostat::Cable| cable.stroke.map_or(cable.tension, rounded_mm).to_string();
            let mut cells = vec![case.to_owned()];
            let first = quarter == 1;
            cells.extend(arm.cables.iter().map(|cable| if first { loads(cable) } else { String::new() }));
            cells.push(if first { arm.flow.speed.to_string() } else { String::new() });
            cells.push(rounded_mm(0.25 * f64::from(quarter) * arm.length).to_string());
            let of = |head: &&str| match *head {
                sd if sd.starts_with("sd_") => "1",
                offset if offset.starts_with("offset_") => "0",
                _ => "",
            };
            cells.extend(measured.iter().map(|head| of(head).to_owned()));
            rows.row(&cells);
        }
    }
    out.push_str(&rows.text());
    out
}
