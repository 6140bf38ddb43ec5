//! SCENE: what the user writes.

mod bare;

pub use bare::BareProblem;
