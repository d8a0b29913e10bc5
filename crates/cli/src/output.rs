//! Standard output and output files.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use hydrostat_figures::Scene;
use hydrostat_files::{WriteError, write_whole};

use crate::args::{Form, PageArgs, form};

/// The file that a result is written to; none where it is standard output, asked for as `-`.
pub(crate) fn file(path: &Path) -> Option<&Path> {
    (path != Path::new("-")).then_some(path)
}

/// Writes a result to standard output or to the file asked for instead.
pub(crate) fn put(path: Option<&Path>, text: &str) -> anyhow::Result<()> {
    match path.and_then(file) {
        Some(path) => write_whole(path, text.as_bytes())?,
        None => print(text)?,
    }
    Ok(())
}

/// Draws a figure into a file, whose ending says how.
pub(crate) fn draw(figure: &Scene, path: &Path, page: &PageArgs) -> anyhow::Result<()> {
    let bytes = match form(path) {
        Some(Form::Png) => figure.png()?,
        Some(Form::Pdf) => figure.pdf(),
        Some(Form::Svg) | None => svg(figure, page).into_bytes(),
    };
    Ok(write_whole(path, &bytes)?)
}

/// A figure as SVG, with its text as it is asked for.
pub(crate) fn svg(figure: &Scene, page: &PageArgs) -> String {
    if page.svg_text { figure.svg_with_text() } else { figure.svg() }
}

/// A text as a line of its own.
pub(crate) fn line(mut text: String) -> String {
    text.push('\n');
    text
}

/// Writes to standard output.
pub(crate) fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// Says before the work whether `path` can be written after it.
///
/// # Errors
/// The error that the write would give.
pub(crate) fn check_writable(path: &Path) -> Result<(), WriteError> {
    probe(path).map_err(|source| WriteError { path: path.to_owned(), source })
}

fn probe(path: &Path) -> io::Result<()> {
    if path.file_name().is_none() {
        return Err(io::ErrorKind::InvalidInput.into());
    }
    match fs::metadata(path) {
        Ok(present) if present.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
        Ok(present) if present.permissions().readonly() => return Err(io::ErrorKind::PermissionDenied.into()),
        // A device or a pipe is written straight; opening it twice could disturb its reader.
        Ok(present) if !present.is_file() => return Ok(()),
        Ok(_) | Err(_) => {}
    }
    let directory = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let probe: PathBuf = directory.join(format!(".hydrostat-{}.tmp", std::process::id()));
    OpenOptions::new().write(true).create_new(true).open(&probe)?;
    fs::remove_file(&probe)
}

/// Directories that were made for files to come, and go again, unless they are kept or hold something by then.
#[derive(Debug)]
pub(crate) struct MadeDirectory {
    /// The innermost first.
    made: Vec<PathBuf>,
}

impl MadeDirectory {
    /// What they were made for is done.
    pub(crate) fn keep(mut self) {
        self.made.clear();
    }
}

impl Drop for MadeDirectory {
    fn drop(&mut self) {
        for path in &self.made {
            // Fails where something is in it, which then stays.
            let _ = fs::remove_dir(path);
        }
    }
}

/// Makes the directory `path` if it is not there and says whether files can be made in it.
///
/// # Errors
/// [`WriteError`] with the directory.
pub(crate) fn make_directory(path: &Path) -> Result<MadeDirectory, WriteError> {
    if file(path).is_none() {
        let source = io::Error::new(io::ErrorKind::InvalidInput, "several files need a directory, not standard output");
        return Err(WriteError { path: path.to_owned(), source });
    }
    let missing = path.ancestors().take_while(|path| !path.as_os_str().is_empty() && !path.exists());
    let made = MadeDirectory { made: missing.map(Path::to_owned).collect() };
    fs::create_dir_all(path)
        .and_then(|()| probe(&path.join("fig1a.svg")))
        .map_err(|source| WriteError { path: path.to_owned(), source })?;
    Ok(made)
}
