//! Pairs of surfaces: what may touch what, what is tied, and in which steps.

use super::interaction::{Interaction, read_law};
use super::statement::{Notes, Statement};
use crate::error::Error;
use crate::mesh_file::abaqus::{Card, Contents, bare};

/// Part of the size of a slave face within which a `*TIE` holds that states no tolerance.
const TIE: f64 = 0.025;

/// Parameters of a `*CONTACT PAIR` that steer how contact is looked for and solved, or are about shells.
const STEERING: [&str; 8] = [
    "TRACKING",
    "NOTHICKNESS",
    "EXTENSIONZONE",
    "SMOOTH",
    "GEOMETRICCORRECTION",
    "MECHANICALCONSTRAINT",
    "SUPPLEMENTARYCONSTRAINTS",
    "CPSET",
];

/// What a row of surfaces is to be.
const TWO: &str = "expected slave and master surface; one that touches itself is read in scenes only, as `against_itself`";

/// Which slave nodes are moved onto the master surface before anything.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Adjust {
    /// None.
    No,
    /// Those that overlap, or are no farther than this.
    Within(f64),
    /// Those of a set.
    Set(Vec<usize>),
}

/// Two surfaces that may touch.
#[derive(Clone, Debug)]
pub(super) struct Pair<'a, 'c> {
    /// Full names: slave, master.
    pub(super) surfaces: [String; 2],
    /// Index of the law.
    pub(super) interaction: usize,
    pub(super) adjust: Adjust,
    /// Distance beyond which slave faces of a `*TIE` are not tied.
    pub(super) tolerance: Option<f64>,
    /// Distance that is stated in place of the one that is drawn, and where.
    pub(super) clearance: Option<(f64, &'c Card<'a>)>,
    /// Numbers of the steps in which it is taken out.
    pub(super) absent: Vec<usize>,
    /// Where it is stated.
    pub(super) card: &'c Card<'a>,
}

/// Laws and pairs of a deck.
#[derive(Debug, Default)]
pub(super) struct Contacts<'a, 'c> {
    pub(super) laws: Vec<Interaction<'a, 'c>>,
    pub(super) pairs: Vec<Pair<'a, 'c>>,
}

impl<'a, 'c> Contacts<'a, 'c> {
    /// Reads the laws, then the pairs.
    pub(super) fn new(
        statement: &Statement<'a, 'c>,
        contents: &Contents,
        notes: &mut Notes,
    ) -> Result<Self, Error> {
        let (mut contacts, model) = (Self::default(), &statement.model);
        for (_, card) in model {
            read_law(&mut contacts.laws, card, notes)?;
        }
        for &(scope, card) in model {
            match card.name.as_str() {
                "CONTACTPAIR" => contacts.read_pairs(scope, card, contents, notes)?,
                "TIE" if card.get("CYCLICSYMMETRY").is_none() => {
                    contacts.read_tie(scope, card, contents, notes)?;
                }
                _ => {}
            }
        }
        if contacts.pairs.is_empty() {
            return Err(statement.missing("*CONTACT PAIR or *TIE"));
        }
        for &(scope, card) in model.iter().filter(|(_, card)| card.name == "CLEARANCE") {
            contacts.read_clearance(scope, card, contents)?;
        }
        for (number, step) in (1..).zip(&statement.steps) {
            contacts.go_on(number);
            let cards = step.cards.iter();
            for &(scope, card) in cards.filter(|(_, card)| card.name == "MODELCHANGE") {
                contacts.change(number, scope, card, contents)?;
                notes.add(
                    card,
                    "a pair that is taken out stands ten times the size of the deck apart: what nothing else holds falls onto it",
                );
            }
        }
        Ok(contacts)
    }

    fn read_pairs(
        &mut self,
        scope: usize,
        card: &'c Card<'a>,
        contents: &Contents,
        notes: &mut Notes,
    ) -> Result<(), Error> {
        let read = ["INTERACTION", "TYPE", "ADJUST", "SMALLSLIDING", "TIED"];
        notes.only(card, &read, &STEERING)?;
        let kinds = [
            "SURFACETOSURFACE",
            "NODETOSURFACE",
            "MORTAR",
            "LINMORTAR",
            "PGLINMORTAR",
        ];
        card.one_of("TYPE", &kinds)?;
        if card.get("SMALLSLIDING").is_none() {
            notes.add(card, "slip counts as small here, as with `SMALL SLIDING`");
        }
        let name = card.need("INTERACTION")?;
        let interaction = self.laws.iter().position(|law| law.name == name);
        let unknown = || card.error(format!("surface interaction `{name}` is not known"));
        let mut interaction = interaction.ok_or_else(unknown)?;
        if card.get("TIED").is_some() {
            interaction = self.glue();
        }
        for surfaces in surfaces(scope, card, contents)? {
            self.pairs.push(Pair {
                surfaces,
                interaction,
                adjust: adjust(scope, card, contents)?,
                tolerance: None,
                clearance: None,
                absent: Vec::new(),
                card,
            });
        }
        Ok(())
    }

