//! Files that appear whole or not at all.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// A file that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}; {}", .path.display(), advice(.path, .source))]
pub struct WriteError {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub source: io::Error,
}

/// What to do about it.
fn advice(path: &Path, error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => match directory(path) {
            // Some directories take no new files whatever one does.
            Some(parent) if !parent.is_dir() => {
                format!("make the directory {} first, or choose another path", parent.display())
            }
            _ => "choose another path".to_owned(),
        },
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "choose a path that you may write to".to_owned()
        }
        io::ErrorKind::IsADirectory => "name a file in that directory".to_owned(),
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "make room, or choose another disk".to_owned(),
        _ => "choose another path".to_owned(),
    }
}

/// Writes `bytes` to `path`, replacing what is there. The file appears whole or not at all: it is
/// written beside `path` under another name and then renamed. A device or pipe is written straight.
///
/// # Errors
/// [`WriteError`] with the path and what to do. No half-written file is left.
pub fn write_whole(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), WriteError> {
    let path = path.as_ref();
    write_whole_with(path, |file| file.write_all(bytes).map_err(|source| WriteError { path: path.to_owned(), source }))
}

/// [`write_whole`] of what `fill` writes, for what is not all in memory at once.
///
/// # Errors
/// That of `fill`, or what `E` makes of a [`WriteError`]. No half-written file is left but by a kill: see [`remove_leftovers`].
pub fn write_whole_with<E: From<WriteError>>(
    path: impl AsRef<Path>,
    fill: impl FnOnce(&mut File) -> Result<(), E>,
) -> Result<(), E> {
    let path = path.as_ref();
    let failed = |source| E::from(WriteError { path: path.to_owned(), source });
    let target = followed(path);
    let present = fs::metadata(&target).ok();
    match &present {
        Some(meta) if meta.is_dir() => return Err(failed(io::ErrorKind::IsADirectory.into())),
        Some(meta) if !meta.is_file() => {
            return fill(&mut OpenOptions::new().write(true).open(&target).map_err(failed)?);
        }
        _ => {}
    }
    let (temporary, mut file) = hidden_beside(&target).map_err(failed)?;
    let written = fill(&mut file).and_then(|()| {
        keep(&file, present.as_ref()).map_err(failed)?;
        drop(file);
        fs::rename(&temporary, &target).map_err(failed)
    });
    if written.is_err() {
        // The first error is the one to report; a leftover that cannot be removed adds nothing.
        let _ = fs::remove_file(&temporary);
    }
    written
}

/// Removes what was half-written of `path` when its writers were killed. For those who know that nobody writes it now.
pub fn remove_leftovers(path: impl AsRef<Path>) {
    let target = followed(path.as_ref());
    let Some(name) = target.file_name().map(OsStr::to_string_lossy) else { return };
    let is_leftover = |found: &str| {
        let numbers = found.strip_prefix('.').and_then(|rest| rest.strip_prefix(&*name)?.strip_prefix('.'));
        let numbers = numbers.and_then(|rest| rest.strip_suffix(".tmp")?.split_once('-'));
        numbers.is_some_and(|(process, count)| process.parse::<u32>().is_ok() && count.parse::<u32>().is_ok())
    };
    let entries = fs::read_dir(directory(&target).unwrap_or(Path::new(".")));
    for entry in entries.into_iter().flatten().flatten() {
        if is_leftover(&entry.file_name().to_string_lossy()) {
            // What cannot be removed is in nobody's way.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether two paths lead to the same file, by whatever names and links, symbolic or hard. Of files that are not there yet the places are
/// compared that they would have.
///
/// ```
/// use hydrostat_files::is_same_file;
///
/// let directory = tempfile::tempdir().unwrap();
/// let at = |name: &str| directory.path().join(name);
/// std::fs::write(at("a"), "").unwrap();
/// std::fs::hard_link(at("a"), at("b")).unwrap();
/// assert!(is_same_file(&at("a"), &at("b")) && is_same_file(&at("new"), &at("./new")));
/// assert!(!is_same_file(&at("a"), &at("new")));
/// ```
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    match [a, b].map(fs::metadata) {
        // Terminals, devices and pipes may be read and written.
        [Ok(own), Ok(other)] => own.is_file() && other.is_file() && is_one([a, b], [&own, &other]),
        _ => place(a) == place(b),
    }
}

/// Whether two files that are there are one.
#[cfg(unix)]
fn is_one(_: [&Path; 2], [a, b]: [&fs::Metadata; 2]) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

/// Whether two files that are there are one.
#[cfg(not(unix))]
fn is_one([a, b]: [&Path; 2], _: [&fs::Metadata; 2]) -> bool {
    same_file::is_same_file(a, b).unwrap_or(false)
}

/// The directory of a path without links, and the name in it.
fn place(path: &Path) -> (PathBuf, Option<&OsStr>) {
    let parent = directory(path).unwrap_or(Path::new("."));
    (fs::canonicalize(parent).unwrap_or_else(|_| parent.to_owned()), path.file_name())
}

/// Where a link leads, so that it keeps pointing where it did.
fn followed(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Puts a file that is full on the disk, with the permissions of the one that it replaces.
fn keep(file: &File, replaced: Option<&fs::Metadata>) -> io::Result<()> {
    if let Some(meta) = replaced {
        if meta.permissions().readonly() {
            return Err(io::ErrorKind::PermissionDenied.into());
        }
        file.set_permissions(meta.permissions())?;
    }
    file.sync_all()
}

/// A new file in the directory of `target`, under a name that nothing else has.
fn hidden_beside(target: &Path) -> io::Result<(PathBuf, File)> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let name = target.file_name().ok_or(io::ErrorKind::InvalidInput)?;
    loop {
        let mut hidden = OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}-{}.tmp", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
        let temporary = target.with_file_name(hidden);
        match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            Ok(file) => return Ok((temporary, file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}

fn directory(path: &Path) -> Option<&Path> {
    path.parent().filter(|p| !p.as_os_str().is_empty())
}
