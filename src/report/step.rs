//! The load step that led to a state: when, under what, and where its work went.

use serde::Serialize;

use crate::kkt;

/// A load step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Step {
    /// From 1.
    pub number: usize,
    /// Its instant.
    pub at: f64,
    /// Value of every table of the scene, under the place of what it drives.
    pub driven: Vec<(String, f64)>,
    /// Work and energy of this step.
    pub ledger: Ledger,
    /// The same since the start of the history.
    pub total: Ledger,
}

/// Work and energy, in joule; see [`kkt::Ledger`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Ledger {
    /// Work of the given forces.
    pub loads: f64,
    /// Work of the moved supports.
    pub supports: f64,
    /// Work of the moved obstacles.
    pub obstacles: f64,
    /// Change of the elastic energy.
    pub elastic: f64,
    /// What friction dissipated, never negative.
    pub dissipation: f64,
    /// External work − elastic − dissipation: what the ends of the steps leave unexplained, by
    /// contacts that changed in between.
    pub closure: f64,
}

impl From<kkt::Ledger> for Ledger {
    fn from(ledger: kkt::Ledger) -> Self {
        Self {
            loads: ledger.loads,
            supports: ledger.supports,
            obstacles: ledger.obstacles,
            elastic: ledger.elastic,
            dissipation: ledger.dissipation,
            closure: ledger.closure,
        }
    }
}
