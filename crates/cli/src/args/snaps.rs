//! How far an arm may snap on the way to its loads.

use clap::Args as ClapArgs;
use hydrostat::SnapBounds;

use super::reach::angle;

// As a doc comment this would replace the help of each command.
#[derive(Debug, ClapArgs)]
pub(crate) struct SnapArgs {
    /// Largest jump of the tip at a snap, relative to the arm's length; beyond it the verdict is a limit point
    #[arg(long, value_name = "FRACTION", default_value = "0.01", allow_hyphen_values = true)]
    pub(crate) snap_distance: f64,
    /// Largest turn of the tip at a snap: degrees, or a number with its unit
    #[arg(long, value_name = "ANGLE", default_value = "2 deg", value_parser = angle, allow_hyphen_values = true)]
    pub(crate) snap_angle: f64,
    /// Answer at the full loads however far the arm snaps on its way
    #[arg(long, conflicts_with_all = ["snap_distance", "snap_angle"])]
    pub(crate) follow_snaps: bool,
    /// Follow the motion after each snap until the arm rests, and answer at the full loads with the shape that follows
    #[arg(long, conflicts_with_all = ["snap_distance", "snap_angle", "follow_snaps"])]
    pub(crate) after_snap: bool,
}

impl SnapArgs {
    pub(crate) fn bounds(&self) -> SnapBounds {
        if self.follow_snaps {
            return SnapBounds::NONE;
        }
        if self.after_snap {
            return SnapBounds { distance: 0.0, angle: 0.0 };
        }
        SnapBounds { distance: self.snap_distance, angle: self.snap_angle }
    }
}
