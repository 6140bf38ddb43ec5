//! Bodies and graphs that tests of the condensation share.

pub(crate) mod bed;
pub(crate) mod lattice;
