//! Files that are there whole or not at all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::error::Error;

/// Writes a file under another name first and then moves it to `path`, so that a failed
/// write leaves what stood there before. A link stays one: the file it leads to is replaced. What is
/// no file (a pipe, a device) is written to.
///
/// # Errors
///
/// [`Error::Write`] with the path and what the system says.
pub fn replace_file(path: &Path, content: &(impl AsRef<[u8]> + ?Sized)) -> Result<(), Error> {
    let written = match place(path) {
        Place::File(file) => replace(&file, content.as_ref()),
        Place::Stream => fs::write(path, content),
    };
    written.map_err(|reason| Error::Write {
        path: path.display().to_string(),
        reason: reason.to_string(),
    })
}

/// Where a text goes.
enum Place {
    /// A file, or nothing yet, that a new one takes the place of.
    File(PathBuf),
    /// What only takes what is written into it.
    Stream,
}

fn place(path: &Path) -> Place {
    match (fs::metadata(path), fs::symlink_metadata(path)) {
        (Ok(found), _) if !found.is_file() && !found.is_dir() => Place::Stream,
        // A link to nothing: the file that it names is made.
        (Err(_), Ok(_)) => Place::Stream,
        (Ok(_), Ok(found)) if found.is_symlink() => match fs::canonicalize(path) {
            Ok(file) => Place::File(file),
            Err(_) => Place::Stream,
        },
        _ => Place::File(path.to_owned()),
    }
}

fn replace(path: &Path, content: &[u8]) -> io::Result<()> {
    let mut partial = path.as_os_str().to_owned();
    partial.push(format!(".{}.partial", std::process::id()));
    let written = fs::write(&partial, content).and_then(|()| fs::rename(&partial, path));
    if written.is_err() {
        // Nothing is lost if this fails too: the first reason is the one to tell.
        let _ = fs::remove_file(&partial);
    }
    written
}
