//! Files that commands write: looked at before any time goes into a solve.

use std::fs;
use std::path::Path;

use dpana::report::{Table, replace_file};

/// Writes a table, as JSON if the file ends so, else as CSV.
pub(crate) fn write_table(path: &Path, table: &Table) -> Result<(), dpana::Error> {
    match path.extension().is_some_and(|ending| ending == "json") {
        true => replace_file(path, &table.to_json()),
        false => replace_file(path, &table.to_csv()),
    }
}

/// Refuses an output file that could not be written or that would overwrite the scene.
pub(crate) fn check_output(option: &str, output: &Path, scene: &Path) -> Result<(), String> {
    check_writable(option, output)?;
    let same = |path: &Path| fs::canonicalize(path).ok();
    if same(output).is_some_and(|output| Some(output) == same(scene)) {
        return Err(format!(
            "{option} {}: would overwrite the scene; expected another file",
            output.display()
        ));
    }
    Ok(())
}

/// Refuses an output file that could not be written.
pub(crate) fn check_writable(option: &str, output: &Path) -> Result<(), String> {
    let refuse = |reason: &str| Err(format!("{option} {}: {reason}", output.display()));
    if output.is_dir() || output.file_name().is_none() {
        return refuse("is a folder; expected a file name");
    }
    if !folder(output).is_dir() {
        return refuse("its folder does not exist; expected an existing folder");
    }
    Ok(())
}

/// Folder of a file; a bare name lies in the working folder.
fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
