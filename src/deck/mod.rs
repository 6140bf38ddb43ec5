//! DECKS: Abaqus and CalculiX input as a scene.
//!
//! ```text
//! mesh_file/abaqus   lines → cards → instances written out → nodes, elements, sets, surfaces
//! statement          which cards state the model, which the steps, which are left or refused
//! material, parts    sections; connected parts become bodies
//! interaction        laws and pairs of surfaces;   adjust   slave nodes moved onto the master
//! load, amplitude    what a card gives;            history  what holds at every instant
//! assemble           the scene
//! ```
//!
//! | read | how |
//! |---|---|
//! | `*NODE`, `*ELEMENT`, `*NSET`, `*ELSET`, `*INCLUDE`, parts and instances | C3D4, C3D8, C3D10, C3D20, and CPE, CPS, CAX of 3, 4, 6, 8 nodes; every connected part is a body |
//! | `*SURFACE` | by faces, by elements (all outer faces), by nodes (outer faces whose corners are all in the set) |
//! | `*MATERIAL`, `*ELASTIC`, `*DENSITY`, `*SOLID SECTION` | isotropic; a thickness is that of plane stress, and what forces of plane strain are divided by |
//! | `*CONTACT PAIR`, `*SURFACE INTERACTION`, `*SURFACE BEHAVIOR`, `*FRICTION` | hard contact with friction, slave first; a penalty is left out, with a note below 100 E / h of the cells there, and refused as a soft layer below 10 E / h; stick slopes are left out |
//! | `ADJUST=` | slave nodes that overlap, or are near, or of a set, are moved onto the master surface |
//! | `*BOUNDARY`, `*CLOAD`, `*DLOAD` (P1 to P6, GRAV, BX, BY, BZ), `*DSLOAD` (P), `*AMPLITUDE` | persist from step to step, ramp, end with `OP=NEW`; supports stay |
//! | `*STEP`, `*STATIC` | an instant per step and per time of an amplitude; `NLGEOM` is noted, displacements are small |
//!
//! What changes the mechanics and is not read is refused by file, line and keyword: shells, beams,
//! tied surfaces, equations, rigid bodies, couplings, preloaded bolts, springs, thermal
//! expansion, plasticity, dynamics, contacts that come and go. What steers a numerical method, and
//! steps of `*FREQUENCY`, are noted and left. Numbers keep the deck's units. Sources: Abaqus keywords
//! reference, CalculiX CrunchiX user's manual.

mod adjust;
mod amplitude;
mod assemble;
mod history;
mod interaction;
mod load;
mod material;
mod parts;
mod statement;

use std::path::Path;

use crate::error::Error;
use crate::mesh_file::abaqus::{Contents, ElementKind, Source, cards, flatten};
use crate::scene::{Scene, read};

use amplitude::amplitudes;
use assemble::Stock;
use history::History;
use interaction::Contacts;
use load::Reader;
use material::Materials;
use parts::Parts;
use statement::{Notes, Statement};

/// A deck that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Deck {
    /// What it says; its meshes are held in memory.
    pub scene: Scene,
    /// What was read and left, by file, line and keyword.
    pub notes: Vec<String>,
}

impl Deck {
    /// Reads a deck from a file, and what it includes relative to its folder.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], and those of [`Deck::parse`].
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let bytes = read("deck", path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut deck = Self::parse(&bytes, &path.display().to_string(), &|included| {
            read("*INCLUDE", &folder.join(included))
        })?;
        deck.scene.source = path.to_owned();
        Ok(deck)
    }

    /// Reads a deck from bytes; `name` stands for it in messages, and `read` gives the bytes of a file
    /// that it includes.
    ///
    /// # Errors
    ///
    /// [`Error::Mesh`] with file, line and keyword: data that is no data, an unknown keyword, one that
    /// is not read, a parameter or value that changes the mechanics and is not read, names that refer
    /// to nothing, files that include themselves.
    pub fn parse(
        bytes: &[u8],
        name: &str,
        read: &dyn Fn(&str) -> Result<Vec<u8>, Error>,
    ) -> Result<Self, Error> {
        let mut notes = Notes::default();
        let source = Source::new(bytes, name, read)?;
        let cards = cards(&source)?;
        let Some(last) = cards.last() else {
            return Err(Error::Mesh {
                file: name.to_owned(),
                line: 1,
                reason: "no keyword; expected a deck with *NODE, *ELEMENT, *STEP".to_owned(),
            });
        };
        let flat = flatten(&cards)?;
        let statement = Statement::new(&flat, &mut notes)?;
        let contents = Contents::new(&flat, ElementKind::new)?;
        if contents.elements.is_empty() {
            return Err(last.error("the deck ends; expected *NODE and *ELEMENT with data"));
        }
        let mut scene = stock(&statement, contents, &mut notes)?.scene(&mut notes)?;
        scene.title = name.to_owned();
        Ok(Self {
            scene,
            notes: notes.lines,
        })
    }
}

/// Takes up all that a deck states.
fn stock<'a, 'c>(
    statement: &Statement<'a, 'c>,
    mut contents: Contents,
    notes: &mut Notes,
) -> Result<Stock<'a, 'c>, Error> {
    let model = &statement.model;
    let materials = Materials::new(statement, &contents, notes)?;
    let parts = Parts::new(&contents, &materials)?;
    let contacts = Contacts::new(statement, &contents, notes)?;
    let reader = Reader {
        contents: &contents,
        materials: &materials,
        parts: &parts,
        outer: contents.outer_sides(),
    };
    let history = History::new(statement, &amplitudes(model)?, reader, notes)?;
    for pair in &contacts.pairs {
        adjust::adjust(&mut contents, pair);
    }
    Ok(Stock {
        contents,
        materials,
        parts,
        contacts,
        history,
    })
}
