//! Binary Gmsh files hold the same mesh as ASCII ones, and damaged ones are refused by their place.

use std::fs;
use std::time::{Duration, Instant};

use dpana::body::Mesh;
use dpana::mesh_file::gmsh;

/// Two triangles in MSH 4.1: a line in two groups, one of them reversed, and a parametric node.
const TRIANGLES: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n\
    $PhysicalNames\n2\n1 4 \"bottom\"\n2 1 \"body\"\n$EndPhysicalNames\n\
    $Entities\n1 1 1 0\n1 0 0 0 1 7\n1 0 0 0 1 0 0 2 -4 6 2 1 -1\n\
    1 0 0 0 1 1 0 1 1 1 -1\n$EndEntities\n\
    $Nodes\n2 4 2 9\n0 1 0 1\n2\n0 0 0\n1 1 1 3\n5\n9\n7\n1 0 0 0.5\n0 1 0 0.25\n1 1 0 0.125\n\
    $EndNodes\n\
    $Elements\n3 4 1 4\n0 1 15 1\n1 2\n1 1 1 1\n2 2 5\n2 1 2 2\n3 2 5 9\n4 5 7 9\n$EndElements\n";

/// The numbers of a binary file.
struct Bytes {
    bytes: Vec<u8>,
    big: bool,
}

impl Bytes {
    fn number<const N: usize>(&mut self, little: [u8; N]) {
        let mut bytes = little;
        if self.big {
            bytes.reverse();
        }
        self.bytes.extend(bytes);
    }

    /// Words of a line in the types that `types` lists, whose last one holds for all further words.
    fn line(&mut self, line: &str, types: &str) {
        let mut types = types.chars();
        let mut last = 'i';
        for word in line.split_whitespace() {
            last = types.next().unwrap_or(last);
            match last {
                'i' => self.number(word.parse::<i32>().unwrap().to_le_bytes()),
                's' => self.number(word.parse::<u64>().unwrap().to_le_bytes()),
                _ => self.number(word.parse::<f64>().unwrap().to_le_bytes()),
            }
        }
    }

    fn text(&mut self, line: &str) {
        self.bytes.extend(line.as_bytes());
        self.bytes.push(b'\n');
    }
}

/// The binary file that holds what an ASCII one does, in sections that the reader knows.
fn binary(text: &str, big: bool) -> Vec<u8> {
    let mut out = Bytes {
        bytes: Vec::new(),
        big,
    };
    let four = text.contains("\n4.1 0 8");
    let mut lines = text.lines();
    while let Some(head) = lines.next() {
        out.text(head);
        let section: Vec<&str> = lines
            .by_ref()
            .take_while(|l| !l.starts_with("$End"))
            .collect();
        match (head, four) {
            ("$MeshFormat", _) => {
                out.text(&section[0].replace(" 0 ", " 1 "));
                out.number(1_i32.to_le_bytes());
                out.text("");
            }
            ("$Entities", _) => entities(&section, &mut out),
            ("$Nodes", true) => blocks(&section, &mut out, true),
            ("$Elements", true) => blocks(&section, &mut out, false),
            ("$Nodes", false) => {
                out.text(section[0]);
                section[1..].iter().for_each(|line| out.line(line, "iddd"));
                out.text("");
            }
            ("$Elements", false) => elements(&section, &mut out),
            _ => section.iter().for_each(|line| out.text(line)),
        }
        out.text(&head.replace('$', "$End"));
    }
    out.bytes
}

fn entities(section: &[&str], out: &mut Bytes) {
    out.line(section[0], "s");
    let points: usize = section[0].split(' ').next().unwrap().parse().unwrap();
    for (at, line) in section[1..].iter().enumerate() {
        let (numbers, words) = (if at < points { 4 } else { 7 }, line.split_whitespace());
        let mut words: Vec<&str> = words.collect();
        let groups: usize = words[numbers].parse().unwrap();
        // The project's own meshes leave out the number of bounding entities.
        if at >= points && words.len() == numbers + 1 + groups {
            words.push("0");
        }
        let (position, groups) = ("d".repeat(numbers - 1), "i".repeat(groups));
        out.line(&words.join(" "), &format!("i{position}s{groups}si"));
    }
    out.text("");
}

/// Blocks of MSH 4.1: of nodes, first their tags, or of elements.
fn blocks(section: &[&str], out: &mut Bytes, nodes: bool) {
    out.line(section[0], "s");
    let mut lines = section[1..].iter();
    while let Some(block) = lines.next() {
        out.line(block, "iiis");
        let count: usize = block.split(' ').next_back().unwrap().parse().unwrap();
        lines
            .by_ref()
            .take(count)
            .for_each(|line| out.line(line, "s"));
        if nodes {
            lines
                .by_ref()
                .take(count)
                .for_each(|line| out.line(line, "d"));
        }
    }
    out.text("");
}

