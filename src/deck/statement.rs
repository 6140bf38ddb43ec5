//! What the cards of a deck are about: the model, its steps, or nothing that is needed here.
//!
//! A keyword that changes the mechanics is read in a file of this folder or refused by name and
//! line. What steers a numerical method or asks for output is noted and left.

use std::collections::BTreeSet;

use crate::error::Error;
use crate::mesh_file::abaqus::{Card, Flat, KEYWORDS};

/// Keywords that state the model.
const MODEL: &str = "MATERIAL ELASTIC DENSITY EXPANSION SOLIDSECTION ORIENTATION SURFACEINTERACTION \
    SURFACEBEHAVIOR FRICTION CONTACTPAIR CLEARANCE TIE CYCLICSYMMETRYMODEL TRANSFORM RIGIDBODY COUPLING \
    KINEMATIC PRE-TENSIONSECTION INITIALCONDITIONS BOUNDARY";

/// Keywords that state a step.
const STEP: &str = "BOUNDARY CLOAD DLOAD DSLOAD TEMPERATURE MODELCHANGE";

/// Keywords that ask for output.
const OUTPUT: &str = "HEADING NODEFILE NODEPRINT NODEOUTPUT ELFILE ELPRINT ELEMENTOUTPUT CONTACTFILE \
    CONTACTPRINT CONTACTOUTPUT ENERGYFILE ENERGYPRINT ENERGYOUTPUT SECTIONPRINT SECTIONFILE \
    OUTPUT RESTART PREPRINT PRINT FILEFORMAT FILEOUTPUT MONITOR TIMEPOINTS FILTER \
    NODALTHICKNESS";

/// Keywords that steer a numerical method, or state what elastic bodies at rest do not feel.
const NUMERICS: &str = "CONTROLS CONTACTCONTROLS CONTACTDAMPING SECTIONCONTROLS SOLUTIONTECHNIQUE CONDUCTIVITY \
    SPECIFICHEAT GAPCONDUCTANCE DAMPING PHYSICALCONSTANTS SELECTCYCLICSYMMETRYMODES";

/// What is refused, and its keywords.
const REFUSED: [(&str, &str); 19] = [
    ("motion with inertia", "DYNAMIC"),
    (
        "temperature as an unknown",
        "HEATTRANSFER COUPLEDTEMPERATUREDISPLACEMENT COUPLEDTEMPERATURE-DISPLACEMENT UNCOUPLEDTEMPERATURE-DISPLACEMENT",
    ),
    ("buckling", "BUCKLE"),
    ("creep", "VISCO CREEP"),
    ("shells", "SHELLSECTION SHELLGENERALSECTION"),
    ("beams", "BEAMSECTION BEAMGENERALSECTION"),
    ("membranes", "MEMBRANESECTION"),
    ("equations between displacements", "EQUATION MPC"),
    (
        "a node that moves as the mean of a surface",
        "DISTRIBUTING DISTRIBUTINGCOUPLING",
    ),
    ("gap elements", "GAP"),
    (
        "an overlap stated apart from the mesh",
        "CONTACTINTERFERENCE",
    ),
    ("contact of all with all; state *CONTACT PAIR", "CONTACT"),
    ("springs", "SPRING"),
    ("plasticity", "PLASTIC"),
    ("large strain", "HYPERELASTIC"),
    ("a material of the user's", "USERMATERIAL"),
    ("friction that changes", "CHANGEFRICTION"),
    (
        "a law of contact that changes",
        "CHANGESURFACEBEHAVIOR CHANGECONTACTTYPE",
    ),
    ("coordinates of a system of their own", "SYSTEM"),
];

/// A card and its scope.
pub(super) type Stated<'a, 'c> = (usize, &'c Card<'a>);

/// A static step.
pub(super) struct Step<'a, 'c> {
    /// `*STEP`.
    pub(super) card: &'c Card<'a>,
    /// `*STATIC`.
    pub(super) procedure: &'c Card<'a>,
    /// What changes in it.
    pub(super) cards: Vec<Stated<'a, 'c>>,
}

/// The cards of a deck, told apart.
#[derive(Default)]
pub(super) struct Statement<'a, 'c> {
    /// Of the model, and `*AMPLITUDE` wherever it stands.
    pub(super) model: Vec<Stated<'a, 'c>>,
    /// Static steps.
    pub(super) steps: Vec<Step<'a, 'c>>,
    /// Pairs of surfaces taken out or in by steps that are left out.
    changes: Vec<Stated<'a, 'c>>,
}

/// What was read and left, in words, each once.
#[derive(Default)]
pub(super) struct Notes {
    pub(super) lines: Vec<String>,
    said: BTreeSet<String>,
}

impl Notes {
    /// Notes something of a keyword, once.
    pub(super) fn add(&mut self, card: &Card<'_>, words: &str) {
        if self.said.insert(format!("{} {words}", card.shown)) {
            self.lines.push(format!("{} {words}", card.place()));
        }
    }

