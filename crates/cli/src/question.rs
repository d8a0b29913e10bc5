//! A question before work that may not have been meant, where there is somebody to answer it.

use std::io::{self, BufRead, IsTerminal, Write};

/// Whether to go on: yes where nobody can be asked, because standard input or standard error is no terminal.
pub(crate) fn goes_on(question: &str) -> bool {
    if !io::stdin().is_terminal() || !io::stderr().is_terminal() {
        return true;
    }
    let mut out = io::stderr().lock();
    // What cannot be shown cannot be answered.
    if write!(out, "{question} Go on? [y/N] ").and_then(|()| out.flush()).is_err() {
        return true;
    }
    let mut answer = String::new();
    let read = io::stdin().lock().read_line(&mut answer);
    read.is_ok() && matches!(answer.trim().to_lowercase().as_str(), "y" | "yes")
}
