//! Runs a target on inputs that are made at random, for as long as asked, and shows the smallest input that breaks it.
//!
//! | variable | |
//! |---|---|
//! | `HYDROSTAT_SEED` | a number from which all random inputs follow, of these targets and of the property tests; without, 0, and another each time in runs of targets that are longer than the default |
//! | `HYDROSTAT_FUZZ_SECONDS` | how long each target runs; 2 without |
//!
//! An hour of one target, and of all one after the other:
//!
//! ```text
//! HYDROSTAT_FUZZ_SECONDS=3600 cargo test --profile ci -p hydrostat-fuzz -- --nocapture arms
//! HYDROSTAT_FUZZ_SECONDS=600 cargo test --profile ci -p hydrostat-fuzz -- --nocapture --test-threads 1
//! ```

mod bytes;

use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngAlgorithm, RngSeed, TestCaseError, TestError, TestRng, TestRunner};

pub use bytes::{Bytes, mutations_of};

/// How long a target runs unless it is asked to run longer, s.
const SHORT: u64 = 2;

/// Cases between looks at the clock; as many are tried however long they take.
const AT_ONCE: u32 = 8;

fn asked(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

/// The number from which random inputs of tests follow: `HYDROSTAT_SEED`, or 0. `./test --seed` sets it.
///
/// # Panics
/// If `HYDROSTAT_SEED` is not a whole number: the tests would not draw what was asked for.
pub fn seed() -> u64 {
    given_seed().unwrap_or(0)
}

fn given_seed() -> Option<u64> {
    let text = std::env::var("HYDROSTAT_SEED").ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("HYDROSTAT_SEED is {text:?}, and not a whole number")))
}

/// A property test of so many cases, which follow from [`seed`]. What fails with a seed fails everywhere with it.
///
/// # Panics
/// As [`seed`].
pub fn property(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(seed()), failure_persistence: None, ..Config::default() }
}

/// Tries `check` on values of `strategy` until time is up, and prints how many there were.
///
/// # Panics
/// Where `check` panics or returns an error: with the seed, and the value, made as small as can be. As [`seed`].
pub fn fuzz<S: Strategy>(target: &str, strategy: &S, check: impl Fn(S::Value) -> Result<(), String>) {
    let long = asked("HYDROSTAT_FUZZ_SECONDS");
    let time = Duration::from_secs(long.unwrap_or(SHORT));
    let by_clock = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let seed = given_seed().unwrap_or_else(|| if long.is_some() { by_clock() } else { 0 });
    let start = Instant::now();
    let mut cases: u32 = 0;
    loop {
        let mut bytes = [0; 32];
        bytes[..8].copy_from_slice(&seed.to_le_bytes());
        bytes[8..12].copy_from_slice(&cases.to_le_bytes());
        let config = Config { cases: AT_ONCE, max_shrink_iters: 400, failure_persistence: None, ..Config::default() };
        // A runner counts its cases and does no more than these.
        let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &bytes));
        let outcome = runner.run(strategy, |value| check(value).map_err(TestCaseError::fail));
        cases += AT_ONCE;
        match outcome {
            Ok(()) => {}
            Err(TestError::Fail(why, value)) => {
                panic!("{target}, HYDROSTAT_SEED={seed}, within {cases} cases: {why}\n{value:#?}")
            }
            Err(TestError::Abort(why)) => panic!("{target}, HYDROSTAT_SEED={seed}: {why}"),
        }
        if start.elapsed() >= time {
            break;
        }
    }
    println!("fuzz: {target}: {cases} cases in {} s, seed {seed}", start.elapsed().as_secs());
}