    /// Reads surfaces that are one from the start, slave nodes moved onto the master surface.
    fn read_tie(
        &mut self,
        scope: usize,
        card: &'c Card<'a>,
        contents: &Contents,
        notes: &mut Notes,
    ) -> Result<(), Error> {
        let read = ["NAME", "POSITIONTOLERANCE", "ADJUST", "TYPE"];
        notes.only(card, &read, &["NOROTATION", "NOTHICKNESS"])?;
        card.one_of("ADJUST", &["YES", "NO"])?;
        card.one_of("TYPE", &["SURFACETOSURFACE", "NODETOSURFACE"])?;
        let interaction = self.glue();
        for surfaces in surfaces(scope, card, contents)? {
            let tolerance = match card.get("POSITIONTOLERANCE") {
                None => TIE * size(contents, &surfaces[0]),
                Some(word) => match card.head(scope).number_of(word, "a distance")? {
                    tolerance if tolerance >= 0.0 => tolerance,
                    other => {
                        let reason = format!("`POSITION TOLERANCE={other}`; expected one from 0");
                        return Err(card.error(reason));
                    }
                },
            };
            self.pairs.push(Pair {
                surfaces,
                interaction,
                adjust: match card.get("ADJUST") {
                    Some("NO") => Adjust::No,
                    _ => Adjust::Within(tolerance),
                },
                tolerance: Some(tolerance),
                clearance: None,
                absent: Vec::new(),
                card,
            });
        }
        Ok(())
    }

    /// The pair of two surfaces that are not tied.
    fn pair(
        &mut self,
        surfaces: &[String; 2],
        card: &Card<'_>,
    ) -> Result<&mut Pair<'a, 'c>, Error> {
        let [slave, master] = surfaces;
        let found = self
            .pairs
            .iter()
            .position(|pair| pair.surfaces == *surfaces);
        let unknown = || {
            card.error(format!(
                "`{slave}`, `{master}` is no *CONTACT PAIR that stands before"
            ))
        };
        let found = found.ok_or_else(unknown)?;
        match self.laws[self.pairs[found].interaction].is_tied() {
            true => Err(card.error(format!(
                "`{slave}`, `{master}` is tied, or without separation; expected surfaces that may part"
            ))),
            false => Ok(&mut self.pairs[found]),
        }
    }

    fn read_clearance(
        &mut self,
        scope: usize,
        card: &'c Card<'a>,
        contents: &Contents,
    ) -> Result<(), Error> {
        card.only(&["MASTER", "SLAVE", "VALUE"])?;
        let head = card.head(scope);
        let surface = |key: &str| Ok(contents.surface(head, card.need(key)?)?.0.clone());
        let surfaces = [surface("SLAVE")?, surface("MASTER")?];
        let value = head.number_of(card.need("VALUE")?, "a distance")?;
        self.pair(&surfaces, card)?.clearance = Some((value, card));
        Ok(())
    }

    /// What was taken out stays out in the next step.
    fn go_on(&mut self, number: usize) {
        for pair in &mut self.pairs {
            if pair.absent.last().is_some_and(|&last| last + 1 == number) {
                pair.absent.push(number);
            }
        }
    }

    /// Takes pairs out, or in again, from a step on.
    fn change(
        &mut self,
        number: usize,
        scope: usize,
        card: &'c Card<'a>,
        contents: &Contents,
    ) -> Result<(), Error> {
        card.only(&["TYPE", "REMOVE", "ADD"])?;
        card.need("TYPE")?;
        card.one_of("TYPE", &["CONTACTPAIR"])?;
        let remove = card.get("REMOVE").is_some();
        if remove == card.get("ADD").is_some() {
            return Err(card.error("expected one of `REMOVE` and `ADD`"));
        }
        for surfaces in surfaces(scope, card, contents)? {
            let absent = &mut self.pair(&surfaces, card)?.absent;
            absent.retain(|&step| step != number);
            if remove {
                absent.push(number);
            }
        }
        Ok(())
    }

    /// The law of surfaces that are one.
    fn glue(&mut self) -> usize {
        self.laws.push(Interaction::glue());
        self.laws.len() - 1
    }
}

/// Size of the smallest face of a surface.
fn size(contents: &Contents, surface: &str) -> f64 {
    let sides = contents.surfaces[surface].iter();
    let sizes = sides.map(|&side| contents.face_size(side));
    sizes.fold(f64::INFINITY, f64::min)
}

/// Full names of the slave and the master surface in every row of a card.
fn surfaces(scope: usize, card: &Card<'_>, contents: &Contents) -> Result<Vec<[String; 2]>, Error> {
    let mut found = Vec::new();
    for row in card.rows(scope) {
        let words: Vec<String> = row.words().map(bare).collect();
        let [slave, master] = &words[..] else {
            return Err(row.error(TWO));
        };
        if slave == master {
            return Err(row.error(TWO));
        }
        let surface = |name| Ok(contents.surface(row, name)?.0.clone());
        found.push([surface(slave)?, surface(master)?]);
    }
    match found.is_empty() {
        true => Err(card.error("expected a line with slave and master surface")),
        false => Ok(found),
    }
}

fn adjust(scope: usize, card: &Card<'_>, contents: &Contents) -> Result<Adjust, Error> {
    let Some(value) = card.get("ADJUST") else {
        return Ok(Adjust::No);
    };
    match value.parse::<f64>() {
        Ok(distance) if distance >= 0.0 && distance.is_finite() => Ok(Adjust::Within(distance)),
        Ok(distance) => Err(card.error(format!("`ADJUST={distance}`; expected one from 0"))),
        Err(_) => {
            let nodes = contents.nodes.members(card.head(scope), value)?;
            Ok(Adjust::Set(nodes))
        }
    }
}
