//! What must not change an answer, as it is reported.

use std::fmt::Write;

use serde::Serialize;

/// Random scenes, and their changes.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MetamorphicBattery {
    /// Everything held.
    pub passed: bool,
    /// Number of scenes.
    pub scenes: usize,
    /// Change by change.
    pub changes: Vec<MetamorphicChange>,
    /// What did not hold, in words.
    pub wrong: Vec<String>,
}

/// One change, tried on many scenes.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MetamorphicChange {
    /// What was changed.
    pub name: &'static str,
    /// On how many scenes.
    pub tried: usize,
    /// How many the judge of the scene refused as beyond what the mesh resolves: cuts through surfaces of a few cells.
    pub refused: usize,
    /// Largest difference of a displacement or force, relative to the largest, where the same sides carried the contacts.
    pub largest_difference: f64,
}

impl MetamorphicBattery {
    pub(crate) fn new<const N: usize>(scenes: usize, names: [&'static str; N]) -> Self {
        let changes = names.map(|name| MetamorphicChange {
            name,
            tried: 0,
            refused: 0,
            largest_difference: 0.0,
        });
        Self {
            passed: false,
            scenes,
            changes: changes.into(),
            wrong: Vec::new(),
        }
    }

    /// Pairs of scene and change that were tried.
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.changes.iter().map(|change| change.tried).sum()
    }

    /// The battery as indented JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Plain structs with string keys: there is nothing that could fail to serialise.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// Pairs and largest difference, change by change.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = format!(
            "{:<34}{:>8}{:>9}{:>20}\n",
            "change", "scenes", "refused", "largest difference"
        );
        for change in &self.changes {
            let _ = writeln!(
                text,
                "{:<34}{:>8}{:>9}{:>20.1e}",
                change.name, change.tried, change.refused, change.largest_difference
            );
        }
        let _ = writeln!(
            text,
            "{} pairs of scene and change, {} wrong",
            self.pairs(),
            self.wrong.len()
        );
        text
    }
}
