//! The SSNV128 square (`examples/scenes/ssnv128.json`) on ever finer meshes.
//!
//! `cargo bench --bench square [-- --quick]`
#![allow(clippy::print_stdout)]

mod generated_square;
mod measured;

use std::error::Error;

use generated_square::square;

fn main() -> Result<(), Box<dyn Error>> {
    measured::table(&[128, 256, 512], square)
}
