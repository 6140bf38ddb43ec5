//! Gmsh meshes: a reader of MSH 2.2 and 4.1, ASCII and binary, and a writer of 2.2, ASCII.
//!
//! ```text
//! $MeshFormat → $PhysicalNames → $Entities (4.1) → $Nodes → $Elements
//! ```
//!
//! The elements of the highest dimension are the cells. Physical groups become the
//! mesh's groups under their name, or under their number where they have none; a name
//! used in several dimensions gets the dimension appended (`wall.1d`, `wall.2d`).
//! Nodes that only construct the geometry are dropped, and lengths stay as they stand
//! in the file. A binary file may have either byte order, which it states itself; messages on it
//! name the byte, counted from 0. Format: Gmsh reference manual, "MSH file format".

mod fields;
mod lines;
mod names;
mod version2;
mod version4;
mod write;

use super::assemble;
use super::elements::Contents;
use crate::body::Mesh;
use crate::error::Error;
use lines::Lines;
pub use write::to_text;

/// The two versions of the format that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Version {
    /// MSH 2.2: an element carries its physical group.
    Two,
    /// MSH 4.1: an element carries its geometric entity, which carries the groups.
    Four,
}

/// Reads a mesh from text or bytes; `name` stands for the file in messages.
///
/// # Errors
///
/// [`Error::Mesh`] with the line, and in a binary file the byte: an ASCII file with bytes that are not
/// text, a truncated file, a version other than 2.2 and 4.1, counts that do not match, unknown tags, an
/// element that is neither linear nor quadratic, a plane mesh that does not lie in a plane
/// `z = constant`, no cell at all.
pub fn parse(content: impl AsRef<[u8]>, name: &str) -> Result<Mesh, Error> {
    let bytes = content.as_ref();
    let mut lines = Lines::new(bytes, name);
    let version = header(&mut lines)?;
    if !lines.binary() {
        check_text(bytes, name)?;
    }
    let mut contents = Contents::default();
    while let Some(section) = lines.section()? {
        match (section, version) {
            ("PhysicalNames", _) => names::read(&mut lines, &mut contents.names)?,
            ("Entities", Version::Four) => version4::entities(&mut lines, &mut contents)?,
            ("Nodes", Version::Two) => version2::nodes(&mut lines, &mut contents)?,
            ("Nodes", Version::Four) => version4::nodes(&mut lines, &mut contents)?,
            ("Elements", Version::Two) => version2::elements(&mut lines, &mut contents)?,
            ("Elements", Version::Four) => version4::elements(&mut lines, &mut contents)?,
            ("PartitionedEntities" | "ParametricNodes", _) => {
                return Err(lines.error(format!("section `${section}` is not read")));
            }
            _ => lines.skip(section)?,
        }
        lines.end(section)?;
    }
    assemble::mesh(&contents, version == Version::Two, &lines)
}

/// Refuses an ASCII file with bytes that are not text, even where its lines are passed over.
fn check_text(bytes: &[u8], name: &str) -> Result<(), Error> {
    let Err(broken) = std::str::from_utf8(bytes) else {
        return Ok(());
    };
    let at = broken.valid_up_to();
    Err(Error::Mesh {
        file: name.to_owned(),
        line: 1 + bytes[..at].iter().filter(|&&b| b == b'\n').count(),
        reason: format!(
            "byte {:#04x} is not text; expected text, as the file says that it is ASCII (file type 0)",
            bytes[at]
        ),
    })
}

