//! What the fuzz targets share: a second opinion on every answer, and small scenes to solve.

mod accurate;
mod attempt;
mod changes;
mod witness;

pub use attempt::{attempt, small};
pub use changes::change;
pub use witness::witness;
