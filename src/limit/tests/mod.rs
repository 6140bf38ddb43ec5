//! Rigid blocks that tests share.

pub(crate) mod blocks;
