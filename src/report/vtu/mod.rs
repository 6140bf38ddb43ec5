//! VTU files: the bodies and their contact surface, for ParaView and its kin.
//!
//! Points stand where they were before loading; warp them by `displacement`. In 2D all
//! vectors have `z = 0`. Tensors have VTK's order xx, yy, zz, xy, yz, xz.
//!
//! | bodies: array | at | what | Abaqus |
//! |---|---|---|---|
//! | `displacement` | points | displacement, in metre | `U` |
//! | `contact_force` | points | force of contacts on the body, on either side of a pair, in newton | `CFORCE` |
//! | `support_force` | points | force of supports on the body, in newton | `RF` |
//! | `stress` | points, cells | stress, in pascal | `S` |
//! | `von_mises` | points, cells | von Mises stress, in pascal | `MISES` |
//! | `principal_stress` | points, cells | principal stresses, the largest first, in pascal | `SP` |
//! | `strain` | cells | strain (the tensor: half of the angles), of heat too; 0 across plates in plane stress | `E` |
//! | `body` | points, cells | body, from 0 | |
//!
//! | contact surface: array | at | what | Abaqus |
//! |---|---|---|---|
//! | `displacement` | points | displacement, in metre | `U` |
//! | `pressure` | points | contact pressure ≥ 0, in pascal | `CPRESS` |
//! | `friction_traction` | points | friction on the body per area, a vector in global axes, in pascal | `CSHEAR` |
//! | `gap` | points | distance left to the other side, in metre | `COPEN` |
//! | `slip` | points | tangential displacement since the start of the load step, a vector in global axes, in metre | `CSLIP` |
//! | `state` | points, cells | 0 open, 1 slip, 2 stick, −1 no contact | `CSTATUS` |
//! | `body` | points, cells | body, from 0 | |
//! | `node` | points | node of its mesh, from 0 | |
//!
//! The last column names the arrays as Abaqus does, on request ([`abaqus_names`]).

mod body;
mod contact;
mod document;
mod image;
mod names;
mod series;

use std::path::{Path, PathBuf};

pub use body::{BodyFields, body_vtu};
pub use contact::contact_vtu;
pub use image::half_space_vti;
pub use names::abaqus_names;
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
