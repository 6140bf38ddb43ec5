//! Parts and their instances: every card of a part stands once for each of its instances.
//!
//! ```text
//! x = R (X + t)      X in the part, R about the line through a and b
//! ```

use std::collections::HashMap;

use super::card::{Card, Row, bare};
use crate::error::Error;

/// Where names and numbers are known: the model itself, or an instance.
#[derive(Clone, Debug)]
pub(crate) struct Scope {
    /// Name of the instance; empty for the model and its assembly.
    pub(crate) name: String,
    motion: Motion,
}

impl Scope {
    /// Where a point of the part is in the model.
    pub(crate) fn place(&self, point: [f64; 3]) -> [f64; 3] {
        self.motion.apply(point)
    }

    /// Where a direction of the part points in the model.
    pub(crate) fn turn(&self, direction: [f64; 3]) -> [f64; 3] {
        self.motion.turn(direction)
    }

    /// The name of a set or surface that is stated here.
    pub(crate) fn full(&self, name: &str) -> String {
        match self.name.as_str() {
            "" => name.to_owned(),
            instance => format!("{instance}.{name}"),
        }
    }
}

/// A card and the number of the scope that it speaks of.
pub(crate) type Scoped<'a, 'c> = (usize, &'c Card<'a>);

/// All scopes, the model first, and the cards in them.
pub(crate) struct Flat<'a, 'c> {
    pub(crate) scopes: Vec<Scope>,
    pub(crate) cards: Vec<Scoped<'a, 'c>>,
}

/// Writes the instances of parts out.
pub(crate) fn flatten<'a, 'c>(cards: &'c [Card<'a>]) -> Result<Flat<'a, 'c>, Error> {
    let model = Scope {
        name: String::new(),
        motion: Motion::default(),
    };
    let mut flat = Flat {
        scopes: vec![model],
        cards: Vec::new(),
    };
    let mut parts: HashMap<String, &'c [Card<'a>]> = HashMap::new();
    let (mut at, mut scope) = (0, 0);
    while let Some(card) = cards.get(at) {
        at += 1;
        match card.name.as_str() {
            "PART" => {
                card.only(&["NAME"])?;
                let length = length(&cards[at..], card, "ENDPART")?;
                let name = card.need("NAME")?;
                let once_more = parts.insert(bare(name), &cards[at..at + length]).is_some();
                if once_more {
                    return Err(
                        card.error(format!("part `{name}` once more; expected another name"))
                    );
                }
                at += length + 1;
            }
            "INSTANCE" => {
                let part = flat.open(card, &parts, scope)?;
                scope = flat.scopes.len() - 1;
                flat.cards.extend(part.iter().map(|card| (scope, card)));
                // What the instance itself adds ends with its own keyword.
                length(&cards[at..], card, "ENDINSTANCE")?;
            }
            "ENDINSTANCE" => scope = 0,
            "ASSEMBLY" | "ENDASSEMBLY" => {}
            _ => flat.cards.push((scope, card)),
        }
    }
    Ok(flat)
}

/// Number of cards before the one that ends a part or an instance.
fn length(cards: &[Card<'_>], opened: &Card<'_>, end: &str) -> Result<usize, Error> {
    let ends = ["ENDPART", "ENDINSTANCE", "PART", "INSTANCE", "STEP"];
    let found = cards
        .iter()
        .position(|card| ends.contains(&card.name.as_str()));
    match found {
        Some(at) if cards[at].name == end => Ok(at),
        Some(at) => Err(cards[at].error(format!("inside {}, which is not ended", opened.shown))),
        None => Err(opened.error("the deck ends before what ends it")),
    }
}

impl<'a, 'c> Flat<'a, 'c> {
    /// Adds the scope of an instance, and returns the cards of its part.
    fn open(
        &mut self,
        card: &Card<'_>,
        parts: &HashMap<String, &'c [Card<'a>]>,
        scope: usize,
    ) -> Result<&'c [Card<'a>], Error> {
        card.only(&["NAME", "PART"])?;
        let (name, part) = (card.need("NAME")?, card.need("PART")?);
        if scope != 0 || self.scopes.iter().any(|scope| scope.name == name) {
            return Err(card.error(format!(
                "instance `{name}` once more; expected another name"
            )));
        }
        let cards = parts.get(part).ok_or_else(|| {
            card.error(format!("part `{part}` is not known; expected *PART before"))
        })?;
        self.scopes.push(Scope {
            name: name.to_owned(),
            motion: Motion::read(card)?,
        });
        Ok(cards)
    }
}

/// A translation and then a rotation.
#[derive(Clone, Copy, Debug, Default)]
struct Motion {
    translation: [f64; 3],
    /// A point of the axis, its direction of length 1, the angle in radian.
    rotation: Option<([f64; 3], [f64; 3], f64)>,
}

impl Motion {
    fn read(card: &Card<'_>) -> Result<Self, Error> {
        let numbers = |row: Row<'_, '_>, count: usize| -> Result<Vec<f64>, Error> {
            (0..count)
                .map(|at| row.number(at, "a coordinate", 0.0))
                .collect()
        };
        let mut rows = card.rows(0);
        let mut motion = Self::default();
        if let Some(row) = rows.next() {
            motion.translation.copy_from_slice(&numbers(row, 3)?);
        }
        if let Some(row) = rows.next() {
            let stated = numbers(row, 7)?;
            let axis = [0, 1, 2].map(|at| stated[3 + at] - stated[at]);
            let length = axis.iter().fold(0.0_f64, |sum, x| sum.hypot(*x));
            if length == 0.0 {
                return Err(row.error("the two points of the axis of rotation coincide"));
            }
            let axis = axis.map(|x| x / length);
            motion.rotation = Some((
                [stated[0], stated[1], stated[2]],
                axis,
                stated[6].to_radians(),
            ));
        }
        match rows.next() {
            None => Ok(motion),
            Some(row) => Err(row.error("one line too many; expected translation and rotation")),
        }
    }

    fn apply(&self, point: [f64; 3]) -> [f64; 3] {
        let moved = [0, 1, 2].map(|at| point[at] + self.translation[at]);
        let through = self.rotation.map_or(moved, |(through, ..)| through);
        let turned = self.turn([0, 1, 2].map(|at| moved[at] - through[at]));
        [0, 1, 2].map(|at| through[at] + turned[at])
    }

    /// By Rodrigues' formula.
    fn turn(&self, d: [f64; 3]) -> [f64; 3] {
        let Some((_, n, angle)) = self.rotation else {
            return d;
        };
        let (sine, cosine) = angle.sin_cos();
        let along: f64 = n.iter().zip(d).map(|(n, d)| n * d).sum();
        let across = [
            n[1] * d[2] - n[2] * d[1],
            n[2] * d[0] - n[0] * d[2],
            n[0] * d[1] - n[1] * d[0],
        ];
        [0, 1, 2].map(|at| cosine * d[at] + sine * across[at] + (1.0 - cosine) * along * n[at])
    }
}
