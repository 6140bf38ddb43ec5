//! Files that are there whole or not at all.

use std::fs;
use std::path::Path;

use crate::error::Error;

/// Writes a file under another name first and then moves it to `path`, so that a failed
/// write leaves what stood there before.
///
/// # Errors
///
/// [`Error::Write`] with the path and what the system says.
pub fn replace_file(path: &Path, text: &str) -> Result<(), Error> {
    let refused = |reason: std::io::Error| Error::Write {
        path: path.display().to_string(),
        reason: reason.to_string(),
    };
    let mut partial = path.as_os_str().to_owned();
    partial.push(format!(".{}.partial", std::process::id()));
    let written = fs::write(&partial, text).and_then(|()| fs::rename(&partial, path));
    if written.is_err() {
        // Nothing is lost if this fails too: the first reason is the one to tell.
        let _ = fs::remove_file(&partial);
    }
    written.map_err(refused)
}