/// Reads `$MeshFormat`, which comes first (after comments).
fn header(lines: &mut Lines<'_>) -> Result<Version, Error> {
    loop {
        match lines.section()? {
            Some("MeshFormat") => break,
            Some("Comments") => {
                lines.skip("Comments")?;
                lines.end("Comments")?;
            }
            Some(other) => {
                return Err(lines.error(format!("expected `$MeshFormat`, found `${other}`")));
            }
            None => return Err(lines.error("the file ends; expected `$MeshFormat`")),
        }
    }
    let mut fields = lines.fields(&"the format's version, file type and word size")?;
    let version = match fields.word("version")? {
        "2.2" => Version::Two,
        "4.1" => Version::Four,
        other => {
            return Err(lines.error(format!(
                "MSH version {} is not read; expected 2.2 or 4.1",
                fields::quote(other)
            )));
        }
    };
    match fields.word("file type")? {
        "0" => {}
        "1" => {
            let size = fields.word("word size")?;
            if size != "8" {
                return Err(lines.error(format!(
                    "numbers of {} bytes are not read from a binary file; expected 8",
                    fields::quote(size)
                )));
            }
            lines.read_order()?;
        }
        other => {
            return Err(lines.error(format!(
                "file type {} is not known; expected 0 (ASCII) or 1 (binary)",
                fields::quote(other)
            )));
        }
    }
    lines.end("MeshFormat")?;
    Ok(version)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::body::{CellKind, Facet, Group};

    /// Two triangles on a square at height 3; node 40 is the centre of an arc, without group.
    const SQUARE_2: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
        $PhysicalNames\n1\n1 5 \"the bottom\"\n$EndPhysicalNames\n\
        $Nodes\n5\n10 0 0 3\n20 2 0 3\n40 9 9 9\n30 2 2 3\n7000000000 0 2 3\n$EndNodes\n\
        $Elements\n5\n\
        1 15 2 0 1 40\n2 1 2 5 1 10 20\n3 2 2 7 1 10 20 30\n\
        4 2 2 0 1 10 30 7000000000\n5 15 2 8 1 30\n$EndElements\n";

    fn facet(nodes: &[usize]) -> Facet {
        Facet {
            nodes: nodes.to_vec(),
        }
    }

    fn reason(text: &str) -> (usize, String) {
        match parse(text, "part.msh") {
            Err(Error::Mesh { file, line, reason }) if file == "part.msh" => (line, reason),
            other => unreachable!("{other:?}"),
        }
    }

    #[test]
    fn cells_and_named_and_numbered_groups_come_out_of_msh_2() {
        // Tags 10, 20, 30, 7e9 become 0 to 3; tag 40 belongs to no cell and no group.
        let mesh = parse(SQUARE_2, "part.msh").unwrap();
        assert_eq!(mesh.dimension, 2);
        assert_eq!(mesh.nodes[3], [0.0, 2.0, 0.0]);
        assert_eq!(mesh.nodes.len(), 4);
        let cells: Vec<_> = mesh.cells().map(|cell| cell.nodes.to_vec()).collect();
        assert_eq!(cells, [vec![0, 1, 2], vec![0, 2, 3]]);
        assert_eq!(
            mesh.groups["the bottom"],
            Group::Facets(vec![facet(&[0, 1])])
        );
        assert_eq!(mesh.groups["7"], Group::Cells(vec![0]));
        assert_eq!(mesh.groups["8"], Group::Points(vec![2]));
        assert_eq!(mesh.groups.len(), 3);
    }

    #[test]
    fn quadratic_cells_come_with_the_nodes_between_their_corners() {
        // Corners 1 to 3 of a triangle, 4 to 6 between them; its lower side is a line of three nodes.
        let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
            $Nodes\n6\n1 0 0 0\n2 2 0 0\n3 0 2 0\n4 1 0 0\n5 1 1 0\n6 0 1 0\n$EndNodes\n\
            $Elements\n2\n1 8 2 5 1 1 2 4\n2 9 2 7 1 1 2 3 4 5 6\n$EndElements\n";
        let mesh = parse(text, "part.msh").unwrap();
        assert_eq!(mesh.cell(0).kind, CellKind::Tri6);
        assert_eq!(mesh.cell(0).nodes, [0, 1, 2, 3, 4, 5]);
        assert_eq!(mesh.groups["5"], Group::Facets(vec![facet(&[0, 1, 3])]));
        assert_eq!(
            mesh.orient(&[facet(&[1, 0, 3])]).unwrap(),
            [facet(&[0, 1, 3])]
        );
        assert!((mesh.volume(0) - 2.0).abs() < 1e-15);
        for (number, kind) in [
            (10, "Quad9"),
            (11, "Tet10"),
            (12, "Hex27"),
            (16, "Quad8"),
            (17, "Hex20"),
        ] {
            let (shape, nodes) = crate::mesh_file::elements::Shape::from_type(number).unwrap();
            let said = format!("{shape:?}");
            assert!(
                said.contains(kind) && kind.ends_with(&nodes.to_string()),
                "{said} {nodes}"
            );
        }
    }

    #[test]
    fn a_node_in_a_group_stays_even_where_no_cell_uses_it() {
        let text = SQUARE_2.replace("1 15 2 0 1 40", "1 15 2 9 1 40");
        let text = text.replace("40 9 9 9", "40 9 9 3");
        let mesh = parse(&text, "part.msh").unwrap();
        assert_eq!(mesh.nodes.len(), 5);
        assert_eq!(mesh.groups["9"], Group::Points(vec![3]));
    }

    #[test]
    fn a_cell_that_msh_2_repeats_for_its_second_group_is_one_cell() {
        let text = SQUARE_2.replace("5 15 2 8 1 30", "5 2 2 8 1 10 20 30");
        let mesh = parse(&text, "part.msh").unwrap();
        assert_eq!(mesh.cell_count(), 2);
        assert_eq!(mesh.groups["7"], mesh.groups["8"]);
        let same_group = SQUARE_2.replace("5 15 2 8 1 30", "5 2 2 7 1 10 20 30");
        let (line, reason) = reason(&same_group);
        assert_eq!((line, reason.contains("line 20")), (22, true), "{reason}");
    }

    #[test]
    fn one_name_for_a_line_and_a_surface_gets_the_dimension_appended() {
        let text = SQUARE_2.replace("1\n1 5 \"the bottom\"", "2\n1 5 \"wall\"\n2 7 \"wall\"");
        let mesh = parse(&text, "part.msh").unwrap();
        let names: Vec<_> = mesh.groups.keys().cloned().collect();
        assert_eq!(names, ["8", "wall.1d", "wall.2d"]);
    }

    #[test]
    fn msh_4_entities_may_belong_to_several_groups_and_be_reversed() {
        let text = "$MeshFormat\r\n4.1 0 8\r\n$EndMeshFormat\r\n\
            $Entities\n1 1 1 0\n1 0 0 0 0\n1 0 0 0 1 0 0 2 -4 6 0\n\
            1 0 0 0 1 1 0 1 5 1 -1\n$EndEntities\n\
            $Nodes\n2 3 2 9\n0 1 0 1\n2\n0 0 0\n1 1 1 2\n5\n9\n1 0 0 0.5\n0 1 0 0.25\n$EndNodes\n\
            $Elements\n2 2 1 2\n1 1 1 1\n1 2 5\n2 1 2 1\n2 2 5 9\n$EndElements\n\
            $Periodic\nnot read\n$EndPeriodic\n";
        let mesh = parse(text, "part.msh").unwrap();
        assert_eq!(mesh.nodes, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let line = Group::Facets(vec![facet(&[0, 1])]);
        assert_eq!((&mesh.groups["4"], &mesh.groups["6"]), (&line, &line));
        assert_eq!(mesh.groups["5"], Group::Cells(vec![0]));
    }

    #[test]
    fn the_projects_meshes_have_the_cells_of_their_names() {
        // Blocks of n × m (× k) cells; D holds two blocks of 7² and 5², of 4³ and 3³.
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/meshes/");
        for (file, kind, nodes, cells, contact) in [
            ("A_block_n32.msh", CellKind::Quad4, 33 * 33, 32 * 32, 32),
            ("B1_hertz_n32.msh", CellKind::Quad4, 33 * 33, 32 * 32, 32),
            ("B2_mindlin_n16.msh", CellKind::Quad4, 2 * 33 * 17, 1024, 32),
            ("C_cube_n8.msh", CellKind::Hex8, 729, 512, 64),
            ("D_patch2d_7_5.msh", CellKind::Quad4, 64 + 36, 49 + 25, 7),
            ("D_patch3d_4_3.msh", CellKind::Hex8, 125 + 64, 64 + 27, 16),
        ] {
            let bytes = std::fs::read(format!("{folder}{file}")).unwrap();
            let mesh = parse(&bytes, file).unwrap();
            assert_eq!((mesh.nodes.len(), mesh.cell_count()), (nodes, cells));
            assert!(mesh.cells().all(|cell| cell.kind == kind));
            let Group::Facets(facets) = &mesh.groups["contact"] else {
                unreachable!("contact is a surface")
            };
            assert_eq!(facets.len(), contact);
        }
    }

    #[test]
    fn a_truncated_file_is_an_error_wherever_it_stops() {
        for end in 0..SQUARE_2.len() - 1 {
            assert!(parse(&SQUARE_2[..end], "part.msh").is_err(), "{end}");
        }
    }

    #[test]
    fn wrong_numbers_are_refused_at_their_line() {
        for (from, to, line, said) in [
            ("2.2 0 8", "4.0 0 8", 2, "expected 2.2 or 4.1"),
            ("2.2 0 8", "2.2 1 8", 3, "expected the number 1"),
            ("$Nodes\n5", "$Nodes\n6", 15, "node 6 of 6"),
            ("$Nodes\n5", "$Nodes\n4", 14, "after the announced count"),
            (
                "$Nodes\n5",
                "$Nodes\n18446744073709551615",
                15,
                "expected node 6",
            ),
            ("30 2 2 3\n", "30 2 nan 3\n", 13, "`nan` is not a finite"),
            (
                "30 2 2 3\n",
                "30 2 1e999 3\n",
                13,
                "`1e999` is not a finite",
            ),
            ("30 2 2 3\n", "20 2 2 3\n", 14, "node 20 is listed twice"),
            (
                "30 2 2 3\n",
                "30 2 2 4\n",
                23,
                "node 30 of a plane mesh lies at z = 4",
            ),
            ("3 2 2 7 1 10", "3 2 2 7 1 11", 20, "node 11 is not listed"),
            ("3 2 2 7 1 10", "3 13 2 7 1 10", 20, "13 (prism of 18"),
            ("1 10 20 30\n", "1 10 20\n", 20, "the line ends"),
            ("1 10 20 30\n", "1 10 20 30 10\n", 20, "one word too many"),
        ] {
            let text = SQUARE_2.replace(from, to);
            let (at, reason) = reason(&text);
            assert!(at == line && reason.contains(said), "{at}: {reason}");
        }
    }

    #[test]
    fn bytes_that_are_not_text_are_an_error() {
        let mut bytes = SQUARE_2.as_bytes().to_vec();
        bytes[60] = 0xff;
        let error = parse(&bytes, "part.msh").unwrap_err().to_string();
        assert!(error.starts_with("part.msh:6: byte 0xff"), "{error}");
    }
}
