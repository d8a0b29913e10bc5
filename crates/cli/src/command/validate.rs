//! `hydrostat validate`: every check again, as a report.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Mutex;

use hydrostat_files::write_whole;
use hydrostat_validate::{Listener, PeersFile, Report, Scope, html, markdown, run as validate};

use crate::args::ValidateArgs;
use crate::output;
use crate::progress::Progress;
use crate::request::{self, WrongRequest};

/// The report as a page, and as text.
const PAGE: &str = "index.html";
const TEXT: &str = "report.md";

pub(crate) fn run(args: &ValidateArgs) -> anyhow::Result<()> {
    let peers = match &args.peers {
        Some(path) => read_peers(path)?,
        None => PeersFile::committed()?,
    };
    let read = [args.peers.as_deref().map(|path| ("--peers", path))];
    for name in [PAGE, TEXT] {
        request::check_not_read(&read, "-o", &args.output.join(name))?;
    }
    output::make_directory(&args.output)?.keep();
    output::make_directory(&args.output.join("figures"))?.keep();
    let scope = if args.quick { Scope::Quick } else { Scope::Whole };
    let watch = Watch { state: Mutex::new((Progress::new(), String::new())) };
    let report = validate(scope, &peers, &watch);
    drop(watch);
    let page = write(&report, &args.output)?;
    output::print(&summary(&report, &page))?;
    anyhow::ensure!(report.holds(), "{} of {} checks do not hold; see {page}", report.failures(), report.checks());
    Ok(())
}

fn read_peers(path: &Path) -> anyhow::Result<PeersFile> {
    let wrong = |why: String| WrongRequest::Peers(path.to_owned(), why);
    let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
    Ok(PeersFile::parse(&text).map_err(|error| wrong(error.to_string()))?)
}

/// Writes all files and says where the page is.
fn write(report: &Report, directory: &Path) -> anyhow::Result<String> {
    let page = directory.join(PAGE);
    write_whole(&page, html(report).as_bytes())?;
    let text = markdown(report);
    write_whole(directory.join(TEXT), text.text.as_bytes())?;
    for (path, svg) in &text.figures {
        write_whole(directory.join(path), svg.as_bytes())?;
    }
    Ok(page.display().to_string())
}

/// Checks and failures of each section, and where to read on.
fn summary(report: &Report, page: &str) -> String {
    let mut out = String::new();
    for section in &report.sections {
        let (checks, failures) = (section.checks(), section.failures());
        let said = if failures == 0 { "hold".to_owned() } else { format!("{failures} FAIL") };
        let _ = writeln!(out, "{checks:5} checks  {said:8} {}", section.title);
    }
    let _ = writeln!(out, "{:5} checks, {} fail: {page}", report.checks(), report.failures());
    out
}

/// Says on standard error where the work is.
struct Watch {
    state: Mutex<(Progress, String)>,
}

impl Watch {
    fn say(&self, text: impl FnOnce(&str) -> String) {
        // A thread that panicked while it spoke leaves nothing that matters.
        let mut state = self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let (progress, part) = &mut *state;
        progress.say(|| text(part));
    }
}

impl Listener for Watch {
    fn begins(&self, part: usize, of: usize, title: &str) {
        self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner).1 = format!("{part} of {of}: {title}");
        self.say(str::to_owned);
    }

    fn advances(&self, done: usize, of: usize) {
        self.say(|part| format!("{part}, {done} of {of}"));
    }
}
