//! REPORT: what the user reads.
