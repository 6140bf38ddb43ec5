//! What the program is doing at the moment, for whoever watches a long solve.
//!
//! One note for the whole process, written by the stages as they begin and read from any thread: it
//! tells, it decides nothing. Where several solves run at once it is that of the stage that began last.

use std::sync::atomic::{AtomicU8, AtomicU64, AtomicUsize, Ordering::Relaxed};

/// A stage of a solve, in the order in which they are reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Reading, checks, contact surface, stiffness.
    Assembly,
    /// Order of elimination.
    Ordering,
    /// Sparse factorisation of a body.
    Factorisation,
    /// Compliance of the contact surface.
    Condensation,
    /// Sweeps of cone programs, and Newton steps.
    Sweeps,
    /// Displacements of the bodies, and the judge.
    Recovery,
}

/// All stages, by the number that stands for them.
const STAGES: [Stage; 6] = [
    Stage::Assembly,
    Stage::Ordering,
    Stage::Factorisation,
    Stage::Condensation,
    Stage::Sweeps,
    Stage::Recovery,
];

static NOW: AtomicU8 = AtomicU8::new(0);
static CONTACTS: AtomicUsize = AtomicUsize::new(0);
static DENSE_BYTES: AtomicUsize = AtomicUsize::new(0);
static RANK_BYTES: AtomicU64 = AtomicU64::new(0);
static SWEEPS: AtomicUsize = AtomicUsize::new(0);
static RESIDUAL: AtomicU64 = AtomicU64::new(0);

impl Stage {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Assembly => "assembly",
            Self::Ordering => "ordering",
            Self::Factorisation => "factorisation",
            Self::Condensation => "condensation",
            Self::Sweeps => "sweeps",
            Self::Recovery => "recovery",
        }
    }

    /// Notes that it begins.
    pub(crate) fn begin(self) {
        NOW.store(self as u8, Relaxed);
    }
}

/// What is known of a solve while it runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What began last.
    pub stage: Stage,
    /// Contacts, 0 until they are found.
    pub contacts: usize,
    /// What the condensed problem takes of the memory, in bytes; 0 until that is known.
    pub dense_bytes: usize,
    /// What factors take of the memory of the rank that needs most, in bytes, as estimated before; 0 on one process.
    pub rank_bytes: f64,
    /// Sweeps of the outer loop so far.
    pub sweeps: usize,
    /// The judge's residual after the last of them, relative.
    pub residual: f64,
}

/// How far the solve is.
#[must_use]
pub fn progress() -> Progress {
    Progress {
        stage: STAGES[usize::from(NOW.load(Relaxed)).min(STAGES.len() - 1)],
        contacts: CONTACTS.load(Relaxed),
        dense_bytes: DENSE_BYTES.load(Relaxed),
        rank_bytes: f64::from_bits(RANK_BYTES.load(Relaxed)),
        sweeps: SWEEPS.load(Relaxed),
        residual: f64::from_bits(RESIDUAL.load(Relaxed)),
    }
}

/// Notes how large the condensed problem is.
pub(crate) fn found(contacts: usize, dense_bytes: usize) {
    CONTACTS.store(contacts, Relaxed);
    DENSE_BYTES.store(dense_bytes, Relaxed);
    RANK_BYTES.store(0.0_f64.to_bits(), Relaxed);
}

/// Notes what one more factor takes of the memory of the rank that needs most, in bytes.
pub(crate) fn divided(bytes: f64) {
    let before = f64::from_bits(RANK_BYTES.load(Relaxed));
    RANK_BYTES.store((before + bytes).to_bits(), Relaxed);
}

/// Notes how far the outer loop is.
pub(crate) fn swept(sweeps: usize, residual: f64) {
    SWEEPS.store(sweeps, Relaxed);
    RESIDUAL.store(residual.to_bits(), Relaxed);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stage_is_the_one_that_its_number_stands_for() {
        for (number, stage) in STAGES.into_iter().enumerate() {
            assert_eq!(stage as usize, number, "{}", stage.name());
        }
    }
}
