//! Why there is no equilibrium, as it is reported.

use serde::Serialize;

use super::ReportParts;
use super::motion::{ReportedMotion, motions, names, sentence, significant};

/// A motion that no contact resists while the loads work on it, checked by the judge.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedFailure {
    /// In words: which body moves how, and what force is missing.
    pub words: String,
    /// Force that is missing at the fastest sliding contact (if none slides, the fastest
    /// opening one), in newton.
    pub missing: f64,
    /// How the bodies begin to move.
    pub motions: Vec<ReportedMotion>,
    /// Contacts that slide, as indices into `contacts`.
    pub sliding: Vec<usize>,
    /// Contacts that open, as indices into `contacts`.
    pub opening: Vec<usize>,
    /// Rigid bodies would be held: these give way as they deform.
    pub elastic: bool,
    /// Work of the loads on the motion that proves it, in newton times its unit.
    pub work: f64,
    /// Largest velocity by which a contact resists that motion, in the same unit.
    pub resistance: f64,
}

impl ReportedFailure {
    /// What a report without an equilibrium says first.
    pub(super) const fn heading(failure: Option<&Self>) -> &'static str {
        match failure {
            Some(Self { elastic: true, .. }) => "the bodies give way as they deform",
            _ => "no admissible contact forces hold the bodies",
        }
    }

    /// None where an equilibrium exists.
    pub(super) fn new(parts: &ReportParts<'_>) -> Option<Self> {
        let failure = parts.outcome.failure.as_ref()?;
        // A smooth contact has no tangent that could tell: what does not open slides.
        let slides = !failure.sliding.is_empty() || failure.opening.is_empty();
        let motions = motions(
            &names(parts.bodies, parts.rigid.bodies),
            parts.motions,
            slides,
        );
        let what = if slides { "friction" } else { "holding force" };
        let missing = significant(failure.missing);
        Some(Self {
            words: format!("{}; missing {what}: {missing}", sentence(&motions)),
            missing: failure.missing,
            motions,
            sliding: failure.sliding.clone(),
            opening: failure.opening.clone(),
            elastic: failure.elastic,
            work: failure.proof.work,
            resistance: failure.proof.resistance,
        })
    }
}
