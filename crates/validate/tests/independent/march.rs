//! Initial-value problems by extrapolation of the modified midpoint rule (Gragg, Bulirsch, Stoer; Hairer, Norsett and Wanner,
//! "Solving Ordinary Differential Equations I", II.9), of order 14, with steps that end where a switch changes its sign.

/// Substeps of the midpoint rule, one column after the other.
const SUBSTEPS: [usize; 7] = [2, 4, 6, 8, 10, 12, 14];

/// An initial-value problem with `N` unknowns.
pub(crate) trait Motion<const N: usize> {
    /// Slopes; `None` where there are none.
    fn slopes(&mut self, t: f64, y: &[f64; N]) -> Option<[f64; N]>;

    /// What an error of each unknown is measured by.
    fn scale(&self, y: &[f64; N]) -> [f64; N];

    /// Slopes are smooth between changes of sign of these.
    fn switches(&mut self, _t: f64, _y: &[f64; N]) -> Vec<f64> {
        Vec::new()
    }

    /// Whether to give up.
    fn lost(&self, _y: &[f64; N]) -> bool {
        false
    }
}

fn step<const N: usize>(motion: &mut impl Motion<N>, t: f64, y: &[f64; N], h: f64) -> Option<([f64; N], f64)> {
    let start = motion.slopes(t, y)?;
    let mut table: Vec<[f64; N]> = Vec::with_capacity(SUBSTEPS.len());
    let mut error = f64::INFINITY;
    for (row, count) in SUBSTEPS.iter().enumerate() {
        let own = h / *count as f64;
        let (mut before, mut here) = (*y, *y);
        for k in 0..N {
            here[k] += own * start[k];
        }
        for i in 1..*count {
            let slopes = motion.slopes(t + own * i as f64, &here)?;
            for k in 0..N {
                (before[k], here[k]) = (here[k], before[k] + 2.0 * own * slopes[k]);
            }
        }
        let last = motion.slopes(t + h, &here)?;
        let mut new = [0.0; N];
        for k in 0..N {
            new[k] = 0.5 * (here[k] + before[k] + own * last[k]);
        }
        // Aitken and Neville in h^2.
        let mut old = std::mem::take(&mut table);
        table.push(new);
        for column in 1..=row {
            let ratio = (*count as f64 / SUBSTEPS[row - column] as f64).powi(2);
            let (finer, coarser) = (table[column - 1], old[column - 1]);
            let mut next = [0.0; N];
            for k in 0..N {
                next[k] = finer[k] + (finer[k] - coarser[k]) / (ratio - 1.0);
            }
            table.push(next);
        }
        old.clear();
        if row > 0 {
            let (best, second) = (table[row], table[row - 1]);
            let scale = motion.scale(&best);
            error = (0..N).map(|k| (best[k] - second[k]).abs() / scale[k]).fold(0.0, f64::max);
        }
    }
    Some((*table.last()?, error))
}

/// From `from` to `to`; `None` where slopes are missing or the motion is lost.
pub(crate) fn march<const N: usize>(
    motion: &mut impl Motion<N>,
    from: f64,
    to: f64,
    start: [f64; N],
    tol: f64,
) -> Option<[f64; N]> {
    let (mut t, mut y) = (from, start);
    let whole = to - from;
    let mut h = 0.05 * whole;
    let mut refused = 0;
    let mut switches = motion.switches(t, &y);
    for _ in 0..20_000 {
        let left = to - t;
        if left.abs() <= 1e-15 * whole.abs() {
            return Some(y);
        }
        let last = h.abs() >= left.abs();
        let own = if last { left } else { h };
        let Some((new, error)) = step(motion, t, &y, own) else {
            if own.abs() < 1e-13 * whole.abs() {
                return None;
            }
            h = 0.25 * own;
            continue;
        };
        // Steps that get shorter and no better are as good as rounding lets them be.
        let rounding = refused > 6 && error < 1e3 * tol;
        if (error.is_nan() || error > tol) && !rounding && own.abs() > 1e-13 * whole.abs() {
            h = own * (0.8 * (tol / error).powf(1.0 / 13.0)).clamp(0.1, 0.7);
            if !error.is_finite() {
                h = 0.2 * own;
            }
            refused += 1;
            continue;
        }
        refused = 0;
        let there = motion.switches(t + own, &new);
        let crossed = |now: &[f64]| switches.iter().zip(now).any(|(before, now)| before * now < 0.0);
        if crossed(&there) && own.abs() > 1e-12 * whole.abs() {
            // End the step just past the first change of sign.
            let (mut low, mut high) = (0.0, own);
            let mut past = new;
            for _ in 0..60 {
                if (high - low).abs() <= 1e-13 * whole.abs() {
                    break;
                }
                let middle = 0.5 * (low + high);
                let (tried, _) = step(motion, t, &y, middle)?;
                if crossed(&motion.switches(t + middle, &tried)) {
                    (high, past) = (middle, tried);
                } else {
                    low = middle;
                }
            }
            (t, y) = (t + high, past);
            h = 0.05 * own;
        } else {
            (t, y) = (t + own, new);
            h = own * (0.8 * (tol / error.max(1e-30)).powf(1.0 / 13.0)).clamp(0.5, 4.0);
        }
        if motion.lost(&y) {
            return None;
        }
        switches = motion.switches(t, &y);
    }
    None
}

#[test]
fn a_pendulum_and_a_kinked_oscillator_are_marched_to_rounding() {
    struct Oscillator;
    impl Motion<2> for Oscillator {
        fn slopes(&mut self, _: f64, y: &[f64; 2]) -> Option<[f64; 2]> {
            // Another stiffness to the left: half periods pi and pi/2.
            Some([y[1], if y[0] > 0.0 { -y[0] } else { -4.0 * y[0] }])
        }
        fn scale(&self, _: &[f64; 2]) -> [f64; 2] {
            [1.0; 2]
        }
        fn switches(&mut self, _: f64, y: &[f64; 2]) -> Vec<f64> {
            vec![y[0]]
        }
    }
    let end = march(&mut Oscillator, 0.0, 3.0 * std::f64::consts::PI, [0.0, 1.0], 1e-13).unwrap();
    assert!(end[0].abs() < 1e-11 && (end[1] - 1.0).abs() < 1e-11, "{end:?}");
}
