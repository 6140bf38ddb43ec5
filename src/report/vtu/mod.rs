//! VTU files: the bodies and their contact surface, for ParaView and its kin.
//!
//! Points stand where they were before loading; warp them by `displacement`. In 2D all
//! vectors have `z = 0`. Tensors have VTK's order xx, yy, zz, xy, yz, xz.

mod body;
mod contact;
mod document;
mod image;
mod series;

use std::path::{Path, PathBuf};

pub use body::{BodyFields, body_vtu};
pub use contact::contact_vtu;
pub use image::half_space_vti;
pub use series::{series, step_path};

/// `block.vtu` → `block_contact.vtu`: where the contact surface goes when the bodies go to `path`.
#[must_use]
pub fn contact_path(path: &Path) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push("_contact");
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_contact_surface_goes_beside_the_bodies() {
        assert_eq!(
            contact_path(Path::new("out/a.b.vtu")),
            Path::new("out/a.b_contact.vtu")
        );
        assert_eq!(contact_path(Path::new("plain")), Path::new("plain_contact"));
    }
}
