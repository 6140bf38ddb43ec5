//! Load histories: exact histories, closed forms that depend on the order of loads, what they cost, what
//! they leave on disk.
#![allow(clippy::unwrap_used)]

#[path = "../program/mod.rs"]
mod program;
#[path = "../stacks/mod.rs"]
mod stacks;

mod bare;
mod command;
mod halving;
mod history;
mod interrupted;
mod mindlin;
mod work;
