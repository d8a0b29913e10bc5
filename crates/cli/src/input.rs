//! Standard input in place of a file, asked for as `-`.

use std::io::{self, Read};
use std::path::Path;

pub(crate) use crate::wrong_request::STANDARD_INPUT as NAME;
use crate::wrong_request::WrongRequest;

/// The most that is read, in bytes: as much as of the largest kind of file.
const MOST: u64 = 64 << 20;

/// Whether a path asks for standard input.
pub(crate) fn is_standard(path: impl AsRef<Path>) -> bool {
    path.as_ref() == Path::new("-")
}

/// The file that is read where `path` is given: of standard input the one that it comes from, if it comes from one.
pub(crate) fn source(path: &Path) -> &Path {
    if is_standard(path) { Path::new("/dev/stdin") } else { path }
}

/// Refuses standard input for two files: it is read once.
pub(crate) fn check_once(files: &[(&'static str, Option<&Path>)]) -> Result<(), WrongRequest> {
    let given: Vec<&'static str> =
        files.iter().filter(|(_, file)| file.is_some_and(is_standard)).map(|(name, _)| *name).collect();
    match given[..] {
        [first, second, ..] => Err(WrongRequest::InputTwice([first, second])),
        _ => Ok(()),
    }
}

/// All of it.
pub(crate) fn bytes() -> Result<Vec<u8>, WrongRequest> {
    let mut bytes = Vec::new();
    io::stdin()
        .lock()
        .take(MOST + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| WrongRequest::Input(error.to_string()))?;
    if bytes.len() as u64 > MOST {
        return Err(WrongRequest::Input(format!("expected at most {MOST} bytes, found more")));
    }
    Ok(bytes)
}

/// All of it as text.
pub(crate) fn text() -> Result<String, WrongRequest> {
    String::from_utf8(bytes()?).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        WrongRequest::Input(format!("expected UTF-8 text, found something else at byte {at}"))
    })
}
