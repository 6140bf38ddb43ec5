//! Bodies on bodies: what is exact stays exact, what one side gives the other receives, and what nothing
//! but contact holds stands or is named.
#![allow(clippy::unwrap_used)]

#[path = "../rounds/mod.rs"]
mod rounds;
#[path = "../stacks/mod.rs"]
mod stacks;

mod apart;
mod balance;
mod covered;
mod covered_in_space;
mod elastic_limits;
mod fits;
mod floating;
mod goodman_coupled;
mod hertz;
mod itself;
mod laws;
#[cfg(feature = "cli")]
mod metamorphic;
mod patch;
mod quadratic;
mod sabotage;
mod several;
mod skins;
