//! Answers of one body that can be known without the program: closed forms, published values, a second solver.
#![allow(clippy::unwrap_used)]

#[path = "../square/mod.rs"]
mod square;

mod accuracy_requests;
mod axisymmetric;
mod cube;
mod error_bound;
mod hertz;
mod konter;
mod obstacles;
mod patch;
mod quadratic_hertz;
mod quadratic_ssnv128;
mod quality;
mod rigid_bodies;
mod sensitivity;
mod ssnv128;
