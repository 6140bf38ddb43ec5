//! Whatever comes in: bad and hostile input is refused with place and cure, what ships is solved.
#![allow(clippy::unwrap_used)]

#[path = "../program/mod.rs"]
mod program;
#[path = "../stacks/mod.rs"]
mod stacks;

mod bad_input;
mod bad_pairs;
mod binary_mesh;
mod checked_scenes;
mod command_line;
mod damaged_mesh;
mod deck_keywords;
mod deck_loads;
mod decks;
mod hostile_input;
mod manners;
mod mesh_cures;
mod mesh_files;
mod models;
mod mutations;
mod shipped_scenes;
mod streams;
mod unsolvable_scenes;
