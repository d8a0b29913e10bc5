//! The time methods: diagonally implicit Runge-Kutta methods that are L-stable and stiffly accurate.
//!
//! `RUNNING` has an explicit first stage and so stage order 2, which stretch and shear, stiff against bending, ask
//! for: with stage order 1 a large swing gains energy without bound. `STARTING` never looks at the slopes before it,
//! which a jump of a load makes useless, and takes the one step after it.

/// A diagonally implicit method: stage i has the slopes of stages 0 to i with the weights `a[i]`; the last stage is
/// the end of the step.
#[derive(Debug)]
pub(super) struct Tableau {
    /// Places of the stages in the step.
    pub(super) c: &'static [f64],
    pub(super) a: &'static [[f64; 6]],
    /// Weights of the step less those of the embedded method of order 3.
    pub(super) error: [f64; 6],
    /// The diagonal of the implicit stages.
    pub(super) gamma: f64,
    /// Whether the first stage is the end of the step before.
    pub(super) explicit_first: bool,
}

/// ESDIRK4(3)6L[2]SA: Kennedy, C. A. and Carpenter, M. H. (2003). Additive Runge-Kutta schemes for
/// convection-diffusion-reaction equations. Applied Numerical Mathematics 44, 139-181, the implicit half of
/// ARK4(3)6L[2]SA.
pub(super) static RUNNING: Tableau = Tableau {
    c: &[0.0, 0.5, 83.0 / 250.0, 31.0 / 50.0, 17.0 / 20.0, 1.0],
    a: &[
        [0.0; 6],
        [0.25, 0.25, 0.0, 0.0, 0.0, 0.0],
        [8611.0 / 62500.0, -1743.0 / 31250.0, 0.25, 0.0, 0.0, 0.0],
        [5_012_029.0 / 34_652_500.0, -654_441.0 / 2_922_500.0, 174_375.0 / 388_108.0, 0.25, 0.0, 0.0],
        [
            15_267_082_809.0 / 155_376_265_600.0,
            -71_443_401.0 / 120_774_400.0,
            730_878_875.0 / 902_184_768.0,
            2_285_395.0 / 8_070_912.0,
            0.25,
            0.0,
        ],
        [82_889.0 / 524_892.0, 0.0, 15_625.0 / 83_664.0, 69_875.0 / 102_672.0, -2260.0 / 8211.0, 0.25],
    ],
    error: [
        82_889.0 / 524_892.0 - 4_586_570_599.0 / 29_645_900_160.0,
        0.0,
        15_625.0 / 83_664.0 - 178_811_875.0 / 945_068_544.0,
        69_875.0 / 102_672.0 - 814_220_225.0 / 1_159_782_912.0,
        3_700_637.0 / 11_593_932.0 - 2260.0 / 8211.0,
        0.25 - 61_727.0 / 225_920.0,
    ],
    gamma: 0.25,
    explicit_first: true,
};

/// SDIRK4: Hairer, E. and Wanner, G. (1996). Solving Ordinary Differential Equations II, table 6.5.
pub(super) static STARTING: Tableau = Tableau {
    c: &[0.25, 0.75, 11.0 / 20.0, 0.5, 1.0],
    a: &[
        [0.25, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.5, 0.25, 0.0, 0.0, 0.0, 0.0],
        [17.0 / 50.0, -1.0 / 25.0, 0.25, 0.0, 0.0, 0.0],
        [371.0 / 1360.0, -137.0 / 2720.0, 15.0 / 544.0, 0.25, 0.0, 0.0],
        [25.0 / 24.0, -49.0 / 48.0, 125.0 / 16.0, -85.0 / 12.0, 0.25, 0.0],
    ],
    error: [25.0 / 24.0 - 59.0 / 48.0, 17.0 / 96.0 - 49.0 / 48.0, 125.0 / 16.0 - 225.0 / 32.0, 0.0, 0.25, 0.0],
    gamma: 0.25,
    explicit_first: false,
};

#[cfg(test)]
mod tests {
    use super::*;

    /// The conditions of order 4 of the step and of order 3 of the embedded method, and stage order 2 of the running
    /// method.
    #[test]
    fn tableaux_meet_their_order_conditions() {
        for tableau in [&RUNNING, &STARTING] {
            let s = tableau.c.len();
            let (a, c) = (tableau.a, tableau.c);
            let b = a[s - 1];
            let sum = |w: &[f64; 6], f: &dyn Fn(usize) -> f64| (0..s).map(|i| w[i] * f(i)).sum::<f64>();
            let through = |i: usize, f: &dyn Fn(usize) -> f64| (0..s).map(|j| a[i][j] * f(j)).sum::<f64>();
            for i in 0..s {
                assert!((through(i, &|_| 1.0) - c[i]).abs() < 1e-14, "row {i} of {tableau:?}");
                if tableau.explicit_first {
                    assert!((through(i, &|j| c[j]) - 0.5 * c[i] * c[i]).abs() < 1e-14, "row {i}");
                }
            }
            let embedded: [f64; 6] = std::array::from_fn(|i| b[i] - tableau.error[i]);
            for (w, order) in [(b, 4), (embedded, 3)] {
                let conditions: [(usize, f64, f64); 8] = [
                    (1, sum(&w, &|_| 1.0), 1.0),
                    (2, sum(&w, &|i| c[i]), 0.5),
                    (3, sum(&w, &|i| c[i] * c[i]), 1.0 / 3.0),
                    (3, sum(&w, &|i| through(i, &|j| c[j])), 1.0 / 6.0),
                    (4, sum(&w, &|i| c[i].powi(3)), 0.25),
                    (4, sum(&w, &|i| c[i] * through(i, &|j| c[j])), 0.125),
                    (4, sum(&w, &|i| through(i, &|j| c[j] * c[j])), 1.0 / 12.0),
                    (4, sum(&w, &|i| through(i, &|j| through(j, &|k| c[k]))), 1.0 / 24.0),
                ];
                for (of, got, want) in conditions {
                    assert!(of > order || (got - want).abs() < 1e-13, "order {of}: {got} {want}");
                }
            }
        }
    }
}
