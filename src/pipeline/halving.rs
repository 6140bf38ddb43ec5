//! Steps in halves: by how much the answer depends on their size.

use super::Setup;
use super::substep::{Course, Reached, State};
use crate::error::Error;
use crate::kkt::{ContactStatus, Ledger};
use crate::report;

/// A step is halved this often at most: into 2⁷ parts.
const DEPTH: i32 = 6;

/// A step is not resolved to less than what matters beside this part of the elastic energy: one
/// that holds what was there does no work.
const FLOOR: f64 = 1e-3;

/// The way from one instant of a load history to the next.
pub(super) struct Path {
    pub(super) last: Reached,
    pub(super) ledger: Ledger,
    /// Of the parts that it was solved in; none where it was not halved.
    change: Option<Change>,
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
    /// Both, and what the parts leave unexplained (K10), are below what the scene asks for.
    pub resolved: bool,
}

/// What parts of a step change where they are halved.
struct Change {
    parts: usize,
    /// In joule.
    dissipation: f64,
    contacts: usize,
    /// Area of these contacts beside the area of contact.
    area: f64,
    /// What the halves leave unexplained by themselves (K10), in joule.
    closure: f64,
}

impl Course<'_> {
    /// The way to an instant, halved where the scene asks for it and the start has an instant, and
    /// what halving still changes.
    pub(super) fn step(
        &mut self,
        from: &State,
        start: Option<f64>,
        end: f64,
    ) -> Result<(Path, Option<Halving>), Error> {
        let whole = self.solve(from, end)?;
        let (Some(most), Some(start)) = (self.history.resolution(), start) else {
            return Ok((Path::of(whole), None));
        };
        let path = self.halve(from, [start, end], &whole, most, 0)?;
        let halving = path.change.as_ref().map(|change| Halving {
            parts: change.parts,
            dissipation: change.dissipation,
            contacts: change.contacts,
            resolved: path.last.is_certified()
                && change.is_within(most, energy(&path.ledger, path.last.state.elastic())),
        });
        Ok((path, halving))
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
            let change = Change::new(&self.setup, whole, &first, &second);
            let ledger = first.ledger.plus(&second.ledger);
            let energy = energy(&ledger, second.state.elastic() * 0.5_f64.powi(depth));
            let resolved = second.is_certified() && change.is_within(most, energy);
            if resolved || depth == DEPTH {
                return Ok(Path {
                    ledger,
                    last: second,
                    change: Some(change),
                });
            }
        } else if depth == DEPTH {
            return Ok(Path::of(first));
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
    /// One solve.
    fn of(last: Reached) -> Self {
        Self {
            ledger: last.ledger,
            last,
            change: None,
        }
    }

    fn then(self, late: Self) -> Self {
        let both = self.change.zip(late.change);
        Self {
            ledger: self.ledger.plus(&late.ledger),
            last: late.last,
            change: both.map(|(a, b)| Change {
                parts: a.parts + b.parts,
                dissipation: a.dissipation + b.dissipation,
                contacts: a.contacts.max(b.contacts),
                area: a.area.max(b.area),
                closure: a.closure + b.closure,
            }),
        }
    }
}

impl Change {
    /// From one solve to two halves.
    fn new(setup: &Setup, whole: &Reached, first: &Reached, second: &Reached) -> Self {
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
        let [a, b] = [first.ledger, second.ledger];
        Self {
            parts: 2,
            dissipation: (whole.ledger.dissipation - a.dissipation - b.dissipation).abs(),
            contacts,
            area: if other > 0.0 { other / pressed } else { 0.0 },
            closure: a.closure.abs() + b.closure.abs(),
        }
    }

    /// Energies are at most this part of an energy, areas of the area of contact.
    fn is_within(&self, most: f64, energy: f64) -> bool {
        self.dissipation.max(self.closure) <= most * energy && self.area <= most
    }
}

/// Work that went in or out, by size, with a floor from the elastic energy, in joule.
fn energy(ledger: &Ledger, elastic: f64) -> f64 {
    let driven = ledger.loads.abs() + ledger.supports.abs() + ledger.obstacles.abs();
    let work = driven + ledger.fits.abs();
    work + FLOOR * elastic
}

impl Halving {
    pub(super) fn record(self) -> report::ReportedHalving {
        report::ReportedHalving {
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
