//! The numbers of the figures as CSV.

use std::fmt::Write as _;

use hydrostat::Configuration;

use super::{speed, tension};

const STATIONS: u32 = 201;

/// Places along an arm, m.
fn places(configuration: &Configuration) -> impl Iterator<Item = f64> + use<> {
    let length = configuration.arm.length;
    (0..STATIONS).map(move |k| length * f64::from(k) / f64::from(STATIONS - 1))
}

/// Shapes: one row a station, one block of rows an arm.
pub(super) fn shapes(configurations: &[Configuration]) -> String {
    let mut out = "T1_N,v_inf_m_per_s,s_m,x_m,y_m,theta_rad,alpha_rad,nu,beta,\
                   left_x_m,left_y_m,right_x_m,right_y_m\n"
        .to_owned();
    for c in configurations {
        for s in places(c) {
            let at = c.at(s);
            let [left, right] = c.surfaces(s);
            let _ = writeln!(
                out,
                "{:?},{:?},{:?},{:?},{:?},{:?},{:?},{:?},{:?},{:?},{:?},{:?},{:?}",
                tension(c),
                speed(c),
                s,
                at.x,
                at.y,
                at.theta,
                at.alpha,
                at.nu,
                at.beta,
                left[0],
                left[1],
                right[0],
                right[1]
            );
        }
    }
    out
}

/// Section rotation along the arm.
pub(super) fn angles(configurations: &[&Configuration]) -> String {
    let mut out = "T1_N,v_inf_m_per_s,s_m,alpha_deg\n".to_owned();
    for c in configurations {
        for s in places(c) {
            let _ = writeln!(out, "{:?},{:?},{:?},{:?}", tension(c), speed(c), s, c.at(s).alpha.to_degrees());
        }
    }
    out
}
