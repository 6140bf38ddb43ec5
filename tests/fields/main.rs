//! What loads, fields, gaps and supports of a scene do, beside closed forms.

#![allow(clippy::unwrap_used)]

mod cells;
mod gaps;
mod heat;
mod loads;
mod materials;
mod springs;
#[path = "../stacks/mod.rs"]
mod stacks;
mod turns;
