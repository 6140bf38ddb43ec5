//! Bodies that tests share, and tests of whole bodies: locking, rings.

mod bending;
mod bound;
mod locking;
mod oriented;
mod rings;
pub(crate) mod samples;
