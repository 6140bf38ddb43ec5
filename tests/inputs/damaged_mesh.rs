//! A damaged mesh file is refused or still a mesh, and never stops the program.

use dpana::mesh_file;
use dpana::mesh_file::gmsh;
use proptest::prelude::*;

const CUBE: &str = include_str!("../data/meshes/D_patch3d_4_3.msh");

/// A unit square in MSH 2.2, with a named line and a named surface.
const SQUARE: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
    $PhysicalNames\n2\n1 5 \"bottom\"\n2 6 \"body\"\n$EndPhysicalNames\n\
    $Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n\
    $Elements\n2\n1 1 2 5 1 1 2\n2 3 2 6 1 1 2 3 4\n$EndElements\n";

/// Replaces the word that starts at or behind a fraction of the text.
fn replace_word(text: &str, fraction: f64, word: &str) -> String {
    let at = (fraction * text.len() as f64) as usize;
    let start = text[at..]
        .find(|c: char| !c.is_whitespace())
        .map_or(text.len(), |skipped| at + skipped);
    let end = text[start..]
        .find(char::is_whitespace)
        .map_or(text.len(), |length| start + length);
    format!("{}{word}{}", &text[..start], &text[end..])
}

/// The other formats, and a binary file of Gmsh.
const FILES: [(&str, &[u8]); 7] = [
    ("a.inp", include_bytes!("../data/meshes/F_hexes.inp")),
    (
        "b.inp",
        include_bytes!("../data/decks/own_blocks_c3d20.inp"),
    ),
    ("a.vtu", include_bytes!("../data/meshes/F_tets_ascii.vtu")),
    ("b.vtu", include_bytes!("../data/meshes/F_hexes_zlib.vtu")),
    (
        "c.vtu",
        include_bytes!("../data/meshes/F_tets_appended.vtu"),
    ),
    (
        "d.vtu",
        include_bytes!("../data/meshes/F_hexes_appended.vtu"),
    ),
    ("a.msh", include_bytes!("../../examples/meshes/gears.msh")),
];

/// Bytes that are numbers, signs of each format, or nothing.
fn splinter() -> impl Strategy<Value = Vec<u8>> {
    prop_oneof![
        prop::collection::vec(any::<u8>(), 0..9),
        Just(b"-1".to_vec()),
        Just(b"18446744073709551615".to_vec()),
        Just(b"99999999999".to_vec()),
        Just(b"\n*ELEMENT, TYPE=C3D4\n1,1,1,1,1\n".to_vec()),
        Just(b"*INCLUDE, INPUT=a.inp\n".to_vec()),
        Just(b"\">".to_vec()),
        Just(b"</DataArray>".to_vec()),
        Just(b"=".to_vec()),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn other_formats_gone_wrong_never_break_the_reader(
        file in 0..FILES.len(),
        fraction in 0.0..1.0,
        gone in 0..40_usize,
        splinter in splinter(),
        cut in any::<bool>(),
    ) {
        let (name, bytes) = FILES[file];
        let at = (fraction * bytes.len() as f64) as usize;
        let rest = if cut { bytes.len() } else { (at + gone).min(bytes.len()) };
        let bytes = [&bytes[..at], &splinter, &bytes[rest..]].concat();
        let none = |file: &str| Err(dpana::Error::Empty { place: file.to_owned() });
        if let Ok(mesh) = mesh_file::parse(&bytes, name, &none) {
            for cell in mesh.cells() {
                prop_assert!(cell.nodes.iter().all(|&node| node < mesh.nodes.len()));
            }
        }
    }
}

proptest! {
    #[test]
    fn a_word_gone_wrong_never_breaks_the_reader(
        solid in any::<bool>(),
        fraction in 0.0..1.0,
        word in prop_oneof![
            Just(""), Just("0"), Just("-1"), Just("18446744073709551615"), Just("nan"),
            Just("$EndNodes"), Just("é\u{0}"), Just("2147483648"), Just("-2147483648"), Just("\n"),
        ],
    ) {
        let text = replace_word(if solid { CUBE } else { SQUARE }, fraction, word);
        if let Ok(mesh) = gmsh::parse(&text, "damaged.msh") {
            for cell in mesh.cells() {
                prop_assert!(cell.nodes.iter().all(|&node| node < mesh.nodes.len()));
            }
        }
    }

    #[test]
    fn bytes_gone_wrong_never_break_the_reader(
        at in 0..SQUARE.len(),
        byte in any::<u8>(),
    ) {
        let mut bytes = SQUARE.as_bytes().to_vec();
        bytes[at] = byte;
        if let Ok(mesh) = gmsh::parse(&bytes, "damaged.msh") {
            prop_assert!(mesh.cell_count() <= 1);
        }
    }
}
