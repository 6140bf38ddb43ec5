//! One mesh in every format that is read is the same mesh, and a damaged file is refused by its place.
//!
//! The files `F_*` were written by Gmsh, meshio and VTK (`tests/data/meshes/write_formats.py`). The
//! Gmsh file is the measure, as its reader is older than the others and shares no line with them.

use std::collections::BTreeMap;
use std::fs;

use dpana::body::{Group, Mesh};
use dpana::mesh_file;
use dpana::{Scene, Status, solve};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/meshes");

fn refuse(name: &str) -> Result<Vec<u8>, dpana::Error> {
    unreachable!("no file includes {name}")
}

fn read(name: &str) -> Mesh {
    let bytes = fs::read(format!("{FOLDER}/{name}")).unwrap();
    mesh_file::parse(&bytes, name, &refuse).unwrap()
}

/// A position that rounding leaves alone; meshio writes twelve digits.
fn place(mesh: &Mesh, node: usize) -> [i64; 3] {
    mesh.nodes[node].map(|x| (x * 1e9).round() as i64)
}

/// Cells by the places of their nodes in order.
fn cells(mesh: &Mesh) -> Vec<(String, Vec<[i64; 3]>)> {
    let places = |nodes: &[usize]| nodes.iter().map(|&node| place(mesh, node)).collect();
    let cells = mesh.cells();
    let mut cells: Vec<_> = cells
        .map(|cell| (format!("{:?}", cell.kind), places(cell.nodes)))
        .collect();
    cells.sort();
    cells
}

/// Places of the nodes of each cell or facet of a group, in any order of each.
fn members(mesh: &Mesh, name: &str) -> Vec<Vec<[i64; 3]>> {
    let Some(group) = mesh.groups.get(name) else {
        unreachable!("no group `{name}` among {:?}", mesh.groups.keys());
    };
    let of = |nodes: &[usize]| {
        let mut places: Vec<_> = nodes.iter().map(|&node| place(mesh, node)).collect();
        places.sort_unstable();
        places
    };
    let mut members: Vec<_> = match group {
        Group::Cells(cells) => cells
            .iter()
            .map(|&cell| of(mesh.cell(cell).nodes))
            .collect(),
        Group::Facets(facets) => facets.iter().map(|facet| of(&facet.nodes)).collect(),
        other => unreachable!("{other:?}"),
    };
    members.sort();
    members
}

/// Gmsh's names of the groups, and those of a file.
type Names = [&'static str; 3];
const GMSH: Names = ["left block", "right block", "base"];
const CAPITALS: Names = ["LEFT_BLOCK", "RIGHT_BLOCK", "BASE"];
/// meshio writes blanks within the names that it joins as underlines, and a deck knows no blanks.
const JOINED: Names = ["left_block", "right_block", "base"];
const CLOSED: Names = ["LEFTBLOCK", "RIGHTBLOCK", "BASE"];

#[test]
fn every_format_holds_the_mesh_that_gmsh_holds() {
    let files: BTreeMap<&str, &[(&str, Names)]> = BTreeMap::from([
        (
            "F_tets.msh",
            &[
                ("F_tets.inp", CAPITALS),
                ("F_tets_ascii.vtu", JOINED),
                ("F_tets_appended.vtu", JOINED),
            ][..],
        ),
        (
            "F_hexes.msh",
            &[
                ("F_hexes.inp", CAPITALS),
                ("F_hexes_meshio.inp", CLOSED),
                ("F_hexes_zlib.vtu", JOINED),
                ("F_hexes_appended.vtu", JOINED),
            ],
        ),
        (
            "F_plane.msh",
            &[("F_plane.inp", CAPITALS), ("F_plane_base64.vtu", JOINED)],
        ),
    ]);
    for (measure, others) in files {
        let measure = read(measure);
        for (name, names) in others {
            let found = read(name);
            assert_eq!(found.nodes.len(), measure.nodes.len(), "{name}");
            assert_eq!(cells(&found), cells(&measure), "{name}");
            for (own, of_gmsh) in names.iter().zip(GMSH) {
                let (own, of_gmsh) = (members(&found, own), members(&measure, of_gmsh));
                assert_eq!(own, of_gmsh, "{name}");
            }
        }
    }
}

/// The blocks under tension along x; held at x = 0, cut between them where `split` says so.
fn pulled(split: &str, contacts: &str) -> Scene {
    let text = format!(
        r#"{{ "bodies": [{{ "mesh": {{ "file": "F_hexes_zlib.vtu"{split} }},
            "materials": [{{ "young": 1000, "poisson": 0.0 }}],
            "supports": [{{ "group": "base", "displacement": [0, 0, 0] }}],
            "loads": [{{ "group": "right_block", "body_force": [-4, 0, 0] }}] }}],
          "contacts": [{contacts}] }}"#
    );
    Scene::from_json(&text, format!("{FOLDER}/scene.json")).unwrap()
}

