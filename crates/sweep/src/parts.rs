//! A sweep on its way: whole parts in a directory beside the output, and the plan that they are of.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use hydrostat_files::{remove_leftovers, write_whole};

use crate::error::{SweepError, read_error, write_error};

const PLAN: &str = "plan.json";

/// The directory of the parts, held for this process alone.
#[derive(Debug)]
pub(crate) struct Parts {
    directory: PathBuf,
    ending: &'static str,
    /// Locked as long as it is open.
    plan: File,
}

/// A part that is there.
#[derive(Debug, Clone)]
pub(crate) struct Part {
    pub(crate) path: PathBuf,
    /// Its rows that have an answer.
    pub(crate) answered: u64,
    /// CRC-32 of its bytes.
    sum: u32,
}

impl Part {
    /// Whether its bytes are those that were written: a full disk, a copy that was broken off or a repaired file system may have changed them since.
    ///
    /// # Errors
    /// [`SweepError::Read`].
    pub(crate) fn is_intact(&self) -> Result<bool, SweepError> {
        let failed = |error| read_error(&self.path, error);
        let mut file = File::open(&self.path).map_err(failed)?;
        let mut hasher = crc32fast::Hasher::new();
        let mut block = vec![0; 1 << 16];
        loop {
            match file.read(&mut block).map_err(failed)? {
                0 => return Ok(hasher.finalize() == self.sum),
                count => hasher.update(&block[..count]),
            }
        }
    }
}

/// Where the parts of a sweep into `output` are.
pub(crate) fn directory(output: &Path) -> PathBuf {
    let mut name = output.file_name().unwrap_or_default().to_owned();
    name.push(".parts");
    output.with_file_name(name)
}

impl Parts {
    /// Makes the directory, or with `resume` goes on with the one that is there.
    ///
    /// # Errors
    /// [`SweepError`] when it is there without `resume`, is of another `plan`, is in use or cannot be written.
    pub(crate) fn open(output: &Path, plan: &str, resume: bool, ending: &'static str) -> Result<Self, SweepError> {
        let directory = directory(output);
        let failed = |error| write_error(&directory, error);
        let path = directory.join(PLAN);
        if path.exists() {
            if !resume {
                return Err(if is_held(&path) {
                    SweepError::Locked { path: output.to_owned() }
                } else {
                    SweepError::Begun { directory }
                });
            }
        } else if !directory.is_dir() {
            // A directory of the output that is missing was misspelt.
            fs::create_dir(&directory).map_err(|error| write_error(output, error))?;
        }
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path).map_err(failed)?;
        // On a file system without locks nothing can be held.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(SweepError::Locked { path: output.to_owned() });
        }
        let mut found = String::new();
        file.read_to_string(&mut found).map_err(failed)?;
        let parts = Self { directory, ending, plan: file };
        if found.is_empty() {
            // New, or the process that made it ended before it could say what it is of.
            parts.clear()?;
            parts.note(plan)?;
        } else if found != plan {
            let what = difference(&found, plan);
            return Err(SweepError::Other { path: parts.directory, what });
        }
        parts.remove_temporary();
        remove_leftovers(output);
        Ok(parts)
    }

    fn note(&self, plan: &str) -> Result<(), SweepError> {
        let failed = |error| write_error(&self.directory, error);
        let mut file = &self.plan;
        file.write_all(plan.as_bytes()).and_then(|()| file.sync_all()).map_err(failed)
    }

    fn entries(&self) -> Result<Vec<(PathBuf, String)>, SweepError> {
        let entries = fs::read_dir(&self.directory).map_err(|error| write_error(&self.directory, error))?;
        Ok(entries.flatten().map(|entry| (entry.path(), entry.file_name().to_string_lossy().into_owned())).collect())
    }

    fn clear(&self) -> Result<(), SweepError> {
        for (path, name) in self.entries()? {
            if name != PLAN {
                fs::remove_file(&path).map_err(|error| write_error(&path, error))?;
            }
        }
        Ok(())
    }

    /// What a kill has left half-written.
    fn remove_temporary(&self) {
        for (path, _) in self.entries().unwrap_or_default().into_iter().filter(|(_, name)| name.starts_with('.')) {
            // What cannot be removed does not count either.
            let _ = fs::remove_file(path);
        }
    }

    /// The parts that are there, by their number, and how many were damaged, which are removed.
    pub(crate) fn present(&self, count: usize) -> Result<(Vec<Option<Part>>, u64), SweepError> {
        let (mut out, mut damaged) = (vec![None; count], 0);
        for (path, name) in self.entries()? {
            let Some((index, answered, sum)) = self.said(&name) else { continue };
            let Some(place) = out.get_mut(index) else { continue };
            let part = Part { path, answered, sum };
            if part.is_intact()? {
                *place = Some(part);
            } else {
                fs::remove_file(&part.path).map_err(|error| write_error(&part.path, error))?;
                damaged += 1;
            }
        }
        Ok((out, damaged))
    }

    /// Number, rows with an answer and sum, from the name of a part.
    fn said(&self, name: &str) -> Option<(usize, u64, u32)> {
        let mut numbers = name.strip_suffix(self.ending)?.strip_suffix('.')?.split('-');
        let said = (numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?);
        let sum = u32::from_str_radix(numbers.next()?, 16).ok()?;
        numbers.next().is_none().then_some((said.0, said.1, sum))
    }

    /// Writes a part, whole or not at all. Its name says how many of its rows have an answer, and the sum of its bytes.
    pub(crate) fn write(&self, index: usize, answered: u64, bytes: &[u8]) -> Result<Part, SweepError> {
        let sum = crc32fast::hash(bytes);
        let path = self.directory.join(format!("{index:06}-{answered}-{sum:08x}.{}", self.ending));
        write_whole(&path, bytes)?;
        Ok(Part { path, answered, sum })
    }

    /// Removes the directory, whose parts are joined.
    pub(crate) fn remove(self) -> Result<(), SweepError> {
        self.clear()?;
        let directory = self.directory.clone();
        let plan = directory.join(PLAN);
        drop(self);
        let removed = fs::remove_file(plan).and_then(|()| fs::remove_dir(&directory));
        removed.map_err(|error| write_error(&directory, error))
    }
}

