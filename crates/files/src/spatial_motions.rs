//! Motions in space as JSON and CSV, by the names that equilibria in space have.

use hydrostat::{SpatialInstant, SpatialMotionStation, SpatialTip};

use crate::motions::{WORK_HEADS, motion_line, work_numbers};
use crate::spatial_results::TipOut;

/// The heads of a row of an arm in space with so many cables and so many stations, and with the equilibrium of the same
/// loads if `equilibrium`: those of [`spatial_motion_numbers`], then of [`spatial_place_numbers`] for each station, then
/// of [`spatial_equilibrium_numbers`].
pub fn spatial_motion_heads(cables: usize, stations: usize, equilibrium: bool) -> Vec<String> {
    let mut out: Vec<String> = ["t_s"].into_iter().chain(TipOut::COLUMNS).map(str::to_owned).collect();
    out.extend((0..cables).flat_map(|c| [format!("stroke_{c}_m"), format!("tension_{c}_N")]));
    let others = [
        "kinetic_energy_J",
        "strain_energy_J",
        "tip_vx_m_s",
        "tip_vy_m_s",
        "tip_vz_m_s",
        "base_force_x_N",
        "base_force_y_N",
        "base_force_z_N",
        "base_moment_x_Nm",
        "base_moment_y_Nm",
        "base_moment_z_Nm",
    ];
    out.extend(others.into_iter().chain(WORK_HEADS).map(str::to_owned));
    let of_place = ["s_m", "x_m", "y_m", "z_m", "a_x", "a_y", "a_z", "vx_m_s", "vy_m_s", "vz_m_s"];
    for k in 0..stations {
        out.extend(of_place.map(|head| format!("place_{k}_{head}")));
    }
    if equilibrium {
        let heads = ["x_m", "y_m", "z_m", "a_x", "a_y", "a_z", "distance"];
        out.extend(heads.map(|head| format!("equilibrium_{head}")));
    }
    out
}

/// One time of a motion in space as the numbers of a row, in the order of [`spatial_motion_heads`].
pub fn spatial_motion_numbers(at: &SpatialInstant) -> Vec<f64> {
    let mut out = vec![at.time];
    out.extend(TipOut::from(at.tip).numbers());
    out.extend(at.cables.iter().flat_map(|cable| [cable.stroke, cable.tension]));
    out.extend([at.kinetic_energy, at.strain_energy]);
    out.extend(at.tip_velocity.into_iter().chain(at.base_reaction.force).chain(at.base_reaction.moment));
    out.extend(work_numbers(&at.works));
    out
}

/// A station at one time as the numbers that a row has of it.
pub fn spatial_place_numbers(at: &SpatialMotionStation) -> [f64; 10] {
    let ([x, y, z], [a_x, a_y, a_z], [vx, vy, vz]) = (at.place, at.a, at.velocity);
    [at.s, x, y, z, a_x, a_y, a_z, vx, vy, vz]
}

/// The tip of the equilibrium under the loads of `at`, its place and director a, and how far the tip is from it over
/// the length (m); no numbers where there is none.
pub fn spatial_equilibrium_numbers(at: &SpatialInstant, equilibrium: Option<SpatialTip>, length: f64) -> [f64; 7] {
    equilibrium.map_or([f64::NAN; 7], |SpatialTip { x, y, z, a: [a_x, a_y, a_z], .. }| {
        let distance = (at.tip.x - x).hypot(at.tip.y - y).hypot(at.tip.z - z) / length;
        [x, y, z, a_x, a_y, a_z, distance]
    })
}

/// The heads of [`spatial_motion_shape_lines`].
pub const SPATIAL_MOTION_SHAPE_HEADS: &str = "t_s,s_m,x_m,y_m,z_m,a_x,a_y,a_z,b_x,b_y,b_z,c_x,c_y,c_z,nu,eta,zeta,\
    tau_per_m,kappa_per_m,mu_per_m,vx_m_s,vy_m_s,vz_m_s,omega_x_rad_s,omega_y_rad_s,omega_z_rad_s";

/// A whole shape in space at one time (s) as lines of CSV, one a station.
pub fn spatial_motion_shape_lines(time: f64, stations: &[SpatialMotionStation]) -> String {
    let line = |at: &SpatialMotionStation| {
        let numbers = [time, at.s].into_iter().chain(at.place).chain(at.a).chain(at.b).chain(at.c);
        motion_line(&numbers.chain(at.strains).chain(at.velocity).chain(at.omega).collect::<Vec<_>>())
    };
    stations.iter().map(line).collect()
}
