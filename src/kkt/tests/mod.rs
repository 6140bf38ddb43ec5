//! Bodies in contact that tests share.

pub(crate) mod samples;
