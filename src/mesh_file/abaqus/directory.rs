//! Numbers and sets of nodes or of elements, and how a deck refers to them.
//!
//! ```text
//! 12            number, where the card stands        Part-1.12     in an instance
//! NAME          set, there or of the model           Part-1.NAME   in an instance
//! ```

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::card::{Card, Row, bare, quote};
use super::instance::Scope;
use crate::error::Error;

/// Nodes or elements by number and by set.
#[derive(Debug)]
pub(crate) struct Directory {
    /// `node` or `element`.
    what: &'static str,
    /// Index, by scope and number.
    labels: HashMap<(usize, u64), usize>,
    /// Indices, by the full name of a set.
    sets: HashMap<String, BTreeSet<usize>>,
    /// The model and its instances.
    scopes: Vec<Scope>,
}

impl Directory {
    pub(super) fn new(what: &'static str, scopes: &[Scope]) -> Self {
        Self {
            what,
            labels: HashMap::new(),
            sets: HashMap::new(),
            scopes: scopes.to_vec(),
        }
    }

    /// The model or the instance of a number.
    pub(crate) fn scope(&self, scope: usize) -> &Scope {
        &self.scopes[scope]
    }

    /// The full name of a set or surface that is stated in a scope.
    pub(crate) fn full(&self, scope: usize, name: &str) -> String {
        self.scopes[scope].full(name)
    }

    /// Gives a number to an index; returns the one that had it before.
    pub(super) fn number(&mut self, scope: usize, label: u64, index: usize) -> Option<usize> {
        self.labels.insert((scope, label), index)
    }

    /// The index of a number.
    pub(super) fn index(&self, scope: usize, label: u64) -> Option<usize> {
        self.labels.get(&(scope, label)).copied()
    }

    /// Adds to a set, which is made where there is none.
    pub(super) fn add(
        &mut self,
        scope: usize,
        name: &str,
        indices: impl IntoIterator<Item = usize>,
    ) {
        let name = self.scopes[scope].full(name);
        self.sets.entry(name).or_default().extend(indices);
    }

    /// The full names of all sets, and what is in them.
    pub(super) fn sets(&self) -> BTreeMap<&String, &BTreeSet<usize>> {
        self.sets.iter().collect()
    }

    /// What a word of a data line refers to, in rising order.
    pub(crate) fn members(&self, row: Row<'_, '_>, word: &str) -> Result<Vec<usize>, Error> {
        let name = bare(word);
        let (inside, rest) = match name.rsplit_once('.') {
            Some((instance, rest)) => match self.scopes.iter().position(|s| s.name == instance) {
                Some(inside) => (inside, rest),
                None => (row.scope, name.as_str()),
            },
            None => (row.scope, name.as_str()),
        };
        let is_number = !rest.is_empty() && rest.bytes().all(|byte| byte.is_ascii_digit());
        if is_number {
            let label = row.label(rest, self.what)?;
            let unknown = || row.error(format!("{} {label} is not in the deck", self.what));
            return Ok(vec![self.index(inside, label).ok_or_else(unknown)?]);
        }
        let set = self.sets.get(&self.scopes[inside].full(rest));
        match set.or_else(|| self.sets.get(&name)) {
            Some(set) => Ok(set.iter().copied().collect()),
            None => Err(row.error(format!(
                "`{}` is no {} and no set of them",
                quote(word),
                self.what
            ))),
        }
    }

    /// Reads the data lines of a set's card.
    pub(super) fn read(&mut self, scope: usize, card: &Card<'_>) -> Result<(), Error> {
        let key = if self.what == "node" { "NSET" } else { "ELSET" };
        let name = card.need(key)?.to_owned();
        let inside = match card.get("INSTANCE") {
            None => scope,
            Some(instance) => {
                let found = self.scopes.iter().position(|scope| scope.name == instance);
                let unknown = || card.error(format!("instance `{}` is not known", quote(instance)));
                found.ok_or_else(unknown)?
            }
        };
        self.add(scope, &name, []);
        for row in card.rows(inside) {
            if card.get("GENERATE").is_some() {
                let members = self.generated(row)?;
                self.add(scope, &name, members);
                continue;
            }
            for word in row.words().filter(|word| !word.is_empty()) {
                if bare(word) != name {
                    let members = self.members(row, word)?;
                    self.add(scope, &name, members);
                }
            }
        }
        Ok(())
    }

    /// The numbers from a first to a last one, those that there are.
    fn generated(&self, row: Row<'_, '_>) -> Result<Vec<usize>, Error> {
        let number = |at: usize| match row.word(at) {
            "" if at == 2 => Ok(1),
            word => row.label(word, "number to generate from"),
        };
        let (first, last, step) = (number(0)?, number(1)?, number(2)?);
        if last < first || row.words().count() > 3 {
            let reason = "expected a first number, one not below it, and a step";
            return Err(row.error(reason));
        }
        let inside: Vec<usize> = match (last - first) / step < self.labels.len() as u64 {
            true => (0..=(last - first) / step)
                .filter_map(|at| self.index(row.scope, first + at * step))
                .collect(),
            // Few numbers in a wide range: the range is asked about each of them.
            false => (self.labels.iter())
                .filter(|((of, label), _)| {
                    *of == row.scope
                        && (first..=last).contains(label)
                        && (label - first) % step == 0
                })
                .map(|(_, index)| *index)
                .collect(),
        };
        match inside.is_empty() {
            false => Ok(inside),
            true => Err(row.error(format!("no {} from {first} to {last}", self.what))),
        }
    }
}
