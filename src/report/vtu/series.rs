//! A time series of VTU files, for ParaView.

use std::path::{Path, PathBuf};

/// `block.vtu` → `block_0003.vtu`: where the bodies of a load step go.
#[must_use]
pub fn step_path(path: &Path, number: usize) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!("_{number:04}"));
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

/// The PVD file of a series: instants and the files beside it that show them.
#[must_use]
pub fn series(files: &[(f64, PathBuf)]) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n",
    );
    for (at, path) in files {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let name = name
            .replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('"', "&quot;");
        text += &format!("<DataSet timestep=\"{at:?}\" file=\"{name}\"/>\n");
    }
    text + "</Collection>\n</VTKFile>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_lists_the_files_beside_it_by_instant() {
        let path = step_path(Path::new("out/a.b.vtu"), 12);
        assert_eq!(path, Path::new("out/a.b_0012.vtu"));
        let text = series(&[(0.5, path)]);
        assert!(
            text.contains("<DataSet timestep=\"0.5\" file=\"a.b_0012.vtu\"/>"),
            "{text}"
        );
    }
}
