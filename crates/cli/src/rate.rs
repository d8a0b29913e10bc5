//! How many rows are done, how fast, and how long the rest takes.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use crate::say;

/// A bar on a terminal, a line now and then elsewhere.
pub(crate) struct Rate {
    bar: ProgressBar,
    rows: u64,
    start: Instant,
    /// Rows that were there at the start, and when a line was last written.
    said: Mutex<(Option<u64>, Instant)>,
}

impl Rate {
    pub(crate) fn new(rows: u64) -> Self {
        let bar = ProgressBar::new(rows);
        let style =
            ProgressStyle::with_template("{bar:30} {percent}% {human_pos} of {human_len} rows, {speed}, {left} left");
        if let Ok(style) = style {
            // What cannot be shown is no failure.
            let left = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
                let _ = out.write_str(&duration(state.eta().as_secs_f64()));
            };
            let speed = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
                let _ = write!(out, "{:.0} rows/s", state.per_sec());
            };
            bar.set_style(style.with_key("left", left).with_key("speed", speed));
        }
        let start = Instant::now();
        Self { bar, rows, start, said: Mutex::new((None, start)) }
    }

    /// So many rows are done, those of an earlier run included.
    pub(crate) fn say(&self, done: u64) {
        const PAUSE: Duration = Duration::from_secs(30);
        let Ok(mut said) = self.said.lock() else { return };
        let resumed = *said.0.get_or_insert(done);
        if !self.bar.is_hidden() {
            if resumed > 0 && done == resumed {
                // What was there does not count as speed.
                self.bar.reset_eta();
            }
            self.bar.set_position(done);
        } else if said.1.elapsed() >= PAUSE {
            said.1 = Instant::now();
            let rate = (done - resumed.min(done)) as f64 / self.start.elapsed().as_secs_f64();
            let left = duration((self.rows - done.min(self.rows)) as f64 / rate);
            let percent = 100.0 * done as f64 / self.rows as f64;
            say::line(format_args!("{percent:.1} %, {done} of {} rows, {rate:.0} rows/s, {left} left", self.rows));
        }
    }

    pub(crate) fn end(&self) {
        self.bar.finish_and_clear();
    }

    /// What `rows` took, of which an earlier run had left `resumed`.
    pub(crate) fn summary(&self, rows: u64, resumed: u64) -> String {
        let seconds = self.start.elapsed().as_secs_f64();
        let solved = rows - resumed;
        if solved == 0 {
            return ", all there before".to_owned();
        }
        let before = if resumed == 0 { String::new() } else { format!(", {resumed} there before") };
        let took = if seconds < 60.0 { format!("{seconds:.1} s") } else { duration(seconds) };
        format!("{before}, {took}, {:.0} rows/s", solved as f64 / seconds)
    }
}

/// A time (s) in the two largest units that people use for it.
pub(crate) fn duration(seconds: f64) -> String {
    const UNITS: [(&str, f64); 5] =
        [("years", 365.25 * 86400.0), ("days", 86400.0), ("h", 3600.0), ("min", 60.0), ("s", 1.0)];
    if !seconds.is_finite() {
        return "an unknown time".to_owned();
    }
    let largest = UNITS.iter().position(|(_, size)| seconds >= *size).unwrap_or(UNITS.len() - 1);
    let (name, size) = UNITS[largest];
    let Some((smaller, part)) = UNITS.get(largest + 1) else {
        return format!("{:.0} {name}", (seconds / size).round());
    };
    let mut whole = (seconds / size).floor();
    let mut rest = ((seconds - whole * size) / part).round();
    if rest >= (size / part).round() {
        (whole, rest) = (whole + 1.0, 0.0);
    }
    let named = |count: f64, name: &str| {
        let one = count == 1.0 && name.len() > 3;
        format!("{count:.0} {}", if one { name.trim_end_matches('s') } else { name })
    };
    if rest == 0.0 { named(whole, name) } else { format!("{} {}", named(whole, name), named(rest, smaller)) }
}

#[cfg(test)]
mod tests {
    use super::duration;

    #[test]
    fn times_are_in_units_that_people_use() {
        for (seconds, words) in [
            (0.2, "0 s"),
            (59.0, "59 s"),
            (60.0, "1 min"),
            (90.0, "1 min 30 s"),
            (3599.0, "59 min 59 s"),
            (3600.0, "1 h"),
            (8000.0, "2 h 13 min"),
            (86400.0 + 7200.0, "1 day 2 h"),
            (1e7, "115 days 18 h"),
            (2e8, "6 years 123 days"),
            (f64::INFINITY, "an unknown time"),
            (f64::NAN, "an unknown time"),
        ] {
            assert_eq!(duration(seconds), words, "{seconds}");
        }
    }
}
