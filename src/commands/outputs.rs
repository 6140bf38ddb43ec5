//! Files that commands write, looked at before any time goes into a solve. A hyphen is
//! standard input or output.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use dpana::report::{Table, replace_file};

/// What was typed, with the program's name in place of its path.
pub(super) fn command_line() -> String {
    let mut words: Vec<String> = std::env::args().collect();
    if let Some(program) = words.first_mut() {
        let name = Path::new(program.as_str()).file_name();
        *program = name.map_or_else(
            || "dpana".to_owned(),
            |name| name.to_string_lossy().into_owned(),
        );
    }
    words.join(" ")
}

/// Writes a text to a file, or to standard output.
pub(crate) fn write_output(path: &Path, text: &str) -> Result<(), dpana::Error> {
    if !is_standard(path) {
        return replace_file(path, text);
    }
    writeln!(io::stdout(), "{}", text.trim_end()).map_err(|error| dpana::Error::Write {
        path: "standard output".to_owned(),
        reason: error.to_string(),
    })
}

/// Writes a table, as JSON if the file ends so, else as CSV.
pub(crate) fn write_table(path: &Path, table: &Table) -> Result<(), dpana::Error> {
    match path.extension().is_some_and(|ending| ending == "json") {
        true => write_output(path, &table.to_json()),
        false => write_output(path, &table.to_csv()),
    }
}

/// Says a line to the user: on standard error where standard output is taken by one of the `outputs`.
pub(crate) fn say<'a>(
    outputs: impl IntoIterator<Item = &'a PathBuf>,
    line: &str,
) -> io::Result<()> {
    match outputs.into_iter().any(|path| is_standard(path)) {
        true => writeln!(io::stderr(), "{line}"),
        false => writeln!(io::stdout(), "{line}"),
    }
}

/// A hyphen in place of a file.
pub(crate) fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
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
    if is_standard(output) {
        return Ok(());
    }
    let refuse = |reason: &str| Err(format!("{option} {}: {reason}", output.display()));
    if output.is_dir() || output.file_name().is_none() {
        return refuse("is a folder; expected a file name");
    }
    if !folder(output).is_dir() {
        return refuse("its folder does not exist; expected an existing folder");
    }
    Ok(())
}

/// Refuses a hyphen where there are several files, or one that is written again after every step.
pub(crate) fn check_file(option: &str, output: &Path) -> Result<(), String> {
    match is_standard(output) {
        true => Err(format!(
            "{option} -: expected a file name, not standard output"
        )),
        false => Ok(()),
    }
}

/// Folder of a file; a bare name lies in the working folder.
fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
