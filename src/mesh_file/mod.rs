//! MESH FILES: meshes as other programs write them.
//!
//! | format | file |
//! |---|---|
//! | Gmsh 2.2 and 4.1, ASCII and binary | `gmsh` |
//! | Abaqus and CalculiX decks | `abaqus` |
//! | STL, triangles of a rigid surface | `stl` |

pub(crate) mod abaqus;
pub mod gmsh;
pub(crate) mod stl;
