//! Files gone wrong: seeds of every reader with bytes, words and pieces changed at random are read or refused,
//! and none panics. `DPANA_MUTATION_SECONDS` says how long each reader is tried, in place of a second.

use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use dpana::deck::Deck;
use dpana::scene::MeshSource;
use dpana::{Error, Scene, mesh_file};

use crate::program::folder;

/// Words that stand in place of others.
const WORDS: [&[u8]; 20] = [
    b"",
    b"0",
    b"-1",
    b"1",
    b"3",
    b"1e308",
    b"-1e308",
    b"5e-324",
    b"nan",
    b"inf",
    b"4294967296",
    b"18446744073709551615",
    b"-9223372036854775808",
    b"\x00\x00\x00\x00",
    b"\xff\xff\xff\x7f",
    b"\xff\xff\xff\xff\xff\xff\xff\xff",
    b"\x00\x00\x80\x7f",
    b"\x00\x00\xc0\x7f",
    b"\n",
    b",",
];

/// Xorshift by Marsaglia, 64 bits.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % end.max(1)
    }

    /// A seed with one to eight changes.
    fn change(&mut self, seeds: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = seeds[self.below(seeds.len())].clone();
        for _ in 0..=self.below(8) {
            self.change_once(&mut bytes, seeds);
        }
        bytes
    }

    fn change_once(&mut self, bytes: &mut Vec<u8>, seeds: &[Vec<u8>]) {
        let at = self.below(bytes.len());
        let end = (at + 1 + self.below(16)).min(bytes.len());
        match self.below(8) {
            _ if bytes.is_empty() => bytes.push(b'*'),
            0 => bytes[at] ^= 1 << self.below(8),
            1 => bytes[at] = self.below(256) as u8,
            2 => drop(bytes.drain(at..end)),
            3 => bytes.truncate(at),
            4 => {
                let piece = bytes[at..end].to_vec();
                bytes.splice(at..at, piece);
            }
            5 => {
                let other = &seeds[self.below(seeds.len())];
                let from = self.below(other.len());
                let to = (from + self.below(200)).min(other.len());
                bytes.splice(at..end, other[from..to].iter().copied());
            }
            6 => {
                let word = WORDS[self.below(WORDS.len())];
                let end = (at + word.len()).min(bytes.len());
                bytes.splice(at..end, word.iter().copied());
            }
            _ => {
                // A whole word between blanks, commas or signs of equality.
                let apart = |byte: &u8| b" ,=\n\t<>\"".contains(byte);
                let start = bytes[..at]
                    .iter()
                    .rposition(apart)
                    .map_or(0, |before| before + 1);
                let length = bytes[at..].iter().position(apart);
                let end = length.map_or(bytes.len(), |length| at + length);
                bytes.splice(start..end, WORDS[self.below(WORDS.len())].iter().copied());
            }
        }
    }
}

/// All files of some folders of the repository that have one of these endings.
fn seeds(folders: &[&str], endings: &[&str]) -> Vec<Vec<u8>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let mut found = BTreeMap::new();
    for folder in folders {
        for file in fs::read_dir(root.join(folder)).unwrap() {
            let path: PathBuf = file.unwrap().path();
            if endings
                .iter()
                .any(|ending| path.to_string_lossy().ends_with(ending))
            {
                found.insert(path.clone(), fs::read(&path).unwrap());
            }
        }
    }
    let mut seeds: Vec<Vec<u8>> = found.into_values().collect();
    seeds.retain(|seed| seed.len() < 20_000);
    assert!(!seeds.is_empty(), "{folders:?}");
    seeds
}

/// Tries a reader on changed seeds for a while; a panic fails with the bytes beside the test's other files.
fn survive(name: &str, seeds: &[Vec<u8>], read: impl Fn(&[u8])) {
    let seconds = std::env::var("DPANA_MUTATION_SECONDS");
    let seconds = seconds.map_or(1.0, |seconds| seconds.parse().unwrap());
    let start = Instant::now();
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (mut count, mut slowest) = (0_u64, Duration::ZERO);
    while start.elapsed().as_secs_f64() < seconds {
        let bytes = random.change(seeds);
        let begun = Instant::now();
        if catch_unwind(AssertUnwindSafe(|| read(&bytes))).is_err() {
            let file = folder("mutations").join(name);
            fs::write(&file, &bytes).unwrap();
            unreachable!("input {count} of {name}, kept in {}", file.display());
        }
        (count, slowest) = (count + 1, slowest.max(begun.elapsed()));
    }
    assert!(
        slowest.as_secs_f64() < 10.0,
        "{name}: {slowest:?} of {count}"
    );
}

fn no_file(name: &str) -> Result<Vec<u8>, Error> {
    Err(Error::Empty {
        place: name.to_owned(),
    })
}

fn read_mesh(bytes: &[u8], name: &str) {
    let _ = mesh_file::parse(bytes, name, &no_file);
}

#[test]
fn gmsh_files_gone_wrong() {
    let seeds = seeds(&["fuzz/seeds/mesh", "data/meshes"], &[".msh"]);
    survive("changed.msh", &seeds, |bytes| {
        read_mesh(bytes, "changed.msh")
    });
}

#[test]
fn vtu_files_gone_wrong() {
    let seeds = seeds(&["fuzz/seeds/mesh", "data/meshes"], &[".vtu"]);
    survive("changed.vtu", &seeds, |bytes| {
        read_mesh(bytes, "changed.vtu")
    });
}

#[test]
fn decks_gone_wrong() {
    let seeds = seeds(
        &["fuzz/seeds/mesh", "fuzz/seeds/deck", "data/decks"],
        &[".inp"],
    );
    survive("changed.inp", &seeds, |bytes| {
        read_mesh(bytes, "changed.inp");
        let itself = |_: &str| Ok(bytes[..bytes.len().min(2000)].to_vec());
        let Ok(deck) = Deck::parse(bytes, "changed.inp", &itself) else {
            return;
        };
        let nodes = deck.scene.bodies.iter().map(|body| match &body.mesh {
            MeshSource::Given(mesh) => mesh.nodes.len(),
            _ => unreachable!("meshes of decks are in memory"),
        });
        if nodes.sum::<usize>() < 1000 {
            drop(deck.scene.mechanics());
        }
    });
}

#[test]
fn stl_files_gone_wrong() {
    let seeds = seeds(&["fuzz/seeds/stl"], &[".stl"]);
    let folder = folder("mutated_stl");
    let text = r#"{ "bodies": [{ "mesh": { "box": { "x": [0, 1], "y": [0, 1], "z": [0, 1], "cells": [1, 1, 1] } },
        "materials": [{ "young": 1000, "poisson": 0.3 }] }], "contacts": [{ "group": "bottom", "friction": 0.3,
        "obstacle": { "triangles": { "file": "part.stl" } } }] }"#;
    let scene = Scene::from_json(text, folder.join("scene.json")).unwrap();
    survive("changed.stl", &seeds, |bytes| {
        let mut bytes = bytes.to_vec();
        // Every other binary file counts its triangles right.
        if bytes.len() >= 84 && bytes.len().is_multiple_of(2) && !bytes.starts_with(b"solid") {
            let count = (bytes.len() - 84) / 50;
            bytes.truncate(84 + 50 * count);
            bytes[80..84].copy_from_slice(&(count as u32).to_le_bytes());
        }
        fs::write(folder.join("part.stl"), &bytes).unwrap();
        drop(scene.mechanics());
    });
}
