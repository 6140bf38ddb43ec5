//! The load step that led to a state: when, under what, and where its work went.

use serde::Serialize;

use crate::kkt;

/// A load step.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedStep {
    /// From 1.
    pub number: usize,
    /// Its instant.
    pub at: f64,
    /// Value of every table of the scene, under the place of what it drives.
    pub driven: Vec<(String, f64)>,
    /// Work and energy of this step.
    pub ledger: ReportedLedger,
    /// The same since the start of the history.
    pub total: ReportedLedger,
    /// What halving the step still changes; absent where the scene does not ask for it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub halving: Option<ReportedHalving>,
}

/// A step that was solved in parts, and what halving these would change.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReportedHalving {
    /// Parts that the step was solved in.
    pub parts: usize,
    /// Change of the dissipated energy, in joule.
    pub dissipation: f64,
    /// Most contacts that any part ends with in another state.
    pub contacts: usize,
    /// Both, and what the parts leave unexplained, are below what the scene asks for.
    pub resolved: bool,
}

/// Work and energy, in joule (K9).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ReportedLedger {
    /// Work of the given forces.
    pub loads: f64,
    /// Work of the moved supports.
    pub supports: f64,
    /// Work of the moved obstacles.
    pub obstacles: f64,
    /// Work of forcing bodies together that overlap before loading; in the first step.
    pub fits: f64,
    /// Change of the elastic energy.
    pub elastic: f64,
    /// What friction dissipated, never negative.
    pub dissipation: f64,
    /// External work − elastic − dissipation: what the ends of the steps leave unexplained, by
    /// contacts that changed in between.
    pub closure: f64,
}

impl From<kkt::Ledger> for ReportedLedger {
    fn from(ledger: kkt::Ledger) -> Self {
        Self {
            loads: ledger.loads,
            supports: ledger.supports,
            obstacles: ledger.obstacles,
            fits: ledger.fits,
            elastic: ledger.elastic,
            dissipation: ledger.dissipation,
            closure: ledger.closure,
        }
    }
}
