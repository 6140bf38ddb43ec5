//! Bodies that tests share, and tests of whole bodies: locking, rings.

mod locking;
mod rings;
pub(crate) mod samples;
