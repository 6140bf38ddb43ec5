//! Why an answer has no certificate, and what to do, as it is reported.

use serde::Serialize;

use super::ReportParts;
use super::digits::size;
use super::fit::fault;
use crate::alternation;
use crate::alternation::Status;

/// Why a solve ended as it did, and what to do about it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedShortfall {
    /// Why, by a name that stays.
    pub reason: Reason,
    /// What to do.
    pub advice: String,
}

/// Every way to end without a certificate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// No admissible contact forces hold the bodies.
    NoEquilibrium,
    /// The sweeps that the settings allow ran out.
    SweepLimit,
    /// Many sweeps led to no better state.
    Stalled,
    /// The time that the settings allow ran out.
    TimeLimit,
    /// The solve was interrupted.
    Interrupted,
    /// The cone solver gave up.
    ConeSolver,
    /// Nothing but round-off gives way to the contacts.
    IllConditioned,
    /// A body as a whole is not in equilibrium.
    OutOfBalance,
    /// The tolerance asks for more digits than the problem has.
    RoundOff,
    /// The bodies are not in the state that the contact problem says.
    CouplingFault,
}

impl Reason {
    /// As the summary says it.
    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::NoEquilibrium => "nothing holds the bodies",
            Self::SweepLimit => "sweeps ran out (max_sweeps)",
            Self::Stalled => "many sweeps led to no better state",
            Self::TimeLimit => "time ran out (time_limit)",
            Self::Interrupted => "interrupted",
            Self::ConeSolver => "the cone solver gave up",
            Self::IllConditioned => {
                "ill-conditioned: nothing but round-off gives way to the contacts"
            }
            Self::OutOfBalance => {
                "a body as a whole is not in equilibrium: its cells leave no digits"
            }
            Self::RoundOff => "what is left is round-off",
            Self::CouplingFault => "the bodies are not in the state that the contact problem says",
        }
    }
}

impl ReportedShortfall {
    /// None for a certified answer.
    pub(super) fn of(parts: &ReportParts<'_>) -> Option<Self> {
        let outcome = parts.outcome;
        match outcome.status {
            Status::Certified => None,
            Status::NotConverged => Some(Self::new(outcome.shortfall?, parts)),
            Status::CouplingFault => Some(Self {
                reason: Reason::CouplingFault,
                advice: fault(parts),
            }),
            Status::NoEquilibrium => Some(Self {
                reason: Reason::NoEquilibrium,
                advice: held(parts),
            }),
        }
    }
}

/// What could hold bodies that move off: friction only where something slides.
fn held(parts: &ReportParts<'_>) -> String {
    let failure = parts.outcome.failure.as_ref();
    let slides = failure.is_some_and(|of| !of.sliding.is_empty() || of.opening.is_empty());
    let laws = parts.problem.laws().is_some();
    let advice = match (slides, laws) {
        (true, false) => {
            "hold the motion by a support, or by more friction: `dpana limit` says how much"
        }
        (true, true) => "hold the motion by a support, or by a law of contact that bears more",
        (false, _) => {
            "hold the motion by a support, or press the bodies together: contacts that only open are \
             held by no friction"
        }
    };
    match failure.is_some_and(|failure| failure.elastic) {
        true => format!(
            "{advice}; or bring the loads on one after the other, by `steps`: rigid bodies would be held, \
             and what friction holds of elastic ones depends on the way"
        ),
        false => advice.to_owned(),
    }
}

/// What to do where sweeps lead nowhere: less friction only helps where there is any.
fn stalled(sweeps: usize, parts: &ReportParts<'_>) -> String {
    let laws = parts.problem.laws().unwrap_or_default();
    let rough = laws.iter().any(|law| law.sticks || law.shear > 0.0);
    let cause = match rough || parts.problem.friction().iter().any(|mu| *mu > 0.0) {
        true => {
            "with this much friction there may be several states, or one that smaller load steps lead \
             to; try steps, or less friction"
        }
        false => {
            "there is no friction, so that states differ in their gaps alone; look for bodies that hardly \
             anything holds, for loads tiny beside the stiffness, and for a misplaced unit"
        }
    };
    format!("{sweeps} sweeps without a better state: {cause}")
}

impl ReportedShortfall {
    fn new(shortfall: alternation::Shortfall, parts: &ReportParts<'_>) -> Self {
        let (reason, advice) = match shortfall {
            alternation::Shortfall::SweepLimit => (
                Reason::SweepLimit,
                "raise settings.max_sweeps, or leave it out".to_owned(),
            ),
            alternation::Shortfall::Stalled { sweeps } => (Reason::Stalled, stalled(sweeps, parts)),
            alternation::Shortfall::TimeLimit => (
                Reason::TimeLimit,
                "raise settings.time_limit, or leave it out".to_owned(),
            ),
            alternation::Shortfall::Interrupted => (
                Reason::Interrupted,
                "the state is the best up to there: let it run on".to_owned(),
            ),
            alternation::Shortfall::ConeSolver => (
                Reason::ConeSolver,
                "numbers of very different size in one scene: look for a misplaced unit among \
                 stiffnesses, loads and gaps"
                    .to_owned(),
            ),
            alternation::Shortfall::IllConditioned { excess } => (
                Reason::IllConditioned,
                format!(
                    "reactions grow to {} times what acts and change nothing: look for an overlap that \
                     nothing gives way to, as between rigid parts or at contacts that face each other",
                    size(excess)
                ),
            ),
            alternation::Shortfall::OutOfBalance { body, part } => (
                Reason::OutOfBalance,
                format!(
                    "rounding of the forces of cells leaves {} times the loads or contact forces on bodies[{body}] \
                     without an answer: look for cells that are millions of times as long as wide, a body that is \
                     thousands of times as long as thick, loads that are tiny beside prescribed motions, and for a \
                     misplaced unit among coordinates",
                    size(part)
                ),
            ),
            alternation::Shortfall::RoundOff { floor } => (
                Reason::RoundOff,
                format!(
                    "no residual much below {} can be had in double precision: raise \
                     settings.tolerance above it",
                    size(floor)
                ),
            ),
        };
        Self { reason, advice }
    }
}
