//! How long something takes that is done again and again.

use std::time::Instant;

/// Rounds before the first that is timed, which fill caches and let the clock rise.
const WARM_UP: usize = 5;

/// Times in microseconds, in rising order.
#[derive(Debug, Clone)]
pub(crate) struct Times(Vec<f64>);

impl Times {
    /// The least (0), a quartile (1 to 3) or the largest (4). Where others use the machine, the least says most of the work.
    pub(crate) fn quartile(&self, number: usize) -> f64 {
        self.0[(self.0.len() - 1) * number / 4]
    }
}

/// Times `solve` so many times, at least once. Before each, `back` brings `state` to its start, untimed. The last answer comes along.
pub(crate) fn timed<S, A, E>(
    repeats: usize,
    mut state: S,
    back: impl Fn(&mut S) -> Result<(), E>,
    solve: impl Fn(&mut S) -> Result<A, E>,
) -> Result<(Times, A), E> {
    let mut round = || -> Result<(f64, A), E> {
        back(&mut state)?;
        let clock = Instant::now();
        let answer = solve(&mut state)?;
        Ok((clock.elapsed().as_secs_f64() * 1e6, answer))
    };
    for _ in 0..WARM_UP {
        round()?;
    }
    let (first, mut answer) = round()?;
    let mut samples = vec![first];
    for _ in 1..repeats {
        let (us, last) = round()?;
        samples.push(us);
        answer = last;
    }
    samples.sort_by(f64::total_cmp);
    Ok((Times(samples), answer))
}
