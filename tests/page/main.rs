//! The page to look at: what it holds is what was solved, and a browser shows it.
#![allow(clippy::unwrap_used)]

#[path = "../program/mod.rs"]
mod program;

mod browser;
mod contents;
mod samples;
