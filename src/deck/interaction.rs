//! Laws of contact, and the pairs of surfaces that obey them.
//!
//! ```text
//! HARD, LINEAR K, EXPONENTIAL (c₀, p₀)       unilateral; a penalty stiffness K is left out where
//!                                            K > 10 E / h, as the cells of size h give more
//! ```

use super::statement::{Notes, Statement};
use crate::error::Error;
use crate::mesh_file::abaqus::{Card, Contents, bare};

/// A law of contact.
#[derive(Clone, Debug)]
pub(super) struct Interaction<'a, 'c> {
    /// Name in the deck.
    name: String,
    /// Coefficient of friction.
    pub(super) friction: f64,
    /// Pressure per overlap, and where it is stated; none for hard contact.
    pub(super) stiffness: Option<(f64, &'c Card<'a>)>,
}

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
            contacts.read_law(card, notes)?;
        }
        for &(scope, card) in model.iter().filter(|(_, card)| card.name == "CONTACTPAIR") {
            contacts.read_pairs(scope, card, contents, notes)?;
        }
        match contacts.pairs.is_empty() {
            true => Err(statement.missing("*CONTACT PAIR")),
            false => Ok(contacts),
        }
    }

    fn read_law(&mut self, card: &'c Card<'a>, notes: &mut Notes) -> Result<(), Error> {
        let orphan = || card.error("expected *SURFACE INTERACTION before");
        match card.name.as_str() {
            "SURFACEINTERACTION" => {
                card.only(&["NAME"])?;
                self.laws.push(Interaction {
                    name: card.need("NAME")?.to_owned(),
                    friction: 0.0,
                    stiffness: None,
                });
            }
            "SURFACEBEHAVIOR" => {
                let law = self.laws.last_mut().ok_or_else(orphan)?;
                law.stiffness = stiffness(card)?.map(|stiffness| (stiffness, card));
            }
            "FRICTION" => {
                let law = self.laws.last_mut().ok_or_else(orphan)?;
                law.friction = friction(card, notes)?;
            }
            _ => {}
        }
        Ok(())
    }

    fn read_pairs(
        &mut self,
        scope: usize,
        card: &'c Card<'a>,
        contents: &Contents,
        notes: &mut Notes,
    ) -> Result<(), Error> {
        card.only(&["INTERACTION", "TYPE", "ADJUST", "SMALLSLIDING"])?;
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
        let interaction = interaction.ok_or_else(unknown)?;
        if card.rows(scope).next().is_none() {
            return Err(card.error("expected a line with slave and master surface"));
        }
        for row in card.rows(scope) {
            let words: Vec<String> = row.words().map(bare).collect();
            let [slave, master] = &words[..] else {
                return Err(row.error("expected slave and master surface"));
            };
            let surface = |name| Ok(contents.surface(row, name)?.0.clone());
            self.pairs.push(Pair {
                surfaces: [surface(slave)?, surface(master)?],
                interaction,
                adjust: adjust(scope, card, contents)?,
                card,
            });
        }
        Ok(())
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

/// Pressure per overlap of a law; none where contact is hard.
fn stiffness(card: &Card<'_>) -> Result<Option<f64>, Error> {
    card.only(&[
        "PRESSURE-OVERCLOSURE",
        "PENALTY",
        "AUGMENTEDLAGRANGE",
        "DIRECT",
    ])?;
    let kind = card.get("PRESSURE-OVERCLOSURE").unwrap_or("HARD");
    card.one_of("PRESSURE-OVERCLOSURE", &["HARD", "LINEAR", "EXPONENTIAL"])?;
    if kind == "HARD" {
        return Ok(None);
    }
    let row = card.row("the stiffness")?;
    let stated = row.number(0, "a stiffness or a distance", None)?;
    let stiffness = match kind {
        "LINEAR" => stated,
        // p = p₀ exp(−g ln 100 / c₀) has the slope p₀ ln 100 / c₀ where the gap closes.
        _ => row.number(1, "a pressure", None)? * 100.0_f64.ln() / stated,
    };
    match stiffness > 0.0 {
        true => Ok(Some(stiffness)),
        false => Err(row.error("expected a stiffness above 0")),
    }
}

fn friction(card: &Card<'_>, notes: &mut Notes) -> Result<f64, Error> {
    card.only(&["SLIPTOLERANCE", "ELASTICSLIP", "LAGRANGE"])?;
    let row = card.row("the coefficient of friction, one for all pressures")?;
    let friction = row.number(0, "a coefficient of friction", None)?;
    if friction < 0.0 {
        return Err(row.error(format!("coefficient {friction}; expected one from 0")));
    }
    if row.words().count() > 1 {
        row.number(1, "a stick slope", 0.0)?;
        notes.add(
            card,
            "a stick slope is not needed here: what sticks does not move",
        );
    }
    Ok(friction)
}

/// Stiffness over E / h below which a layer is soft: it gives more than a tenth of what a cell gives.
const SOFT: f64 = 10.0;

/// Stiffness over E / h from which on nothing is said: a hundredth of what a cell gives.
const HARD: f64 = 100.0;

/// Refuses a law so soft that leaving its stiffness out would change the answer, and notes what is left
/// out; `cell` is E / h, of the softest and of the smallest cell at the surfaces.
pub(super) fn check_hard(
    law: &Interaction<'_, '_>,
    cell: f64,
    notes: &mut Notes,
) -> Result<(), Error> {
    let Some((stiffness, card)) = law.stiffness else {
        return Ok(());
    };
    let ratio = stiffness / cell;
    if ratio < SOFT {
        return Err(card.error(format!(
            "stiffness {stiffness:.3e} is a soft layer, {ratio:.2} E / h of the cells there; expected \
             at least {SOFT} E / h = {:.3e}, or HARD",
            SOFT * cell
        )));
    }
    if ratio < HARD {
        let given = 100.0 / ratio;
        let words = format!(
            "the stiffness is left out, contact is hard here: it gives {given:.0} % of what a cell gives"
        );
        notes.add(card, &words);
    } else {
        notes.add(
            card,
            "the stiffness of the penalty is not needed here: contact is hard",
        );
    }
    Ok(())
}
