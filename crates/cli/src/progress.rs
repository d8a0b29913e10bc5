//! How far the work is, on standard error where a person reads it.

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// One line that is written over and goes when the work is done. Silent unless standard error is a terminal.
pub(crate) struct Progress {
    shown: bool,
    last: Instant,
    terminal: bool,
}

impl Progress {
    pub(crate) fn new() -> Self {
        Self { shown: false, last: Instant::now(), terminal: io::stderr().is_terminal() }
    }

    /// Says where the work is, a few times a second.
    pub(crate) fn say(&mut self, text: impl FnOnce() -> String) {
        const PAUSE: Duration = Duration::from_millis(200);
        if self.terminal && self.last.elapsed() >= PAUSE {
            self.last = Instant::now();
            self.shown = true;
            write(&format!("\r\u{1b}[K{}", text()));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.shown {
            write("\r\u{1b}[K");
        }
    }
}

/// What cannot be shown is no failure.
fn write(text: &str) {
    let mut out = io::stderr().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}
