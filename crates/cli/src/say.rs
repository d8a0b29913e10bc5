//! What is said on standard error: the first word coloured on a terminal, and nothing where nobody reads any more.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};

use clap::builder::styling::{AnsiColor, Style};

const ERROR: (&str, Style) = ("error", AnsiColor::Red.on_default().bold());
const WARNING: (&str, Style) = ("warning", AnsiColor::Yellow.on_default().bold());
const NOTE: (&str, Style) = ("note", AnsiColor::Cyan.on_default().bold());
const TRY: (&str, Style) = ("try", AnsiColor::Green.on_default().bold());

pub(crate) fn error(text: impl Display) {
    // Several errors stand below each other, each with the word.
    let text = text.to_string();
    for one in text.split(MORE) {
        headed(ERROR, one);
    }
}

/// What stands between several errors in one message.
pub(crate) const MORE: &str = "\nerror: ";

pub(crate) fn warning(text: impl Display) {
    headed(WARNING, text);
}

pub(crate) fn note(text: impl Display) {
    headed(NOTE, text);
}

/// What may help.
pub(crate) fn advice(text: impl Display) {
    headed(TRY, text);
}

/// A line as it is.
pub(crate) fn line(text: impl Display) {
    write(&format!("{text}\n"));
}

fn headed((word, style): (&str, Style), text: impl Display) {
    if has_colours() {
        write(&format!("{style}{word}:{style:#} {text}\n"));
    } else {
        write(&format!("{word}: {text}\n"));
    }
}

/// On a terminal that knows colours, unless the environment says otherwise (<https://no-color.org>).
fn has_colours() -> bool {
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let is_dumb = std::env::var_os("TERM").is_some_and(|terminal| terminal == "dumb");
    io::stderr().is_terminal() && !is_set("NO_COLOR") && !is_dumb
}

/// A reader that has gone away has seen enough.
fn write(text: &str) {
    let mut out = io::stderr().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}
