//! What loads, fields, gaps and supports of a scene do, beside closed forms.

#![allow(clippy::unwrap_used)]

mod bolts;
mod cells;
mod gaps;
mod group_lists;
mod heat;
mod held_contacts;
mod loads;
mod local_supports;
mod materials;
mod periodic;
mod rigid_groups;
mod springs;
#[path = "../stacks/mod.rs"]
mod stacks;
mod turns;
