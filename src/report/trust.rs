//! How far the answer depends on where the solve started, as it is reported.

use serde::Serialize;

use crate::alternation::Outcome;
use crate::kkt::ContactStatus;
use crate::trust::{Contraction, OtherStarts, WayBack};

/// What other starts led to, and how much friction the alternation takes.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Trust {
    /// In words.
    pub words: String,
    /// Factor per sweep by which the plain alternation shrinks a small disturbance of this state, an
    /// estimate; `null` without friction, and between bodies that contact alone holds.
    pub contraction: Option<f64>,
    /// Multiple of all friction coefficients at which that factor would be one, on the contact states
    /// as they are; `null` where it stays on its side of one up to a thousand times.
    pub critical_friction_factor: Option<f64>,
    /// Whether the state is reached from the last one (from rest, where there is none) without a jump.
    pub continuity: Continuity,
    /// Number of other starts.
    pub starts: usize,
    /// Starts that led to no certified state.
    pub lost: usize,
    /// Every certified state that was found; that of this report comes first.
    pub solutions: Vec<TrustedState>,
}

/// Whether a path of states leads from the last one to this, loads changing in proportion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Continuity {
    /// It does.
    Continuous,
    /// It does not: followed back, the state turns at this part of the step.
    Turns(f64),
    /// It does not: followed back, the state leads to another one than the last.
    Elsewhere,
    /// Not known: the state could not be followed back below this part of the step.
    Lost(f64),
}

/// A certified state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrustedState {
    /// Number of other starts that led to it.
    pub starts: usize,
    /// The judge's residual.
    pub residual: f64,
    /// Open contacts.
    pub open: usize,
    /// Sticking contacts.
    pub stick: usize,
    /// Slipping contacts.
    pub slip: usize,
    /// Sum of normal reactions as pressed, in newton.
    pub normal: f64,
}

impl Trust {
    /// Joins both; `normals` are the contacts' normal unknowns.
    pub(crate) fn new(
        contraction: Option<Contraction>,
        continuity: Continuity,
        others: &OtherStarts,
        normals: &[usize],
    ) -> Self {
        let solutions = others.solutions.iter();
        let mut trust = Self {
            words: String::new(),
            contraction: contraction.map(|contraction| contraction.factor),
            critical_friction_factor: contraction.and_then(|contraction| contraction.critical),
            continuity,
            starts: others.starts,
            lost: others.lost,
            solutions: solutions
                .map(|(outcome, starts)| TrustedState::new(outcome, *starts, normals))
                .collect(),
        };
        trust.words = trust.sentence();
        trust
    }

    fn sentence(&self) -> String {
        let mut words = match self.solutions.len() {
            1 => format!("one solution found from {} other starts", self.starts),
            several => format!(
                "NOT UNIQUE: {several} solutions found from {} other starts, each certified",
                self.starts
            ),
        };
        if self.lost > 0 {
            words.push_str(&format!(" ({} led nowhere)", self.lost));
        }
        if let Some(factor) = self.contraction {
            let does = if factor < 1.0 { "contracts" } else { "expands" };
            words.push_str(&format!("; the alternation {does} by {factor:.2} a sweep"));
        }
        if let Some(multiple) = self.critical_friction_factor {
            words.push_str(&format!(", by 1 at {multiple:.2} times the friction"));
        }
        words.push_str(&format!("; {}", self.continuity.words()));
        words
    }
}

impl Continuity {
    /// As the summary says it.
    #[must_use]
    pub fn words(self) -> String {
        match self {
            Self::Continuous => "reached without a jump".to_owned(),
            Self::Turns(part) => format!(
                "NO CONTINUOUS PATH leads here: there is no state like this before {part:.3} of the step"
            ),
            Self::Elsewhere => {
                "NO CONTINUOUS PATH leads here: going back leads to another state".to_owned()
            }
            Self::Lost(part) => format!("followed back to {part:.3} of the step only, for jumps"),
        }
    }
}

impl From<WayBack> for Continuity {
    fn from(way_back: WayBack) -> Self {
        match way_back {
            WayBack::Continuous => Self::Continuous,
            WayBack::Turns(part) => Self::Turns(part),
            WayBack::Elsewhere => Self::Elsewhere,
            WayBack::Lost(part) => Self::Lost(part),
        }
    }
}

impl TrustedState {
    fn new(outcome: &Outcome, starts: usize, normals: &[usize]) -> Self {
        let status = &outcome.verdict.status;
        let count = |wanted| status.iter().filter(|status| **status == wanted).count();
        Self {
            starts,
            residual: outcome.verdict.certificate.residual(),
            open: count(ContactStatus::Open),
            stick: count(ContactStatus::Stick),
            slip: count(ContactStatus::Slip),
            normal: -normals.iter().map(|&n| outcome.reaction[n]).sum::<f64>(),
        }
    }
}
