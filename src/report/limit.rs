//! How far loads can grow, as it is reported.

use std::fmt::Write;

use serde::Serialize;

use super::motion::{ReportedMotion, sentence, significant};

/// The limits of a scene's loads.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Limits {
    /// Title of the scene.
    pub title: String,
    /// Every load that the free motions feel, grown alone while the others stay.
    pub loads: Vec<LoadLimit>,
    /// How much friction the loads take as they stand.
    pub least_friction: ReportedLeastFriction,
}

/// How far one load can grow.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LoadLimit {
    /// Where the scene says so, such as `bodies[0].loads[1]`.
    pub place: String,
    /// Name of its body.
    pub body: String,
    /// `pressure`, `traction`, `body_force` or `point_force`.
    pub kind: &'static str,
    /// What happens to it on rigid bodies: an upper bound.
    #[serde(flatten)]
    pub beyond: Beyond,
    /// What is known of it on the elastic bodies; none where only rigid bodies were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elastic: Option<ReportedElasticLimit>,
}

/// How far a load can grow on the elastic bodies: between two factors that were tried.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedElasticLimit {
    /// Largest multiple that was found to hold, with a certified state.
    pub held: Option<f64>,
    /// Least multiple at which nothing was found to hold the bodies.
    pub fails: Option<f64>,
    /// How the bodies begin to move there.
    pub motions: Vec<ReportedMotion>,
}

/// What a growing load leads to.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "limit", rename_all = "snake_case")]
pub enum Beyond {
    /// It may grow to this multiple of what the scene states.
    Grows {
        /// The largest multiple.
        factor: f64,
        /// How the bodies begin to move there.
        motions: Vec<ReportedMotion>,
        /// The judge found the factor held, and a millionth more impossible.
        certified: bool,
    },
    /// Contact holds it alone, however large.
    Unbounded,
    /// The bodies are not held at any multiple, zero included.
    Never {
        /// How they move.
        motions: Vec<ReportedMotion>,
        /// Force that is missing at the fastest contact, in newton.
        missing: f64,
    },
    /// Too badly conditioned to tell.
    Undecided,
}

/// How much friction the loads take.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "limit", rename_all = "snake_case")]
pub enum ReportedLeastFriction {
    /// They are held from this multiple of the scene's coefficients on.
    Multiple {
        /// The least multiple; zero if the loads need no friction.
        multiple: f64,
        /// The same as a coefficient, where all contacts have one.
        coefficient: Option<f64>,
        /// How the bodies begin to move just below it.
        motions: Vec<ReportedMotion>,
    },
    /// No friction holds them.
    Never {
        /// How the bodies move.
        motions: Vec<ReportedMotion>,
        /// Force that is missing at the fastest contact, in newton.
        missing: f64,
    },
    /// Too badly conditioned to tell.
    Undecided,
}

impl Limits {
    /// The limits as indented JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Plain structs with string keys: there is nothing that could fail to serialise.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// One line per load, and one on friction.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = String::new();
        if !self.title.is_empty() {
            let _ = writeln!(text, "{}", self.title);
        }
        let _ = writeln!(
            text,
            "each load alone, the others as they stand; on rigid bodies, an upper bound:"
        );
        for load in &self.loads {
            let place = format!("{} ({}, {})", load.place, load.body, load.kind);
            let _ = writeln!(text, "  {place:<44} {}", load.beyond.words());
            if let Some(elastic) = &load.elastic {
                let _ = writeln!(text, "  {:<44} {}", "  elastic bodies", elastic.words());
            }
        }
        let _ = writeln!(text, "least friction  {}", self.least_friction.words());
        text
    }
}

impl Beyond {
    fn words(&self) -> String {
        match self {
            Self::Grows {
                factor,
                motions,
                certified,
            } => {
                let doubt = if *certified { "" } else { " (NOT CERTIFIED)" };
                format!("up to {factor:.9} times{doubt}; then {}", sentence(motions))
            }
            Self::Unbounded => "without limit".to_owned(),
            Self::Never { motions, missing } => {
                let missing = significant(*missing);
                format!("at no multiple: {}; missing {missing}", sentence(motions))
            }
            Self::Undecided => "too badly conditioned to tell".to_owned(),
        }
    }
}

impl ReportedElasticLimit {
    fn words(&self) -> String {
        let then = sentence(&self.motions);
        match (self.held, self.fails) {
            (Some(held), Some(fails)) => {
                format!("{held:.9} times holds, {fails:.9} does not; then {then}")
            }
            (Some(held), None) => format!("{held} times holds; no end was found"),
            (None, Some(0.0)) => format!("at no multiple that was tried: {then}"),
            (None, Some(fails)) => {
                format!("{fails} times does not hold, less was not found to: {then}")
            }
            (None, None) => "no state was found, nor that there is none".to_owned(),
        }
    }
}

impl ReportedLeastFriction {
    fn words(&self) -> String {
        match self {
            Self::Multiple { multiple: 0.0, .. } => "none is needed".to_owned(),
            Self::Multiple {
                multiple,
                coefficient,
                motions,
            } => {
                let of = match coefficient {
                    Some(coefficient) => format!(" (coefficient {coefficient:.9})"),
                    None => String::new(),
                };
                let below = sentence(motions);
                format!("{multiple:.9} times the scene's{of}; below it {below}")
            }
            Self::Never { motions, missing } => {
                let missing = significant(*missing);
                format!("none suffices: {}; missing {missing}", sentence(motions))
            }
            Self::Undecided => "too badly conditioned to tell".to_owned(),
        }
    }
}
