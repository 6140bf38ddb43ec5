//! A cube dragged over a rigid plane (`examples/scenes/cube.json`) on ever finer meshes.
//!
//! `cargo bench --bench cube [-- --quick]`
#![allow(clippy::print_stdout)]

mod dragged_cube;
mod measured;

use std::error::Error;

use dragged_cube::dragged_cube;

fn main() -> Result<(), Box<dyn Error>> {
    measured::table(&[8, 16, 24, 32], dragged_cube)
}
