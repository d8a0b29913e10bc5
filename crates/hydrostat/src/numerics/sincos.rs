//! Sine and cosine of four angles at once, to about one unit in the last place.

use hydrostat_bvp::{LANES, Lanes};

/// Angles beyond this go to the library: their multiple of pi/2 would no longer be exact.
const FAR: f64 = 1e4;

/// pi/2 in three parts, the first two with 33 bits, so that small multiples of them are exact
/// (Cody and Waite; the parts are those of fdlibm).
const HALF_PI: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_7e-21];

/// Minimax polynomials on [-pi/4, pi/4], from fdlibm: sin r = r + r^3 P(r^2),
/// cos r = 1 - r^2/2 + r^4 Q(r^2).
const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Added to a number below 2^51, leaves its nearest whole number in the last bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Sine and cosine.
#[inline(always)]
pub(crate) fn sin_cos(x: Lanes) -> (Lanes, Lanes) {
    let (mut sin, mut cos) = (x, x);
    let mut near = true;
    for i in 0..LANES {
        let v = x.0[i];
        let shifted = v * std::f64::consts::FRAC_2_PI + ROUND;
        let turns = shifted - ROUND;
        let r = ((v - turns * HALF_PI[0]) - turns * HALF_PI[1]) - turns * HALF_PI[2];
        let z = r * r;
        let p = SINE[0] + z * (SINE[1] + z * (SINE[2] + z * (SINE[3] + z * (SINE[4] + z * SINE[5]))));
        let q = COSINE[0] + z * (COSINE[1] + z * (COSINE[2] + z * (COSINE[3] + z * (COSINE[4] + z * COSINE[5]))));
        let own_sin = r + r * z * p;
        let half = 0.5 * z;
        let rough = 1.0 - half;
        let own_cos = rough + ((1.0 - rough - half) + z * z * q);
        // The quarter turn says which of both is which, and their signs.
        let quarter = shifted.to_bits();
        let odd = 0_u64.wrapping_sub(quarter & 1);
        let (s, c) = (own_sin.to_bits(), own_cos.to_bits());
        let sign_sin = (quarter & 2) << 62;
        let sign_cos = (quarter.wrapping_add(1) & 2) << 62;
        sin.0[i] = f64::from_bits(((s & !odd) | (c & odd)) ^ sign_sin);
        cos.0[i] = f64::from_bits(((c & !odd) | (s & odd)) ^ sign_cos);
        near &= v.abs() <= FAR;
    }
    if near { (sin, cos) } else { by_library(x) }
}

#[cold]
#[inline(never)]
fn by_library(x: Lanes) -> (Lanes, Lanes) {
    (x.map(f64::sin), x.map(f64::cos))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(x: [f64; LANES]) {
        let (sin, cos) = sin_cos(Lanes(x));
        for i in 0..LANES {
            let (s, c) = x[i].sin_cos();
            assert!((sin.0[i] - s).abs() <= 2.0 * f64::EPSILON * s.abs() + 1e-20, "sin {}: {} {s}", x[i], sin.0[i]);
            assert!((cos.0[i] - c).abs() <= 2.0 * f64::EPSILON * c.abs() + 1e-20, "cos {}: {} {c}", x[i], cos.0[i]);
        }
    }

    #[test]
    fn agrees_with_the_library_to_the_last_places() {
        // Knuth's MMIX generator.
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for range in [1e-8, 1.0, 10.0, 1e3, 2e4] {
            for _ in 0..20_000 {
                check(std::array::from_fn(|_| range * random()));
            }
        }
    }

    #[test]
    fn holds_at_multiples_of_a_quarter_turn_and_beyond_its_own_range() {
        for k in -4000..4000 {
            let x = f64::from(k) * std::f64::consts::FRAC_PI_2;
            check([x, x + 1e-9, x - 1e-9, x * 1e6]);
        }
        let (sin, cos) = sin_cos(Lanes([0.0, f64::NAN, f64::INFINITY, 1e300]));
        assert!(sin.0[1].is_nan() && cos.0[1].is_nan() && sin.0[2].is_nan() && cos.0[2].is_nan());
        assert_eq!((sin.0[0], cos.0[0]), (0.0, 1.0));
        assert_eq!((sin.0[3], cos.0[3]), 1e300_f64.sin_cos());
    }
}