#[test]
fn blocks_that_shared_nodes_press_each_other_once_they_are_split() {
    // A force of 4 per volume in the right block (volume 1) presses the common face, of area 1.
    let contact = r#"{ "group": "right_block.own", "against": { "group": "right_block.other" },
        "friction": 0.3 }"#;
    let scene = pulled(r#", "split": "right_block""#, contact);
    let solution = solve(&scene).unwrap();
    assert_eq!(solution.status(), Status::Certified);
    let report = solution.report().unwrap();
    assert!((report.totals.normal - 4.0).abs() < 1e-9);
    // Nothing else changes: at x = 2 the left block (length 2) is pressed by 4: u = −4 · 2 / 1000.
    let moved = solution.displacement_near(0, [2.0, 0.5, 0.5]).unwrap();
    assert!((moved[0] + 8e-3).abs() < 1e-12, "{moved:?}");
    let said = solve(&pulled(r#", "split": "base""#, contact)).unwrap_err();
    let said = said.to_string();
    assert!(
        said.contains("bodies[0].mesh") && said.contains("`right_block`"),
        "{said}"
    );
}

/// What reading a file says where `from` is replaced by `to`.
fn damaged(name: &str, from: &str, to: &str) -> String {
    let text = fs::read_to_string(format!("{FOLDER}/{name}")).unwrap();
    assert!(text.contains(from), "{name}: {from}");
    let text = text.replacen(from, to, 1);
    let found = mesh_file::parse(text.as_bytes(), name, &refuse);
    found.map(|mesh| mesh.nodes.len()).unwrap_err().to_string()
}

#[test]
fn damaged_vtu_files_are_refused_by_line_and_array() {
    let ascii = "F_tets_ascii.vtu";
    for (name, from, to, said) in [
        (ascii, "</Piece>", "", "no XML"),
        (
            ascii,
            "UnstructuredGrid\"",
            "PolyData\"",
            "of type PolyData",
        ),
        (
            ascii,
            "NumberOfCells=\"",
            "NumberOfCells=\"1",
            "numbers; expected",
        ),
        (
            ascii,
            "NumberOfPoints=\"",
            "NumberOfPoints=\"-",
            "a whole number",
        ),
        (ascii, "Name=\"types\"", "Name=\"kinds\"", "named `types`"),
        (
            ascii,
            "\n24\n24\n24\n",
            "\n42\n24\n24\n",
            "kind 42 (a polyhedron) is not read",
        ),
        (
            ascii,
            "format=\"ascii\"",
            "format=\"text\"",
            "format `text`",
        ),
        (
            "F_hexes_zlib.vtu",
            "vtkZLib",
            "vtkLZ4",
            "vtkLZ4DataCompressor",
        ),
        (
            "F_hexes_appended.vtu",
            "offset=\"0\"",
            "offset=\"99999999\"",
            "not in the file",
        ),
        (
            "F_hexes_appended.vtu",
            "encoding=\"base64\"",
            "encoding=\"hex\"",
            "raw or base64",
        ),
        (
            "F_hexes_appended.vtu",
            "LittleEndian",
            "BigEndian",
            "array `",
        ),
    ] {
        let found = damaged(name, from, to);
        assert!(
            found.contains(said) && found.contains(name),
            "{from}: {found}"
        );
    }
}

#[test]
fn damaged_decks_are_refused_as_meshes_too() {
    for (from, to, said) in [
        ("type=C3D20", "type=C3D15", "expected 15 of C3D15"),
        ("*NODE", "*NGEN\n*NODE", "*NGEN"),
        (
            "*ELSET,ELSET=base\n",
            "*ELSET,ELSET=base\n999999,",
            "element 999999 is not",
        ),
    ] {
        let found = damaged("F_hexes.inp", from, to);
        assert!(
            found.contains(said) && found.contains("F_hexes.inp:"),
            "{found}"
        );
    }
}
