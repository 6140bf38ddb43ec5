//! What holds for the crate as a whole: who may import whom, the same bits every time, nothing done that a
//! scene does not need, what reports, studies and the gallery say.
#![allow(clippy::panic, clippy::unwrap_used)]

#[path = "../program/mod.rs"]
mod program;
#[path = "../square/mod.rs"]
mod square;

mod architecture;
mod cases;
mod constants;
mod limits_of_a_mesh;
mod links;
mod only_what_a_scene_needs;
mod picture;
mod repeatable;
mod report;
mod rust_words;
mod study;
mod units;
mod verify;
mod what_if;
