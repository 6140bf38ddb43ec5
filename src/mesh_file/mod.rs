//! MESH FILES: meshes as other programs write them.
//!
//! | format | ending | file |
//! |---|---|---|
//! | Gmsh 2.2 and 4.1, ASCII and binary | any other | `gmsh` |
//! | VTU, as ParaView and meshio write it | `.vtu` | `vtu` |
//! | Abaqus and CalculiX decks | `.inp` | `abaqus` |
//! | STL, triangles of a rigid surface | `.stl` | `stl` |

pub(crate) mod abaqus;
mod assemble;
mod elements;
pub mod gmsh;
pub(crate) mod stl;
pub mod vtu;

use std::path::Path;

use crate::body::Mesh;
use crate::error::Error;

/// Reads a mesh in the format that the ending of `name` says; `read` gives the bytes of a file that it
/// includes, by the name that stands in it.
///
/// # Errors
///
/// Those of [`gmsh::parse`] and [`vtu::parse`]; of a deck [`Error::Mesh`] with line and keyword.
pub fn parse(
    bytes: &[u8],
    name: &str,
    read: &dyn Fn(&str) -> Result<Vec<u8>, Error>,
) -> Result<Mesh, Error> {
    let ending = Path::new(name).extension().unwrap_or_default();
    match ending {
        ending if ending.eq_ignore_ascii_case("vtu") => vtu::parse(bytes, name),
        ending if ending.eq_ignore_ascii_case("inp") => abaqus::parse(bytes, name, read),
        _ => gmsh::parse(bytes, name),
    }
}