/// Elements of MSH 2.2 in blocks of the same type.
fn elements(section: &[&str], out: &mut Bytes) {
    out.text(section[0]);
    let rows: Vec<Vec<&str>> = section[1..]
        .iter()
        .map(|l| l.split(' ').collect())
        .collect();
    for block in rows.chunk_by(|one, two| one[1..3] == two[1..3]) {
        out.line(
            &format!("{} {} {}", block[0][1], block.len(), block[0][2]),
            "i",
        );
        for row in block {
            out.line(&format!("{} {}", row[0], row[3..].join(" ")), "i");
        }
    }
    out.text("");
}

fn read(bytes: &[u8]) -> Result<Mesh, String> {
    gmsh::parse(bytes, "part.msh").map_err(|error| error.to_string())
}

/// The texts of small meshes of either version.
fn small() -> [String; 2] {
    let mesh = gmsh::parse(TRIANGLES, "triangles.msh").unwrap();
    [gmsh::to_text(&mesh), TRIANGLES.to_owned()]
}

#[test]
fn a_binary_mesh_is_that_of_the_ascii_file_to_the_last_bit() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/meshes");
    let mut texts = small().to_vec();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "msh") {
            texts.push(fs::read_to_string(path).unwrap());
        }
    }
    assert!(texts.len() > 7);
    for text in texts {
        let mesh = gmsh::parse(&text, "ascii.msh").unwrap();
        for big in [false, true] {
            assert_eq!(read(&binary(&text, big)).unwrap(), mesh);
            // MSH 2.2 sorts the elements by groups: another mesh, of the same file in both forms.
            let two = gmsh::to_text(&mesh);
            let of_two = gmsh::parse(&two, "ascii.msh").unwrap();
            assert_eq!(read(&binary(&two, big)).unwrap(), of_two);
        }
    }
}

#[test]
fn sections_that_are_not_read_are_passed_over_whatever_their_bytes() {
    let bytes = binary(TRIANGLES, false);
    let mut more = b"$Periodic\n\xff\x00\n$\n\xfe$EndPeriodic\n".to_vec();
    more.splice(..0, bytes.iter().copied());
    assert_eq!(read(&more), read(&bytes));
}

#[test]
fn a_binary_file_that_is_cut_is_refused_wherever_it_stops() {
    for text in small() {
        for big in [false, true] {
            let bytes = binary(&text, big);
            for end in 0..bytes.len() - 1 {
                let said = read(&bytes[..end]).unwrap_err();
                assert!(said.starts_with("part.msh:"), "{end}: {said}");
            }
        }
    }
    let bytes = binary(TRIANGLES, false);
    let nodes = bytes
        .windows(7)
        .position(|word| word == b"$Nodes\n")
        .unwrap()
        + 7;
    // Four counts, a block's head of 20 bytes and the node's tag stand before the first position.
    let position = nodes + 32 + 20 + 8;
    let said = read(&bytes[..position + 11]).unwrap_err();
    let expected = format!(
        "byte {}: the file ends; expected a coordinate in 8 bytes",
        position + 8
    );
    assert!(said.ends_with(&expected), "{said}");
}

#[test]
fn a_byte_gone_wrong_never_breaks_the_reader() {
    for text in small() {
        for big in [false, true] {
            let whole = binary(&text, big);
            for at in 0..whole.len() {
                for mask in [0x01, 0x10, 0x80, 0xff] {
                    let mut bytes = whole.clone();
                    bytes[at] ^= mask;
                    if let Ok(mesh) = read(&bytes) {
                        let known = |node: &usize| *node < mesh.nodes.len();
                        assert!(mesh.cells().all(|cell| cell.nodes.iter().all(known)));
                    }
                }
            }
        }
    }
}

#[test]
fn counts_and_words_of_a_binary_header_are_checked() {
    let start = Instant::now();
    let replaced = |from: &[u8], to: &[u8]| {
        let mut bytes = binary(TRIANGLES, false);
        let at = bytes.windows(from.len()).position(|found| found == from);
        let at = at.unwrap();
        bytes.splice(at..at + from.len(), to.iter().copied());
        read(&bytes).unwrap_err()
    };
    let most = [0xff; 8];
    for (said, parts) in [
        (
            replaced(b"4.1 1 8", b"4.1 1 4"),
            ["part.msh:2:", "expected 8"],
        ),
        (
            replaced(b"8\n\x01\0\0\0", b"8\n\x02\0\0\0"),
            ["part.msh:3: byte 20: ", "[02, 00, 00, 00]"],
        ),
        (
            replaced(
                b"$Nodes\n\x02\0\0\0\0\0\0\0",
                &[b"$Nodes\n", &most[..]].concat(),
            ),
            ["is not a dimension from 0 to 3", "byte "],
        ),
        (
            replaced(
                b"$Entities\n\x01\0\0\0\0\0\0\0",
                &[b"$Entities\n", &most[..]].concat(),
            ),
            ["part.msh:", "byte "],
        ),
        (
            replaced(&0.25_f64.to_le_bytes(), &f64::NAN.to_le_bytes()),
            ["NaN is not a finite coordinate", "byte "],
        ),
    ] {
        for part in parts {
            assert!(said.contains(part), "`{part}` is not in: {said}");
        }
    }
    assert!(start.elapsed() < Duration::from_secs(5));
}
