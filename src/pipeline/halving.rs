//! Steps in halves: by how much the answer depends on their size.

use super::Setup;
use super::substep::{Course, Reached, State};
use crate::error::Error;
use crate::kkt::{ContactStatus, Ledger};
use crate::report;

/// A step is halved this often at most: into 2⁷ parts.
const DEPTH: i32 = 6;

/// The way from one instant of a load history to the next.
pub(super) struct Path {
    pub(super) last: Reached,
    pub(super) ledger: Ledger,
    pub(super) halving: Option<Halving>,
}

/// What halving the parts of a step, as it was solved, still changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Halving {
    /// Parts that the step was solved in.
    pub parts: usize,
    /// Change of the energy that friction dissipates over the step, in joule; those of the parts
    /// add up by size.
    pub dissipation: f64,
    /// Most contacts that any part ends with in another state.
    pub contacts: usize,
    /// Both are below what the scene asks for.
    pub resolved: bool,
}

/// A part of a step in one, and in two.
struct Change {
    dissipation: f64,
    contacts: usize,
    /// Area of these contacts beside the area of contact.
    area: f64,
    /// Work of the part, and the share of its length in the elastic energy, in joule.
    energy: f64,
}

impl Course<'_> {
    /// The way to an instant, halved where the scene asks for it and the start has an instant.
    pub(super) fn step(
        &mut self,
        from: &State,
        start: Option<f64>,
        end: f64,
    ) -> Result<Path, Error> {
        let whole = self.solve(from, end)?;
        match (self.history.resolution(), start) {
            (Some(most), Some(start)) => self.halve(from, [start, end], &whole, most, 0),
            _ => Ok(Path {
                ledger: whole.ledger,
                last: whole,
                halving: None,
            }),
        }
    }

    /// Two halves in place of `whole`, and halves of these while they change too much.
    fn halve(
        &mut self,
        from: &State,
        [start, end]: [f64; 2],
        whole: &Reached,
        most: f64,
        depth: i32,
    ) -> Result<Path, Error> {
        let middle = 0.5 * (start + end);
        let first = self.solve(from, middle)?;
        if first.is_certified() {
            let second = self.solve(&first.state, end)?;
            let change = Change::new(&self.setup, whole, [&first, &second], depth);
            let resolved = second.is_certified() && change.is_within(most);
            if resolved || depth == DEPTH {
                return Ok(Path {
                    ledger: first.ledger.plus(&second.ledger),
                    last: second,
                    halving: Some(Halving {
                        parts: 2,
                        dissipation: change.dissipation,
                        contacts: change.contacts,
                        resolved,
                    }),
                });
            }
        } else if depth == DEPTH {
            return Ok(Path {
                ledger: first.ledger,
                last: first,
                halving: None,
            });
        }
        let early = self.halve(from, [start, middle], &first, most, depth + 1)?;
        if !early.last.is_certified() {
            return Ok(early);
        }
        let rest = self.solve(&early.last.state, end)?;
        let late = self.halve(&early.last.state, [middle, end], &rest, most, depth + 1)?;
        Ok(early.then(late))
    }
}

impl Path {
    fn then(self, late: Self) -> Self {
        let both = self.halving.zip(late.halving);
        Self {
            ledger: self.ledger.plus(&late.ledger),
            last: late.last,
            halving: both.map(|(a, b)| Halving {
                parts: a.parts + b.parts,
                dissipation: a.dissipation + b.dissipation,
                contacts: a.contacts.max(b.contacts),
                resolved: a.resolved && b.resolved,
            }),
        }
    }
}

impl Change {
    fn new(setup: &Setup, whole: &Reached, [first, second]: [&Reached; 2], depth: i32) -> Self {
        let halves = first.ledger.plus(&second.ledger);
        let (mut contacts, mut other, mut pressed) = (0, 0.0, 0.0);
        let nodes = setup.condensed.surface().nodes.iter();
        let [a, b] = [whole, second].map(|reached| &reached.outcome.verdict.status);
        for (node, (a, b)) in nodes.zip(a.iter().zip(b)) {
            if a != b {
                contacts += 1;
                other += node.area;
            }
            if *b != ContactStatus::Open {
                pressed += node.area;
            }
        }
        let work: f64 = [halves.loads, halves.supports, halves.obstacles]
            .map(f64::abs)
            .iter()
            .sum();
        Self {
            dissipation: (whole.ledger.dissipation - halves.dissipation).abs(),
            contacts,
            area: if other > 0.0 { other / pressed } else { 0.0 },
            energy: work + second.state.elastic() * 0.5_f64.powi(depth),
        }
    }

    fn is_within(&self, most: f64) -> bool {
        self.dissipation <= most * self.energy && self.area <= most
    }
}

impl Halving {
    pub(super) fn record(self) -> report::Halving {
        report::Halving {
            parts: self.parts,
            dissipation: self.dissipation,
            contacts: self.contacts,
            resolved: self.resolved,
        }
    }

    /// What a reader should know of a step that stays unresolved.
    pub(super) fn note(self) -> Option<String> {
        let (parts, contacts) = (self.parts, self.contacts);
        (!self.resolved).then(|| {
            format!(
                "this step is not resolved: halving its {parts} parts again changes the \
                 dissipated energy by up to {:.1e} and the state of up to {contacts} contacts",
                self.dissipation
            )
        })
    }
}