/// Whether another process has the plan locked.
fn is_held(plan: &Path) -> bool {
    let file = OpenOptions::new().read(true).write(true).open(plan);
    file.is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
}

/// What two plans do not share, for a message.
pub(crate) fn difference(found: &str, plan: &str) -> &'static str {
    let [found, plan] = [found, plan].map(|text| serde_json::from_str::<serde_json::Value>(text).unwrap_or_default());
    let differs = |key: &str| found[key] != plan[key];
    let named = [
        ("version", "version of the program"),
        ("arm", "arm"),
        ("vary", "list of keys and values"),
        ("sample", "sample"),
        ("seed", "seed"),
        ("tol", "tolerance"),
        ("snap_distance", "bound of snaps"),
        ("snap_angle", "bound of snaps"),
        ("after_snap", "way of snaps"),
        ("columns", "list of columns"),
        ("shapes", "number of stations"),
        ("shard", "shard"),
    ];
    named.into_iter().find(|(key, _)| differs(key)).map_or("plan", |(_, words)| words)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::io;

    use super::*;
    use crate::column::{Column, Data};
    use crate::{csv_file, parquet_file};

    /// What a full disk answers is what the error says, through the Parquet library, too.
    #[test]
    fn a_full_disk_is_named() {
        let path = Path::new("/dev/full");
        let open = || OpenOptions::new().write(true).open(path).unwrap();
        let columns = [Column { name: "row".to_owned(), data: Data::Whole(Vec::new()) }];
        let errors = [
            csv_file::join(&[], &columns, path, open()).unwrap_err(),
            parquet_file::join(&[], &columns, &[], path, &mut open()).unwrap_err(),
        ];
        for error in errors {
            let SweepError::Write(write) = &error else { panic!("{error:?}") };
            assert_eq!(write.source.kind(), io::ErrorKind::StorageFull, "{error}");
            assert!(error.to_string().ends_with("make room, or choose another disk"), "{error}");
        }
    }
}
