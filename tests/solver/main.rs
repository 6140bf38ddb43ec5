//! The method on problems that were made for it: random ones, hard ones, those of other codes; and its judge.
#![allow(clippy::unwrap_used)]

#[path = "../square/mod.rs"]
mod square;

mod bare_problems;
mod continuity;
mod derivatives;
mod discrete_kinds;
mod energies;
mod hard_cases;
mod judge;
mod laws;
mod limits;
mod random_equilibria;
mod random_problems;
mod random_stacks;
mod rates;
mod reasons;
mod single_precision;