    /// Refuses every parameter but those that are read and those that steer a method, which are noted.
    pub(super) fn only(
        &mut self,
        card: &Card<'_>,
        read: &[&str],
        steering: &[&str],
    ) -> Result<(), Error> {
        let all: Vec<&str> = read.iter().chain(steering).copied().collect();
        card.only(&all)?;
        for key in steering.iter().filter(|key| card.get(key).is_some()) {
            self.add(card, &format!("`{key}` is not needed here"));
        }
        Ok(())
    }
}

impl<'a, 'c> Statement<'a, 'c> {
    /// Tells the cards apart.
    pub(super) fn new(flat: &Flat<'a, 'c>, notes: &mut Notes) -> Result<Self, Error> {
        let (mut statement, mut at) = (Self::default(), 0);
        while let Some(&(scope, card)) = flat.cards.get(at) {
            at += 1;
            if card.name == "STEP" {
                let ends =
                    |(_, card): &Stated<'_, '_>| ["STEP", "ENDSTEP"].contains(&card.name.as_str());
                let length = flat.cards[at..].iter().position(ends);
                let length = length.filter(|length| flat.cards[at + length].1.name == "ENDSTEP");
                let open = || card.error("a step that is not ended; expected *END STEP");
                let length = length.ok_or_else(open)?;
                statement.add_step(card, &flat.cards[at..at + length], notes)?;
                at += length + 1;
            } else if has(MODEL, &card.name) || card.name == "AMPLITUDE" {
                statement.model.push((scope, card));
            } else {
                leave(card, notes, "before the first step")?;
            }
        }
        match (statement.steps.is_empty(), flat.cards.last()) {
            (true, Some((_, last))) => {
                Err(last.error("the deck ends; expected a *STEP with *STATIC"))
            }
            (true, None) => Err(Error::Empty {
                place: "deck".to_owned(),
            }),
            _ => Ok(statement),
        }
    }

    /// What the model lacks before the first step.
    pub(super) fn missing(&self, what: impl std::fmt::Display) -> Error {
        match self.steps.first() {
            Some(step) => step
                .card
                .error(format!("begins; expected a {what} before it")),
            None => Error::Empty {
                place: what.to_string(),
            },
        }
    }

    fn add_step(
        &mut self,
        card: &'c Card<'a>,
        inside: &[Stated<'a, 'c>],
        notes: &mut Notes,
    ) -> Result<(), Error> {
        let read = ["NLGEOM", "INC", "NAME", "PERTURBATION", "AMPLITUDE"];
        notes.only(
            card,
            &read,
            &["UNSYMM", "EXTRAPOLATION", "CONVERTSDI", "SOLVER"],
        )?;
        if let Some((_, frequency)) = inside.iter().find(|(_, card)| card.name == "FREQUENCY") {
            notes.add(
                frequency,
                "vibrations are not computed: the step is left out",
            );
            let changes = inside.iter().filter(|(_, card)| card.name == "MODELCHANGE");
            self.changes.extend(changes);
            return Ok(());
        }
        if card.get("PERTURBATION").is_some() {
            return Err(card.error("`PERTURBATION` is not read: steps start from the loads before"));
        }
        if card.get("NLGEOM").is_some_and(|value| value != "NO") {
            notes.add(card, "`NLGEOM`: displacements count as small here");
        }
        let (mut procedure, mut cards) = (None, std::mem::take(&mut self.changes));
        for &(scope, inner) in inside {
            match inner.name.as_str() {
                "STATIC" => procedure = Some(inner),
                "AMPLITUDE" => self.model.push((scope, inner)),
                name if has(STEP, name) => cards.push((scope, inner)),
                name if has(MODEL, name) => {
                    return Err(inner.error("inside a step; expected it before the first one"));
                }
                _ => leave(inner, notes, "in a step")?,
            }
        }
        let missing = || card.error("a step without *STATIC; expected one");
        self.steps.push(Step {
            card,
            procedure: procedure.ok_or_else(missing)?,
            cards,
        });
        Ok(())
    }
}

/// Notes a keyword that is not needed, and refuses all others that are not read.
fn leave(card: &Card<'_>, notes: &mut Notes, place: &str) -> Result<(), Error> {
    let name = card.name.as_str();
    if KEYWORDS.contains(&name) || name == "HEADING" {
        return Ok(());
    }
    if has(OUTPUT, name) || has(NUMERICS, name) {
        notes.add(card, "is not needed here");
        return Ok(());
    }
    if let Some((what, _)) = REFUSED.iter().find(|(_, words)| has(words, name)) {
        return Err(card.error(format!("is not read: {what}")));
    }
    match has(STEP, name) || ["STATIC", "ENDSTEP", "FREQUENCY"].contains(&name) {
        true => Err(card.error(format!("{place}; expected it in a step"))),
        false => Err(card.error(format!("an unknown keyword {place}"))),
    }
}

fn has(words: &str, name: &str) -> bool {
    words.split(' ').any(|word| word == name)
}
